// Inputs as signals over time: constant, sine or step. The rates of an input are those of its signal.

/** Start of a step, s. */
const STEP_START = 1;

/** Value of a signal with its first and second rate, for each form. `change`: amplitude or height. */
const FORMS = {
  constant: ({ value }) => [value, 0, 0],
  sine: ({ value, change, period }, t) => {
    const [w, phase] = [(2 * Math.PI) / period, (2 * Math.PI * t) / period];
    return [value + change * Math.sin(phase), change * w * Math.cos(phase), -change * w * w * Math.sin(phase)];
  },
  /** Polynomial of degree 5, whose rates begin and end at 0. */
  step: ({ value, change, rise }, t) => {
    const s = Math.min(1, Math.max(0, (t - STEP_START) / rise));
    return [
      value + change * s ** 3 * (10 - 15 * s + 6 * s * s),
      (change / rise) * 30 * s * s * (1 - s) ** 2,
      (change / rise ** 2) * 60 * s * (1 - s) * (1 - 2 * s),
    ];
  },
};

/** Input with its controls. */
class Signal {
  /** `declared`: its value in the specification. `changed` is called after a change. */
  constructor(element, declared, changed) {
    this.element = element;
    this.form = element.querySelector("select");
    this.places = [element.dataset.place, ...element.dataset.rates.split(" ").filter(Boolean)].map(Number);
    this.numbers = { value: declared };
    for (const control of element.querySelectorAll("[data-kind]")) {
      const name = control.dataset.kind;
      const number = control.querySelector("input[type=number]");
      this.numbers[name] ??= Number(number.value);
      const first = this.numbers[name];
      join(control, (value) => {
        this.numbers[name] = value ?? first;
        changed();
      });
    }
    this.form.addEventListener("input", () => {
      this.show();
      changed();
    });
    this.show();
  }

  /** Shows the controls of the form. */
  show() {
    for (const part of this.element.querySelectorAll("[data-forms]")) {
      part.hidden = !part.dataset.forms.split(" ").includes(this.form.value);
    }
  }

  reset() {
    this.form.value = "constant";
    for (const control of this.element.querySelectorAll("[data-kind]")) control.reset();
    this.show();
  }

  /** Writes the value and its rates at a time to the inputs. */
  write(t, inputs) {
    const numbers = FORMS[this.form.value](this.numbers, t);
    for (const [order, place] of this.places.entries()) inputs[place] = numbers[order];
  }
}
