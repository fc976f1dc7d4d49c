//! Random expressions: their values, derivatives (as forces of a potential) and rates along the motion after the
//! whole derivation are compared with dual numbers applied to the original tree.
//!
//! Simplification of the graph regroups operations, so the results differ because of rounding. For the tolerance, every
//! intermediate result of the reference is perturbed randomly by 1e-10, relative. Rounding perturbs by 1e-16, so a
//! thousandth of the resulting spread leaves a margin of 1e3.

use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::RngSeed;

use crate::support::{accelerations, evaluator, model, observables};
use crate::trees::{COORDINATES, PARAMETERS, Tree, trees};

/// Value with its derivatives with respect to x, y and z.
#[derive(Clone, Copy, Debug)]
struct Dual {
    value: f64,
    slopes: [f64; 3],
}

impl Dual {
    fn constant(value: f64) -> Self {
        Self {
            value,
            slopes: [0.0; 3],
        }
    }

    /// Applies a function with this value and slope; an infinite or undefined slope gives NaN.
    fn chain(self, value: f64, slope: f64) -> Self {
        let times = |own: f64| {
            if slope.is_finite() {
                slope * own
            } else {
                f64::NAN
            }
        };
        Self {
            value,
            slopes: self.slopes.map(times),
        }
    }

    fn with(self, other: Self, value: f64, by: [f64; 2]) -> Self {
        let (first, second) = (self.chain(0.0, by[0]), other.chain(0.0, by[1]));
        let slopes = std::array::from_fn(|k| first.slopes[k] + second.slopes[k]);
        Self { value, slopes }
    }
}

/// Evaluator of trees that perturbs every result by a relative amount of up to `size`.
struct Reference {
    state: [f64; 3],
    size: f64,
    seed: u64,
}

