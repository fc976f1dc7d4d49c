//! Largest Lyapunov exponent of the motion relative to the free rotation of the machine.
//!
//! A tangent vector is propagated exactly along the motion and measured once per forcing period (G. Benettin, L.
//! Galgani, A. Giorgilli, J.-M. Strelcyn, Meccanica 15 (1980) 9-30). The displacement of the carrier is excluded: no
//! force depends on it, so its exponent is zero and would hide negative ones. If the rotation is undamped, its rate is
//! excluded too, because its linear growth would appear as a slow divergence.

use std::f64::consts::TAU;

use eomgen_analysis::exponent::{Exponent, mean_exponent};
use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::piecewise_linear::{MotionWithTangents, Propagator};

use super::arm::{Case, ConversionFactors};
use super::error::StudyError;
use super::run::Run;
use super::series::{FIRST_MODE, X_C, X_PR, X_SP};

/// Number of forcing periods after which the tangent vector has the direction of fastest growth.
const ALIGNMENT_PERIODS: usize = 5;

/// Motion with a tangent vector, sampled once per forcing period.
pub(super) struct TangentMotion {
    carried: MotionWithTangents,
    begin: f64,
    period: f64,
    /// Logarithm of the growth of the tangent vector over each period.
    growths: Vec<f64>,
    /// State at the start and after each period.
    states: Vec<Vec<f64>>,
}

impl TangentMotion {
    /// Starts a tangent vector at the start of a recorded motion.
    pub fn start(
        run: &Run,
        propagator: &mut Propagator,
        case: &Case,
        lengths: &ConversionFactors,
    ) -> Result<Self, StudyError> {
        let first = run.states.first().cloned().unwrap_or_default();
        let weights = compute_weights(case, lengths);
        let carried =
            propagator.start_with_tangent(&first, run.begin, &HeldInputs::zero(0), &weights)?;
        Ok(Self {
            carried,
            begin: run.begin,
            period: case.period(),
            growths: Vec::new(),
            states: vec![first],
        })
    }

    /// Propagates the motion until `periods` forcing periods are available.
    pub fn extend(
        &mut self,
        propagator: &mut Propagator,
        periods: usize,
    ) -> Result<(), StudyError> {
        let none = HeldInputs::zero(0);
        for period in self.growths.len() + 1..=periods {
            let end = self.begin + period as f64 * self.period;
            propagator.continue_to(&mut self.carried, end, &none)?;
            self.growths.extend(self.carried.growth_exponents());
            self.states.push(self.carried.state().to_vec());
        }
        Ok(())
    }

    pub fn states(&self) -> &[Vec<f64>] {
        &self.states
    }

    /// Computes the largest exponent from the periods so far.
    pub fn exponent(&self) -> Result<Exponent, StudyError> {
        let turned = self.growths.get(ALIGNMENT_PERIODS..).unwrap_or_default();
        Ok(mean_exponent(turned, self.period)?)
    }
}

/// Returns weights for which a free vibration of the arm with closed meshes has a constant norm, just as its energy is
/// constant. Otherwise the phase of the vibration would appear as growth. Excluded components have the weight 0.
fn compute_weights(case: &Case, lengths: &ConversionFactors) -> Vec<f64> {
    let rates = FIRST_MODE + case.order;
    let mut weights = vec![1.0; 2 * rates];
    let meshes = [X_SP, X_PR].map(|mesh| (mesh, 1.0 / lengths.mesh_deflection));
    let mesh_rates = [X_SP, X_PR].map(|mesh| (rates + mesh, 1.0 / lengths.mesh_rate));
    let modes = lengths.natural_frequencies.iter().enumerate();
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
    for (index, weight) in all {
        if let Some(slot) = weights.get_mut(index) {
            *slot = weight;
        }
    }
    weights
}
