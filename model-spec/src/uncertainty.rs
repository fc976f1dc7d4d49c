//! What is not known of parameters: how their values are spread, as a specification declares it.

use crate::model::{Model, Parameter, ParameterValue, Uncertainty};
use crate::variant::ModelError;

/// How the values of a parameter are spread, in the unit that the specification declares for it.
#[derive(Clone, Debug, PartialEq)]
pub struct Spread {
    /// The parameter's name.
    pub name: String,
    /// The law of its values.
    pub law: Law,
}

/// A law of values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// Normal, without what lies outside the bounds.
    Normal {
        /// The mean, which is the parameter's value.
        mean: f64,
        /// The standard deviation, greater than 0.
        sd: f64,
        /// The bounds, a standard deviation from the mean or more.
        bounds: [Option<f64>; 2],
    },
    /// All values between two ends alike.
    Uniform {
        /// The lower end.
        low: f64,
        /// The upper end.
        high: f64,
    },
}

impl Model {
    /// How the uncertain parameters are spread about the values that they have, in the order of the
    /// model. A parameter whose uncertainty is a part of its value keeps its sign.
    ///
    /// # Errors
    /// An uncertainty that is none at this value, by name.
    pub fn spreads(&self) -> Result<Vec<Spread>, ModelError> {
        let uncertain = self.parameters.iter().filter_map(|parameter| {
            let uncertainty = parameter.uncertainty.as_ref()?;
            Some(spread(parameter, uncertainty))
        });
        uncertain.collect()
    }
}

fn spread(parameter: &Parameter, uncertainty: &Uncertainty) -> Result<Spread, ModelError> {
    let ParameterValue::Number(value) = parameter.value else {
        return Err(wrong(
            parameter,
            "it is given by an expression",
            "declare what is not known of the numbers that the expression is made of",
        ));
    };
    let law = match *uncertainty {
        Uncertainty::Between(ends) => uniform(parameter, value, ends)?,
        Uncertainty::Relative(part) if value == 0.0 || !(part > 0.0 && part < 1.0) => {
            return Err(wrong(
                parameter,
                &format!("{part} of {}", parameter.unit.from_si(value)),
                "a part is between 0 and 1, and of a value that is not 0; `sd` is in the parameter's unit",
            ));
        }
        Uncertainty::Relative(part) => {
            let zero = [(value > 0.0).then_some(0.0), (value < 0.0).then_some(0.0)];
            normal(parameter, value, part * value.abs(), zero)?
        }
        Uncertainty::StandardDeviation(sd) => normal(parameter, value, sd, [None, None])?,
    };
    Ok(Spread {
        name: parameter.name.clone(),
        law,
    })
}

fn wrong(parameter: &Parameter, what: &str, help: &str) -> ModelError {
    let error = ModelError::new(format!("the uncertainty of `{}`: {what}", parameter.name));
    error.at(parameter.span).help(help)
}

fn uniform(parameter: &Parameter, value: f64, [low, high]: [f64; 2]) -> Result<Law, ModelError> {
    let (least, most) = (parameter.min, parameter.max);
    let inside = least.is_none_or(|min| min <= low) && most.is_none_or(|max| high <= max);
    let is_right = low < high && (low..=high).contains(&value) && inside;
    let [low, high] = [low, high].map(|end| parameter.unit.from_si(end));
    if is_right {
        return Ok(Law::Uniform { low, high });
    }
    Err(wrong(
        parameter,
        &format!("{low} to {high} {}", parameter.unit),
        "the lower end comes first, the value lies between, and both ends within `min` and `max`",
    ))
}

/// About the value; `further` are bounds beside those of the parameter, all in SI.
fn normal(
    parameter: &Parameter,
    value: f64,
    sd: f64,
    further: [Option<f64>; 2],
) -> Result<Law, ModelError> {
    let declared = |value: f64| parameter.unit.from_si(value);
    if !(sd > 0.0 && sd.is_finite()) {
        return Err(wrong(
            parameter,
            &format!("a standard deviation of {}", declared(sd)),
            "a standard deviation is greater than 0",
        ));
    }
    let low = [parameter.min, further[0]].into_iter().flatten();
    let high = [parameter.max, further[1]].into_iter().flatten();
    let bounds = [low.reduce(f64::max), high.reduce(f64::min)];
    let near = |bound: &f64| (bound - value).abs() < sd;
    if bounds.iter().flatten().any(near) {
        return Err(wrong(
            parameter,
            "`min` or `max` is nearer than a standard deviation",
            "say between which ends the value lies, as { between = [1, 2] }",
        ));
    }
    Ok(Law::Normal {
        mean: declared(value),
        sd: declared(sd),
        bounds: bounds.map(|bound| bound.map(declared)),
    })
}
