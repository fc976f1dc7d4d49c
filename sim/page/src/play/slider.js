// Sliders with number fields, and texts that change.

/** Formats a number for a field with six digits. */
function written(value) {
  const size = Math.abs(value);
  const digits = Number(value.toPrecision(6));
  return size !== 0 && (size < 1e-4 || size >= 1e6) ? digits.toExponential() : String(digits);
}

/** Connects a slider and its number field. `change` receives the value in SI, or undefined for the value of the
 * specification, which needs no conversion. Adds `reset` to the control, and `changed`: its name, value and unit, or an
 * empty text if it has the value of the specification. */
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
  control.changed = () => {
    const { name, unit } = control.dataset;
    if (number.value === declared || !number.checkValidity()) return "";
    return `${name} = ${number.value}${unit === "1" ? "" : ` ${unit}`}`;
  };
  control.reset = () => {
    number.value = declared;
    slider.value = declared;
    apply(declared);
  };
}

/** Returns the changed values of controls as a list: "m = 0 kg, l = 2 m". */
function changedValues(controls) {
  return controls
    .map((control) => control.changed())
    .filter(Boolean)
    .join(", ");
}

/** Replaces the text of an element, if it differs. */
function say(id, text) {
  const element = document.getElementById(id);
  if (element.textContent !== text) element.textContent = text;
}
