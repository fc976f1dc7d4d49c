//! How fast neighbouring motions part: the largest Lyapunov exponent of the motion relative
//! to the machine's free rotation.
//!
//! A second motion is started beside the recorded one, carried exactly for a part of a
//! forcing period, compared, and set back to its first distance (G. Benettin, L. Galgani,
//! J.-M. Strelcyn, Phys. Rev. A 14 (1976) 2338-2345). The displacement of the carrier is
//! left out: no force depends on it, so it would add an exponent that is zero and hide the
//! negative ones; where nothing damps the rotation its rate is left out too, which would
//! otherwise grow linearly and pass for a slow divergence.

use std::f64::consts::TAU;

use crate::analysis::exponent::{Exponent, mean_exponent};
use crate::exact::Propagator;
use crate::record::HeldInputs;

use super::arm::{Case, Lengths};
use super::error::StudyError;
use super::series::{FIRST_MODE, X_C, X_PR, X_SP, extents};

/// How many times per forcing period neighbouring motions are compared.
pub(super) const COMPARISONS: usize = 4;
/// After these forcing periods the difference of neighbours has turned into the direction
/// that grows fastest.
const TURNING: usize = 5;

/// The distance of the neighbours, each coordinate divided by its scale: far above rounding
/// (1e-16 m beside deflections of 1e-5 m) and far below 1, where the difference is no longer
/// linear after it has grown by a factor of 1000.
const DISTANCE: f64 = 1e-6;

/// A recorded motion beside which another is carried.
pub(super) struct Recorded<'a> {
    /// Times, s, and the states there.
    pub times: &'a [f64],
    pub states: &'a [Vec<f64>],
    /// Samples per forcing period.
    pub samples: usize,
}

/// How a difference is measured.
struct Measure {
    /// The unit of each number of the state.
    scale: Vec<f64>,
    /// Numbers of the state that are left out.
    free: Vec<usize>,
}

/// The largest exponent of a recorded motion.
pub(super) fn exponent(
    propagator: &mut Propagator,
    case: &Case,
    lengths: &Lengths,
    recorded: &Recorded<'_>,
) -> Result<Exponent, StudyError> {
    let measure = Measure::of(case, lengths, recorded.states);
    let every = (recorded.samples / COMPARISONS).max(1);
    let times: Vec<f64> = recorded.times.iter().step_by(every).copied().collect();
    let states = recorded.states.iter().step_by(every).map(Vec::as_slice);
    let states: Vec<&[f64]> = states.collect();
    let growths = growths(propagator, &times, &states, &measure)?;
    let turned = growths.get(TURNING * COMPARISONS..).unwrap_or_default();
    Ok(mean_exponent(turned, case.period() / COMPARISONS as f64)?)
}

impl Measure {
    /// Units in which a free vibration of the arm on the closed drive keeps its size, as its
    /// energy does: otherwise the phase of the vibration would pass for growth.
    fn of(case: &Case, lengths: &Lengths, states: &[Vec<f64>]) -> Self {
        let extents = extents(states);
        let rates = FIRST_MODE + case.order;
        let carrier = extents.get(rates + X_C).copied().unwrap_or_default();
        let modal = extents.get(rates + FIRST_MODE..).unwrap_or_default();
        let rate = modal
            .iter()
            .fold(carrier / lengths.carrier_rate, |a, b| a.max(*b));
        // Without any motion, the unit itself.
        let rate = if rate > 0.0 { rate } else { 1.0 };
        let mut scale = vec![rate; 2 * rates];
        let meshes = [X_SP, X_PR].map(|mesh| (mesh, lengths.mesh_deflection));
        let mesh_rates = [X_SP, X_PR].map(|mesh| (rates + mesh, lengths.mesh_rate));
        let modes = lengths.natural.iter().enumerate();
        let modes = modes.map(|(mode, natural)| (FIRST_MODE + mode, 1.0 / (TAU * natural)));
        let carrier = [(rates + X_C, lengths.carrier_rate)];
        for (place, unit) in meshes
            .into_iter()
            .chain(mesh_rates)
            .chain(modes)
            .chain(carrier)
        {
            if let Some(entry) = scale.get_mut(place) {
                *entry = rate * unit;
            }
        }
        let mut free = vec![X_C];
        if case.undisclosed.b_m <= 0.0 {
            free.push(rates + X_C);
        }
        Self { scale, free }
    }

    fn leave_out(&self, difference: &mut [f64]) {
        for &place in &self.free {
            if let Some(value) = difference.get_mut(place) {
                *value = 0.0;
            }
        }
    }

    /// The size of a difference.
    fn norm(&self, difference: &[f64]) -> f64 {
        let scaled = difference.iter().zip(&self.scale);
        scaled.map(|(d, s)| (d / s).powi(2)).sum::<f64>().sqrt()
    }
}

/// The logarithm of the growth from each time to the next. The first growths, over which the
/// difference turns into the direction that grows fastest, are in it.
fn growths(
    propagator: &mut Propagator,
    times: &[f64],
    states: &[&[f64]],
    measure: &Measure,
) -> Result<Vec<f64>, StudyError> {
    let mut difference = measure.scale.clone();
    measure.leave_out(&mut difference);
    let mut growths = Vec::with_capacity(times.len());
    for (times, states) in times.windows(2).zip(states.windows(2)) {
        let (&[from, to], &[here, there]) = (times, states) else {
            continue;
        };
        let factor = DISTANCE / measure.norm(&difference);
        let start: Vec<f64> = here
            .iter()
            .zip(&difference)
            .map(|(y, d)| y + d * factor)
            .collect();
        let none = HeldInputs::zero(0);
        let neighbour = propagator.simulate(&start, (from, to), &[], &none, &mut |_| {})?;
        let ends = neighbour.last.iter().zip(there);
        difference = ends.map(|(a, b)| a - b).collect();
        measure.leave_out(&mut difference);
        let grown = measure.norm(&difference);
        // Two neighbours that meet exactly are as near as rounding allows.
        let least = DISTANCE * f64::EPSILON;
        if grown < least {
            difference.clone_from(&measure.scale);
            measure.leave_out(&mut difference);
        }
        growths.push((grown.max(least) / DISTANCE).ln());
    }
    Ok(growths)
}
