//! Energy audit of a motion: along every step the change of the energy is compared with the work,
//! the integral of the power. What is left and exceeds the errors that the solver's tolerance
//! allows is energy from nothing, whatever its cause.
//!
//! Changes at impacts are booked by themselves; they may not be gains. Contacts at rest do no
//! work. A contact whose distance depends on the time or on inputs does work that no power of the
//! model counts: what happens there is left out.

use eomgen_sim::ode::{Interior, ObservedStep, UNMOVED_PART};

/// How many times the energy may change by an error that the tolerance allows in every entry of
/// the state, where no estimate of an error is relied on: from step to step, in the short step over
/// a surface, at an impact.
pub(crate) const ERROR_FACTOR: f64 = 30.0;
/// The same in a step whose length follows from an estimate, which may be too small by so much.
const ESTIMATE_FACTOR: f64 = 1000.0;
/// A step that is shorter than this part of the one before leads over a surface.
const SHORT: f64 = 1e-3;
/// Roundings of an energy that count as none.
const ROUNDINGS: f64 = 64.0 * f64::EPSILON;
/// A difference below this part of what was last found to be allowed is not looked at.
const NEGLIGIBLE: f64 = 1e-2;
/// The most panels of a quadrature by interpolated states.
const MOST_PANELS: usize = 4096;
/// The same by states that take a step each.
const MOST_RESOLVED_PANELS: usize = 16;
/// The error of a quadrature beside the change of the energy that is allowed.
const QUADRATURE_ERROR: f64 = 0.1;
/// The tolerance of a solver without one.
const EXACT_TOLERANCE: f64 = 1e-9;
/// Nodes and weights of Gauss' quadrature of order 8 on (0, 1).
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

/// Energy and power at a time (s) and a state, in J and W.
pub(crate) type Energies<'e> = dyn FnMut(f64, &[f64]) -> EnergyAt + 'e;

/// Energy and power of a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct EnergyAt {
    /// J.
    pub energy: f64,
    /// W.
    pub power: f64,
}

impl EnergyAt {
    /// Of the observables of a model, `energy` and `power` last.
    pub fn of(observables: &[f64]) -> Self {
        match observables {
            [.., energy, power] => Self {
                energy: *energy,
                power: *power,
            },
            _ => Self {
                energy: f64::NAN,
                power: f64::NAN,
            },
        }
    }
}

/// The energy balance of a motion.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Audit {
    /// Change of the energy from the first step to the last, J.
    pub energy_change: f64,
    /// Integral of the power, J.
    pub work: f64,
    /// Change of the energy at impacts, J; losses are negative.
    pub impacts: f64,
    /// Change of the energy in what could not be judged, J.
    pub unaudited: f64,
    /// Steps and impacts that changed the energy by more than errors explain.
    pub faults: u64,
    /// The first of them.
    pub first_fault: Option<Imbalance>,
    /// The largest of them.
    pub largest_fault: Option<Imbalance>,
    /// Evaluations of energy and power.
    pub evaluations: u64,
    /// Why some of the motion was not judged, if it was not.
    pub not_applicable: Option<String>,
}

/// A change of the energy that nothing explains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Imbalance {
    /// When, s.
    pub t: f64,
    /// The energy gained, J; lost if it is negative.
    pub size: f64,
    /// What errors of the solver explain, J.
    pub tolerance: f64,
}

impl Audit {
    /// The part of the energy's change that neither work nor impacts explain, J.
    pub fn unexplained(&self) -> f64 {
        self.energy_change - self.work - self.impacts - self.unaudited
    }

    /// A sentence on the first change of the energy that nothing explains, if there is one.
    pub fn warning(&self) -> Option<String> {
        let Imbalance { t, size, tolerance } = self.first_fault?;
        let (verb, size) = if size < 0.0 {
            ("loses", -size)
        } else {
            ("gains", size)
        };
        let more = match self.faults {
            1 => String::new(),
            count => format!("; {count} steps do so, {:.4e} J in all", self.unexplained()),
        };
        Some(format!(
            "the motion {verb} {size:.4e} J without work at t = {t} s, where errors of the solver \
             explain {tolerance:.1e} J{more}: the equations or the solver are wrong there"
        ))
    }

