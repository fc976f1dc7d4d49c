// Computes the residuals of the report of `discover` without a browser: one per channel, with the
// parameter of the first slider at its found value or at a given value.
import { readFileSync } from "node:fs";

const [page, engine, playback, value] = process.argv.slice(2);
const text = readFileSync(page, "utf8");
const data = JSON.parse(text.match(/<script id="model" type="application\/json">(.*?)<\/script>/s)[1]);
const place = Number(text.match(/data-kind="parameter" data-place="(\d+)"/)[1]);
const script = [engine, playback].map((file) => readFileSync(file, "utf8")).join("");
const { Motion, Playback } = new Function(`"use strict";${script}return { Motion, Playback };`)();
const motion = await Motion.load(data.moving);
const moved = new Playback(data, motion);
if (value !== "found") {
  motion.parameters[place] = Number(value);
  motion.change();
}
for (const _ of moved.follow());
console.log(JSON.stringify(moved.see()));
