//! Comparison of masses on springs with closed forms: resonance, equal and defective eigenvalues, extreme units, long
//! times.

use eomgen_tests::motions::{Spec, TestMotion, difference, grid};

fn mass(m: f64, k: f64, c: f64, force: &str, start: [f64; 2]) -> Spec {
    let spec = Spec::default()
        .parameter("m", m, "kg")
        .parameter("k", k, "N/m")
        .parameter("c", c, "N s/m")
        .coordinate("x", start)
        .kinetic("1/2*m*dot(x)^2")
        .potential("1/2*k*x^2")
        .force("x", "-c*dot(x)");
    if force.is_empty() {
        spec
    } else {
        spec.force("x", force)
    }
}

/// Compares position and speed with a closed form, relative to the largest value of each.
fn assert_matches_closed_form(
    name: &str,
    spec: &Spec,
    until: f64,
    tolerance: f64,
    closed: impl Fn(f64) -> Vec<f64>,
) {
    let times = grid(until, 97);
    let motion = TestMotion::new(spec.model(), 0).simulate_exactly((0.0, until), &times);
    let wanted: Vec<Vec<f64>> = times.iter().map(|t| closed(*t)).collect();
    let error = difference(&motion.states, &wanted, 0.0);
    println!("{name}: {error:.1e}");
    assert!(error < tolerance, "{name}: {error:e}");
}

/// Returns the undamped response from rest to F sin((w - gap) t), by a closed form that is accurate for small gaps.
fn resonant_response(w: f64, gap: f64, force: f64, t: f64) -> Vec<f64> {
    let omega = w - gap;
    let middle = w - 0.5 * gap;
    let half = 0.5 * gap;
    // sin(gap t/2)/gap.
    let sinc = if half * t == 0.0 {
        0.5 * t
    } else {
        (half * t).sin() / gap
    };
    let x = -2.0 * (middle * t).cos() * sinc + (w * t).sin() / w;
    // omega (cos(omega t) - cos(w t))/gap.
    let v = 2.0 * omega * (middle * t).sin() * sinc;
    let factor = force / (w + omega);
    vec![factor * x, factor * v]
}

#[test]
fn forcing_at_and_near_undamped_resonance_matches_closed_form() {
    for w in [10.0_f64, 7.3, 1234.5] {
        for distance in [0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-4, 0.9e-3, 1.1e-3, 1e-2] {
            let omega = w * (1.0 - distance);
            let spec = mass(1.0, w * w, 0.0, "F*sin(omega*t)", [0.0, 0.0])
                .parameter("F", 3.0, "N")
                .parameter("omega", omega, "rad/s");
            let name = format!("w = {w}, relative distance {distance:e}");
            // The rounding of w^2 and of its root changes the phase by 2 eps w t. The non-resonant part loses at most
            // three digits by cancellation.
            let phase = 200.0 * 4.0 * f64::EPSILON;
            assert_matches_closed_form(&name, &spec, 200.0 / w, phase + 1e3 * f64::EPSILON, |t| {
                resonant_response(w, w - omega, 3.0, t)
            });
        }
    }
}

#[test]
fn forcing_at_zero_and_negative_frequency_matches_closed_form() {
    let (m, k) = (2.0, 50.0);
    let spec = |omega: f64, force: &str| {
        mass(m, k, 0.0, force, [0.0, 0.0])
            .parameter("F", 3.0, "N")
            .parameter("omega", omega, "rad/s")
            .parameter("phi", 0.7, "rad")
    };
    for omega in [0.0, -0.0, 1e-300, 1e-12] {
        assert_matches_closed_form(
            "constant",
            &spec(omega, "F*sin(omega*t + phi)"),
            4.0,
            1e-11,
            |t| {
                let still = 3.0 * 0.7_f64.sin() / k;
                vec![
                    still * (1.0 - (5.0 * t).cos()),
                    still * 5.0 * (5.0 * t).sin(),
                ]
            },
        );
    }
    for omega in [-5.0, -5.0 * (1.0 - 1e-6)] {
        assert_matches_closed_form(
            "backwards",
            &spec(omega, "-F*sin(omega*t) + 0*phi*F"),
            20.0,
            1e-12,
            |t| resonant_response(5.0, 5.0 + omega, 3.0 / m, t),
        );
    }
}

