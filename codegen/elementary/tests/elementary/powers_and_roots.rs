//! Accuracy of powers and the square root.

use crate::hard_cases::roots_near_a_tie;
use crate::oracle::{Random, assert_pairs_within, sample};
use eomgen_elementary::{pow, sqrt};

/// Returns a base and an exponent whose power can underflow, be finite, or overflow.
fn with_any_power(random: &mut Random, basis: f64) -> (f64, f64) {
    let logarithm = random.uniform(-745.1, 709.78);
    (basis, logarithm / basis.ln())
}

#[test]
fn power_is_accurate() {
    let mut arguments = sample(|random| (random.uniform(0.01, 10.0), random.uniform(-9.0, 9.0)));
    arguments.extend(sample(|random| {
        let basis = random.magnitude(-1022, 1023).abs();
        with_any_power(random, basis)
    }));
    arguments.extend(sample(|random| {
        let basis = 1.0 + random.magnitude(-52, -2);
        with_any_power(random, basis)
    }));
    arguments.extend(sample(|random| {
        let basis = random.magnitude(-1074, -1020).abs();
        (basis, random.uniform(-0.95, 1.0))
    }));
    arguments.extend(sample(|random| {
        let basis = random.uniform(1.5, 30.0);
        (basis, random.uniform(705.0, 709.78) / basis.ln())
    }));
    arguments.retain(|(x, y)| *x > 0.0 && *x != 1.0 && y.is_finite());
    assert_pairs_within(0.76, arguments, pow, |x, y| x.powf(y));
}

#[test]
fn powers_representable_as_doubles_are_exact() {
    for x in sample(|random| random.magnitude(-500, 500)) {
        assert_eq!(pow(x, 1.0), x);
        assert_eq!(pow(x.abs(), -0.0), 1.0);
        let short = (x.abs() as f32) as f64;
        if short.is_normal() {
            assert_eq!(pow(-short, 2.0), short * short);
        }
    }
    for k in -1074..1024 {
        let expected = 2f64.powi(k / 2) * 2f64.powi(k - k / 2);
        assert_eq!(pow(2.0, f64::from(k)), expected, "2^{k}");
    }
    for (x, y, expected) in [
        (3.0, 20.0, 3_486_784_401.0),
        (10.0, 15.0, 1e15),
        (7.0, 3.0, 343.0),
    ] {
        assert_eq!(pow(x, y), expected);
        assert_eq!(
            pow(-x, y),
            if y % 2.0 == 0.0 { expected } else { -expected }
        );
    }
}

// IEEE 754 requires a correctly rounded square root of the standard library, so the results must be equal.
#[test]
fn square_root_is_correctly_rounded() {
    let mut random = Random(3);
    for _ in 0..200_000 {
        let x = random.magnitude(-1074, 1023).abs();
        assert_eq!(sqrt(x).to_bits(), x.sqrt().to_bits(), "sqrt {x:e}");
    }
    for bits in 0..2000 {
        for near in [1.0_f64, 2.0, 4.0] {
            let x = f64::from_bits(near.to_bits() - 1000 + bits);
            assert_eq!(sqrt(x).to_bits(), x.sqrt().to_bits(), "sqrt {x:e}");
        }
    }
}

#[test]
fn square_roots_near_a_tie_are_correctly_rounded() {
    let arguments = roots_near_a_tie();
    assert!(arguments.len() > 50, "only {}", arguments.len());
    for x in arguments {
        assert!((1.0..4.0).contains(&x));
        for x in [x, x * 2f64.powi(600), x * 2f64.powi(-1000)] {
            assert_eq!(sqrt(x).to_bits(), x.sqrt().to_bits(), "sqrt {x:e}");
        }
    }
}
