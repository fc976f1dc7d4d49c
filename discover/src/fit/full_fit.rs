//! Full fit of a specification: continues a preliminary fit over whole windows and computes
//! uncertainties and residuals of training and test records.

use crate::error::DiscoverError;
use crate::fit::continuation::{continue_by_secants, replace_by_secants, run_continuation};
use crate::fit::final_steps::{compute_whitening, run_final_steps};
use crate::fit::fit_result::Fit;
use crate::fit::gauss_newton::{
    Estimate, compute_derivatives, evaluate_cost, run_damped_gauss_newton,
};
use crate::fit::initial_states::{self, estimate_for_unknowns, update_carried_prior};
use crate::fit::preliminary_fit::{self, PreliminaryFit};
use crate::fit::prior::{InitialStatePrior, InitialStates};
use crate::fit::residuals::Residuals;
use crate::fit::sensitivity::WindowDerivatives;
use crate::fit::shooting::Shooting;
use crate::fit::step_refinement::{
    combine, compute_root_of_squares, compute_step_errors, shift_measurements,
};
use crate::fit::uncertainty::compute_uncertainties;
use crate::ids::WindowId;
use crate::model::estimation_model::EstimationModel;
use crate::model::problem::EstimationProblem;
use crate::model::specification_texts::SpecificationTexts;
use crate::model::unknowns::Unknown;
use crate::thresholds;
use eomgen_records::windows::Windows;

/// Initial values of a fit to whole windows.
struct StartingPoint {
    /// Prior of the initial states.
    prior: InitialStatePrior,
    /// Estimate so far.
    estimate: Estimate,
    /// True if the initial states were estimated again for whole windows.
    is_followed: bool,
    /// True if the residual is too large for further steps.
    is_far: bool,
}

/// Result of the fit to whole windows.
struct ConvergedFit {
    /// Prior of the initial states.
    prior: InitialStatePrior,
    /// Residuals.
    residuals: Residuals,
    /// True if the residual is too large for further steps.
    is_far: bool,
}

/// Fits a specification from initial values `theta` and computes its residuals.
///
/// # Errors
///
/// An invalid text, or a motion that cannot be simulated.
pub fn fit_specification(
    problem: &EstimationProblem<'_>,
    texts: SpecificationTexts,
    unknowns: Vec<Unknown>,
    theta: &[f64],
) -> Result<Fit, DiscoverError> {
    complete_fit(
        problem,
        preliminary_fit::fit_initial_segments(problem, texts, unknowns, &[theta.to_vec()])?,
    )
}

