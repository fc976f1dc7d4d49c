// Runs in the report of `discover`: moves the sliders and returns the observations.
(async () => {
  const wait = (time) => new Promise((done) => setTimeout(done, time));
  const until = async (holds) => {
    for (let turn = 0; turn < 100 && !holds(); turn += 1) await wait(50);
    return holds();
  };
  const change = (control, value) => {
    control.value = value;
    control.dispatchEvent(new Event("input", { bubbles: true }));
  };
  const seen = {};
  seen.dark = matchMedia("(prefers-color-scheme: dark)").matches;
  const cell = document.querySelector("[data-left=now]");
  if (cell) {
    const canvas = document.getElementById("strips");
    seen.computed = await until(() => cell.dataset.value !== undefined);
    seen.left = Number(cell.dataset.value);
    const before = [cell.textContent, canvas.toDataURL()];
    const slider = document.querySelector("[data-kind] input[type=range]");
    change(slider, slider.max);
    seen.reacted = await until(() => cell.textContent !== before[0]);
    seen.drawn = canvas.toDataURL() !== before[1];
    document.getElementById("defaults").click();
    seen.restored = await until(() => cell.textContent === before[0] && canvas.toDataURL() === before[1]);
  }
  for (const folded of document.querySelectorAll("details")) folded.open = true;
  await wait(100);
  seen.excess = document.documentElement.scrollWidth - document.documentElement.clientWidth;
  seen.unlabelled = Array.from(document.querySelectorAll("input, button")).filter(
    (one) => !one.getAttribute("aria-label") && !one.textContent && one.labels?.length === 0,
  ).length;
  return seen;
})();
