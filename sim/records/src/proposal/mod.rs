//! Proposal of a dataset file for a record and a model. `layout` detects the layout of the file, `matching` matches its
//! columns, and `dataset_file` writes the text with the reason for every guess.

mod dataset_file;
pub(crate) mod layout;
mod matching;

use std::path::Path;

use eomgen_model_spec::dimension::Dimension;
use eomgen_model_spec::model::Model;
use eomgen_model_spec::span::Span;
use eomgen_model_spec::unit::Unit;

use crate::columns;
use crate::csv_file;
use crate::description::columns::ColumnKey;
use crate::description::format::Format;
use crate::parquet_file;
use crate::refusal::Refusal;
use crate::samples::{MAX_JITTER_FRACTION, MIN_SAMPLES, typical_step};
use crate::wrap_detection::{WrapPattern, detect_wrapping};
use crate::wrapped_columns::{can_wrap, to_column_unit};

use self::matching::{FileColumn, Match, Quantity, list_quantities, match_columns};

const TRAIN_FRACTION: f64 = 0.6;

const WINDOWS_PER_RECORD: f64 = 20.0;

const MIN_SAMPLES_PER_WINDOW: f64 = 100.0;

/// Number of samples above which decimation is proposed, because a search would take too long.
const MAX_UNDECIMATED_SAMPLES: usize = 100_000;

const TIME_COLUMN_NAMES: [&str; 6] = ["t", "time", "zeit", "timestamp", "seconds", "sec"];

struct DetectedRecord<'m> {
    model: &'m Model,
    format: Format,
    columns: Vec<FileColumn>,
    values: Vec<Vec<f64>>,
    /// Index of the time column, and its unit.
    time: usize,
    time_unit: Unit,
    quantities: Vec<Quantity>,
    matches: Vec<Match>,
}

impl DetectedRecord<'_> {
    fn times(&self) -> &[f64] {
        &self.values[self.time]
    }

    /// Returns the unit of a matched column, and its source: the file or a guess.
    fn unit(&self, matched: &Match) -> (Unit, &'static str) {
        let own = &self.quantities[matched.quantity].unit;
        let degree = || {
            Unit::parse("deg")
                .ok()
                .filter(|unit| self.turns_in_unit(matched, unit))
        };
        match &self.columns[matched.column].unit {
            Some(unit) => (unit.clone(), "from the file"),
            None => match Some(own)
                .filter(|own| own.text == "rad")
                .and_then(|_| degree())
            {
                Some(degree) => (degree, "guessed: it jumps by 360, like an angle in degrees"),
                None => (
                    own.clone(),
                    "guessed: the unit in the model, because the file has none",
                ),
            },
        }
    }

    fn turns_in_unit(&self, matched: &Match, unit: &Unit) -> bool {
        let values = &self.values[matched.column];
        let pattern = detect_wrapping(self.times(), values, to_column_unit(unit));
        pattern.is_some_and(|pattern| pattern.is_turn)
    }

    fn wrap_pattern(&self, matched: &Match) -> Option<WrapPattern> {
        let (unit, _) = self.unit(matched);
        let values = &self.values[matched.column];
        let pattern = || detect_wrapping(self.times(), values, to_column_unit(&unit));
        can_wrap(&unit).then(pattern).flatten()
    }

    fn step(&self) -> f64 {
        self.time_unit.to_si(typical_step(self.times()))
    }

    fn is_uneven(&self) -> bool {
        let step = typical_step(self.times());
        let mut steps = self.times().windows(2).map(|pair| pair[1] - pair[0]);
        steps.any(|s| (s - step).abs() > MAX_JITTER_FRACTION * step)
    }

    /// Returns true if the column of time has no unit and increases by one from line to line.
    fn time_is_a_counter(&self) -> bool {
        self.columns[self.time].unit.is_none()
            && self.times().windows(2).all(|pair| pair[1] - pair[0] == 1.0)
    }

    fn decimation_factor(&self) -> usize {
        self.times().len().div_ceil(MAX_UNDECIMATED_SAMPLES)
    }

    /// Returns the start of the test part, in the unit of the time column.
    fn test_start(&self) -> f64 {
        let times = self.times();
        times[(TRAIN_FRACTION * times.len() as f64) as usize]
    }

    /// Returns the length of a window in s; `None` if the record is too short to split.
    fn window_length(&self) -> Option<f64> {
        let step = self.step() * self.decimation_factor() as f64;
        let train = self.time_unit.to_si(self.test_start() - self.times()[0]);
        let length = round_down((train / WINDOWS_PER_RECORD).max(MIN_SAMPLES_PER_WINDOW * step));
        let judged = self
            .time_unit
            .to_si(self.times()[self.times().len() - 1] - self.test_start());
        (2.0 * length <= judged).then_some(length)
    }
}