/// Continues a preliminary fit over whole windows.
///
/// # Errors
///
/// Errors of [`fit_specification`].
pub fn complete_fit(
    problem: &EstimationProblem<'_>,
    preliminary: PreliminaryFit,
) -> Result<Fit, DiscoverError> {
    problem.stop.check_not_stopped()?;
    let mut all = Shooting::new(
        problem,
        &preliminary.model,
        &problem.train,
        &preliminary.unknowns,
        &preliminary.ranges,
    );
    let near = evaluate_whole_windows(problem, &all, &preliminary);
    let is_followed = near.is_followed;
    let ConvergedFit {
        mut prior,
        residuals: mut train,
        is_far,
    } = iterate_to_convergence(problem, &mut all, near, preliminary.max_rms);
    // Priors from preceding windows depend on the unknowns. They would hold the estimate at its
    // value and make it too certain.
    let mut loose = prior.without_preceding(&train.estimate.initial_states);
    let FinalSteps {
        windows,
        refined,
        derivatives,
    } = match is_far {
        true => FinalSteps {
            derivatives: compute_derivatives(&all, &train.estimate),
            ..FinalSteps::new(&problem.train)
        },
        false => take_final_steps(problem, &mut all, [&mut prior, &mut loose], &mut train),
    };
    all.windows = &windows;
    if !train.failed_windows.is_empty() {
        // Simulations also fail after a stop request. In this case the fit is not evaluated.
        problem.stop.check_not_stopped()?;
    }
    let prior_weight = all.prior_weight;
    let estimate = &train.estimate;
    // Two kinds of derivatives may fail with impacts and would make unknowns too certain. Tangent
    // vectors grow without bound, and secants are too steep if the motions end in different local
    // minima. The larger uncertainty is used.
    let secants = is_followed.then(|| {
        let horizons = thresholds::INITIAL_STATE_HORIZONS.len();
        let follow = estimate_for_unknowns(problem, &all, &preliminary.ranges, horizons);
        replace_by_secants(&all, estimate, derivatives.clone(), &follow)
    });
    let linear: Vec<_> = [Some(derivatives), secants].into_iter().flatten().collect();
    let known = compute_uncertainties(&all, &loose, estimate, &linear);
    let held_out = Shooting {
        windows: &problem.test,
        prior_weight: 1.0,
        ..all
    };
    let theta = train.estimate.theta.clone();
    let test = evaluate_held_out(problem, held_out, theta, &preliminary.ranges, is_far)?;
    preliminary.model.work.check()?;
    // If the residual exceeds the noise, the uncertainty increases with the misfit.
    let inflation = train.variance_inflation();
    let numbers = problem.train.measurement_count();
    let sd = |wider: f64| {
        let sds = known.iter().map(|known| known.combine(wider));
        sds.map(|sd| sd * inflation.sqrt()).collect()
    };
    let by_noise = known.iter().map(|known| known.from_noise);
    Ok(Fit {
        misfit_sensitivity: by_noise.map(|sd| sd * numbers.sqrt()).collect(),
        sd: sd(1.0),
        effect_sd: sd(thresholds::UNCERTAINTY_FACTOR),
        texts: preliminary.texts,
        unknowns: preliminary.unknowns,
        ranges: preliminary.ranges,
        prior,
        prior_weight,
        train: train.or_infinite(),
        test: test.or_infinite(),
        model: refined.unwrap_or(preliminary.model).without_work_limit(),
    })
}

/// Windows and derivatives of the final steps.
struct FinalSteps<'d> {
    /// Training windows, corrected for the errors of the fixed steps.
    windows: Windows<'d>,
    /// Model for later simulations, if it needs shorter steps.
    refined: Option<EstimationModel>,
    /// Derivatives at the estimate.
    derivatives: Vec<Option<WindowDerivatives>>,
}

impl<'d> FinalSteps<'d> {
    fn new(windows: &Windows<'d>) -> Self {
        Self {
            windows: windows.clone(),
            refined: None,
            derivatives: Vec::new(),
        }
    }
}

/// Takes final steps until the errors of the fixed steps and the weight of the priors no longer
/// change. `priors`: prior of the fit, and the wide prior of the final steps.
fn take_final_steps<'d>(
    problem: &EstimationProblem<'d>,
    all: &mut Shooting<'_>,
    [prior, loose]: [&mut InitialStatePrior; 2],
    train: &mut Residuals,
) -> FinalSteps<'d> {
    let mut found = FinalSteps::new(&problem.train);
    let mut corrections: Option<Vec<Vec<f64>>> = None;
    let mut change = f64::INFINITY;
    loop {
        let mut has_settled = true;
        if let Some(errors) = compute_step_errors(all, &train.estimate) {
            let moved = corrections.as_ref().map(|before| {
                compute_root_of_squares(&combine(&errors.corrections, before, |new, old| new - old))
            });
            has_settled = moved
                .is_some_and(|moved| moved < thresholds::MAX_SUMMED_STEP_ERROR || moved >= change);
            change = moved.unwrap_or(f64::INFINITY);
            found.windows = shift_measurements(&problem.train, &problem.noise, &errors.corrections);
            found.refined = errors.refined;
            corrections = Some(errors.corrections);
        }
        let shifted = Shooting {
            windows: &found.windows,
            ..*all
        };
        loose.whitening = compute_whitening(&shifted, &train.estimate);
        let from = std::mem::take(&mut train.estimate);
        let (estimate, derivatives) = run_final_steps(&shifted, loose, from);
        update_carried_prior(&shifted, prior, &estimate.theta, &estimate.initial_states);
        *train = Residuals::compute(&shifted, estimate);
        found.derivatives = derivatives;
        // The weight of the priors was computed from the misfit before these steps, and may be too
        // large after them.
        let weight = train.variance_inflation();
        if has_settled && weight > thresholds::MAX_WEIGHT_DECREASE * all.prior_weight {
            return found;
        }
        all.prior_weight = all.prior_weight.min(weight);
    }
}

