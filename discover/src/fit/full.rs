//! Full fit of a specification: from a preliminary fit to estimates with uncertainties and
//! residuals on training and test records.

use crate::error::DiscoverError;
use crate::fit::continuation::{continuation, continuation_by_secants, secants};
use crate::fit::fitted::Fit;
use crate::fit::gauss_newton::{Estimate, damped_gauss_newton, derivatives_at, evaluated};
use crate::fit::initial_states::{self, carry, following};
use crate::fit::preliminary::{self, PreliminaryFit};
use crate::fit::prior::{InitialStatePrior, InitialStates};
use crate::fit::residuals::Residuals;
use crate::fit::shooting::Shooting;
use crate::fit::uncertainty::uncertainties;
use crate::fit::whole_motions::{settled, whitening};
use crate::ids::WindowId;
use crate::model::problem::EstimationProblem;
use crate::model::specification_texts::SpecificationTexts;
use crate::model::unknowns::Unknown;
use crate::thresholds;

/// Where whole windows are fitted from.
struct StartingPoint {
    /// What is known of their initial states.
    prior: InitialStatePrior,
    /// The estimate so far.
    estimate: Estimate,
    /// Whether its windows were followed anew.
    is_followed: bool,
    /// Whether it leaves too much to be worth more.
    is_far: bool,
}

/// Whole windows fitted.
struct Converged {
    /// What is known of their initial states.
    prior: InitialStatePrior,
    /// What is left of them.
    residuals: Residuals,
    /// Whether that is too much to be worth more.
    is_far: bool,
}

/// Fits a specification from start values `theta` and computes its residuals.
///
/// # Errors
///
/// An invalid text, or a motion that cannot be simulated.
pub fn fit(
    problem: &EstimationProblem<'_>,
    texts: SpecificationTexts,
    unknowns: Vec<Unknown>,
    theta: &[f64],
) -> Result<Fit, DiscoverError> {
    complete(
        problem,
        preliminary::preliminary(problem, texts, unknowns, &[theta.to_vec()])?,
    )
}

/// Continues a preliminary fit over the whole windows.
///
/// # Errors
///
/// As [`fit`].
pub fn complete(
    problem: &EstimationProblem<'_>,
    preliminary: PreliminaryFit,
) -> Result<Fit, DiscoverError> {
    problem.stop.check()?;
    let mut all = Shooting::new(
        problem,
        &preliminary.model,
        &problem.train,
        &preliminary.unknowns,
        &preliminary.ranges,
    );
    let near = near(problem, &all, &preliminary);
    let is_followed = near.is_followed;
    let Converged {
        mut prior,
        residuals: mut train,
        is_far,
    } = converged(problem, &mut all, near, preliminary.most);
    let prior_weight = all.prior_weight;
    // A start that is known from the window before depends on these unknowns: it would keep the estimate in
    // place and make it too certain.
    let mut loose = prior.without_carried();
    let derivatives = match is_far {
        true => derivatives_at(&all, &train.estimate),
        false => {
            loose.whitening = whitening(&all, &train.estimate);
            let (estimate, derivatives) = settled(&all, &mut loose, train.estimate);
            carry(&all, &mut prior, &estimate.theta, &estimate.initial_states);
            train = Residuals::of(&all, estimate);
            derivatives
        }
    };
    let estimate = &train.estimate;
    // Tangents through impacts grow without bound, secants of motions that ended in other folds are
    // too steep: either would make unknowns too certain.
    let secants = is_followed.then(|| {
        let horizons = thresholds::HORIZONS.len();
        let follow = following(problem, &all, &preliminary.ranges, horizons);
        secants(&all, estimate, derivatives.clone(), &follow)
    });
    let linear: Vec<_> = [Some(derivatives), secants].into_iter().flatten().collect();
    let known = uncertainties(&all, &loose, estimate, &linear);
    let held_out = Shooting {
        windows: &problem.test,
        prior_weight: 1.0,
        ..all
    };
    let theta = train.estimate.theta.clone();
    let initial_states = initial_states::best(problem, &held_out, &theta, &preliminary.ranges)?;
    let test = evaluated(
        &held_out,
        &InitialStatePrior::default(),
        theta,
        initial_states,
    );
    let test = Residuals::of(&held_out, test);
    // A fit worse than noise does not know its unknowns better than its own misfit allows.
    let inflation = train.inflation();
    let numbers = problem.train.numbers();
    let sd = |wider: f64| {
        let sds = known.iter().map(|known| known.sd(wider));
        sds.map(|sd| sd * inflation.sqrt()).collect()
    };
    let by_noise = known.iter().map(|known| known.by_noise);
    Ok(Fit {
        by_alike_misfit: by_noise.map(|sd| sd * numbers.sqrt()).collect(),
        sd: sd(1.0),
        wider_sd: sd(thresholds::WIDER),
        texts: preliminary.texts,
        unknowns: preliminary.unknowns,
        ranges: preliminary.ranges,
        prior,
        prior_weight,
        train: train.whole(),
        test: test.whole(),
        model: preliminary.model,
    })
}

