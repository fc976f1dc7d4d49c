//! What is estimated beside the windows' initial states: parameters of the model and how the
//! sensors differ from what they measure, each with its prior and its bounds.

use model_spec::model::{Model, Parameter};

use crate::dataset::{Channel, Dataset, Record};
use crate::gate::typical_step;
use crate::rule;

/// What an unknown is.
#[derive(Clone, Debug, PartialEq)]
pub enum What {
    /// A parameter, by name.
    Parameter(String),
    /// One over a parameter, by name: an effect that is absent where it is infinite.
    Inverse(String),
    /// The gain of a channel, by its place.
    Gain(usize),
    /// The bias of a channel, SI.
    Bias(usize),
    /// The delay of a channel, s.
    Delay(usize),
}

/// Something to be estimated.
#[derive(Clone, Debug, PartialEq)]
pub struct Unknown {
    /// What it is.
    pub what: What,
    /// Where the estimate begins, SI.
    pub start: f64,
    /// Mean and standard deviation of what is known before, SI.
    pub prior: Option<(f64, f64)>,
    /// The smallest and the largest admissible value, SI.
    pub bounds: (f64, f64),
    /// A change that matters, SI.
    pub scale: f64,
}

impl Unknown {
    /// A value moved into the bounds.
    pub fn admissible(&self, value: f64) -> f64 {
        value.clamp(self.bounds.0, self.bounds.1)
    }
}

/// The unknowns of the null model: parameters declared uncertain and, where there is more
/// than noise to tell them from, the sensors.
pub fn of_null_model(dataset: &Dataset, model: &Model, values: &[(String, f64)]) -> Vec<Unknown> {
    let mut unknowns = Vec::new();
    for uncertain in &dataset.uncertain {
        let value = values.iter().find(|(name, _)| *name == uncertain.name);
        let parameter = model.parameters.iter().find(|p| p.name == uncertain.name);
        let (Some((_, value)), Some(parameter)) = (value, parameter) else {
            continue;
        };
        let sd = uncertain.relative * value.abs();
        unknowns.push(Unknown {
            what: What::Parameter(uncertain.name.clone()),
            start: *value,
            prior: Some((*value, sd)),
            bounds: sign_bounds(parameter, *value),
            scale: sd,
        });
    }
    let step = dataset
        .train
        .first()
        .map_or(0.0, |record: &Record| typical_step(&record.times));
    for (place, channel) in dataset.channels.iter().enumerate() {
        unknowns.extend(of_sensor(place, channel, step));
    }
    unknowns
}

/// The unknowns of one sensor, with the priors of a channel that says nothing else.
pub fn of_sensor(place: usize, channel: &Channel, step: f64) -> [Unknown; 3] {
    let gain = rule::GAIN_PRIOR;
    let bias = rule::BIAS_PRIOR * channel.noise;
    let delay = rule::DELAY_PRIOR * step;
    let free = (f64::NEG_INFINITY, f64::INFINITY);
    let unknown = |what, start, sd| Unknown {
        what,
        start,
        prior: Some((start, sd)),
        bounds: free,
        scale: sd,
    };
    [
        unknown(What::Gain(place), 1.0, gain),
        unknown(What::Bias(place), 0.0, bias),
        Unknown {
            bounds: (-rule::LONGEST_LEAD * step, rule::LONGEST_DELAY * step),
            ..unknown(What::Delay(place), 0.0, delay)
        },
    ]
}

/// A parameter keeps its sign, and the bounds of the specification.
pub fn sign_bounds(parameter: &Parameter, value: f64) -> (f64, f64) {
    let (low, high) = match value {
        v if v > 0.0 => (0.0, f64::INFINITY),
        v if v < 0.0 => (f64::NEG_INFINITY, 0.0),
        _ => (f64::NEG_INFINITY, f64::INFINITY),
    };
    (
        parameter.min.map_or(low, |min| min.max(low)),
        parameter.max.map_or(high, |max| max.min(high)),
    )
}

/// What an unknown is called in messages.
pub fn name(what: &What) -> String {
    match what {
        What::Parameter(name) | What::Inverse(name) => name.clone(),
        What::Gain(place) => format!("gain of channel {place}"),
        What::Bias(place) => format!("bias of channel {place}"),
        What::Delay(place) => format!("delay of channel {place}"),
    }
}
