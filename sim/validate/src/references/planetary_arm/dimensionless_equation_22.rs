//! Eq. (22) as a dimensionless right-hand side: each coefficient is divided once by the inertia and
//! the scales of its row; modes are loops; nothing is allocated.
//!
//! X = x/b_c, qbar = q/b_c and tau = omega_n t; derivatives are by tau. With omega_n = 1 rad/s and
//! b_c = 1 m the numbers are the physical ones.

use super::equation_22::Coefficients;
use super::mesh::{f_c, f_k};
use super::parameters::PlanetaryArmParameters;

/// Coefficients of the four mesh terms of one row.
#[derive(Clone, Copy, Debug, PartialEq)]
struct MeshColumns {
    f_k_sp: f64,
    f_c_sp: f64,
    f_k_pr: f64,
    f_c_pr: f64,
}

/// Eq. (22) of order `S`, prepared for one set of parameters and scales.
#[derive(Clone, Debug, PartialEq)]
pub struct Equation22<const S: usize> {
    /// Constant part and amplitude of the fluctuation of a_11/(b_c omega_n^2).
    a_11: [f64; 2],
    /// omega/omega_n.
    omega: f64,
    /// b_sp/b_c and b_pr/b_c.
    half_width: [f64; 2],
    /// a_12/omega_n and a_13/omega_n.
    motor: [f64; 2],
    /// Coefficients of the mesh terms in the rows of X_sp, X_pr and X_c.
    mesh: [MeshColumns; 3],
    /// a_18 .. divided by omega_n^2: coefficients of qbar in rows 1 and 2.
    a_18: [f64; S],
    /// a_31 .. divided by a_30 omega_n^2: coefficients of qbar in row 3.
    a_3: [f64; S],
    /// Coefficients of qbar in the rows of the modes, stored by column for vectorisation over the rows.
    modes: [[f64; S]; S],
    /// Coefficients of the mesh terms in the rows of the modes, one array over the rows for each mesh term.
    modes_mesh: [[f64; S]; 4],
}

impl<const S: usize> Equation22<S> {
    /// Number of entries of the state: X_sp, X_pr, X_c, qbar_1 .. qbar_S, then their derivatives.
    pub const STATES: usize = 2 * (3 + S);

    /// Prepares the equation for `parameters`, `omega_n` in rad/s and `b_c` in m.
    pub fn new(parameters: &PlanetaryArmParameters, omega_n: f64, b_c: f64) -> Self {
        let a = Coefficients::new(parameters, S);
        let stiffness = 1.0 / (omega_n * omega_n);
        let damping = 1.0 / omega_n;
        let columns = |inertia: f64, [f_k_sp, f_c_sp, f_k_pr, f_c_pr]: [f64; 4]| MeshColumns {
            f_k_sp: f_k_sp * stiffness / inertia,
            f_c_sp: f_c_sp * damping / inertia,
            f_k_pr: f_k_pr * stiffness / inertia,
            f_c_pr: f_c_pr * damping / inertia,
        };
        let row = |i: usize| &a.modes[i];
        Self {
            a_11: [a.a_11_constant, a.a_11_amplitude].map(|part| part * stiffness / b_c),
            omega: a.omega / omega_n,
            half_width: [a.b_sp / b_c, a.b_pr / b_c],
            motor: [a.a_12 * damping, a.a_13 * damping],
            mesh: [
                columns(1.0, [a.a_14, a.a_15, a.a_16, a.a_17]),
                columns(1.0, [a.a_21, a.a_22, a.a_23, a.a_24]),
                columns(a.a_30, [a.a_35, a.a_36, a.a_37, a.a_38]),
            ],
            a_18: std::array::from_fn(|i| a.a_18[i] * stiffness),
            a_3: std::array::from_fn(|i| a.a_3[i] * stiffness / a.a_30),
            modes: std::array::from_fn(|column| {
                std::array::from_fn(|i| row(i).a[column] * stiffness / row(i).a_0)
            }),
            modes_mesh: [
                std::array::from_fn(|i| row(i).a_5 * stiffness / row(i).a_0),
                std::array::from_fn(|i| row(i).a_6 * damping / row(i).a_0),
                std::array::from_fn(|i| row(i).a_7 * stiffness / row(i).a_0),
                std::array::from_fn(|i| row(i).a_8 * damping / row(i).a_0),
            ],
        }
    }

    /// Writes the derivative of `state` by tau to `out`.
    ///
    /// # Panics
    ///
    /// If `state` or `out` does not have [`Self::STATES`] entries.
    #[inline]
    pub fn rates(&self, tau: f64, state: &[f64], out: &mut [f64]) {
        assert_eq!(state.len(), Self::STATES);
        assert_eq!(out.len(), Self::STATES);
        let (position, rate) = state.split_at(3 + S);
        let (out_position, acceleration) = out.split_at_mut(3 + S);
        out_position.copy_from_slice(rate);

        let q: [f64; S] = std::array::from_fn(|i| position[3 + i]);
        let mesh = [
            f_k(position[0], self.half_width[0]),
            f_c(position[0], rate[0], self.half_width[0]),
            f_k(position[1], self.half_width[1]),
            f_c(position[1], rate[1], self.half_width[1]),
        ];
        let a_11 = self.a_11[0] + self.a_11[1] * eomgen_elementary::sin(self.omega * tau);
        let motor = self.motor[0] * rate[0] + self.motor[0] * rate[1] + self.motor[1] * rate[2];
        let bending = dot(&self.a_18, &q);
        acceleration[0] = a_11 + motor + self.mesh[0].on(&mesh) + bending;
        acceleration[1] = self.mesh[1].on(&mesh) + bending;
        acceleration[2] = dot(&self.a_3, &q) + self.mesh[2].on(&mesh);
        acceleration[3..].copy_from_slice(&self.mode_rows(&q, &mesh));
    }

    /// Computes the rows of the modes (a_40 ..), each divided by its inertia.
    #[inline]
    fn mode_rows(&self, q: &[f64; S], mesh: &[f64; 4]) -> [f64; S] {
        let mut rows = [0.0; S];
        for (column, q) in self.modes.iter().zip(q) {
            for (row, a) in rows.iter_mut().zip(column) {
                *row += a * q;
            }
        }
        for (column, term) in self.modes_mesh.iter().zip(mesh) {
            for (row, a) in rows.iter_mut().zip(column) {
                *row += a * term;
            }
        }
        rows
    }
}

impl MeshColumns {
    #[inline]
    fn on(&self, mesh: &[f64; 4]) -> f64 {
        self.f_k_sp * mesh[0]
            + self.f_c_sp * mesh[1]
            + self.f_k_pr * mesh[2]
            + self.f_c_pr * mesh[3]
    }
}

/// Computes the dot product in four partial sums, which avoids a single dependent chain of additions.
#[inline]
fn dot<const S: usize>(a: &[f64; S], b: &[f64; S]) -> f64 {
    let mut partial = [0.0; 4];
    let (a_lanes, a_rest) = a.as_chunks::<4>();
    let (b_lanes, b_rest) = b.as_chunks::<4>();
    for (a, b) in a_lanes.iter().zip(b_lanes) {
        for lane in 0..4 {
            partial[lane] += a[lane] * b[lane];
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    (partial[0] + partial[1]) + (partial[2] + partial[3]) + rest
}
