// Drawing of the machine: points and lines if the specification has a drawing, else an instrument for every
// coordinate.

/** Length of a trail, in frames. */
const TRAIL = 400;

/** Points and lines in a plane. */
class Plane {
  constructor(model) {
    this.drawing = model.drawing;
    this.clear();
  }

  clear() {
    this.bounds = null;
    this.trails = this.drawing.points.map(() => []);
  }

  place(point, state, observables) {
    const ordinate = (of) => of.number ?? (of.state === undefined ? observables[of.observable] : state[of.state]);
    return [ordinate(point.x), ordinate(point.y)];
  }

  /** Extends the visible range to the points. */
  follow(state, observables) {
    this.places = this.drawing.points.map((point) => this.place(point, state, observables));
    for (const [x, y] of this.places) {
      if (!Number.isFinite(x) || !Number.isFinite(y)) continue;
      const bounds = this.bounds ?? [x, x, y, y];
      this.bounds = [Math.min(bounds[0], x), Math.max(bounds[1], x), Math.min(bounds[2], y), Math.max(bounds[3], y)];
    }
  }

  /** Appends a point per frame to the trails. */
  leave() {
    for (const [index, [x, y]] of this.places.entries()) {
      const trail = this.trails[index];
      if (Number.isFinite(x) && Number.isFinite(y)) trail.push([x, y]);
      if (trail.length > TRAIL) trail.shift();
    }
  }

  draw(canvas) {
    const { context, width, height } = cleared(canvas);
    if (!this.bounds) return;
    this.leave();
    const colour = colours();
    const [left, right, low, high] = this.bounds;
    // Margin on all sides of the visited range.
    const reach = Math.max(right - left, high - low, 1e-9);
    const [wide, tall] = [Math.max(right - left, 0.6 * reach), Math.max(high - low, 0.6 * reach)];
    const margin = 34;
    const scale = Math.min((width - 2 * margin) / wide, (height - 2 * margin) / tall);
    const onto = ([x, y]) => [
      width / 2 + (x - (left + right) / 2) * scale,
      height / 2 - (y - (low + high) / 2) * scale,
    ];
    this.grid(context, { width, height, scale, onto, colour });
    for (const [index, trail] of this.trails.entries()) this.trail(context, trail, onto, colour, index);
    context.strokeStyle = colour.ink;
    context.lineWidth = 5;
    for (const line of this.drawing.lines) {
      context.beginPath();
      for (const point of line) context.lineTo(...onto(this.places[point]));
      context.stroke();
    }
    for (const [index, place] of this.places.entries()) {
      const [x, y] = onto(place);
      const { x: across, y: up } = this.drawing.points[index];
      const fixed = across.number !== undefined && up.number !== undefined;
      context.beginPath();
      context.arc(x, y, fixed ? 4 : 7, 0, 2 * Math.PI);
      context.fillStyle = fixed ? colour.soft : colour.marks[(index - 1) % colour.marks.length];
      context.fill();
    }
  }

  /** Draws grid lines at round distances. Returns the distance. */
  grid(context, { width, height, scale, onto, colour }) {
    const step = round(70 / scale);
    const [x0, y0] = onto([0, 0]);
    context.strokeStyle = colour.line;
    context.lineWidth = 1;
    context.beginPath();
    for (let x = x0 % (step * scale); x < width; x += step * scale) {
      context.moveTo(Math.round(x) + 0.5, 0);
      context.lineTo(Math.round(x) + 0.5, height);
    }
    for (let y = y0 % (step * scale); y < height; y += step * scale) {
      context.moveTo(0, Math.round(y) + 0.5);
      context.lineTo(width, Math.round(y) + 0.5);
    }
    context.stroke();
    context.fillStyle = colour.soft;
    context.textAlign = "left";
    context.fillText(`grid ${shown(step)} m`, 10, height - 10);
  }

  trail(context, trail, onto, colour, index) {
    context.strokeStyle = colour.marks[Math.max(0, index - 1) % colour.marks.length];
    context.lineWidth = 1.5;
    context.globalAlpha = 0.45;
    context.beginPath();
    for (const place of trail) context.lineTo(...onto(place));
    context.stroke();
    context.globalAlpha = 1;
  }
}

