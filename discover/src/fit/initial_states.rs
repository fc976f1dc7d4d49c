//! Initial states of the windows. They are estimated along the record from window to window, or
//! read from a record after zero-phase smoothing.

use crate::ids::{WindowId, WindowRange};
use rayon::prelude::*;

use crate::error::DiscoverError;
use crate::fit::continuation::EstimateInitialStates;
use crate::fit::gauss_newton::{Estimate, evaluate_cost, fit_initial_state};
use crate::fit::prior::{InitialStatePrior, InitialStates, PriorSource};
use crate::fit::sensitivity::SensitivityEvaluator;
use crate::fit::shooting::Shooting;
use crate::model::estimation_model::EstimationModel;
use crate::model::problem::EstimationProblem;
use crate::model::smoothing::{differentiate_column, smooth_column};
use crate::thresholds;
use eomgen_records::dataset::{Channel, Initial, Quantity};
use eomgen_records::windows::{Window, Windows};

/// Estimates the initial states of all windows for given unknowns.
pub fn estimate_at_unknowns(
    problem: &EstimationProblem<'_>,
    shooting: &Shooting<'_>,
    theta: &[f64],
    ranges: &[f64],
    horizons: &[f64],
    before: Option<&[Vec<f64>]>,
) -> Result<InitialStates, DiscoverError> {
    if !problem.estimates_initial_states() {
        let states = match problem.dataset.gives_motion() {
            // With given motion, the model has no motion of its own.
            true => vec![shooting.model.initial_state(); shooting.windows.windows.len()],
            false => read_smoothed(shooting.model, shooting.windows, &problem.dataset.channels)?,
        };
        return Ok(InitialStates {
            prior: InitialStatePrior::default(),
            states,
        });
    }
    let records = shooting.windows.records.iter();
    let firsts: Vec<Vec<f64>> = records
        .map(|r| problem.estimate_first_state(shooting.model, r))
        .collect();
    let known = WindowPriors {
        firsts: &firsts,
        sd: &prior_sd(ranges),
        sources: &list_sources(problem, shooting.windows),
    };
    Ok(follow_windows(shooting, theta, known, horizons, before))
}

/// Estimates the initial states of all windows for given unknowns with all horizons of a fit.
///
/// # Errors
///
/// The initial states must be read from the record, and no channel measures a coordinate.
pub fn estimate_best(
    problem: &EstimationProblem<'_>,
    shooting: &Shooting<'_>,
    theta: &[f64],
    ranges: &[f64],
) -> Result<Vec<Vec<f64>>, DiscoverError> {
    let sequences = [
        &thresholds::INITIAL_STATE_HORIZONS[..],
        &thresholds::OTHER_INITIAL_STATE_HORIZONS,
    ];
    let sequences = if problem.estimates_initial_states() {
        &sequences[..]
    } else {
        &sequences[..1]
    };
    let found: Vec<Result<Estimate, DiscoverError>> = sequences
        .par_iter()
        .map(|horizons| {
            let found = estimate_at_unknowns(problem, shooting, theta, ranges, horizons, None)?;
            let initial_states = found.states;
            let prior = InitialStatePrior::default();
            Ok(evaluate_cost(
                shooting,
                &prior,
                theta.to_vec(),
                initial_states,
            ))
        })
        .collect();
    let found = found
        .into_iter()
        .collect::<Result<Vec<Estimate>, DiscoverError>>()?;
    let windows = WindowId::first(shooting.windows.windows.len());
    let best = windows.map(|window| {
        let order = |a: &&Estimate, b: &&Estimate| a.squares[window].total_cmp(&b.squares[window]);
        let best = found.iter().min_by(order);
        best.map_or_else(Vec::new, |found| found.initial_states[window].clone())
    });
    Ok(best.collect())
}

/// Fits the first state of each training record to its first window. The prior is computed from the
/// given ranges.
pub fn fit_first_states(
    problem: &EstimationProblem<'_>,
    shooting: &Shooting<'_>,
    theta: &[f64],
    ranges: &[f64],
) -> Vec<Vec<f64>> {
    let windows = shooting.windows;
    let firsts: Vec<Vec<f64>> = (windows.records.iter())
        .map(|record| problem.estimate_first_state(shooting.model, record))
        .collect();
    let chain = Chain {
        shooting,
        known: WindowPriors {
            firsts: &firsts,
            sd: &prior_sd(ranges),
            sources: &list_sources(problem, windows),
        },
        horizons: &thresholds::INITIAL_STATE_HORIZONS,
    };
    let mut fitted = firsts.clone();
    for (index, window) in windows.windows.iter().enumerate() {
        if window.follows.is_none() {
            let followed = chain.estimate_states(theta, WindowId::range(index..index + 1), None);
            fitted[window.record] = followed
                .into_iter()
                .map(|of| of.state)
                .next()
                .unwrap_or_default();
        }
    }
    fitted
}

