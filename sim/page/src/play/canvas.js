// Common functions of pictures on a canvas: colours, clearing, and formatted numbers.

/** Sizes of letters and of subscripts, px. */
const LETTERS = 13;
const SUBSCRIPTS = 11;

/** Returns the font of a size. */
function font(size) {
  return `${size}px system-ui, "Segoe UI", "Helvetica Neue", Arial, sans-serif`;
}

/** Returns the parts of a symbol with a text after it: text, font size, offset downwards and width of each, px. */
function symbolParts(context, [head, subscript], rest) {
  const parts = [
    [head, LETTERS, 0],
    [subscript, SUBSCRIPTS, 3],
    [rest, LETTERS, 0],
  ].map(([text, size, down]) => {
    context.font = font(size);
    return { text, size, down, width: context.measureText(text).width };
  });
  context.font = font(LETTERS);
  return parts;
}

/** Returns the width of a symbol, px. */
function symbolWidth(context, symbol) {
  return symbolParts(context, symbol, "").reduce((sum, { width }) => sum + width, 0);
}

/** Writes a symbol with its subscript and a text after it, at most `widest` px wide; narrower letters make it fit.
 * `symbol`: letters of the name and of its subscript. */
function writeSymbol(context, symbol, rest, [x, y], widest = Infinity) {
  const parts = symbolParts(context, symbol, rest);
  const total = parts.reduce((sum, { width }) => sum + width, 0);
  context.save();
  const shift = { center: 0.5, right: 1 }[context.textAlign] ?? 0;
  const scale = Math.min(1, widest / (total || 1));
  context.translate(x - shift * total * scale, y);
  context.scale(scale, 1);
  context.textAlign = "left";
  let at = 0;
  for (const { text, size, down, width } of parts) {
    context.font = font(size);
    context.fillText(text, at, down);
    at += width;
  }
  context.restore();
  context.font = font(LETTERS);
}

/** Returns the colours of the page. Every picture reads them again, because the scheme can change. */
function colours() {
  const style = getComputedStyle(document.documentElement);
  const named = (name) => style.getPropertyValue(`--${name}`).trim();
  return {
    ink: named("ink"),
    soft: named("soft"),
    line: named("line"),
    panel: named("panel"),
    accent: named("accent"),
    marks: [1, 2, 3, 4, 5, 6].map((number) => named(`mark-${number}`)),
  };
}

/** Resizes a canvas to its size on the page and clears it; returns its context, width and height. */
function cleared(canvas) {
  const scale = window.devicePixelRatio || 1;
  const { clientWidth: width, clientHeight: height } = canvas;
  if (canvas.width !== Math.round(width * scale) || canvas.height !== Math.round(height * scale)) {
    canvas.width = Math.round(width * scale);
    canvas.height = Math.round(height * scale);
  }
  const context = canvas.getContext("2d");
  context.setTransform(scale, 0, 0, scale, 0, 0);
  context.clearRect(0, 0, width, height);
  context.lineCap = "round";
  context.lineJoin = "round";
  context.font = font(LETTERS);
  return { context, width, height };
}

/** Writes an exponent as a superscript: 2.5e-7 becomes 2.5·10⁻⁷. */
function powerOfTen(text) {
  const [mantissa, exponent] = text.split("e");
  const raised = [...exponent.replace("+", "")].map((digit) => (digit === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[digit]));
  return `${mantissa}·10${raised.join("")}`;
}

/** Formats a number with few digits and a minus sign. */
function shown(value, digits = 4) {
  if (!Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  const text =
    size !== 0 && (size < 1e-3 || size >= 1e5)
      ? powerOfTen(value.toExponential(Math.max(0, digits - 2)))
      : String(Number(value.toPrecision(digits)));
  return text.replaceAll("-", "−");
}

/** Returns the smallest of 1, 2 or 5 times a power of ten that is at least `least`. */
function round(least) {
  const power = 10 ** Math.floor(Math.log10(least));
  return power * ([1, 2, 5, 10].find((step) => step * power >= least * (1 - 1e-12)) ?? 10);
}

/** Smallest range of an axis that is shown, as a fraction of the largest value. */
const FINEST = 1e-5;

/** Returns the limits of an axis, rounded so that they seldom change. */
function ends(values) {
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) {
    if (Number.isFinite(value)) {
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
  }
  if (low > high) return [-1, 1];
  const size = Math.max(Math.abs(low), Math.abs(high));
  // Variations of the last digits are shown as a constant.
  if (high - low <= FINEST * size || high === low) {
    const half = size > 0 ? 0.5 * size : 1;
    return [low - half, high + half];
  }
  const step = round((high - low) / 4);
  return [step * Math.floor(low / step), step * Math.ceil(high / step)];
}

/** Returns the labels of an axis' ends, with as many digits as distinguish them. */
function endLabels(low, high) {
  for (let digits = 3; ; digits += 1) {
    const labels = [low, high].map((end) => shown(end, digits));
    if (labels[0] !== labels[1] || digits === 8) return labels;
  }
}

/** Replaces a rounding error by 0. `noise`: the largest one. */
function withoutNoise(value, noise) {
  return Math.abs(value) < noise ? 0 : value;
}

/** Returns the multiple of a unit in which a magnitude is at least 1: its size in the unit and its name. */
function multiple(magnitude, unit) {
  const takesPrefix = /^(m|s|N|rad|V|A|W|J|Pa)(?=$|\/| )/.test(unit);
  const steps = [
    [1, ""],
    [1e-3, "m"],
    [1e-6, "µ"],
    [1e-9, "n"],
  ];
  const [size, prefix] = (takesPrefix && steps.find(([least]) => magnitude >= 0.9995 * least)) || steps[0];
  return { size, unit: unit === "1" ? "" : prefix + unit };
}
