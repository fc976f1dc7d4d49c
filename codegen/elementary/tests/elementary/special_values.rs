//! Zeros, infinities, NaN and the ends of domains, as tables.

use crate::piecewise_cases::{DEFLECTION_CASES, ONE_NUMBER_CASES};
use eomgen_elementary::Function::{self, *};
use eomgen_elementary::{Operation, Single};

const INF: f64 = f64::INFINITY;
const NAN: f64 = f64::NAN;
const PI: f64 = std::f64::consts::PI;
const HALF_PI: f64 = std::f64::consts::FRAC_PI_2;
const QUARTER_PI: f64 = std::f64::consts::FRAC_PI_4;
const SMALLEST: f64 = f64::from_bits(1);

/// Asserts that the result is bit-identical to the expected value; any NaN equals any other NaN.
#[track_caller]
fn assert_value(function: Function, arguments: &[f64], expected: f64) {
    let value = function.apply(arguments);
    let same = value.to_bits() == expected.to_bits() || (value.is_nan() && expected.is_nan());
    let name = function.name();
    assert!(same, "{name}{arguments:?} is {value:e}, not {expected:e}");
}

#[track_caller]
fn assert_table(table: &[(Function, f64, f64)]) {
    for &(function, x, expected) in table {
        assert_value(function, &[x], expected);
    }
}

#[test]
fn odd_functions_keep_zeros_and_subnormals() {
    for function in [Sin, Tan, Asin, Atan, Sinh, Tanh, ExpMinusOne] {
        for x in [0.0, -0.0, SMALLEST, -SMALLEST, 1e-300, -1e-300] {
            assert_value(function, &[x], x);
        }
    }
    for function in [Cos, Cosh, Exp] {
        for x in [0.0, -0.0, SMALLEST, -SMALLEST] {
            assert_value(function, &[x], 1.0);
        }
    }
}

#[test]
fn every_function_of_nan_but_indicators_is_nan() {
    let indicators = [Contact, Above];
    for function in Function::ALL {
        if indicators.contains(&function) {
            continue;
        }
        assert_value(function, &[NAN, NAN], NAN);
        if function.arity() == 2 && ![Pow, Deadzone].contains(&function) {
            assert_value(function, &[NAN, 1.0], NAN);
            assert_value(function, &[1.0, NAN], NAN);
            assert_value(function, &[NAN, 0.0], NAN);
            assert_value(function, &[0.0, NAN], NAN);
            assert_value(function, &[NAN, INF], NAN);
        }
    }
}

#[test]
fn angles_beyond_the_largest_are_nan() {
    let beyond = eomgen_elementary::LARGEST_ANGLE.next_up();
    for function in [Sin, Cos, Tan] {
        for x in [beyond, -beyond, 1e15, 1e300, f64::MAX, INF, -INF] {
            assert_value(function, &[x], NAN);
        }
        assert!(!function.apply(&[eomgen_elementary::LARGEST_ANGLE]).is_nan());
        assert!(
            !function
                .apply(&[-eomgen_elementary::LARGEST_ANGLE])
                .is_nan()
        );
    }
}

#[test]
fn exponentials_and_logarithms_at_the_edges() {
    assert_table(&[
        (Exp, INF, INF),
        (Exp, -INF, 0.0),
        (Exp, f64::MAX, INF),
        (Exp, f64::MIN, 0.0),
        (Exp, 709.782_712_893_384_1, INF),
        (Exp, -745.133_219_101_941_2, 0.0),
        (Exp, -745.133_219_101_941, SMALLEST),
        (ExpMinusOne, INF, INF),
        (ExpMinusOne, -INF, -1.0),
        (ExpMinusOne, -50.0, -1.0),
        (Ln, 1.0, 0.0),
        (Ln, 0.0, -INF),
        (Ln, -0.0, -INF),
        (Ln, INF, INF),
        (Ln, -INF, NAN),
        (Ln, -1.0, NAN),
        (Ln, -SMALLEST, NAN),
        (Sinh, INF, INF),
        (Sinh, -INF, -INF),
        (Sinh, 710.475_860_073_944, INF),
        (Cosh, INF, INF),
        (Cosh, -INF, INF),
        (Cosh, 710.475_860_073_944, INF),
        (Tanh, INF, 1.0),
        (Tanh, -INF, -1.0),
        (Tanh, 30.0, 1.0),
    ]);
}

