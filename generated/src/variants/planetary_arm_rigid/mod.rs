//! Flexible single-link arm on a 2K-H planetary reducer with backlash: equations of motion, modal truncation order 0.
//!
//! Emitted by eomgen 0.2.0 from the specification `planetary_arm` (SHA-256 f6f74b40cfbe4f1a78359fb6b00716cbaaf50ac5d844f506baff6fcfb0a6c75e).
//! Do not edit: change the specification and generate again.
//!
//! State: x_sp, x_pr, x_c, x_sp_dot, x_pr_dot, x_c_dot.
//! All quantities are in SI units. The code does not allocate, panic or use the standard library.
#![allow(non_snake_case)]
#![allow(clippy::all)]
#![forbid(unsafe_code)]

/// Modal truncation order of each field.
pub const ORDERS: [usize; 1] = [0];

/// Number of degrees of freedom: coordinates and modes.
pub const DEGREES_OF_FREEDOM: usize = 3;

/// Number of states: coordinates, modes, and the rates of both.
pub const STATES: usize = 6;

/// Names of the states, in their order.
pub const STATE_NAMES: [&'static str; STATES] = [
    "x_sp",
    "x_pr",
    "x_c",
    "x_sp_dot",
    "x_pr_dot",
    "x_c_dot",
];

/// Number of observables.
pub const OBSERVABLES: usize = 11;

/// Names of the observables, in their order.
pub const OBSERVABLE_NAMES: [&'static str; OBSERVABLES] = [
    "theta_s",
    "theta_p",
    "theta_c",
    "tip",
    "dtheta",
    "f_la",
    "f_la_signed",
    "F_sp",
    "F_pr",
    "energy",
    "power",
];

/// Number of switching surfaces.
pub const GUARDS: usize = 4;

/// SHA-256 of the specification.
pub const SPECIFICATION_SHA256: &'static str = "f6f74b40cfbe4f1a78359fb6b00716cbaaf50ac5d844f506baff6fcfb0a6c75e";

/// Version of the generator.
pub const GENERATOR_VERSION: &'static str = "0.2.0";

/// Number of inputs.
pub const INPUTS: usize = 0;

