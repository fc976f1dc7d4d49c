// Motion of one machine on its page, without a browser. The argument is a job as JSON; the answer is written as JSON.
import { readFileSync } from "node:fs";

const job = JSON.parse(readFileSync(process.argv[2], "utf8"));
const engine = readFileSync(new URL("../../../../sim/page/src/play/engine.js", import.meta.url), "utf8");
const { Motion } = new Function(`"use strict";${engine}return { Motion };`)();

/** Returns the numbers of an input for the engine if it is the product of an amplitude and sin(frequency*t). */
function sine(expression, place) {
  const [, amplitude, frequency] = expression.match(/^(\S+)\*sin\((\S+)\*t\)$/) ?? [];
  return frequency && [place, -1, -1, 1, 0, Number(amplitude), (2 * Math.PI) / Number(frequency), 1];
}

async function move() {
  const [, text] = readFileSync(job.page, "utf8").match(/<script id="model" type="application\/json">(.*?)<\/script>/s);
  const model = JSON.parse(text);
  const motion = await Motion.load(model.moving);
  const place = (name) => model.inputs.findIndex((input) => input.name === name);
  const held = job.inputs.filter((input) => input.samples.length > 0);
  const signals = job.inputs.filter((input) => input.samples.length === 0).map((input) => sine(input.expression, place(input.name)));
  if (!signals.every(Boolean)) return { rejected: "an input is a constant, a step or a sine" };
  if (signals.length > 0 && held.length > 0) return { rejected: "the study drives a page by functions or by samples" };
  const set = (sample) => {
    for (const input of held) motion.inputs[place(input.name)] = input.samples[sample];
  };
  if (signals.length > 0) motion.drive(signals);
  motion.inputs.set(model.inputs.map((input) => input.value));
  set(0);
  motion.start(job.initial, job.times[0]);
  const states = [];
  for (const [sample, time] of job.times.entries()) {
    if (sample > 0) motion.advance(time);
    if (motion.failed) return { rejected: motion.reason };
    states.push(Array.from(motion.state));
    if (sample > 0 && held.some((input) => input.samples[sample] !== input.samples[sample - 1])) {
      set(sample);
      motion.hold();
    }
  }
  return { states };
}

console.log(JSON.stringify(await move()));
