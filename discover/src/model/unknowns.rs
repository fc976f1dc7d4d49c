//! What is estimated beside the windows' initial states: parameters of the model and how the
//! sensors differ from what they measure, each with its prior and its bounds.

use crate::ids::ChannelId;
use crate::interval::Interval;
use eomgen_model_spec::model::{Model, Parameter};

use crate::model::input_faults::{InputFault, declared, delayed_input};
use crate::thresholds;
use eomgen_records::dataset::{Channel, Dataset, Expected, InputPriors};
use eomgen_records::record::Record;
use eomgen_records::samples::typical_step;
use eomgen_records::windows::{LONGEST_DELAY, LONGEST_LEAD};

/// What an unknown is.
#[derive(Clone, Debug, PartialEq)]
pub enum What {
    /// A parameter, by name.
    Parameter(String),
    /// One over a parameter, by name: an effect that is absent where it is infinite.
    Inverse(String),
    /// The gain of a channel.
    Gain(ChannelId),
    /// The bias of a channel, SI.
    Bias(ChannelId),
    /// The delay of a channel, s.
    Delay(ChannelId),
    /// The delay of the input, s, by which all channels are late.
    InputDelay,
}

impl What {
    /// The parameter that it is, or one over it.
    pub fn parameter(&self) -> Option<&str> {
        match self {
            Self::Parameter(name) | Self::Inverse(name) => Some(name),
            Self::Gain(_) | Self::Bias(_) | Self::Delay(_) | Self::InputDelay => None,
        }
    }

    /// Its value as a specification states it, from its estimate, SI.
    pub fn stated(&self, value: f64) -> f64 {
        match self {
            Self::Inverse(_) => 1.0 / value,
            Self::Parameter(_)
            | Self::Gain(_)
            | Self::Bias(_)
            | Self::Delay(_)
            | Self::InputDelay => value,
        }
    }
}

/// What is known of a value before: a normal distribution, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalPrior {
    /// Its mean.
    pub mean: f64,
    /// Its standard deviation.
    pub sd: f64,
}

/// Something to be estimated.
#[derive(Clone, Debug, PartialEq)]
pub struct Unknown {
    /// What it is.
    pub what: What,
    /// What it is called in messages.
    pub label: String,
    /// Where the estimate begins, SI.
    pub start: f64,
    /// What is known of it before.
    pub prior: Option<NormalPrior>,
    /// The admissible values, SI.
    pub bounds: Interval,
    /// The same where it need not be what was declared.
    pub limits: Interval,
    /// A change that matters, SI.
    pub scale: f64,
}

impl Unknown {
    /// Returns true for parameters of the model, false for those of sensors.
    pub(crate) fn is_of_model(&self) -> bool {
        matches!(self.what, What::Parameter(_) | What::Inverse(_))
    }

    /// A value moved into the bounds.
    pub fn admissible(&self, value: f64) -> f64 {
        self.bounds.clamp(value)
    }

    /// The same without what was declared of it.
    pub fn without_prior(&self) -> Self {
        Self {
            prior: None,
            bounds: self.limits,
            ..self.clone()
        }
    }

    /// One of the null model: within so many standard deviations of what was declared, because
    /// beyond it is an effect.
    fn declared((what, label): (What, String), prior: NormalPrior, limits: Interval) -> Self {
        let NormalPrior { mean, sd } = prior;
        let reach = thresholds::SHIFTED * sd;
        Self {
            what,
            label,
            start: mean,
            prior: Some(prior),
            bounds: limits.intersection(Interval::new(mean - reach, mean + reach)),
            limits,
            scale: sd,
        }
    }
}

/// The unknowns of the null model: parameters declared uncertain, gains and biases of inputs of which
/// the dataset speaks and, where there is more than noise to tell them from, the sensors.
pub fn of_null_model(dataset: &Dataset, model: &Model, values: &[(String, f64)]) -> Vec<Unknown> {
    let mut unknowns = Vec::new();
    for uncertain in &dataset.uncertain {
        let value = values.iter().find(|(name, _)| *name == uncertain.name);
        let parameter = model.parameters.iter().find(|p| p.name == uncertain.name);
        let (Some((_, value)), Some(parameter)) = (value, parameter) else {
            continue;
        };
        let sd = uncertain.relative * value.abs();
        let name = &uncertain.name;
        let what = (What::Parameter(name.clone()), format!("`{name}`"));
        let limits = sign_bounds(parameter, *value);
        let prior = NormalPrior { mean: *value, sd };
        unknowns.push(Unknown::declared(what, prior, limits));
    }
    for (name, value) in values {
        let Some((input, fault, expected)) = declared(&dataset.inputs, name) else {
            continue;
        };
        if expected.sd == 0.0 {
            continue;
        }
        let label = format!("the {} of the input `{input}`", fault.word());
        let limits = match fault {
            InputFault::Gain if *value > 0.0 => Interval::new(0.0, f64::INFINITY),
            _ => Interval::ALL,
        };
        let prior = NormalPrior {
            mean: *value,
            sd: expected.sd,
        };
        let what = (What::Parameter(name.clone()), label);
        unknowns.push(Unknown::declared(what, prior, limits));
    }
    let step = dataset
        .train
        .first()
        .map_or(0.0, |record: &Record| typical_step(&record.times));
    unknowns.extend(of_input_delay(dataset, model, step));
    let ids = ChannelId::first(dataset.channels.len());
    for (id, channel) in ids.zip(&dataset.channels) {
        unknowns.extend(of_sensor(id, channel, model, step));
    }
    unknowns
}

