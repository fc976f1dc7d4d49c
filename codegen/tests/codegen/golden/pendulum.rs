//! Pendulum arm with viscous friction: equations of motion, rigid.
//!
//! Emitted by eomgen 0.2.0 from the specification `pendulum` (SHA-256 683b86cddda2f4c47ea60a0b1d58b7a99fa825a2631fbf37b000b9ac4c8c8694).
//! Do not edit: change the specification and generate again.
//!
//! State: theta, theta_dot.
//! All quantities are in SI units. The code does not allocate, panic or use the standard library.
#![no_std]
#![allow(non_snake_case)]
#![allow(clippy::all)]
#![forbid(unsafe_code)]

/// Modal truncation order of each field.
pub const ORDERS: [usize; 0] = [];

/// Number of degrees of freedom: coordinates and modes.
pub const DEGREES_OF_FREEDOM: usize = 1;

/// Number of states: coordinates, modes, and the rates of both.
pub const STATES: usize = 2;

/// Names of the states, in their order.
pub const STATE_NAMES: [&'static str; STATES] = ["theta", "theta_dot"];

/// Number of observables.
pub const OBSERVABLES: usize = 2;

/// Names of the observables, in their order.
pub const OBSERVABLE_NAMES: [&'static str; OBSERVABLES] = ["energy", "power"];

/// Number of switching surfaces.
pub const GUARDS: usize = 0;

/// SHA-256 of the specification.
pub const SPECIFICATION_SHA256: &'static str = "683b86cddda2f4c47ea60a0b1d58b7a99fa825a2631fbf37b000b9ac4c8c8694";

/// Version of the generator.
pub const GENERATOR_VERSION: &'static str = "0.2.0";

/// Number of inputs.
pub const INPUTS: usize = 0;

/// Names of the inputs, in their order.
pub const INPUT_NAMES: [&'static str; INPUTS] = [];

/// Number of parameters.
pub const PARAMETERS: usize = 5;

/// Names of the parameters, in their order.
pub const PARAMETER_NAMES: [&'static str; PARAMETERS] = ["m", "a", "I", "k", "g"];

/// SI units of the states.
pub const STATE_UNITS: [&'static str; STATES] = ["rad", "rad/s"];

/// SI units of the inputs.
pub const INPUT_UNITS: [&'static str; INPUTS] = [];

/// SI units of the parameters.
pub const PARAMETER_UNITS: [&'static str; PARAMETERS] = [
    "kg",
    "m",
    "kg m^2",
    "N m s",
    "m/s^2",
];

/// SI units of the observables.
pub const OBSERVABLE_UNITS: [&'static str; OBSERVABLES] = ["J", "W"];

/// Initial state of the specification, at its parameters.
pub const INITIAL_STATE: [f64; STATES] = [2.356194490192345, 0.0];

/// Lower ends of the ranges of the states, -infinity if the specification gives none.
pub const STATE_LOWER: [f64; STATES] = [f64::NEG_INFINITY, f64::NEG_INFINITY];

/// Upper ends of the ranges of the states, infinity if the specification gives none.
pub const STATE_UPPER: [f64; STATES] = [f64::INFINITY, f64::INFINITY];

/// Lower ends of the ranges of the inputs, -infinity if the specification gives none.
pub const INPUT_LOWER: [f64; INPUTS] = [];

/// Upper ends of the ranges of the inputs, infinity if the specification gives none.
pub const INPUT_UPPER: [f64; INPUTS] = [];

/// Indices of the states, and of their time derivatives in the rates.
#[allow(non_upper_case_globals)]
pub mod state {
    /// `theta`
    pub const THETA: usize = 0;
    /// `theta_dot`
    pub const THETA_DOT: usize = 1;
}

/// Indices of the parameters.
#[allow(non_upper_case_globals)]
pub mod parameter {
    /// `m`
    pub const M: usize = 0;
    /// `a`
    pub const A: usize = 1;
    /// `I`
    pub const I: usize = 2;
    /// `k`
    pub const K: usize = 3;
    /// `g`
    pub const G: usize = 4;
}

/// Indices of the observables.
#[allow(non_upper_case_globals)]
pub mod observable {
    /// `energy`
    pub const ENERGY: usize = 0;
    /// `power`
    pub const POWER: usize = 1;
}

/// Identity, for `eomgen identify`; `source` is the SHA-256 of this file without the line below.
pub static IDENTITY: [u8; 197] = *b"eomgen-identity name=pendulum specification=683b86cddda2f4c47ea60a0b1d58b7a99fa825a2631fbf37b000b9ac4c8c8694 source=d71850fff13e261a4036d3a0c7743d6c30f2010741ca44eb8413310cb6575bc9 generator=0.2.0;";

/// Parameters of the model. `Default` has the values of the specification.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameters<T = f64> {
    /// mass of the arm \[kg] (arXiv 2205.06231)
    pub m: T,
    /// distance from pivot to centre of mass \[m] (arXiv 2205.06231)
    pub a: T,
    /// inertia about the centre of mass \[kg m^2] (arXiv 2205.06231)
    pub I: T,
    /// viscous friction in the pivot \[N m s] (arXiv 2205.06231)
    pub k: T,
    /// gravity \[m/s^2]
    pub g: T,
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
impl Parameters {
    /// Converts these parameters to another number type, without derivatives.
    #[inline(always)]
    pub fn cast<T: Scalar>(&self) -> Parameters<T> {
        Parameters {
            m: T::number(self.m),
            a: T::number(self.a),
            I: T::number(self.I),
            k: T::number(self.k),
            g: T::number(self.g),
        }
    }
}
impl<T: Copy> From<[T; PARAMETERS]> for Parameters<T> {
    fn from(numbers: [T; PARAMETERS]) -> Self {
        Self {
            m: numbers[0],
            a: numbers[1],
            I: numbers[2],
            k: numbers[3],
            g: numbers[4],
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
    /// `m*a*a + I`
    pub M_theta_theta: T,
    /// `k*1/M_theta_theta`
    pub c_rrnp4: T,
    /// `m*a*g`
    pub c_m_a_g: T,
    /// `m*a*g*1/M_theta_theta`
    pub c_y275w: T,
    /// `0.5*M_theta_theta`
    pub c_wa294: T,
    /// `-k`
    pub c_xp5v9: T,
    /// True if all prepared pivots of the mass matrix are positive and finite. If false, the mass matrix is not positive definite and the rates are invalid.
    pub positive_definite: bool,
}
impl<T: Scalar> Coefficients<T> {
    /// Prepares the coefficients of these parameters.
    pub fn prepare(parameters: &Parameters<T>) -> Self {
        let _ = core::hint::black_box(&IDENTITY);
        let s_4h5gw = parameters.k;
        let m = parameters.m;
        let a = parameters.a;
        let I = parameters.I;
        let M_theta_theta = m * (a * a) + I;
        let s_s9xwx = pivot_reciprocal(M_theta_theta);
        let g = parameters.g;
        let s_m_a_g = m * a * g;
        Self {
            M_theta_theta: M_theta_theta,
            c_rrnp4: s_4h5gw * s_s9xwx,
            c_m_a_g: s_m_a_g,
            c_y275w: s_m_a_g * s_s9xwx,
            c_wa294: T::number(0.5) * M_theta_theta,
            c_xp5v9: -s_4h5gw,
            positive_definite: T::all_greater(M_theta_theta, T::number(0.0))
                && T::all_greater(T::number(f64::INFINITY), M_theta_theta),
        }
    }
}
impl Coefficients {
    /// Converts these coefficients to another number type, without derivatives.
    #[inline(always)]
    pub fn cast<T: Scalar>(&self) -> Coefficients<T> {
        Coefficients {
            M_theta_theta: T::number(self.M_theta_theta),
            c_rrnp4: T::number(self.c_rrnp4),
            c_m_a_g: T::number(self.c_m_a_g),
            c_y275w: T::number(self.c_y275w),
            c_wa294: T::number(self.c_wa294),
            c_xp5v9: T::number(self.c_xp5v9),
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
    let theta_dot = state[1];
    let theta = state[0];
    let theta_ddot = coefficients.c_y275w * sin(theta)
        - coefficients.c_rrnp4 * theta_dot;
    for i in 0..1 {
        rates[i] = state[1 + i];
    }
    rates[1] = theta_ddot;
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
/// - `energy`: kinetic plus potential energy \[J]
/// - `power`: power of all non-conservative forces: the rate of the energy \[W]
#[allow(unused_variables)]
pub fn observables<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs,
    coefficients: &Coefficients<T>,
) -> [T; OBSERVABLES] {
    let theta_dot = state[1];
    let theta = state[0];
    let s_theta_dot_theta_dot = theta_dot * theta_dot;
    let T_arm = coefficients.c_wa294 * s_theta_dot_theta_dot;
    let V_gravity = coefficients.c_m_a_g * cos(theta);
    [T_arm + V_gravity, coefficients.c_xp5v9 * s_theta_dot_theta_dot]
}

/// Kinetic plus potential energy, in J.
#[allow(unused_variables)]
pub fn energy<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs,
    coefficients: &Coefficients<T>,
) -> T {
    let theta_dot = state[1];
    let theta = state[0];
    let T_arm = coefficients.c_wa294 * (theta_dot * theta_dot);
    let V_gravity = coefficients.c_m_a_g * cos(theta);
    T_arm + V_gravity
}

/// Power of all non-conservative forces, in W: the rate of the energy.
#[allow(unused_variables)]
pub fn power<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs,
    coefficients: &Coefficients<T>,
) -> T {
    let theta_dot = state[1];
    coefficients.c_xp5v9 * (theta_dot * theta_dot)
}

/// Switching surfaces: the equations change when one of these changes sign.
///
#[allow(unused_variables, unused_mut)]
pub fn guards<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs,
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
    inputs: &Inputs,
    coefficients: &Coefficients<T>,
) -> [[T; DEGREES_OF_FREEDOM]; DEGREES_OF_FREEDOM] {
    let mut values = [[T::number(0.0); DEGREES_OF_FREEDOM]; DEGREES_OF_FREEDOM];
    values[0][0] = coefficients.M_theta_theta;
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

/// 1/pivot for a positive pivot, else NaN: the mass matrix is not positive definite.
#[inline(always)]
fn pivot_reciprocal<T: Scalar>(pivot: T) -> T {
    T::select_greater(pivot, T::number(0.0), T::number(1.0) / pivot, T::number(f64::NAN))
}
