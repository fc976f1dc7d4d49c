//! Regimes beyond the limits of a regime: which regime it is, whether the rate of the limiting function jumps,
//! and how the transition changes tangent vectors.

use nalgebra::Complex;

use super::error::ExactError;
use super::event_function::Linear;
use super::parallel_guards::Cell;
use super::propagator::Propagator;
use super::saltation;
use super::transition::Limit;

/// Relative difference of rates below which they count as continuous.
const CONTINUOUS_JUMP_FRACTION: f64 = 1e-12;

/// Rounding error of a sum of products of magnitude 1.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Regime beyond a limit, and properties of the transition.
#[derive(Clone, Copy, Debug)]
pub(super) struct AdjacentRegime {
    pub regime: usize,
    /// True if the rate of the limiting function may jump.
    pub jumps: bool,
    /// Index of the saltation matrix of the transition, if it is constant.
    pub saltation: Option<usize>,
    /// True if the transition may change functions or limits of other families.
    pub moves_others: bool,
    /// True if the motion is then on several surfaces, whose effects are decided together.
    pub meets_others: bool,
}

impl Propagator {
    /// Finds the regime beyond a limit and stores it.
    pub(super) fn find_adjacent(&mut self, limit: &Limit) -> Result<AdjacentRegime, ExactError> {
        let &Limit {
            before,
            event_function,
            family,
            upper,
            t,
            ..
        } = limit;
        let mut cells = self.regimes[before].cells.clone();
        cells[family] = cells[family].adjacent(upper);
        let held = matches!(self.regimes[before].cells[family], Cell::On(_));
        let regime = self.regime(&cells, t)?;
        let jumps = !held && self.rate_jumps(before, regime, family);
        let visited = &self.regimes[before];
        let limits = &visited.regime.event_functions[event_function].limits;
        let constant = saltation::find_constant_saltation(
            &visited.regime.system,
            &self.regimes[regime].regime.system,
            &visited.regime.event_functions[event_function].linear,
            if upper { limits.high } else { limits.low },
        );
        let saltation = constant.map(|u| {
            self.saltations.push(u);
            self.saltations.len() - 1
        });
        let adjacent = AdjacentRegime {
            regime,
            jumps,
            saltation,
            moves_others: held || self.moves_others(before, regime, family),
            meets_others: (held || jumps) && self.surfaces_at_limit(limit).len() > 1,
        };
        self.regimes[before].adjacent[event_function][usize::from(upper)] = Some(adjacent);
        Ok(adjacent)
    }

    /// Returns true if any event function of another family differs between two regimes.
    fn moves_others(&self, a: usize, b: usize, family: usize) -> bool {
        let (a, b) = (&self.regimes[a].regime, &self.regimes[b].regime);
        let mut pairs = a.event_functions.iter().zip(&b.event_functions);
        pairs.any(|(a, b)| {
            a.limits.family != family && (a.linear != b.linear || a.limits != b.limits)
        })
    }

    /// Returns true if the rate of a family's function differs between two regimes.
    fn rate_jumps(&self, a: usize, b: usize, family: usize) -> bool {
        let row = &self.regimes[a].functions[family].state;
        let (a, b) = (
            &self.regimes[a].regime.system.rates,
            &self.regimes[b].regime.system.rates,
        );
        let blocks = [
            (&a.state, &b.state),
            (&a.inputs, &b.inputs),
            (&a.sines, &b.sines),
            (&a.cosines, &b.cosines),
            (&a.constant, &b.constant),
        ];
        blocks.iter().any(|(a, b)| {
            let width = a.len() / row.len().max(1);
            (0..width).any(|column| {
                let (mut difference, mut size) = (0.0, 0.0);
                for (state, factor) in row.iter().enumerate() {
                    let (x, y) = (a[state * width + column], b[state * width + column]);
                    difference += factor * (x - y);
                    size += (factor * x).abs() + (factor * y).abs();
                }
                difference.abs() > CONTINUOUS_JUMP_FRACTION * size
            })
        })
    }

    /// Returns the rate of a family's function at a state, with the function and the rates of a regime.
    pub(super) fn rate(
        &self,
        index: usize,
        family: usize,
        state: &[f64],
        inputs: &[f64],
        phases: &[Complex<f64>],
    ) -> f64 {
        let visited = &self.regimes[index];
        let function = &visited.functions[family];
        let mut rates = vec![0.0; self.states];
        visited.regime.rates(state, inputs, phases, &mut rates);
        let rate: f64 = function.state.iter().zip(&rates).map(|(a, b)| a * b).sum();
        rate + self.explicit_rate(function, phases)
    }

    /// Returns the rounding error of the rate of a family's function.
    pub(super) fn rate_rounding(&self, index: usize, family: usize, state: &[f64]) -> f64 {
        let visited = &self.regimes[index];
        let matrix = &visited.regime.system.rates.state;
        let mut size = 0.0;
        for (factor, row) in visited.functions[family]
            .state
            .iter()
            .zip(matrix.chunks(self.states.max(1)))
        {
            if *factor != 0.0 {
                let sum: f64 = row.iter().zip(state).map(|(a, y)| (a * y).abs()).sum();
                size += factor.abs() * sum;
            }
        }
        ROUNDING * size
    }

    /// Returns the partial derivative with respect to time of a function with sinusoids.
    pub(super) fn explicit_rate(&self, function: &Linear, phases: &[Complex<f64>]) -> f64 {
        let terms = phases.iter().enumerate().map(|(index, phase)| {
            let omega = self.phases[index][0];
            omega * (function.sines[index] * phase.re - function.cosines[index] * phase.im)
        });
        terms.sum()
    }
}
