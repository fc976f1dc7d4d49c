//! Distributions of uncertain parameters, as declared in a specification.

use crate::model::{Model, Parameter, ParameterValue, Uncertainty};
use crate::variant::ModelError;

/// Distribution of a parameter, in its declared unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Distribution {
    /// Name of the parameter.
    pub name: String,
    /// Distribution law.
    pub law: Law,
}

/// Distribution law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// Normal distribution, truncated at the bounds.
    Normal {
        /// Mean: the value of the parameter.
        mean: f64,
        /// Standard deviation, greater than 0.
        sd: f64,
        /// Bounds, at least one standard deviation from the mean.
        bounds: [Option<f64>; 2],
    },
    /// Uniform distribution between two ends.
    Uniform {
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
    },
}

impl Model {
    /// Returns the distributions of the uncertain parameters about their current values, in the order of the model. A
    /// parameter with a relative uncertainty keeps its sign.
    ///
    /// # Errors
    /// An uncertainty is invalid for the current value; the error contains the name of the parameter.
    pub fn distributions(&self) -> Result<Vec<Distribution>, ModelError> {
        let uncertain = self.parameters.iter().filter_map(|parameter| {
            let uncertainty = parameter.uncertainty.as_ref()?;
            Some(spread(parameter, uncertainty))
        });
        uncertain.collect()
    }
}

fn spread(parameter: &Parameter, uncertainty: &Uncertainty) -> Result<Distribution, ModelError> {
    let ParameterValue::Number(value) = parameter.value else {
        return Err(uncertainty_error(
            parameter,
            "the value is an expression",
            "declare the uncertainty of the parameters in the expression",
        ));
    };
    let law = match *uncertainty {
        Uncertainty::Between(ends) => uniform(parameter, value, ends)?,
        Uncertainty::Relative(part) if value == 0.0 || !(part > 0.0 && part < 1.0) => {
            return Err(uncertainty_error(
                parameter,
                &format!("{part} of {}", parameter.unit.from_si(value)),
                "give a `relative` between 0 and 1, for a value other than 0; otherwise give `sd` in the parameter's unit",
            ));
        }
        Uncertainty::Relative(part) => {
            let zero = [(value > 0.0).then_some(0.0), (value < 0.0).then_some(0.0)];
            normal(parameter, value, part * value.abs(), zero)?
        }
        Uncertainty::StandardDeviation(sd) => normal(parameter, value, sd, [None, None])?,
    };
    Ok(Distribution {
        name: parameter.name.clone(),
        law,
    })
}

fn uncertainty_error(parameter: &Parameter, what: &str, help: &str) -> ModelError {
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
    Err(uncertainty_error(
        parameter,
        &format!("{low} to {high} {}", parameter.unit),
        "give the lower end first, with the value between the ends and both ends within `min` and `max`",
    ))
}

/// Returns a normal law about the value. `further` are additional bounds; all numbers are in
/// SI.
fn normal(
    parameter: &Parameter,
    value: f64,
    sd: f64,
    further: [Option<f64>; 2],
) -> Result<Law, ModelError> {
    let declared = |value: f64| parameter.unit.from_si(value);
    if !(sd > 0.0 && sd.is_finite()) {
        return Err(uncertainty_error(
            parameter,
            &format!("a standard deviation of {}", declared(sd)),
            "give a standard deviation greater than 0",
        ));
    }
    let low = [parameter.min, further[0]].into_iter().flatten();
    let high = [parameter.max, further[1]].into_iter().flatten();
    let bounds = [low.reduce(f64::max), high.reduce(f64::min)];
    // Each number is rounded when it is read and when it is converted, and the difference is rounded again.
    let rounding = |bound: f64| 2.0 * f64::EPSILON * (bound.abs() + value.abs() + sd);
    let near = |bound: &f64| (bound - value).abs() < sd - rounding(*bound);
    if bounds.iter().flatten().any(near) {
        return Err(uncertainty_error(
            parameter,
            "`min` or `max` is less than a standard deviation from the value",
            "give the ends of an interval instead, for example { between = [1, 2] }",
        ));
    }
    Ok(Law::Normal {
        mean: declared(value),
        sd: declared(sd),
        bounds: bounds.map(|bound| bound.map(declared)),
    })
}
