//! Bounds on the rounding errors of energy and power. The code of these bounds is not part of exported programs, which
//! are therefore not audited.

#[cfg(feature = "derive")]
use std::cell::OnceCell;

use eomgen_codegen::program::evaluator::{Evaluator, Point};
#[cfg(feature = "derive")]
use eomgen_codegen::rounding::PointBounds;

use super::EnergyAndPower;

/// Bounds on the rounding errors of energy and power, prepared at first use.
#[derive(Default)]
pub(crate) struct EnergyRoundings {
    #[cfg(feature = "derive")]
    bounds: OnceCell<PointBounds>,
}

impl EnergyRoundings {
    /// Returns bounds on the rounding errors at a point of the evaluator's program; 0 if there is no bound.
    #[cfg(feature = "derive")]
    pub fn bound(&self, evaluator: &Evaluator, point: Point<'_>) -> EnergyAndPower {
        let bounds = self.bounds.get_or_init(|| {
            let program = evaluator.program();
            let observed = &program.observable_values;
            PointBounds::new(program, &observed[observed.len().saturating_sub(2)..])
        });
        let numbers = std::iter::once(&point.t).chain(point.state);
        let numbers = numbers.chain(point.inputs).copied();
        let found = bounds.bound(numbers.chain(evaluator.parameter_values()));
        let found: Vec<f64> = found.into_iter().map(Option::unwrap_or_default).collect();
        EnergyAndPower::from_observables(&found)
    }

    #[cfg(not(feature = "derive"))]
    pub fn bound(&self, _: &Evaluator, _: Point<'_>) -> EnergyAndPower {
        EnergyAndPower::default()
    }
}
