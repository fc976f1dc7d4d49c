// Runs a module at points: reads module.wasm and points.bin, writes results.bin, all numbers f64.
// A point is parameters, t, state, inputs; its results are the validity of the coefficients,
// rates, observables, guards.
import { readFileSync, writeFileSync } from "node:fs";

const [folder, ...counts] = process.argv.slice(2);
const [parameters, states, inputs, observables, guards] = counts.map(Number);
const module = new WebAssembly.Module(readFileSync(`${folder}/module.wasm`));
if (WebAssembly.Module.imports(module).length > 0) throw new Error("it imports something");
const { exports } = new WebAssembly.Instance(module, {});
const bytes = readFileSync(`${folder}/points.bin`);
const points = new Float64Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
const at = (place, length) => new Float64Array(exports.memory.buffer, exports[place].value, length);

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
writeFileSync(`${folder}/results.bin`, new Uint8Array(new Float64Array(results).buffer));