    fn note(&mut self, found: Imbalance) {
        self.faults += 1;
        self.first_fault.get_or_insert(found);
        let largest = self.largest_fault.get_or_insert(found);
        if found.size.abs() > largest.size.abs() {
            *largest = found;
        }
    }
}

/// Keeps the energy balance of a motion while it goes on.
#[derive(Debug)]
pub(crate) struct Auditor {
    tolerance: f64,
    /// Whether steps have no error but rounding.
    is_exact: bool,
    /// Why contacts are not judged, if they are not.
    moving_contacts: Option<String>,
    /// The largest that each entry of the state has been.
    sizes: Vec<f64>,
    /// The energy behind the last step.
    energy: Option<f64>,
    /// What impacts have changed of it since, J.
    pending: f64,
    /// The last change that errors were found to explain, J.
    last_allowed: f64,
    /// The length of the last step with a known inside, s.
    last_length: f64,
    audit: Audit,
}

impl Auditor {
    /// An auditor of a motion with a relative tolerance, none for an exact one, and with the typical sizes of its
    /// states.
    pub fn new(
        tolerance: Option<f64>,
        typical_sizes: &[f64],
        moving_contacts: Option<String>,
    ) -> Self {
        Self {
            tolerance: tolerance.unwrap_or(EXACT_TOLERANCE),
            is_exact: tolerance.is_none(),
            moving_contacts,
            sizes: typical_sizes
                .iter()
                .map(|size| UNMOVED_PART * size)
                .collect(),
            energy: None,
            pending: 0.0,
            last_allowed: 0.0,
            last_length: 0.0,
            audit: Audit::default(),
        }
    }

    /// The balance so far.
    pub fn audit(&self) -> &Audit {
        &self.audit
    }

    /// Judges a step.
    pub fn step(&mut self, step: &mut ObservedStep<'_>, energies: &mut Energies<'_>) {
        let (start, end) = (step.start, step.end);
        self.raise_sizes(start.1);
        self.raise_sizes(end.1);
        let ends = (self.at(energies, start), self.at(energies, end));
        if let Some(before) = self.energy.replace(ends.1.energy) {
            self.jump(start, ends.0.energy - before, energies);
        }
        let change = ends.1.energy - ends.0.energy - std::mem::take(&mut self.pending);
        let (mut work, has_interior) = self.simpson(step, energies, ends);
        let length = end.0 - start.0;
        if has_interior {
            self.last_length = length;
        }
        let is_estimated = has_interior || length > SHORT * self.last_length;
        // What is no number is not negligible.
        let is_negligible = (change - work).abs() <= NEGLIGIBLE * self.last_allowed;
        if !is_negligible {
            let factor = match is_estimated && !self.is_exact {
                true => ESTIMATE_FACTOR,
                false => ERROR_FACTOR,
            };
            let values = [ends.0.energy, ends.1.energy];
            let allowed = self.allowed(energies, factor, &[start, end], &values);
            self.last_allowed = allowed;
            let judged = (ends, change);
            let (found, tolerance) = self.look_closely(step, energies, judged, (factor, allowed));
            work = found;
            self.judge(end.0, change - work, tolerance);
        }
        self.audit.energy_change += change;
        self.audit.work += work;
    }

    /// Judges what changed the energy between two steps: a surface, or the return to constraints.
    fn jump(&mut self, start: (f64, &[f64]), change: f64, energies: &mut Energies<'_>) {
        self.audit.energy_change += change;
        let is_negligible = change.abs() <= NEGLIGIBLE / ESTIMATE_FACTOR * self.last_allowed;
        if change != 0.0 && !is_negligible {
            let values = [self.energy.unwrap_or(0.0)];
            let allowed = self.allowed(energies, ERROR_FACTOR, &[start], &values);
            self.judge(start.0, change, allowed);
        }
    }

