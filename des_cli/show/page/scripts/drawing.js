// The machine, moving: arm, fork, cab and seat by the chain of the run itself.

const SVG = "http://www.w3.org/2000/svg";

function times(a, b) {
  return a.map((row) => b[0].map((_, j) => row.reduce((sum, value, k) => sum + value * b[k][j], 0)));
}

function turned(angle) {
  const c = Math.cos(angle);
  const s = Math.sin(angle);
  return [[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]];
}

/** Return where a point of a frame is in the ground frame [m]. */
function placed(frame, [x, y, z]) {
  return [0, 1, 2].map((i) => frame[i][0] * x + frame[i][1] * y + frame[i][2] * z + frame[i][3]);
}

function pointing(frame, [x, y, z]) {
  return [0, 1, 2].map((i) => frame[i][0] * x + frame[i][1] * y + frame[i][2] * z);
}

/** Return the frames behind arm, fork, cab and seat: T = C0 R1 C1 R2 C2 R3 C3. */
function framesOf(chain, angles) {
  const [c0, c1, c2, c3] = chain.constants;
  const turn = (i) => turned(chain.signs[i] * angles[i]);
  const arm = c0;
  const fork = times(times(arm, turn(0)), c1);
  const cab = times(times(fork, turn(1)), c2);
  const seat = times(times(cab, turn(2)), c3);
  return { arm, fork, cab, seat };
}

/** A camera far away: it looks down at a slant, from a side that turns with a heading. */
function camera(heading, slant) {
  const [c, s] = [Math.cos(heading), Math.sin(heading)];
  const [k, l] = [Math.cos(slant), Math.sin(slant)];
  return ([x, y, z]) => {
    const across = -s * x + c * y;
    const away = c * x + s * y;
    return [across, -(k * z - l * away)];
  };
}

const PILOT = {
  seat: [[-0.34, 0, -0.1], [-0.28, 0, 0.72], [0.32, 0, 0.66], [0.42, 0, 1.15]],
  body: [[-0.16, 0, 0.16], [-0.16, 0, 0.6], [0.34, 0, 0.54], [0.46, 0, 1.02], [0.66, 0, 1.02]],
  arms: [[-0.14, 0, 0.28], [0.12, 0, 0.46], [0.4, 0, 0.36]],
  head: [0, 0, 0],
};
const BOX = { x: [-0.75, 1.0], y: [-0.6, 0.6], z: [-0.42, 1.35] };
const ARROW = 1.5; // length [m] of the longest G, and of the longest cross-coupling

/** One view of the machine; what it draws is made once and only moved after. */
class MachineSketch {
  constructor(svg, data, near) {
    this.svg = svg;
    this.data = data;
    this.near = near;
    this.ends = {};
    const arm = framesOf(data.chains.after, [0, 0, 0]);
    const reach = Math.hypot(arm.fork[0][3], arm.fork[1][3]);
    this.ring = 0.6 + Math.hypot(...[0, 1, 2].map((i) => arm.seat[i][3] - arm.cab[i][3]));
    const half = near ? this.reachOf(arm) : reach + this.ring + 0.6;
    const height = near ? half : 0.66 * half;
    svg.setAttribute("viewBox", `${-half} ${-height} ${2 * half} ${2 * height}`);
    this.unit = half / 160; // the width of a thin line
    this.parts = { before: this.make("ghost"), after: this.make("real") };
    this.largest = {
      g: this.peak(["gx", "gy", "gz"], "g"),
      c: this.peak(["c_x", "c_y", "c_z"], "turning"),
    };
  }

  /** Return how far box and arrows come from the gimbals' centre [m], however they turn. */
  reachOf(frames) {
    const centre = placed(frames.cab, [0, 0, 0]);
    const far = (point) => Math.hypot(...placed(frames.seat, point).map((value, i) => value - centre[i]));
    return 0.15 + Math.max(...boxLines().flat().map(far), far([0, 0, 0.25]) + ARROW);
  }

  /** Return the largest size of a vector, before or after. */
  peak(names, family) {
    const columns = this.data.family(family);
    let most = 0;
    for (const when of ["before", "after"]) {
      const parts = names.map((name) => columns[`${name}_${when}`]);
      for (let i = 0; i < columns.t.length; i++) most = Math.max(most, Math.hypot(...parts.map((part) => part[i])));
    }
    return most || 1;
  }

  make(kind) {
    const group = this.add("g", this.svg, { class: kind });
    const parts = {};
    for (const [name, width] of [
      ["floor", 1], ["column", 5], ["arm", 6], ["ring", 3], ["axis", 1.5], ["box", 1.2], ["seat", 3], ["body", 4], ["limbs", 3],
    ]) {
      parts[name] = this.add("path", group, { class: name, "stroke-width": width * this.unit });
    }
    parts.head = this.add("circle", group, { class: "head", r: 0.17 });
    for (const name of ["g", "c"]) {
      parts[name] = this.add("path", group, { class: `arrow ${name}`, "stroke-width": 3 * this.unit });
    }
    return parts;
  }