#[test]
fn slow_forcing_of_free_mass_matches_closed_form() {
    for omega in [0.0, 1e-9, 1e-3, 1.0, 1e3] {
        let spec = mass(2.0, 0.0, 0.0, "F*cos(omega*t)", [1.0, -2.0])
            .parameter("F", 3.0, "N")
            .parameter("omega", omega, "rad/s");
        assert_matches_closed_form(&format!("omega = {omega}"), &spec, 50.0, 1e-13, |t| {
            let z: f64 = omega * t;
            let once = if z == 0.0 { 1.0 } else { z.sin() / z };
            let half = if z == 0.0 {
                1.0
            } else {
                (0.5 * z).sin() / (0.5 * z)
            };
            vec![
                1.0 - 2.0 * t + 0.75 * t * t * half * half,
                -2.0 + 1.5 * t * once,
            ]
        });
    }
}

/// Returns the free motion of a damped mass from x0 at rest; zeta may be close to 1.
fn damped_response(w: f64, zeta: f64, x0: f64, t: f64) -> Vec<f64> {
    let s = (zeta * zeta - 1.0) * (w * t) * (w * t);
    // sinh(sqrt(s))/sqrt(s) and cosh(sqrt(s)) are entire functions of s.
    let (sine, cosine) = if s.abs() < 1e-4 {
        (
            1.0 + s / 6.0 + s * s / 120.0,
            1.0 + s / 2.0 + s * s / 24.0 + s * s * s / 720.0,
        )
    } else if s > 0.0 {
        (s.sqrt().sinh() / s.sqrt(), s.sqrt().cosh())
    } else {
        ((-s).sqrt().sin() / (-s).sqrt(), (-s).sqrt().cos())
    };
    let decay = x0 * (-zeta * w * t).exp();
    vec![
        decay * (cosine + zeta * w * t * sine),
        -decay * w * w * t * sine,
    ]
}

#[test]
fn damping_at_and_near_critical_matches_closed_form() {
    let w = 10.0;
    for distance in [0.0, 1e-15, -1e-12, 1e-9, -1e-6, 1e-4, -1e-3, 1e-2] {
        let zeta = 1.0 + distance;
        let spec = mass(1.0, w * w, 2.0 * zeta * w, "", [0.3, 0.0]);
        assert_matches_closed_form(
            &format!("zeta = 1 + {distance:e}"),
            &spec,
            3.0,
            1e-12,
            |t| damped_response(w, zeta, 0.3, t),
        );
    }
}

#[test]
fn equal_oscillators_match_closed_form() {
    // Two equal oscillators, separate and joined by a spring, and a chain of three.
    for k_c in [0.0, 1e-9, 1e-6, 1e-3, 1.0] {
        let spec = Spec::default()
            .parameter("m", 2.0, "kg")
            .parameter("k", 50.0, "N/m")
            .parameter("k_c", k_c, "N/m")
            .coordinate("x", [0.3, 0.0])
            .coordinate("y", [0.0, 1.0])
            .kinetic("1/2*m*dot(x)^2 + 1/2*m*dot(y)^2")
            .potential("1/2*k*(x^2 + y^2) + 1/2*k_c*(x - y)^2");
        let (w1, w2) = (5.0_f64, ((50.0 + 2.0 * k_c) / 2.0_f64).sqrt());
        assert_matches_closed_form(&format!("joined by {k_c:e} N/m"), &spec, 30.0, 2e-12, |t| {
            let part = |w: f64, x: f64, v: f64| {
                [
                    x * (w * t).cos() + v / w * (w * t).sin(),
                    v * (w * t).cos() - x * w * (w * t).sin(),
                ]
            };
            let (a, d) = (part(w1, 0.15, 0.5), part(w2, 0.15, -0.5));
            vec![a[0] + d[0], a[0] - d[0], a[1] + d[1], a[1] - d[1]]
        });
    }
}

