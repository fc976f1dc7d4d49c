// Controls of inputs: constant, sine or step. The engine computes their values and rates.

/** Forms, in the order of the engine. */
const FORMS = ["constant", "sine", "step"];

/** Input with its controls. */
class Signal {
  /** `declared`: its value in the specification. `changed` is called after a change. */
  constructor(element, declared, changed) {
    this.element = element;
    this.form = element.querySelector("select");
    const rates = element.dataset.rates.split(" ").filter(Boolean);
    this.places = [0, 1, 2].map((order) => Number([element.dataset.place, ...rates][order] ?? -1));
    this.quantities = { value: declared };
    this.controls = Array.from(element.querySelectorAll("[data-kind]"));
    for (const control of this.controls) {
      const name = control.dataset.kind;
      const number = control.querySelector("input[type=number]");
      this.quantities[name] ??= Number(number.value);
      const first = this.quantities[name];
      join(control, (value) => {
        this.quantities[name] = value ?? first;
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
    for (const control of this.controls) control.reset();
    this.show();
  }

  /** Returns the numbers of the signal for the engine. */
  get numbers() {
    const { value, change, period, rise } = this.quantities;
    return [...this.places, FORMS.indexOf(this.form.value), value, change, period, rise];
  }
}
