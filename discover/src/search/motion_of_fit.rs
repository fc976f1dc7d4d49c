//! Usual motion at the sites of a model, computed from a fit.

use std::collections::BTreeSet;

use eomgen_compiled_model::TypicalSizes;

use crate::catalogue::effect::SiteKind;
use crate::catalogue::site::Site;
use crate::catalogue::usual_motion::UsualMotion;
use crate::fit::expression_ranges::compute_ranges;
use crate::fit::fit_result::Fit;
use crate::model::problem::EstimationProblem;
use crate::model::usual_rates::compute_usual_rates;

/// Returns the usual rates and the ranges at the sites of a model, without orders.
pub fn compute_usual_motion(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    sites: &[Site],
) -> UsualMotion {
    let moving = sites.iter().filter(|site| {
        matches!(
            site.kind,
            SiteKind::Axis | SiteKind::Angle | SiteKind::Spring
        )
    });
    let expressions: BTreeSet<String> = moving
        .filter_map(|site| site.arguments.get("on").cloned())
        .collect();
    let travels = match expressions.is_empty() {
        true => Default::default(),
        false => compute_ranges(problem, fit, &expressions),
    };
    UsualMotion {
        rates: compute_usual_rates(problem.dataset, fit.model.specification()),
        ranges: travels,
        orders: Default::default(),
        sizes: TypicalSizes::new(fit.model.specification(), fit.model.orders()),
    }
}
