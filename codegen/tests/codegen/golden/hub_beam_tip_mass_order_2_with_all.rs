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
    /// `sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED)`
    pub c_7: T,
    /// `sum_i(INTEGRAL_S1_PHI*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)`
    pub c_8: T,
    /// `J_t*(l*sum_i(INTEGRAL_S1_PHI*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_D1_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))/(l*l) - (M_t*J_t*sum_i(PHI_A...`
    pub c_9: T,
    /// `M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)*(l*sum_i(.../...) + sum_i(.../...)/(rho*A*l))*1/(1.0 + M_t*sum_i(...)/(rho*A*l))/(rho*A*l) - (l*sum_i(INTEGRAL_S1_PHI*PH...`
    pub c_10: T,
    /// `1/(1.0 + J_t*sum_i(PHI_D1_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)/(rho*A*l*l*l) - (M_t*J_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)*sum_i(...*.../INTEGRAL_PHI_SQU...`
    pub c_11: T,
    /// `1/pivot_theta`
    pub c_12: T,
    /// `c`
    pub c: T,
    /// `E*I*INTEGRAL_PHI_D2_SQUARED*M_theta_q/(rho*A*l*l*l*l*INTEGRAL_PHI_SQUARED)`
    pub c_13: [T; 2],
    /// `M_t*E*I*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/(1.0 + M_t*sum_i(...*.../INT...`
    pub c_14: T,
    /// `PHI_AT_END*INTEGRAL_PHI_D2_SQUARED/INTEGRAL_PHI_SQUARED`
    pub c_15: [T; 2],
    /// `(M_t*sum_i(.../...)*(l*sum_i(...) + sum_i(...)/(...*l))*1/(1.0 + M_t*.../(...*l))/(rho*A*l) - (l*sum_i(INTEGRAL_S1_PHI*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)) - (s...`
    pub c_16: T,
    /// `J_t*E*I*PHI_D1_AT_END*INTEGRAL_PHI_D2_SQUARED/(rho*A*l*l*l*l*l*l*INTEGRAL_PHI_SQUARED)`
    pub c_17: [T; 2],
    /// `M_t*J_t*E*I*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*A*A*l*l*l*l*l*l*l)`
    pub c_18: T,
    /// `E*I*INTEGRAL_PHI_D2_SQUARED/(rho*A*l*l*l*l*INTEGRAL_PHI_SQUARED)`
    pub c_19: [T; 2],
    /// `rho*A*l*INTEGRAL_PHI_SQUARED`
    pub c_20: [T; 2],
    /// `1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))*PHI_AT_END/(rho*A*l*INTEGRAL_PHI_SQUARED)`
    pub c_21: [T; 2],
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + J_t*sum_i(.../...)/(rho*A*l*l*l) - (M_t*J_t*sum_i(...)*sum_i(...)*1/(1.0 + .../...)/(rho*rho*A...`
    pub c_22: T,
    /// `(J_t*(l*sum_i(...*.../INTEGRAL_PHI_SQUARED) + sum_i(...*(...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))/(l*l) - (M_t*J_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)*(l*sum_i(......`
    pub c_23: T,
    /// `M_t*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(...*... + .../l)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/pivot_theta`
    pub c_24: T,
    /// `-(M_t*E*I/(rho*A*l*l*l*l))`
    pub c_25: T,
    /// `1/(1.0 + J_t*sum_i(.../...)/(rho*A*l*l*l) - (M_t*J_t*sum_i(...)*sum_i(...)*1/(1.0 + .../...)/(rho*rho*A*A*l*l*l*l)))*PHI_D1_AT_END/(rho*A*l*INTEGRAL_PHI_SQUARED...`
    pub c_26: [T; 2],
    /// `l*INTEGRAL_S1_PHI/INTEGRAL_PHI_SQUARED + (l*M_t*PHI_AT_END + J_t*PHI_D1_AT_END/l)/(rho*A*l*INTEGRAL_PHI_SQUARED)`
    pub c_27: [T; 2],
    /// `1/pivot_theta*(l*INTEGRAL_S1_PHI/INTEGRAL_PHI_SQUARED + (l*M_t*PHI_AT_END + J_t*PHI_D1_AT_END/l)/(rho*A*l*INTEGRAL_PHI_SQUARED))`
    pub c_28: [T; 2],
    /// `-(E*I*INTEGRAL_PHI_D2_SQUARED/(rho*A*l*l*l*l*INTEGRAL_PHI_SQUARED))`
    pub c_29: [T; 2],
    /// `J_h + 0.3333333333333333*rho*A*l*l*l + J_t + l*l*M_t`
    pub M_theta_theta: T,
    /// `M_t*PHI_AT_END`
    pub c_30: [T; 2],
    /// `PHI_D1_AT_END/l`
    pub c_31: [T; 2],
    /// `E*I*INTEGRAL_PHI_D2_SQUARED/(l*l*l)`
    pub c_32: [T; 2],
    /// `1.0/l`
    pub c_33: T,
    /// `0.5*J_h`
    pub c_34: T,
    /// `2.0*rho*A*l*l`
    pub c_35: T,
    /// `0.5*M_t`
    pub c_36: T,
    /// `0.5*J_t`
    pub c_37: T,
    /// `0.5*E*I/(l*l*l)`
    pub c_38: T,
    /// `J_t*PHI_D1_AT_END/(l*l)`
    pub c_39: [T; 2],
    /// `E*I*INTEGRAL_PHI_D2_SQUARED*M_theta_q/(rho*A*l*l*l*l*INTEGRAL_PHI_SQUARED) - (M_t*E*I*(l*... + .../...)*1/(1.0 + .../...)*PHI_AT_END*INTEGRAL_PHI_D2_SQUARED/(rh...`
    pub c_40: [T; 2],
    /// `1/pivot_theta*(E*I*INTEGRAL_PHI_D2_SQUARED*M_theta_q/(rho*A*l*l*l*l*INTEGRAL_PHI_SQUARED) - (...*I*(... + ...)*1/(... + ...)*PHI_AT_END*INTEGRAL_PHI_D2_SQUARED/...`
    pub c_41: [T; 2],
    /// `-(c*1/pivot_theta)`
    pub c_42: T,
    /// `-(1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))*PHI_AT_END/(rho*A*l*INTEGRAL_PHI_SQUARED))`
    pub c_43: [T; 2],
    /// `...*E*I*sum_i(.../...)*1/(1.0 + .../...)*PHI_AT_END*INTEGRAL_PHI_D2_SQUARED/(rho*rho*A*A*l*l*l*l*l*l*l*INTEGRAL_PHI_SQUARED) - (J_t*E*I*PHI_D1_AT_END*INTEGRAL_P...`
    pub c_44: [T; 2],
    /// `-(M_t*E*I*PHI_AT_END*INTEGRAL_PHI_D2_SQUARED/(rho*A*l*l*l*l*INTEGRAL_PHI_SQUARED)) - (M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)*1/(1.0 + .../... - (...*.../(...*....`
    pub c_45: [T; 2],
    /// `-(1/(1.0 + J_t*sum_i(...)/(rho*A*l*...) - (M_t*J_t*...*...*1/(... + ...)/(rho*rho*A*A*l*l*l*l)))*PHI_D1_AT_END/(rho*A*l*INTEGRAL_PHI_SQUARED))`
    pub c_46: [T; 2],
    /// `-(1/pivot_theta*(l*INTEGRAL_S1_PHI/INTEGRAL_PHI_SQUARED + (l*M_t*PHI_AT_END + J_t*PHI_D1_AT_END/l)/(rho*A*l*INTEGRAL_PHI_SQUARED)))`
    pub c_47: [T; 2],
    /// `c*1/pivot_theta*(l*INTEGRAL_S1_PHI/INTEGRAL_PHI_SQUARED + (l*M_t*PHI_AT_END + J_t*PHI_D1_AT_END/l)/(rho*A*l*INTEGRAL_PHI_SQUARED)) - (1/(1.0 + M_t*.../(...*l))*...`
    pub c_48: [T; 2],
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*(J_t*(l*... + .../...)/(l*l) - (...*...*(... + ...)*1/(... + ...)/(rho*A*l*l*l)))*1/(1.0 + J_t*sum_i(.....`
    pub c_49: T,
    /// `(J_t*(l*... + .../...)/(l*l) - (...*...*(... + ...)*1/(... + ...)/(rho*A*l*l*l)))*1/(1.0 + J_t*.../(...*...) - (...*...*1/.../(...*...*...*...)))*1/pivot_theta*...`
    pub c_50: [T; 2],
    /// `(J_t*(...)/(l*l) - (...*.../(...*...)))*1/(... + ... - (.../...))*1/pivot_theta*PHI_D1_AT_END/(rho*A*l*INTEGRAL_PHI_SQUARED) - (1/pivot_theta*(l*INTEGRAL_S1_PHI...`
    pub c_51: [T; 2],
    /// `1/pivot_theta*1/pivot_theta`
    pub c_52: T,
    /// `-(1/pivot_theta*1/pivot_theta)`
    pub c_53: T,
    /// `E*I/(rho*rho*A*l*l*l*l)`
    pub c_54: T,
    /// `INTEGRAL_PHI_D2_SQUARED*M_theta_q/INTEGRAL_PHI_SQUARED`
    pub c_55: [T; 2],
    /// `rho*l*l`
    pub c_56: T,
    /// `E*I/(rho*l*l)`
    pub c_57: T,
    /// `INTEGRAL_S1_PHI*INTEGRAL_PHI_D2_SQUARED/INTEGRAL_PHI_SQUARED`
    pub c_58: [T; 2],
    /// `M_t*E*I*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/(1.0 + M_t*sum_i(...*.../INT...`
    pub c_59: T,
    /// `M_t*E*I*sum_i(PHI_AT_END*(l*M_t*PHI_AT_END + J_t*.../l)/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*rho*A*A*l*l*l...`
    pub c_60: T,
    /// `M_t*M_t*E*I*sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_...`
    pub c_61: T,
    /// `J_t*E*I/(rho*rho*A*l*l*l*l*l*l)`
    pub c_62: T,
    /// `PHI_D1_AT_END*INTEGRAL_PHI_D2_SQUARED/INTEGRAL_PHI_SQUARED`
    pub c_63: [T; 2],
    /// `2.0*M_t*J_t*E*I*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*rho*A*A*l*l*l*l*l*l*l)`
    pub c_64: T,
    /// `M_t*M_t*J_t*E*I*sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))*1/...`
    pub c_65: T,
    /// `sum_i(PHI_D1_AT_END*(l*M_t*PHI_AT_END + J_t*PHI_D1_AT_END/l)/INTEGRAL_PHI_SQUARED)/(rho*rho*A*l)`
    pub c_66: T,
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_S...`
    pub c_67: T,
    /// `1/(1.0 + J_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l*l*l) - (M_t*J_t*sum_i(.../...)*sum_i(.../...)*1/(1.0 + M_t*.../(...*l))/(rho*rho*A*A*l*l*l*l)))*(sum_i...`
    pub c_68: T,
    /// `(M_t*sum_i(...)*(l*... + .../...)*1/(1.0 + .../...)/(rho*A*l) - (l*sum_i(INTEGRAL_S1_PHI*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)) - (sum_i(PHI_D1_AT_END*(...*... + ...`
    pub c_69: T,
    /// `0.3333333333333333*A*l*l*l`
    pub c_70: T,
    /// `M_t*J_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_P...`
    pub c_71: T,
    /// `1/pivot_theta*1/pivot_theta*(0.3333333333333333*A*l*l*l + ...*...*...*.../(...*A*l) - (...*(...)*1/.../(...*A*l)) - (A*l*l*l*sum_i(INTEGRAL_S1_PHI*INTEGRAL_S1_P...`
    pub c_72: T,
    /// `E*I/(rho*A*A*l*l*l*l)`
    pub c_73: T,
    /// `A*l*l`
    pub c_74: T,
    /// `E*I/(A*l*l)`
    pub c_75: T,
    /// `M_t*E*I*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/(1.0 + M_t*sum_i(...*.../INT...`
    pub c_76: T,
    /// `M_t*E*I*sum_i(PHI_AT_END*(l*M_t*PHI_AT_END + J_t*.../l)/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*A*A*A*l*l*l*l...`
    pub c_77: T,
    /// `M_t*M_t*E*I*sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_...`
    pub c_78: T,
    /// `J_t*E*I/(rho*A*A*l*l*l*l*l*l)`
    pub c_79: T,
    /// `2.0*M_t*J_t*E*I*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*A*A*A*l*l*l*l*l*l*l)`
    pub c_80: T,
    /// `M_t*M_t*J_t*E*I*sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))*1/...`
    pub c_81: T,
    /// `sum_i(PHI_D1_AT_END*(l*M_t*PHI_AT_END + J_t*PHI_D1_AT_END/l)/INTEGRAL_PHI_SQUARED)/(rho*A*A*l)`
    pub c_82: T,
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_S...`
    pub c_83: T,
    /// `1/(1.0 + J_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l*l*l) - (M_t*J_t*sum_i(.../...)*sum_i(.../...)*1/(1.0 + M_t*.../(...*l))/(rho*rho*A*A*l*l*l*l)))*(sum_i...`
    pub c_84: T,
    /// `(M_t*sum_i(...)*(l*... + .../...)*1/(1.0 + .../...)/(rho*A*l) - (l*sum_i(INTEGRAL_S1_PHI*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)) - (sum_i(PHI_D1_AT_END*(...*... + ...`
    pub c_85: T,
    /// `0.3333333333333333*rho*l*l*l`
    pub c_86: T,
    /// `M_t*J_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_P...`
    pub c_87: T,
    /// `1/pivot_theta*1/pivot_theta*(0.3333333333333333*rho*l*l*l + ...*...*...*.../(rho*...*l) - (...*(...)*1/.../(rho*...*l)) - (rho*l*l*l*sum_i(INTEGRAL_S1_PHI*INTEG...`
    pub c_88: T,
    /// `4.0*E*I/(rho*A*l*l*l*l*l)`
    pub c_89: T,
    /// `E*I/(rho*A*l*l*l*l)`
    pub c_90: T,
    /// `2.0*rho*A*l`
    pub c_91: T,
    /// `INTEGRAL_PHI_D2_SQUARED*(2.0*rho*A*l*INTEGRAL_S1_PHI + M_t*PHI_AT_END - (J_t*PHI_D1_AT_END/(l*l)))/INTEGRAL_PHI_SQUARED`
    pub c_92: [T; 2],
    /// `4.0*M_t*E*I*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/(1.0 + M_t*sum_i(...*......`
    pub c_93: T,
    /// `sum_i(PHI_AT_END*(l*M_t*PHI_AT_END + J_t*PHI_D1_AT_END/l)/INTEGRAL_PHI_SQUARED)/(rho*A*l*l)`
    pub c_94: T,
    /// `M_t*E*I*1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))*(sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... - ...)/INTEGRAL_PHI_SQUARED)/(rho...`
    pub c_95: T,
    /// `M_t*M_t*E*I*sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_...`
    pub c_96: T,
    /// `6.0*J_t*E*I/(rho*A*l*l*l*l*l*l*l)`
    pub c_97: T,
    /// `7.0*M_t*J_t*E*I*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*A*A*l*l*l*l*l*l*l*l)`
    pub c_98: T,
    /// `M_t*M_t*J_t*E*I*sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))*1/...`
    pub c_99: T,
    /// `sum_i(PHI_D1_AT_END*(l*M_t*PHI_AT_END + J_t*PHI_D1_AT_END/l)/INTEGRAL_PHI_SQUARED)/(rho*A*l*l)`
    pub c_100: T,
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_S...`
    pub c_101: T,
    /// `1/(1.0 + J_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l*l*l) - (M_t*J_t*sum_i(.../...)*sum_i(.../...)*1/(1.0 + M_t*.../(...*l))/(rho*rho*A*A*l*l*l*l)))*(M_t*....`
    pub c_102: T,
    /// `(M_t*sum_i(...)*(l*... + .../...)*1/(1.0 + .../...)/(rho*A*l) - (l*sum_i(INTEGRAL_S1_PHI*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)) - (sum_i(PHI_D1_AT_END*(...*... + ...`
    pub c_103: T,
    /// `2.0*J_t*(l*sum_i(INTEGRAL_S1_PHI*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_D1_AT_END*(...*... + .../l)/INTEGRAL_PHI_SQUARED)/(rho*A*l))/(l*l*l)`
    pub c_104: T,
    /// `3.0*M_t*J_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGR...`
    pub c_105: T,
    /// `1/pivot_theta*1/pivot_theta*(2.0*l*M_t + rho*A*l*l + ...*(...)*1/...*(sum_i(...) + ... - ...) + ...*...*...*.../(rho*A*l*l) - (sum_i(INTEGRAL_S1_PHI*M_theta_q/I...`
    pub c_106: T,
    /// `I/(rho*A*l*l*l*l)`
    pub c_107: T,
    /// `M_t*I*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/(1.0 + M_t*sum_i(...*.../INTEG...`
    pub c_108: T,
    /// `J_t*I/(rho*A*l*l*l*l*l*l)`
    pub c_109: T,
    /// `M_t*J_t*I*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*A*A*l*l*l*l*l*l*l)`
    pub c_110: T,
    /// `E/(rho*A*l*l*l*l)`
    pub c_111: T,
    /// `M_t*E*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/(1.0 + M_t*sum_i(...*.../INTEG...`
    pub c_112: T,
    /// `J_t*E/(rho*A*l*l*l*l*l*l)`
    pub c_113: T,
    /// `M_t*J_t*E*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*A*A*l*l*l*l*l*l*l)`
    pub c_114: T,
    /// `E*I/(rho*A*l*l*l)`
    pub c_115: T,
    /// `E*I*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/(1.0 + M_t*sum_i(...*.../INTEGRA...`
    pub c_116: T,
    /// `M_t*E*I*sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*A*A*l*l*l*l)`
    pub c_117: T,
    /// `M_t*E*I*sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_...`
    pub c_118: T,
    /// `J_t*E*I*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*A*A*l*l*l*l*l*l*l)`
    pub c_119: T,
    /// `M_t*J_t*E*I*sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))*1/(1.0...`
    pub c_120: T,
    /// `sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_SQUAR...`
    pub c_121: T,
    /// `1/(1.0 + J_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l*l*l) - (M_t*J_t*sum_i(.../...)*sum_i(.../...)*1/(1.0 + M_t*.../(...*l))/(rho*rho*A*A*l*l*l*l)))*(sum_i...`
    pub c_122: T,
    /// `(M_t*sum_i(...)*(l*... + .../...)*1/(1.0 + .../...)/(rho*A*l) - (l*sum_i(INTEGRAL_S1_PHI*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)) - (sum_i(PHI_D1_AT_END*(...*... + ...`
    pub c_123: T,
    /// `J_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_S...`
    pub c_124: T,
    /// `1/pivot_theta*1/pivot_theta*(l*l + (...)*(...)*1/... + ...*.../(rho*A) - (...*...*...*.../(rho*A*l)) - (l*l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARE...`
    pub c_125: T,
    /// `E*I/(rho*A*l*l*l*l*l)`
    pub c_126: T,
    /// `M_t*E*I*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*A*A*l*l*l*l*l*l)`
    pub c_127: T,
    /// `E*I/(rho*A*l*l*l*l*l*l)`
    pub c_128: T,
    /// `M_t*E*I*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*A*A*l*l*l*l*l*l*l)`
    pub c_129: T,
    /// `1/(1.0 + J_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l*l*l) - (M_t*J_t*sum_i(.../...)*sum_i(.../...)*1/(1.0 + M_t*.../(...*l))/(rho*rho*A*A*l*l*l*l)))*(M_t*s...`
    pub c_130: T,
    /// `(M_t*sum_i(...)*(l*... + .../...)*1/(1.0 + .../...)/(rho*A*l) - (l*sum_i(INTEGRAL_S1_PHI*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)) - (sum_i(PHI_D1_AT_END*(...*... + ...`
    pub c_131: T,
    /// `(l*sum_i(INTEGRAL_S1_PHI*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_D1_AT_END*(l*M_t*PHI_AT_END + J_t*.../l)/INTEGRAL_PHI_SQUARED)/(rho*A*l))/(l*l)`
    pub c_132: T,
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_S...`
    pub c_133: T,
    /// `1/pivot_theta*1/pivot_theta*(1.0 + ...*...*(... + ...)*1/(... + ...)/(rho*A*l*l) - (sum_i(INTEGRAL_S1_PHI*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)) - (sum_i(PHI_D1_A...`
    pub c_134: T,
    /// `-(1/pivot_theta)`
    pub c_135: T,
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*(J_t*(l*... + .../...)/(l*l) - (...*...*(... + ...)*1/(... + ...)/(rho*A*l*l*l)))*1/(1.0 + J_t*sum_i(.....`
    pub c_136: T,
    /// `M_t*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(...*... + .../l)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/pivot_theta*1/pivot_theta`
    pub c_137: T,
    /// `(J_t*(l*sum_i(.../...) + sum_i(.../...)/(rho*A*l))/(l*l) - (M_t*J_t*sum_i(.../...)*(l*sum_i(...) + sum_i(...)/(...*l))*1/(1.0 + M_t*.../(...*l))/(rho*A*l*l*l)))...`
    pub c_138: T,
    /// `(J_t*(l*... + .../...)/(l*l) - (...*...*(... + ...)*1/(... + ...)/(rho*A*l*l*l)))*1/(1.0 + J_t*.../(...*...) - (...*...*1/.../(...*...*...*...)))*1/pivot_theta*...`
    pub c_139: [T; 2],
    /// `1/pivot_theta*1/pivot_theta*(l*INTEGRAL_S1_PHI/INTEGRAL_PHI_SQUARED + (l*M_t*PHI_AT_END + J_t*PHI_D1_AT_END/l)/(rho*A*l*INTEGRAL_PHI_SQUARED))`
    pub c_140: [T; 2],
    /// `E*I*INTEGRAL_PHI_D2_SQUARED/(rho*rho*A*l*l*l*l*INTEGRAL_PHI_SQUARED)`
    pub c_141: [T; 2],
    /// `1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))*PHI_AT_END/(rho*rho*A*l*INTEGRAL_PHI_SQUARED)`
    pub c_142: [T; 2],
    /// `M_t*sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...)/(rho*A*l))*1/(1.0 + M_t*sum_i(...)/(rho*A*l))*PHI_AT_END/(rho*rho*rho*A*A*l*l*INTE...`
    pub c_143: [T; 2],
    /// `M_t*E*I/(rho*rho*A*l*l*l*l)`
    pub c_144: T,
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + J_t*sum_i(.../...)/(rho*A*l*l*l) - (M_t*J_t*sum_i(...)*sum_i(...)*1/(1.0 + .../...)/(rho*rho*A...`
    pub c_145: T,
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + J_t*.../(...*...) - (...*...*1/.../(...*...*...*...)))*1/(1.0 + J_t*.../(...*...) - (...*...*1...`
    pub c_146: T,
    /// `1/pivot_theta*(-(J_t*sum_i(PHI_D1_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*rho*A*l*l*l)) - (...*...*sum_i(...)*(l*... + .../...)*1/(... + ...)*1/(... + ......`
    pub c_147: T,
    /// `(J_t*(l*sum_i(.../...) + sum_i(.../...)/(rho*A*l))/(l*l) - (M_t*J_t*sum_i(.../...)*(l*sum_i(...) + sum_i(...)/(...*l))*1/(1.0 + M_t*.../(...*l))/(rho*A*l*l*l)))...`
    pub c_148: T,
    /// `M_t*sum_i(PHI_AT_END*(l*M_t*PHI_AT_END + J_t*.../l)/INTEGRAL_PHI_SQUARED)*1/pivot_theta/(rho*rho*A*l)`
    pub c_149: T,
    /// `M_t*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/pivot_theta*1/pivot_theta*(0.333...`
    pub c_150: T,
    /// `1/(1.0 + J_t*sum_i(.../...)/(rho*A*l*l*l) - (M_t*J_t*sum_i(...)*sum_i(...)*1/(1.0 + .../...)/(rho*rho*A*A*l*l*l*l)))*PHI_D1_AT_END/(rho*rho*A*l*INTEGRAL_PHI_SQU...`
    pub c_151: [T; 2],
    /// `1/(1.0 + J_t*.../(...*...) - (...*...*1/.../(...*...*...*...)))*1/(1.0 + J_t*.../(...*...) - (...*...*1/.../(...*...*...*...)))*(-(J_t*sum_i(.../...)/(rho*rho*A...`
    pub c_152: [T; 2],
    /// `1/pivot_theta*(l*M_t*PHI_AT_END + J_t*PHI_D1_AT_END/l)/(rho*rho*A*l*INTEGRAL_PHI_SQUARED)`
    pub c_153: [T; 2],
    /// `1/pivot_theta*1/pivot_theta*(0.3333333333333333*A*l*l*l + ...*.../(...*l) - (...*.../(...*l)) - (A*l*l*l*sum_i(...*.../INTEGRAL_PHI_SQUARED)) - (l*sum_i(.../......`
    pub c_154: [T; 2],
    /// `E*I*INTEGRAL_PHI_D2_SQUARED/(rho*A*A*l*l*l*l*INTEGRAL_PHI_SQUARED)`
    pub c_155: [T; 2],
    /// `1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))*PHI_AT_END/(rho*A*A*l*INTEGRAL_PHI_SQUARED)`
    pub c_156: [T; 2],
    /// `M_t*sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...)/(rho*A*l))*1/(1.0 + M_t*sum_i(...)/(rho*A*l))*PHI_AT_END/(rho*rho*A*A*A*l*l*INTEGR...`
    pub c_157: [T; 2],
    /// `M_t*E*I/(rho*A*A*l*l*l*l)`
    pub c_158: T,
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + J_t*sum_i(.../...)/(rho*A*l*l*l) - (M_t*J_t*sum_i(...)*sum_i(...)*1/(1.0 + .../...)/(rho*rho*A...`
    pub c_159: T,
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + J_t*.../(...*...) - (...*...*1/.../(...*...*...*...)))*1/(1.0 + J_t*.../(...*...) - (...*...*1...`
    pub c_160: T,
    /// `1/pivot_theta*(-(J_t*sum_i(PHI_D1_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*A*A*l*l*l)) - (...*...*sum_i(...)*(l*... + .../...)*1/(... + ...)*1/(... + ...)/...`
    pub c_161: T,
    /// `(J_t*(l*sum_i(.../...) + sum_i(.../...)/(rho*A*l))/(l*l) - (M_t*J_t*sum_i(.../...)*(l*sum_i(...) + sum_i(...)/(...*l))*1/(1.0 + M_t*.../(...*l))/(rho*A*l*l*l)))...`
    pub c_162: T,
    /// `M_t*sum_i(PHI_AT_END*(l*M_t*PHI_AT_END + J_t*.../l)/INTEGRAL_PHI_SQUARED)*1/pivot_theta/(rho*A*A*l)`
    pub c_163: T,
    /// `M_t*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/pivot_theta*1/pivot_theta*(0.333...`
    pub c_164: T,
    /// `1/(1.0 + J_t*sum_i(.../...)/(rho*A*l*l*l) - (M_t*J_t*sum_i(...)*sum_i(...)*1/(1.0 + .../...)/(rho*rho*A*A*l*l*l*l)))*PHI_D1_AT_END/(rho*A*A*l*INTEGRAL_PHI_SQUAR...`
    pub c_165: [T; 2],
    /// `1/(1.0 + J_t*.../(...*...) - (...*...*1/.../(...*...*...*...)))*1/(1.0 + J_t*.../(...*...) - (...*...*1/.../(...*...*...*...)))*(-(J_t*sum_i(.../...)/(rho*A*A*l...`
    pub c_166: [T; 2],
    /// `1/pivot_theta*(l*M_t*PHI_AT_END + J_t*PHI_D1_AT_END/l)/(rho*A*A*l*INTEGRAL_PHI_SQUARED)`
    pub c_167: [T; 2],
    /// `1/pivot_theta*1/pivot_theta*(0.3333333333333333*rho*l*l*l + ...*.../(...*l) - (...*.../(...*l)) - (rho*l*l*l*sum_i(...*.../INTEGRAL_PHI_SQUARED)) - (l*sum_i(......`
    pub c_168: [T; 2],
    /// `4.0*E*I*INTEGRAL_PHI_D2_SQUARED/(rho*A*l*l*l*l*l*INTEGRAL_PHI_SQUARED)`
    pub c_169: [T; 2],
    /// `1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))*PHI_AT_END/(rho*A*l*l*INTEGRAL_PHI_SQUARED)`
    pub c_170: [T; 2],
    /// `M_t*sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...)/(rho*A*l))*1/(1.0 + M_t*sum_i(...)/(rho*A*l))*PHI_AT_END/(rho*rho*A*A*l*l*l*INTEGR...`
    pub c_171: [T; 2],
    /// `4.0*M_t*E*I/(rho*A*l*l*l*l*l)`
    pub c_172: T,
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + J_t*sum_i(.../...)/(rho*A*l*l*l) - (M_t*J_t*sum_i(...)*sum_i(...)*1/(1.0 + .../...)/(rho*rho*A...`
    pub c_173: T,
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + J_t*.../(...*...) - (...*...*1/.../(...*...*...*...)))*1/(1.0 + J_t*.../(...*...) - (...*...*1...`
    pub c_174: T,
    /// `1/pivot_theta*(J_t*(sum_i(...*.../INTEGRAL_PHI_SQUARED) + sum_i(...)/(...*l) - (sum_i(...)/(...*...)))/(l*l) - (2.0*J_t*(l*sum_i(.../...) + sum_i(.../...)/(rho*...`
    pub c_175: T,
    /// `(J_t*(l*sum_i(.../...) + sum_i(.../...)/(rho*A*l))/(l*l) - (M_t*J_t*sum_i(.../...)*(l*sum_i(...) + sum_i(...)/(...*l))*1/(1.0 + M_t*.../(...*l))/(rho*A*l*l*l)))...`
    pub c_176: T,
    /// `M_t*1/pivot_theta*(sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(M_t*... - (.../...))/INTEGRAL_PHI_SQUARED)/(rho*A*l) - (sum_i(PHI_...`
    pub c_177: T,
    /// `M_t*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/pivot_theta*1/pivot_theta*(2.0*l...`
    pub c_178: T,
    /// `1/(1.0 + J_t*sum_i(.../...)/(rho*A*l*l*l) - (M_t*J_t*sum_i(...)*sum_i(...)*1/(1.0 + .../...)/(rho*rho*A*A*l*l*l*l)))*PHI_D1_AT_END/(rho*A*l*l*INTEGRAL_PHI_SQUAR...`
    pub c_179: [T; 2],
    /// `1/(1.0 + J_t*.../(...*...) - (...*...*1/.../(...*...*...*...)))*1/(1.0 + J_t*.../(...*...) - (...*...*1/.../(...*...*...*...)))*(-(3.0*J_t*sum_i(.../...)/(rho*A...`
    pub c_180: [T; 2],
    /// `INTEGRAL_S1_PHI/INTEGRAL_PHI_SQUARED`
    pub c_181: [T; 2],
    /// `1/pivot_theta*(INTEGRAL_S1_PHI/INTEGRAL_PHI_SQUARED + (M_t*PHI_AT_END - (J_t*PHI_D1_AT_END/(l*l)))/(rho*A*l*INTEGRAL_PHI_SQUARED) - ((l*M_t*PHI_AT_END + J_t*PHI...`
    pub c_182: [T; 2],
    /// `1/pivot_theta*1/pivot_theta*(...*l*M_t + rho*A*l*l + ...*...*(... + ...) + ...*.../(...*...) - (sum_i(...*M_theta_q/INTEGRAL_PHI_SQUARED) + l*sum_i(.../...)) - ...`
    pub c_183: [T; 2],
    /// `-(M_t*I/(rho*A*l*l*l*l))`
    pub c_184: T,
    /// `-(I*INTEGRAL_PHI_D2_SQUARED/(rho*A*l*l*l*l*INTEGRAL_PHI_SQUARED))`
    pub c_185: [T; 2],
    /// `-(M_t*E/(rho*A*l*l*l*l))`
    pub c_186: T,
    /// `-(E*INTEGRAL_PHI_D2_SQUARED/(rho*A*l*l*l*l*INTEGRAL_PHI_SQUARED))`
    pub c_187: [T; 2],
    /// `sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...)/(rho*A*l))*1/(1.0 + M_t*sum_i(...)/(rho*A*l))*PHI_AT_END/(rho*rho*A*A*l*l*INTEGRAL_PHI...`
    pub c_188: [T; 2],
    /// `sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + J_t*sum_i(.../...)/(rho*A*l*l*l) - (M_t*J_t*sum_i(...)*sum_i(...)*1/(1.0 + .../...)/(rho*rho*A*A*l...`
    pub c_189: T,
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + J_t*.../(...*...) - (...*...*1/.../(...*...*...*...)))*1/(1.0 + J_t*.../(...*...) - (...*...*1...`
    pub c_190: T,
    /// `1/pivot_theta*(J_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)/(rho*A*l*l) - (J_t*sum_i(...)*(l*... + .../...)*1/(1.0 + .../...)/(rho*A*l*l*l) + M_t*J_...`
    pub c_191: T,
    /// `(J_t*(l*sum_i(.../...) + sum_i(.../...)/(rho*A*l))/(l*l) - (M_t*J_t*sum_i(.../...)*(l*sum_i(...) + sum_i(...)/(...*l))*1/(1.0 + M_t*.../(...*l))/(rho*A*l*l*l)))...`
    pub c_192: T,
    /// `(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(l*M_t*PHI_AT_END + J_t*.../l)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/pivot_theta`
    pub c_193: T,
    /// `M_t*sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)*1/pivot_theta/(rho*A)`
    pub c_194: T,
    /// `M_t*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/pivot_theta*1/pivot_theta*(l*l +...`
    pub c_195: T,
    /// `-(E*I/(rho*A*l*l*l*l))`
    pub c_196: T,
    /// `1/(1.0 + J_t*.../(...*...) - (...*...*1/.../(...*...*...*...)))*1/(1.0 + J_t*.../(...*...) - (...*...*1/.../(...*...*...*...)))*(J_t*sum_i(...)*sum_i(...)*1/(1....`
    pub c_197: [T; 2],
    /// `1/pivot_theta*PHI_AT_END/(rho*A*INTEGRAL_PHI_SQUARED)`
    pub c_198: [T; 2],
    /// `1/pivot_theta*1/pivot_theta*(l*l + ...*... + .../... - (...*.../(...*l)) - (l*l*sum_i(...*.../INTEGRAL_PHI_SQUARED)) - (sum_i(...*M_theta_q/INTEGRAL_PHI_SQUARED...`
    pub c_199: [T; 2],
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + J_t*.../(...*...) - (...*...*1/.../(...*...*...*...)))*1/(1.0 + J_t*.../(...*...) - (...*...*1...`
    pub c_200: T,
    /// `1/pivot_theta*(J_t*sum_i(PHI_D1_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)/(rho*A*l*l*l*l) + (l*sum_i(...*.../INTEGRAL_PHI_SQUARED) + sum_i(...*(...)/INTEGRAL_P...`
    pub c_201: T,
    /// `(J_t*(l*sum_i(.../...) + sum_i(.../...)/(rho*A*l))/(l*l) - (M_t*J_t*sum_i(.../...)*(l*sum_i(...) + sum_i(...)/(...*l))*1/(1.0 + M_t*.../(...*l))/(rho*A*l*l*l)))...`
    pub c_202: T,
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/pivot_theta/(rho*A*l*l)`
    pub c_203: T,
    /// `M_t*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/pivot_theta*1/pivot_theta*(1.0 +...`
    pub c_204: T,
    /// `1/(1.0 + J_t*.../(...*...) - (...*...*1/.../(...*...*...*...)))*1/(1.0 + J_t*.../(...*...) - (...*...*1/.../(...*...*...*...)))*(sum_i(PHI_D1_AT_END*PHI_D1_AT_E...`
    pub c_205: [T; 2],
    /// `1/pivot_theta*PHI_D1_AT_END/(rho*A*l*l*INTEGRAL_PHI_SQUARED)`
    pub c_206: [T; 2],
    /// `1/pivot_theta*1/pivot_theta*(1.0 + ...*(...)*1/.../(rho*A*l*l) - (sum_i(INTEGRAL_S1_PHI*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)) - (sum_i(...*M_theta_q/(l*...) + .....`
    pub c_207: [T; 2],
    /// `0.6666666666666666*rho*A*l*l*l`
    pub c_208: T,
    /// `2.0*rho*A*l*l*INTEGRAL_S1_PHI`
    pub c_209: [T; 2],
    /// `2.0*rho*A*l*INTEGRAL_PHI_SQUARED`
    pub c_210: [T; 2],
    /// `-(1.0/(l*l))`
    pub c_211: T,
    /// `2.0*A*l*l`
    pub c_212: T,
    /// `A*l`
    pub c_213: T,
    /// `2.0*rho*l*l`
    pub c_214: T,
    /// `rho*l`
    pub c_215: T,
    /// `4.0*rho*A*l`
    pub c_216: T,
    /// `J_t/(l*l)`
    pub c_217: T,
    /// `1.5*E*I/(l*l*l*l)`
    pub c_218: T,
    /// `0.5*I/(l*l*l)`
    pub c_219: T,
    /// `0.5*E/(l*l*l)`
    pub c_220: T,
    /// `J_t*E*I/(rho*A*l*l*l*l*l*l)`
    pub c_221: T,
    /// `M_t*(l*sum_i(...*.../INTEGRAL_PHI_SQUARED) + sum_i(...*(...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))*1/pivot_theta/(rho*A*l)`
    pub c_222: T,
    /// `PHI_AT_END/INTEGRAL_PHI_SQUARED`
    pub c_223: [T; 2],
    /// `1/(1.0 + J_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l*l*l) - (M_t*J_t*sum_i(.../...)*sum_i(.../...)*1/(1.0 + M_t*.../(...*l))/(rho*rho*A*A*l*l*l*l)))/(rho*A...`
    pub c_224: T,
    /// `PHI_D1_AT_END/INTEGRAL_PHI_SQUARED`
    pub c_225: [T; 2],
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))*1/(1.0 + J_t*sum_i(.../...)/(rho*A*l*l*l) - (M_t*J_t*sum_i(...)*...`
    pub c_226: T,
    /// `-c`
    pub c_227: T,
    /// `M_t*E*I*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*A*A*l*l*l*l*l)`
    pub c_228: T,
    /// `M_t*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/(1.0 + M_t*sum_i(...*.../INTEGRA...`
    pub c_229: T,
    /// `1/(1.0 + J_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l*l*l) - (M_t*J_t*sum_i(.../...)*sum_i(.../...)*1/(1.0 + M_t*.../(...*l))/(rho*rho*A*A*l*l*l*l)))/(rho*r...`
    pub c_230: T,
    /// `1/(1.0 + M_t*sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*A*l)`
    pub c_231: T,
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))*1/(1.0 + J_t*sum_i(.../...)/(rho*A*l*l*l) - (M_t*J_t*sum_i(...)*...`
    pub c_232: T,
    /// `(M_t*sum_i(...)*(l*... + .../...)*1/(1.0 + .../...)/(rho*A*l) - (l*sum_i(INTEGRAL_S1_PHI*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)) - (sum_i(PHI_D1_AT_END*(...*... + ...`
    pub c_233: T,
    /// `2.0*M_t*J_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))*1/(...`
    pub c_234: T,
    /// `1.0/(rho*A*l)`
    pub c_235: T,
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*A*A*l*l)`
    pub c_236: T,
    /// `(J_t*(l*sum_i(.../...) + sum_i(.../...)/(rho*A*l))/(l*l) - (M_t*J_t*sum_i(.../...)*(l*sum_i(...) + sum_i(...)/(...*l))*1/(1.0 + M_t*.../(...*l))/(rho*A*l*l*l)))...`
    pub c_237: T,
    /// `sum_i((l*M_t*PHI_AT_END + J_t*PHI_D1_AT_END/l)*M_theta_q/INTEGRAL_PHI_SQUARED)*1/pivot_theta*1/pivot_theta/(rho*rho*A*l)`
    pub c_238: T,
    /// `J_t*sum_i(PHI_D1_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + J_t*sum_i(...)/(rho*A*l*...) - (M_t*J_t*...*...*1/(... + ...)/(rho*rho*A*A*l*l*l*l)))*1/(1....`
    pub c_239: T,
    /// `M_t*E*I*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*rho*A*A*l*l*l*l*l)`
    pub c_240: T,
    /// `M_t*sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))*1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))/(rho*rho*A*l)`
    pub c_241: T,
    /// `M_t*E*I*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(...*... + .../l)/INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*A*l*l*l*l)`
    pub c_242: T,
    /// `M_t*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_EN...`
    pub c_243: T,
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(...*... + .../l)/INTEGRAL...`
    pub c_244: T,
    /// `M_t*J_t*E*I*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)/(rho*rho*A*A*l*l*l*l*l*l*l)`
    pub c_245: T,
    /// `M_t*J_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(...*... + .../l)/INTE...`
    pub c_246: T,
    /// `M_t*J_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + J_t*sum_i(...)/(rho*A*l*...) - (M_t*J...`
    pub c_247: T,
    /// `sum_i(PHI_AT_END*(l*M_t*PHI_AT_END + J_t*PHI_D1_AT_END/l)/INTEGRAL_PHI_SQUARED)/(rho*rho*A*l)`
    pub c_248: T,
    /// `M_t*1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))*1/pivot_theta/(rho*A*l)`
    pub c_249: T,
    /// `M_t*E*I*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*A*l*l*l*l)`
    pub c_250: T,
    /// `2.0*M_t*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/(1.0 + M_t*sum_i(...*.../INT...`
    pub c_251: T,
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*A*l)`
    pub c_252: T,
    /// `M_t*J_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*A*l*l*l)`
    pub c_253: T,
    /// `1/pivot_theta/(rho*rho*A*l)`
    pub c_254: T,
    /// `(l*M_t*PHI_AT_END + J_t*PHI_D1_AT_END/l)/INTEGRAL_PHI_SQUARED`
    pub c_255: [T; 2],
    /// `INTEGRAL_PHI_D2_SQUARED/INTEGRAL_PHI_SQUARED`
    pub c_256: [T; 2],
    /// `1/pivot_theta*1/pivot_theta*(l*M_t*PHI_AT_END + J_t*PHI_D1_AT_END/l)/(rho*A*l*INTEGRAL_PHI_SQUARED)`
    pub c_257: [T; 2],
    /// `l*1/pivot_theta*1/pivot_theta*INTEGRAL_S1_PHI/INTEGRAL_PHI_SQUARED`
    pub c_258: [T; 2],
    /// `0.3333333333333333*A*l*l*l*1/pivot_theta*1/pivot_theta`
    pub c_259: T,
    /// `1/(1.0 + J_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l*l*l) - (M_t*J_t*sum_i(.../...)*sum_i(.../...)*1/(1.0 + M_t*.../(...*l))/(rho*rho*A*A*l*l*l*l)))/(rho*A...`
    pub c_260: T,
    /// `1/(1.0 + M_t*sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*A*A*l)`
    pub c_261: T,
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))*1/(1.0 + J_t*sum_i(.../...)/(rho*A*l*l*l) - (M_t*J_t*sum_i(...)*...`
    pub c_262: T,
    /// `2.0*M_t*J_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))*1/(...`
    pub c_263: T,
    /// `sum_i((l*M_t*PHI_AT_END + J_t*PHI_D1_AT_END/l)*M_theta_q/INTEGRAL_PHI_SQUARED)*1/pivot_theta*1/pivot_theta/(rho*A*A*l)`
    pub c_264: T,
    /// `J_t*sum_i(PHI_D1_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + J_t*sum_i(...)/(rho*A*l*...) - (M_t*J_t*...*...*1/(... + ...)/(rho*rho*A*A*l*l*l*l)))*1/(1....`
    pub c_265: T,
    /// `M_t*E*I*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*A*A*A*l*l*l*l*l)`
    pub c_266: T,
    /// `M_t*sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))*1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))/(rho*A*A*l)`
    pub c_267: T,
    /// `sum_i(PHI_AT_END*(l*M_t*PHI_AT_END + J_t*PHI_D1_AT_END/l)/INTEGRAL_PHI_SQUARED)/(rho*A*A*l)`
    pub c_268: T,
    /// `1/pivot_theta/(rho*A*A*l)`
    pub c_269: T,
    /// `0.3333333333333333*rho*l*l*l*1/pivot_theta*1/pivot_theta`
    pub c_270: T,
    /// `1/(1.0 + J_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l*l*l) - (M_t*J_t*sum_i(.../...)*sum_i(.../...)*1/(1.0 + M_t*.../(...*l))/(rho*rho*A*A*l*l*l*l)))/(rho*A...`
    pub c_271: T,
    /// `1/(1.0 + M_t*sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*A*l*l)`
    pub c_272: T,
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))*1/(1.0 + J_t*sum_i(.../...)/(rho*A*l*l*l) - (M_t*J_t*sum_i(...)*...`
    pub c_273: T,
    /// `4.0*M_t*J_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))*1/(...`
    pub c_274: T,
    /// `sum_i((l*M_t*PHI_AT_END + J_t*PHI_D1_AT_END/l)*M_theta_q/INTEGRAL_PHI_SQUARED)*1/pivot_theta*1/pivot_theta/(rho*A*l*l)`
    pub c_275: T,
    /// `sum_i(INTEGRAL_S1_PHI*M_theta_q/INTEGRAL_PHI_SQUARED)*1/pivot_theta*1/pivot_theta`
    pub c_276: T,
    /// `3.0*J_t*sum_i(PHI_D1_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + J_t*sum_i(...)/(rho*A*l*...) - (M_t*J_t*...*...*1/(... + ...)/(rho*rho*A*A*l*l*l*l)))*1...`
    pub c_277: T,
    /// `4.0*M_t*E*I*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*A*A*l*l*l*l*l*l)`
    pub c_278: T,
    /// `M_t*sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))*1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))/(rho*A*l*l)`
    pub c_279: T,
    /// `1/pivot_theta/(rho*A*l*l)`
    pub c_280: T,
    /// `1/pivot_theta*1/pivot_theta*M_theta_q/(rho*A*l*INTEGRAL_PHI_SQUARED)`
    pub c_281: [T; 2],
    /// `PHI_D1_AT_END/(rho*A*l*INTEGRAL_PHI_SQUARED)`
    pub c_282: [T; 2],
    /// `PHI_AT_END/(rho*A*l*INTEGRAL_PHI_SQUARED)`
    pub c_283: [T; 2],
    /// `1/pivot_theta/(rho*A*l*INTEGRAL_PHI_SQUARED)`
    pub c_284: [T; 2],
    /// `2.0*l*M_t*1/pivot_theta*1/pivot_theta`
    pub c_285: T,
    /// `rho*A*l*l*1/pivot_theta*1/pivot_theta`
    pub c_286: T,
    /// `M_t*I*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*A*A*l*l*l*l*l)`
    pub c_287: T,
    /// `M_t*E*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*A*A*l*l*l*l*l)`
    pub c_288: T,
    /// `(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))...`
    pub c_289: T,
    /// `sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))*1/(1.0 + J_t*sum_i(.../...)/(rho*A*l*l*l) - (M_t*J_t*sum_i(...)*sum_...`
    pub c_290: T,
    /// `(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/INTEGRAL_PHI_SQUARED) + sum_i(PHI_AT_END*(... + ...)/INTEGRAL_PHI_SQUARED)/(rho*A*l))*(l*sum_i(INTEGRAL_S1_PHI*PHI_AT_END/IN...`
    pub c_291: T,
    /// `J_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))*1/(1.0 + J_...`
    pub c_292: T,
    /// `E*I*1/(1.0 + M_t*sum_i(...*.../INTEGRAL_PHI_SQUARED)/(rho*A*l))/(rho*rho*A*A*l*l*l*l*l)`
    pub c_293: T,
    /// `sum_i(PHI_AT_END*PHI_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))*1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))/(rho*A*l)`
    pub c_294: T,
    /// `l*l*1/pivot_theta*1/pivot_theta`
    pub c_295: T,
    /// `M_t*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*sum_i(PHI_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + M_t*sum_i(.../...)/(rho*A*l))*1/(1.0 + J_...`
    pub c_296: T,
    /// `sum_i(PHI_D1_AT_END*PHI_D1_AT_END/INTEGRAL_PHI_SQUARED)*1/(1.0 + J_t*sum_i(...)/(rho*A*l*...) - (M_t*J_t*...*...*1/(... + ...)/(rho*rho*A*A*l*l*l*l)))*1/(1.0 + ...`
    pub c_297: T,
    /// True if all prepared pivots of the mass matrix are positive and finite. If false, the mass matrix is not positive definite and the rates are invalid.
    pub positive_definite: bool,
}
impl<T: Scalar> Coefficients<T> {
    /// Prepares the coefficients of these parameters.
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
        let s_19 = M_t * s_18;
        let s_20 = sum_of_few(
            [(); 2],
            |i| {
                T::number(PHI_AT_END[i]) * T::number(PHI_AT_END[i])
                    / T::number(INTEGRAL_PHI_SQUARED[i])
            },
        );
        let s_21 = M_t * s_20;
        let s_22 = T::number(1.0) + s_21 / s_13;
        let s_23 = pivot_reciprocal(s_22);
        let s_24 = sum_of_few(
            [(); 2],
            |i| {
                T::number(INTEGRAL_S1_PHI[i]) * T::number(PHI_D1_AT_END[i])
                    / T::number(INTEGRAL_PHI_SQUARED[i])
            },
        );
        let s_25 = l * s_24;
        let mut s_26 = [T::number(0.0); 2];
        for i in 0..2 {
            s_26[i] = T::number(PHI_D1_AT_END[i]) * s_11[i];
        }
        let s_27 = sum_of_few([(); 2], |i| s_26[i] / T::number(INTEGRAL_PHI_SQUARED[i]));
        let s_28 = s_27 / s_13;
        let s_29 = s_25 + s_28;
        let s_30 = s_6 * s_3;
        let s_31 = M_t * J_t;
        let s_32 = sum_of_few(
            [(); 2],
            |i| {
                T::number(PHI_AT_END[i]) * T::number(PHI_D1_AT_END[i])
                    / T::number(INTEGRAL_PHI_SQUARED[i])
            },
        );
        let s_33 = s_31 * s_32;
        let s_34 = s_33 * s_17;
        let s_35 = s_34 * s_23;
        let s_36 = J_t * s_29 / s_2 - s_35 / s_30;
        let s_37 = M_t * s_32;
        let s_38 = s_37 * s_17;
        let s_39 = s_38 * s_23;
        let s_40 = s_39 / s_13 - s_25 - s_28;
        let s_41 = s_36 * s_40;
        let s_42 = sum_of_few(
            [(); 2],
            |i| {
                T::number(PHI_D1_AT_END[i]) * T::number(PHI_D1_AT_END[i])
                    / T::number(INTEGRAL_PHI_SQUARED[i])
            },
        );
        let s_43 = J_t * s_42;
        let s_44 = rho * rho;
        let s_45 = A * A;
        let s_46 = s_44 * s_45;
        let s_47 = s_2 * s_2;
        let s_48 = s_46 * s_47;
        let s_49 = s_32 * s_32;
        let s_50 = s_31 * s_49;
        let s_51 = s_50 * s_23;
        let s_52 = T::number(1.0) + s_43 / s_30 - s_51 / s_48;
        let s_53 = pivot_reciprocal(s_52);
        let s_54 = J_h + J_t + s_4 + s_5 + s_19 * s_23 - l * s_12 - s_14 / s_13;
        let pivot_theta = s_54 - s_41 * s_53;
        let s_55 = pivot_reciprocal(pivot_theta);
        let c = parameters.c;
        let s_56 = s_6 * s_47;
        let E = parameters.E;
        let I = parameters.I;
        let s_57 = E * I;
        let mut s_58 = [T::number(0.0); 2];
        for i in 0..2 {
            s_58[i] = s_56 * T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let mut s_59 = [T::number(0.0); 2];
        for i in 0..2 {
            s_59[i] = s_57 * T::number(INTEGRAL_PHI_D2_SQUARED[i]);
        }
        let mut s_60 = [T::number(0.0); 2];
        for i in 0..2 {
            s_60[i] = s_59[i] * M_theta_q[i] / s_58[i];
        }
        let s_61 = M_t * E;
        let s_62 = s_61 * I;
        let s_63 = s_62 * s_17;
        let s_64 = s_63 * s_23;
        let mut s_65 = [T::number(0.0); 2];
        for i in 0..2 {
            s_65[i] = T::number(PHI_AT_END[i]) * T::number(INTEGRAL_PHI_D2_SQUARED[i])
                / T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let s_66 = s_40 * s_53;
        let s_67 = s_2 * s_47;
        let s_68 = s_6 * s_67;
        let s_69 = J_t * E;
        let s_70 = s_69 * I;
        let mut s_71 = [T::number(0.0); 2];
        for i in 0..2 {
            s_71[i] = s_70 * T::number(PHI_D1_AT_END[i])
                * T::number(INTEGRAL_PHI_D2_SQUARED[i])
                / (s_68 * T::number(INTEGRAL_PHI_SQUARED[i]));
        }
        let s_72 = s_3 * s_47;
        let s_73 = s_46 * s_72;
        let s_74 = s_31 * E;
        let s_75 = s_74 * I;
        let s_76 = s_75 * s_32;
        let s_77 = s_76 * s_23;
        let mut s_78 = [T::number(0.0); 2];
        for i in 0..2 {
            s_78[i] = s_59[i] / s_58[i];
        }
        let mut s_79 = [T::number(0.0); 2];
        for i in 0..2 {
            s_79[i] = s_13 * T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let mut s_80 = [T::number(0.0); 2];
        for i in 0..2 {
            s_80[i] = s_23 * T::number(PHI_AT_END[i]);
        }
        let mut s_81 = [T::number(0.0); 2];
        for i in 0..2 {
            s_81[i] = s_80[i] / s_79[i];
        }
        let s_82 = s_37 * s_53;
        let s_83 = s_36 * s_55;
        let s_84 = M_t * s_17;
        let s_85 = s_84 * s_55;
        let mut s_86 = [T::number(0.0); 2];
        for i in 0..2 {
            s_86[i] = s_53 * T::number(PHI_D1_AT_END[i]);
        }
        let mut s_87 = [T::number(0.0); 2];
        for i in 0..2 {
            s_87[i] = s_86[i] / s_79[i];
        }
        let mut s_88 = [T::number(0.0); 2];
        for i in 0..2 {
            s_88[i] = l * T::number(INTEGRAL_S1_PHI[i])
                / T::number(INTEGRAL_PHI_SQUARED[i]) + s_11[i] / s_79[i];
        }
        let mut s_89 = [T::number(0.0); 2];
        for i in 0..2 {
            s_89[i] = s_55 * s_88[i];
        }
        let mut s_90 = [T::number(0.0); 2];
        for i in 0..2 {
            s_90[i] = -s_78[i];
        }
        let M_theta_theta = J_h + s_4 + (J_t + s_5);
        let mut s_91 = [T::number(0.0); 2];
        for i in 0..2 {
            s_91[i] = M_t * T::number(PHI_AT_END[i]);
        }
        let mut s_92 = [T::number(0.0); 2];
        for i in 0..2 {
            s_92[i] = T::number(PHI_D1_AT_END[i]) / l;
        }
        let mut s_93 = [T::number(0.0); 2];
        for i in 0..2 {
            s_93[i] = s_59[i] / s_3;
        }
        let s_94 = T::number(2.0) * rho;
        let s_95 = s_94 * A;
        let s_96 = s_95 * s_2;
        let s_97 = T::number(0.5) * E;
        let mut s_98 = [T::number(0.0); 2];
        for i in 0..2 {
            s_98[i] = s_9[i] / s_2;
        }
        let mut s_99 = [T::number(0.0); 2];
        for i in 0..2 {
            s_99[i] = s_77 * T::number(PHI_AT_END[i])
                * T::number(INTEGRAL_PHI_D2_SQUARED[i])
                / (s_73 * T::number(INTEGRAL_PHI_SQUARED[i])) - s_71[i];
        }
        let mut s_100 = [T::number(0.0); 2];
        for i in 0..2 {
            s_100[i] = s_60[i]
                - s_64 * T::number(PHI_AT_END[i]) * T::number(INTEGRAL_PHI_D2_SQUARED[i])
                    / s_58[i] - s_66 * s_99[i];
        }
        let mut s_101 = [T::number(0.0); 2];
        for i in 0..2 {
            s_101[i] = s_55 * s_100[i];
        }
        let s_102 = c * s_55;
        let mut s_103 = [T::number(0.0); 2];
        for i in 0..2 {
            s_103[i] = -s_81[i];
        }
        let mut s_104 = [T::number(0.0); 2];
        for i in 0..2 {
            s_104[i] = s_99[i] - s_83 * s_100[i];
        }
        let mut s_105 = [T::number(0.0); 2];
        for i in 0..2 {
            s_105[i] = -(s_62 * T::number(PHI_AT_END[i])
                * T::number(INTEGRAL_PHI_D2_SQUARED[i]) / s_58[i])
                - s_82 * s_104[i] / s_13 - s_85 * s_100[i];
        }
        let mut s_106 = [T::number(0.0); 2];
        for i in 0..2 {
            s_106[i] = -s_87[i];
        }
        let mut s_107 = [T::number(0.0); 2];
        for i in 0..2 {
            s_107[i] = -s_89[i];
        }
        let s_108 = M_t * c;
        let s_109 = s_23
            * (s_108 * s_17 * s_55 - s_108 * s_32 * s_36 * s_53 * s_55 / s_13);
        let s_110 = c * s_36 * s_53 * s_55;
        let mut s_111 = [T::number(0.0); 2];
        for i in 0..2 {
            s_111[i] = s_102 * s_88[i] - s_109 * T::number(PHI_AT_END[i]) / s_79[i]
                - s_110 * T::number(PHI_D1_AT_END[i]) / s_79[i];
        }
        let s_112 = s_37 * s_36 * s_53;
        let s_113 = s_112 * s_55 / s_13;
        let s_114 = s_23 * (s_113 - s_85);
        let s_115 = s_36 * s_53;
        let s_116 = s_115 * s_55;
        let mut s_117 = [T::number(0.0); 2];
        for i in 0..2 {
            s_117[i] = s_116 * T::number(PHI_D1_AT_END[i]) / s_79[i];
        }
        let mut s_118 = [T::number(0.0); 2];
        for i in 0..2 {
            s_118[i] = s_117[i] - s_89[i] - s_114 * T::number(PHI_AT_END[i]) / s_79[i];
        }
        let s_119 = s_55 * s_55;
        let s_120 = s_44 * A;
        let s_121 = s_120 * s_47;
        let mut s_122 = [T::number(0.0); 2];
        for i in 0..2 {
            s_122[i] = T::number(INTEGRAL_PHI_D2_SQUARED[i]) * M_theta_q[i]
                / T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let s_123 = rho * s_2;
        let mut s_124 = [T::number(0.0); 2];
        for i in 0..2 {
            s_124[i] = T::number(INTEGRAL_S1_PHI[i])
                * T::number(INTEGRAL_PHI_D2_SQUARED[i])
                / T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let s_125 = rho * s_44;
        let s_126 = s_125 * s_45;
        let s_127 = l * s_47;
        let s_128 = s_126 * s_127;
        let s_129 = s_62 * s_16 * s_23;
        let s_130 = M_t * M_t;
        let s_131 = s_23 * s_23;
        let s_132 = s_130 * E * I * s_20 * s_17 * s_131;
        let mut s_133 = [T::number(0.0); 2];
        for i in 0..2 {
            s_133[i] = T::number(PHI_D1_AT_END[i])
                * T::number(INTEGRAL_PHI_D2_SQUARED[i])
                / T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let s_134 = T::number(2.0) * M_t;
        let s_135 = s_134 * J_t;
        let s_136 = s_135 * E * I * s_32 * s_23;
        let s_137 = A * s_45;
        let s_138 = s_44 * s_44 * s_137;
        let s_139 = s_47 * s_47;
        let s_140 = s_130 * J_t;
        let s_141 = s_140 * E * I * s_20 * s_32 * s_131;
        let s_142 = s_120 * l;
        let s_143 = s_27 / s_142;
        let s_144 = s_39 / s_142;
        let s_145 = s_126 * s_2;
        let s_146 = s_37 * s_16 * s_23;
        let s_147 = s_130 * s_20;
        let s_148 = s_147 * s_32 * s_17 * s_131;
        let s_149 = s_143 + (s_148 / s_145 - s_144 - s_146 / s_145);
        let s_150 = s_53 * s_53;
        let s_151 = s_40 * s_150;
        let s_152 = s_120 * s_3;
        let s_153 = s_126 * s_47;
        let s_154 = s_135 * s_49 * s_23;
        let s_155 = s_140 * s_20;
        let s_156 = s_155 * s_49 * s_131;
        let s_157 = -(s_43 / s_152) - (s_156 / (s_138 * s_127) - s_154 / s_153);
        let s_158 = T::number(0.3333333333333333) * A * s_3;
        let s_159 = sum_of_few(
            [(); 2],
            |i| {
                T::number(INTEGRAL_S1_PHI[i]) * T::number(INTEGRAL_S1_PHI[i])
                    / T::number(INTEGRAL_PHI_SQUARED[i])
            },
        );
        let s_160 = sum_of_few(
            [(); 2],
            |i| {
                T::number(INTEGRAL_S1_PHI[i]) * s_11[i]
                    / T::number(INTEGRAL_PHI_SQUARED[i])
            },
        );
        let s_161 = l * s_160;
        let s_162 = s_134 * s_16 * s_17 * s_23;
        let s_163 = s_147 * s_18 * s_131;
        let s_164 = J_t * s_27;
        let s_165 = s_35 / s_152;
        let s_166 = s_33 * s_16 * s_23;
        let s_167 = s_155 * s_32 * s_17 * s_131;
        let s_168 = -(s_164 / s_152) - (s_167 / s_153 - s_165 - s_166 / s_153);
        let s_169 = s_41 * s_150;
        let s_170 = s_158 + (s_163 / s_142 - s_162 / s_142) - A * s_3 * s_159
            - (s_161 / rho - s_14 / s_142);
        let s_171 = s_170 - (s_66 * s_168 + s_115 * s_149 - s_169 * s_157);
        let s_172 = s_119 * s_171;
        let s_173 = rho * s_45;
        let s_174 = s_173 * s_47;
        let s_175 = A * s_2;
        let s_176 = s_44 * s_137;
        let s_177 = s_176 * s_127;
        let s_178 = s_125 * (s_45 * s_45);
        let s_179 = s_173 * l;
        let s_180 = s_27 / s_179;
        let s_181 = s_39 / s_179;
        let s_182 = s_176 * s_2;
        let s_183 = s_180 + (s_148 / s_182 - s_181 - s_146 / s_182);
        let s_184 = s_173 * s_3;
        let s_185 = s_176 * s_47;
        let s_186 = -(s_43 / s_184) - (s_156 / (s_178 * s_127) - s_154 / s_185);
        let s_187 = s_1 * s_3;
        let s_188 = s_35 / s_184;
        let s_189 = -(s_164 / s_184) - (s_167 / s_185 - s_188 - s_166 / s_185);
        let s_190 = s_187 + (s_163 / s_179 - s_162 / s_179) - rho * s_3 * s_159
            - (s_161 / A - s_14 / s_179);
        let s_191 = s_190 - (s_66 * s_189 + s_115 * s_183 - s_169 * s_186);
        let s_192 = s_119 * s_191;
        let s_193 = s_6 * s_127;
        let s_194 = T::number(4.0) * E * I;
        let s_195 = s_57 / s_56;
        let s_196 = s_95 * l;
        let mut s_197 = [T::number(0.0); 2];
        for i in 0..2 {
            s_197[i] = s_91[i] - s_98[i];
        }
        let mut s_198 = [T::number(0.0); 2];
        for i in 0..2 {
            s_198[i] = s_196 * T::number(INTEGRAL_S1_PHI[i]) + s_197[i];
        }
        let mut s_199 = [T::number(0.0); 2];
        for i in 0..2 {
            s_199[i] = T::number(INTEGRAL_PHI_D2_SQUARED[i]) * s_198[i]
                / T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let s_200 = T::number(4.0) * M_t;
        let s_201 = s_200 * E * I;
        let s_202 = s_62 * s_23;
        let s_203 = s_16 / s_7;
        let s_204 = sum_of_few(
            [(); 2],
            |i| T::number(PHI_AT_END[i]) * s_197[i] / T::number(INTEGRAL_PHI_SQUARED[i]),
        );
        let s_205 = s_15 + (s_204 / s_13 - s_203);
        let s_206 = s_46 * s_67;
        let s_207 = s_125 * s_137;
        let s_208 = s_27 / s_7;
        let s_209 = sum_of_few(
            [(); 2],
            |i| {
                T::number(PHI_D1_AT_END[i]) * s_197[i]
                    / T::number(INTEGRAL_PHI_SQUARED[i])
            },
        );
        let s_210 = s_209 / s_13 - s_208;
        let s_211 = s_39 / s_7;
        let s_212 = s_37 * s_23;
        let s_213 = s_46 * s_3;
        let s_214 = s_212 * s_205 / s_13 + s_148 / s_213 - s_211 - s_24 - s_210;
        let s_215 = T::number(3.0) * J_t * s_42;
        let s_216 = s_46 * s_127;
        let s_217 = s_200 * J_t * s_49 * s_23;
        let s_218 = -(s_215 / s_56) - (s_156 / (s_207 * s_67) - s_217 / s_216);
        let s_219 = T::number(2.0) * l * M_t;
        let s_220 = sum_of_few(
            [(); 2],
            |i| {
                T::number(INTEGRAL_S1_PHI[i]) * s_198[i]
                    / T::number(INTEGRAL_PHI_SQUARED[i])
            },
        );
        let s_221 = sum_of_few(
            [(); 2],
            |i| {
                M_theta_q[i] * s_197[i] / T::number(INTEGRAL_PHI_SQUARED[i])
                    + s_11[i] * s_198[i] / T::number(INTEGRAL_PHI_SQUARED[i])
            },
        );
        let s_222 = s_134 * s_17 * s_23;
        let s_223 = T::number(2.0) * J_t * s_29 / s_3;
        let s_224 = T::number(3.0) * M_t * J_t * s_32 * s_17 * s_23 / s_56;
        let s_225 = s_33 * s_23;
        let s_226 = J_t * (s_24 + s_210) / s_2 - s_223
            - (s_225 * s_205 / s_30 + s_167 / s_216 - s_224);
        let s_227 = s_219 + s_7 + (s_222 * s_205 + s_163 / s_7) - (s_12 + l * s_220)
            - (s_221 / s_13 - s_14 / s_7);
        let s_228 = s_227 - (s_66 * s_226 + s_115 * s_214 - s_169 * s_218);
        let s_229 = s_119 * s_228;
        let s_230 = M_t * I;
        let s_231 = s_62 * s_20;
        let s_232 = s_32 * s_17 * s_23 / s_13;
        let s_233 = s_21 * s_32;
        let s_234 = s_46 * s_2;
        let s_235 = s_232 + s_233 * s_23 / (s_46 * l) - s_233 * s_17 * s_131 / s_234
            - s_32 / s_6;
        let s_236 = J_t * s_49 * s_23;
        let s_237 = s_31 * s_20;
        let s_238 = s_236 / s_48 - s_237 * s_49 * s_131 / (s_207 * s_127);
        let mut s_239 = [T::number(0.0); 2];
        for i in 0..2 {
            s_239[i] = l * T::number(PHI_AT_END[i]);
        }
        let s_240 = sum_of_few(
            [(); 2],
            |i| {
                s_239[i] * M_theta_q[i] / T::number(INTEGRAL_PHI_SQUARED[i])
                    + s_239[i] * s_11[i] / T::number(INTEGRAL_PHI_SQUARED[i])
            },
        );
        let s_241 = s_18 * s_23;
        let s_242 = s_241 + s_134 * s_20 * s_17 * s_23 / s_6
            - s_21 * s_18 * s_131 / s_13;
        let s_243 = J_t * s_32;
        let s_244 = s_243 * s_17 * s_23 / s_30;
        let s_245 = s_237 * s_32;
        let s_246 = s_243 / s_7
            - (s_244 + s_245 * s_23 / s_213 - s_245 * s_17 * s_131 / s_48);
        let s_247 = s_2 + s_242 - s_2 * s_15 - s_240 / s_13
            - (s_66 * s_246 + s_115 * s_235 + s_169 * s_238);
        let s_248 = s_119 * s_247;
        let s_249 = s_62 * s_32 * s_23;
        let s_250 = M_t * s_49 * s_23;
        let s_251 = s_250 / s_213 - s_42 / s_7;
        let s_252 = s_42 / s_30 - s_250 / s_48;
        let mut s_253 = [T::number(0.0); 2];
        for i in 0..2 {
            s_253[i] = l * T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let s_254 = sum_of_few(
            [(); 2],
            |i| {
                T::number(PHI_D1_AT_END[i]) * M_theta_q[i] / s_253[i]
                    + s_26[i] / s_253[i]
            },
        );
        let s_255 = s_29 / s_2;
        let s_256 = s_39 / s_30;
        let s_257 = s_43 / s_56 + s_255 - (s_51 / s_216 + s_256);
        let s_258 = T::number(1.0) + s_134 * s_32 * s_17 * s_23 / s_7 - s_24
            - s_254 / s_13 - (s_66 * s_257 + s_115 * s_251 - s_169 * s_252);
        let s_259 = s_119 * s_258;
        let s_260 = s_84 * s_119;
        let s_261 = s_115 * s_119;
        let mut s_262 = [T::number(0.0); 2];
        for i in 0..2 {
            s_262[i] = s_261 * T::number(PHI_D1_AT_END[i]) / s_79[i];
        }
        let mut s_263 = [T::number(0.0); 2];
        for i in 0..2 {
            s_263[i] = s_119 * s_88[i];
        }
        let mut s_264 = [T::number(0.0); 2];
        for i in 0..2 {
            s_264[i] = s_59[i] / (s_121 * T::number(INTEGRAL_PHI_SQUARED[i]));
        }
        let mut s_265 = [T::number(0.0); 2];
        for i in 0..2 {
            s_265[i] = s_142 * T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let mut s_266 = [T::number(0.0); 2];
        for i in 0..2 {
            s_266[i] = s_80[i] / s_265[i];
        }
        let s_267 = s_21 * s_131;
        let mut s_268 = [T::number(0.0); 2];
        for i in 0..2 {
            s_268[i] = s_267 * T::number(PHI_AT_END[i]);
        }
        let mut s_269 = [T::number(0.0); 2];
        for i in 0..2 {
            s_269[i] = s_268[i] / (s_145 * T::number(INTEGRAL_PHI_SQUARED[i]));
        }
        let s_270 = s_37 * s_150;
        let s_271 = s_36 * s_119;
        let s_272 = M_t * s_16 * s_55;
        let mut s_273 = [T::number(0.0); 2];
        for i in 0..2 {
            s_273[i] = s_86[i] / s_265[i];
        }
        let s_274 = s_150 * s_157;
        let mut s_275 = [T::number(0.0); 2];
        for i in 0..2 {
            s_275[i] = s_274 * T::number(PHI_D1_AT_END[i]) / s_79[i];
        }
        let mut s_276 = [T::number(0.0); 2];
        for i in 0..2 {
            s_276[i] = s_55 * s_11[i];
        }
        let mut s_277 = [T::number(0.0); 2];
        for i in 0..2 {
            s_277[i] = s_276[i] / s_265[i];
        }
        let mut s_278 = [T::number(0.0); 2];
        for i in 0..2 {
            s_278[i] = s_172 * s_88[i];
        }
        let mut s_279 = [T::number(0.0); 2];
        for i in 0..2 {
            s_279[i] = s_59[i] / (s_174 * T::number(INTEGRAL_PHI_SQUARED[i]));
        }
        let mut s_280 = [T::number(0.0); 2];
        for i in 0..2 {
            s_280[i] = s_179 * T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let mut s_281 = [T::number(0.0); 2];
        for i in 0..2 {
            s_281[i] = s_80[i] / s_280[i];
        }
        let mut s_282 = [T::number(0.0); 2];
        for i in 0..2 {
            s_282[i] = s_268[i] / (s_182 * T::number(INTEGRAL_PHI_SQUARED[i]));
        }
        let mut s_283 = [T::number(0.0); 2];
        for i in 0..2 {
            s_283[i] = s_86[i] / s_280[i];
        }
        let s_284 = s_150 * s_186;
        let mut s_285 = [T::number(0.0); 2];
        for i in 0..2 {
            s_285[i] = s_284 * T::number(PHI_D1_AT_END[i]) / s_79[i];
        }
        let mut s_286 = [T::number(0.0); 2];
        for i in 0..2 {
            s_286[i] = s_276[i] / s_280[i];
        }
        let mut s_287 = [T::number(0.0); 2];
        for i in 0..2 {
            s_287[i] = s_192 * s_88[i];
        }
        let mut s_288 = [T::number(0.0); 2];
        for i in 0..2 {
            s_288[i] = s_194 * T::number(INTEGRAL_PHI_D2_SQUARED[i])
                / (s_193 * T::number(INTEGRAL_PHI_SQUARED[i]));
        }
        let mut s_289 = [T::number(0.0); 2];
        for i in 0..2 {
            s_289[i] = s_7 * T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let mut s_290 = [T::number(0.0); 2];
        for i in 0..2 {
            s_290[i] = s_80[i] / s_289[i];
        }
        let mut s_291 = [T::number(0.0); 2];
        for i in 0..2 {
            s_291[i] = s_268[i] / (s_213 * T::number(INTEGRAL_PHI_SQUARED[i]));
        }
        let mut s_292 = [T::number(0.0); 2];
        for i in 0..2 {
            s_292[i] = s_86[i] / s_289[i];
        }
        let s_293 = s_150 * s_218;
        let mut s_294 = [T::number(0.0); 2];
        for i in 0..2 {
            s_294[i] = s_293 * T::number(PHI_D1_AT_END[i]) / s_79[i];
        }
        let mut s_295 = [T::number(0.0); 2];
        for i in 0..2 {
            s_295[i] = T::number(INTEGRAL_S1_PHI[i])
                / T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let mut s_296 = [T::number(0.0); 2];
        for i in 0..2 {
            s_296[i] = s_55 * (s_295[i] + (s_197[i] / s_79[i] - s_11[i] / s_289[i]));
        }
        let mut s_297 = [T::number(0.0); 2];
        for i in 0..2 {
            s_297[i] = s_229 * s_88[i];
        }
        let mut s_298 = [T::number(0.0); 2];
        for i in 0..2 {
            s_298[i] = -(I * T::number(INTEGRAL_PHI_D2_SQUARED[i]) / s_58[i]);
        }
        let mut s_299 = [T::number(0.0); 2];
        for i in 0..2 {
            s_299[i] = -(E * T::number(INTEGRAL_PHI_D2_SQUARED[i]) / s_58[i]);
        }
        let s_300 = s_20 * s_131;
        let mut s_301 = [T::number(0.0); 2];
        for i in 0..2 {
            s_301[i] = s_300 * T::number(PHI_AT_END[i])
                / (s_234 * T::number(INTEGRAL_PHI_SQUARED[i]));
        }
        let s_302 = s_150 * s_238;
        let mut s_303 = [T::number(0.0); 2];
        for i in 0..2 {
            s_303[i] = s_302 * T::number(PHI_D1_AT_END[i]) / s_79[i];
        }
        let mut s_304 = [T::number(0.0); 2];
        for i in 0..2 {
            s_304[i] = s_55 * T::number(PHI_AT_END[i])
                / (s_6 * T::number(INTEGRAL_PHI_SQUARED[i]));
        }
        let mut s_305 = [T::number(0.0); 2];
        for i in 0..2 {
            s_305[i] = s_248 * s_88[i];
        }
        let s_306 = s_150 * s_252;
        let mut s_307 = [T::number(0.0); 2];
        for i in 0..2 {
            s_307[i] = s_306 * T::number(PHI_D1_AT_END[i]) / s_79[i];
        }
        let mut s_308 = [T::number(0.0); 2];
        for i in 0..2 {
            s_308[i] = s_55 * T::number(PHI_D1_AT_END[i]) / s_289[i];
        }
        let mut s_309 = [T::number(0.0); 2];
        for i in 0..2 {
            s_309[i] = s_259 * s_88[i];
        }
        let mut s_310 = [T::number(0.0); 2];
        for i in 0..2 {
            s_310[i] = s_96 * T::number(INTEGRAL_S1_PHI[i]);
        }
        let mut s_311 = [T::number(0.0); 2];
        for i in 0..2 {
            s_311[i] = s_196 * T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let s_312 = s_84 * s_23;
        let mut s_313 = [T::number(0.0); 2];
        for i in 0..2 {
            s_313[i] = T::number(PHI_AT_END[i]) / T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let mut s_314 = [T::number(0.0); 2];
        for i in 0..2 {
            s_314[i] = T::number(PHI_D1_AT_END[i]) / T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let s_315 = s_212 * s_53;
        let s_316 = s_154 * s_150;
        let s_317 = s_14 * s_119;
        let s_318 = s_43 * s_150;
        let mut s_319 = [T::number(0.0); 2];
        for i in 0..2 {
            s_319[i] = s_11[i] / T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let mut s_320 = [T::number(0.0); 2];
        for i in 0..2 {
            s_320[i] = T::number(INTEGRAL_PHI_D2_SQUARED[i])
                / T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let mut s_321 = [T::number(0.0); 2];
        for i in 0..2 {
            s_321[i] = s_119 * s_11[i] / s_79[i];
        }
        let s_322 = l * s_119;
        let mut s_323 = [T::number(0.0); 2];
        for i in 0..2 {
            s_323[i] = s_322 * T::number(INTEGRAL_S1_PHI[i])
                / T::number(INTEGRAL_PHI_SQUARED[i]);
        }
        let mut s_324 = [T::number(0.0); 2];
        for i in 0..2 {
            s_324[i] = s_119 * M_theta_q[i] / s_79[i];
        }
        let mut s_325 = [T::number(0.0); 2];
        for i in 0..2 {
            s_325[i] = T::number(PHI_D1_AT_END[i]) / s_79[i];
        }
        let mut s_326 = [T::number(0.0); 2];
        for i in 0..2 {
            s_326[i] = T::number(PHI_AT_END[i]) / s_79[i];
        }
        let mut s_327 = [T::number(0.0); 2];
        for i in 0..2 {
            s_327[i] = s_55 / s_79[i];
        }
        let mut positive_4 = true;
        for i in 0..2 {
            positive_4 = positive_4 && T::all_greater(s_79[i], T::number(0.0))
                && T::all_greater(T::number(f64::INFINITY), s_79[i]);
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
            c_7: s_15,
            c_8: s_24,
            c_9: s_36,
            c_10: s_40,
            c_11: s_53,
            c_12: s_55,
            c: c,
            c_13: s_60,
            c_14: s_64 / s_56,
            c_15: s_65,
            c_16: s_66,
            c_17: s_71,
            c_18: s_77 / s_73,
            c_19: s_78,
            c_20: s_79,
            c_21: s_81,
            c_22: s_82 / s_13,
            c_23: s_83,
            c_24: s_85,
            c_25: -(s_62 / s_56),
            c_26: s_87,
            c_27: s_88,
            c_28: s_89,
            c_29: s_90,
            M_theta_theta: M_theta_theta,
            c_30: s_91,
            c_31: s_92,
            c_32: s_93,
            c_33: T::number(1.0) / l,
            c_34: T::number(0.5) * J_h,
            c_35: s_96,
            c_36: T::number(0.5) * M_t,
            c_37: T::number(0.5) * J_t,
            c_38: s_97 * I / s_3,
            c_39: s_98,
            c_40: s_100,
            c_41: s_101,
            c_42: -s_102,
            c_43: s_103,
            c_44: s_104,
            c_45: s_105,
            c_46: s_106,
            c_47: s_107,
            c_48: s_111,
            c_49: s_113,
            c_50: s_117,
            c_51: s_118,
            c_52: s_119,
            c_53: -s_119,
            c_54: s_57 / s_121,
            c_55: s_122,
            c_56: s_123,
            c_57: s_57 / s_123,
            c_58: s_124,
            c_59: s_64 / s_121,
            c_60: s_129 / s_128,
            c_61: s_132 / s_128,
            c_62: s_70 / (s_120 * s_67),
            c_63: s_133,
            c_64: s_136 / (s_126 * s_72),
            c_65: s_141 / (s_138 * s_139),
            c_66: s_143,
            c_67: s_144,
            c_68: s_53 * s_149,
            c_69: s_151 * s_157,
            c_70: s_158,
            c_71: s_165,
            c_72: s_172,
            c_73: s_57 / s_174,
            c_74: s_175,
            c_75: s_57 / s_175,
            c_76: s_64 / s_174,
            c_77: s_129 / s_177,
            c_78: s_132 / s_177,
            c_79: s_70 / (s_173 * s_67),
            c_80: s_136 / (s_176 * s_72),
            c_81: s_141 / (s_178 * s_139),
            c_82: s_180,
            c_83: s_181,
            c_84: s_53 * s_183,
            c_85: s_151 * s_186,
            c_86: s_187,
            c_87: s_188,
            c_88: s_192,
            c_89: s_194 / s_193,
            c_90: s_195,
            c_91: s_196,
            c_92: s_199,
            c_93: s_201 * s_17 * s_23 / s_193,
            c_94: s_203,
            c_95: s_202 * s_205 / s_56,
            c_96: s_132 / s_206,
            c_97: T::number(6.0) * J_t * E * I / (s_6 * s_72),
            c_98: T::number(7.0) * M_t * J_t * E * I * s_32 * s_23 / (s_46 * s_139),
            c_99: s_141 / (s_207 * (l * s_139)),
            c_100: s_208,
            c_101: s_211,
            c_102: s_53 * s_214,
            c_103: s_151 * s_218,
            c_104: s_223,
            c_105: s_224,
            c_106: s_229,
            c_107: I / s_56,
            c_108: s_230 * s_17 * s_23 / s_56,
            c_109: J_t * I / s_68,
            c_110: s_31 * I * s_32 * s_23 / s_73,
            c_111: E / s_56,
            c_112: s_61 * s_17 * s_23 / s_56,
            c_113: s_69 / s_68,
            c_114: s_74 * s_32 * s_23 / s_73,
            c_115: s_57 / s_30,
            c_116: s_57 * s_17 * s_23 / s_56,
            c_117: s_231 * s_23 / s_48,
            c_118: s_231 * s_17 * s_131 / s_216,
            c_119: s_70 * s_32 * s_23 / s_73,
            c_120: s_75 * s_20 * s_32 * s_131 / (s_207 * s_139),
            c_121: s_232,
            c_122: s_53 * s_235,
            c_123: s_151 * s_238,
            c_124: s_244,
            c_125: s_248,
            c_126: s_57 / s_193,
            c_127: s_249 / s_206,
            c_128: s_57 / s_68,
            c_129: s_249 / s_73,
            c_130: s_53 * s_251,
            c_131: s_151 * s_252,
            c_132: s_255,
            c_133: s_256,
            c_134: s_259,
            c_135: -s_55,
            c_136: s_112 * s_119 / s_13,
            c_137: s_260,
            c_138: s_261,
            c_139: s_262,
            c_140: s_263,
            c_141: s_264,
            c_142: s_266,
            c_143: s_269,
            c_144: s_62 / s_121,
            c_145: s_82 / s_142,
            c_146: s_270 * s_157 / s_13,
            c_147: s_55 * s_168,
            c_148: s_271 * s_171,
            c_149: s_272 / s_142,
            c_150: s_260 * s_171,
            c_151: s_273,
            c_152: s_275,
            c_153: s_277,
            c_154: s_278,
            c_155: s_279,
            c_156: s_281,
            c_157: s_282,
            c_158: s_62 / s_174,
            c_159: s_82 / s_179,
            c_160: s_270 * s_186 / s_13,
            c_161: s_55 * s_189,
            c_162: s_271 * s_191,
            c_163: s_272 / s_179,
            c_164: s_260 * s_191,
            c_165: s_283,
            c_166: s_285,
            c_167: s_286,
            c_168: s_287,
            c_169: s_288,
            c_170: s_290,
            c_171: s_291,
            c_172: s_201 / s_193,
            c_173: s_82 / s_7,
            c_174: s_270 * s_218 / s_13,
            c_175: s_55 * s_226,
            c_176: s_271 * s_228,
            c_177: M_t * s_55 * s_205,
            c_178: s_260 * s_228,
            c_179: s_292,
            c_180: s_294,
            c_181: s_295,
            c_182: s_296,
            c_183: s_297,
            c_184: -(s_230 / s_56),
            c_185: s_298,
            c_186: -(s_61 / s_56),
            c_187: s_299,
            c_188: s_301,
            c_189: s_32 * s_53 / s_13,
            c_190: s_270 * s_238 / s_13,
            c_191: s_55 * s_246,
            c_192: s_271 * s_247,
            c_193: s_17 * s_55,
            c_194: s_21 * s_55 / s_6,
            c_195: s_260 * s_247,
            c_196: -s_195,
            c_197: s_303,
            c_198: s_304,
            c_199: s_305,
            c_200: s_270 * s_252 / s_13,
            c_201: s_55 * s_257,
            c_202: s_271 * s_258,
            c_203: s_37 * s_55 / s_7,
            c_204: s_260 * s_258,
            c_205: s_307,
            c_206: s_308,
            c_207: s_309,
            c_208: T::number(0.6666666666666666) * rho * A * s_3,
            c_209: s_310,
            c_210: s_311,
            c_211: -(T::number(1.0) / s_2),
            c_212: T::number(2.0) * A * s_2,
            c_213: A * l,
            c_214: s_94 * s_2,
            c_215: rho * l,
            c_216: T::number(4.0) * rho * A * l,
            c_217: J_t / s_2,
            c_218: T::number(1.5) * E * I / s_47,
            c_219: T::number(0.5) * I / s_3,
            c_220: s_97 / s_3,
            c_221: s_70 / s_68,
            c_222: s_312 * s_55 / s_13,
            c_223: s_313,
            c_224: s_53 / s_13,
            c_225: s_314,
            c_226: s_315 / s_234,
            c_227: -c,
            c_228: s_202 / s_216,
            c_229: s_312 / s_13,
            c_230: s_53 / s_142,
            c_231: s_23 / s_142,
            c_232: s_315 / s_145,
            c_233: s_66 * s_119,
            c_234: s_316 / s_153,
            c_235: T::number(1.0) / s_13,
            c_236: s_212 / s_234,
            c_237: s_41 * s_119,
            c_238: s_317 / s_142,
            c_239: s_318 / s_152,
            c_240: s_202 / s_128,
            c_241: s_267 / s_142,
            c_242: s_63 / s_56,
            c_243: s_19 * s_119,
            c_244: s_38 / s_13,
            c_245: s_76 / s_73,
            c_246: s_34 / s_30,
            c_247: s_50 * s_150 / s_48,
            c_248: s_16 / s_142,
            c_249: M_t * s_23 * s_55 / s_13,
            c_250: s_202 / s_56,
            c_251: s_222 * s_119,
            c_252: s_212 / s_13,
            c_253: s_225 / s_30,
            c_254: s_55 / s_142,
            c_255: s_319,
            c_256: s_320,
            c_257: s_321,
            c_258: s_323,
            c_259: s_158 * s_119,
            c_260: s_53 / s_179,
            c_261: s_23 / s_179,
            c_262: s_315 / s_182,
            c_263: s_316 / s_185,
            c_264: s_317 / s_179,
            c_265: s_318 / s_184,
            c_266: s_202 / s_177,
            c_267: s_267 / s_179,
            c_268: s_16 / s_179,
            c_269: s_55 / s_179,
            c_270: s_187 * s_119,
            c_271: s_53 / s_7,
            c_272: s_23 / s_7,
            c_273: s_315 / s_213,
            c_274: s_217 * s_150 / s_216,
            c_275: s_317 / s_7,
            c_276: s_12 * s_119,
            c_277: s_215 * s_150 / s_56,
            c_278: s_201 * s_23 / s_206,
            c_279: s_267 / s_7,
            c_280: s_55 / s_7,
            c_281: s_324,
            c_282: s_325,
            c_283: s_326,
            c_284: s_327,
            c_285: s_219 * s_119,
            c_286: s_7 * s_119,
            c_287: s_230 * s_23 / s_216,
            c_288: s_61 * s_23 / s_216,
            c_289: s_17 * s_23 * s_55 / s_13,
            c_290: s_32 * s_23 * s_53 / s_234,
            c_291: s_241 * s_119,
            c_292: s_236 * s_150 / s_48,
            c_293: s_57 * s_23 / s_216,
            c_294: s_300 / s_13,
            c_295: s_2 * s_119,
            c_296: s_250 * s_150 / s_48,
            c_297: s_42 * s_150 / s_30,
            positive_definite: T::all_greater(pivot_theta, T::number(0.0))
                && T::all_greater(T::number(f64::INFINITY), pivot_theta)
                && T::all_greater(s_22, T::number(0.0))
                && T::all_greater(T::number(f64::INFINITY), s_22)
                && T::all_greater(s_52, T::number(0.0))
                && T::all_greater(T::number(f64::INFINITY), s_52) && positive_4,
        }
    }
}
impl Coefficients {
    /// Converts these coefficients to another number type, without derivatives.
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
            c_8: T::number(self.c_8),
            c_9: T::number(self.c_9),
            c_10: T::number(self.c_10),
            c_11: T::number(self.c_11),
            c_12: T::number(self.c_12),
            c: T::number(self.c),
            c_13: converted(&self.c_13),
            c_14: T::number(self.c_14),
            c_15: converted(&self.c_15),
            c_16: T::number(self.c_16),
            c_17: converted(&self.c_17),
            c_18: T::number(self.c_18),
            c_19: converted(&self.c_19),
            c_20: converted(&self.c_20),
            c_21: converted(&self.c_21),
            c_22: T::number(self.c_22),
            c_23: T::number(self.c_23),
            c_24: T::number(self.c_24),
            c_25: T::number(self.c_25),
            c_26: converted(&self.c_26),
            c_27: converted(&self.c_27),
            c_28: converted(&self.c_28),
            c_29: converted(&self.c_29),
            M_theta_theta: T::number(self.M_theta_theta),
            c_30: converted(&self.c_30),
            c_31: converted(&self.c_31),
            c_32: converted(&self.c_32),
            c_33: T::number(self.c_33),
            c_34: T::number(self.c_34),
            c_35: T::number(self.c_35),
            c_36: T::number(self.c_36),
            c_37: T::number(self.c_37),
            c_38: T::number(self.c_38),
            c_39: converted(&self.c_39),
            c_40: converted(&self.c_40),
            c_41: converted(&self.c_41),
            c_42: T::number(self.c_42),
            c_43: converted(&self.c_43),
            c_44: converted(&self.c_44),
            c_45: converted(&self.c_45),
            c_46: converted(&self.c_46),
            c_47: converted(&self.c_47),
            c_48: converted(&self.c_48),
            c_49: T::number(self.c_49),
            c_50: converted(&self.c_50),
            c_51: converted(&self.c_51),
            c_52: T::number(self.c_52),
            c_53: T::number(self.c_53),
            c_54: T::number(self.c_54),
            c_55: converted(&self.c_55),
            c_56: T::number(self.c_56),
            c_57: T::number(self.c_57),
            c_58: converted(&self.c_58),
            c_59: T::number(self.c_59),
            c_60: T::number(self.c_60),
            c_61: T::number(self.c_61),
            c_62: T::number(self.c_62),
            c_63: converted(&self.c_63),
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
            c_78: T::number(self.c_78),
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
            c_92: converted(&self.c_92),
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
            c_115: T::number(self.c_115),
            c_116: T::number(self.c_116),
            c_117: T::number(self.c_117),
            c_118: T::number(self.c_118),
            c_119: T::number(self.c_119),
            c_120: T::number(self.c_120),
            c_121: T::number(self.c_121),
            c_122: T::number(self.c_122),
            c_123: T::number(self.c_123),
            c_124: T::number(self.c_124),
            c_125: T::number(self.c_125),
            c_126: T::number(self.c_126),
            c_127: T::number(self.c_127),
            c_128: T::number(self.c_128),
            c_129: T::number(self.c_129),
            c_130: T::number(self.c_130),
            c_131: T::number(self.c_131),
            c_132: T::number(self.c_132),
            c_133: T::number(self.c_133),
            c_134: T::number(self.c_134),
            c_135: T::number(self.c_135),
            c_136: T::number(self.c_136),
            c_137: T::number(self.c_137),
            c_138: T::number(self.c_138),
            c_139: converted(&self.c_139),
            c_140: converted(&self.c_140),
            c_141: converted(&self.c_141),
            c_142: converted(&self.c_142),
            c_143: converted(&self.c_143),
            c_144: T::number(self.c_144),
            c_145: T::number(self.c_145),
            c_146: T::number(self.c_146),
            c_147: T::number(self.c_147),
            c_148: T::number(self.c_148),
            c_149: T::number(self.c_149),
            c_150: T::number(self.c_150),
            c_151: converted(&self.c_151),
            c_152: converted(&self.c_152),
            c_153: converted(&self.c_153),
            c_154: converted(&self.c_154),
            c_155: converted(&self.c_155),
            c_156: converted(&self.c_156),
            c_157: converted(&self.c_157),
            c_158: T::number(self.c_158),
            c_159: T::number(self.c_159),
            c_160: T::number(self.c_160),
            c_161: T::number(self.c_161),
            c_162: T::number(self.c_162),
            c_163: T::number(self.c_163),
            c_164: T::number(self.c_164),
            c_165: converted(&self.c_165),
            c_166: converted(&self.c_166),
            c_167: converted(&self.c_167),
            c_168: converted(&self.c_168),
            c_169: converted(&self.c_169),
            c_170: converted(&self.c_170),
            c_171: converted(&self.c_171),
            c_172: T::number(self.c_172),
            c_173: T::number(self.c_173),
            c_174: T::number(self.c_174),
            c_175: T::number(self.c_175),
            c_176: T::number(self.c_176),
            c_177: T::number(self.c_177),
            c_178: T::number(self.c_178),
            c_179: converted(&self.c_179),
            c_180: converted(&self.c_180),
            c_181: converted(&self.c_181),
            c_182: converted(&self.c_182),
            c_183: converted(&self.c_183),
            c_184: T::number(self.c_184),
            c_185: converted(&self.c_185),
            c_186: T::number(self.c_186),
            c_187: converted(&self.c_187),
            c_188: converted(&self.c_188),
            c_189: T::number(self.c_189),
            c_190: T::number(self.c_190),
            c_191: T::number(self.c_191),
            c_192: T::number(self.c_192),
            c_193: T::number(self.c_193),
            c_194: T::number(self.c_194),
            c_195: T::number(self.c_195),
            c_196: T::number(self.c_196),
            c_197: converted(&self.c_197),
            c_198: converted(&self.c_198),
            c_199: converted(&self.c_199),
            c_200: T::number(self.c_200),
            c_201: T::number(self.c_201),
            c_202: T::number(self.c_202),
            c_203: T::number(self.c_203),
            c_204: T::number(self.c_204),
            c_205: converted(&self.c_205),
            c_206: converted(&self.c_206),
            c_207: converted(&self.c_207),
            c_208: T::number(self.c_208),
            c_209: converted(&self.c_209),
            c_210: converted(&self.c_210),
            c_211: T::number(self.c_211),
            c_212: T::number(self.c_212),
            c_213: T::number(self.c_213),
            c_214: T::number(self.c_214),
            c_215: T::number(self.c_215),
            c_216: T::number(self.c_216),
            c_217: T::number(self.c_217),
            c_218: T::number(self.c_218),
            c_219: T::number(self.c_219),
            c_220: T::number(self.c_220),
            c_221: T::number(self.c_221),
            c_222: T::number(self.c_222),
            c_223: converted(&self.c_223),
            c_224: T::number(self.c_224),
            c_225: converted(&self.c_225),
            c_226: T::number(self.c_226),
            c_227: T::number(self.c_227),
            c_228: T::number(self.c_228),
            c_229: T::number(self.c_229),
            c_230: T::number(self.c_230),
            c_231: T::number(self.c_231),
            c_232: T::number(self.c_232),
            c_233: T::number(self.c_233),
            c_234: T::number(self.c_234),
            c_235: T::number(self.c_235),
            c_236: T::number(self.c_236),
            c_237: T::number(self.c_237),
            c_238: T::number(self.c_238),
            c_239: T::number(self.c_239),
            c_240: T::number(self.c_240),
            c_241: T::number(self.c_241),
            c_242: T::number(self.c_242),
            c_243: T::number(self.c_243),
            c_244: T::number(self.c_244),
            c_245: T::number(self.c_245),
            c_246: T::number(self.c_246),
            c_247: T::number(self.c_247),
            c_248: T::number(self.c_248),
            c_249: T::number(self.c_249),
            c_250: T::number(self.c_250),
            c_251: T::number(self.c_251),
            c_252: T::number(self.c_252),
            c_253: T::number(self.c_253),
            c_254: T::number(self.c_254),
            c_255: converted(&self.c_255),
            c_256: converted(&self.c_256),
            c_257: converted(&self.c_257),
            c_258: converted(&self.c_258),
            c_259: T::number(self.c_259),
            c_260: T::number(self.c_260),
            c_261: T::number(self.c_261),
            c_262: T::number(self.c_262),
            c_263: T::number(self.c_263),
            c_264: T::number(self.c_264),
            c_265: T::number(self.c_265),
            c_266: T::number(self.c_266),
            c_267: T::number(self.c_267),
            c_268: T::number(self.c_268),
            c_269: T::number(self.c_269),
            c_270: T::number(self.c_270),
            c_271: T::number(self.c_271),
            c_272: T::number(self.c_272),
            c_273: T::number(self.c_273),
            c_274: T::number(self.c_274),
            c_275: T::number(self.c_275),
            c_276: T::number(self.c_276),
            c_277: T::number(self.c_277),
            c_278: T::number(self.c_278),
            c_279: T::number(self.c_279),
            c_280: T::number(self.c_280),
            c_281: converted(&self.c_281),
            c_282: converted(&self.c_282),
            c_283: converted(&self.c_283),
            c_284: converted(&self.c_284),
            c_285: T::number(self.c_285),
            c_286: T::number(self.c_286),
            c_287: T::number(self.c_287),
            c_288: T::number(self.c_288),
            c_289: T::number(self.c_289),
            c_290: T::number(self.c_290),
            c_291: T::number(self.c_291),
            c_292: T::number(self.c_292),
            c_293: T::number(self.c_293),
            c_294: T::number(self.c_294),
            c_295: T::number(self.c_295),
            c_296: T::number(self.c_296),
            c_297: T::number(self.c_297),
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

/// [`rates_into`], inlined into the calling function and compiled for its registers.
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
    let s_1 = sum_of_few([(); 2], |i| C::read(coefficients.c_13[i]) * state[1 + i]);
    let s_2 = sum_of_few([(); 2], |i| C::read(coefficients.c_15[i]) * state[1 + i]);
    let s_3 = sum_of_few([(); 2], |i| C::read(coefficients.c_17[i]) * state[1 + i]);
    let s_4 = C::read(coefficients.c_18) * s_2 - s_3;
    let s_5 = u + s_1 - C::read(coefficients.c) * theta_dot
        - C::read(coefficients.c_14) * s_2 - C::read(coefficients.c_16) * s_4;
    let theta_ddot = C::read(coefficients.c_12) * s_5;
    let s_6 = s_4 - C::read(coefficients.c_23) * s_5;
    let s_7 = C::read(coefficients.c_25) * s_2 - C::read(coefficients.c_22) * s_6
        - C::read(coefficients.c_24) * s_5;
    let mut q_ddot = [T::number(0.0); 2];
    for i in 0..2 {
        q_ddot[i] = C::read(coefficients.c_29[i]) * state[1 + i]
            - C::read(coefficients.c_21[i]) * s_7 - C::read(coefficients.c_26[i]) * s_6
            - C::read(coefficients.c_28[i]) * s_5;
    }
    for i in 0..3 {
        rates[i] = state[3 + i];
    }
    rates[3] = theta_ddot;
    for i in 0..2 {
        rates[4 + i] = q_ddot[i];
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
    inlined_rates(t, state, inputs, coefficients)
}

/// [`rates`], inlined into the calling function and compiled for its registers.
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
    inlined_observables(t, state, inputs, coefficients)
}

/// [`observables`], inlined into the calling function and compiled for its registers.
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
    let tip_slope = C::read(coefficients.c_33) * s_1;
    let s_2 = theta_dot * theta_dot;
    let s_3 = sum_of_few([(); 2], |i| T::number(INTEGRAL_S1_PHI[i]) * state[4 + i]);
    let s_4 = sum_of_few(
        [(); 2],
        |i| T::number(INTEGRAL_PHI_SQUARED[i]) * (state[4 + i] * state[4 + i]),
    );
    let s_5 = C::read(coefficients.c_1) * s_2
        + C::read(coefficients.c_35) * (theta_dot * s_3)
        + C::read(coefficients.c_6) * s_4;
    let s_6 = sum_of_few([(); 2], |i| T::number(PHI_AT_END[i]) * state[4 + i]);
    let s_7 = C::read(coefficients.l) * theta_dot + s_6;
    let s_8 = sum_of_few([(); 2], |i| T::number(PHI_D1_AT_END[i]) * state[4 + i]);
    let s_9 = theta_dot + C::read(coefficients.c_33) * s_8;
    let T_tip = C::read(coefficients.c_36) * (s_7 * s_7)
        + C::read(coefficients.c_37) * (s_9 * s_9);
    let s_10 = sum_of_few(
        [(); 2],
        |i| T::number(INTEGRAL_PHI_D2_SQUARED[i]) * (state[1 + i] * state[1 + i]),
    );
    let V_bending = C::read(coefficients.c_38) * s_10;
    [
        tip,
        tip_slope,
        C::read(coefficients.c_34) * s_2 + T::number(0.5) * s_5 + T_tip + V_bending,
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

/// [`energy`], inlined into the calling function and compiled for its registers.
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
        + C::read(coefficients.c_35) * (theta_dot * s_2)
        + C::read(coefficients.c_6) * s_3;
    let s_5 = sum_of_few([(); 2], |i| T::number(PHI_AT_END[i]) * state[4 + i]);
    let s_6 = C::read(coefficients.l) * theta_dot + s_5;
    let s_7 = sum_of_few([(); 2], |i| T::number(PHI_D1_AT_END[i]) * state[4 + i]);
    let s_8 = theta_dot + C::read(coefficients.c_33) * s_7;
    let T_tip = C::read(coefficients.c_36) * (s_6 * s_6)
        + C::read(coefficients.c_37) * (s_8 * s_8);
    let s_9 = sum_of_few(
        [(); 2],
        |i| T::number(INTEGRAL_PHI_D2_SQUARED[i]) * (state[1 + i] * state[1 + i]),
    );
    let V_bending = C::read(coefficients.c_38) * s_9;
    C::read(coefficients.c_34) * s_1 + T::number(0.5) * s_4 + T_tip + V_bending
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

/// [`power`], inlined into the calling function and compiled for its registers.
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

/// Switching surfaces: the equations change when one of these changes sign.
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

/// [`guards`], inlined into the calling function and compiled for its registers.
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

/// Mass matrix in the order of the first half of [`STATE_NAMES`].
#[allow(unused_variables, unused_mut)]
pub fn mass_matrix<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> [[T; DEGREES_OF_FREEDOM]; DEGREES_OF_FREEDOM] {
    inlined_mass_matrix(t, state, inputs, coefficients)
}

/// [`mass_matrix`], inlined into the calling function and compiled for its registers.
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
        values[1 + i][1 + i] = values[1 + i][1 + i] + C::read(coefficients.c_20[i]);
        for j in 0..2 {
            values[1 + i][1 + j] = values[1 + i][1 + j]
                + C::read(coefficients.c_30[i]) * T::number(PHI_AT_END[j]);
            values[1 + i][1 + j] = values[1 + i][1 + j]
                + C::read(coefficients.c_5[i]) * C::read(coefficients.c_31[j]);
        }
    }
    values
}

/// Regime of a state: bit k is set if number k of [`guards`] is positive, for up to 32 of
/// them. Crossing a surface flips its bit. SIMD lanes must be in one regime: a bit is set
/// if it is set in all of them.
#[allow(unused_variables)]
pub fn regime<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> u32 {
    inlined_regime(t, state, inputs, coefficients)
}

/// [`regime`], inlined into the calling function and compiled for its registers.
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

/// Rates of the state in a regime, written to `rates`. They equal those of [`rates_into`] if
/// [`regime`] is `REGIME` and half-widths are not negative. Outside the regime its equations
/// are continued; on a surface they are those of the regime's side.
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

/// [`rates_in_regime_into`], inlined into the calling function and compiled for its registers.
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
    let s_1 = sum_of_few([(); 2], |i| C::read(coefficients.c_13[i]) * state[1 + i]);
    let s_2 = sum_of_few([(); 2], |i| C::read(coefficients.c_15[i]) * state[1 + i]);
    let s_3 = sum_of_few([(); 2], |i| C::read(coefficients.c_17[i]) * state[1 + i]);
    let s_4 = C::read(coefficients.c_18) * s_2 - s_3;
    let s_5 = u + s_1 - C::read(coefficients.c) * theta_dot
        - C::read(coefficients.c_14) * s_2 - C::read(coefficients.c_16) * s_4;
    let theta_ddot = C::read(coefficients.c_12) * s_5;
    let s_6 = s_4 - C::read(coefficients.c_23) * s_5;
    let s_7 = C::read(coefficients.c_25) * s_2 - C::read(coefficients.c_22) * s_6
        - C::read(coefficients.c_24) * s_5;
    let mut q_ddot = [T::number(0.0); 2];
    for i in 0..2 {
        q_ddot[i] = C::read(coefficients.c_29[i]) * state[1 + i]
            - C::read(coefficients.c_21[i]) * s_7 - C::read(coefficients.c_26[i]) * s_6
            - C::read(coefficients.c_28[i]) * s_5;
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
/// [`STATE_NAMES`]: the additional forces for zero accelerations.
#[allow(unused_variables, unused_mut)]
pub fn bias_forces<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> [T; DEGREES_OF_FREEDOM] {
    inlined_bias_forces(t, state, inputs, coefficients)
}

/// [`bias_forces`], inlined into the calling function and compiled for its registers.
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
        values[1 + i] = C::read(coefficients.c_32[i]) * state[1 + i];
    }
    values
}

/// Inverse dynamics M a + c - f: the generalised forces needed in addition to
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

/// [`inverse_dynamics`], inlined into the calling function and compiled for its registers.
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
        s_4[i] = C::read(coefficients.c_32[i]) * state[1 + i]
            + C::read(coefficients.M_theta_q[i]) * s
            + C::read(coefficients.c_20[i]) * accelerations[1 + i]
            + C::read(coefficients.c_30[i]) * s_2;
    }
    let mut values = [T::number(0.0); DEGREES_OF_FREEDOM];
    values[0] = C::read(coefficients.M_theta_theta) * s + s_1
        - (u - C::read(coefficients.c) * theta_dot);
    for i in 0..2 {
        values[1 + i] = s_4[i] + C::read(coefficients.c_39[i]) * s_3;
    }
    values
}

/// Rates of the switching surfaces along the motion, with constant inputs.
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

/// [`guard_rates`], inlined into the calling function and compiled for its registers.
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

/// Product of the Jacobian of the rates by state and inputs with a direction: the derivative
/// of the rates along it.
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

/// [`jacobian_vector_product`], inlined into the calling function and compiled for its registers.
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
    let s_2 = sum_of_few([(); 2], |i| C::read(coefficients.c_55[i]) * direction[1 + i]);
    let s_3 = sum_of_few([(); 2], |i| C::read(coefficients.c_15[i]) * direction[1 + i]);
    let s_4 = sum_of_few([(); 2], |i| C::read(coefficients.c_63[i]) * direction[1 + i]);
    let s_5 = C::read(coefficients.c_18) * s_3 - C::read(coefficients.c_221) * s_4;
    let s_6 = s_1 + C::read(coefficients.c_90) * s_2 - C::read(coefficients.c) * s
        - C::read(coefficients.c_14) * s_3;
    let s_7 = s_6 - C::read(coefficients.c_16) * s_5;
    let s_8 = s_5 - C::read(coefficients.c_23) * s_7;
    let s_9 = C::read(coefficients.c_25) * s_3 - C::read(coefficients.c_22) * s_8
        - C::read(coefficients.c_24) * s_7;
    let mut s_10 = [T::number(0.0); 2];
    for i in 0..2 {
        s_10[i] = C::read(coefficients.c_29[i]) * direction[1 + i]
            - C::read(coefficients.c_21[i]) * s_9 - C::read(coefficients.c_26[i]) * s_8
            - C::read(coefficients.c_28[i]) * s_7;
    }
    let mut product = [T::number(0.0); STATES];
    for i in 0..3 {
        product[i] = direction[3 + i];
    }
    product[3] = C::read(coefficients.c_12) * s_7;
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

/// [`vector_jacobian_product`], inlined into the calling function and compiled for its registers.
#[allow(unused_variables)]
#[inline(always)]
pub fn inlined_vector_jacobian_product<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
    weights: &[T; STATES],
) -> ([T; STATES], Inputs<T>) {
    let s_1 = sum_of_few([(); 2], |i| C::read(coefficients.c_27[i]) * weights[4 + i]);
    let s_2 = sum_of_few([(); 2], |i| C::read(coefficients.c_223[i]) * weights[4 + i]);
    let s_3 = sum_of_few([(); 2], |i| C::read(coefficients.c_225[i]) * weights[4 + i]);
    let s_4 = C::read(coefficients.c_226) * s_2 - C::read(coefficients.c_224) * s_3;
    let s = weights[3];
    let s_5 = C::read(coefficients.c_222) * s_2 + C::read(coefficients.c_12) * s
        - C::read(coefficients.c_12) * s_1 - C::read(coefficients.c_23) * s_4;
    let s_6 = s_4 - C::read(coefficients.c_16) * s_5;
    let s_7 = C::read(coefficients.c_18) * s_6 + C::read(coefficients.c_228) * s_2
        - C::read(coefficients.c_14) * s_5;
    let mut s_8 = [T::number(0.0); 2];
    for i in 0..2 {
        s_8[i] = C::read(coefficients.c_13[i]) * s_5
            + C::read(coefficients.c_15[i]) * s_7 - C::read(coefficients.c_17[i]) * s_6
            - C::read(coefficients.c_19[i]) * weights[4 + i];
    }
    let mut product = [T::number(0.0); STATES];
    for i in 0..3 {
        product[3 + i] = weights[i];
    }
    product[3] = product[3] + C::read(coefficients.c_227) * s_5;
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

/// [`vector_jacobian_product_by_parameters`], inlined into the calling function and compiled for its registers.
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
    let s_1 = sum_of_few([(); 2], |i| C::read(coefficients.c_13[i]) * state[1 + i]);
    let s_2 = sum_of_few([(); 2], |i| C::read(coefficients.c_15[i]) * state[1 + i]);
    let s_3 = sum_of_few([(); 2], |i| C::read(coefficients.c_17[i]) * state[1 + i]);
    let s_4 = C::read(coefficients.c_18) * s_2 - s_3;
    let s_5 = u + s_1 - C::read(coefficients.c) * theta_dot
        - C::read(coefficients.c_14) * s_2 - C::read(coefficients.c_16) * s_4;
    let s_6 = s_4 - C::read(coefficients.c_23) * s_5;
    let s_7 = sum_of_few([(); 2], |i| C::read(coefficients.c_55[i]) * state[1 + i]);
    let s_8 = sum_of_few([(); 2], |i| C::read(coefficients.c_63[i]) * state[1 + i]);
    let s_9 = sum_of_few([(); 2], |i| C::read(coefficients.c_27[i]) * weights[4 + i]);
    let s_10 = sum_of_few([(); 2], |i| C::read(coefficients.c_223[i]) * weights[4 + i]);
    let s_11 = sum_of_few([(); 2], |i| C::read(coefficients.c_225[i]) * weights[4 + i]);
    let s_12 = C::read(coefficients.c_226) * s_10 - C::read(coefficients.c_224) * s_11;
    let s = weights[3];
    let s_13 = C::read(coefficients.c_222) * s_10 + C::read(coefficients.c_12) * s
        - C::read(coefficients.c_12) * s_9 - C::read(coefficients.c_23) * s_12;
    let s_14 = s_12 - C::read(coefficients.c_16) * s_13;
    let s_15 = s_5 * s_10;
    let s_16 = s_5 * s_12;
    let s_17 = C::read(coefficients.c_229) * s_15 + s_5 * s - s_5 * s_9
        - C::read(coefficients.c_9) * s_16;
    let s_18 = s_6 * s_11;
    let s_19 = (C::read(coefficients.c_25) * s_2 - C::read(coefficients.c_22) * s_6
        - C::read(coefficients.c_24) * s_5) * s_10;
    let s_20 = s_6 * s_10;
    let s_21 = s_2 * s_13;
    let s_22 = s_4 * s_13;
    let s_23 = C::read(coefficients.c_138) * s_17 - C::read(coefficients.c_11) * s_22;
    let s_24 = s_2 * s_14;
    let s_25 = C::read(coefficients.c_233) * s_17 - C::read(coefficients.c_12) * s_16;
    let s_26 = C::read(coefficients.c_236) * s_20 + C::read(coefficients.c_237) * s_17
        - C::read(coefficients.c_235) * s_18 - C::read(coefficients.c_10) * s_22;
    let s_27 = s_7 * s_13;
    let s_28 = s_8 * s_14;
    let s_29 = s_2 * s_10;
    let s_30 = C::read(coefficients.c_244) * s_23 + C::read(coefficients.c_245) * s_24
        + C::read(coefficients.c_247) * s_26 - C::read(coefficients.c_235) * s_19;
    let s_31 = s_30 - C::read(coefficients.c_242) * s_21
        - C::read(coefficients.c_243) * s_17 - C::read(coefficients.c_246) * s_25;
    let s_32 = C::read(coefficients.c_217) * s_25 - s_23;
    let s_33 = C::read(coefficients.c_249) * s_15 + C::read(coefficients.c_252) * s_23
        - C::read(coefficients.c_250) * s_21 - C::read(coefficients.c_251) * s_17;
    let s_34 = s_33 - C::read(coefficients.c_253) * s_25;
    let s_35 = sum_of_few([(); 2], |i| C::read(coefficients.c_255[i]) * weights[4 + i]);
    let s_36 = s_5 * s_35;
    let s_37 = sum_of_few(
        [(); 2],
        |i| C::read(coefficients.c_256[i]) * (state[1 + i] * weights[4 + i]),
    );
    let mut s_38 = [T::number(0.0); 2];
    for i in 0..2 {
        s_38[i] = C::read(coefficients.c_19[i]) * (s_13 * state[1 + i])
            + C::read(coefficients.c_257[i]) * s_17
            + C::read(coefficients.c_258[i]) * s_17;
    }
    let s_39 = sum_of_few([(); 2], |i| T::number(INTEGRAL_S1_PHI[i]) * s_38[i]);
    let s_40 = C::read(coefficients.c_230) * s_18 + C::read(coefficients.c_231) * s_19
        + C::read(coefficients.c_59) * s_21 + C::read(coefficients.c_71) * s_25;
    let s_41 = s_40 + C::read(coefficients.c_62) * s_28
        + C::read(coefficients.c_239) * s_26 + C::read(coefficients.c_241) * s_31;
    let s_42 = s_41 + C::read(coefficients.c_254) * s_36
        + C::read(coefficients.c_54) * s_37 + C::read(coefficients.c_74) * s_39;
    let s_43 = s_42 - C::read(coefficients.c_232) * s_20
        - C::read(coefficients.c_67) * s_23 - C::read(coefficients.c_64) * s_24;
    let s_44 = s_43 - C::read(coefficients.c_234) * s_26
        - C::read(coefficients.c_54) * s_27 - C::read(coefficients.c_238) * s_17;
    let s_45 = s_44 - C::read(coefficients.c_240) * s_29
        - C::read(coefficients.c_66) * s_32 - C::read(coefficients.c_248) * s_34;
    let s_46 = C::read(coefficients.c_260) * s_18 + C::read(coefficients.c_261) * s_19
        + C::read(coefficients.c_76) * s_21 + C::read(coefficients.c_87) * s_25;
    let s_47 = s_46 + C::read(coefficients.c_79) * s_28
        + C::read(coefficients.c_265) * s_26 + C::read(coefficients.c_267) * s_31;
    let s_48 = s_47 + C::read(coefficients.c_269) * s_36
        + C::read(coefficients.c_73) * s_37 + C::read(coefficients.c_56) * s_39;
    let s_49 = s_48 - C::read(coefficients.c_262) * s_20
        - C::read(coefficients.c_83) * s_23 - C::read(coefficients.c_80) * s_24;
    let s_50 = s_49 - C::read(coefficients.c_263) * s_26
        - C::read(coefficients.c_73) * s_27 - C::read(coefficients.c_264) * s_17;
    let s_51 = s_50 - C::read(coefficients.c_266) * s_29
        - C::read(coefficients.c_82) * s_32 - C::read(coefficients.c_268) * s_34;
    let s_52 = sum_of_few([(); 2], |i| C::read(coefficients.c_181[i]) * weights[4 + i]);
    let mut s_53 = [T::number(0.0); 2];
    for i in 0..2 {
        s_53[i] = C::read(coefficients.c_281[i]) * s_17
            + C::read(coefficients.c_282[i]) * s_32
            + C::read(coefficients.c_283[i]) * s_34 + s_38[i];
    }
    let mut s_54 = [T::number(0.0); 2];
    for i in 0..2 {
        s_54[i] = s_53[i] - C::read(coefficients.c_284[i]) * (s_5 * weights[4 + i]);
    }
    let s_55 = sum_of_few([(); 2], |i| T::number(PHI_D1_AT_END[i]) * s_54[i]);
    let s_56 = sum_of_few([(); 2], |i| T::number(PHI_AT_END[i]) * s_54[i]);
    let s_57 = C::read(coefficients.c_271) * s_18 + C::read(coefficients.c_272) * s_19
        + C::read(coefficients.c_93) * s_21 + C::read(coefficients.c_105) * s_25;
    let s_58 = s_57 + C::read(coefficients.c_276) * s_17
        + C::read(coefficients.c_97) * s_28 + C::read(coefficients.c_277) * s_26;
    let s_59 = s_58 + C::read(coefficients.c_279) * s_31
        + C::read(coefficients.c_8) * s_32 + C::read(coefficients.c_7) * s_34;
    let s_60 = s_59 + C::read(coefficients.c_280) * s_36
        + C::read(coefficients.c_89) * s_37 + C::read(coefficients.M_t) * s_56;
    let s_61 = s_60 + C::read(coefficients.c_91) * s_39
        - C::read(coefficients.c_273) * s_20 - C::read(coefficients.c_101) * s_23;
    let s_62 = s_61 - C::read(coefficients.c_98) * s_24
        - C::read(coefficients.c_274) * s_26 - C::read(coefficients.c_89) * s_27;
    let s_63 = s_62 - C::read(coefficients.c_275) * s_17
        - C::read(coefficients.c_104) * s_25 - C::read(coefficients.c_278) * s_29;
    let s_64 = s_63 - C::read(coefficients.c_100) * s_32
        - C::read(coefficients.c_94) * s_34 - C::read(coefficients.c_12) * (s_5 * s_52);
    let s_65 = s_64 - C::read(coefficients.c_217) * s_55
        - C::read(coefficients.c_285) * s_17 - C::read(coefficients.c_286) * s_17;
    let s_66 = C::read(coefficients.c_110) * s_24 + C::read(coefficients.c_107) * s_27
        + C::read(coefficients.c_287) * s_29 - C::read(coefficients.c_108) * s_21;
    let s_67 = C::read(coefficients.c_114) * s_24 + C::read(coefficients.c_111) * s_27
        + C::read(coefficients.c_288) * s_29 - C::read(coefficients.c_112) * s_21;
    let s_68 = C::read(coefficients.c_289) * s_15 + C::read(coefficients.c_290) * s_20
        + C::read(coefficients.c_121) * s_23 + C::read(coefficients.c_119) * s_24;
    let s_69 = s_68 + C::read(coefficients.c_292) * s_26
        + C::read(coefficients.c_293) * s_29 + C::read(coefficients.l) * s_56;
    let s_70 = s_69 - C::read(coefficients.c_116) * s_21
        - C::read(coefficients.c_291) * s_17 - C::read(coefficients.c_124) * s_25;
    let s_71 = C::read(coefficients.c_129) * s_24 + C::read(coefficients.c_296) * s_26
        + C::read(coefficients.c_132) * s_25 + C::read(coefficients.c_33) * s_55;
    let s_72 = s_71 - C::read(coefficients.c_52) * s_17
        - C::read(coefficients.c_133) * s_25 - C::read(coefficients.c_128) * s_28;
    let mut product = [T::number(0.0); PARAMETERS];
    product[0] = C::read(coefficients.c_53) * s_17;
    product[1] = s_45 - C::read(coefficients.c_259) * s_17;
    product[2] = s_51 - C::read(coefficients.c_270) * s_17;
    product[3] = s_65;
    product[4] = s_66 - C::read(coefficients.c_109) * s_28
        - C::read(coefficients.c_107) * s_37;
    product[5] = s_67 - C::read(coefficients.c_113) * s_28
        - C::read(coefficients.c_111) * s_37;
    product[6] = s_70 - C::read(coefficients.c_294) * s_31
        - C::read(coefficients.c_295) * s_17;
    product[7] = s_72 - C::read(coefficients.c_297) * s_26;
    product[8] = -(theta_dot * s_13);
    product
}

/// Number of structural nonzeros of [`rates_by_state`].
pub const RATES_BY_STATE_NONZEROS: usize = 12;

/// Positions of the nonzeros in the matrix of 6 x 6.
pub static RATES_BY_STATE: Pattern<12> = pattern(
    &[
        [0, 3, 3, 3, 1],
        [3, 1, 1, 2, 0],
        [3, 1, 3, 1, 0],
        [4, 2, 1, 2, 0],
        [4, 2, 3, 1, 0],
    ],
);

/// Jacobian of the rates by the state: structural nonzeros, row by row, at the positions
/// given by [`RATES_BY_STATE`].
#[allow(unused_variables, unused_mut)]
pub fn rates_by_state<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> [T; RATES_BY_STATE_NONZEROS] {
    inlined_rates_by_state(t, state, inputs, coefficients)
}

/// [`rates_by_state`], inlined into the calling function and compiled for its registers.
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
        values[3 + i] = C::read(coefficients.c_41[i]);
    }
    values[5] = C::read(coefficients.c_42);
    for i in 0..2 {
        values[6 + 3 * i + i] = values[6 + 3 * i + i] + C::read(coefficients.c_29[i]);
        for j in 0..2 {
            values[6 + 3 * i + j] = values[6 + 3 * i + j]
                + C::read(coefficients.c_43[i]) * C::read(coefficients.c_45[j]);
            values[6 + 3 * i + j] = values[6 + 3 * i + j]
                + C::read(coefficients.c_46[i]) * C::read(coefficients.c_44[j]);
            values[6 + 3 * i + j] = values[6 + 3 * i + j]
                + C::read(coefficients.c_47[i]) * C::read(coefficients.c_40[j]);
        }
    }
    for i in 0..2 {
        values[8 + 3 * i] = C::read(coefficients.c_48[i]);
    }
    values
}

/// Number of structural nonzeros of [`rates_by_inputs`].
pub const RATES_BY_INPUTS_NONZEROS: usize = 3;

/// Positions of the nonzeros in the matrix of 6 x 1.
pub static RATES_BY_INPUTS: Pattern<3> = pattern(&[[3, 1, 0, 1, 0], [4, 2, 0, 1, 0]]);

/// Jacobian of the rates by the inputs: structural nonzeros, row by row, at the positions
/// given by [`RATES_BY_INPUTS`].
#[allow(unused_variables, unused_mut)]
pub fn rates_by_inputs<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> [T; RATES_BY_INPUTS_NONZEROS] {
    inlined_rates_by_inputs(t, state, inputs, coefficients)
}

/// [`rates_by_inputs`], inlined into the calling function and compiled for its registers.
#[allow(unused_variables, unused_mut)]
#[inline(always)]
pub fn inlined_rates_by_inputs<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
) -> [T; RATES_BY_INPUTS_NONZEROS] {
    let mut values = [T::number(0.0); RATES_BY_INPUTS_NONZEROS];
    values[0] = C::read(coefficients.c_12);
    for i in 0..2 {
        values[1 + i] = C::read(coefficients.c_51[i]);
    }
    values
}

/// Number of structural nonzeros of [`rates_by_parameters`].
pub const RATES_BY_PARAMETERS_NONZEROS: usize = 27;

/// Positions of the nonzeros in the matrix of 6 x 9.
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

/// Jacobian of the rates by the parameters: structural nonzeros, row by row, at the positions
/// given by [`RATES_BY_PARAMETERS`].
#[allow(unused_variables, unused_mut)]
pub fn rates_by_parameters<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> [T; RATES_BY_PARAMETERS_NONZEROS] {
    inlined_rates_by_parameters(t, state, inputs, coefficients)
}

/// [`rates_by_parameters`], inlined into the calling function and compiled for its registers.
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
    let s_1 = sum_of_few([(); 2], |i| C::read(coefficients.c_13[i]) * state[1 + i]);
    let s_2 = sum_of_few([(); 2], |i| C::read(coefficients.c_15[i]) * state[1 + i]);
    let s_3 = sum_of_few([(); 2], |i| C::read(coefficients.c_17[i]) * state[1 + i]);
    let s_4 = C::read(coefficients.c_18) * s_2 - s_3;
    let s_5 = u + s_1 - C::read(coefficients.c) * theta_dot
        - C::read(coefficients.c_14) * s_2 - C::read(coefficients.c_16) * s_4;
    let s_6 = s_4 - C::read(coefficients.c_23) * s_5;
    let s_7 = C::read(coefficients.c_25) * s_2 - C::read(coefficients.c_22) * s_6
        - C::read(coefficients.c_24) * s_5;
    let s_8 = sum_of_few([(); 2], |i| C::read(coefficients.c_55[i]) * state[1 + i]);
    let s_9 = sum_of_few([(); 2], |i| C::read(coefficients.c_58[i]) * state[1 + i]);
    let s_10 = sum_of_few([(); 2], |i| C::read(coefficients.c_63[i]) * state[1 + i]);
    let s_11 = C::read(coefficients.c_62) * s_10
        + (C::read(coefficients.c_65) * s_2 - C::read(coefficients.c_64) * s_2);
    let s_12 = C::read(coefficients.c_57) * s_9 - C::read(coefficients.c_54) * s_8
        - (C::read(coefficients.c_61) * s_2 - C::read(coefficients.c_59) * s_2
            - C::read(coefficients.c_60) * s_2);
    let s_13 = s_12
        - (C::read(coefficients.c_16) * s_11 + C::read(coefficients.c_68) * s_4
            - C::read(coefficients.c_69) * s_4);
    let s_14 = C::read(coefficients.c_79) * s_10
        + (C::read(coefficients.c_81) * s_2 - C::read(coefficients.c_80) * s_2);
    let s_15 = C::read(coefficients.c_75) * s_9 - C::read(coefficients.c_73) * s_8
        - (C::read(coefficients.c_78) * s_2 - C::read(coefficients.c_76) * s_2
            - C::read(coefficients.c_77) * s_2);
    let s_16 = s_15
        - (C::read(coefficients.c_16) * s_14 + C::read(coefficients.c_84) * s_4
            - C::read(coefficients.c_85) * s_4);
    let s_17 = sum_of_few([(); 2], |i| C::read(coefficients.c_92[i]) * state[1 + i]);
    let s_18 = C::read(coefficients.c_97) * s_10
        + (C::read(coefficients.c_99) * s_2 - C::read(coefficients.c_98) * s_2);
    let s_19 = C::read(coefficients.c_90) * s_17 - C::read(coefficients.c_89) * s_8
        - (C::read(coefficients.c_95) * s_2 + C::read(coefficients.c_96) * s_2
            - C::read(coefficients.c_93) * s_2);
    let s_20 = s_19
        - (C::read(coefficients.c_16) * s_18 + C::read(coefficients.c_102) * s_4
            - C::read(coefficients.c_103) * s_4);
    let s_21 = C::read(coefficients.c_110) * s_2 - C::read(coefficients.c_109) * s_10;
    let s_22 = C::read(coefficients.c_107) * s_8 - C::read(coefficients.c_108) * s_2
        - C::read(coefficients.c_16) * s_21;
    let s_23 = C::read(coefficients.c_114) * s_2 - C::read(coefficients.c_113) * s_10;
    let s_24 = C::read(coefficients.c_111) * s_8 - C::read(coefficients.c_112) * s_2
        - C::read(coefficients.c_16) * s_23;
    let s_25 = C::read(coefficients.c_119) * s_2 - C::read(coefficients.c_120) * s_2;
    let s_26 = C::read(coefficients.c_115) * s_2
        - (C::read(coefficients.c_116) * s_2 + C::read(coefficients.c_117) * s_2
            - C::read(coefficients.c_118) * s_2);
    let s_27 = s_26
        - (C::read(coefficients.c_16) * s_25 + C::read(coefficients.c_122) * s_4
            + C::read(coefficients.c_123) * s_4);
    let s_28 = C::read(coefficients.c_129) * s_2 - C::read(coefficients.c_128) * s_10;
    let s_29 = C::read(coefficients.c_126) * s_10 - C::read(coefficients.c_127) * s_2
        - (C::read(coefficients.c_16) * s_28 + C::read(coefficients.c_130) * s_4
            - C::read(coefficients.c_131) * s_4);
    let s_30 = C::read(coefficients.c_137) * s_5 - C::read(coefficients.c_136) * s_5;
    let s_31 = s_11
        - (C::read(coefficients.c_147) * s_5 + C::read(coefficients.c_23) * s_13
            - C::read(coefficients.c_148) * s_5);
    let s_32 = C::read(coefficients.c_144) * s_2
        - (C::read(coefficients.c_22) * s_31 - C::read(coefficients.c_145) * s_6
            - C::read(coefficients.c_146) * s_6);
    let s_33 = s_32
        - (C::read(coefficients.c_24) * s_13 - C::read(coefficients.c_149) * s_5
            - C::read(coefficients.c_150) * s_5);
    let mut s_34 = [T::number(0.0); 2];
    for i in 0..2 {
        s_34[i] = C::read(coefficients.c_141[i]) * state[1 + i]
            - (C::read(coefficients.c_143[i]) * s_7
                + C::read(coefficients.c_21[i]) * s_33
                - C::read(coefficients.c_142[i]) * s_7);
    }
    let mut s_35 = [T::number(0.0); 2];
    for i in 0..2 {
        s_35[i] = s_34[i]
            - (C::read(coefficients.c_26[i]) * s_31
                - C::read(coefficients.c_151[i]) * s_6
                - C::read(coefficients.c_152[i]) * s_6);
    }
    let mut s_36 = [T::number(0.0); 2];
    for i in 0..2 {
        s_36[i] = s_35[i]
            - (C::read(coefficients.c_28[i]) * s_13
                - C::read(coefficients.c_153[i]) * s_5
                - C::read(coefficients.c_154[i]) * s_5);
    }
    let s_37 = s_14
        - (C::read(coefficients.c_161) * s_5 + C::read(coefficients.c_23) * s_16
            - C::read(coefficients.c_162) * s_5);
    let s_38 = C::read(coefficients.c_158) * s_2
        - (C::read(coefficients.c_22) * s_37 - C::read(coefficients.c_159) * s_6
            - C::read(coefficients.c_160) * s_6);
    let s_39 = s_38
        - (C::read(coefficients.c_24) * s_16 - C::read(coefficients.c_163) * s_5
            - C::read(coefficients.c_164) * s_5);
    let mut s_40 = [T::number(0.0); 2];
    for i in 0..2 {
        s_40[i] = C::read(coefficients.c_155[i]) * state[1 + i]
            - (C::read(coefficients.c_157[i]) * s_7
                + C::read(coefficients.c_21[i]) * s_39
                - C::read(coefficients.c_156[i]) * s_7);
    }
    let mut s_41 = [T::number(0.0); 2];
    for i in 0..2 {
        s_41[i] = s_40[i]
            - (C::read(coefficients.c_26[i]) * s_37
                - C::read(coefficients.c_165[i]) * s_6
                - C::read(coefficients.c_166[i]) * s_6);
    }
    let mut s_42 = [T::number(0.0); 2];
    for i in 0..2 {
        s_42[i] = s_41[i]
            - (C::read(coefficients.c_28[i]) * s_16
                - C::read(coefficients.c_167[i]) * s_5
                - C::read(coefficients.c_168[i]) * s_5);
    }
    let s_43 = s_18
        - (C::read(coefficients.c_175) * s_5 + C::read(coefficients.c_23) * s_20
            - C::read(coefficients.c_176) * s_5);
    let s_44 = C::read(coefficients.c_172) * s_2
        - (C::read(coefficients.c_22) * s_43 - C::read(coefficients.c_173) * s_6
            - C::read(coefficients.c_174) * s_6);
    let s_45 = s_44
        - (C::read(coefficients.c_177) * s_5 + C::read(coefficients.c_24) * s_20
            - C::read(coefficients.c_178) * s_5);
    let mut s_46 = [T::number(0.0); 2];
    for i in 0..2 {
        s_46[i] = C::read(coefficients.c_169[i]) * state[1 + i]
            - (C::read(coefficients.c_171[i]) * s_7
                + C::read(coefficients.c_21[i]) * s_45
                - C::read(coefficients.c_170[i]) * s_7);
    }
    let mut s_47 = [T::number(0.0); 2];
    for i in 0..2 {
        s_47[i] = s_46[i]
            - (C::read(coefficients.c_26[i]) * s_43
                - C::read(coefficients.c_179[i]) * s_6
                - C::read(coefficients.c_180[i]) * s_6);
    }
    let mut s_48 = [T::number(0.0); 2];
    for i in 0..2 {
        s_48[i] = s_47[i]
            - (C::read(coefficients.c_182[i]) * s_5
                + C::read(coefficients.c_28[i]) * s_20
                - C::read(coefficients.c_183[i]) * s_5);
    }
    let s_49 = s_21 - C::read(coefficients.c_23) * s_22;
    let s_50 = C::read(coefficients.c_184) * s_2 - C::read(coefficients.c_22) * s_49
        - C::read(coefficients.c_24) * s_22;
    let mut s_51 = [T::number(0.0); 2];
    for i in 0..2 {
        s_51[i] = C::read(coefficients.c_185[i]) * state[1 + i]
            - C::read(coefficients.c_21[i]) * s_50 - C::read(coefficients.c_26[i]) * s_49
            - C::read(coefficients.c_28[i]) * s_22;
    }
    let s_52 = s_23 - C::read(coefficients.c_23) * s_24;
    let s_53 = C::read(coefficients.c_186) * s_2 - C::read(coefficients.c_22) * s_52
        - C::read(coefficients.c_24) * s_24;
    let mut s_54 = [T::number(0.0); 2];
    for i in 0..2 {
        s_54[i] = C::read(coefficients.c_187[i]) * state[1 + i]
            - C::read(coefficients.c_21[i]) * s_53 - C::read(coefficients.c_26[i]) * s_52
            - C::read(coefficients.c_28[i]) * s_24;
    }
    let s_55 = s_25
        - (C::read(coefficients.c_191) * s_5 + C::read(coefficients.c_23) * s_27
            - C::read(coefficients.c_192) * s_5);
    let s_56 = C::read(coefficients.c_193) * s_5 + C::read(coefficients.c_194) * s_5
        + C::read(coefficients.c_24) * s_27 - C::read(coefficients.c_195) * s_5;
    let s_57 = C::read(coefficients.c_196) * s_2
        - (C::read(coefficients.c_189) * s_6 + C::read(coefficients.c_190) * s_6
            + C::read(coefficients.c_22) * s_55);
    let s_58 = s_57 - s_56;
    let mut s_59 = [T::number(0.0); 2];
    for i in 0..2 {
        s_59[i] = -(C::read(coefficients.c_21[i]) * s_58
            - C::read(coefficients.c_188[i]) * s_7)
            - (C::read(coefficients.c_197[i]) * s_6
                + C::read(coefficients.c_26[i]) * s_55);
    }
    let mut s_60 = [T::number(0.0); 2];
    for i in 0..2 {
        s_60[i] = s_59[i]
            - (C::read(coefficients.c_198[i]) * s_5
                + C::read(coefficients.c_28[i]) * s_27
                - C::read(coefficients.c_199[i]) * s_5);
    }
    let s_61 = s_28
        - (C::read(coefficients.c_201) * s_5 + C::read(coefficients.c_23) * s_29
            - C::read(coefficients.c_202) * s_5);
    let s_62 = -(C::read(coefficients.c_22) * s_61 - C::read(coefficients.c_200) * s_6)
        - (C::read(coefficients.c_203) * s_5 + C::read(coefficients.c_24) * s_29
            - C::read(coefficients.c_204) * s_5);
    let mut s_63 = [T::number(0.0); 2];
    for i in 0..2 {
        s_63[i] = C::read(coefficients.c_43[i]) * s_62
            - (C::read(coefficients.c_26[i]) * s_61
                - C::read(coefficients.c_205[i]) * s_6)
            - (C::read(coefficients.c_206[i]) * s_5
                + C::read(coefficients.c_28[i]) * s_29
                - C::read(coefficients.c_207[i]) * s_5);
    }
    let s_64 = C::read(coefficients.c_24) * theta_dot
        - C::read(coefficients.c_49) * theta_dot;
    let mut values = [T::number(0.0); RATES_BY_PARAMETERS_NONZEROS];
    values[0] = C::read(coefficients.c_53) * s_5;
    values[1] = C::read(coefficients.c_12) * s_13 - C::read(coefficients.c_72) * s_5;
    values[2] = C::read(coefficients.c_12) * s_16 - C::read(coefficients.c_88) * s_5;
    values[3] = C::read(coefficients.c_12) * s_20 - C::read(coefficients.c_106) * s_5;
    values[4] = C::read(coefficients.c_12) * s_22;
    values[5] = C::read(coefficients.c_12) * s_24;
    values[6] = C::read(coefficients.c_12) * s_27 - C::read(coefficients.c_125) * s_5;
    values[7] = C::read(coefficients.c_12) * s_29 - C::read(coefficients.c_134) * s_5;
    values[8] = C::read(coefficients.c_135) * theta_dot;
    for i in 0..2 {
        values[9 + 9 * i] = C::read(coefficients.c_140[i]) * s_5
            - C::read(coefficients.c_21[i]) * s_30
            - C::read(coefficients.c_139[i]) * s_5;
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
        values[17 + 9 * i] = C::read(coefficients.c_28[i]) * theta_dot
            - C::read(coefficients.c_21[i]) * s_64
            - C::read(coefficients.c_50[i]) * theta_dot;
    }
    values
}

/// Number of structural nonzeros of [`observables_by_state`].
pub const OBSERVABLES_BY_STATE_NONZEROS: usize = 10;

/// Positions of the nonzeros in the matrix of 4 x 6.
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

/// Jacobian of the observables by the state: structural nonzeros, row by row, at the positions
/// given by [`OBSERVABLES_BY_STATE`].
#[allow(unused_variables, unused_mut)]
pub fn observables_by_state<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> [T; OBSERVABLES_BY_STATE_NONZEROS] {
    inlined_observables_by_state(t, state, inputs, coefficients)
}

/// [`observables_by_state`], inlined into the calling function and compiled for its registers.
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
    let s_6 = theta_dot + C::read(coefficients.c_33) * s_5;
    let s_7 = C::read(coefficients.J_h) * theta_dot
        + T::number(0.5)
            * (C::read(coefficients.c_208) * theta_dot
                + C::read(coefficients.c_35) * s_2);
    let mut s_8 = [T::number(0.0); 2];
    for i in 0..2 {
        s_8[i] = T::number(0.5)
            * (C::read(coefficients.c_209[i]) * theta_dot
                + C::read(coefficients.c_210[i]) * state[4 + i])
            + (C::read(coefficients.c_30[i]) * s_4 + C::read(coefficients.c_5[i]) * s_6);
    }
    let mut values = [T::number(0.0); OBSERVABLES_BY_STATE_NONZEROS];
    for i in 0..2 {
        values[0 + i] = T::number(PHI_AT_END[i]);
    }
    for i in 0..2 {
        values[2 + i] = C::read(coefficients.c_31[i]);
    }
    for i in 0..2 {
        values[4 + i] = C::read(coefficients.c_32[i]) * state[1 + i];
    }
    values[6] = s_7
        + (C::read(coefficients.c_4) * s_4 + C::read(coefficients.J_t) * s_6);
    for i in 0..2 {
        values[7 + i] = s_8[i];
    }
    values[9] = u - s_1 - s_1;
    values
}

/// Number of structural nonzeros of [`observables_by_inputs`].
pub const OBSERVABLES_BY_INPUTS_NONZEROS: usize = 1;

/// Positions of the nonzeros in the matrix of 4 x 1.
pub static OBSERVABLES_BY_INPUTS: Pattern<1> = pattern(&[[3, 1, 0, 1, 0]]);

/// Jacobian of the observables by the inputs: structural nonzeros, row by row, at the positions
/// given by [`OBSERVABLES_BY_INPUTS`].
#[allow(unused_variables, unused_mut)]
pub fn observables_by_inputs<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> [T; OBSERVABLES_BY_INPUTS_NONZEROS] {
    inlined_observables_by_inputs(t, state, inputs, coefficients)
}

/// [`observables_by_inputs`], inlined into the calling function and compiled for its registers.
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

/// Number of structural nonzeros of [`observables_by_parameters`].
pub const OBSERVABLES_BY_PARAMETERS_NONZEROS: usize = 10;

/// Positions of the nonzeros in the matrix of 4 x 9.
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

/// Jacobian of the observables by the parameters: structural nonzeros, row by row, at the positions
/// given by [`OBSERVABLES_BY_PARAMETERS`].
#[allow(unused_variables, unused_mut)]
pub fn observables_by_parameters<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> [T; OBSERVABLES_BY_PARAMETERS_NONZEROS] {
    inlined_observables_by_parameters(t, state, inputs, coefficients)
}

/// [`observables_by_parameters`], inlined into the calling function and compiled for its registers.
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
    let s_9 = theta_dot + C::read(coefficients.c_33) * s_8;
    let s_10 = sum_of_few(
        [(); 2],
        |i| T::number(INTEGRAL_PHI_D2_SQUARED[i]) * (state[1 + i] * state[1 + i]),
    );
    let s_11 = T::number(0.5)
        * (C::read(coefficients.c_70) * s_2 + C::read(coefficients.c_212) * s_4
            + C::read(coefficients.c_213) * s_5);
    let s_12 = T::number(0.5)
        * (C::read(coefficients.c_86) * s_2 + C::read(coefficients.c_214) * s_4
            + C::read(coefficients.c_215) * s_5);
    let s_13 = T::number(0.5)
        * (C::read(coefficients.c_3) * s_2 + C::read(coefficients.c_216) * s_4
            + C::read(coefficients.c_2) * s_5);
    let s_14 = s_13
        + (C::read(coefficients.M_t) * (theta_dot * s_7)
            - C::read(coefficients.c_217) * (s_8 * s_9))
        - C::read(coefficients.c_218) * s_10;
    let mut values = [T::number(0.0); OBSERVABLES_BY_PARAMETERS_NONZEROS];
    values[0] = C::read(coefficients.c_211) * s_1;
    values[1] = T::number(0.5) * s_2;
    values[2] = s_11;
    values[3] = s_12;
    values[4] = s_14;
    values[5] = C::read(coefficients.c_219) * s_10;
    values[6] = C::read(coefficients.c_220) * s_10;
    values[7] = T::number(0.5) * (s_7 * s_7);
    values[8] = T::number(0.5) * (s_9 * s_9);
    values[9] = -s_2;
    values
}

/// Linearisation about a point: rates + A dx + B du, observables + C dx + D du.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linearisation<T = f64> {
    /// Rates at the point.
    pub rates: [T; STATES],
    /// Observables at the point.
    pub observables: [T; OBSERVABLES],
    /// Derivatives of the rates by the state.
    pub A: [[T; STATES]; STATES],
    /// Derivatives of the rates by the inputs.
    pub B: [[T; INPUTS]; STATES],
    /// Derivatives of the observables by the state.
    pub C: [[T; STATES]; OBSERVABLES],
    /// Derivatives of the observables by the inputs.
    pub D: [[T; INPUTS]; OBSERVABLES],
}

/// Linearisation about a point.
pub fn linearise<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> Linearisation<T> {
    inlined_linearise(t, state, inputs, coefficients)
}

/// [`linearise`], inlined into the calling function and compiled for its registers.
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

/// Positions of the structural nonzeros of a matrix, row by row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pattern<const N: usize> {
    /// Row of each.
    pub rows: [usize; N],
    /// Column of each.
    pub columns: [usize; N],
}
impl<const N: usize> Pattern<N> {
    /// Returns the matrix of `R` rows and `C` columns with these nonzeros.
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

/// Expands blocks to positions. A block has first row, rows, first column, columns, and 1 if only
/// its diagonal is filled, else 0. Blocks of the same rows are adjacent.
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

/// Number type of the elementary functions: IEEE 754 double precision, or SIMD lanes of it.
pub trait Real: Scalar {
    /// Returns `then` if a = b, else `otherwise`, also if either is NaN.
    fn select_equal(a: Self, b: Self, then: Self, otherwise: Self) -> Self;
    /// Clears the sign bit.
    fn magnitude(self) -> Self;
    /// Returns the magnitude with the sign bit of another number.
    fn copy_sign(self, sign: Self) -> Self;
    /// Returns 2^k for an integral k: the addition of 2^52 + 1023 moves k to the exponent bits.
    fn power_of_two(self) -> Self;
    /// Returns the unbiased exponent field.
    fn exponent(self) -> Self;
    /// Returns the mantissa with the exponent of 1.
    fn significand(self) -> Self;
}

/// Elementary function: plain operations in a fixed order, with the same bits on every machine.
pub trait Function {
    /// Computes the value.
    fn value<T: Real>(x: T) -> T;
    /// Computes the derivative at x; `value` is the value there.
    fn slope<T: Scalar>(x: T, value: T) -> T;
}

/// Elementary function of two arguments.
pub trait FunctionOfTwo {
    /// Computes the value.
    fn value<T: Real>(x: T, y: T) -> T;
    /// Computes the derivatives by x and y; `value` is the value there.
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

/// Elementary functions are computed in double precision and rounded: within 0.5001 units in the
/// last place.
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

/// Coefficient of functions for SIMD lanes: a number of their type, or an `f64` that all lanes
/// share, which takes an eighth of the memory.
pub trait Coefficient<T>: Copy {
    /// Returns the number in every lane.
    fn read(self) -> T;
}
impl<T: Scalar> Coefficient<T> for T {
    #[inline(always)]
    fn read(self) -> T {
        self
    }
}

/// Returns 1/pivot for a positive pivot, else NaN: the mass matrix is not positive definite.
#[inline(always)]
fn pivot_reciprocal<T: Scalar>(pivot: T) -> T {
    let reciprocal = T::number(1.0) / pivot;
    T::select_greater(pivot, T::number(0.0), reciprocal, T::number(f64::NAN))
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

/// Adds the first `N` of eight numbers, neighbours in pairs.
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
    paired::<N, T>(&s)
}
