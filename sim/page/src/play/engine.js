// Motion by the engine: the solvers of `eomgen simulate` as a WebAssembly module. The emitted modules of the model's
// programs share its memory.

/** Decodes base 64. */
function bytes(text) {
  return Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
}

/** Expands bytes that are compressed with gzip and encoded in base 64. */
async function expanded(text) {
  const stream = new Blob([bytes(text)]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Arrays of an emitted module, in the order of the engine. */
const ARRAYS = ["parameters_at", "inputs_at", "state_at", "rates_at", "observables_at", "guards_at"];

/** Outcomes of the engine's calls. */
const [MOVED, STOPPED] = [1, 2];

/** A motion of the model: state and observables at the time reached. */
class Motion {
  /** `moving`: engine, model and modules of a page. */
  static async load(moving) {
    const modules = [];
    const call = (name) => (place, t) => modules[place][name](t);
    const host = Object.fromEntries(["prepare", "rates", "observables", "guards"].map((name) => [name, call(name)]));
    host.prepare = (place) => {
      modules[place].prepare();
    };
    const { instance } = await WebAssembly.instantiate(await expanded(moving.engine), { host });
    const engine = instance.exports;
    const addresses = [];
    for (const { module, size } of moving.modules) {
      const base = engine.reserve(size);
      const imports = { host: { memory: engine.memory, base } };
      const { instance: emitted } = await WebAssembly.instantiate(await expanded(module), imports);
      modules.push(emitted.exports);
      addresses.push(...ARRAYS.map((name) => base + emitted.exports[name].value));
    }
    const model = await expanded(moving.model);
    const at = engine.reserve(model.length);
    new Uint8Array(engine.memory.buffer, at, model.length).set(model);
    const handle = engine.create(at, model.length, moving.tolerance);
    if (handle === 0) throw new Error("the model is damaged");
    const places = engine.reserve(4 * addresses.length);
    new Uint32Array(engine.memory.buffer, places, addresses.length).set(addresses);
    engine.attach(handle, places);
    return new Motion(engine, handle, moving.counts);
  }

  constructor(engine, handle, counts) {
    this.engine = engine;
    this.handle = handle;
    this.counts = counts;
    /** Whether the last start or change of a parameter moved the state onto the constraints. */
    this.moved = false;
    this.failed = false;
  }

  /** Returns numbers in the memory; a later call may move them. */
  numbers(name, length) {
    return new Float64Array(this.engine.memory.buffer, this.engine[name](this.handle), length);
  }

  get parameters() {
    return this.numbers("parameters_at", this.counts.parameters);
  }

  get inputs() {
    return this.numbers("inputs_at", this.counts.inputs);
  }

  get state() {
    return this.numbers("state_at", this.counts.states);
  }

  get observables() {
    return this.numbers("observables_at", this.counts.observables);
  }

  get t() {
    return this.engine.time(this.handle);
  }

  /** Number of events since the start. */
  get events() {
    return this.engine.event_count(this.handle);
  }

  /** Why the motion ended or cannot start; empty if it continues. */
  get reason() {
    const [at, length] = [this.engine.reason_at(this.handle), this.engine.reason_length(this.handle)];
    return new TextDecoder().decode(new Uint8Array(this.engine.memory.buffer, at, length));
  }

  settle(status) {
    this.failed = status === STOPPED;
    return status;
  }

  /** Starts at a state and a time, with the inputs. */
  start(initial, t = 0) {
    this.state.set(initial);
    this.moved = this.settle(this.engine.start(this.handle, t)) === MOVED;
  }

  /** Continues with the parameters. */
  change() {
    this.moved = this.settle(this.engine.set_parameters(this.handle)) === MOVED;
  }

  /** Continues with the inputs, held from now on. */
  hold() {
    this.settle(this.engine.hold(this.handle));
  }

  /** Continues with inputs over time, eight numbers for each. */
  drive(signals) {
    this.numbers("signals_at", signals.length * 8).set(signals.flat());
    this.settle(this.engine.drive(this.handle, signals.length));
  }

  /** Continues to a time. */
  advance(end) {
    this.settle(this.engine.advance(this.handle, end));
  }
}
