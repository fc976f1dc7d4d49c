//! Integrands that need quadrature at run time or during preparation, compared with a composite rule over shapes that
//! `at` evaluates.

use crate::support::{evaluator, model, observables};

/// Returns a model with the observable `found`, and deflections and slopes at the points of the rule.
fn spec(integrand: &str) -> String {
    let samples: String = (0..=POINTS)
        .map(|k| {
            format!(
                "w_at_{k} = {{ value = \"at(w, a + (l - a)*{k}/{POINTS})\", unit = \"m\" }}\n\
                 d_at_{k} = {{ value = \"at(diff(w, x, 1), a + (l - a)*{k}/{POINTS})\", unit = \"1\" }}\n"
            )
        })
        .collect();
    format!(
        r#"
[model]
name = "weights"
title = "A beam that starts at a"

[parameters]
mu = {{ value = 2.0, unit = "kg/m" }}
a  = {{ value = 0.3, unit = "m" }}
l  = {{ value = 1.1, unit = "m" }}

[fields.w]
along = "x"
from = "a"
to = "l"
basis = "clamped_free"
coordinates = "q"
order = 2
unit = "m"

[kinetic]
beam = "1/2*integral(mu*dot(w)^2, w)"

[observables]
found = {{ value = "integral({integrand}, w)", unit = "1" }}
{samples}"#
    )
}

const POINTS: usize = 400;
const A: f64 = 0.3;
const L: f64 = 1.1;

fn check(integrand: &str, function: impl Fn(f64, f64, f64) -> f64) {
    let model = model(&spec(integrand));
    let mut evaluator = evaluator(&model, 3);
    let values = observables(&mut evaluator, 0.0, &[0.11, -0.05, 0.02, 0.0, 0.0, 0.0]);
    let h = (L - A) / POINTS as f64;
    let mut expected = 0.0;
    for k in 0..=POINTS {
        let weight = if k == 0 || k == POINTS {
            1.0
        } else if k % 2 == 1 {
            4.0
        } else {
            2.0
        };
        let (w, slope) = (values[1 + 2 * k], values[2 + 2 * k]);
        expected += weight * h / 3.0 * function(A + h * k as f64, w, slope);
    }
    // Simpson's rule with 400 intervals for three modes: (8/400)^4/180 = 1e-9; x^9, 3e-9.
    let found = values[0];
    assert!(
        (found - expected).abs() < 1e-8 * expected.abs().max(1e-3),
        "{integrand}: {found} {expected}"
    );
}

#[test]
fn integrands_of_every_form_match_composite_rule() {
    check("w/l^2", |_, w, _| w / L.powi(2));
    check("x/l^2", |x, _, _| x / L.powi(2));
    check("x^2*w/l^4", |x, w, _| x * x * w / L.powi(4));
    check("w^2*(l + a)/l^4", |_, w, _| w * w * (L + A) / L.powi(4));
    check("x*w*diff(w, x, 1)/l^3", |x, w, d| x * w * d / L.powi(3));
    check("w^3/l^4", |_, w, _| (w / L).powi(3) / L);
    check("w^4*x/l^6", |x, w, _| w.powi(4) * x / L.powi(6));
    check("(w/l)^2*diff(w, x, 1)^2/l", |_, w, d| {
        (w / L * d).powi(2) / L
    });
    check("exp(-x/l)*w^2/l^3", |x, w, _| {
        (-x / L).exp() * w * w / L.powi(3)
    });
    check("sin(w/l)/l", |_, w, _| (w / L).sin() / L);
    check("sqrt(1 + diff(w, x, 1)^2)/l", |_, _, d| {
        (1.0 + d * d).sqrt() / L
    });
    check("w/(l + x)^2", |x, w, _| w / (L + x).powi(2));
    check("w^2/((l + w)*l^2)", |_, w, _| w * w / ((L + w) * L * L));
    check("(x/l)^2.5/l", |x, _, _| (x / L).powf(2.5) / L);
    check("2^(x/l)*w/l^2", |x, w, _| 2_f64.powf(x / L) * w / L.powi(2));
    check("atan2(w, x)/l", |x, w, _| w.atan2(x) / L);
    check("(x/l)^9*w/l^2", |x, w, _| (x / L).powi(9) * w / L.powi(2));
    check("1/l", |_, _, _| 1.0 / L);
}

// The power is too high for a table of moments; the reference is the closed form.
#[test]
fn high_powers_of_the_position_match_closed_form() {
    let model = model(&spec("(x/l)^40/l"));
    let found = observables(&mut evaluator(&model, 3), 0.0, &[0.0; 6])[0];
    let expected = (1.0 - (A / L).powi(41)) / 41.0;
    assert!((found / expected - 1.0).abs() < 1e-13, "{found} {expected}");
}

// Factors that are constant along the field can be any expression, also as a divisor in `at`.
#[test]
fn at_divides_by_constant_sums() {
    let text = spec("1/l").replace(
        "at(w, a + (l - a)*7/400)",
        "at(2*w/(1 + (l + a)/(a + l)), a + (l - a)*7/400)",
    );
    let plain = observables(
        &mut evaluator(&model(&spec("1/l")), 3),
        0.0,
        &[0.1, 0.2, 0.3, 0.0, 0.0, 0.0],
    );
    let divided = observables(
        &mut evaluator(&model(&text), 3),
        0.0,
        &[0.1, 0.2, 0.3, 0.0, 0.0, 0.0],
    );
    assert!(
        (divided[15] / plain[15] - 1.0).abs() < 1e-14,
        "{} {}",
        divided[15],
        plain[15]
    );
}
