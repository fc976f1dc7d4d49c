//! An extended Kalman filter for the planetary arm with 16 modes, from emitted products of the
//! Jacobian with vectors: the covariance is S S', and the columns of S are carried along the motion by a
//! product each, so that no Jacobian is formed. Beside it the textbook's filter with the Jacobian.
//! `arm` is what `eomgen generate` left, see docs/controllers.md.
//!
//! The method: M. Verlaan and A. W. Heemink, "Tidal flow forecasting using reduced rank square
//! root filters", Stochastic Hydrology and Hydraulics 11, 1997; measurements one after the other by
//! J. E. Potter's formula.

mod filter;
mod motion;
mod products;
mod textbook;

use std::time::Instant;

use arm::{Coefficients, Parameters, STATES};
use filter::Filter;
use motion::{MEASURED, MEASUREMENTS, STEP, STEPS, State, begin, expected, motion, moved};
use products::Products;
use textbook::Textbook;

/// How far a filter is from the arm in the second half of the run, root mean square: the carrier's path, m, its
/// rate, m/s, and the arm's first mode, m.
const JUDGED: [(usize, &str, &str); 3] = [
    (2, "carrier", "um"),
    (2 + STATES / 2, "its rate", "um/s"),
    (3, "first mode", "um"),
];

/// Runs a filter over the records; prints how far it was, returns its estimates and variances at the end.
fn filtered(
    name: &str,
    arm: &Coefficients,
    motion: &[(State, [f64; 3])],
    mut filter: impl Filter,
) -> [State; 2] {
    let begun = Instant::now();
    let mut squares = [0.0; JUDGED.len()];
    for (period, (state, record)) in motion.iter().enumerate() {
        filter.carried(arm, STEP * (period * STEPS) as f64);
        let t = STEP * ((period + 1) * STEPS) as f64;
        for ((which, deviation), value) in MEASURED.iter().zip(record) {
            filter.taken(arm, t, *which, *value, *deviation);
        }
        assert!(
            filter.estimate().iter().all(|x| x.is_finite()),
            "lost after {t} s"
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
            " {what} {error:.2} {unit} (claims {:.2})",
            1e6 * filter.variance(which).sqrt()
        );
    }
    println!();
    [
        *filter.estimate(),
        std::array::from_fn(|i| filter.variance(i)),
    ]
}

/// The largest difference of two lists, for each number by its claimed deviation.
fn apart(one: &State, other: &State, size: impl Fn(usize) -> f64) -> f64 {
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
            columns
                .iter()
                .fold([0.0; STATES], |row, column| moved(&row, column[i], column))
        })
        .collect();
    let textbook = Textbook {
        estimate: expected(),
        covariance,
    };
    let [estimate, variance] = filtered("Jacobian, whole covariance", arm, &motion, textbook);
    for rank in [STATES, 12, 6] {
        let products = Products {
            estimate: expected(),
            columns: columns.clone(),
            rank,
        };
        let name = format!("products, {rank} columns");
        let [same, claimed] = filtered(&name, arm, &motion, products);
        let away = apart(&same, &estimate, |i| variance[i].sqrt());
        let claims = apart(&claimed, &variance, |i| variance[i]);
        println!("    from the first: {away:.0e} of its deviations, {claims:.0e} of its variances");
        if rank == STATES {
            assert!(away < 1e-7 && claims < 1e-9, "two filters in place of one");
        }
        assert!(away < 1.0, "{rank} columns are too few");
    }
}