/// Names of the inputs, in their order.
pub const INPUT_NAMES: [&'static str; INPUTS] = [];

/// Number of parameters.
pub const PARAMETERS: usize = 24;

/// Names of the parameters, in their order.
pub const PARAMETER_NAMES: [&'static str; PARAMETERS] = [
    "z_s",
    "z_p",
    "z_r",
    "m",
    "alpha",
    "M_s",
    "M_p",
    "m_c",
    "m_p",
    "k_sp",
    "k_pr",
    "c_sp",
    "c_pr",
    "b_sp",
    "b_pr",
    "rho",
    "A",
    "l",
    "E",
    "I",
    "a_m",
    "b_m",
    "F_w",
    "omega",
];

/// SI units of the states.
pub const STATE_UNITS: [&'static str; STATES] = ["m", "m", "m", "m/s", "m/s", "m/s"];

/// SI units of the inputs.
pub const INPUT_UNITS: [&'static str; INPUTS] = [];

/// SI units of the parameters.
pub const PARAMETER_UNITS: [&'static str; PARAMETERS] = [
    "1",
    "1",
    "1",
    "m",
    "1",
    "kg",
    "kg",
    "kg",
    "kg",
    "N/m",
    "N/m",
    "N s/m",
    "N s/m",
    "m",
    "m",
    "kg/m^3",
    "m^2",
    "m",
    "Pa",
    "m^4",
    "N m",
    "N m s",
    "N m",
    "rad/s",
];

/// SI units of the observables.
pub const OBSERVABLE_UNITS: [&'static str; OBSERVABLES] = [
    "rad",
    "rad",
    "rad",
    "m",
    "rad",
    "m",
    "m",
    "N",
    "N",
    "J",
    "W",
];

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
pub const INPUT_LOWER: [f64; INPUTS] = [];

/// Upper ends of the ranges of the inputs, infinity if the specification gives none.
pub const INPUT_UPPER: [f64; INPUTS] = [];

/// Indices of the states, and of their time derivatives in the rates.
#[allow(non_upper_case_globals)]
pub mod state {
    /// `x_sp`
    pub const X_SP: usize = 0;
    /// `x_pr`
    pub const X_PR: usize = 1;
    /// `x_c`
    pub const X_C: usize = 2;
    /// `x_sp_dot`
    pub const X_SP_DOT: usize = 3;
    /// `x_pr_dot`
    pub const X_PR_DOT: usize = 4;
    /// `x_c_dot`
    pub const X_C_DOT: usize = 5;
}

/// Indices of the parameters.
#[allow(non_upper_case_globals)]
pub mod parameter {
    /// `z_s`
    pub const Z_S: usize = 0;
    /// `z_p`
    pub const Z_P: usize = 1;
    /// `z_r`
    pub const Z_R: usize = 2;
    /// `m`
    pub const M: usize = 3;
    /// `alpha`
    pub const ALPHA: usize = 4;
    /// `M_s`
    pub const M_S: usize = 5;
    /// `M_p`
    pub const M_p: usize = 6;
    /// `m_c`
    pub const M_C: usize = 7;
    /// `m_p`
    pub const m_p: usize = 8;
    /// `k_sp`
    pub const K_SP: usize = 9;
    /// `k_pr`
    pub const K_PR: usize = 10;
    /// `c_sp`
    pub const C_SP: usize = 11;
    /// `c_pr`
    pub const C_PR: usize = 12;
    /// `b_sp`
    pub const B_SP: usize = 13;
    /// `b_pr`
    pub const B_PR: usize = 14;
    /// `rho`
    pub const RHO: usize = 15;
    /// `A`
    pub const A: usize = 16;
    /// `l`
    pub const L: usize = 17;
    /// `E`
    pub const E: usize = 18;
    /// `I`
    pub const I: usize = 19;
    /// `a_m`
    pub const A_M: usize = 20;
    /// `b_m`
    pub const B_M: usize = 21;
    /// `F_w`
    pub const F_W: usize = 22;
    /// `omega`
    pub const OMEGA: usize = 23;
}

/// Indices of the observables.
#[allow(non_upper_case_globals)]
pub mod observable {
    /// `theta_s`
    pub const THETA_S: usize = 0;
    /// `theta_p`
    pub const THETA_P: usize = 1;
    /// `theta_c`
    pub const THETA_C: usize = 2;
    /// `tip`
    pub const TIP: usize = 3;
    /// `dtheta`
    pub const DTHETA: usize = 4;
    /// `f_la`
    pub const F_LA: usize = 5;
    /// `f_la_signed`
    pub const F_LA_SIGNED: usize = 6;
    /// `F_sp`
    pub const F_SP: usize = 7;
    /// `F_pr`
    pub const F_PR: usize = 8;
    /// `energy`
    pub const ENERGY: usize = 9;
    /// `power`
    pub const POWER: usize = 10;
}

/// Identity, for `eomgen identify`; `source` is the SHA-256 of this file without the line below.
pub static IDENTITY: [u8; 208] = *b"eomgen-identity name=planetary_arm_rigid specification=f6f74b40cfbe4f1a78359fb6b00716cbaaf50ac5d844f506baff6fcfb0a6c75e source=a1ad09c9e7569480c29bc1cd18c9fabd4604390c161cce12f1697c24f22ac452 generator=0.2.0;";

/// Parameters of the model. `Default` has the values of the specification.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameters<T = f64> {
    /// teeth of the sun \[1] (Table I)
    pub z_s: T,
    /// teeth of each planet \[1] (Table I)
    pub z_p: T,
    /// teeth of the ring \[1] (Table I)
    pub z_r: T,
    /// module \[m] (Table I)
    pub m: T,
    /// pressure angle \[1] (Table I)
    pub alpha: T,
    /// I_s/r_s^2 \[kg] (Table I)
    pub M_s: T,
    /// I_p/r_p^2 \[kg] (Table I)
    pub M_p: T,
    /// I_c/r_c^2 (not the M_c of Eq. (12)) \[kg] (Table I)
    pub m_c: T,
    /// mass of one planet \[kg] (Table I)
    pub m_p: T,
    /// mesh stiffness, sun-planet \[N/m] (Table I)
    pub k_sp: T,
    /// mesh stiffness, planet-ring \[N/m] (Table I)
    pub k_pr: T,
    /// mesh damping, sun-planet \[N s/m] (assumed: 10 % of critical for M_sp)
    pub c_sp: T,
    /// mesh damping, planet-ring \[N s/m] (assumed: 4.4 % of critical for M_pr)
    pub c_pr: T,
    /// half backlash, sun-planet \[m] (one of the paper's: 0, 10, 25, 50, 100 um)
    pub b_sp: T,
    /// half backlash, planet-ring \[m] (one of the paper's: 0, 10, 25, 50, 100 um)
    pub b_pr: T,
    /// density \[kg/m^3] (Table I)
    pub rho: T,
    /// section area \[m^2] (Table I)
    pub A: T,
    /// length \[m] (Table I)
    pub l: T,
    /// Young's modulus \[Pa] (Table I)
    pub E: T,
    /// second moment of area \[m^4] (assumed: 10 mm square section)
    pub I: T,
    /// constant torque \[N m] (assumed)
    pub a_m: T,
    /// fall of the torque with speed \[N m s] (assumed)
    pub b_m: T,
    /// amplitude of the torque ripple \[N m] (assumed)
    pub F_w: T,
    /// frequency of the torque ripple, 10 pi \[rad/s] (one of the paper's: 5 pi, 10 pi)
    pub omega: T,
}
impl Default for Parameters {
    fn default() -> Self {
        Self {
            z_s: 27.0,
            z_p: 36.0,
            z_r: 99.0,
            m: 0.003,
            alpha: 0.4293509959906051,
            M_s: 0.39,
            M_p: 0.61,
            m_c: 6.29,
            m_p: 0.66,
            k_sp: 1e8,
            k_pr: 1e8,
            c_sp: 650.0,
            c_pr: 650.0,
            b_sp: 2.5e-5,
            b_pr: 2.5e-5,
            rho: 7900.0,
            A: 0.0001,
            l: 0.5,
            E: 2e11,
            I: 8.333e-10,
            a_m: 2.0,
            b_m: 0.05,
            F_w: 5.0,
            omega: 31.41592653589793,
        }
    }
}
impl Parameters {
    /// Converts these parameters to another number type, without derivatives.
    #[inline(always)]
    pub fn cast<T: Scalar>(&self) -> Parameters<T> {
        Parameters {
            z_s: T::number(self.z_s),
            z_p: T::number(self.z_p),
            z_r: T::number(self.z_r),
            m: T::number(self.m),
            alpha: T::number(self.alpha),
            M_s: T::number(self.M_s),
            M_p: T::number(self.M_p),
            m_c: T::number(self.m_c),
            m_p: T::number(self.m_p),
            k_sp: T::number(self.k_sp),
            k_pr: T::number(self.k_pr),
            c_sp: T::number(self.c_sp),
            c_pr: T::number(self.c_pr),
            b_sp: T::number(self.b_sp),
            b_pr: T::number(self.b_pr),
            rho: T::number(self.rho),
            A: T::number(self.A),
            l: T::number(self.l),
            E: T::number(self.E),
            I: T::number(self.I),
            a_m: T::number(self.a_m),
            b_m: T::number(self.b_m),
            F_w: T::number(self.F_w),
            omega: T::number(self.omega),
        }
    }
}
impl<T: Copy> From<[T; PARAMETERS]> for Parameters<T> {
    fn from(numbers: [T; PARAMETERS]) -> Self {
        Self {
            z_s: numbers[0],
            z_p: numbers[1],
            z_r: numbers[2],
            m: numbers[3],
            alpha: numbers[4],
            M_s: numbers[5],
            M_p: numbers[6],
            m_c: numbers[7],
            m_p: numbers[8],
            k_sp: numbers[9],
            k_pr: numbers[10],
            c_sp: numbers[11],
            c_pr: numbers[12],
            b_sp: numbers[13],
            b_pr: numbers[14],
            rho: numbers[15],
            A: numbers[16],
            l: numbers[17],
            E: numbers[18],
            I: numbers[19],
            a_m: numbers[20],
            b_m: numbers[21],
            F_w: numbers[22],
            omega: numbers[23],
        }
    }
}

/// Inputs at run time. `Default` is zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Inputs {}
impl<T: Copy> From<[T; INPUTS]> for Inputs {
    fn from(_: [T; INPUTS]) -> Self {
        Self {}
    }
}

/// Values that depend only on the parameters: prepare once, use in every call.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficients<T = f64> {
    /// `a_m` \[N m] forces.motor
    pub a_m: T,
    /// `r_s*a_m/I_s` \[m/s^2] kinetic.sun
    pub c_r_s_a_m_per_I_s: T,
    /// `1/pivot_x_c` \[1/kg] kinetic.planets, kinetic.carrier, kinetic.arm
    pub c_5f1my: T,
    /// `2.0*1/pivot_x_c` \[1/kg] kinetic.planets, kinetic.carrier, kinetic.arm
    pub c_79h79: T,
    /// `c_sp` \[N s/m] forces.damping_sp
    pub c_sp: T,
    /// `3.0*c_sp` \[N s/m] forces.damping_sp
    pub c_3_c_sp: T,
    /// `b_sp` \[m] potential.mesh_sp, forces.damping_sp, guards.0, guards.1
    pub b_sp: T,
    /// `c_pr` \[N s/m] forces.damping_pr
    pub c_pr: T,
    /// `3.0*c_pr` \[N s/m] forces.damping_pr
    pub c_3_c_pr: T,
    /// `b_pr` \[m] potential.mesh_pr, forces.damping_pr, guards.2, guards.3
    pub b_pr: T,
    /// `k_sp` \[N/m] potential.mesh_sp
    pub k_sp: T,
    /// `3.0*k_sp` \[N/m] potential.mesh_sp
    pub c_3_k_sp: T,
    /// `k_pr` \[N/m] potential.mesh_pr
    pub k_pr: T,
    /// `3.0*k_pr` \[N/m] potential.mesh_pr
    pub c_3_k_pr: T,
    /// `0.3333333333333333*r_p*r_p/I_p` \[1/kg] kinetic.planets
    pub c_mttba: T,
    /// `3.0*I_p*1/pivot_x_c/(r_p*r_p)` \[1] kinetic.planets, kinetic.carrier, kinetic.arm
    pub c_en65n: T,
    /// `b_m/I_s` \[1/s] kinetic.sun
    pub c_b_m_per_I_s: T,
    /// `r_s*r_s/I_s` \[1/kg] kinetic.sun
    pub c_r_s_r_s_per_I_s: T,
    /// `F_w` \[N m] forces.motor
    pub F_w: T,
    /// `r_s*F_w/I_s` \[m/s^2] kinetic.sun
    pub c_r_s_F_w_per_I_s: T,
    /// `omega` \[1/s] forces.motor
    pub omega: T,
    /// `I_s/(r_s*r_s)` \[kg] kinetic.sun
    pub M_x_sp_x_sp: T,
    /// `2.0*I_s/(r_s*r_s)` \[kg] kinetic.sun
    pub M_x_sp_x_c: T,
    /// `M_x_sp_x_sp + pivot_x_pr` \[kg] kinetic.sun, kinetic.planets
    pub M_x_pr_x_pr: T,
    /// `M_x_sp_x_c + pivot_x_pr` \[kg] kinetic.sun, kinetic.planets
    pub M_x_pr_x_c: T,
    /// `4.0*I_s/s_r_s_r_s + pivot_x_pr + s_hppb7 + s_f4jtk + s_1u3rt` with prepared intermediate values \[kg] kinetic.*
    pub M_x_c_x_c: T,
    /// `1.0/r_s` \[1/m] kinetic.sun, forces.motor
    pub c_1_per_r_s: T,
    /// `b_m/r_s` \[N s] kinetic.sun, forces.motor
    pub c_b_m_per_r_s: T,
    /// `2.0/r_s` \[1/m] kinetic.sun, forces.motor
    pub c_2_per_r_s: T,
    /// `1.0/r_p` \[1/m] kinetic.planets
    pub c_1_per_r_p: T,
    /// `1.0/(cos(alpha)*r_c)` \[1/m] kinetic.carrier, kinetic.arm
    pub c_72jmj: T,
    /// `1.0/(r_s*i_sH)` \[1/m] kinetic.sun, forces.motor
    pub c_1_per_r_s_i_sH: T,
    /// `l/(r_s*i_sH)` \[1] kinetic.sun, forces.motor
    pub c_l_per_r_s_i_sH: T,
    /// `-(l/(r_s*i_sH))` \[1] kinetic.sun, forces.motor
    pub c_minus_l_per_r_s_i_sH: T,
    /// `0.5*I_s/(r_s*r_s)` \[kg] kinetic.sun
    pub c_tqaqf: T,
    /// `1.5*I_p/(r_p*r_p)` \[kg] kinetic.planets
    pub c_k4tad: T,
    /// `1.5*m_p/(cos(alpha)*cos(alpha))` \[kg] kinetic.planets
    pub c_uxvby: T,
    /// `0.5*I_c/(cos(alpha)*cos(alpha)*r_c*r_c)` \[kg] kinetic.carrier
    pub c_r6kbz: T,
    /// `0.16666666666666666*rho*A*l*l*l/(cos(alpha)*cos(alpha)*r_c*r_c)` \[kg] kinetic.arm
    pub c_g3zhz: T,
    /// `1.5*k_sp` \[N/m] potential.mesh_sp
    pub c_x6cxe: T,
    /// `1.5*k_pr` \[N/m] potential.mesh_pr
    pub c_ydxtm: T,
    /// True if all prepared pivots of the mass matrix are positive and finite. If false, the mass matrix is not positive definite and the rates are invalid.
    pub positive_definite: bool,
}
impl<T: Scalar> Coefficients<T> {
    /// Prepares the coefficients of these parameters.
    pub fn prepare(parameters: &Parameters<T>) -> Self {
        let _ = core::hint::black_box(&IDENTITY);
        let m = parameters.m;
        // [m] kinetic.*, forces.motor
        let s_79w6g = T::number(0.5) * m;
        let z_s = parameters.z_s;
        let alpha = parameters.alpha;
        // [1] kinetic.planets, kinetic.carrier, kinetic.arm
        let s_rrfp8 = cos(alpha);
        // [m] kinetic.sun, forces.motor
        let r_s = s_79w6g * z_s * s_rrfp8;
        let M_s = parameters.M_s;
        // [m^2] kinetic.sun, forces.motor
        let s_r_s_r_s = r_s * r_s;
        // [kg m^2] kinetic.sun
        let I_s = M_s * s_r_s_r_s;
        let a_m = parameters.a_m;
        // [1] kinetic.planets, kinetic.carrier, kinetic.arm
        let s_z14ky = s_rrfp8 * s_rrfp8;
        let m_p = parameters.m_p;
        // [kg] kinetic.planets
        let s_hppb7 = T::number(3.0) * m_p / s_z14ky;
        let z_p = parameters.z_p;
        // [m] kinetic.carrier, kinetic.arm
        let r_c = s_79w6g * (z_s + z_p);
        // [m^2] kinetic.carrier, kinetic.arm
        let s_r_c_r_c = r_c * r_c;
        // [m^2] kinetic.carrier, kinetic.arm
        let s_dmnvh = s_z14ky * s_r_c_r_c;
        let m_c = parameters.m_c;
        // [kg m^2] kinetic.carrier
        let I_c = m_c * s_r_c_r_c;
        // [kg] kinetic.carrier
        let s_f4jtk = I_c / s_dmnvh;
        let rho = parameters.rho;
        let A = parameters.A;
        let l = parameters.l;
        // [m^3] kinetic.arm
        let s_l_l_l = l * (l * l);
        // [kg] kinetic.arm
        let s_1u3rt = T::number(0.3333333333333333) * rho * A * s_l_l_l / s_dmnvh;
        // [kg] kinetic.planets, kinetic.carrier, kinetic.arm
        let pivot_x_c = s_hppb7 + s_f4jtk + s_1u3rt;
        // [1/kg] kinetic.planets, kinetic.carrier, kinetic.arm
        let s_5f1my = pivot_reciprocal(pivot_x_c);
        let c_sp = parameters.c_sp;
        let b_sp = parameters.b_sp;
        let c_pr = parameters.c_pr;
        let b_pr = parameters.b_pr;
        let k_sp = parameters.k_sp;
        let k_pr = parameters.k_pr;
        // [m] kinetic.planets
        let r_p = s_79w6g * s_rrfp8 * z_p;
        // [m^2] kinetic.planets
        let s_r_p_r_p = r_p * r_p;
        let M_p = parameters.M_p;
        // [kg m^2] kinetic.planets
        let I_p = M_p * s_r_p_r_p;
        // [kg m^2] kinetic.planets
        let s_3_I_p = T::number(3.0) * I_p;
        let b_m = parameters.b_m;
        let F_w = parameters.F_w;
        let omega = parameters.omega;
        // [kg] kinetic.sun
        let M_x_sp_x_sp = I_s / s_r_s_r_s;
        // [kg] kinetic.sun
        let M_x_sp_x_c = T::number(2.0) * I_s / s_r_s_r_s;
        // [kg] kinetic.planets
        let pivot_x_pr = s_3_I_p / s_r_p_r_p;
        // [kg] kinetic.sun, kinetic.planets
        let M_x_pr_x_pr = M_x_sp_x_sp + pivot_x_pr;
        // [kg] kinetic.sun, kinetic.planets
        let M_x_pr_x_c = M_x_sp_x_c + pivot_x_pr;
        // [kg] kinetic.*
        let M_x_c_x_c = T::number(4.0) * I_s / s_r_s_r_s + (pivot_x_pr + s_hppb7)
            + s_f4jtk + s_1u3rt;
        let z_r = parameters.z_r;
        // [1] kinetic.sun, forces.motor
        let i_sH = T::number(1.0) + z_r / z_s;
        // [m] kinetic.sun, forces.motor
        let s_r_s_i_sH = r_s * i_sH;
        // [1] kinetic.sun, forces.motor
        let s_l_per_r_s_i_sH = l / s_r_s_i_sH;
        Self {
            a_m: a_m,
            c_r_s_a_m_per_I_s: r_s * a_m / I_s,
            c_5f1my: s_5f1my,
            c_79h79: T::number(2.0) * s_5f1my,
            c_sp: c_sp,
            c_3_c_sp: T::number(3.0) * c_sp,
            b_sp: b_sp,
            c_pr: c_pr,
            c_3_c_pr: T::number(3.0) * c_pr,
            b_pr: b_pr,
            k_sp: k_sp,
            c_3_k_sp: T::number(3.0) * k_sp,
            k_pr: k_pr,
            c_3_k_pr: T::number(3.0) * k_pr,
            c_mttba: T::number(0.3333333333333333) * s_r_p_r_p / I_p,
            c_en65n: s_3_I_p * s_5f1my / s_r_p_r_p,
            c_b_m_per_I_s: b_m / I_s,
            c_r_s_r_s_per_I_s: s_r_s_r_s / I_s,
            F_w: F_w,
            c_r_s_F_w_per_I_s: r_s * F_w / I_s,
            omega: omega,
            M_x_sp_x_sp: M_x_sp_x_sp,
            M_x_sp_x_c: M_x_sp_x_c,
            M_x_pr_x_pr: M_x_pr_x_pr,
            M_x_pr_x_c: M_x_pr_x_c,
            M_x_c_x_c: M_x_c_x_c,
            c_1_per_r_s: T::number(1.0) / r_s,
            c_b_m_per_r_s: b_m / r_s,
            c_2_per_r_s: T::number(2.0) / r_s,
            c_1_per_r_p: T::number(1.0) / r_p,
            c_72jmj: T::number(1.0) / (s_rrfp8 * r_c),
            c_1_per_r_s_i_sH: T::number(1.0) / s_r_s_i_sH,
            c_l_per_r_s_i_sH: s_l_per_r_s_i_sH,
            c_minus_l_per_r_s_i_sH: -s_l_per_r_s_i_sH,
            c_tqaqf: T::number(0.5) * I_s / s_r_s_r_s,
            c_k4tad: T::number(1.5) * I_p / s_r_p_r_p,
            c_uxvby: T::number(1.5) * m_p / s_z14ky,
            c_r6kbz: T::number(0.5) * I_c / s_dmnvh,
            c_g3zhz: T::number(0.16666666666666666) * rho * A * s_l_l_l / s_dmnvh,
            c_x6cxe: T::number(1.5) * k_sp,
            c_ydxtm: T::number(1.5) * k_pr,
            positive_definite: T::all_greater(M_x_sp_x_sp, T::number(0.0))
                && T::all_greater(T::number(f64::INFINITY), M_x_sp_x_sp)
                && T::all_greater(pivot_x_pr, T::number(0.0))
                && T::all_greater(T::number(f64::INFINITY), pivot_x_pr)
                && T::all_greater(pivot_x_c, T::number(0.0))
                && T::all_greater(T::number(f64::INFINITY), pivot_x_c),
        }
    }
}
impl Coefficients {
    /// Converts these coefficients to another number type, without derivatives.
    #[inline(always)]
    pub fn cast<T: Scalar>(&self) -> Coefficients<T> {
        Coefficients {
            a_m: T::number(self.a_m),
            c_r_s_a_m_per_I_s: T::number(self.c_r_s_a_m_per_I_s),
            c_5f1my: T::number(self.c_5f1my),
            c_79h79: T::number(self.c_79h79),
            c_sp: T::number(self.c_sp),
            c_3_c_sp: T::number(self.c_3_c_sp),
            b_sp: T::number(self.b_sp),
            c_pr: T::number(self.c_pr),
            c_3_c_pr: T::number(self.c_3_c_pr),
            b_pr: T::number(self.b_pr),
            k_sp: T::number(self.k_sp),
            c_3_k_sp: T::number(self.c_3_k_sp),
            k_pr: T::number(self.k_pr),
            c_3_k_pr: T::number(self.c_3_k_pr),
            c_mttba: T::number(self.c_mttba),
            c_en65n: T::number(self.c_en65n),
            c_b_m_per_I_s: T::number(self.c_b_m_per_I_s),
            c_r_s_r_s_per_I_s: T::number(self.c_r_s_r_s_per_I_s),
            F_w: T::number(self.F_w),
            c_r_s_F_w_per_I_s: T::number(self.c_r_s_F_w_per_I_s),
            omega: T::number(self.omega),
            M_x_sp_x_sp: T::number(self.M_x_sp_x_sp),
            M_x_sp_x_c: T::number(self.M_x_sp_x_c),
            M_x_pr_x_pr: T::number(self.M_x_pr_x_pr),
            M_x_pr_x_c: T::number(self.M_x_pr_x_c),
            M_x_c_x_c: T::number(self.M_x_c_x_c),
            c_1_per_r_s: T::number(self.c_1_per_r_s),
            c_b_m_per_r_s: T::number(self.c_b_m_per_r_s),
            c_2_per_r_s: T::number(self.c_2_per_r_s),
            c_1_per_r_p: T::number(self.c_1_per_r_p),
            c_72jmj: T::number(self.c_72jmj),
            c_1_per_r_s_i_sH: T::number(self.c_1_per_r_s_i_sH),
            c_l_per_r_s_i_sH: T::number(self.c_l_per_r_s_i_sH),
            c_minus_l_per_r_s_i_sH: T::number(self.c_minus_l_per_r_s_i_sH),
            c_tqaqf: T::number(self.c_tqaqf),
            c_k4tad: T::number(self.c_k4tad),
            c_uxvby: T::number(self.c_uxvby),
            c_r6kbz: T::number(self.c_r6kbz),
            c_g3zhz: T::number(self.c_g3zhz),
            c_x6cxe: T::number(self.c_x6cxe),
            c_ydxtm: T::number(self.c_ydxtm),
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
    inputs: &Inputs,
    coefficients: &Coefficients<T>,
    rates: &mut [T; STATES],
) {
    let x_sp_dot = state[3];
    let x_sp = state[0];
    // [N] forces.damping_sp
    let s_9a1vw = coefficients.c_3_c_sp
        * T::select_greater(
            contact(x_sp, coefficients.b_sp),
            T::number(0.0),
            x_sp_dot,
            T::number(0.0),
        );
    let x_pr_dot = state[4];
    let x_pr = state[1];
    // [N] forces.damping_pr
    let s_rt6xq = coefficients.c_3_c_pr
        * T::select_greater(
            contact(x_pr, coefficients.b_pr),
            T::number(0.0),
            x_pr_dot,
            T::number(0.0),
        );
    // [N] potential.mesh_sp
    let s_jbryk = coefficients.c_3_k_sp * deadzone(x_sp, coefficients.b_sp);
    // [N] potential.mesh_pr
    let s_hfjv2 = coefficients.c_3_k_pr * deadzone(x_pr, coefficients.b_pr);
    // [N] potential.mesh_sp, potential.mesh_pr, forces.damping_sp, forces.damping_pr
    let s_byz6c = s_9a1vw + s_rt6xq + s_jbryk + s_hfjv2;
    // [N] potential.mesh_sp, forces.damping_sp
    let s_3tfc6 = s_9a1vw + s_jbryk;
    // [m/s^2] kinetic.planets, kinetic.carrier, kinetic.arm, potential.mesh_sp, potential.mesh_pr, forces.damping_sp, forces.damping_pr
    let x_pr_ddot = coefficients.c_mttba
        * (s_3tfc6 - s_rt6xq - s_hfjv2 - coefficients.c_en65n * s_byz6c);
    let x_c_dot = state[5];
    // [m/s^2] kinetic.*, potential.mesh_sp, potential.mesh_pr, forces.*
    let s_kdtcs = coefficients.c_r_s_a_m_per_I_s - coefficients.c_79h79 * s_byz6c
        - x_pr_ddot
        - coefficients.c_b_m_per_I_s * (x_sp_dot + x_pr_dot + T::number(2.0) * x_c_dot)
        - coefficients.c_r_s_r_s_per_I_s * s_3tfc6;
    // [m/s^2] kinetic.*, potential.mesh_sp, potential.mesh_pr, forces.*
    let x_sp_ddot = s_kdtcs
        + coefficients.c_r_s_F_w_per_I_s * sin(coefficients.omega * t);
    // [m/s^2] kinetic.planets, kinetic.carrier, kinetic.arm, potential.mesh_sp, potential.mesh_pr, forces.damping_sp, forces.damping_pr
    let x_c_ddot = coefficients.c_5f1my * s_byz6c;
    for i in 0..3 {
        rates[i] = state[3 + i];
    }
    rates[3] = x_sp_ddot;
    rates[4] = x_pr_ddot;
    rates[5] = x_c_ddot;
}

/// Returns the rates of the state.
///
/// `t` in s; `state` and the rates in the order of [`STATE_NAMES`].
pub fn rates<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs,
    coefficients: &Coefficients<T>,
) -> [T; STATES] {
    let mut rates = [T::number(0.0); STATES];
    rates_into(t, state, inputs, coefficients, &mut rates);
    rates
}

/// Observables in the order of [`OBSERVABLE_NAMES`]:
///
/// - `theta_s`: angle of the sun \[rad]
/// - `theta_p`: angle of the planets \[rad]
/// - `theta_c`: angle of the carrier \[rad]
/// - `tip`: deflection of the arm's end, w(l, t) \[m]
/// - `dtheta`: error of the angle by backlash, Eq. (23) \[rad]
/// - `f_la`: positioning error as Eq. (24) prints it \[m]
/// - `f_la_signed`: positioning error: dtheta is a lag, w a lead \[m]
/// - `F_sp`: force of one sun-planet mesh \[N]
/// - `F_pr`: force of one planet-ring mesh \[N]
/// - `energy`: kinetic plus potential energy \[J]
/// - `power`: power of all non-conservative forces: the rate of the energy \[W]
#[allow(unused_variables)]
pub fn observables<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs,
    coefficients: &Coefficients<T>,
) -> [T; OBSERVABLES] {
    let x_sp_dot = state[3];
    let x_sp = state[0];
    // [m/s] forces.damping_sp
    let s_kzaxq = T::select_greater(
        contact(x_sp, coefficients.b_sp),
        T::number(0.0),
        x_sp_dot,
        T::number(0.0),
    );
    let x_pr_dot = state[4];
    let x_pr = state[1];
    // [m/s] forces.damping_pr
    let s_vt299 = T::select_greater(
        contact(x_pr, coefficients.b_pr),
        T::number(0.0),
        x_pr_dot,
        T::number(0.0),
    );
    // [m] potential.mesh_sp
    let s_kc16t = deadzone(x_sp, coefficients.b_sp);
    // [m] potential.mesh_pr
    let s_g2jy4 = deadzone(x_pr, coefficients.b_pr);
    let x_c_dot = state[5];
    // [m/s] kinetic.sun, forces.motor
    let s_zjdaz = x_sp_dot + x_pr_dot + T::number(2.0) * x_c_dot;
    // [N m] forces.motor
    let motor = coefficients.a_m - coefficients.c_b_m_per_r_s * s_zjdaz
        + coefficients.F_w * sin(coefficients.omega * t);
    // [N] kinetic.sun, forces.motor
    let s_1_per_r_s_motor = coefficients.c_1_per_r_s * motor;
    // [m] kinetic.sun, forces.motor
    let s_x_sp_plus_x_pr = x_sp + x_pr;
    let x_c = state[2];
    // [m] kinetic.sun, forces.motor
    let x_s = s_x_sp_plus_x_pr + T::number(2.0) * x_c;
    // [1] kinetic.sun, forces.motor
    let theta_s = coefficients.c_1_per_r_s * x_s;
    // [m] kinetic.planets
    let x_p = x_pr + x_c;
    // [1] kinetic.planets
    let theta_p = coefficients.c_1_per_r_p * x_p;
    // [1] kinetic.carrier, kinetic.arm
    let theta_c = coefficients.c_72jmj * x_c;
    // [1] kinetic.sun, forces.motor
    let dtheta = coefficients.c_1_per_r_s_i_sH * s_x_sp_plus_x_pr;
    // [m] kinetic.sun, forces.motor
    let f_la = coefficients.c_l_per_r_s_i_sH * s_x_sp_plus_x_pr;
    // [m] kinetic.sun, forces.motor
    let f_la_signed = coefficients.c_minus_l_per_r_s_i_sH * s_x_sp_plus_x_pr;
    // [N] potential.mesh_sp, forces.damping_sp
    let F_sp = coefficients.c_sp * s_kzaxq + coefficients.k_sp * s_kc16t;
    // [N] potential.mesh_pr, forces.damping_pr
    let F_pr = coefficients.c_pr * s_vt299 + coefficients.k_pr * s_g2jy4;
    // [m/s] kinetic.planets
    let s_x_pr_dot_plus_x_c_dot = x_pr_dot + x_c_dot;
    // [m^2/s^2] kinetic.planets, kinetic.carrier, kinetic.arm
    let s_x_c_dot_x_c_dot = x_c_dot * x_c_dot;
    // [N m] kinetic.planets
    let T_planets = coefficients.c_k4tad
        * (s_x_pr_dot_plus_x_c_dot * s_x_pr_dot_plus_x_c_dot)
        + coefficients.c_uxvby * s_x_c_dot_x_c_dot;
    // [N m] kinetic.*, potential.mesh_sp, potential.mesh_pr, forces.motor
    let s_vdj5m = coefficients.c_tqaqf * (s_zjdaz * s_zjdaz) + T_planets
        + coefficients.c_r6kbz * s_x_c_dot_x_c_dot
        + coefficients.c_g3zhz * s_x_c_dot_x_c_dot
        + (coefficients.c_x6cxe * (s_kc16t * s_kc16t)
            + coefficients.c_ydxtm * (s_g2jy4 * s_g2jy4));
    // [W] kinetic.sun, forces.*
    let s_sv6wc = x_sp_dot * (s_1_per_r_s_motor - coefficients.c_3_c_sp * s_kzaxq)
        + x_pr_dot * (s_1_per_r_s_motor - coefficients.c_3_c_pr * s_vt299)
        + coefficients.c_2_per_r_s * (x_c_dot * motor);
    [
        theta_s,
        theta_p,
        theta_c,
        T::number(0.0),
        dtheta,
        f_la,
        f_la_signed,
        F_sp,
        F_pr,
        s_vdj5m,
        s_sv6wc,
    ]
}

/// Kinetic plus potential energy, in J.
#[allow(unused_variables)]
pub fn energy<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs,
    coefficients: &Coefficients<T>,
) -> T {
    let x_sp_dot = state[3];
    let x_sp = state[0];
    let x_pr_dot = state[4];
    let x_pr = state[1];
    // [m] potential.mesh_sp
    let s_kc16t = deadzone(x_sp, coefficients.b_sp);
    // [m] potential.mesh_pr
    let s_g2jy4 = deadzone(x_pr, coefficients.b_pr);
    let x_c_dot = state[5];
    // [m/s] kinetic.sun, forces.motor
    let s_zjdaz = x_sp_dot + x_pr_dot + T::number(2.0) * x_c_dot;
    // [m/s] kinetic.planets
    let s_x_pr_dot_plus_x_c_dot = x_pr_dot + x_c_dot;
    // [m^2/s^2] kinetic.planets, kinetic.carrier, kinetic.arm
    let s_x_c_dot_x_c_dot = x_c_dot * x_c_dot;
    // [N m] kinetic.planets
    let T_planets = coefficients.c_k4tad
        * (s_x_pr_dot_plus_x_c_dot * s_x_pr_dot_plus_x_c_dot)
        + coefficients.c_uxvby * s_x_c_dot_x_c_dot;
    // [N m] kinetic.*, potential.mesh_sp, potential.mesh_pr, forces.motor
    let s_vdj5m = coefficients.c_tqaqf * (s_zjdaz * s_zjdaz) + T_planets
        + coefficients.c_r6kbz * s_x_c_dot_x_c_dot
        + coefficients.c_g3zhz * s_x_c_dot_x_c_dot
        + (coefficients.c_x6cxe * (s_kc16t * s_kc16t)
            + coefficients.c_ydxtm * (s_g2jy4 * s_g2jy4));
    s_vdj5m
}

