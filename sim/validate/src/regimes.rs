//! Regimes of a model: combinations of sides of its switches.

use super::oracle::{Oracle, OracleError, Side, SwitchValue};
use super::sample::Sample;

const MAX_REGIMES: usize = 810;

/// One side for every switch of the model.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Regime {
    /// Sides in the order of [`Oracle::switches`].
    pub sides: Vec<Side>,
}

impl Regime {
    /// Returns the regime of a state.
    pub fn from_state(oracle: &Oracle, sample: &Sample) -> Result<Self, OracleError> {
        let values = oracle.switch_values(sample.time, &sample.state, &sample.inputs)?;
        let sides = values.iter().map(SwitchValue::side).collect();
        Ok(Self { sides })
    }

    /// Returns names and sides, for example `x_sp+ x_pr0`; empty for a model without switches.
    pub fn label(&self, oracle: &Oracle) -> String {
        let parts: Vec<String> = oracle
            .switches()
            .iter()
            .zip(&self.sides)
            .map(|(switch, side)| format!("{}{}", switch.name, side.symbol()))
            .collect();
        parts.join(" ")
    }
}

pub(super) fn count_combinations(oracle: &Oracle) -> u64 {
    let sides = oracle.switches().iter().map(|switch| switch.sides().len());
    sides.fold(1, |count: u64, sides| count.saturating_mul(sides as u64))
}

/// Lists the combinations of sides that interval bounds do not prove empty; `None` if there are
/// more than `MAX_REGIMES`. See [`Oracle::is_empty`] for `sizes` and `input_sizes`.
pub(super) fn possible_regimes(
    oracle: &Oracle,
    sizes: &[f64],
    input_sizes: &[f64],
) -> Option<Vec<Regime>> {
    let mut regimes = vec![Regime { sides: Vec::new() }];
    for switch in oracle.switches() {
        let extended = |regime: &Regime| {
            let sides = regime.sides.clone();
            switch.sides().iter().map(move |side| Regime {
                sides: sides.iter().chain([side]).copied().collect(),
            })
        };
        regimes = regimes.iter().flat_map(extended).collect();
        regimes.retain(|regime| !oracle.is_empty(&regime.sides, sizes, input_sizes));
        if regimes.len() > MAX_REGIMES {
            return None;
        }
    }
    Some(regimes)
}
