//! Checks of a certificate:
//!
//! - [`states`]: random states in every regime;
//! - [`zeros`]: states with entries equal to 0;
//! - [`balance`]: power balance along trajectories;
//! - [`integrals`]: quadrature of integrands that are not polynomials of the motion;
//! - [`nesting`]: agreement between orders;
//! - [`outputs`]: requested outputs;
//! - [`emitted`]: emitted source, with `number_types` for single precision, SIMD and requested outputs;
//! - [`emitted_c`]: emitted C; `interface` compares names, conversions, parameters and precisions of both;
//! - [`casadi`]: emitted functions for CasADi;
//! - [`mod@unit`]: functional mock-up units;
//! - [`regimes`]: emitted kernels of regimes;
//! - [`exact`]: state derivative of the exact solver.
//!
//! The oracle is accurate to 1e-14 of the largest term of a row (at order 128). Therefore nearly the whole tolerance of
//! 1e-12 is available to the variant under test.

pub mod balance;
pub mod casadi;
mod controller_decisions;
mod controllers;
pub mod emitted;
pub mod emitted_c;
pub mod exact;
pub mod integrals;
mod interface;
pub mod linked_program;
pub mod nesting;
mod number_types;
pub mod outputs;
mod regime_interiors;
pub mod regimes;
pub mod states;
pub mod unit;
pub mod zeros;

use super::oracle::Equations;
use super::variant::Variant;
use nalgebra::DMatrix;

/// Tolerance of rows of the equations, relative to the largest addend of the row before cancellation.
pub const ROW_TOLERANCE: f64 = 1e-12;
/// Tolerance of entries of the mass matrix: about a thousand roundings. It is relative to the
/// geometric mean of the two diagonal entries or to the terms that cancel in the entry.
pub const MASS_TOLERANCE: f64 = 2e-13;
/// Tolerance of the mass matrix's asymmetry, which is due to products with another order of factors.
pub const SYMMETRY_TOLERANCE: f64 = 1e-15;

/// Returns the variant's accelerations and rates of first-order states. Errors: rates of coordinates that differ from
/// the state.
fn unknowns(
    variant: &mut dyn Variant,
    time: f64,
    state: &[f64],
    inputs: &[f64],
) -> Result<Vec<f64>, String> {
    let mut rates = vec![f64::NAN; state.len()];
    variant.rates(time, state, inputs, &mut rates)?;
    let size = variant.coordinate_names().len();
    if rates.get(..size) != state.get(size..2 * size) {
        return Err("the rates of the coordinates differ from those in the state".to_owned());
    }
    Ok(rates.split_off(size))
}

fn mass_matrix(
    variant: &mut dyn Variant,
    time: f64,
    state: &[f64],
    inputs: &[f64],
) -> Result<DMatrix<f64>, String> {
    let size = variant.coordinate_names().len();
    let mut mass = vec![f64::NAN; size * size];
    variant.mass_matrix(time, state, inputs, &mut mass)?;
    Ok(DMatrix::from_row_slice(size, size, &mass))
}

/// Returns the largest |first - second| relative to the scale of each entry.
fn matrix_distance(first: &DMatrix<f64>, second: &DMatrix<f64>, scale: &Equations) -> f64 {
    let mut worst: f64 = 0.0;
    for row in 0..first.nrows() {
        for column in 0..first.ncols() {
            let difference = (first[(row, column)] - second[(row, column)]).abs();
            if difference.is_nan() {
                return f64::INFINITY;
            }
            if difference > 0.0 {
                worst = worst.max(difference / scale.mass_scale(row, column));
            }
        }
    }
    worst
}
