//! Results of the energy audit in `simulate`, as warnings and JSON.

use eomgen_compiled_model::{Audit, Imbalance, Instance, Motion, Overlap};
use serde_json::{Value, json};

use crate::error::{Result, warn};

/// Result of the audit of a motion.
pub struct AuditResult<'m> {
    audit: Option<&'m Audit>,
    overlap: Option<Overlap>,
}

impl<'m> AuditResult<'m> {
    /// Audits a motion; `tolerance` is the relative tolerance of its solver.
    pub fn new(run: &Instance<'_>, motion: &'m Motion, tolerance: f64) -> Result<Self> {
        Ok(Self {
            audit: motion.audit.as_ref(),
            overlap: run.find_first_overlap(motion, tolerance)?,
        })
    }

    pub fn has_failed(&self) -> bool {
        self.overlap.is_some() || self.audit.is_some_and(Audit::has_failed)
    }

    pub fn warn(&self) {
        if let Some(warning) = self.audit.and_then(Audit::warning_message) {
            warn(&format!("warning: {warning}"));
        }
        if let Some(overlap) = &self.overlap {
            warn(&format!("warning: {}", overlap.warning_message()));
        }
    }

    /// Returns the energy balance as JSON; null if it was not computed.
    pub fn json(&self) -> Value {
        let Some(audit) = self.audit else {
            return Value::Null;
        };
        let overlap = self.overlap.as_ref().map(|overlap| {
            json!({
                "impact": overlap.impact,
                "t": overlap.t,
                "distance": overlap.distance,
                "tolerance": overlap.tolerance,
            })
        });
        let imbalance = |fault: Imbalance| json!({ "t": fault.t, "size": fault.energy_gain, "tolerance": fault.tolerance });
        json!({
            "energy_change": audit.energy_change,
            "work": audit.work,
            "impacts": audit.impact_energy,
            "unchecked": audit.unaudited_energy,
            "residual": audit.unexplained_energy(),
            "faults": audit.fault_count,
            "largest_fault": audit.largest_fault.map(imbalance),
            "drift": audit.drift.map(imbalance),
            "overlap": overlap,
            "not_applicable": audit.exclusion_reason,
            "evaluations": audit.evaluations,
        })
    }
}
