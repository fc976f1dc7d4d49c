//! Fits before they are made in full: to the beginnings of windows, or as a straight line promises
//! them.

use crate::error::DiscoverError;
use crate::fit::continuation::continuation;
use crate::fit::fitted::Fit;
use crate::fit::gauss_newton::{damped_gauss_newton, square};
use crate::fit::initial_states::{self, following, spread};
use crate::fit::prior::{InitialStatePrior, InitialStates};
use crate::fit::shooting::Shooting;
use crate::model::estimation_model::EstimationModel;
use crate::model::problem::EstimationProblem;
use crate::model::specification_texts::SpecificationTexts;
use crate::model::unknowns::Unknown;
use crate::thresholds;

/// A specification fitted to the beginnings of the windows.
pub struct PreliminaryFit {
    /// The cost there, in standard deviations, with what priors add.
    pub cost: f64,
    /// What is known of the initial states of whole windows, where they begin there already.
    pub(crate) whole: Option<InitialStatePrior>,
    /// What leaves more standard deviations than this of whole windows is not worth following them anew.
    pub(crate) most: f64,
    /// Whether further steps over beginnings of windows would help little.
    pub(crate) is_converged: bool,
    pub(crate) texts: SpecificationTexts,
    pub(crate) model: EstimationModel,
    pub(crate) unknowns: Vec<Unknown>,
    pub(crate) ranges: Vec<f64>,
    pub(crate) theta: Vec<f64>,
    pub(crate) initial_states: Vec<Vec<f64>>,
}

/// A fit whose motions another begins with.
#[derive(Clone, Copy)]
pub struct WarmStart<'f> {
    /// The fit.
    pub fit: &'f Fit,
    /// The cost that the other is expected to come to, in squared standard deviations.
    pub cost: f64,
    /// Where the other leaves more standard deviations than this of the training records, its windows are not
    /// followed anew: it is not worth that.
    pub most: f64,
}

/// Fits the model's unknowns to the beginnings of the windows, which tells good ones from
/// bad ones at a part of the cost. `texts`: the specification's, and its linear part's;
/// `guesses`: unknowns to begin with, of which the best is taken.
///
/// # Errors
/// As for [`crate::fit::full::fit`].
pub fn preliminary(
    problem: &EstimationProblem<'_>,
    texts: SpecificationTexts,
    unknowns: Vec<Unknown>,
    guesses: &[Vec<f64>],
) -> Result<PreliminaryFit, DiscoverError> {
    let model = problem.model(&texts.whole, Some(&texts.linear))?;
    let ranges = problem.ranges(&model, &model.values);
    let shooting = Shooting::new(problem, &model, &problem.train, &unknowns, &ranges);
    let (found, is_converged) = if problem.estimates_initial_states() {
        let shooting = Shooting {
            part: thresholds::FIRST_PART,
            ..shooting
        };
        let follow = following(problem, &shooting, &ranges, thresholds::FIRST_HORIZONS);
        let found = continuation(&shooting, guesses, &follow, thresholds::CONTINUATION_STEPS);
        (found.estimate, found.is_converged)
    } else {
        let theta = guesses.first().map_or(&[][..], Vec::as_slice);
        let InitialStates {
            prior,
            states: initial_states,
        } = initial_states::at_unknowns(
            problem,
            &shooting,
            theta,
            &ranges,
            &thresholds::HORIZONS,
            None,
        )?;
        let found = damped_gauss_newton(
            &shooting,
            &prior,
            theta,
            &initial_states,
            thresholds::PRELIMINARY_STEPS,
        );
        (found, true)
    };
    // How far states go may depend on what was found: a joint yields so much the more.
    let ranges = problem.ranges(&model, &shooting.values(&found.theta));
    Ok(PreliminaryFit {
        cost: found.cost,
        whole: None,
        most: f64::INFINITY,
        is_converged,
        initial_states: found.initial_states,
        theta: found.theta,
        texts,
        model,
        unknowns,
        ranges,
    })
}

/// The model's unknowns as they are expected, with whole windows started where those of a fit
/// begin: close to a fit a straight line says enough. `guesses`: unknowns to begin with, at least one;
/// the first is taken that is not hopeless beside the fit, or else what leaves least.
///
/// # Errors
/// As for [`crate::fit::full::fit`].
pub fn expected(
    problem: &EstimationProblem<'_>,
    texts: SpecificationTexts,
    unknowns: Vec<Unknown>,
    guesses: &[Vec<f64>],
    warm_start: WarmStart<'_>,
) -> Result<PreliminaryFit, DiscoverError> {
    let WarmStart { fit, cost, most } = warm_start;
    let model = problem.model(&texts.whole, Some(&texts.linear))?;
    let bare = Shooting::new(problem, &model, &problem.train, &unknowns, &[]);
    let mapped = |states: &[Vec<f64>]| -> Vec<Vec<f64>> {
        states
            .iter()
            .map(|state| fit.mapped(&model, state))
            .collect()
    };
    let initial_states = mapped(&fit.train.estimate.initial_states);
    let theta = first_near(&bare, guesses, &initial_states, fit);
    let ranges = problem.ranges(&model, &bare.values(&theta));
    let prior = InitialStatePrior {
        mean: mapped(&fit.prior.mean),
        sd: match fit.prior.sd.is_empty() {
            true => Vec::new(),
            false => spread(&ranges),
        },
        sources: fit.prior.sources.clone(),
        whitening: None,
    };
    Ok(PreliminaryFit {
        cost,
        whole: Some(prior),
        most,
        is_converged: true,
        initial_states,
        theta,
        texts,
        model,
        unknowns,
        ranges,
    })
}

/// The first of some unknowns that leave not many times what a fit does, or else those that leave least:
/// what a straight line promises may be far too much, and initial states are not fitted to it yet.
fn first_near(
    shooting: &Shooting<'_>,
    guesses: &[Vec<f64>],
    initial_states: &[Vec<f64>],
    fit: &Fit,
) -> Vec<f64> {
    if let [only] = guesses {
        return only.clone();
    }
    let near = thresholds::HOPELESS.powi(2) * fit.train.estimate.squares.iter().sum::<f64>();
    let mut least = (f64::INFINITY, guesses.first());
    for theta in guesses {
        let residuals = shooting.residuals(theta, initial_states);
        let squares = residuals.iter().map(square);
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
