//! Chaplygin's sleigh. The edge is at the distance a behind the centre of mass. The force lambda perpendicular to the
//! edge gives m x'' = -lambda sin(theta), m y'' = lambda cos(theta), J theta'' = -a lambda. The constraint keeps the
//! velocity perpendicular to the edge, y' cos(theta) - x' sin(theta) - a theta', constant: lambda (1/m + a^2/J) =
//! theta' (x' cos(theta) + y' sin(theta)) (Neimark and Fufaev, *Dynamics of Nonholonomic Systems*, 1972). A
//! stabilisation rate w reduces the right side by 2 w times the perpendicular velocity.

use super::{NotApplicable, StateAndParameters};
use crate::references::evaluation::{Evaluation, Row};

pub fn accelerations(at: &StateAndParameters<'_>) -> Result<Evaluation, NotApplicable> {
    let [_, _, theta, x_dot, y_dot, theta_dot] = at.state else {
        return Err(NotApplicable::State(6));
    };
    let (m, inertia, a) = (at.required("m")?, at.required("J")?, at.required("a")?);
    let w = at.required("stabilisation_rate")?;
    let (sine, cosine) = theta.sin_cos();
    let compliance = 1.0 / m + a * a / inertia;
    let parts = [
        theta_dot * x_dot * cosine,
        theta_dot * y_dot * sine,
        -2.0 * w * y_dot * cosine,
        2.0 * w * x_dot * sine,
        2.0 * w * a * theta_dot,
    ];
    let row = |factor: f64| {
        let mut row = Row::new();
        parts
            .iter()
            .for_each(|part| row.add(factor * part / compliance));
        row
    };
    Ok(Evaluation::from_rows([
        row(-sine / m),
        row(cosine / m),
        row(-a / inertia),
    ]))
}
