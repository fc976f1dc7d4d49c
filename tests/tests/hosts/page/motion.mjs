// Integrates the motion of a page with its script and data, frame by frame, without a browser.
// Prints the final state and the number of switches.
import { readFileSync } from "node:fs";

const [page, script, end] = process.argv.slice(2);
const [, text] = readFileSync(page, "utf8").match(/<script id="model" type="application\/json">(.*?)<\/script>/s);
const model = JSON.parse(text);
const { Machine, Motion } = new Function(`"use strict";${readFileSync(script, "utf8")}return { Machine, Motion };`)();
const module = new WebAssembly.Module(Buffer.from(model.module, "base64"));
const machine = new Machine(model, new WebAssembly.Instance(module, {}).exports);
const motion = new Motion(machine, Float64Array.from(model.state, (quantity) => quantity.initial));
const frame = 1 / 60;
let steps = 0;
for (let turn = 1; motion.t < Number(end); turn += 1) {
  const target = Math.min(turn * frame, Number(end));
  while (motion.t < target) {
    motion.advance(target);
    steps += 1;
    if (motion.failed || steps > 1e6) throw new Error(`it stops at ${motion.t}`);
  }
}
console.log(JSON.stringify({ t: motion.t, state: Array.from(motion.state), switches: motion.switches, steps }));
