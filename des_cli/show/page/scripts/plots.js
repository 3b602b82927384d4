// The plots of a run, drawn by Bokeh when they come into view.

const DASHES = {
  before: [6, 3],
  after: [],
  total_before: [2, 3],
  total_after: [9, 3, 2, 3],
  arm: [],
  fork: [8, 3],
  cab: [3, 3],
};
const WIDTHS = { before: 1.5, total_before: 1.5 };
const HEIGHT = 188;
const STATIC = window.matchMedia("(pointer: coarse)");

/** Return a colour of the page's style. */
function colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

/** Say what the abscissa is, in little room. */
function timeAxis() {
  return {
    axis_label: "t [s]",
    axis_label_standoff: 0,
    axis_label_text_font_size: "11px",
    axis_label_text_font_style: "normal",
    axis_label_text_color: colour("soft"),
  };
}

/** One plot: a figure of the page, filled when it is first seen. */
class Panel {
  constructor(run, figure, spec) {
    this.run = run;
    this.figure = figure;
    this.spec = spec;
    this.host = figure.querySelector(".plot");
    this.values = [...figure.querySelectorAll(".legend output")];
    this.painted = []; // what takes the colours of the page, and takes them again
    this.view = null;
    this.busy = false;
  }

  /** Draw the plot, once. */
  draw() {
    this.drawing ??= this.embed();
    return this.drawing;
  }

  async embed() {
    this.build();
    const doc = new (Bokeh.require("document").Document)();
    doc.add_root(this.plot);
    this.host.replaceChildren();
    const views = await Bokeh.embed.add_document_standalone(doc, this.host);
    this.view = views.roots ? [...views.roots][0] : views[0];
    this.cursor = document.createElement("div");
    this.cursor.className = "cursor";
    this.host.append(this.cursor);
    this.listen();
    this.figure.dataset.drawn = "";
    this.follow();
  }

  build() {
    const M = Bokeh.Models;
    const { spec, run } = this;
    const [low, high] = spec.span;
    const { from, to } = run.clock;
    this.x = new M.Range1d({ start: from, end: to });
    this.plot = new M.Plot({
      x_range: this.x,
      y_range: new M.Range1d({ start: low, end: high }),
      sizing_mode: "stretch_width",
      height: HEIGHT,
      toolbar_location: null,
      min_border_left: 58,
      min_border_right: 10,
      min_border_top: 6,
      min_border_bottom: 36,
      background_fill_alpha: 0,
      border_fill_alpha: 0,
      outline_line_color: null,
    });
    this.addBand(M, low, high);
    this.addAxes(M);
    const family = run.data.family(spec.family);
    const source = new M.ColumnDataSource({ data: family });
    for (const { column, pen } of spec.curves) {
      const line = new M.Line({
        x: { field: "t" },
        y: { field: column },
        line_width: WIDTHS[pen] ?? 1.8,
        line_dash: DASHES[pen],
        line_join: "round",
      });
      this.plot.add_glyph(line, source);
      this.painted.push(() => (line.line_color = { value: colour(`pen-${pen}`) }));
    }
    this.addStays(M);
    if (!STATIC.matches) this.addTools(M);
    this.paint();
  }

  addAxes(M) {
    for (const [side, Axis, dimension] of [
      ["below", M.LinearAxis, 0],
      ["left", M.LinearAxis, 1],
    ]) {
      const ticker = new M.BasicTicker({ desired_num_ticks: dimension ? 5 : 8 });
      const axis = new Axis({
        ticker,
        minor_tick_line_color: null,
        major_tick_in: 0,
        major_tick_out: 4,
        major_label_text_font_size: "11px",
        axis_line_color: null,
        ...(dimension ? {} : timeAxis()),
      });
      const grid = new M.Grid({ ticker, axis, dimension, grid_line_width: 1 });
      this.plot.add_layout(axis, side);
      this.plot.add_layout(grid, "center");
      this.painted.push(() => {
        axis.major_label_text_color = colour("soft");
        axis.major_tick_line_color = colour("line");
        axis.axis_label_text_color = colour("soft");
        grid.grid_line_color = colour("grid");
      });
    }
    const zero = new M.Span({ dimension: "width", location: 0, line_width: 1, level: "underlay" });
    this.plot.add_layout(zero, "center");
    this.painted.push(() => (zero.line_color = colour("zero")));
  }

