//! Triangular factor of the information matrix of a set of windows.

use nalgebra::DMatrix;

use crate::fit::fit_result::Fit;
use crate::fit::gauss_newton::compute_derivatives;
use crate::fit::prior::InitialStatePrior;
use crate::fit::sensitivity::WindowDerivatives;
use crate::fit::shooting::Shooting;
use crate::fit::variable_projection::{compute_triangular_factor, eliminate_initial_state};
use crate::ids::WindowId;
use crate::model::problem::EstimationProblem;
use crate::thresholds;

/// Returns a triangular R; R'R is the information of windows and priors on the unknowns, with free
/// initial states. A change d of the unknowns increases the cost by |R d|^2 squared standard
/// deviations.
pub(crate) fn compute_information_factor(
    shooting: &Shooting<'_>,
    prior: &InitialStatePrior,
    initial_states: &[Vec<f64>],
    linear: &[Option<WindowDerivatives>],
) -> DMatrix<f64> {
    let count = shooting.unknowns.len();
    let mut rows = DMatrix::zeros(count, count);
    for (row, unknown) in shooting.unknowns.iter().enumerate() {
        let sd = unknown.prior.map_or(f64::INFINITY, |prior| prior.sd);
        rows[(row, row)] = shooting.prior_weight.sqrt() / sd;
    }
    let mut factor = DMatrix::zeros(count + 1, count + 1);
    for (window, linear) in WindowId::first(linear.len()).zip(linear) {
        if let Some(linear) = linear {
            let block = eliminate_initial_state(linear, prior, window, &initial_states[window]);
            factor = compute_triangular_factor(&factor, &block.reduced_columns());
        }
    }
    let factor = factor.view((0, 0), (count, count)).into_owned();
    compute_triangular_factor(&factor, &rows)
}

/// Returns the information factor of the training windows of a fit, reduced by its misfit.
pub fn compute_fit_information(problem: &EstimationProblem<'_>, fit: &Fit) -> DMatrix<f64> {
    let shooting = Shooting {
        prior_weight: fit.prior_weight,
        ..fit.training_shooting(problem)
    };
    let estimate = &fit.train.estimate;
    let linear = compute_derivatives(&shooting, estimate);
    let factor =
        compute_information_factor(&shooting, &fit.prior, &estimate.initial_states, &linear);
    let inflation = fit.train.variance_inflation();
    factor / (thresholds::UNCERTAINTY_FACTOR * inflation.sqrt())
}
