//! Bounds of the rounding errors of a program over ranges of time, states, inputs and parameters.
//!
//! `scalars` lists the operations on single numbers, `analysis` bounds each number and its error over a box, with the
//! rules of `format` and `slopes`, and `boxes` divides the ranges until the bound is tight. `points` bounds errors at
//! single points. `quantities` lists the numbers that are bounded, and `obstacle` describes the reason for a missing
//! bound.
//!
//! The error of a quantity is the difference between the value that emitted code computes and the exact value of the
//! same formulas. Constants, tables and the arguments of the call (time, states, inputs, parameters) count as exact.
//! In single precision the coefficients are prepared in double precision and converted. If a function jumps, the
//! computed and the exact value are taken on the same side of the jump.

mod analysis;
mod boxes;
mod format;
mod obstacle;
mod points;
mod quantities;
mod scalars;
mod slopes;

pub use analysis::{Bounded, bound_by_sensitivities, bound_numbers};
pub use boxes::{Ranges, bound_root};
pub use format::Format;
pub use obstacle::{Cause, Obstacle, point_names};
pub use points::PointBounds;
pub use quantities::{Quantity, quantities};
pub use scalars::{Scalar, ScalarOp, Scalars};

use crate::program::Program;

/// Bound of the rounding error of one quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct RoundingBound {
    /// Quantity.
    pub quantity: Quantity,
    /// Format of the computation.
    pub format: Format,
    /// Bound in the unit of the quantity, or the reason for a missing bound.
    pub bound: Result<f64, String>,
}

/// Bounds the rounding errors of mass matrix, velocity terms, forces and rates at all points in `ranges`, which has an
/// entry for each component of a [point](Program::point_place).
pub fn bound_quantities(program: &Program, format: Format, ranges: &Ranges) -> Vec<RoundingBound> {
    bound_all(program, quantities(program), format, ranges)
}

/// Bounds the rounding errors of the accelerations, then of the rates of first-order states, at all points in `ranges`, in
/// double precision.
///
/// # Errors
/// The reason for the missing bound of a rate.
pub fn bound_rates(program: &Program, ranges: &Ranges) -> Result<Vec<f64>, String> {
    let bounds = bound_all(program, quantities::rates(program), Format::Double, ranges);
    bounds.into_iter().map(|bounded| bounded.bound).collect()
}

fn bound_all(
    program: &Program,
    quantities: Vec<Quantity>,
    format: Format,
    ranges: &Ranges,
) -> Vec<RoundingBound> {
    let roots: Vec<_> = quantities.iter().map(|quantity| quantity.value).collect();
    let scalars = Scalars::record(program, &roots, format);
    let bound = |quantity: &Quantity| {
        let root = scalars.element(program, quantity.value, quantity.index);
        let bound = bound_root(&scalars, root, ranges);
        bound.map_err(|obstacle| obstacle.describe(program, &scalars))
    };
    let bounds = quantities.into_iter().map(|quantity| RoundingBound {
        bound: bound(&quantity),
        quantity,
        format,
    });
    bounds.collect()
}
