//! Unknowns of a fit in addition to the initial states: parameters of the model and errors of the
//! sensors, each with prior and bounds.

use crate::ids::ChannelId;
use crate::interval::Interval;
use eomgen_model_spec::model::{Model, Parameter};

use crate::model::input_faults::{InputFault, find_declared, find_delayed_input};
use crate::thresholds;
use eomgen_records::dataset::{Channel, Dataset, InputPriors, PriorInSi};
use eomgen_records::record::Record;
use eomgen_records::samples::typical_step;
use eomgen_records::windows::{MAX_DELAY_SAMPLES, MAX_LEAD_SAMPLES};

/// Kind of an unknown.
#[derive(Clone, Debug, PartialEq)]
pub enum UnknownKind {
    /// Parameter, by name.
    Parameter(String),
    /// Inverse of a parameter, by name, for an effect that vanishes at infinity.
    InverseParameter(String),
    /// Gain of a channel.
    Gain(ChannelId),
    /// Bias of a channel, SI.
    Bias(ChannelId),
    /// Delay of a channel, s.
    Delay(ChannelId),
    /// Common delay of all channels, which represents the delay of the input, s.
    InputDelay,
}

impl UnknownKind {
    /// Returns the name of the parameter or inverse parameter.
    pub fn parameter_name(&self) -> Option<&str> {
        match self {
            Self::Parameter(name) | Self::InverseParameter(name) => Some(name),
            Self::Gain(_) | Self::Bias(_) | Self::Delay(_) | Self::InputDelay => None,
        }
    }

    /// Converts an estimate to the value in the specification, SI.
    pub fn value_in_specification(&self, value: f64) -> f64 {
        match self {
            Self::InverseParameter(_) => 1.0 / value,
            Self::Parameter(_)
            | Self::Gain(_)
            | Self::Bias(_)
            | Self::Delay(_)
            | Self::InputDelay => value,
        }
    }
}

/// Normal prior of a value, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalPrior {
    /// Mean.
    pub mean: f64,
    /// Standard deviation.
    pub sd: f64,
}

/// Unknown of a fit.
#[derive(Clone, Debug, PartialEq)]
pub struct Unknown {
    /// Kind of the unknown.
    pub kind: UnknownKind,
    /// Name in messages.
    pub label: String,
    /// Initial value, SI.
    pub start: f64,
    /// Prior.
    pub prior: Option<NormalPrior>,
    /// Admissible values, SI.
    pub bounds: Interval,
    /// Admissible values without the declared prior, SI.
    pub bounds_without_prior: Interval,
    /// Change with a significant effect, SI.
    pub scale: f64,
}

impl Unknown {
    /// Returns true for parameters of the model, false for sensor unknowns.
    pub(crate) fn is_model_parameter(&self) -> bool {
        matches!(
            self.kind,
            UnknownKind::Parameter(_) | UnknownKind::InverseParameter(_)
        )
    }

    /// Returns the nearest admissible value.
    pub fn clamp(&self, value: f64) -> f64 {
        self.bounds.clamp(value)
    }

    /// Returns the unknown without its declared prior.
    pub fn without_prior(&self) -> Self {
        Self {
            prior: None,
            bounds: self.bounds_without_prior,
            ..self.clone()
        }
    }

    /// Creates an unknown of the null model, bounded to some standard deviations around its
    /// declared value. A larger deviation is an effect.
    fn within_declared(
        (what, label): (UnknownKind, String),
        prior: NormalPrior,
        limits: Interval,
    ) -> Self {
        let NormalPrior { mean, sd } = prior;
        let reach = thresholds::MAX_PRIOR_DEVIATION * sd;
        Self {
            kind: what,
            label,
            start: mean,
            prior: Some(prior),
            bounds: limits.intersect(Interval::new(mean - reach, mean + reach)),
            bounds_without_prior: limits,
            scale: sd,
        }
    }
}

/// Returns the unknowns of the null model: parameters declared uncertain, declared gains and biases
/// of inputs and, if the data can determine them, sensor errors.
pub fn list_null_unknowns(
    dataset: &Dataset,
    model: &Model,
    values: &[(String, f64)],
) -> Vec<Unknown> {
    let mut unknowns = Vec::new();
    for uncertain in &dataset.uncertain {
        let value = values.iter().find(|(name, _)| *name == uncertain.name);
        let parameter = model.parameters.iter().find(|p| p.name == uncertain.name);
        let (Some((_, value)), Some(parameter)) = (value, parameter) else {
            continue;
        };
        let sd = uncertain.relative * value.abs();
        let name = &uncertain.name;
        let what = (UnknownKind::Parameter(name.clone()), format!("`{name}`"));
        let limits = bounds_with_sign(parameter, *value);
        let prior = NormalPrior { mean: *value, sd };
        unknowns.push(Unknown::within_declared(what, prior, limits));
    }
    for (name, value) in values {
        let Some((input, fault, expected)) = find_declared(&dataset.inputs, name) else {
            continue;
        };
        if expected.sd == 0.0 {
            continue;
        }
        let label = format!("the {} of the input `{input}`", fault.name());
        let limits = match fault {
            InputFault::Gain if *value > 0.0 => Interval::new(0.0, f64::INFINITY),
            _ => Interval::ALL,
        };
        let prior = NormalPrior {
            mean: *value,
            sd: expected.sd,
        };
        let what = (UnknownKind::Parameter(name.clone()), label);
        unknowns.push(Unknown::within_declared(what, prior, limits));
    }
    let step = dataset
        .train
        .first()
        .map_or(0.0, |record: &Record| typical_step(&record.times));
    unknowns.extend(create_input_delay_unknown(dataset, model, step));
    let ids = ChannelId::first(dataset.channels.len());
    for (id, channel) in ids.zip(&dataset.channels) {
        unknowns.extend(list_sensor_unknowns(id, channel, model, step));
    }
    unknowns
}

