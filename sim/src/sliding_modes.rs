//! Sliding modes: the switching surfaces that hold a motion on them (A. F. Filippov).
//!
//! With s_i between -1 and 1 instead of sign(g_i), the rates of the switching functions are
//! g' = c + W s. A surface holds the motion if its rate is zero, and releases it to the side
//! s_i = 1 or s_i = -1 if its rate has that sign. This is a linear complementarity problem with bounds. For
//! friction, W is -J M^-1 J^T times the friction levels, and the rates that solve the problem are
//! unique.

use std::ops::Range;

use eomgen_analysis::qr_iteration;
use eomgen_codegen::independence::vectors::dot;
use nalgebra::{DMatrix, DVector};

/// Rates below this fraction of the magnitude of their terms count as rounding.
pub(crate) const RATE_ROUNDING: f64 = 1e-10;

/// Singular values below this fraction of the largest count as 0; their surfaces are linearly dependent.
pub const MIN_SINGULAR_VALUE_FRACTION: f64 = 1e-10;

/// Relative increase of the diagonal of the regularised system. It is small compared with [`RATE_ROUNDING`], so
/// an error above rounding gives a value far beyond its limit.
const DIAGONAL_INCREASE: f64 = 1e-13;

/// Largest error of a row of a solved system, in roundings of its terms.
const ROW_ROUNDINGS: f64 = 64.0;

/// Number of changes per surface that select the surface with the largest error. Later changes select the first
/// surface with an error, which guarantees termination (K. G. Murty, *Linear Complementarity*, chapter 11).
const LARGEST_FIRST_CHANGES: usize = 4;

const MAX_SURFACES_TO_TRY: usize = 7;

/// Effect of a surface on a motion that has reached it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// The surface holds the motion; the number s, between -1 and 1, replaces the sign.
    Holds(f64),
    /// The surface exerts its maximum force to this side, and other surfaces hold the motion.
    AtLimit(f64),
    /// Breakaway to this side occurs.
    Releases(f64),
}

impl Verdict {
    /// Returns the number s that replaces the sign.
    pub fn sign(self) -> f64 {
        match self {
            Self::Holds(s) | Self::AtLimit(s) | Self::Releases(s) => s,
        }
    }
}

/// Arrival of a motion on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrival {
    /// Side to which the motion leaves if the surface cannot hold it, -1 or 1.
    pub side: f64,
    /// True if the surface held the motion until now and would need more than its maximum force to this side.
    pub exceeds_limit: bool,
}

/// Choice of the values s if holding surfaces are linearly dependent, so that s is not unique.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sharing {
    /// Minimises the largest magnitude: all surfaces hold as long as possible.
    LeastMaximum,
    /// Minimises the sum of squares, which makes s linear in the rates. A surface can reach its limit before
    /// others do.
    LeastSquares,
}

/// Rates of the switching functions on their surfaces, g' = c + W s, with s instead of the signs of the
/// functions.
pub struct Rates {
    /// Matrix W; each row has the unit of its function per second.
    pub w: DMatrix<f64>,
    /// Vector c, in the units of the rows of W.
    pub c: DVector<f64>,
    /// Choice of s if it is not unique.
    pub sharing: Sharing,
}

/// Determines the effect of each surface on a motion with these arrivals. Returns `None` if no solution is
/// found.
pub fn decide(rates: &Rates, arrivals: &[Arrival]) -> Option<Vec<Verdict>> {
    let count = arrivals.len();
    let begins = |(i, arrival): (usize, &Arrival)| {
        (arrival.exceeds_limit || !rates.may_hold(i)).then_some(arrival.side)
    };
    let mut sides: Vec<Option<f64>> = arrivals.iter().enumerate().map(begins).collect();
    for change in 0..20 * (count + 1) {
        let s = rates.solve_signs(&sides);
        let errors = (0..count).map(|i| rates.case_violation(&sides, &s, i));
        let wrong = errors.enumerate().filter(|(_, error)| *error > 0.0);
        let next = match change < LARGEST_FIRST_CHANGES * count {
            true => wrong.max_by(|a, b| a.1.total_cmp(&b.1)),
            false => wrong.min_by_key(|(index, _)| *index),
        };
        let Some((index, _)) = next else {
            if rates.are_held(&sides, &s) {
                return Some(rates.verdicts(&sides, &s));
            }
            break;
        };
        sides[index] = match sides[index] {
            None => Some(s[index].signum()),
            Some(_) if rates.may_hold(index) => None,
            Some(side) => Some(-side),
        };
    }
    (count <= MAX_SURFACES_TO_TRY).then(|| rates.try_all_cases(count))?
}

