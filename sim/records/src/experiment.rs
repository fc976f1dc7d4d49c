//! Bounds of the next experiment in SI, and the units of its columns.

use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics, quote};
use eomgen_model_spec::model::Model;
use eomgen_model_spec::suggest::did_you_mean;
use eomgen_model_spec::unit::Unit;

use crate::description::Description;
use crate::description::experiment::NumberRange;

const MAX_SAMPLES: f64 = 1e6;

/// Bounds of the next experiment, in SI; `None` if the dataset file does not give them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ExperimentBounds {
    /// Maximum duration, in s.
    pub duration: Option<f64>,
    /// Sample time, in s.
    pub sample: Option<f64>,
    /// Bounds of each input of the model.
    pub inputs: Vec<InputBounds>,
    /// Minimum and maximum of each channel.
    pub limits: Vec<Option<(f64, f64)>>,
}

/// Bounds of one input, in SI.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct InputBounds {
    /// Minimum and maximum value.
    pub range: Option<(f64, f64)>,
    /// Maximum rate of change, per s.
    pub rate: Option<f64>,
    /// Lowest and highest frequency, in Hz.
    pub band: Option<(f64, f64)>,
}

/// Units of the columns of an experiment to run.
#[derive(Clone, Debug)]
pub struct ExperimentUnits {
    /// Unit of the time column.
    pub time: Unit,
    /// Unit of each input's column; `None` if the input has no column and is 0.
    pub inputs: Vec<Option<Unit>>,
}

pub(crate) fn bind_experiment(
    description: &Description,
    model: &Model,
    (inputs, channels): (&[Option<Unit>], &[Unit]),
    found: &mut Diagnostics,
) -> ExperimentBounds {
    let said = &description.experiment;
    let mut bounds = ExperimentBounds {
        duration: said.duration.map(|number| number.value),
        sample: said.sample.map(|number| number.value),
        inputs: vec![InputBounds::default(); model.inputs.len()],
        limits: vec![None; description.channels.len()],
    };
    if let (Some(duration), Some(sample)) = (said.duration, said.sample)
        && duration.value / sample.value > MAX_SAMPLES
    {
        found.push(
            Diagnostic::error(format!(
                "an experiment of {:.0} samples is too long",
                duration.value / sample.value
            ))
            .with_span(duration.span, format!("expected at most {MAX_SAMPLES:.0}"))
            .with_related_span(sample.span, "sample time"),
        );
    }
    for input in &said.inputs {
        let place = model
            .inputs
            .iter()
            .position(|of| of.name == input.name.text);
        let unit = place.and_then(|place| inputs.get(place)?.as_ref());
        let (Some(place), Some(unit)) = (place, unit) else {
            let known = description.inputs.iter();
            let known = known.map(|column| column.name.text.as_str());
            found.push(
                Diagnostic::error(format!(
                    "no record has a column for an input {}",
                    quote(&input.name.text)
                ))
                .with_span(input.name.span, "expected one of [inputs]")
                .with_optional_help(did_you_mean(&input.name.text, known)),
            );
            continue;
        };
        bounds.inputs[place] = InputBounds {
            range: input.range.map(|range| convert_range_to_si(range, unit)),
            rate: input.rate.map(|rate| unit.to_si(rate.value)),
            band: input.band.map(|band| (band.low.value, band.high.value)),
        };
    }
    for (name, limit) in &said.limits {
        let place = description.channels.iter();
        let place = { place }.position(|channel| channel.name.text == name.text);
        match place.and_then(|place| Some((place, channels.get(place)?))) {
            Some((place, unit)) => bounds.limits[place] = Some(convert_range_to_si(*limit, unit)),
            None => {
                let known = description.channels.iter();
                let known = known.map(|channel| channel.name.text.as_str());
                found.push(
                    Diagnostic::error(format!("there is no channel {}", quote(&name.text)))
                        .with_span(name.span, "expected one of [channels]")
                        .with_optional_help(did_you_mean(&name.text, known)),
                );
            }
        }
    }
    bounds
}

fn convert_range_to_si(range: NumberRange, unit: &Unit) -> (f64, f64) {
    (unit.to_si(range.low.value), unit.to_si(range.high.value))
}
