//! Forcing of a model: its angular frequency and its period.

use eomgen_model_spec::argument::Argument;
use std::f64::consts::TAU;

use eomgen_compiled_model::Instance;
use eomgen_model_spec::model::Model;
use eomgen_model_spec::unit::Unit;

use crate::error::SweepError;
use crate::measure::Failure;

/// Looks up the parameter that is the angular frequency of the forcing.
pub fn frequency(model: &Model, name: &str) -> Result<Frequency, SweepError> {
    let parameters = &model.parameters;
    let Some(place) = parameters.iter().position(|known| known.name == name) else {
        return Err(SweepError::Request(format!(
            "the model `{}` has no parameter `{name}`: give {}, the parameter \
             that is the angular frequency of the forcing in rad/s",
            model.name,
            Argument::Frequency.with_text("NAME")
        )));
    };
    let unit = &parameters[place].unit;
    let expected = Unit::parse("rad/s").map(|unit| unit.dimension);
    if Ok(unit.dimension) != expected {
        return Err(SweepError::Request(format!(
            "{}: its unit is {unit}, expected rad/s for an angular frequency",
            Argument::Frequency.with_text(name)
        )));
    }
    Ok(Frequency {
        name: parameters[place].name.clone(),
    })
}

#[derive(Clone, Debug)]
pub struct Frequency {
    name: String,
}

impl Frequency {
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the period of the forcing, in s; undefined if the frequency is not positive.
    pub fn period(&self, instance: &Instance<'_>) -> Result<f64, Failure> {
        let period = TAU / instance.value(&self.name).unwrap_or(f64::NAN);
        if period > 0.0 && period.is_finite() {
            return Ok(period);
        }
        Err(Failure::Undefined)
    }
}
