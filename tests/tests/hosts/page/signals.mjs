// Compares the rates of every form of an input with differences of its value. Prints the largest deviation.
import { readFileSync } from "node:fs";

const [script] = process.argv.slice(2);
const FORMS = new Function(`"use strict";${readFileSync(script, "utf8")}return FORMS;`)();
const numbers = { value: 0.7, change: 1.3, period: 0.9, rise: 0.8 };
const h = 1e-4;
let largest = 0;
const forms = Object.values(FORMS);
for (const form of forms) {
  for (let t = 0.05; t < 3; t += 0.0703) {
    const [before, now, after] = [t - h, t, t + h].map((at) => form(numbers, at));
    const rates = [(after[0] - before[0]) / (2 * h), (after[1] - before[1]) / (2 * h)];
    rates.forEach((rate, order) => {
      largest = Math.max(largest, Math.abs(rate - now[order + 1]));
    });
  }
}
console.log(JSON.stringify({ forms: forms.length, largest, end: FORMS.step(numbers, 9) }));
