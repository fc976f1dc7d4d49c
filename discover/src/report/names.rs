//! Names of effects and unknowns in results.

use crate::catalogue::candidate::Candidate;
use crate::fit::fit_result::Fit;
use crate::model::problem::EstimationProblem;
use crate::model::unknowns::UnknownKind;
use crate::report::result::{EffectSite, ShaftOrder};

/// Returns effect, site and order of a candidate.
pub(crate) fn locate(candidate: &Candidate) -> EffectSite {
    let order = candidate.angle_order.clone();
    EffectSite {
        effect: candidate.effect.clone(),
        site: candidate.site.clone(),
        order: order.map(|(angle, order)| ShaftOrder { angle, order }),
    }
}

/// Returns the name of an unknown of the null model, the value of one SI unit in its unit, and the
/// unit.
pub(crate) fn name_unknown(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    what: &UnknownKind,
) -> Option<(String, f64, String)> {
    match what {
        UnknownKind::Gain(_) => Some(("gain".to_owned(), 1.0, "1".to_owned())),
        UnknownKind::Bias(at) => {
            let unit = problem.dataset.channels[*at].unit.clone();
            Some(("bias".to_owned(), 1.0, unit))
        }
        UnknownKind::Delay(_) | UnknownKind::InputDelay => {
            Some(("delay".to_owned(), 1.0, "s".to_owned()))
        }
        UnknownKind::Parameter(name) => {
            let mut parameters = fit.model.specification().parameters.iter();
            let parameter = parameters.find(|p| p.name == *name)?;
            let unit = parameter.unit.text.clone();
            Some((name.clone(), parameter.unit.from_si(1.0), unit))
        }
        UnknownKind::InverseParameter(_) => None,
    }
}
