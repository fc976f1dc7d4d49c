//! What is done about columns whose values wrap around: those that the dataset file declares are unwrapped,
//! others that look wrapped are refused.

use std::f64::consts::TAU;
use std::ops::Range;
use std::path::Path;

use eomgen_model_spec::diagnostic::Diagnostic;
use eomgen_model_spec::dimension::Dimension;
use eomgen_model_spec::table::Number;
use eomgen_model_spec::unit::Unit;

use crate::description::columns::{Column, Wrap};
use crate::header::Table;
use crate::samples::{LOST, span, typical_step};
use crate::unwrapping::unwrapped;
use crate::wrap_detection::{ALIKE, WrapPattern, wrap_pattern};
use crate::wrap_period::ColumnUnit;

/// A period that differs from a full or a half turn by less than this part is one that was rounded.
const ROUNDED: f64 = 1e-3;

/// A wrapped column spans at most this many periods, its noise included.
const MOST_PERIODS: f64 = 1.1;

/// A column that is read.
pub(crate) struct ReadColumn<'d> {
    /// The table that describes it: `inputs`, `motion` or `channels`.
    table: &'static str,
    /// The table's entry.
    name: &'d str,
    /// What the dataset file says of it.
    pub column: &'d Column,
    /// Its unit.
    pub unit: &'d Unit,
    /// Its value at the beginning of a file, SI, if that is known.
    start: Option<f64>,
}

impl<'d> ReadColumn<'d> {
    /// The column of an entry of a table, of which no value is known.
    pub fn of(table: &'static str, name: &'d str, column: &'d Column, unit: &'d Unit) -> Self {
        Self {
            table,
            name,
            column,
            unit,
            start: None,
        }
    }

    /// The same column with its value at the beginning of a file, SI.
    pub fn starting_at(self, start: Option<f64>) -> Self {
        Self { start, ..self }
    }

    /// Returns the unit, in SI.
    fn column_unit(&self) -> ColumnUnit {
        ColumnUnit {
            size: self.unit.to_si(1.0) - self.unit.to_si(0.0),
            turn: self.turn(),
        }
    }

    /// A full turn in SI, if the column may hold angles.
    fn turn(&self) -> Option<f64> {
        full_turn(self.unit).map(|turn| self.unit.to_si(turn))
    }

    /// The declared period, SI. One that is a rounded full or half turn is that turn: its error would grow
    /// with every turn.
    fn period(&self, number: Number) -> f64 {
        let period = self.unit.to_si(number.value);
        let turns = self.turn().into_iter().flat_map(|turn| [turn, 0.5 * turn]);
        let mut near = turns.filter(|turn| (period - turn).abs() < ROUNDED * turn);
        near.next().unwrap_or(period)
    }
}

/// A full turn in a unit of angles or of pure numbers.
fn full_turn(unit: &Unit) -> Option<f64> {
    (unit.dimension == Dimension::NONE).then(|| unit.from_si(TAU))
}

/// Returns the unit of a column whose values are in that unit.
pub(crate) fn own_unit(unit: &Unit) -> ColumnUnit {
    ColumnUnit {
        size: 1.0,
        turn: full_turn(unit),
    }
}

/// Whether a quantity of this unit can wrap around: angles, counts and lengths can.
pub(crate) fn can_wrap(unit: &Unit) -> bool {
    [Dimension::NONE, Dimension::LENGTH].contains(&unit.dimension)
}

