//! What drives neighbouring motions: how the accelerations of neighbouring models differ.

use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_sim::exponential::Drives;

use crate::model::simulation::NeighbourDrives;

/// The equations of a neighbouring model.
pub(crate) struct MovedEvaluator<'c> {
    /// The equations.
    pub evaluator: &'c mut Evaluator,
    /// By how much a parameter differs, SI.
    pub size: f64,
}

/// Differences between the accelerations of a model and of others, per size, as drives of
/// neighbouring motions.
pub(crate) struct AccelerationDifferences<'c> {
    base: &'c mut Evaluator,
    moved: Vec<MovedEvaluator<'c>>,
    rates: [Vec<f64>; 2],
}

impl<'c> AccelerationDifferences<'c> {
    /// Others with the sizes by which they differ.
    pub fn new(base: &'c mut Evaluator, moved: Vec<MovedEvaluator<'c>>) -> Self {
        let states = base.program().states();
        Self {
            base,
            moved,
            rates: [vec![0.0; states], vec![0.0; states]],
        }
    }

    /// Each as the drive of a neighbouring motion.
    pub fn drives(&mut self) -> NeighbourDrives<'_> {
        NeighbourDrives {
            count: self.moved.len(),
            drives: self,
        }
    }
}

impl Drives for AccelerationDifferences<'_> {
    fn at(&mut self, t: f64, state: &[f64], inputs: &[f64], out: &mut [f64]) {
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
                *slot = (a - b) / of.size;
            }
        }
    }
}
