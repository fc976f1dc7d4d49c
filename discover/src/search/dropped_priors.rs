//! Candidates for errors of declared parameters, inputs and sensors that are larger than their
//! priors permit.

use crate::catalogue::candidate::{self, Candidate};
use crate::catalogue::input_faults;
use crate::fit::fit_result::Fit;
use crate::model::input_faults::{INPUT_DELAY_EFFECT, find_declared, find_delayed_input};
use crate::model::problem::EstimationProblem;
use crate::model::unknowns::{Unknown, UnknownKind};

/// Returns the candidates that remove the prior of a declared parameter, input or sensor.
pub fn list_prior_candidates(problem: &EstimationProblem<'_>, fit: &Fit) -> Vec<Candidate> {
    let unknowns = fit
        .unknowns
        .iter()
        .filter(|unknown| unknown.prior.is_some());
    let candidate = |unknown: &Unknown| {
        let inputs = &problem.dataset.inputs;
        if let UnknownKind::Parameter(name) = &unknown.kind
            && let Some((input, fault, _)) = find_declared(inputs, name)
        {
            let (says, experiment) = input_faults::describe_fault(fault);
            return candidate::drop_prior(
                fault.effect_name(),
                input,
                says,
                experiment,
                &unknown.kind,
            );
        }
        let (effect, on, says, experiment) = match &unknown.kind {
            UnknownKind::Parameter(name) | UnknownKind::InverseParameter(name) => (
                candidate::PARAMETER_SHIFT,
                name.clone(),
                "a parameter that differs from its declared value",
                "a separate measurement of the parameter",
            ),
            UnknownKind::Gain(channel) => (
                "sensor_gain",
                problem.dataset.channels[*channel].name.clone(),
                "a sensor with a wrong gain",
                "a calibration of the sensor over its range",
            ),
            UnknownKind::Bias(channel) => (
                "sensor_bias",
                problem.dataset.channels[*channel].name.clone(),
                "a sensor with an offset",
                "a reading of the sensor at a known value",
            ),
            UnknownKind::InputDelay => (
                INPUT_DELAY_EFFECT,
                find_delayed_input(inputs).map_or_else(String::new, |(input, _)| input.to_owned()),
                "a delayed input",
                "a record of the actual input, such as a measured current in addition to its command",
            ),
            UnknownKind::Delay(channel) => (
                "sensor_delay",
                problem.dataset.channels[*channel].name.clone(),
                "a delayed sensor",
                "a recorded response to a step",
            ),
        };
        candidate::drop_prior(effect, &on, says, experiment, &unknown.kind)
    };
    unknowns.map(candidate).collect()
}