/// Power of all non-conservative forces, in W: the rate of the energy.
#[allow(unused_variables)]
pub fn power<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs,
    coefficients: &Coefficients<T>,
) -> T {
    let x_sp_dot = state[3];
    let x_sp = state[0];
    let x_pr_dot = state[4];
    let x_pr = state[1];
    let x_c_dot = state[5];
    // [N m] forces.motor
    let motor = coefficients.a_m
        - coefficients.c_b_m_per_r_s * (x_sp_dot + x_pr_dot + T::number(2.0) * x_c_dot)
        + coefficients.F_w * sin(coefficients.omega * t);
    // [N] kinetic.sun, forces.motor
    let s_1_per_r_s_motor = coefficients.c_1_per_r_s * motor;
    // [W] kinetic.sun, forces.*
    let s_eap7n = x_sp_dot
        * (s_1_per_r_s_motor
            - coefficients.c_3_c_sp
                * T::select_greater(
                    contact(x_sp, coefficients.b_sp),
                    T::number(0.0),
                    x_sp_dot,
                    T::number(0.0),
                ))
        + x_pr_dot
            * (s_1_per_r_s_motor
                - coefficients.c_3_c_pr
                    * T::select_greater(
                        contact(x_pr, coefficients.b_pr),
                        T::number(0.0),
                        x_pr_dot,
                        T::number(0.0),
                    ));
    s_eap7n + coefficients.c_2_per_r_s * (x_c_dot * motor)
}

