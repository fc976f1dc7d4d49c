//! Inputs that act otherwise than they are recorded: gain * (input + bias) in the place of an input, with
//! parameters of the specification for both. A motor's torque constant that is off is such a gain, an
//! amplifier's offset such a bias.
//!
//! A delay of the input is one of all sensors, and estimated as such: initial states are free, and no model
//! depends on when a motion begins but by its inputs.

use eomgen_model_spec::edit::{self, Edit, EditError, NewParameter, NewValue};
use eomgen_model_spec::model::Input;
use eomgen_model_spec::source::Source;
use eomgen_records::dataset::{Expected, InputPriors};

use crate::model::input_places::in_the_place_of;

/// The effect of an input that acts later than declared.
pub const INPUT_DELAY: &str = "input_delay";

/// How an input acts otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InputFault {
    /// By a factor.
    Gain,
    /// By a constant.
    Bias,
}

impl InputFault {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Gain, Self::Bias];

    /// Its word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Gain => "gain",
            Self::Bias => "bias",
        }
    }

    /// The effect that it is where it is more than was declared, or nobody spoke of it.
    pub fn effect(self) -> &'static str {
        match self {
            Self::Gain => "input_gain",
            Self::Bias => "input_bias",
        }
    }

    /// Its value where an input acts as it is recorded.
    pub fn absent(self) -> f64 {
        match self {
            Self::Gain => 1.0,
            Self::Bias => 0.0,
        }
    }

    /// The parameter of a specification that holds it.
    pub fn parameter(self, input: &str) -> String {
        format!("{input}_{}", self.word())
    }

    /// The parameter's unit.
    pub fn unit(self, input: &Input) -> String {
        match self {
            Self::Gain => "1".to_owned(),
            Self::Bias => input.unit.text.clone(),
        }
    }

    /// What the parameter is, in words.
    pub fn doc(self, input: &str) -> String {
        format!("{} of the input {input}", self.word())
    }

    /// What stands in the place of an input.
    pub fn acting(self, input: &str) -> String {
        let parameter = self.parameter(input);
        match self {
            Self::Gain => format!("{parameter}*{input}"),
            Self::Bias => format!("{input} + {parameter}"),
        }
    }

    fn prior(self, priors: &InputPriors) -> Option<Expected> {
        match self {
            Self::Gain => priors.gain,
            Self::Bias => priors.bias,
        }
    }
}

/// The fault whose parameter this is, of an input of which a dataset speaks, and what it says.
pub fn declared<'p>(
    inputs: &'p [InputPriors],
    parameter: &str,
) -> Option<(&'p str, InputFault, Expected)> {
    let all = inputs.iter().flat_map(|input| {
        let faults = InputFault::ALL.into_iter();
        faults.filter_map(move |fault| Some((input.name.as_str(), fault, fault.prior(input)?)))
    });
    let mut all = all;
    all.find(|(input, fault, _)| fault.parameter(input) == parameter)
}

/// The input of whose delay a dataset speaks, and what it says.
pub fn delayed_input(inputs: &[InputPriors]) -> Option<(&str, Expected)> {
    let mut delayed = inputs.iter();
    delayed.find_map(|input| Some((input.name.as_str(), input.delay?)))
}

/// A specification's text in which the inputs of which a dataset speaks act as that says, to begin
/// with. Parameters that are there already, from a search before, stay what they are.
///
/// # Errors
/// An input in a place where nothing can be put, as an edit of the text.
pub fn with_declared(text: &str, path: &str, inputs: &[InputPriors]) -> Result<String, EditError> {
    let mut text = text.to_owned();
    for priors in inputs {
        for fault in InputFault::ALL {
            let Some(expected) = fault.prior(priors) else {
                continue;
            };
            let source = Source::new(path, text.as_str());
            let Ok(checked) = eomgen_model_spec::check(source.clone()) else {
                // What is wrong with a text is said where it is derived.
                return Ok(text);
            };
            let (model, name) = (&checked.model, fault.parameter(&priors.name));
            let mut declared = model.inputs.iter();
            let Some(input) = declared.find(|input| input.name == priors.name) else {
                continue;
            };
            let doc = fault.doc(&priors.name);
            // One of that name that is something else is refused as taken.
            let mut known = model.parameters.iter();
            if known.any(|known| known.name == name && known.doc == doc) {
                continue;
            }
            let mut edits = vec![Edit::AddParameter(NewParameter {
                name,
                value: NewValue::Number(expected.mean.unwrap_or(fault.absent())),
                unit: fault.unit(input),
                doc,
                source: String::new(),
            })];
            edits.extend(in_the_place_of(
                model,
                &priors.name,
                &fault.acting(&priors.name),
            ));
            text = edit::apply(&source, &edits)?;
        }
    }
    Ok(text)
}
