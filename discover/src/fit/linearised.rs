//! Linearisation of a fit over the beginnings of windows, or over whole windows. The first-order
//! responses of candidates and forces are compared with it.

use crate::fit::fitted::Fit;
use crate::fit::gauss_newton::{Estimate, evaluated, level};
use crate::fit::initial_states::following;
use crate::fit::prior::{InitialStatePrior, InitialStates};
use crate::fit::sensitivity::SensitivityEvaluator;
use crate::fit::shooting::Shooting;
use crate::fit::variable_projection::StateProjection;
use crate::ids::WindowId;
use crate::model::problem::EstimationProblem;
use crate::thresholds;

/// Residual and derivatives of each window at the fit.
pub type Base = Vec<Option<StateProjection>>;

/// Linearisation point of candidates: beginnings of windows, in which the motion is nearly linear
/// in the unknowns, with initial states fitted to these parts.
pub struct LinearisedFit {
    /// Fraction of each window.
    pub part: f64,
    /// The windows.
    pub windows: Vec<WindowId>,
    /// Estimate for these parts.
    pub estimate: Estimate,
    /// Residuals and derivatives.
    pub base: Base,
    /// Size of the residuals, in standard deviations.
    pub level: f64,
}

/// A linearised fit with its problem.
#[derive(Clone, Copy)]
pub struct Linearisation<'a> {
    /// Derivatives of the residuals.
    pub at: &'a LinearisedFit,
    /// Problem of all fits.
    pub problem: &'a EstimationProblem<'a>,
    /// The fit.
    pub fit: &'a Fit,
}

impl LinearisedFit {
    /// Linearises a fit over a fraction of each window.
    pub fn of(problem: &EstimationProblem<'_>, fit: &Fit, part: f64) -> Self {
        let (prior, estimate) = beginnings(problem, fit, part);
        let whole = fit.shooting(problem);
        let shooting = Shooting { part, ..whole };
        let all = problem.train.list.len();
        let count = all.min(thresholds::MOST_WINDOWS);
        let windows: Vec<WindowId> = (0..count).map(|k| WindowId::new(k * all / count)).collect();
        let level = level(&shooting, &estimate) / part.sqrt();
        let mut sensitivities = SensitivityEvaluator::new(&shooting, &estimate.theta, level);
        let base = windows
            .iter()
            .map(|window| {
                let start = &estimate.initial_states[*window];
                let linear = sensitivities.as_mut()?.linear(*window, start)?;
                Some(StateProjection::new(&linear, &prior, *window, start))
            })
            .collect();
        Self {
            part,
            windows,
            estimate,
            base,
            level,
        }
    }

    /// Keeps every other window if there are many.
    pub fn with_few_windows(&self) -> Self {
        let every = self.windows.len().div_ceil(thresholds::FEW_WINDOWS).max(1);
        let windows = self.windows.iter().step_by(every).copied();
        Self {
            part: self.part,
            windows: windows.collect(),
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
