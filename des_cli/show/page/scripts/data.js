// The numbers of a run: read from the page when they are first needed.

/** Return the 32-bit floats that a base64 text holds, the lowest byte first. */
function unpack(text) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const view = new DataView(bytes.buffer);
  return Float64Array.from({ length: bytes.length / 4 }, (_, i) => view.getFloat32(4 * i, true));
}

/** The curves of a run. Curves of one family share their times. */
class RunData {
  constructor(anchor) {
    const content = JSON.parse(document.getElementById(`${anchor}-data`).textContent);
    Object.assign(this, content); // name, start, duration, panels, chains, packed
    this.families = new Map();
  }

  /** Return a family: t [s] and its columns. */
  family(name) {
    if (!this.families.has(name)) {
      const columns = {};
      for (const [key, text] of Object.entries(this.packed[name])) columns[key] = unpack(text);
      columns.t = columns.t.map((t) => t + this.start);
      this.families.set(name, columns);
    }
    return this.families.get(name);
  }

  /** Return a column at a time [s], linear between its rows. */
  at(family, column, time) {
    const { t, [column]: values } = this.family(family);
    const i = rowBefore(t, time);
    const step = t[i + 1] - t[i];
    const share = step > 0 ? Math.min(1, Math.max(0, (time - t[i]) / step)) : 0;
    return values[i] + share * (values[i + 1] - values[i]);
  }
}

/** Return the last row but one that is not after a time: there is always a row behind it. */
function rowBefore(t, time) {
  let low = 0;
  let high = t.length - 2;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (t[middle] <= time) low = middle;
    else high = middle - 1;
  }
  return low;
}

/** Write a number as a person reads it: three digits that count, and a true minus. */
function written(value, digits = 3) {
  if (!Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  const text =
    size !== 0 && (size < 1e-3 || size >= 1e5) ? value.toExponential(digits - 2) : String(Number(value.toPrecision(digits)));
  return text.replace("-", "−");
}
