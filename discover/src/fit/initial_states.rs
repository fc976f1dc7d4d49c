//! Where the windows' initial states come from: followed through the record from window to
//! window, or read from a record smoothed without delay.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::fit::gauss_newton::{StartPrior, settle};
use crate::fit::sensitivity::Crew;
use crate::fit::shooting::Shooting;
use crate::model::plant::Plant;
use crate::model::smoothing::{sloped, smoothed};
use crate::thresholds;
use eomgen_records::dataset::{Channel, Initial, Quantity};
use eomgen_records::record::Record;
use eomgen_records::windows::Windows;

/// Samples from which a first value and a first slope are read.
const FIRST_SAMPLES: usize = 12;

/// How far each state ranges in the motion that the records' inputs cause, SI: the root mean
/// square around its mean. `values`: the plant's parameters, on which that may depend much.
pub fn ranges(plant: &Plant, values: &[f64], records: &[Record], initial: &[f64]) -> Vec<f64> {
    let states = plant.state_count();
    let mut sums = vec![(0.0, 0.0); states];
    let mut count = 0.0;
    if let Ok(mut runner) = plant.at(values) {
        for record in records {
            // Every tenth sample shows how far a state goes.
            let times: Vec<f64> = record.times.iter().step_by(10).copied().collect();
            let Ok(motion) = runner.states(initial, &times, &record.inputs) else {
                continue;
            };
            for state in &motion {
                count += 1.0;
                for (sum, value) in sums.iter_mut().zip(state) {
                    sum.0 += value;
                    sum.1 += value * value;
                }
            }
        }
    }
    let range = |(sum, squares): (f64, f64)| {
        let mean: f64 = sum / count;
        (squares / count - mean * mean).max(0.0).sqrt()
    };
    let found: Vec<f64> = sums.into_iter().map(range).collect();
    let largest = found
        .iter()
        .copied()
        .filter(|r| r.is_finite())
        .fold(0.0, f64::max);
    // A state that nothing moves may still not be known exactly.
    let least = if largest > 0.0 { 1e-9 * largest } else { 1.0 };
    found
        .into_iter()
        .map(|r| if r.is_finite() { r.max(least) } else { 1.0 })
        .collect()
}

/// The first state of a record, as far as it is known.
pub fn first_state(
    plant: &Plant,
    record: &Record,
    channels: &[Channel],
    initial: &Initial,
) -> Vec<f64> {
    let mut state = plant.initial();
    match initial {
        Initial::Rest => {}
        Initial::Given(values) => {
            for (name, value) in values {
                if let Some(place) = plant.states.iter().position(|state| state == name) {
                    state[place] = *value;
                }
            }
        }
        Initial::Estimate => {
            let half = plant.state_count() / 2;
            for (channel, column) in channels.iter().zip(&record.channels) {
                let (value, slope) = begin(&record.times, column);
                match channel.quantity {
                    Quantity::Coordinate(place) => {
                        state[place] = value;
                        state[half + place] = slope;
                    }
                    Quantity::Rate(place) => state[half + place] = value,
                    Quantity::Observable(_) => {}
                }
            }
            // Noise may put what is measured beyond where the model lives.
            state = plant.admissible(state);
        }
    }
    state
}

/// The parabola through a column's first samples at the first time: value and slope. A line
/// would show the slope in their middle, and what is late by that looks like a late sensor.
fn begin(times: &[f64], column: &[f64]) -> (f64, f64) {
    let points: Vec<(f64, f64)> = (times.iter().zip(column))
        .filter(|(_, value)| value.is_finite())
        .take(FIRST_SAMPLES)
        .map(|(t, value)| (t - times[0], *value))
        .collect();
    let Some(span) = points.last().map(|(t, _)| *t).filter(|span| *span > 0.0) else {
        return (0.0, 0.0);
    };
    let powers = DMatrix::from_fn(points.len(), 3, |row, power| {
        (points[row].0 / span).powi(power as i32)
    });
    let values = DVector::from_fn(points.len(), |row, _| points[row].1);
    match powers.svd(true, true).solve(&values, 1e-12) {
        Ok(fitted) => (fitted[0], fitted[1] / span),
        Err(_) => (0.0, 0.0),
    }
}

