//! Accuracy of all functions in single precision, compared with double precision, whose error is below 1e-8
//! units in the last place of single precision; native values compared with kernels.

use crate::oracle::{Random, sample};
use eomgen_elementary::{
    Function, LARGEST_SINGLE_ANGLE, Single, cos, sin, sin_cos, sin_cos_kernel,
};
use std::f64::consts::FRAC_PI_2;

/// Difference of two consecutive sampled bit patterns, a prime. The tests sample about 270 000 arguments, of both
/// signs.
const STRIDE: usize = 15_991;

/// Largest argument of sine, cosine and tangent with an error of at most two units.
const ACCURATE_ANGLE: f32 = 1e5;

/// Returns numbers of both signs from zero to infinity. Consecutive bit patterns differ by `stride`.
fn numbers(stride: usize) -> impl Iterator<Item = f32> {
    let patterns = (0..=f32::INFINITY.to_bits()).step_by(stride);
    patterns.flat_map(|bits| [f32::from_bits(bits), -f32::from_bits(bits)])
}

/// Returns `|result - expected|` in units in the last place of a single-precision number of `expected`'s
/// magnitude, the subnormal spacing below the normal range. An infinite result counts as 2^128.
fn ulps(result: f32, expected: f64) -> f64 {
    if result.is_nan() || expected.is_nan() {
        return if result.is_nan() && expected.is_nan() {
            0.0
        } else {
            f64::INFINITY
        };
    }
    let bounded = |x: f64| x.clamp(-(2f64.powi(128)), 2f64.powi(128));
    let magnitude = expected
        .abs()
        .clamp(f64::from(f32::MIN_POSITIVE), 2f64.powi(127));
    let last_place = 2f64.powi(((magnitude.to_bits() >> 52) as i32 - 1023) - 23);
    (bounded(f64::from(result)) - bounded(expected)).abs() / last_place
}

/// Asserts that the largest error of a function over the arguments is at most `bound`.
#[track_caller]
fn assert_within<const N: usize>(
    function: Function,
    bound: f64,
    arguments: impl Iterator<Item = [f32; N]>,
) {
    let (mut worst, mut at, mut count) = (-1.0, [f32::NAN; N], 0_u64);
    for x in arguments {
        let error = ulps(function.apply(&x), function.apply(&x.map(f64::from)));
        count += 1;
        if error > worst {
            (worst, at) = (error, x);
        }
    }
    println!(
        "{}: {count} arguments, at most {worst:.4} ulp, at {at:?}",
        function.name()
    );
    assert!(count > 0, "no arguments");
    assert!(worst <= bound, "{}: {worst} ulp at {at:?}", function.name());
}

/// Functions of one number other than those of angles, with the bounds of the crate's table.
const BOUNDS: [(Function, f64); 12] = [
    (Function::Abs, 0.0),
    (Function::Sign, 0.0),
    (Function::Sqrt, 0.5),
    (Function::Exp, 0.63),
    (Function::ExpMinusOne, 0.88),
    (Function::Ln, 0.75),
    (Function::Sinh, 0.87),
    (Function::Cosh, 0.89),
    (Function::Tanh, 0.73),
    (Function::Asin, 0.59),
    (Function::Acos, 0.55),
    (Function::Atan, 0.70),
];

/// Functions of angles, with their bounds up to 1e5.
const ANGLE_BOUNDS: [(Function, f64); 3] = [
    (Function::Sin, 1.72),
    (Function::Cos, 1.77),
    (Function::Tan, 0.80),
];

fn is_accurate_angle(x: &f32) -> bool {
    x.abs() <= ACCURATE_ANGLE
}

/// Returns the numbers next to every multiple of pi/2 up to 1e5.
fn near_multiples_of_half_pi() -> impl Iterator<Item = f32> {
    let nearest = (1..=63_662).map(|k| (f64::from(k) * FRAC_PI_2) as f32);
    nearest
        .flat_map(|x| [x.next_down(), x, x.next_up()])
        .filter(is_accurate_angle)
}

#[test]
fn functions_of_one_number_are_accurate() {
    for (function, bound) in BOUNDS {
        assert_within(function, bound, numbers(STRIDE).map(|x| [x]));
    }
}

#[test]
fn functions_of_angles_are_accurate() {
    for (function, bound) in ANGLE_BOUNDS {
        let angles = numbers(STRIDE).filter(is_accurate_angle);
        assert_within(function, bound, angles.map(|x| [x]));
        let usual = sample(|random| random.uniform(-10.0, 10.0) as f32);
        assert_within(function, bound, usual.into_iter().map(|x| [x]));
        assert_within(function, bound, near_multiples_of_half_pi().map(|x| [x]));
    }
}

#[test]
fn large_angles_are_accurate_to_their_spacing_and_nan_beyond() {
    let mut worst = 0.0_f64;
    for x in numbers(997).filter(|x| x.abs() > ACCURATE_ANGLE && x.abs() <= LARGEST_SINGLE_ANGLE) {
        let spacing = f64::from(x.abs().next_up() - x.abs());
        let (sine, cosine) = sin_cos(f64::from(x));
        for (found, expected) in [(sin(x), sine), (cos(x), cosine)] {
            worst = worst.max((f64::from(found) - expected).abs() / spacing);
        }
    }
    println!("at most {worst:.4} times the distance of neighbouring angles");
    assert!(worst > 0.0 && worst <= 1.0, "{worst}");
    for x in [
        LARGEST_SINGLE_ANGLE.next_up(),
        1e9,
        f32::MAX,
        f32::INFINITY,
        f32::NAN,
    ] {
        for function in [Function::Sin, Function::Cos, Function::Tan] {
            assert!(
                function.apply(&[x]).is_nan() && function.apply(&[-x]).is_nan(),
                "{x}"
            );
        }
    }
}