impl Reference {
    fn random(&mut self) -> f64 {
        self.seed = self
            .seed
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// Perturbs a result. Results above 1e9, for which sine and cosine are undefined, become NaN.
    fn perturb(&mut self, dual: Dual) -> Dual {
        let mut disturb = |value: f64| value * (1.0 + self.size * self.random());
        let value = if dual.value.abs() < 1e9 {
            dual.value
        } else {
            f64::NAN
        };
        Dual {
            value: disturb(value),
            slopes: dual.slopes.map(&mut disturb),
        }
    }

    fn of(&mut self, tree: &Tree) -> Dual {
        let exact = match tree {
            Tree::Coordinate(index) => {
                let mut slopes = [0.0; 3];
                slopes[*index] = 1.0;
                return Dual {
                    value: self.state[*index],
                    slopes,
                };
            }
            Tree::Parameter(index) => return Dual::constant(PARAMETERS[*index].1),
            Tree::Number(value) => return Dual::constant(*value),
            Tree::Unary(function, a) => {
                let a = self.of(a);
                self.unary(function, a)
            }
            Tree::Binary(function, a, b) => {
                let (a, b) = (self.of(a), self.of(b));
                self.binary(function, a, b)
            }
            Tree::Integer(a, n) => {
                let mut a = self.of(a);
                if *n < 0 {
                    a = a.chain(2.0 + a.value.cos(), -a.value.sin());
                    a = self.perturb(a);
                }
                let slope = if *n == 0 {
                    0.0
                } else {
                    f64::from(*n) * a.value.powi(n - 1)
                };
                a.chain(a.value.powi(*n), slope)
            }
            Tree::Power(a, e) => {
                let (a, e) = (self.of(a), self.of(e));
                let base = a.chain(1.0 + a.value * a.value, 2.0 * a.value);
                let base = self.perturb(base);
                let value = base.value.powf(e.value);
                let by_base = e.value * base.value.powf(e.value - 1.0);
                base.with(e, value, [by_base, value * base.value.ln()])
            }
        };
        self.perturb(exact)
    }

    fn unary(&mut self, function: &str, a: Dual) -> Dual {
        let u = a.value;
        let side = sign(u);
        match function {
            "-" => a.chain(-u, -1.0),
            "sin" => a.chain(u.sin(), u.cos()),
            "cos" => a.chain(u.cos(), -u.sin()),
            "tan" => a.chain(u.tan(), 1.0 + u.tan().powi(2)),
            "asin" | "acos" => {
                let inner = a.chain(u / (2.0 + u.abs()), 2.0 / (2.0 + u.abs()).powi(2));
                let inner = self.perturb(inner);
                let (v, slope) = (inner.value, 1.0 / (1.0 - inner.value * inner.value).sqrt());
                if function == "asin" {
                    inner.chain(v.asin(), slope)
                } else {
                    inner.chain(v.acos(), -slope)
                }
            }
            "atan" => a.chain(u.atan(), 1.0 / (1.0 + u * u)),
            "sinh" => a.chain(u.sinh(), u.cosh()),
            "cosh" => a.chain(u.cosh(), u.sinh()),
            "tanh" => a.chain(u.tanh(), 1.0 - u.tanh().powi(2)),
            "exp" => a.chain(u.exp(), u.exp()),
            "ln" => a.chain((1.0 + u * u).ln(), 2.0 * u / (1.0 + u * u)),
            "sqrt" => a.chain((1.0 + u * u).sqrt(), u / (1.0 + u * u).sqrt()),
            "abs" => a.chain(u.abs(), side),
            "above" => a.chain(f64::from(u8::from(u > 0.0)), 0.0),
            _ => a.chain(side, 0.0),
        }
    }

    fn binary(&mut self, function: &str, a: Dual, b: Dual) -> Dual {
        let (u, v) = (a.value, b.value);
        if u.is_nan() || v.is_nan() {
            return Dual::constant(f64::NAN);
        }
        match function {
            "+" => a.with(b, u + v, [1.0, 1.0]),
            "-" => a.with(b, u - v, [1.0, -1.0]),
            "*" => a.with(b, u * v, [v, u]),
            "/" => {
                let divisor = b.chain(2.0 + v.sin(), v.cos());
                let divisor = self.perturb(divisor);
                let d = divisor.value;
                a.with(divisor, u / d, [1.0 / d, -u / (d * d)])
            }
            "min" => {
                if u < v {
                    a
                } else {
                    b
                }
            }
            "max" => {
                if u > v {
                    a
                } else {
                    b
                }
            }
            // On the branch cut the result depends on the sign of a zero, which a simplification can change.
            "atan2" if u == 0.0 && v <= 0.0 => Dual::constant(f64::NAN),
            "atan2" => {
                let radius = u * u + v * v;
                a.with(b, u.atan2(v), [v / radius, -u / radius])
            }
            "deadzone" if u.abs() > v.abs() => {
                let side = u.signum();
                a.with(b, u - side * v.abs(), [1.0, -side * sign(v)])
            }
            "contact" if u.abs() > v.abs() => Dual::constant(1.0),
            _ => Dual::constant(0.0),
        }
    }
}

/// Returns the sign, with sign(0) = 0.
fn sign(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x.signum() }
}

fn spec(expression: &str) -> String {
    format!(
        r#"
[model]
name = "random"
title = "A random potential"

[parameters]
m = {{ value = 1, unit = "kg m^2" }}
V = {{ value = 1, unit = "J" }}
a = {{ value = 1.7, unit = "1" }}
b = {{ value = -0.6, unit = "1" }}

[coordinates]
x = {{ unit = "1" }}
y = {{ unit = "1" }}
z = {{ unit = "1" }}

[definitions]
random = "{expression}"

[kinetic]
all = "1/2*m*(dot(x)^2 + dot(y)^2 + dot(z)^2)"

[potential]
all = "V*random"

[observables]
value = {{ value = "random + 0*a*b", unit = "1" }}
rate  = {{ value = "dot(random)", unit = "1/s" }}
"#
    )
}

