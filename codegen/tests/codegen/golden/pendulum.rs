//! Pendulum arm with viscous friction: equations of motion, rigid.
//!
//! Emitted by eomgen 0.1.0 from the specification `pendulum` (SHA-256 683b86cddda2f4c47ea60a0b1d58b7a99fa825a2631fbf37b000b9ac4c8c8694).
//! Do not edit: change the specification and generate again.
//!
//! State: theta, theta_dot.
//! All quantities are in SI units. Nothing here allocates, panics or needs the standard library.
#![no_std]
#![allow(non_snake_case)]
#![allow(clippy::all)]
#![forbid(unsafe_code)]

/// Modal truncation order of each field.
pub const ORDERS: [usize; 0] = [];

/// Degrees of freedom: coordinates and modes.
pub const DEGREES_OF_FREEDOM: usize = 1;

/// Numbers in the state: coordinates, modes, and the rates of both.
pub const STATES: usize = 2;

/// Names of the state, in its order.
pub const STATE_NAMES: [&'static str; STATES] = ["theta", "theta_dot"];

/// Numbers that [`observables`] returns.
pub const OBSERVABLES: usize = 2;

/// Names of the observables, in their order.
pub const OBSERVABLE_NAMES: [&'static str; OBSERVABLES] = ["energy", "power"];

/// Switching surfaces.
pub const GUARDS: usize = 0;

/// SHA-256 of the specification.
pub const SPECIFICATION_SHA256: &'static str = "683b86cddda2f4c47ea60a0b1d58b7a99fa825a2631fbf37b000b9ac4c8c8694";

/// Version of the generator.
pub const GENERATOR_VERSION: &'static str = "0.1.0";

/// Parameters of the model. `Default` gives the specification's values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameters {
    /// mass of the arm \[kg] (arXiv 2205.06231)
    pub m: f64,
    /// distance from pivot to centre of mass \[m] (arXiv 2205.06231)
    pub a: f64,
    /// inertia about the centre of mass \[kg m^2] (arXiv 2205.06231)
    pub I: f64,
    /// viscous friction in the pivot \[N m s] (arXiv 2205.06231)
    pub k: f64,
    /// gravity \[m/s^2]
    pub g: f64,
}
impl Default for Parameters {
    fn default() -> Self {
        Self {
            m: 0.14758,
            a: 0.14775,
            I: 0.0001091,
            k: 0.0002239,
            g: 9.81,
        }
    }
}

/// Signals supplied at run time. `Default` gives zeros.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Inputs {}

/// What depends on the parameters alone: prepare once, use in every call.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficients {
    /// `m*a*a + I`
    pub M_theta_theta: f64,
    /// `k*1/M_theta_theta`
    pub c_1: f64,
    /// `m*a*g`
    pub c_2: f64,
    /// `m*a*g*1/M_theta_theta`
    pub c_3: f64,
    /// `0.5*M_theta_theta`
    pub c_4: f64,
    /// `-k`
    pub c_5: f64,
    /// Whether all prepared pivots of the mass matrix are positive and finite. If not, the mass matrix is not positive definite and the rates are not to be used.
    pub positive_definite: bool,
}
impl Coefficients {
    /// The coefficients of these parameters.
    pub fn prepare(parameters: &Parameters) -> Self {
        let s_1 = parameters.k;
        let m = parameters.m;
        let a = parameters.a;
        let I = parameters.I;
        let M_theta_theta = m * (a * a) + I;
        let s_2 = pivot_reciprocal(M_theta_theta);
        let g = parameters.g;
        let s_3 = m * a * g;
        Self {
            M_theta_theta: M_theta_theta,
            c_1: s_1 * s_2,
            c_2: s_3,
            c_3: s_3 * s_2,
            c_4: 0.5 * M_theta_theta,
            c_5: -s_1,
            positive_definite: M_theta_theta > 0.0 && M_theta_theta < f64::INFINITY,
        }
    }
}

/// Rates of the state.
///
/// `t` in s; `state` and the result in the order of [`STATE_NAMES`].
#[allow(unused_variables)]
pub fn rates(
    t: f64,
    state: &[f64; STATES],
    inputs: &Inputs,
    coefficients: &Coefficients,
) -> [f64; STATES] {
    let theta_dot = state[1];
    let theta = state[0];
    let theta_ddot = coefficients.c_3 * sin(theta) - coefficients.c_1 * theta_dot;
    let mut rates = [0.0; STATES];
    for i in 0..1 {
        rates[i] = state[1 + i];
    }
    rates[1] = theta_ddot;
    rates
}

/// The observables, in the order of [`OBSERVABLE_NAMES`]:
///
/// - `energy`: kinetic plus potential energy \[J]
/// - `power`: power of all non-conservative forces: the rate of the energy \[W]
#[allow(unused_variables)]
pub fn observables(
    t: f64,
    state: &[f64; STATES],
    inputs: &Inputs,
    coefficients: &Coefficients,
) -> [f64; OBSERVABLES] {
    let theta_dot = state[1];
    let theta = state[0];
    let s_1 = theta_dot * theta_dot;
    let T_arm = coefficients.c_4 * s_1;
    let V_gravity = coefficients.c_2 * cos(theta);
    [T_arm + V_gravity, coefficients.c_5 * s_1]
}

/// Kinetic plus potential energy, in J.
#[allow(unused_variables)]
pub fn energy(
    t: f64,
    state: &[f64; STATES],
    inputs: &Inputs,
    coefficients: &Coefficients,
) -> f64 {
    let theta_dot = state[1];
    let theta = state[0];
    let T_arm = coefficients.c_4 * (theta_dot * theta_dot);
    let V_gravity = coefficients.c_2 * cos(theta);
    T_arm + V_gravity
}

