//! What the null model took up beyond its priors: a declared parameter or a sensor that is off
//! by more than is to be expected is an effect of its own.

use crate::fitting::{Fit, Setting};
use crate::rule;
use crate::unknowns::What;

/// A declared parameter or a sensor that is off.
#[derive(Clone, Debug, PartialEq)]
pub struct Shifted {
    /// The effect's name.
    pub effect: &'static str,
    /// The parameter or the channel.
    pub on: String,
    /// What is off: the parameter itself, or `gain`, `bias` or `delay`.
    pub name: String,
    /// Its value and standard deviation, in `unit`.
    pub value: f64,
    /// In `unit`.
    pub sd: f64,
    /// The unit as it is written.
    pub unit: String,
    /// How far it is off, in standard deviations of its prior.
    pub off: f64,
}

/// What a fit that leaves no more than a right model would has to shift for it, the farthest
/// first. Where more is left, sensors and parameters may stand in for what is missing.
pub fn shifted(setting: &Setting<'_>, fit: &Fit) -> Vec<Shifted> {
    let mut found = Vec::new();
    for (place, unknown) in fit.unknowns.iter().enumerate() {
        let Some((mean, prior)) = unknown.prior else {
            continue;
        };
        let value = fit.train.estimate.theta[place];
        if value <= unknown.bounds.0 || value >= unknown.bounds.1 {
            // A bound is no estimate.
            continue;
        }
        let off = (value - mean).abs() / prior;
        // Beyond its prior for certain, not by what the record leaves open.
        let sure = off - rule::STANDARD_ERRORS * fit.sd[place] / prior;
        if sure.is_nan() || sure <= rule::SHIFTED {
            continue;
        }
        if let Some(entry) = entry(setting, fit, place, off) {
            found.push(entry);
        }
    }
    found.sort_by(|a, b| b.off.total_cmp(&a.off));
    found
}

/// What is off, in the units that it is known in.
pub(crate) fn entry(setting: &Setting<'_>, fit: &Fit, place: usize, off: f64) -> Option<Shifted> {
    let (value, sd) = (fit.train.estimate.theta[place], fit.sd[place]);
    let channel = |place: usize| &setting.dataset.channels[place];
    let sensor = |effect, place: usize, name: &str, unit: &str| Shifted {
        effect,
        on: channel(place).name.clone(),
        name: name.to_owned(),
        value,
        sd,
        unit: unit.to_owned(),
        off,
    };
    match &fit.unknowns[place].what {
        What::Gain(at) => Some(sensor("sensor_gain", *at, "gain", "1")),
        What::Bias(at) => Some(sensor("sensor_bias", *at, "bias", &channel(*at).unit)),
        What::Delay(at) => Some(sensor("sensor_delay", *at, "delay", "s")),
        What::Parameter(name) => {
            let parameter = fit
                .plant
                .model
                .parameters
                .iter()
                .find(|p| p.name == *name)?;
            Some(Shifted {
                effect: "parameter_shift",
                on: name.clone(),
                name: name.clone(),
                value: parameter.unit.from_si(value),
                sd: parameter.unit.from_si(sd),
                unit: parameter.unit.text.clone(),
                off,
            })
        }
        What::Inverse(_) => None,
    }
}
