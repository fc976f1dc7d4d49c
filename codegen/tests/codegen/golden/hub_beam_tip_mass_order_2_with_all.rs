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

/// Inputs.
pub const INPUTS: usize = 1;

/// Names of the inputs, in their order.
pub const INPUT_NAMES: [&'static str; INPUTS] = ["u"];

/// Parameters.
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

/// Parameters of the model. `Default` gives the specification's values.
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
    /// The numbers of these parameters in another type, without derivatives.
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

/// Signals supplied at run time. `Default` gives zeros.
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

/// What depends on the parameters alone: prepare once, use in every call.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficients<T = f64> {
    /// `J_h`
    pub J_h: T,
    /// `J_t`
    pub J_t: T,
    /// `l`
    pub l: T,
    /// `0.3333333333333333*rho*A*l*l*l`
    pub c_1: T,
    /// `M_t`
    pub M_t: T,
    /// `rho*A`
    pub c_2: T,
    /// `rho*A*l*l`
    pub c_3: T,
    /// `l*M_t`
    pub c_4: T,
    /// `J_t*PHI_D1_AT_END/l`
    pub c_5: [T; 2],
    /// `rho*A*l*l*INTEGRAL_S1_PHI + l*M_t*PHI_AT_END + J_t*PHI_D1_AT_END/l`
    pub M_theta_q: [T; 2],
    /// `rho*A*l`
    pub c_6: T,
    /// `1/pivot_theta`
    pub c_7: T,
    /// `c`
    pub c: T,
    /// `E*I*INTEGRAL_PHI_D2_SQUARED*M_theta_q/(rho*A*l*l*l*l*INTEGRAL_PHI_SQUARED)`
    pub c_8: [T; 2],
    /// `M_t*E*I*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/(1.0 + M_t*sum_i(...*.../INT...`
    pub c_9: T,
    /// `PHI_AT_END*INTEGRAL_PHI_D2_SQUARED/INTEGRAL_PHI_SQUARED`
    pub c_10: [T; 2],
    /// `(M_t*sum_i(.../...)*(l*sum_i(...) + sum_i(...)/(...*l))*1/(1.0 + M_t*.../(...*l))/(rho*A*l) - (l*sum_i(INTEGRAL_S1_PHI*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)) - (s...`
    pub c_11: T,
    /// `J_t*E*I*PHI_D1_AT_END*INTEGRAL_PHI_D2_SQUARED/(rho*A*l*l*l*l*l*l*INTEGRAL_PHI_SQUARED)`
    pub c_12: [T; 2],
    /// `M_t*J_t*E*I*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*A*A*l*l*l*l*l*l*l)`
    pub c_13: T,
    /// `E*I*INTEGRAL_PHI_D2_SQUARED/(rho*A*l*l*l*l*INTEGRAL_PHI_SQUARED)`
    pub c_14: [T; 2],
    /// `rho*A*l*INTEGRAL_PHI_SQUARED`
    pub c_15: [T; 2],
    /// `1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))*PHI_AT_END/(rho*A*l*INTEGRAL_PHI_SQUARED)`
    pub c_16: [T; 2],
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + J_t*sum_i(.../...)/(rho*A*l*l*l) - (M_t*J_t*sum_i(...)*sum_i(...)*1/(1.0 + .../...)/(rho*rho*A...`
    pub c_17: T,
    /// `(J_t*(l*sum_i(...*.../INTEGRAL_PHI_SQUARED) + sum_i(...*(...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))/(l*l) - (M_t*J_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)*(l*sum_i(......`
    pub c_18: T,
    /// `M_t*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(...*... + .../l)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/pivot_theta`
    pub c_19: T,
    /// `-(M_t*E*I/(rho*A*l*l*l*l))`
    pub c_20: T,
    /// `1/(1.0 + J_t*sum_i(.../...)/(rho*A*l*l*l) - (M_t*J_t*sum_i(...)*sum_i(...)*1/(1.0 + .../...)/(rho*rho*A*A*l*l*l*l)))*PHI_D1_AT_END/(rho*A*l*INTEGRAL_PHI_SQUARED...`
    pub c_21: [T; 2],
    /// `l*INTEGRAL_S1_PHI/INTEGRAL_PHI_SQUARED + (l*M_t*PHI_AT_END + J_t*PHI_D1_AT_END/l)/(rho*A*l*INTEGRAL_PHI_SQUARED)`
    pub c_22: [T; 2],
    /// `1/pivot_theta*(l*INTEGRAL_S1_PHI/INTEGRAL_PHI_SQUARED + (l*M_t*PHI_AT_END + J_t*PHI_D1_AT_END/l)/(rho*A*l*INTEGRAL_PHI_SQUARED))`
    pub c_23: [T; 2],
    /// `-(E*I*INTEGRAL_PHI_D2_SQUARED/(rho*A*l*l*l*l*INTEGRAL_PHI_SQUARED))`
    pub c_24: [T; 2],
    /// `J_h + 0.3333333333333333*rho*A*l*l*l + J_t + l*l*M_t`
    pub M_theta_theta: T,
    /// `M_t*PHI_AT_END`
    pub c_25: [T; 2],
    /// `PHI_D1_AT_END/l`
    pub c_26: [T; 2],
    /// `E*I*INTEGRAL_PHI_D2_SQUARED/(l*l*l)`
    pub c_27: [T; 2],
    /// `1.0/l`
    pub c_28: T,
    /// `0.5*J_h`
    pub c_29: T,
    /// `2.0*rho*A*l*l`
    pub c_30: T,
    /// `0.5*M_t`
    pub c_31: T,
    /// `0.5*J_t`
    pub c_32: T,
    /// `0.5*E*I/(l*l*l)`
    pub c_33: T,
    /// `J_t*PHI_D1_AT_END/(l*l)`
    pub c_34: [T; 2],
    /// `E*I*INTEGRAL_PHI_D2_SQUARED*M_theta_q/(rho*A*l*l*l*l*INTEGRAL_PHI_SQUARED) - (M_t*E*I*(l*... + .../...)*1/(1.0 + .../...)*PHI_AT_END*INTEGRAL_PHI_D2_SQUARED/(rh...`
    pub c_35: [T; 2],
    /// `1/pivot_theta*(E*I*INTEGRAL_PHI_D2_SQUARED*M_theta_q/(rho*A*l*l*l*l*INTEGRAL_PHI_SQUARED) - (...*I*(... + ...)*1/(... + ...)*PHI_AT_END*INTEGRAL_PHI_D2_SQUARED/...`
    pub c_36: [T; 2],
    /// `-(c*1/pivot_theta)`
    pub c_37: T,
    /// `-(1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))*PHI_AT_END/(rho*A*l*INTEGRAL_PHI_SQUARED))`
    pub c_38: [T; 2],
    /// `...*E*I*sum_i(.../...)*1/(1.0 + .../...)*PHI_AT_END*INTEGRAL_PHI_D2_SQUARED/(rho*rho*A*A*l*l*l*l*l*l*l*INTEGRAL_PHI_SQUARED) - (J_t*E*I*PHI_D1_AT_END*INTEGRAL_P...`
    pub c_39: [T; 2],
    /// `-(M_t*E*I*PHI_AT_END*INTEGRAL_PHI_D2_SQUARED/(rho*A*l*l*l*l*INTEGRAL_PHI_SQUARED)) - (M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)*1/(1.0 + .../... - (...*.../(...*....`
    pub c_40: [T; 2],
    /// `-(1/(1.0 + J_t*sum_i(...)/(rho*A*l*...) - (M_t*J_t*...*...*1/(... + ...)/(rho*rho*A*A*l*l*l*l)))*PHI_D1_AT_END/(rho*A*l*INTEGRAL_PHI_SQUARED))`
    pub c_41: [T; 2],
    /// `-(1/pivot_theta*(l*INTEGRAL_S1_PHI/INTEGRAL_PHI_SQUARED + (l*M_t*PHI_AT_END + J_t*PHI_D1_AT_END/l)/(rho*A*l*INTEGRAL_PHI_SQUARED)))`
    pub c_42: [T; 2],
    /// `c*1/pivot_theta*(l*INTEGRAL_S1_PHI/INTEGRAL_PHI_SQUARED + (l*M_t*PHI_AT_END + J_t*PHI_D1_AT_END/l)/(rho*A*l*INTEGRAL_PHI_SQUARED)) - (1/(1.0 + M_t*.../(...*l))*...`
    pub c_43: [T; 2],
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*(J_t*(l*... + .../...)/(l*l) - (...*...*(... + ...)*1/(... + ...)/(rho*A*l*l*l)))*1/(1.0 + J_t*sum_i(.....`
    pub c_44: T,
    /// `(J_t*(l*... + .../...)/(l*l) - (...*...*(... + ...)*1/(... + ...)/(rho*A*l*l*l)))*1/(1.0 + J_t*.../(...*...) - (...*...*1/.../(...*...*...*...)))*1/pivot_theta*...`
    pub c_45: [T; 2],
    /// `(J_t*(...)/(l*l) - (...*.../(...*...)))*1/(... + ... - (.../...))*1/pivot_theta*PHI_D1_AT_END/(rho*A*l*INTEGRAL_PHI_SQUARED) - (1/pivot_theta*(l*INTEGRAL_S1_PHI...`
    pub c_46: [T; 2],
    /// `1/pivot_theta*1/pivot_theta`
    pub c_47: T,
    /// `-(1/pivot_theta*1/pivot_theta)`
    pub c_48: T,
    /// `E*I/(rho*rho*A*l*l*l*l)`
    pub c_49: T,
    /// `INTEGRAL_PHI_D2_SQUARED*M_theta_q/INTEGRAL_PHI_SQUARED`
    pub c_50: [T; 2],
    /// `E*I/(rho*l*l)`
    pub c_51: T,
    /// `INTEGRAL_S1_PHI*INTEGRAL_PHI_D2_SQUARED/INTEGRAL_PHI_SQUARED`
    pub c_52: [T; 2],
    /// `M_t*E*I*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/(1.0 + M_t*sum_i(...*.../INT...`
    pub c_53: T,
    /// `M_t*E*I*sum_i(PHI_AT_END*(l*M_t*PHI_AT_END + J_t*.../l)/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*rho*A*A*l*l*l...`
    pub c_54: T,
    /// `M_t*M_t*E*I*sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_...`
    pub c_55: T,
    /// `J_t*E*I/(rho*rho*A*l*l*l*l*l*l)`
    pub c_56: T,
    /// `PHI_D1_AT_END*INTEGRAL_PHI_D2_SQUARED/INTEGRAL_PHI_SQUARED`
    pub c_57: [T; 2],
    /// `2.0*M_t*J_t*E*I*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*rho*A*A*l*l*l*l*l*l*l)`
    pub c_58: T,
    /// `M_t*M_t*J_t*E*I*sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))*1/...`
    pub c_59: T,
    /// `1/(1.0 + J_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l*l*l) - (M_t*J_t*sum_i(.../...)*sum_i(.../...)*1/(1.0 + M_t*.../(...*l))/(rho*rho*A*A*l*l*l*l)))*(sum_i...`
    pub c_60: T,
    /// `(M_t*sum_i(...)*(l*... + .../...)*1/(1.0 + .../...)/(rho*A*l) - (l*sum_i(INTEGRAL_S1_PHI*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)) - (sum_i(PHI_D1_AT_END*(...*... + ...`
    pub c_61: T,
    /// `0.3333333333333333*A*l*l*l`
    pub c_62: T,
    /// `1/pivot_theta*1/pivot_theta*(0.3333333333333333*A*l*l*l + ...*...*...*.../(...*A*l) - (...*(...)*1/.../(...*A*l)) - (A*l*l*l*sum_i(INTEGRAL_S1_PHI*INTEGRAL_S1_P...`
    pub c_63: T,
    /// `E*I/(rho*A*A*l*l*l*l)`
    pub c_64: T,
    /// `E*I/(A*l*l)`
    pub c_65: T,
    /// `M_t*E*I*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/(1.0 + M_t*sum_i(...*.../INT...`
    pub c_66: T,
    /// `M_t*E*I*sum_i(PHI_AT_END*(l*M_t*PHI_AT_END + J_t*.../l)/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*A*A*A*l*l*l*l...`
    pub c_67: T,
    /// `M_t*M_t*E*I*sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_...`
    pub c_68: T,
    /// `J_t*E*I/(rho*A*A*l*l*l*l*l*l)`
    pub c_69: T,
    /// `2.0*M_t*J_t*E*I*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*A*A*A*l*l*l*l*l*l*l)`
    pub c_70: T,
    /// `M_t*M_t*J_t*E*I*sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))*1/...`
    pub c_71: T,
    /// `1/(1.0 + J_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l*l*l) - (M_t*J_t*sum_i(.../...)*sum_i(.../...)*1/(1.0 + M_t*.../(...*l))/(rho*rho*A*A*l*l*l*l)))*(sum_i...`
    pub c_72: T,
    /// `(M_t*sum_i(...)*(l*... + .../...)*1/(1.0 + .../...)/(rho*A*l) - (l*sum_i(INTEGRAL_S1_PHI*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)) - (sum_i(PHI_D1_AT_END*(...*... + ...`
    pub c_73: T,
    /// `0.3333333333333333*rho*l*l*l`
    pub c_74: T,
    /// `1/pivot_theta*1/pivot_theta*(0.3333333333333333*rho*l*l*l + ...*...*...*.../(rho*...*l) - (...*(...)*1/.../(rho*...*l)) - (rho*l*l*l*sum_i(INTEGRAL_S1_PHI*INTEG...`
    pub c_75: T,
    /// `4.0*E*I/(rho*A*l*l*l*l*l)`
    pub c_76: T,
    /// `E*I/(rho*A*l*l*l*l)`
    pub c_77: T,
    /// `INTEGRAL_PHI_D2_SQUARED*(2.0*rho*A*l*INTEGRAL_S1_PHI + M_t*PHI_AT_END - (J_t*PHI_D1_AT_END/(l*l)))/INTEGRAL_PHI_SQUARED`
    pub c_78: [T; 2],
    /// `4.0*M_t*E*I*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/(1.0 + M_t*sum_i(...*......`
    pub c_79: T,
    /// `M_t*E*I*1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))*(sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... - ...)/INTEGRAL_PHI_SQUARED)/(rho...`
    pub c_80: T,
    /// `M_t*M_t*E*I*sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_...`
    pub c_81: T,
    /// `6.0*J_t*E*I/(rho*A*l*l*l*l*l*l*l)`
    pub c_82: T,
    /// `7.0*M_t*J_t*E*I*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*A*A*l*l*l*l*l*l*l*l)`
    pub c_83: T,
    /// `M_t*M_t*J_t*E*I*sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))*1/...`
    pub c_84: T,
    /// `1/(1.0 + J_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l*l*l) - (M_t*J_t*sum_i(.../...)*sum_i(.../...)*1/(1.0 + M_t*.../(...*l))/(rho*rho*A*A*l*l*l*l)))*(M_t*....`
    pub c_85: T,
    /// `(M_t*sum_i(...)*(l*... + .../...)*1/(1.0 + .../...)/(rho*A*l) - (l*sum_i(INTEGRAL_S1_PHI*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)) - (sum_i(PHI_D1_AT_END*(...*... + ...`
    pub c_86: T,
    /// `1/pivot_theta*1/pivot_theta*(2.0*l*M_t + rho*A*l*l + ...*(...)*1/...*(sum_i(...) + ... - ...) + ...*...*...*.../(rho*A*l*l) - (sum_i(INTEGRAL_S1_PHI*M_theta_q/I...`
    pub c_87: T,
    /// `I/(rho*A*l*l*l*l)`
    pub c_88: T,
    /// `M_t*I*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/(1.0 + M_t*sum_i(...*.../INTEG...`
    pub c_89: T,
    /// `J_t*I/(rho*A*l*l*l*l*l*l)`
    pub c_90: T,
    /// `M_t*J_t*I*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*A*A*l*l*l*l*l*l*l)`
    pub c_91: T,
    /// `E/(rho*A*l*l*l*l)`
    pub c_92: T,
    /// `M_t*E*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/(1.0 + M_t*sum_i(...*.../INTEG...`
    pub c_93: T,
    /// `J_t*E/(rho*A*l*l*l*l*l*l)`
    pub c_94: T,
    /// `M_t*J_t*E*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*A*A*l*l*l*l*l*l*l)`
    pub c_95: T,
    /// `E*I/(rho*A*l*l*l)`
    pub c_96: T,
    /// `E*I*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/(1.0 + M_t*sum_i(...*.../INTEGRA...`
    pub c_97: T,
    /// `M_t*E*I*sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*A*A*l*l*l*l)`
    pub c_98: T,
    /// `M_t*E*I*sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_...`
    pub c_99: T,
    /// `J_t*E*I*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*A*A*l*l*l*l*l*l*l)`
    pub c_100: T,
    /// `M_t*J_t*E*I*sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))*1/(1.0...`
    pub c_101: T,
    /// `1/(1.0 + J_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l*l*l) - (M_t*J_t*sum_i(.../...)*sum_i(.../...)*1/(1.0 + M_t*.../(...*l))/(rho*rho*A*A*l*l*l*l)))*(sum_i...`
    pub c_102: T,
    /// `(M_t*sum_i(...)*(l*... + .../...)*1/(1.0 + .../...)/(rho*A*l) - (l*sum_i(INTEGRAL_S1_PHI*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)) - (sum_i(PHI_D1_AT_END*(...*... + ...`
    pub c_103: T,
    /// `1/pivot_theta*1/pivot_theta*(l*l + (...)*(...)*1/... + ...*.../(rho*A) - (...*...*...*.../(rho*A*l)) - (l*l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARE...`
    pub c_104: T,
    /// `E*I/(rho*A*l*l*l*l*l)`
    pub c_105: T,
    /// `M_t*E*I*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*A*A*l*l*l*l*l*l)`
    pub c_106: T,
    /// `E*I/(rho*A*l*l*l*l*l*l)`
    pub c_107: T,
    /// `M_t*E*I*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*A*A*l*l*l*l*l*l*l)`
    pub c_108: T,
    /// `1/(1.0 + J_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l*l*l) - (M_t*J_t*sum_i(.../...)*sum_i(.../...)*1/(1.0 + M_t*.../(...*l))/(rho*rho*A*A*l*l*l*l)))*(M_t*s...`
    pub c_109: T,
    /// `(M_t*sum_i(...)*(l*... + .../...)*1/(1.0 + .../...)/(rho*A*l) - (l*sum_i(INTEGRAL_S1_PHI*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)) - (sum_i(PHI_D1_AT_END*(...*... + ...`
    pub c_110: T,
    /// `1/pivot_theta*1/pivot_theta*(1.0 + ...*...*(... + ...)*1/(... + ...)/(rho*A*l*l) - (sum_i(INTEGRAL_S1_PHI*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)) - (sum_i(PHI_D1_A...`
    pub c_111: T,
    /// `-(1/pivot_theta)`
    pub c_112: T,
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*(J_t*(l*... + .../...)/(l*l) - (...*...*(... + ...)*1/(... + ...)/(rho*A*l*l*l)))*1/(1.0 + J_t*sum_i(.....`
    pub c_113: T,
    /// `M_t*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(...*... + .../l)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/pivot_theta*1/pivot_theta`
    pub c_114: T,
    /// `(J_t*(l*... + .../...)/(l*l) - (...*...*(... + ...)*1/(... + ...)/(rho*A*l*l*l)))*1/(1.0 + J_t*.../(...*...) - (...*...*1/.../(...*...*...*...)))*1/pivot_theta*...`
    pub c_115: [T; 2],
    /// `1/pivot_theta*1/pivot_theta*(l*INTEGRAL_S1_PHI/INTEGRAL_PHI_SQUARED + (l*M_t*PHI_AT_END + J_t*PHI_D1_AT_END/l)/(rho*A*l*INTEGRAL_PHI_SQUARED))`
    pub c_116: [T; 2],
    /// `E*I*INTEGRAL_PHI_D2_SQUARED/(rho*rho*A*l*l*l*l*INTEGRAL_PHI_SQUARED)`
    pub c_117: [T; 2],
    /// `1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))*PHI_AT_END/(rho*rho*A*l*INTEGRAL_PHI_SQUARED)`
    pub c_118: [T; 2],
    /// `M_t*sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...)/(rho*A*l))*1/(1.0 + M_t*sum_i(...)/(rho*A*l))*PHI_AT_END/(rho*rho*rho*A*A*l*l*INTE...`
    pub c_119: [T; 2],
    /// `M_t*E*I/(rho*rho*A*l*l*l*l)`
    pub c_120: T,
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + J_t*sum_i(.../...)/(rho*A*l*l*l) - (M_t*J_t*sum_i(...)*sum_i(...)*1/(1.0 + .../...)/(rho*rho*A...`
    pub c_121: T,
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + J_t*.../(...*...) - (...*...*1/.../(...*...*...*...)))*1/(1.0 + J_t*.../(...*...) - (...*...*1...`
    pub c_122: T,
    /// `1/pivot_theta*(-(J_t*sum_i(PHI_D1_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*rho*A*l*l*l)) - (...*...*sum_i(...)*(l*... + .../...)*1/(... + ...)*1/(... + ......`
    pub c_123: T,
    /// `(J_t*(l*sum_i(.../...) + sum_i(.../...)/(rho*A*l))/(l*l) - (M_t*J_t*sum_i(.../...)*(l*sum_i(...) + sum_i(...)/(...*l))*1/(1.0 + M_t*.../(...*l))/(rho*A*l*l*l)))...`
    pub c_124: T,
    /// `M_t*sum_i(PHI_AT_END*(l*M_t*PHI_AT_END + J_t*.../l)/INTEGRAL_PHI_SQUARED)*1/pivot_theta/(rho*rho*A*l)`
    pub c_125: T,
    /// `M_t*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/pivot_theta*1/pivot_theta*(0.333...`
    pub c_126: T,
    /// `1/(1.0 + J_t*sum_i(.../...)/(rho*A*l*l*l) - (M_t*J_t*sum_i(...)*sum_i(...)*1/(1.0 + .../...)/(rho*rho*A*A*l*l*l*l)))*PHI_D1_AT_END/(rho*rho*A*l*INTEGRAL_PHI_SQU...`
    pub c_127: [T; 2],
    /// `1/(1.0 + J_t*.../(...*...) - (...*...*1/.../(...*...*...*...)))*1/(1.0 + J_t*.../(...*...) - (...*...*1/.../(...*...*...*...)))*(-(J_t*sum_i(.../...)/(rho*rho*A...`
    pub c_128: [T; 2],
    /// `1/pivot_theta*(l*M_t*PHI_AT_END + J_t*PHI_D1_AT_END/l)/(rho*rho*A*l*INTEGRAL_PHI_SQUARED)`
    pub c_129: [T; 2],
    /// `1/pivot_theta*1/pivot_theta*(0.3333333333333333*A*l*l*l + ...*.../(...*l) - (...*.../(...*l)) - (A*l*l*l*sum_i(...*.../INTEGRAL_PHI_SQUARED)) - (l*sum_i(.../......`
    pub c_130: [T; 2],
    /// `E*I*INTEGRAL_PHI_D2_SQUARED/(rho*A*A*l*l*l*l*INTEGRAL_PHI_SQUARED)`
    pub c_131: [T; 2],
    /// `1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))*PHI_AT_END/(rho*A*A*l*INTEGRAL_PHI_SQUARED)`
    pub c_132: [T; 2],
    /// `M_t*sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...)/(rho*A*l))*1/(1.0 + M_t*sum_i(...)/(rho*A*l))*PHI_AT_END/(rho*rho*A*A*A*l*l*INTEGR...`
    pub c_133: [T; 2],
    /// `M_t*E*I/(rho*A*A*l*l*l*l)`
    pub c_134: T,
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + J_t*sum_i(.../...)/(rho*A*l*l*l) - (M_t*J_t*sum_i(...)*sum_i(...)*1/(1.0 + .../...)/(rho*rho*A...`
    pub c_135: T,
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + J_t*.../(...*...) - (...*...*1/.../(...*...*...*...)))*1/(1.0 + J_t*.../(...*...) - (...*...*1...`
    pub c_136: T,
    /// `1/pivot_theta*(-(J_t*sum_i(PHI_D1_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*A*A*l*l*l)) - (...*...*sum_i(...)*(l*... + .../...)*1/(... + ...)*1/(... + ...)/...`
    pub c_137: T,
    /// `(J_t*(l*sum_i(.../...) + sum_i(.../...)/(rho*A*l))/(l*l) - (M_t*J_t*sum_i(.../...)*(l*sum_i(...) + sum_i(...)/(...*l))*1/(1.0 + M_t*.../(...*l))/(rho*A*l*l*l)))...`
    pub c_138: T,
    /// `M_t*sum_i(PHI_AT_END*(l*M_t*PHI_AT_END + J_t*.../l)/INTEGRAL_PHI_SQUARED)*1/pivot_theta/(rho*A*A*l)`
    pub c_139: T,
    /// `M_t*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/pivot_theta*1/pivot_theta*(0.333...`
    pub c_140: T,
    /// `1/(1.0 + J_t*sum_i(.../...)/(rho*A*l*l*l) - (M_t*J_t*sum_i(...)*sum_i(...)*1/(1.0 + .../...)/(rho*rho*A*A*l*l*l*l)))*PHI_D1_AT_END/(rho*A*A*l*INTEGRAL_PHI_SQUAR...`
    pub c_141: [T; 2],
    /// `1/(1.0 + J_t*.../(...*...) - (...*...*1/.../(...*...*...*...)))*1/(1.0 + J_t*.../(...*...) - (...*...*1/.../(...*...*...*...)))*(-(J_t*sum_i(.../...)/(rho*A*A*l...`
    pub c_142: [T; 2],
    /// `1/pivot_theta*(l*M_t*PHI_AT_END + J_t*PHI_D1_AT_END/l)/(rho*A*A*l*INTEGRAL_PHI_SQUARED)`
    pub c_143: [T; 2],
    /// `1/pivot_theta*1/pivot_theta*(0.3333333333333333*rho*l*l*l + ...*.../(...*l) - (...*.../(...*l)) - (rho*l*l*l*sum_i(...*.../INTEGRAL_PHI_SQUARED)) - (l*sum_i(......`
    pub c_144: [T; 2],
    /// `4.0*E*I*INTEGRAL_PHI_D2_SQUARED/(rho*A*l*l*l*l*l*INTEGRAL_PHI_SQUARED)`
    pub c_145: [T; 2],
    /// `1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))*PHI_AT_END/(rho*A*l*l*INTEGRAL_PHI_SQUARED)`
    pub c_146: [T; 2],
    /// `M_t*sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...)/(rho*A*l))*1/(1.0 + M_t*sum_i(...)/(rho*A*l))*PHI_AT_END/(rho*rho*A*A*l*l*l*INTEGR...`
    pub c_147: [T; 2],
    /// `4.0*M_t*E*I/(rho*A*l*l*l*l*l)`
    pub c_148: T,
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + J_t*sum_i(.../...)/(rho*A*l*l*l) - (M_t*J_t*sum_i(...)*sum_i(...)*1/(1.0 + .../...)/(rho*rho*A...`
    pub c_149: T,
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + J_t*.../(...*...) - (...*...*1/.../(...*...*...*...)))*1/(1.0 + J_t*.../(...*...) - (...*...*1...`
    pub c_150: T,
    /// `1/pivot_theta*(J_t*(sum_i(...*.../INTEGRAL_PHI_SQUARED) + sum_i(...)/(...*l) - (sum_i(...)/(...*...)))/(l*l) - (2.0*J_t*(l*sum_i(.../...) + sum_i(.../...)/(rho*...`
    pub c_151: T,
    /// `(J_t*(l*sum_i(.../...) + sum_i(.../...)/(rho*A*l))/(l*l) - (M_t*J_t*sum_i(.../...)*(l*sum_i(...) + sum_i(...)/(...*l))*1/(1.0 + M_t*.../(...*l))/(rho*A*l*l*l)))...`
    pub c_152: T,
    /// `M_t*1/pivot_theta*(sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(M_t*... - (.../...))/INTEGRAL_PHI_SQUARED)/(rho*A*l) - (sum_i(PHI_...`
    pub c_153: T,
    /// `M_t*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/pivot_theta*1/pivot_theta*(2.0*l...`
    pub c_154: T,
    /// `1/(1.0 + J_t*sum_i(.../...)/(rho*A*l*l*l) - (M_t*J_t*sum_i(...)*sum_i(...)*1/(1.0 + .../...)/(rho*rho*A*A*l*l*l*l)))*PHI_D1_AT_END/(rho*A*l*l*INTEGRAL_PHI_SQUAR...`
    pub c_155: [T; 2],
    /// `1/(1.0 + J_t*.../(...*...) - (...*...*1/.../(...*...*...*...)))*1/(1.0 + J_t*.../(...*...) - (...*...*1/.../(...*...*...*...)))*(-(3.0*J_t*sum_i(.../...)/(rho*A...`
    pub c_156: [T; 2],
    /// `1/pivot_theta*(INTEGRAL_S1_PHI/INTEGRAL_PHI_SQUARED + (M_t*PHI_AT_END - (J_t*PHI_D1_AT_END/(l*l)))/(rho*A*l*INTEGRAL_PHI_SQUARED) - ((l*M_t*PHI_AT_END + J_t*PHI...`
    pub c_157: [T; 2],
    /// `1/pivot_theta*1/pivot_theta*(...*l*M_t + rho*A*l*l + ...*...*(... + ...) + ...*.../(...*...) - (sum_i(...*M_theta_q/INTEGRAL_PHI_SQUARED) + l*sum_i(.../...)) - ...`
    pub c_158: [T; 2],
    /// `-(M_t*I/(rho*A*l*l*l*l))`
    pub c_159: T,
    /// `-(I*INTEGRAL_PHI_D2_SQUARED/(rho*A*l*l*l*l*INTEGRAL_PHI_SQUARED))`
    pub c_160: [T; 2],
    /// `-(M_t*E/(rho*A*l*l*l*l))`
    pub c_161: T,
    /// `-(E*INTEGRAL_PHI_D2_SQUARED/(rho*A*l*l*l*l*INTEGRAL_PHI_SQUARED))`
    pub c_162: [T; 2],
    /// `sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...)/(rho*A*l))*1/(1.0 + M_t*sum_i(...)/(rho*A*l))*PHI_AT_END/(rho*rho*A*A*l*l*INTEGRAL_PHI...`
    pub c_163: [T; 2],
    /// `sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + J_t*sum_i(.../...)/(rho*A*l*l*l) - (M_t*J_t*sum_i(...)*sum_i(...)*1/(1.0 + .../...)/(rho*rho*A*A*l...`
    pub c_164: T,
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + J_t*.../(...*...) - (...*...*1/.../(...*...*...*...)))*1/(1.0 + J_t*.../(...*...) - (...*...*1...`
    pub c_165: T,
    /// `1/pivot_theta*(J_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)/(rho*A*l*l) - (J_t*sum_i(...)*(l*... + .../...)*1/(1.0 + .../...)/(rho*A*l*l*l) + M_t*J_...`
    pub c_166: T,
    /// `(J_t*(l*sum_i(.../...) + sum_i(.../...)/(rho*A*l))/(l*l) - (M_t*J_t*sum_i(.../...)*(l*sum_i(...) + sum_i(...)/(...*l))*1/(1.0 + M_t*.../(...*l))/(rho*A*l*l*l)))...`
    pub c_167: T,
    /// `(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(l*M_t*PHI_AT_END + J_t*.../l)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/pivot_theta`
    pub c_168: T,
    /// `M_t*sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)*1/pivot_theta/(rho*A)`
    pub c_169: T,
    /// `M_t*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/pivot_theta*1/pivot_theta*(l*l +...`
    pub c_170: T,
    /// `-(E*I/(rho*A*l*l*l*l))`
    pub c_171: T,
    /// `1/(1.0 + J_t*.../(...*...) - (...*...*1/.../(...*...*...*...)))*1/(1.0 + J_t*.../(...*...) - (...*...*1/.../(...*...*...*...)))*(J_t*sum_i(...)*sum_i(...)*1/(1....`
    pub c_172: [T; 2],
    /// `1/pivot_theta*PHI_AT_END/(rho*A*INTEGRAL_PHI_SQUARED)`
    pub c_173: [T; 2],
    /// `1/pivot_theta*1/pivot_theta*(l*l + ...*... + .../... - (...*.../(...*l)) - (l*l*sum_i(...*.../INTEGRAL_PHI_SQUARED)) - (sum_i(...*M_theta_q/INTEGRAL_PHI_SQUARED...`
    pub c_174: [T; 2],
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + J_t*.../(...*...) - (...*...*1/.../(...*...*...*...)))*1/(1.0 + J_t*.../(...*...) - (...*...*1...`
    pub c_175: T,
    /// `1/pivot_theta*(J_t*sum_i(PHI_D1_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)/(rho*A*l*l*l*l) + (l*sum_i(...*.../INTEGRAL_PHI_SQUARED) + sum_i(...*(...)/INTEGRAL_P...`
    pub c_176: T,
    /// `(J_t*(l*sum_i(.../...) + sum_i(.../...)/(rho*A*l))/(l*l) - (M_t*J_t*sum_i(.../...)*(l*sum_i(...) + sum_i(...)/(...*l))*1/(1.0 + M_t*.../(...*l))/(rho*A*l*l*l)))...`
    pub c_177: T,
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/pivot_theta/(rho*A*l*l)`
    pub c_178: T,
    /// `M_t*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/pivot_theta*1/pivot_theta*(1.0 +...`
    pub c_179: T,
    /// `1/(1.0 + J_t*.../(...*...) - (...*...*1/.../(...*...*...*...)))*1/(1.0 + J_t*.../(...*...) - (...*...*1/.../(...*...*...*...)))*(sum_i(PHI_D1_AT_END*PHI_D1_AT_E...`
    pub c_180: [T; 2],
    /// `1/pivot_theta*PHI_D1_AT_END/(rho*A*l*l*INTEGRAL_PHI_SQUARED)`
    pub c_181: [T; 2],
    /// `1/pivot_theta*1/pivot_theta*(1.0 + ...*(...)*1/.../(rho*A*l*l) - (sum_i(INTEGRAL_S1_PHI*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)) - (sum_i(...*M_theta_q/(l*...) + .....`
    pub c_182: [T; 2],
    /// `0.6666666666666666*rho*A*l*l*l`
    pub c_183: T,
    /// `2.0*rho*A*l*l*INTEGRAL_S1_PHI`
    pub c_184: [T; 2],
    /// `2.0*rho*A*l*INTEGRAL_PHI_SQUARED`
    pub c_185: [T; 2],
    /// `-(1.0/(l*l))`
    pub c_186: T,
    /// `2.0*A*l*l`
    pub c_187: T,
    /// `A*l`
    pub c_188: T,
    /// `2.0*rho*l*l`
    pub c_189: T,
    /// `rho*l`
    pub c_190: T,
    /// `4.0*rho*A*l`
    pub c_191: T,
    /// `J_t/(l*l)`
    pub c_192: T,
    /// `1.5*E*I/(l*l*l*l)`
    pub c_193: T,
    /// `0.5*I/(l*l*l)`
    pub c_194: T,
    /// `0.5*E/(l*l*l)`
    pub c_195: T,
    /// `J_t*E*I/(rho*A*l*l*l*l*l*l)`
    pub c_196: T,
    /// `M_t*(l*sum_i(...*.../INTEGRAL_PHI_SQUARED) + sum_i(...*(...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))*1/pivot_theta/(rho*A*l)`
    pub c_197: T,
    /// `PHI_AT_END/INTEGRAL_PHI_SQUARED`
    pub c_198: [T; 2],
    /// `1/(1.0 + J_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l*l*l) - (M_t*J_t*sum_i(.../...)*sum_i(.../...)*1/(1.0 + M_t*.../(...*l))/(rho*rho*A*A*l*l*l*l)))/(rho*A...`
    pub c_199: T,
    /// `PHI_D1_AT_END/INTEGRAL_PHI_SQUARED`
    pub c_200: [T; 2],
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))*1/(1.0 + J_t*sum_i(.../...)/(rho*A*l*l*l) - (M_t*J_t*sum_i(...)*...`
    pub c_201: T,
    /// `-c`
    pub c_202: T,
    /// `M_t*E*I*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*A*A*l*l*l*l*l)`
    pub c_203: T,
    /// Whether all prepared pivots of the mass matrix are positive and finite. If not, the mass matrix is not positive definite and the rates are not to be used.
    pub positive_definite: bool,
}
impl<T: Scalar> Coefficients<T> {
    /// The coefficients of these parameters.
    pub fn prepare(parameters: &Parameters<T>) -> Self {
        let J_h = parameters.J_h;
        let J_t = parameters.J_t;
        let rho = parameters.rho;
        let s_1 = T::number(0.3333333333333333) * rho;
        let A = parameters.A;
        let l = parameters.l;
        let s_2 = l * l;
        let s_3 = l * s_2;
        let s_4 = s_1 * A * s_3;
        let M_t = parameters.M_t;
        let s_5 = s_2 * M_t;
        let s_6 = rho * A;
        let s_7 = s_6 * s_2;
        let s_8 = l * M_t;
        let mut s_9 = [T::number(0.0); 2];
        for i in 0..2 {
            s_9[i] = J_t * T::number(PHI_D1_AT_END[i]);
        }
        let mut s_10 = [T::number(0.0); 2];
        for i in 0..2 {
            s_10[i] = s_9[i] / l;
        }
        let mut s_11 = [T::number(0.0); 2];
        for i in 0..2 {
            s_11[i] = s_8 * T::number(PHI_AT_END[i]) + s_10[i];
        }
        let mut M_theta_q = [T::number(0.0); 2];
        for i in 0..2 {
            M_theta_q[i] = s_7 * T::number(INTEGRAL_S1_PHI[i]) + s_11[i];
        }
        let s_12 = sum_of_few(
            [(); 2],
            |i| {
                T::number(INTEGRAL_S1_PHI[i]) * M_theta_q[i]
                    / T::number(INTEGRAL_PHI_SQUARED[i])
            },
        );
        let s_13 = s_6 * l;
        let s_14 = sum_of_few(
            [(); 2],
            |i| s_11[i] * M_theta_q[i] / T::number(INTEGRAL_PHI_SQUARED[i]),
        );
        let s_15 = sum_of_few(
            [(); 2],
            |i| {
                T::number(INTEGRAL_S1_PHI[i]) * T::number(PHI_AT_END[i])
                    / T::number(INTEGRAL_PHI_SQUARED[i])
            },
        );
        let s_16 = sum_of_few(
            [(); 2],
            |i| T::number(PHI_AT_END[i]) * s_11[i] / T::number(INTEGRAL_PHI_SQUARED[i]),
        );
        let s_17 = l * s_15 + s_16 / s_13;
        let s_18 = s_17 * s_17;
        let s_19 = sum_of_few(
            [(); 2],
            |i| {
                T::number(PHI_AT_END[i]) * T::number(PHI_AT_END[i])
                    / T::number(INTEGRAL_PHI_SQUARED[i])
            },
        );
        let s_20 = M_t * s_19;
        let s_21 = T::number(1.0) + s_20 / s_13;
        let s_22 = pivot_reciprocal(s_21);
        let s_23 = sum_of_few(
            [(); 2],
            |i| {
                T::number(INTEGRAL_S1_PHI[i]) * T::number(PHI_D1_AT_END[i])
                    / T::number(INTEGRAL_PHI_SQUARED[i])
            },
        );
        let s_24 = l * s_23;
        let mut s_25 = [T::number(0.0); 2];
        for i in 0..2 {
            s_25[i] = T::number(PHI_D1_AT_END[i]) * s_11[i];
        }
        let s_26 = sum_of_few([(); 2], |i| s_25[i] / T::number(INTEGRAL_PHI_SQUARED[i]));
        let s_27 = s_26 / s_13;
        let s_28 = s_24 + s_27;
        let s_29 = s_6 * s_3;
        let s_30 = M_t * J_t;
        let s_31 = sum_of_few(
            [(); 2],
            |i| {
                T::number(PHI_AT_END[i]) * T::number(PHI_D1_AT_END[i])
                    / T::number(INTEGRAL_PHI_SQUARED[i])
            },
        );
        let s_32 = s_30 * s_31;
        let s_33 = s_32 * s_17 * s_22;
        let s_34 = J_t * s_28 / s_2 - s_33 / s_29;
        let s_35 = M_t * s_31;
        let s_36 = s_35 * s_17 * s_22;
        let s_37 = s_36 / s_13 - s_24 - s_27;
        let s_38 = s_34 * s_37;
        let s_39 = sum_of_few(
            [(); 2],
            |i| {
                T::number(PHI_D1_AT_END[i]) * T::number(PHI_D1_AT_END[i])
                    / T::number(INTEGRAL_PHI_SQUARED[i])
            },
        );
        let s_40 = J_t * s_39;
        let s_41 = rho * rho;
        let s_42 = A * A;
        let s_43 = s_41 * s_42;
        let s_44 = s_2 * s_2;
        let s_45 = s_43 * s_44;
        let s_46 = s_31 * s_31;
        let s_47 = s_30 * s_46 * s_22;
        let s_48 = T::number(1.0) + s_40 / s_29 - s_47 / s_45;
        let s_49 = pivot_reciprocal(s_48);
        let s_50 = J_h + J_t + s_4 + s_5 + M_t * s_18 * s_22 - l * s_12 - s_14 / s_13;
        let pivot_theta = s_50 - s_38 * s_49;
        let s_51 = pivot_reciprocal(pivot_theta);
        let c = parameters.c;
        let s_52 = s_6 * s_44;
        let E = parameters.E;
        let I = parameters.I;
        let s_53 = E * I;
        let mut s_54 = [T::number(0.0); 2];
        for i in 0..2 {
            s_54[i] = s_52 * T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let mut s_55 = [T::number(0.0); 2];
        for i in 0..2 {
            s_55[i] = s_53 * T::number(INTEGRAL_PHI_D2_SQUARED[i]);
        }
        let mut s_56 = [T::number(0.0); 2];
        for i in 0..2 {
            s_56[i] = s_55[i] * M_theta_q[i] / s_54[i];
        }
        let s_57 = M_t * E;
        let s_58 = s_57 * I;
        let s_59 = s_58 * s_17 * s_22;
        let mut s_60 = [T::number(0.0); 2];
        for i in 0..2 {
            s_60[i] = T::number(PHI_AT_END[i]) * T::number(INTEGRAL_PHI_D2_SQUARED[i])
                / T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let s_61 = s_37 * s_49;
        let s_62 = s_2 * s_44;
        let s_63 = s_6 * s_62;
        let s_64 = J_t * E;
        let s_65 = s_64 * I;
        let mut s_66 = [T::number(0.0); 2];
        for i in 0..2 {
            s_66[i] = s_65 * T::number(PHI_D1_AT_END[i])
                * T::number(INTEGRAL_PHI_D2_SQUARED[i])
                / (s_63 * T::number(INTEGRAL_PHI_SQUARED[i]));
        }
        let s_67 = s_3 * s_44;
        let s_68 = s_43 * s_67;
        let s_69 = s_30 * E;
        let s_70 = s_69 * I;
        let s_71 = s_70 * s_31 * s_22;
        let mut s_72 = [T::number(0.0); 2];
        for i in 0..2 {
            s_72[i] = s_55[i] / s_54[i];
        }
        let mut s_73 = [T::number(0.0); 2];
        for i in 0..2 {
            s_73[i] = s_13 * T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let mut s_74 = [T::number(0.0); 2];
        for i in 0..2 {
            s_74[i] = s_22 * T::number(PHI_AT_END[i]);
        }
        let mut s_75 = [T::number(0.0); 2];
        for i in 0..2 {
            s_75[i] = s_74[i] / s_73[i];
        }
        let s_76 = s_35 * s_49;
        let s_77 = s_34 * s_51;
        let s_78 = M_t * s_17;
        let s_79 = s_78 * s_51;
        let mut s_80 = [T::number(0.0); 2];
        for i in 0..2 {
            s_80[i] = s_49 * T::number(PHI_D1_AT_END[i]);
        }
        let mut s_81 = [T::number(0.0); 2];
        for i in 0..2 {
            s_81[i] = s_80[i] / s_73[i];
        }
        let mut s_82 = [T::number(0.0); 2];
        for i in 0..2 {
            s_82[i] = l * T::number(INTEGRAL_S1_PHI[i])
                / T::number(INTEGRAL_PHI_SQUARED[i]) + s_11[i] / s_73[i];
        }
        let mut s_83 = [T::number(0.0); 2];
        for i in 0..2 {
            s_83[i] = s_51 * s_82[i];
        }
        let mut s_84 = [T::number(0.0); 2];
        for i in 0..2 {
            s_84[i] = -s_72[i];
        }
        let M_theta_theta = J_h + s_4 + (J_t + s_5);
        let mut s_85 = [T::number(0.0); 2];
        for i in 0..2 {
            s_85[i] = M_t * T::number(PHI_AT_END[i]);
        }
        let mut s_86 = [T::number(0.0); 2];
        for i in 0..2 {
            s_86[i] = T::number(PHI_D1_AT_END[i]) / l;
        }
        let mut s_87 = [T::number(0.0); 2];
        for i in 0..2 {
            s_87[i] = s_55[i] / s_3;
        }
        let s_88 = T::number(2.0) * rho;
        let s_89 = s_88 * A;
        let s_90 = s_89 * s_2;
        let s_91 = T::number(0.5) * E;
        let mut s_92 = [T::number(0.0); 2];
        for i in 0..2 {
            s_92[i] = s_9[i] / s_2;
        }
        let mut s_93 = [T::number(0.0); 2];
        for i in 0..2 {
            s_93[i] = s_71 * T::number(PHI_AT_END[i])
                * T::number(INTEGRAL_PHI_D2_SQUARED[i])
                / (s_68 * T::number(INTEGRAL_PHI_SQUARED[i])) - s_66[i];
        }
        let mut s_94 = [T::number(0.0); 2];
        for i in 0..2 {
            s_94[i] = s_56[i]
                - s_59 * T::number(PHI_AT_END[i]) * T::number(INTEGRAL_PHI_D2_SQUARED[i])
                    / s_54[i] - s_61 * s_93[i];
        }
        let mut s_95 = [T::number(0.0); 2];
        for i in 0..2 {
            s_95[i] = s_51 * s_94[i];
        }
        let s_96 = c * s_51;
        let mut s_97 = [T::number(0.0); 2];
        for i in 0..2 {
            s_97[i] = -s_75[i];
        }
        let mut s_98 = [T::number(0.0); 2];
        for i in 0..2 {
            s_98[i] = s_93[i] - s_77 * s_94[i];
        }
        let mut s_99 = [T::number(0.0); 2];
        for i in 0..2 {
            s_99[i] = -(s_58 * T::number(PHI_AT_END[i])
                * T::number(INTEGRAL_PHI_D2_SQUARED[i]) / s_54[i])
                - s_76 * s_98[i] / s_13 - s_79 * s_94[i];
        }
        let mut s_100 = [T::number(0.0); 2];
        for i in 0..2 {
            s_100[i] = -s_81[i];
        }
        let mut s_101 = [T::number(0.0); 2];
        for i in 0..2 {
            s_101[i] = -s_83[i];
        }
        let s_102 = M_t * c;
        let s_103 = s_22
            * (s_102 * s_17 * s_51 - s_102 * s_31 * s_34 * s_49 * s_51 / s_13);
        let s_104 = c * s_34 * s_49 * s_51;
        let mut s_105 = [T::number(0.0); 2];
        for i in 0..2 {
            s_105[i] = s_96 * s_82[i] - s_103 * T::number(PHI_AT_END[i]) / s_73[i]
                - s_104 * T::number(PHI_D1_AT_END[i]) / s_73[i];
        }
        let s_106 = s_35 * s_34 * s_49;
        let s_107 = s_106 * s_51 / s_13;
        let s_108 = s_22 * (s_107 - s_79);
        let s_109 = s_34 * s_49;
        let s_110 = s_109 * s_51;
        let mut s_111 = [T::number(0.0); 2];
        for i in 0..2 {
            s_111[i] = s_110 * T::number(PHI_D1_AT_END[i]) / s_73[i];
        }
        let mut s_112 = [T::number(0.0); 2];
        for i in 0..2 {
            s_112[i] = s_111[i] - s_83[i] - s_108 * T::number(PHI_AT_END[i]) / s_73[i];
        }
        let s_113 = s_51 * s_51;
        let s_114 = s_41 * A;
        let s_115 = s_114 * s_44;
        let mut s_116 = [T::number(0.0); 2];
        for i in 0..2 {
            s_116[i] = T::number(INTEGRAL_PHI_D2_SQUARED[i]) * M_theta_q[i]
                / T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let mut s_117 = [T::number(0.0); 2];
        for i in 0..2 {
            s_117[i] = T::number(INTEGRAL_S1_PHI[i])
                * T::number(INTEGRAL_PHI_D2_SQUARED[i])
                / T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let s_118 = rho * s_41;
        let s_119 = s_118 * s_42;
        let s_120 = l * s_44;
        let s_121 = s_119 * s_120;
        let s_122 = s_58 * s_16 * s_22;
        let s_123 = M_t * M_t;
        let s_124 = s_22 * s_22;
        let s_125 = s_123 * E * I * s_19 * s_17 * s_124;
        let mut s_126 = [T::number(0.0); 2];
        for i in 0..2 {
            s_126[i] = T::number(PHI_D1_AT_END[i])
                * T::number(INTEGRAL_PHI_D2_SQUARED[i])
                / T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let s_127 = T::number(2.0) * M_t;
        let s_128 = s_127 * J_t;
        let s_129 = s_128 * E * I * s_31 * s_22;
        let s_130 = A * s_42;
        let s_131 = s_41 * s_41 * s_130;
        let s_132 = s_44 * s_44;
        let s_133 = s_123 * J_t;
        let s_134 = s_133 * E * I * s_19 * s_31 * s_124;
        let s_135 = s_114 * l;
        let s_136 = s_119 * s_2;
        let s_137 = s_35 * s_16 * s_22;
        let s_138 = s_123 * s_19;
        let s_139 = s_138 * s_31 * s_17 * s_124;
        let s_140 = s_26 / s_135 + (s_139 / s_136 - s_36 / s_135 - s_137 / s_136);
        let s_141 = s_49 * s_49;
        let s_142 = s_37 * s_141;
        let s_143 = s_114 * s_3;
        let s_144 = s_119 * s_44;
        let s_145 = s_128 * s_46 * s_22;
        let s_146 = s_133 * s_19;
        let s_147 = s_146 * s_46 * s_124;
        let s_148 = -(s_40 / s_143) - (s_147 / (s_131 * s_120) - s_145 / s_144);
        let s_149 = T::number(0.3333333333333333) * A * s_3;
        let s_150 = sum_of_few(
            [(); 2],
            |i| {
                T::number(INTEGRAL_S1_PHI[i]) * T::number(INTEGRAL_S1_PHI[i])
                    / T::number(INTEGRAL_PHI_SQUARED[i])
            },
        );
        let s_151 = sum_of_few(
            [(); 2],
            |i| {
                T::number(INTEGRAL_S1_PHI[i]) * s_11[i]
                    / T::number(INTEGRAL_PHI_SQUARED[i])
            },
        );
        let s_152 = l * s_151;
        let s_153 = s_127 * s_16 * s_17 * s_22;
        let s_154 = s_138 * s_18 * s_124;
        let s_155 = J_t * s_26;
        let s_156 = s_32 * s_16 * s_22;
        let s_157 = s_146 * s_31 * s_17 * s_124;
        let s_158 = -(s_155 / s_143) - (s_157 / s_144 - s_33 / s_143 - s_156 / s_144);
        let s_159 = s_38 * s_141;
        let s_160 = s_149 + (s_154 / s_135 - s_153 / s_135) - A * s_3 * s_150
            - (s_152 / rho - s_14 / s_135);
        let s_161 = s_160 - (s_61 * s_158 + s_109 * s_140 - s_159 * s_148);
        let s_162 = s_113 * s_161;
        let s_163 = rho * s_42;
        let s_164 = s_163 * s_44;
        let s_165 = s_41 * s_130;
        let s_166 = s_165 * s_120;
        let s_167 = s_118 * (s_42 * s_42);
        let s_168 = s_163 * l;
        let s_169 = s_165 * s_2;
        let s_170 = s_26 / s_168 + (s_139 / s_169 - s_36 / s_168 - s_137 / s_169);
        let s_171 = s_163 * s_3;
        let s_172 = s_165 * s_44;
        let s_173 = -(s_40 / s_171) - (s_147 / (s_167 * s_120) - s_145 / s_172);
        let s_174 = s_1 * s_3;
        let s_175 = -(s_155 / s_171) - (s_157 / s_172 - s_33 / s_171 - s_156 / s_172);
        let s_176 = s_174 + (s_154 / s_168 - s_153 / s_168) - rho * s_3 * s_150
            - (s_152 / A - s_14 / s_168);
        let s_177 = s_176 - (s_61 * s_175 + s_109 * s_170 - s_159 * s_173);
        let s_178 = s_113 * s_177;
        let s_179 = s_6 * s_120;
        let s_180 = T::number(4.0) * E * I;
        let s_181 = s_53 / s_52;
        let s_182 = s_89 * l;
        let mut s_183 = [T::number(0.0); 2];
        for i in 0..2 {
            s_183[i] = s_85[i] - s_92[i];
        }
        let mut s_184 = [T::number(0.0); 2];
        for i in 0..2 {
            s_184[i] = s_182 * T::number(INTEGRAL_S1_PHI[i]) + s_183[i];
        }
        let mut s_185 = [T::number(0.0); 2];
        for i in 0..2 {
            s_185[i] = T::number(INTEGRAL_PHI_D2_SQUARED[i]) * s_184[i]
                / T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let s_186 = T::number(4.0) * M_t;
        let s_187 = s_186 * E * I;
        let s_188 = s_58 * s_22;
        let s_189 = sum_of_few(
            [(); 2],
            |i| T::number(PHI_AT_END[i]) * s_183[i] / T::number(INTEGRAL_PHI_SQUARED[i]),
        );
        let s_190 = s_15 + (s_189 / s_13 - s_16 / s_7);
        let s_191 = s_43 * s_62;
        let s_192 = s_118 * s_130;
        let s_193 = sum_of_few(
            [(); 2],
            |i| {
                T::number(PHI_D1_AT_END[i]) * s_183[i]
                    / T::number(INTEGRAL_PHI_SQUARED[i])
            },
        );
        let s_194 = s_193 / s_13 - s_26 / s_7;
        let s_195 = s_35 * s_22;
        let s_196 = s_43 * s_3;
        let s_197 = s_195 * s_190 / s_13 + s_139 / s_196 - s_36 / s_7 - s_23 - s_194;
        let s_198 = s_43 * s_120;
        let s_199 = -(T::number(3.0) * J_t * s_39 / s_52)
            - (s_147 / (s_192 * s_62) - s_186 * J_t * s_46 * s_22 / s_198);
        let s_200 = sum_of_few(
            [(); 2],
            |i| {
                T::number(INTEGRAL_S1_PHI[i]) * s_184[i]
                    / T::number(INTEGRAL_PHI_SQUARED[i])
            },
        );
        let s_201 = sum_of_few(
            [(); 2],
            |i| {
                M_theta_q[i] * s_183[i] / T::number(INTEGRAL_PHI_SQUARED[i])
                    + s_11[i] * s_184[i] / T::number(INTEGRAL_PHI_SQUARED[i])
            },
        );
        let s_202 = s_32 * s_22 * s_190 / s_29 + s_157 / s_198
            - T::number(3.0) * M_t * J_t * s_31 * s_17 * s_22 / s_52;
        let s_203 = J_t * (s_23 + s_194) / s_2 - T::number(2.0) * J_t * s_28 / s_3
            - s_202;
        let s_204 = T::number(2.0) * l * M_t + s_7
            + (s_127 * s_17 * s_22 * s_190 + s_154 / s_7);
        let s_205 = s_204 - (s_12 + l * s_200) - (s_201 / s_13 - s_14 / s_7)
            - (s_61 * s_203 + s_109 * s_197 - s_159 * s_199);
        let s_206 = s_113 * s_205;
        let s_207 = M_t * I;
        let s_208 = s_58 * s_19;
        let s_209 = s_20 * s_31;
        let s_210 = s_43 * s_2;
        let s_211 = s_31 * s_17 * s_22 / s_13 + s_209 * s_22 / (s_43 * l)
            - s_209 * s_17 * s_124 / s_210;
        let s_212 = s_211 - s_31 / s_6;
        let s_213 = s_30 * s_19;
        let s_214 = J_t * s_46 * s_22 / s_45 - s_213 * s_46 * s_124 / (s_192 * s_120);
        let mut s_215 = [T::number(0.0); 2];
        for i in 0..2 {
            s_215[i] = l * T::number(PHI_AT_END[i]);
        }
        let s_216 = sum_of_few(
            [(); 2],
            |i| {
                s_215[i] * M_theta_q[i] / T::number(INTEGRAL_PHI_SQUARED[i])
                    + s_215[i] * s_11[i] / T::number(INTEGRAL_PHI_SQUARED[i])
            },
        );
        let s_217 = s_18 * s_22 + s_127 * s_19 * s_17 * s_22 / s_6
            - s_20 * s_18 * s_124 / s_13;
        let s_218 = J_t * s_31;
        let s_219 = s_213 * s_31;
        let s_220 = s_218 * s_17 * s_22 / s_29 + s_219 * s_22 / s_196
            - s_219 * s_17 * s_124 / s_45;
        let s_221 = s_218 / s_7 - s_220;
        let s_222 = s_2 + s_217 - s_2 * s_15 - s_216 / s_13
            - (s_61 * s_221 + s_109 * s_212 + s_159 * s_214);
        let s_223 = s_113 * s_222;
        let s_224 = s_58 * s_31 * s_22;
        let s_225 = M_t * s_46 * s_22;
        let s_226 = s_225 / s_196 - s_39 / s_7;
        let s_227 = s_39 / s_29 - s_225 / s_45;
        let mut s_228 = [T::number(0.0); 2];
        for i in 0..2 {
            s_228[i] = l * T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let s_229 = sum_of_few(
            [(); 2],
            |i| {
                T::number(PHI_D1_AT_END[i]) * M_theta_q[i] / s_228[i]
                    + s_25[i] / s_228[i]
            },
        );
        let s_230 = s_40 / s_52 + s_28 / s_2 - (s_47 / s_198 + s_36 / s_29);
        let s_231 = T::number(1.0) + s_127 * s_31 * s_17 * s_22 / s_7 - s_23
            - s_229 / s_13 - (s_61 * s_230 + s_109 * s_226 - s_159 * s_227);
        let s_232 = s_113 * s_231;
        let s_233 = s_78 * s_113;
        let s_234 = s_109 * s_113;
        let mut s_235 = [T::number(0.0); 2];
        for i in 0..2 {
            s_235[i] = s_234 * T::number(PHI_D1_AT_END[i]) / s_73[i];
        }
        let mut s_236 = [T::number(0.0); 2];
        for i in 0..2 {
            s_236[i] = s_113 * s_82[i];
        }
        let mut s_237 = [T::number(0.0); 2];
        for i in 0..2 {
            s_237[i] = s_55[i] / (s_115 * T::number(INTEGRAL_PHI_SQUARED[i]));
        }
        let mut s_238 = [T::number(0.0); 2];
        for i in 0..2 {
            s_238[i] = s_135 * T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let mut s_239 = [T::number(0.0); 2];
        for i in 0..2 {
            s_239[i] = s_74[i] / s_238[i];
        }
        let s_240 = s_20 * s_124;
        let mut s_241 = [T::number(0.0); 2];
        for i in 0..2 {
            s_241[i] = s_240 * T::number(PHI_AT_END[i]);
        }
        let mut s_242 = [T::number(0.0); 2];
        for i in 0..2 {
            s_242[i] = s_241[i] / (s_136 * T::number(INTEGRAL_PHI_SQUARED[i]));
        }
        let s_243 = s_35 * s_141;
        let s_244 = s_34 * s_113;
        let s_245 = M_t * s_16 * s_51;
        let mut s_246 = [T::number(0.0); 2];
        for i in 0..2 {
            s_246[i] = s_80[i] / s_238[i];
        }
        let s_247 = s_141 * s_148;
        let mut s_248 = [T::number(0.0); 2];
        for i in 0..2 {
            s_248[i] = s_247 * T::number(PHI_D1_AT_END[i]) / s_73[i];
        }
        let mut s_249 = [T::number(0.0); 2];
        for i in 0..2 {
            s_249[i] = s_51 * s_11[i];
        }
        let mut s_250 = [T::number(0.0); 2];
        for i in 0..2 {
            s_250[i] = s_249[i] / s_238[i];
        }
        let mut s_251 = [T::number(0.0); 2];
        for i in 0..2 {
            s_251[i] = s_162 * s_82[i];
        }
        let mut s_252 = [T::number(0.0); 2];
        for i in 0..2 {
            s_252[i] = s_55[i] / (s_164 * T::number(INTEGRAL_PHI_SQUARED[i]));
        }
        let mut s_253 = [T::number(0.0); 2];
        for i in 0..2 {
            s_253[i] = s_168 * T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let mut s_254 = [T::number(0.0); 2];
        for i in 0..2 {
            s_254[i] = s_74[i] / s_253[i];
        }
        let mut s_255 = [T::number(0.0); 2];
        for i in 0..2 {
            s_255[i] = s_241[i] / (s_169 * T::number(INTEGRAL_PHI_SQUARED[i]));
        }
        let mut s_256 = [T::number(0.0); 2];
        for i in 0..2 {
            s_256[i] = s_80[i] / s_253[i];
        }
        let s_257 = s_141 * s_173;
        let mut s_258 = [T::number(0.0); 2];
        for i in 0..2 {
            s_258[i] = s_257 * T::number(PHI_D1_AT_END[i]) / s_73[i];
        }
        let mut s_259 = [T::number(0.0); 2];
        for i in 0..2 {
            s_259[i] = s_249[i] / s_253[i];
        }
        let mut s_260 = [T::number(0.0); 2];
        for i in 0..2 {
            s_260[i] = s_178 * s_82[i];
        }
        let mut s_261 = [T::number(0.0); 2];
        for i in 0..2 {
            s_261[i] = s_180 * T::number(INTEGRAL_PHI_D2_SQUARED[i])
                / (s_179 * T::number(INTEGRAL_PHI_SQUARED[i]));
        }
        let mut s_262 = [T::number(0.0); 2];
        for i in 0..2 {
            s_262[i] = s_7 * T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let mut s_263 = [T::number(0.0); 2];
        for i in 0..2 {
            s_263[i] = s_74[i] / s_262[i];
        }
        let mut s_264 = [T::number(0.0); 2];
        for i in 0..2 {
            s_264[i] = s_241[i] / (s_196 * T::number(INTEGRAL_PHI_SQUARED[i]));
        }
        let mut s_265 = [T::number(0.0); 2];
        for i in 0..2 {
            s_265[i] = s_80[i] / s_262[i];
        }
        let s_266 = s_141 * s_199;
        let mut s_267 = [T::number(0.0); 2];
        for i in 0..2 {
            s_267[i] = s_266 * T::number(PHI_D1_AT_END[i]) / s_73[i];
        }
        let mut s_268 = [T::number(0.0); 2];
        for i in 0..2 {
            s_268[i] = s_51
                * (T::number(INTEGRAL_S1_PHI[i]) / T::number(INTEGRAL_PHI_SQUARED[i])
                    + (s_183[i] / s_73[i] - s_11[i] / s_262[i]));
        }
        let mut s_269 = [T::number(0.0); 2];
        for i in 0..2 {
            s_269[i] = s_206 * s_82[i];
        }
        let mut s_270 = [T::number(0.0); 2];
        for i in 0..2 {
            s_270[i] = -(I * T::number(INTEGRAL_PHI_D2_SQUARED[i]) / s_54[i]);
        }
        let mut s_271 = [T::number(0.0); 2];
        for i in 0..2 {
            s_271[i] = -(E * T::number(INTEGRAL_PHI_D2_SQUARED[i]) / s_54[i]);
        }
        let s_272 = s_19 * s_124;
        let mut s_273 = [T::number(0.0); 2];
        for i in 0..2 {
            s_273[i] = s_272 * T::number(PHI_AT_END[i])
                / (s_210 * T::number(INTEGRAL_PHI_SQUARED[i]));
        }
        let s_274 = s_141 * s_214;
        let mut s_275 = [T::number(0.0); 2];
        for i in 0..2 {
            s_275[i] = s_274 * T::number(PHI_D1_AT_END[i]) / s_73[i];
        }
        let mut s_276 = [T::number(0.0); 2];
        for i in 0..2 {
            s_276[i] = s_51 * T::number(PHI_AT_END[i])
                / (s_6 * T::number(INTEGRAL_PHI_SQUARED[i]));
        }
        let mut s_277 = [T::number(0.0); 2];
        for i in 0..2 {
            s_277[i] = s_223 * s_82[i];
        }
        let s_278 = s_141 * s_227;
        let mut s_279 = [T::number(0.0); 2];
        for i in 0..2 {
            s_279[i] = s_278 * T::number(PHI_D1_AT_END[i]) / s_73[i];
        }
        let mut s_280 = [T::number(0.0); 2];
        for i in 0..2 {
            s_280[i] = s_51 * T::number(PHI_D1_AT_END[i]) / s_262[i];
        }
        let mut s_281 = [T::number(0.0); 2];
        for i in 0..2 {
            s_281[i] = s_232 * s_82[i];
        }
        let mut s_282 = [T::number(0.0); 2];
        for i in 0..2 {
            s_282[i] = s_90 * T::number(INTEGRAL_S1_PHI[i]);
        }
        let mut s_283 = [T::number(0.0); 2];
        for i in 0..2 {
            s_283[i] = s_182 * T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let mut s_284 = [T::number(0.0); 2];
        for i in 0..2 {
            s_284[i] = T::number(PHI_AT_END[i]) / T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let mut s_285 = [T::number(0.0); 2];
        for i in 0..2 {
            s_285[i] = T::number(PHI_D1_AT_END[i]) / T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let mut positive_4 = true;
        for i in 0..2 {
            positive_4 = positive_4 && T::all_greater(s_73[i], T::number(0.0))
                && T::all_greater(T::number(f64::INFINITY), s_73[i]);
        }
        Self {
            J_h: J_h,
            J_t: J_t,
            l: l,
            c_1: s_4,
            M_t: M_t,
            c_2: s_6,
            c_3: s_7,
            c_4: s_8,
            c_5: s_10,
            M_theta_q: M_theta_q,
            c_6: s_13,
            c_7: s_51,
            c: c,
            c_8: s_56,
            c_9: s_59 / s_52,
            c_10: s_60,
            c_11: s_61,
            c_12: s_66,
            c_13: s_71 / s_68,
            c_14: s_72,
            c_15: s_73,
            c_16: s_75,
            c_17: s_76 / s_13,
            c_18: s_77,
            c_19: s_79,
            c_20: -(s_58 / s_52),
            c_21: s_81,
            c_22: s_82,
            c_23: s_83,
            c_24: s_84,
            M_theta_theta: M_theta_theta,
            c_25: s_85,
            c_26: s_86,
            c_27: s_87,
            c_28: T::number(1.0) / l,
            c_29: T::number(0.5) * J_h,
            c_30: s_90,
            c_31: T::number(0.5) * M_t,
            c_32: T::number(0.5) * J_t,
            c_33: s_91 * I / s_3,
            c_34: s_92,
            c_35: s_94,
            c_36: s_95,
            c_37: -s_96,
            c_38: s_97,
            c_39: s_98,
            c_40: s_99,
            c_41: s_100,
            c_42: s_101,
            c_43: s_105,
            c_44: s_107,
            c_45: s_111,
            c_46: s_112,
            c_47: s_113,
            c_48: -s_113,
            c_49: s_53 / s_115,
            c_50: s_116,
            c_51: s_53 / (rho * s_2),
            c_52: s_117,
            c_53: s_59 / s_115,
            c_54: s_122 / s_121,
            c_55: s_125 / s_121,
            c_56: s_65 / (s_114 * s_62),
            c_57: s_126,
            c_58: s_129 / (s_119 * s_67),
            c_59: s_134 / (s_131 * s_132),
            c_60: s_49 * s_140,
            c_61: s_142 * s_148,
            c_62: s_149,
            c_63: s_162,
            c_64: s_53 / s_164,
            c_65: s_53 / (A * s_2),
            c_66: s_59 / s_164,
            c_67: s_122 / s_166,
            c_68: s_125 / s_166,
            c_69: s_65 / (s_163 * s_62),
            c_70: s_129 / (s_165 * s_67),
            c_71: s_134 / (s_167 * s_132),
            c_72: s_49 * s_170,
            c_73: s_142 * s_173,
            c_74: s_174,
            c_75: s_178,
            c_76: s_180 / s_179,
            c_77: s_181,
            c_78: s_185,
            c_79: s_187 * s_17 * s_22 / s_179,
            c_80: s_188 * s_190 / s_52,
            c_81: s_125 / s_191,
            c_82: T::number(6.0) * J_t * E * I / (s_6 * s_67),
            c_83: T::number(7.0) * M_t * J_t * E * I * s_31 * s_22 / (s_43 * s_132),
            c_84: s_134 / (s_192 * (l * s_132)),
            c_85: s_49 * s_197,
            c_86: s_142 * s_199,
            c_87: s_206,
            c_88: I / s_52,
            c_89: s_207 * s_17 * s_22 / s_52,
            c_90: J_t * I / s_63,
            c_91: s_30 * I * s_31 * s_22 / s_68,
            c_92: E / s_52,
            c_93: s_57 * s_17 * s_22 / s_52,
            c_94: s_64 / s_63,
            c_95: s_69 * s_31 * s_22 / s_68,
            c_96: s_53 / s_29,
            c_97: s_53 * s_17 * s_22 / s_52,
            c_98: s_208 * s_22 / s_45,
            c_99: s_208 * s_17 * s_124 / s_198,
            c_100: s_65 * s_31 * s_22 / s_68,
            c_101: s_70 * s_19 * s_31 * s_124 / (s_192 * s_132),
            c_102: s_49 * s_212,
            c_103: s_142 * s_214,
            c_104: s_223,
            c_105: s_53 / s_179,
            c_106: s_224 / s_191,
            c_107: s_53 / s_63,
            c_108: s_224 / s_68,
            c_109: s_49 * s_226,
            c_110: s_142 * s_227,
            c_111: s_232,
            c_112: -s_51,
            c_113: s_106 * s_113 / s_13,
            c_114: s_233,
            c_115: s_235,
            c_116: s_236,
            c_117: s_237,
            c_118: s_239,
            c_119: s_242,
            c_120: s_58 / s_115,
            c_121: s_76 / s_135,
            c_122: s_243 * s_148 / s_13,
            c_123: s_51 * s_158,
            c_124: s_244 * s_161,
            c_125: s_245 / s_135,
            c_126: s_233 * s_161,
            c_127: s_246,
            c_128: s_248,
            c_129: s_250,
            c_130: s_251,
            c_131: s_252,
            c_132: s_254,
            c_133: s_255,
            c_134: s_58 / s_164,
            c_135: s_76 / s_168,
            c_136: s_243 * s_173 / s_13,
            c_137: s_51 * s_175,
            c_138: s_244 * s_177,
            c_139: s_245 / s_168,
            c_140: s_233 * s_177,
            c_141: s_256,
            c_142: s_258,
            c_143: s_259,
            c_144: s_260,
            c_145: s_261,
            c_146: s_263,
            c_147: s_264,
            c_148: s_187 / s_179,
            c_149: s_76 / s_7,
            c_150: s_243 * s_199 / s_13,
            c_151: s_51 * s_203,
            c_152: s_244 * s_205,
            c_153: M_t * s_51 * s_190,
            c_154: s_233 * s_205,
            c_155: s_265,
            c_156: s_267,
            c_157: s_268,
            c_158: s_269,
            c_159: -(s_207 / s_52),
            c_160: s_270,
            c_161: -(s_57 / s_52),
            c_162: s_271,
            c_163: s_273,
            c_164: s_31 * s_49 / s_13,
            c_165: s_243 * s_214 / s_13,
            c_166: s_51 * s_221,
            c_167: s_244 * s_222,
            c_168: s_17 * s_51,
            c_169: s_20 * s_51 / s_6,
            c_170: s_233 * s_222,
            c_171: -s_181,
            c_172: s_275,
            c_173: s_276,
            c_174: s_277,
            c_175: s_243 * s_227 / s_13,
            c_176: s_51 * s_230,
            c_177: s_244 * s_231,
            c_178: s_35 * s_51 / s_7,
            c_179: s_233 * s_231,
            c_180: s_279,
            c_181: s_280,
            c_182: s_281,
            c_183: T::number(0.6666666666666666) * rho * A * s_3,
            c_184: s_282,
            c_185: s_283,
            c_186: -(T::number(1.0) / s_2),
            c_187: T::number(2.0) * A * s_2,
            c_188: A * l,
            c_189: s_88 * s_2,
            c_190: rho * l,
            c_191: T::number(4.0) * rho * A * l,
            c_192: J_t / s_2,
            c_193: T::number(1.5) * E * I / s_44,
            c_194: T::number(0.5) * I / s_3,
            c_195: s_91 / s_3,
            c_196: s_65 / s_63,
            c_197: s_78 * s_22 * s_51 / s_13,
            c_198: s_284,
            c_199: s_49 / s_13,
            c_200: s_285,
            c_201: s_195 * s_49 / s_210,
            c_202: -c,
            c_203: s_188 / s_198,
            positive_definite: T::all_greater(pivot_theta, T::number(0.0))
                && T::all_greater(T::number(f64::INFINITY), pivot_theta)
                && T::all_greater(s_21, T::number(0.0))
                && T::all_greater(T::number(f64::INFINITY), s_21)
                && T::all_greater(s_48, T::number(0.0))
                && T::all_greater(T::number(f64::INFINITY), s_48) && positive_4,
        }
    }
}
impl Coefficients {
    /// The numbers of these coefficients in another type, without derivatives.
    #[inline(always)]
    pub fn cast<T: Scalar>(&self) -> Coefficients<T> {
        Coefficients {
            J_h: T::number(self.J_h),
            J_t: T::number(self.J_t),
            l: T::number(self.l),
            c_1: T::number(self.c_1),
            M_t: T::number(self.M_t),
            c_2: T::number(self.c_2),
            c_3: T::number(self.c_3),
            c_4: T::number(self.c_4),
            c_5: converted(&self.c_5),
            M_theta_q: converted(&self.M_theta_q),
            c_6: T::number(self.c_6),
            c_7: T::number(self.c_7),
            c: T::number(self.c),
            c_8: converted(&self.c_8),
            c_9: T::number(self.c_9),
            c_10: converted(&self.c_10),
            c_11: T::number(self.c_11),
            c_12: converted(&self.c_12),
            c_13: T::number(self.c_13),
            c_14: converted(&self.c_14),
            c_15: converted(&self.c_15),
            c_16: converted(&self.c_16),
            c_17: T::number(self.c_17),
            c_18: T::number(self.c_18),
            c_19: T::number(self.c_19),
            c_20: T::number(self.c_20),
            c_21: converted(&self.c_21),
            c_22: converted(&self.c_22),
            c_23: converted(&self.c_23),
            c_24: converted(&self.c_24),
            M_theta_theta: T::number(self.M_theta_theta),
            c_25: converted(&self.c_25),
            c_26: converted(&self.c_26),
            c_27: converted(&self.c_27),
            c_28: T::number(self.c_28),
            c_29: T::number(self.c_29),
            c_30: T::number(self.c_30),
            c_31: T::number(self.c_31),
            c_32: T::number(self.c_32),
            c_33: T::number(self.c_33),
            c_34: converted(&self.c_34),
            c_35: converted(&self.c_35),
            c_36: converted(&self.c_36),
            c_37: T::number(self.c_37),
            c_38: converted(&self.c_38),
            c_39: converted(&self.c_39),
            c_40: converted(&self.c_40),
            c_41: converted(&self.c_41),
            c_42: converted(&self.c_42),
            c_43: converted(&self.c_43),
            c_44: T::number(self.c_44),
            c_45: converted(&self.c_45),
            c_46: converted(&self.c_46),
            c_47: T::number(self.c_47),
            c_48: T::number(self.c_48),
            c_49: T::number(self.c_49),
            c_50: converted(&self.c_50),
            c_51: T::number(self.c_51),
            c_52: converted(&self.c_52),
            c_53: T::number(self.c_53),
            c_54: T::number(self.c_54),
            c_55: T::number(self.c_55),
            c_56: T::number(self.c_56),
            c_57: converted(&self.c_57),
            c_58: T::number(self.c_58),
            c_59: T::number(self.c_59),
            c_60: T::number(self.c_60),
            c_61: T::number(self.c_61),
            c_62: T::number(self.c_62),
            c_63: T::number(self.c_63),
            c_64: T::number(self.c_64),
            c_65: T::number(self.c_65),
            c_66: T::number(self.c_66),
            c_67: T::number(self.c_67),
            c_68: T::number(self.c_68),
            c_69: T::number(self.c_69),
            c_70: T::number(self.c_70),
            c_71: T::number(self.c_71),
            c_72: T::number(self.c_72),
            c_73: T::number(self.c_73),
            c_74: T::number(self.c_74),
            c_75: T::number(self.c_75),
            c_76: T::number(self.c_76),
            c_77: T::number(self.c_77),
            c_78: converted(&self.c_78),
            c_79: T::number(self.c_79),
            c_80: T::number(self.c_80),
            c_81: T::number(self.c_81),
            c_82: T::number(self.c_82),
            c_83: T::number(self.c_83),
            c_84: T::number(self.c_84),
            c_85: T::number(self.c_85),
            c_86: T::number(self.c_86),
            c_87: T::number(self.c_87),
            c_88: T::number(self.c_88),
            c_89: T::number(self.c_89),
            c_90: T::number(self.c_90),
            c_91: T::number(self.c_91),
            c_92: T::number(self.c_92),
            c_93: T::number(self.c_93),
            c_94: T::number(self.c_94),
            c_95: T::number(self.c_95),
            c_96: T::number(self.c_96),
            c_97: T::number(self.c_97),
            c_98: T::number(self.c_98),
            c_99: T::number(self.c_99),
            c_100: T::number(self.c_100),
            c_101: T::number(self.c_101),
            c_102: T::number(self.c_102),
            c_103: T::number(self.c_103),
            c_104: T::number(self.c_104),
            c_105: T::number(self.c_105),
            c_106: T::number(self.c_106),
            c_107: T::number(self.c_107),
            c_108: T::number(self.c_108),
            c_109: T::number(self.c_109),
            c_110: T::number(self.c_110),
            c_111: T::number(self.c_111),
            c_112: T::number(self.c_112),
            c_113: T::number(self.c_113),
            c_114: T::number(self.c_114),
            c_115: converted(&self.c_115),
            c_116: converted(&self.c_116),
            c_117: converted(&self.c_117),
            c_118: converted(&self.c_118),
            c_119: converted(&self.c_119),
            c_120: T::number(self.c_120),
            c_121: T::number(self.c_121),
            c_122: T::number(self.c_122),
            c_123: T::number(self.c_123),
            c_124: T::number(self.c_124),
            c_125: T::number(self.c_125),
            c_126: T::number(self.c_126),
            c_127: converted(&self.c_127),
            c_128: converted(&self.c_128),
            c_129: converted(&self.c_129),
            c_130: converted(&self.c_130),
            c_131: converted(&self.c_131),
            c_132: converted(&self.c_132),
            c_133: converted(&self.c_133),
            c_134: T::number(self.c_134),
            c_135: T::number(self.c_135),
            c_136: T::number(self.c_136),
            c_137: T::number(self.c_137),
            c_138: T::number(self.c_138),
            c_139: T::number(self.c_139),
            c_140: T::number(self.c_140),
            c_141: converted(&self.c_141),
            c_142: converted(&self.c_142),
            c_143: converted(&self.c_143),
            c_144: converted(&self.c_144),
            c_145: converted(&self.c_145),
            c_146: converted(&self.c_146),
            c_147: converted(&self.c_147),
            c_148: T::number(self.c_148),
            c_149: T::number(self.c_149),
            c_150: T::number(self.c_150),
            c_151: T::number(self.c_151),
            c_152: T::number(self.c_152),
            c_153: T::number(self.c_153),
            c_154: T::number(self.c_154),
            c_155: converted(&self.c_155),
            c_156: converted(&self.c_156),
            c_157: converted(&self.c_157),
            c_158: converted(&self.c_158),
            c_159: T::number(self.c_159),
            c_160: converted(&self.c_160),
            c_161: T::number(self.c_161),
            c_162: converted(&self.c_162),
            c_163: converted(&self.c_163),
            c_164: T::number(self.c_164),
            c_165: T::number(self.c_165),
            c_166: T::number(self.c_166),
            c_167: T::number(self.c_167),
            c_168: T::number(self.c_168),
            c_169: T::number(self.c_169),
            c_170: T::number(self.c_170),
            c_171: T::number(self.c_171),
            c_172: converted(&self.c_172),
            c_173: converted(&self.c_173),
            c_174: converted(&self.c_174),
            c_175: T::number(self.c_175),
            c_176: T::number(self.c_176),
            c_177: T::number(self.c_177),
            c_178: T::number(self.c_178),
            c_179: T::number(self.c_179),
            c_180: converted(&self.c_180),
            c_181: converted(&self.c_181),
            c_182: converted(&self.c_182),
            c_183: T::number(self.c_183),
            c_184: converted(&self.c_184),
            c_185: converted(&self.c_185),
            c_186: T::number(self.c_186),
            c_187: T::number(self.c_187),
            c_188: T::number(self.c_188),
            c_189: T::number(self.c_189),
            c_190: T::number(self.c_190),
            c_191: T::number(self.c_191),
            c_192: T::number(self.c_192),
            c_193: T::number(self.c_193),
            c_194: T::number(self.c_194),
            c_195: T::number(self.c_195),
            c_196: T::number(self.c_196),
            c_197: T::number(self.c_197),
            c_198: converted(&self.c_198),
            c_199: T::number(self.c_199),
            c_200: converted(&self.c_200),
            c_201: T::number(self.c_201),
            c_202: T::number(self.c_202),
            c_203: T::number(self.c_203),
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
    inlined_rates_into(t, state, inputs, coefficients, rates)
}

/// [`rates_into`], inlined where it is called, to be compiled for the registers there.
#[allow(unused_variables)]
#[inline(always)]
pub fn inlined_rates_into<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
    rates: &mut [T; STATES],
) {
    let theta_dot = state[3];
    let u = inputs.u;
    let s_1 = sum_of_few([(); 2], |i| C::read(coefficients.c_8[i]) * state[1 + i]);
    let s_2 = sum_of_few([(); 2], |i| C::read(coefficients.c_10[i]) * state[1 + i]);
    let s_3 = sum_of_few([(); 2], |i| C::read(coefficients.c_12[i]) * state[1 + i]);
    let s_4 = C::read(coefficients.c_13) * s_2 - s_3;
    let s_5 = u + s_1 - C::read(coefficients.c) * theta_dot
        - C::read(coefficients.c_9) * s_2 - C::read(coefficients.c_11) * s_4;
    let theta_ddot = C::read(coefficients.c_7) * s_5;
    let s_6 = s_4 - C::read(coefficients.c_18) * s_5;
    let s_7 = C::read(coefficients.c_20) * s_2 - C::read(coefficients.c_17) * s_6
        - C::read(coefficients.c_19) * s_5;
    let mut q_ddot = [T::number(0.0); 2];
    for i in 0..2 {
        q_ddot[i] = C::read(coefficients.c_24[i]) * state[1 + i]
            - C::read(coefficients.c_16[i]) * s_7 - C::read(coefficients.c_21[i]) * s_6
            - C::read(coefficients.c_23[i]) * s_5;
    }
    for i in 0..3 {
        rates[i] = state[3 + i];
    }
    rates[3] = theta_ddot;
    for i in 0..2 {
        rates[4 + i] = q_ddot[i];
    }
}

/// Rates of the state, returned.
///
/// `t` in s; `state` and the rates in the order of [`STATE_NAMES`].
pub fn rates<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> [T; STATES] {
    inlined_rates(t, state, inputs, coefficients)
}

/// [`rates`], inlined where it is called, to be compiled for the registers there.
#[inline(always)]
pub fn inlined_rates<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
) -> [T; STATES] {
    let mut rates = [T::number(0.0); STATES];
    inlined_rates_into(t, state, inputs, coefficients, &mut rates);
    rates
}

/// The observables, in the order of [`OBSERVABLE_NAMES`]:
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
    inlined_observables(t, state, inputs, coefficients)
}

/// [`observables`], inlined where it is called, to be compiled for the registers there.
#[allow(unused_variables)]
#[inline(always)]
pub fn inlined_observables<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
) -> [T; OBSERVABLES] {
    let theta_dot = state[3];
    let u = inputs.u;
    let tip = sum_of_few([(); 2], |i| T::number(PHI_AT_END[i]) * state[1 + i]);
    let s_1 = sum_of_few([(); 2], |i| T::number(PHI_D1_AT_END[i]) * state[1 + i]);
    let tip_slope = C::read(coefficients.c_28) * s_1;
    let s_2 = theta_dot * theta_dot;
    let s_3 = sum_of_few([(); 2], |i| T::number(INTEGRAL_S1_PHI[i]) * state[4 + i]);
    let s_4 = sum_of_few(
        [(); 2],
        |i| T::number(INTEGRAL_PHI_SQUARED[i]) * (state[4 + i] * state[4 + i]),
    );
    let s_5 = C::read(coefficients.c_1) * s_2
        + C::read(coefficients.c_30) * (theta_dot * s_3)
        + C::read(coefficients.c_6) * s_4;
    let s_6 = sum_of_few([(); 2], |i| T::number(PHI_AT_END[i]) * state[4 + i]);
    let s_7 = C::read(coefficients.l) * theta_dot + s_6;
    let s_8 = sum_of_few([(); 2], |i| T::number(PHI_D1_AT_END[i]) * state[4 + i]);
    let s_9 = theta_dot + C::read(coefficients.c_28) * s_8;
    let T_tip = C::read(coefficients.c_31) * (s_7 * s_7)
        + C::read(coefficients.c_32) * (s_9 * s_9);
    let s_10 = sum_of_few(
        [(); 2],
        |i| T::number(INTEGRAL_PHI_D2_SQUARED[i]) * (state[1 + i] * state[1 + i]),
    );
    let V_bending = C::read(coefficients.c_33) * s_10;
    [
        tip,
        tip_slope,
        C::read(coefficients.c_29) * s_2 + T::number(0.5) * s_5 + T_tip + V_bending,
        theta_dot * (u - C::read(coefficients.c) * theta_dot),
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
    inlined_energy(t, state, inputs, coefficients)
}

/// [`energy`], inlined where it is called, to be compiled for the registers there.
#[allow(unused_variables)]
#[inline(always)]
pub fn inlined_energy<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
) -> T {
    let theta_dot = state[3];
    let s_1 = theta_dot * theta_dot;
    let s_2 = sum_of_few([(); 2], |i| T::number(INTEGRAL_S1_PHI[i]) * state[4 + i]);
    let s_3 = sum_of_few(
        [(); 2],
        |i| T::number(INTEGRAL_PHI_SQUARED[i]) * (state[4 + i] * state[4 + i]),
    );
    let s_4 = C::read(coefficients.c_1) * s_1
        + C::read(coefficients.c_30) * (theta_dot * s_2)
        + C::read(coefficients.c_6) * s_3;
    let s_5 = sum_of_few([(); 2], |i| T::number(PHI_AT_END[i]) * state[4 + i]);
    let s_6 = C::read(coefficients.l) * theta_dot + s_5;
    let s_7 = sum_of_few([(); 2], |i| T::number(PHI_D1_AT_END[i]) * state[4 + i]);
    let s_8 = theta_dot + C::read(coefficients.c_28) * s_7;
    let T_tip = C::read(coefficients.c_31) * (s_6 * s_6)
        + C::read(coefficients.c_32) * (s_8 * s_8);
    let s_9 = sum_of_few(
        [(); 2],
        |i| T::number(INTEGRAL_PHI_D2_SQUARED[i]) * (state[1 + i] * state[1 + i]),
    );
    let V_bending = C::read(coefficients.c_33) * s_9;
    C::read(coefficients.c_29) * s_1 + T::number(0.5) * s_4 + T_tip + V_bending
}

/// Power of all non-conservative forces, in W: the rate of the energy.
#[allow(unused_variables)]
pub fn power<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> T {
    inlined_power(t, state, inputs, coefficients)
}

/// [`power`], inlined where it is called, to be compiled for the registers there.
#[allow(unused_variables)]
#[inline(always)]
pub fn inlined_power<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
) -> T {
    let theta_dot = state[3];
    let u = inputs.u;
    theta_dot * (u - C::read(coefficients.c) * theta_dot)
}

/// Switching surfaces: the equations change where one of these changes sign.
///
#[allow(unused_variables, unused_mut)]
pub fn guards<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> [T; GUARDS] {
    inlined_guards(t, state, inputs, coefficients)
}

/// [`guards`], inlined where it is called, to be compiled for the registers there.
#[allow(unused_variables, unused_mut)]
#[inline(always)]
pub fn inlined_guards<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
) -> [T; GUARDS] {
    let mut values = [T::number(0.0); GUARDS];
    values
}

/// The mass matrix, in the order of the first half of [`STATE_NAMES`].
#[allow(unused_variables, unused_mut)]
pub fn mass_matrix<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> [[T; DEGREES_OF_FREEDOM]; DEGREES_OF_FREEDOM] {
    inlined_mass_matrix(t, state, inputs, coefficients)
}

/// [`mass_matrix`], inlined where it is called, to be compiled for the registers there.
#[allow(unused_variables, unused_mut)]
#[inline(always)]
pub fn inlined_mass_matrix<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
) -> [[T; DEGREES_OF_FREEDOM]; DEGREES_OF_FREEDOM] {
    let mut values = [[T::number(0.0); DEGREES_OF_FREEDOM]; DEGREES_OF_FREEDOM];
    values[0][0] = C::read(coefficients.M_theta_theta);
    for i in 0..2 {
        values[0][1 + i] = C::read(coefficients.M_theta_q[i]);
        values[1 + i][0] = values[0][1 + i];
    }
    for i in 0..2 {
        values[1 + i][1 + i] = values[1 + i][1 + i] + C::read(coefficients.c_15[i]);
        for j in 0..2 {
            values[1 + i][1 + j] = values[1 + i][1 + j]
                + C::read(coefficients.c_25[i]) * T::number(PHI_AT_END[j]);
            values[1 + i][1 + j] = values[1 + i][1 + j]
                + C::read(coefficients.c_5[i]) * C::read(coefficients.c_26[j]);
        }
    }
    values
}

/// The regime that a state is in: bit k is set where number k of [`guards`] is positive,
/// for up to 32 of them. Crossing one flips its bit. Of lanes, which have to be in
/// one regime, a bit is set where it is in all.
#[allow(unused_variables)]
pub fn regime<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> u32 {
    inlined_regime(t, state, inputs, coefficients)
}

/// [`regime`], inlined where it is called, to be compiled for the registers there.
#[allow(unused_variables)]
#[inline(always)]
pub fn inlined_regime<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
) -> u32 {
    0
}

/// Rates of the state within a regime, written to `rates`: those of [`rates_into`] where
/// [`regime`] is `REGIME`, for half-widths that are not negative. Beyond the regime they go
/// on as they are within, and on its surfaces they are those of its side.
///
/// `t` in s; `state` and the rates in the order of [`STATE_NAMES`].
#[allow(unused_variables)]
pub fn rates_in_regime_into<const REGIME: u32, T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
    rates: &mut [T; STATES],
) {
    inlined_rates_in_regime_into::<REGIME, _, _>(t, state, inputs, coefficients, rates)
}

/// [`rates_in_regime_into`], inlined where it is called, to be compiled for the registers there.
#[allow(unused_variables)]
#[inline(always)]
pub fn inlined_rates_in_regime_into<const REGIME: u32, T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
    rates: &mut [T; STATES],
) {
    let theta_dot = state[3];
    let u = inputs.u;
    let s_1 = sum_of_few([(); 2], |i| C::read(coefficients.c_8[i]) * state[1 + i]);
    let s_2 = sum_of_few([(); 2], |i| C::read(coefficients.c_10[i]) * state[1 + i]);
    let s_3 = sum_of_few([(); 2], |i| C::read(coefficients.c_12[i]) * state[1 + i]);
    let s_4 = C::read(coefficients.c_13) * s_2 - s_3;
    let s_5 = u + s_1 - C::read(coefficients.c) * theta_dot
        - C::read(coefficients.c_9) * s_2 - C::read(coefficients.c_11) * s_4;
    let theta_ddot = C::read(coefficients.c_7) * s_5;
    let s_6 = s_4 - C::read(coefficients.c_18) * s_5;
    let s_7 = C::read(coefficients.c_20) * s_2 - C::read(coefficients.c_17) * s_6
        - C::read(coefficients.c_19) * s_5;
    let mut q_ddot = [T::number(0.0); 2];
    for i in 0..2 {
        q_ddot[i] = C::read(coefficients.c_24[i]) * state[1 + i]
            - C::read(coefficients.c_16[i]) * s_7 - C::read(coefficients.c_21[i]) * s_6
            - C::read(coefficients.c_23[i]) * s_5;
    }
    for i in 0..3 {
        rates[i] = state[3 + i];
    }
    rates[3] = theta_ddot;
    for i in 0..2 {
        rates[4 + i] = q_ddot[i];
    }
}

/// Bias forces c - f of M q'' + c = f, in the order of the first half of
/// [`STATE_NAMES`]: the forces missing for no acceleration.
#[allow(unused_variables, unused_mut)]
pub fn bias_forces<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> [T; DEGREES_OF_FREEDOM] {
    inlined_bias_forces(t, state, inputs, coefficients)
}

/// [`bias_forces`], inlined where it is called, to be compiled for the registers there.
#[allow(unused_variables, unused_mut)]
#[inline(always)]
pub fn inlined_bias_forces<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
) -> [T; DEGREES_OF_FREEDOM] {
    let theta_dot = state[3];
    let u = inputs.u;
    let mut values = [T::number(0.0); DEGREES_OF_FREEDOM];
    values[0] = -(u - C::read(coefficients.c) * theta_dot);
    for i in 0..2 {
        values[1 + i] = C::read(coefficients.c_27[i]) * state[1 + i];
    }
    values
}

/// Inverse dynamics M a + c - f: the generalised forces that have to act besides
/// those of the model for the accelerations a, in the order of the first half of
/// [`STATE_NAMES`].
#[allow(unused_variables, unused_mut)]
pub fn inverse_dynamics<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
    accelerations: &[T; DEGREES_OF_FREEDOM],
) -> [T; DEGREES_OF_FREEDOM] {
    inlined_inverse_dynamics(t, state, inputs, coefficients, accelerations)
}

/// [`inverse_dynamics`], inlined where it is called, to be compiled for the registers there.
#[allow(unused_variables, unused_mut)]
#[inline(always)]
pub fn inlined_inverse_dynamics<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
    accelerations: &[T; DEGREES_OF_FREEDOM],
) -> [T; DEGREES_OF_FREEDOM] {
    let theta_dot = state[3];
    let u = inputs.u;
    let s = accelerations[0];
    let s_1 = sum_of_few(
        [(); 2],
        |i| C::read(coefficients.M_theta_q[i]) * accelerations[1 + i],
    );
    let s_2 = sum_of_few([(); 2], |i| T::number(PHI_AT_END[i]) * accelerations[1 + i]);
    let s_3 = sum_of_few(
        [(); 2],
        |i| T::number(PHI_D1_AT_END[i]) * accelerations[1 + i],
    );
    let mut s_4 = [T::number(0.0); 2];
    for i in 0..2 {
        s_4[i] = C::read(coefficients.c_27[i]) * state[1 + i]
            + C::read(coefficients.M_theta_q[i]) * s
            + C::read(coefficients.c_15[i]) * accelerations[1 + i]
            + C::read(coefficients.c_25[i]) * s_2;
    }
    let mut values = [T::number(0.0); DEGREES_OF_FREEDOM];
    values[0] = C::read(coefficients.M_theta_theta) * s + s_1
        - (u - C::read(coefficients.c) * theta_dot);
    for i in 0..2 {
        values[1 + i] = s_4[i] + C::read(coefficients.c_34[i]) * s_3;
    }
    values
}

/// Rates of the switching surfaces along the motion, the inputs held.
///
#[allow(unused_variables, unused_mut)]
pub fn guard_rates<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> [T; GUARDS] {
    inlined_guard_rates(t, state, inputs, coefficients)
}

/// [`guard_rates`], inlined where it is called, to be compiled for the registers there.
#[allow(unused_variables, unused_mut)]
#[inline(always)]
pub fn inlined_guard_rates<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
) -> [T; GUARDS] {
    let mut values = [T::number(0.0); GUARDS];
    values
}

/// Product of the Jacobian of the rates by state and inputs with a direction: how the
/// rates change along it.
#[allow(unused_variables)]
pub fn jacobian_vector_product<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
    direction: &[T; STATES],
    input_direction: &Inputs<T>,
) -> [T; STATES] {
    inlined_jacobian_vector_product(
        t,
        state,
        inputs,
        coefficients,
        direction,
        input_direction,
    )
}

/// [`jacobian_vector_product`], inlined where it is called, to be compiled for the registers there.
#[allow(unused_variables)]
#[inline(always)]
pub fn inlined_jacobian_vector_product<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
    direction: &[T; STATES],
    input_direction: &Inputs<T>,
) -> [T; STATES] {
    let s = direction[3];
    let s_1 = input_direction.u;
    let s_2 = sum_of_few([(); 2], |i| C::read(coefficients.c_50[i]) * direction[1 + i]);
    let s_3 = sum_of_few([(); 2], |i| C::read(coefficients.c_10[i]) * direction[1 + i]);
    let s_4 = sum_of_few([(); 2], |i| C::read(coefficients.c_57[i]) * direction[1 + i]);
    let s_5 = C::read(coefficients.c_13) * s_3 - C::read(coefficients.c_196) * s_4;
    let s_6 = s_1 + C::read(coefficients.c_77) * s_2 - C::read(coefficients.c) * s
        - C::read(coefficients.c_9) * s_3;
    let s_7 = s_6 - C::read(coefficients.c_11) * s_5;
    let s_8 = s_5 - C::read(coefficients.c_18) * s_7;
    let s_9 = C::read(coefficients.c_20) * s_3 - C::read(coefficients.c_17) * s_8
        - C::read(coefficients.c_19) * s_7;
    let mut s_10 = [T::number(0.0); 2];
    for i in 0..2 {
        s_10[i] = C::read(coefficients.c_24[i]) * direction[1 + i]
            - C::read(coefficients.c_16[i]) * s_9 - C::read(coefficients.c_21[i]) * s_8
            - C::read(coefficients.c_23[i]) * s_7;
    }
    let mut product = [T::number(0.0); STATES];
    for i in 0..3 {
        product[i] = direction[3 + i];
    }
    product[3] = C::read(coefficients.c_7) * s_7;
    for i in 0..2 {
        product[4 + i] = s_10[i];
    }
    product
}

/// Product of weights with the Jacobian of the rates by state and inputs: the gradient of
/// the weighted sum of the rates.
#[allow(unused_variables)]
pub fn vector_jacobian_product<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
    weights: &[T; STATES],
) -> ([T; STATES], Inputs<T>) {
    inlined_vector_jacobian_product(t, state, inputs, coefficients, weights)
}

/// [`vector_jacobian_product`], inlined where it is called, to be compiled for the registers there.
#[allow(unused_variables)]
#[inline(always)]
pub fn inlined_vector_jacobian_product<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
    weights: &[T; STATES],
) -> ([T; STATES], Inputs<T>) {
    let s_1 = sum_of_few([(); 2], |i| C::read(coefficients.c_22[i]) * weights[4 + i]);
    let s_2 = sum_of_few([(); 2], |i| C::read(coefficients.c_198[i]) * weights[4 + i]);
    let s_3 = sum_of_few([(); 2], |i| C::read(coefficients.c_200[i]) * weights[4 + i]);
    let s_4 = C::read(coefficients.c_201) * s_2 - C::read(coefficients.c_199) * s_3;
    let s = weights[3];
    let s_5 = C::read(coefficients.c_197) * s_2 + C::read(coefficients.c_7) * s
        - C::read(coefficients.c_7) * s_1 - C::read(coefficients.c_18) * s_4;
    let s_6 = s_4 - C::read(coefficients.c_11) * s_5;
    let s_7 = C::read(coefficients.c_13) * s_6 + C::read(coefficients.c_203) * s_2
        - C::read(coefficients.c_9) * s_5;
    let mut s_8 = [T::number(0.0); 2];
    for i in 0..2 {
        s_8[i] = C::read(coefficients.c_8[i]) * s_5 + C::read(coefficients.c_10[i]) * s_7
            - C::read(coefficients.c_12[i]) * s_6
            - C::read(coefficients.c_14[i]) * weights[4 + i];
    }
    let mut product = [T::number(0.0); STATES];
    for i in 0..3 {
        product[3 + i] = weights[i];
    }
    product[3] = product[3] + C::read(coefficients.c_202) * s_5;
    for i in 0..2 {
        product[1 + i] = s_8[i];
    }
    let input_product = Inputs { u: s_5 };
    (product, input_product)
}

/// Product of weights with the Jacobian of the rates by the parameters, in the order of
/// [`PARAMETER_NAMES`]: the gradient of the weighted sum of the rates.
#[allow(unused_variables, unused_mut)]
pub fn vector_jacobian_product_by_parameters<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
    weights: &[T; STATES],
) -> [T; PARAMETERS] {
    inlined_vector_jacobian_product_by_parameters(
        t,
        state,
        inputs,
        coefficients,
        weights,
    )
}

/// [`vector_jacobian_product_by_parameters`], inlined where it is called, to be compiled for the registers there.
#[allow(unused_variables, unused_mut)]
#[inline(always)]
pub fn inlined_vector_jacobian_product_by_parameters<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
    weights: &[T; STATES],
) -> [T; PARAMETERS] {
    let theta_dot = state[3];
    let u = inputs.u;
    let s_1 = sum_of_few([(); 2], |i| C::read(coefficients.c_8[i]) * state[1 + i]);
    let s_2 = sum_of_few([(); 2], |i| C::read(coefficients.c_10[i]) * state[1 + i]);
    let s_3 = sum_of_few([(); 2], |i| C::read(coefficients.c_12[i]) * state[1 + i]);
    let s_4 = C::read(coefficients.c_13) * s_2 - s_3;
    let s_5 = u + s_1 - C::read(coefficients.c) * theta_dot
        - C::read(coefficients.c_9) * s_2 - C::read(coefficients.c_11) * s_4;
    let s_6 = s_4 - C::read(coefficients.c_18) * s_5;
    let s_7 = C::read(coefficients.c_20) * s_2 - C::read(coefficients.c_17) * s_6
        - C::read(coefficients.c_19) * s_5;
    let s_8 = sum_of_few([(); 2], |i| C::read(coefficients.c_50[i]) * state[1 + i]);
    let s_9 = sum_of_few([(); 2], |i| C::read(coefficients.c_52[i]) * state[1 + i]);
    let s_10 = sum_of_few([(); 2], |i| C::read(coefficients.c_57[i]) * state[1 + i]);
    let s_11 = C::read(coefficients.c_56) * s_10
        + (C::read(coefficients.c_59) * s_2 - C::read(coefficients.c_58) * s_2);
    let s_12 = C::read(coefficients.c_51) * s_9 - C::read(coefficients.c_49) * s_8
        - (C::read(coefficients.c_55) * s_2 - C::read(coefficients.c_53) * s_2
            - C::read(coefficients.c_54) * s_2);
    let s_13 = s_12
        - (C::read(coefficients.c_11) * s_11 + C::read(coefficients.c_60) * s_4
            - C::read(coefficients.c_61) * s_4);
    let s_14 = C::read(coefficients.c_69) * s_10
        + (C::read(coefficients.c_71) * s_2 - C::read(coefficients.c_70) * s_2);
    let s_15 = C::read(coefficients.c_65) * s_9 - C::read(coefficients.c_64) * s_8
        - (C::read(coefficients.c_68) * s_2 - C::read(coefficients.c_66) * s_2
            - C::read(coefficients.c_67) * s_2);
    let s_16 = s_15
        - (C::read(coefficients.c_11) * s_14 + C::read(coefficients.c_72) * s_4
            - C::read(coefficients.c_73) * s_4);
    let s_17 = sum_of_few([(); 2], |i| C::read(coefficients.c_78[i]) * state[1 + i]);
    let s_18 = C::read(coefficients.c_82) * s_10
        + (C::read(coefficients.c_84) * s_2 - C::read(coefficients.c_83) * s_2);
    let s_19 = C::read(coefficients.c_77) * s_17 - C::read(coefficients.c_76) * s_8
        - (C::read(coefficients.c_80) * s_2 + C::read(coefficients.c_81) * s_2
            - C::read(coefficients.c_79) * s_2);
    let s_20 = s_19
        - (C::read(coefficients.c_11) * s_18 + C::read(coefficients.c_85) * s_4
            - C::read(coefficients.c_86) * s_4);
    let s_21 = C::read(coefficients.c_91) * s_2 - C::read(coefficients.c_90) * s_10;
    let s_22 = C::read(coefficients.c_88) * s_8 - C::read(coefficients.c_89) * s_2
        - C::read(coefficients.c_11) * s_21;
    let s_23 = C::read(coefficients.c_95) * s_2 - C::read(coefficients.c_94) * s_10;
    let s_24 = C::read(coefficients.c_92) * s_8 - C::read(coefficients.c_93) * s_2
        - C::read(coefficients.c_11) * s_23;
    let s_25 = C::read(coefficients.c_100) * s_2 - C::read(coefficients.c_101) * s_2;
    let s_26 = C::read(coefficients.c_96) * s_2
        - (C::read(coefficients.c_97) * s_2 + C::read(coefficients.c_98) * s_2
            - C::read(coefficients.c_99) * s_2);
    let s_27 = s_26
        - (C::read(coefficients.c_11) * s_25 + C::read(coefficients.c_102) * s_4
            + C::read(coefficients.c_103) * s_4);
    let s_28 = C::read(coefficients.c_108) * s_2 - C::read(coefficients.c_107) * s_10;
    let s_29 = C::read(coefficients.c_105) * s_10 - C::read(coefficients.c_106) * s_2
        - (C::read(coefficients.c_11) * s_28 + C::read(coefficients.c_109) * s_4
            - C::read(coefficients.c_110) * s_4);
    let s_30 = C::read(coefficients.c_114) * s_5 - C::read(coefficients.c_113) * s_5;
    let s_31 = s_11
        - (C::read(coefficients.c_123) * s_5 + C::read(coefficients.c_18) * s_13
            - C::read(coefficients.c_124) * s_5);
    let s_32 = C::read(coefficients.c_120) * s_2
        - (C::read(coefficients.c_17) * s_31 - C::read(coefficients.c_121) * s_6
            - C::read(coefficients.c_122) * s_6);
    let s_33 = s_32
        - (C::read(coefficients.c_19) * s_13 - C::read(coefficients.c_125) * s_5
            - C::read(coefficients.c_126) * s_5);
    let mut s_34 = [T::number(0.0); 2];
    for i in 0..2 {
        s_34[i] = C::read(coefficients.c_117[i]) * state[1 + i]
            - (C::read(coefficients.c_119[i]) * s_7
                + C::read(coefficients.c_16[i]) * s_33
                - C::read(coefficients.c_118[i]) * s_7);
    }
    let mut s_35 = [T::number(0.0); 2];
    for i in 0..2 {
        s_35[i] = s_34[i]
            - (C::read(coefficients.c_21[i]) * s_31
                - C::read(coefficients.c_127[i]) * s_6
                - C::read(coefficients.c_128[i]) * s_6);
    }
    let mut s_36 = [T::number(0.0); 2];
    for i in 0..2 {
        s_36[i] = s_35[i]
            - (C::read(coefficients.c_23[i]) * s_13
                - C::read(coefficients.c_129[i]) * s_5
                - C::read(coefficients.c_130[i]) * s_5);
    }
    let s_37 = s_14
        - (C::read(coefficients.c_137) * s_5 + C::read(coefficients.c_18) * s_16
            - C::read(coefficients.c_138) * s_5);
    let s_38 = C::read(coefficients.c_134) * s_2
        - (C::read(coefficients.c_17) * s_37 - C::read(coefficients.c_135) * s_6
            - C::read(coefficients.c_136) * s_6);
    let s_39 = s_38
        - (C::read(coefficients.c_19) * s_16 - C::read(coefficients.c_139) * s_5
            - C::read(coefficients.c_140) * s_5);
    let mut s_40 = [T::number(0.0); 2];
    for i in 0..2 {
        s_40[i] = C::read(coefficients.c_131[i]) * state[1 + i]
            - (C::read(coefficients.c_133[i]) * s_7
                + C::read(coefficients.c_16[i]) * s_39
                - C::read(coefficients.c_132[i]) * s_7);
    }
    let mut s_41 = [T::number(0.0); 2];
    for i in 0..2 {
        s_41[i] = s_40[i]
            - (C::read(coefficients.c_21[i]) * s_37
                - C::read(coefficients.c_141[i]) * s_6
                - C::read(coefficients.c_142[i]) * s_6);
    }
    let mut s_42 = [T::number(0.0); 2];
    for i in 0..2 {
        s_42[i] = s_41[i]
            - (C::read(coefficients.c_23[i]) * s_16
                - C::read(coefficients.c_143[i]) * s_5
                - C::read(coefficients.c_144[i]) * s_5);
    }
    let s_43 = s_18
        - (C::read(coefficients.c_151) * s_5 + C::read(coefficients.c_18) * s_20
            - C::read(coefficients.c_152) * s_5);
    let s_44 = C::read(coefficients.c_148) * s_2
        - (C::read(coefficients.c_17) * s_43 - C::read(coefficients.c_149) * s_6
            - C::read(coefficients.c_150) * s_6);
    let s_45 = s_44
        - (C::read(coefficients.c_153) * s_5 + C::read(coefficients.c_19) * s_20
            - C::read(coefficients.c_154) * s_5);
    let mut s_46 = [T::number(0.0); 2];
    for i in 0..2 {
        s_46[i] = C::read(coefficients.c_145[i]) * state[1 + i]
            - (C::read(coefficients.c_147[i]) * s_7
                + C::read(coefficients.c_16[i]) * s_45
                - C::read(coefficients.c_146[i]) * s_7);
    }
    let mut s_47 = [T::number(0.0); 2];
    for i in 0..2 {
        s_47[i] = s_46[i]
            - (C::read(coefficients.c_21[i]) * s_43
                - C::read(coefficients.c_155[i]) * s_6
                - C::read(coefficients.c_156[i]) * s_6);
    }
    let mut s_48 = [T::number(0.0); 2];
    for i in 0..2 {
        s_48[i] = s_47[i]
            - (C::read(coefficients.c_157[i]) * s_5
                + C::read(coefficients.c_23[i]) * s_20
                - C::read(coefficients.c_158[i]) * s_5);
    }
    let s_49 = s_21 - C::read(coefficients.c_18) * s_22;
    let s_50 = C::read(coefficients.c_159) * s_2 - C::read(coefficients.c_17) * s_49
        - C::read(coefficients.c_19) * s_22;
    let mut s_51 = [T::number(0.0); 2];
    for i in 0..2 {
        s_51[i] = C::read(coefficients.c_160[i]) * state[1 + i]
            - C::read(coefficients.c_16[i]) * s_50 - C::read(coefficients.c_21[i]) * s_49
            - C::read(coefficients.c_23[i]) * s_22;
    }
    let s_52 = s_23 - C::read(coefficients.c_18) * s_24;
    let s_53 = C::read(coefficients.c_161) * s_2 - C::read(coefficients.c_17) * s_52
        - C::read(coefficients.c_19) * s_24;
    let mut s_54 = [T::number(0.0); 2];
    for i in 0..2 {
        s_54[i] = C::read(coefficients.c_162[i]) * state[1 + i]
            - C::read(coefficients.c_16[i]) * s_53 - C::read(coefficients.c_21[i]) * s_52
            - C::read(coefficients.c_23[i]) * s_24;
    }
    let s_55 = s_25
        - (C::read(coefficients.c_166) * s_5 + C::read(coefficients.c_18) * s_27
            - C::read(coefficients.c_167) * s_5);
    let s_56 = C::read(coefficients.c_168) * s_5 + C::read(coefficients.c_169) * s_5
        + C::read(coefficients.c_19) * s_27 - C::read(coefficients.c_170) * s_5;
    let s_57 = C::read(coefficients.c_171) * s_2
        - (C::read(coefficients.c_164) * s_6 + C::read(coefficients.c_165) * s_6
            + C::read(coefficients.c_17) * s_55);
    let s_58 = s_57 - s_56;
    let mut s_59 = [T::number(0.0); 2];
    for i in 0..2 {
        s_59[i] = -(C::read(coefficients.c_16[i]) * s_58
            - C::read(coefficients.c_163[i]) * s_7)
            - (C::read(coefficients.c_172[i]) * s_6
                + C::read(coefficients.c_21[i]) * s_55);
    }
    let mut s_60 = [T::number(0.0); 2];
    for i in 0..2 {
        s_60[i] = s_59[i]
            - (C::read(coefficients.c_173[i]) * s_5
                + C::read(coefficients.c_23[i]) * s_27
                - C::read(coefficients.c_174[i]) * s_5);
    }
    let s_61 = s_28
        - (C::read(coefficients.c_176) * s_5 + C::read(coefficients.c_18) * s_29
            - C::read(coefficients.c_177) * s_5);
    let s_62 = -(C::read(coefficients.c_17) * s_61 - C::read(coefficients.c_175) * s_6)
        - (C::read(coefficients.c_178) * s_5 + C::read(coefficients.c_19) * s_29
            - C::read(coefficients.c_179) * s_5);
    let mut s_63 = [T::number(0.0); 2];
    for i in 0..2 {
        s_63[i] = C::read(coefficients.c_38[i]) * s_62
            - (C::read(coefficients.c_21[i]) * s_61
                - C::read(coefficients.c_180[i]) * s_6)
            - (C::read(coefficients.c_181[i]) * s_5
                + C::read(coefficients.c_23[i]) * s_29
                - C::read(coefficients.c_182[i]) * s_5);
    }
    let s_64 = C::read(coefficients.c_19) * theta_dot
        - C::read(coefficients.c_44) * theta_dot;
    let s = weights[3];
    let s_65 = s_5 * s;
    let mut s_66 = [T::number(0.0); 2];
    for i in 0..2 {
        s_66[i] = (C::read(coefficients.c_116[i]) * s_5
            - C::read(coefficients.c_16[i]) * s_30
            - C::read(coefficients.c_115[i]) * s_5) * weights[4 + i];
    }
    let s_67 = sum_of_few([(); 2], |i| s_66[i]);
    let s_68 = sum_of_few([(); 2], |i| s_36[i] * weights[4 + i]);
    let s_69 = sum_of_few([(); 2], |i| s_42[i] * weights[4 + i]);
    let s_70 = sum_of_few([(); 2], |i| s_48[i] * weights[4 + i]);
    let s_71 = sum_of_few([(); 2], |i| s_51[i] * weights[4 + i]);
    let s_72 = sum_of_few([(); 2], |i| s_54[i] * weights[4 + i]);
    let s_73 = sum_of_few([(); 2], |i| s_60[i] * weights[4 + i]);
    let s_74 = sum_of_few([(); 2], |i| s_63[i] * weights[4 + i]);
    let mut s_75 = [T::number(0.0); 2];
    for i in 0..2 {
        s_75[i] = (C::read(coefficients.c_23[i]) * theta_dot
            - C::read(coefficients.c_16[i]) * s_64
            - C::read(coefficients.c_45[i]) * theta_dot) * weights[4 + i];
    }
    let s_76 = sum_of_few([(); 2], |i| s_75[i]);
    let mut product = [T::number(0.0); PARAMETERS];
    product[0] = s_67 - C::read(coefficients.c_47) * s_65;
    product[1] = C::read(coefficients.c_7) * (s_13 * s)
        - C::read(coefficients.c_63) * s_65 + s_68;
    product[2] = C::read(coefficients.c_7) * (s_16 * s)
        - C::read(coefficients.c_75) * s_65 + s_69;
    product[3] = C::read(coefficients.c_7) * (s_20 * s)
        - C::read(coefficients.c_87) * s_65 + s_70;
    product[4] = C::read(coefficients.c_7) * (s_22 * s) + s_71;
    product[5] = C::read(coefficients.c_7) * (s_24 * s) + s_72;
    product[6] = C::read(coefficients.c_7) * (s_27 * s)
        - C::read(coefficients.c_104) * s_65 + s_73;
    product[7] = C::read(coefficients.c_7) * (s_29 * s)
        - C::read(coefficients.c_111) * s_65 + s_74;
    product[8] = s_76 - C::read(coefficients.c_7) * (theta_dot * s);
    product
}

/// Structural nonzeros of [`rates_by_state`].
pub const RATES_BY_STATE_NONZEROS: usize = 12;

/// Where they stand in the matrix of 6 x 6.
pub static RATES_BY_STATE: Pattern<12> = pattern(
    &[
        [0, 3, 3, 3, 1],
        [3, 1, 1, 2, 0],
        [3, 1, 3, 1, 0],
        [4, 2, 1, 2, 0],
        [4, 2, 3, 1, 0],
    ],
);

/// The Jacobian of the rates by the state: its structural nonzeros, row by row, at the
/// places of [`RATES_BY_STATE`].
#[allow(unused_variables, unused_mut)]
pub fn rates_by_state<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> [T; RATES_BY_STATE_NONZEROS] {
    inlined_rates_by_state(t, state, inputs, coefficients)
}

/// [`rates_by_state`], inlined where it is called, to be compiled for the registers there.
#[allow(unused_variables, unused_mut)]
#[inline(always)]
pub fn inlined_rates_by_state<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
) -> [T; RATES_BY_STATE_NONZEROS] {
    let mut values = [T::number(0.0); RATES_BY_STATE_NONZEROS];
    for i in 0..3 {
        values[0 + i] = T::number(1.0);
    }
    for i in 0..2 {
        values[3 + i] = C::read(coefficients.c_36[i]);
    }
    values[5] = C::read(coefficients.c_37);
    for i in 0..2 {
        values[6 + 3 * i + i] = values[6 + 3 * i + i] + C::read(coefficients.c_24[i]);
        for j in 0..2 {
            values[6 + 3 * i + j] = values[6 + 3 * i + j]
                + C::read(coefficients.c_38[i]) * C::read(coefficients.c_40[j]);
            values[6 + 3 * i + j] = values[6 + 3 * i + j]
                + C::read(coefficients.c_41[i]) * C::read(coefficients.c_39[j]);
            values[6 + 3 * i + j] = values[6 + 3 * i + j]
                + C::read(coefficients.c_42[i]) * C::read(coefficients.c_35[j]);
        }
    }
    for i in 0..2 {
        values[8 + 3 * i] = C::read(coefficients.c_43[i]);
    }
    values
}

/// Structural nonzeros of [`rates_by_inputs`].
pub const RATES_BY_INPUTS_NONZEROS: usize = 3;

/// Where they stand in the matrix of 6 x 1.
pub static RATES_BY_INPUTS: Pattern<3> = pattern(&[[3, 1, 0, 1, 0], [4, 2, 0, 1, 0]]);

/// The Jacobian of the rates by the inputs: its structural nonzeros, row by row, at the
/// places of [`RATES_BY_INPUTS`].
#[allow(unused_variables, unused_mut)]
pub fn rates_by_inputs<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> [T; RATES_BY_INPUTS_NONZEROS] {
    inlined_rates_by_inputs(t, state, inputs, coefficients)
}

/// [`rates_by_inputs`], inlined where it is called, to be compiled for the registers there.
#[allow(unused_variables, unused_mut)]
#[inline(always)]
pub fn inlined_rates_by_inputs<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
) -> [T; RATES_BY_INPUTS_NONZEROS] {
    let mut values = [T::number(0.0); RATES_BY_INPUTS_NONZEROS];
    values[0] = C::read(coefficients.c_7);
    for i in 0..2 {
        values[1 + i] = C::read(coefficients.c_46[i]);
    }
    values
}

/// Structural nonzeros of [`rates_by_parameters`].
pub const RATES_BY_PARAMETERS_NONZEROS: usize = 27;

/// Where they stand in the matrix of 6 x 9.
pub static RATES_BY_PARAMETERS: Pattern<27> = pattern(
    &[
        [3, 1, 0, 1, 0],
        [3, 1, 1, 1, 0],
        [3, 1, 2, 1, 0],
        [3, 1, 3, 1, 0],
        [3, 1, 4, 1, 0],
        [3, 1, 5, 1, 0],
        [3, 1, 6, 1, 0],
        [3, 1, 7, 1, 0],
        [3, 1, 8, 1, 0],
        [4, 2, 0, 1, 0],
        [4, 2, 1, 1, 0],
        [4, 2, 2, 1, 0],
        [4, 2, 3, 1, 0],
        [4, 2, 4, 1, 0],
        [4, 2, 5, 1, 0],
        [4, 2, 6, 1, 0],
        [4, 2, 7, 1, 0],
        [4, 2, 8, 1, 0],
    ],
);

/// The Jacobian of the rates by the parameters: its structural nonzeros, row by row, at the
/// places of [`RATES_BY_PARAMETERS`].
#[allow(unused_variables, unused_mut)]
pub fn rates_by_parameters<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> [T; RATES_BY_PARAMETERS_NONZEROS] {
    inlined_rates_by_parameters(t, state, inputs, coefficients)
}

/// [`rates_by_parameters`], inlined where it is called, to be compiled for the registers there.
#[allow(unused_variables, unused_mut)]
#[inline(always)]
pub fn inlined_rates_by_parameters<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
) -> [T; RATES_BY_PARAMETERS_NONZEROS] {
    let theta_dot = state[3];
    let u = inputs.u;
    let s_1 = sum_of_few([(); 2], |i| C::read(coefficients.c_8[i]) * state[1 + i]);
    let s_2 = sum_of_few([(); 2], |i| C::read(coefficients.c_10[i]) * state[1 + i]);
    let s_3 = sum_of_few([(); 2], |i| C::read(coefficients.c_12[i]) * state[1 + i]);
    let s_4 = C::read(coefficients.c_13) * s_2 - s_3;
    let s_5 = u + s_1 - C::read(coefficients.c) * theta_dot
        - C::read(coefficients.c_9) * s_2 - C::read(coefficients.c_11) * s_4;
    let s_6 = s_4 - C::read(coefficients.c_18) * s_5;
    let s_7 = C::read(coefficients.c_20) * s_2 - C::read(coefficients.c_17) * s_6
        - C::read(coefficients.c_19) * s_5;
    let s_8 = sum_of_few([(); 2], |i| C::read(coefficients.c_50[i]) * state[1 + i]);
    let s_9 = sum_of_few([(); 2], |i| C::read(coefficients.c_52[i]) * state[1 + i]);
    let s_10 = sum_of_few([(); 2], |i| C::read(coefficients.c_57[i]) * state[1 + i]);
    let s_11 = C::read(coefficients.c_56) * s_10
        + (C::read(coefficients.c_59) * s_2 - C::read(coefficients.c_58) * s_2);
    let s_12 = C::read(coefficients.c_51) * s_9 - C::read(coefficients.c_49) * s_8
        - (C::read(coefficients.c_55) * s_2 - C::read(coefficients.c_53) * s_2
            - C::read(coefficients.c_54) * s_2);
    let s_13 = s_12
        - (C::read(coefficients.c_11) * s_11 + C::read(coefficients.c_60) * s_4
            - C::read(coefficients.c_61) * s_4);
    let s_14 = C::read(coefficients.c_69) * s_10
        + (C::read(coefficients.c_71) * s_2 - C::read(coefficients.c_70) * s_2);
    let s_15 = C::read(coefficients.c_65) * s_9 - C::read(coefficients.c_64) * s_8
        - (C::read(coefficients.c_68) * s_2 - C::read(coefficients.c_66) * s_2
            - C::read(coefficients.c_67) * s_2);
    let s_16 = s_15
        - (C::read(coefficients.c_11) * s_14 + C::read(coefficients.c_72) * s_4
            - C::read(coefficients.c_73) * s_4);
    let s_17 = sum_of_few([(); 2], |i| C::read(coefficients.c_78[i]) * state[1 + i]);
    let s_18 = C::read(coefficients.c_82) * s_10
        + (C::read(coefficients.c_84) * s_2 - C::read(coefficients.c_83) * s_2);
    let s_19 = C::read(coefficients.c_77) * s_17 - C::read(coefficients.c_76) * s_8
        - (C::read(coefficients.c_80) * s_2 + C::read(coefficients.c_81) * s_2
            - C::read(coefficients.c_79) * s_2);
    let s_20 = s_19
        - (C::read(coefficients.c_11) * s_18 + C::read(coefficients.c_85) * s_4
            - C::read(coefficients.c_86) * s_4);
    let s_21 = C::read(coefficients.c_91) * s_2 - C::read(coefficients.c_90) * s_10;
    let s_22 = C::read(coefficients.c_88) * s_8 - C::read(coefficients.c_89) * s_2
        - C::read(coefficients.c_11) * s_21;
    let s_23 = C::read(coefficients.c_95) * s_2 - C::read(coefficients.c_94) * s_10;
    let s_24 = C::read(coefficients.c_92) * s_8 - C::read(coefficients.c_93) * s_2
        - C::read(coefficients.c_11) * s_23;
    let s_25 = C::read(coefficients.c_100) * s_2 - C::read(coefficients.c_101) * s_2;
    let s_26 = C::read(coefficients.c_96) * s_2
        - (C::read(coefficients.c_97) * s_2 + C::read(coefficients.c_98) * s_2
            - C::read(coefficients.c_99) * s_2);
    let s_27 = s_26
        - (C::read(coefficients.c_11) * s_25 + C::read(coefficients.c_102) * s_4
            + C::read(coefficients.c_103) * s_4);
    let s_28 = C::read(coefficients.c_108) * s_2 - C::read(coefficients.c_107) * s_10;
    let s_29 = C::read(coefficients.c_105) * s_10 - C::read(coefficients.c_106) * s_2
        - (C::read(coefficients.c_11) * s_28 + C::read(coefficients.c_109) * s_4
            - C::read(coefficients.c_110) * s_4);
    let s_30 = C::read(coefficients.c_114) * s_5 - C::read(coefficients.c_113) * s_5;
    let s_31 = s_11
        - (C::read(coefficients.c_123) * s_5 + C::read(coefficients.c_18) * s_13
            - C::read(coefficients.c_124) * s_5);
    let s_32 = C::read(coefficients.c_120) * s_2
        - (C::read(coefficients.c_17) * s_31 - C::read(coefficients.c_121) * s_6
            - C::read(coefficients.c_122) * s_6);
    let s_33 = s_32
        - (C::read(coefficients.c_19) * s_13 - C::read(coefficients.c_125) * s_5
            - C::read(coefficients.c_126) * s_5);
    let mut s_34 = [T::number(0.0); 2];
    for i in 0..2 {
        s_34[i] = C::read(coefficients.c_117[i]) * state[1 + i]
            - (C::read(coefficients.c_119[i]) * s_7
                + C::read(coefficients.c_16[i]) * s_33
                - C::read(coefficients.c_118[i]) * s_7);
    }
    let mut s_35 = [T::number(0.0); 2];
    for i in 0..2 {
        s_35[i] = s_34[i]
            - (C::read(coefficients.c_21[i]) * s_31
                - C::read(coefficients.c_127[i]) * s_6
                - C::read(coefficients.c_128[i]) * s_6);
    }
    let mut s_36 = [T::number(0.0); 2];
    for i in 0..2 {
        s_36[i] = s_35[i]
            - (C::read(coefficients.c_23[i]) * s_13
                - C::read(coefficients.c_129[i]) * s_5
                - C::read(coefficients.c_130[i]) * s_5);
    }
    let s_37 = s_14
        - (C::read(coefficients.c_137) * s_5 + C::read(coefficients.c_18) * s_16
            - C::read(coefficients.c_138) * s_5);
    let s_38 = C::read(coefficients.c_134) * s_2
        - (C::read(coefficients.c_17) * s_37 - C::read(coefficients.c_135) * s_6
            - C::read(coefficients.c_136) * s_6);
    let s_39 = s_38
        - (C::read(coefficients.c_19) * s_16 - C::read(coefficients.c_139) * s_5
            - C::read(coefficients.c_140) * s_5);
    let mut s_40 = [T::number(0.0); 2];
    for i in 0..2 {
        s_40[i] = C::read(coefficients.c_131[i]) * state[1 + i]
            - (C::read(coefficients.c_133[i]) * s_7
                + C::read(coefficients.c_16[i]) * s_39
                - C::read(coefficients.c_132[i]) * s_7);
    }
    let mut s_41 = [T::number(0.0); 2];
    for i in 0..2 {
        s_41[i] = s_40[i]
            - (C::read(coefficients.c_21[i]) * s_37
                - C::read(coefficients.c_141[i]) * s_6
                - C::read(coefficients.c_142[i]) * s_6);
    }
    let mut s_42 = [T::number(0.0); 2];
    for i in 0..2 {
        s_42[i] = s_41[i]
            - (C::read(coefficients.c_23[i]) * s_16
                - C::read(coefficients.c_143[i]) * s_5
                - C::read(coefficients.c_144[i]) * s_5);
    }
    let s_43 = s_18
        - (C::read(coefficients.c_151) * s_5 + C::read(coefficients.c_18) * s_20
            - C::read(coefficients.c_152) * s_5);
    let s_44 = C::read(coefficients.c_148) * s_2
        - (C::read(coefficients.c_17) * s_43 - C::read(coefficients.c_149) * s_6
            - C::read(coefficients.c_150) * s_6);
    let s_45 = s_44
        - (C::read(coefficients.c_153) * s_5 + C::read(coefficients.c_19) * s_20
            - C::read(coefficients.c_154) * s_5);
    let mut s_46 = [T::number(0.0); 2];
    for i in 0..2 {
        s_46[i] = C::read(coefficients.c_145[i]) * state[1 + i]
            - (C::read(coefficients.c_147[i]) * s_7
                + C::read(coefficients.c_16[i]) * s_45
                - C::read(coefficients.c_146[i]) * s_7);
    }
    let mut s_47 = [T::number(0.0); 2];
    for i in 0..2 {
        s_47[i] = s_46[i]
            - (C::read(coefficients.c_21[i]) * s_43
                - C::read(coefficients.c_155[i]) * s_6
                - C::read(coefficients.c_156[i]) * s_6);
    }
    let mut s_48 = [T::number(0.0); 2];
    for i in 0..2 {
        s_48[i] = s_47[i]
            - (C::read(coefficients.c_157[i]) * s_5
                + C::read(coefficients.c_23[i]) * s_20
                - C::read(coefficients.c_158[i]) * s_5);
    }
    let s_49 = s_21 - C::read(coefficients.c_18) * s_22;
    let s_50 = C::read(coefficients.c_159) * s_2 - C::read(coefficients.c_17) * s_49
        - C::read(coefficients.c_19) * s_22;
    let mut s_51 = [T::number(0.0); 2];
    for i in 0..2 {
        s_51[i] = C::read(coefficients.c_160[i]) * state[1 + i]
            - C::read(coefficients.c_16[i]) * s_50 - C::read(coefficients.c_21[i]) * s_49
            - C::read(coefficients.c_23[i]) * s_22;
    }
    let s_52 = s_23 - C::read(coefficients.c_18) * s_24;
    let s_53 = C::read(coefficients.c_161) * s_2 - C::read(coefficients.c_17) * s_52
        - C::read(coefficients.c_19) * s_24;
    let mut s_54 = [T::number(0.0); 2];
    for i in 0..2 {
        s_54[i] = C::read(coefficients.c_162[i]) * state[1 + i]
            - C::read(coefficients.c_16[i]) * s_53 - C::read(coefficients.c_21[i]) * s_52
            - C::read(coefficients.c_23[i]) * s_24;
    }
    let s_55 = s_25
        - (C::read(coefficients.c_166) * s_5 + C::read(coefficients.c_18) * s_27
            - C::read(coefficients.c_167) * s_5);
    let s_56 = C::read(coefficients.c_168) * s_5 + C::read(coefficients.c_169) * s_5
        + C::read(coefficients.c_19) * s_27 - C::read(coefficients.c_170) * s_5;
    let s_57 = C::read(coefficients.c_171) * s_2
        - (C::read(coefficients.c_164) * s_6 + C::read(coefficients.c_165) * s_6
            + C::read(coefficients.c_17) * s_55);
    let s_58 = s_57 - s_56;
    let mut s_59 = [T::number(0.0); 2];
    for i in 0..2 {
        s_59[i] = -(C::read(coefficients.c_16[i]) * s_58
            - C::read(coefficients.c_163[i]) * s_7)
            - (C::read(coefficients.c_172[i]) * s_6
                + C::read(coefficients.c_21[i]) * s_55);
    }
    let mut s_60 = [T::number(0.0); 2];
    for i in 0..2 {
        s_60[i] = s_59[i]
            - (C::read(coefficients.c_173[i]) * s_5
                + C::read(coefficients.c_23[i]) * s_27
                - C::read(coefficients.c_174[i]) * s_5);
    }
    let s_61 = s_28
        - (C::read(coefficients.c_176) * s_5 + C::read(coefficients.c_18) * s_29
            - C::read(coefficients.c_177) * s_5);
    let s_62 = -(C::read(coefficients.c_17) * s_61 - C::read(coefficients.c_175) * s_6)
        - (C::read(coefficients.c_178) * s_5 + C::read(coefficients.c_19) * s_29
            - C::read(coefficients.c_179) * s_5);
    let mut s_63 = [T::number(0.0); 2];
    for i in 0..2 {
        s_63[i] = C::read(coefficients.c_38[i]) * s_62
            - (C::read(coefficients.c_21[i]) * s_61
                - C::read(coefficients.c_180[i]) * s_6)
            - (C::read(coefficients.c_181[i]) * s_5
                + C::read(coefficients.c_23[i]) * s_29
                - C::read(coefficients.c_182[i]) * s_5);
    }
    let s_64 = C::read(coefficients.c_19) * theta_dot
        - C::read(coefficients.c_44) * theta_dot;
    let mut values = [T::number(0.0); RATES_BY_PARAMETERS_NONZEROS];
    values[0] = C::read(coefficients.c_48) * s_5;
    values[1] = C::read(coefficients.c_7) * s_13 - C::read(coefficients.c_63) * s_5;
    values[2] = C::read(coefficients.c_7) * s_16 - C::read(coefficients.c_75) * s_5;
    values[3] = C::read(coefficients.c_7) * s_20 - C::read(coefficients.c_87) * s_5;
    values[4] = C::read(coefficients.c_7) * s_22;
    values[5] = C::read(coefficients.c_7) * s_24;
    values[6] = C::read(coefficients.c_7) * s_27 - C::read(coefficients.c_104) * s_5;
    values[7] = C::read(coefficients.c_7) * s_29 - C::read(coefficients.c_111) * s_5;
    values[8] = C::read(coefficients.c_112) * theta_dot;
    for i in 0..2 {
        values[9 + 9 * i] = C::read(coefficients.c_116[i]) * s_5
            - C::read(coefficients.c_16[i]) * s_30
            - C::read(coefficients.c_115[i]) * s_5;
    }
    for i in 0..2 {
        values[10 + 9 * i] = s_36[i];
    }
    for i in 0..2 {
        values[11 + 9 * i] = s_42[i];
    }
    for i in 0..2 {
        values[12 + 9 * i] = s_48[i];
    }
    for i in 0..2 {
        values[13 + 9 * i] = s_51[i];
    }
    for i in 0..2 {
        values[14 + 9 * i] = s_54[i];
    }
    for i in 0..2 {
        values[15 + 9 * i] = s_60[i];
    }
    for i in 0..2 {
        values[16 + 9 * i] = s_63[i];
    }
    for i in 0..2 {
        values[17 + 9 * i] = C::read(coefficients.c_23[i]) * theta_dot
            - C::read(coefficients.c_16[i]) * s_64
            - C::read(coefficients.c_45[i]) * theta_dot;
    }
    values
}

/// Structural nonzeros of [`observables_by_state`].
pub const OBSERVABLES_BY_STATE_NONZEROS: usize = 10;

/// Where they stand in the matrix of 4 x 6.
pub static OBSERVABLES_BY_STATE: Pattern<10> = pattern(
    &[
        [0, 1, 1, 2, 0],
        [1, 1, 1, 2, 0],
        [2, 1, 1, 2, 0],
        [2, 1, 3, 1, 0],
        [2, 1, 4, 2, 0],
        [3, 1, 3, 1, 0],
    ],
);

/// The Jacobian of the observables by the state: its structural nonzeros, row by row, at the
/// places of [`OBSERVABLES_BY_STATE`].
#[allow(unused_variables, unused_mut)]
pub fn observables_by_state<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> [T; OBSERVABLES_BY_STATE_NONZEROS] {
    inlined_observables_by_state(t, state, inputs, coefficients)
}

/// [`observables_by_state`], inlined where it is called, to be compiled for the registers there.
#[allow(unused_variables, unused_mut)]
#[inline(always)]
pub fn inlined_observables_by_state<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
) -> [T; OBSERVABLES_BY_STATE_NONZEROS] {
    let theta_dot = state[3];
    let s_1 = C::read(coefficients.c) * theta_dot;
    let u = inputs.u;
    let s_2 = sum_of_few([(); 2], |i| T::number(INTEGRAL_S1_PHI[i]) * state[4 + i]);
    let s_3 = sum_of_few([(); 2], |i| T::number(PHI_AT_END[i]) * state[4 + i]);
    let s_4 = C::read(coefficients.l) * theta_dot + s_3;
    let s_5 = sum_of_few([(); 2], |i| T::number(PHI_D1_AT_END[i]) * state[4 + i]);
    let s_6 = theta_dot + C::read(coefficients.c_28) * s_5;
    let s_7 = C::read(coefficients.J_h) * theta_dot
        + T::number(0.5)
            * (C::read(coefficients.c_183) * theta_dot
                + C::read(coefficients.c_30) * s_2);
    let mut s_8 = [T::number(0.0); 2];
    for i in 0..2 {
        s_8[i] = T::number(0.5)
            * (C::read(coefficients.c_184[i]) * theta_dot
                + C::read(coefficients.c_185[i]) * state[4 + i])
            + (C::read(coefficients.c_25[i]) * s_4 + C::read(coefficients.c_5[i]) * s_6);
    }
    let mut values = [T::number(0.0); OBSERVABLES_BY_STATE_NONZEROS];
    for i in 0..2 {
        values[0 + i] = T::number(PHI_AT_END[i]);
    }
    for i in 0..2 {
        values[2 + i] = C::read(coefficients.c_26[i]);
    }
    for i in 0..2 {
        values[4 + i] = C::read(coefficients.c_27[i]) * state[1 + i];
    }
    values[6] = s_7
        + (C::read(coefficients.c_4) * s_4 + C::read(coefficients.J_t) * s_6);
    for i in 0..2 {
        values[7 + i] = s_8[i];
    }
    values[9] = u - s_1 - s_1;
    values
}

/// Structural nonzeros of [`observables_by_inputs`].
pub const OBSERVABLES_BY_INPUTS_NONZEROS: usize = 1;

/// Where they stand in the matrix of 4 x 1.
pub static OBSERVABLES_BY_INPUTS: Pattern<1> = pattern(&[[3, 1, 0, 1, 0]]);

/// The Jacobian of the observables by the inputs: its structural nonzeros, row by row, at the
/// places of [`OBSERVABLES_BY_INPUTS`].
#[allow(unused_variables, unused_mut)]
pub fn observables_by_inputs<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> [T; OBSERVABLES_BY_INPUTS_NONZEROS] {
    inlined_observables_by_inputs(t, state, inputs, coefficients)
}

/// [`observables_by_inputs`], inlined where it is called, to be compiled for the registers there.
#[allow(unused_variables, unused_mut)]
#[inline(always)]
pub fn inlined_observables_by_inputs<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
) -> [T; OBSERVABLES_BY_INPUTS_NONZEROS] {
    let theta_dot = state[3];
    let mut values = [T::number(0.0); OBSERVABLES_BY_INPUTS_NONZEROS];
    values[0] = theta_dot;
    values
}

/// Structural nonzeros of [`observables_by_parameters`].
pub const OBSERVABLES_BY_PARAMETERS_NONZEROS: usize = 10;

/// Where they stand in the matrix of 4 x 9.
pub static OBSERVABLES_BY_PARAMETERS: Pattern<10> = pattern(
    &[
        [1, 1, 3, 1, 0],
        [2, 1, 0, 1, 0],
        [2, 1, 1, 1, 0],
        [2, 1, 2, 1, 0],
        [2, 1, 3, 1, 0],
        [2, 1, 4, 1, 0],
        [2, 1, 5, 1, 0],
        [2, 1, 6, 1, 0],
        [2, 1, 7, 1, 0],
        [3, 1, 8, 1, 0],
    ],
);

/// The Jacobian of the observables by the parameters: its structural nonzeros, row by row, at the
/// places of [`OBSERVABLES_BY_PARAMETERS`].
#[allow(unused_variables, unused_mut)]
pub fn observables_by_parameters<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> [T; OBSERVABLES_BY_PARAMETERS_NONZEROS] {
    inlined_observables_by_parameters(t, state, inputs, coefficients)
}

/// [`observables_by_parameters`], inlined where it is called, to be compiled for the registers there.
#[allow(unused_variables, unused_mut)]
#[inline(always)]
pub fn inlined_observables_by_parameters<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
) -> [T; OBSERVABLES_BY_PARAMETERS_NONZEROS] {
    let theta_dot = state[3];
    let s_1 = sum_of_few([(); 2], |i| T::number(PHI_D1_AT_END[i]) * state[1 + i]);
    let s_2 = theta_dot * theta_dot;
    let s_3 = sum_of_few([(); 2], |i| T::number(INTEGRAL_S1_PHI[i]) * state[4 + i]);
    let s_4 = theta_dot * s_3;
    let s_5 = sum_of_few(
        [(); 2],
        |i| T::number(INTEGRAL_PHI_SQUARED[i]) * (state[4 + i] * state[4 + i]),
    );
    let s_6 = sum_of_few([(); 2], |i| T::number(PHI_AT_END[i]) * state[4 + i]);
    let s_7 = C::read(coefficients.l) * theta_dot + s_6;
    let s_8 = sum_of_few([(); 2], |i| T::number(PHI_D1_AT_END[i]) * state[4 + i]);
    let s_9 = theta_dot + C::read(coefficients.c_28) * s_8;
    let s_10 = sum_of_few(
        [(); 2],
        |i| T::number(INTEGRAL_PHI_D2_SQUARED[i]) * (state[1 + i] * state[1 + i]),
    );
    let s_11 = T::number(0.5)
        * (C::read(coefficients.c_62) * s_2 + C::read(coefficients.c_187) * s_4
            + C::read(coefficients.c_188) * s_5);
    let s_12 = T::number(0.5)
        * (C::read(coefficients.c_74) * s_2 + C::read(coefficients.c_189) * s_4
            + C::read(coefficients.c_190) * s_5);
    let s_13 = T::number(0.5)
        * (C::read(coefficients.c_3) * s_2 + C::read(coefficients.c_191) * s_4
            + C::read(coefficients.c_2) * s_5);
    let s_14 = s_13
        + (C::read(coefficients.M_t) * (theta_dot * s_7)
            - C::read(coefficients.c_192) * (s_8 * s_9))
        - C::read(coefficients.c_193) * s_10;
    let mut values = [T::number(0.0); OBSERVABLES_BY_PARAMETERS_NONZEROS];
    values[0] = C::read(coefficients.c_186) * s_1;
    values[1] = T::number(0.5) * s_2;
    values[2] = s_11;
    values[3] = s_12;
    values[4] = s_14;
    values[5] = C::read(coefficients.c_194) * s_10;
    values[6] = C::read(coefficients.c_195) * s_10;
    values[7] = T::number(0.5) * (s_7 * s_7);
    values[8] = T::number(0.5) * (s_9 * s_9);
    values[9] = -s_2;
    values
}

/// The linearisation about a point: rates + A dx + B du, observables + C dx + D du.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linearisation<T = f64> {
    /// The rates at the point.
    pub rates: [T; STATES],
    /// The observables at the point.
    pub observables: [T; OBSERVABLES],
    /// The rates by the state.
    pub A: [[T; STATES]; STATES],
    /// The rates by the inputs.
    pub B: [[T; INPUTS]; STATES],
    /// The observables by the state.
    pub C: [[T; STATES]; OBSERVABLES],
    /// The observables by the inputs.
    pub D: [[T; INPUTS]; OBSERVABLES],
}

/// The linearisation about a point.
pub fn linearise<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> Linearisation<T> {
    inlined_linearise(t, state, inputs, coefficients)
}

/// [`linearise`], inlined where it is called, to be compiled for the registers there.
#[inline(always)]
pub fn inlined_linearise<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
) -> Linearisation<T> {
    let rates = inlined_rates(t, state, inputs, coefficients);
    let observables = inlined_observables(t, state, inputs, coefficients);
    let rates_by_state = inlined_rates_by_state(t, state, inputs, coefficients);
    let rates_by_inputs = inlined_rates_by_inputs(t, state, inputs, coefficients);
    let observables_by_state = inlined_observables_by_state(
        t,
        state,
        inputs,
        coefficients,
    );
    let observables_by_inputs = inlined_observables_by_inputs(
        t,
        state,
        inputs,
        coefficients,
    );
    Linearisation {
        rates,
        observables,
        A: RATES_BY_STATE.dense(&rates_by_state),
        B: RATES_BY_INPUTS.dense(&rates_by_inputs),
        C: OBSERVABLES_BY_STATE.dense(&observables_by_state),
        D: OBSERVABLES_BY_INPUTS.dense(&observables_by_inputs),
    }
}

/// Where the structural nonzeros of a matrix stand, row by row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pattern<const N: usize> {
    /// The row of each.
    pub rows: [usize; N],
    /// The column of each.
    pub columns: [usize; N],
}
impl<const N: usize> Pattern<N> {
    /// The matrix of `R` rows and `C` columns with these nonzeros.
    pub fn dense<T: Scalar, const R: usize, const C: usize>(
        &self,
        nonzeros: &[T; N],
    ) -> [[T; C]; R] {
        let mut matrix = [[T::number(0.0); C]; R];
        for k in 0..N {
            if let Some(row) = matrix.get_mut(self.rows[k]) {
                if let Some(entry) = row.get_mut(self.columns[k]) {
                    *entry = nonzeros[k];
                }
            }
        }
        matrix
    }
}

/// The places of blocks: first row, rows, first column, columns, and whether only the diagonal
/// is filled. Blocks of the same rows stand together.
const fn pattern<const B: usize, const N: usize>(
    blocks: &[[usize; 5]; B],
) -> Pattern<N> {
    let mut pattern = Pattern {
        rows: [0; N],
        columns: [0; N],
    };
    let (mut next, mut first) = (0, 0);
    while first < B {
        let [row, rows, _, _, _] = blocks[first];
        let mut last = first;
        while last < B && blocks[last][0] == row {
            last += 1;
        }
        let mut i = 0;
        while i < rows {
            let mut block = first;
            while block < last {
                let [_, _, column, columns, diagonal] = blocks[block];
                let (column, count) = if diagonal == 1 {
                    (column + i, 1)
                } else {
                    (column, columns)
                };
                let mut j = 0;
                while j < count {
                    pattern.rows[next] = row + i;
                    pattern.columns[next] = column + j;
                    next += 1;
                    j += 1;
                }
                block += 1;
            }
            i += 1;
        }
        first = last;
    }
    pattern
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

/// What the equations are computed with: `f64`, `f32`, lanes of them, or numbers that carry
/// derivatives. Nothing branches on a value, so that lanes may differ in every condition.
pub trait Scalar: Copy
where
    Self: core::ops::Add<Output = Self>,
    Self: core::ops::Sub<Output = Self>,
    Self: core::ops::Mul<Output = Self>,
    Self: core::ops::Div<Output = Self>,
    Self: core::ops::Neg<Output = Self>,
{
    /// A number, in every lane and without derivative.
    fn number(value: f64) -> Self;
    /// `then` where a > b, `otherwise` elsewhere, also where either is NaN. Whatever is not
    /// chosen leaves no trace.
    fn select_greater(a: Self, b: Self, then: Self, otherwise: Self) -> Self;
    /// Whether a > b in every lane.
    fn all_greater(a: Self, b: Self) -> bool;
    /// An elementary function of this.
    fn function<F: Function>(self) -> Self;
    /// An elementary function of this and another.
    fn function_of_two<F: FunctionOfTwo>(self, other: Self) -> Self;
    /// A long loop. Single numbers keep it out of the code around; lanes must not, because code
    /// of its own would not be compiled for their registers.
    #[inline(always)]
    fn long_loop<F: FnOnce() -> Self>(lines: F) -> Self {
        lines()
    }
}

/// Numbers in IEEE 754 double precision, or lanes of them: what the elementary functions are
/// written for.
pub trait Real: Scalar {
    /// `then` where a = b, `otherwise` elsewhere, also where either is NaN.
    fn select_equal(a: Self, b: Self, then: Self, otherwise: Self) -> Self;
    /// The sign bit cleared.
    fn magnitude(self) -> Self;
    /// The magnitude with the sign bit of another number.
    fn copy_sign(self, sign: Self) -> Self;
    /// 2^k for an integral k: 2^52 + 1023 brings it to the place of the exponent.
    fn power_of_two(self) -> Self;
    /// The unbiased exponent field.
    fn exponent(self) -> Self;
    /// The mantissa under the exponent of 1.
    fn significand(self) -> Self;
}

/// An elementary function: plain operations in a fixed order, the same bits on every machine.
pub trait Function {
    /// Its value.
    fn value<T: Real>(x: T) -> T;
    /// Its derivative at x, where it is `value`.
    fn slope<T: Scalar>(x: T, value: T) -> T;
}

/// An elementary function of two arguments.
pub trait FunctionOfTwo {
    /// Its value.
    fn value<T: Real>(x: T, y: T) -> T;
    /// Its derivatives by x and y, where it is `value`.
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

/// Elementary functions in double precision, then rounded: within 0.5001 units in the last
/// place.
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
        F::value(f64::from(self)) as f32
    }
    #[inline]
    fn function_of_two<F: FunctionOfTwo>(self, other: f32) -> f32 {
        F::value(f64::from(self), f64::from(other)) as f32
    }
    #[inline(never)]
    fn long_loop<F: FnOnce() -> f32>(lines: F) -> f32 {
        lines()
    }
}

/// A coefficient as the functions for lanes read it: a number of the type that they compute
/// with, or an `f64` that all lanes share, which takes an eighth of the memory.
pub trait Coefficient<T>: Copy {
    /// The number, in every lane.
    fn read(self) -> T;
}
impl<T: Scalar> Coefficient<T> for T {
    #[inline(always)]
    fn read(self) -> T {
        self
    }
}

/// 1/pivot of a positive pivot; NaN where the mass matrix is not positive definite.
#[inline(always)]
fn pivot_reciprocal<T: Scalar>(pivot: T) -> T {
    let reciprocal = T::number(1.0) / pivot;
    T::select_greater(pivot, T::number(0.0), reciprocal, T::number(f64::NAN))
}

/// These numbers in another type.
#[inline(always)]
fn converted<T: Scalar, const N: usize>(numbers: &[f64; N]) -> [T; N] {
    let mut converted = [T::number(0.0); N];
    for i in 0..N {
        converted[i] = T::number(numbers[i]);
    }
    converted
}

/// The sum of the first `N` of eight numbers, neighbours added in pairs.
#[inline(always)]
fn paired<const N: usize, T: Scalar>(s: &[T; 8]) -> T {
    let a = if N > 1 { s[0] + s[1] } else { s[0] };
    let b = if N > 3 { s[2] + s[3] } else { s[2] };
    let c = if N > 5 { s[4] + s[5] } else { s[4] };
    let d = if N > 7 { s[6] + s[7] } else { s[6] };
    let left = if N > 2 { a + b } else { a };
    let right = if N > 6 { c + d } else { c };
    if N > 4 { left + right } else { left }
}

/// The sum of up to eight elements.
#[inline(always)]
fn sum_of_few<const N: usize, T: Scalar, F: Fn(usize) -> T>(
    _: [(); N],
    element: F,
) -> T {
    let mut s = [T::number(0.0); 8];
    for k in 0..N {
        s[k] = element(k);
    }
    paired::<N, T>(&s)
}
