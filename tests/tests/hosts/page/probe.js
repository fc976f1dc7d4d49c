// Runs in a page under test: operates its controls and returns the observations.
(async () => {
  const wait = (time) => new Promise((done) => setTimeout(done, time));
  const find = (id) => document.getElementById(id);
  const pictures = () => ["drawing", "curves"].map((id) => find(id).toDataURL());
  const change = (control, value) => {
    control.value = value;
    control.dispatchEvent(new Event("input", { bubbles: true }));
  };
  const clock = () => find("clock").textContent;
  /** Waits until a condition is true, with a timeout. */
  const until = async (holds, turns = 20) => {
    for (let turn = 0; turn < turns && !holds(); turn += 1) await wait(50);
    return holds();
  };
  const seen = {};
  await wait(300);
  seen.excess = document.documentElement.scrollWidth - document.documentElement.clientWidth;
  seen.dark = matchMedia("(prefers-color-scheme: dark)").matches;
  seen.label = find("play").textContent;
  const before = [clock(), ...pictures()];
  if (seen.label === "Pause") await until(() => clock() !== before[0] && pictures().every((p, i) => p !== before[1 + i]), 100);
  const after = [clock(), ...pictures()];
  seen.moved = before.map((part, place) => part !== after[place]);
  if (seen.label === "Pause") find("play").click();
  await wait(150);
  const [paused, held] = [clock(), pictures()];
  await wait(200);
  seen.paused = paused === clock();
  const control = document.querySelector("[data-kind=parameter]");
  if (control) {
    const [number, slider] = control.querySelectorAll("input");
    change(slider, slider.max);
    seen.reacted = await until(() => pictures().some((picture, place) => picture !== held[place]));
    seen.number = Math.abs(Number(number.value) / Number(slider.value) - 1) < 1e-5;
    change(number, "");
    seen.refused = !number.checkValidity();
    change(number, "0");
    seen.zero = await until(() => find("status").textContent !== "");
    seen.obstacle = find("status").textContent;
    find("defaults").click();
    seen.restored = number.checkValidity() && number.value === number.defaultValue;
  }
  find("reset").click();
  await wait(150);
  seen.reset = Number.parseFloat(clock());
  seen.focusable = Array.from(document.querySelectorAll("input, button, summary")).every((one) => one.tabIndex === 0);
  seen.unlabelled = Array.from(document.querySelectorAll("input, button")).filter(
    (one) => !one.getAttribute("aria-label") && !one.textContent && one.labels?.length === 0,
  ).length;
  return seen;
})();