/// What a preliminary fit comes to over whole windows, before they are fitted together.
fn near(
    problem: &EstimationProblem<'_>,
    all: &Shooting<'_>,
    preliminary: &PreliminaryFit,
) -> StartingPoint {
    if let (None, true) = (&preliminary.whole, problem.estimates_initial_states()) {
        let theta = continued_unknowns(problem, all, preliminary);
        let follow = following(
            problem,
            all,
            &preliminary.ranges,
            thresholds::HORIZONS.len(),
        );
        let mut near = continuation(all, &[theta], &follow, thresholds::CONTINUATION_STEPS);
        // What is not linear costs ten times as much.
        if preliminary.model.is_linear() {
            continuation_by_secants(all, &mut near, &follow);
        }
        return StartingPoint {
            is_far: near.estimate.cost
                > thresholds::HOPELESS * thresholds::HOPELESS * problem.train.numbers(),
            prior: near.prior,
            estimate: near.estimate,
            is_followed: true,
        };
    }
    let prior = preliminary.whole.clone().unwrap_or_default();
    let (theta, initial_states) = (
        preliminary.theta.clone(),
        preliminary.initial_states.clone(),
    );
    let estimate = evaluated(all, &prior, theta, initial_states);
    StartingPoint {
        is_far: preliminary.whole.is_none()
            && estimate.cost
                > thresholds::HOPELESS * thresholds::HOPELESS * problem.train.numbers(),
        prior,
        estimate,
        is_followed: false,
    }
}

/// Whole windows fitted, and those followed anew that are better for it, as long as that helps and no more
/// than `most` standard deviations are left.
fn converged(
    problem: &EstimationProblem<'_>,
    all: &mut Shooting<'_>,
    near: StartingPoint,
    most: f64,
) -> Converged {
    let (mut prior, estimate) = (near.prior, near.estimate);
    let free = match near.is_far {
        true => estimate,
        false => damped_gauss_newton(
            all,
            &prior,
            &estimate.theta,
            &estimate.initial_states,
            thresholds::FULL_STEPS,
        ),
    };
    let mut residuals = Residuals::of(all, free);
    let is_far = near.is_far || residuals.rms > most;
    // What remains where records are trusted as if noise were all that they hold says how
    // far they may be trusted against the priors.
    all.prior_weight = residuals.inflation();
    for _ in 0..thresholds::REFRESHES {
        let Estimate {
            theta,
            initial_states,
            ..
        } = &residuals.estimate;
        let found = damped_gauss_newton(all, &prior, theta, initial_states, thresholds::FULL_STEPS);
        if is_far {
            residuals = Residuals::of(all, found);
            break;
        }
        let before = found.cost;
        let (new_prior, found) = refreshed(problem, all, prior, found);
        prior = new_prior;
        let is_converged = found.cost > (1.0 - thresholds::REFRESH_DECREASE) * before;
        residuals = Residuals::of(all, found);
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
        part: thresholds::FIRST_PART,
        ..*all
    };
    let theta = preliminary.theta.clone();
    let near = thresholds::AT_FLOOR * thresholds::AT_FLOOR * first.part * problem.train.numbers();
    if preliminary.is_converged && preliminary.cost < near {
        return theta;
    }
    let follow = following(
        problem,
        &first,
        &preliminary.ranges,
        thresholds::FIRST_HORIZONS,
    );
    let steps = if preliminary.is_converged {
        0
    } else {
        thresholds::FURTHER_STEPS
    };
    let mut continued = continuation(&first, &[theta], &follow, steps);
    continuation_by_secants(&first, &mut continued, &follow);
    continued.estimate.theta
}

/// The windows followed anew at an estimate: those that are better for it begin there.
fn refreshed(
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
    }) = initial_states::at_unknowns(
        problem,
        shooting,
        &found.theta,
        ranges,
        &thresholds::OTHER_HORIZONS,
        None,
    )
    else {
        return (prior, found);
    };
    let new = evaluated(shooting, &restarted, found.theta.clone(), initial_states);
    let mut initial_states = found.initial_states.clone();
    let windows = WindowId::first(initial_states.len());
    for (window, start) in windows.zip(&mut initial_states) {
        let before = found.squares[window] + prior.cost(window, start);
        let after = new.squares[window] + restarted.cost(window, &new.initial_states[window]);
        if after < before {
            start.clone_from(&new.initial_states[window]);
            prior.mean[window].clone_from(&restarted.mean[window]);
        }
    }
    carry(shooting, &mut prior, &found.theta, &initial_states);
    let found = evaluated(shooting, &prior, found.theta, initial_states);
    (prior, found)
}