/// Windows that are followed from another estimate's initial states, side by side.
const CHAINS: usize = 2;

/// One standard deviation of what is known of each state from the window before.
pub fn spread(ranges: &[f64]) -> Vec<f64> {
    ranges
        .iter()
        .map(|range| thresholds::START_PRIOR * range)
        .collect()
}

/// Initial states followed from window to window: each begins where the one before ended and
/// is then fitted to its own samples. `before`: those at other unknowns, from which parts of
/// the records may be followed side by side.
pub fn followed(
    shooting: &Shooting<'_>,
    theta: &[f64],
    firsts: &[Vec<f64>],
    ranges: &[f64],
    horizons: &[f64],
    before: Option<&[Vec<f64>]>,
) -> (StartPrior, Vec<Vec<f64>>) {
    let sd = spread(ranges);
    let count = shooting.windows.list.len();
    let chains = before.map_or(1, |_| CHAINS).min(count).max(1);
    let parts: Vec<std::ops::Range<usize>> = (0..chains)
        .map(|chain| chain * count / chains..(chain + 1) * count / chains)
        .collect();
    let followed: Vec<Vec<(Vec<f64>, Vec<f64>)>> = parts
        .into_par_iter()
        .map(|windows| {
            let first = windows.start;
            let known = before
                .filter(|_| first > 0)
                .map(|starts| starts[first].clone());
            chain(shooting, theta, (firsts, &sd), horizons, (windows, known))
        })
        .collect();
    let (mean, starts) = followed.into_iter().flatten().unzip();
    (StartPrior { mean, sd }, starts)
}

/// Where each window's motion from these initial states leaves the next window that follows
/// it; nothing for the first windows of records.
pub fn carried(
    shooting: &Shooting<'_>,
    theta: &[f64],
    starts: &[Vec<f64>],
) -> Vec<Option<Vec<f64>>> {
    let list = &shooting.windows.list;
    shooting.by_threads(|places| {
        let mut crew = Crew::frozen(shooting, theta, 1.0);
        let mut of = |place: usize| {
            let before = place.checked_sub(1)?;
            list[place].follows?;
            crew.as_mut()?
                .carried(before, &starts[before], list[place].times[0])
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
    let Some(mut crew) = Crew::frozen(shooting, theta, 1.0) else {
        let nothing = vec![0.0; shooting.plant.state_count()];
        return windows
            .map(|_| (nothing.clone(), nothing.clone()))
            .collect();
    };
    let mut prior = StartPrior {
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
        let settled = settle(&mut crew, &prior, place, begin.clone(), horizons);
        let start = settled.unwrap_or_else(|| begin.clone());
        if let Some(next) = shooting.windows.list.get(place + 1) {
            carried = crew.carried(place, &start, next.times[0]);
        }
        found.push((begin, start));
    }
    found
}

/// Initial states read from smoothed records, where the channels show all coordinates.
///
/// # Errors
/// The coordinate that no channel shows.
pub fn read_smoothed(
    plant: &Plant,
    windows: &Windows<'_>,
    channels: &[Channel],
) -> Result<Vec<Vec<f64>>, String> {
    let half = plant.state_count() / 2;
    let mut sources = Vec::with_capacity(half);
    for coordinate in 0..half {
        let shown = (channels.iter())
            .position(|channel| channel.quantity == Quantity::Coordinate(coordinate));
        sources.push(shown.ok_or_else(|| plant.states[coordinate].clone())?);
    }
    let mut starts = vec![Vec::new(); windows.list.len()];
    for (place, record) in windows.records.iter().enumerate() {
        let smooth: Vec<(Vec<f64>, Vec<f64>)> = sources
            .iter()
            .map(|source| {
                let values = smoothed(&record.times, &record.channels[*source]);
                let slopes = sloped(&record.times, &values);
                (values, slopes)
            })
            .collect();
        for (window, start) in windows.list.iter().zip(&mut starts) {
            if window.record == place {
                let values = smooth.iter().map(|(values, _)| values[window.first]);
                let slopes = smooth.iter().map(|(_, slopes)| slopes[window.first]);
                *start = values.chain(slopes).collect();
            }
        }
    }
    Ok(starts)
}
