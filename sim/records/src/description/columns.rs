//! Tables `[time]`, `[inputs.NAME]`, `[motion.NAME]` and `[channels.NAME]`.

use eomgen_model_spec::assignment::{Assignment, QuantityReader};
use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics};
use eomgen_model_spec::model::Model;
use eomgen_model_spec::quantity::{Name, Number, StringValue};
use eomgen_model_spec::record::Record;
use eomgen_model_spec::span::Span;
use eomgen_model_spec::table::Entry;
use eomgen_model_spec::unit::Unit;

use super::keys;

const DECIMATION_RANGE: std::ops::RangeInclusive<i64> = 1..=1_000_000;

/// Identification of a column.
#[derive(Clone, Debug)]
pub enum ColumnKey {
    /// Name of the column.
    Name(StringValue),
    /// Number of the column, from 1.
    Number(usize, Span),
}

impl ColumnKey {
    /// Returns the location in the dataset file.
    pub fn span(&self) -> Span {
        match self {
            Self::Name(written) => written.span,
            Self::Number(_, span) => *span,
        }
    }
}

/// Column of the records.
#[derive(Debug)]
pub struct Column {
    /// Name or number.
    pub column: ColumnKey,
    /// Unit of the values.
    pub unit: StringValue,
    /// Wrapping of the values, if declared.
    pub wrap: Option<Wrap>,
    /// Period of wrapped values as an expression, which [`Column::evaluate_period`] evaluates.
    period: Option<StringValue>,
}

impl Column {
    /// Evaluates the period of wrapped values if it is an expression, at the parameter values of a model. An invalid
    /// unit of the column is reported elsewhere.
    ///
    /// # Errors
    /// An invalid expression, another unit, and a period that is not positive.
    pub fn evaluate_period(&mut self, model: &Model) -> Result<(), Diagnostic> {
        let (Some(written), Ok(unit)) = (self.period.take(), Unit::parse(&self.unit.text)) else {
            return Ok(());
        };
        let text = format!("wrap={}", written.text);
        let value = Assignment::split("wrap", &text)
            .and_then(|given| QuantityReader::new(model)?.read(&given, &unit));
        let value = value.map_err(|found| {
            let found = found.list().first().cloned();
            let message = found
                .as_ref()
                .map_or("`wrap` has no value", |found| found.message.as_str());
            let help = found.as_ref().and_then(|found| found.help.clone());
            Diagnostic::error(message)
                .with_span(written.span, PERIOD_FORMS)
                .with_optional_help(help)
        })?;
        self.wrap = Some(Wrap::Period(require_positive_period(Number {
            value,
            span: written.span,
        })?));
        Ok(())
    }
}

/// Admissible values of `wrap`, for messages.
const PERIOD_FORMS: &str =
    "expected a number in the column's unit, an expression such as \"2*pi rad\", or \"none\"";

/// Declaration for a column with jumps from one end of a range to the other.
#[derive(Clone, Copy, Debug)]
pub enum Wrap {
    /// Period of wrapped values, in the column's unit.
    Period(Number),
    /// The jumps are part of the motion.
    Never,
}

/// Table `[time]`.
#[derive(Debug)]
pub struct Time {
    /// Column of the time.
    pub column: Column,
    /// Decimation factor: number of samples of which one is kept.
    pub every: usize,
    /// True if a low-pass filter is applied to the channels before decimation.
    pub filter: bool,
}

/// Table `[inputs.NAME]`.
#[derive(Debug)]
pub struct InputColumn {
    /// Name of the input.
    pub name: Name,
    /// Column of the input.
    pub column: Column,
    /// Prior of the actuator's gain.
    pub gain: Option<Prior>,
    /// Prior of the bias, in the column's unit.
    pub bias: Option<Prior>,
    /// Prior of the delay, in s.
    pub delay: Option<Prior>,
}

/// Table `[motion.NAME]`.
#[derive(Debug)]
pub struct MotionColumn {
    /// Name of the coordinate.
    pub name: Name,
    /// Column of the position or of the speed; its unit decides.
    pub column: Column,
    /// Position at the first sample of a file, in SI; only for a speed.
    pub initial: Option<Number>,
}

/// Table `[channels.NAME]`.
#[derive(Debug)]
pub struct ChannelColumn {
    /// Name of the channel.
    pub name: Name,
    /// Column of the channel.
    pub column: Column,
    /// Standard deviation of the noise, in the column's unit.
    pub noise: Number,
    /// Measured quantity, if it differs from the channel's name.
    pub observable: Option<StringValue>,
    /// Prior of the gain.
    pub gain: Option<Prior>,
    /// Prior of the bias, in the column's unit.
    pub bias: Option<Prior>,
    /// Prior of the delay, in s.
    pub delay: Option<Prior>,
}

impl ChannelColumn {
    /// Returns the name of the measured quantity.
    pub fn quantity_name(&self) -> &str {
        let observable = self.observable.as_ref();
        observable.map_or(&self.name.text, |written| &written.text)
    }
}