/** Maximum number of instruments. */
const INSTRUMENTS = 12;

/** Instruments: a dial for an angle, a block on a rail for a length, a bar for other quantities. */
class Instruments {
  constructor(model) {
    this.all = model.state.slice(0, Math.min(model.state.length / 2, INSTRUMENTS));
    this.clear();
  }

  clear() {
    this.reach = this.all.map(() => 0);
  }

  follow(state) {
    this.values = this.all.map((_, place) => state[place]);
    this.reach = this.reach.map((reach, place) => Math.max(reach, Math.abs(this.values[place]) || 0));
  }

  draw(canvas) {
    const { context, width, height } = cleared(canvas);
    const colour = colours();
    const count = this.all.length;
    // Number of columns with the most nearly square cells.
    const columns = Math.max(1, Math.min(count, Math.round(Math.sqrt((count * width) / Math.max(height, 1)))));
    const rows = Math.ceil(count / columns);
    const [wide, tall] = [width / columns, height / rows];
    for (const [place, quantity] of this.all.entries()) {
      const [x, y] = [(place % columns) * wide, Math.floor(place / columns) * tall];
      const cell = { x: x + wide / 2, y: y + tall / 2 - 8, wide: wide - 24, tall: tall - 44, colour };
      const value = this.values[place];
      context.fillStyle = colour.soft;
      context.textAlign = "center";
      context.fillText(`${quantity.name} = ${shown(value)} ${quantity.unit}`, x + wide / 2, y + tall - 10, wide - 8);
      if (!Number.isFinite(value)) continue;
      const mark = colour.marks[place % colour.marks.length];
      if (quantity.unit === "rad") this.dial(context, cell, value, mark);
      else this.rail(context, cell, value / round(Math.max(this.reach[place], 1e-12)), mark);
    }
  }

  /** Draws an arm at an angle from hanging down. */
  dial(context, { x, y, wide, tall, colour }, angle, mark) {
    const radius = Math.max(4, Math.min(wide, tall) / 2 - 4);
    context.strokeStyle = colour.line;
    context.lineWidth = 1.5;
    context.beginPath();
    context.arc(x, y, radius, 0, 2 * Math.PI);
    for (let tick = 0; tick < 12; tick += 1) {
      const [s, c] = [Math.sin((tick * Math.PI) / 6), Math.cos((tick * Math.PI) / 6)];
      context.moveTo(x + radius * s, y + radius * c);
      context.lineTo(x + 0.93 * radius * s, y + 0.93 * radius * c);
    }
    context.stroke();
    const [s, c] = [Math.sin(angle), Math.cos(angle)];
    context.strokeStyle = mark;
    context.lineWidth = 5;
    context.beginPath();
    context.moveTo(x, y);
    context.lineTo(x + 0.8 * radius * s, y + 0.8 * radius * c);
    context.stroke();
    context.fillStyle = mark;
    context.beginPath();
    context.arc(x + 0.8 * radius * s, y + 0.8 * radius * c, 7, 0, 2 * Math.PI);
    context.fill();
    context.fillStyle = colour.ink;
    context.beginPath();
    context.arc(x, y, 4, 0, 2 * Math.PI);
    context.fill();
  }

  /** Draws a block on a rail, at a fraction of its range to the right. */
  rail(context, { x, y, wide, colour }, fraction, mark) {
    const reach = Math.max(4, wide / 2 - 18);
    context.strokeStyle = colour.line;
    context.lineWidth = 2;
    context.beginPath();
    context.moveTo(x - reach - 14, y + 13);
    context.lineTo(x + reach + 14, y + 13);
    for (const tick of [-1, 0, 1]) {
      context.moveTo(x + tick * reach, y + 13);
      context.lineTo(x + tick * reach, y + 19);
    }
    context.stroke();
    context.fillStyle = mark;
    context.beginPath();
    context.roundRect(x + fraction * reach - 14, y - 12, 28, 24, 4);
    context.fill();
  }
}
