// Sliders for what was found, and what they do.

/** How long the page may compute before it lets the browser draw, in ms. */
const SLICE = 14;
/** How long a whole motion may take, in ms. */
const LONGEST_WAIT = 30000;

const model = JSON.parse(document.getElementById("model").textContent);
const element = (id) => document.getElementById(id);

/** Everything that changes while the page is open. */
class Page {
  constructor(motion) {
    this.playback = new Playback(model, motion);
    this.breaks = new Set(model.windows.map(({ first }) => first));
    this.canvas = element("strips");
    this.canvas.style.setProperty("--channels", model.channels.length);
    this.controls = Array.from(document.querySelectorAll("[data-kind]"));
    for (const control of this.controls) join(control, (value) => this.change(control.dataset, value));
    element("defaults").addEventListener("click", () => {
      for (const control of this.controls) control.reset();
    });
    const again = () => this.draw();
    addEventListener("resize", again);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", again);
    for (const [place, { left, unit }] of model.channels.entries()) this.write("before", place, left[0], unit);
    this.begin();
  }

  /** Sets a parameter, or a sensor's gain, bias or delay; without a value what was found. */
  change({ kind, place }, value) {
    const { motion, declared, channels } = this.playback;
    if (kind === "parameter") {
      motion.parameters[place] = value ?? declared[place];
      motion.change();
    } else {
      channels[place][kind] = value ?? model.channels[place][kind];
    }
    this.begin();
  }

  begin() {
    this.work = this.playback.follow();
    this.started = performance.now();
    if (!this.pending) this.later();
  }

  later() {
    this.pending = true;
    setTimeout(() => this.go(), 0);
  }

  /** Computes for a while; draws when all is there. */
  go() {
    this.pending = false;
    const deadline = performance.now() + SLICE;
    while (performance.now() < deadline) {
      if (this.work.next().done) {
        this.finish();
        return;
      }
    }
    if (performance.now() - this.started > LONGEST_WAIT) {
      say("status", "This motion is too fast for the simulation on this page.");
      return;
    }
    say("status", "Computing …");
    this.later();
  }

  finish() {
    const left = this.playback.see();
    for (const [place, value] of left.entries()) this.write("now", place, value, model.channels[place].unit);
    say("status", this.obstacle());
    this.draw();
  }

  /** Returns the reason for a stopped simulation, with the values that the reader changed. */
  obstacle() {
    const { motion } = this.playback;
    if (!motion.failed) return "";
    const changed = changedValues(this.controls);
    return `${changed ? `With ${changed} the` : "The"} simulation fails before its end: ${motion.reason}.`;
  }

  write(which, place, value, unit) {
    const cell = document.querySelectorAll(`[data-left=${which}]`)[place];
    const of = multiple(value, unit);
    cell.textContent = Number.isFinite(value) ? `${shown(value / of.size, 3)}\u00a0${of.unit}` : "–";
    cell.dataset.value = value;
  }

  draw() {
    drawStrips(this.canvas, this.playback.times, this.breaks, this.playback.channels);
  }
}

Motion.load(model.moving).then(
  (motion) => new Page(motion),
  (error) => {
    say("status", `This browser cannot run the model: ${error.message}`);
  },
);
