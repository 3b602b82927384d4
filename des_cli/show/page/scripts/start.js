// Puts the page to work: each run when it is opened, each plot when it comes into view.

document.documentElement.classList.add("scripted");

Bokeh.set_log_level("warn");

const RUNS = new Map();
const PANELS = new WeakMap();

/** A run of the page: its numbers when they are needed, the rest when it is opened. */
class Run {
  constructor(anchor) {
    this.anchor = anchor;
    this.section = document.getElementById(anchor);
    this.panels = [];
    this.opened = false;
  }

  get data() {
    this.read ??= new RunData(this.anchor);
    return this.read;
  }

  open() {
    if (this.opened) return;
    this.opened = true;
    const { data, section } = this;
    this.clock = new Clock(section.querySelector(".timebar"), data.start, data.duration);
    const figures = new Map([...section.querySelectorAll("figure[data-panel]")].map((each) => [each.dataset.panel, each]));
    for (const spec of data.panels) {
      const figure = figures.get(spec.key);
      const panel = new Panel(this, figure, spec);
      this.panels.push(panel);
      PANELS.set(figure, panel);
      SEEN.observe(figure);
      for (const button of figure.querySelectorAll("button[data-save]")) {
        button.addEventListener("click", () => exportPanel(panel, button.dataset.save));
      }
    }
    const sketches = data.chains
      ? [...section.querySelectorAll("svg.machine")].map((svg) => new MachineSketch(svg, data, svg.dataset.view === "near"))
      : [];
    const tell = () => {
      const { shown } = this.clock;
      for (const sketch of sketches) sketch.show(shown);
      for (const panel of this.panels) if (panel.view) panel.follow();
    };
    this.clock.onChange(tell);
    tell();
  }
}

const SEEN = new IntersectionObserver(
  (entries) => {
    for (const entry of entries) {
      if (!entry.isIntersecting) continue;
      SEEN.unobserve(entry.target);
      PANELS.get(entry.target).draw();
    }
  },
  { rootMargin: "300px" },
);

function runOf(anchor) {
  if (!RUNS.has(anchor)) RUNS.set(anchor, new Run(anchor));
  return RUNS.get(anchor);
}

for (const section of document.querySelectorAll("section.run")) {
  const details = section.querySelector("details.all");
  const open = () => details.open && runOf(section.id).open();
  details.addEventListener("toggle", open);
  open();
}

// On a narrow screen the contents would push the verdict off the first view.
if (matchMedia("(max-width: 68rem)").matches) document.querySelector(".toc details").open = false;

/** Open what a link points into. */
function openTarget() {
  const target = location.hash && document.getElementById(location.hash.slice(1));
  for (let each = target; each; each = each.parentElement) if (each.tagName === "DETAILS") each.open = true;
  const details = target?.matches?.("section.run") && target.querySelector("details.all");
  if (details) details.open = true;
}
addEventListener("hashchange", openTarget);
openTarget();

for (const table of document.querySelectorAll("table.sortable")) sortable(table);
for (const host of document.querySelectorAll(".overlay")) {
  new Overlay(host, [...document.querySelectorAll("input[name=overlay]")], runOf);
}
for (const button of document.querySelectorAll("button[data-copy]")) {
  button.addEventListener("click", () => copyText(document.getElementById(button.dataset.copy), button));
}

function repaint() {
  for (const run of RUNS.values()) for (const panel of run.panels) if (panel.plot) panel.paint();
}
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", repaint);
addEventListener("beforeprint", () => toPaper([...RUNS.values()]));
addEventListener("afterprint", fromPaper);
