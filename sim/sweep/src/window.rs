//! Which time of a motion measures look at: some periods of the forcing after others, or a time from
//! the start for models without one.

use eomgen_compiled_model::Instance;
use eomgen_model_spec::model::Model;
use eomgen_sim::variational::Stretches;

use crate::error::SweepError;
use crate::forcing::{Frequency, frequency};
use crate::measure::Failure;
use crate::span::Span;

/// Into how many stretches the second half of a time is cut where growth is measured.
const STRETCHES: usize = 100;

/// Which time is looked at.
#[derive(Clone, Debug)]
pub enum Window {
    /// From t = 0 to this time, s.
    Until(f64),
    /// So many periods of a forcing after others.
    Periods {
        /// The parameter that is the angular frequency of the forcing.
        forcing: String,
        /// Which ones.
        span: Span,
    },
}

/// A window with its forcing looked up.
#[derive(Clone, Debug)]
pub enum Times {
    /// From t = 0 to this time, s.
    Until(f64),
    /// Periods of the forcing.
    Periods(Frequency, Span),
}

impl Times {
    /// The window of the measure `asked`, which looks at `least` periods or more.
    ///
    /// # Errors
    /// A window that makes no sense, a parameter that is no frequency.
    pub fn of(
        model: &Model,
        window: &Window,
        asked: &str,
        least: usize,
    ) -> Result<Self, SweepError> {
        match window {
            Window::Until(end) => time(*end).map(Self::Until),
            Window::Periods { forcing, span } => {
                span.check(asked, least)?;
                let known = frequency(model, forcing).map_err(|error| {
                    SweepError::Request(format!(
                        "--measure {asked}: {error}; or give --until, the time in s that is looked at"
                    ))
                })?;
                Ok(Self::Periods(known, *span))
            }
        }
    }

    /// What of a measure's numbers depends on the window.
    pub fn options(&self) -> Vec<(String, String)> {
        let option = |name: &str, value: String| (name.to_owned(), value);
        match self {
            Self::Until(end) => vec![option("until", format!("{end:?}"))],
            Self::Periods(frequency, span) => vec![
                option("frequency", frequency.name().to_owned()),
                option("transient", span.transient.to_string()),
                option("periods", span.periods.to_string()),
            ],
        }
    }

    /// The first and the last time that is looked at, s.
    ///
    /// # Errors
    /// [`Failure::Undefined`] where the frequency is not positive.
    pub fn range(&self, instance: &Instance<'_>) -> Result<(f64, f64), Failure> {
        Ok(match self {
            Self::Until(end) => (0.0, *end),
            Self::Periods(frequency, span) => {
                let period = frequency.period(instance)?;
                let begin = span.transient as f64 * period;
                (begin, begin + span.periods as f64 * period)
            }
        })
    }

    /// Where growth is measured: once per period, or over the second half of the time.
    ///
    /// # Errors
    /// As [`Times::range`].
    pub fn stretches(&self, instance: &Instance<'_>) -> Result<Stretches, Failure> {
        Ok(match self {
            Self::Until(end) => Stretches {
                transient: 0.5 * end,
                interval: 0.5 * end / STRETCHES as f64,
                intervals: STRETCHES,
            },
            Self::Periods(frequency, span) => {
                let period = frequency.period(instance)?;
                Stretches {
                    transient: span.transient as f64 * period,
                    interval: period,
                    intervals: span.periods,
                }
            }
        })
    }
}

/// A time to look at, s.
///
/// # Errors
/// One that is not above 0, or not finite.
pub fn time(until: f64) -> Result<f64, SweepError> {
    if until > 0.0 && until.is_finite() {
        return Ok(until);
    }
    Err(SweepError::Request(format!(
        "--until {until:?}: expected a time in s above 0"
    )))
}