    /// Notes a change of the energy that is larger than the tolerance, or no number.
    fn judge(&mut self, t: f64, size: f64, tolerance: f64) {
        if size.abs() > tolerance || size.is_nan() {
            self.audit.note(Imbalance { t, size, tolerance });
        }
    }

    /// The work of a step whose energy changes so, as accurately as is needed, and the change that
    /// errors explain.
    fn look_closely(
        &mut self,
        step: &mut ObservedStep<'_>,
        energies: &mut Energies<'_>,
        (ends, change): ((EnergyAt, EnergyAt), f64),
        (factor, mut allowed): (f64, f64),
    ) -> (f64, f64) {
        let (mut work, mut tolerance) = (f64::NAN, f64::NAN);
        for (interior, panels) in [
            (Interior::Interpolated, MOST_PANELS),
            (Interior::Resolved, MOST_RESOLVED_PANELS),
        ] {
            let uncertainty;
            (work, uncertainty) = self.work(step, energies, ends, (interior, panels, allowed));
            tolerance = allowed + uncertainty;
            if (change - work).abs() <= tolerance {
                return (work, tolerance);
            }
            // A part of the energy may be larger inside than at the ends.
            let middle = 0.5 * (step.start.0 + step.end.0);
            if let Some(state) = (step.inside)(middle, interior) {
                let inside = self.allowed(energies, factor, &[(middle, &state)], &[]);
                allowed = allowed.max(inside);
                tolerance = allowed + uncertainty;
            }
        }
        (work, tolerance)
    }

    /// Leaves out a step that cannot be judged, for a reason.
    pub fn leave_out(
        &mut self,
        step: &ObservedStep<'_>,
        energies: &mut Energies<'_>,
        reason: &str,
    ) {
        self.raise_sizes(step.end.1);
        let first = match self.energy {
            Some(energy) => energy,
            None => self.at(energies, step.start).energy,
        };
        let last = self.at(energies, step.end).energy;
        let change = last - first - std::mem::take(&mut self.pending);
        self.energy = Some(last);
        self.audit.energy_change += change;
        self.audit.unaudited += change;
        let why = &mut self.audit.not_applicable;
        why.get_or_insert_with(|| reason.to_owned());
    }

    /// Books an impact at time `t` (s) that changes the state.
    pub fn impact(&mut self, t: f64, (from, to): (&[f64], &[f64]), energies: &mut Energies<'_>) {
        let before = self.at(energies, (t, from)).energy;
        let after = self.at(energies, (t, to)).energy;
        let change = after - before;
        // The step that leads here ends behind the impact.
        self.pending += change;
        self.audit.energy_change += change;
        if let Some(reason) = &self.moving_contacts {
            self.audit.unaudited += change;
            self.audit.not_applicable.get_or_insert(reason.clone());
            return;
        }
        self.audit.impacts += change;
        if change > 0.0 {
            let states = [(t, from), (t, to)];
            let allowed = self.allowed(energies, ERROR_FACTOR, &states, &[before, after]);
            self.judge(t, change, allowed);
        }
    }

    /// Why closed contacts are not judged, if they are not.
    pub fn moving_contacts(&self) -> Option<&str> {
        self.moving_contacts.as_deref()
    }

    /// The integral of the power over a step by Simpson's rule, and whether the inside is known.
    fn simpson(
        &mut self,
        step: &mut ObservedStep<'_>,
        energies: &mut Energies<'_>,
        (first, last): (EnergyAt, EnergyAt),
    ) -> (f64, bool) {
        let (begin, end) = (step.start.0, step.end.0);
        let middle = 0.5 * (begin + end);
        let mean = 0.5 * (first.power + last.power);
        match (step.inside)(middle, Interior::Interpolated) {
            Some(state) => {
                let power = self.at(energies, (middle, &state)).power;
                ((mean + 2.0 * power) / 3.0 * (end - begin), true)
            }
            None => (mean * (end - begin), false),
        }
    }

