//! Preliminary fits: to the initial segments of windows, or by a linear prediction.

use crate::error::DiscoverError;
use crate::fit::continuation::run_continuation;
use crate::fit::fit_result::Fit;
use crate::fit::gauss_newton::{run_damped_gauss_newton, sum_of_squares};
use crate::fit::initial_states::{self, estimate_for_unknowns, fit_first_states, prior_sd};
use crate::fit::prior::{InitialStatePrior, InitialStates};
use crate::fit::shooting::Shooting;
use crate::model::estimation_model::EstimationModel;
use crate::model::problem::EstimationProblem;
use crate::model::specification_texts::SpecificationTexts;
use crate::model::unknowns::Unknown;
use crate::thresholds;
use eomgen_records::dataset::Initial;

/// Specification fitted to the initial segments of the windows.
pub struct PreliminaryFit {
    /// Cost with the priors, in squared standard deviations.
    pub cost: f64,
    /// Prior of the initial states of whole windows, if they are already estimated.
    pub(crate) whole_window_prior: Option<InitialStatePrior>,
    /// RMS residual of whole windows above which the initial states are not estimated again, in
    /// standard deviations.
    pub(crate) max_rms: f64,
    /// True if further steps over the initial segments would decrease the cost only slightly.
    pub(crate) is_converged: bool,
    pub(crate) texts: SpecificationTexts,
    pub(crate) model: EstimationModel,
    pub(crate) unknowns: Vec<Unknown>,
    pub(crate) ranges: Vec<f64>,
    pub(crate) theta: Vec<f64>,
    pub(crate) initial_states: Vec<Vec<f64>>,
}

/// Fit whose initial states are the initial values of another fit.
#[derive(Clone, Copy)]
pub struct WarmStart<'f> {
    /// Fit with the initial states.
    pub fit: &'f Fit,
    /// Expected cost of the other fit, in squared standard deviations.
    pub cost: f64,
    /// RMS residual of the training records above which the other fit does not estimate the initial
    /// states again, in standard deviations.
    pub max_rms: f64,
}

/// Fits the unknowns to the initial segments of the windows, which compares candidates at a
/// fraction of the cost of a full fit. `texts`: texts of the specification and of its linear part;
/// `guesses`: sets of initial values, of which the best is used.
///
/// # Errors
///
/// Errors of [`crate::fit::full_fit::fit_specification`].
pub fn fit_initial_segments(
    problem: &EstimationProblem<'_>,
    texts: SpecificationTexts,
    unknowns: Vec<Unknown>,
    guesses: &[Vec<f64>],
) -> Result<PreliminaryFit, DiscoverError> {
    let model = problem.compile_model(&texts.full, Some(&texts.linear))?;
    let ranges = find_state_ranges(problem, &model, &unknowns);
    let shooting = Shooting::new(problem, &model, &problem.train, &unknowns, &ranges);
    let (found, is_converged) = if problem.estimates_initial_states() {
        let shooting = Shooting {
            fraction: thresholds::PRELIMINARY_FRACTION,
            ..shooting
        };
        let follow = estimate_for_unknowns(
            problem,
            &shooting,
            &ranges,
            thresholds::PRELIMINARY_HORIZON_COUNT,
        );
        let found = run_continuation(
            &shooting,
            guesses,
            &follow,
            thresholds::MAX_CONTINUATION_STEPS,
        );
        (found.estimate, found.is_converged)
    } else {
        let theta = guesses.first().map_or(&[][..], Vec::as_slice);
        let InitialStates {
            prior,
            states: initial_states,
        } = initial_states::estimate_at_unknowns(
            problem,
            &shooting,
            theta,
            &ranges,
            &thresholds::INITIAL_STATE_HORIZONS,
            None,
        )?;
        let found = run_damped_gauss_newton(
            &shooting,
            &prior,
            theta,
            &initial_states,
            thresholds::MAX_PRELIMINARY_STEPS,
        );
        (found, true)
    };
    model.work.check()?;
    // Ranges of states may depend on the estimate: a more compliant joint moves farther.
    let values = shooting.parameter_values(&found.theta);
    let ranges = keep_larger(estimate_state_ranges(problem, &model, &values), &ranges);
    Ok(PreliminaryFit {
        cost: found.cost,
        whole_window_prior: None,
        max_rms: f64::INFINITY,
        is_converged,
        initial_states: found.initial_states,
        theta: found.theta,
        texts,
        model,
        unknowns,
        ranges,
    })
}

