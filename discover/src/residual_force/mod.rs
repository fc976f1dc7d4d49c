//! Residual force: the equation of motion in which a force is missing, and profiles of this force
//! over time, rate, angle, shaft order, frequency and amplitude. It shows the location of the gap;
//! effects are accepted without it. Files: `equations`; `basis_functions`; `force_response` and,
//! without tangent vectors, `finite_difference_response`; `regression` and `family_regression`
//! (coefficients); `ranking` (comparison of equations); `ripple_orders` and, for given motion,
//! `orders_of_given_motion` (orders of waves over an angle); `profiles` of one equation; `wording`
//! and `figures`; `types` (results).

pub mod basis_functions;
pub mod equations;
pub mod family_regression;
pub mod figures;
mod finite_difference_response;
pub mod force_response;
mod orders_of_given_motion;
pub mod profiles;
pub mod ranking;
pub mod regression;
pub mod ripple_orders;
pub mod types;
pub mod wording;

use crate::ids::EquationId;
use std::f64::consts::TAU;

use crate::fit::fit_result::Fit;
use crate::fit::linearised_fit::{Linearisation, LinearisedFit};
use crate::fit::residual_spectrum::find_peak_frequency;
use crate::model::problem::EstimationProblem;
use crate::residual_force::basis_functions::{BasisFamily, ForceArgument, OperatingRange};
use crate::residual_force::equations::{EquationSet, OperatingPoint};
use crate::residual_force::family_regression::FamilyRegression;
use crate::residual_force::force_response::compute_operating_points;
use crate::residual_force::profiles::ProfileInputs;
use crate::residual_force::ranking::{EquationRanking, find_simple_functions};
use crate::residual_force::types::{ForceKind, ResidualForce};
use crate::thresholds;
use eomgen_records::samples::typical_step;

/// Estimates the residual force of a fit, with the profiles of a named equation or of the best
/// equation. `None` if the responses cannot be computed.
pub fn estimate_residual_force(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    wanted: Option<&str>,
) -> Option<ResidualForce> {
    // With given motion, the residual of a channel is the residual force.
    if problem.dataset.gives_motion() {
        return None;
    }
    let equations = EquationSet::derive_from_fit(problem, fit)?;
    let at = LinearisedFit::linearise_fit(problem, fit, 1.0);
    let of = Linearisation {
        point: &at,
        problem,
        fit,
    };
    let operating_points = compute_operating_points(of, &equations);
    let ranges: Vec<OperatingRange> = EquationId::first(equations.list.len())
        .map(|equation| {
            let own = operating_points.iter().flatten().map(|all| all[equation]);
            OperatingRange::from_operating_points(&own.collect::<Vec<OperatingPoint>>())
        })
        .collect();
    let length = operating_points
        .iter()
        .flatten()
        .flatten()
        .map(|s| s.time)
        .fold(0.0, f64::max);
    let general = |equation: EquationId| {
        let is_angle = equations.list[equation].unit == "rad";
        [
            BasisFamily::build_over_rate(equation, &ranges[equation]),
            BasisFamily::build_over_position(equation, &ranges[equation], is_angle),
            BasisFamily::build_over_time(equation, length),
        ]
    };
    let moves = |equation: &EquationId| {
        ranges[*equation].width() > 0.0 && ranges[*equation].largest_rate > 0.0
    };
    let all: Vec<EquationId> = EquationId::first(equations.list.len())
        .filter(moves)
        .collect();
    let wave = |equation: EquationId| {
        let mut families = Vec::new();
        if equations.list[equation].unit == "rad" {
            families.extend(list_order_families(equation, &ranges[equation]));
        }
        families.extend(list_frequency_families(equation, of, length));
        families
    };
    let named = |name: &str| {
        all.iter()
            .copied()
            .find(|e| equations.list[*e].name == name)
    };
    let mut families: Vec<BasisFamily> = all.iter().flat_map(|e| general(*e)).collect();
    if let [only] = all[..] {
        families.extend(wave(only));
    }
    let few_windows = at.thin_out();
    let few = Linearisation {
        point: &few_windows,
        ..of
    };
    let regressed = FamilyRegression::fit_families(few, &equations, families)?;
    let ranking = EquationRanking::from_families(&regressed, &all, few)?;
    let equation = wanted.and_then(named).unwrap_or(ranking.best);
    let close = match all.len() {
        1 => None,
        _ => {
            let own = general(equation).into_iter().chain(wave(equation));
            Some(FamilyRegression::fit_families(
                of,
                &equations,
                own.collect(),
            )?)
        }
    };
    let (close, seen) = match &close {
        Some(close) => (close, of),
        None => (&regressed, few),
    };
    let blocks = ProfileInputs {
        linearisation: seen,
        operating_points: &operating_points,
        equation,
    };
    let mut found = blocks.compute_profiles(close, &ranges[equation]);
    found.ranking = ranking.rank_equations();
    found.equations.clone_from(&equations.list);
    found.best_equation = ranking.best;
    if ranking.is_significant {
        found.explained_fraction = ranking.explained_fraction;
        found.kind = Some(match ranking.is_state {
            false => ForceKind::Time,
            true => find_simple_functions(&regressed, ranking.family, few),
        });
    } else if found.frequency.explained_fraction > thresholds::MIN_FORCE_FRACTION
        && equation == ranking.best
    {
        // A piecewise linear force over time can miss a narrow frequency band.
        found.explained_fraction = found.frequency.explained_fraction;
        found.kind = Some(ForceKind::Time);
    }
    Some(found)
}

/// Returns waves over an angle, for the orders with at least one full period in the motion.
fn list_order_families(equation: EquationId, range: &OperatingRange) -> Vec<BasisFamily> {
    if range.width() <= TAU / 4.0 {
        return Vec::new();
    }
    let turns = |order: &u32| f64::from(*order) * range.width() > TAU;
    let orders = thresholds::FORCE_ORDERS.into_iter().filter(turns);
    let wave = |order: u32| BasisFamily::build_wave(equation, ForceArgument::Order(order));
    orders.map(wave).collect()
}

/// Returns waves over time: from one period per `length`, s, upwards, and at the frequency of the
/// largest residual.
fn list_frequency_families(
    equation: EquationId,
    of: Linearisation<'_>,
    length: f64,
) -> Vec<BasisFamily> {
    let step = typical_step(&of.problem.dataset.train[0].times);
    let mut frequencies: Vec<f64> = find_peak_frequency(of.problem, of.fit)
        .into_iter()
        .collect();
    let mut periods = 1.0;
    for number in 1..=thresholds::MAX_FORCE_FREQUENCIES {
        if periods * thresholds::MIN_SAMPLES_PER_PERIOD * step > length {
            break;
        }
        frequencies.push(periods / length);
        periods = if number < thresholds::HARMONIC_FREQUENCY_COUNT {
            periods + 1.0
        } else {
            periods * thresholds::FREQUENCY_RATIO
        };
    }
    frequencies.sort_by(f64::total_cmp);
    let wave =
        |frequency: f64| BasisFamily::build_wave(equation, ForceArgument::Frequency(frequency));
    frequencies.into_iter().map(wave).collect()
}
