// The plots on paper: as lines of their own, for a screen's pixels are not a sheet's width.

const PAPER = { width: 480, height: 150, left: 46, right: 6, top: 6, bottom: 18 };

/** Return round numbers in a range, about so many. */
function ticks(low, high, about) {
  const rough = (high - low) / about;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * [1, 2, 5, 10].find((each) => each * power >= rough);
  const found = [];
  for (let i = Math.ceil(low / step); i * step <= high; i++) found.push(i * step);
  return found;
}

/** Return a panel's shown range as SVG. */
function paperPlot({ spec, run }) {
  const { width, height, left, right, top, bottom } = PAPER;
  const { from, to } = run.clock;
  const [low, high] = spec.span;
  const x = (t) => left + ((t - from) / (to - from)) * (width - left - right);
  const y = (v) => top + ((high - v) / (high - low)) * (height - top - bottom);
  const parts = [];
  if (spec.limit != null) {
    const [upper, lower] = [y(Math.min(high, spec.limit)), y(Math.max(low, -spec.limit))];
    parts.push(`<rect class="within" x="${left}" y="${upper}" width="${width - left - right}" height="${lower - upper}"/>`);
  }
  for (const t of ticks(from, to, 8)) {
    parts.push(`<path class="grid" d="M${x(t)},${top}V${height - bottom}"/><text x="${x(t)}" y="${height - 5}" text-anchor="middle">${written(t)}</text>`);
  }
  for (const v of ticks(low, high, 4)) {
    parts.push(`<path class="grid" d="M${left},${y(v)}H${width - right}"/><text x="${left - 5}" y="${y(v) + 3.5}" text-anchor="end">${written(v)}</text>`);
  }
  const family = run.data.family(spec.family);
  for (const { column, pen } of spec.curves) {
    const points = [];
    family.t.forEach((t, i) => {
      const value = Math.min(high, Math.max(low, family[column][i]));
      if (t >= from && t <= to) points.push(`${x(t).toFixed(1)},${y(value).toFixed(1)}`);
    });
    parts.push(`<polyline class="pen-${pen}" points="${points.join(" ")}"/>`);
  }
  const svg = document.createElementNS(SVG, "svg");
  svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
  svg.setAttribute("class", "paper");
  svg.innerHTML = parts.join("");
  return svg;
}

function toPaper(runs) {
  fromPaper();
  for (const run of runs) for (const panel of run.panels) panel.host.append(paperPlot(panel));
}

function fromPaper() {
  for (const svg of document.querySelectorAll("svg.paper")) svg.remove();
}
