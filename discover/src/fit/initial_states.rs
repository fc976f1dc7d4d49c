//! Where the windows' initial states come from: followed through the record from window to
//! window, or read from a record smoothed without delay.

use rayon::prelude::*;

use crate::error::DiscoverError;
use crate::fit::continuation::Follow;
use crate::fit::gauss_newton::{Estimate, evaluated, inner_solve};
use crate::fit::prior::{InitialStatePrior, InitialStates};
use crate::fit::sensitivity::SensitivityEvaluator;
use crate::fit::shooting::Shooting;
use crate::model::estimation_model::EstimationModel;
use crate::model::problem::EstimationProblem;
use crate::model::smoothing::{sloped, smoothed};
use crate::thresholds;
use eomgen_records::dataset::{Channel, Quantity};
use eomgen_records::windows::Windows;

/// Initial states of all windows at these unknowns.
pub fn at_unknowns(
    problem: &EstimationProblem<'_>,
    shooting: &Shooting<'_>,
    theta: &[f64],
    ranges: &[f64],
    horizons: &[f64],
    before: Option<&[Vec<f64>]>,
) -> Result<InitialStates, DiscoverError> {
    if !problem.estimates_initial_states() {
        let read = read_smoothed(shooting.model, shooting.windows, &problem.dataset.channels);
        return Ok(InitialStates {
            prior: InitialStatePrior::default(),
            states: read?,
        });
    }
    let records = shooting.windows.records.iter();
    let firsts: Vec<Vec<f64>> = records
        .map(|r| problem.first_state(shooting.model, r))
        .collect();
    Ok(followed(shooting, theta, &firsts, ranges, horizons, before))
}

/// Initial states of all windows at these unknowns, found as they are in a fit.
///
/// # Errors
/// If they are to be read from the record and no channel shows a coordinate.
pub fn best(
    problem: &EstimationProblem<'_>,
    shooting: &Shooting<'_>,
    theta: &[f64],
    ranges: &[f64],
) -> Result<Vec<Vec<f64>>, DiscoverError> {
    let ladders = [&thresholds::HORIZONS[..], &thresholds::OTHER_HORIZONS];
    let ladders = if problem.estimates_initial_states() {
        &ladders[..]
    } else {
        &ladders[..1]
    };
    let found: Vec<Result<Estimate, DiscoverError>> = ladders
        .par_iter()
        .map(|horizons| {
            let found = at_unknowns(problem, shooting, theta, ranges, horizons, None)?;
            let initial_states = found.states;
            let prior = InitialStatePrior::default();
            Ok(evaluated(shooting, &prior, theta.to_vec(), initial_states))
        })
        .collect();
    let found = found
        .into_iter()
        .collect::<Result<Vec<Estimate>, DiscoverError>>()?;
    let best = (0..shooting.windows.list.len()).map(|window| {
        let order = |a: &&Estimate, b: &&Estimate| a.squares[window].total_cmp(&b.squares[window]);
        let best = found.iter().min_by(order);
        best.map_or_else(Vec::new, |found| found.initial_states[window].clone())
    });
    Ok(best.collect())
}

/// Initial states that follow unknowns, by so many horizons.
pub fn following<'f>(
    problem: &'f EstimationProblem<'f>,
    shooting: &'f Shooting<'f>,
    ranges: &'f [f64],
    horizons: usize,
) -> Box<Follow<'f>> {
    Box::new(move |theta, before| {
        let horizons = &thresholds::HORIZONS[..horizons];
        at_unknowns(problem, shooting, theta, ranges, horizons, before).unwrap_or_default()
    })
}

/// One standard deviation of what is known of each state from the window before.
pub fn spread(ranges: &[f64]) -> Vec<f64> {
    ranges
        .iter()
        .map(|range| thresholds::INITIAL_STATE_PRIOR * range)
        .collect()
}

