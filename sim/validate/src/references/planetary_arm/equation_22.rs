//! Coefficients of Eq. (22) with the names of the paper, for any truncation order S, corrected
//! where the printed ones contradict the mechanics of the paper.
//!
//! The paper numbers columns for S = 4: a_31 .. a_34 are for modes and a_35 .. a_38 for meshes. Here the columns of the
//! modes are an array of S entries. The columns of the meshes keep the names that they have at S = 4.

use super::mesh::{f_c, f_k};
use super::mode_shapes::ModeShape;
use super::parameters::PlanetaryArmParameters;
use crate::references::evaluation::{Evaluation, Row};

/// Coefficients of Eq. (22) in physical units.
#[derive(Clone, Debug, PartialEq)]
pub struct Coefficients {
    /// (I_c + 3 m_p r_c^2 + I_arm)/(r_c cos alpha), kg m.
    pub a_01: f64,
    /// a_02 .. a_0(S+1): rho A int x phi_i dx/(r_c cos alpha), kg.
    pub a_0: Vec<f64>,
    /// Constant part of a_11: a_m/(r_s M_s), m/s^2.
    pub a_11_constant: f64,
    /// Amplitude of the fluctuation of a_11: F_w/(r_s M_s), m/s^2.
    pub a_11_amplitude: f64,
    /// -B_m/M_s, 1/s, on x_sp' and on x_pr'.
    pub a_12: f64,
    /// 2 a_12, 1/s, on x_c'.
    pub a_13: f64,
    /// -(3/M_s + 1/M_p + 3 r_c cos alpha/a_30) k_sp, 1/s^2, on f_k(x_sp).
    pub a_14: f64,
    /// a_14 c_sp/k_sp, 1/s, on f_c(x_sp).
    pub a_15: f64,
    /// -(-1/M_p + 3 r_c cos alpha/a_30) k_pr, 1/s^2, on f_k(x_pr).
    pub a_16: f64,
    /// a_16 c_pr/k_pr, 1/s, on f_c(x_pr).
    pub a_17: f64,
    /// a_18 .. a_111 (at S = 4): -a_3i/a_30, 1/s^2, on q_i in rows 1 and 2.
    pub a_18: Vec<f64>,
    /// (1/M_p - 3 r_c cos alpha/a_30) k_sp, 1/s^2, on f_k(x_sp).
    pub a_21: f64,
    /// a_21 c_sp/k_sp, 1/s, on f_c(x_sp).
    pub a_22: f64,
    /// -(1/M_p + 3 r_c cos alpha/a_30) k_pr, 1/s^2, on f_k(x_pr).
    pub a_23: f64,
    /// a_23 c_pr/k_pr, 1/s, on f_c(x_pr).
    pub a_24: f64,
    /// a_01 - sum over i of (int x phi_i dx/int phi_i^2 dx) a_0(i+1), kg m.
    pub a_30: f64,
    /// a_31 .. a_3S: rho A int x phi_i dx int EI phi_i''^2 dx/(rho A int phi_i^2 dx), N.
    pub a_3: Vec<f64>,
    /// 3 r_c cos(alpha) k_sp, N, on f_k(x_sp).
    pub a_35: f64,
    /// 3 r_c cos(alpha) c_sp, N s, on f_c(x_sp).
    pub a_36: f64,
    /// 3 r_c cos(alpha) k_pr, N, on f_k(x_pr).
    pub a_37: f64,
    /// 3 r_c cos(alpha) c_pr, N s, on f_c(x_pr).
    pub a_38: f64,
    /// Rows of the modes: a_40 .. a_48 is `modes[0]`, a_50 .. a_58 `modes[1]`, ...
    pub modes: Vec<ModeRow>,
    /// Half of the backlash between sun and planet, m.
    pub b_sp: f64,
    /// Half of the backlash between planet and ring, m.
    pub b_pr: f64,
    /// Angular frequency of the motor fluctuation, rad/s.
    pub omega: f64,
}

