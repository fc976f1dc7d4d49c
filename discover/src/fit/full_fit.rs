//! Full fit of a specification: from a preliminary fit to estimates with uncertainties and
//! residuals on training and test records.

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
    combine, compute_step_errors, root_of_squares, shift_measurements,
};
use crate::fit::uncertainty::compute_uncertainties;
use crate::ids::WindowId;
use crate::model::estimation_model::EstimationModel;
use crate::model::problem::EstimationProblem;
use crate::model::specification_texts::SpecificationTexts;
use crate::model::unknowns::Unknown;
use crate::thresholds;
use eomgen_records::windows::Windows;

/// Starting point of a fit to whole windows.
struct StartingPoint {
    /// Prior of their initial states.
    prior: InitialStatePrior,
    /// The estimate so far.
    estimate: Estimate,
    /// True if its windows were followed anew.
    is_followed: bool,
    /// True if it leaves too much to be worth more.
    is_far: bool,
}

/// Whole windows fitted.
struct Converged {
    /// Prior of their initial states.
    prior: InitialStatePrior,
    /// Their residuals.
    residuals: Residuals,
    /// True if that is too much to be worth more.
    is_far: bool,
}

/// Fits a specification from start values `theta` and computes its residuals.
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
        preliminary_fit::fit_beginnings(problem, texts, unknowns, &[theta.to_vec()])?,
    )
}

/// Continues a preliminary fit over the whole windows.
///
/// # Errors
///
/// As [`fit_specification`].
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
    let Converged {
        mut prior,
        residuals: mut train,
        is_far,
    } = iterate_to_convergence(problem, &mut all, near, preliminary.max_rms);
    // A start that is known from the window before depends on these unknowns: it would keep the estimate in
    // place and make it too certain.
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
        // A stop that interrupted motions is no property of the fit.
        problem.stop.check_not_stopped()?;
    }
    let prior_weight = all.prior_weight;
    let estimate = &train.estimate;
    // Tangents through impacts grow without bound, secants of motions that ended in other folds are
    // too steep: either would make unknowns too certain.
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
    // A fit worse than noise does not know its unknowns better than its own misfit allows.
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
    /// The training windows, without the errors of the fixed steps.
    windows: Windows<'d>,
    /// The model for later simulations, if it needs shorter steps.
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

/// Takes the final steps, until neither the errors of the fixed steps at the estimate nor the weight of
/// the priors changes. `priors`: that of the fit, and the wide one of the final steps.
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
                root_of_squares(&combine(&errors.corrections, before, |new, old| new - old))
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
        // The misfit before these steps gave the priors their weight, which is too large after them.
        let weight = train.variance_inflation();
        if has_settled && weight > thresholds::MAX_WEIGHT_DECREASE * all.prior_weight {
            return found;
        }
        all.prior_weight = all.prior_weight.min(weight);
    }
}

/// Fits the initial states of the test windows and returns their residuals, without the errors of the
/// fixed steps unless the fit is far.
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

/// Evaluates a preliminary fit over whole windows, before they are fitted together.
fn evaluate_whole_windows(
    problem: &EstimationProblem<'_>,
    all: &Shooting<'_>,
    preliminary: &PreliminaryFit,
) -> StartingPoint {
    if let (None, true) = (
        &preliminary.whole_window_prior,
        problem.estimates_initial_states(),
    ) {
        let theta = continued_unknowns(problem, all, preliminary);
        let follow = estimate_for_unknowns(
            problem,
            all,
            &preliminary.ranges,
            thresholds::INITIAL_STATE_HORIZONS.len(),
        );
        let mut near = run_continuation(all, &[theta], &follow, thresholds::MAX_CONTINUATION_STEPS);
        // A nonlinear model costs ten times as much.
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

/// Whole windows fitted, and those followed anew that are better for it, as long as that helps and no more
/// than `most` standard deviations are left.
fn iterate_to_convergence(
    problem: &EstimationProblem<'_>,
    all: &mut Shooting<'_>,
    near: StartingPoint,
    most: f64,
) -> Converged {
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
    // The remaining residual, if treated as noise, gives the weight of the records relative to the
    // priors.
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
    Converged {
        prior,
        residuals,
        is_far,
    }
}

/// Unknowns from a preliminary fit of the beginnings of windows, as far as these lead: longer
/// windows are folded until it is near.
fn continued_unknowns(
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
        thresholds::PRELIMINARY_HORIZONS,
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

/// The windows followed anew at an estimate: those that are better for it begin there.
fn refresh_initial_states(
    problem: &EstimationProblem<'_>,
    shooting: &Shooting<'_>,
    mut prior: InitialStatePrior,
    found: Estimate,
) -> (InitialStatePrior, Estimate) {
    // Initial states that are read from the record are not followed.
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
