//! Rigid arm in mesh deflections: Eq. (12), corrected.
//!
//! The state is x_sp, x_pr, x_c (m) and their rates (m/s).

use super::mesh::{f_c, f_k};
use super::parameters::PlanetaryArmParameters;
use crate::references::evaluation::{Evaluation, Row};

/// Equivalent masses and factors that the paper lists below Eq. (12).
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(non_snake_case, reason = "names as in the paper")]
pub struct EquivalentMasses {
    /// I_s/r_s^2, kg.
    pub M_s: f64,
    /// I_p/r_p^2, kg.
    pub M_p: f64,
    /// I_c/(r_c^2 cos^2 alpha), kg.
    pub M_c: f64,
    /// M_c' = M_c + 3 m_p/cos^2 alpha + I_arm/(r_c^2 cos^2 alpha), kg.
    pub M_c_prime: f64,
    /// M_s M_p M_c'/(3 M_p M_c' + M_s M_c' + 3 M_s M_p), kg.
    pub M_sp: f64,
    /// M_p M_c'/(3 M_p + M_c'), kg.
    pub M_pr: f64,
    /// (3 M_p - M_c')/(3 M_p + M_c').
    pub D: f64,
    /// (3 M_s M_p - M_s M_c')/(3 M_p M_c' + M_s M_c' + 3 M_s M_p).
    pub B: f64,
    /// b_m/r_s^2, N s/m.
    pub B_m: f64,
}

#[allow(non_snake_case, reason = "names as in the paper")]
impl EquivalentMasses {
    /// Computes the masses and factors.
    pub fn new(parameters: &PlanetaryArmParameters) -> Self {
        let cos_squared = parameters.alpha.cos().powi(2);
        let r_c_squared = parameters.r_c().powi(2);
        let M_s = parameters.I_s / parameters.r_s().powi(2);
        let M_p = parameters.I_p / parameters.r_p().powi(2);
        let M_c = parameters.I_c / (r_c_squared * cos_squared);
        let M_c_prime = M_c
            + 3.0 * parameters.m_p / cos_squared
            + parameters.I_arm() / (r_c_squared * cos_squared);
        let common = 3.0 * M_p * M_c_prime + M_s * M_c_prime + 3.0 * M_s * M_p;
        Self {
            M_s,
            M_p,
            M_c,
            M_c_prime,
            M_sp: M_s * M_p * M_c_prime / common,
            M_pr: M_p * M_c_prime / (3.0 * M_p + M_c_prime),
            D: (3.0 * M_p - M_c_prime) / (3.0 * M_p + M_c_prime),
            B: (3.0 * M_s * M_p - M_s * M_c_prime) / common,
            B_m: parameters.b_m / parameters.r_s().powi(2),
        }
    }
}

/// Mesh forces of Eq. (6) and (9), N.
struct MeshForces {
    spring_sp: f64,
    damping_sp: f64,
    spring_pr: f64,
    damping_pr: f64,
}

impl MeshForces {
    fn new(parameters: &PlanetaryArmParameters, state: &[f64; 6]) -> Self {
        let [x_sp, x_pr, _, x_sp_dot, x_pr_dot, _] = *state;
        let PlanetaryArmParameters {
            k_sp,
            k_pr,
            c_sp,
            c_pr,
            b_sp,
            b_pr,
            ..
        } = *parameters;
        Self {
            spring_sp: k_sp * f_k(x_sp, b_sp),
            damping_sp: c_sp * f_c(x_sp, x_sp_dot, b_sp),
            spring_pr: k_pr * f_k(x_pr, b_pr),
            damping_pr: c_pr * f_c(x_pr, x_pr_dot, b_pr),
        }
    }
}

/// Evaluates the corrected Eq. (12): x_sp'', x_pr'', x_c'', m/s^2.
pub fn corrected_accelerations(
    parameters: &PlanetaryArmParameters,
    t: f64,
    state: &[f64; 6],
) -> Evaluation {
    let masses = EquivalentMasses::new(parameters);
    let forces = MeshForces::new(parameters, state);
    let [.., x_sp_dot, x_pr_dot, x_c_dot] = *state;
    let EquivalentMasses {
        M_s,
        M_sp,
        M_pr,
        D,
        B,
        B_m,
        ..
    } = masses;

    let mut sun = Row::new();
    sun.add(-forces.damping_sp / M_sp);
    sun.add(-B_m / M_s * x_sp_dot);
    sun.add(-B_m / M_s * x_pr_dot);
    sun.add(-2.0 * B_m / M_s * x_c_dot);
    sun.add(-B / M_sp * forces.damping_pr);
    sun.add(-forces.spring_sp / M_sp);
    sun.add(-B / M_sp * forces.spring_pr);
    sun.add(parameters.a_m / (parameters.r_s() * M_s));
    sun.add(parameters.torque_fluctuation(t) / (parameters.r_s() * M_s));

    let mut planet = Row::new();
    planet.add(-D / M_pr * forces.damping_sp);
    planet.add(-forces.damping_pr / M_pr);
    planet.add(-D / M_pr * forces.spring_sp);
    planet.add(-forces.spring_pr / M_pr);

    let mut carrier = Row::new();
    for force in [
        forces.damping_sp,
        forces.damping_pr,
        forces.spring_sp,
        forces.spring_pr,
    ] {
        carrier.add(3.0 / masses.M_c_prime * force);
    }

    Evaluation::from_rows([sun, planet, carrier])
}
