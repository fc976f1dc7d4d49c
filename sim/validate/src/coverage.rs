//! Coverage of a model's regimes by the sampled states.

use serde::Serialize;

/// Numbers of possible, sampled and unreachable regimes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Coverage {
    /// Combinations of sides that are not proven unreachable.
    pub regimes: u64,
    /// Regimes with enough sampled states.
    pub sampled: u64,
    /// Combinations of sides that interval bounds prove to have no state.
    pub unreachable: u64,
}

impl Coverage {
    /// Returns the coverage as a sentence.
    pub fn sentence(&self) -> String {
        let Self {
            regimes,
            sampled,
            unreachable,
        } = self;
        let word = if *regimes == 1 { "regime" } else { "regimes" };
        let excluded = match unreachable {
            0 => String::new(),
            count => {
                format!("; {count} combinations of sides of the switching surfaces are impossible")
            }
        };
        format!("states were tried in {sampled} of {regimes} {word}{excluded}")
    }
}