/// Returns a function that estimates initial states for given unknowns, with a given number of
/// horizons.
pub fn estimate_for_unknowns<'f>(
    problem: &'f EstimationProblem<'f>,
    shooting: &'f Shooting<'f>,
    ranges: &'f [f64],
    horizons: usize,
) -> Box<EstimateInitialStates<'f>> {
    Box::new(move |theta, before| {
        let horizons = &thresholds::INITIAL_STATE_HORIZONS[..horizons];
        estimate_at_unknowns(problem, shooting, theta, ranges, horizons, before).unwrap_or_default()
    })
}

/// Returns the prior standard deviation of each initial state around the final state of the
/// preceding window.
pub fn prior_sd(ranges: &[f64]) -> Vec<f64> {
    ranges
        .iter()
        .map(|range| thresholds::INITIAL_STATE_PRIOR_IN_RANGES * range)
        .collect()
}

/// Returns a prior with the given means and the standard deviation of states from preceding
/// windows. The standard deviation is infinite if initial states are read from the record.
pub fn prior_from_states(
    problem: &EstimationProblem<'_>,
    states: &[Vec<f64>],
    ranges: &[f64],
) -> InitialStatePrior {
    match problem.estimates_initial_states() {
        true => InitialStatePrior {
            mean: states.to_vec(),
            sd: prior_sd(ranges),
            ..InitialStatePrior::default()
        },
        false => InitialStatePrior::default(),
    }
}

/// Returns the source of the prior mean of each window.
fn list_sources(problem: &EstimationProblem<'_>, windows: &Windows<'_>) -> Vec<PriorSource> {
    let of = |window: &Window| {
        let is_stated = window.first == 0
            && !windows.records[window.record].is_continued
            && problem.dataset.initial != Initial::Estimate;
        match (window.follows, is_stated) {
            (Some(_), _) => PriorSource::PrecedingWindow,
            (None, true) => PriorSource::Dataset,
            (None, false) => PriorSource::FirstSamples,
        }
    };
    windows.windows.iter().map(of).collect()
}

/// Prior of the initial states of windows.
#[derive(Clone, Copy)]
struct WindowPriors<'a> {
    /// First state of each record.
    firsts: &'a [Vec<f64>],
    /// Standard deviation of each state, if its mean is from the dataset or the preceding window.
    sd: &'a [f64],
    /// Source of the prior mean of each window.
    sources: &'a [PriorSource],
}

/// Estimates initial states from window to window. The prior mean is the final state of the
/// preceding window; the state is then fitted to the samples of its own window. `before`: initial
/// states for similar unknowns; with them, chains of windows are processed in parallel.
fn follow_windows(
    shooting: &Shooting<'_>,
    theta: &[f64],
    known: WindowPriors<'_>,
    horizons: &[f64],
    before: Option<&[Vec<f64>]>,
) -> InitialStates {
    let count = shooting.windows.windows.len();
    let chains = before
        .map_or(1, |_| thresholds::PARALLEL_CHAIN_COUNT)
        .min(count)
        .max(1);
    let parts: Vec<std::ops::Range<usize>> = (0..chains)
        .map(|chain| chain * count / chains..(chain + 1) * count / chains)
        .collect();
    let followed: Vec<Vec<FollowedState>> = parts
        .into_par_iter()
        .map(|windows| {
            let first = windows.start;
            let carried = before
                .filter(|_| first > 0)
                .map(|initial_states| initial_states[first].clone());
            let chain = Chain {
                shooting,
                known,
                horizons,
            };
            chain.estimate_states(theta, WindowId::range(windows), carried)
        })
        .collect();
    let followed = followed.into_iter().flatten();
    let (mean, states) = followed.map(|of| (of.mean, of.state)).unzip();
    InitialStates {
        prior: InitialStatePrior {
            mean,
            sd: known.sd.to_vec(),
            sources: known.sources.to_vec(),
            whitening: None,
        },
        states,
    }
}

/// Returns the final state of the preceding window for each window; `None` for the first window of
/// a record.
pub fn propagate_to_next_windows(
    shooting: &Shooting<'_>,
    theta: &[f64],
    initial_states: &[Vec<f64>],
) -> Vec<Option<Vec<f64>>> {
    let list = &shooting.windows.windows;
    shooting.map_windows_in_parallel(|windows| {
        let mut sensitivities = SensitivityEvaluator::with_fixed_unknowns(shooting, theta, 1.0);
        let mut of = |window: WindowId| {
            let before = WindowId::new(window.index().checked_sub(1)?);
            list[window].follows?;
            sensitivities.as_mut()?.propagate(
                before,
                &initial_states[before],
                list[window].times[0],
            )
        };
        windows.map(&mut of).collect()
    })
}

