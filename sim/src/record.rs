//! Recorded input signals: a dataset file names the records, their time column and the
//! columns of the inputs; between samples an input is held. Measured channels are not
//! read here.

pub mod description;

use std::path::{Component, Path, PathBuf};

use model_spec::diagnostic::{Diagnostic, Diagnostics};
use model_spec::model::Model;
use model_spec::table::Written;
use model_spec::unit::Unit;

use description::{Column, Description};

/// The largest record accepted, in bytes.
const LARGEST_RECORD: u64 = 512 << 20;

/// Inputs that are constant between the times of a record. Before the first sample the
/// first one holds, after the last one the last.
#[derive(Clone, Debug, PartialEq)]
pub struct HeldInputs {
    times: Vec<f64>,
    /// One row per time, one number per input.
    values: Vec<f64>,
    count: usize,
}

impl HeldInputs {
    /// Inputs that are zero at all times.
    pub fn zero(count: usize) -> Self {
        Self {
            times: vec![0.0],
            values: vec![0.0; count],
            count,
        }
    }

    /// Inputs from rows of `count` numbers, one row for each of the ascending times (s), each
    /// held until the next; none if there is no row, or not as many numbers as rows hold.
    pub fn new(times: Vec<f64>, values: Vec<f64>, count: usize) -> Option<Self> {
        let whole = !times.is_empty() && values.len() == times.len() * count;
        whole.then_some(Self {
            times,
            values,
            count,
        })
    }

    /// The inputs at a time, in the order of the model.
    pub fn at(&self, t: f64) -> &[f64] {
        let after = self.times.partition_point(|time| *time <= t);
        let row = after.saturating_sub(1);
        &self.values[row * self.count..(row + 1) * self.count]
    }

    /// The next time after `t` at which an input changes.
    pub fn next_change(&self, t: f64) -> Option<f64> {
        if self.count == 0 {
            return None;
        }
        let after = self.times.partition_point(|time| *time <= t);
        self.times.get(after).copied()
    }

    /// The times of the samples, in s.
    pub fn times(&self) -> &[f64] {
        &self.times
    }
}

/// Why records are not taken: where they are wrong, what is wrong and what would be right.
#[derive(Clone, Debug)]
pub enum Refusal {
    /// The dataset file is wrong.
    Description(Diagnostics),
    /// A record is wrong: a sentence that names its file, and line where there is one.
    Record(String),
}

impl Refusal {
    /// A record that is wrong as a whole.
    pub fn file(path: &Path, message: impl std::fmt::Display) -> Self {
        Self::Record(format!("{}: {message}", path.display()))
    }

    /// A record that is wrong on a line.
    pub fn line(path: &Path, line: u64, message: impl std::fmt::Display) -> Self {
        Self::Record(format!("{}, line {line}: {message}", path.display()))
    }
}

impl From<Diagnostics> for Refusal {
    fn from(found: Diagnostics) -> Self {
        Self::Description(found)
    }
}

impl std::fmt::Display for Refusal {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Description(found) => found.fmt(f),
            Self::Record(message) => f.write_str(message),
        }
    }
}

impl std::error::Error for Refusal {}

/// The inputs of `model` from a record of a dataset, and what is worth a warning.
///
/// `record` is `train[0]`, `test[1]`, ...
///
/// # Errors
/// What is wrong with the dataset file or with the record.
pub fn read_inputs(
    dataset: &Path,
    record: &str,
    model: &Model,
) -> Result<(HeldInputs, Vec<String>), Refusal> {
    let description = Description::read(dataset)?;
    let place = described(&description, record).map_err(Refusal::Record)?;
    let wrong = |diagnostic: Diagnostic| {
        Refusal::Description(Diagnostics::one(description.source.clone(), diagnostic))
    };
    let path = beside(dataset, place).map_err(wrong)?;
    let mut warnings = Vec::new();
    let mut columns = Vec::new();
    for input in &model.inputs {
        let described = description.inputs.iter();
        match described
            .into_iter()
            .find(|column| column.name.text == input.name)
        {
            Some(entry) => {
                columns.push(Some(
                    scaled(&entry.column, &input.unit.text).map_err(wrong)?,
                ));
            }
            None => {
                warnings.push(format!(
                    "{} has no input `{}`: it is 0",
                    dataset.display(),
                    input.name
                ));
                columns.push(None);
            }
        }
    }
    for column in &description.inputs {
        let name = &column.name.text;
        if model.inputs.iter().all(|input| input.name != *name) {
            warnings.push(format!(
                "the model has no input `{name}`: that column is not used"
            ));
        }
    }
    let time = scaled(&description.time, "s").map_err(wrong)?;
    let inputs = read_record(&path, &time, &columns).map_err(Refusal::Record)?;
    Ok((inputs, warnings))
}

/// A column's name and the factor that brings it to SI.
struct Scaled {
    name: String,
    unit: Unit,
}

fn scaled(column: &Column, expected: &str) -> Result<Scaled, Diagnostic> {
    Ok(Scaled {
        name: column.column.text.clone(),
        unit: unit(&column.unit, expected)?,
    })
}

