// Moves the model of a page with its script and data, frame by frame, without a browser. Prints the time, state and
// observables at each of the given times, and the outcome.
import { readFileSync } from "node:fs";

const [page, script, asked] = process.argv.slice(2);
const [, text] = readFileSync(page, "utf8").match(/<script id="model" type="application\/json">(.*?)<\/script>/s);
const model = JSON.parse(text);
const { Motion } = new Function(`"use strict";${readFileSync(script, "utf8")}return { Motion };`)();
/** `times`: of the rows, s. `signals`: of the inputs; `parameters`: changes by index, each with its time. */
const { times, signals, parameters = [], initial } = JSON.parse(asked);
const motion = await Motion.load(model.moving);
motion.drive(signals);
motion.start(Float64Array.from(initial ?? model.state.map((quantity) => quantity.initial)));
const moved = motion.moved;
const frame = 1 / 60;
const rows = [];
const changes = [...parameters];
const begin = performance.now();
for (const time of times) {
  while (motion.t < time && !motion.failed) {
    const next = changes[0]?.time ?? Infinity;
    motion.advance(Math.min(motion.t + frame, time, next));
    if (motion.t >= next) {
      motion.parameters[changes[0].place] = changes[0].value;
      motion.change();
      changes.shift();
    }
  }
  rows.push({ t: motion.t, state: Array.from(motion.state), observables: Array.from(motion.observables) });
}
const seconds = (performance.now() - begin) / 1000;
console.log(JSON.stringify({ rows, moved, events: motion.events, reason: motion.reason, seconds }));
