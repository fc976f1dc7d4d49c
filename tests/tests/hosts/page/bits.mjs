// Runs a module at points: reads module.wasm and points.bin, writes results.bin, all numbers f64.
// A point is parameters, t, state, inputs; its results are the validity of the coefficients,
// rates, observables, guards.
import { readFileSync, writeFileSync } from "node:fs";

/** Address of the module's numbers, after those of other modules. */
const BASE = 4096;

const [folder, ...counts] = process.argv.slice(2);
const [parameters, states, inputs, observables, guards] = counts.map(Number);
const module = new WebAssembly.Module(readFileSync(`${folder}/module.wasm`));
const imported = WebAssembly.Module.imports(module).map(({ module: from, name }) => `${from}.${name}`);
if (imported.join() !== "host.memory,host.base") throw new Error(`it imports ${imported}`);
const memory = new WebAssembly.Memory({ initial: 1024 });
const before = new Float64Array(memory.buffer).fill(NaN);
const { exports } = new WebAssembly.Instance(module, { host: { memory, base: BASE } });
const bytes = readFileSync(`${folder}/points.bin`);
const points = new Float64Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
const at = (place, length) => new Float64Array(memory.buffer, BASE + exports[place].value, length);

const defaults = Float64Array.from(at("parameters_at", parameters));
const results = [...defaults];
const width = parameters + 1 + states + inputs;
for (let start = 0; start < points.length; start += width) {
  let from = start;
  const take = (length) => points.subarray(from, (from += length));
  at("parameters_at", parameters).set(take(parameters));
  const usable = exports.prepare();
  const [t] = take(1);
  at("state_at", states).set(take(states));
  at("inputs_at", inputs).set(take(inputs));
  exports.rates(t);
  exports.observables(t);
  exports.guards?.(t);
  results.push(usable, ...at("rates_at", states), ...at("observables_at", observables), ...at("guards_at", guards));
}
const end = (BASE + exports.size.value) / 8;
const outside = [before.subarray(0, BASE / 8), before.subarray(end)];
if (!outside.every((numbers) => numbers.every(Number.isNaN))) throw new Error("it writes outside its part of the memory");
writeFileSync(`${folder}/results.bin`, new Uint8Array(new Float64Array(results).buffer));
