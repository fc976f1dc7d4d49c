//! The checks of a certificate, one file each: [`states`] at random states in every
//! regime, [`zeros`] where entries of the state are 0, [`balance`] along a trajectory, [`nesting`] between orders, [`outputs`] for
//! output functions, [`emitted`] for source text, with `kinds` for other kinds of
//! numbers, [`regimes`] for its kernels of regimes, [`exact`] for what the exact solver
//! integrates. `certify` runs them all.
//!
//! Tolerances: 1e-12 of the largest term summed in a row is what the project promises;
//! the oracle itself is good to 1e-14 there (S = 128), so the margin is the subject's.

pub mod balance;
pub mod emitted;
pub mod exact;
mod inside;
mod kinds;
pub mod linked;
pub mod nesting;
pub mod outputs;
pub mod regimes;
pub mod states;
pub mod zeros;

use super::oracle::Equations;
use super::variant::Variant;
use nalgebra::DMatrix;

/// Deviation from the oracle that passes, relative to the largest term summed in a row,
/// before anything cancels in it.
pub const ROW_TOLERANCE: f64 = 1e-12;
/// Deviation of entries of the mass matrix that passes, relative to the geometric mean
/// of the two diagonal entries or to the terms that cancel in the entry: a thousand
/// roundings.
pub const MASS_TOLERANCE: f64 = 2e-13;
/// Asymmetry of the mass matrix that passes, relative as above: an entry is a product of
/// a few factors, which may be formed in another order on the other side.
pub const SYMMETRY_TOLERANCE: f64 = 1e-15;

/// The accelerations a variant gives, then the rates of states of first order; the rates of the
/// coordinates, which come first, must be those of the state, bit for bit.
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
        return Err("the rates of the coordinates are not those of the state".to_owned());
    }
    Ok(rates.split_off(size))
}

/// The mass matrix a variant gives.
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

/// The largest |first - second| relative to the scale of each entry.
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