/// Returns the delay of the input as an unknown, if the dataset declares its uncertainty.
fn create_input_delay_unknown(dataset: &Dataset, model: &Model, step: f64) -> Option<Unknown> {
    let (input, expected) = find_delayed_input(&dataset.inputs)?;
    let mean = expected_input_delay(&dataset.inputs, model);
    let late = Interval::new(-MAX_LEAD_SAMPLES * step, MAX_DELAY_SAMPLES * step);
    let what = (
        UnknownKind::InputDelay,
        format!("the delay of the input `{input}`"),
    );
    let prior = NormalPrior {
        mean,
        sd: expected.sd,
    };
    (expected.sd > 0.0).then(|| Unknown {
        bounds_without_prior: Interval::new(mean.min(0.0), late.high),
        ..Unknown::within_declared(what, prior, late)
    })
}

/// Returns the delay of the input before a fit, s. If the specification contains sensors, an
/// earlier fit has added the delay of the input to their delays.
pub fn expected_input_delay(inputs: &[InputPriors], model: &Model) -> f64 {
    let said = find_delayed_input(inputs).and_then(|(_, delay)| delay.mean);
    match model.sensors.is_empty() {
        true => said.unwrap_or(0.0),
        false => 0.0,
    }
}

/// Returns a note if the declared delay in the dataset is assumed to be included in the sensor
/// delays of the specification.
pub fn note_input_delay(inputs: &[InputPriors], model: &Model) -> Option<String> {
    let (input, expected) = find_delayed_input(inputs)?;
    let mean = expected.mean.filter(|mean| *mean != 0.0)?;
    (!model.sensors.is_empty()).then(|| {
        format!(
            "the delay of `{input}`, {mean} s in the dataset, is assumed to be included in the delays of \
             [sensors] in the specification"
        )
    })
}

/// Returns the unknowns of a sensor, with the priors of its channel or default priors. Values that
/// are declared exact are left out.
pub fn list_sensor_unknowns(
    id: ChannelId,
    channel: &Channel,
    model: &Model,
    step: f64,
) -> Vec<Unknown> {
    let expected = ExpectedSensor::from_channel(channel, model);
    let sd = |said: Option<PriorInSi>, usual: f64| said.map_or(usual, |said| said.sd);
    let gain = sd(channel.priors.gain, thresholds::GAIN_PRIOR_SD);
    let bias = sd(
        channel.priors.bias,
        thresholds::BIAS_PRIOR_IN_NOISE_SD * channel.noise,
    );
    let delay = sd(channel.priors.delay, thresholds::DELAY_PRIOR_SAMPLES * step);
    let free = Interval::ALL;
    let late = Interval::new(-MAX_LEAD_SAMPLES * step, MAX_DELAY_SAMPLES * step);
    let prior = |mean: f64, sd: f64| NormalPrior { mean, sd };
    let called =
        |what: UnknownKind, fault: &str| (what, format!("the {fault} of `{}`", channel.name));
    let unknowns = [
        Unknown::within_declared(
            called(UnknownKind::Gain(id), "gain"),
            prior(expected.gain, gain),
            free,
        ),
        Unknown::within_declared(
            called(UnknownKind::Bias(id), "bias"),
            prior(expected.bias, bias),
            free,
        ),
        // Without a prior, the delay is positive, because sensors do not lead.
        Unknown {
            bounds_without_prior: Interval::new(expected.delay.min(0.0), late.high),
            ..Unknown::within_declared(
                called(UnknownKind::Delay(id), "delay"),
                prior(expected.delay, delay),
                late,
            )
        },
    ];
    let is_open = |unknown: &Unknown| unknown.scale > 0.0;
    unknowns.into_iter().filter(is_open).collect()
}

/// Values of a sensor before a fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExpectedSensor {
    /// Gain.
    pub gain: f64,
    /// Bias, SI.
    pub bias: f64,
    /// Delay, s.
    pub delay: f64,
}

impl ExpectedSensor {
    /// Converts a measured value to the quantity, SI. The delay is ignored.
    pub fn quantity(&self, measured: f64) -> f64 {
        (measured - self.bias) / self.gain
    }

    /// Returns the sensor values from the specification, otherwise from the dataset, otherwise of
    /// an ideal sensor. Therefore a later search continues from the values that a fit has written
    /// to the specification.
    pub fn from_channel(channel: &Channel, model: &Model) -> Self {
        let written = model.sensors.iter().find(|s| s.channel == channel.name);
        let said = |prior: Option<PriorInSi>| prior.and_then(|prior| prior.mean);
        match written {
            Some(sensor) => Self {
                gain: sensor.gain,
                bias: sensor.bias,
                delay: sensor.delay,
            },
            None => Self {
                gain: said(channel.priors.gain).unwrap_or(1.0),
                bias: said(channel.priors.bias).unwrap_or(0.0),
                delay: said(channel.priors.delay).unwrap_or(0.0),
            },
        }
    }
}

/// Returns the bounds of a parameter that keep the sign of its value.
pub fn bounds_with_sign(parameter: &Parameter, value: f64) -> Interval {
    let of_sign = match value {
        v if v > 0.0 => Interval::new(0.0, f64::INFINITY),
        v if v < 0.0 => Interval::new(f64::NEG_INFINITY, 0.0),
        _ => Interval::ALL,
    };
    of_sign.intersect(Interval::new(
        parameter.min.unwrap_or(f64::NEG_INFINITY),
        parameter.max.unwrap_or(f64::INFINITY),
    ))
}