    /// The integral of the power over a step, panels halved until that changes little beside
    /// what is allowed; and how uncertain it is if nothing is known of the inside.
    fn work(
        &mut self,
        step: &mut ObservedStep<'_>,
        energies: &mut Energies<'_>,
        (first, last): (EnergyAt, EnergyAt),
        (interior, most_panels, allowed): (Interior, usize, f64),
    ) -> (f64, f64) {
        let (begin, length) = (step.start.0, step.end.0 - step.start.0);
        let mut gauss = |(from, width): (f64, f64)| {
            let mut sum = 0.0;
            for (node, weight) in GAUSS {
                let t = begin + length * (from + width * node);
                let state = (step.inside)(t, interior)?;
                self.audit.evaluations += 1;
                sum += weight * width * length * energies(t, &state).power;
            }
            Some(sum)
        };
        let Some(whole) = gauss((0.0, 1.0)) else {
            let spread = (last.power - first.power).abs();
            let mean = 0.5 * (first.power + last.power);
            return (mean * length, 0.5 * spread * length);
        };
        let (mut work, mut panels) = (0.0, 1);
        let mut open = vec![((0.0, 1.0), whole)];
        while let Some(((from, width), whole)) = open.pop() {
            let half = 0.5 * width;
            let halves = [(from, half), (from + half, half)];
            let [Some(left), Some(right)] = halves.map(&mut gauss) else {
                work += whole;
                continue;
            };
            let error = (left + right - whole).abs();
            panels += 1;
            if error <= QUADRATURE_ERROR * allowed * width || panels >= most_panels {
                work += left + right;
            } else {
                open.extend([(halves[0], left), (halves[1], right)]);
            }
        }
        (work, 0.0)
    }

    fn at(&mut self, energies: &mut Energies<'_>, (t, state): (f64, &[f64])) -> EnergyAt {
        self.audit.evaluations += 1;
        energies(t, state)
    }

    fn raise_sizes(&mut self, state: &[f64]) {
        for (size, entry) in self.sizes.iter_mut().zip(state) {
            *size = size.max(entry.abs());
        }
    }

    /// The change of the energy that errors at these states explain.
    fn allowed(
        &mut self,
        energies: &mut Energies<'_>,
        factor: f64,
        states: &[(f64, &[f64])],
        values: &[f64],
    ) -> f64 {
        let mut largest: f64 = 0.0;
        for (t, state) in states {
            let mut evaluations = 0;
            let energy = &mut |state: &[f64]| {
                evaluations += 1;
                energies(*t, state).energy
            };
            largest = largest.max(allowed_change(state, &self.sizes, self.tolerance, energy));
            self.audit.evaluations += evaluations;
        }
        let rounding = values
            .iter()
            .fold(0.0_f64, |most, value| most.max(value.abs()));
        factor * largest + ROUNDINGS * rounding
    }
}

