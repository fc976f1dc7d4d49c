//! Step-by-step energy audit of a motion.

use eomgen_sim::ode::{Interior, ObservedStep, ROUNDING_FACTOR, UNMOVED_SIZE_FRACTION};

use super::allowed_errors::{
    TOLERANCE_ERROR_FACTOR, find_allowed_change, find_allowed_errors, find_changes,
    find_uncertain_work,
};
use super::refinement::Refinement;
use super::{Audit, Energies, EnergyAndPower, Imbalance};

/// Factor on the energy change that an error at the relative tolerance in every state causes, for a step with an error
/// estimate.
const ESTIMATE_FACTOR: f64 = 1000.0;

/// A step shorter than this fraction of the preceding one crosses a surface.
const MAX_CROSSING_STEP_FRACTION: f64 = 1e-3;

/// Energy differences below this fraction of the last allowed change are not examined.
const NEGLIGIBLE_FRACTION: f64 = 1e-2;

/// Maximum number of panels of a quadrature that interpolates the states.
const MAX_PANELS: usize = 4096;

/// Maximum number of panels of a quadrature that also halves panels whose energy changes without work. A transient of
/// 1e-5 of the step length needs fewer than 150 panels.
const MAX_BALANCED_PANELS: usize = 512;

/// Maximum number of panels of a quadrature that computes each state inside the step by a step of the solver.
const MAX_RESOLVED_PANELS: usize = 16;

/// Relative error of every state whose energy change limits the sum of the energy differences. A larger sum invalidates
/// the motion, even if the tolerance allows each difference.
const MAX_DRIFT_ERROR: f64 = 1e-2;

/// Rounding error of an energy, relative to its magnitude.
const ENERGY_ROUNDING: f64 = 64.0 * f64::EPSILON;

const EXACT_TOLERANCE: f64 = 1e-9;

/// Work of a step, J.
struct Balance {
    work: f64,
    /// Error of the quadrature, J.
    uncertainty: f64,
    /// Energy change that errors of the states can cause, J.
    allowed: f64,
}

/// Energy auditor of a motion in progress.
#[derive(Debug)]
pub(crate) struct Auditor {
    tolerance: f64,
    /// True if the steps are exact except for rounding.
    is_exact: bool,
    /// Reason why contacts are not audited; `None` if they are.
    driven_contacts: Option<String>,
    /// Reference magnitude of each state for relative errors: its largest magnitude, or more if the solver's known
    /// errors are larger than the tolerance of this magnitude.
    sizes: Vec<f64>,
    /// Largest magnitude of each state.
    magnitudes: Vec<f64>,
    /// Largest rounding error of each state while surfaces or contacts held the motion. Rates keep this error after the
    /// release.
    roundings: Vec<f64>,
    /// Sum of the energy differences of steps, each minus the uncertainty of its work, J.
    drift: f64,
    /// Largest magnitude of `drift` that is not examined, J.
    drift_limit: f64,
    /// Energy at the end of the last step, J.
    energy: Option<f64>,
    /// Largest magnitude of the energy, J.
    largest_energy: f64,
    /// Power at the end of the last step, W.
    power: f64,
    /// Energy change at impacts since the end of the last step, J.
    pending_energy: f64,
    /// Last energy change that errors can cause, J.
    last_allowed: f64,
    /// Length of the last step with known states inside the step, s.
    last_length: f64,
    /// Energy change of the last step across a surface, if it exceeds the tolerance.
    suspected: Option<SuspectedCrossing>,
    pub(super) audit: Audit,
}

/// Energy change of a step across a surface. The rates beyond the surface give the errors of the step, which may cause
/// the change.
#[derive(Clone, Debug)]
struct SuspectedCrossing {
    imbalance: Imbalance,
    /// Length of the step, s.
    length: f64,
    /// State at the end of the step.
    state: Vec<f64>,
}