/// Row of mode i of Eq. (22): a_(3+i)0 .. a_(3+i)8 at S = 4.
#[derive(Clone, Debug, PartialEq)]
pub struct ModeRow {
    /// a_(3+i)0 = a_30 rho A int phi_i^2 dx, kg^2 m, on q_i''.
    pub a_0: f64,
    /// a_(3+i)1 .. a_(3+i)S, on q_1 .. q_S: -a_0(i+1) a_3j, and on q_i itself
    /// -a_30 int EI phi_i''^2 dx - a_0(i+1) a_3i.
    pub a: Vec<f64>,
    /// a_(3+i)5 = -a_0(i+1) a_35, on f_k(x_sp).
    pub a_5: f64,
    /// a_(3+i)6 = -a_0(i+1) a_36, on f_c(x_sp).
    pub a_6: f64,
    /// a_(3+i)7 = -a_0(i+1) a_37, on f_k(x_pr).
    pub a_7: f64,
    /// a_(3+i)8 = -a_0(i+1) a_38, on f_c(x_pr).
    pub a_8: f64,
}

/// Integrals over one mode of the uniform arm, with units.
struct ArmMode {
    /// rho A int x phi dx, kg m.
    h: f64,
    /// rho A int phi^2 dx, kg.
    mass: f64,
    /// int EI phi''^2 dx, N/m.
    stiffness: f64,
}

impl ArmMode {
    fn new(parameters: &PlanetaryArmParameters, r: usize) -> Self {
        let integrals = ModeShape::clamped_free(r).integrals();
        let PlanetaryArmParameters {
            rho,
            A: area,
            l,
            E: modulus,
            I: second_moment,
            ..
        } = *parameters;
        Self {
            h: rho * area * l * l * integrals.s_phi,
            mass: rho * area * l * integrals.phi_squared,
            stiffness: modulus * second_moment / l.powi(3) * integrals.curvature_squared,
        }
    }
}

impl Coefficients {
    /// Computes the coefficients for truncation order `order`, 0 for the rigid arm.
    pub fn new(parameters: &PlanetaryArmParameters, order: usize) -> Self {
        let PlanetaryArmParameters {
            k_sp,
            k_pr,
            c_sp,
            c_pr,
            ..
        } = *parameters;
        let r_s = parameters.r_s();
        let r_c_cos_alpha = parameters.r_c_cos_alpha();
        let m_s = parameters.I_s / r_s.powi(2);
        let m_p = parameters.I_p / parameters.r_p().powi(2);
        let arm: Vec<ArmMode> = (1..=order).map(|r| ArmMode::new(parameters, r)).collect();

        let a_01 = parameters.I_tot() / r_c_cos_alpha;
        let a_0: Vec<f64> = arm.iter().map(|mode| mode.h / r_c_cos_alpha).collect();
        let coupling: f64 = arm
            .iter()
            .zip(&a_0)
            .map(|(mode, a)| mode.h / mode.mass * a)
            .sum();
        let a_30 = a_01 - coupling;
        let a_3: Vec<f64> = arm
            .iter()
            .map(|mode| mode.h * mode.stiffness / mode.mass)
            .collect();
        let carrier = 3.0 * r_c_cos_alpha / a_30;

        let a_12 = -parameters.b_m / (r_s.powi(2) * m_s);
        let a_14 = -(3.0 / m_s + 1.0 / m_p + carrier) * k_sp;
        let a_16 = -(-1.0 / m_p + carrier) * k_pr;
        let a_21 = (1.0 / m_p - carrier) * k_sp;
        let a_23 = -(1.0 / m_p + carrier) * k_pr;
        let mut coefficients = Self {
            a_01,
            a_11_constant: parameters.a_m / (r_s * m_s),
            a_11_amplitude: parameters.F_w / (r_s * m_s),
            a_12,
            a_13: 2.0 * a_12,
            a_14,
            a_15: a_14 / k_sp * c_sp,
            a_16,
            a_17: a_16 / k_pr * c_pr,
            a_18: a_3.iter().map(|a| -a / a_30).collect(),
            a_21,
            a_22: a_21 / k_sp * c_sp,
            a_23,
            a_24: a_23 / k_pr * c_pr,
            a_30,
            a_35: 3.0 * r_c_cos_alpha * k_sp,
            a_36: 3.0 * r_c_cos_alpha * c_sp,
            a_37: 3.0 * r_c_cos_alpha * k_pr,
            a_38: 3.0 * r_c_cos_alpha * c_pr,
            modes: Vec::with_capacity(order),
            b_sp: parameters.b_sp,
            b_pr: parameters.b_pr,
            omega: parameters.omega,
            a_0,
            a_3,
        };
        coefficients.modes = (0..order)
            .map(|i| coefficients.mode_row(i, &arm[i]))
            .collect();
        coefficients
    }