/// The change of a quantity of the state that errors explain: the sum over the entries of the
/// changes by the error that the relative tolerance allows in each, beside the entry and the
/// largest that it has been. Of errors of either sign the smaller change counts: a jump of the
/// quantity beside the state is no error.
pub(crate) fn allowed_change(
    state: &[f64],
    sizes: &[f64],
    tolerance: f64,
    quantity: &mut dyn FnMut(&[f64]) -> f64,
) -> f64 {
    let here = quantity(state);
    let mut moved = state.to_vec();
    let mut sum = 0.0;
    for ((place, entry), size) in state.iter().enumerate().zip(sizes) {
        let error = tolerance * (entry.abs() + size);
        let mut change = f64::INFINITY;
        for moved_entry in [entry + error, entry - error] {
            moved[place] = moved_entry;
            change = change.min((quantity(&moved) - here).abs());
        }
        sum += change;
        moved[place] = *entry;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A mass of 1 kg on a spring of 1 N/m; its state is (x, v).
    fn oscillator(_: f64, state: &[f64]) -> EnergyAt {
        EnergyAt {
            energy: 0.5 * (state[0] * state[0] + state[1] * state[1]),
            power: 0.0,
        }
    }

    /// The audit of the oscillator's motion in steps of 0.1 s, tampered with from step 20 on.
    fn audited(tamper: impl Fn(&mut [f64; 2]), energies: &mut Energies<'_>) -> Audit {
        let mut auditor = Auditor::new(Some(1e-9), &[1.0; 2], None);
        let state = |t: f64| [t.cos(), -t.sin()];
        for count in 0..40 {
            let (t, next) = (0.1 * f64::from(count), 0.1 * f64::from(count + 1));
            let (start, mut end) = (state(t), state(next));
            if count >= 20 {
                tamper(&mut end);
            }
            let mut step = ObservedStep {
                start: (t, &start),
                end: (next, &end),
                inside: &mut |t, _| Some(state(t).to_vec()),
            };
            auditor.step(&mut step, energies);
        }
        auditor.audit().clone()
    }

    #[test]
    fn an_exact_motion_has_no_fault() {
        let audit = audited(|_| {}, &mut oscillator);
        assert_eq!(audit.faults, 0);
        assert!(audit.evaluations < 40 * 20, "{}", audit.evaluations);
    }

    #[test]
    fn a_tampered_state_is_a_fault_with_its_time_and_size() {
        let audit = audited(|state| state[1] *= 1.0 + 1e-4, &mut oscillator);
        let fault = audit.first_fault.expect("a fault");
        assert!((fault.t - 2.1).abs() < 1e-12);
        let v: f64 = (2.1_f64).sin();
        assert!((fault.size - 1e-4 * v * v).abs() < 1e-8, "{}", fault.size);
    }

    #[test]
    fn an_energy_that_jumps_beside_the_state_is_a_fault() {
        // x falls through cos(2.05) between 2.0 and 2.1 s.
        let wall = 2.05_f64.cos();
        let mut jump = |t: f64, state: &[f64]| EnergyAt {
            energy: oscillator(t, state).energy + f64::from(state[0] < wall),
            power: 0.0,
        };
        let audit = audited(|_| {}, &mut jump);
        let fault = audit.first_fault.expect("a fault");
        assert!((fault.t - 2.1).abs() < 1e-12 && (fault.size - 1.0).abs() < 1e-9);
    }

    #[test]
    fn work_that_is_done_is_no_fault_and_work_that_is_not_is_one() {
        // The energy grows by 0.2 J/s by the work of a force, or by nothing.
        let mut pushed = |t: f64, state: &[f64]| EnergyAt {
            energy: oscillator(t, state).energy + 0.1 * t * t,
            power: 0.2 * t,
        };
        let audit = audited(|_| {}, &mut pushed);
        assert_eq!(audit.faults, 0);
        assert!((audit.work - 1.6).abs() < 1e-12);
        let mut idle = |t: f64, state: &[f64]| EnergyAt {
            power: 0.0,
            ..pushed(t, state)
        };
        assert_eq!(audited(|_| {}, &mut idle).faults, 40);
    }

    #[test]
    fn an_impact_may_lose_energy_and_not_gain_it() {
        let mut auditor = Auditor::new(Some(1e-9), &[1.0; 2], None);
        auditor.impact(1.0, (&[0.0, -1.0], &[0.0, 0.5]), &mut oscillator);
        assert_eq!(auditor.audit().faults, 0);
        assert_eq!(auditor.audit().impacts, 0.5 * (0.25 - 1.0));
        auditor.impact(2.0, (&[0.0, -1.0], &[0.0, 1.1]), &mut oscillator);
        let fault = auditor.audit().first_fault.expect("a fault");
        assert_eq!(fault.t, 2.0);
        assert!((fault.size - 0.5 * 0.21).abs() < 1e-12);
    }
}
