//! Tests of `--measure lyapunov`: comparison with the closed form of a linear oscillator and with two motions of a
//! nonlinear oscillator, combination with `poincare`, and rejected options.

use eomgen_tests::models::path;
use eomgen_tests::program::run_accepted;

use super::sweep_folder::{SweepFolder, accept, column, expect_rejection, table};

#[test]
fn exponent_of_linear_oscillator_is_minus_damping() {
    let place = SweepFolder::new();
    let axes = ["--vary", "c=400:1000:3", "--vary", "omega=1:3:2"];
    let more = [
        "--measure",
        "lyapunov",
        "--transient",
        "20",
        "--periods",
        "400",
    ];
    accept(&place.sweep("map", &[&axes[..], &more[..]].concat()));
    let found = table(&place.path_to("map"));
    let (c, omega) = (column(&found, "c"), column(&found, "omega"));
    for point in 0..6 {
        // Every tangent vector decays as exp(-c t/(2 m)) and rotates.
        let expected = -c[point] / 1000.0 / 2.0;
        let lambda = column(&found, "lambda_1")[point];
        // The length of a rotating vector varies by a factor below 2.2, the ratio of the ellipse's axes. The mean over
        // 400 periods divides the logarithm of this factor by their duration.
        let bound = 2.2_f64.ln() / (400.0 * std::f64::consts::TAU / omega[point]);
        assert!((lambda - expected).abs() < bound, "{point}: {lambda}");
        assert!(column(&found, "lambda_1_se")[point] < bound * 10.0);
        assert_eq!(column(&found, "switch_rate")[point], 0.0);
        assert_eq!(column(&found, "lyapunov_status")[point], 0.0);
        assert_eq!(column(&found, "poincare_status")[point], 0.0);
    }
}

#[test]
fn arm_with_backlash_is_chaotic() {
    let place = SweepFolder::new();
    let (arm, out) = (
        path("planetary_arm").display().to_string(),
        place.path_to("arm"),
    );
    let axis = ["--vary", "b_sp,b_pr=0:100e-6:2", "--set", "omega=60"];
    let span = ["--transient", "20", "--periods", "40", "--order", "4"];
    let what = ["sweep", &arm, "--measure", "lyapunov,poincare", "--out"];
    let out_text = out.display().to_string();
    run_accepted(&[&what[..], &[&*out_text], &axis, &span].concat());
    let found = table(&out);
    let (lambda, error) = (column(&found, "lambda_1"), column(&found, "lambda_1_se"));
    assert!(lambda[1] > 2.0 + 2.0 * error[1], "{lambda:?} {error:?}");
    assert!(lambda[0] < 2.0 * error[0], "{lambda:?} {error:?}");
    let rate = column(&found, "switch_rate");
    assert!(rate[1] > 100.0 && rate[0] < rate[1], "{rate:?}");
}

#[test]
fn invalid_uses_of_exponents_are_rejected() {
    let place = SweepFolder::new();
    let vary = ["--vary", "c=400:1000:3"];
    let few = ["--measure", "lyapunov", "--periods", "19"];
    let message = expect_rejection(&place.sweep("never", &[&vary[..], &few[..]].concat()));
    assert!(message.contains("at least 20 --periods"), "{message}");
    let pendulum = path("pendulum").display().to_string();
    let out = place.path_to("never").display().to_string();
    let given = ["sweep", &pendulum, "--vary", "m=1:2:3", "--out", &out];
    let given = given.iter().chain(&["--measure", "lyapunov"]);
    let message = expect_rejection(&given.map(|part| (*part).to_owned()).collect::<Vec<_>>());
    assert!(message.contains("or give --until"), "{message}");
    let sleigh = path("chaplygin_sleigh").display().to_string();
    let given = ["sweep", &sleigh, "--vary", "m=1:2:3", "--out", &out];
    let given = given
        .iter()
        .chain(&["--measure", "lyapunov", "--until", "5"]);
    let message = expect_rejection(&given.map(|part| (*part).to_owned()).collect::<Vec<_>>());
    assert!(message.contains("has constraints (`edge`)"), "{message}");
    assert!(!place.path_to("never").exists());
}