  /** Shade what is within the limit and what is beyond it. */
  addBand(M, low, high) {
    const { limit } = this.spec;
    if (limit == null) return;
    const boxes = [["within", Math.max(low, -limit), Math.min(high, limit)]];
    if (high > limit) boxes.push(["beyond", limit, high]);
    if (low < -limit) boxes.push(["beyond", low, -limit]);
    for (const [name, bottom, top] of boxes) {
      const box = new M.BoxAnnotation({
        bottom,
        top,
        level: "underlay",
        line_color: null,
        fill_alpha: 1,
        propagate_hover: true,
      });
      this.plot.add_layout(box, "center");
      this.painted.push(() => (box.fill_color = colour(name)));
    }
  }

  /** Mark where the modified motion is at its limit: a thick bar on the limit itself. */
  addStays(M) {
    const { limit, at_limit: stays } = this.spec;
    if (limit == null || !stays.length) return;
    const after = this.spec.curves[1].column;
    const least = this.run.data.duration / 300; // a single sample is seen too
    const data = { from: [], to: [], y: [] };
    for (const [from, to] of stays) {
      const middle = 0.5 * (from + to);
      const half = Math.max(0.5 * (to - from), least);
      data.from.push(middle - half);
      data.to.push(middle + half);
      data.y.push(Math.sign(this.run.data.at(this.spec.family, after, middle)) * limit);
    }
    const bar = new M.Segment({
      x0: { field: "from" },
      x1: { field: "to" },
      y0: { field: "y" },
      y1: { field: "y" },
      line_width: 5,
    });
    this.plot.add_glyph(bar, new M.ColumnDataSource({ data }));
    this.painted.push(() => (bar.line_color = { value: colour("bad") }));
  }

  addTools(M) {
    const overlay = new M.BoxAnnotation({ line_width: 1, fill_alpha: 0.25, level: "overlay", visible: false });
    const drag = new M.BoxZoomTool({ dimensions: "width", overlay });
    this.plot.add_tools(drag);
    this.plot.toolbar.active_drag = drag;
    this.plot.toolbar.active_scroll = null;
    this.painted.push(() => {
      overlay.fill_color = colour("accent");
      overlay.line_color = colour("accent");
    });
  }

  /** Take the colours of the page: they change with the theme, and for paper. */
  paint() {
    for (const take of this.painted) take();
  }

  /** Return the sides of the plotting area [px], and the time at a place of it. */
  frame() {
    const box = this.view?.frame?.bbox;
    return box && box.width > 0 ? box : null;
  }

  timeAt(event) {
    const box = this.frame();
    if (!box) return null;
    const x = event.clientX - this.host.getBoundingClientRect().left;
    const share = (x - box.left) / box.width;
    return share < 0 || share > 1 ? null : this.x.start + share * (this.x.end - this.x.start);
  }

  listen() {
    const clock = this.run.clock;
    const changed = () => {
      if (!this.busy) clock.zoom(this.x.start, this.x.end);
    };
    this.x.properties.start.change.connect(changed);
    this.x.properties.end.change.connect(changed);
    let from = null;
    this.host.addEventListener("pointermove", (event) => {
      if (event.pointerType === "mouse" && !clock.playing) clock.point(this.timeAt(event));
    });
    this.host.addEventListener("pointerleave", () => clock.point(null));
    this.host.addEventListener("pointerdown", (event) => (from = event.clientX), true);
    this.host.addEventListener("click", (event) => {
      const time = this.timeAt(event);
      // a drag is a zoom, not a choice of a time
      if (time != null && from != null && Math.abs(event.clientX - from) < 4) clock.set(time);
    });
    this.host.addEventListener("dblclick", () => clock.zoom(clock.first, clock.last));
    this.host.addEventListener(
      "wheel",
      (event) => {
        const time = this.timeAt(event);
        if (!event.ctrlKey || time == null) return;
        event.preventDefault();
        clock.scale(event.deltaY > 0 ? 1.25 : 0.8, time);
      },
      { passive: false },
    );
    new ResizeObserver(() => requestAnimationFrame(() => this.place())).observe(this.host);
  }

  /** Take the range, the time and the values of the clock. */
  follow() {
    const { from, to } = this.run.clock;
    if (this.x && (this.x.start !== from || this.x.end !== to)) {
      this.busy = true;
      this.x.setv({ start: from, end: to });
      this.busy = false;
    }
    this.place();
    this.read();
  }

  place() {
    const box = this.frame();
    if (!box) return;
    const { start, end } = this.x;
    const share = (this.run.clock.shown - start) / (end - start);
    this.cursor.hidden = share < 0 || share > 1;
    this.cursor.style.transform = `translate(${box.left + share * box.width}px, ${box.top}px)`;
    this.cursor.style.height = `${box.height}px`;
  }

  read() {
    const time = this.run.clock.shown;
    this.spec.curves.forEach(({ column }, i) => {
      this.values[i].textContent = written(this.run.data.at(this.spec.family, column, time));
    });
  }
}
