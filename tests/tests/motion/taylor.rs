//! Tests of the Taylor series integrator: arithmetic, mode shapes, first crossings, independence of the step size, and
//! comparison of the paper's case with a trajectory of seventeen digits.

use eomgen_tests::taylor::arm::Case;
use eomgen_tests::taylor::crossing::first_rise;
use eomgen_tests::taylor::double_double::DoubleDouble;
use eomgen_tests::taylor::modes::Mode;
use eomgen_tests::taylor::run::{MAX_STEP_S, Run};
use eomgen_tests::taylor::scalar::Scalar;
use serde_json::Value;

const MODES: &str = include_str!("../../reference/clamped_free_modes.json");

/// Trajectory of which two codes in quadruple precision agree in all digits.
const TRAJECTORY: &str = include_str!("../../reference/trajectory_order4.csv");

fn pair(high: f64, low: f64) -> DoubleDouble {
    DoubleDouble { high, low }
}

fn relative(a: DoubleDouble, b: DoubleDouble) -> f64 {
    ((a - b) / b).to_f64().abs()
}

/// Parses a decimal number of up to thirty digits; only the last bits may be wrong.
fn decimal(text: &str) -> DoubleDouble {
    let digits = text.chars().filter(char::is_ascii_digit);
    let whole = digits.fold(DoubleDouble::exactly(0.0), |number, digit| {
        let digit = digit.to_digit(10).expect("a digit");
        number.times(10.0) + DoubleDouble::exactly(f64::from(digit))
    });
    let places = text.split_once('.').map_or(0, |(_, places)| places.len());
    let scale = (0..places).fold(DoubleDouble::exactly(1.0), |scale, _| scale.times(10.0));
    let sign = if text.starts_with('-') { -1.0 } else { 1.0 };
    whole.times(sign) / scale
}

#[test]
fn double_doubles_have_thirty_one_digits() {
    let number = DoubleDouble::exactly;
    let (sin_1, cos_1) = number(1.0).sin_cos();
    let (sin_40, cos_40) = number(40.0).sin_cos();
    // The second value is from rational arithmetic with sixty decimals.
    let found = [
        (
            number(1.0) / number(3.0),
            0.3333333333333333,
            1.850371707708594e-17,
        ),
        (
            number(1.0).exp(),
            std::f64::consts::E,
            1.4456468917292502e-16,
        ),
        (
            number(-20.0).exp(),
            2.061153622438558e-09,
            -4.19755767595054e-26,
        ),
        (sin_1, 0.8414709848078965, 1.776845092935536e-18),
        (cos_1, 0.5403023058681398, -4.760954612604417e-17),
        (sin_40, 0.7451131604793488, -4.800921719561452e-17),
        (cos_40, -0.6669380616522619, 3.771106789024549e-17),
    ];
    for (found, high, low) in found {
        let error = relative(found, pair(high, low));
        // The reduction of 40 by multiples of pi/2 multiplies the rounding error of pi by 25.
        assert!(error < 1e-30, "{found:?} is off by {error:e}");
    }
}

#[test]
fn mode_shapes_1_to_128_match_high_precision_table() {
    let modes: Vec<Value> = serde_json::from_str(MODES).expect("a list of modes");
    assert_eq!(modes.len(), 128);
    for (r, mode) in (1..).zip(&modes) {
        let own = Mode::<DoubleDouble>::clamped_free(r);
        let found = [
            ("beta_l", own.z),
            ("xi", own.xi),
            ("int_s_phi", own.moment),
            ("int_phi2", own.square),
            ("int_phi_ss2", own.bending),
            ("phi_tip", own.tip),
        ];
        for (name, found) in found {
            let expected = decimal(mode[name].as_str().expect("a decimal number"));
            let error = relative(found, expected);
            // The table has 25 digits; the last is rounded.
            assert!(error < 1e-24, "mode {r}, {name}: off by {error:e}");
        }
    }
}

/// Returns the coefficients of the polynomial with these roots.
fn product(roots: &[f64]) -> Vec<DoubleDouble> {
    let zero = DoubleDouble::exactly(0.0);
    let mut coefficients = vec![DoubleDouble::exactly(1.0)];
    for root in roots {
        let mut next = vec![zero; coefficients.len() + 1];
        for (k, coefficient) in coefficients.iter().enumerate() {
            next[k + 1] = next[k + 1] + *coefficient;
            next[k] = next[k] - coefficient.times(*root);
        }
        coefficients = next;
    }
    coefficients
}

