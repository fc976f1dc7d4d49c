//! Statistics of the points on a section.

use std::f64::consts::{PI, TAU};

use eomgen_analysis::poincare::{Section, Shape};

/// Distance below which points count as equal, relative to the extent of the motion.
pub const MAX_RELATIVE_DISTANCE: f64 = 1e-3;

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CoordinateComparison {
    /// Difference relative to the extent of the motion.
    Linear {
        /// Range of the coordinate over the trajectory.
        extent: f64,
    },
    /// Difference of angles, modulo full turns.
    Angle,
    /// No comparison: the coordinate is cyclic or constant.
    Ignored,
}

/// Returns period and number of clusters of the points, 0 if there is none; `None` if a point is not finite.
pub fn find_repetition(points: &[[f64; 2]], parts: [CoordinateComparison; 2]) -> Option<[f64; 2]> {
    let mut scale = Vec::with_capacity(4);
    for part in parts {
        match part {
            CoordinateComparison::Linear { extent } => scale.push(extent),
            CoordinateComparison::Angle => scale.extend([TAU, TAU]),
            CoordinateComparison::Ignored => {}
        }
    }
    if !points.as_flattened().iter().all(|value| value.is_finite()) {
        return None;
    }
    // A motion at rest has no extent, so all points are equal.
    if scale.is_empty() {
        return Some([1.0, 1.0]);
    }
    let mut flat = Vec::with_capacity(points.len() * scale.len());
    for (value, part) in points.iter().flat_map(|point| point.iter().zip(parts)) {
        match part {
            CoordinateComparison::Linear { .. } => flat.push(*value),
            CoordinateComparison::Angle => flat.extend([value.cos(), value.sin()]),
            CoordinateComparison::Ignored => {}
        }
    }
    let section = Section {
        points: &flat,
        scale: &scale,
    };
    let Shape {
        period, clusters, ..
    } = section.shape(MAX_RELATIVE_DISTANCE).ok()?;
    Some([period, clusters].map(|count| count.unwrap_or(0) as f64))
}

/// Returns mean, minimum, maximum and RMS of the first coordinate; `None` if a point is not finite.
pub fn compute_statistics(points: &[[f64; 2]]) -> Option<[f64; 4]> {
    let values = || points.iter().map(|[x, _]| *x);
    let count = values().count() as f64;
    let found = [
        values().sum::<f64>() / count,
        values().fold(f64::INFINITY, f64::min),
        values().fold(f64::NEG_INFINITY, f64::max),
        (values().map(|x| x * x).sum::<f64>() / count).sqrt(),
    ];
    found
        .iter()
        .all(|number| number.is_finite())
        .then_some(found)
}

/// Returns comparisons of the coordinates. A coordinate is constant if it changes by at most `resolution` of its size.
pub fn create_linear_comparisons(seen: &[[f64; 2]], resolution: f64) -> [CoordinateComparison; 2] {
    compute_extents(seen.iter()).map(|(least, greatest)| {
        let extent = greatest - least;
        match extent <= resolution * least.abs().max(greatest.abs()) {
            true => CoordinateComparison::Ignored,
            false => CoordinateComparison::Linear { extent },
        }
    })
}

pub fn compute_extents<'s>(seen: impl Iterator<Item = &'s [f64; 2]> + Clone) -> [(f64, f64); 2] {
    [0, 1].map(|place| {
        let values = || seen.clone().map(|pair| pair[place]);
        let least = values().fold(f64::INFINITY, f64::min);
        (least, values().fold(f64::NEG_INFINITY, f64::max))
    })
}

pub fn wrap_angle(angle: f64, from: f64) -> f64 {
    let turned = (angle - from + PI).rem_euclid(TAU) - PI;
    from + turned
}

#[cfg(test)]
mod tests {
    use super::*;

    const SAMPLES_PER_PERIOD: usize = 8;

    /// Relative change below which a coordinate is constant.
    const RESOLUTION: f64 = 1e-12;

    /// Returns samples of x = a + b cos(t) + c cos(t/2) at the phases of cos(t), over `periods`.
    fn sample_motion(periods: usize, [a, b, c]: [f64; 3]) -> Vec<[f64; 2]> {
        let look = |look: usize| {
            let t = TAU * look as f64 / SAMPLES_PER_PERIOD as f64;
            [
                a + b * t.cos() + c * (t / 2.0).cos(),
                -b * t.sin() - c / 2.0 * (t / 2.0).sin(),
            ]
        };
        (0..periods * SAMPLES_PER_PERIOD).map(look).collect()
    }

    fn analyse(seen: &[[f64; 2]]) -> [f64; 6] {
        let points: Vec<[f64; 2]> = seen.iter().step_by(SAMPLES_PER_PERIOD).copied().collect();
        let [period, clusters] =
            find_repetition(&points, create_linear_comparisons(seen, RESOLUTION)).expect("numbers");
        let [mean, min, max, rms] = compute_statistics(&points).expect("numbers");
        [period, clusters, mean, min, max, rms]
    }

    fn assert_close(found: f64, expected: f64) {
        // Rounding error of a few dozen terms of order 10.
        assert!((found - expected).abs() < 1e-13, "{found} for {expected}");
    }

    #[test]
    fn motion_with_half_forcing_frequency_has_two_points() {
        // On the section x alternates between a + b + c and a + b - c.
        let [period, clusters, mean, min, max, rms] = analyse(&sample_motion(10, [3.0, 4.0, 1.0]));
        assert_eq!((period, clusters), (2.0, 2.0));
        assert_close(mean, 7.0);
        assert_close(min, 6.0);
        assert_close(max, 8.0);
        assert_close(rms, 50.0_f64.sqrt());
    }

    #[test]
    fn motion_with_forcing_frequency_and_rest_have_one_point() {
        let found = analyse(&sample_motion(10, [3.0, 4.0, 0.0]));
        assert_eq!(found[..2], [1.0, 1.0]);
        assert_close(found[2], 7.0);
        let rest = analyse(&[[2.0, 0.0]; 5 * SAMPLES_PER_PERIOD]);
        assert_eq!(rest, [1.0, 1.0, 2.0, 2.0, 2.0, 2.0]);
    }

    #[test]
    fn angles_repeat_across_end_of_turn() {
        // The angle advances by two and a half turns each time, with noise on both sides of half a turn.
        let points: Vec<[f64; 2]> = (0..20)
            .map(|k| [PI + 2.0 * TAU * f64::from(k) + 1e-9 * f64::from(k % 2), 1.0])
            .collect();
        let parts = [CoordinateComparison::Angle, CoordinateComparison::Ignored];
        assert_eq!(find_repetition(&points, parts), Some([1.0, 1.0]));
        let extent = 40.0 * TAU;
        let parts = [
            CoordinateComparison::Linear { extent },
            CoordinateComparison::Ignored,
        ];
        assert_eq!(
            find_repetition(&points, parts).map(|found| found[0]),
            Some(0.0)
        );
        assert!((wrap_angle(7.0, 0.0) - (7.0 - TAU)).abs() < 1e-15);
        assert!((wrap_angle(PI + 0.1, PI) - (PI + 0.1)).abs() < 1e-15);
    }
}
