//! Eq. (22), optimised by hand. The modes are eliminated first, because their block of the mass matrix is diagonal. One
//! division by a_30 remains, and every row needs O(S) operations. All coefficients are prepared once; nothing is
//! allocated.
//!
//! Generated code is compared with this code, which uses the coefficients of Eq. (22) and no code of the derivation.

use eomgen_validate::references::planetary_arm::equation_22::Coefficients;
use eomgen_validate::references::planetary_arm::mesh::{f_c, f_k};
use eomgen_validate::references::planetary_arm::parameters::PlanetaryArmParameters;

/// Largest number of modes summed without partial sums.
const MAX_UNSPLIT_MODES: usize = 8;

#[derive(Clone, Copy, Debug, PartialEq)]
struct Mesh {
    /// N/m
    stiffness: f64,
    /// N s/m
    damping: f64,
    /// m
    half_width: f64,
}

/// Arm of order `S`, prepared for one set of parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct EliminatedArm<const S: usize> {
    sun_planet: Mesh,
    planet_ring: Mesh,
    /// a_m/(r_s M_s), m/s^2
    motor: f64,
    /// F_w/(r_s M_s), m/s^2
    fluctuation: f64,
    /// rad/s
    omega: f64,
    /// B_m/M_s, 1/s
    motor_damping: f64,
    /// 3/M_s, 1/kg
    sun: f64,
    /// 1/M_p, 1/kg
    planet: f64,
    /// 3 r_c cos(alpha)/a_30, 1/kg: acceleration of the carrier per unit force.
    carrier: f64,
    /// a_3i/(3 r_c cos alpha), N/m: force of a mode at the carrier.
    bending: [f64; S],
    /// -k_i/m_i, 1/s^2
    minus_square: [f64; S],
    /// -h_i/(m_i r_c cos alpha) carrier, 1/kg
    minus_coupling: [f64; S],
}

impl Mesh {
    /// Computes the force of the mesh, N.
    #[inline(always)]
    fn force(&self, p: f64, p_dot: f64) -> f64 {
        self.stiffness * f_k(p, self.half_width) + self.damping * f_c(p, p_dot, self.half_width)
    }
}

impl<const S: usize> EliminatedArm<S> {
    /// Prepares the equations for `parameters`.
    pub fn new(parameters: &PlanetaryArmParameters) -> Self {
        let a = Coefficients::new(parameters, S);
        let lever = parameters.r_c_cos_alpha();
        let carrier = 3.0 * lever / a.a_30;
        let inertia = |i: usize| a.modes[i].a_0 / a.a_30;
        Self {
            sun_planet: Mesh {
                stiffness: parameters.k_sp,
                damping: parameters.c_sp,
                half_width: a.b_sp,
            },
            planet_ring: Mesh {
                stiffness: parameters.k_pr,
                damping: parameters.c_pr,
                half_width: a.b_pr,
            },
            motor: a.a_11_constant,
            fluctuation: a.a_11_amplitude,
            omega: a.omega,
            motor_damping: -a.a_12,
            sun: 3.0 * parameters.r_s().powi(2) / parameters.I_s,
            planet: parameters.r_p().powi(2) / parameters.I_p,
            carrier,
            bending: std::array::from_fn(|i| a.a_3[i] / (3.0 * lever)),
            minus_square: std::array::from_fn(|i| -a.a_3[i] / (a.a_0[i] * lever)),
            minus_coupling: std::array::from_fn(|i| -a.a_0[i] / inertia(i) * carrier),
        }
    }

    /// Returns all prepared numbers in the order of the fields, for the C version of these equations
    /// (`benches/c/by_hand.h`).
    pub fn prepared_numbers(&self) -> Vec<f64> {
        let mesh = |mesh: Mesh| [mesh.stiffness, mesh.damping, mesh.half_width];
        let scalars = [
            self.motor,
            self.fluctuation,
            self.omega,
            self.motor_damping,
            self.sun,
            self.planet,
            self.carrier,
        ];
        let modes = [self.bending, self.minus_square, self.minus_coupling];
        let meshes = mesh(self.sun_planet)
            .into_iter()
            .chain(mesh(self.planet_ring));
        meshes
            .chain(scalars)
            .chain(modes.into_iter().flatten())
            .collect()
    }

    /// Writes the rates of `state` (x_sp, x_pr, x_c, q_1 .. q_S in m, then their rates in m/s) at time `t` (s). The
    /// motor's sine is used last. The function is not inlined, like emitted functions in other crates.
    #[inline(never)]
    pub fn rates<const N: usize>(&self, t: f64, state: &[f64; N], rates: &mut [f64; N]) {
        const { assert!(N == 2 * (3 + S)) };
        let (position, rate) = state.split_at(3 + S);
        let (x, q) = position.split_at(3);
        let f_sp = self.sun_planet.force(x[0], rate[0]);
        let f_pr = self.planet_ring.force(x[1], rate[1]);
        let force = f_sp + f_pr + sum_of_products(&self.bending, q);
        let x_c = self.carrier * force;
        let x_pr = self.planet * (f_sp - f_pr) - x_c;
        let sun = self.motor
            - self.motor_damping * (rate[0] + rate[1] + 2.0 * rate[2])
            - self.sun * f_sp
            - x_pr
            - 2.0 * x_c;
        let x_sp = sun + self.fluctuation * eomgen_elementary::sin(self.omega * t);

        let (velocity, acceleration) = rates.split_at_mut(3 + S);
        copy_in_pairs(rate, velocity);
        acceleration[0] = x_sp;
        acceleration[1] = x_pr;
        acceleration[2] = x_c;
        for i in 0..S {
            acceleration[3 + i] = self.minus_square[i] * q[i] + self.minus_coupling[i] * force;
        }
    }
}

/// Copies numbers, two per iteration. The compiler replaces a simple loop by a call of `memcpy`,
/// which takes longer than the copy.
#[inline(always)]
pub fn copy_in_pairs(from: &[f64], to: &mut [f64]) {
    let length = from.len().min(to.len());
    for k in 0..length / 2 {
        to[2 * k] = from[2 * k];
        to[2 * k + 1] = from[2 * k + 1];
    }
    if length % 2 == 1 {
        to[length - 1] = from[length - 1];
    }
}

#[inline(always)]
fn sum_of_products<const S: usize>(a: &[f64; S], b: &[f64]) -> f64 {
    if S > MAX_UNSPLIT_MODES {
        return sum_in_blocks(a, b);
    }
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Computes the dot product in eight partial sums, which avoids a single dependent chain of additions. The two halves
/// are added, because adding neighbouring partial sums would make the compiler shuffle all factors. The function is not
/// inlined. Otherwise the compiler would vectorise across the surrounding loops and spill registers.
#[inline(never)]
fn sum_in_blocks(a: &[f64], b: &[f64]) -> f64 {
    let ((a_blocks, a_rest), (b_blocks, b_rest)) = (a.as_chunks::<8>(), b.as_chunks::<8>());
    let mut s = [0.0; 8];
    for (a, b) in a_blocks.iter().zip(b_blocks) {
        s = std::array::from_fn(|k| s[k] + a[k] * b[k]);
    }
    for (s, (a, b)) in s.iter_mut().zip(a_rest.iter().zip(b_rest)) {
        *s += a * b;
    }
    let quarters: [f64; 4] = std::array::from_fn(|k| s[k] + s[k + 4]);
    (quarters[0] + quarters[2]) + (quarters[1] + quarters[3])
}
