//! Errors of inputs as candidates, each with a single unknown.

use eomgen_compiled_model::TypicalSizes;
use eomgen_model_spec::model::{Input, Model};

use crate::catalogue::candidate::{Candidate, CandidateParameter, ParameterOffset, drop_prior};
use crate::interval::Interval;
use crate::model::input_faults::InputFault;
use crate::model::input_occurrences::{list_replaceable, replace_input};
use crate::model::unknowns::UnknownKind;

/// Returns the description of an input fault and the experiment that shows it best.
pub(crate) fn describe_fault(fault: InputFault) -> (&'static str, &'static str) {
    match fault {
        InputFault::Gain => (
            "an input with a wrong gain",
            "a separate measurement of the input, such as the torque at standstill",
        ),
        InputFault::Bias => (
            "an input with an offset",
            "a record of the motion at zero input",
        ),
    }
}

/// Returns the input faults that have no parameter in the model. `path`: path of the specification,
/// for messages.
pub fn list_input_faults(model: &Model, path: &str) -> Vec<Candidate> {
    let inputs = list_replaceable(model);
    let all =
        inputs.flat_map(|input| InputFault::ALL.map(|fault| create_candidate(model, input, fault)));
    let text = &model.source.text;
    let is_written = |candidate: &Candidate| {
        let absent = candidate
            .parameters
            .iter()
            .map(CandidateParameter::neutral_value);
        let absent: Vec<f64> = absent.collect();
        candidate.write_effect(text, path, &absent, "").is_ok()
    };
    all.flatten().filter(is_written).collect()
}

fn create_candidate(model: &Model, input: &Input, fault: InputFault) -> Option<Candidate> {
    let orders: Vec<usize> = model.fields.iter().map(|field| field.order).collect();
    let name = fault.parameter_name(&input.name);
    let changes = replace_input(model, &input.name, &fault.write_expression(&input.name));
    if changes.is_empty() {
        return None;
    }
    let (says, experiment) = describe_fault(fault);
    let what = UnknownKind::Parameter(name.clone());
    let parameter = CandidateParameter {
        name,
        typical_size: TypicalSizes::new(model, &orders).typical_size(input.unit.dimension),
        unit: fault.parameter_unit(input),
        is_positive: false,
        is_inverse: false,
        shape_size: None,
        offset: match fault {
            InputFault::Gain => Some(ParameterOffset::with_reference(
                fault.neutral_value(),
                Interval::new(0.0, f64::INFINITY),
            )),
            InputFault::Bias => None,
        },
        doc: fault.describe_parameter(&input.name),
    };
    Some(Candidate {
        parameters: vec![parameter],
        changes,
        dropped_prior: None,
        term: fault.write_expression(&input.name),
        ..drop_prior(fault.effect_name(), &input.name, says, experiment, &what)
    })
}
