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

/// Length of a machine whose parameters and initial state contain none, relative to the typical size of a coordinate.
/// Distances of a unit roundoff of that size then count as zero.
const UNMOVED_LENGTH_FRACTION: f64 = 1e-5;

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
        let sizes = self.model.typical_sizes();
        let coordinates = self.labels().impacts[impact].coordinates.iter();
        let unmoved = coordinates.map(|place| UNMOVED_LENGTH_FRACTION * sizes[*place]);
        let lengths = lengths.map(|(_, value)| value.abs());
        lengths.chain(unmoved).fold(0.0, f64::max)
    }

    fn find_infinite_function(&self, span: (f64, f64)) -> Option<String> {
        find_infinite_function(&self.model, self.values(), span)
    }
}
