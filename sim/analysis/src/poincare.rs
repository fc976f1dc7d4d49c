//! Stroboscopic section of a forced motion: period, extent and dimension of the points sampled once per forcing
//! period.

use super::error::{AnalysisError, check_positive, check_values};

/// Longest period that is searched, in forcing periods, and largest number of clusters that are counted.
pub const LONGEST_PERIOD: usize = 64;
/// Number of last points used for the dimension; they form two million pairs.
const MAX_DIMENSION_POINTS: usize = 2000;
/// Smallest number of points for an estimate of the dimension.
const MIN_DIMENSION_POINTS: usize = 200;
/// Shares of the pairs whose largest distances bound the range for the estimate of the dimension.
const DIMENSION_PAIR_SHARES: (f64, f64) = (0.01, 0.05);

/// States once per forcing period, in order of time.
///
/// Omit a coordinate that drifts, such as an angle of rotation, and use its rate.
#[derive(Clone, Copy, Debug)]
pub struct Section<'a> {
    /// Points in order, each with the number of coordinates of `scale`.
    pub points: &'a [f64],
    /// Extent of each coordinate over the trajectory. The extent on the section is zero for a
    /// motion with the forcing period.
    pub scale: &'a [f64],
}

/// Properties of a section.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// Smallest n, at most 64, for which each point is within the tolerance of one of the first n points, an
    /// integer number of n periods earlier; `None` if there is none.
    pub period: Option<usize>,
    /// Number of clusters of points; `None` for more than 64.
    pub clusters: Option<usize>,
    /// Smallest and largest value of each coordinate, in its unit.
    pub extent: Vec<(f64, f64)>,
    /// Correlation dimension: near 0 for finitely many points, 1 for a closed curve, not an integer
    /// for a strange attractor, 2 or more for a cloud. `None` for fewer than 200 points, or points
    /// that coincide.
    pub dimension: Option<f64>,
}

impl Section<'_> {
    /// Describes the section. Points are equal if no coordinate differs by more than `tolerance` of
    /// its scale.
    ///
    /// With d(i, k) the largest difference of the coordinates of points i and k, each divided by its scale, the
    /// period is the smallest n with d(k mod n, k) <= tolerance for all k, if there are at least 2n points.
    /// Therefore a slow drift does not count as a period. Clusters are counted in order of time: a point
    /// farther than the tolerance from the first point of every cluster starts a new one.
    ///
    /// The dimension is that of P. Grassberger and I. Procaccia (Physica D 9 (1983) 189-208): the dimension is
    /// ln 5 / ln(r_2/r_1), where 1 % of the pairs are closer than r_1 and 5 % closer than r_2. It uses at most
    /// the last 2000 points, each coordinate divided by its extent on the section. The cost is quadratic in the
    /// number of points.
    ///
    /// # Errors
    ///
    /// No scale, scales or a tolerance that are not positive, an incomplete point, values that are
    /// not finite, fewer than two points.
    pub fn shape(&self, tolerance: f64) -> Result<Shape, AnalysisError> {
        self.check()?;
        check_positive(tolerance, "the tolerance")?;
        let scaled = scaled(self.points, self.scale);
        let points: Vec<&[f64]> = scaled.chunks_exact(self.scale.len()).collect();
        let extent = self.extent();
        Ok(Shape {
            period: period(&points, tolerance),
            clusters: clusters(&points, tolerance),
            dimension: self.dimension(&extent, tolerance),
            extent,
        })
    }

    fn check(&self) -> Result<(), AnalysisError> {
        let width = self.scale.len();
        if width == 0 {
            return Err(AnalysisError::TooFew {
                needed: 1,
                given: 0,
            });
        }
        for scale in self.scale {
            check_positive(*scale, "the scale of a coordinate")?;
        }
        check_values(self.points, 2 * width)?;
        match self.points.len() % width {
            0 => Ok(()),
            given => Err(AnalysisError::LengthMismatch {
                expected: width,
                given,
            }),
        }
    }

    fn extent(&self) -> Vec<(f64, f64)> {
        let width = self.scale.len();
        (0..width)
            .map(|coordinate| {
                let values = self.points.iter().skip(coordinate).step_by(width);
                values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                    (low.min(*value), high.max(*value))
                })
            })
            .collect()
    }

    fn dimension(&self, extent: &[(f64, f64)], tolerance: f64) -> Option<f64> {
        let width = self.scale.len();
        let first = self
            .points
            .len()
            .saturating_sub(MAX_DIMENSION_POINTS * width);
        let recent = self.points.get(first..)?;
        if recent.len() < MIN_DIMENSION_POINTS * width {
            return None;
        }
        // A coordinate that varies by less than the tolerance counts as constant: its noise must not affect the
        // dimension.
        let own: Vec<f64> = extent
            .iter()
            .zip(self.scale)
            .map(|((low, high), scale)| (high - low).max(tolerance * scale))
            .collect();
        let scaled = scaled(recent, &own);
        let points: Vec<&[f64]> = scaled.chunks_exact(width).collect();
        let mut distances: Vec<f64> = points
            .iter()
            .enumerate()
            .flat_map(|(i, a)| points.iter().take(i).map(|b| distance(a, b)))
            .collect();
        let far = quantile(&mut distances, DIMENSION_PAIR_SHARES.1)?;
        let near = quantile(&mut distances, DIMENSION_PAIR_SHARES.0)?;
        let ratio = (far / near).ln();
        (near > 0.0 && ratio > 0.0)
            .then(|| (DIMENSION_PAIR_SHARES.1 / DIMENSION_PAIR_SHARES.0).ln() / ratio)
    }
}

fn scaled(points: &[f64], scale: &[f64]) -> Vec<f64> {
    let scales = scale.iter().cycle();
    points.iter().zip(scales).map(|(x, s)| x / s).collect()
}

