//! Model at one set of parameters, as required for its motions.

use eomgen_codegen::independence::rows::ConstraintRows;
use eomgen_codegen::program::evaluator::Evaluator;

use crate::corners::Corners;
use crate::error::Error;
use crate::jacobians::JacobianEvaluator;
use crate::labels::Labels;
use crate::sticking::SidedModel;

/// Model at one set of parameters, as required for its motions. An [`Instance`](crate::Instance) derives the programs
/// at first use; exported models contain them.
pub(crate) trait MotionModel {
    fn labels(&self) -> &Labels;

    /// Returns an evaluator of the rates.
    ///
    /// # Errors
    /// [`Error::Request`] if the mass matrix is not positive definite.
    fn evaluator(&self) -> Result<Evaluator, Error>;

    /// Returns an evaluator in which the residuals of constraints decay at the given rate, 1/s.
    ///
    /// # Errors
    /// See [`MotionModel::evaluator`].
    fn evaluator_at_stabilisation_rate(&self, rate: f64) -> Result<Evaluator, Error>;

    /// Returns the decay rate of the residuals of constraints, 1/s.
    fn stabilisation_rate(&self) -> f64;

    /// Returns the model with the sides of its surfaces as inputs; `None` without surfaces.
    ///
    /// # Errors
    /// Inadmissible parameter values.
    fn sided_model(&self) -> Result<Option<SidedModel>, Error>;

    /// Returns the corners of the motion; `None` if no momentum can jump.
    ///
    /// # Errors
    /// Terms that cannot be derived.
    fn corners(&self) -> Result<Option<Corners>, Error>;

    /// Returns the derivatives of the constraints; `None` without constraints.
    fn constraint_rows(&self) -> Option<ConstraintRows>;

    /// Returns the Jacobians; `None` if solvers must use finite differences.
    ///
    /// # Errors
    /// Terms that cannot be differentiated.
    fn jacobian_evaluator(&self) -> Result<Option<JacobianEvaluator>, Error>;

    /// Returns the largest magnitude of the parameters with the dimension of an impact's distance, SI. Without such a
    /// parameter, returns a length whose rounding error is the unit roundoff of one SI unit.
    fn largest_length(&self, impact: usize) -> f64;

    /// Returns the message for a function of time that is not finite where a motion over a time span (s) ended.
    fn find_infinite_function(&self, span: (f64, f64)) -> Option<String>;
}