/// Fits the initial states of the test windows and returns their residuals. If the fit is near the
/// records, they are corrected for the errors of the fixed steps.
fn evaluate_held_out(
    problem: &EstimationProblem<'_>,
    held_out: Shooting<'_>,
    theta: Vec<f64>,
    ranges: &[f64],
    is_far: bool,
) -> Result<Residuals, DiscoverError> {
    let follow = |shooting: &Shooting<'_>| -> Result<Estimate, DiscoverError> {
        let states = initial_states::estimate_best(problem, shooting, &theta, ranges)?;
        let prior = InitialStatePrior::default();
        Ok(evaluate_cost(shooting, &prior, theta.clone(), states))
    };
    let found = follow(&held_out)?;
    let errors = match is_far {
        true => None,
        false => compute_step_errors(&held_out, &found),
    };
    let Some(errors) = errors else {
        return Ok(Residuals::compute(&held_out, found));
    };
    let windows = shift_measurements(&problem.test, &problem.noise, &errors.corrections);
    let shifted = Shooting {
        windows: &windows,
        ..held_out
    };
    Ok(Residuals::compute(&shifted, follow(&shifted)?))
}

/// Evaluates a preliminary fit over whole windows before the joint fit of these windows.
fn evaluate_whole_windows(
    problem: &EstimationProblem<'_>,
    all: &Shooting<'_>,
    preliminary: &PreliminaryFit,
) -> StartingPoint {
    if let (None, true) = (
        &preliminary.whole_window_prior,
        problem.estimates_initial_states(),
    ) {
        let theta = continue_initial_segments(problem, all, preliminary);
        let follow = estimate_for_unknowns(
            problem,
            all,
            &preliminary.ranges,
            thresholds::INITIAL_STATE_HORIZONS.len(),
        );
        let mut near = run_continuation(all, &[theta], &follow, thresholds::MAX_CONTINUATION_STEPS);
        // For a nonlinear model, secants cost ten times as much.
        if preliminary.model.is_linear() {
            continue_by_secants(all, &mut near, &follow);
        }
        return StartingPoint {
            is_far: near.estimate.cost
                > thresholds::MAX_RMS_TO_CONTINUE
                    * thresholds::MAX_RMS_TO_CONTINUE
                    * problem.train.measurement_count(),
            prior: near.prior,
            estimate: near.estimate,
            is_followed: true,
        };
    }
    let prior = preliminary.whole_window_prior.clone().unwrap_or_default();
    let (theta, initial_states) = (
        preliminary.theta.clone(),
        preliminary.initial_states.clone(),
    );
    let estimate = evaluate_cost(all, &prior, theta, initial_states);
    StartingPoint {
        is_far: preliminary.whole_window_prior.is_none()
            && estimate.cost
                > thresholds::MAX_RMS_TO_CONTINUE
                    * thresholds::MAX_RMS_TO_CONTINUE
                    * problem.train.measurement_count(),
        prior,
        estimate,
        is_followed: false,
    }
}

