// Computes the residuals of the report of `discover` without a browser: one per channel, with the
// parameter of the first slider at its found value or at a given value.
import { readFileSync } from "node:fs";

const [page, motion, playback, value] = process.argv.slice(2);
const text = readFileSync(page, "utf8");
const data = JSON.parse(text.match(/<script id="model" type="application\/json">(.*?)<\/script>/s)[1]);
const place = Number(text.match(/data-kind="parameter" data-place="(\d+)"/)[1]);
const script = [motion, playback].map((file) => readFileSync(file, "utf8")).join("");
const { Playback } = new Function(`"use strict";${script}return { Playback };`)();
const module = new WebAssembly.Module(Buffer.from(data.module, "base64"));
const moved = new Playback(data, new WebAssembly.Instance(module, {}).exports);
if (value !== "found") moved.machine.parameters[place] = Number(value);
moved.machine.prepare();
for (const _ of moved.follow());
console.log(JSON.stringify(moved.see()));