#[test]
fn first_change_to_positive_is_found_for_any_duration() {
    // The polynomial is positive only between the first two roots, an interval of 1e-9 of the step.
    let found = first_rise(&product(&[0.3, 0.3 + 1e-9, 0.9, 1.5, 2.0]));
    assert!(found.is_some_and(|at| (at.to_f64() - 0.3).abs() < 1e-15));
    // The polynomial is negative between the roots and changes to positive at the second.
    let found = first_rise(&product(&[0.25, 0.75]));
    assert!(found.is_some_and(|at| (at.to_f64() - 0.75).abs() < 1e-15));
    // The polynomial decreases at the only root within the step; it becomes positive only after the step.
    assert!(first_rise(&product(&[0.25, 1.25])).is_none());
    // A pair of complex roots is near the axis: the polynomial comes within 1e-20 of zero without crossing it.
    let mut touching = product(&[0.4, 0.4]);
    touching[0] = touching[0] + DoubleDouble::exactly(1e-20);
    let touching: Vec<DoubleDouble> = touching.into_iter().map(|c| -c).collect();
    assert!(first_rise(&touching).is_none());
    // The start is beyond the edge by a rounding error, and the motion continues outwards or inwards.
    let start = |slope: f64| [1e-40, slope, 0.0].map(DoubleDouble::exactly);
    assert!(first_rise(&start(1.0)).is_some_and(|at| at.to_f64() == 0.0));
    assert!(first_rise(&start(-1.0)).is_none());
}

/// Returns a case with the paper's excitation frequency, 10 pi rad/s.
fn case(order: usize, b: f64) -> Case {
    Case {
        order,
        b,
        omega: 31.41592653589793,
    }
}

fn milliseconds(until: usize) -> Vec<f64> {
    (0..=until).map(|k| k as f64 / 1000.0).collect()
}

#[test]
fn motion_is_independent_of_step_size() {
    let times = milliseconds(2000);
    let chosen = Run::<DoubleDouble>::simulate(case(4, 100e-6), &times, MAX_STEP_S);
    let finer = Run::<DoubleDouble>::simulate(case(4, 100e-6), &times, 1.0 / 32768.0);
    assert!(
        finer.steps * 2 > chosen.steps * 3,
        "the smaller step needs too few steps"
    );
    assert_eq!(chosen.switch_counts(), finer.switch_counts());
    let deviations =
        (0..times.len()).map(|sample| (chosen.tip(sample) - finer.tip(sample)).to_f64());
    let worst = deviations.fold(0.0, |worst: f64, deviation| worst.max(deviation.abs()));
    println!(
        "tip, b = 100 um: {worst:.1e} m in {} and {} steps",
        chosen.steps, finer.steps
    );
    // Rounding errors of 1e-33 m grow by a factor of 1e5, as in doubles; the bound allows a further factor of 100.
    assert!(worst < 1e-26, "{worst:e}");
}

#[test]
fn papers_case_matches_reference_to_last_digits() {
    let times: Vec<f64> = (0..=200).map(|k| f64::from(k) / 100.0).collect();
    let run = Run::<DoubleDouble>::simulate(case(4, 25e-6), &times, MAX_STEP_S);
    assert_eq!(run.switch_counts().iter().sum::<usize>(), 965);
    let rows: Vec<Vec<f64>> = TRAJECTORY
        .lines()
        .skip(1)
        .map(|line| {
            line.split(',')
                .map(|field| field.parse().expect("a number"))
                .collect()
        })
        .collect();
    assert_eq!(rows.len(), times.len());
    let mut worst = [0.0_f64; 4];
    for (sample, row) in rows.iter().enumerate() {
        let [x_sp, x_pr, x_c] = [0, 1, 2].map(|j| run.states[sample].positions[j]);
        let found = [x_sp, x_pr, x_c, run.tip(sample)];
        for ((worst, found), expected) in worst.iter_mut().zip(found).zip(&row[1..]) {
            let deviation = (found - DoubleDouble::exactly(*expected)).to_f64().abs();
            *worst = worst.max(deviation);
        }
    }
    // The bounds are twice the resolution of seventeen digits at 1e-4 m, 1 m and 3e-3 m, because the reference rounds
    // the constants 10 pi and 24.6 degrees differently.
    for (worst, allowed) in worst.into_iter().zip([2e-17, 2e-17, 1e-15, 1e-16]) {
        assert!(
            worst < allowed,
            "{worst:e} m where {allowed:e} m is allowed"
        );
    }
}
