//! Checks that the mass properties of a body are physically possible. Its mass is positive and its inertia matrix
//! positive semidefinite. No principal moment exceeds the sum of the other two, because I_xx + I_yy - I_zz is twice
//! the integral of z^2 over the mass.

use super::requirements::Inertia;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::evaluate::evaluate;
use crate::model::Expr;

/// Tolerance for the rounding of published inertia matrices, as a fraction of the trace.
const ROUNDING: f64 = 1e-9;

/// Tolerance of the triangle inequality for measured principal moments, as a fraction of the
/// trace. The moments of the PUMA 560 measured by Armstrong, Khatib and Burdick (1986) violate
/// it by 0.046.
const MEASUREMENT_TOLERANCE: f64 = 0.05;

/// Checks masses and inertias for these values of the parameters. Reports a mass that is not positive, an inertia
/// that is not positive semidefinite, and an inertia that no mass distribution has.
pub fn check(inertias: &[Inertia<Expr>], parameters: &[f64], found: &mut Diagnostics) {
    for inertia in inertias {
        let value = |index: usize| {
            let element = inertia.elements.get(index);
            element.map_or(0.0, |expr| evaluate(expr, parameters))
        };
        if let Some(mass) = &inertia.mass {
            let kilograms = evaluate(mass, parameters);
            if kilograms.is_nan() || kilograms <= 0.0 {
                let name = &inertia.body.text;
                found.push(
                    Diagnostic::error(format!("the mass of `{name}` is {kilograms} kg"))
                        .with_span(mass.span, "not greater than 0")
                        .with_help("remove `mass` if the body has only inertia"),
                );
                continue;
            }
        }
        let [xx, yy, zz] = [0, 1, 2].map(value);
        let [xy, yz, xz] = [3, 4, 5].map(value);
        let body = &inertia.body.text;
        let half_trace = (0.5 + MEASUREMENT_TOLERANCE) * (xx + yy + zz);
        if !is_positive_semidefinite([xx, yy, zz], [xy, yz, xz]) {
            found.push(
                Diagnostic::error(format!(
                    "the inertia of `{body}` is not positive semidefinite"
                ))
                .with_span(inertia.span, "some rotation has negative energy")
                .with_help("check the order: I_xx, I_yy, I_zz, I_xy, I_yz, I_xz"),
            );
        } else if !is_positive_semidefinite(
            [xx, yy, zz].map(|own| half_trace - own),
            [-xy, -yz, -xz],
        ) {
            found.push(
                Diagnostic::error(format!("no body has the inertia of `{body}`"))
                    .with_span(
                        inertia.span,
                        "a principal moment exceeds the sum of the other two",
                    )
                    .with_help("give the moments about the centre of mass"),
            );
        }
    }
}

/// Returns true if all principal minors of a symmetric matrix are at least 0, within rounding.
fn is_positive_semidefinite([xx, yy, zz]: [f64; 3], [xy, yz, xz]: [f64; 3]) -> bool {
    let scale = xx.abs().max(yy.abs()).max(zz.abs());
    let scale = scale.max(xy.abs()).max(yz.abs()).max(xz.abs());
    if scale == 0.0 {
        return true;
    }
    let [xx, yy, zz, xy, yz, xz] = [xx, yy, zz, xy, yz, xz].map(|element| element / scale);
    let determinant =
        xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
    let pairs = [xx * yy - xy * xy, yy * zz - yz * yz, xx * zz - xz * xz];
    let minors = [xx, yy, zz].into_iter().chain(pairs).chain([determinant]);
    minors.into_iter().all(|minor| minor >= -ROUNDING)
}
