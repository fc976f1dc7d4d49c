//! Hub-driven flexible beam with a tip mass: equations of motion, modal truncation order 2.
//!
//! Emitted by eomgen 0.1.0 from the specification `hub_beam_tip_mass` (SHA-256 5a673f0b14db7a31d38ef2c487e53a8e52ea6c332f254be714846748c9ef3b5e).
//! Do not edit: change the specification and generate again.
//!
//! State: theta, q_1, q_2, theta_dot, q_1_dot, q_2_dot.
//! All quantities are in SI units. Nothing here allocates, panics or needs the standard library.
#![no_std]
#![allow(non_snake_case)]
#![allow(clippy::all)]
#![forbid(unsafe_code)]

/// Modal truncation order of each field.
pub const ORDERS: [usize; 1] = [2];

/// Degrees of freedom: coordinates and modes.
pub const DEGREES_OF_FREEDOM: usize = 3;

/// Numbers in the state: coordinates, modes, and the rates of both.
pub const STATES: usize = 6;

/// Names of the state, in its order.
pub const STATE_NAMES: [&'static str; STATES] = [
    "theta",
    "q_1",
    "q_2",
    "theta_dot",
    "q_1_dot",
    "q_2_dot",
];

/// Numbers that [`observables`] returns.
pub const OBSERVABLES: usize = 4;

/// Names of the observables, in their order.
pub const OBSERVABLE_NAMES: [&'static str; OBSERVABLES] = [
    "tip",
    "tip_slope",
    "energy",
    "power",
];

/// Switching surfaces.
pub const GUARDS: usize = 0;

/// SHA-256 of the specification.
pub const SPECIFICATION_SHA256: &'static str = "5a673f0b14db7a31d38ef2c487e53a8e52ea6c332f254be714846748c9ef3b5e";

/// Version of the generator.
pub const GENERATOR_VERSION: &'static str = "0.1.0";

/// Parameters of the model. `Default` gives the specification's values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameters {
    /// inertia of the hub \[kg m^2]
    pub J_h: f64,
    /// density of the beam \[kg/m^3]
    pub rho: f64,
    /// section area: 30 mm by 3 mm \[m^2]
    pub A: f64,
    /// length of the beam \[m]
    pub l: f64,
    /// Young's modulus \[Pa]
    pub E: f64,
    /// second moment of area: 30 mm by 3 mm \[m^4]
    pub I: f64,
    /// mass of the tip \[kg]
    pub M_t: f64,
    /// inertia of the tip about its centre of mass \[kg m^2]
    pub J_t: f64,
    /// friction of the hub's bearing \[N m s]
    pub c: f64,
}
impl Default for Parameters {
    fn default() -> Self {
        Self {
            J_h: 0.05,
            rho: 2700.0,
            A: 9e-5,
            l: 1.0,
            E: 7e10,
            I: 6.75e-11,
            M_t: 0.1,
            J_t: 0.0001,
            c: 0.01,
        }
    }
}

/// Signals supplied at run time. `Default` gives zeros.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Inputs {
    /// torque on the hub \[N m]
    pub u: f64,
}