  add(tag, parent, attributes) {
    const element = document.createElementNS(SVG, tag);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    parent.append(element);
    return element;
  }

  /** Move the machine to a time [s]. */
  show(time) {
    for (const when of ["before", "after"]) this.pose(this.parts[when], when, time);
  }

  pose(parts, when, time) {
    const { data } = this;
    const at = (family, name) => data.at(family, `${name}_${when}`, time);
    const angles = ["arm", "fork", "cab"].map((joint) => (at("angle", joint) * Math.PI) / 180);
    const chain = data.chains[when];
    const frames = framesOf(chain, angles);
    const tip = placed(frames.fork, [0, 0, 0]);
    // Close by, the camera goes round with its own arm: what is compared is fork and cab.
    const heading = this.near ? Math.atan2(tip[1], tip[0]) + 0.6 : -0.5 * Math.PI + 0.35;
    const look = camera(heading, this.near ? 0.25 : 0.5);
    const centre = this.near ? look(tip) : look([0, 0, -0.6]);
    const project = (point) => look(point).map((value, i) => value - centre[i]);
    const draw = (name, lines) => {
      parts[name].setAttribute("d", lines.map((line) => `M${line.map((p) => project(p).map((v) => v.toFixed(3)).join(",")).join("L")}`).join(""));
    };
    const inside = (frame, points) => points.map((point) => placed(frame, point));
    if (!this.near) {
      draw("floor", [circle(([c, s]) => [c * Math.hypot(tip[0], tip[1]), s * Math.hypot(tip[0], tip[1]), -2.6])]);
      draw("column", [[[0, 0, -2.6], [0, 0, 0.3]]]);
    }
    const root = this.near ? tip.map((value, i) => (i < 2 ? value * 0.62 : value)) : [0, 0, tip[2]];
    const inner = this.toward(tip, root, this.ring);
    draw("arm", [[root, inner]]);
    const forkAxis = pointing(frames.fork, [0, 0, 1]);
    const cabAxis = pointing(frames.cab, [0, 0, 1]);
    const middle = placed(frames.cab, [0, 0, 0]);
    draw("ring", [circle(([c, s]) => middle.map((value, i) => value + this.ring * (c * forkAxis[i] + s * cabAxis[i])))]);
    draw("axis", [[-1, 1].map((side) => middle.map((value, i) => value + side * this.ring * cabAxis[i]))]);
    draw("box", boxLines().map((line) => inside(frames.seat, line)));
    draw("seat", [inside(frames.seat, PILOT.seat)]);
    draw("body", [inside(frames.seat, PILOT.body)]);
    draw("limbs", [inside(frames.seat, PILOT.arms)]);
    const head = project(placed(frames.seat, PILOT.head));
    parts.head.setAttribute("cx", head[0].toFixed(3));
    parts.head.setAttribute("cy", head[1].toFixed(3));
    // The way the pilot is pressed is against the push: +Gx backward, +Gy to the left, +Gz down.
    const g = [-at("g", "gx"), -at("g", "gy"), at("g", "gz")];
    const c = ["c_x", "c_y", "c_z"].map((name) => at("turning", name));
    for (const [name, vector] of [["g", g], ["c", c]]) {
      const scale = ARROW / this.largest[name];
      const from = placed(frames.seat, [0, 0, 0.25]);
      const along = pointing(frames.seat, vector);
      const to = from.map((value, i) => value + scale * along[i]);
      parts[name].setAttribute("d", arrow(project(from), project(to), 9 * this.unit));
    }
  }

  toward(from, to, distance) {
    const way = to.map((value, i) => value - from[i]);
    const length = Math.hypot(...way) || 1;
    return from.map((value, i) => value + (way[i] * Math.min(distance, length)) / length);
  }
}

function circle(point) {
  return Array.from({ length: 49 }, (_, i) => point([Math.cos((i * Math.PI) / 24), Math.sin((i * Math.PI) / 24)]));
}

function boxLines() {
  const corners = (x) => [0, 1, 3, 2, 0].map((k) => [BOX.x[x], BOX.y[k & 1], BOX.z[k >> 1]]);
  const edges = [0, 1, 2, 3].map((k) => [0, 1].map((x) => [BOX.x[x], BOX.y[k & 1], BOX.z[k >> 1]]));
  return [corners(0), corners(1), ...edges];
}

/** Return the path of an arrow; one that hardly has a length is a point. */
function arrow([x0, y0], [x1, y1], size) {
  const [dx, dy] = [x1 - x0, y1 - y0];
  const length = Math.hypot(dx, dy);
  if (length < 0.05) return `M${x0},${y0}h0`;
  const head = Math.min(size, 0.6 * length);
  const [ux, uy] = [dx / length, dy / length];
  const side = (sign) => `${x1 - head * ux - sign * 0.5 * head * uy},${y1 - head * uy + sign * 0.5 * head * ux}`;
  return `M${x0},${y0}L${x1},${y1}M${side(1)}L${x1},${y1}L${side(-1)}`;
}
