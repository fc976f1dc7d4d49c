//! Selection of the terms of an empirical expression. All sets of one, two and three terms are
//! compared to first order along the fitted motion. The expression is accepted or rejected after a
//! full fit.

use crate::ids::{BasisFunctionId, EquationId};
use nalgebra::{DMatrix, DVector};

use crate::empirical::expressions::{Scales, Term, list_terms};
use crate::fit::fit_result::Fit;
use crate::fit::linearised_fit::{Linearisation, LinearisedFit};
use crate::fit::residuals::compute_correlation_samples;
use crate::model::problem::EstimationProblem;
use crate::residual_force::basis_functions::OperatingRange;
use crate::residual_force::equations::{Equation, EquationSet, OperatingPoint};
use crate::residual_force::force_response::{
    ForceColumns, compute_force_responses, compute_operating_points,
};
use crate::residual_force::regression::{Coefficients, Regression};
use crate::thresholds;

/// Sum of terms in an equation.
pub struct Expression {
    /// Equation of motion.
    pub equation: Equation,
    /// Scales of the quantities in the terms.
    pub scales: Scales,
    /// Terms.
    pub terms: Vec<Term>,
    /// Coefficients of the terms, N or N m.
    pub sizes: Vec<f64>,
    /// Expected explained fraction of the squares.
    pub explained_fraction: f64,
}

/// Set of terms with its fitted coefficients.
struct TermSet {
    terms: Vec<BasisFunctionId>,
    sizes: Coefficients,
}

/// Returns the best expression in a set of equations; `None` if no set of terms is significant or
/// tangent vectors are not available.
pub fn select_expression(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    among: &[EquationId],
) -> Option<Expression> {
    let equations = EquationSet::derive_from_fit(problem, fit)?;
    let at = LinearisedFit::linearise_fit(problem, fit, 1.0);
    let linearisation = Linearisation {
        point: &at,
        problem,
        fit,
    };
    let operating_points = compute_operating_points(linearisation, &equations);
    let inputs = find_largest_inputs(problem);
    let of = |equation: &EquationId| {
        let own = operating_points.iter().flatten().map(|all| all[*equation]);
        let range = OperatingRange::from_operating_points(&own.collect::<Vec<OperatingPoint>>());
        let scales = Scales {
            rate: round_to_two_digits(range.largest_rate),
            position: round_to_two_digits(
                range
                    .position_bounds
                    .0
                    .abs()
                    .max(range.position_bounds.1.abs()),
            ),
            inputs: inputs.clone(),
        };
        select_in_equation(linearisation, &equations, *equation, range.width(), scales)
    };
    let found = among.iter().filter_map(of);
    found.max_by(|a, b| a.explained_fraction.total_cmp(&b.explained_fraction))
}

fn select_in_equation(
    of: Linearisation<'_>,
    equations: &EquationSet,
    equation: EquationId,
    width: f64,
    scales: Scales,
) -> Option<Expression> {
    let own = &equations.list[equation];
    let terms = list_terms(&scales, own.unit == "rad", width);
    let weights = |operating_points: &[OperatingPoint], inputs: &[f64], out: &mut [f64]| {
        for (slot, term) in out.iter_mut().zip(&terms) {
            *slot = term.evaluate(&operating_points[equation], inputs, &scales);
        }
    };
    let columns = ForceColumns {
        equations: vec![equation; terms.len()],
        fill_weights: &weights,
    };
    let blocks = compute_force_responses(of, equations, &columns)?;
    let regression = Regression::new(of.point, of.fit, &blocks)?;
    let best = select_best_set(&regression, of, &blocks)?;
    Some(Expression {
        equation: own.clone(),
        terms: best.terms.iter().map(|term| terms[*term].clone()).collect(),
        sizes: best.sizes.values.iter().copied().collect(),
        explained_fraction: best.sizes.decrease / regression.remaining_squares,
        scales,
    })
}

/// Returns the best single term, or a set of more terms if each of them greatly reduces the
/// residual.
fn select_best_set(
    regression: &Regression,
    of: Linearisation<'_>,
    blocks: &[Option<DMatrix<f64>>],
) -> Option<TermSet> {
    let count = blocks.iter().flatten().map(DMatrix::ncols).next()?;
    let mut known: Option<TermSet> = None;
    for size in 1..=thresholds::MAX_EXPRESSION_TERMS {
        let sets = list_subsets(count, size).into_iter();
        let sizes = sets.map(|terms| (regression.fit_shared(&terms), terms));
        let Some((sizes, terms)) = sizes.max_by(|a, b| a.0.decrease.total_cmp(&b.0.decrease))
        else {
            break;
        };
        let mut values = DVector::zeros(count);
        for (term, value) in terms.iter().zip(sizes.values.iter()) {
            values[term.index()] = *value;
        }
        let residuals = regression.compute_remaining(of.point, blocks, &|_| values.clone(), true);
        let over = compute_correlation_samples(&residuals, of.problem.noise.len());
        let gain_before = known.as_ref().map_or(0.0, |set| set.sizes.decrease);
        let squares = regression.remaining_squares - sizes.decrease;
        let level = (squares / regression.number_count).max(1.0);
        let taken = sizes.decrease - gain_before;
        let is_enough = taken > 2.0 * thresholds::MIN_INFORMATION_GAIN * level * over
            && taken
                > thresholds::MIN_TERM_REDUCTION * (regression.remaining_squares - gain_before);
        if is_enough {
            known = Some(TermSet { terms, sizes });
        }
    }
    known
}

/// Returns all subsets of `size` of `count` terms.
fn list_subsets(count: usize, size: usize) -> Vec<Vec<BasisFunctionId>> {
    let mut found: Vec<Vec<BasisFunctionId>> = vec![Vec::new()];
    for _ in 0..size {
        let longer = found.iter().flat_map(|set| {
            let from = set.last().map_or(0, |last| last.index() + 1);
            BasisFunctionId::first(count)
                .skip(from)
                .map(move |term| [&set[..], &[term]].concat())
        });
        found = longer.collect();
    }
    found
}

/// Returns the largest absolute value of each input in the training records.
fn find_largest_inputs(problem: &EstimationProblem<'_>) -> Vec<f64> {
    let records = &problem.dataset.train;
    let count = records.iter().map(|r| r.input_columns.len()).max();
    let largest = |input: usize| {
        let columns = records.iter().filter_map(|r| r.input_columns.get(input));
        let sizes = columns.flatten().map(|value| value.abs());
        round_to_two_digits(sizes.filter(|size| size.is_finite()).fold(0.0, f64::max))
    };
    (0..count.unwrap_or(0)).map(largest).collect()
}

/// Rounds to two significant digits for readability.
fn round_to_two_digits(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    #[test]
    fn subsets_are_complete_and_unique() {
        let sets = super::list_subsets(6, 3);
        assert_eq!(sets.len(), 20);
        for (number, set) in sets.iter().enumerate() {
            assert!(set.is_sorted() && !sets[..number].contains(set));
        }
    }
}
