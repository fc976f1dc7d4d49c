// Projection of a state onto the constraints, as in the crate `compiled_model`: with the stabilisation rate w the
// accelerations are a(w) = a(0) - 2 w P r - w^2 P g, so that two evaluations at w and -w give the smallest corrections
// P g of the coordinates and P r of the rates.

/** Rate w, 1/s, and the largest number of corrections. */
const LARGE_RATE = 1048576;
const CORRECTIONS = 50;
/** Relative size of the last correction, and of one that is reported. */
const LAST_CORRECTION = 1e-8;
const REPORTED_CORRECTION = 1e-6;

/** Corrects a state in place. `place`: index of the stabilisation rate among the parameters. Returns "unchanged", "moved"
 * or "failed". */
function project(machine, place, t, state) {
  const given = Float64Array.from(state);
  const own = machine.parameters[place];
  const degrees = model.degrees;
  const rates = [own, LARGE_RATE, -LARGE_RATE].map(() => new Float64Array(state.length));
  const largest = (first) => {
    let most = Number.MIN_VALUE;
    for (let row = first; row < first + degrees; row += 1) most = Math.max(most, Math.abs(state[row]));
    return most;
  };
  const settle = (outcome) => {
    machine.parameters[place] = own;
    machine.prepare();
    if (outcome === "failed") state.set(given);
    return outcome;
  };
  for (let correction = 0; correction < CORRECTIONS; correction += 1) {
    [own, LARGE_RATE, -LARGE_RATE].forEach((rate, which) => {
      machine.parameters[place] = rate;
      machine.prepare();
      machine.rate(t, state, rates[which]);
    });
    const [size, rateSize] = [largest(0), largest(degrees)];
    let relative = 0;
    for (let row = 0; row < degrees; row += 1) {
      const [here, plus, minus] = rates.map((of) => of[degrees + row]);
      const ofRate = (minus - plus) / (4 * LARGE_RATE);
      const ofValue = (here + 2 * own * ofRate - 0.5 * (plus + minus)) / (LARGE_RATE ** 2 - own ** 2);
      if (!Number.isFinite(ofValue) || !Number.isFinite(ofRate)) return settle("failed");
      relative = Math.max(relative, Math.abs(ofValue) / size, Math.abs(ofRate) / Math.max(rateSize, size));
      state[row] -= ofValue;
      state[degrees + row] -= ofRate;
    }
    if (relative <= LAST_CORRECTION) {
      const scale = Math.max(size, rateSize);
      const moved = given.some((value, row) => Math.abs(value - state[row]) > REPORTED_CORRECTION * scale);
      return settle(moved ? "moved" : "unchanged");
    }
  }
  return settle("failed");
}
