//! Errors of inputs as candidates, each with a single unknown.

use eomgen_compiled_model::TypicalSizes;
use eomgen_model_spec::model::{Input, Model};

use crate::catalogue::candidate::{Candidate, CandidateParameter, ParameterOffset, dropped_prior};
use crate::interval::Interval;
use crate::model::input_faults::InputFault;
use crate::model::input_places::{in_the_place_of, replaceable};
use crate::model::unknowns::What;

/// Returns the description of a fault and the experiment that shows it best.
pub(crate) fn words(fault: InputFault) -> (&'static str, &'static str) {
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

/// Returns the faults of the inputs without a parameter in the model. `path`: path of the
/// specification, for messages.
pub fn input_faults(model: &Model, path: &str) -> Vec<Candidate> {
    let inputs = replaceable(model);
    let all = inputs.flat_map(|input| InputFault::ALL.map(|fault| candidate(model, input, fault)));
    let text = &model.source.text;
    let is_written = |candidate: &Candidate| {
        let absent = candidate.parameters.iter().map(CandidateParameter::absent);
        let absent: Vec<f64> = absent.collect();
        candidate.written(text, path, &absent, "").is_ok()
    };
    all.flatten().filter(is_written).collect()
}

fn candidate(model: &Model, input: &Input, fault: InputFault) -> Option<Candidate> {
    let orders: Vec<usize> = model.fields.iter().map(|field| field.order).collect();
    let name = fault.parameter(&input.name);
    let changes = in_the_place_of(model, &input.name, &fault.acting(&input.name));
    if changes.is_empty() {
        return None;
    }
    let (says, experiment) = words(fault);
    let what = What::Parameter(name.clone());
    let parameter = CandidateParameter {
        name,
        typical_size: TypicalSizes::new(model, &orders).size(input.unit.dimension),
        unit: fault.unit(input),
        positive: false,
        inverse: false,
        shape: None,
        offset: match fault {
            InputFault::Gain => Some(ParameterOffset::new_from(
                fault.absent(),
                Interval::new(0.0, f64::INFINITY),
            )),
            InputFault::Bias => None,
        },
        doc: fault.doc(&input.name),
    };
    Some(Candidate {
        parameters: vec![parameter],
        changes,
        dropped_prior: None,
        term: fault.acting(&input.name),
        ..dropped_prior(fault.effect(), &input.name, says, experiment, &what)
    })
}
