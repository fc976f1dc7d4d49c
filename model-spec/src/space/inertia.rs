//! Whether a body can be: its mass is more than 0; the matrix of its inertia is positive
//! semidefinite, or no motion has its energy, and no principal moment exceeds the sum of the other
//! two, as follows from I_xx + I_yy - I_zz = 2 times the integral of z^2 over the mass.

use super::demands::Inertia;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::evaluate::evaluate;
use crate::model::Expr;

/// How far rounding of published numbers may carry a matrix beyond a limit, as a fraction of its
/// trace.
const ROUNDING: f64 = 1e-9;

/// How far errors of measurement may carry the principal moments beyond the triangle inequality,
/// as a fraction of the trace: those that Armstrong, Khatib and Burdick (1986) measured on the PUMA
/// 560 break it by 0.046.
const MEASURED: f64 = 0.05;

/// Checks masses and inertias at these values of the parameters: refuses a mass that is not more
/// than 0, an inertia that is not positive semidefinite and one that no mass distribution has.
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
                        .at(mass.span, "not more than 0")
                        .help("leave out `mass` where a body has inertia only"),
                );
                continue;
            }
        }
        let [xx, yy, zz] = [0, 1, 2].map(value);
        let [xy, yz, xz] = [3, 4, 5].map(value);
        let body = &inertia.body.text;
        let half_trace = (0.5 + MEASURED) * (xx + yy + zz);
        if !semidefinite([xx, yy, zz], [xy, yz, xz]) {
            found.push(
                Diagnostic::error(format!(
                    "the inertia of `{body}` is not positive semidefinite"
                ))
                .at(inertia.span, "some rotation has negative energy")
                .help("the order is I_xx, I_yy, I_zz, I_xy, I_yz, I_xz"),
            );
        } else if !semidefinite([xx, yy, zz].map(|own| half_trace - own), [-xy, -yz, -xz]) {
            found.push(
                Diagnostic::error(format!("no body has the inertia of `{body}`"))
                    .at(
                        inertia.span,
                        "a principal moment exceeds the sum of the other two",
                    )
                    .help("moments are about the centre of mass"),
            );
        }
    }
}

/// Whether all principal minors of a symmetric matrix are at least 0.
fn semidefinite([xx, yy, zz]: [f64; 3], [xy, yz, xz]: [f64; 3]) -> bool {
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
