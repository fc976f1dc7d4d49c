// Drawing of the machine: points and lines if the specification has a drawing, else the deflection of every field and an
// instrument for every coordinate.

/** Maximum number of points of a trail. */
const TRAIL = 1500;

/** Smallest distance between points of a trail, as a fraction of the visible range. */
const TRAIL_DISTANCE = 0.003;

/** Largest width of a name in the drawing, px. */
const NAME_WIDTH = 70;

/** Distances of a name from its point, px: across, base line above it, base line below it. */
const NAME_OFFSET = { across: 11, up: 9, down: 20 };

/** Height of letters above and below their base line, px. */
const LETTER_HEIGHT = { up: 11, down: 5 };

/** Sides of a point at which its name can be, the preferred one first: across and up. */
const SIDES = [
  [1, 1],
  [-1, 1],
  [1, -1],
  [-1, -1],
];

/** Distance of the tested points of a line, px. */
const LINE_STEP = 3;

/** Returns whether two boxes overlap. */
function overlap(a, b) {
  return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}

/** Returns whether a line between two points crosses a box. */
function crosses(box, [[x0, y0], [x1, y1]]) {
  const steps = Math.ceil(Math.hypot(x1 - x0, y1 - y0) / LINE_STEP);
  for (let step = 0; step <= steps; step += 1) {
    const [x, y] = [x0 + ((x1 - x0) * step) / (steps || 1), y0 + ((y1 - y0) * step) / (steps || 1)];
    if (x > box.left && x < box.right && y > box.top && y < box.bottom) return true;
  }
  return false;
}

/** Points and lines in a plane. */
class Plane {
  constructor(model) {
    this.drawing = model.drawing;
    this.clear();
  }

  clear() {
    this.bounds = null;
    this.trails = this.drawing.points.map(() => []);
    /** Side of each point at which its name was last. */
    this.sides = this.drawing.points.map(() => SIDES[0]);
  }

  place(point, state, observables) {
    const ordinate = (of) => of.number ?? (of.state === undefined ? observables[of.observable] : state[of.state]);
    return [ordinate(point.x), ordinate(point.y)];
  }

  /** Extends the visible range to the points, and the trails by them. */
  follow(state, observables) {
    this.places = this.drawing.points.map((point) => this.place(point, state, observables));
    for (const [x, y] of this.places) {
      if (!Number.isFinite(x) || !Number.isFinite(y)) continue;
      const bounds = this.bounds ?? [x, x, y, y];
      this.bounds = [Math.min(bounds[0], x), Math.max(bounds[1], x), Math.min(bounds[2], y), Math.max(bounds[3], y)];
    }
    this.leave();
  }

  /** Appends the points to the trails, unless they are near the last ones. */
  leave() {
    if (!this.bounds) return;
    const [left, right, low, high] = this.bounds;
    const near = TRAIL_DISTANCE * Math.max(right - left, high - low);
    for (const [index, [x, y]] of this.places.entries()) {
      const trail = this.trails[index];
      const last = trail.at(-1);
      const isNear = last && Math.hypot(x - last[0], y - last[1]) <= near;
      if (Number.isFinite(x) && Number.isFinite(y) && !isNear) trail.push([x, y]);
      if (trail.length > TRAIL) trail.shift();
    }
  }

  draw(canvas) {
    const { context, width, height } = cleared(canvas);
    if (!this.bounds) return;
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
    this.name(context, { width, height, onto, colour });
  }

  /** Writes the names of the points at the ends of lines next to them, unless they are fixed. A name covers no line and
   * no other text if one of its sides is free; it is omitted if every side has another text. */
  name(context, { width, height, onto, colour }) {
    const ends = new Set(this.drawing.lines.flatMap((line) => [line[0], line.at(-1)]));
    const places = this.places.map(onto);
    const segments = this.drawing.lines.flatMap((line) => line.slice(1).map((end, index) => [places[line[index]], places[end]]));
    const written = [this.scaleText];
    context.fillStyle = colour.ink;
    for (const [index, { symbol, x: across, y: up }] of this.drawing.points.entries()) {
      const [x, y] = places[index];
      const isFixed = across.number !== undefined && up.number !== undefined;
      if (!ends.has(index) || isFixed || !Number.isFinite(x) || !Number.isFinite(y)) continue;
      const wide = Math.min(NAME_WIDTH, symbolWidth(context, symbol));
      const options = [this.sides[index], ...SIDES].map((side) => {
        const left = side[0] > 0 ? x + NAME_OFFSET.across : x - NAME_OFFSET.across - wide;
        const base = side[1] > 0 ? y - NAME_OFFSET.up : y + NAME_OFFSET.down;
        return { side, base, left, right: left + wide, top: base - LETTER_HEIGHT.up, bottom: base + LETTER_HEIGHT.down };
      });
      const allowed = options.filter(
        (box) => box.left >= 0 && box.right <= width && box.top >= 0 && box.bottom <= height && !written.some((other) => overlap(box, other)),
      );
      const box = allowed.find((option) => !segments.some((segment) => crosses(option, segment))) ?? allowed[0];
      if (!box) continue;
      this.sides[index] = box.side;
      written.push(box);
      context.textAlign = "left";
      writeSymbol(context, symbol, "", [box.left, box.base], NAME_WIDTH);
    }
  }

