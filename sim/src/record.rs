//! Recorded input signals: a dataset file names the records, their time column and the
//! columns of the inputs; between samples an input is held. Measured channels are not
//! read here.

use std::path::{Component, Path, PathBuf};

use model_spec::model::Model;
use model_spec::unit::Unit;
use serde::Deserialize;

/// The largest record accepted, in bytes.
const LARGEST_RECORD: u64 = 512 << 20;

/// The largest dataset file accepted, in bytes.
const LARGEST_DATASET: u64 = 1 << 20;

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

#[derive(Deserialize)]
struct Dataset {
    records: Records,
    time: Column,
    #[serde(default)]
    inputs: std::collections::BTreeMap<String, InputColumn>,
}

#[derive(Deserialize)]
struct Records {
    #[serde(default)]
    train: Vec<String>,
    #[serde(default)]
    test: Vec<String>,
}

#[derive(Deserialize)]
struct Column {
    column: String,
    unit: String,
}

#[derive(Deserialize)]
struct InputColumn {
    column: String,
    unit: String,
    hold: Option<String>,
}

/// The inputs of `model` from a record of a dataset, and what is worth a warning.
///
/// `record` is `train[0]`, `test[1]`, ...
///
/// # Errors
/// A sentence that names the file (and line) and says what is wrong and what would be right.
pub fn read_inputs(
    dataset: &Path,
    record: &str,
    model: &Model,
) -> Result<(HeldInputs, Vec<String>), String> {
    let text = read_limited(dataset, LARGEST_DATASET)?;
    let description: Dataset = toml_edit::de::from_str(&text)
        .map_err(|error| format!("{}: {error}", dataset.display()))?;
    let path = record_path(dataset, &description.records, record)?;
    let mut warnings = Vec::new();
    let mut columns = Vec::new();
    for input in &model.inputs {
        match description.inputs.get(&input.name) {
            Some(column) => columns.push(Some(input_column(
                dataset,
                &input.name,
                column,
                &input.unit,
            )?)),
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
    for name in description.inputs.keys() {
        if model.inputs.iter().all(|input| input.name != *name) {
            warnings.push(format!(
                "the model has no input `{name}`: that column is not used"
            ));
        }
    }
    let time = scaled_column(
        dataset,
        "time",
        &description.time.column,
        &description.time.unit,
        "s",
    )?;
    Ok((read_record(&path, &time, &columns)?, warnings))
}

/// A column's name and the factor that brings it to SI.
struct Scaled {
    name: String,
    unit: Unit,
}

fn input_column(
    dataset: &Path,
    name: &str,
    column: &InputColumn,
    unit: &Unit,
) -> Result<Scaled, String> {
    match column.hold.as_deref() {
        None | Some("zero-order") => {}
        Some(other) => {
            return Err(format!(
                "{}: inputs.{name}: hold = \"{other}\" is not known; expected \"zero-order\"",
                dataset.display()
            ));
        }
    }
    scaled_column(
        dataset,
        &format!("inputs.{name}"),
        &column.column,
        &column.unit,
        &unit.text,
    )
}

fn scaled_column(
    dataset: &Path,
    place: &str,
    column: &str,
    unit: &str,
    expected: &str,
) -> Result<Scaled, String> {
    let parsed = Unit::parse(unit)
        .map_err(|error| format!("{}: {place}: unit \"{unit}\": {error}", dataset.display()))?;
    let wanted = Unit::parse(expected).map_err(|error| error.to_string())?;
    if parsed.dimension != wanted.dimension {
        return Err(format!(
            "{}: {place} is in {unit}, expected {expected}",
            dataset.display()
        ));
    }
    Ok(Scaled {
        name: column.to_owned(),
        unit: parsed,
    })
}

/// The file of `train[0]`, below the dataset's folder.
fn record_path(dataset: &Path, records: &Records, record: &str) -> Result<PathBuf, String> {
    let described = || {
        format!(
            "{}: there is no record `{record}`; it lists {} as train[..] and {} as test[..], numbered from 0",
            dataset.display(),
            records.train.len(),
            records.test.len()
        )
    };
    let (list, rest) = match (record.strip_prefix("train["), record.strip_prefix("test[")) {
        (Some(rest), _) => (&records.train, rest),
        (_, Some(rest)) => (&records.test, rest),
        _ => return Err(described()),
    };
    let index: usize = rest
        .strip_suffix(']')
        .and_then(|i| i.parse().ok())
        .ok_or_else(described)?;
    let name = list.get(index).ok_or_else(described)?;
    let relative = Path::new(name);
    if !relative
        .components()
        .all(|part| matches!(part, Component::Normal(_) | Component::CurDir))
    {
        return Err(format!(
            "{}: the record \"{name}\" lies outside the dataset's folder",
            dataset.display()
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