impl Auditor {
    /// Creates an auditor of a motion with a relative tolerance (`None` for an exact motion). `sizes` are the typical
    /// sizes of the states.
    pub fn new(
        tolerance: Option<f64>,
        typical_sizes: &[f64],
        driven_contacts: Option<String>,
    ) -> Self {
        let unmoved = typical_sizes
            .iter()
            .map(|size| UNMOVED_SIZE_FRACTION * size);
        let magnitudes: Vec<f64> = unmoved.collect();
        Self {
            tolerance: tolerance.unwrap_or(EXACT_TOLERANCE),
            is_exact: tolerance.is_none(),
            driven_contacts,
            sizes: magnitudes.clone(),
            magnitudes,
            roundings: vec![0.0; typical_sizes.len()],
            drift: 0.0,
            drift_limit: 0.0,
            energy: None,
            largest_energy: 0.0,
            power: 0.0,
            pending_energy: 0.0,
            last_allowed: 0.0,
            last_length: 0.0,
            suspected: None,
            audit: Audit::default(),
        }
    }

    /// Continues the audit with a solver of another relative tolerance.
    pub fn continue_with(&mut self, tolerance: f64) {
        (self.tolerance, self.is_exact) = (tolerance, false);
        (self.last_allowed, self.last_length) = (0.0, 0.0);
    }

    /// Returns the energy balance so far.
    pub fn audit(&self) -> Audit {
        let mut audit = self.audit.clone();
        if let Some(suspected) = &self.suspected {
            audit.note(suspected.imbalance);
        }
        audit.remove_faults_up_to(ENERGY_ROUNDING * self.largest_energy);
        audit
    }

    /// Returns the length (s) of the last step across a surface, if its energy change exceeds the tolerance.
    pub fn suspected_crossing(&self) -> Option<f64> {
        self.suspected.as_ref().map(|suspected| suspected.length)
    }

    /// Records the energy change of the last step across a surface, unless the `errors` of its state can cause this
    /// change.
    pub fn judge_crossing(&mut self, errors: &[f64], energies: &mut dyn Energies) {
        let Some(SuspectedCrossing {
            imbalance,
            state,
            length,
        }) = self.suspected.take()
        else {
            return;
        };
        self.raise_to_errors(errors);
        let Imbalance {
            t,
            energy_gain,
            tolerance,
        } = imbalance;
        let states = States {
            ends: &[(t, &state[..])],
            length,
        };
        let allowed = self.find_allowed_change(energies, TOLERANCE_ERROR_FACTOR, &states, &[]);
        let allowed = tolerance.max(allowed);
        self.record_unrounded_excess((t, energy_gain, allowed), &states, energies);
    }

    /// Audits a step.
    pub fn audit_step(&mut self, step: &mut ObservedStep<'_>, energies: &mut dyn Energies) {
        let (start, end) = (step.start, step.end);
        if let Some(suspected) = self.suspected.take() {
            self.audit.note(suspected.imbalance);
        }
        self.raise_sizes(start.1);
        self.raise_sizes(end.1);
        let ends = (self.evaluate(energies, start), self.evaluate(energies, end));
        self.largest_energy = self.largest_energy.max(ends.1.energy.abs());
        if let Some(before) = self.energy.replace(ends.1.energy) {
            self.audit_jump(start, (before, ends.0), energies);
        }
        // The mode may have changed at the start of a step across a surface; the power before it counts too.
        let powers = [self.power, ends.0.power, ends.1.power];
        self.power = ends.1.power;
        let change = ends.1.energy - ends.0.energy - std::mem::take(&mut self.pending_energy);
        let (mut work, has_interior) = self.integrate_simpson(step, energies, ends);
        let length = end.0 - start.0;
        if has_interior {
            self.last_length = length;
        }
        let is_estimated = has_interior || length > MAX_CROSSING_STEP_FRACTION * self.last_length;
        let states = States {
            ends: &[start, end],
            length,
        };
        // NaN is not negligible.
        let is_negligible = (change - work).abs() <= NEGLIGIBLE_FRACTION * self.last_allowed;
        let mut uncertainty = 0.0;
        if !is_negligible {
            let factor = match is_estimated && !self.is_exact {
                true => ESTIMATE_FACTOR,
                false => TOLERANCE_ERROR_FACTOR,
            };
            let values = [ends.0.energy, ends.1.energy];
            let allowed = self.find_allowed_change(energies, factor, &states, &values)
                + find_uncertain_work(end.0, &powers);
            self.last_allowed = allowed;
            let found = match has_interior {
                true => {
                    let judged = (ends, change);
                    self.integrate_accurately(step, energies, judged, (factor, allowed))
                }
                // Interpolated states would follow the rates beyond the surface.
                false => Balance {
                    work,
                    uncertainty: find_spread(&powers) * length,
                    allowed,
                },
            };
            (work, uncertainty) = (found.work, found.uncertainty);
            let tolerance = found.allowed + found.uncertainty;
            if has_interior
                && found.uncertainty > found.allowed
                && (change - work).abs() <= tolerance
            {
                self.exclude_change(
                    change,
                    "the power of the forces changes too often in a step to be integrated",
                );
                return;
            }
            match has_interior {
                true => self.record_excess(end.0, change - work, tolerance),
                false => self.suspect_crossing(end, (change - work, tolerance), length),
            }
        }
        self.audit.energy_change += change;
        self.audit.work += work;
        self.add_to_drift((change - work, uncertainty), &states, energies);
    }

