//! Search for surfaces that a motion crosses inside a step.
//!
//! The dense output of a step is a polynomial. Interval arithmetic bounds each switching function and its rate
//! over a piece of the step. Together with the values at both ends, this gives a lower bound of the function
//! (mean-value form). Pieces in which a function may be negative are halved. Therefore no crossing of the
//! interpolated motion is missed, however short, and the result does not depend on samples.

use eomgen_codegen::program::evaluator::Enclosure;
use eomgen_model_spec::interval::Interval;

use super::bernstein::Piece;

/// Negative values up to this fraction of the largest value in a step count as rounding.
const ROUNDING_FRACTION: f64 = 1e-12;

/// Negative values up to this multiple of the width of the bounds at a single state count as rounding. The
/// rounding of a state grows by this factor in the control points of the dense output.
const MAX_ROUNDING_GROWTH: f64 = 100.0;

/// Maximum number of halvings of a step; a shorter excursion beyond a surface is not resolved.
const MAX_HALVINGS: i32 = 40;

/// Maximum number of examined pieces of one step. Throws at a disc need 30.
const MAX_PIECES: usize = 500;

/// Switching functions of a step, as the search evaluates and bounds them.
pub trait SwitchingFunctions {
    /// Returns the switching functions at state `y`, at a fraction `part` of the step.
    fn evaluate(&mut self, part: f64, y: &[f64]) -> Vec<f64>;

    /// Writes the bounds of the switching functions over a piece of the step.
    fn bound(&mut self, piece: &Piece, out: &mut [Enclosure]);
}

/// Crossing of surfaces inside a step.
#[derive(Debug, PartialEq)]
pub struct Crossing {
    /// Fraction of the step at which the motion is on the near side.
    pub near: f64,
    /// Fraction of the step at which the motion is beyond the surfaces.
    pub beyond: f64,
    /// Indices of the switching functions.
    pub guards: Vec<usize>,
}

/// Piece to be examined, with the functions at its ends and those that may be negative in it.
struct SearchPiece {
    piece: Piece,
    start: Vec<f64>,
    end: Vec<f64>,
    guards: Vec<usize>,
}

/// Searches for the first crossing in a step of `length` s whose dense output is `piece`. `sides` are -1 or 1
/// for the guards to examine and 0 for the others. Further arguments are the bounds of the functions over the
/// step and the functions at both ends. Guards whose bounds are too wide are added to `undecided`.
pub fn find_crossing(
    (piece, length): (Piece, f64),
    (sides, mut bounds): (&[f64], Vec<Enclosure>),
    (start, end): (Vec<f64>, Vec<f64>),
    functions: &mut impl SwitchingFunctions,
    undecided: &mut Vec<usize>,
) -> Option<Crossing> {
    let least = |guard: usize, bounds: &[Enclosure], (start, end): (&[f64], &[f64]), duration| {
        let side = sides[guard];
        let bound = bounds[guard].multiply(Enclosure::constant(side));
        compute_lower_bound(bound, (side * start[guard], side * end[guard]), duration)
    };
    let guards = (0..sides.len()).filter(|guard| sides[*guard] != 0.0);
    let guards: Vec<usize> = guards
        .filter(|guard| least(*guard, &bounds, (&start, &end), length) < 0.0)
        .collect();
    if guards.is_empty() {
        return None;
    }
    functions.bound(&piece.start(), &mut bounds);
    let ends = start.iter().zip(&end).zip(&bounds);
    let negligible: Vec<f64> = ends
        .map(|((a, b), bound)| {
            let rounding = MAX_ROUNDING_GROWTH * (bound.value().high - bound.value().low);
            ROUNDING_FRACTION * a.abs().max(b.abs()) + rounding
        })
        .collect();
    let mut tasks = vec![SearchPiece {
        piece,
        start,
        end,
        guards,
    }];
    let mut examined = 0;
    while let Some(mut task) = tasks.pop() {
        examined += 1;
        if examined > MAX_PIECES {
            undecided.extend(&task.guards);
            undecided.extend(tasks.iter().flat_map(|task| &task.guards));
            return None;
        }
        functions.bound(&task.piece, &mut bounds);
        let width = task.piece.to - task.piece.from;
        let ends = (&task.start[..], &task.end[..]);
        task.guards
            .retain(|guard| least(*guard, &bounds, ends, width * length) < -negligible[*guard]);
        if task.guards.is_empty() {
            continue;
        }
        let is_end_beyond = |guard: &usize| sides[*guard] * task.end[*guard] < -negligible[*guard];
        let mut guards = task.guards.iter();
        let falls = |guard: &usize| match sides[*guard] > 0.0 {
            true => bounds[*guard].rate().high < 0.0,
            false => bounds[*guard].rate().low > 0.0,
        };
        if width <= 2.0_f64.powi(-MAX_HALVINGS) || guards.all(falls) {
            task.guards.retain(is_end_beyond);
            if task.guards.is_empty() {
                continue;
            }
            return Some(Crossing {
                near: task.piece.from,
                beyond: task.piece.to,
                guards: task.guards,
            });
        }
        let [first, second] = task.piece.halves();
        let middle = functions.evaluate(first.to, &first.end_state());
        tasks.push(SearchPiece {
            piece: second,
            start: middle.clone(),
            end: task.end,
            guards: task.guards.clone(),
        });
        tasks.push(SearchPiece {
            piece: first,
            start: task.start,
            end: middle,
            guards: task.guards,
        });
    }
    None
}