/// Estimation of consecutive windows.
struct Chain<'a> {
    shooting: &'a Shooting<'a>,
    known: WindowPriors<'a>,
    horizons: &'a [f64],
}

/// Prior mean and estimate of the initial state of a window.
struct FollowedState {
    mean: Vec<f64>,
    state: Vec<f64>,
}

impl Chain<'_> {
    /// Estimates the initial states of consecutive windows. `carried`: prior mean of the first
    /// window, if known.
    fn estimate_states(
        &self,
        theta: &[f64],
        windows: WindowRange,
        mut carried: Option<Vec<f64>>,
    ) -> Vec<FollowedState> {
        let shooting = self.shooting;
        let Some(mut sensitivities) =
            SensitivityEvaluator::with_fixed_unknowns(shooting, theta, 1.0)
        else {
            let nothing = vec![0.0; shooting.model.state_count()];
            let unknown = |_| FollowedState {
                mean: nothing.clone(),
                state: nothing.clone(),
            };
            return windows.map(unknown).collect();
        };
        let list = &shooting.windows.windows;
        let mut prior = InitialStatePrior {
            mean: vec![Vec::new(); list.len()],
            sd: self.known.sd.to_vec(),
            sources: self.known.sources.to_vec(),
            whitening: None,
        };
        let mut found = Vec::with_capacity(windows.len());
        for id in windows {
            let window = &list[id];
            let mean = match (window.follows, carried.take()) {
                (Some(_), Some(state)) => state,
                _ => self.known.firsts[window.record].clone(),
            };
            prior.mean[id].clone_from(&mean);
            let solved =
                fit_initial_state(&mut sensitivities, &prior, id, mean.clone(), self.horizons);
            let state = solved.unwrap_or_else(|| mean.clone());
            if let Some(next) = list.get(id.index() + 1) {
                carried = sensitivities.propagate(id, &state, next.times[0]);
            }
            found.push(FollowedState { mean, state });
        }
        found
    }
}

/// Reads initial states from smoothed records. All coordinates and first-order states must be
/// measured.
///
/// # Errors
///
/// The coordinate or first-order state that no channel measures.
fn read_smoothed(
    model: &EstimationModel,
    windows: &Windows<'_>,
    channels: &[Channel],
) -> Result<Vec<Vec<f64>>, DiscoverError> {
    let degrees = model.degrees_of_freedom();
    let source = |quantity: Quantity, state: usize| {
        let shown = (channels.iter()).position(|channel| channel.quantity == quantity);
        shown.ok_or_else(|| DiscoverError::StateNotMeasured(model.states[state].clone()))
    };
    let coordinates = (0..degrees).map(|index| source(Quantity::Coordinate(index), index));
    let first_order = 2 * degrees..model.states.len();
    let first_order = first_order.map(|state| source(Quantity::State(state - 2 * degrees), state));
    let sources = coordinates
        .chain(first_order)
        .collect::<Result<Vec<usize>, _>>()?;
    let mut initial_states = vec![Vec::new(); windows.windows.len()];
    for (number, record) in windows.records.iter().enumerate() {
        let smooth: Vec<(Vec<f64>, Vec<f64>)> = sources
            .iter()
            .map(|source| {
                let sensor = model.sensors[*source];
                let measured = smooth_column(&record.times, &record.channels[*source]);
                let quantities = measured.iter().map(|value| sensor.quantity(*value));
                let values: Vec<f64> = quantities.collect();
                let slopes = differentiate_column(&record.times, &values);
                (values, slopes)
            })
            .collect();
        for (window, start) in windows.windows.iter().zip(&mut initial_states) {
            if window.record == number {
                let (coordinates, first_order) = smooth.split_at(degrees);
                let values = coordinates.iter().map(|(values, _)| values[window.first]);
                let slopes = coordinates.iter().map(|(_, slopes)| slopes[window.first]);
                let first_order = first_order.iter().map(|(values, _)| values[window.first]);
                *start = values.chain(slopes).chain(first_order).collect();
            }
        }
    }
    Ok(initial_states)
}

/// Sets the prior mean of each window to the final state of the preceding window, which depends on
/// the unknowns.
pub(crate) fn update_carried_prior(
    shooting: &Shooting<'_>,
    prior: &mut InitialStatePrior,
    theta: &[f64],
    initial_states: &[Vec<f64>],
) {
    let carried = propagate_to_next_windows(shooting, theta, initial_states);
    for (mean, carried) in prior.mean.iter_mut().zip(carried) {
        if let Some(carried) = carried {
            *mean = carried;
        }
    }
}