    /// Adds the energy difference of a step to `drift`, minus the uncertainty (J) of its work. Records the first sum
    /// that no correct motion can have.
    fn add_to_drift(
        &mut self,
        (difference, uncertainty): (f64, f64),
        states: &States<'_>,
        energies: &mut dyn Energies,
    ) {
        let before = self.drift;
        let add = |uncertainty: f64| {
            let certain = (difference.abs() - uncertainty).max(0.0);
            before + certain.copysign(difference)
        };
        self.drift = add(uncertainty);
        let rounding = ENERGY_ROUNDING * self.largest_energy;
        self.audit.remove_faults_up_to(rounding);
        if self.audit.drift.is_some() || self.has_small_drift() {
            return;
        }
        let Some((t, state)) = states.ends.last() else {
            return;
        };
        let error = MAX_DRIFT_ERROR.max(self.tolerance);
        let mut evaluations = 0;
        let limit = find_allowed_change(state, &self.magnitudes, error, &mut |state| {
            evaluations += 1;
            energies.evaluate((*t, state)).energy
        });
        self.audit.evaluations += evaluations;
        self.drift_limit = self.drift_limit.max(limit);
        if self.has_small_drift() {
            return;
        }
        self.drift = add(uncertainty + self.find_rounding(states, energies));
        if !self.has_small_drift() {
            self.audit.drift = Some(Imbalance {
                t: *t,
                energy_gain: self.drift,
                tolerance: self.drift_limit,
            });
        }
    }

    fn has_small_drift(&self) -> bool {
        self.drift.is_nan() || self.drift.abs() <= self.drift_limit
    }

    /// Excludes an energy change (J) from the audit and keeps the reason.
    fn exclude_change(&mut self, change: f64, reason: &str) {
        self.audit.energy_change += change;
        self.audit.unaudited_energy += change;
        let why = &mut self.audit.exclusion_reason;
        why.get_or_insert_with(|| reason.to_owned());
    }

    /// Audits an energy change between two steps: at a surface, or by projection onto the constraints.
    fn audit_jump(
        &mut self,
        start: (f64, &[f64]),
        (before, after): (f64, EnergyAndPower),
        energies: &mut dyn Energies,
    ) {
        let change = after.energy - before;
        self.audit.energy_change += change;
        let is_negligible =
            change.abs() <= NEGLIGIBLE_FRACTION / ESTIMATE_FACTOR * self.last_allowed;
        if change != 0.0 && !is_negligible {
            let values = [before, after.energy];
            let states = States::at_once(std::slice::from_ref(&start));
            let allowed =
                self.find_allowed_change(energies, TOLERANCE_ERROR_FACTOR, &states, &values)
                    + find_uncertain_work(start.0, &[self.power, after.power]);
            self.record_unrounded_excess((start.0, change, allowed), &states, energies);
        }
    }

