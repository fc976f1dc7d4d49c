//! `--measure lyapunov` against the closed form of a linear oscillator, and beside
//! `poincare`; where it is refused.

use eomgen_tests::models::path;
use eomgen_tests::program::accepted;

use crate::place::{Place, accept, column, refuse, table};

#[test]
fn the_exponent_of_a_linear_oscillator_is_minus_its_damping() {
    let place = Place::new();
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
    let found = table(&place.at("map"));
    let (c, omega) = (column(&found, "c"), column(&found, "omega"));
    for point in 0..6 {
        // Every tangent vector shrinks as exp(-c t/(2 m)) and turns.
        let expected = -c[point] / 1000.0 / 2.0;
        let lambda = column(&found, "lambda_1")[point];
        // The length of a turning vector swings by a factor, which a mean over 400 periods
        // divides by their time; it is less than the ratio of axes of the ellipse, 2.2.
        let bound = 2.2_f64.ln() / (400.0 * std::f64::consts::TAU / omega[point]);
        assert!((lambda - expected).abs() < bound, "{point}: {lambda}");
        assert!(column(&found, "lambda_1_se")[point] < bound * 10.0);
        assert_eq!(column(&found, "switch_rate")[point], 0.0);
        assert_eq!(column(&found, "lyapunov_status")[point], 0.0);
        assert_eq!(column(&found, "poincare_status")[point], 0.0);
    }
}

#[test]
fn play_makes_the_arm_chaotic() {
    let place = Place::new();
    let (arm, out) = (path("planetary_arm").display().to_string(), place.at("arm"));
    let axis = ["--vary", "b_sp,b_pr=0:100e-6:2", "--set", "omega=60"];
    let span = ["--transient", "20", "--periods", "40", "--order", "4"];
    let what = ["sweep", &arm, "--measure", "lyapunov,poincare", "--out"];
    let out_text = out.display().to_string();
    accepted(&[&what[..], &[&*out_text], &axis, &span].concat());
    let found = table(&out);
    let (lambda, error) = (column(&found, "lambda_1"), column(&found, "lambda_1_se"));
    assert!(lambda[1] > 2.0 + 2.0 * error[1], "{lambda:?} {error:?}");
    assert!(lambda[0] < 2.0 * error[0], "{lambda:?} {error:?}");
    let rate = column(&found, "switch_rate");
    assert!(rate[1] > 100.0 && rate[0] < rate[1], "{rate:?}");
}

#[test]
fn exponents_are_refused_where_they_are_not_exact_or_too_few() {
    let place = Place::new();
    let vary = ["--vary", "c=400:1000:3"];
    let few = ["--measure", "lyapunov", "--periods", "19"];
    let message = refuse(&place.sweep("never", &[&vary[..], &few[..]].concat()));
    assert!(message.contains("at least 20 --periods"), "{message}");
    let pendulum = path("pendulum").display().to_string();
    let out = place.at("never").display().to_string();
    let given = ["sweep", &pendulum, "--vary", "m=1:2:3", "--out", &out];
    let given = given.iter().chain(&["--measure", "lyapunov"]);
    let message = refuse(&given.map(|part| (*part).to_owned()).collect::<Vec<_>>());
    assert!(message.contains("`sin(theta)`"), "{message}");
    assert!(!place.at("never").exists());
}