/// x'' + delta x' - x + x^3 = F cos(omega t) with unit parameters.
const DUFFING: &str = r#"
[model]
name = "duffing"
[parameters]
m     = { value = 1,    unit = "kg" }
delta = { value = 0.25, unit = "N s/m" }
k     = { value = 1,    unit = "N/m" }
k_3   = { value = 1,    unit = "N/m^3" }
F     = { value = 0.4,  unit = "N" }
omega = { value = 1,    unit = "rad/s" }
[coordinates]
x = { unit = "m", initial = 0.1 }
[kinetic]
mass = "1/2*m*dot(x)^2"
[potential]
wells = "1/4*k_3*x^4 - 1/2*k*x^2"
[dissipation]
damper = "1/2*delta*dot(x)^2"
[forces]
drive = { on = "x", value = "F*cos(omega*t)" }
"#;

/// Returns the growth rate of the distance of two close motions of Duffing's oscillator, rescaled
/// after every period (Benettin), with classical Runge-Kutta steps.
fn growth_of_a_distance(force: f64, transient: usize, periods: usize) -> f64 {
    const STEPS: usize = 400;
    const CLOSE: f64 = 1e-7;
    let rates = |t: f64, [x, v]: [f64; 2]| [v, x - x * x * x - 0.25 * v + force * t.cos()];
    let h = std::f64::consts::TAU / STEPS as f64;
    let step = |t: f64, y: [f64; 2]| {
        let moved = |k: [f64; 2], part: f64| [y[0] + part * k[0], y[1] + part * k[1]];
        let first = rates(t, y);
        let second = rates(t + 0.5 * h, moved(first, 0.5 * h));
        let third = rates(t + 0.5 * h, moved(second, 0.5 * h));
        let last = rates(t + h, moved(third, h));
        [0, 1].map(|k| y[k] + h / 6.0 * (first[k] + 2.0 * (second[k] + third[k]) + last[k]))
    };
    let (mut y, mut near, mut sum) = ([0.1, 0.0], [0.1 + CLOSE, 0.0], 0.0);
    for period in 0..transient + periods {
        for part in 0..STEPS {
            let t = (period * STEPS + part) as f64 * h;
            (y, near) = (step(t, y), step(t, near));
        }
        let apart = [near[0] - y[0], near[1] - y[1]];
        let distance = apart[0].hypot(apart[1]);
        if period >= transient {
            sum += (distance / CLOSE).ln();
        }
        near = [0, 1].map(|k| y[k] + apart[k] * CLOSE / distance);
    }
    sum / (periods as f64 * std::f64::consts::TAU)
}

#[test]
fn exponent_of_duffing_oscillator_matches_two_motions() {
    let place = SweepFolder::new();
    std::fs::write(place.path_to("duffing.toml"), DUFFING).expect("a specification");
    let (spec, out) = (place.path_to("duffing.toml"), place.path_to("duffing"));
    let (spec, out_text) = (spec.display().to_string(), out.display().to_string());
    let what = ["sweep", &spec, "--measure", "lyapunov", "--out", &out_text];
    let span = [
        "--vary",
        "F=0.2:0.4:2",
        "--transient",
        "50",
        "--periods",
        "300",
    ];
    run_accepted(&[&what[..], &span].concat());
    let found = table(&out);
    let (lambda, error) = (column(&found, "lambda_1"), column(&found, "lambda_1_se"));
    // The motion is periodic in one potential well, and the tangent vector rotates and decays as exp(-delta t/2).
    assert!((lambda[0] + 0.125).abs() < 5e-3, "{lambda:?}");
    let expected = growth_of_a_distance(0.4, 50, 300);
    assert!(expected > 0.05, "chaotic: {expected}");
    let bound = 4.0 * error[1];
    assert!(
        (lambda[1] - expected).abs() < bound,
        "{lambda:?} {error:?}, {expected}"
    );
}

/// Without forcing, the second half of the time span is measured.
#[test]
fn exponent_of_pendulum_at_rest_is_minus_damping() {
    let place = SweepFolder::new();
    let text = DUFFING
        .replace("1/4*k_3*x^4 - 1/2*k*x^2", "1/4*k_3*x^4 + 1/2*k*x^2")
        .replace("value = 0.4,", "value = 0,");
    std::fs::write(place.path_to("quiet.toml"), text).expect("a specification");
    let (spec, out) = (place.path_to("quiet.toml"), place.path_to("quiet"));
    let (spec, out_text) = (spec.display().to_string(), out.display().to_string());
    let what = ["sweep", &spec, "--measure", "lyapunov", "--out", &out_text];
    run_accepted(&[&what[..], &["--vary", "delta=0.1:0.3:2", "--until", "400"]].concat());
    let found = table(&out);
    let lambda = column(&found, "lambda_1");
    for (lambda, delta) in lambda.iter().zip([0.1, 0.3]) {
        assert!((lambda + delta / 2.0).abs() < 5e-3, "{lambda} of {delta}");
    }
}
