//! Derivatives of a regime with respect to parameters. They are exact for tangent vectors between switches, if no mode
//! excited by the held drives turns far within a step.

use eomgen_codegen::program::affine::AffineEvaluator;
use nalgebra::DMatrix;

use super::kernels::Columns;
use super::regime_rates::{MAX_DOUBLINGS, Rates, TERMS, compute_held_rates, find_flow_scale};
use super::surfaces::{Row, Side, Surfaces};
use crate::balancing::scale_matrix;

/// Norm of a matrix below which the series of the exponential converges to rounding within [`TERMS`] terms.
const SERIES_NORM: f64 = 0.5;

/// Values of the independent parameters (SI, in the order of the model's program), one of which is changed.
#[derive(Clone, Debug)]
pub struct MovedParameters {
    /// Values of all parameters.
    pub values: Vec<f64>,
    /// Change of the changed parameter, SI.
    pub parameter_change: f64,
}

/// Derivatives of a regime by one parameter.
#[derive(Clone, Debug)]
pub(super) struct RegimeDerivative {
    /// Derivative of the matrix of the rates, states x states.
    pub state: Columns,
    /// Derivative of the matrix that maps (1, inputs) to the rates.
    pub given: Columns,
    /// Derivatives of the surfaces' functions.
    pub functions: Vec<Row>,
    /// For 1, 2, 4 ... steps: matrices that map the state at the start, and (1, inputs), to the change of a
    /// tangent vector.
    pub doubled: Vec<(Columns, Columns)>,
}

/// Rates of a regime and functions of its surfaces.
type RegimeRows = (Rates, Vec<Row>);

/// Computes the derivatives of a regime by each parameter. `base` are the parameters of the evaluator. Returns
/// `None` if a derivative cannot be computed.
pub(super) fn compute_regime_derivatives(
    evaluator: &mut AffineEvaluator,
    surfaces: &Surfaces,
    sides: &[Side],
    step: f64,
    (base, moved): (&[f64], &[Vec<MovedParameters>]),
) -> Option<Vec<RegimeDerivative>> {
    let mut rows_at = |values: &[f64]| -> Option<RegimeRows> {
        evaluator.set_parameters(values);
        let (rates, functions, _) = compute_held_rates(evaluator, surfaces, sides)?;
        rates.are_finite().then_some((rates, functions))
    };
    let own = rows_at(base)?;
    let derivatives = moved.iter().map(|ends| {
        let ends = ends.iter().filter_map(|end| {
            let rows = rows_at(&end.values).filter(|_| end.parameter_change != 0.0)?;
            Some((rows, end.parameter_change))
        });
        let mut ends: Vec<(RegimeRows, f64)> = ends.collect();
        ends.push((own.clone(), 0.0));
        let [(a, from), (b, to), ..] = &ends[..] else {
            return None;
        };
        Some(compute_difference_quotient(&own.0, (a, b), to - from, step))
    });
    let derivatives = derivatives.collect();
    evaluator.set_parameters(base);
    derivatives
}

/// Returns the difference quotient of a regime's matrices over `span`, and its effect on tangent vectors.
fn compute_difference_quotient(
    own: &Rates,
    (a, b): (&RegimeRows, &RegimeRows),
    span: f64,
    step: f64,
) -> RegimeDerivative {
    let rates = Rates {
        state: (&b.0.state - &a.0.state) / span,
        given: (&b.0.given - &a.0.given) / span,
    };
    let quotient = |a: &[f64], b: &[f64]| -> Vec<f64> {
        let pairs = a.iter().zip(b);
        pairs.map(|(a, b)| (b - a) / span).collect()
    };
    let functions = a.1.iter().zip(&b.1).map(|(a, b)| Row {
        state: quotient(&a.state, &b.state),
        given: quotient(&a.given, &b.given),
    });
    let (n, given) = (rates.state.nrows(), rates.given.ncols());
    let doubled = compute_flow_derivatives(&own.joined_matrix(), &rates.joined_matrix(), n, step);
    let doubled = doubled.iter().map(|of| {
        (
            Columns::from_entries(n, n, |r, c| of[(r, c)]),
            Columns::from_entries(n, given, |r, c| of[(r, n + c)]),
        )
    });
    RegimeDerivative {
        functions: functions.collect(),
        doubled: doubled.collect(),
        state: Columns::from_entries(n, n, |r, c| rates.state[(r, c)]),
        given: Columns::from_entries(n, given, |r, c| rates.given[(r, c)]),
    }
}

/// Returns the Fréchet derivatives of exp(W h) in the direction V, for h of 1, 2, 4 ... steps, by the series
/// and by squaring (Higham, Functions of Matrices, 2008, section 10.6). The first `states` rows of W and V are
/// rates, the others are 0.
fn compute_flow_derivatives(
    whole: &DMatrix<f64>,
    change: &DMatrix<f64>,
    states: usize,
    step: f64,
) -> Vec<DMatrix<f64>> {
    let scale = find_flow_scale(whole, states, step);
    let back: Vec<f64> = scale.iter().map(|factor| 1.0 / factor).collect();
    let (w, v) = (
        scale_matrix(whole, &scale) * step,
        scale_matrix(change, &scale) * step,
    );
    let norm = w.column_iter().map(|column| column.lp_norm(1));
    let norm = norm.fold(0.0, f64::max);
    let squarings = (norm / SERIES_NORM).log2().ceil().max(0.0);
    let (w, v) = (w / squarings.exp2(), v / squarings.exp2());
    let count = w.nrows();
    let (mut flow, mut derivative) = (DMatrix::identity(count, count), v.clone());
    let (mut term, mut of_term) = (w.clone(), v.clone());
    flow += &term;
    for k in 2..=TERMS {
        of_term = (&v * &term + &w * &of_term) / k as f64;
        term = &w * &term / k as f64;
        flow += &term;
        derivative += &of_term;
    }
    let double = |flow: &mut DMatrix<f64>, derivative: &mut DMatrix<f64>| {
        *derivative = &*derivative * &*flow + &*flow * &*derivative;
        *flow = &*flow * &*flow;
    };
    for _ in 0..squarings as usize {
        double(&mut flow, &mut derivative);
    }
    let mut doubled = Vec::with_capacity(MAX_DOUBLINGS);
    for _ in 0..MAX_DOUBLINGS {
        doubled.push(scale_matrix(&derivative, &back));
        double(&mut flow, &mut derivative);
    }
    doubled
}
