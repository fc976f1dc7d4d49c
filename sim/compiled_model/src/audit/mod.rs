//! Energy audit of a motion: compares the energy change of every step with the work, the integral of the power. A
//! difference beyond the errors that the solver's tolerance allows indicates an error of the equations or of the
//! solver.
//!
//! Energy changes at impacts are counted separately. An impact must not add energy beyond the work of its contacts.
//! Contacts do work if they move with time, and on coordinates relative to a moving frame. Contacts whose distance
//! depends on inputs are not audited, because the distance jumps with held inputs.

mod allowed_errors;
mod auditor;
mod refinement;
mod roundings;
#[cfg(test)]
mod tests;
mod work;

pub(crate) use allowed_errors::{TOLERANCE_ERROR_FACTOR, find_allowed_change};
pub(crate) use auditor::Auditor;
pub(crate) use roundings::EnergyRoundings;

/// Source of energy and power along a motion.
pub(crate) trait Energies {
    /// Returns energy and power at a time (s) and a state.
    fn evaluate(&mut self, at: (f64, &[f64])) -> EnergyAndPower;

    /// Returns bounds on the rounding errors of energy and power at a time (s) and a state; 0 if no bound is known.
    fn bound_roundings(&mut self, _at: (f64, &[f64])) -> EnergyAndPower {
        EnergyAndPower::default()
    }
}

impl<F: FnMut(f64, &[f64]) -> EnergyAndPower> Energies for F {
    fn evaluate(&mut self, (t, state): (f64, &[f64])) -> EnergyAndPower {
        self(t, state)
    }
}

/// Energy and power of a state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct EnergyAndPower {
    /// Energy, J.
    pub energy: f64,
    /// Power, W.
    pub power: f64,
}

impl EnergyAndPower {
    /// Reads energy and power from the observables of a model; they are the last two.
    pub fn from_observables(observables: &[f64]) -> Self {
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

/// Energy balance of a motion.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Audit {
    /// Change of the energy from the first step to the last, J.
    pub energy_change: f64,
    /// Integral of the power plus the work of contacts at impacts, J.
    pub work: f64,
    /// Change of the energy at impacts minus the work of their contacts, J; losses are negative.
    pub impact_energy: f64,
    /// Change of the energy in steps and impacts that were not audited, J.
    pub unaudited_energy: f64,
    /// Number of steps and impacts whose energy change exceeds the tolerance.
    pub fault_count: u64,
    /// First fault.
    pub first_fault: Option<Imbalance>,
    /// Largest fault.
    pub largest_fault: Option<Imbalance>,
    /// First sum of the energy differences of all steps that no correct motion can have, even if the tolerance allows
    /// each difference.
    pub drift: Option<Imbalance>,
    /// Number of evaluations of energy and power.
    pub evaluations: u64,
    /// Reason why part of the motion was not audited; `None` if all of it was.
    pub exclusion_reason: Option<String>,
}

/// Energy change that the work does not explain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Imbalance {
    /// Time, s.
    pub t: f64,
    /// Energy gained, J; negative if lost.
    pub energy_gain: f64,
    /// Energy change that errors of the solver can cause, J.
    pub tolerance: f64,
}

impl Audit {
    /// Returns the change of the energy that neither work nor impacts explain, J.
    pub fn unexplained_energy(&self) -> f64 {
        self.energy_change - self.work - self.impact_energy - self.unaudited_energy
    }

    /// Returns true if the energy changed without work.
    pub fn has_failed(&self) -> bool {
        self.fault_count > 0 || self.drift.is_some()
    }

    /// Returns a warning about the first unexplained energy change, if there is one.
    pub fn warning_message(&self) -> Option<String> {
        let Some(fault) = self.first_fault else {
            return self.drift.map(Imbalance::describe_drift);
        };
        let (verb, size) = fault.verb_and_size();
        let Imbalance { t, tolerance, .. } = fault;
        let more = match self.fault_count {
            1 => String::new(),
            count => format!(
                "; {count} steps change the energy in this way, by {:.4e} J in total",
                self.unexplained_energy()
            ),
        };
        Some(format!(
            "the motion {verb} {size:.4e} J without work at t = {t} s, but the solver's error can \
             explain only {tolerance:.1e} J{more}: check the forces and energies of the model, or reduce the tolerance"
        ))
    }

    fn note(&mut self, found: Imbalance) {
        self.fault_count += 1;
        self.first_fault.get_or_insert(found);
        let largest = self.largest_fault.get_or_insert(found);
        if found.energy_gain.abs() > largest.energy_gain.abs() {
            *largest = found;
        }
    }

    /// Removes faults up to the rounding error of the energy (J). In a motion that starts at rest, early faults have no
    /// larger energy as reference.
    fn remove_faults_up_to(&mut self, rounding: f64) {
        let is_rounding = |fault: Imbalance| fault.energy_gain.abs() <= rounding;
        if self.largest_fault.is_some_and(is_rounding) {
            self.fault_count = 0;
            (self.first_fault, self.largest_fault) = (None, None);
        }
        self.drift = self.drift.filter(|drift| !is_rounding(*drift));
    }
}

impl Imbalance {
    fn verb_and_size(self) -> (&'static str, f64) {
        let verb = match self.energy_gain < 0.0 {
            true => "loses",
            false => "gains",
        };
        (verb, self.energy_gain.abs())
    }

    fn describe_drift(self) -> String {
        let (verb, size) = self.verb_and_size();
        format!(
            "the motion {verb} {size:.4e} J without work until t = {} s, because of solver errors within the \
             tolerance of each step: reduce the tolerance",
            self.t
        )
    }
}