/// Fits whole windows. Initial states are estimated again while this decreases the cost and the RMS
/// residual is at most `most` standard deviations.
fn iterate_to_convergence(
    problem: &EstimationProblem<'_>,
    all: &mut Shooting<'_>,
    near: StartingPoint,
    most: f64,
) -> ConvergedFit {
    let (mut prior, estimate) = (near.prior, near.estimate);
    let free = match near.is_far {
        true => estimate,
        false => run_damped_gauss_newton(
            all,
            &prior,
            &estimate.theta,
            &estimate.initial_states,
            thresholds::MAX_FULL_STEPS,
        ),
    };
    let mut residuals = Residuals::compute(all, free);
    let is_far = near.is_far || residuals.rms > most;
    // The remaining residual is treated as noise. It determines the weight of the records relative
    // to the priors.
    all.prior_weight = residuals.variance_inflation();
    for _ in 0..thresholds::MAX_REFRESHES {
        let Estimate {
            theta,
            initial_states,
            ..
        } = &residuals.estimate;
        let found = run_damped_gauss_newton(
            all,
            &prior,
            theta,
            initial_states,
            thresholds::MAX_FULL_STEPS,
        );
        if is_far {
            residuals = Residuals::compute(all, found);
            break;
        }
        let before = found.cost;
        let (new_prior, found) = refresh_initial_states(problem, all, prior, found);
        prior = new_prior;
        let is_converged = found.cost > (1.0 - thresholds::MIN_REFRESH_DECREASE) * before;
        residuals = Residuals::compute(all, found);
        if is_converged {
            break;
        }
    }
    ConvergedFit {
        prior,
        residuals,
        is_far,
    }
}

/// Continues the fit of the initial segments of windows with further steps until it is near the
/// noise. In longer windows, impacts make the outputs irregular for distant unknowns.
fn continue_initial_segments(
    problem: &EstimationProblem<'_>,
    all: &Shooting<'_>,
    preliminary: &PreliminaryFit,
) -> Vec<f64> {
    let first = Shooting {
        fraction: thresholds::PRELIMINARY_FRACTION,
        ..*all
    };
    let theta = preliminary.theta.clone();
    let near = thresholds::MAX_FLOOR_RATIO_AT_FLOOR
        * thresholds::MAX_FLOOR_RATIO_AT_FLOOR
        * first.fraction
        * problem.train.measurement_count();
    if preliminary.is_converged && preliminary.cost < near {
        return theta;
    }
    let follow = estimate_for_unknowns(
        problem,
        &first,
        &preliminary.ranges,
        thresholds::PRELIMINARY_HORIZON_COUNT,
    );
    let steps = if preliminary.is_converged {
        0
    } else {
        thresholds::MAX_FURTHER_STEPS
    };
    let mut continued = run_continuation(&first, &[theta], &follow, steps);
    continue_by_secants(&first, &mut continued, &follow);
    continued.estimate.theta
}

/// Estimates the initial states again at an estimate. Each window keeps the initial state with the
/// lower cost.
fn refresh_initial_states(
    problem: &EstimationProblem<'_>,
    shooting: &Shooting<'_>,
    mut prior: InitialStatePrior,
    found: Estimate,
) -> (InitialStatePrior, Estimate) {
    // Initial states that are read from the record are not estimated.
    let Some(ranges) = shooting.ranges else {
        return (prior, found);
    };
    let Ok(InitialStates {
        prior: restarted,
        states: initial_states,
    }) = initial_states::estimate_at_unknowns(
        problem,
        shooting,
        &found.theta,
        ranges,
        &thresholds::OTHER_INITIAL_STATE_HORIZONS,
        None,
    )
    else {
        return (prior, found);
    };
    let new = evaluate_cost(shooting, &restarted, found.theta.clone(), initial_states);
    let mut initial_states = found.initial_states.clone();
    let windows = WindowId::first(initial_states.len());
    for (window, start) in windows.zip(&mut initial_states) {
        let before = found.squares[window] + prior.compute_cost(window, start);
        let after =
            new.squares[window] + restarted.compute_cost(window, &new.initial_states[window]);
        if after < before {
            start.clone_from(&new.initial_states[window]);
            prior.mean[window].clone_from(&restarted.mean[window]);
        }
    }
    update_carried_prior(shooting, &mut prior, &found.theta, &initial_states);
    let found = evaluate_cost(shooting, &prior, found.theta, initial_states);
    (prior, found)
}
