//! Search for a tight bound by division of the ranges into boxes.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use eomgen_model_spec::interval::Interval;

use super::analysis::{bound_by_sensitivities, bound_numbers};
use super::obstacle::Obstacle;
use super::scalars::{ScalarOp, Scalars};

/// Ranges of the components of a point; `None` for components without a range.
pub type Ranges = [Option<Interval>];

/// Box with the bound of the error in it.
struct Part {
    ranges: Vec<Option<Interval>>,
    bound: Result<f64, Obstacle>,
}

impl Part {
    /// Returns the bound, or infinity if there is none.
    fn size(&self) -> f64 {
        self.bound.unwrap_or(f64::INFINITY)
    }
}

impl PartialEq for Part {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Part {}

impl PartialOrd for Part {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Part {
    fn cmp(&self, other: &Self) -> Ordering {
        self.size().total_cmp(&other.size())
    }
}

/// Largest number of divisions of a box.
const MAX_DIVISIONS: usize = 64;

/// Largest number of operations that the search evaluates, not counting those of the whole box.
const MAX_OPERATIONS: usize = 4_000_000;

/// Returns a bound of the rounding error of the number `root` at all points in `ranges`. The bound is the largest
/// bound of all boxes; the box with the largest bound is divided repeatedly.
///
/// # Errors
/// The reason for the missing bound of a box.
pub fn bound_root(scalars: &Scalars, root: usize, ranges: &Ranges) -> Result<f64, Obstacle> {
    let needed = scalars.reachable(root);
    let variables = needed
        .iter()
        .filter_map(|index| match scalars.list[*index].op {
            ScalarOp::Variable(place) => Some(place),
            _ => None,
        });
    let variables: Vec<usize> = variables.collect();
    let whole = evaluate(scalars, &needed, ranges.to_vec());
    if variables.iter().any(|place| ranges[*place].is_none()) {
        return whole.bound;
    }
    let divisions = MAX_OPERATIONS / (2 * needed.len() * variables.len()).max(1);
    let mut parts = BinaryHeap::from([whole]);
    for _ in 0..divisions.min(MAX_DIVISIONS) {
        let Some(worst) = parts.pop() else { break };
        let halves = variables.iter().filter_map(|place| {
            let halves = divide(&worst.ranges, *place)?;
            let halves = halves.map(|ranges| evaluate(scalars, &needed, ranges));
            Some((halves, relative_width(&worst.ranges, ranges, *place)))
        });
        let best = halves.min_by(compare_halves);
        match best {
            Some((best, _)) => parts.extend(best),
            None => {
                parts.push(worst);
                break;
            }
        }
    }
    parts.pop().map_or(Ok(0.0), |worst| worst.bound)
}

/// Orders divisions of a box by the larger bound of the two halves, then by the smaller bound. If no half has a
/// bound, the variable with the largest share of its range is divided.
fn compare_halves((a, a_share): &([Part; 2], f64), (b, b_share): &([Part; 2], f64)) -> Ordering {
    let larger = |halves: &[Part; 2]| halves[0].size().max(halves[1].size());
    let smaller = |halves: &[Part; 2]| halves[0].size().min(halves[1].size());
    let by_bounds = larger(a).total_cmp(&larger(b));
    let by_bounds = by_bounds.then(smaller(a).total_cmp(&smaller(b)));
    by_bounds.then(b_share.total_cmp(a_share))
}

/// Returns the width of a box relative to the whole range of a variable.
fn relative_width(part: &Ranges, whole: &Ranges, place: usize) -> f64 {
    let width = |ranges: &Ranges| ranges[place].map_or(0.0, |range| range.high - range.low);
    width(part) / width(whole)
}

fn evaluate(scalars: &Scalars, needed: &[usize], ranges: Vec<Option<Interval>>) -> Part {
    let known = bound_numbers(scalars, needed, &ranges);
    let bound = match needed.last().map(|root| known[*root]) {
        None => Ok(0.0),
        Some(root) => match root.obstacle {
            Some(obstacle) => Err(obstacle),
            None => Ok(root
                .error
                .min(bound_by_sensitivities(scalars, needed, &known))),
        },
    };
    Part { ranges, bound }
}

/// Divides a box at the middle of a range; `None` if the range has no number between its ends.
fn divide(ranges: &Ranges, place: usize) -> Option<[Vec<Option<Interval>>; 2]> {
    let Interval { low, high } = ranges[place]?;
    let middle = 0.5 * low + 0.5 * high;
    if middle <= low || middle >= high {
        return None;
    }
    let part = |low, high| {
        let mut part = ranges.to_vec();
        part[place] = Some(Interval { low, high });
        part
    };
    Some([part(low, middle), part(middle, high)])
}
