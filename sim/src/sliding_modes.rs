//! Which of several switching surfaces hold a motion that stands on them: its sliding mode (A. F. Filippov).
//!
//! With s_i between -1 and 1 in the place of sign(g_i) the rates are g' = c + W s. A surface holds
//! the motion where its rate is zero, and lets it go to the side s_i = 1 or -1 where its rate leads
//! there. That is a linear complementarity problem with bounds; of friction W is -J M^-1 J^T times the
//! friction's levels, and the rates that solve it are unique.

use eomgen_analysis::qr_iteration;
use nalgebra::{DMatrix, DVector};

/// Parts of a rate that are this small beside its terms are rounding.
const ROUNDING: f64 = 1e-10;

/// Singular values that are this small beside the largest belong to surfaces that follow from others.
pub const DEPENDENT: f64 = 1e-10;

/// So many changes for each surface take that of the largest error, then the first one is taken,
/// which comes to an end (K. G. Murty, *Linear Complementarity*, chapter 11).
const LARGEST_FIRST: usize = 4;

/// All cases are tried of so many surfaces at most.
const MOST_TO_TRY: usize = 7;

/// What a surface does to a motion that stands on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// It holds it, with this number in the place of the sign.
    Holds(f64),
    /// It bears all it can to this side, and the motion stays, as other surfaces hold it.
    Bears(f64),
    /// It lets it go to this side.
    LetsGo(f64),
}

impl Verdict {
    /// The number in the place of the sign.
    pub fn sign(self) -> f64 {
        match self {
            Self::Holds(s) | Self::Bears(s) | Self::LetsGo(s) => s,
        }
    }
}

/// How a motion comes to stand on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrival {
    /// The side to which it goes, -1 or 1, where the surface cannot hold it.
    pub side: f64,
    /// Whether the surface held it so far and would have to bear more than it can to this side.
    pub is_overcome: bool,
}

/// The rates of the functions g that the surfaces are the zeros of, g' = c + W s, where s stands in the place of
/// their signs.
pub struct Rates {
    /// W, in the unit of each row's function per second.
    pub w: DMatrix<f64>,
    /// c, in the same units.
    pub c: DVector<f64>,
}

/// What each surface does to a motion that came to them so. Nothing where no answer was found.
pub fn decide(rates: &Rates, arrivals: &[Arrival]) -> Option<Vec<Verdict>> {
    let count = arrivals.len();
    let begins = |(i, arrival): (usize, &Arrival)| {
        (arrival.is_overcome || !rates.may_hold(i)).then_some(arrival.side)
    };
    let mut sides: Vec<Option<f64>> = arrivals.iter().enumerate().map(begins).collect();
    for change in 0..20 * (count + 1) {
        let s = rates.signs(&sides);
        let errors = (0..count).map(|i| rates.error(&sides, &s, i));
        let wrong = errors.enumerate().filter(|(_, error)| *error > 0.0);
        let next = match change < LARGEST_FIRST * count {
            true => wrong.max_by(|a, b| a.1.total_cmp(&b.1)),
            false => wrong.min_by_key(|(place, _)| *place),
        };
        let Some((place, _)) = next else {
            if rates.are_held(&sides, &s) {
                return Some(rates.verdicts(&sides, &s));
            }
            break;
        };
        sides[place] = match sides[place] {
            None => Some(s[place].signum()),
            Some(_) if rates.may_hold(place) => None,
            Some(side) => Some(-side),
        };
    }
    (count <= MOST_TO_TRY).then(|| rates.by_trial(count))?
}

impl Rates {
    /// Whether the rates on both sides of a surface may lead back to it.
    fn may_hold(&self, i: usize) -> bool {
        self.w[(i, i)] < 0.0
    }

    /// The numbers in the place of the signs: the smallest that hold where no side is given.
    fn signs(&self, sides: &[Option<f64>]) -> DVector<f64> {
        let mut s = DVector::from_iterator(sides.len(), sides.iter().map(|s| s.unwrap_or(0.0)));
        let held = held(sides);
        let free = &self.c + &self.w * &s;
        let right = DVector::from_iterator(held.len(), held.iter().map(|i| -free[*i]));
        let w = DMatrix::from_fn(held.len(), held.len(), |r, c| self.w[(held[r], held[c])]);
        for (i, value) in held.iter().zip(&least(w, right)) {
            s[*i] = *value;
        }
        s
    }

    /// By how much a surface is not what it was taken for, in numbers s.
    fn error(&self, sides: &[Option<f64>], s: &DVector<f64>, i: usize) -> f64 {
        match sides[i] {
            None => s[i].abs() - 1.0,
            Some(side) => {
                let (rate, size) = self.rate(s, i);
                let back = -side * rate - ROUNDING * size;
                let by_own = self.w[(i, i)].abs();
                if by_own > 0.0 { back / by_own } else { back }
            }
        }
    }

    /// The rate of a surface's function, and how large its terms are.
    fn rate(&self, s: &DVector<f64>, i: usize) -> (f64, f64) {
        let terms = (0..s.len()).map(|j| self.w[(i, j)] * s[j]);
        terms.fold((self.c[i], self.c[i].abs()), |(sum, size), term| {
            (sum + term, size + term.abs())
        })
    }

    /// Whether those without a side are held.
    fn are_held(&self, sides: &[Option<f64>], s: &DVector<f64>) -> bool {
        held(sides).into_iter().all(|i| {
            let (rate, size) = self.rate(s, i);
            rate.abs() <= 10.0 * ROUNDING * size
        })
    }

