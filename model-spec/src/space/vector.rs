//! Vectors of three expressions along the axes of one frame.

use super::scalar::{add, is_literal, is_plain, multiply, negate, number, zero_times};
use crate::ast::Syntax;
use crate::span::Span;

pub type Vector = [Syntax; 3];

/// Components of the fixed axes x, y and z along a frame's axes: the rows of the rotation
/// matrix from the frame's axes to the fixed axes.
pub type Rows = [Vector; 3];

/// Suffixes of the axes in names.
pub const AXES: [&str; 3] = ["x", "y", "z"];

pub fn zero(span: Span) -> Vector {
    [0, 1, 2].map(|_| number(0.0, span))
}

/// Returns a component for use as a scalar. A component that is 0 is replaced by 0 times another component, to keep
/// the unit.
pub fn component(vector: &Vector, axis: usize) -> Syntax {
    let own = &vector[axis];
    let other = vector
        .iter()
        .find(|other| is_plain(other) && !is_literal(other, 0.0));
    match other {
        Some(other) if is_literal(own, 0.0) => zero_times(other, own.span),
        _ => own.clone(),
    }
}

pub fn sum([ax, ay, az]: Vector, [bx, by, bz]: Vector) -> Vector {
    [add(ax, bx), add(ay, by), add(az, bz)]
}

pub fn scale(vector: &Vector, by: &Syntax) -> Vector {
    vector
        .clone()
        .map(|component| multiply(by.clone(), component))
}

pub fn cross([ax, ay, az]: &Vector, [bx, by, bz]: &Vector) -> Vector {
    let minor = |a: &Syntax, d: &Syntax, c: &Syntax, b: &Syntax| {
        let left = multiply(a.clone(), d.clone());
        add(left, negate(multiply(c.clone(), b.clone())))
    };
    [
        minor(ay, bz, az, by),
        minor(az, bx, ax, bz),
        minor(ax, by, ay, bx),
    ]
}

pub fn inner([ax, ay, az]: &Vector, [bx, by, bz]: &Vector) -> Syntax {
    let product = |a: &Syntax, b: &Syntax| multiply(a.clone(), b.clone());
    add(add(product(ax, bx), product(ay, by)), product(az, bz))
}

/// Rotates a vector from a frame's axes to the fixed axes.
pub fn rotate(rows: &Rows, vector: &Vector) -> Vector {
    [0, 1, 2].map(|axis| inner(&rows[axis], vector))
}