fn round_down(value: f64) -> f64 {
    let exponent = value.log10().floor() as i32;
    let part = |digit: i32, exponent: i32| -> f64 {
        format!("{digit}e{exponent}").parse().unwrap_or(value)
    };
    let choices = [5, 2, 1].map(|digit| part(digit, exponent));
    let fitting = choices
        .into_iter()
        .find(|choice| *choice <= value * (1.0 + 1e-9));
    fitting.unwrap_or(part(1, exponent))
}

/// Returns the text of a dataset file for a record of a model. Comments give the reason for every
/// guess. `name` is the record's path relative to the folder of the dataset file.
///
/// # Errors
/// A record that cannot be read, has no time, or has no column that is a quantity of the model.
pub fn propose_dataset(record: &Path, name: &str, model: &Model) -> Result<String, Refusal> {
    let bytes = columns::read_bytes(record)?;
    let (format, mut columns) = match record.extension().is_some_and(|e| e == "parquet") {
        true => {
            let names = parquet_file::column_names(record, bytes)?;
            let column =
                |(number, name): &(usize, String)| FileColumn::from_header(*number, name, "");
            (Format::default(), names.iter().map(column).collect())
        }
        false => detect_columns(record, &bytes)?,
    };
    let keys: Vec<ColumnKey> = columns
        .iter()
        .map(|column| ColumnKey::Number(column.number, Span::default()))
        .collect();
    let wanted: Vec<&ColumnKey> = keys.iter().collect();
    let table = columns::read_columns(record, &format, &wanted)?;
    let (time, time_unit) = find_time(record, &mut columns, &table.columns)?;
    let fewest = 2 * MIN_SAMPLES + MIN_SAMPLES / 2;
    if table.lines.len() < fewest {
        return Err(Refusal::file_error(
            record,
            format!(
                "has {} samples; expected {fewest} or more: at least {MIN_SAMPLES} each for training and testing",
                table.lines.len()
            ),
        ));
    }
    let mut found = DetectedRecord {
        model,
        format,
        columns,
        values: table.columns,
        time,
        time_unit,
        quantities: list_quantities(model),
        matches: Vec::new(),
    };
    let clock = found.columns.remove(time);
    found.matches = match_columns(&mut found.columns, &found.quantities);
    found.columns.insert(time, clock);
    for matched in &mut found.matches {
        matched.column += usize::from(matched.column >= time);
    }
    let is_channel = |m: &Match| !found.quantities[m.quantity].is_input;
    if !found.matches.iter().any(is_channel) {
        return Err(no_match_error(record, &found));
    }
    Ok(dataset_file::dataset_text(&found, name))
}

