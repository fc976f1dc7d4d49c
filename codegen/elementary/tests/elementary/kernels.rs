//! Kernels: values bit-identical to native values, structure, and number of operations.

use crate::hard_cases::near_multiples_of_half_pi;
use crate::oracle::Random;
use eomgen_elementary::{Double, Function, Kernel, sin_cos_kernel};
use std::collections::HashSet;

/// Returns zeros, ones, ends of every function's domain, infinities and NaN, with both signs.
fn special_arguments() -> Vec<f64> {
    let magnitudes = [
        0.0,
        f64::from_bits(1),
        f64::MIN_POSITIVE,
        f64::MIN_POSITIVE.next_down(),
        1e-300,
        1e-9,
        0.406_25,
        0.5,
        0.6875,
        std::f64::consts::FRAC_PI_4,
        1.0_f64.next_down(),
        1.0,
        1.0_f64.next_up(),
        std::f64::consts::SQRT_2,
        std::f64::consts::FRAC_PI_2,
        2.0,
        3.0,
        22.0,
        40.0,
        709.782_712_893_384,
        710.475_860_073_943_9,
        710.5,
        745.2,
        1024.0,
        1e9,
        1e9_f64.next_up(),
        4_503_599_627_370_496.0,
        9_007_199_254_740_993.0,
        1e300,
        f64::MAX,
        f64::INFINITY,
        f64::NAN,
    ];
    magnitudes.iter().flat_map(|&x| [x, -x]).collect()
}

#[track_caller]
fn assert_same_bits(function: Function, kernel: &Kernel, arguments: &[f64]) {
    let native = function.apply(arguments);
    let &[traced] = kernel.evaluate(arguments).as_slice() else {
        panic!("{} has one output", function.name());
    };
    assert!(
        native.to_bits() == traced.to_bits() || (native.is_nan() && traced.is_nan()),
        "{}{arguments:?}: natively {native:e}, by its kernel {traced:e}",
        function.name()
    );
}

#[test]
fn kernels_match_native_bits_at_special_arguments() {
    let specials = special_arguments();
    for function in Function::ALL {
        let kernel = function.kernel();
        for &x in &specials {
            if function.arity() == 1 {
                assert_same_bits(function, &kernel, &[x]);
            } else {
                for &y in &specials {
                    assert_same_bits(function, &kernel, &[x, y]);
                }
            }
        }
    }
}

#[test]
fn kernels_match_native_bits_at_random_arguments() {
    for function in Function::ALL {
        let kernel = function.kernel();
        let mut random = Random(function as u64);
        for _ in 0..1000 {
            let any = [f64::from_bits(random.bits()), f64::from_bits(random.bits())];
            let usual = [random.magnitude(-12, 10), random.magnitude(-12, 10)];
            for arguments in [any, usual] {
                assert_same_bits(function, &kernel, &arguments[..function.arity()]);
            }
        }
    }
    let sine = Function::Sin.kernel();
    for x in near_multiples_of_half_pi() {
        assert_same_bits(Function::Sin, &sine, &[x]);
    }
}

#[test]
fn sine_and_cosine_share_one_kernel() {
    let both = sin_cos_kernel::<Double>();
    let mut random = Random(5);
    for _ in 0..1000 {
        let x = random.magnitude(-30, 29);
        let values = both.evaluate(&[x]);
        let expected = [Function::Sin.apply(&[x]), Function::Cos.apply(&[x])];
        assert_eq!(values.len(), 2);
        for (value, expected) in values.iter().zip(expected) {
            assert!(value.to_bits() == expected.to_bits() || (value.is_nan() && expected.is_nan()));
        }
    }
}

#[test]
fn kernels_have_no_repeated_or_unused_operations() {
    let kernels = Function::ALL.map(Function::kernel);
    for kernel in kernels.iter().chain([&sin_cos_kernel::<Double>()]) {
        let mut used: HashSet<usize> = kernel.outputs.iter().copied().collect();
        let mut seen = HashSet::new();
        for (index, operation) in kernel.operations.iter().enumerate() {
            assert!(
                seen.insert(format!("{operation:?}")),
                "{operation:?} repeats"
            );
            operation.map_operands(|operand| {
                assert!(operand < index, "{operation:?} refers forward");
                used.insert(operand);
                operand
            });
        }
        assert_eq!(
            used.len(),
            kernel.operations.len(),
            "an operation without use"
        );
    }
}

#[test]
fn tracing_is_reproducible() {
    for function in Function::ALL {
        assert_eq!(
            format!("{:?}", function.kernel()),
            format!("{:?}", function.kernel())
        );
    }
}

// If a number changes, every program that calls the function changes. Such a change must be intended.
#[test]
fn operation_counts_are_as_documented() {
    let counted: Vec<(&str, usize)> = Function::ALL
        .iter()
        .map(|function| (function.name(), function.kernel().operation_count()))
        .collect();
    let documented = [
        ("abs", 1),
        ("sign", 2),
        ("min", 2),
        ("max", 2),
        ("sqrt", 84),
        ("exp", 50),
        ("exp_minus_one", 56),
        ("ln", 42),
        ("sinh", 81),
        ("cosh", 53),
        ("tanh", 93),
        ("sin", 67),
        ("cos", 68),
        ("tan", 103),
        ("asin", 116),
        ("acos", 120),
        ("atan", 62),
        ("atan2", 77),
        ("pow", 228),
        ("quantise", 10),
        ("deadzone", 4),
        ("contact", 3),
        ("above", 1),
        ("pivot_reciprocal", 2),
    ];
    assert_eq!(counted, documented);
    assert_eq!(sin_cos_kernel::<Double>().operation_count(), 71);
}
