//! `[time]`, `[inputs.NAME]`, `[motion.NAME]` and `[channels.NAME]`: columns of the records, and what is known of
//! the sensors behind them.

use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics};
use eomgen_model_spec::span::Span;
use eomgen_model_spec::table::{Entry, Name, Number, Record, Written};

use super::keys;
use super::required::required;

/// The least and the most samples of which one is kept.
const EVERY: std::ops::RangeInclusive<i64> = 1..=1_000_000;

/// Which column of the records.
#[derive(Clone, Debug)]
pub enum ColumnKey {
    /// The one of this name.
    Name(Written),
    /// The one of this number, from 1 on.
    Number(usize, Span),
}

impl ColumnKey {
    /// Where the dataset file says it.
    pub fn span(&self) -> Span {
        match self {
            Self::Name(written) => written.span,
            Self::Number(_, span) => *span,
        }
    }
}

/// A column of the records.
#[derive(Debug)]
pub struct Column {
    /// Which one.
    pub column: ColumnKey,
    /// Its unit.
    pub unit: Written,
    /// Whether its values wrap around, if the file says it.
    pub wrap: Option<Wrap>,
}

/// What a dataset file says of values that jump from one end of a range to the other.
#[derive(Clone, Copy, Debug)]
pub enum Wrap {
    /// They wrap around after this much, in the column's unit.
    Period(Number),
    /// Jumps are real.
    Never,
}

/// `[time]`
#[derive(Debug)]
pub struct Time {
    /// The column.
    pub column: Column,
    /// One of so many samples is kept.
    pub every: usize,
    /// Whether the channels are low-passed before.
    pub filter: bool,
}

/// `[inputs.NAME]`
#[derive(Debug)]
pub struct InputColumn {
    /// The input.
    pub name: Name,
    /// Its column.
    pub column: Column,
    /// What is known of the gain of what it acts through.
    pub gain: Option<Prior>,
    /// What is known of its bias, in its unit.
    pub bias: Option<Prior>,
    /// What is known of its delay, s.
    pub delay: Option<Prior>,
}

/// `[motion.NAME]`
#[derive(Debug)]
pub struct MotionColumn {
    /// The coordinate.
    pub name: Name,
    /// Its column: the position or, by its unit, the speed.
    pub column: Column,
    /// The position at a file's first sample, in SI, beside a speed.
    pub initial: Option<Number>,
}

/// `[channels.NAME]`
#[derive(Debug)]
pub struct ChannelColumn {
    /// The channel.
    pub name: Name,
    /// Its column.
    pub column: Column,
    /// One standard deviation of its noise, in its unit.
    pub noise: Number,
    /// What it measures, where that is not its name.
    pub observable: Option<Written>,
    /// What is known of its gain.
    pub gain: Option<Prior>,
    /// What is known of its bias, in its unit.
    pub bias: Option<Prior>,
    /// What is known of its delay, s.
    pub delay: Option<Prior>,
}

impl ChannelColumn {
    /// What it measures, as the file calls it.
    pub fn measures(&self) -> &str {
        let observable = self.observable.as_ref();
        observable.map_or(&self.name.text, |written| &written.text)
    }
}

/// What is known of a gain, a bias or a delay.
#[derive(Clone, Copy, Debug)]
pub struct Prior {
    /// What is expected, where that is not the usual.
    pub mean: Option<Number>,
    /// One standard deviation; 0 where it is known.
    pub sd: Number,
}

fn column(record: &Record<'_>, found: &mut Diagnostics) -> Option<Column> {
    let column = required(record, "column", "\"its name in the records\"", found).cloned();
    let unit = required(record, "unit", "\"m\"", found).cloned();
    let column = column.and_then(|entry| key(&entry, found));
    let unit = unit.and_then(|entry| found.keep(entry.written()));
    let wrap = wrap(record, found);
    Some(Column {
        column: column?,
        unit: unit?,
        wrap: wrap?,
    })
}

/// What the file says of wrapping; none if that is wrong.
fn wrap(record: &Record<'_>, found: &mut Diagnostics) -> Option<Option<Wrap>> {
    let Some(entry) = record.get("wrap") else {
        return Some(None);
    };
    if entry.written().is_ok() {
        let never = found.keep(entry.word(&[("none", Wrap::Never)]))?;
        return Some(Some(never));
    }
    let period = found.keep(entry.number())?;
    if period.value <= 0.0 {
        found.push(
            Diagnostic::error(format!("values cannot wrap around after {}", period.value)).at(
                period.span,
                "expected a number greater than 0, in the column's unit, or \"none\"",
            ),
        );
        return None;
    }
    Some(Some(Wrap::Period(period)))
}