impl Rates {
    /// Returns true if the rates on both sides of a surface can point towards it.
    fn may_hold(&self, i: usize) -> bool {
        self.w[(i, i)] < 0.0
    }

    /// Returns the values s: the given sides, and holding values for the other surfaces.
    fn solve_signs(&self, sides: &[Option<f64>]) -> DVector<f64> {
        let mut s = DVector::from_iterator(sides.len(), sides.iter().map(|s| s.unwrap_or(0.0)));
        let held = held_surfaces(sides);
        let free = &self.c + &self.w * &s;
        let right = DVector::from_iterator(held.len(), held.iter().map(|i| -free[*i]));
        let w = DMatrix::from_fn(held.len(), held.len(), |r, c| self.w[(held[r], held[c])]);
        let (mut values, can_hold) = solve_holding(&w, &right);
        if can_hold && self.sharing == Sharing::LeastMaximum {
            let groups: Vec<Range<usize>> = (0..values.len()).map(|row| row..row + 1).collect();
            reduce_largest(&w, values.as_mut_slice(), &groups);
        }
        for (i, value) in held.iter().zip(&values) {
            s[*i] = *value;
        }
        s
    }

    /// Returns the violation of the assumed case of a surface at the values s; positive if the case is
    /// violated.
    fn case_violation(&self, sides: &[Option<f64>], s: &DVector<f64>, i: usize) -> f64 {
        match sides[i] {
            None => s[i].abs() - 1.0,
            Some(side) => {
                let (rate, size) = self.rate(s, i);
                let back = -side * rate - RATE_ROUNDING * size;
                let by_own = self.w[(i, i)].abs();
                if by_own > 0.0 { back / by_own } else { back }
            }
        }
    }

    /// Returns the rate of a surface's function and the magnitude of its terms.
    fn rate(&self, s: &DVector<f64>, i: usize) -> (f64, f64) {
        let terms = (0..s.len()).map(|j| self.w[(i, j)] * s[j]);
        terms.fold((self.c[i], self.c[i].abs()), |(sum, size), term| {
            (sum + term, size + term.abs())
        })
    }

    fn are_held(&self, sides: &[Option<f64>], s: &DVector<f64>) -> bool {
        held_surfaces(sides).into_iter().all(|i| {
            let (rate, size) = self.rate(s, i);
            rate.abs() <= 10.0 * RATE_ROUNDING * size
        })
    }

    fn verdicts(&self, sides: &[Option<f64>], s: &DVector<f64>) -> Vec<Verdict> {
        let held = held_surfaces(sides);
        let verdict = |i: usize| match sides[i] {
            None => Verdict::Holds(s[i].clamp(-1.0, 1.0)),
            Some(side) if self.is_at_rest(s, i) && self.is_dependent(&held, i) => {
                Verdict::AtLimit(side)
            }
            Some(side) => Verdict::Releases(side),
        };
        (0..sides.len()).map(verdict).collect()
    }

    /// Returns true if the rate of a surface's function is only rounding at the values s.
    fn is_at_rest(&self, s: &DVector<f64>, i: usize) -> bool {
        let (rate, size) = self.rate(s, i);
        rate.abs() <= RATE_ROUNDING * size
    }

    /// Returns true if the rates of the `held` surfaces determine the effect of the forces on the rate of
    /// surface `i`.
    fn is_dependent(&self, held: &[usize], i: usize) -> bool {
        if held.is_empty() {
            return false;
        }
        let w = DMatrix::from_fn(held.len(), held.len(), |r, c| self.w[(held[r], held[c])]);
        let column = DVector::from_iterator(held.len(), held.iter().map(|j| self.w[(*j, i)]));
        let balanced = solve_least_squares(&w, column);
        let pairs = held.iter().zip(&balanced);
        let through: f64 = pairs.map(|(j, b)| self.w[(i, *j)] * b).sum();
        let own = self.w[(i, i)];
        own != 0.0 && (own - through).abs() <= 1e-8 * own.abs()
    }

    /// Tries all cases and returns the first solution.
    fn try_all_cases(&self, count: usize) -> Option<Vec<Verdict>> {
        let cases = 3_usize.pow(count as u32);
        (0..cases).find_map(|case| {
            let side = |i: usize| match case / 3_usize.pow(i as u32) % 3 {
                0 => None,
                1 => Some(1.0),
                _ => Some(-1.0),
            };
            let sides: Vec<Option<f64>> = (0..count).map(side).collect();
            let s = self.solve_signs(&sides);
            let is_right = (0..count).all(|i| self.case_violation(&sides, &s, i) <= 0.0);
            (is_right && self.are_held(&sides, &s)).then(|| self.verdicts(&sides, &s))
        })
    }
}