/// Returns the reference and its tolerances; `None` for huge or undefined results.
fn expected(tree: &Tree, state: [f64; 3]) -> Option<(Dual, [f64; 4])> {
    let at = |size: f64, seed: u64| Reference { state, size, seed }.of(tree);
    let numbers = |dual: Dual| [dual.value, dual.slopes[0], dual.slopes[1], dual.slopes[2]];
    let reference = at(0.0, 0);
    let mut spread = [0.0_f64; 4];
    for seed in 0..8_u64 {
        let perturb = numbers(at(1e-10, seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 77));
        for (k, value) in numbers(reference).into_iter().enumerate() {
            spread[k] = spread[k].max((perturb[k] - value).abs());
        }
        if !numbers(reference)
            .iter()
            .chain(&perturb)
            .all(|value| value.abs() < 1e12)
        {
            return None;
        }
    }
    Some((reference, spread.map(|spread| 1e-3 * spread + 1e-15)))
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 2000,
        rng_seed: RngSeed::Fixed(7),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn values_slopes_and_rates_match_the_tree(
        tree in trees(),
        state in prop::array::uniform3(prop_oneof![8 => -2.0..2.0_f64, 1 => Just(0.0), 1 => Just(1.0)]),
        rates in prop::array::uniform3(-1.0..1.0_f64),
    ) {
        let Some((reference, allowed)) = expected(&tree, state) else { return Ok(()) };
        let mut text = String::new();
        tree.write(&mut text);
        let mut evaluator = match eomgen_model_spec::check(eomgen_model_spec::source::Source::new("r", spec(&text))) {
            Ok(checked) => evaluator(&checked.model, 0),
            // The model is rejected if constants divide by zero or overflow.
            Err(_) => return Ok(()),
        };
        let all: Vec<f64> = state.into_iter().chain(rates).collect();
        let values = observables(&mut evaluator, 0.0, &all);
        let forces = accelerations(&mut evaluator, &all);
        prop_assert!((values[0] - reference.value).abs() <= allowed[0], "{} not {} of {text}", values[0], reference.value);
        for k in 0..3 {
            let slope = reference.slopes[k];
            prop_assert!((forces[k] + slope).abs() <= allowed[1 + k], "-{} not {slope} by {} of {text}", forces[k], COORDINATES[k]);
        }
        let rate: f64 = (0..3).map(|k| reference.slopes[k] * rates[k]).sum();
        let allowed: f64 = allowed[1..].iter().sum();
        prop_assert!((values[1] - rate).abs() <= allowed, "{} not {rate} of {text}", values[1]);
    }
}

// The test is useful only if most random expressions can be compared.
#[test]
fn most_random_expressions_are_compared() {
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let compared = (0..200)
        .filter(|_| {
            let tree = trees().new_tree(&mut runner).unwrap().current();
            expected(&tree, [0.3, -0.8, 1.2])
                .is_some_and(|(_, allowed)| allowed.iter().all(|a| *a < 1e-6))
        })
        .count();
    assert!(compared > 150, "{compared} of 200");
}

// Zero times the infinite slope of the unused branch would be NaN.
#[test]
fn unused_branch_does_not_affect_the_slope() {
    for choice in ["min(x, exp(700 + 10*x^2))", "-max(-x, -exp(700 + 10*x^2))"] {
        let mut evaluator = evaluator(&model(&spec(choice)), 0);
        let force = accelerations(&mut evaluator, &[3.0, 0.0, 0.0, 0.0, 0.0, 0.0])[0];
        assert_eq!(force, -1.0, "{choice}");
    }
}

// Exponents are not combined if their product is huge. An exponent that overflowed gave 1 in an earlier version.
#[test]
fn nested_powers_do_not_overflow() {
    let nested = (0..7).fold("x".to_owned(), |inner, _| format!("({inner})^64"));
    let mut evaluator = evaluator(&model(&spec(&nested)), 0);
    for (x, power) in [(1.0, 1.0), (0.5, 0.0), (2.0, f64::INFINITY), (-1.0, 1.0)] {
        assert_eq!(
            observables(&mut evaluator, 0.0, &[x, 0.0, 0.0, 0.0, 0.0, 0.0])[0],
            power
        );
    }
    let near = observables(&mut evaluator, 0.0, &[1.0 + 1e-12, 0.0, 0.0, 0.0, 0.0, 0.0])[0];
    // (1 + 1e-12)^(64^7) = exp(4.398), the base being rounded to 1e-4 of its distance from 1.
    assert!(
        (near.ln() - 64_f64.powi(7) * (1.0 + 1e-12_f64).ln()).abs() < 1e-3,
        "{near}"
    );
}
