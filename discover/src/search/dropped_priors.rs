//! Candidates for errors of declared parameters, inputs and sensors beyond their priors.

use crate::catalogue::candidate::{self, Candidate};
use crate::catalogue::input_faults;
use crate::fit::fitted::Fit;
use crate::model::input_faults::{INPUT_DELAY, declared, delayed_input};
use crate::model::problem::EstimationProblem;
use crate::model::unknowns::{Unknown, What};

/// Returns the candidates that remove the prior of a declared parameter, input or sensor.
pub fn dropped_prior(problem: &EstimationProblem<'_>, fit: &Fit) -> Vec<Candidate> {
    let unknowns = fit
        .unknowns
        .iter()
        .filter(|unknown| unknown.prior.is_some());
    let candidate = |unknown: &Unknown| {
        let inputs = &problem.dataset.inputs;
        if let What::Parameter(name) = &unknown.what
            && let Some((input, fault, _)) = declared(inputs, name)
        {
            let (says, experiment) = input_faults::words(fault);
            return candidate::dropped_prior(
                fault.effect(),
                input,
                says,
                experiment,
                &unknown.what,
            );
        }
        let (effect, on, says, experiment) = match &unknown.what {
            What::Parameter(name) | What::Inverse(name) => (
                candidate::PARAMETER_OFFSET,
                name.clone(),
                "a parameter that differs from its declared value",
                "a separate measurement of the parameter",
            ),
            What::Gain(channel) => (
                "sensor_gain",
                problem.dataset.channels[*channel].name.clone(),
                "a sensor with a wrong gain",
                "a calibration of the sensor over its range",
            ),
            What::Bias(channel) => (
                "sensor_bias",
                problem.dataset.channels[*channel].name.clone(),
                "a sensor with an offset",
                "a reading of the sensor at a known value",
            ),
            What::InputDelay => (
                INPUT_DELAY,
                delayed_input(inputs).map_or_else(String::new, |(input, _)| input.to_owned()),
                "a delayed input",
                "a record of the acting input, such as a current in addition to its command",
            ),
            What::Delay(channel) => (
                "sensor_delay",
                problem.dataset.channels[*channel].name.clone(),
                "a delayed sensor",
                "an excitation by a step that is recorded separately",
            ),
        };
        candidate::dropped_prior(effect, &on, says, experiment, &unknown.what)
    };
    unknowns.map(candidate).collect()
}
