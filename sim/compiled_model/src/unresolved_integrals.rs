//! Check of a motion for integrals along a field that the quadrature does not resolve.

use eomgen_codegen::mechanics::fields::resolution::{
    MAX_ERROR, QuadratureError, State, find_largest_error_at_state, has_nonlinear_integrals,
};

use crate::error::Error;
use crate::instance::Instance;
use crate::motion::Motion;

/// Number of checked samples of a motion; each check takes as long as hundreds of evaluations.
const SAMPLES: usize = 20;

/// Sample at which an integral has a larger error than the quadrature allows.
#[derive(Clone, Debug)]
pub struct UnresolvedIntegral {
    /// Time, s.
    pub t: f64,
    /// Integral and its error.
    pub integral: QuadratureError,
}

impl UnresolvedIntegral {
    /// Returns a warning with the integrand, its error and the time.
    pub fn warning_message(&self) -> String {
        let QuadratureError {
            text, error, nodes, ..
        } = &self.integral;
        format!(
            "the {nodes} quadrature points integrate `integral({text})` with a relative error of {error:.0e} at t = {} \
             s; raise the order of the field, which adds points, or write a smoother integrand",
            self.t
        )
    }
}

impl Instance<'_> {
    /// Returns the sample with the largest integral error if this error is above [`MAX_ERROR`]. Only integrals whose
    /// integrand is not a polynomial of the motion are checked.
    ///
    /// # Errors
    /// Invalid parameter values.
    pub fn find_unresolved_integral(
        &self,
        motion: &Motion,
    ) -> Result<Option<UnresolvedIntegral>, Error> {
        if !has_nonlinear_integrals(self.model().model()) {
            return Ok(None);
        }
        let model = self.valued_model()?;
        let parameters = model.parameter_values();
        let parameters = parameters.map_err(|error| Error::from_model_error(&model, error))?;
        let trajectory = &motion.trajectory;
        let step = trajectory.times.len().div_ceil(SAMPLES).max(1);
        let samples = trajectory.times.iter().zip(&trajectory.states);
        let errors = samples.step_by(step).filter_map(|(&t, state)| {
            let at = State {
                parameters: &parameters,
                t,
                state,
                inputs: &motion.inputs.evaluate(t),
            };
            let integral = find_largest_error_at_state(&model, self.model().orders(), at)?;
            Some(UnresolvedIntegral { t, integral })
        });
        let worst = errors.max_by(|one, other| one.integral.error.total_cmp(&other.integral.error));
        Ok(worst.filter(|found| found.integral.error > MAX_ERROR))
    }
}