/// The delay of the input, if the dataset says how far it is known.
fn of_input_delay(dataset: &Dataset, model: &Model, step: f64) -> Option<Unknown> {
    let (input, expected) = delayed_input(&dataset.inputs)?;
    let mean = expected_input_delay(&dataset.inputs, model);
    let late = Interval::new(-LONGEST_LEAD * step, LONGEST_DELAY * step);
    let what = (
        What::InputDelay,
        format!("the delay of the input `{input}`"),
    );
    let prior = NormalPrior {
        mean,
        sd: expected.sd,
    };
    (expected.sd > 0.0).then(|| Unknown {
        limits: Interval::new(mean.min(0.0), late.high),
        ..Unknown::declared(what, prior, late)
    })
}

/// The delay of the input before anything is fitted, s. Where the specification describes sensors, a fit
/// has written the delay of the input into theirs.
pub fn expected_input_delay(inputs: &[InputPriors], model: &Model) -> f64 {
    let said = delayed_input(inputs).and_then(|(_, delay)| delay.mean);
    match model.sensors.is_empty() {
        true => said.unwrap_or(0.0),
        false => 0.0,
    }
}

/// That a mean which the dataset gives is not added to what the specification has.
pub fn note_of_input_delay(inputs: &[InputPriors], model: &Model) -> Option<String> {
    let (input, expected) = delayed_input(inputs)?;
    let mean = expected.mean.filter(|mean| *mean != 0.0)?;
    (!model.sensors.is_empty()).then(|| {
        format!(
            "the delay of `{input}`, {mean} s in the dataset, is taken to be in those of [sensors] in the specification"
        )
    })
}

/// The unknowns of one sensor, with the priors of its channel, or the usual ones where that says
/// nothing. What is known for certain is none of them.
pub fn of_sensor(id: ChannelId, channel: &Channel, model: &Model, step: f64) -> Vec<Unknown> {
    let expected = ExpectedSensor::of(channel, model);
    let sd = |said: Option<Expected>, usual: f64| said.map_or(usual, |said| said.sd);
    let gain = sd(channel.priors.gain, thresholds::GAIN_PRIOR);
    let bias = sd(channel.priors.bias, thresholds::BIAS_PRIOR * channel.noise);
    let delay = sd(channel.priors.delay, thresholds::DELAY_PRIOR * step);
    let free = Interval::ALL;
    let late = Interval::new(-LONGEST_LEAD * step, LONGEST_DELAY * step);
    let prior = |mean: f64, sd: f64| NormalPrior { mean, sd };
    let called = |what: What, fault: &str| (what, format!("the {fault} of `{}`", channel.name));
    let unknowns = [
        Unknown::declared(
            called(What::Gain(id), "gain"),
            prior(expected.gain, gain),
            free,
        ),
        Unknown::declared(
            called(What::Bias(id), "bias"),
            prior(expected.bias, bias),
            free,
        ),
        // What no prior holds is late: no sensor sees ahead.
        Unknown {
            limits: Interval::new(expected.delay.min(0.0), late.high),
            ..Unknown::declared(
                called(What::Delay(id), "delay"),
                prior(expected.delay, delay),
                late,
            )
        },
    ];
    let is_open = |unknown: &Unknown| unknown.scale > 0.0;
    unknowns.into_iter().filter(is_open).collect()
}

/// What is expected of a sensor before anything is fitted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExpectedSensor {
    /// Its gain.
    pub gain: f64,
    /// Its bias, SI.
    pub bias: f64,
    /// Its delay, s.
    pub delay: f64,
}

impl ExpectedSensor {
    /// As the specification says, else as the dataset does, else that of a true sensor: what a fit
    /// wrote into the specification is where the next one begins.
    pub fn of(channel: &Channel, model: &Model) -> Self {
        let written = model.sensors.iter().find(|s| s.channel == channel.name);
        let said = |prior: Option<Expected>| prior.and_then(|prior| prior.mean);
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

/// A parameter keeps its sign, and the bounds of the specification.
pub fn sign_bounds(parameter: &Parameter, value: f64) -> Interval {
    let of_sign = match value {
        v if v > 0.0 => Interval::new(0.0, f64::INFINITY),
        v if v < 0.0 => Interval::new(f64::NEG_INFINITY, 0.0),
        _ => Interval::ALL,
    };
    of_sign.intersection(Interval::new(
        parameter.min.unwrap_or(f64::NEG_INFINITY),
        parameter.max.unwrap_or(f64::INFINITY),
    ))
}