    /// Keeps the energy change of a step of `length` s across a surface for a later decision if the change exceeds the
    /// tolerance.
    fn suspect_crossing(
        &mut self,
        (t, state): (f64, &[f64]),
        (energy_gain, tolerance): (f64, f64),
        length: f64,
    ) {
        let found = find_excess(t, energy_gain, tolerance);
        self.suspected = found.map(|imbalance| SuspectedCrossing {
            imbalance,
            length,
            state: state.to_vec(),
        });
    }

    /// Records an energy change (J) at a time (s) if it exceeds the tolerance (J) by more than the rounding error at
    /// `states`.
    fn record_unrounded_excess(
        &mut self,
        (t, energy_gain, tolerance): (f64, f64, f64),
        states: &States<'_>,
        energies: &mut dyn Energies,
    ) {
        if find_excess(t, energy_gain, tolerance).is_some() {
            let rounding = self.find_rounding(states, energies);
            self.record_excess(t, energy_gain, tolerance + rounding);
        }
    }

    /// Records an energy change that exceeds the tolerance.
    fn record_excess(&mut self, t: f64, energy_gain: f64, tolerance: f64) {
        if let Some(found) = find_excess(t, energy_gain, tolerance) {
            self.audit.note(found);
        }
    }

    /// Returns the work of a step. Refines the quadrature until the given energy change is decided.
    fn integrate_accurately(
        &mut self,
        step: &mut ObservedStep<'_>,
        energies: &mut dyn Energies,
        (ends, change): ((EnergyAndPower, EnergyAndPower), f64),
        (factor, mut allowed): (f64, f64),
    ) -> Balance {
        let mut best = Balance {
            work: f64::NAN,
            uncertainty: f64::INFINITY,
            allowed,
        };
        let states = [step.start, step.end];
        let states = States {
            ends: &states,
            length: step.end.0 - step.start.0,
        };
        let mut rounding = None;
        for (interior, most_panels, balances_panels) in [
            (Interior::Interpolated, MAX_PANELS, false),
            (Interior::Interpolated, MAX_BALANCED_PANELS, true),
            (Interior::Recomputed, MAX_RESOLVED_PANELS, false),
        ] {
            let refinement = Refinement {
                interior,
                most_panels,
                balances_panels,
            };
            let (work, uncertainty) =
                self.integrate_work(step, energies, ends, (refinement, allowed));
            // A later quadrature has more accurate states. With too few panels its uncertainty is larger.
            if uncertainty <= allowed || uncertainty < best.uncertainty {
                (best.work, best.uncertainty) = (work, uncertainty);
            }
            if (change - best.work).abs() <= best.allowed + best.uncertainty {
                return best;
            }
            let rounding = *rounding.get_or_insert_with(|| self.find_rounding(&states, energies));
            best.allowed = allowed + rounding;
            if (change - best.work).abs() <= best.allowed + best.uncertainty {
                return best;
            }
            // A part of the energy may be larger inside the step than at its ends.
            let middle = 0.5 * (step.start.0 + step.end.0);
            if let Some(state) = (step.state_inside)(middle, interior) {
                let states = States {
                    ends: &[(middle, &state[..])],
                    ..states
                };
                let inside = self.find_allowed_change(energies, factor, &states, &[]);
                allowed = allowed.max(inside);
                best.allowed = allowed + rounding;
            }
        }
        best
    }

    /// Excludes a step that cannot be audited and keeps the reason.
    pub fn exclude_step(
        &mut self,
        step: &ObservedStep<'_>,
        energies: &mut dyn Energies,
        reason: &str,
    ) {
        self.raise_sizes(step.end.1);
        let first = match self.energy {
            Some(energy) => energy,
            None => self.evaluate(energies, step.start).energy,
        };
        let last = self.evaluate(energies, step.end).energy;
        let change = last - first - std::mem::take(&mut self.pending_energy);
        self.energy = Some(last);
        self.exclude_change(change, reason);
    }