/// Switching surfaces: the equations change when one of these changes sign.
///
/// - `x_sp - b_sp`
/// - `x_sp + b_sp`
/// - `x_pr - b_pr`
/// - `x_pr + b_pr`
#[allow(unused_variables, unused_mut)]
pub fn guards<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs,
    coefficients: &Coefficients<T>,
) -> [T; GUARDS] {
    let x_sp = state[0];
    let x_pr = state[1];
    let mut values = [T::number(0.0); GUARDS];
    values[0] = x_sp - coefficients.b_sp;
    values[1] = coefficients.b_sp + x_sp;
    values[2] = x_pr - coefficients.b_pr;
    values[3] = coefficients.b_pr + x_pr;
    values
}

/// Mass matrix in the order of the first half of [`STATE_NAMES`].
#[allow(unused_variables, unused_mut)]
pub fn mass_matrix<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs,
    coefficients: &Coefficients<T>,
) -> [[T; DEGREES_OF_FREEDOM]; DEGREES_OF_FREEDOM] {
    let mut values = [[T::number(0.0); DEGREES_OF_FREEDOM]; DEGREES_OF_FREEDOM];
    values[0][0] = coefficients.M_x_sp_x_sp;
    values[0][1] = coefficients.M_x_sp_x_sp;
    values[0][2] = coefficients.M_x_sp_x_c;
    values[1][0] = coefficients.M_x_sp_x_sp;
    values[1][1] = coefficients.M_x_pr_x_pr;
    values[1][2] = coefficients.M_x_pr_x_c;
    values[2][0] = coefficients.M_x_sp_x_c;
    values[2][1] = coefficients.M_x_pr_x_c;
    values[2][2] = coefficients.M_x_c_x_c;
    values
}

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

