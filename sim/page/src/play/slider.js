// Sliders with a number beside them, and texts that change.

/** A number as it is written into a field, of few digits. */
function written(value) {
  const size = Math.abs(value);
  const digits = Number(value.toPrecision(6));
  return size !== 0 && (size < 1e-4 || size >= 1e6) ? digits.toExponential() : String(digits);
}

/** Joins a slider and its number: either changes the other, and `change` is told the value in SI, or nothing where it
 * stands as in the specification: that is taken as it is there, without a conversion. Gives the control a `reset`. */
function join(control, change) {
  const [number, slider] = control.querySelectorAll("input");
  const factor = Number(control.dataset.factor);
  const declared = number.value;
  const apply = (text) => {
    const value = Number(text);
    const fits = text.trim() !== "" && Number.isFinite(value);
    number.setCustomValidity(fits ? "" : "a number");
    if (fits) change(text === declared ? undefined : value * factor);
  };
  slider.addEventListener("input", () => {
    number.value = written(Number(slider.value));
    apply(number.value);
  });
  number.addEventListener("input", () => {
    slider.value = number.value;
    apply(number.value);
  });
  control.reset = () => {
    number.value = declared;
    slider.value = declared;
    apply(declared);
  };
}

/** Writes a text where another one stands. */
function say(id, text) {
  const element = document.getElementById(id);
  if (element.textContent !== text) element.textContent = text;
}