/// Returns the indices of the surfaces without a side.
fn held_surfaces(sides: &[Option<f64>]) -> Vec<usize> {
    (0..sides.len()).filter(|i| sides[*i].is_none()).collect()
}

/// Returns the matrix with each row divided by its largest magnitude, and these magnitudes (1 for a zero row).
/// The rows of W have different units.
pub fn divide_rows(w: &DMatrix<f64>) -> (DMatrix<f64>, DVector<f64>) {
    let sizes = w.row_iter().map(|row| row.amax());
    let sizes = sizes.map(|size| if size > 0.0 { size } else { 1.0 });
    let sizes = DVector::from_iterator(w.nrows(), sizes);
    let divided = w.map_with_location(|row, _, entry| entry / sizes[row]);
    (divided, sizes)
}

/// Returns the least-squares solution x of W x = b with the smallest norm. If a row is not solved to rounding,
/// the rows are divided by their largest magnitudes, because their units may differ by decades. The scaled
/// solution is returned if it solves all rows.
pub fn solve_least_squares(w: &DMatrix<f64>, b: DVector<f64>) -> DVector<f64> {
    if b.len() <= 1 {
        let divided = b.zip_map(&w.column_sum(), |b, w| b / w);
        return divided.map(|x| if x.is_finite() { x } else { 0.0 });
    }
    let plain = solve_refined(w, &b);
    if are_rows_solved(w, &b, &plain) {
        return plain;
    }
    let (divided, sizes) = divide_rows(w);
    let scaled = solve_refined(&divided, &b.component_div(&sizes));
    match are_rows_solved(w, &b, &scaled) {
        true => scaled,
        false => plain,
    }
}

/// Returns values x that hold surfaces, W x = b, and true; the values have the smallest norm if surfaces are
/// linearly dependent. If no values hold all surfaces, because dependent surfaces move apart, returns values
/// beyond their limits and false.
pub fn solve_holding(w: &DMatrix<f64>, b: &DVector<f64>) -> (DVector<f64>, bool) {
    let values = solve_least_squares(w, b.clone());
    if b.len() <= 1 {
        return (values, true);
    }
    let errors = w * &values - b;
    let is_held = |(row, error): (usize, &f64)| {
        let largest: f64 = w.row(row).iter().map(|entry| entry.abs()).sum();
        error.abs() <= RATE_ROUNDING * largest
    };
    if errors.iter().enumerate().all(is_held) {
        return (values, true);
    }
    match solve_regularised(w, b) {
        Some(beyond) => (beyond, false),
        None => (values, true),
    }
}

/// Returns a solution of W x = b with a slightly increased diagonal. It is finite even if rows contradict each
/// other, and then far beyond the limits of forces.
pub(crate) fn solve_regularised(w: &DMatrix<f64>, b: &DVector<f64>) -> Option<DVector<f64>> {
    let (mut divided, sizes) = divide_rows(w);
    for own in 0..w.nrows() {
        divided[(own, own)] *= 1.0 + DIAGONAL_INCREASE;
    }
    divided.lu().solve(&b.component_div(&sizes))
}

/// Returns the least-squares solution with the smallest norm; 0 if there is none. One refinement step reduces
/// the error of each row to a rounding of its terms (R. D. Skeel, Math. Comp. 35 (1980) 817-832).
fn solve_refined(w: &DMatrix<f64>, b: &DVector<f64>) -> DVector<f64> {
    let zero = || DVector::zeros(b.len());
    let Some(svd) = qr_iteration::svd(w).filter(|_| b.iter().all(|entry| entry.is_finite())) else {
        return zero();
    };
    let least = MIN_SINGULAR_VALUE_FRACTION * svd.singular_values.max();
    let solve = |right: &DVector<f64>| svd.solve(right, least).unwrap_or_else(|_| zero());
    let solution = solve(b);
    let correction = solve(&(b - w * &solution));
    solution + correction
}

/// Returns true if each row of W x = b is satisfied up to rounding of its terms.
fn are_rows_solved(w: &DMatrix<f64>, b: &DVector<f64>, x: &DVector<f64>) -> bool {
    w.row_iter().zip(b).all(|(row, right)| {
        let terms = row.iter().zip(x).map(|(entry, x)| entry * x);
        let (sum, size) = terms.fold((-right, right.abs()), |(sum, size), term| {
            (sum + term, size + term.abs())
        });
        sum.abs() <= ROW_ROUNDINGS * f64::EPSILON * size
    })
}

