// The time of a run: one slider that moves every plot's cursor and the machine.

const STEP_KEYS = 200; // the slider's steps over the whole maneuver

class Clock {
  constructor(bar, start, duration) {
    this.bar = bar;
    this.first = start;
    this.last = start + duration;
    this.from = this.first;
    this.to = this.last;
    this.time = this.first;
    this.pointed = null;
    this.playing = false;
    this.listeners = [];
    this.slider = bar.querySelector("input[type=range]");
    this.output = bar.querySelector(".now");
    this.button = bar.querySelector(".play");
    this.speed = bar.querySelector("select");
    this.slider.min = this.first;
    this.slider.max = this.last;
    this.slider.step = duration / STEP_KEYS / 10;
    this.slider.addEventListener("input", () => this.set(Number(this.slider.value)));
    this.button.addEventListener("click", () => this.play(!this.playing));
    for (const [name, act] of Object.entries({
      in: () => this.scale(0.5, this.time),
      out: () => this.scale(2, this.time),
      all: () => this.zoom(this.first, this.last),
    })) {
      bar.querySelector(`[data-zoom=${name}]`).addEventListener("click", act);
    }
    this.tell();
  }

  /** The time that is shown: where the pointer is, else where the slider is. */
  get shown() {
    return this.pointed ?? this.time;
  }

  onChange(listener) {
    this.listeners.push(listener);
  }

  set(time) {
    this.time = Math.min(this.last, Math.max(this.first, time));
    this.pointed = null;
    this.tell();
  }

  point(time) {
    if (time === this.pointed) return;
    this.pointed = time;
    this.tell();
  }

  zoom(from, to) {
    const least = (this.last - this.first) / 2000;
    from = Math.max(this.first, from);
    to = Math.min(this.last, to);
    if (!(to - from >= least) || (from === this.from && to === this.to)) return;
    this.from = from;
    this.to = to;
    this.tell();
  }

  /** Show more or less time; what was at a time stays where it is. */
  scale(factor, about) {
    const whole = this.last - this.first;
    const width = Math.min(whole, (this.to - this.from) * factor);
    const share = (Math.min(this.to, Math.max(this.from, about)) - this.from) / (this.to - this.from);
    const from = Math.min(this.last - width, Math.max(this.first, about - share * width));
    this.zoom(from, from + width);
  }

  play(on) {
    this.playing = on;
    this.button.setAttribute("aria-pressed", String(on));
    this.button.querySelector("span").textContent = on ? "Pause" : "Play";
    if (!on) return;
    if (this.time >= this.to) this.set(this.from);
    let before = performance.now();
    const step = (now) => {
      if (!this.playing) return;
      const passed = (Math.min(now - before, 200) / 1000) * Number(this.speed.value);
      before = now;
      this.set(this.time + passed);
      if (this.time >= this.last) this.play(false);
      else requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }

  tell() {
    this.slider.value = this.time;
    const text = `${this.shown.toFixed(2)} s`;
    this.output.textContent = text;
    this.slider.setAttribute("aria-valuetext", text);
    this.bar.querySelector("[data-zoom=all]").disabled = this.from === this.first && this.to === this.last;
    for (const listener of this.listeners) listener();
  }
}
