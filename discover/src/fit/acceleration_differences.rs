//! Differences between the accelerations of a model and of the model with changed parameters. They
//! drive tangent vectors.

use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_sim::exponential::DrivingAccelerations;

use crate::model::simulation::TangentDrives;

/// Model with one changed parameter.
pub(crate) struct PerturbedEvaluator<'c> {
    /// Evaluator of the equations.
    pub evaluator: &'c mut Evaluator,
    /// Change of the parameter, SI.
    pub change: f64,
}

/// Differences between the accelerations of changed models and of the base model, per unit of the
/// change, as drives of tangent vectors.
pub(crate) struct AccelerationDifferences<'c> {
    base: &'c mut Evaluator,
    moved: Vec<PerturbedEvaluator<'c>>,
    rates: [Vec<f64>; 2],
}

impl<'c> AccelerationDifferences<'c> {
    /// Combines the evaluators of the model and of the changed models.
    pub fn new(base: &'c mut Evaluator, moved: Vec<PerturbedEvaluator<'c>>) -> Self {
        let states = base.program().states();
        Self {
            base,
            moved,
            rates: [vec![0.0; states], vec![0.0; states]],
        }
    }

    /// Returns the differences as drives of tangent vectors.
    pub fn as_drives(&mut self) -> TangentDrives<'_> {
        TangentDrives {
            count: self.moved.len(),
            drives: self,
        }
    }
}

impl DrivingAccelerations for AccelerationDifferences<'_> {
    fn write_differences(&mut self, t: f64, state: &[f64], inputs: &[f64], out: &mut [f64]) {
        let [base, moved] = &mut self.rates;
        let first = self.base.program().degrees_of_freedom();
        self.base.rates(Point { t, state, inputs }, base);
        let slots = out.chunks_exact_mut((base.len() - first).max(1));
        for (of, slots) in self.moved.iter_mut().zip(slots) {
            of.evaluator.rates(Point { t, state, inputs }, moved);
            for (slot, (a, b)) in slots
                .iter_mut()
                .zip(moved[first..].iter().zip(&base[first..]))
            {
                *slot = (a - b) / of.change;
            }
        }
    }
}
