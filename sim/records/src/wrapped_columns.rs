//! Unwraps columns with a declared period, and rejects other columns that look wrapped.

use std::f64::consts::TAU;
use std::path::Path;

use eomgen_model_spec::diagnostic::Diagnostic;
use eomgen_model_spec::dimension::Dimension;
use eomgen_model_spec::quantity::Number;
use eomgen_model_spec::unit::Unit;

use crate::description::columns::{Column, Wrap};
use crate::header::Table;
use crate::samples::{MIN_GAP_STEPS, span, typical_step};
use crate::unwrapping::unwrap_values;
use crate::used_part::UsedPart;
use crate::wrap_detection::{MAX_RELATIVE_DIFFERENCE, WrapPattern, detect_wrapping};
use crate::wrap_period::ColumnUnit;

/// Relative difference below which a period counts as a rounded full or half turn.
const MAX_ROUNDING: f64 = 1e-3;

/// Largest range of a wrapped column in periods, including noise.
const MAX_RANGE_PERIODS: f64 = 1.1;

pub(crate) struct ReadColumn<'d> {
    /// Table of the dataset file: `inputs`, `motion` or `channels`.
    table: &'static str,
    name: &'d str,
    pub column: &'d Column,
    pub unit: &'d Unit,
    /// Known value at the start of a file, in SI.
    start: Option<f64>,
}

impl<'d> ReadColumn<'d> {
    pub fn new(table: &'static str, name: &'d str, column: &'d Column, unit: &'d Unit) -> Self {
        Self {
            table,
            name,
            column,
            unit,
            start: None,
        }
    }

    pub fn with_start(self, start: Option<f64>) -> Self {
        Self { start, ..self }
    }

    fn column_unit(&self) -> ColumnUnit {
        ColumnUnit {
            size: self.unit.to_si(1.0) - self.unit.to_si(0.0),
            turn: self.turn(),
        }
    }

    fn turn(&self) -> Option<f64> {
        full_turn(self.unit).map(|turn| self.unit.to_si(turn))
    }

    /// Returns the declared period in SI; a rounded full or half turn is replaced by the exact value.
    fn period_in_si(&self, number: Number) -> f64 {
        let period = self.unit.to_si(number.value);
        let turns = self.turn().into_iter().flat_map(|turn| [turn, 0.5 * turn]);
        let mut near = turns.filter(|turn| (period - turn).abs() < MAX_ROUNDING * turn);
        near.next().unwrap_or(period)
    }
}

fn full_turn(unit: &Unit) -> Option<f64> {
    (unit.dimension == Dimension::DIMENSIONLESS).then(|| unit.from_si(TAU))
}

pub(crate) fn to_column_unit(unit: &Unit) -> ColumnUnit {
    ColumnUnit {
        size: 1.0,
        turn: full_turn(unit),
    }
}

/// Returns true for units of angles, counts and lengths, whose values can wrap around.
pub(crate) fn can_wrap(unit: &Unit) -> bool {
    [Dimension::DIMENSIONLESS, Dimension::LENGTH].contains(&unit.dimension)
}

