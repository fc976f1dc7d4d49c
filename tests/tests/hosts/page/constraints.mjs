// Projects a state of a page onto the constraints, twice. Prints the outcomes and the state.
import { readFileSync } from "node:fs";

const [page, motion, constraints, given] = process.argv.slice(2);
const [, text] = readFileSync(page, "utf8").match(/<script id="model" type="application\/json">(.*?)<\/script>/s);
const model = JSON.parse(text);
const parts = [motion, constraints].map((script) => readFileSync(script, "utf8")).join("");
const { Machine, project } = new Function("model", `"use strict";${parts}return { Machine, project };`)(model);
const module = new WebAssembly.Module(Buffer.from(model.module, "base64"));
const machine = new Machine(model, new WebAssembly.Instance(module, {}).exports);
const state = Float64Array.from(JSON.parse(given));
const outcomes = [0, 1].map(() => project(machine, model.stabilisation, 0, state));
console.log(JSON.stringify({ outcomes, state: Array.from(state) }));
