//! Instances as models of motions.

use eomgen_codegen::independence::rows::ConstraintRows;
use eomgen_codegen::program::evaluator::Evaluator;
use eomgen_model_spec::model::STABILISATION_RATE;

use crate::corners::Corners;
use crate::error::Error;
use crate::infinite_inputs::find_infinite_function;
use crate::instance::Instance;
use crate::jacobians::JacobianEvaluator;
use crate::labels::Labels;
use crate::motion_model::MotionModel;
use crate::sticking::SidedModel;

/// Length, in the SI unit of a distance, assumed for a model without parameters of that dimension. Distances below the
/// unit roundoff of one SI unit then count as zero.
const UNKNOWN_LENGTH_SI: f64 = 1e-5;

impl MotionModel for Instance<'_> {
    fn labels(&self) -> &Labels {
        self.model.labels()
    }

    fn evaluator(&self) -> Result<Evaluator, Error> {
        self.evaluator()
    }

    fn evaluator_at_stabilisation_rate(&self, rate: f64) -> Result<Evaluator, Error> {
        self.with_stabilisation_rate(rate).evaluator()
    }

    fn stabilisation_rate(&self) -> f64 {
        self.value(STABILISATION_RATE).unwrap_or(0.0)
    }

    fn sided_model(&self) -> Result<Option<SidedModel>, Error> {
        self.sided_model()
    }

    fn corners(&self) -> Result<Option<Corners>, Error> {
        self.model.corners(self.parameters())
    }

    fn constraint_rows(&self) -> Option<ConstraintRows> {
        self.constraint_rows()
    }

    fn jacobian_evaluator(&self) -> Result<Option<JacobianEvaluator>, Error> {
        self.jacobian_evaluator().map(Some)
    }

    fn largest_length(&self, impact: usize) -> f64 {
        let model = self.model.model();
        let dimension = model.impacts[impact].unit.dimension;
        let parameters = model.parameters.iter().zip(self.values());
        let lengths = parameters.filter(|(known, _)| known.unit.dimension == dimension);
        let lengths = lengths.map(|(_, value)| value.abs());
        lengths.reduce(f64::max).unwrap_or(UNKNOWN_LENGTH_SI)
    }

    fn find_infinite_function(&self, span: (f64, f64)) -> Option<String> {
        find_infinite_function(&self.model, self.values(), span)
    }
}
