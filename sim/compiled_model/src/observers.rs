//! Observers of the steps of a motion: the energy audit and the meters.

use crate::audit::{Audit, Auditor};
use crate::statistics::Meters;

/// Observers of a motion in progress.
#[derive(Debug, Default)]
pub(crate) struct Observers {
    pub auditor: Option<Auditor>,
    pub meters: Meters,
}

/// Results of the observers of a motion.
#[derive(Default)]
pub(crate) struct Results {
    pub audit: Option<Audit>,
    pub measured: Vec<Option<f64>>,
}

impl Observers {
    pub fn is_empty(&self) -> bool {
        self.auditor.is_none() && self.meters.is_empty()
    }

    pub fn results(&self) -> Results {
        Results {
            audit: self.auditor.as_ref().map(|own| own.audit()),
            measured: self.meters.results(),
        }
    }

    /// Continues with a solver of another relative tolerance.
    pub fn continue_with(&mut self, tolerance: f64) {
        if let Some(auditor) = &mut self.auditor {
            auditor.continue_with(tolerance);
        }
        self.meters.continue_with(tolerance);
    }
}
