//! Usual motion at the sites of a model in a fit.

use std::collections::BTreeSet;

use eomgen_compiled_model::TypicalSizes;

use crate::catalogue::effect::SiteKind;
use crate::catalogue::site::Site;
use crate::catalogue::usual_motion::UsualMotion;
use crate::fit::fitted::Fit;
use crate::fit::travels::travels;
use crate::model::problem::EstimationProblem;
use crate::model::usual_rates::usual_rates;

/// Returns the usual rates and the ranges at the sites of a model, without orders.
pub fn motion_of(problem: &EstimationProblem<'_>, fit: &Fit, sites: &[Site]) -> UsualMotion {
    let moving = sites
        .iter()
        .filter(|site| matches!(site.kind, SiteKind::Angle | SiteKind::Spring));
    let expressions: BTreeSet<String> = moving
        .filter_map(|site| site.arguments.get("on").cloned())
        .collect();
    let travels = match expressions.is_empty() {
        true => Default::default(),
        false => travels(problem, fit, &expressions),
    };
    UsualMotion {
        rates: usual_rates(problem.dataset, fit.model.specification()),
        travels,
        orders: Default::default(),
        sizes: TypicalSizes::new(fit.model.specification(), fit.model.orders()),
    }
}
