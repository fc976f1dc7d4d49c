//! Saltation matrix, the effect of a switch on tangent vectors: I + (f_after - f_before) grad g / (rate of g).
//!
//! The jump of a force can be proportional to the rate of the switching function, as for damping in a gear
//! mesh: f_after - f_before = u (rate of g) on the surface. The quotient is then the same for every crossing
//! and is computed once. This also avoids a quotient of two small numbers at a grazing crossing.

use eomgen_codegen::program::affine::{AffineRows, AffineSystem};
use nalgebra::{DVector, Matrix2, Vector2};

use super::event_function::Linear;

/// Largest relative residual of a jump that is proportional to the rate.
const ROUNDING: f64 = 1e-10;

/// Returns u of the saltation matrix I + u grad g; `None` if it is not constant.
pub(super) fn find_constant_saltation(
    before: &AffineSystem,
    after: &AffineSystem,
    function: &Linear,
    threshold: f64,
) -> Option<DVector<f64>> {
    let states = before.states;
    let row = &function.state;
    let still = |block: &[f64]| block.iter().all(|entry| *entry == 0.0);
    if !(still(&function.inputs) && still(&function.sines) && still(&function.cosines)) {
        return None;
    }
    let rate = compute_function_rate(row, &before.rates);
    // Each row of the jump is w row + u rate.state, by least squares.
    let normal = Matrix2::new(
        row.norm_squared(),
        row.dot(&rate.state),
        row.dot(&rate.state),
        rate.state.norm_squared(),
    );
    let inverse = normal.try_inverse()?;
    let mut factors = DVector::zeros(states);
    for state in 0..states {
        let jump = compute_jump(&before.rates, &after.rates, state);
        let right = Vector2::new(row.dot(&jump.state), rate.state.dot(&jump.state));
        let [w, u] = (inverse * right).into();
        let rest = &jump.state - row * w - &rate.state * u;
        let size = jump.state.amax();
        let constant = jump.constant + w * threshold - u * rate.constant;
        let scale = jump.constant.abs() + (w * threshold).abs();
        let others = [
            (&jump.inputs, &rate.inputs),
            (&jump.sines, &rate.sines),
            (&jump.cosines, &rate.cosines),
        ];
        let differs = |(a, b): &(&Vec<f64>, &Vec<f64>)| {
            a.iter()
                .zip(*b)
                .any(|(a, b)| (a - u * b).abs() > ROUNDING * a.abs().max((u * b).abs()))
        };
        if rest.amax() > ROUNDING * size
            || constant.abs() > ROUNDING * scale
            || others.iter().any(differs)
        {
            return None;
        }
        factors[state] = u;
    }
    Some(factors)
}

/// Returns row f as a function of state, inputs and sinusoids.
fn compute_function_rate(row: &DVector<f64>, rates: &AffineRows) -> Linear {
    let of = |block: &[f64]| -> Vec<f64> {
        let width = block.len() / row.len().max(1);
        (0..width)
            .map(|column| {
                row.iter()
                    .enumerate()
                    .map(|(state, r)| r * block[state * width + column])
                    .sum()
            })
            .collect()
    };
    Linear {
        state: DVector::from_vec(of(&rates.state)),
        inputs: of(&rates.inputs),
        sines: of(&rates.sines),
        cosines: of(&rates.cosines),
        constant: of(&rates.constant)[0],
    }
}

/// Returns row `state` of f_after - f_before.
fn compute_jump(before: &AffineRows, after: &AffineRows, state: usize) -> Linear {
    let (mut a, b) = (Linear::row(after, state), Linear::row(before, state));
    a.state -= b.state;
    a.constant -= b.constant;
    let pairs = [
        (&mut a.inputs, b.inputs),
        (&mut a.sines, b.sines),
        (&mut a.cosines, b.cosines),
    ];
    for (a, b) in pairs {
        a.iter_mut().zip(b).for_each(|(a, b)| *a -= b);
    }
    a
}
