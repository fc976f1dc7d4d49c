// Common functions of pictures on a canvas: colours, clearing, and formatted numbers.

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
  context.font = '13px system-ui, "Segoe UI", "Helvetica Neue", Arial, sans-serif';
  return { context, width, height };
}

/** Formats a number with few digits and a minus sign. */
function shown(value, digits = 4) {
  if (!Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  const text =
    size !== 0 && (size < 1e-3 || size >= 1e5)
      ? value.toExponential(Math.max(0, digits - 2))
      : String(Number(value.toPrecision(digits)));
  return text.replaceAll("-", "−");
}

/** Returns the smallest of 1, 2 or 5 times a power of ten that is at least `least`. */
function round(least) {
  const power = 10 ** Math.floor(Math.log10(least));
  return power * ([1, 2, 5, 10].find((step) => step * power >= least * (1 - 1e-12)) ?? 10);
}