fn detect_columns(record: &Path, bytes: &[u8]) -> Result<(Format, Vec<FileColumn>), Refusal> {
    // If the file is not text, the reader reports the error.
    let text = csv_file::skip_lines(record, bytes, &Format::default())?;
    let text = String::from_utf8_lossy(&text);
    let layout = layout::detect_layout(&text).ok_or_else(|| {
        Refusal::file_error(
            record,
            "no two columns of numbers are found; expected lines of numbers, separated by commas, \
             semicolons, bars, tabs or spaces",
        )
    })?;
    let cells = layout.names.iter().zip(&layout.units).enumerate();
    let columns = cells.filter(|(place, _)| layout.numeric_columns[*place]);
    let columns =
        columns.map(|(place, (name, unit))| FileColumn::from_header(place + 1, name, unit));
    Ok((layout.format, columns.collect()))
}

fn find_time(
    record: &Path,
    columns: &mut [FileColumn],
    values: &[Vec<f64>],
) -> Result<(usize, Unit), Refusal> {
    let is_time =
        |name: &str| TIME_COLUMN_NAMES.contains(&name.to_lowercase().trim_matches(['#', ' ']));
    for column in columns.iter_mut() {
        if column
            .stem
            .rsplit_once('_')
            .is_some_and(|(stem, _)| is_time(stem))
        {
            column.read_unit_suffix();
        }
    }
    let is_of_time = |column: &FileColumn| match (&column.unit, &column.unknown_unit) {
        (Some(unit), _) => unit.dimension == Dimension::TIME,
        (None, unknown) => unknown.is_none() || is_time(&column.stem),
    };
    let rises = |column: &usize| {
        let values = &values[*column];
        let can_be_time = is_of_time(&columns[*column]);
        can_be_time
            && values.iter().all(|v| v.is_finite())
            && values.windows(2).all(|pair| pair[0] < pair[1])
    };
    let is_called = |column: &usize| is_time(&columns[*column].stem);
    let all = 0..columns.len();
    let Some(time) = all
        .clone()
        .find(|c| is_called(c) && rises(c))
        .or_else(|| all.clone().find(rises))
    else {
        let called = all.clone().find(is_called);
        return Err(Refusal::file_error(
            record,
            match called {
                Some(column) if !is_of_time(&columns[column]) => format!(
                    "column {}, `{}`, is not in a unit of time, and no other column increases; expected a column of \
                     time, for example in s",
                    columns[column].number, columns[column].name
                ),
                Some(column) => format!(
                    "the time does not increase in column {}, `{}`; expected samples in order, each once",
                    columns[column].number, columns[column].name
                ),
                None => "no column with a unit of time, or without a unit, increases from line to line; expected a \
                         time column"
                    .to_owned(),
            },
        ));
    };
    let unit = columns[time].unit.clone();
    Ok((time, unit.unwrap_or(Unit::coherent(Dimension::TIME))))
}

fn no_match_error(record: &Path, found: &DetectedRecord<'_>) -> Refusal {
    let names = found
        .columns
        .iter()
        .map(|column| match column.name.as_str() {
            "" => format!("column {}", column.number),
            name => name.to_owned(),
        });
    let names: Vec<String> = names.collect();
    let repeated = (names.iter().enumerate()).find(|(place, name)| names[..*place].contains(name));
    if let Some((_, name)) = repeated {
        return Refusal::file_error(
            record,
            format!("there are two columns `{name}`; rename one"),
        );
    }
    let measured = found.quantities.iter().filter(|q| !q.is_input);
    let measured: Vec<&str> = measured.map(|q| q.name.as_str()).collect();
    Refusal::file_error(
        record,
        format!(
            "no column is an observable, coordinate or rate of the model by its name or unit; columns: {}; \
             quantities of the model: {}; rename columns, or write the dataset file by hand",
            names.join(", "),
            measured.join(", ")
        ),
    )
}

#[cfg(test)]
mod tests {
    #[test]
    fn lengths_are_rounded_down_to_one_two_or_five() {
        for (value, expected) in [
            (0.12, 0.1),
            (0.5, 0.5),
            (0.99, 0.5),
            (2.4, 2.0),
            (1e-3, 1e-3),
        ] {
            assert_eq!(super::round_down(value), expected);
        }
    }
}