/// Returns the largest difference of the coordinates.
fn distance(a: &[f64], b: &[f64]) -> f64 {
    let differences = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, f64::max)
}

fn period(points: &[&[f64]], tolerance: f64) -> Option<usize> {
    let longest = LONGEST_PERIOD.min(points.len() / 2);
    (1..=longest).find(|n| {
        let mut pairs = points[..*n].iter().cycle().zip(points);
        pairs.all(|(a, b)| distance(a, b) <= tolerance)
    })
}

fn clusters(points: &[&[f64]], tolerance: f64) -> Option<usize> {
    let mut leaders: Vec<&[f64]> = Vec::new();
    for point in points {
        if leaders
            .iter()
            .any(|leader| distance(leader, point) <= tolerance)
        {
            continue;
        }
        if leaders.len() == LONGEST_PERIOD {
            return None;
        }
        leaders.push(point);
    }
    Some(leaders.len())
}

/// Returns the quantile: a share `share` of the values is below it.
fn quantile(values: &mut [f64], share: f64) -> Option<f64> {
    let index = (share * values.len() as f64) as usize;
    if index >= values.len() {
        return None;
    }
    let (_, value, _) = values.select_nth_unstable_by(index, f64::total_cmp);
    Some(*value)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::maps::{circle, henon, logistic, noise};

    fn shape(points: &[f64], scale: &[f64]) -> Shape {
        Section { points, scale }.shape(1e-6).unwrap()
    }

    #[test]
    fn logistic_map_doubles_its_period() {
        // Between the thresholds of May (1976): 3, 1 + sqrt 6, 3.5441, 3.5644, 3.5688.
        for (r, period) in [(2.9, 1), (3.2, 2), (3.5, 4), (3.55, 8), (3.566, 16)] {
            let found = shape(&logistic(r, 400), &[1.0]);
            assert_eq!(found.period, Some(period), "r = {r}");
            assert_eq!(found.clusters, Some(period), "r = {r}");
        }
        // The period-3 window starts at 1 + sqrt 8.
        assert_eq!(shape(&logistic(3.835, 400), &[1.0]).period, Some(3));
        let chaos = shape(&logistic(4.0, 2000), &[1.0]);
        assert_eq!((chaos.period, chaos.clusters), (None, None));
    }

    #[test]
    fn slow_drift_is_no_period() {
        // Three periods turn by nearly one revolution.
        let points = circle(1.0 / 3.0 + 1e-4, 0.0, 300);
        let section = Section {
            points: &points,
            scale: &[1.0],
        };
        assert_eq!(section.shape(2e-3).unwrap().period, None);
        let points = circle(1.0 / 3.0 + 1e-7, 0.0, 300);
        let section = Section {
            points: &points,
            scale: &[1.0],
        };
        assert_eq!(section.shape(2e-3).unwrap().period, Some(3));
    }

    #[test]
    fn rotation_is_a_closed_curve() {
        let golden = (5_f64.sqrt() - 1.0) / 2.0;
        let points: Vec<f64> = circle(golden, 0.5, 2000)
            .iter()
            .flat_map(|x| [3.0 * (TAU * x).cos(), 1e-3 * (TAU * x).sin()])
            .collect();
        let found = shape(&points, &[6.0, 2e-3]);
        assert_eq!((found.period, found.clusters), (None, None));
        // 1 % of 2000 points is 20 neighbours, which limits the accuracy on a line to 5 %.
        let dimension = found.dimension.unwrap();
        assert!((dimension - 1.0).abs() < 0.1, "{dimension}");
        let (low, high) = found.extent[0];
        assert!((low + 3.0).abs() < 1e-3 && (high - 3.0).abs() < 1e-3);
        // Rational: period 7.
        let rational: Vec<f64> = circle(3.0 / 7.0, 0.0, 100)
            .iter()
            .flat_map(|x| [(TAU * x).cos(), (TAU * x).sin()])
            .collect();
        assert_eq!(shape(&rational, &[2.0, 2.0]).period, Some(7));
    }

    #[test]
    fn dimensions_match_the_literature() {
        let henon: Vec<f64> = henon(2000).into_flattened();
        let strange = shape(&henon, &[2.5, 0.8]).dimension.unwrap();
        // 1.21 in the limit; local slopes at these distances scatter by 10 %.
        assert!((strange - 1.21).abs() < 0.12, "{strange}");
        let cloud = shape(&noise(4000), &[2.0, 2.0]).dimension.unwrap();
        // A square, at distances up to a tenth of its side: the edges cause an error of a few per cent.
        assert!((cloud - 2.0).abs() < 0.15, "{cloud}");
    }

    #[test]
    fn fixed_point_with_rounding_has_period_one() {
        let points: Vec<f64> = noise(600).iter().map(|x| 2.5e-5 + 1e-16 * x).collect();
        let found = shape(&points, &[1e-4]);
        assert_eq!((found.period, found.clusters), (Some(1), Some(1)));
    }

    #[test]
    fn malformed_sections_are_rejected() {
        let attempt = |points: &[f64], scale: &[f64], tolerance| {
            Section { points, scale }.shape(tolerance).is_err()
        };
        assert!(attempt(&[1.0, 2.0], &[], 1e-6));
        assert!(attempt(&[1.0], &[1.0], 1e-6));
        assert!(attempt(&[1.0, 2.0, 3.0, 4.0, 5.0], &[1.0, 1.0], 1e-6));
        assert!(attempt(&[1.0, f64::NAN], &[1.0], 1e-6));
        assert!(attempt(&[1.0, 2.0], &[0.0], 1e-6));
        assert!(attempt(&[1.0, 2.0], &[1.0], f64::NAN));
    }
}