    /// Audits an impact at time `t` (s) that changes the state. The contacts do the given work (J).
    pub fn audit_impact(
        &mut self,
        t: f64,
        (from, to): (&[f64], &[f64]),
        work: f64,
        energies: &mut dyn Energies,
    ) {
        let before = self.evaluate(energies, (t, from)).energy;
        let after = self.evaluate(energies, (t, to)).energy;
        let change = after - before;
        // The energy change of the step that ends here includes the impact.
        self.pending_energy += change;
        self.audit.energy_change += change;
        if let Some(reason) = &self.driven_contacts {
            self.audit.unaudited_energy += change;
            self.audit.exclusion_reason.get_or_insert(reason.clone());
            return;
        }
        let gain = change - work;
        self.audit.work += work;
        self.audit.impact_energy += gain;
        if gain > 0.0 {
            let ends = [(t, from), (t, to)];
            let states = States::at_once(&ends);
            let allowed = self.find_allowed_change(
                energies,
                TOLERANCE_ERROR_FACTOR,
                &states,
                &[before, after, work],
            );
            self.record_unrounded_excess((t, gain, allowed), &states, energies);
        }
    }

    /// Audits a corner in the step that ends at the given time (s) and state. The corner conditions give the energy
    /// before it and the work at it (J).
    pub fn audit_corner(
        &mut self,
        end: (f64, &[f64]),
        corner: (f64, f64),
        energies: &mut dyn Energies,
    ) {
        self.pending_energy += self.audit_jump_of_rates(end, corner, energies) - corner.0;
    }

    /// Audits a corner between two steps.
    pub fn audit_corner_between_steps(
        &mut self,
        start: (f64, &[f64]),
        corner: (f64, f64),
        energies: &mut dyn Energies,
    ) {
        self.energy = Some(self.audit_jump_of_rates(start, corner, energies));
    }

    /// Audits the energy after a jump of rates and returns it.
    fn audit_jump_of_rates(
        &mut self,
        (t, state): (f64, &[f64]),
        (before, work): (f64, f64),
        energies: &mut dyn Energies,
    ) -> f64 {
        let after = self.evaluate(energies, (t, state)).energy;
        self.audit.energy_change += after - before;
        self.audit.work += work;
        let ends = [(t, state)];
        let states = States::at_once(&ends);
        let allowed = self.find_allowed_change(
            energies,
            TOLERANCE_ERROR_FACTOR,
            &states,
            &[before, after, work],
        );
        self.record_unrounded_excess((t, after - before - work, allowed), &states, energies);
        after
    }

    /// Returns the reason why closed contacts are not audited; `None` if they are.
    pub fn driven_contacts(&self) -> Option<&str> {
        self.driven_contacts.as_deref()
    }

    pub(super) fn evaluate(
        &mut self,
        energies: &mut dyn Energies,
        at: (f64, &[f64]),
    ) -> EnergyAndPower {
        self.audit.evaluations += 1;
        energies.evaluate(at)
    }

    /// Raises the rounding errors and the reference magnitudes of the states to the changes that rounding of `rates`
    /// causes in a step of `length` s.
    pub fn raise_to_roundings(&mut self, rates: &[f64], length: f64) {
        let changes: Vec<f64> = (rates.iter())
            .map(|rate| ROUNDING_FACTOR * length * rate)
            .collect();
        for (rounding, change) in self.roundings.iter_mut().zip(&changes) {
            *rounding = rounding.max(*change);
        }
        self.raise_to_errors(&changes);
    }

    /// Raises the reference magnitudes of the states until the tolerance allows the given errors.
    pub fn raise_to_errors(&mut self, errors: &[f64]) {
        for (size, error) in self.sizes.iter_mut().zip(errors) {
            if error.is_finite() {
                *size = size.max(error / self.tolerance);
            }
        }
    }

