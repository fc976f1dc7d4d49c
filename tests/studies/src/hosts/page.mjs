// Motion of one machine on its page, without a browser. The argument is a job as JSON; the answer is written as JSON.
import { readFileSync } from "node:fs";

const job = JSON.parse(readFileSync(process.argv[2], "utf8"));
const [, text] = readFileSync(job.page, "utf8").match(/<script id="model" type="application\/json">(.*?)<\/script>/s);
const { Motion } = new Function(`"use strict";${readFileSync(job.script, "utf8")}return { Motion };`)();
const motion = await Motion.load(JSON.parse(text).moving);

/** Numbers of a signal: no rates, form sine, middle, amplitude, period. */
function signal({ place, sine: [amplitude, frequency] }) {
  return [place, -1, -1, 1, 0, amplitude, (2 * Math.PI) / frequency, 1];
}

const sines = job.inputs.filter((input) => input.sine);
const held = job.inputs.filter((input) => !input.sine);

function write(sample) {
  motion.inputs.set(job.default_inputs);
  for (const { place, samples } of held) motion.inputs[place] = samples[sample];
}

const states = [];
if (sines.length > 0) motion.drive(sines.map(signal));
else write(0);
motion.start(Float64Array.from(job.initial));
for (const [sample, time] of job.times.entries()) {
  if (sample > 0) motion.advance(time);
  if (motion.failed) break;
  states.push(Array.from(motion.state));
  if (held.length > 0) {
    write(sample);
    motion.hold();
  }
}
console.log(JSON.stringify(motion.failed ? { rejected: motion.reason } : { states }));
