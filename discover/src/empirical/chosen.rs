//! Selection of the terms of an unnamed expression that explain the residual best: all sets of one,
//! two and three terms, to first order along the fitted motion. The acceptance is decided after a
//! full fit.

use crate::ids::{BasisFunctionId, EquationId};
use nalgebra::{DMatrix, DVector};

use crate::empirical::expressions::{Scales, Term, terms};
use crate::fit::fitted::Fit;
use crate::fit::linearised::{Linearisation, LinearisedFit};
use crate::fit::residuals::correlation;
use crate::model::problem::EstimationProblem;
use crate::residual_force::basis_functions::Range;
use crate::residual_force::equations::{Equation, Equations, OperatingPoint};
use crate::residual_force::force_response::{ForceColumns, force_responses, operating_points};
use crate::residual_force::regression::{Regression, Sizes};
use crate::thresholds;

/// Sum of terms in an equation.
pub struct Expression {
    /// Equation of motion.
    pub equation: Equation,
    /// Scales of its quantities.
    pub scales: Scales,
    /// Terms.
    pub terms: Vec<Term>,
    /// Coefficients of the terms, N or N m.
    pub sizes: Vec<f64>,
    /// Expected explained fraction of the squares.
    pub part: f64,
}

/// A set of terms with what it is expected to do.
struct Set {
    terms: Vec<BasisFunctionId>,
    sizes: Sizes,
}

/// Returns the best expression in a set of equations; `None` if no set of terms is significant or
/// tangent vectors are not available.
pub fn chosen(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    among: &[EquationId],
) -> Option<Expression> {
    let equations = Equations::of(problem, fit)?;
    let at = LinearisedFit::of(problem, fit, 1.0);
    let linearisation = Linearisation {
        at: &at,
        problem,
        fit,
    };
    let operating_points = operating_points(linearisation, &equations);
    let inputs = largest_inputs(problem);
    let of = |equation: &EquationId| {
        let own = operating_points.iter().flatten().map(|all| all[*equation]);
        let range = Range::of(&own.collect::<Vec<OperatingPoint>>());
        let scales = Scales {
            rate: rounded(range.rate),
            position: rounded(range.position.0.abs().max(range.position.1.abs())),
            inputs: inputs.clone(),
        };
        in_equation(linearisation, &equations, *equation, range.width(), scales)
    };
    let found = among.iter().filter_map(of);
    found.max_by(|a, b| a.part.total_cmp(&b.part))
}

fn in_equation(
    of: Linearisation<'_>,
    equations: &Equations,
    equation: EquationId,
    width: f64,
    scales: Scales,
) -> Option<Expression> {
    let own = &equations.list[equation];
    let terms = terms(&scales, own.unit == "rad", width);
    let weights = |operating_points: &[OperatingPoint], inputs: &[f64], out: &mut [f64]| {
        for (slot, term) in out.iter_mut().zip(&terms) {
            *slot = term.at(&operating_points[equation], inputs, &scales);
        }
    };
    let columns = ForceColumns {
        equations: vec![equation; terms.len()],
        weights: &weights,
    };
    let blocks = force_responses(of, equations, &columns)?;
    let regression = Regression::new(of.at, of.fit, &blocks)?;
    let best = best(&regression, of, &blocks)?;
    Some(Expression {
        equation: own.clone(),
        terms: best.terms.iter().map(|term| terms[*term].clone()).collect(),
        sizes: best.sizes.values.iter().copied().collect(),
        part: best.sizes.decrease / regression.squares,
        scales,
    })
}

/// The best set of one term, or of more where that takes much of what fewer leave.
fn best(
    regression: &Regression,
    of: Linearisation<'_>,
    blocks: &[Option<DMatrix<f64>>],
) -> Option<Set> {
    let count = blocks.iter().flatten().map(DMatrix::ncols).next()?;
    let mut known: Option<Set> = None;
    for size in 1..=thresholds::UNNAMED_TERMS {
        let sets = subsets(count, size).into_iter();
        let sizes = sets.map(|terms| (regression.shared(&terms), terms));
        let Some((sizes, terms)) = sizes.max_by(|a, b| a.0.decrease.total_cmp(&b.0.decrease))
        else {
            break;
        };
        let mut values = DVector::zeros(count);
        for (term, value) in terms.iter().zip(sizes.values.iter()) {
            values[term.index()] = *value;
        }
        let residuals = regression.remaining(of.at, blocks, &|_| values.clone(), true);
        let over = correlation(&residuals, of.problem.noise.len());
        let gain_before = known.as_ref().map_or(0.0, |set| set.sizes.decrease);
        let squares = regression.squares - sizes.decrease;
        let level = (squares / regression.numbers).max(1.0);
        let taken = sizes.decrease - gain_before;
        let is_enough = taken > 2.0 * thresholds::INFORMATION * level * over
            && taken > thresholds::TERM_TAKES * (regression.squares - gain_before);
        if is_enough {
            known = Some(Set { terms, sizes });
        }
    }
    known
}

/// All sets of so many of so many terms.
fn subsets(count: usize, size: usize) -> Vec<Vec<BasisFunctionId>> {
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

/// The largest value of each input in the training records.
fn largest_inputs(problem: &EstimationProblem<'_>) -> Vec<f64> {
    let records = &problem.dataset.train;
    let count = records.iter().map(|r| r.input_columns.len()).max();
    let largest = |input: usize| {
        let columns = records.iter().filter_map(|r| r.input_columns.get(input));
        let sizes = columns.flatten().map(|value| value.abs());
        rounded(sizes.filter(|size| size.is_finite()).fold(0.0, f64::max))
    };
    (0..count.unwrap_or(0)).map(largest).collect()
}

/// Two significant digits, for reading.
fn rounded(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    #[test]
    fn every_set_is_there_once() {
        let sets = super::subsets(6, 3);
        assert_eq!(sets.len(), 20);
        for (number, set) in sets.iter().enumerate() {
            assert!(set.is_sorted() && !sets[..number].contains(set));
        }
    }
}
