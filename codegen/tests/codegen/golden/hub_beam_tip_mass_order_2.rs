//! Hub-driven flexible beam with a tip mass: equations of motion, modal truncation order 2.
//!
//! Emitted by eomgen 0.2.0 from the specification `hub_beam_tip_mass` (SHA-256 5a673f0b14db7a31d38ef2c487e53a8e52ea6c332f254be714846748c9ef3b5e).
//! Do not edit: change the specification and generate again.
//!
//! State: theta, q_1, q_2, theta_dot, q_1_dot, q_2_dot.
//! All quantities are in SI units. The code does not allocate, panic or use the standard library.
#![no_std]
#![allow(non_snake_case)]
#![allow(clippy::all)]
#![forbid(unsafe_code)]

/// Modal truncation order of each field.
pub const ORDERS: [usize; 1] = [2];

/// Number of degrees of freedom: coordinates and modes.
pub const DEGREES_OF_FREEDOM: usize = 3;

/// Number of states: coordinates, modes, and the rates of both.
pub const STATES: usize = 6;

/// Names of the states, in their order.
pub const STATE_NAMES: [&'static str; STATES] = [
    "theta",
    "q_1",
    "q_2",
    "theta_dot",
    "q_1_dot",
    "q_2_dot",
];

/// Number of observables.
pub const OBSERVABLES: usize = 4;

/// Names of the observables, in their order.
pub const OBSERVABLE_NAMES: [&'static str; OBSERVABLES] = [
    "tip",
    "tip_slope",
    "energy",
    "power",
];

/// Number of switching surfaces.
pub const GUARDS: usize = 0;

/// SHA-256 of the specification.
pub const SPECIFICATION_SHA256: &'static str = "5a673f0b14db7a31d38ef2c487e53a8e52ea6c332f254be714846748c9ef3b5e";

/// Version of the generator.
pub const GENERATOR_VERSION: &'static str = "0.2.0";

/// Number of inputs.
pub const INPUTS: usize = 1;