/// Sine for |x| up to 1e9 (4194303 in single precision), NaN beyond.
#[inline(always)]
fn sin<T: Scalar>(x: T) -> T {
    x.function::<Sin>()
}
enum Sin {}
impl Function for Sin {
    #[inline(always)]
    fn value<T: Real>(x: T) -> T {
        let v6 = x * T::number(0.6366197723675814) + T::number(6.755399441055744e15)
            - T::number(6.755399441055744e15);
        let v15 = x - v6 * T::number(1.570796251296997)
            - v6 * T::number(7.549789415861596e-8);
        let v16 = v6 * T::number(5.390304224023659e-15);
        let v17 = v6 * T::number(-1.3658654267100645e-21);
        let v18 = v16 + v17;
        let v23 = v15 - v18;
        let v26 = v16 - v18 + v17 + v6 * T::number(-1.1351118607522202e-28)
            - (v15 - v23 - v18);
        let v27 = v23 * v23;
        let v29 = v27 * T::number(-0.5);
        let v30 = T::number(1.0) + v29;
        let v46 = v27 * v27;
        let v49 = v46 * v46;
        let v51 = T::number(0.1666666666666663) + v27 * T::number(-0.008333333333321917)
            + v46
                * (T::number(0.00019841269829458453)
                    + v27 * T::number(-2.755731358278338e-6))
            + v49
                * (T::number(2.5050742477852252e-8)
                    + v27 * T::number(-1.5895956565664054e-10));
        let v70 = T::number(0.041666666666666595)
            + v27 * T::number(-0.0013888888888873342)
            + v46
                * (T::number(2.4801587289001978e-5)
                    + v27 * T::number(-2.755731421694031e-7))
            + v49
                * (T::number(2.0875705319424642e-9)
                    + v27 * T::number(-1.1358738323480003e-11));
        let v85 = T::select_greater(
            T::magnitude(x),
            T::number(1e9),
            T::number(f64::NAN),
            v6
                - (v6 * T::number(0.25) + T::number(6.755399441055744e15)
                    - T::number(6.755399441055744e15)) * T::number(4.0),
        );
        let v87 = v30 + (T::number(1.0) - v30 + v29 + (v46 * v70 + v23 * v26));
        let v88 = T::magnitude(v85);
        let v92 = T::select_equal(
            v88,
            T::number(1.0),
            v87,
            v23 - (v23 * v27 * v51 + v26 * v30),
        ) * T::select_equal(v88, T::number(1.0), v85, T::number(1.0) - v88);
        v92
    }
    #[inline(always)]
    fn single<T: Real>(x: T) -> T {
        let v8 = x * T::number(8.112963841460668e31);
        let v15 = x * T::number(0.6366197466850281) + T::number(1.2582912e7)
            - T::number(1.2582912e7) - (v8 - v8);
        let v19 = x - v15 * T::number(1.5703125)
            - v15 * T::number(0.0004825592041015625);
        let v20 = v15 * T::number(1.2665987014770508e-6);
        let v22 = v19 - v20;
        let v25 = v22 - v15 * T::number(9.89530235528946e-10);
        let v27 = v15 * T::number(2.563344285097524e-12) - (v19 - v22 - v20);
        let v28 = v25 - v27;
        let v29 = v28 * v28;
        let v39 = v28 * v29
            * (T::number(0.16666655242443085)
                + v29
                    * (T::number(-0.008332187309861183)
                        + v29 * T::number(0.00019517897453624755))) + v27;
        let v51 = v29
            * (T::number(-0.5)
                + v29
                    * (T::number(0.041666653007268906)
                        + v29
                            * (T::number(-0.001388760982081294)
                                + v29 * T::number(2.446174949000124e-5))));
        let v56 = v15 + T::number(5.0331648e7) - T::number(5.0331648e7) - v15;
        let v57 = T::magnitude(v56);
        let v64 = (v25 - v39) * (T::number(1.0) - v57)
            - (T::number(1.0) + v51) * (v56 * (T::number(2.0) - v57));
        v64
    }
    #[inline(always)]
    fn slope<T: Scalar>(x: T, _: T) -> T {
        cos(x)
    }
}