/// A column by its name, or by its number.
fn key(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<ColumnKey> {
    let Ok((number, span)) = entry.whole() else {
        return found.keep(entry.written()).map(ColumnKey::Name);
    };
    match usize::try_from(number) {
        Ok(number) if number > 0 => Some(ColumnKey::Number(number, span)),
        _ => {
            found.push(
                Diagnostic::error(format!("there is no column {number}"))
                    .at(span, "columns are numbered from 1"),
            );
            None
        }
    }
}

/// Reads `[time]`.
pub(super) fn time(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<Time> {
    let record = entry.record(&keys::TIME, "{ column = \"t\", unit = \"s\" }", found)?;
    let every = match record.get("every") {
        Some(every) => {
            let (count, span) = found.keep(every.whole())?;
            if !EVERY.contains(&count) {
                found.push(
                    Diagnostic::error(format!("one of {count} samples cannot be kept"))
                        .at(span, "expected how many samples become one, from 1 on"),
                );
            }
            usize::try_from(count).unwrap_or(1).max(1)
        }
        None => 1,
    };
    let filter = match record.get("filter") {
        Some(filter) => found.keep(filter.word(&[("low-pass", true), ("none", false)]))?,
        None => true,
    };
    Some(Time {
        column: column(&record, found)?,
        every,
        filter,
    })
}

/// Reads an entry of `[inputs]`.
pub(super) fn input(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<InputColumn> {
    let example = "{ column = \"u\", unit = \"N\" }";
    let record = entry.record(&keys::INPUT, example, found)?;
    if let Some(hold) = record.get("hold") {
        found.keep(hold.word(&[("zero-order", ())]));
    }
    let [gain, bias, delay] = ["gain", "bias", "delay"].map(|key| prior(&record, key, found));
    Some(InputColumn {
        name: entry.name.clone(),
        column: column(&record, found)?,
        gain: gain?,
        bias: bias?,
        delay: delay?,
    })
}

/// Reads an entry of `[motion]`.
pub(super) fn motion(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<MotionColumn> {
    let record = entry.record(&keys::MOTION, "{ column = \"q\", unit = \"rad\" }", found)?;
    let initial = record.number("initial", found);
    Some(MotionColumn {
        name: entry.name.clone(),
        column: column(&record, found)?,
        initial,
    })
}

/// Reads an entry of `[channels]`.
pub(super) fn channel(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<ChannelColumn> {
    let example = "{ column = \"x\", unit = \"m\", noise = 1e-6 }";
    let record = entry.record(&keys::CHANNEL, example, found)?;
    let noise = required(&record, "noise", "1e-6, one standard deviation", found).cloned();
    let noise = noise.and_then(|noise| found.keep(noise.number()));
    let observable = record.written("observable", found);
    let [gain, bias, delay] = ["gain", "bias", "delay"].map(|key| prior(&record, key, found));
    Some(ChannelColumn {
        name: entry.name.clone(),
        column: column(&record, found)?,
        noise: noise?,
        observable,
        gain: gain?,
        bias: bias?,
        delay: delay?,
    })
}

/// What is known of a gain, a bias or a delay, if anything is said; none if that is wrong.
fn prior(record: &Record<'_>, key: &str, found: &mut Diagnostics) -> Option<Option<Prior>> {
    let Some(entry) = record.get(key) else {
        return Some(None);
    };
    let record = entry.record(&keys::PRIOR, "{ sd = 0.02 }", found)?;
    let mean = match record.get("mean") {
        Some(mean) => Some(found.keep(mean.number())?),
        None => None,
    };
    let sd = required(
        &record,
        "sd",
        "0.02, one standard deviation, or 0 where it is known",
        found,
    )?;
    let sd = found.keep(sd.number())?;
    if sd.value < 0.0 {
        found.push(
            Diagnostic::error(format!("`sd` cannot be {}", sd.value))
                .at(sd.span, "expected one standard deviation, 0 or greater"),
        );
    }
    Some(Some(Prior { mean, sd }))
}