#[test]
fn roots_and_arcs_at_the_edges() {
    assert_table(&[
        (Sqrt, 0.0, 0.0),
        (Sqrt, -0.0, -0.0),
        (Sqrt, INF, INF),
        (Sqrt, -INF, NAN),
        (Sqrt, -SMALLEST, NAN),
        (Sqrt, 4.0, 2.0),
        (Asin, 1.0, HALF_PI),
        (Asin, -1.0, -HALF_PI),
        (Asin, 1.0_f64.next_up(), NAN),
        (Asin, -INF, NAN),
        (Acos, 1.0, 0.0),
        (Acos, -1.0, PI),
        (Acos, 0.0, HALF_PI),
        (Acos, -0.0, HALF_PI),
        (Acos, -1.0_f64.next_up(), NAN),
        (Acos, INF, NAN),
        (Acos, -INF, NAN),
        (Atan, INF, HALF_PI),
        (Atan, -INF, -HALF_PI),
        (Atan, f64::MAX, HALF_PI),
        (Atan, 1.0, QUARTER_PI),
    ]);
}

#[test]
fn angles_of_points_on_axes_and_at_infinity() {
    for (y, x, expected) in [
        (0.0, 1.0, 0.0),
        (0.0, 0.0, 0.0),
        (0.0, -0.0, PI),
        (0.0, -1.0, PI),
        (0.0, INF, 0.0),
        (0.0, -INF, PI),
        (1.0, 0.0, HALF_PI),
        (1.0, -0.0, HALF_PI),
        (1.0, INF, 0.0),
        (1.0, -INF, PI),
        (1.0, 1.0, QUARTER_PI),
        (1.0, -1.0, 3.0 * QUARTER_PI),
        (INF, 1.0, HALF_PI),
        (INF, -1.0, HALF_PI),
        (INF, INF, QUARTER_PI),
        (INF, -INF, 3.0 * QUARTER_PI),
        (SMALLEST, SMALLEST, QUARTER_PI),
        (SMALLEST, -SMALLEST, 3.0 * QUARTER_PI),
        (SMALLEST, 1.0, SMALLEST),
        (SMALLEST, f64::MAX, 0.0),
        (f64::MAX, SMALLEST, HALF_PI),
        (f64::MAX, f64::MAX, QUARTER_PI),
    ] {
        assert_value(Atan2, &[y, x], expected);
        assert_value(Atan2, &[-y, x], -expected);
    }
}

#[test]
fn powers_of_special_arguments() {
    for (x, y, expected) in [
        (NAN, 0.0, 1.0),
        (NAN, -0.0, 1.0),
        (1.0, NAN, 1.0),
        (NAN, 1.0, NAN),
        (2.0, NAN, NAN),
        (-2.0, NAN, NAN),
        (0.0, NAN, NAN),
        (0.0, 0.0, 1.0),
        (INF, 0.0, 1.0),
        (1.0, INF, 1.0),
        (-1.0, INF, 1.0),
        (-1.0, -INF, 1.0),
        (0.0, 3.0, 0.0),
        (-0.0, 3.0, -0.0),
        (-0.0, 2.0, 0.0),
        (-0.0, 0.5, 0.0),
        (0.0, -3.0, INF),
        (-0.0, -3.0, -INF),
        (-0.0, -2.0, INF),
        (-0.0, -0.5, INF),
        (0.0, INF, 0.0),
        (0.0, -INF, INF),
        (0.5, INF, 0.0),
        (0.5, -INF, INF),
        (1.5, INF, INF),
        (-1.5, INF, INF),
        (1.5, -INF, 0.0),
        (INF, 0.1, INF),
        (INF, -0.1, 0.0),
        (INF, INF, INF),
        (-INF, 3.0, -INF),
        (-INF, 2.0, INF),
        (-INF, 0.5, INF),
        (-INF, -3.0, -0.0),
        (-INF, -2.0, 0.0),
        (-8.0, 1.0 / 3.0, NAN),
        (-2.0, 3.0, -8.0),
        (-2.0, 2.0, 4.0),
        (-1.0, 9_007_199_254_740_991.0, -1.0),
        (-1.0, 9_007_199_254_740_992.0, 1.0),
        (-1.0, 4_503_599_627_370_497.0, -1.0),
        (-1.0, 4_503_599_627_370_495.5, NAN),
        (1.0_f64.next_up(), f64::MAX, INF),
        (1.0_f64.next_down(), f64::MAX, 0.0),
        (SMALLEST, f64::MAX, 0.0),
        (f64::MAX, f64::MAX, INF),
        (f64::MAX, SMALLEST, 1.0),
        (2.0, 1024.0, INF),
        (2.0, -1074.0, SMALLEST),
        (2.0, -1076.0, 0.0),
    ] {
        assert_value(Pow, &[x, y], expected);
    }
}

