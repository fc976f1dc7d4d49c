//! How long measures wait and look, in periods of the forcing.

use super::error::SweepError;

/// The most periods of a measurement: beyond, rounding has long decided what is seen.
pub const MOST_PERIODS: usize = 1_000_000;

/// How long to wait and to look, in forcing periods.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Span {
    /// Periods that pass first.
    pub transient: usize,
    /// Periods that are looked at.
    pub periods: usize,
}

impl Span {
    /// Refuses fewer than `least` periods to look at, and times without end.
    ///
    /// # Errors
    /// What is wrong, in words of the command line.
    pub fn check(&self, measure: &str, least: usize) -> Result<(), SweepError> {
        if self.periods >= least && self.transient.saturating_add(self.periods) <= MOST_PERIODS {
            return Ok(());
        }
        Err(SweepError::Request(format!(
            "--measure {measure}: at least {least} --periods are looked at, and --transient and \
             --periods are at most {MOST_PERIODS} together"
        )))
    }
}
