// The table of runs: sorted by a column, and the chosen ones drawn over each other.

function sortable(table) {
  const body = table.tBodies[0];
  const heads = [...table.tHead.rows[0].cells];
  heads.forEach((head, column) => {
    const button = head.querySelector("button");
    if (!button) return;
    button.addEventListener("click", () => {
      const up = head.getAttribute("aria-sort") !== "ascending";
      for (const each of heads) each.removeAttribute("aria-sort");
      head.setAttribute("aria-sort", up ? "ascending" : "descending");
      const key = (row) => row.cells[column].dataset.key ?? row.cells[column].textContent;
      const rows = [...body.rows].map((row) => [key(row), row]);
      const numbers = rows.every(([text]) => text === "" || Number.isFinite(Number(text)));
      const order = ([a], [b]) => {
        if ((a === "") !== (b === "")) return a === "" ? 1 : -1; // what is not known stays last
        const less = numbers ? Number(a) - Number(b) : a.localeCompare(b);
        return up ? less : -less;
      };
      body.append(...rows.sort(order).map(([, row]) => row));
    });
  });
}

const OVERLAID = [
  ["c_n", "turning", "Cross-coupling, size after [rad/s²]"],
  ["a_n", "turning", "Total angular acceleration, size after [rad/s²]"],
  ["gn", "g", "|G| after [g]"],
];
const MOST = 6;
const CHOSEN_DASHES = [[], [7, 3], [2, 3], [9, 3, 2, 3], [12, 4], [4, 2]];

/** Draw the chosen runs over each other, each from its own start. */
class Overlay {
  constructor(host, boxes, runs) {
    this.host = host;
    this.boxes = boxes;
    this.runs = runs;
    for (const box of boxes) box.addEventListener("change", () => this.draw());
  }

  async draw() {
    const chosen = this.boxes.filter((box) => box.checked).map((box) => box.value);
    for (const box of this.boxes) box.disabled = chosen.length >= MOST && !box.checked;
    this.host.hidden = chosen.length === 0;
    const serial = (this.serial = (this.serial ?? 0) + 1);
    const legend = this.host.querySelector(".legend");
    legend.replaceChildren(...chosen.map((anchor, i) => this.entry(anchor, i)));
    const places = this.host.querySelectorAll(".plot");
    for (const [i, [stem, family]] of OVERLAID.entries()) {
      if (serial !== this.serial) return;
      const doc = new (Bokeh.require("document").Document)();
      doc.add_root(this.plot(chosen, stem, family));
      const place = document.createElement("div");
      places[i].replaceChildren(place);
      await Bokeh.embed.add_document_standalone(doc, place);
    }
  }

  entry(anchor, i) {
    const item = document.createElement("li");
    item.innerHTML = '<svg class="swatch" viewBox="0 0 28 8" aria-hidden="true"><line x1="1" y1="4" x2="27" y2="4"/></svg>';
    const line = item.querySelector("line");
    line.style.stroke = colour(`run-${i}`);
    line.setAttribute("stroke-dasharray", CHOSEN_DASHES[i].join(" ") || "none");
    item.append(this.runs(anchor).data.name);
    return item;
  }

  plot(chosen, stem, family) {
    const M = Bokeh.Models;
    const plot = new M.Plot({
      x_range: new M.DataRange1d({ range_padding: 0 }),
      y_range: new M.DataRange1d(),
      sizing_mode: "stretch_width",
      height: 220,
      toolbar_location: null,
      min_border_left: 58,
      background_fill_alpha: 0,
      border_fill_alpha: 0,
      outline_line_color: null,
    });
    for (const [side, dimension] of [["below", 0], ["left", 1]]) {
      const style = { axis_line_color: null, minor_tick_line_color: null, major_tick_line_color: colour("line"), major_tick_in: 0, major_label_text_color: colour("soft") };
      const axis = new M.LinearAxis({ ...style, ...(dimension ? {} : timeAxis()) });
      plot.add_layout(axis, side);
      plot.add_layout(new M.Grid({ axis, dimension, grid_line_color: colour("grid") }), "center");
    }
    chosen.forEach((anchor, i) => {
      const { data } = this.runs(anchor);
      const columns = data.family(family);
      const source = new M.ColumnDataSource({
        data: { t: columns.t.map((t) => t - data.start), y: columns[`${stem}_after`] },
      });
      const line = new M.Line({
        x: { field: "t" },
        y: { field: "y" },
        line_width: 1.8,
        line_color: colour(`run-${i}`),
        line_dash: CHOSEN_DASHES[i],
      });
      plot.add_glyph(line, source);
    });
    return plot;
  }
}