  /** Draws grid lines at round distances and writes the distance. */
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
    const scaled = multiple(step, "m");
    const text = `grid ${shown(step / scaled.size)} ${scaled.unit}`;
    const base = height - 10;
    context.fillText(text, 10, base);
    this.scaleText = {
      left: 10,
      right: 10 + context.measureText(text).width,
      top: base - LETTER_HEIGHT.up,
      bottom: base + LETTER_HEIGHT.down,
    };
  }

  trail(context, trail, onto, colour, index) {
    context.strokeStyle = colour.marks[Math.max(0, index - 1) % colour.marks.length];
    context.lineWidth = 1.5;
    context.globalAlpha = 0.45;
    context.beginPath();
    for (const place of [...trail, this.places[index]]) context.lineTo(...onto(place));
    context.stroke();
    context.globalAlpha = 1;
  }
}

/** Maximum number of instruments. */
const INSTRUMENTS = 12;

/** Fraction of the height for the fields. */
const FIELDS = 0.5;

/** Instruments: a line for the deflection of a field, a dial for an angle, a block on a rail for other quantities. */
class Instruments {
  constructor(model) {
    this.fields = model.fields;
    this.all = model.state.slice(0, Math.min(model.coordinates, INSTRUMENTS));
    this.clear();
  }

  clear() {
    this.reach = this.all.map(() => 0);
    this.deflections = this.fields.map(() => 0);
  }

  follow(state) {
    this.values = this.all.map(({ noise }, place) => withoutNoise(state[place], noise));
    this.lines = this.fields.map(({ first, functions }) =>
      functions.map((row) => row.reduce((sum, phi, mode) => sum + phi * state[first + mode], 0)),
    );
    this.lines.forEach((line, place) => {
      for (const value of line) {
        if (Number.isFinite(value)) this.deflections[place] = Math.max(this.deflections[place], Math.abs(value));
      }
    });
    this.reach = this.reach.map((reach, place) => Math.max(reach, Math.abs(this.values[place]) || 0));
  }

  draw(canvas) {
    const { context, width, height } = cleared(canvas);
    const colour = colours();
    const count = this.all.length;
    const above = this.fields.length === 0 ? 0 : count === 0 ? height : FIELDS * height;
    for (const place of this.fields.keys()) {
      const tall = above / this.fields.length;
      this.field(context, { top: place * tall, width, tall, colour }, place);
    }
    // Number of columns with the most nearly square cells.
    const room = height - above;
    const columns = Math.max(1, Math.min(count, Math.round(Math.sqrt((count * width) / Math.max(room, 1)))));
    const rows = Math.ceil(count / columns);
    const [wide, tall] = [width / columns, room / rows];
    for (const [place, quantity] of this.all.entries()) {
      const [x, y] = [(place % columns) * wide, above + Math.floor(place / columns) * tall];
      const cell = { x: x + wide / 2, y: y + tall / 2 - 8, wide: wide - 24, tall: tall - 44, colour };
      const value = this.values[place];
      context.fillStyle = colour.soft;
      context.textAlign = "center";
      const scaled = quantity.unit === "rad" ? { size: 1, unit: "rad" } : multiple(this.reach[place], quantity.unit);
      writeSymbol(context, quantity.symbol, ` = ${shown(value / scaled.size)} ${scaled.unit}`, [x + wide / 2, y + tall - 10], wide - 8);
      if (!Number.isFinite(value)) continue;
      const mark = colour.marks[place % colour.marks.length];
      if (quantity.unit === "rad") this.dial(context, cell, value, mark);
      else this.rail(context, cell, value / round(Math.max(this.reach[place], 1e-12)), mark);
    }
  }

  /** Draws the deflection of a field over its length, enlarged to the height. */
  field(context, { top, width, tall, colour }, place) {
    const { symbol, unit, along, length } = this.fields[place];
    const line = this.lines[place];
    const [left, right, middle] = [24, width - 24, top + (tall - 18) / 2];
    const scale = (0.5 * (tall - 18) - 14) / round(Math.max(this.deflections[place], 1e-12));
    const across = (index) => left + (index / (line.length - 1)) * (right - left);
    context.strokeStyle = colour.line;
    context.lineWidth = 1.5;
    context.setLineDash([6, 5]);
    context.beginPath();
    context.moveTo(left, middle);
    context.lineTo(right, middle);
    context.stroke();
    context.setLineDash([]);
    context.strokeStyle = colour.marks[place % colour.marks.length];
    context.lineWidth = 5;
    context.beginPath();
    for (const [index, value] of line.entries()) {
      if (Number.isFinite(value)) context.lineTo(across(index), middle - scale * value);
    }
    context.stroke();
    context.fillStyle = colour.soft;
    context.textAlign = "left";
    // The scale along the field is that of its length, if both are lengths.
    const ratio = (scale * length) / (right - left);
    const factor = shown(ratio, 2);
    const size = ratio < 1 ? `, drawn at ${factor} of its size` : `, drawn ${factor} times larger`;
    const times = unit === "m" && length > 0 && this.deflections[place] > 0 ? size : "";
    const scaled = multiple(this.deflections[place], unit);
    const end = `${shown(line.at(-1) / scaled.size, 3)} ${scaled.unit}`;
    writeSymbol(context, symbol, `(${along}) = ${end} at the end${times}`, [left, top + tall - 8], right - left);
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
