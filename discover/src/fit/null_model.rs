//! Null model: the specification fitted with its declared unknowns only.

use crate::error::{DiscoverError, Unfollowed};
use crate::fit::fitted::Fit;
use crate::fit::full;
use crate::fit::preliminary::{self, WarmStart};
use crate::interval::Interval;
use crate::model::problem::EstimationProblem;
use crate::model::specification_texts::SpecificationTexts;
use crate::model::unknowns::{Unknown, What, of_null_model};

/// Fits the model with its declared unknowns only.
///
/// # Errors
///
/// The windows and the reason if the motion cannot be simulated.
pub fn null_fit(problem: &EstimationProblem<'_>, text: &str) -> Result<Fit, DiscoverError> {
    let model = problem.model(text, None)?;
    let values: Vec<(String, f64)> = model
        .parameters
        .iter()
        .cloned()
        .zip(model.values.iter().copied())
        .collect();
    let unknowns = of_null_model(problem.dataset, model.specification(), &values);
    let theta: Vec<f64> = unknowns.iter().map(|unknown| unknown.start).collect();
    let texts = || SpecificationTexts::of(text);
    // Sensors that are free from the first step on find what is off by much, and now and then
    // stand in for what parameters have not done yet: those that wait do not.
    let held = |unknown: &Unknown| match unknown.what {
        What::Parameter(_) | What::Inverse(_) => unknown.clone(),
        What::Gain(_) | What::Bias(_) | What::Delay(_) | What::InputDelay => Unknown {
            bounds: Interval::new(unknown.start, unknown.start),
            ..unknown.clone()
        },
    };
    let waiting = || -> Result<Fit, DiscoverError> {
        let held = unknowns.iter().map(held).collect();
        let fit = full::fit(problem, texts(), held, &theta)?;
        let theta = fit.train.estimate.theta.clone();
        let warm_start = WarmStart {
            fit: &fit,
            cost: fit.train.estimate.cost,
            most: f64::INFINITY,
        };
        full::complete(
            problem,
            preliminary::expected(problem, texts(), unknowns.clone(), &[theta], warm_start)?,
        )
    };
    let (free, waiting) = rayon::join(
        || full::fit(problem, texts(), unknowns.clone(), &theta),
        waiting,
    );
    let fit = match (free, waiting) {
        (Ok(free), Ok(waiting)) if waiting.train.estimate.cost < free.train.estimate.cost => {
            waiting
        }
        (Ok(fit), _) | (Err(_), Ok(fit)) => fit,
        (Err(error), Err(_)) => return Err(error),
    };
    let lost = Unfollowed::of(&problem.train, &fit.train.unfollowed)
        .or_else(|| Unfollowed::of(&problem.test, &fit.test.unfollowed));
    match lost {
        Some(windows) => Err(DiscoverError::Unfollowed(windows)),
        None => Ok(fit),
    }
}