/// Maximum number of passes over the null-space directions.
const MAX_PASSES: usize = 20;

/// Relative reduction of the largest magnitude in a pass below which the iteration ends.
const MIN_REDUCTION: f64 = 1e-3;

/// Reduces the largest magnitude of the values s without changing W s: dependent surfaces share their forces,
/// so all of them hold as long as possible. Each of the `groups` of rows is a vector and counts by its length.
pub fn reduce_largest(w: &DMatrix<f64>, s: &mut [f64], groups: &[Range<usize>]) {
    if s.len() <= 1 {
        return;
    }
    let Some(v) = qr_iteration::svd(&divide_rows(w).0) else {
        return;
    };
    let most = v.singular_values.max();
    let Some(rows) = v.v_t else { return };
    let null = v.singular_values.iter().enumerate();
    let null = null.filter(|(_, value)| **value <= MIN_SINGULAR_VALUE_FRACTION * most);
    let null: Vec<DVector<f64>> = null.map(|(row, _)| rows.row(row).transpose()).collect();
    for _ in 0..MAX_PASSES {
        let before = largest_length(s, groups);
        for own in groups {
            let direction = project_group(&null, (&*s, own));
            let squares = squares_along(s, &direction, groups);
            let step = find_best_step(&squares);
            let entries = s.iter_mut().zip(&direction);
            entries.for_each(|(entry, part)| *entry += step * part);
        }
        if null.len() <= 1 || largest_length(s, groups) > before * (1.0 - MIN_REDUCTION) {
            return;
        }
    }
}

/// Returns the projection of the vector of one group of rows onto the null space of W. The projection does not
/// depend on the axes of the group.
fn project_group(null: &[DVector<f64>], (s, own): (&[f64], &Range<usize>)) -> Vec<f64> {
    let mut projection = vec![0.0; s.len()];
    for direction in null {
        let part = dot(&direction.as_slice()[own.clone()], &s[own.clone()]);
        let entries = projection.iter_mut().zip(direction.iter());
        entries.for_each(|(entry, along)| *entry += part * along);
    }
    projection
}

fn largest_length(s: &[f64], groups: &[Range<usize>]) -> f64 {
    let squares = groups
        .iter()
        .map(|rows| dot(&s[rows.clone()], &s[rows.clone()]));
    squares.fold(0.0, f64::max).sqrt()
}

/// Squared length of a vector a + x b as a function of x.
struct SquareAlong {
    /// b b
    second: f64,
    /// a b
    first: f64,
    /// a a
    constant: f64,
}

impl SquareAlong {
    fn evaluate(&self, step: f64) -> f64 {
        (self.second * step + 2.0 * self.first) * step + self.constant
    }
}

/// Returns the squared lengths of all vectors along a direction.
fn squares_along(values: &[f64], direction: &[f64], groups: &[Range<usize>]) -> Vec<SquareAlong> {
    let squares = groups.iter().map(|rows| {
        let (a, b) = (&values[rows.clone()], &direction[rows.clone()]);
        SquareAlong {
            second: dot(b, b),
            first: dot(a, b),
            constant: dot(a, a),
        }
    });
    squares.collect()
}

fn largest_square_after(squares: &[SquareAlong], step: f64) -> f64 {
    let after = squares.iter().map(|square| square.evaluate(step));
    after.fold(0.0, f64::max)
}