/// Starts a fit from the initial states of another fit, whose linearisation predicts the unknowns.
/// `guesses`: one or more sets of initial values. The first set with an acceptable cost relative to
/// the other fit is used, otherwise the set with the lowest cost.
///
/// # Errors
///
/// Errors of [`crate::fit::full_fit::fit_specification`].
pub fn start_from_fit(
    problem: &EstimationProblem<'_>,
    texts: SpecificationTexts,
    unknowns: Vec<Unknown>,
    guesses: &[Vec<f64>],
    warm_start: WarmStart<'_>,
) -> Result<PreliminaryFit, DiscoverError> {
    let WarmStart {
        fit,
        cost,
        max_rms: most,
    } = warm_start;
    let model = problem.compile_model(&texts.full, Some(&texts.linear))?;
    let bare = Shooting::new(problem, &model, &problem.train, &unknowns, &[]);
    let mapped = |states: &[Vec<f64>]| -> Vec<Vec<f64>> {
        states
            .iter()
            .map(|state| fit.map_state(&model, state))
            .collect()
    };
    let initial_states = mapped(&fit.train.estimate.initial_states);
    let theta = choose_initial_values(&bare, guesses, &initial_states, fit);
    let ranges = keep_larger(
        estimate_state_ranges(problem, &model, &bare.parameter_values(&theta)),
        &fit.map_state(&model, &fit.ranges),
    );
    let prior = InitialStatePrior {
        mean: mapped(&fit.prior.mean),
        sd: match fit.prior.sd.is_empty() {
            true => Vec::new(),
            false => prior_sd(&ranges),
        },
        sources: fit.prior.sources.clone(),
        whitening: None,
    };
    Ok(PreliminaryFit {
        cost,
        whole_window_prior: Some(prior),
        max_rms: most,
        is_converged: true,
        initial_states,
        theta,
        texts,
        model,
        unknowns,
        ranges,
    })
}

/// Returns the range of each state for first states that are read from the records without a fit.
fn estimate_state_ranges(
    problem: &EstimationProblem<'_>,
    model: &EstimationModel,
    values: &[f64],
) -> Vec<f64> {
    let records = problem.dataset.train.iter();
    let firsts = records.map(|record| problem.estimate_first_state(model, record));
    problem.compute_state_ranges(model, values, &firsts.collect::<Vec<Vec<f64>>>())
}

/// Returns the range of each state for the parameter values of the specification. A record may
/// start from a state that its channels do not show, for example in a free decay. First states are
/// therefore fitted with the ranges found so far, until the simulated motion stays within these
/// ranges.
fn find_state_ranges(
    problem: &EstimationProblem<'_>,
    model: &EstimationModel,
    unknowns: &[Unknown],
) -> Vec<f64> {
    let mut ranges = estimate_state_ranges(problem, model, &model.values);
    if !problem.estimates_initial_states() || problem.dataset.initial != Initial::Estimate {
        return ranges;
    }
    let theta: Vec<f64> = unknowns.iter().map(|unknown| unknown.start).collect();
    for _ in 0..thresholds::MAX_RANGE_FITS {
        let shooting = Shooting::new(problem, model, &problem.train, unknowns, &ranges);
        let firsts = fit_first_states(problem, &shooting, &theta, &ranges);
        let fitted = problem.compute_state_ranges(model, &model.values, &firsts);
        let larger = keep_larger(ranges.clone(), &fitted);
        if larger == ranges {
            break;
        }
        ranges = larger;
    }
    ranges
}

/// Replaces each range by the other estimate if this is much larger.
fn keep_larger(ranges: Vec<f64>, others: &[f64]) -> Vec<f64> {
    let pairs = ranges.into_iter().zip(others);
    pairs
        .map(
            |(range, other)| match *other > thresholds::MAX_RANGE_RATIO * range {
                true => *other,
                false => range,
            },
        )
        .collect()
}

/// Returns the first set of unknowns with an acceptable residual relative to a fit, or else the set
/// with the smallest residual. The residual can be very large: the linear prediction may be wrong,
/// and initial states are not yet fitted.
fn choose_initial_values(
    shooting: &Shooting<'_>,
    guesses: &[Vec<f64>],
    initial_states: &[Vec<f64>],
    fit: &Fit,
) -> Vec<f64> {
    if let [only] = guesses {
        return only.clone();
    }
    let near =
        thresholds::MAX_RMS_TO_CONTINUE.powi(2) * fit.train.estimate.squares.iter().sum::<f64>();
    let mut least = (f64::INFINITY, guesses.first());
    for theta in guesses {
        let residuals = shooting.compute_residuals(theta, initial_states);
        let squares = residuals.iter().map(sum_of_squares);
        let left: f64 = squares.sum();
        if left < near {
            return theta.clone();
        }
        if left < least.0 {
            least = (left, Some(theta));
        }
    }
    least.1.cloned().unwrap_or_default()
}