/// A unit of a dataset file that has the dimension of the expected one.
///
/// # Errors
/// What is no unit, or another quantity's.
pub fn unit(written: &Written, expected: &str) -> Result<Unit, Diagnostic> {
    let wrong = |message: String| Diagnostic::error(message);
    let text = &written.text;
    let unit = Unit::parse(text).map_err(|error| {
        wrong(format!("unit \"{text}\": {error}")).at(written.span, format!("expected {expected}"))
    })?;
    let wanted = Unit::parse(expected).map_err(|error| wrong(error.to_string()))?;
    if unit.dimension == wanted.dimension {
        return Ok(unit);
    }
    Err(
        wrong(format!("the column is in {text}, expected {expected}")).at(
            written.span,
            format!("expected {expected}, or a unit of its dimension"),
        ),
    )
}

/// The file of `train[0]`.
fn described<'d>(description: &'d Description, record: &str) -> Result<&'d Written, String> {
    let records = &description.records;
    let none = || {
        format!(
            "{}: there is no record `{record}`; it lists {} as train[..] and {} as test[..], numbered from 0",
            description.source.path,
            records.train.len(),
            records.test.len()
        )
    };
    let (list, rest) = match (record.strip_prefix("train["), record.strip_prefix("test[")) {
        (Some(rest), _) => (&records.train, rest),
        (_, Some(rest)) => (&records.test, rest),
        _ => return Err(none()),
    };
    let index = rest.strip_suffix(']').and_then(|i| i.parse().ok());
    let index: usize = index.ok_or_else(none)?;
    list.get(index).ok_or_else(none)
}

/// A record's file, below the dataset's folder.
///
/// # Errors
/// A name that leads out of that folder.
pub fn beside(dataset: &Path, file: &Written) -> Result<PathBuf, Diagnostic> {
    let relative = Path::new(&file.text);
    let inside = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
    if !relative.components().all(inside) {
        let name = &file.text;
        return Err(Diagnostic::error(format!(
            "the record \"{name}\" lies outside the dataset's folder"
        ))
        .at(
            file.span,
            "expected a file beside the dataset file or below",
        ));
    }
    Ok(dataset.parent().unwrap_or(Path::new(".")).join(relative))
}

fn read_limited(path: &Path, limit: u64) -> Result<String, String> {
    let metadata = std::fs::metadata(path)
        .map_err(|error| format!("cannot read {}: {error}", path.display()))?;
    if !metadata.is_file() {
        return Err(format!("cannot read {}: it is not a file", path.display()));
    }
    let size = metadata.len();
    if size > limit {
        return Err(format!(
            "{} has {size} bytes; the limit is {limit}",
            path.display()
        ));
    }
    std::fs::read_to_string(path)
        .map_err(|error| format!("cannot read {}: {error}", path.display()))
}

fn read_record(
    path: &Path,
    time: &Scaled,
    columns: &[Option<Scaled>],
) -> Result<HeldInputs, String> {
    let text = read_limited(path, LARGEST_RECORD)?;
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let headers = reader
        .headers()
        .map_err(|error| format!("{}: {error}", path.display()))?
        .clone();
    let find = |name: &str| {
        headers
            .iter()
            .position(|header| header.trim() == name)
            .ok_or_else(|| {
                let list: Vec<&str> = headers.iter().collect();
                format!(
                    "{}: no column `{name}`; there are {}",
                    path.display(),
                    list.join(", ")
                )
            })
    };
    let time_place = find(&time.name)?;
    let mut places = Vec::with_capacity(columns.len());
    for column in columns {
        places.push(match column {
            Some(scaled) => Some((find(&scaled.name)?, scaled)),
            None => None,
        });
    }
    let mut held = HeldInputs {
        times: Vec::new(),
        values: Vec::new(),
        count: columns.len(),
    };
    for (row, record) in reader.records().enumerate() {
        let record = record.map_err(|error| format!("{}: {error}", path.display()))?;
        let number = |place: usize, unit: &Unit| {
            let text = record.get(place).unwrap_or_default().trim();
            match text.parse::<f64>() {
                Ok(value) if value.is_finite() => Ok(unit.to_si(value)),
                _ => Err(format!(
                    "{}, line {}, column {}: \"{text}\" is no finite number",
                    path.display(),
                    row + 2,
                    place + 1
                )),
            }
        };
        let t = number(time_place, &time.unit)?;
        if held.times.last().is_some_and(|last| *last >= t) {
            return Err(format!(
                "{}, line {}: the time does not increase",
                path.display(),
                row + 2
            ));
        }
        held.times.push(t);
        for place in &places {
            held.values.push(match place {
                Some((place, scaled)) => number(*place, &scaled.unit)?,
                None => 0.0,
            });
        }
    }
    if held.times.len() < 2 {
        return Err(format!("{}: fewer than two samples", path.display()));
    }
    Ok(held)
}

#[cfg(test)]
mod tests {
    use super::HeldInputs;

    #[test]
    fn an_input_is_held_from_its_sample_to_the_next() {
        let held = HeldInputs {
            times: vec![0.0, 1.0, 2.0],
            values: vec![5.0, 6.0, 7.0],
            count: 1,
        };
        assert_eq!(held.at(-1.0), [5.0]);
        assert_eq!(held.at(0.999), [5.0]);
        assert_eq!(held.at(1.0), [6.0]);
        assert_eq!(held.at(9.0), [7.0]);
        assert_eq!(held.next_change(0.0), Some(1.0));
        assert_eq!(held.next_change(1.5), Some(2.0));
        assert_eq!(held.next_change(2.0), None);
    }

    #[test]
    fn no_input_never_changes() {
        assert_eq!(HeldInputs::zero(0).next_change(0.0), None);
        assert_eq!(HeldInputs::zero(2).at(3.0), [0.0, 0.0]);
    }
}
