//! A fit linearised over beginnings of windows, or whole ones: what candidates and forces do to
//! first order is set beside this.

use crate::fit::fitted::Fit;
use crate::fit::gauss_newton::{Estimate, evaluated, level};
use crate::fit::initial_states::following;
use crate::fit::prior::{InitialStatePrior, InitialStates};
use crate::fit::sensitivity::SensitivityEvaluator;
use crate::fit::shooting::Shooting;
use crate::fit::variable_projection::StateProjection;
use crate::model::problem::EstimationProblem;
use crate::thresholds;

/// A window at the fit: residual, derivatives by state and by unknowns.
pub type Base = Vec<Option<StateProjection>>;

/// Where candidates are looked at: beginnings of windows, over which a motion is nearly linear
/// in whatever changes it, with initial states that suit these parts.
pub struct LinearisedFit {
    /// The part of each window that is looked at.
    pub part: f64,
    /// The windows.
    pub places: Vec<usize>,
    /// The estimate there.
    pub estimate: Estimate,
    /// Residuals and derivatives.
    pub base: Base,
    /// The size of the residuals, in standard deviations.
    pub level: f64,
}

impl LinearisedFit {
    /// The beginnings of the windows at a fit, so much of each.
    pub fn of(problem: &EstimationProblem<'_>, fit: &Fit, part: f64) -> Self {
        let (prior, estimate) = beginnings(problem, fit, part);
        let whole = fit.shooting(problem);
        let shooting = Shooting { part, ..whole };
        let all = problem.train.list.len();
        let count = all.min(thresholds::MOST_WINDOWS);
        let places: Vec<usize> = (0..count).map(|k| k * all / count).collect();
        let level = level(&shooting, &estimate) / part.sqrt();
        let mut sensitivities = SensitivityEvaluator::new(&shooting, &estimate.theta, level);
        let base = places
            .iter()
            .map(|place| {
                let start = &estimate.initial_states[*place];
                let linear = sensitivities.as_mut()?.linear(*place, start)?;
                Some(StateProjection::new(&linear, &prior, *place, start))
            })
            .collect();
        Self {
            part,
            places,
            estimate,
            base,
            level,
        }
    }

    /// Every other window where there are many.
    pub fn with_few_windows(&self) -> Self {
        let every = self.places.len().div_ceil(thresholds::FEW_WINDOWS).max(1);
        let places = self.places.iter().step_by(every).copied();
        Self {
            part: self.part,
            places: places.collect(),
            estimate: self.estimate.clone(),
            base: self.base.iter().step_by(every).cloned().collect(),
            level: self.level,
        }
    }
}

/// So much of each window at a fit: what is known of initial states, and states that suit
/// these parts.
fn beginnings(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    part: f64,
) -> (InitialStatePrior, Estimate) {
    if part == 1.0 || !problem.estimates_initial_states() {
        return (fit.prior.clone(), fit.train.estimate.clone());
    }
    let whole = fit.shooting(problem);
    let shooting = Shooting { part, ..whole };
    let theta = fit.train.estimate.theta.clone();
    let follow = following(problem, &shooting, &fit.ranges, thresholds::FIRST_HORIZONS);
    let InitialStates {
        prior,
        states: initial_states,
    } = follow(&theta, None);
    let estimate = evaluated(&shooting, &prior, theta, initial_states);
    (prior, estimate)
}
