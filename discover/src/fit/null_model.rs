//! Null model: the specification fitted with its declared unknowns only.

use crate::error::{DiscoverError, FailedWindows};
use crate::fit::fit_result::Fit;
use crate::fit::full_fit;
use crate::fit::preliminary_fit::{self, WarmStart};
use crate::interval::Interval;
use crate::model::problem::EstimationProblem;
use crate::model::specification_texts::SpecificationTexts;
use crate::model::unknowns::{Unknown, UnknownKind, list_null_unknowns};

/// Fits the model with its declared unknowns only.
///
/// # Errors
///
/// The windows that cannot be simulated, and the reason.
pub fn fit_null_model(problem: &EstimationProblem<'_>, text: &str) -> Result<Fit, DiscoverError> {
    let model = problem.compile_model(text, None)?;
    let values: Vec<(String, f64)> = model
        .parameters
        .iter()
        .cloned()
        .zip(model.values.iter().copied())
        .collect();
    let unknowns = list_null_unknowns(problem.dataset, model.specification(), &values);
    let theta: Vec<f64> = unknowns.iter().map(|unknown| unknown.start).collect();
    let texts = || SpecificationTexts::from_text(text);
    // The fit is repeated with sensors that are free from the first step or only later. Sensors
    // that are free from the first step find large sensor errors, but sometimes absorb the effect
    // of parameters that have not converged.
    let held = |unknown: &Unknown| match unknown.kind {
        UnknownKind::Parameter(_) | UnknownKind::InverseParameter(_) => unknown.clone(),
        UnknownKind::Gain(_)
        | UnknownKind::Bias(_)
        | UnknownKind::Delay(_)
        | UnknownKind::InputDelay => Unknown {
            bounds: Interval::new(unknown.start, unknown.start),
            ..unknown.clone()
        },
    };
    let waiting = || -> Result<Fit, DiscoverError> {
        let held = unknowns.iter().map(held).collect();
        let fit = full_fit::fit_specification(problem, texts(), held, &theta)?;
        let theta = fit.train.estimate.theta.clone();
        let warm_start = WarmStart {
            fit: &fit,
            cost: fit.train.estimate.cost,
            max_rms: f64::INFINITY,
        };
        full_fit::complete_fit(
            problem,
            preliminary_fit::start_from_fit(
                problem,
                texts(),
                unknowns.clone(),
                &[theta],
                warm_start,
            )?,
        )
    };
    let (free, waiting) = rayon::join(
        || full_fit::fit_specification(problem, texts(), unknowns.clone(), &theta),
        waiting,
    );
    let fit = match (free, waiting) {
        (Ok(free), Ok(waiting)) if waiting.train.estimate.cost < free.train.estimate.cost => {
            waiting
        }
        (Ok(fit), _) | (Err(_), Ok(fit)) => fit,
        (Err(error), Err(_)) => return Err(error),
    };
    let lost = FailedWindows::from_windows(&problem.train, &fit.train.failed_windows)
        .or_else(|| FailedWindows::from_windows(&problem.test, &fit.test.failed_windows));
    match lost {
        Some(windows) => Err(DiscoverError::SimulationFailed(windows)),
        None => Ok(fit),
    }
}