    /// Raises the magnitudes of the states to those of a state of the motion. States inside a step count too, because
    /// in a step from rest to rest the rates at both ends are 0.
    pub(super) fn raise_sizes(&mut self, state: &[f64]) {
        let magnitudes = self.sizes.iter_mut().zip(&mut self.magnitudes);
        for ((size, magnitude), entry) in magnitudes.zip(state) {
            *size = size.max(entry.abs());
            *magnitude = magnitude.max(entry.abs());
        }
    }

    /// Returns the energy change that errors of `states` can cause: by the energy at the ends, and by the work between
    /// them.
    fn find_allowed_change(
        &mut self,
        energies: &mut dyn Energies,
        factor: f64,
        states: &States<'_>,
        values: &[f64],
    ) -> f64 {
        let mut largest: f64 = 0.0;
        for (t, state) in states.ends {
            let errors = find_allowed_errors(state, &self.sizes, self.tolerance);
            let change = self.find_change((*t, state), &errors, states.length, energies);
            largest = largest.max(change);
        }
        let rounding = values
            .iter()
            .fold(0.0_f64, |most, value| most.max(value.abs()));
        factor * largest + ENERGY_ROUNDING * rounding
    }

    /// Returns the changes (J) of the energy at a time (s) and a state, and of the work in a step of `length` s, that
    /// the given errors of the state cause.
    fn find_change(
        &mut self,
        (t, state): (f64, &[f64]),
        errors: &[f64],
        length: f64,
        energies: &mut dyn Energies,
    ) -> f64 {
        let mut evaluations = 0;
        let [energy, power] = find_changes(state, errors, &mut |state| {
            evaluations += 1;
            let EnergyAndPower { energy, power } = energies.evaluate((t, state));
            [energy, power]
        });
        self.audit.evaluations += evaluations;
        energy + find_work(power, length)
    }

    /// Returns a bound (J) on the rounding error of the energy at `states` and of the work between them.
    fn find_rounding(&mut self, states: &States<'_>, energies: &mut dyn Energies) -> f64 {
        let (mut energy, mut power, mut of_states) = (0.0, 0.0_f64, 0.0_f64);
        let roundings = std::mem::take(&mut self.roundings);
        for (t, state) in states.ends {
            let bounds = energies.bound_roundings((*t, state));
            energy += bounds.energy;
            power = power.max(bounds.power);
            if roundings.iter().any(|rounding| *rounding > 0.0) {
                let change = self.find_change((*t, state), &roundings, states.length, energies);
                of_states = of_states.max(change);
            }
        }
        self.roundings = roundings;
        energy + find_work(power, states.length) + of_states
    }
}

/// States whose errors can cause an energy change.
#[derive(Clone, Copy)]
struct States<'s> {
    /// Time (s) and state at each end.
    ends: &'s [(f64, &'s [f64])],
    /// Time between the ends, s.
    length: f64,
}

impl<'s> States<'s> {
    fn at_once(ends: &'s [(f64, &'s [f64])]) -> Self {
        Self { ends, length: 0.0 }
    }
}

/// Returns the work (J) of a power (W) during a time (s). A length of 0 gives 0, even if the power is infinite.
fn find_work(power: f64, length: f64) -> f64 {
    match length > 0.0 {
        true => power * length,
        false => 0.0,
    }
}

/// Returns the difference of the largest and the smallest number.
fn find_spread(numbers: &[f64]) -> f64 {
    let low = numbers.iter().copied().fold(f64::INFINITY, f64::min);
    let high = numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    high - low
}

/// Returns an energy change that exceeds the tolerance. Infinite and NaN energies are reported with the rows of the
/// trajectory.
fn find_excess(t: f64, energy_gain: f64, tolerance: f64) -> Option<Imbalance> {
    (energy_gain.is_finite() && energy_gain.abs() > tolerance).then_some(Imbalance {
        t,
        energy_gain,
        tolerance,
    })
}
