//! Functions of the expression language, and their values in double precision.

/// Functions of the expression language.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Function {
    /// Sine of an angle.
    Sin,
    /// Cosine of an angle.
    Cos,
    /// Tangent of an angle.
    Tan,
    /// Inverse sine.
    Asin,
    /// Inverse cosine.
    Acos,
    /// Inverse tangent.
    Atan,
    /// `atan2(y, x)`, the angle of the point (x, y); both arguments in one unit.
    Atan2,
    /// Hyperbolic sine.
    Sinh,
    /// Hyperbolic cosine.
    Cosh,
    /// Hyperbolic tangent.
    Tanh,
    /// Exponential function.
    Exp,
    /// Natural logarithm.
    Ln,
    /// Square root.
    Sqrt,
    /// Absolute value; switching surface at 0.
    Abs,
    /// Sign, with sign(0) = 0; switching surface at 0.
    Sign,
    /// Smaller of two values; switching surface where both are equal.
    Min,
    /// Larger of two values; switching surface where both are equal.
    Max,
    /// `deadzone(p, b)`: p - b above the play, p + b below it, else 0; f_k of Eq. (7) of the paper.
    Deadzone,
    /// `contact(p, b)`: 1 if |p| > b, else 0; Eq. (8) of the paper, without the rate.
    Contact,
    /// `above(p)`, 1 if p > 0, else 0.
    Above,
}

/// Evaluates a function of `x`, or of `x` and `second`.
pub fn call(function: Function, x: f64, second: f64) -> f64 {
    match function {
        Function::Sin => x.sin(),
        Function::Cos => x.cos(),
        Function::Tan => x.tan(),
        Function::Asin => x.asin(),
        Function::Acos => x.acos(),
        Function::Atan => x.atan(),
        Function::Atan2 => x.atan2(second),
        Function::Sinh => x.sinh(),
        Function::Cosh => x.cosh(),
        Function::Tanh => x.tanh(),
        Function::Exp => x.exp(),
        Function::Ln => x.ln(),
        Function::Sqrt => x.sqrt(),
        Function::Abs => x.abs(),
        Function::Sign if x > 0.0 => 1.0,
        Function::Sign if x < 0.0 => -1.0,
        Function::Sign => x * 0.0,
        Function::Min => x.min(second),
        Function::Max => x.max(second),
        // Eq. (7) of the paper: 0 within the play, else the distance from its edge.
        Function::Deadzone if x > second => x - second,
        Function::Deadzone if x < -second => x + second,
        Function::Deadzone => (x + second) * 0.0,
        Function::Contact if x.abs() > second => 1.0,
        Function::Contact => (x + second) * 0.0,
        Function::Above if x > 0.0 => 1.0,
        Function::Above => x * 0.0,
    }
}
