//! Linearisation of a fit over initial segments of windows or over whole windows. It is the
//! reference for the first-order responses of candidates and forces.

use crate::fit::fit_result::Fit;
use crate::fit::gauss_newton::{Estimate, evaluate_cost, residual_level};
use crate::fit::initial_states::estimate_for_unknowns;
use crate::fit::prior::{InitialStatePrior, InitialStates};
use crate::fit::sensitivity::SensitivityEvaluator;
use crate::fit::shooting::Shooting;
use crate::fit::variable_projection::StateProjection;
use crate::ids::WindowId;
use crate::model::problem::EstimationProblem;
use crate::thresholds;

/// Residual and derivatives of each window, with initial states eliminated.
pub type ProjectedWindows = Vec<Option<StateProjection>>;

/// Fit whose initial states are estimated for a fraction of each window, with derivatives. In
/// initial segments the motion is nearly linear in the unknowns.
pub struct LinearisedFit {
    /// Fraction of each window.
    pub fraction: f64,
    /// The windows.
    pub windows: Vec<WindowId>,
    /// Estimate for these segments.
    pub estimate: Estimate,
    /// Residuals and derivatives.
    pub projections: ProjectedWindows,
    /// Size of the residuals, in standard deviations.
    pub level: f64,
}

/// Linearised fit with its problem.
#[derive(Clone, Copy)]
pub struct Linearisation<'a> {
    /// Residuals and derivatives.
    pub point: &'a LinearisedFit,
    /// Problem of all fits.
    pub problem: &'a EstimationProblem<'a>,
    /// Fit that is linearised.
    pub fit: &'a Fit,
}

impl LinearisedFit {
    /// Linearises a fit over a fraction of each window.
    pub fn linearise_fit(problem: &EstimationProblem<'_>, fit: &Fit, part: f64) -> Self {
        let (prior, estimate) = estimate_initial_segments(problem, fit, part);
        let whole = fit.training_shooting(problem);
        let shooting = Shooting {
            fraction: part,
            ..whole
        };
        let all = problem.train.windows.len();
        let count = all.min(thresholds::MAX_SCREENING_WINDOWS);
        let windows: Vec<WindowId> = (0..count).map(|k| WindowId::new(k * all / count)).collect();
        let level = residual_level(&shooting, &estimate) / part.sqrt();
        let mut sensitivities = SensitivityEvaluator::new(&shooting, &estimate.theta, level);
        let base = windows
            .iter()
            .map(|window| {
                let start = &estimate.initial_states[*window];
                let linear = sensitivities.as_mut()?.linearise(*window, start)?;
                Some(StateProjection::new(&linear, &prior, *window, start))
            })
            .collect();
        Self {
            fraction: part,
            windows,
            estimate,
            projections: base,
            level,
        }
    }

    /// Removes every second window if there are many.
    pub fn thin_out(&self) -> Self {
        let every = self
            .windows
            .len()
            .div_ceil(thresholds::COMPARISON_WINDOW_COUNT)
            .max(1);
        let windows = self.windows.iter().step_by(every).copied();
        Self {
            fraction: self.fraction,
            windows: windows.collect(),
            estimate: self.estimate.clone(),
            projections: self.projections.iter().step_by(every).cloned().collect(),
            level: self.level,
        }
    }
}

/// Returns the priors of the initial states for a fraction of each window, and initial states that
/// fit these segments.
fn estimate_initial_segments(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    part: f64,
) -> (InitialStatePrior, Estimate) {
    if part == 1.0 || !problem.estimates_initial_states() {
        return (fit.prior.clone(), fit.train.estimate.clone());
    }
    let whole = fit.training_shooting(problem);
    let shooting = Shooting {
        fraction: part,
        ..whole
    };
    let theta = fit.train.estimate.theta.clone();
    let follow = estimate_for_unknowns(
        problem,
        &shooting,
        &fit.ranges,
        thresholds::PRELIMINARY_HORIZON_COUNT,
    );
    let InitialStates {
        prior,
        states: initial_states,
    } = follow(&theta, None);
    let estimate = evaluate_cost(&shooting, &prior, theta, initial_states);
    (prior, estimate)
}