/// Initial states followed from window to window: each begins where the one before ended and
/// is then fitted to its own samples. `before`: those at other unknowns, from which parts of
/// the records may be followed side by side.
fn followed(
    shooting: &Shooting<'_>,
    theta: &[f64],
    firsts: &[Vec<f64>],
    ranges: &[f64],
    horizons: &[f64],
    before: Option<&[Vec<f64>]>,
) -> InitialStates {
    let sd = spread(ranges);
    let count = shooting.windows.list.len();
    let chains = before.map_or(1, |_| thresholds::CHAINS).min(count).max(1);
    let parts: Vec<std::ops::Range<usize>> = (0..chains)
        .map(|chain| chain * count / chains..(chain + 1) * count / chains)
        .collect();
    let followed: Vec<Vec<(Vec<f64>, Vec<f64>)>> = parts
        .into_par_iter()
        .map(|windows| {
            let first = windows.start;
            let known = before
                .filter(|_| first > 0)
                .map(|initial_states| initial_states[first].clone());
            chain(shooting, theta, (firsts, &sd), horizons, (windows, known))
        })
        .collect();
    let (mean, states) = followed.into_iter().flatten().unzip();
    InitialStates {
        prior: InitialStatePrior { mean, sd },
        states,
    }
}

/// Where each window's motion from these initial states leaves the next window that follows
/// it; nothing for the first windows of records.
pub fn carried(
    shooting: &Shooting<'_>,
    theta: &[f64],
    initial_states: &[Vec<f64>],
) -> Vec<Option<Vec<f64>>> {
    let list = &shooting.windows.list;
    shooting.by_threads(|places| {
        let mut sensitivities = SensitivityEvaluator::frozen(shooting, theta, 1.0);
        let mut of = |place: usize| {
            let before = place.checked_sub(1)?;
            list[place].follows?;
            sensitivities
                .as_mut()?
                .carried(before, &initial_states[before], list[place].times[0])
        };
        places.map(&mut of).collect()
    })
}

/// Some windows, one after the other: what is known of each initial state before, and the
/// state.
fn chain(
    shooting: &Shooting<'_>,
    theta: &[f64],
    (firsts, sd): (&[Vec<f64>], &[f64]),
    horizons: &[f64],
    (windows, mut carried): (std::ops::Range<usize>, Option<Vec<f64>>),
) -> Vec<(Vec<f64>, Vec<f64>)> {
    let Some(mut sensitivities) = SensitivityEvaluator::frozen(shooting, theta, 1.0) else {
        let nothing = vec![0.0; shooting.model.state_count()];
        return windows
            .map(|_| (nothing.clone(), nothing.clone()))
            .collect();
    };
    let mut prior = InitialStatePrior {
        mean: vec![Vec::new(); shooting.windows.list.len()],
        sd: sd.to_vec(),
    };
    let mut found = Vec::with_capacity(windows.len());
    for place in windows {
        let window = &shooting.windows.list[place];
        let begin = match (window.follows, carried.take()) {
            (Some(_), Some(state)) => state,
            _ => firsts[window.record].clone(),
        };
        prior.mean[place].clone_from(&begin);
        let settled = inner_solve(&mut sensitivities, &prior, place, begin.clone(), horizons);
        let start = settled.unwrap_or_else(|| begin.clone());
        if let Some(next) = shooting.windows.list.get(place + 1) {
            carried = sensitivities.carried(place, &start, next.times[0]);
        }
        found.push((begin, start));
    }
    found
}

/// Initial states read from smoothed records, where the channels show all coordinates.
///
/// # Errors
/// The coordinate that no channel shows.
fn read_smoothed(
    model: &EstimationModel,
    windows: &Windows<'_>,
    channels: &[Channel],
) -> Result<Vec<Vec<f64>>, DiscoverError> {
    let half = model.state_count() / 2;
    let mut sources = Vec::with_capacity(half);
    for coordinate in 0..half {
        let shown = (channels.iter())
            .position(|channel| channel.quantity == Quantity::Coordinate(coordinate));
        sources
            .push(shown.ok_or_else(|| {
                DiscoverError::StateNotMeasured(model.states[coordinate].clone())
            })?);
    }
    let mut initial_states = vec![Vec::new(); windows.list.len()];
    for (place, record) in windows.records.iter().enumerate() {
        let smooth: Vec<(Vec<f64>, Vec<f64>)> = sources
            .iter()
            .map(|source| {
                let values = smoothed(&record.times, &record.channels[*source]);
                let slopes = sloped(&record.times, &values);
                (values, slopes)
            })
            .collect();
        for (window, start) in windows.list.iter().zip(&mut initial_states) {
            if window.record == place {
                let values = smooth.iter().map(|(values, _)| values[window.first]);
                let slopes = smooth.iter().map(|(_, slopes)| slopes[window.first]);
                *start = values.chain(slopes).collect();
            }
        }
    }
    Ok(initial_states)
}
