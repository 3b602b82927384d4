// What can be taken from the page: a plot, the numbers of the shown range, the metrics.

function save(blob, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

/** Return the shown range of a panel as CSV; a cell holds a number, so nothing needs quotes. */
function csvOf(panel) {
  const { spec, run } = panel;
  const family = run.data.family(spec.family);
  const names = spec.curves.map(({ column }) => column);
  const unit = spec.csv_unit;
  const lines = [["t_s", ...names.map((name) => (unit ? `${name}_${unit}` : name))].join(",")];
  family.t.forEach((t, i) => {
    if (t < run.clock.from || t > run.clock.to) return;
    // a 32-bit float has seven digits
    lines.push([t, ...names.map((name) => family[name][i])].map((value) => String(Number(value.toPrecision(7)))).join(","));
  });
  return `${lines.join("\n")}\n`;
}

async function exportPanel(panel, kind) {
  await panel.draw();
  const name = `${panel.run.data.file}-${panel.spec.key}`;
  if (kind === "csv") {
    save(new Blob([csvOf(panel)], { type: "text/csv" }), `${name}.csv`);
    return;
  }
  const picture = panel.view.export(kind, true);
  save(await picture.to_blob(), `${name}.${kind}`);
}

/** Put a text where it can be pasted; where that is not allowed, it is selected. */
async function copyText(element, button) {
  const said = button.textContent;
  try {
    await navigator.clipboard.writeText(element.textContent);
    button.textContent = "Copied";
  } catch {
    getSelection().selectAllChildren(element);
    button.textContent = "Selected";
  }
  setTimeout(() => (button.textContent = said), 1500);
}