/// What depends on the parameters alone: prepare once, use in every call.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficients {
    /// `l`
    pub l: f64,
    /// `0.3333333333333333*rho*A*l*l*l`
    pub c_1: f64,
    /// `J_t*PHI_D1_AT_END/l`
    pub c_2: [f64; 2],
    /// `rho*A*l*l*INTEGRAL_S1_PHI + l*M_t*PHI_AT_END + J_t*PHI_D1_AT_END/l`
    pub M_theta_q: [f64; 2],
    /// `rho*A*l`
    pub c_3: f64,
    /// `1/pivot_theta`
    pub c_4: f64,
    /// `c`
    pub c: f64,
    /// `E*I*INTEGRAL_PHI_D2_SQUARED*M_theta_q/(rho*A*l*l*l*l*INTEGRAL_PHI_SQUARED)`
    pub c_5: [f64; 2],
    /// `M_t*E*I*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/(1.0 + M_t*sum_i(...*.../INT...`
    pub c_6: f64,
    /// `PHI_AT_END*INTEGRAL_PHI_D2_SQUARED/INTEGRAL_PHI_SQUARED`
    pub c_7: [f64; 2],
    /// `(M_t*sum_i(.../...)*(l*sum_i(...) + sum_i(...)/(...*l))*1/(1.0 + M_t*.../(...*l))/(rho*A*l) - (l*sum_i(INTEGRAL_S1_PHI*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)) - (s...`
    pub c_8: f64,
    /// `J_t*E*I*PHI_D1_AT_END*INTEGRAL_PHI_D2_SQUARED/(rho*A*l*l*l*l*l*l*INTEGRAL_PHI_SQUARED)`
    pub c_9: [f64; 2],
    /// `M_t*J_t*E*I*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*A*A*l*l*l*l*l*l*l)`
    pub c_10: f64,
    /// `rho*A*l*INTEGRAL_PHI_SQUARED`
    pub c_11: [f64; 2],
    /// `1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))*PHI_AT_END/(rho*A*l*INTEGRAL_PHI_SQUARED)`
    pub c_12: [f64; 2],
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + J_t*sum_i(.../...)/(rho*A*l*l*l) - (M_t*J_t*sum_i(...)*sum_i(...)*1/(1.0 + .../...)/(rho*rho*A...`
    pub c_13: f64,
    /// `(J_t*(l*sum_i(...*.../INTEGRAL_PHI_SQUARED) + sum_i(...*(...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))/(l*l) - (M_t*J_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)*(l*sum_i(......`
    pub c_14: f64,
    /// `M_t*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(...*... + .../l)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/pivot_theta`
    pub c_15: f64,
    /// `-(M_t*E*I/(rho*A*l*l*l*l))`
    pub c_16: f64,
    /// `1/(1.0 + J_t*sum_i(.../...)/(rho*A*l*l*l) - (M_t*J_t*sum_i(...)*sum_i(...)*1/(1.0 + .../...)/(rho*rho*A*A*l*l*l*l)))*PHI_D1_AT_END/(rho*A*l*INTEGRAL_PHI_SQUARED...`
    pub c_17: [f64; 2],
    /// `1/pivot_theta*(l*INTEGRAL_S1_PHI/INTEGRAL_PHI_SQUARED + (l*M_t*PHI_AT_END + J_t*PHI_D1_AT_END/l)/(rho*A*l*INTEGRAL_PHI_SQUARED))`
    pub c_18: [f64; 2],
    /// `-(E*I*INTEGRAL_PHI_D2_SQUARED/(rho*A*l*l*l*l*INTEGRAL_PHI_SQUARED))`
    pub c_19: [f64; 2],
    /// `J_h + 0.3333333333333333*rho*A*l*l*l + J_t + l*l*M_t`
    pub M_theta_theta: f64,
    /// `M_t*PHI_AT_END`
    pub c_20: [f64; 2],
    /// `PHI_D1_AT_END/l`
    pub c_21: [f64; 2],
    /// `1.0/l`
    pub c_22: f64,
    /// `0.5*J_h`
    pub c_23: f64,
    /// `2.0*rho*A*l*l`
    pub c_24: f64,
    /// `0.5*M_t`
    pub c_25: f64,
    /// `0.5*J_t`
    pub c_26: f64,
    /// `0.5*E*I/(l*l*l)`
    pub c_27: f64,
    /// Whether all prepared pivots of the mass matrix are positive and finite. If not, the mass matrix is not positive definite and the rates are not to be used.
    pub positive_definite: bool,
}
impl Coefficients {
    /// The coefficients of these parameters.
    pub fn prepare(parameters: &Parameters) -> Self {
        let J_h = parameters.J_h;
        let J_t = parameters.J_t;
        let rho = parameters.rho;
        let A = parameters.A;
        let l = parameters.l;
        let s_1 = l * l;
        let s_2 = l * s_1;
        let s_3 = 0.3333333333333333 * rho * A * s_2;
        let M_t = parameters.M_t;
        let s_4 = s_1 * M_t;
        let s_5 = rho * A;
        let s_6 = s_5 * s_1;
        let s_7 = l * M_t;
        let mut s_8 = [0.0; 2];
        for i in 0..2 {
            s_8[i] = J_t * PHI_D1_AT_END[i] / l;
        }
        let mut s_9 = [0.0; 2];
        for i in 0..2 {
            s_9[i] = s_7 * PHI_AT_END[i] + s_8[i];
        }
        let mut M_theta_q = [0.0; 2];
        for i in 0..2 {
            M_theta_q[i] = s_6 * INTEGRAL_S1_PHI[i] + s_9[i];
        }
        let s_10 = sum_of_few(
            2,
            |i| INTEGRAL_S1_PHI[i] * M_theta_q[i] / INTEGRAL_PHI_SQUARED[i],
        );
        let s_11 = s_5 * l;
        let s_12 = sum_of_few(2, |i| s_9[i] * M_theta_q[i] / INTEGRAL_PHI_SQUARED[i]);
        let s_13 = sum_of_few(
            2,
            |i| INTEGRAL_S1_PHI[i] * PHI_AT_END[i] / INTEGRAL_PHI_SQUARED[i],
        );
        let s_14 = sum_of_few(2, |i| PHI_AT_END[i] * s_9[i] / INTEGRAL_PHI_SQUARED[i]);
        let s_15 = l * s_13 + s_14 / s_11;
        let s_16 = sum_of_few(
            2,
            |i| PHI_AT_END[i] * PHI_AT_END[i] / INTEGRAL_PHI_SQUARED[i],
        );
        let s_17 = 1.0 + M_t * s_16 / s_11;
        let s_18 = pivot_reciprocal(s_17);
        let s_19 = sum_of_few(
            2,
            |i| INTEGRAL_S1_PHI[i] * PHI_D1_AT_END[i] / INTEGRAL_PHI_SQUARED[i],
        );
        let s_20 = l * s_19;
        let s_21 = sum_of_few(
            2,
            |i| PHI_D1_AT_END[i] * s_9[i] / INTEGRAL_PHI_SQUARED[i],
        );
        let s_22 = s_21 / s_11;
        let s_23 = s_5 * s_2;
        let s_24 = M_t * J_t;
        let s_25 = sum_of_few(
            2,
            |i| PHI_AT_END[i] * PHI_D1_AT_END[i] / INTEGRAL_PHI_SQUARED[i],
        );
        let s_26 = J_t * (s_20 + s_22) / s_1 - s_24 * s_25 * s_15 * s_18 / s_23;
        let s_27 = M_t * s_25;
        let s_28 = s_27 * s_15 * s_18 / s_11 - s_20 - s_22;
        let s_29 = sum_of_few(
            2,
            |i| PHI_D1_AT_END[i] * PHI_D1_AT_END[i] / INTEGRAL_PHI_SQUARED[i],
        );
        let s_30 = rho * rho * (A * A);
        let s_31 = s_1 * s_1;
        let s_32 = 1.0 + J_t * s_29 / s_23 - s_24 * (s_25 * s_25) * s_18 / (s_30 * s_31);
        let s_33 = pivot_reciprocal(s_32);
        let s_34 = J_h + J_t + s_3 + s_4 + M_t * (s_15 * s_15) * s_18 - l * s_10;
        let pivot_theta = s_34 - s_12 / s_11 - s_26 * s_28 * s_33;
        let s_35 = pivot_reciprocal(pivot_theta);
        let c = parameters.c;
        let s_36 = s_5 * s_31;
        let E = parameters.E;
        let I = parameters.I;
        let s_37 = E * I;
        let mut s_38 = [0.0; 2];
        for i in 0..2 {
            s_38[i] = s_36 * INTEGRAL_PHI_SQUARED[i];
        }
        let mut s_39 = [0.0; 2];
        for i in 0..2 {
            s_39[i] = s_37 * INTEGRAL_PHI_D2_SQUARED[i];
        }
        let mut s_40 = [0.0; 2];
        for i in 0..2 {
            s_40[i] = s_39[i] * M_theta_q[i] / s_38[i];
        }
        let s_41 = M_t * E * I;
        let mut s_42 = [0.0; 2];
        for i in 0..2 {
            s_42[i] = PHI_AT_END[i] * INTEGRAL_PHI_D2_SQUARED[i]
                / INTEGRAL_PHI_SQUARED[i];
        }
        let s_43 = s_5 * (s_1 * s_31);
        let s_44 = J_t * E * I;
        let mut s_45 = [0.0; 2];
        for i in 0..2 {
            s_45[i] = s_44 * PHI_D1_AT_END[i] * INTEGRAL_PHI_D2_SQUARED[i]
                / (s_43 * INTEGRAL_PHI_SQUARED[i]);
        }
        let mut s_46 = [0.0; 2];
        for i in 0..2 {
            s_46[i] = s_11 * INTEGRAL_PHI_SQUARED[i];
        }
        let mut s_47 = [0.0; 2];
        for i in 0..2 {
            s_47[i] = s_18 * PHI_AT_END[i] / s_46[i];
        }
        let mut s_48 = [0.0; 2];
        for i in 0..2 {
            s_48[i] = s_33 * PHI_D1_AT_END[i] / s_46[i];
        }
        let mut s_49 = [0.0; 2];
        for i in 0..2 {
            s_49[i] = s_35
                * (l * INTEGRAL_S1_PHI[i] / INTEGRAL_PHI_SQUARED[i] + s_9[i] / s_46[i]);
        }
        let mut s_50 = [0.0; 2];
        for i in 0..2 {
            s_50[i] = -(s_39[i] / s_38[i]);
        }
        let M_theta_theta = J_h + s_3 + (J_t + s_4);
        let mut s_51 = [0.0; 2];
        for i in 0..2 {
            s_51[i] = M_t * PHI_AT_END[i];
        }
        let mut s_52 = [0.0; 2];
        for i in 0..2 {
            s_52[i] = PHI_D1_AT_END[i] / l;
        }
        let mut positive_4 = true;
        for i in 0..2 {
            positive_4 = positive_4 && s_46[i] > 0.0 && s_46[i] < f64::INFINITY;
        }
        Self {
            l: l,
            c_1: s_3,
            c_2: s_8,
            M_theta_q: M_theta_q,
            c_3: s_11,
            c_4: s_35,
            c: c,
            c_5: s_40,
            c_6: s_41 * s_15 * s_18 / s_36,
            c_7: s_42,
            c_8: s_28 * s_33,
            c_9: s_45,
            c_10: s_24 * E * I * s_25 * s_18 / (s_30 * (s_2 * s_31)),
            c_11: s_46,
            c_12: s_47,
            c_13: s_27 * s_33 / s_11,
            c_14: s_26 * s_35,
            c_15: M_t * s_15 * s_35,
            c_16: -(s_41 / s_36),
            c_17: s_48,
            c_18: s_49,
            c_19: s_50,
            M_theta_theta: M_theta_theta,
            c_20: s_51,
            c_21: s_52,
            c_22: 1.0 / l,
            c_23: 0.5 * J_h,
            c_24: 2.0 * rho * A * s_1,
            c_25: 0.5 * M_t,
            c_26: 0.5 * J_t,
            c_27: 0.5 * E * I / s_2,
            positive_definite: pivot_theta > 0.0 && pivot_theta < f64::INFINITY
                && s_17 > 0.0 && s_17 < f64::INFINITY && s_32 > 0.0
                && s_32 < f64::INFINITY && positive_4,
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
    let theta_dot = state[3];
    let u = inputs.u;
    let s_1 = sum_of_few(2, |i| coefficients.c_5[i] * state[1 + i]);
    let s_2 = sum_of_few(2, |i| coefficients.c_7[i] * state[1 + i]);
    let s_3 = sum_of_few(2, |i| coefficients.c_9[i] * state[1 + i]);
    let s_4 = coefficients.c_10 * s_2 - s_3;
    let s_5 = u + s_1 - coefficients.c * theta_dot - coefficients.c_6 * s_2
        - coefficients.c_8 * s_4;
    let theta_ddot = coefficients.c_4 * s_5;
    let s_6 = s_4 - coefficients.c_14 * s_5;
    let s_7 = coefficients.c_16 * s_2 - coefficients.c_13 * s_6
        - coefficients.c_15 * s_5;
    let mut rates = [0.0; STATES];
    for i in 0..1 {
        rates[i] = state[3 + i];
    }
    rates[3] = theta_ddot;
    for i in 0..2 {
        rates[1 + i] = state[4 + i];
        rates[4 + i] = coefficients.c_19[i] * state[1 + i] - coefficients.c_12[i] * s_7
            - coefficients.c_17[i] * s_6 - coefficients.c_18[i] * s_5;
    }
    rates
}

/// The observables, in the order of [`OBSERVABLE_NAMES`]:
///
/// - `tip`: deflection of the beam's end \[m]
/// - `tip_slope`: slope of the beam's end \[rad]
/// - `energy`: kinetic plus potential energy \[J]
/// - `power`: power of all non-conservative forces: the rate of the energy \[W]
#[allow(unused_variables)]
pub fn observables(
    t: f64,
    state: &[f64; STATES],
    inputs: &Inputs,
    coefficients: &Coefficients,
) -> [f64; OBSERVABLES] {
    let theta_dot = state[3];
    let u = inputs.u;
    let tip = sum_of_few(2, |i| PHI_AT_END[i] * state[1 + i]);
    let s_1 = sum_of_few(2, |i| PHI_D1_AT_END[i] * state[1 + i]);
    let tip_slope = coefficients.c_22 * s_1;
    let s_2 = theta_dot * theta_dot;
    let s_3 = sum_of_few(2, |i| INTEGRAL_S1_PHI[i] * state[4 + i]);
    let s_4 = sum_of_few(2, |i| INTEGRAL_PHI_SQUARED[i] * (state[4 + i] * state[4 + i]));
    let s_5 = sum_of_few(2, |i| PHI_AT_END[i] * state[4 + i]);
    let s_6 = coefficients.l * theta_dot + s_5;
    let s_7 = sum_of_few(2, |i| PHI_D1_AT_END[i] * state[4 + i]);
    let s_8 = theta_dot + coefficients.c_22 * s_7;
    let T_tip = coefficients.c_25 * (s_6 * s_6) + coefficients.c_26 * (s_8 * s_8);
    let s_9 = coefficients.c_23 * s_2
        + 0.5
            * (coefficients.c_1 * s_2 + coefficients.c_24 * (theta_dot * s_3)
                + coefficients.c_3 * s_4);
    let s_10 = sum_of_few(
        2,
        |i| INTEGRAL_PHI_D2_SQUARED[i] * (state[1 + i] * state[1 + i]),
    );
    let V_bending = coefficients.c_27 * s_10;
    [
        tip,
        tip_slope,
        s_9 + T_tip + V_bending,
        theta_dot * (u - coefficients.c * theta_dot),
    ]
}

/// Kinetic plus potential energy, in J.
#[allow(unused_variables)]
pub fn energy(
    t: f64,
    state: &[f64; STATES],
    inputs: &Inputs,
    coefficients: &Coefficients,
) -> f64 {
    let theta_dot = state[3];
    let s_1 = theta_dot * theta_dot;
    let s_2 = sum_of_few(2, |i| INTEGRAL_S1_PHI[i] * state[4 + i]);
    let s_3 = sum_of_few(2, |i| INTEGRAL_PHI_SQUARED[i] * (state[4 + i] * state[4 + i]));
    let s_4 = sum_of_few(2, |i| PHI_AT_END[i] * state[4 + i]);
    let s_5 = coefficients.l * theta_dot + s_4;
    let s_6 = sum_of_few(2, |i| PHI_D1_AT_END[i] * state[4 + i]);
    let s_7 = theta_dot + coefficients.c_22 * s_6;
    let T_tip = coefficients.c_25 * (s_5 * s_5) + coefficients.c_26 * (s_7 * s_7);
    let s_8 = coefficients.c_23 * s_1
        + 0.5
            * (coefficients.c_1 * s_1 + coefficients.c_24 * (theta_dot * s_2)
                + coefficients.c_3 * s_3);
    let s_9 = sum_of_few(
        2,
        |i| INTEGRAL_PHI_D2_SQUARED[i] * (state[1 + i] * state[1 + i]),
    );
    let V_bending = coefficients.c_27 * s_9;
    s_8 + T_tip + V_bending
}

/// Power of all non-conservative forces, in W: the rate of the energy.
#[allow(unused_variables)]
pub fn power(
    t: f64,
    state: &[f64; STATES],
    inputs: &Inputs,
    coefficients: &Coefficients,
) -> f64 {
    let theta_dot = state[3];
    let u = inputs.u;
    theta_dot * (u - coefficients.c * theta_dot)
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
    for i in 0..2 {
        values[0][1 + i] = coefficients.M_theta_q[i];
        values[1 + i][0] = values[0][1 + i];
    }
    for i in 0..2 {
        values[1 + i][1 + i] += coefficients.c_11[i];
        for j in 0..2 {
            values[1 + i][1 + j] += coefficients.c_20[i] * PHI_AT_END[j];
            values[1 + i][1 + j] += coefficients.c_2[i] * coefficients.c_21[j];
        }
    }
    values
}

/// int\[s phi_i], with s = x/l from 0 to 1 and primes for derivatives by s
static INTEGRAL_S1_PHI: [f64; 2] = [0.774866121708409, 0.08912096167893394];

/// int\[phi_i^2], with s = x/l from 0 to 1 and primes for derivatives by s
static INTEGRAL_PHI_SQUARED: [f64; 2] = [1.8556448472351015, 0.9640638644850398];

/// phi_i(1), with s = x/l from 0 to 1 and primes for derivatives by s
static PHI_AT_END: [f64; 2] = [2.7244411149702623, -1.9637350783494598];

/// phi_i'(1), with s = x/l from 0 to 1 and primes for derivatives by s
static PHI_D1_AT_END: [f64; 2] = [3.7502081374239222, -9.38818226594835];

/// int\[phi_i''^2], with s = x/l from 0 to 1 and primes for derivatives by s
static INTEGRAL_PHI_D2_SQUARED: [f64; 2] = [22.940155884082465, 468.07114845621095];

/// 1/pivot of a positive pivot; NaN where the mass matrix is not positive definite.
#[inline(always)]
fn pivot_reciprocal(pivot: f64) -> f64 {
    if pivot > 0.0 { 1.0 / pivot } else { f64::NAN }
}

/// The sum of the first `length` of eight numbers, neighbours added in pairs.
#[inline(always)]
fn paired(length: usize, s: &[f64; 8]) -> f64 {
    let a = if length > 1 { s[0] + s[1] } else { s[0] };
    let b = if length > 3 { s[2] + s[3] } else { s[2] };
    let c = if length > 5 { s[4] + s[5] } else { s[4] };
    let d = if length > 7 { s[6] + s[7] } else { s[6] };
    let left = if length > 2 { a + b } else { a };
    let right = if length > 6 { c + d } else { c };
    if length > 4 { left + right } else { left }
}

/// The sum of up to eight elements.
#[inline(always)]
fn sum_of_few<F: Fn(usize) -> f64>(length: usize, element: F) -> f64 {
    let mut s = [0.0; 8];
    for k in 0..length {
        s[k] = element(k);
    }
    paired(length, &s)
}
