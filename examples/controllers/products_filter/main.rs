//! Extended Kalman filter for the planetary arm with 16 modes, with emitted Jacobian-vector products. The covariance is
//! S S'. Each column of S is propagated by a product, so that no Jacobian is computed. The result is compared with the
//! standard filter with the Jacobian. `arm` is emitted by `eomgen generate`, see docs/controllers.md.
//!
//! Method: M. Verlaan and A. W. Heemink, "Tidal flow forecasting using reduced rank square
//! root filters", Stochastic Hydrology and Hydraulics 11, 1997; sequential measurement updates by
//! J. E. Potter's formula.

mod filter;
mod motion;
mod products;
mod textbook;

use std::time::Instant;

use arm::{Coefficients, Parameters, STATES};
use filter::Filter;
use motion::{MEASURED, MEASUREMENTS, STEP, STEPS, State, add_scaled, begin, expected, motion};
use products::Products;
use textbook::Textbook;

/// States whose RMS error over the second half of the run is printed: displacement of the carrier (m), its rate (m/s),
/// and first mode of the arm (m).
const JUDGED: [(usize, &str, &str); 3] = [
    (2, "carrier", "um"),
    (2 + STATES / 2, "its rate", "um/s"),
    (3, "first mode", "um"),
];

/// Runs a filter and prints its RMS errors. Returns its final estimates and variances.
fn run_filter(
    name: &str,
    arm: &Coefficients,
    motion: &[(State, [f64; 3])],
    mut filter: impl Filter,
) -> [State; 2] {
    let begun = Instant::now();
    let mut squares = [0.0; JUDGED.len()];
    for (period, (state, record)) in motion.iter().enumerate() {
        filter.propagate(arm, STEP * (period * STEPS) as f64);
        let t = STEP * ((period + 1) * STEPS) as f64;
        for ((which, deviation), value) in MEASURED.iter().zip(record) {
            filter.update(arm, t, *which, *value, *deviation);
        }
        assert!(
            filter.estimate().iter().all(|x| x.is_finite()),
            "the estimate is not finite after {t} s"
        );
        if period >= MEASUREMENTS / 2 {
            for (square, (which, _, _)) in squares.iter_mut().zip(JUDGED) {
                *square += (filter.estimate()[which] - state[which]).powi(2);
            }
        }
    }
    eprintln!("{name}: {:.0} ms", 1e3 * begun.elapsed().as_secs_f64());
    print!("{name:<28}");
    for (square, (which, what, unit)) in squares.iter().zip(JUDGED) {
        let error = 1e6 * (square / (MEASUREMENTS / 2) as f64).sqrt();
        print!(
            " {what} {error:.2} {unit} (sd {:.2})",
            1e6 * filter.variance(which).sqrt()
        );
    }
    println!();
    [
        *filter.estimate(),
        std::array::from_fn(|i| filter.variance(i)),
    ]
}

/// Returns the largest difference of two states, each entry relative to `size` of its index.
fn difference(one: &State, other: &State, size: impl Fn(usize) -> f64) -> f64 {
    (0..STATES)
        .map(|i| (one[i] - other[i]).abs() / size(i))
        .fold(0.0, f64::max)
}

fn main() {
    let arm = &Coefficients::prepare(&Parameters::default());
    assert!(arm.positive_definite);
    let motion = motion(arm);
    let columns = begin();
    let covariance = (0..STATES)
        .map(|i| {
            columns.iter().fold([0.0; STATES], |row, column| {
                add_scaled(&row, column[i], column)
            })
        })
        .collect();
    let textbook = Textbook {
        estimate: expected(),
        covariance,
    };
    let [estimate, variance] = run_filter("Jacobian, whole covariance", arm, &motion, textbook);
    for rank in [STATES, 12, 6] {
        let products = Products {
            estimate: expected(),
            columns: columns.clone(),
            rank,
        };
        let name = format!("products, {rank} columns");
        let [same, claimed] = run_filter(&name, arm, &motion, products);
        let away = difference(&same, &estimate, |i| variance[i].sqrt());
        let claims = difference(&claimed, &variance, |i| variance[i]);
        println!(
            "    difference from the first filter: {away:.0e} standard deviations, {claims:.0e} of the variances"
        );
        if rank == STATES {
            assert!(away < 1e-7 && claims < 1e-9, "the filters differ");
        }
        assert!(away < 1.0, "{rank} columns are too few");
    }
}
