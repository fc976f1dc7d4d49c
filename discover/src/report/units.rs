//! Check for estimates that suggest a wrong unit.

use crate::fit::fit_result::Fit;
use crate::model::channel_checks::describe_unit_factor;
use crate::model::problem::EstimationProblem;
use crate::model::unknowns::UnknownKind;
use crate::search::search_result::SearchResult;
use eomgen_model_spec::model::ParameterValue;

/// Returns a note for each estimate that deviates by the factor between two units.
pub(crate) fn note_wrong_units(
    problem: &EstimationProblem<'_>,
    found: &SearchResult,
) -> Vec<String> {
    let best = found.best_fit();
    let unknowns = found.accepted.iter().flat_map(|effect| &effect.unknowns);
    let note = |what: &UnknownKind, value: f64| match what {
        UnknownKind::Gain(channel) => {
            let factor = describe_unit_factor(value, "the expected value")?;
            let channel = &problem.dataset.channels[*channel].name;
            Some(format!("`{channel}` is {factor}; check its unit"))
        }
        UnknownKind::Parameter(name) => {
            let factor = value / read_declared_value(&found.null_fit, name)?;
            let factor = describe_unit_factor(factor, "the value in the specification")?;
            Some(format!(
                "the estimate of `{name}` is {factor}; check all units"
            ))
        }
        UnknownKind::InverseParameter(_)
        | UnknownKind::Bias(_)
        | UnknownKind::Delay(_)
        | UnknownKind::InputDelay => None,
    };
    unknowns
        .filter_map(|id| note(&best.unknowns[*id].kind, best.train.estimate.theta[*id]))
        .collect()
}

/// Returns the value of a parameter in the original specification, SI; `None` if it is missing or
/// an expression.
fn read_declared_value(null: &Fit, name: &str) -> Option<f64> {
    let mut parameters = null.model.specification().parameters.iter();
    match parameters.find(|parameter| parameter.name == name)?.value {
        ParameterValue::Number(value) => Some(value),
        ParameterValue::Expression(_) => None,
    }
}