/// Names of the inputs, in their order.
pub const INPUT_NAMES: [&'static str; INPUTS] = ["u"];

/// Number of parameters.
pub const PARAMETERS: usize = 9;

/// Names of the parameters, in their order.
pub const PARAMETER_NAMES: [&'static str; PARAMETERS] = [
    "J_h",
    "rho",
    "A",
    "l",
    "E",
    "I",
    "M_t",
    "J_t",
    "c",
];

/// SI units of the states.
pub const STATE_UNITS: [&'static str; STATES] = ["rad", "m", "m", "rad/s", "m/s", "m/s"];

/// SI units of the inputs.
pub const INPUT_UNITS: [&'static str; INPUTS] = ["N m"];

/// SI units of the parameters.
pub const PARAMETER_UNITS: [&'static str; PARAMETERS] = [
    "kg m^2",
    "kg/m^3",
    "m^2",
    "m",
    "Pa",
    "m^4",
    "kg",
    "kg m^2",
    "N m s",
];

/// SI units of the observables.
pub const OBSERVABLE_UNITS: [&'static str; OBSERVABLES] = ["m", "rad", "J", "W"];

/// Initial state of the specification, at its parameters.
pub const INITIAL_STATE: [f64; STATES] = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0];

/// Lower ends of the ranges of the states, -infinity if the specification gives none.
pub const STATE_LOWER: [f64; STATES] = [
    f64::NEG_INFINITY,
    f64::NEG_INFINITY,
    f64::NEG_INFINITY,
    f64::NEG_INFINITY,
    f64::NEG_INFINITY,
    f64::NEG_INFINITY,
];

/// Upper ends of the ranges of the states, infinity if the specification gives none.
pub const STATE_UPPER: [f64; STATES] = [
    f64::INFINITY,
    f64::INFINITY,
    f64::INFINITY,
    f64::INFINITY,
    f64::INFINITY,
    f64::INFINITY,
];

/// Lower ends of the ranges of the inputs, -infinity if the specification gives none.
pub const INPUT_LOWER: [f64; INPUTS] = [f64::NEG_INFINITY];

/// Upper ends of the ranges of the inputs, infinity if the specification gives none.
pub const INPUT_UPPER: [f64; INPUTS] = [f64::INFINITY];

/// Indices of the states, and of their time derivatives in the rates.
#[allow(non_upper_case_globals)]
pub mod state {
    /// `theta`
    pub const THETA: usize = 0;
    /// `q_1`
    pub const Q_1: usize = 1;
    /// `q_2`
    pub const Q_2: usize = 2;
    /// `theta_dot`
    pub const THETA_DOT: usize = 3;
    /// `q_1_dot`
    pub const Q_1_DOT: usize = 4;
    /// `q_2_dot`
    pub const Q_2_DOT: usize = 5;
}

/// Indices of the inputs.
#[allow(non_upper_case_globals)]
pub mod input {
    /// `u`
    pub const U: usize = 0;
}

/// Indices of the parameters.
#[allow(non_upper_case_globals)]
pub mod parameter {
    /// `J_h`
    pub const J_H: usize = 0;
    /// `rho`
    pub const RHO: usize = 1;
    /// `A`
    pub const A: usize = 2;
    /// `l`
    pub const L: usize = 3;
    /// `E`
    pub const E: usize = 4;
    /// `I`
    pub const I: usize = 5;
    /// `M_t`
    pub const M_T: usize = 6;
    /// `J_t`
    pub const J_T: usize = 7;
    /// `c`
    pub const C: usize = 8;
}

/// Indices of the observables.
#[allow(non_upper_case_globals)]
pub mod observable {
    /// `tip`
    pub const TIP: usize = 0;
    /// `tip_slope`
    pub const TIP_SLOPE: usize = 1;
    /// `energy`
    pub const ENERGY: usize = 2;
    /// `power`
    pub const POWER: usize = 3;
}

/// Identity, for `eomgen identify`; `source` is the SHA-256 of this file without the line below.
pub static IDENTITY: [u8; 206] = *b"eomgen-identity name=hub_beam_tip_mass specification=5a673f0b14db7a31d38ef2c487e53a8e52ea6c332f254be714846748c9ef3b5e source=0fb784d69a5efb59d5721d5737b9ea828cbe0b286a23cb0156b1ec42c2e95344 generator=0.2.0;";

/// Parameters of the model. `Default` has the values of the specification.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameters<T = f64> {
    /// inertia of the hub \[kg m^2]
    pub J_h: T,
    /// density of the beam \[kg/m^3]
    pub rho: T,
    /// section area: 30 mm by 3 mm \[m^2]
    pub A: T,
    /// length of the beam \[m]
    pub l: T,
    /// Young's modulus \[Pa]
    pub E: T,
    /// second moment of area: 30 mm by 3 mm \[m^4]
    pub I: T,
    /// mass of the tip \[kg]
    pub M_t: T,
    /// inertia of the tip about its centre of mass \[kg m^2]
    pub J_t: T,
    /// friction of the hub's bearing \[N m s]
    pub c: T,
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
impl Parameters {
    /// Converts these parameters to another number type, without derivatives.
    #[inline(always)]
    pub fn cast<T: Scalar>(&self) -> Parameters<T> {
        Parameters {
            J_h: T::number(self.J_h),
            rho: T::number(self.rho),
            A: T::number(self.A),
            l: T::number(self.l),
            E: T::number(self.E),
            I: T::number(self.I),
            M_t: T::number(self.M_t),
            J_t: T::number(self.J_t),
            c: T::number(self.c),
        }
    }
}
impl<T: Copy> From<[T; PARAMETERS]> for Parameters<T> {
    fn from(numbers: [T; PARAMETERS]) -> Self {
        Self {
            J_h: numbers[0],
            rho: numbers[1],
            A: numbers[2],
            l: numbers[3],
            E: numbers[4],
            I: numbers[5],
            M_t: numbers[6],
            J_t: numbers[7],
            c: numbers[8],
        }
    }
}

/// Inputs at run time. `Default` is zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inputs<T = f64> {
    /// torque on the hub \[N m]
    pub u: T,
}
impl<T: Scalar> Default for Inputs<T> {
    fn default() -> Self {
        Self { u: T::number(0.0) }
    }
}
impl<T: Copy> From<[T; INPUTS]> for Inputs<T> {
    fn from(numbers: [T; INPUTS]) -> Self {
        Self { u: numbers[0] }
    }
}

/// Values that depend only on the parameters: prepare once, use in every call.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficients<T = f64> {
    /// `l`
    pub l: T,
    /// `0.3333333333333333*rho*A*l*l*l`
    pub c_yjjuw: T,
    /// `J_t*PHI_D1_AT_END/l`
    pub c_J_t_PHI_D1_AT_END_per_l: [T; 2],
    /// `rho*A*l*l*INTEGRAL_S1_PHI + l*M_t*PHI_AT_END + J_t*PHI_D1_AT_END/l`
    pub M_theta_q: [T; 2],
    /// `rho*A*l`
    pub c_rho_A_l: T,
    /// `1/pivot_theta`
    pub c_wcwe9: T,
    /// `c`
    pub c: T,
    /// `E*I*INTEGRAL_PHI_D2_SQUARED*M_theta_q/(rho*A*l*l*l*l*INTEGRAL_PHI_SQUARED)`
    pub c_sjz8w: [T; 2],
    /// `s_M_t_E_I*s_czt1z*s_q456h/s_yt44u` with prepared intermediate values
    pub c_3esjz: T,
    /// `PHI_AT_END*INTEGRAL_PHI_D2_SQUARED/INTEGRAL_PHI_SQUARED`
    pub c_axmtw: [T; 2],
    /// `s_bp4cn*s_wfuhw` with prepared intermediate values
    pub c_4g7wt: T,
    /// `J_t*E*I*PHI_D1_AT_END*INTEGRAL_PHI_D2_SQUARED/(rho*A*l*l*l*l*l*l*INTEGRAL_PHI_SQUARED)`
    pub c_y3zfv: [T; 2],
    /// `s_M_t_J_t*E*I*s_2nsp7*s_q456h/(s_rho_rho_A_A*s_l_l_l*s_l_l_l_l)` with prepared intermediate values
    pub c_1rv2k: T,
    /// `rho*A*l*INTEGRAL_PHI_SQUARED`
    pub c_uug3k: [T; 2],
    /// `s_q456h*PHI_AT_END/s_uug3k` with prepared intermediate values
    pub c_mqx2z: [T; 2],
    /// `s_mbcr7*s_wfuhw/s_rho_A_l` with prepared intermediate values
    pub c_gj36f: T,
    /// `s_r84p2*s_wcwe9` with prepared intermediate values
    pub c_8x3f2: T,
    /// `M_t*s_czt1z*s_wcwe9` with prepared intermediate values
    pub c_rtd1j: T,
    /// `-(M_t*E*I/(rho*A*l*l*l*l))`
    pub c_3zzzt: T,
    /// `s_wfuhw*PHI_D1_AT_END/s_uug3k` with prepared intermediate values
    pub c_dkurp: [T; 2],
    /// `1/pivot_theta*(l*INTEGRAL_S1_PHI/INTEGRAL_PHI_SQUARED + (l*M_t*PHI_AT_END + J_t*PHI_D1_AT_END/l)/(rho*A*l*INTEGRAL_PHI_SQUARED))`
    pub c_y2pfu: [T; 2],
    /// `-(E*I*INTEGRAL_PHI_D2_SQUARED/(rho*A*l*l*l*l*INTEGRAL_PHI_SQUARED))`
    pub c_hy49k: [T; 2],
    /// `J_h + 0.3333333333333333*rho*A*l*l*l + J_t + l*l*M_t`
    pub M_theta_theta: T,
    /// `M_t*PHI_AT_END`
    pub c_M_t_PHI_AT_END: [T; 2],
    /// `PHI_D1_AT_END/l`
    pub c_PHI_D1_AT_END_per_l: [T; 2],
    /// `1.0/l`
    pub c_1_per_l: T,
    /// `0.5*J_h`
    pub c_ywqgp: T,
    /// `2.0*rho*A*l*l`
    pub c_ffu9y: T,
    /// `0.5*M_t`
    pub c_47a9e: T,
    /// `0.5*J_t`
    pub c_wrnms: T,
    /// `0.5*E*I/(l*l*l)`
    pub c_bsgvc: T,
    /// True if all prepared pivots of the mass matrix are positive and finite. If false, the mass matrix is not positive definite and the rates are invalid.
    pub positive_definite: bool,
}
impl<T: Scalar> Coefficients<T> {
    /// Prepares the coefficients of these parameters.
    pub fn prepare(parameters: &Parameters<T>) -> Self {
        let _ = core::hint::black_box(&IDENTITY);
        let J_h = parameters.J_h;
        let J_t = parameters.J_t;
        let rho = parameters.rho;
        let A = parameters.A;
        let l = parameters.l;
        let s_l_l = l * l;
        let s_l_l_l = l * s_l_l;
        let s_yjjuw = T::number(0.3333333333333333) * rho * A * s_l_l_l;
        let M_t = parameters.M_t;
        let s_l_l_M_t = s_l_l * M_t;
        let s_rho_A = rho * A;
        let s_rho_A_l_l = s_rho_A * s_l_l;
        let s_l_M_t = l * M_t;
        let mut s_J_t_PHI_D1_AT_END_per_l = [T::number(0.0); 2];
        for i in 0..2 {
            s_J_t_PHI_D1_AT_END_per_l[i] = J_t * T::number(PHI_D1_AT_END[i]) / l;
        }
        let mut s_un1qs = [T::number(0.0); 2];
        for i in 0..2 {
            s_un1qs[i] = s_l_M_t * T::number(PHI_AT_END[i])
                + s_J_t_PHI_D1_AT_END_per_l[i];
        }
        let mut M_theta_q = [T::number(0.0); 2];
        for i in 0..2 {
            M_theta_q[i] = s_rho_A_l_l * T::number(INTEGRAL_S1_PHI[i]) + s_un1qs[i];
        }
        let s_v68jd = sum_of_few(
            [(); 2],
            |i| {
                T::number(INTEGRAL_S1_PHI[i]) * M_theta_q[i]
                    / T::number(INTEGRAL_PHI_SQUARED[i])
            },
        );
        let s_rho_A_l = s_rho_A * l;
        let s_pp8bx = sum_of_few(
            [(); 2],
            |i| s_un1qs[i] * M_theta_q[i] / T::number(INTEGRAL_PHI_SQUARED[i]),
        );
        let s_8drh7 = sum_of_few(
            [(); 2],
            |i| {
                T::number(INTEGRAL_S1_PHI[i]) * T::number(PHI_AT_END[i])
                    / T::number(INTEGRAL_PHI_SQUARED[i])
            },
        );
        let s_y1h1q = sum_of_few(
            [(); 2],
            |i| {
                T::number(PHI_AT_END[i]) * s_un1qs[i]
                    / T::number(INTEGRAL_PHI_SQUARED[i])
            },
        );
        let s_czt1z = l * s_8drh7 + s_y1h1q / s_rho_A_l;
        let s_mnvqj = sum_of_few(
            [(); 2],
            |i| {
                T::number(PHI_AT_END[i]) * T::number(PHI_AT_END[i])
                    / T::number(INTEGRAL_PHI_SQUARED[i])
            },
        );
        let s_tprmu = T::number(1.0) + M_t * s_mnvqj / s_rho_A_l;
        let s_q456h = pivot_reciprocal(s_tprmu);
        let s_s3s9t = sum_of_few(
            [(); 2],
            |i| {
                T::number(INTEGRAL_S1_PHI[i]) * T::number(PHI_D1_AT_END[i])
                    / T::number(INTEGRAL_PHI_SQUARED[i])
            },
        );
        let s_pkwwk = l * s_s3s9t;
        let s_y1b3a = sum_of_few(
            [(); 2],
            |i| {
                T::number(PHI_D1_AT_END[i]) * s_un1qs[i]
                    / T::number(INTEGRAL_PHI_SQUARED[i])
            },
        );
        let s_qjhbq = s_y1b3a / s_rho_A_l;
        let s_pck8d = s_rho_A * s_l_l_l;
        let s_M_t_J_t = M_t * J_t;
        let s_2nsp7 = sum_of_few(
            [(); 2],
            |i| {
                T::number(PHI_AT_END[i]) * T::number(PHI_D1_AT_END[i])
                    / T::number(INTEGRAL_PHI_SQUARED[i])
            },
        );
        let s_r84p2 = J_t * (s_pkwwk + s_qjhbq) / s_l_l
            - s_M_t_J_t * s_2nsp7 * s_czt1z * s_q456h / s_pck8d;
        let s_mbcr7 = M_t * s_2nsp7;
        let s_bp4cn = s_mbcr7 * s_czt1z * s_q456h / s_rho_A_l - s_pkwwk - s_qjhbq;
        let s_jgqf9 = sum_of_few(
            [(); 2],
            |i| {
                T::number(PHI_D1_AT_END[i]) * T::number(PHI_D1_AT_END[i])
                    / T::number(INTEGRAL_PHI_SQUARED[i])
            },
        );
        let s_rho_rho_A_A = rho * rho * (A * A);
        let s_l_l_l_l = s_l_l * s_l_l;
        let s_jafpa = T::number(1.0) + J_t * s_jgqf9 / s_pck8d
            - s_M_t_J_t * (s_2nsp7 * s_2nsp7) * s_q456h / (s_rho_rho_A_A * s_l_l_l_l);
        let s_wfuhw = pivot_reciprocal(s_jafpa);
        let s_prfqb = J_h + J_t + s_yjjuw + s_l_l_M_t
            + M_t * (s_czt1z * s_czt1z) * s_q456h - l * s_v68jd;
        let pivot_theta = s_prfqb - s_pp8bx / s_rho_A_l - s_r84p2 * s_bp4cn * s_wfuhw;
        let s_wcwe9 = pivot_reciprocal(pivot_theta);
        let c = parameters.c;
        let s_yt44u = s_rho_A * s_l_l_l_l;
        let E = parameters.E;
        let I = parameters.I;
        let s_E_I = E * I;
        let mut s_jfg32 = [T::number(0.0); 2];
        for i in 0..2 {
            s_jfg32[i] = s_yt44u * T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let mut s_e1v7w = [T::number(0.0); 2];
        for i in 0..2 {
            s_e1v7w[i] = s_E_I * T::number(INTEGRAL_PHI_D2_SQUARED[i]);
        }
        let mut s_sjz8w = [T::number(0.0); 2];
        for i in 0..2 {
            s_sjz8w[i] = s_e1v7w[i] * M_theta_q[i] / s_jfg32[i];
        }
        let s_M_t_E_I = M_t * E * I;
        let mut s_axmtw = [T::number(0.0); 2];
        for i in 0..2 {
            s_axmtw[i] = T::number(PHI_AT_END[i]) * T::number(INTEGRAL_PHI_D2_SQUARED[i])
                / T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let s_khhrf = s_rho_A * (s_l_l * s_l_l_l_l);
        let s_J_t_E_I = J_t * E * I;
        let mut s_y3zfv = [T::number(0.0); 2];
        for i in 0..2 {
            s_y3zfv[i] = s_J_t_E_I * T::number(PHI_D1_AT_END[i])
                * T::number(INTEGRAL_PHI_D2_SQUARED[i])
                / (s_khhrf * T::number(INTEGRAL_PHI_SQUARED[i]));
        }
        let mut s_uug3k = [T::number(0.0); 2];
        for i in 0..2 {
            s_uug3k[i] = s_rho_A_l * T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let mut s_mqx2z = [T::number(0.0); 2];
        for i in 0..2 {
            s_mqx2z[i] = s_q456h * T::number(PHI_AT_END[i]) / s_uug3k[i];
        }
        let mut s_dkurp = [T::number(0.0); 2];
        for i in 0..2 {
            s_dkurp[i] = s_wfuhw * T::number(PHI_D1_AT_END[i]) / s_uug3k[i];
        }
        let mut s_y2pfu = [T::number(0.0); 2];
        for i in 0..2 {
            s_y2pfu[i] = s_wcwe9
                * (l * T::number(INTEGRAL_S1_PHI[i]) / T::number(INTEGRAL_PHI_SQUARED[i])
                    + s_un1qs[i] / s_uug3k[i]);
        }
        let mut s_hy49k = [T::number(0.0); 2];
        for i in 0..2 {
            s_hy49k[i] = -(s_e1v7w[i] / s_jfg32[i]);
        }
        let M_theta_theta = J_h + s_yjjuw + (J_t + s_l_l_M_t);
        let mut s_M_t_PHI_AT_END = [T::number(0.0); 2];
        for i in 0..2 {
            s_M_t_PHI_AT_END[i] = M_t * T::number(PHI_AT_END[i]);
        }
        let mut s_PHI_D1_AT_END_per_l = [T::number(0.0); 2];
        for i in 0..2 {
            s_PHI_D1_AT_END_per_l[i] = T::number(PHI_D1_AT_END[i]) / l;
        }
        let mut positive_4 = true;
        for i in 0..2 {
            positive_4 = positive_4 && T::all_greater(s_uug3k[i], T::number(0.0))
                && T::all_greater(T::number(f64::INFINITY), s_uug3k[i]);
        }
        Self {
            l: l,
            c_yjjuw: s_yjjuw,
            c_J_t_PHI_D1_AT_END_per_l: s_J_t_PHI_D1_AT_END_per_l,
            M_theta_q: M_theta_q,
            c_rho_A_l: s_rho_A_l,
            c_wcwe9: s_wcwe9,
            c: c,
            c_sjz8w: s_sjz8w,
            c_3esjz: s_M_t_E_I * s_czt1z * s_q456h / s_yt44u,
            c_axmtw: s_axmtw,
            c_4g7wt: s_bp4cn * s_wfuhw,
            c_y3zfv: s_y3zfv,
            c_1rv2k: s_M_t_J_t * E * I * s_2nsp7 * s_q456h
                / (s_rho_rho_A_A * (s_l_l_l * s_l_l_l_l)),
            c_uug3k: s_uug3k,
            c_mqx2z: s_mqx2z,
            c_gj36f: s_mbcr7 * s_wfuhw / s_rho_A_l,
            c_8x3f2: s_r84p2 * s_wcwe9,
            c_rtd1j: M_t * s_czt1z * s_wcwe9,
            c_3zzzt: -(s_M_t_E_I / s_yt44u),
            c_dkurp: s_dkurp,
            c_y2pfu: s_y2pfu,
            c_hy49k: s_hy49k,
            M_theta_theta: M_theta_theta,
            c_M_t_PHI_AT_END: s_M_t_PHI_AT_END,
            c_PHI_D1_AT_END_per_l: s_PHI_D1_AT_END_per_l,
            c_1_per_l: T::number(1.0) / l,
            c_ywqgp: T::number(0.5) * J_h,
            c_ffu9y: T::number(2.0) * rho * A * s_l_l,
            c_47a9e: T::number(0.5) * M_t,
            c_wrnms: T::number(0.5) * J_t,
            c_bsgvc: T::number(0.5) * E * I / s_l_l_l,
            positive_definite: T::all_greater(pivot_theta, T::number(0.0))
                && T::all_greater(T::number(f64::INFINITY), pivot_theta)
                && T::all_greater(s_tprmu, T::number(0.0))
                && T::all_greater(T::number(f64::INFINITY), s_tprmu)
                && T::all_greater(s_jafpa, T::number(0.0))
                && T::all_greater(T::number(f64::INFINITY), s_jafpa) && positive_4,
        }
    }
}
impl Coefficients {
    /// Converts these coefficients to another number type, without derivatives.
    #[inline(always)]
    pub fn cast<T: Scalar>(&self) -> Coefficients<T> {
        Coefficients {
            l: T::number(self.l),
            c_yjjuw: T::number(self.c_yjjuw),
            c_J_t_PHI_D1_AT_END_per_l: converted(&self.c_J_t_PHI_D1_AT_END_per_l),
            M_theta_q: converted(&self.M_theta_q),
            c_rho_A_l: T::number(self.c_rho_A_l),
            c_wcwe9: T::number(self.c_wcwe9),
            c: T::number(self.c),
            c_sjz8w: converted(&self.c_sjz8w),
            c_3esjz: T::number(self.c_3esjz),
            c_axmtw: converted(&self.c_axmtw),
            c_4g7wt: T::number(self.c_4g7wt),
            c_y3zfv: converted(&self.c_y3zfv),
            c_1rv2k: T::number(self.c_1rv2k),
            c_uug3k: converted(&self.c_uug3k),
            c_mqx2z: converted(&self.c_mqx2z),
            c_gj36f: T::number(self.c_gj36f),
            c_8x3f2: T::number(self.c_8x3f2),
            c_rtd1j: T::number(self.c_rtd1j),
            c_3zzzt: T::number(self.c_3zzzt),
            c_dkurp: converted(&self.c_dkurp),
            c_y2pfu: converted(&self.c_y2pfu),
            c_hy49k: converted(&self.c_hy49k),
            M_theta_theta: T::number(self.M_theta_theta),
            c_M_t_PHI_AT_END: converted(&self.c_M_t_PHI_AT_END),
            c_PHI_D1_AT_END_per_l: converted(&self.c_PHI_D1_AT_END_per_l),
            c_1_per_l: T::number(self.c_1_per_l),
            c_ywqgp: T::number(self.c_ywqgp),
            c_ffu9y: T::number(self.c_ffu9y),
            c_47a9e: T::number(self.c_47a9e),
            c_wrnms: T::number(self.c_wrnms),
            c_bsgvc: T::number(self.c_bsgvc),
            positive_definite: self.positive_definite,
        }
    }
}

/// Rates of the state, written to `rates`.
///
/// `t` in s; `state` and the rates in the order of [`STATE_NAMES`].
#[allow(unused_variables)]
pub fn rates_into<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
    rates: &mut [T; STATES],
) {
    let theta_dot = state[3];
    let u = inputs.u;
    let s_pj46n = sum_of_few([(); 2], |i| coefficients.c_sjz8w[i] * state[1 + i]);
    let s_na64g = sum_of_few([(); 2], |i| coefficients.c_axmtw[i] * state[1 + i]);
    let s_756ys = sum_of_few([(); 2], |i| coefficients.c_y3zfv[i] * state[1 + i]);
    let s_vnggz = coefficients.c_1rv2k * s_na64g - s_756ys;
    let s_9a7br = u + s_pj46n - coefficients.c * theta_dot
        - coefficients.c_3esjz * s_na64g - coefficients.c_4g7wt * s_vnggz;
    let theta_ddot = coefficients.c_wcwe9 * s_9a7br;
    let s_hhahr = s_vnggz - coefficients.c_8x3f2 * s_9a7br;
    let s_tahtg = coefficients.c_3zzzt * s_na64g - coefficients.c_gj36f * s_hhahr
        - coefficients.c_rtd1j * s_9a7br;
    for i in 0..3 {
        rates[i] = state[3 + i];
    }
    rates[3] = theta_ddot;
    for i in 0..2 {
        rates[4 + i] = coefficients.c_hy49k[i] * state[1 + i]
            - coefficients.c_mqx2z[i] * s_tahtg - coefficients.c_dkurp[i] * s_hhahr
            - coefficients.c_y2pfu[i] * s_9a7br;
    }
}

/// Returns the rates of the state.
///
/// `t` in s; `state` and the rates in the order of [`STATE_NAMES`].
pub fn rates<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> [T; STATES] {
    let mut rates = [T::number(0.0); STATES];
    rates_into(t, state, inputs, coefficients, &mut rates);
    rates
}

/// Observables in the order of [`OBSERVABLE_NAMES`]:
///
/// - `tip`: deflection of the beam's end \[m]
/// - `tip_slope`: slope of the beam's end \[rad]
/// - `energy`: kinetic plus potential energy \[J]
/// - `power`: power of all non-conservative forces: the rate of the energy \[W]
#[allow(unused_variables)]
pub fn observables<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> [T; OBSERVABLES] {
    let theta_dot = state[3];
    let u = inputs.u;
    let tip = sum_of_few([(); 2], |i| T::number(PHI_AT_END[i]) * state[1 + i]);
    let s_qat53 = sum_of_few([(); 2], |i| T::number(PHI_D1_AT_END[i]) * state[1 + i]);
    let tip_slope = coefficients.c_1_per_l * s_qat53;
    let s_theta_dot_theta_dot = theta_dot * theta_dot;
    let s_bz2gj = sum_of_few([(); 2], |i| T::number(INTEGRAL_S1_PHI[i]) * state[4 + i]);
    let s_dbu4z = sum_of_few(
        [(); 2],
        |i| T::number(INTEGRAL_PHI_SQUARED[i]) * (state[4 + i] * state[4 + i]),
    );
    let s_kpq4n = sum_of_few([(); 2], |i| T::number(PHI_AT_END[i]) * state[4 + i]);
    let s_sjgdr = coefficients.l * theta_dot + s_kpq4n;
    let s_cz5r3 = sum_of_few([(); 2], |i| T::number(PHI_D1_AT_END[i]) * state[4 + i]);
    let s_zyd2t = theta_dot + coefficients.c_1_per_l * s_cz5r3;
    let T_tip = coefficients.c_47a9e * (s_sjgdr * s_sjgdr)
        + coefficients.c_wrnms * (s_zyd2t * s_zyd2t);
    let s_6tupp = coefficients.c_ywqgp * s_theta_dot_theta_dot
        + T::number(0.5)
            * (coefficients.c_yjjuw * s_theta_dot_theta_dot
                + coefficients.c_ffu9y * (theta_dot * s_bz2gj)
                + coefficients.c_rho_A_l * s_dbu4z);
    let s_86a4q = sum_of_few(
        [(); 2],
        |i| T::number(INTEGRAL_PHI_D2_SQUARED[i]) * (state[1 + i] * state[1 + i]),
    );
    let V_bending = coefficients.c_bsgvc * s_86a4q;
    [
        tip,
        tip_slope,
        s_6tupp + T_tip + V_bending,
        theta_dot * (u - coefficients.c * theta_dot),
    ]
}

/// Kinetic plus potential energy, in J.
#[allow(unused_variables)]
pub fn energy<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> T {
    let theta_dot = state[3];
    let s_theta_dot_theta_dot = theta_dot * theta_dot;
    let s_bz2gj = sum_of_few([(); 2], |i| T::number(INTEGRAL_S1_PHI[i]) * state[4 + i]);
    let s_dbu4z = sum_of_few(
        [(); 2],
        |i| T::number(INTEGRAL_PHI_SQUARED[i]) * (state[4 + i] * state[4 + i]),
    );
    let s_kpq4n = sum_of_few([(); 2], |i| T::number(PHI_AT_END[i]) * state[4 + i]);
    let s_sjgdr = coefficients.l * theta_dot + s_kpq4n;
    let s_cz5r3 = sum_of_few([(); 2], |i| T::number(PHI_D1_AT_END[i]) * state[4 + i]);
    let s_zyd2t = theta_dot + coefficients.c_1_per_l * s_cz5r3;
    let T_tip = coefficients.c_47a9e * (s_sjgdr * s_sjgdr)
        + coefficients.c_wrnms * (s_zyd2t * s_zyd2t);
    let s_6tupp = coefficients.c_ywqgp * s_theta_dot_theta_dot
        + T::number(0.5)
            * (coefficients.c_yjjuw * s_theta_dot_theta_dot
                + coefficients.c_ffu9y * (theta_dot * s_bz2gj)
                + coefficients.c_rho_A_l * s_dbu4z);
    let s_86a4q = sum_of_few(
        [(); 2],
        |i| T::number(INTEGRAL_PHI_D2_SQUARED[i]) * (state[1 + i] * state[1 + i]),
    );
    let V_bending = coefficients.c_bsgvc * s_86a4q;
    s_6tupp + T_tip + V_bending
}

/// Power of all non-conservative forces, in W: the rate of the energy.
#[allow(unused_variables)]
pub fn power<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> T {
    let theta_dot = state[3];
    let u = inputs.u;
    theta_dot * (u - coefficients.c * theta_dot)
}

/// Switching surfaces: the equations change when one of these changes sign.
///
#[allow(unused_variables, unused_mut)]
pub fn guards<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> [T; GUARDS] {
    let mut values = [T::number(0.0); GUARDS];
    values
}

/// Mass matrix in the order of the first half of [`STATE_NAMES`].
#[allow(unused_variables, unused_mut)]
pub fn mass_matrix<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> [[T; DEGREES_OF_FREEDOM]; DEGREES_OF_FREEDOM] {
    let mut values = [[T::number(0.0); DEGREES_OF_FREEDOM]; DEGREES_OF_FREEDOM];
    values[0][0] = coefficients.M_theta_theta;
    for i in 0..2 {
        values[0][1 + i] = coefficients.M_theta_q[i];
        values[1 + i][0] = values[0][1 + i];
    }
    for i in 0..2 {
        values[1 + i][1 + i] = values[1 + i][1 + i] + coefficients.c_uug3k[i];
        for j in 0..2 {
            values[1 + i][1 + j] = values[1 + i][1 + j]
                + coefficients.c_M_t_PHI_AT_END[i] * T::number(PHI_AT_END[j]);
            values[1 + i][1 + j] = values[1 + i][1 + j]
                + coefficients.c_J_t_PHI_D1_AT_END_per_l[i]
                    * coefficients.c_PHI_D1_AT_END_per_l[j];
        }
    }
    values
}

/// int\[s phi_i], with s = x/l from 0 to 1; primes are derivatives by s
static INTEGRAL_S1_PHI: [f64; 2] = [0.774866121708409, 0.08912096167893394];

/// int\[phi_i^2], with s = x/l from 0 to 1; primes are derivatives by s
static INTEGRAL_PHI_SQUARED: [f64; 2] = [1.8556448472351015, 0.9640638644850398];

/// phi_i(1), with s = x/l from 0 to 1; primes are derivatives by s
static PHI_AT_END: [f64; 2] = [2.7244411149702623, -1.9637350783494598];

/// phi_i'(1), with s = x/l from 0 to 1; primes are derivatives by s
static PHI_D1_AT_END: [f64; 2] = [3.7502081374239222, -9.38818226594835];

/// int\[phi_i''^2], with s = x/l from 0 to 1; primes are derivatives by s
static INTEGRAL_PHI_D2_SQUARED: [f64; 2] = [22.940155884082465, 468.07114845621095];

/// Number type of the equations: `f64`, `f32`, SIMD lanes of them, or dual numbers. The code
/// does not branch on a value, so that lanes can differ in every condition.
pub trait Scalar: Copy
where
    Self: core::ops::Add<Output = Self>,
    Self: core::ops::Sub<Output = Self>,
    Self: core::ops::Mul<Output = Self>,
    Self: core::ops::Div<Output = Self>,
    Self: core::ops::Neg<Output = Self>,
{
    /// Returns a constant, equal in every lane and without derivative.
    fn number(value: f64) -> Self;
    /// Returns `then` if a > b, else `otherwise`, also if either is NaN. The other value has no
    /// effect.
    fn select_greater(a: Self, b: Self, then: Self, otherwise: Self) -> Self;
    /// Returns true if a > b in every lane.
    fn all_greater(a: Self, b: Self) -> bool;
    /// Applies an elementary function.
    fn function<F: Function>(self) -> Self;
    /// Applies an elementary function of two arguments.
    fn function_of_two<F: FunctionOfTwo>(self, other: Self) -> Self;
    /// Runs a long loop. For single numbers it is not inlined; for lanes it must be, because a
    /// separate function would not be compiled for their registers.
    #[inline(always)]
    fn long_loop<F: FnOnce() -> Self>(lines: F) -> Self {
        lines()
    }
}

/// Number type of the elementary functions: IEEE 754 double precision, SIMD lanes of it, or single
/// precision, with the bits in parentheses.
pub trait Real: Scalar {
    /// Returns `then` if a = b, else `otherwise`, also if either is NaN.
    fn select_equal(a: Self, b: Self, then: Self, otherwise: Self) -> Self;
    /// Clears the sign bit.
    fn magnitude(self) -> Self;
    /// Returns the magnitude with the sign bit of another number.
    fn copy_sign(self, sign: Self) -> Self;
    /// Returns 2^k for an integral k: the addition of 2^52 + 1023 (2^23 + 127) moves k to the
    /// exponent bits.
    fn power_of_two(self) -> Self;
    /// Returns the unbiased exponent field.
    fn exponent(self) -> Self;
    /// Returns the mantissa with the exponent of 1.
    fn significand(self) -> Self;
}

/// Elementary function: plain operations in a fixed order, bit-identical on every machine.
pub trait Function {
    /// Computes the value in double precision.
    fn value<T: Real>(x: T) -> T;
    /// Computes the value in single precision.
    fn single<T: Real>(x: T) -> T;
    /// Computes the derivative at x; `value` is the value at x.
    fn slope<T: Scalar>(x: T, value: T) -> T;
}

/// Elementary function of two arguments.
pub trait FunctionOfTwo {
    /// Computes the value in double precision.
    fn value<T: Real>(x: T, y: T) -> T;
    /// Computes the value in single precision.
    fn single<T: Real>(x: T, y: T) -> T;
    /// Computes the derivatives by x and y; `value` is the value at (x, y).
    fn slopes<T: Scalar>(x: T, y: T, value: T) -> [T; 2];
}
impl Scalar for f64 {
    #[inline(always)]
    fn number(value: f64) -> f64 {
        value
    }
    #[inline(always)]
    fn select_greater(a: f64, b: f64, then: f64, otherwise: f64) -> f64 {
        if a > b { then } else { otherwise }
    }
    #[inline(always)]
    fn all_greater(a: f64, b: f64) -> bool {
        a > b
    }
    #[inline]
    fn function<F: Function>(self) -> f64 {
        F::value(self)
    }
    #[inline]
    fn function_of_two<F: FunctionOfTwo>(self, other: f64) -> f64 {
        F::value(self, other)
    }
    #[inline(never)]
    fn long_loop<F: FnOnce() -> f64>(lines: F) -> f64 {
        lines()
    }
}
impl Real for f64 {
    #[inline(always)]
    fn select_equal(a: f64, b: f64, then: f64, otherwise: f64) -> f64 {
        if a == b { then } else { otherwise }
    }
    #[inline(always)]
    fn magnitude(self) -> f64 {
        f64::from_bits(self.to_bits() & !(1 << 63))
    }
    #[inline(always)]
    fn copy_sign(self, sign: f64) -> f64 {
        f64::from_bits((self.to_bits() & !(1 << 63)) | (sign.to_bits() & (1 << 63)))
    }
    #[inline(always)]
    fn power_of_two(self) -> f64 {
        f64::from_bits((self + 4503599627371519.0).to_bits() << 52)
    }
    #[inline(always)]
    fn exponent(self) -> f64 {
        ((self.to_bits() >> 52) & 0x7ff) as f64 - 1023.0
    }
    #[inline(always)]
    fn significand(self) -> f64 {
        f64::from_bits((self.to_bits() & 0x000f_ffff_ffff_ffff) | 0x3ff0_0000_0000_0000)
    }
}

/// Elementary functions are computed in single precision, within two units in the last place:
/// sine, cosine and tangent for |x| up to 1e5.
impl Scalar for f32 {
    #[inline(always)]
    fn number(value: f64) -> f32 {
        value as f32
    }
    #[inline(always)]
    fn select_greater(a: f32, b: f32, then: f32, otherwise: f32) -> f32 {
        if a > b { then } else { otherwise }
    }
    #[inline(always)]
    fn all_greater(a: f32, b: f32) -> bool {
        a > b
    }
    #[inline]
    fn function<F: Function>(self) -> f32 {
        F::single(self)
    }
    #[inline]
    fn function_of_two<F: FunctionOfTwo>(self, other: f32) -> f32 {
        F::single(self, other)
    }
    #[inline(never)]
    fn long_loop<F: FnOnce() -> f32>(lines: F) -> f32 {
        lines()
    }
}
impl Real for f32 {
    #[inline(always)]
    fn select_equal(a: f32, b: f32, then: f32, otherwise: f32) -> f32 {
        if a == b { then } else { otherwise }
    }
    #[inline(always)]
    fn magnitude(self) -> f32 {
        f32::from_bits(self.to_bits() & !(1 << 31))
    }
    #[inline(always)]
    fn copy_sign(self, sign: f32) -> f32 {
        f32::from_bits((self.to_bits() & !(1 << 31)) | (sign.to_bits() & (1 << 31)))
    }
    #[inline(always)]
    fn power_of_two(self) -> f32 {
        f32::from_bits((self + 8388735.0).to_bits() << 23)
    }
    #[inline(always)]
    fn exponent(self) -> f32 {
        ((self.to_bits() >> 23) & 0xff) as f32 - 127.0
    }
    #[inline(always)]
    fn significand(self) -> f32 {
        f32::from_bits((self.to_bits() & 0x007f_ffff) | 0x3f80_0000)
    }
}

/// Converts numbers to another type.
#[inline(always)]
fn converted<T: Scalar, const N: usize>(numbers: &[f64; N]) -> [T; N] {
    let mut converted = [T::number(0.0); N];
    for i in 0..N {
        converted[i] = T::number(numbers[i]);
    }
    converted
}

/// Returns the pairwise sum of the first `N` of eight numbers.
#[inline(always)]
fn pairwise_sum<const N: usize, T: Scalar>(s: &[T; 8]) -> T {
    let a = if N > 1 { s[0] + s[1] } else { s[0] };
    let b = if N > 3 { s[2] + s[3] } else { s[2] };
    let c = if N > 5 { s[4] + s[5] } else { s[4] };
    let d = if N > 7 { s[6] + s[7] } else { s[6] };
    let left = if N > 2 { a + b } else { a };
    let right = if N > 6 { c + d } else { c };
    if N > 4 { left + right } else { left }
}

/// Adds up to eight elements.
#[inline(always)]
fn sum_of_few<const N: usize, T: Scalar, F: Fn(usize) -> T>(
    _: [(); N],
    element: F,
) -> T {
    let mut s = [T::number(0.0); 8];
    for k in 0..N {
        s[k] = element(k);
    }
    pairwise_sum::<N, T>(&s)
}

/// 1/pivot for a positive pivot, else NaN: the mass matrix is not positive definite.
#[inline(always)]
fn pivot_reciprocal<T: Scalar>(pivot: T) -> T {
    T::select_greater(pivot, T::number(0.0), T::number(1.0) / pivot, T::number(f64::NAN))
}
