//! Orders of the residual force over angles, in periods per turn.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use crate::fit::fit_result::Fit;
use crate::fit::linearised_fit::{Linearisation, LinearisedFit};
use crate::ids::{EquationId, FamilyId};
use crate::model::problem::EstimationProblem;
use crate::residual_force::basis_functions::{BasisFamily, ForceArgument, OperatingRange};
use crate::residual_force::equations::{EquationSet, OperatingPoint};
use crate::residual_force::family_regression::FamilyRegression;
use crate::residual_force::force_response::compute_operating_points;
use crate::residual_force::orders_of_given_motion;
use crate::thresholds;
use eomgen_records::samples::typical_step;

/// Returns for each angle, by its expression, the orders whose waves explain most of the residual.
/// The best order is first. Only orders that the motion covers and its samples resolve are tried.
/// Empty if the responses cannot be computed.
pub fn find_ripple_orders(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
) -> BTreeMap<String, Vec<u32>> {
    match problem.dataset.gives_motion() {
        true => orders_of_given_motion::find_orders(problem, fit),
        false => compute_spectrum(problem, fit).unwrap_or_default(),
    }
}

fn compute_spectrum(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
) -> Option<BTreeMap<String, Vec<u32>>> {
    let equations = EquationSet::derive_from_fit(problem, fit)?;
    let at = LinearisedFit::linearise_fit(problem, fit, 1.0).thin_out();
    let of = Linearisation {
        point: &at,
        problem,
        fit,
    };
    let operating_points = compute_operating_points(of, &equations);
    let step = typical_step(&problem.dataset.train[0].times);
    let angles = EquationId::first(equations.list.len());
    let angles = angles.filter(|id| equations.list[*id].unit == "rad");
    let families = angles.flat_map(|equation| {
        let own = operating_points.iter().flatten().map(|all| all[equation]);
        let range = OperatingRange::from_operating_points(&own.collect::<Vec<OperatingPoint>>());
        let is_seen = move |order: &u32| {
            let order = f64::from(*order);
            order * range.width() >= TAU
                && order * range.rms.1 * step * thresholds::MIN_SAMPLES_PER_PERIOD < TAU
        };
        (1..=thresholds::MAX_SHAFT_ORDER)
            .filter(is_seen)
            .map(move |order| BasisFamily::build_wave(equation, ForceArgument::Order(order)))
    });
    let families: Vec<BasisFamily> = families.collect();
    if families.is_empty() {
        return None;
    }
    let regressed = FamilyRegression::fit_families(of, &equations, families)?;
    let mut explained: BTreeMap<String, Vec<(f64, u32)>> = BTreeMap::new();
    for id in FamilyId::first(regressed.families.len()) {
        let family = &regressed.families[id];
        if let ForceArgument::Order(order) = family.argument {
            let on = equations.list[family.equation].target.clone();
            explained
                .entry(on)
                .or_default()
                .push((regressed.explained_fraction(id), order));
        }
    }
    let best = explained.into_iter().map(|(on, mut orders)| {
        orders.sort_by(|a, b| b.0.total_cmp(&a.0));
        orders.truncate(thresholds::MAX_SPECTRUM_ORDERS);
        (on, orders.into_iter().map(|(_, order)| order).collect())
    });
    Some(best.collect())
}
