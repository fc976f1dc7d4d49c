//! Errors of inputs. An input is replaced by `gain * (input + bias)`, with two parameters in the
//! specification. A wrong torque constant of a motor is a gain, an amplifier offset a bias.
//!
//! A delay of the input is estimated as a common delay of all sensors. This is equivalent, because
//! initial states are free and models depend on absolute time only through their inputs.

use eomgen_model_spec::edit::{self, Edit, EditError, NewParameter, NewValue};
use eomgen_model_spec::model::Input;
use eomgen_records::dataset::{InputPriors, PriorInSi};

use crate::model::input_occurrences::replace_input;
use crate::model::specification_texts::edited_source;

/// Effect name of an input with an additional delay.
pub const INPUT_DELAY_EFFECT: &str = "input_delay";

/// Error of an input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InputFault {
    /// Wrong factor.
    Gain,
    /// Offset.
    Bias,
}

impl InputFault {
    /// Both errors.
    pub const ALL: [Self; 2] = [Self::Gain, Self::Bias];

    /// Returns the name of the error.
    pub fn name(self) -> &'static str {
        match self {
            Self::Gain => "gain",
            Self::Bias => "bias",
        }
    }

    /// Returns the name of the effect. It is reported if the error exceeds its declared prior, or
    /// if no prior is declared.
    pub fn effect_name(self) -> &'static str {
        match self {
            Self::Gain => "input_gain",
            Self::Bias => "input_bias",
        }
    }

    /// Returns the value without an error.
    pub fn neutral_value(self) -> f64 {
        match self {
            Self::Gain => 1.0,
            Self::Bias => 0.0,
        }
    }

    /// Returns the name of the parameter in the specification.
    pub fn parameter_name(self, input: &str) -> String {
        format!("{input}_{}", self.name())
    }

    /// Returns the unit of the parameter.
    pub fn parameter_unit(self, input: &Input) -> String {
        match self {
            Self::Gain => "1".to_owned(),
            Self::Bias => input.unit.text.clone(),
        }
    }

    /// Returns a description of the parameter.
    pub fn describe_parameter(self, input: &str) -> String {
        format!("{} of the input {input}", self.name())
    }

    /// Returns the expression that replaces an input.
    pub fn write_expression(self, input: &str) -> String {
        let parameter = self.parameter_name(input);
        match self {
            Self::Gain => format!("{parameter}*{input}"),
            Self::Bias => format!("{input} + {parameter}"),
        }
    }

    fn find_prior(self, priors: &InputPriors) -> Option<PriorInSi> {
        match self {
            Self::Gain => priors.gain,
            Self::Bias => priors.bias,
        }
    }
}

/// Returns input, error and prior for a parameter that represents a declared error of an input.
pub fn find_declared<'p>(
    inputs: &'p [InputPriors],
    parameter: &str,
) -> Option<(&'p str, InputFault, PriorInSi)> {
    let all = inputs.iter().flat_map(|input| {
        let faults = InputFault::ALL.into_iter();
        faults.filter_map(move |fault| Some((input.name.as_str(), fault, fault.find_prior(input)?)))
    });
    let mut all = all;
    all.find(|(input, fault, _)| fault.parameter_name(input) == parameter)
}

/// Returns the input with a declared delay and the prior of the delay.
pub fn find_delayed_input(inputs: &[InputPriors]) -> Option<(&str, PriorInSi)> {
    let mut delayed = inputs.iter();
    delayed.find_map(|input| Some((input.name.as_str(), input.delay?)))
}

/// Returns a specification in which the inputs have their declared errors as initial values.
/// Parameters from an earlier search are kept.
///
/// # Errors
///
/// An input that cannot be replaced in the text.
pub fn add_declared_faults(
    text: &str,
    path: &str,
    inputs: &[InputPriors],
) -> Result<String, EditError> {
    let mut text = text.to_owned();
    for priors in inputs {
        for fault in InputFault::ALL {
            let Some(expected) = fault.find_prior(priors) else {
                continue;
            };
            let source = edited_source(path, &text);
            let Ok(checked) = eomgen_model_spec::check(source.clone()) else {
                // Errors of an invalid text are reported by the derivation.
                return Ok(text);
            };
            let (model, name) = (&checked.model, fault.parameter_name(&priors.name));
            let mut declared = model.inputs.iter();
            let Some(input) = declared.find(|input| input.name == priors.name) else {
                continue;
            };
            let doc = fault.describe_parameter(&priors.name);
            // Another parameter of the same name is an error, reported as a name in use.
            let mut known = model.parameters.iter();
            if known.any(|known| known.name == name && known.doc == doc) {
                continue;
            }
            let mut edits = vec![Edit::AddParameter(NewParameter {
                name,
                value: NewValue::Number(expected.mean.unwrap_or(fault.neutral_value())),
                unit: fault.parameter_unit(input),
                doc,
                source: String::new(),
            })];
            edits.extend(replace_input(
                model,
                &priors.name,
                &fault.write_expression(&priors.name),
            ));
            text = edit::apply(&source, &edits)?;
        }
    }
    Ok(text)
}
