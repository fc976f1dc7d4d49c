//! Rigid arm in the angles of its shafts: Eq. (10) with Eq. (6), (9) and (11).
//!
//! Equations are residuals (left side minus right side, N m). Mesh deflections computed from angles lose digits; use
//! [`super::equation_12`] for simulation.

use super::mesh::{f_c, f_k};
use super::parameters::PlanetaryArmParameters;
use crate::references::evaluation::{Row, relative};

/// Angles of sun, planet and carrier with their first two derivatives (rad, s).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShaftMotion {
    /// theta_s, theta_p, theta_c.
    pub angle: [f64; 3],
    /// Rates of the angles.
    pub rate: [f64; 3],
    /// Accelerations of the angles.
    pub acceleration: [f64; 3],
}

/// Residuals of Eq. (10): the torque on each inertia, N m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residuals {
    /// Left side minus right side of the three rows.
    pub residual: [f64; 3],
    /// Largest term of each row, the scale of its rounding.
    pub scale: [f64; 3],
}

impl Residuals {
    /// Returns the largest residual relative to the scale of its row; infinite if one is NaN.
    pub fn worst(&self) -> f64 {
        let rows = self.residual.iter().zip(&self.scale);
        rows.map(|(residual, scale)| relative(*residual, *scale))
            .fold(0.0, f64::max)
    }
}

/// Evaluates the corrected Eq. (10): the sun is loaded only by its own mesh, the carrier by the sum of both meshes, and
/// the third row contains the acceleration of the carrier.
pub fn corrected_residuals(
    parameters: &PlanetaryArmParameters,
    t: f64,
    motion: &ShaftMotion,
) -> Residuals {
    let (f_sp, f_pr) = mesh_forces(parameters, motion);
    let acceleration = motion.acceleration;
    rows([
        &[
            parameters.I_s * acceleration[0],
            3.0 * f_sp * parameters.r_s(),
            -parameters.a_m,
            -parameters.torque_fluctuation(t),
            parameters.b_m * motion.rate[0],
        ],
        &[
            parameters.I_p * acceleration[1],
            -f_sp * parameters.r_p(),
            f_pr * parameters.r_p(),
        ],
        &[
            parameters.I_tot() * acceleration[2],
            -3.0 * f_sp * parameters.r_c_cos_alpha(),
            -3.0 * f_pr * parameters.r_c_cos_alpha(),
        ],
    ])
}

/// Computes F_ksp + F_csp and F_kpr + F_cpr of Eq. (6) and (9), N.
fn mesh_forces(parameters: &PlanetaryArmParameters, motion: &ShaftMotion) -> (f64, f64) {
    let deflections = |[theta_s, theta_p, theta_c]: [f64; 3]| {
        let x_s = parameters.r_s() * theta_s;
        let x_p = parameters.r_p() * theta_p;
        let x_c = parameters.r_c_cos_alpha() * theta_c;
        (x_s - x_p - x_c, x_p - x_c)
    };
    let (x_sp, x_pr) = deflections(motion.angle);
    let (x_sp_dot, x_pr_dot) = deflections(motion.rate);
    let PlanetaryArmParameters {
        k_sp,
        k_pr,
        c_sp,
        c_pr,
        b_sp,
        b_pr,
        ..
    } = *parameters;
    (
        k_sp * f_k(x_sp, b_sp) + c_sp * f_c(x_sp, x_sp_dot, b_sp),
        k_pr * f_k(x_pr, b_pr) + c_pr * f_c(x_pr, x_pr_dot, b_pr),
    )
}

/// Sums the terms of each row and keeps the largest.
fn rows(terms: [&[f64]; 3]) -> Residuals {
    let rows = terms.map(|terms| {
        let mut row = Row::new();
        terms.iter().for_each(|term| row.add(*term));
        row
    });
    Residuals {
        residual: rows.map(|row| row.sum()),
        scale: rows.map(|row| row.largest()),
    }
}