/// Unwraps the declared columns behind the times of a table; returns remarks. `range`: the file and the
/// stretch of time that is used of it.
///
/// # Errors
/// A column that is wrapped and not declared so, a period that is not the column's, and a gap inside the
/// stretch over which the number of periods is not known.
pub(crate) fn unwrap_columns(
    read: &[ReadColumn<'_>],
    (file, range): (&Path, Range<f64>),
    table: &mut Table,
) -> Result<Vec<String>, Diagnostic> {
    let mut notes = Vec::new();
    let Some((times, columns)) = table.columns.split_first_mut() else {
        return Ok(notes);
    };
    for (column, values) in read.iter().zip(columns) {
        let pattern = match can_wrap(column.unit) {
            true => wrap_pattern(times, values, column.column_unit()),
            false => None,
        };
        match (column.column.wrap, pattern) {
            (Some(Wrap::Period(number)), pattern) => {
                check_period(column, number, values, pattern)?;
                notes.extend(unwrap_column(column, number, &range, (times, values))?);
            }
            (None, Some(pattern)) => notes.extend(refuse_wrapped(column, file, &pattern)?),
            _ => {}
        }
    }
    Ok(notes)
}

/// Checks that a declared period is the column's.
fn check_period(
    column: &ReadColumn<'_>,
    number: Number,
    values: &[f64],
    pattern: Option<WrapPattern>,
) -> Result<(), Diagnostic> {
    let (name, unit, period) = (column.name, column.unit, column.period(number));
    let wrong = |message: String, help: String| {
        let wrong = Diagnostic::error(message).at(number.span, "this is not its period");
        Err(wrong.help(help))
    };
    let spanned = span(values);
    if spanned > MOST_PERIODS * period {
        let spanned = unit.from_si(spanned);
        return wrong(
            format!(
                "the column of `{name}` spans {}, more than one period",
                with_unit(spanned, unit)
            ),
            "expected how far the sensor counts before it starts again; leave `wrap` out if it does not"
                .to_owned(),
        );
    }
    match pattern {
        Some(pattern) if (pattern.period - period).abs() > ALIKE * period => {
            let seen = unit.from_si(pattern.period);
            wrong(
                format!(
                    "the column of `{name}` jumps by about {}",
                    with_unit(seen, unit)
                ),
                proposed_key(&pattern, seen, ""),
            )
        }
        _ => Ok(()),
    }
}

/// Returns a size in a unit, as messages give it.
fn with_unit(size: f64, unit: &Unit) -> String {
    match unit.to_string().as_str() {
        "1" => format!("{size:.4}"),
        unit => format!("{size:.4} {unit}"),
    }
}

/// Returns the key to write for a period in its unit, at a place, with the uncertainty of the period.
fn proposed_key(pattern: &WrapPattern, period: f64, place: &str) -> String {
    let key = format!("write wrap = {}{place}", pattern.written(period));
    match pattern.doubt(period) {
        Some(doubt) => format!("{key} ({doubt})"),
        None => key,
    }
}

/// Unwraps one column.
fn unwrap_column(
    column: &ReadColumn<'_>,
    number: Number,
    range: &Range<f64>,
    (times, values): (&[f64], &mut Vec<f64>),
) -> Result<Vec<String>, Diagnostic> {
    let (name, period) = (column.name, column.period(number));
    let found = unwrapped(times, values, period);
    let lost = LOST * typical_step(times);
    let mut notes = Vec::new();
    for (from, to) in found.unknown {
        let place = format!("from {from:.6} s to {to:.6} s");
        let has_samples = (times.iter()).any(|t| *t > from && *t < to);
        if to - from > lost && !has_samples {
            notes.push(format!(
                "`{name}` may be off by whole periods after the gap {place}: its speed changes there"
            ));
        } else if from < range.end && to > range.start {
            return Err(Diagnostic::error(format!(
                "`{name}` is missing {place}, and its speed changes there: the number of turns is not known"
            ))
            .at(column.column.column.span(), "in this column")
            .help("list the parts of the file before and after it, with from and to"));
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

/// Refuses a column that is wrapped and not declared so; returns a remark if it only may be wrapped.
fn refuse_wrapped(
    column: &ReadColumn<'_>,
    file: &Path,
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
        with_unit(size, unit),
        pattern.first
    );
    let cure = proposed_key(pattern, size, &format!(" in [{table}.{name}]"));
    if pattern.is_wrapped(table == "inputs") {
        return Err(Diagnostic::error(jumps)
            .at(column.column.column.span(), "the values wrap around")
            .help(format!("{cure}, or wrap = \"none\" if the jumps are real")));
    }
    Ok((table != "inputs").then(|| format!("{jumps}; if it wraps around, {cure}")))
}