/// Returns a lower bound of a function with these bounds over a `duration` in s and with these values at its
/// ends.
fn compute_lower_bound(bounds: Enclosure, (start, end): (f64, f64), duration: f64) -> f64 {
    let Interval {
        low: falling,
        high: rising,
    } = bounds.rate();
    let by_rate = match () {
        () if falling >= 0.0 => start,
        () if rising <= 0.0 => end,
        () if falling.is_infinite() || rising.is_infinite() => f64::NEG_INFINITY,
        // The lower bound is the intersection of the steepest descents from both ends.
        () => {
            let fall = start * rising - end * falling + falling * rising * duration;
            (fall / (rising - falling)).min(start).min(end)
        }
    };
    match by_rate.is_nan() {
        true => bounds.value().low,
        false => by_rate.max(bounds.value().low),
    }
}

#[cfg(test)]
mod tests {
    use super::super::bernstein::BernsteinBasis;
    use super::*;

    /// The function norm(position) - radius of a point in the plane.
    struct Disc {
        radius: f64,
        evaluations: usize,
    }

    impl SwitchingFunctions for Disc {
        fn evaluate(&mut self, _: f64, y: &[f64]) -> Vec<f64> {
            self.evaluations += 1;
            vec![y[0].hypot(y[1]) - self.radius]
        }

        fn bound(&mut self, piece: &Piece, out: &mut [Enclosure]) {
            let mut state = Vec::new();
            piece.bound(1.0, &mut state);
            let square = |x: Enclosure| x.value().square();
            let distance = square(state[0]).add_interval(square(state[1])).raise(0.5);
            let along = |x: Enclosure| x.value().multiply(x.rate());
            let rate = along(state[0]).add_interval(along(state[1]));
            let radius = Interval::from_ends(self.radius, self.radius);
            let value = distance.subtract(radius);
            out[0] = Enclosure::from_bounds(value, rate.multiply(distance.reciprocal()));
        }
    }

    #[test]
    fn every_throw_at_disc_that_hits_is_found() {
        let (mut hits, mut evaluations) = (0, 0);
        for throw in 0..400 {
            let number = |k: f64| (f64::from(throw) * k).fract();
            let radius = 1e-3 * 300.0_f64.powf(number(0.618_034));
            let offset = 2.0 * radius * number(0.414_214);
            let bend = number(0.259_921) - 0.5;
            let path = |s: f64| {
                let x = 4.0 * (s - 0.2 - 0.6 * number(0.732_051));
                vec![x, offset + bend * x * x]
            };
            let least = (0..=200_000)
                .map(|k| path(f64::from(k) / 2e5))
                .map(|point| point[0].hypot(point[1]) - radius)
                .fold(f64::INFINITY, f64::min);
            if least.abs() < 1e-6 {
                continue;
            }
            let ends = (path(0.0), path(1.0));
            let piece = BernsteinBasis::new().fit((&ends.0, &ends.1), |s| Some(path(s)));
            let mut disc = Disc {
                radius,
                evaluations: 0,
            };
            let values = (disc.evaluate(0.0, &ends.0), disc.evaluate(1.0, &ends.1));
            let piece = piece.expect("a polynomial");
            let mut undecided = Vec::new();
            let mut bounds = vec![Enclosure::UNKNOWN];
            disc.bound(&piece, &mut bounds);
            let guards = (&[1.0][..], bounds);
            let found = find_crossing((piece, 1.0), guards, values, &mut disc, &mut undecided);
            assert!(undecided.is_empty(), "{throw}");
            match found {
                Some(crossing) => {
                    let point = path(crossing.beyond);
                    assert!(point[0].hypot(point[1]) < radius, "{throw}: {crossing:?}");
                }
                None => assert!(least > 0.0, "{throw}: {least:e}"),
            }
            hits += usize::from(least < 0.0);
            evaluations = evaluations.max(disc.evaluations);
        }
        assert!(hits > 100, "{hits} hits");
        assert!(evaluations < 100, "{evaluations} evaluations");
    }
}
