//! Transient and measured time, in forcing periods.

use super::error::SweepError;
use eomgen_model_spec::argument::Argument;

/// Maximum number of periods of a measurement; with more periods rounding errors dominate.
pub const MAX_PERIODS: usize = 1_000_000;

/// Transient and measured time, in forcing periods.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Span {
    /// Number of periods before the measurement.
    pub transient: usize,
    /// Number of measured periods.
    pub periods: usize,
}

impl Span {
    /// Checks that at least `least` and at most [`MAX_PERIODS`] periods are measured.
    pub fn check(&self, measure: &str, least: usize) -> Result<(), SweepError> {
        if self.periods >= least && self.transient.saturating_add(self.periods) <= MAX_PERIODS {
            return Ok(());
        }
        Err(SweepError::Request(format!(
            "{}: expected at least {least} {periods}, and {} and {periods} of at most {MAX_PERIODS} together",
            Argument::Measure.with_text(measure),
            Argument::Transient,
            periods = Argument::Periods
        )))
    }
}
