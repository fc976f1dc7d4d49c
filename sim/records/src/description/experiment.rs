//! Table `[experiment]`: bounds of the next experiment.

use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics};
use eomgen_model_spec::quantity::{Name, Number};
use eomgen_model_spec::record::Record;
use eomgen_model_spec::table::Entry;

use super::keys;

/// Table `[experiment]`.
#[derive(Debug, Default)]
pub struct Experiment {
    /// Maximum duration, in s.
    pub duration: Option<Number>,
    /// Sample time, in s.
    pub sample: Option<Number>,
    /// Bounds of inputs.
    pub inputs: Vec<InputBounds>,
    /// Ranges of channels, in the units of their columns.
    pub limits: Vec<(Name, NumberRange)>,
}

/// Table `[experiment.inputs.NAME]`.
#[derive(Debug)]
pub struct InputBounds {
    /// Name of the input.
    pub name: Name,
    /// Range of values, in the unit of its column.
    pub range: Option<NumberRange>,
    /// Maximum rate of change, in the unit of its column per s.
    pub rate: Option<Number>,
    /// Range of frequencies, in Hz.
    pub band: Option<NumberRange>,
}

/// Range of two numbers, in ascending order.
#[derive(Clone, Copy, Debug)]
pub struct NumberRange {
    /// Lower end.
    pub low: Number,
    /// Upper end.
    pub high: Number,
}

pub(super) fn read_experiment(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<Experiment> {
    let record = Record::read(entry, &keys::EXPERIMENT, found)?;
    let mut experiment = Experiment {
        duration: require_positive(record.number("duration", found), "duration", found),
        sample: require_positive(record.number("sample", found), "sample", found),
        ..Experiment::default()
    };
    if let Some(entry) = record.get("inputs") {
        let entries = found.push_error(entry.table("{ u = { range = [-1, 1] } }"))?;
        let inputs = entries.iter().filter_map(|entry| read_input(entry, found));
        experiment.inputs = inputs.collect();
    }
    if let Some(entry) = record.get("limits") {
        let entries = found.push_error(entry.table("{ x = [-0.1, 0.1] }"))?;
        for entry in &entries {
            let limit = read_range(entry, found)?;
            experiment.limits.push((entry.name.clone(), limit));
        }
    }
    Some(experiment)
}

fn read_input(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<InputBounds> {
    let record = Record::read(entry, &keys::EXPERIMENT_INPUT, found)?;
    let mut pair = |key: &str| match record.get(key) {
        Some(entry) => read_range(entry, found).map(Some),
        None => Some(None),
    };
    let (values, band) = (pair("range")?, pair("band")?);
    if let Some(band) = band.filter(|band| band.low.value < 0.0) {
        found.push(
            Diagnostic::error(format!("a frequency cannot be {}", band.low.value))
                .with_span(band.low.span, "expected Hz, 0 or greater"),
        );
    }
    Some(InputBounds {
        name: entry.name.clone(),
        range: values,
        rate: require_positive(record.number("rate", found), "rate", found),
        band,
    })
}

fn read_range(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<NumberRange> {
    let elements = found.push_error(entry.list("[-1, 1]"))?;
    let [low, high] = &elements[..] else {
        found.push(
            Diagnostic::error(format!(
                "`{}` has {} numbers",
                entry.name.text,
                elements.len()
            ))
            .with_span(
                entry.span(),
                "expected two frequencies, the lower one first",
            ),
        );
        return None;
    };
    let (low, high) = (
        found.push_error(low.number()),
        found.push_error(high.number()),
    );
    let (low, high) = (low?, high?);
    if low.value >= high.value {
        found.push(
            Diagnostic::error(format!(
                "the range from {} to {} is empty",
                low.value, high.value
            ))
            .with_span(entry.span(), "expected two numbers, the lower one first"),
        );
        return None;
    }
    Some(NumberRange { low, high })
}

fn require_positive(number: Option<Number>, key: &str, found: &mut Diagnostics) -> Option<Number> {
    if let Some(number) = number.filter(|number| number.value <= 0.0) {
        found.push(
            Diagnostic::error(format!("`{key}` cannot be {}", number.value))
                .with_span(number.span, "expected a number greater than 0"),
        );
        return None;
    }
    number
}