/// Prior of a gain, a bias or a delay.
#[derive(Clone, Copy, Debug)]
pub struct Prior {
    /// Mean; `None` for the default.
    pub mean: Option<Number>,
    /// Standard deviation; 0 if the value is known.
    pub sd: Number,
}

fn read_column(record: &Record<'_>, found: &mut Diagnostics) -> Option<Column> {
    let column = record.require("column", found).cloned();
    let unit = record.required("unit", Entry::written, found);
    let column = column.and_then(|entry| read_key(&entry, found));
    let (wrap, period) = match record.get("wrap").map(|entry| (entry, entry.written())) {
        None => (None, None),
        Some((_, Ok(written))) if written.text == "none" => (Some(Wrap::Never), None),
        Some((_, Ok(written))) => (None, Some(written)),
        Some((entry, Err(_))) => {
            let period = entry.number().and_then(require_positive_period);
            (found.push_error(period).map(Wrap::Period), None)
        }
    };
    Some(Column {
        column: column?,
        unit: unit?,
        wrap,
        period,
    })
}

fn require_positive_period(period: Number) -> Result<Number, Diagnostic> {
    match period.value > 0.0 {
        true => Ok(period),
        false => Err(Diagnostic::error(format!(
            "values cannot wrap around after {}",
            period.value
        ))
        .with_span(
            period.span,
            "expected a number greater than 0, in the column's unit, or \"none\"",
        )),
    }
}

fn read_key(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<ColumnKey> {
    let Ok((number, span)) = entry.integer() else {
        return found.push_error(entry.written()).map(ColumnKey::Name);
    };
    match usize::try_from(number) {
        Ok(number) if number > 0 => Some(ColumnKey::Number(number, span)),
        _ => {
            found.push(
                Diagnostic::error(format!("there is no column {number}"))
                    .with_span(span, "columns are numbered from 1"),
            );
            None
        }
    }
}

pub(super) fn read_time(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<Time> {
    let record = Record::read(entry, &keys::TIME, found)?;
    let every = match record.get("every") {
        Some(every) => {
            let (count, span) = found.push_error(every.integer())?;
            if !DECIMATION_RANGE.contains(&count) {
                found.push(
                    Diagnostic::error(format!("`every` cannot be {count}")).with_span(
                        span,
                        "expected a number of samples of which one is kept, at least 1",
                    ),
                );
            }
            usize::try_from(count).unwrap_or(1).max(1)
        }
        None => 1,
    };
    let filter = |entry: &Entry<'_>| entry.keyword(&[("low-pass", true), ("none", false)]);
    let filter = record.optional("filter", filter, found).unwrap_or(true);
    Some(Time {
        column: read_column(&record, found)?,
        every,
        filter,
    })
}

pub(super) fn read_input(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<InputColumn> {
    let record = Record::read(entry, &keys::INPUT, found)?;
    record.optional("hold", |entry| entry.keyword(&[("zero-order", ())]), found);
    let [gain, bias, delay] = ["gain", "bias", "delay"].map(|key| read_prior(&record, key, found));
    Some(InputColumn {
        name: entry.name.clone(),
        column: read_column(&record, found)?,
        gain,
        bias,
        delay,
    })
}

pub(super) fn read_motion(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<MotionColumn> {
    let record = Record::read(entry, &keys::MOTION, found)?;
    let initial = record.number("initial", found);
    Some(MotionColumn {
        name: entry.name.clone(),
        column: read_column(&record, found)?,
        initial,
    })
}

pub(super) fn read_channel(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<ChannelColumn> {
    let record = Record::read(entry, &keys::CHANNEL, found)?;
    let noise = record.required("noise", Entry::number, found);
    let observable = record.written("observable", found);
    let [gain, bias, delay] = ["gain", "bias", "delay"].map(|key| read_prior(&record, key, found));
    Some(ChannelColumn {
        name: entry.name.clone(),
        column: read_column(&record, found)?,
        noise: noise?,
        observable,
        gain,
        bias,
        delay,
    })
}

fn read_prior(record: &Record<'_>, key: &str, found: &mut Diagnostics) -> Option<Prior> {
    let record = Record::read(record.get(key)?, &keys::PRIOR, found)?;
    let mean = record.number("mean", found);
    let sd = record.required("sd", Entry::number, found)?;
    if sd.value < 0.0 {
        found.push(
            Diagnostic::error(format!("`sd` cannot be {}", sd.value))
                .with_span(sd.span, "expected one standard deviation, 0 or greater"),
        );
    }
    if let Some(mean) = mean.filter(|mean| key == "gain" && mean.value == 0.0) {
        found.push(
            Diagnostic::error("a gain cannot be 0: the column would not depend on the quantity")
                .with_span(mean.span, "expected a number other than 0"),
        );
    }
    Some(Prior { mean, sd })
}
