//! The regimes that a certificate's states are in.

use serde::Serialize;

/// How many regimes of the piecewise functions were tried.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Coverage {
    /// Combinations of sides that may have a state: all but the unreachable ones.
    pub regimes: u64,
    /// Those in which enough states were tried.
    pub sampled: u64,
    /// Combinations of sides that bounds prove to have no state.
    pub unreachable: u64,
}

impl Coverage {
    /// A sentence on the regimes tried.
    pub fn sentence(&self) -> String {
        let Self {
            regimes,
            sampled,
            unreachable,
        } = self;
        let word = if *regimes == 1 { "regime" } else { "regimes" };
        let excluded = match unreachable {
            0 => String::new(),
            count => format!("; {count} combinations of sides are impossible"),
        };
        format!("states were tried in {sampled} of {regimes} {word}{excluded}")
    }
}
