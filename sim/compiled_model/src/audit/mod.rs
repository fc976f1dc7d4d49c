//! Energy audit of a motion: along every step the change of the energy is compared with the work,
//! the integral of the power. What is left and exceeds the errors that the solver's tolerance
//! allows is energy from nothing, whatever its cause.
//!
//! Changes at impacts are booked by themselves: less the work of contacts that move, they may not be gains.
//! Contacts at rest do no work unless they move with the time. A contact whose distance depends on inputs is
//! left out: it jumps where held inputs do.

mod allowed;
mod auditor;
#[cfg(test)]
mod tests;
mod work;

pub(crate) use allowed::{ERROR_FACTOR, allowed_change};
pub(crate) use auditor::Auditor;

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
    /// Integral of the power, and the work of contacts that move, J.
    pub work: f64,
    /// Change of the energy at impacts less that work, J; losses are negative.
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
