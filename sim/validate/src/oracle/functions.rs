//! Functions of the expression language for all number types of automatic differentiation. A piecewise function is
//! evaluated on the side of the real part, with the derivative of that side. The derivative of a step is 0, and sign(0)
//! = 0.

use super::switches::Side;
use eomgen_model_spec::model::Function;
use num_dual::DualNum;

/// Returns the value of a function; NaN if an argument is missing, which a checked model excludes.
pub(super) fn evaluate_function<N>(function: Function, arguments: &[N]) -> N
where
    N: DualNum<Primitive = f64> + Copy,
{
    match arguments {
        [argument] => unary(function, *argument),
        [first, second] => binary(function, *first, *second),
        _ => N::from(f64::NAN),
    }
}

/// Returns a piecewise function on a given side of its switch; `None` for a smooth one.
pub(super) fn evaluate_on_side<N>(function: Function, side: Side, arguments: &[N]) -> Option<N>
where
    N: DualNum<Primitive = f64> + Copy,
{
    let sign = side.sign();
    Some(match (function, arguments) {
        (Function::Abs, [x]) => *x * sign,
        (Function::Sign, [_]) => N::from(sign),
        (Function::Deadzone, [p, b]) => (*p - *b * sign) * sign.abs(),
        (Function::Contact, [_, _]) => N::from(sign.abs()),
        (Function::Above, [_]) => N::from(sign.max(0.0)),
        (Function::Min, [x, y]) => *(if sign < 0.0 { x } else { y }),
        (Function::Max, [x, y]) => *(if sign > 0.0 { x } else { y }),
        _ => return None,
    })
}

fn unary<N>(function: Function, x: N) -> N
where
    N: DualNum<Primitive = f64> + Copy,
{
    match function {
        Function::Sin => x.sin(),
        Function::Cos => x.cos(),
        Function::Tan => x.tan(),
        Function::Asin => x.asin(),
        Function::Acos => x.acos(),
        Function::Atan => x.atan(),
        Function::Sinh => x.sinh(),
        Function::Cosh => x.cosh(),
        Function::Tanh => tanh(x),
        Function::Exp => x.exp(),
        Function::Ln => x.ln(),
        Function::Sqrt => x.sqrt(),
        Function::Abs => x * sign(x.re()),
        Function::Sign => N::from(sign(x.re())),
        Function::Above => N::from(if x.re() > 0.0 { 1.0 } else { 0.0 }),
        Function::Atan2
        | Function::Min
        | Function::Max
        | Function::Deadzone
        | Function::Contact => N::from(f64::NAN),
    }
}

fn binary<N>(function: Function, x: N, y: N) -> N
where
    N: DualNum<Primitive = f64> + Copy,
{
    match function {
        Function::Atan2 => x.atan2(y),
        Function::Min => {
            if x.re() < y.re() {
                x
            } else {
                y
            }
        }
        Function::Max => {
            if x.re() > y.re() {
                x
            } else {
                y
            }
        }
        Function::Deadzone => deadzone(x, y),
        Function::Contact => N::from(if x.re().abs() > y.re() { 1.0 } else { 0.0 }),
        _ => N::from(f64::NAN),
    }
}

/// f_k of Eq. (7) of the paper.
fn deadzone<N>(p: N, b: N) -> N
where
    N: DualNum<Primitive = f64> + Copy,
{
    if p.re() > b.re() {
        p - b
    } else if p.re() < -b.re() {
        p + b
    } else {
        N::from(0.0)
    }
}

/// Returns -1, 0 or 1; NaN for NaN.
pub(super) fn sign(x: f64) -> f64 {
    if x > 0.0 {
        1.0
    } else if x < 0.0 {
        -1.0
    } else {
        x * 0.0
    }
}

/// Returns `base` to a constant power. Integer exponents avoid the logarithm and allow any base.
pub(super) fn constant_power<N>(base: N, exponent: f64) -> N
where
    N: DualNum<Primitive = f64> + Copy,
{
    if exponent.fract() == 0.0 && exponent.abs() <= 64.0 {
        base.powi(exponent as i32)
    } else {
        base.powf(exponent)
    }
}

