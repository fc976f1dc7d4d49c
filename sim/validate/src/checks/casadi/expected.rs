//! Expected results of the functions for CasADi.

use eomgen_codegen::program::evaluator::{Evaluator, Point};
use nalgebra::DMatrix;

use super::super::interface::arguments;
use super::interface::lengths;
use crate::derived_outputs::dense;
use crate::sampler::Sample;

/// Jacobians of the rates by time, state, inputs and parameters.
const JACOBIANS: [&str; 4] = [
    "rates_by_time",
    "rates_by_state",
    "rates_by_inputs",
    "rates_by_parameters",
];

/// Expected result of a function.
pub enum Expected {
    /// Values to reproduce bit for bit.
    Exact(DMatrix<f64>),
    /// Second derivatives: row and column of this block in the matrix of all second derivatives.
    Second(usize, usize),
}

/// Returns the Jacobians of the rates by time, state, inputs and parameters.
pub fn rate_jacobians(evaluator: &mut Evaluator, sample: &Sample) -> [DMatrix<f64>; 4] {
    let states = evaluator.program().states();
    let lengths = lengths(evaluator.program());
    std::array::from_fn(|place| {
        let jacobians = &evaluator.program().outputs.jacobians;
        let found = jacobians
            .iter()
            .position(|known| known.name == JACOBIANS[place]);
        let Some(index) = found else {
            return DMatrix::from_element(states, lengths[place], f64::NAN);
        };
        let jacobian = jacobians[index].clone();
        let mut nonzeros = vec![f64::NAN; jacobian.nonzeros()];
        evaluator.jacobian(index, point(sample), &mut nonzeros);
        dense(&jacobian, &nonzeros)
    })
}

/// Returns the expected results of the function `name` for the parameters that the evaluator was prepared with.
pub fn expected_results(name: &str, evaluator: &mut Evaluator, sample: &Sample) -> Vec<Expected> {
    match name {
        "rates" => {
            let mut rates = vec![f64::NAN; sample.state.len()];
            evaluator.rates(point(sample), &mut rates);
            vec![Expected::Exact(column(rates))]
        }
        "jac_rates" => {
            let jacobians = rate_jacobians(evaluator, sample);
            jacobians.map(Expected::Exact).into()
        }
        "adj1_rates" => weighted_rates(evaluator, sample)
            .map(|gradient| Expected::Exact(column(gradient)))
            .into(),
        _ => second_derivatives(evaluator, sample),
    }
}

/// Returns the gradient of the weighted rates by time, state, inputs and parameters.
fn weighted_rates(evaluator: &mut Evaluator, sample: &Sample) -> [Vec<f64>; 4] {
    let [_, states, inputs, parameters] = lengths(evaluator.program());
    let weights = arguments(states);
    let [by_time, ..] = rate_jacobians(evaluator, sample);
    let by_time = by_time.iter().zip(&weights);
    let by_time = by_time.fold(0.0, |sum, (rate, weight)| sum + rate * weight);
    let mut gradient = [
        vec![by_time],
        vec![f64::NAN; states],
        vec![f64::NAN; inputs],
        vec![f64::NAN; parameters],
    ];
    let [_, by_state, by_inputs, by_parameters] = &mut gradient;
    evaluator.vector_jacobian_product(point(sample), &weights, (by_state, by_inputs));
    evaluator.vector_jacobian_product_by_parameters(point(sample), &weights, by_parameters);
    gradient
}

fn second_derivatives(evaluator: &mut Evaluator, sample: &Sample) -> Vec<Expected> {
    let lengths = lengths(evaluator.program());
    let states = lengths[1];
    let jacobians = rate_jacobians(evaluator, sample);
    let first = |place: usize| lengths[..place].iter().sum::<usize>();
    let mut results = Vec::new();
    for (row, jacobian) in jacobians.iter().enumerate() {
        results
            .extend((0..lengths.len()).map(|column| Expected::Second(first(row), first(column))));
        results.push(Expected::Exact(DMatrix::zeros(lengths[row], states)));
        results.push(Expected::Exact(jacobian.transpose()));
    }
    results
}

fn column(numbers: Vec<f64>) -> DMatrix<f64> {
    DMatrix::from_vec(numbers.len(), 1, numbers)
}

fn point(sample: &Sample) -> Point<'_> {
    Point {
        t: sample.time,
        state: &sample.state,
        inputs: &sample.inputs,
    }
}