/// Returns the step that minimises the largest squared length: the minimum of one of them, or an intersection
/// of two.
fn find_best_step(squares: &[SquareAlong]) -> f64 {
    let mut best = (0.0, largest_square_after(squares, 0.0));
    for (i, a) in squares.iter().enumerate() {
        let minimum = -a.first / a.second;
        let equal = squares[i + 1..].iter().flat_map(|b| {
            let [second, first, constant] = [
                a.second - b.second,
                a.first - b.first,
                a.constant - b.constant,
            ];
            let root = (first * first - second * constant).max(0.0).sqrt();
            let sum = -(first + root.copysign(first));
            [sum / second, constant / sum]
        });
        for step in std::iter::once(minimum).chain(equal) {
            if step.is_finite() {
                let largest = largest_square_after(squares, step);
                if largest < best.1 {
                    best = (step, largest);
                }
            }
        }
    }
    best.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random_numbers::Numbers;

    const UP: Arrival = Arrival {
        side: 1.0,
        exceeds_limit: false,
    };

    /// Returns friction in random directions in a space of this dimension, with a load.
    fn frictions(seed: u64, count: usize, dimensions: usize) -> Rates {
        let mut numbers = Numbers::new(seed);
        let j = DMatrix::from_fn(count, dimensions, |_, _| numbers.draw());
        let load = DVector::from_fn(dimensions, |_, _| 3.0 * numbers.draw());
        let levels = DVector::from_fn(count, |_, _| 0.1 + numbers.draw().abs());
        Rates {
            w: -(&j * j.transpose() * DMatrix::from_diagonal(&levels)),
            c: &j * load,
            sharing: Sharing::LeastMaximum,
        }
    }

    #[test]
    fn random_frictions_satisfy_complementarity() {
        for seed in 1..3000 {
            let count = 1 + (seed % 8) as usize;
            let rates = frictions(seed, count, 1 + (seed / 8 % 7) as usize);
            let found = decide(&rates, &vec![UP; count]);
            let found = found.unwrap_or_else(|| panic!("{seed}: no answer"));
            let s = DVector::from_iterator(count, found.iter().map(|verdict| verdict.sign()));
            for (i, verdict) in found.iter().enumerate() {
                let (rate, size) = rates.rate(&s, i);
                let is_right = match verdict {
                    Verdict::Holds(s) => s.abs() <= 1.0 && rate.abs() < 1e-8 * size,
                    Verdict::AtLimit(s) => s.abs() == 1.0 && rate.abs() < 1e-7 * size,
                    Verdict::Releases(s) => s.abs() == 1.0 && s * rate >= -1e-9 * size,
                };
                assert!(is_right, "{seed}: {verdict:?}, rate {rate:e}");
            }
        }
    }

    #[test]
    fn two_frictions_on_one_surface_add_their_levels() {
        let rates = |load: f64| Rates {
            w: DMatrix::from_row_slice(2, 2, &[-1.0, -2.0, -1.0, -2.0]),
            c: DVector::from_element(2, load),
            sharing: Sharing::LeastMaximum,
        };
        for load in [0.5, 1.7, 2.9, 2.999] {
            let found = decide(&rates(load), &[UP, UP]).expect("an answer");
            let borne = found[0].sign() + 2.0 * found[1].sign();
            assert!((borne - load).abs() < 1e-12, "{load}: {found:?}");
            let lets_go = |verdict: &Verdict| matches!(verdict, Verdict::Releases(_));
            assert!(!found.iter().any(lets_go), "{load}: {found:?}");
        }
        let found = decide(&rates(3.001), &[UP, UP]).expect("an answer");
        assert_eq!(found, [Verdict::Releases(1.0), Verdict::Releases(1.0)]);
    }

    #[test]
    fn repelling_surface_is_crossed() {
        let rates = Rates {
            w: DMatrix::from_element(1, 1, 2.0),
            c: DVector::from_element(1, 0.5),
            sharing: Sharing::LeastMaximum,
        };
        for side in [1.0, -1.0] {
            let found = decide(&rates, &[Arrival { side, ..UP }]).expect("an answer");
            assert_eq!(found, [Verdict::Releases(side)]);
        }
    }

    #[test]
    fn discs_share_a_force_by_length_in_every_direction() {
        // Two discs with the friction levels 3 and 1 and the same velocity in a plane.
        let w = -DMatrix::from_fn(4, 4, |row, column| {
            let level = if column < 2 { 3.0 } else { 1.0 };
            level * f64::from(u8::from(row % 2 == column % 2))
        });
        for angle in [0.0_f64, 0.4, 2.1, 3.9] {
            let load = DVector::from_fn(4, |row, _| [angle.cos(), angle.sin()][row % 2]);
            let mut s = solve_least_squares(&w, -load.clone());
            reduce_largest(&w, s.as_mut_slice(), &[0..2, 2..4]);
            assert!((&w * &s + &load).amax() < 1e-12, "{angle}: {s}");
            for disc in [0..2, 2..4] {
                let length = dot(&s.as_slice()[disc.clone()], &s.as_slice()[disc]).sqrt();
                assert!((length - 0.25).abs() < 1e-9, "{angle}: {s}");
            }
        }
        // A contact with a wall bears the force normal to the wall.
        let along = DVector::from_vec(vec![0.8, 0.6]);
        let w = -(&along * along.transpose());
        let mut s = &along * 0.7;
        reduce_largest(&w, s.as_mut_slice(), std::slice::from_ref(&(0..2)));
        assert!((&s - &along * 0.7).amax() < 1e-12, "{s}");
    }
}