#[test]
fn sign_magnitude_minimum_and_maximum() {
    assert_table(&[
        (Abs, -0.0, 0.0),
        (Abs, -INF, INF),
        (Abs, -2.5, 2.5),
        (Sign, 0.0, 0.0),
        (Sign, -0.0, -0.0),
        (Sign, SMALLEST, 1.0),
        (Sign, -INF, -1.0),
    ]);
    for (a, b, least, greatest) in [
        (1.0, 2.0, 1.0, 2.0),
        (2.0, 1.0, 1.0, 2.0),
        (-INF, INF, -INF, INF),
        (0.0, -0.0, 0.0, 0.0),
        (-0.0, 0.0, -0.0, -0.0),
    ] {
        assert_value(Min, &[a, b], least);
        assert_value(Max, &[a, b], greatest);
    }
}

#[test]
fn piecewise_functions_have_one_value_in_both_formats() {
    let check = |function: Function, arguments: &[f64], expected: f64| {
        assert_value(function, arguments, expected);
        let narrow: Vec<f32> = arguments.iter().map(|number| *number as f32).collect();
        let value = f64::from(function.apply(&narrow));
        let same = value.to_bits() == expected.to_bits() || value.is_nan() && expected.is_nan();
        assert!(
            same,
            "{function:?}{narrow:?} is {value:e}, not {expected:e}"
        );
    };
    for [p, b, deadzone, contact] in DEFLECTION_CASES {
        check(Deadzone, &[p, b], deadzone);
        check(Contact, &[p, b], contact);
    }
    for [p, above, reciprocal] in ONE_NUMBER_CASES {
        check(Above, &[p], above);
        check(PivotReciprocal, &[p], reciprocal);
    }
}

/// Emitted code contains one generic definition of these functions for all number types.
#[test]
fn kernels_of_generic_functions_are_equal_in_both_formats() {
    for function in Function::ALL.into_iter().filter(|f| f.is_generic()) {
        let kernel = function.kernel();
        assert_eq!(
            format!("{kernel:?}"),
            format!("{:?}", function.kernel_in::<Single>())
        );
        for operation in kernel.operations {
            use Operation as O;
            let generic = matches!(
                operation,
                O::Input(_)
                    | O::Constant(_)
                    | O::Add(..)
                    | O::Sub(..)
                    | O::Mul(..)
                    | O::Div(..)
                    | O::Neg(_)
                    | O::SelectLess { .. }
            );
            assert!(generic, "{function:?}: {operation:?}");
        }
    }
}

#[test]
fn missing_argument_is_nan() {
    assert_value(Sin, &[], NAN);
    assert_value(Atan2, &[1.0], NAN);
    assert!(Sin.kernel().evaluate::<f64>(&[])[0].is_nan());
}

#[test]
fn quantised_numbers_are_nearest_multiples() {
    let quantise = |x: f64, step: f64| Function::Quantise.apply(&[x, step]);
    let found = [-0.75, -0.25, -0.2, 0.2, 0.25, 0.75, 1.3].map(|x| quantise(x, 0.5));
    assert_eq!(found, [-1.0, -0.5, -0.0, 0.0, 0.5, 1.0, 1.5]);
    assert_eq!(quantise(0.7, -0.5), 0.5);
    assert!(quantise(1.0, 0.0).is_nan() && quantise(0.0, 0.0).is_nan());
    // The standard library also rounds halves away from zero.
    let below_half = 0.5_f64.next_down();
    let mut numbers = vec![
        below_half,
        1.5,
        2.5,
        1e15 + 0.5,
        2.0_f64.powi(51) - 0.5,
        1e300,
    ];
    numbers.extend((0..2000_i32).map(|k| f64::from(k - 1000) * 0.37));
    for x in numbers {
        assert_eq!(quantise(x, 1.0), x.round(), "{x:?}");
    }
}
