// Motion: functions of the module, and an explicit Runge-Kutta method of order 5 (Dormand and Prince,
// 1980) with step size control. A step ends at the first switching surface that it crosses.

const NODES = [0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1, 1];
const STAGES = [
  [],
  [1 / 5],
  [3 / 40, 9 / 40],
  [44 / 45, -56 / 15, 32 / 9],
  [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729],
  [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656],
  [35 / 384, 0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84],
];
/** Weights of the difference between the results of orders 5 and 4. */
const ERROR = [71 / 57600, 0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40];

const RELATIVE_TOLERANCE = 1e-7;
const ABSOLUTE_TOLERANCE = 1e-11;
/** Largest step size, in s. */
const LONGEST = 0.05;
/** Smallest step size, relative to the time or 1 s, whichever is larger. */
const SHORTEST = 1e-14;
/** Number of consecutive crossings after which the motion slides along a surface, and its step size then, in s. */
const CROSSINGS_IN_A_ROW = 16;
const SLIDING = 1e-4;
/** Accuracy of the location of a crossing, as a fraction of a step. */
const CROSSING = 1e-9;

/** Decodes base 64: a module, or the numbers of an array. */
function bytes(text) {
  return Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
}

/** Module with views of the arrays in its memory. */
class Machine {
  constructor(model, exports) {
    const array = (name, length) => new Float64Array(exports.memory.buffer, exports[name].value, length);
    this.exports = exports;
    this.parameters = array("parameters_at", model.parameters.length);
    this.inputs = array("inputs_at", model.inputs.length);
    this.state = array("state_at", model.state.length);
    this.rates = array("rates_at", model.state.length);
    this.observables = array("observables_at", model.observables.length);
    this.guards = array("guards_at", model.guards);
    this.usable = exports.prepare() === 1;
    /** Sets the inputs for a time. */
    this.drive = () => {};
  }

  /** Computes the coefficients after a change of parameters. */
  prepare() {
    this.usable = this.exports.prepare() === 1;
  }

  /** Writes the time derivative of a state to `rates`. */
  rate(t, state, rates) {
    this.drive(t);
    this.state.set(state);
    this.exports.rates(t);
    rates.set(this.rates);
  }

  /** Returns the observables of a state. */
  observe(t, state) {
    this.drive(t);
    this.state.set(state);
    this.exports.observables(t);
    return this.observables;
  }

  /** Returns the sides of all switching surfaces for a state. */
  sides(t, state) {
    if (this.guards.length === 0) return [];
    this.drive(t);
    this.state.set(state);
    this.exports.guards(t);
    return Array.from(this.guards, (value) => value > 0);
  }
}

/** Integration of a state. */
class Motion {
  constructor(machine, initial) {
    this.machine = machine;
    const vector = () => new Float64Array(initial.length);
    this.slopes = NODES.map(vector);
    [this.state, this.next, this.trial] = [vector(), vector(), vector()];
    this.restart(initial);
  }

  /** Restarts at a state and a time. */
  restart(initial, t = 0) {
    this.t = t;
    this.state.set(initial);
    this.switches = 0;
    this.inARow = 0;
    this.begin();
  }

  /** Starts a smooth piece at the current state, after a restart, a switch or an external change. */
  begin() {
    this.step = 1e-4;
    this.failed = !this.machine.usable;
    this.current = this.machine.sides(this.t, this.state);
    this.machine.rate(this.t, this.state, this.slopes[0]);
    if (!this.slopes[0].every(Number.isFinite)) this.failed = true;
  }

  /** Takes one step, at most to `end`. */
  advance(end) {
    const rest = end - this.t;
    if (this.inARow >= CROSSINGS_IN_A_ROW && !this.failed) {
      this.slide(Math.min(rest, SLIDING));
      return;
    }
    while (!this.failed) {
      // Avoid a very short last step.
      let h = Math.min(this.step, LONGEST);
      if (h > 0.9 * rest) h = rest;
      const error = this.attempt(h);
      if (error <= 1) {
        const whole = h === rest && h < this.step;
        if (!whole) this.step = h * Math.min(5, Math.max(0.2, 0.9 * error ** -0.2));
        this.accept(h);
        return;
      }
      this.step = h * (Number.isFinite(error) ? Math.max(0.1, 0.9 * error ** -0.2) : 0.1);
      if (this.step < SHORTEST * Math.max(1, this.t)) this.failed = true;
    }
  }

  /** Computes a step of size h from the state to `next`; returns its error relative to the tolerance. */
  attempt(h) {
    const { state, next, slopes, trial } = this;
    for (let stage = 1; stage < NODES.length; stage += 1) {
      const target = stage === NODES.length - 1 ? next : trial;
      for (let i = 0; i < state.length; i += 1) {
        let sum = 0;
        for (let k = 0; k < stage; k += 1) sum += STAGES[stage][k] * slopes[k][i];
        target[i] = state[i] + h * sum;
      }
      this.machine.rate(this.t + NODES[stage] * h, target, slopes[stage]);
    }
    let error = 0;
    for (let i = 0; i < state.length; i += 1) {
      let sum = 0;
      for (let k = 0; k < NODES.length; k += 1) sum += ERROR[k] * slopes[k][i];
      const size = Math.max(Math.abs(state[i]), Math.abs(next[i]));
      const ratio = Math.abs(h * sum) / (ABSOLUTE_TOLERANCE + RELATIVE_TOLERANCE * size);
      // The negated comparison also keeps NaN.
      if (!(ratio <= error)) error = ratio;
    }
    return error;
  }

  /** Accepts the step up to the first switching surface that it crosses. */
  accept(h) {
    const after = this.machine.sides(this.t + h, this.next);
    const crossed = after.some((side, place) => side !== this.current[place]);
    const length = crossed ? this.crossing(h) : h;
    if (length < h) this.attempt(length);
    this.t += length;
    this.state.set(this.next);
    this.inARow = crossed ? this.inARow + 1 : 0;
    if (crossed) {
      const [step, before] = [this.step, this.current];
      this.begin();
      this.step = Math.min(step, h);
      // The interpolation can locate a crossing too early; the next step then crosses.
      if (before.some((side, place) => side !== this.current[place])) this.switches += 1;
    } else {
      // The last stage is the first stage of the next step.
      const [first, last] = [0, NODES.length - 1];
      [this.slopes[first], this.slopes[last]] = [this.slopes[last], this.slopes[first]];
    }
  }

  /** Takes a step without location of crossings, for a motion that both sides of a surface drive back to it. */
  slide(h) {
    this.attempt(h);
    this.t += h;
    this.state.set(this.next);
    const side = this.current;
    this.begin();
    if (side.every((value, place) => value === this.current[place])) this.inARow = 0;
  }

  /** Returns the time from the start of a step to its first crossing, on the cubic through both ends. */
  crossing(h) {
    const { state, next, slopes, trial } = this;
    const [start, end] = [slopes[0], slopes[NODES.length - 1]];
    let [low, high] = [0, 1];
    while (high - low > CROSSING) {
      const s = (low + high) / 2;
      const [a, b, c, d] = [(1 + 2 * s) * (1 - s) ** 2, s * (1 - s) ** 2 * h, s * s * (3 - 2 * s), s * s * (s - 1) * h];
      for (let i = 0; i < state.length; i += 1) {
        trial[i] = a * state[i] + b * start[i] + c * next[i] + d * end[i];
      }
      const sides = this.machine.sides(this.t + s * h, trial);
      if (sides.some((side, place) => side !== this.current[place])) high = s;
      else low = s;
    }
    return high * h;
  }
}
