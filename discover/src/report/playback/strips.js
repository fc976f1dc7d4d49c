// For every channel what was measured with the simulations over it, and below, what they are off.

/** A strip of a canvas over time: where its numbers stand. */
class Strip {
  constructor(context, { left, right, top, bottom }, [start, end], [low, high]) {
    Object.assign(this, { context, left, right, top, bottom, low, high });
    this.across = (t) => left + ((t - start) / (end - start || 1)) * (right - left);
    this.up = (value) => bottom - ((value - low) / (high - low || 1)) * (bottom - top);
  }

  frame(colour, symbol, text, unit) {
    const { context, left, right, top, bottom, low, high } = this;
    const of = multiple(Math.max(Math.abs(low), Math.abs(high)), unit);
    const title = of.unit === "" ? text : `${text} [${of.unit}]`;
    context.strokeStyle = colour.line;
    context.lineWidth = 1;
    context.beginPath();
    for (const y of [top, bottom, low < 0 && high > 0 ? this.up(0) : bottom]) {
      context.moveTo(left, Math.round(y) + 0.5);
      context.lineTo(right, Math.round(y) + 0.5);
    }
    context.stroke();
    context.fillStyle = colour.soft;
    context.textAlign = "right";
    const [least, most] = endLabels(low / of.size, high / of.size);
    context.fillText(most, left - 6, top + 10, left - 8);
    context.fillText(least, left - 6, bottom, left - 8);
    context.textAlign = "left";
    context.fillStyle = colour.ink;
    writeSymbol(context, symbol, title, [left, top - 6], right - left);
  }

  /** A curve, which ends where a window ends or a number is missing. */
  curve(times, values, breaks, style, width) {
    const { context, left, right, top, bottom } = this;
    context.save();
    context.beginPath();
    context.rect(left, top - 1, right - left, bottom - top + 2);
    context.clip();
    context.strokeStyle = style;
    context.lineWidth = width;
    context.beginPath();
    let pen = false;
    for (const [place, value] of values.entries()) {
      if (breaks.has(place)) pen = false;
      if (!Number.isFinite(value)) pen = false;
      else if (pen) context.lineTo(this.across(times[place]), this.up(value));
      else context.moveTo(this.across(times[place]), this.up(value));
      pen = Number.isFinite(value);
    }
    context.stroke();
    context.restore();
  }
}

/** Draws all channels. Of each: `symbol`, `unit` and the columns `measured`, `before` and `now`. */
function drawStrips(canvas, times, breaks, channels) {
  const { context, width, height } = cleared(canvas);
  const colour = colours();
  const [left, right] = [62, width - 6];
  const tall = (height - 18) / channels.length;
  const span = [times[0], times.at(-1)];
  for (const [place, { symbol, unit, measured, before, now }] of channels.entries()) {
    const top = place * tall;
    const less = (column) => column.map((value, sample) => value - measured[sample]);
    const motion = { left, right, top: top + 20, bottom: top + 0.58 * tall };
    const both = new Strip(context, motion, span, ends([...measured, ...before]));
    both.frame(colour, symbol, "", unit);
    both.curve(times, measured, breaks, colour.soft, 5);
    both.curve(times, before, breaks, colour.marks[1], 1.6);
    both.curve(times, now, breaks, colour.marks[0], 1.6);
    const [first, second] = [less(before), less(now)];
    const off = new Strip(context, { left, right, top: top + 0.58 * tall + 28, bottom: top + tall - 10 }, span, ends([...first, 0]));
    off.frame(colour, symbol, ": simulated minus measured", unit);
    off.curve(times, first, breaks, colour.marks[1], 1.4);
    off.curve(times, second, breaks, colour.marks[0], 1.4);
  }
  context.fillStyle = colour.soft;
  context.textAlign = "left";
  context.fillText(`${shown(span[0], 5)} s`, left, height - 4);
  context.textAlign = "right";
  context.fillText(`${shown(span[1], 5)} s`, right, height - 4);
}
