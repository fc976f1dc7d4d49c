//! Simulation of the extended specification on the records. It tests the written text in addition
//! to the fit.

use crate::error::DiscoverError;
use crate::fit::fit_result::Fit;
use crate::fit::gauss_newton::{Estimate, evaluate_cost};
use crate::fit::prior::InitialStatePrior;
use crate::fit::residuals::Residuals;
use crate::fit::shooting::Shooting;
use crate::model::problem::EstimationProblem;
use eomgen_records::windows::Windows;

/// RMS residuals of a specification over all channels, in standard deviations of the noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resimulation {
    /// RMS residual of the training records.
    pub train: f64,
    /// RMS residual of the test records.
    pub test: f64,
}

/// Simulates a specification with its parameters and sensors on the windows of a fit, starting from
/// the initial states of the fit.
///
/// # Errors
///
/// An invalid text.
pub fn resimulate(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    text: &str,
) -> Result<Resimulation, DiscoverError> {
    let model = problem.compile_model(text, Some(&fit.texts.linear))?;
    let ranges = fit.map_state(&model, &fit.ranges);
    let rms = |windows: &Windows<'_>, estimate: &Estimate| {
        let shooting = Shooting::new(problem, &model, windows, &[], &ranges);
        let initial_states = estimate.initial_states.iter();
        let initial_states = initial_states
            .map(|start| fit.map_state(&model, start))
            .collect();
        let estimate = evaluate_cost(
            &shooting,
            &InitialStatePrior::default(),
            Vec::new(),
            initial_states,
        );
        Residuals::compute(&shooting, estimate).or_infinite().rms
    };
    Ok(Resimulation {
        train: rms(&problem.train, &fit.train.estimate),
        test: rms(&problem.test, &fit.test.estimate),
    })
}
