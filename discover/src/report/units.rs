//! Check for estimates that suggest a wrong unit.

use crate::fit::fitted::Fit;
use crate::model::channel_checks::factor_of_units;
use crate::model::problem::EstimationProblem;
use crate::model::unknowns::What;
use crate::search::found::Found;
use eomgen_model_spec::model::ParameterValue;

/// Returns a note for each estimate that is wrong by a factor between two units.
pub(crate) fn notes_of_units(problem: &EstimationProblem<'_>, found: &Found) -> Vec<String> {
    let best = found.best();
    let unknowns = found.accepted.iter().flat_map(|effect| &effect.unknowns);
    let note = |what: &What, value: f64| match what {
        What::Gain(channel) => {
            let factor = factor_of_units(value, "the expected value")?;
            let channel = &problem.dataset.channels[*channel].name;
            Some(format!("`{channel}` is {factor}; check its unit"))
        }
        What::Parameter(name) => {
            let factor = value / declared(&found.null, name)?;
            let factor = factor_of_units(factor, "the value in the specification")?;
            Some(format!(
                "the estimate of `{name}` is {factor}; check all units"
            ))
        }
        What::Inverse(_) | What::Bias(_) | What::Delay(_) | What::InputDelay => None,
    };
    unknowns
        .filter_map(|id| note(&best.unknowns[*id].what, best.train.estimate.theta[*id]))
        .collect()
}

/// The value of a parameter in the specification as it was, SI; none if it is not there, or an expression.
fn declared(null: &Fit, name: &str) -> Option<f64> {
    let mut parameters = null.model.specification().parameters.iter();
    match parameters.find(|parameter| parameter.name == name)?.value {
        ParameterValue::Number(value) => Some(value),
        ParameterValue::Expression(_) => None,
    }
}
