//! Vectors of three expressions along the axes of one frame.

use super::scalar::{add, is, is_plain, multiply, negate, number, zero_times};
use crate::ast::Syntax;
use crate::span::Span;

/// Components along x, y, z.
pub type Vector = [Syntax; 3];

/// The fixed axes x, y and z, each along a frame's axes: the rows of the matrix that turns
/// components along the frame into those along the fixed axes.
pub type Rows = [Vector; 3];

/// The axes, as names end.
pub const AXES: [&str; 3] = ["x", "y", "z"];

/// Zero.
pub fn zero(span: Span) -> Vector {
    [0, 1, 2].map(|_| number(0.0, span))
}

/// A component as a scalar by itself: one that is 0 keeps the unit of another, as 0 times that.
pub fn component(vector: &Vector, axis: usize) -> Syntax {
    let own = &vector[axis];
    let other = vector
        .iter()
        .find(|other| is_plain(other) && !is(other, 0.0));
    match other {
        Some(other) if is(own, 0.0) => zero_times(other, own.span),
        _ => own.clone(),
    }
}

/// `a + b`
pub fn sum([ax, ay, az]: Vector, [bx, by, bz]: Vector) -> Vector {
    [add(ax, bx), add(ay, by), add(az, bz)]
}

/// `by * a`
pub fn scaled(vector: &Vector, by: &Syntax) -> Vector {
    vector
        .clone()
        .map(|component| multiply(by.clone(), component))
}

/// The vector product.
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

/// The scalar product.
pub fn inner([ax, ay, az]: &Vector, [bx, by, bz]: &Vector) -> Syntax {
    let product = |a: &Syntax, b: &Syntax| multiply(a.clone(), b.clone());
    add(add(product(ax, bx), product(ay, by)), product(az, bz))
}

/// A vector along a frame's axes, along the fixed axes.
pub fn turned(rows: &Rows, vector: &Vector) -> Vector {
    [0, 1, 2].map(|axis| inner(&rows[axis], vector))
}
