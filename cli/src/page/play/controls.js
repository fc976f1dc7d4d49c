// Controls, clock and frame loop of the page.

/** Longest computation per frame, ms. */
const BUDGET = 11;
/** Number of parts of a frame after each of which the motion is shown. */
const PARTS = 8;
/** Duration of a frame with this number of parts, s. */
const SHORT_FRAME = 1 / 60;
/** Longest time between frames that the clock follows, s; a hidden page has longer ones. */
const LONGEST_FRAME = 0.1;

/** Time for which a change of the initial state is noted, s. */
const NOTED = 3;

/** Number of digits of a number in a message. */
const MESSAGE_DIGITS = 4;

/** Returns a message of the engine with rounded numbers and without backticks. */
function readable(message) {
  return message.replaceAll("`", "").replace(/\d+\.\d+(e-?\d+)?/g, (text) => shown(Number(text), MESSAGE_DIGITS));
}

const model = JSON.parse(document.getElementById("model").textContent);
const element = (id) => document.getElementById(id);
const [drawingCanvas, curvesCanvas] = [element("drawing"), element("curves")];

/** State of the page. */
class Page {
  constructor(motion) {
    this.motion = motion;
    const driven = () => {
      this.drive();
      this.remember();
    };
    this.signals = Array.from(
      document.querySelectorAll("[data-signal]"),
      (signal) => new Signal(signal, model.inputs[signal.dataset.place].value, driven),
    );
    this.initial = Float64Array.from(model.state, (quantity) => quantity.initial);
    this.start();
    this.picture = model.drawing ? new Plane(model) : new Instruments(model);
    this.record = new Record();
    this.playing = !matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.pace = 1;
    this.parts = PARTS;
    this.last = null;
    /** Whether the page must be redrawn although the time is unchanged. */
    this.stale = true;
    this.listen();
    this.remember();
    this.label();
    requestAnimationFrame((now) => this.frame(now));
  }

  get speed() {
    return 10 ** Number(element("speed").value);
  }

  /** Number of decimals of the clock. */
  get decimals() {
    return this.speed < 0.05 ? Math.max(5, 2 - Math.floor(Math.log10(this.speed))) : 2;
  }

  get span() {
    return WINDOW * this.speed;
  }

  listen() {
    element("play").addEventListener("click", () => {
      this.playing = !this.playing;
      this.label();
    });
    element("reset").addEventListener("click", () => this.restart());
    element("defaults").addEventListener("click", () => {
      for (const control of this.controls) control.reset();
      for (const signal of this.signals) signal.reset();
      this.restart();
    });
    element("speed").addEventListener("input", () => this.label());
    const stale = () => {
      this.stale = true;
    };
    element("shown").addEventListener("change", stale);
    addEventListener("resize", stale);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", stale);
    this.controls = Array.from(document.querySelectorAll("[data-kind]")).filter((one) => !one.closest("[data-signal]"));
    for (const control of this.controls) this.connect(control);
  }

  /** Connects a control to the model. */
  connect(control) {
    const { kind, place } = control.dataset;
    join(control, (value) => this.change(kind, Number(place), value));
  }

  /** Sets a number of the model; the default is the specification's value. */
  change(kind, place, value) {
    if (kind === "parameter") {
      this.motion.parameters[place] = value ?? model.parameters[place];
      this.motion.change();
      this.remember();
    } else {
      this.initial[place] = value ?? model.state[place].initial;
      this.restart();
    }
  }

  /** Starts at the initial state. */
  start() {
    this.drive();
    this.motion.start(this.initial);
  }

  drive() {
    this.motion.drive(this.signals.map(({ numbers }) => numbers));
  }

  restart() {
    this.start();
    this.picture.clear();
    this.record.clear();
    this.remember();
  }

  /** Passes the current state to drawing and curves. */
  remember() {
    this.stale = true;
    const { t, state, observables } = this.motion;
    this.picture.follow(state, observables);
    this.record.add(t, Float64Array.of(...state, ...observables), this.span);
  }

  frame(now) {
    const passed = this.last === null ? 0 : Math.min((now - this.last) / 1000, LONGEST_FRAME);
    this.last = now;
    if (this.playing && passed > 0) this.move(passed);
    if (this.stale) this.draw();
    requestAnimationFrame((next) => this.frame(next));
  }

  /** Advances by the elapsed time, or as far as the time of a frame allows. */
  move(passed) {
    const { motion } = this;
    if (motion.failed) return;
    const [start, end] = [motion.t, motion.t + passed * this.speed];
    let now = performance.now();
    const deadline = now + BUDGET;
    // A long frame has more parts, so the distance between shown points does not depend on the frame rate.
    const frames = Math.max(1, passed / SHORT_FRAME);
    while (motion.t < end && !motion.failed && now < deadline) {
      motion.advance(Math.min(end, motion.t + (end - start) / (this.parts * frames)));
      this.remember();
      // A part takes a small part of the budget.
      const before = now;
      now = performance.now();
      if (now - before > BUDGET / 2) this.parts *= 2;
      else if (now - before < BUDGET / 16 && this.parts > PARTS) this.parts /= 2;
    }
    const pace = (motion.t - start) / passed;
    this.pace += 0.1 * (pace / this.speed - this.pace);
  }

  draw() {
    this.stale = false;
    this.picture.draw(drawingCanvas);
    drawCurves(curvesCanvas, this.record, this.ticked(), this.motion.t, this.span);
    element("clock").textContent = `${this.motion.t.toFixed(this.decimals)} s`;
    say("status", this.obstacle());
    say("note", this.note());
  }

  ticked() {
    const places = Array.from(document.querySelectorAll("#shown input:checked"), (box) => Number(box.value));
    const all = [...model.state, ...model.observables];
    return places.map((place) => ({ ...all[place], place }));
  }

  /** Returns the reason for a stopped motion, with the values that the reader changed. */
  obstacle() {
    if (!this.motion.failed) return "";
    const inputs = this.signals.flatMap((signal) => signal.controls);
    const changed = changedValues([...this.controls, ...inputs]);
    return `There is no motion from here on${changed && ` with ${changed}`}: ${readable(this.motion.reason)}.`;
  }

  /** Updates the status and the clock. */
  note() {
    if (this.playing && !this.motion.failed && this.pace < 0.8) return `Slower than selected: ${shown(this.pace * this.speed, 2)} s per second.`;
    if (this.motion.moved && this.motion.t < NOTED) return "The initial state was moved onto the constraints.";
    return this.motion.events > 0 ? `Events: ${this.motion.events}.` : "";
  }

  label() {
    this.stale = true;
    element("play").textContent = this.playing ? "Pause" : "Play";
    const text = `${shown(this.speed, 2)} ×`;
    element("speed-value").textContent = text;
    element("speed").setAttribute("aria-valuetext", `${text} real time`);
  }
}

Motion.load(model.moving).then(
  (motion) => new Page(motion),
  (error) => {
    say("status", `This browser does not run the model: ${error.message}`);
  },
);