/// Unwraps the declared columns and returns notes.
pub(crate) fn unwrap_columns(
    read: &[ReadColumn<'_>],
    (file, used): (&Path, &UsedPart),
    table: &mut Table,
) -> Result<Vec<String>, Diagnostic> {
    let mut notes = Vec::new();
    let Some((times, columns)) = table.columns.split_first_mut() else {
        return Ok(notes);
    };
    for (column, values) in read.iter().zip(columns) {
        let pattern = match can_wrap(column.unit) {
            true => detect_wrapping(times, values, column.column_unit()),
            false => None,
        };
        match (column.column.wrap, pattern) {
            (Some(Wrap::Period(number)), pattern) => {
                check_period(column, number, values, pattern)?;
                notes.extend(unwrap_column(column, number, used, (times, values))?);
            }
            (None, Some(pattern)) => {
                notes.extend(reject_wrapped(column, (file, used.origin), &pattern)?)
            }
            _ => {}
        }
    }
    Ok(notes)
}

fn check_period(
    column: &ReadColumn<'_>,
    number: Number,
    values: &[f64],
    pattern: Option<WrapPattern>,
) -> Result<(), Diagnostic> {
    let (name, unit, period) = (column.name, column.unit, column.period_in_si(number));
    let wrong = |message: String, help: String| {
        let wrong =
            Diagnostic::error(message).with_span(number.span, "not the period of the column");
        Err(wrong.with_help(help))
    };
    let spanned = span(values);
    if spanned > MAX_RANGE_PERIODS * period {
        let spanned = unit.from_si(spanned);
        return wrong(
            format!(
                "the column of `{name}` spans {}, more than one period",
                format_with_unit(spanned, unit)
            ),
            "write the range of the sensor, or remove `wrap` if the values do not wrap around"
                .to_owned(),
        );
    }
    match pattern {
        Some(pattern) if (pattern.period - period).abs() > MAX_RELATIVE_DIFFERENCE * period => {
            let seen = unit.from_si(pattern.period);
            wrong(
                format!(
                    "the column of `{name}` jumps by about {}",
                    format_with_unit(seen, unit)
                ),
                format_proposed_key(&pattern, seen, ""),
            )
        }
        _ => Ok(()),
    }
}

fn format_with_unit(size: f64, unit: &Unit) -> String {
    match unit.to_string().as_str() {
        "1" => format!("{size:.4}"),
        unit => format!("{size:.4} {unit}"),
    }
}

fn format_proposed_key(pattern: &WrapPattern, period: f64, place: &str) -> String {
    let key = format!("write wrap = {}{place}", pattern.format_period(period));
    match pattern.uncertainty_note(period) {
        Some(doubt) => format!("{key} ({doubt})"),
        None => key,
    }
}

fn unwrap_column(
    column: &ReadColumn<'_>,
    number: Number,
    used: &UsedPart,
    (times, values): (&[f64], &mut Vec<f64>),
) -> Result<Vec<String>, Diagnostic> {
    let (name, period) = (column.name, column.period_in_si(number));
    let found = unwrap_values(times, values, period);
    let lost = MIN_GAP_STEPS * typical_step(times);
    let mut notes = Vec::new();
    for (from, to) in found.unknown {
        let (origin, span) = (used.origin, &used.span);
        let place = format!("from {:.6} s to {:.6} s", origin + from, origin + to);
        let has_samples = (times.iter()).any(|t| *t > from && *t < to);
        if to - from > lost && !has_samples {
            notes.push(format!(
                "`{name}` may have an error of whole periods after the gap {place}, because its speed changes there"
            ));
        } else if from < span.end && to > span.start {
            return Err(Diagnostic::error(format!(
                "`{name}` is missing {place}, and its speed changes there: the number of periods in the gap is unknown"
            ))
            .with_span(column.column.column.span(), "in this column")
            .with_help("list the parts of the file before and after the gap, with from and to"));
        }
    }
    *values = found.values;
    let first = values.iter().copied().find(|value| value.is_finite());
    if let (Some(start), Some(first)) = (column.start, first) {
        let offset = period * ((start - first) / period).round();
        values.iter_mut().for_each(|value| *value += offset);
    }
    Ok(notes)
}

fn reject_wrapped(
    column: &ReadColumn<'_>,
    (file, origin): (&Path, f64),
    pattern: &WrapPattern,
) -> Result<Option<String>, Diagnostic> {
    let (table, name, unit) = (column.table, column.name, column.unit);
    let size = unit.from_si(pattern.period);
    let count = match pattern.count {
        1 => "once".to_owned(),
        count => format!("{count} times"),
    };
    let jumps = format!(
        "{}: `{name}` jumps {count} by about {}, first at {:.6} s",
        file.display(),
        format_with_unit(size, unit),
        origin + pattern.first
    );
    let cure = format_proposed_key(pattern, size, &format!(" in [{table}.{name}]"));
    if pattern.is_wrapped(table == "inputs") {
        return Err(Diagnostic::error(jumps)
            .with_span(column.column.column.span(), "the values wrap around")
            .with_help(format!("{cure}, or wrap = \"none\" if the jumps are real")));
    }
    Ok((table != "inputs").then(|| format!("{jumps}; if it wraps around, {cure}")))
}