/// Returns the hyperbolic tangent as sinh/cosh. For large arguments, at which cosh would overflow, it returns the limit
/// with derivative 0. The derivative (cosh^2 - sinh^2)/cosh^2 cancels as 1 - tanh^2 does, and its magnitude includes
/// this cancellation.
fn tanh<N>(x: N) -> N
where
    N: DualNum<Primitive = f64> + Copy,
{
    const TANH_SATURATION: f64 = 60.0;
    if x.re().abs() > TANH_SATURATION {
        N::from(sign(x.re()))
    } else {
        x.tanh()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_dual::{Dual64, HyperDual64};

    /// The oracle relies on the derivatives of num-dual, so central differences check every function.
    #[test]
    fn derivatives_match_central_differences() {
        let smooth = [
            Function::Sin,
            Function::Cos,
            Function::Tan,
            Function::Asin,
            Function::Acos,
            Function::Atan,
            Function::Sinh,
            Function::Cosh,
            Function::Tanh,
            Function::Exp,
            Function::Ln,
            Function::Sqrt,
            Function::Abs,
        ];
        let step = 1e-5;
        for function in smooth {
            let at = |x: f64| unary(function, Dual64::new(x, 1.0));
            let second = unary(function, HyperDual64::new(0.4, 1.0, 1.0, 0.0));
            let first = (at(0.4 + step).re - at(0.4 - step).re) / (2.0 * step);
            let curvature = (at(0.4 + step).eps - at(0.4 - step).eps) / (2.0 * step);
            assert!((first - second.eps1).abs() < 1e-8, "{function:?}");
            assert!((curvature - second.eps1eps2).abs() < 1e-8, "{function:?}");
        }
    }

    #[test]
    fn atan2_is_correct_in_every_quadrant() {
        for angle in [-3.0, -2.0, -0.5, 0.3, 1.2, 2.8] {
            let turning = Dual64::new(angle, 1.0);
            let found = binary(Function::Atan2, turning.sin() * 2.0, turning.cos() * 2.0);
            assert!((found.re - angle).abs() < 1e-15);
            assert!((found.eps - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn piecewise_functions_use_derivative_of_their_side() {
        let p = |x| Dual64::new(x, 1.0);
        let b = Dual64::new(0.5, 0.0);
        let pair = |function, x| {
            let found: Dual64 = binary(function, p(x), b);
            (found.re, found.eps)
        };
        assert_eq!(pair(Function::Deadzone, 0.75), (0.25, 1.0));
        assert_eq!(pair(Function::Deadzone, -0.75), (-0.25, 1.0));
        assert_eq!(pair(Function::Deadzone, 0.5), (0.0, 0.0));
        assert_eq!(pair(Function::Contact, 0.75), (1.0, 0.0));
        assert_eq!(pair(Function::Contact, 0.5), (0.0, 0.0));
        assert_eq!(pair(Function::Min, 0.25), (0.25, 1.0));
        assert_eq!(pair(Function::Max, 0.25), (0.5, 0.0));
        assert_eq!(unary(Function::Sign, p(0.0)).re, 0.0);
        assert_eq!(unary(Function::Above, p(0.0)).re, 0.0);
        assert_eq!(unary(Function::Above, p(0.5)).re, 1.0);
        assert_eq!(unary(Function::Abs, p(-2.0)).eps, -1.0);
    }

    #[test]
    fn integer_powers_allow_nonpositive_bases() {
        let cube = constant_power(HyperDual64::new(0.0, 1.0, 1.0, 0.0), 3.0);
        assert_eq!((cube.eps1, cube.eps1eps2), (0.0, 0.0));
        let square = constant_power(HyperDual64::new(-3.0, 1.0, 1.0, 0.0), 2.0);
        assert_eq!((square.re, square.eps1, square.eps1eps2), (9.0, -6.0, 2.0));
    }
}
