//! Decimation of samples to the first, lowest, highest and last sample of each pixel column.

use std::collections::BTreeSet;

pub(super) type Point = (f64, f64);

struct Column {
    index: i64,
    /// First, lowest, highest and last sample, each with its index in the series.
    extremes: [(usize, Point); 4],
}

impl Column {
    fn new(index: i64, sample: (usize, Point)) -> Self {
        Self {
            index,
            extremes: [sample; 4],
        }
    }

    fn include(&mut self, sample: (usize, Point)) {
        let [_, lowest, highest, last] = &mut self.extremes;
        let (_, (_, y)) = sample;
        if y < lowest.1.1 {
            *lowest = sample;
        }
        if y > highest.1.1 {
            *highest = sample;
        }
        *last = sample;
    }

    fn points(mut self) -> impl Iterator<Item = Point> {
        self.extremes.sort_by_key(|(number, _)| *number);
        let mut previous = None;
        self.extremes
            .into_iter()
            .filter_map(move |(number, point)| {
                (previous.replace(number) != Some(number)).then_some(point)
            })
    }
}

/// Returns the lines through the samples, with at most four points per column of `width` pixels.
///
/// A sample with a coordinate that is not finite interrupts the line. A gap inside one column is
/// invisible and is dropped, so that the bound holds for every series.
pub(super) fn polylines(samples: impl Iterator<Item = Point>, width: f64) -> Vec<Vec<Point>> {
    let mut lines = Vec::new();
    let mut line = Vec::new();
    let mut column: Option<Column> = None;
    let mut interrupted = false;
    for (number, point) in samples.enumerate() {
        if !(point.0.is_finite() && point.1.is_finite()) {
            interrupted = true;
            continue;
        }
        // Pixels are small, so the cast cannot overflow.
        let index = (point.0 / width).floor() as i64;
        match &mut column {
            Some(current) if current.index == index => current.include((number, point)),
            _ => {
                let full = column.replace(Column::new(index, (number, point)));
                line.extend(full.into_iter().flat_map(Column::points));
                if interrupted && !line.is_empty() {
                    lines.push(std::mem::take(&mut line));
                }
            }
        }
        interrupted = false;
    }
    line.extend(column.into_iter().flat_map(Column::points));
    if !line.is_empty() {
        lines.push(line);
    }
    lines
}

/// Minimum distance of points of an orbit, in px.
const MIN_ORBIT_STEP_PX: f64 = 1.0;
/// Distance below which points look the same, in px.
const MIN_POINT_DISTANCE_PX: f64 = 0.5;

/// Returns lines without the samples close to the last drawn one. A sample that is not finite interrupts the
/// line.
pub(super) fn thin_orbit(samples: impl Iterator<Item = Point>) -> Vec<Vec<Point>> {
    let mut lines: Vec<Vec<Point>> = Vec::new();
    let mut line: Vec<Point> = Vec::new();
    for (x, y) in samples {
        if !(x.is_finite() && y.is_finite()) {
            lines.push(std::mem::take(&mut line));
            continue;
        }
        let is_near = |last: &Point| (last.0 - x).hypot(last.1 - y) < MIN_ORBIT_STEP_PX;
        if !line.last().is_some_and(is_near) {
            line.push((x, y));
        }
    }
    lines.push(line);
    lines.retain(|line| !line.is_empty());
    lines
}

/// Returns one sample of each group of samples that look the same, as separate points.
pub(super) fn separate_points(samples: impl Iterator<Item = Point>) -> Vec<Vec<Point>> {
    let mut taken = BTreeSet::new();
    // Pixels are small, so the cast cannot overflow.
    let cell = |at: f64| (at / MIN_POINT_DISTANCE_PX).round() as i64;
    samples
        .filter(|(x, y)| x.is_finite() && y.is_finite())
        .filter(|(x, y)| taken.insert((cell(*x), cell(*y))))
        .map(|point| vec![point])
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_samples_are_unchanged() {
        let samples = [(0.0, 1.0), (2.0, 3.0), (4.0, -1.0)];
        assert_eq!(polylines(samples.into_iter(), 1.0), [samples.to_vec()]);
    }

    #[test]
    fn column_keeps_extremes_in_order() {
        let heights = [0.0, 5.0, 1.0, -7.0, 2.0, 3.0];
        let samples = heights
            .iter()
            .enumerate()
            .map(|(i, y)| (0.1 * i as f64, *y));
        let kept: Vec<f64> = polylines(samples, 1.0)
            .concat()
            .iter()
            .map(|p| p.1)
            .collect();
        assert_eq!(kept, [0.0, 5.0, -7.0, 3.0]);
    }

    #[test]
    fn orbit_drops_samples_near_the_last_one() {
        let samples = [
            (0.0, 0.0),
            (0.3, 0.3),
            (2.0, 0.0),
            (f64::NAN, 0.0),
            (0.0, 0.0),
            (0.0, 5.0),
        ];
        let lines = thin_orbit(samples.into_iter());
        assert_eq!(
            lines,
            [vec![(0.0, 0.0), (2.0, 0.0)], vec![(0.0, 0.0), (0.0, 5.0)]]
        );
    }

    #[test]
    fn indistinguishable_points_are_drawn_once() {
        let samples = [
            (1.0, 1.0),
            (1.01, 1.0),
            (f64::NAN, 1.0),
            (4.0, 1.0),
            (1.0, 1.02),
        ];
        assert_eq!(
            separate_points(samples.into_iter()),
            [vec![(1.0, 1.0)], vec![(4.0, 1.0)]]
        );
    }

    #[test]
    fn gap_splits_line() {
        let samples = [
            (0.0, 1.0),
            (1.0, f64::NAN),
            (2.0, f64::INFINITY),
            (3.0, 1.0),
            (4.0, 2.0),
        ];
        let lines = polylines(samples.into_iter(), 1.0);
        assert_eq!(lines, [vec![(0.0, 1.0)], vec![(3.0, 1.0), (4.0, 2.0)]]);
    }

    #[test]
    fn number_of_points_is_bounded_with_gaps() {
        let samples = (0..100_000).map(|i| {
            let y = if i % 2 == 0 {
                f64::from(i * 7919 % 1000)
            } else {
                f64::NAN
            };
            (f64::from(i) * 1e-3, y)
        });
        assert!(polylines(samples, 1.0).concat().len() <= 4 * 100);
    }
}
