//! Time window of a measure: forcing periods after a transient, or a time from the start.

use eomgen_compiled_model::{CompiledModel, Instance};
use eomgen_model_spec::argument::Argument;
use eomgen_model_spec::model::Model;
use eomgen_sim::variational::MeasurementTimes;

use crate::conditions::Conditions;
use crate::error::SweepError;
use crate::forcing::{Frequency, frequency};
use crate::measure::Failure;
use crate::span::Span;

/// Number of intervals in the second half of a time, over which growth is measured.
const GROWTH_INTERVALS: usize = 100;

/// Time window of a measure.
#[derive(Clone, Debug)]
pub enum Window {
    /// From the start to this time, in s.
    Until(f64),
    /// Forcing periods after a transient.
    Periods {
        /// Parameter that is the angular frequency of the forcing.
        forcing: String,
        /// Transient and measured periods.
        span: Span,
    },
}

/// Time window with resolved names.
#[derive(Clone, Debug)]
pub enum Times {
    /// From the start to this time, in s.
    Until(f64),
    /// Periods of the forcing.
    Periods(Frequency, Span),
}

impl Times {
    /// Creates the window of the measure `measure_name`, which requires at least `least` periods.
    ///
    /// # Errors
    /// An invalid window, or a parameter that is not a frequency.
    pub fn from_window(
        (model, conditions): (&Model, &Conditions),
        window: &Window,
        measure_name: &str,
        least: usize,
    ) -> Result<Self, SweepError> {
        match window {
            Window::Until(end) => check_end(*end, conditions).map(Self::Until),
            Window::Periods { forcing, span } => {
                span.check(measure_name, least)?;
                let known = frequency(model, forcing).map_err(|error| {
                    SweepError::Request(format!(
                        "{}: {error}; or give {}, the measured time in s",
                        Argument::Measure.with_text(measure_name),
                        Argument::Until
                    ))
                })?;
                Ok(Self::Periods(known, *span))
            }
        }
    }

    /// Returns the options that determine a measure's numbers.
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

    /// Returns the first and the last time of the window, in s.
    ///
    /// # Errors
    /// [`Failure::Undefined`] if the frequency is not positive, or if the record ends earlier.
    pub fn range(
        &self,
        instance: &Instance<'_>,
        conditions: &Conditions,
    ) -> Result<(f64, f64), Failure> {
        let start = conditions.start();
        let (begin, end) = match self {
            Self::Until(end) => (start, *end),
            Self::Periods(frequency, span) => {
                let period = frequency.period(instance)?;
                let begin = start + span.transient as f64 * period;
                (begin, begin + span.periods as f64 * period)
            }
        };
        require_inputs(end, conditions)?;
        Ok((begin, end))
    }

    /// Returns the time intervals over which growth is measured: once per period, or over the second half of the time.
    ///
    /// # Errors
    /// See [`Times::range`].
    pub fn list_growth_intervals(
        &self,
        instance: &Instance<'_>,
        conditions: &Conditions,
    ) -> Result<MeasurementTimes, Failure> {
        let start = conditions.start();
        self.range(instance, conditions)?;
        Ok(match self {
            Self::Until(end) => MeasurementTimes {
                start,
                transient: 0.5 * (end - start),
                interval: 0.5 * (end - start) / GROWTH_INTERVALS as f64,
                intervals: GROWTH_INTERVALS,
            },
            Self::Periods(frequency, span) => {
                let period = frequency.period(instance)?;
                MeasurementTimes {
                    start,
                    transient: span.transient as f64 * period,
                    interval: period,
                    intervals: span.periods,
                }
            }
        })
    }
}

/// Checks that the end of a motion, in s, is after its start and at most at the end of the record.
///
/// # Errors
/// The option `--until` with the limit.
pub fn check_end(until: f64, conditions: &Conditions) -> Result<f64, SweepError> {
    let start = conditions.start();
    if !(until > start && until.is_finite()) {
        return Err(SweepError::Request(format!(
            "{}: expected a time in s greater than {start}",
            Argument::Until.with_number(format_args!("{until:?}"))
        )));
    }
    match conditions.end().filter(|end| until > *end) {
        None => Ok(until),
        Some(end) => Err(SweepError::Request(format!(
            "{}: the record ends at {end:?} s; give an earlier time",
            Argument::Until.with_number(format_args!("{until:?}"))
        ))),
    }
}

/// Checks that the inputs do not end before a time, in s.
///
/// # Errors
/// [`Failure::Undefined`] after the end of the record.
pub fn require_inputs(end: f64, conditions: &Conditions) -> Result<(), Failure> {
    match conditions.end().is_some_and(|last| end > last) {
        true => Err(Failure::Undefined),
        false => Ok(()),
    }
}

/// Rejects a model with controllers, for a measure that does not support them.
///
/// # Errors
/// The model has a controller; the message names the first one.
pub fn reject_controllers(model: &CompiledModel, measure: &str) -> Result<(), SweepError> {
    let controlled = model.model().reject_controllers("this measure");
    let refused = |error| {
        let measure = Argument::Measure.with_text(measure);
        SweepError::Request(format!("{measure}: {error}"))
    };
    controlled.map_err(refused)
}
