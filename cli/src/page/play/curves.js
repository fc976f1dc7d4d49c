// Curves over the last seconds, a strip for each selected quantity.

/** Time span of the strips, s at the speed of the clock. */
const WINDOW = 10;
/** Maximum number of stored samples. */
const SAMPLES = 1200;

/** Stored samples of the motion. */
class Record {
  constructor() {
    this.clear();
  }

  clear() {
    this.times = [];
    this.rows = [];
  }

  /** Adds a sample; forgets what no strip shows. The last one gives way to the next as long as it is close to
   * the one before, so that it always is what is now. */
  add(t, row, span) {
    const last = this.times.length - 1;
    const crowded = last > 0 && t - this.times[last - 1] < span / SAMPLES;
    const place = crowded || this.times[last] === t ? last : last + 1;
    this.times[place] = t;
    this.rows[place] = row;
    const start = t - 1.05 * span;
    let gone = 0;
    while (gone < this.times.length - 2 && this.times[gone + 1] < start) gone += 1;
    if (gone > 100 || this.times.length > 2 * SAMPLES) {
      this.times.splice(0, gone);
      this.rows.splice(0, gone);
    }
  }
}

/** Returns an index of a colour for each place: its own one, or the first that no earlier place has. */
function distinctMarks(places, count) {
  const free = new Set(Array(count).keys());
  return places.map((place) => {
    const mark = free.has(place) ? place : (free.values().next().value ?? place % count);
    free.delete(mark);
    return mark;
  });
}

/** Draws the strips. `quantities`: symbol, unit, largest rounding error and index in a row of each. */
function drawCurves(canvas, record, quantities, t, span) {
  const { context, width, height } = cleared(canvas);
  const colour = colours();
  const [left, right, gap] = [64, 10, 22];
  const tall = (height - gap - 20) / Math.max(1, quantities.length);
  const start = Math.max(0, t - span);
  const across = (time) => left + ((time - start) / span) * (width - left - right);
  let first = record.times.findIndex((time) => time >= start);
  first = Math.max(0, first - 1);
  const marks = distinctMarks(quantities.map(({ place }) => place), colour.marks.length);
  for (const [strip, { symbol, unit, noise, place }] of quantities.entries()) {
    const [top, bottom] = [gap + strip * tall, (strip + 1) * tall];
    const values = record.rows.slice(first).map((row) => withoutNoise(row[place], noise));
    const [low, high] = ends(values);
    const up = (value) => bottom - ((value - low) / (high - low)) * (bottom - top);
    context.strokeStyle = colour.line;
    context.lineWidth = 1;
    context.beginPath();
    for (const y of [top, bottom]) {
      context.moveTo(left, Math.round(y) + 0.5);
      context.lineTo(width - right, Math.round(y) + 0.5);
    }
    if (low < 0 && high > 0) {
      context.moveTo(left, Math.round(up(0)) + 0.5);
      context.lineTo(width - right, Math.round(up(0)) + 0.5);
    }
    context.stroke();
    context.fillStyle = colour.soft;
    context.textAlign = "right";
    const scaled = multiple(Math.max(Math.abs(low), Math.abs(high)), unit);
    const [least, most] = endLabels(low / scaled.size, high / scaled.size);
    context.fillText(most, left - 8, top + 9, left - 10);
    context.fillText(least, left - 8, bottom, left - 10);
    context.textAlign = "left";
    context.fillStyle = colour.ink;
    const value = values.at(-1);
    const reading = value === undefined ? "" : ` = ${shown(value / scaled.size)} ${scaled.unit}`;
    writeSymbol(context, symbol, reading, [left, top - 6], width - left - right);
    context.save();
    context.beginPath();
    context.rect(left, top - 2, width - left - right, bottom - top + 4);
    context.clip();
    context.strokeStyle = colour.marks[marks[strip]];
    context.lineWidth = 2;
    context.beginPath();
    for (const [index, y] of values.entries()) {
      if (Number.isFinite(y)) context.lineTo(across(record.times[first + index]), up(y));
    }
    context.stroke();
    context.restore();
  }
  context.fillStyle = colour.soft;
  context.textAlign = "left";
  context.fillText(`${shown(start, 5)} s`, left, height - 6);
  context.textAlign = "right";
  context.fillText(`${shown(start + span, 5)} s`, width - right, height - 6);
}