#[test]
fn defective_eigenvalues_in_resonance_match_closed_form() {
    // Two critically damped oscillators; the first drives the second. The eigenvalue has multiplicity four.
    let spec = |coupling: f64| {
        Spec::default()
            .parameter("m", 1.0, "kg")
            .parameter("k", 100.0, "N/m")
            .parameter("c", 20.0, "N s/m")
            .parameter("g", coupling, "N/m")
            .parameter("F", 1.0, "N")
            .parameter("omega", 10.0, "rad/s")
            .coordinate("x", [0.1, 0.0])
            .coordinate("y", [0.0, 0.0])
            .kinetic("1/2*m*(dot(x)^2 + dot(y)^2)")
            .potential("1/2*k*(x^2 + y^2)")
            .force("x", "-c*dot(x) + F*sin(omega*t)")
            .force("y", "-c*dot(y) + g*x")
    };
    for coupling in [0.0, 1.0, 100.0] {
        let subject = TestMotion::new(spec(coupling).model(), 0);
        let times = grid(2.0, 40);
        let exact = subject.simulate_exactly((0.0, 2.0), &times);
        let general = subject
            .simulate_generally((0.0, 2.0), &times, 1e-13)
            .expect("a motion");
        let found = difference(&exact.states, &general.states, 1e-6);
        println!("one way by {coupling}: {found:.1e}");
        assert!(found < 1e-11, "{found:e}");
    }
}

#[test]
fn tiny_and_huge_units_match_closed_form() {
    for m in [1e-12, 1e-6, 1.0, 1e6, 1e12] {
        for w in [1e-4_f64, 1.0, 1e4] {
            for x0 in [1e-12, 1.0, 1e12] {
                let spec = mass(m, m * w * w, 0.0, "", [x0, 0.0]);
                assert_matches_closed_form(
                    &format!("m = {m:e}, w = {w:e}, x = {x0:e}"),
                    &spec,
                    20.0 / w,
                    1e-13,
                    |t| vec![x0 * (w * t).cos(), -x0 * w * (w * t).sin()],
                );
            }
        }
    }
}

#[test]
fn frequencies_decades_apart_match_closed_form() {
    // Frequencies twelve decades apart are decoupled.
    for ratio in [1e3, 1e4, 0.99e5, 1.01e5, 1e6, 1e8, 1e12_f64] {
        let spec = Spec::default()
            .parameter("m", 1.0, "kg")
            .parameter("k", 1.0, "N/m")
            .parameter("stiff", ratio * ratio, "N/m")
            .coordinate("x", [1.0, 0.0])
            .coordinate("y", [0.0, 1.0])
            .kinetic("1/2*m*(dot(x)^2 + dot(y)^2)")
            .potential("1/2*k*x^2 + 1/2*stiff*y^2");
        let until = (1e6 / ratio).min(20.0);
        assert_matches_closed_form(
            &format!("ratio {ratio:e}"),
            &spec,
            until,
            50.0 * f64::EPSILON * (ratio * until).max(1.0),
            |t| {
                let z = ratio * t;
                vec![t.cos(), z.sin() / ratio, -t.sin(), z.cos()]
            },
        );
    }
}

#[test]
fn long_motion_without_switch_matches_closed_form() {
    // The transient has decayed, so only the phase of the steady response is tested.
    let (w, zeta, omega): (f64, f64, f64) = (100.0, 0.05, 31.0);
    let spec = mass(1.0, w * w, 2.0 * zeta * w, "F*sin(omega*t)", [1.0, 0.0])
        .parameter("F", 3.0, "N")
        .parameter("omega", omega, "rad/s");
    let subject = TestMotion::new(spec.model(), 0);
    let times = [9.9e5, 1e6 - 0.01, 1e6];
    let motion = subject.simulate_exactly((0.0, 1e6), &times);
    // A step covers 25 periods of the forcing.
    assert!(motion.statistics.steps < 400_000, "{:?}", motion.statistics);
    for (t, state) in times.iter().zip(&motion.states) {
        let (a, b) = (w * w - omega * omega, 2.0 * zeta * w * omega);
        let (sine, cosine) = (omega * t).sin_cos();
        let x = 3.0 * (a * sine - b * cosine) / (a * a + b * b);
        // The bound allows for the rounding of the closed form's phase of 3.1e7 rad.
        assert!(
            (state[0] - x).abs() < 3e-4 * 3.1e7 * f64::EPSILON,
            "{} {x}",
            state[0]
        );
    }
    let free = TestMotion::new(mass(1.0, 0.0, 0.0, "", [1.0, 2.0]).model(), 0);
    let motion = free.simulate_exactly((0.0, 1e4), &[1e4]);
    assert!((motion.states[0][0] / 20001.0 - 1.0).abs() < 1e-11);
}