#[test]
fn functions_of_two_numbers_are_accurate() {
    let any = |random: &mut Random| f32::from_bits(random.bits() as u32);
    let usual = |random: &mut Random| random.magnitude(-12, 10) as f32;
    let mut pairs = Vec::new();
    for _ in 0..40 {
        pairs.extend(sample(|random| [any(random), any(random)]));
    }
    let mut random = Random(2);
    for _ in 0..100_000 {
        pairs.push([any(&mut random), any(&mut random)]);
        pairs.push([usual(&mut random), usual(&mut random)]);
    }
    for (function, bound) in [
        (Function::Min, 0.0),
        (Function::Max, 0.0),
        (Function::Atan2, 1.45),
        (Function::Pow, 0.73),
    ] {
        assert_within(function, bound, pairs.iter().copied());
    }
}

/// Special values agree with those of double precision, signs of zeros included.
#[test]
fn special_values_match_double_precision() {
    let specials = [0.0, 0.5, 1.0, 2.0, 3.0, f32::INFINITY, f32::NAN].map(|x| [x, -x]);
    for function in Function::ALL {
        for &x in specials.as_flattened() {
            for &y in specials.as_flattened() {
                let found: f32 = function.apply(&[x, y]);
                let expected = function.apply(&[x, y].map(f64::from)) as f32;
                let same = found.is_nan() && expected.is_nan()
                    || ulps(found, f64::from(expected)) <= 2.0
                        && found.is_sign_negative() == expected.is_sign_negative();
                assert!(
                    same,
                    "{}({x}, {y}): {found}, not {expected}",
                    function.name()
                );
            }
        }
    }
}

#[test]
fn kernels_match_native_bits() {
    for function in Function::ALL {
        let kernel = function.kernel_in::<Single>();
        let mut random = Random(function as u64);
        for _ in 0..2000 {
            let any = [random.bits() as u32, random.bits() as u32].map(f32::from_bits);
            let usual = [random.magnitude(-12, 10), random.magnitude(-12, 10)].map(|x| x as f32);
            for arguments in [any, usual] {
                let arguments = &arguments[..function.arity()];
                let (native, traced) = (function.apply(arguments), kernel.evaluate(arguments)[0]);
                assert!(
                    native.to_bits() == traced.to_bits() || (native.is_nan() && traced.is_nan()),
                    "{}{arguments:?}: natively {native:e}, by its kernel {traced:e}",
                    function.name()
                );
            }
        }
    }
}

#[test]
fn joint_sine_and_cosine_are_bit_identical() {
    let both = sin_cos_kernel::<Single>();
    for x in numbers(STRIDE).filter(|x| x.abs() <= LARGEST_SINGLE_ANGLE) {
        let bits = [sin(x), cos(x)].map(f32::to_bits);
        assert_eq!([sin_cos(x).0, sin_cos(x).1].map(f32::to_bits), bits);
        assert_eq!(
            both.evaluate(&[x])
                .iter()
                .map(|x| x.to_bits())
                .collect::<Vec<_>>(),
            bits
        );
    }
}

/// Constants of the kernels are numbers of the format, so that each language reads the same bits.
#[test]
fn constants_are_single_precision() {
    for function in Function::ALL {
        for operation in function.kernel_in::<Single>().operations {
            if let eomgen_elementary::Operation::Constant(value) = operation {
                assert!(
                    value.is_nan() || f64::from(value as f32) == value,
                    "{value}"
                );
            }
        }
    }
}

// If a number changes, every program that calls the function changes. Such a change must be intended.
#[test]
fn operation_counts_are_as_documented() {
    let counted: Vec<(&str, usize)> = Function::ALL
        .iter()
        .map(|function| {
            (
                function.name(),
                function.kernel_in::<Single>().operation_count(),
            )
        })
        .collect();
    let documented = [
        ("abs", 1),
        ("sign", 2),
        ("min", 2),
        ("max", 2),
        ("sqrt", 76),
        ("exp", 39),
        ("exp_minus_one", 45),
        ("ln", 33),
        ("sinh", 70),
        ("cosh", 42),
        ("tanh", 82),
        ("sin", 46),
        ("cos", 46),
        ("tan", 90),
        ("asin", 93),
        ("acos", 97),
        ("atan", 49),
        ("atan2", 64),
        ("pow", 206),
        ("quantise", 10),
        ("deadzone", 4),
        ("contact", 3),
        ("above", 1),
        ("pivot_reciprocal", 2),
    ];
    assert_eq!(counted, documented);
    assert_eq!(sin_cos_kernel::<Single>().operation_count(), 49);
}

/// Tests all numbers: `cargo test --release -p eomgen-elementary single -- --ignored`, about twenty minutes.
#[test]
#[ignore = "takes minutes"]
fn all_numbers_are_accurate() {
    for (function, bound) in BOUNDS {
        assert_within(function, bound, numbers(1).map(|x| [x]));
    }
    for (function, bound) in ANGLE_BOUNDS {
        assert_within(
            function,
            bound,
            numbers(1).filter(is_accurate_angle).map(|x| [x]),
        );
    }
}
