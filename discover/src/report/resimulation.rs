//! The specification that was written, run on the records: what is handed on is the text, not the
//! fit from which it was written.

use crate::error::DiscoverError;
use crate::fit::fitted::Fit;
use crate::fit::gauss_newton::{Estimate, evaluated};
use crate::fit::prior::InitialStatePrior;
use crate::fit::residuals::Residuals;
use crate::fit::shooting::Shooting;
use crate::model::problem::EstimationProblem;
use eomgen_records::windows::Windows;

/// What a specification leaves, root mean squares over all channels, in standard deviations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resimulation {
    /// Of the training records.
    pub train: f64,
    /// Of the test records.
    pub test: f64,
}

/// Runs a specification's text with its own numbers on the windows of a fit, from where that begins
/// them, seen by the sensors that the text describes.
///
/// # Errors
/// What is wrong with the text.
pub fn resimulated(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    text: &str,
) -> Result<Resimulation, DiscoverError> {
    let model = problem.model(text, Some(&fit.texts.linear))?;
    let ranges = fit.mapped(&model, &fit.ranges);
    let rms = |windows: &Windows<'_>, estimate: &Estimate| {
        let shooting = Shooting::new(problem, &model, windows, &[], &ranges);
        let initial_states = estimate.initial_states.iter();
        let initial_states = initial_states
            .map(|start| fit.mapped(&model, start))
            .collect();
        let estimate = evaluated(
            &shooting,
            &InitialStatePrior::default(),
            Vec::new(),
            initial_states,
        );
        Residuals::of(&shooting, estimate).whole().rms
    };
    Ok(Resimulation {
        train: rms(&problem.train, &fit.train.estimate),
        test: rms(&problem.test, &fit.test.estimate),
    })
}