    fn mode_row(&self, i: usize, mode: &ArmMode) -> ModeRow {
        let a_0 = self.a_0[i];
        let mut a: Vec<f64> = self.a_3.iter().map(|a_3| -a_0 * a_3).collect();
        a[i] -= self.a_30 * mode.stiffness;
        ModeRow {
            a_0: self.a_30 * mode.mass,
            a,
            a_5: -a_0 * self.a_35,
            a_6: -a_0 * self.a_36,
            a_7: -a_0 * self.a_37,
            a_8: -a_0 * self.a_38,
        }
    }

    /// Returns the truncation order S.
    pub fn order(&self) -> usize {
        self.modes.len()
    }

    /// Returns a_11 at time `t` (s): A_m(t)/M_s, m/s^2.
    pub fn a_11(&self, t: f64) -> f64 {
        self.a_11_constant + self.a_11_fluctuation(t)
    }

    fn a_11_fluctuation(&self, t: f64) -> f64 {
        self.a_11_amplitude * eomgen_elementary::sin(self.omega * t)
    }

    /// Evaluates the accelerations of x_sp, x_pr, x_c, q_1 .. q_S (m/s^2) at time `t` (s) and
    /// `state` (the same coordinates in m, then their rates in m/s), with row scales. Returns
    /// `None` if the state does not have 2 (3 + S) entries.
    pub fn evaluate(&self, t: f64, state: &[f64]) -> Option<Evaluation> {
        let coordinates = 3 + self.order();
        if state.len() != 2 * coordinates {
            return None;
        }
        let (position, rate) = state.split_at(coordinates);
        let (meshes, q) = position.split_at(3);
        let terms = MeshTerms::new(self, meshes, rate);

        let mut sp = Row::new();
        sp.add(self.a_11_constant);
        sp.add(self.a_11_fluctuation(t));
        sp.add(self.a_12 * rate[0]);
        sp.add(self.a_12 * rate[1]);
        sp.add(self.a_13 * rate[2]);
        terms.add_to(&mut sp, [self.a_14, self.a_15, self.a_16, self.a_17], 1.0);
        add_modes(&mut sp, &self.a_18, q, 1.0);

        let mut pr = Row::new();
        terms.add_to(&mut pr, [self.a_21, self.a_22, self.a_23, self.a_24], 1.0);
        add_modes(&mut pr, &self.a_18, q, 1.0);

        let mut carrier = Row::new();
        add_modes(&mut carrier, &self.a_3, q, self.a_30);
        terms.add_to(
            &mut carrier,
            [self.a_35, self.a_36, self.a_37, self.a_38],
            self.a_30,
        );

        let modes = self.modes.iter().map(|mode| {
            let mut row = Row::new();
            add_modes(&mut row, &mode.a, q, mode.a_0);
            terms.add_to(&mut row, [mode.a_5, mode.a_6, mode.a_7, mode.a_8], mode.a_0);
            row
        });
        Some(Evaluation::from_rows(
            [sp, pr, carrier].into_iter().chain(modes),
        ))
    }
}

/// f_k(x_sp), f_c(x_sp), f_k(x_pr), f_c(x_pr).
struct MeshTerms([f64; 4]);

impl MeshTerms {
    fn new(coefficients: &Coefficients, position: &[f64], rate: &[f64]) -> Self {
        let Coefficients { b_sp, b_pr, .. } = *coefficients;
        Self([
            f_k(position[0], b_sp),
            f_c(position[0], rate[0], b_sp),
            f_k(position[1], b_pr),
            f_c(position[1], rate[1], b_pr),
        ])
    }

    fn add_to(&self, row: &mut Row, coefficients: [f64; 4], divisor: f64) {
        for (term, coefficient) in self.0.iter().zip(coefficients) {
            row.add(coefficient / divisor * term);
        }
    }
}

fn add_modes(row: &mut Row, coefficients: &[f64], q: &[f64], divisor: f64) {
    for (coefficient, q) in coefficients.iter().zip(q) {
        row.add(coefficient / divisor * q);
    }
}
