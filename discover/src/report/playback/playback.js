// The motion along the record, for every value of what was found.

/** Numbers that are written in base 64. */
const numbers = (text) => new Float64Array(bytes(text).buffer);

/** One column of rows. */
const column = (rows, place, count) => rows.filter((_, number) => number % count === place);

/** A sensor's quantity at a time near a sample, by the cubic through its four neighbours. */
function interpolated(times, values, at, near) {
  let before = near;
  while (before > 0 && times[before] > at) before -= 1;
  while (before < times.length - 1 && times[before + 1] <= at) before += 1;
  const count = Math.min(times.length, 4);
  const first = Math.min(Math.max(0, before - 1), times.length - count);
  let sum = 0;
  for (let i = first; i < first + count; i += 1) {
    let weight = 1;
    for (let j = first; j < first + count; j += 1) if (j !== i) weight *= (at - times[j]) / (times[i] - times[j]);
    sum += weight * values[i];
  }
  return sum;
}

/** The motion along the record, window by window. */
class Playback {
  constructor(data, motion) {
    this.windows = data.windows;
    this.times = numbers(data.times);
    this.driven = numbers(data.driven);
    const count = data.channels.length;
    const [measured, before] = [numbers(data.measured), numbers(data.before)];
    this.channels = data.channels.map((channel, place) => ({
      ...channel,
      measured: column(measured, place, count),
      before: column(before, place, count),
      quantity: new Float64Array(this.times.length),
      now: new Float64Array(this.times.length),
    }));
    this.declared = data.parameters;
    this.motion = motion;
  }

  /** Follows all windows; yields after every sample, so that the page stays alive. */
  *follow() {
    for (const channel of this.channels) channel.quantity.fill(NaN);
    const inputs = this.motion.inputs.length;
    for (const { first, samples, initial } of this.windows) {
      for (let sample = first; sample < first + samples; sample += 1) {
        const t = this.times[sample];
        const { motion } = this;
        if (sample > first) motion.advance(t);
        motion.inputs.set(this.driven.subarray(sample * inputs, (sample + 1) * inputs));
        if (sample === first) motion.start(initial, t);
        else if (inputs > 0) motion.hold();
        if (motion.failed) return;
        this.read(sample);
        yield;
      }
    }
  }

  read(sample) {
    const { state, observables } = this.motion;
    for (const channel of this.channels) {
      const { state: place, observable } = channel.from;
      channel.quantity[sample] = place === undefined ? observables[observable] : state[place];
    }
  }

  /** What the sensors show of the quantities; what is left of each channel, where they are compared. */
  see() {
    return this.channels.map((channel) => {
      const { gain, bias, delay, quantity, now, measured } = channel;
      let [sum, count] = [0, 0];
      for (const { first, samples, judged } of this.windows) {
        const [times, values] = [this.times, quantity].map((all) => all.subarray(first, first + samples));
        for (let sample = 0; sample < samples; sample += 1) {
          const value = delay === 0 ? values[sample] : interpolated(times, values, times[sample] - delay, sample);
          const compared = sample >= judged[0] && sample < judged[1];
          const seen = gain * value + bias;
          now[first + sample] = compared ? seen : NaN;
          if (!Number.isFinite(measured[first + sample])) continue;
          count += 1;
          if (compared) sum += (seen - measured[first + sample]) ** 2;
        }
      }
      return Math.sqrt(sum / Math.max(1, count));
    });
  }
}
