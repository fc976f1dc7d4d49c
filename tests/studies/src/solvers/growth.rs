//! Growth of small differences along a motion: norm of the tangent map from several times to all later samples,
//! computed by finite differences.

use eomgen_compiled_model::{Error, Instance, Request};
use eomgen_validate::random::Random;

/// Size of a disturbance relative to the magnitude of each state.
const DISTURBANCE: f64 = 1e-6;

const DIRECTIONS: usize = 2;

/// Starts of the disturbed motions, as fractions of the number of samples.
pub const STARTS: [f64; 4] = [0.0, 0.25, 0.5, 0.75];

/// Returns the largest magnitude of every state over a motion. States with the same unit share the largest magnitude,
/// so that differences of a nearly constant state are relative to the other states.
pub fn magnitudes(states: &[Vec<f64>], units: &[String]) -> Vec<f64> {
    let largest = |state: usize| states.iter().fold(0.0_f64, |m, y| m.max(y[state].abs()));
    let own: Vec<f64> = (0..units.len()).map(largest).collect();
    let of_unit = |unit: &String| {
        let same = units.iter().zip(&own).filter(|(other, _)| *other == unit);
        same.fold(0.0_f64, |m, (_, value)| m.max(*value))
    };
    units
        .iter()
        .map(|unit| of_unit(unit).max(f64::MIN_POSITIVE))
        .collect()
}

/// Returns the largest difference of two motions at their common samples, relative to the
/// magnitudes.
pub fn difference(a: &[Vec<f64>], b: &[Vec<f64>], magnitudes: &[f64]) -> f64 {
    let rows = a.iter().zip(b);
    rows.map(|(a, b)| relative(a, b, magnitudes))
        .fold(0.0, f64::max)
}

fn relative(a: &[f64], b: &[f64], magnitudes: &[f64]) -> f64 {
    let states = a.iter().zip(b).zip(magnitudes);
    states
        .map(|((a, b), magnitude)| (a - b).abs() / magnitude)
        .fold(0.0, |worst, value| {
            if value <= worst {
                worst
            } else if value.is_nan() {
                f64::INFINITY
            } else {
                value
            }
        })
}

/// Returns the largest growth, at least 1, of a disturbance along the motion `states` at
/// `request.times`, from the samples at the fractions `starts` on.
///
/// # Errors
///
/// Returns an error if a disturbed motion cannot be simulated.
pub fn growth(
    instance: &Instance<'_>,
    request: &Request<'_>,
    states: &[Vec<f64>],
    magnitudes: &[f64],
    (starts, random): (&[f64], &mut Random),
) -> Result<f64, Error> {
    let mut growth = 1.0_f64;
    for part in starts {
        let first = (part * (states.len() - 1) as f64) as usize;
        let times = &request.times[first..];
        let follow = |initial: &[f64]| {
            let request = Request {
                initial,
                times,
                ..*request
            };
            Ok::<_, Error>(
                instance
                    .simulate_until_stop(&request, &mut |_| {})?
                    .trajectory
                    .states,
            )
        };
        let reference = follow(&states[first])?;
        for _ in 0..DIRECTIONS {
            let disturbed: Vec<f64> = states[first]
                .iter()
                .zip(magnitudes)
                .map(|(value, magnitude)| value + DISTURBANCE * magnitude * random.away_from_zero())
                .collect();
            let motion = follow(&disturbed)?;
            growth = growth.max(difference(&motion, &reference, magnitudes) / DISTURBANCE);
        }
    }
    Ok(growth)
}