/// Cosine for |x| up to 1e9 (4194303 in single precision), NaN beyond.
#[inline(always)]
fn cos<T: Scalar>(x: T) -> T {
    x.function::<Cos>()
}
enum Cos {}
impl Function for Cos {
    #[inline(always)]
    fn value<T: Real>(x: T) -> T {
        let v6 = x * T::number(0.6366197723675814) + T::number(6.755399441055744e15)
            - T::number(6.755399441055744e15);
        let v15 = x - v6 * T::number(1.570796251296997)
            - v6 * T::number(7.549789415861596e-8);
        let v16 = v6 * T::number(5.390304224023659e-15);
        let v17 = v6 * T::number(-1.3658654267100645e-21);
        let v18 = v16 + v17;
        let v23 = v15 - v18;
        let v26 = v16 - v18 + v17 + v6 * T::number(-1.1351118607522202e-28)
            - (v15 - v23 - v18);
        let v27 = v23 * v23;
        let v29 = v27 * T::number(-0.5);
        let v30 = T::number(1.0) + v29;
        let v46 = v27 * v27;
        let v49 = v46 * v46;
        let v51 = T::number(0.1666666666666663) + v27 * T::number(-0.008333333333321917)
            + v46
                * (T::number(0.00019841269829458453)
                    + v27 * T::number(-2.755731358278338e-6))
            + v49
                * (T::number(2.5050742477852252e-8)
                    + v27 * T::number(-1.5895956565664054e-10));
        let v70 = T::number(0.041666666666666595)
            + v27 * T::number(-0.0013888888888873342)
            + v46
                * (T::number(2.4801587289001978e-5)
                    + v27 * T::number(-2.755731421694031e-7))
            + v49
                * (T::number(2.0875705319424642e-9)
                    + v27 * T::number(-1.1358738323480003e-11));
        let v85 = T::select_greater(
            T::magnitude(x),
            T::number(1e9),
            T::number(f64::NAN),
            v6
                - (v6 * T::number(0.25) + T::number(6.755399441055744e15)
                    - T::number(6.755399441055744e15)) * T::number(4.0),
        );
        let v87 = v30 + (T::number(1.0) - v30 + v29 + (v46 * v70 + v23 * v26));
        let v88 = T::magnitude(v85);
        let v93 = T::select_equal(
            v88,
            T::number(1.0),
            v23 - (v23 * v27 * v51 + v26 * v30),
            v87,
        ) * T::select_equal(v88, T::number(1.0), -v85, T::number(1.0) - v88);
        v93
    }
    #[inline(always)]
    fn single<T: Real>(x: T) -> T {
        let v8 = x * T::number(8.112963841460668e31);
        let v15 = x * T::number(0.6366197466850281) + T::number(1.2582912e7)
            - T::number(1.2582912e7) - (v8 - v8);
        let v19 = x - v15 * T::number(1.5703125)
            - v15 * T::number(0.0004825592041015625);
        let v20 = v15 * T::number(1.2665987014770508e-6);
        let v22 = v19 - v20;
        let v25 = v22 - v15 * T::number(9.89530235528946e-10);
        let v27 = v15 * T::number(2.563344285097524e-12) - (v19 - v22 - v20);
        let v28 = v25 - v27;
        let v29 = v28 * v28;
        let v39 = v28 * v29
            * (T::number(0.16666655242443085)
                + v29
                    * (T::number(-0.008332187309861183)
                        + v29 * T::number(0.00019517897453624755))) + v27;
        let v51 = v29
            * (T::number(-0.5)
                + v29
                    * (T::number(0.041666653007268906)
                        + v29
                            * (T::number(-0.001388760982081294)
                                + v29 * T::number(2.446174949000124e-5))));
        let v56 = v15 + T::number(5.0331648e7) - T::number(5.0331648e7) - v15;
        let v57 = T::magnitude(v56);
        let v64 = (T::number(1.0) + v51) * (T::number(1.0) - v57)
            + (v25 - v39) * (v56 * (T::number(2.0) - v57));
        v64
    }
    #[inline(always)]
    fn slope<T: Scalar>(x: T, _: T) -> T {
        -sin(x)
    }
}

/// Deflection beyond the play b: p - b above it, p + b below it, else 0.
#[inline(always)]
fn deadzone<T: Scalar>(p: T, b: T) -> T {
    let v2 = T::select_greater(p, b, b, p);
    p - T::select_greater(-b, v2, -b, v2)
}

/// 1 if |p| > b, else 0.
#[inline(always)]
fn contact<T: Scalar>(p: T, b: T) -> T {
    T::select_greater(T::select_greater(-p, p, -p, p), b, T::number(1.0), T::number(0.0))
}

/// 1/pivot for a positive pivot, else NaN: the mass matrix is not positive definite.
#[inline(always)]
fn pivot_reciprocal<T: Scalar>(pivot: T) -> T {
    T::select_greater(pivot, T::number(0.0), T::number(1.0) / pivot, T::number(f64::NAN))
}
