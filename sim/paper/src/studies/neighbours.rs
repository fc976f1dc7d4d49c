//! How fast neighbouring motions part: the largest Lyapunov exponent of the motion relative
//! to the machine's free rotation.
//!
//! A tangent vector is carried along the motion exactly and measured once per forcing period
//! (G. Benettin, L. Galgani, A. Giorgilli, J.-M. Strelcyn, Meccanica 15 (1980) 9-30). The
//! displacement of the carrier is left out: no force depends on it, so it would add an
//! exponent that is zero and hide the negative ones; where nothing damps the rotation its
//! rate is left out too, which would otherwise grow linearly and pass for a slow divergence.

use std::f64::consts::TAU;

use eomgen_analysis::exponent::{Exponent, mean_exponent};
use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::piecewise_linear::{Carried, Propagator};

use super::arm::{Case, Lengths};
use super::error::StudyError;
use super::run::Run;
use super::series::{FIRST_MODE, X_C, X_PR, X_SP};

/// After these forcing periods a tangent vector has turned into the direction that grows
/// fastest.
const TURNING: usize = 5;

/// A motion with a tangent vector, seen once per forcing period.
pub(super) struct Neighbours {
    carried: Carried,
    begin: f64,
    period: f64,
    /// The logarithm of the vector's growth over each period.
    growths: Vec<f64>,
    /// The state at the beginning and after each period.
    states: Vec<Vec<f64>>,
}

impl Neighbours {
    /// Beside a recorded motion, from where its record begins.
    pub fn beside(
        run: &Run,
        propagator: &mut Propagator,
        case: &Case,
        lengths: &Lengths,
    ) -> Result<Self, StudyError> {
        let first = run.states.first().cloned().unwrap_or_default();
        let weights = weights(case, lengths);
        let carried = propagator.carried(&first, run.begin, &HeldInputs::zero(0), &weights)?;
        Ok(Self {
            carried,
            begin: run.begin,
            period: case.period(),
            growths: Vec::new(),
            states: vec![first],
        })
    }

    /// Follows the motion until so many forcing periods have been seen.
    pub fn extend(
        &mut self,
        propagator: &mut Propagator,
        periods: usize,
    ) -> Result<(), StudyError> {
        let none = HeldInputs::zero(0);
        for period in self.growths.len() + 1..=periods {
            let end = self.begin + period as f64 * self.period;
            propagator.carry(&mut self.carried, end, &none)?;
            self.growths.extend(self.carried.growth());
            self.states.push(self.carried.state().to_vec());
        }
        Ok(())
    }

    /// The states once per forcing period.
    pub fn states(&self) -> &[Vec<f64>] {
        &self.states
    }

    /// The largest exponent so far.
    pub fn exponent(&self) -> Result<Exponent, StudyError> {
        let turned = self.growths.get(TURNING..).unwrap_or_default();
        Ok(mean_exponent(turned, self.period)?)
    }
}

/// Weights with which a free vibration of the arm on the closed drive keeps its length, as it
/// keeps its energy: otherwise the phase of the vibration would pass for growth. What is free
/// has none.
fn weights(case: &Case, lengths: &Lengths) -> Vec<f64> {
    let rates = FIRST_MODE + case.order;
    let mut weights = vec![1.0; 2 * rates];
    let meshes = [X_SP, X_PR].map(|mesh| (mesh, 1.0 / lengths.mesh_deflection));
    let mesh_rates = [X_SP, X_PR].map(|mesh| (rates + mesh, 1.0 / lengths.mesh_rate));
    let modes = lengths.natural.iter().enumerate();
    let modes = modes.map(|(mode, natural)| (FIRST_MODE + mode, TAU * natural));
    let is_restrained = case.undisclosed.b_m > 0.0;
    let carrier_rate = if is_restrained {
        1.0 / lengths.carrier_rate
    } else {
        0.0
    };
    let carrier = [(X_C, 0.0), (rates + X_C, carrier_rate)];
    let all = meshes
        .into_iter()
        .chain(mesh_rates)
        .chain(modes)
        .chain(carrier);
    for (place, weight) in all {
        if let Some(slot) = weights.get_mut(place) {
            *slot = weight;
        }
    }
    weights
}