/// Power of all non-conservative forces, in W: the rate of the energy.
#[allow(unused_variables)]
pub fn power(
    t: f64,
    state: &[f64; STATES],
    inputs: &Inputs,
    coefficients: &Coefficients,
) -> f64 {
    let theta_dot = state[1];
    coefficients.c_5 * (theta_dot * theta_dot)
}

/// Switching surfaces: the equations change where one of these changes sign.
///
#[allow(unused_variables, unused_mut)]
pub fn guards(
    t: f64,
    state: &[f64; STATES],
    inputs: &Inputs,
    coefficients: &Coefficients,
) -> [f64; GUARDS] {
    let mut values = [0.0; GUARDS];
    values
}

/// The mass matrix, in the order of the first half of [`STATE_NAMES`].
#[allow(unused_variables, unused_mut)]
pub fn mass_matrix(
    t: f64,
    state: &[f64; STATES],
    inputs: &Inputs,
    coefficients: &Coefficients,
) -> [[f64; DEGREES_OF_FREEDOM]; DEGREES_OF_FREEDOM] {
    let mut values = [[0.0; DEGREES_OF_FREEDOM]; DEGREES_OF_FREEDOM];
    values[0][0] = coefficients.M_theta_theta;
    values
}

/// 1/pivot of a positive pivot; NaN where the mass matrix is not positive definite.
#[inline(always)]
fn pivot_reciprocal(pivot: f64) -> f64 {
    if pivot > 0.0 { 1.0 / pivot } else { f64::NAN }
}

/// Sine for |x| up to 1e9, NaN beyond. Plain operations in a fixed order: the same bits on every machine.
#[inline]
fn sin(x: f64) -> f64 {
    let v6 = x * 0.6366197723675814 + 6.755399441055744e15 - 6.755399441055744e15;
    let v15 = x - v6 * 1.570796251296997 - v6 * 7.549789415861596e-8;
    let v16 = v6 * 5.390304224023659e-15;
    let v17 = v6 * -1.3658654267100645e-21;
    let v18 = v16 + v17;
    let v23 = v15 - v18;
    let v26 = v16 - v18 + v17 + v6 * -1.1351118607522202e-28 - (v15 - v23 - v18);
    let v27 = v23 * v23;
    let v29 = v27 * -0.5;
    let v30 = 1.0 + v29;
    let v46 = v27 * v27;
    let v49 = v46 * v46;
    let v51 = 0.1666666666666663 + v27 * -0.008333333333321917
        + v46 * (0.00019841269829458453 + v27 * -2.755731358278338e-6)
        + v49 * (2.5050742477852252e-8 + v27 * -1.5895956565664054e-10);
    let v70 = 0.041666666666666595 + v27 * -0.0013888888888873342
        + v46 * (2.4801587289001978e-5 + v27 * -2.755731421694031e-7)
        + v49 * (2.0875705319424642e-9 + v27 * -1.1358738323480003e-11);
    let v85 = if 1e9 < magnitude_of(x) {
        f64::NAN
    } else {
        v6 - (v6 * 0.25 + 6.755399441055744e15 - 6.755399441055744e15) * 4.0
    };
    let v87 = v30 + (1.0 - v30 + v29 + (v46 * v70 + v23 * v26));
    let v88 = magnitude_of(v85);
    let v92 = (if v88 == 1.0 { v87 } else { v23 - (v23 * v27 * v51 + v26 * v30) })
        * (if v88 == 1.0 { v85 } else { 1.0 - v88 });
    v92
}

/// Cosine for |x| up to 1e9, NaN beyond. Plain operations in a fixed order: the same bits on every machine.
#[inline]
fn cos(x: f64) -> f64 {
    let v6 = x * 0.6366197723675814 + 6.755399441055744e15 - 6.755399441055744e15;
    let v15 = x - v6 * 1.570796251296997 - v6 * 7.549789415861596e-8;
    let v16 = v6 * 5.390304224023659e-15;
    let v17 = v6 * -1.3658654267100645e-21;
    let v18 = v16 + v17;
    let v23 = v15 - v18;
    let v26 = v16 - v18 + v17 + v6 * -1.1351118607522202e-28 - (v15 - v23 - v18);
    let v27 = v23 * v23;
    let v29 = v27 * -0.5;
    let v30 = 1.0 + v29;
    let v46 = v27 * v27;
    let v49 = v46 * v46;
    let v51 = 0.1666666666666663 + v27 * -0.008333333333321917
        + v46 * (0.00019841269829458453 + v27 * -2.755731358278338e-6)
        + v49 * (2.5050742477852252e-8 + v27 * -1.5895956565664054e-10);
    let v70 = 0.041666666666666595 + v27 * -0.0013888888888873342
        + v46 * (2.4801587289001978e-5 + v27 * -2.755731421694031e-7)
        + v49 * (2.0875705319424642e-9 + v27 * -1.1358738323480003e-11);
    let v85 = if 1e9 < magnitude_of(x) {
        f64::NAN
    } else {
        v6 - (v6 * 0.25 + 6.755399441055744e15 - 6.755399441055744e15) * 4.0
    };
    let v87 = v30 + (1.0 - v30 + v29 + (v46 * v70 + v23 * v26));
    let v88 = magnitude_of(v85);
    let v93 = (if v88 == 1.0 { v23 - (v23 * v27 * v51 + v26 * v30) } else { v87 })
        * (if v88 == 1.0 { -v85 } else { 1.0 - v88 });
    v93
}

/// The sign bit cleared.
#[inline(always)]
fn magnitude_of(x: f64) -> f64 {
    f64::from_bits(x.to_bits() & !(1 << 63))
}
