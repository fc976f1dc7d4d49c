//! Test of the gain of the example controller (`examples/bare_metal/controller.rs`), which is recomputed as the example
//! documents it.

use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_tests::models::{load, project, variant};
use nalgebra::{DMatrix, DVector};

/// Sample period of the controller, in s.
const STEP: f64 = 20e-6;

/// Scale of each state in the cost: 1 mm for deflections, the carrier's displacement and modes, 1 m/s for their rates.
/// The scale of the torque is 1 N m.
const STATE_SCALES: [f64; 14] = [
    1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0,
];

fn rates(evaluator: &mut Evaluator, state: &[f64], torque: f64) -> DVector<f64> {
    let mut out = vec![0.0; state.len()];
    let point = Point {
        t: 0.0,
        state,
        inputs: &[torque],
    };
    evaluator.rates(point, &mut out);
    DVector::from_vec(out)
}

/// Returns A and B of the arm with both meshes in contact. In this regime the model is linear, so finite differences
/// are exact up to rounding.
fn linearise() -> (DMatrix<f64>, DVector<f64>) {
    let mut evaluator = variant(&load("planetary_arm_rig"), 4).evaluator;
    let mut state = vec![0.0; STATE_SCALES.len()];
    (state[0], state[1]) = (1e-2, 1e-2);
    let at = rates(&mut evaluator, &state, 0.0);
    let b = rates(&mut evaluator, &state, 1.0) - &at;
    let columns: Vec<DVector<f64>> = (0..state.len())
        .map(|i| {
            let mut moved = state.clone();
            moved[i] += 1e-2;
            (rates(&mut evaluator, &moved, 0.0) - &at) / 1e-2
        })
        .collect();
    (DMatrix::from_columns(&columns), b)
}

/// Computes the gain by the doubling algorithm (Chu, Fan, Lin and Wang, "Structure-preserving algorithms for periodic
/// discrete-time algebraic Riccati equations", 2004), with scaled states, whose cost matrix is the identity.
fn compute_gain() -> Vec<f64> {
    let (a, b) = linearise();
    let n = STATE_SCALES.len();
    let mut both = DMatrix::zeros(n + 1, n + 1);
    for row in 0..n {
        for column in 0..n {
            both[(row, column)] =
                STEP * a[(row, column)] * STATE_SCALES[column] / STATE_SCALES[row];
        }
        both[(row, n)] = STEP * b[row] / STATE_SCALES[row];
    }
    let flow = both.exp();
    let (a, b) = (
        flow.view((0, 0), (n, n)).into_owned(),
        flow.view((0, n), (n, 1)).into_owned(),
    );
    let one = DMatrix::identity(n, n);
    let (mut flow, mut moved, mut cost) = (a.clone(), &b * b.transpose(), one.clone());
    for _ in 0..40 {
        let inverse = (&one + &moved * &cost).try_inverse().expect("regular");
        let next_cost = &cost + flow.transpose() * &cost * &inverse * &flow;
        let next_moved = &moved + &flow * &inverse * &moved * flow.transpose();
        flow = &flow * &inverse * &flow;
        (cost, moved) = (next_cost, next_moved);
    }
    let weight = 1.0 + (b.transpose() * &cost * &b)[(0, 0)];
    let gain = b.transpose() * &cost * &a / weight;
    (0..n).map(|i| gain[i] / STATE_SCALES[i]).collect()
}

fn gain_in_source() -> Vec<f64> {
    let path = project().join("examples/bare_metal/controller.rs");
    let source = std::fs::read_to_string(path).expect("the controller");
    let (_, rest) = source.split_once("GAIN: State = [").expect("the gain");
    let (numbers, _) = rest.split_once(']').expect("its end");
    numbers
        .split(',')
        .map(str::trim)
        .filter(|number| !number.is_empty())
        .map(|number| number.parse().expect("a number"))
        .collect()
}

/// The source has six digits. The solution of the Riccati equation has fewer than sixteen.
#[test]
fn gain_in_source_matches_computed_gain() {
    let (expected, written) = (compute_gain(), gain_in_source());
    assert_eq!(written.len(), expected.len());
    for (written, expected) in written.iter().zip(&expected) {
        assert!(
            (written - expected).abs() < 1e-5 * expected.abs(),
            "{written:?} instead of {expected:?}"
        );
    }
}

/// All eigenvalues of the closed loop must be inside the unit circle.
#[test]
fn gain_stabilises_the_arm() {
    let (a, b) = linearise();
    let gain = DMatrix::from_row_slice(1, STATE_SCALES.len(), &gain_in_source());
    let scale = DMatrix::from_diagonal(&DVector::from_column_slice(&STATE_SCALES));
    let back = scale.map(|x| if x == 0.0 { 0.0 } else { 1.0 / x });
    let closed = back * (a - b * gain) * scale;
    let rightmost = closed
        .complex_eigenvalues()
        .iter()
        .fold(f64::MIN, |most, value| most.max(value.re));
    assert!(rightmost < -0.1, "{rightmost}");
}