    fn verdicts(&self, sides: &[Option<f64>], s: &DVector<f64>) -> Vec<Verdict> {
        let held = held(sides);
        let verdict = |i: usize| match sides[i] {
            None => Verdict::Holds(s[i].clamp(-1.0, 1.0)),
            Some(side) if self.follows(&held, i) => Verdict::Bears(side),
            Some(side) => Verdict::LetsGo(side),
        };
        (0..sides.len()).map(verdict).collect()
    }

    /// Whether a surface's rate is zero where those of others are.
    fn follows(&self, held: &[usize], i: usize) -> bool {
        if held.is_empty() {
            return false;
        }
        let w = DMatrix::from_fn(held.len(), held.len(), |r, c| self.w[(held[r], held[c])]);
        let column = DVector::from_iterator(held.len(), held.iter().map(|j| self.w[(*j, i)]));
        let balanced = least(w, column);
        let pairs = held.iter().zip(&balanced);
        let through: f64 = pairs.map(|(j, b)| self.w[(i, *j)] * b).sum();
        let own = self.w[(i, i)];
        own != 0.0 && (own - through).abs() <= 1e-8 * own.abs()
    }

    /// The first of all cases that is an answer.
    fn by_trial(&self, count: usize) -> Option<Vec<Verdict>> {
        let cases = 3_usize.pow(count as u32);
        (0..cases).find_map(|case| {
            let side = |i: usize| match case / 3_usize.pow(i as u32) % 3 {
                0 => None,
                1 => Some(1.0),
                _ => Some(-1.0),
            };
            let sides: Vec<Option<f64>> = (0..count).map(side).collect();
            let s = self.signs(&sides);
            let is_right = (0..count).all(|i| self.error(&sides, &s, i) <= 0.0);
            (is_right && self.are_held(&sides, &s)).then(|| self.verdicts(&sides, &s))
        })
    }
}

/// Those without a side.
fn held(sides: &[Option<f64>]) -> Vec<usize> {
    (0..sides.len()).filter(|i| sides[*i].is_none()).collect()
}

/// The smallest x with W x = b, or with as small a difference as there can be.
pub fn least(w: DMatrix<f64>, b: DVector<f64>) -> DVector<f64> {
    if b.len() <= 1 {
        let divided = b.zip_map(&w.column_sum(), |b, w| b / w);
        return divided.map(|x| if x.is_finite() { x } else { 0.0 });
    }
    let zero = || DVector::zeros(b.len());
    let Some(svd) = qr_iteration::svd(&w).filter(|_| b.iter().all(|entry| entry.is_finite()))
    else {
        return zero();
    };
    let most = svd.singular_values.max();
    svd.solve(&b, DEPENDENT * most).unwrap_or_else(|_| zero())
}

#[cfg(test)]
mod tests {
    use super::*;

    const UP: Arrival = Arrival {
        side: 1.0,
        is_overcome: false,
    };

    struct Numbers(u64);

    impl Numbers {
        fn next(&mut self) -> f64 {
            self.0 ^= self.0 << 13;
            self.0 ^= self.0 >> 7;
            self.0 ^= self.0 << 17;
            (self.0 >> 11) as f64 / (1_u64 << 53) as f64 * 2.0 - 1.0
        }
    }

    /// Frictions of random directions in so many dimensions, and a load.
    fn frictions(seed: u64, count: usize, dimensions: usize) -> Rates {
        let mut numbers = Numbers(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
        let j = DMatrix::from_fn(count, dimensions, |_, _| numbers.next());
        let load = DVector::from_fn(dimensions, |_, _| 3.0 * numbers.next());
        let levels = DVector::from_fn(count, |_, _| 0.1 + numbers.next().abs());
        Rates {
            w: -(&j * j.transpose() * DMatrix::from_diagonal(&levels)),
            c: &j * load,
        }
    }

    #[test]
    fn every_surface_holds_or_lets_go_to_the_side_its_rate_leads_to() {
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
                    Verdict::Bears(s) => s.abs() == 1.0 && rate.abs() < 1e-7 * size,
                    Verdict::LetsGo(s) => s.abs() == 1.0 && s * rate >= -1e-9 * size,
                };
                assert!(is_right, "{seed}: {verdict:?}, rate {rate:e}");
            }
        }
    }

    #[test]
    fn two_frictions_at_one_place_bear_together_what_they_can() {
        let rates = |load: f64| Rates {
            w: DMatrix::from_row_slice(2, 2, &[-1.0, -2.0, -1.0, -2.0]),
            c: DVector::from_element(2, load),
        };
        for load in [0.5, 1.7, 2.9, 2.999] {
            let found = decide(&rates(load), &[UP, UP]).expect("an answer");
            let borne = found[0].sign() + 2.0 * found[1].sign();
            assert!((borne - load).abs() < 1e-12, "{load}: {found:?}");
            let lets_go = |verdict: &Verdict| matches!(verdict, Verdict::LetsGo(_));
            assert!(!found.iter().any(lets_go), "{load}: {found:?}");
        }
        let found = decide(&rates(3.001), &[UP, UP]).expect("an answer");
        assert_eq!(found, [Verdict::LetsGo(1.0), Verdict::LetsGo(1.0)]);
    }

    #[test]
    fn a_surface_that_pushes_away_is_gone_over() {
        let rates = Rates {
            w: DMatrix::from_element(1, 1, 2.0),
            c: DVector::from_element(1, 0.5),
        };
        for side in [1.0, -1.0] {
            let found = decide(&rates, &[Arrival { side, ..UP }]).expect("an answer");
            assert_eq!(found, [Verdict::LetsGo(side)]);
        }
    }
}
