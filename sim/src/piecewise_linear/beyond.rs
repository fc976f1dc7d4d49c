//! What lies beyond a limit of a regime: which regime, whether the rate of the function that
//! reached it may jump there, and how neighbouring motions pass.

use nalgebra::Complex;

use super::error::ExactError;
use super::functional::Linear;
use super::groups::Place;
use super::passage::Limit;
use super::propagator::Propagator;
use super::saltation;

/// Rates that differ by less than this part of their size are continuous.
const CONTINUOUS: f64 = 1e-12;

/// The roundings of a sum of products of size 1.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// What lies beyond a limit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beyond {
    pub regime: usize,
    /// Whether the rate of the group's function may jump there.
    pub jumps: bool,
    /// Where the constant saltation matrix of the passage is kept, if it is constant.
    pub saltation: Option<usize>,
    /// Whether the functions of other groups may jump in the passage.
    pub moves_others: bool,
}

impl Propagator {
    /// Finds what lies beyond a limit and remembers it.
    pub(super) fn find_beyond(&mut self, limit: &Limit) -> Result<Beyond, ExactError> {
        let &Limit {
            before,
            functional,
            group,
            upper,
            t,
            ..
        } = limit;
        let mut places = self.regimes[before].places.clone();
        places[group] = places[group].beyond(upper);
        let held = matches!(self.regimes[before].places[group], Place::On(_));
        let regime = self.regime(&places, t)?;
        let jumps = !held && self.rate_jumps(before, regime, group);
        let entered = &self.regimes[before];
        let limits = &entered.regime.functionals[functional].limits;
        let constant = saltation::constant(
            &entered.regime.system,
            &self.regimes[regime].regime.system,
            &entered.regime.functionals[functional].linear,
            if upper { limits.high } else { limits.low },
        );
        let saltation = constant.map(|u| {
            self.saltations.push(u);
            self.saltations.len() - 1
        });
        let beyond = Beyond {
            regime,
            jumps,
            saltation,
            moves_others: held || self.moves_others(before, regime, group),
        };
        self.regimes[before].beyond[functional][usize::from(upper)] = Some(beyond);
        Ok(beyond)
    }

    /// Whether what is watched of other groups differs between two regimes.
    fn moves_others(&self, a: usize, b: usize, group: usize) -> bool {
        let (a, b) = (&self.regimes[a].regime, &self.regimes[b].regime);
        let mut pairs = a.functionals.iter().zip(&b.functionals);
        pairs
            .any(|(a, b)| a.limits.group != group && (a.linear != b.linear || a.limits != b.limits))
    }

    /// Whether the rate of a group's function differs between two regimes.
    fn rate_jumps(&self, a: usize, b: usize, group: usize) -> bool {
        let row = &self.regimes[a].functions[group].state;
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
                difference.abs() > CONTINUOUS * size
            })
        })
    }

    /// The rate of a group's function at a state as a regime has it.
    pub(super) fn rate(
        &self,
        index: usize,
        group: usize,
        state: &[f64],
        inputs: &[f64],
        phases: &[Complex<f64>],
    ) -> f64 {
        let entered = &self.regimes[index];
        let function = &entered.functions[group];
        let mut rates = vec![0.0; self.states];
        entered.regime.rates(state, inputs, phases, &mut rates);
        let rate: f64 = function.state.iter().zip(&rates).map(|(a, b)| a * b).sum();
        rate + self.explicit_rate(function, phases)
    }

    /// What rounding may make of the rate of a group's function.
    pub(super) fn rate_rounding(&self, index: usize, group: usize, state: &[f64]) -> f64 {
        let entered = &self.regimes[index];
        let matrix = &entered.regime.system.rates.state;
        let mut size = 0.0;
        for (factor, row) in entered.functions[group]
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

    /// The rate of a function of sinusoids that is due to time alone.
    pub(super) fn explicit_rate(&self, function: &Linear, phases: &[Complex<f64>]) -> f64 {
        let terms = phases.iter().enumerate().map(|(place, phase)| {
            let omega = self.phases[place][0];
            omega * (function.sines[place] * phase.re - function.cosines[place] * phase.im)
        });
        terms.sum()
    }
}
