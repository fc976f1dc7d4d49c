//! Dry friction opposite to a sliding velocity with two or three components, together with scalar switching
//! surfaces.
//!
//! The rates of the sliding velocities are u = c + W s. A scalar surface has |s| <= 1, and s = sign(u) if u is
//! not 0. A disc is the set of friction vectors s with |s| <= 1, and s = u/|u| if u is not 0. Gauss-Seidel
//! sweeps solve one surface or disc after another exactly (F. Jourdan, P. Alart, M. Jean 1998). If they
//! converge slowly, Newton's method solves s = P(s + r u), P the projection onto the bounds (P. Alart, A.
//! Curnier 1991). The fixed-point residual verifies the result.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use crate::sliding_modes::{Arrival, RATE_ROUNDING, Rates, Verdict, decide, solve_least_squares};

const MAX_SWEEPS: usize = 300;

const MAX_NEWTON_STEPS: usize = 50;

/// Maximum number of halvings of a Newton step that does not reduce the residual.
const MAX_HALVINGS: usize = 20;

/// Change of s in a sweep below which the sweeps have converged.
const CONVERGED_CHANGE: f64 = 1e-14;

/// Largest residual of a solution.
const MAX_RESIDUAL: f64 = 1e-9;

/// Number of bisections for the rate of a sliding disc; more than a number has bits.
const BISECTIONS: usize = 200;

/// Arrival of a motion on a disc with zero sliding velocity.
#[derive(Clone, Debug)]
pub struct DiscArrival {
    /// Rows of the sliding velocity in the matrix of the rates.
    pub rows: Range<usize>,
    /// Unit vector of the direction in which the motion leaves if the disc cannot hold it.
    pub along: Vec<f64>,
    /// True if the disc held the motion until now and would need more than its maximum force.
    pub exceeds_limit: bool,
}

/// Effect of a disc on a motion.
#[derive(Clone, Debug, PartialEq)]
pub enum DiscVerdict {
    /// The disc holds the motion with this friction vector.
    Holds(Vec<f64>),
    /// The motion slides in the direction of this unit vector.
    Slides(Vec<f64>),
}

impl DiscVerdict {
    /// Returns the friction vector s of the disc.
    pub fn vector(&self) -> &[f64] {
        match self {
            Self::Holds(s) | Self::Slides(s) => s,
        }
    }
}

/// Determines whether scalar surfaces, whose rows come first, and discs hold the motion. Returns `None` if no
/// solution is found.
pub fn decide_with_discs(
    rates: &Rates,
    arrivals: &[Arrival],
    discs: &[DiscArrival],
) -> Option<(Vec<Verdict>, Vec<DiscVerdict>)> {
    if discs.is_empty() {
        return Some((decide(rates, arrivals)?, Vec::new()));
    }
    let problem = Problem {
        rates,
        arrivals,
        discs,
    };
    let s = problem.solve()?;
    let u = &rates.c + &rates.w * &s;
    let scalars = arrivals.iter().enumerate().map(|(row, arrival)| {
        let terms = rates.c[row].abs()
            + (0..s.len())
                .map(|j| (rates.w[(row, j)] * s[j]).abs())
                .sum::<f64>();
        let is_moving = s[row] * u[row] > RATE_ROUNDING * terms;
        match s[row].abs() < 1.0 || !(is_moving || arrival.exceeds_limit) {
            true => Verdict::Holds(s[row]),
            false => Verdict::Releases(s[row].signum()),
        }
    });
    let vectors = discs.iter().map(|disc| {
        let own = rows(&s, &disc.rows);
        let length = own.norm();
        let rate = rows(&u, &disc.rows).norm();
        let size = rows(&rates.c, &disc.rows).norm() + problem.disc_matrix(disc).norm();
        let is_sliding = length >= 1.0 - CONVERGED_CHANGE && rate > RATE_ROUNDING * size;
        match is_sliding || disc.exceeds_limit || !problem.may_hold(disc) {
            true => DiscVerdict::Slides((own / length).iter().copied().collect()),
            false => DiscVerdict::Holds(own.iter().copied().collect()),
        }
    });
    Some((scalars.collect(), vectors.collect()))
}

struct Problem<'p> {
    rates: &'p Rates,
    arrivals: &'p [Arrival],
    discs: &'p [DiscArrival],
}

impl Problem<'_> {
    fn solve(&self) -> Option<DVector<f64>> {
        let mut s = DVector::zeros(self.rates.c.len());
        for _ in 0..MAX_SWEEPS {
            let before = s.clone();
            self.sweep(&mut s);
            if (&s - before).amax() <= CONVERGED_CHANGE {
                return Some(s);
            }
        }
        if self.residual(&s) > MAX_RESIDUAL {
            s = self.solve_by_newton(s);
        }
        (self.residual(&s) <= MAX_RESIDUAL).then_some(s)
    }

    /// Solves each surface and each disc once, in order.
    fn sweep(&self, s: &mut DVector<f64>) {
        for row in 0..self.arrivals.len() {
            s[row] = self.solve_scalar(s, row);
        }
        for disc in self.discs {
            let solved = self.solve_disc(s, disc);
            s.rows_mut(disc.rows.start, disc.rows.len())
                .copy_from(&solved);
        }
    }

    /// Returns the largest change of s if each surface and disc is solved on its own.
    fn residual(&self, s: &DVector<f64>) -> f64 {
        let scalars =
            (0..self.arrivals.len()).map(|row| (self.solve_scalar(s, row) - s[row]).abs());
        let discs = self.discs.iter();
        let discs = discs.map(|disc| (self.solve_disc(s, disc) - rows(s, &disc.rows)).norm());
        let largest = |most: f64, change: f64| {
            if change > most || change.is_nan() {
                change
            } else {
                most
            }
        };
        scalars.chain(discs).fold(0.0, largest)
    }

    fn solve_scalar(&self, s: &DVector<f64>, row: usize) -> f64 {
        let own = self.rates.w[(row, row)];
        if own >= 0.0 {
            return self.arrivals[row].side;
        }
        let free = self.rates.c[row] + self.rates.w.row(row).transpose().dot(s) - own * s[row];
        (-free / own).clamp(-1.0, 1.0)
    }

    fn disc_matrix(&self, disc: &DiscArrival) -> DMatrix<f64> {
        let (start, count) = (disc.rows.start, disc.rows.len());
        self.rates
            .w
            .view((start, start), (count, count))
            .into_owned()
    }

    /// Returns true if the friction of the disc cannot drive the sliding velocity.
    fn may_hold(&self, disc: &DiscArrival) -> bool {
        self.disc_matrix(disc).trace() <= 0.0
    }

    fn solve_disc(&self, s: &DVector<f64>, disc: &DiscArrival) -> DVector<f64> {
        let own = self.disc_matrix(disc);
        if !self.may_hold(disc) {
            return DVector::from_column_slice(&disc.along);
        }
        let all = &self.rates.c + &self.rates.w * s;
        let free = rows(&all, &disc.rows) - &own * rows(s, &disc.rows);
        if own.amax() == 0.0 {
            // Contact forces stop the sliding or drive it.
            return free.clone() / free.norm().max(f64::MIN_POSITIVE);
        }
        let held = solve_least_squares(&own, -free.clone());
        let rest = (&free + &own * &held).norm();
        if held.norm() <= 1.0 && rest <= RATE_ROUNDING * (free.norm() + own.norm()) {
            return held;
        }
        // u = k s with |s| = 1 and k > 0: (k - W) s = c.
        let at = |rate: f64| {
            let matrix = DMatrix::identity(free.len(), free.len()) * rate - &own;
            matrix.lu().solve(&free)
        };
        let (mut low, mut high) = (0.0, free.norm());
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            match at(middle).is_none_or(|s| s.norm() > 1.0) {
                true => low = middle,
                false => high = middle,
            }
        }
        at(high).map_or(held, |s| s.normalize())
    }

    /// Solves s = P(s + r u) by Newton's method from `s`.
    fn solve_by_newton(&self, mut s: DVector<f64>) -> DVector<f64> {
        let count = s.len();
        let mut errors = self.projection_error(&s).0;
        for _ in 0..MAX_NEWTON_STEPS {
            let (error, derivative) = self.projection_error(&s);
            let step = solve_least_squares(&derivative, -error);
            let mut part = 1.0;
            let mut is_better = false;
            for _ in 0..MAX_HALVINGS {
                let trial = &s + &step * part;
                let error = self.projection_error(&trial).0;
                if error.norm() < errors.norm() {
                    (s, errors, is_better) = (trial, error, true);
                    break;
                }
                part *= 0.5;
            }
            if !is_better || step.amax() <= CONVERGED_CHANGE * count as f64 {
                break;
            }
        }
        s
    }

    /// Returns s - P(s + r u) and its derivative.
    fn projection_error(&self, s: &DVector<f64>) -> (DVector<f64>, DMatrix<f64>) {
        let count = s.len();
        let u = &self.rates.c + &self.rates.w * s;
        let mut projected = DVector::zeros(count);
        let mut derivative = DMatrix::zeros(count, count);
        let blocks = (0..self.arrivals.len()).map(|row| row..row + 1);
        for block in blocks.chain(self.discs.iter().map(|disc| disc.rows.clone())) {
            let (start, size) = (block.start, block.len());
            let own = self.rates.w.view((start, start), (size, size)).norm();
            let factor = if own > 0.0 { 1.0 / own } else { 1.0 };
            let moved = rows(s, &block) + rows(&u, &block) * factor;
            let length = moved.norm();
            let by_moved = match length <= 1.0 {
                true => DMatrix::identity(size, size),
                false => {
                    let unit = &moved / length;
                    (DMatrix::identity(size, size) - &unit * unit.transpose()) / length
                }
            };
            let limited = &moved / length.max(1.0);
            projected.rows_mut(start, size).copy_from(&limited);
            let mut of_moved = DMatrix::zeros(size, count);
            of_moved.copy_from(&(self.rates.w.rows(start, size) * factor));
            for row in 0..size {
                of_moved[(row, start + row)] += 1.0;
            }
            let rows = &by_moved * of_moved;
            derivative.rows_mut(start, size).copy_from(&rows);
        }
        (s - projected, DMatrix::identity(count, count) - derivative)
    }
}

fn rows(of: &DVector<f64>, rows: &Range<usize>) -> DVector<f64> {
    of.rows(rows.start, rows.len()).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random_numbers::Numbers;
    use crate::sliding_modes::Sharing;

    /// Returns the rates of discs with two or three components and of scalar frictions on bodies with a common
    /// mass matrix, and their arrivals.
    fn random_problem(seed: u64) -> (Rates, Vec<Arrival>, Vec<DiscArrival>) {
        let mut numbers = Numbers::new(seed);
        let scalars = (seed % 3) as usize;
        let mut count = scalars;
        let mut discs = Vec::new();
        for disc in 0..1 + (seed / 3 % 3) as usize {
            let size = 2 + (seed as usize / 9 + disc) % 2;
            discs.push(DiscArrival {
                rows: count..count + size,
                along: vec![1.0; size],
                exceeds_limit: false,
            });
            count += size;
        }
        let freedoms = 2 + (seed / 27 % 9) as usize;
        let j = DMatrix::from_fn(count, freedoms, |_, _| numbers.draw());
        let load = DVector::from_fn(freedoms, |_, _| 3.0 * numbers.draw());
        let mut levels = DVector::from_fn(count, |_, _| 0.1 + numbers.draw().abs());
        for disc in &discs {
            let level = levels[disc.rows.start];
            levels
                .rows_mut(disc.rows.start, disc.rows.len())
                .fill(level);
        }
        let rates = Rates {
            w: -(&j * j.transpose() * DMatrix::from_diagonal(&levels)),
            c: &j * load,
            sharing: Sharing::LeastMaximum,
        };
        let arrival = Arrival {
            side: 1.0,
            exceeds_limit: false,
        };
        (rates, vec![arrival; scalars], discs)
    }

    #[test]
    fn random_discs_satisfy_the_inclusion() {
        let mut unsolved = 0;
        for seed in 1..2000 {
            let (rates, arrivals, discs) = random_problem(seed);
            let Some((scalars, vectors)) = decide_with_discs(&rates, &arrivals, &discs) else {
                unsolved += 1;
                continue;
            };
            let mut s: Vec<f64> = scalars.iter().map(|verdict| verdict.sign()).collect();
            s.extend(vectors.iter().flat_map(|verdict| verdict.vector().to_vec()));
            let s = DVector::from_vec(s);
            let u = &rates.c + &rates.w * &s;
            let size = rates.c.norm();
            for (disc, verdict) in discs.iter().zip(&vectors) {
                let (own, rate) = (rows(&s, &disc.rows), rows(&u, &disc.rows));
                match verdict {
                    DiscVerdict::Holds(_) => {
                        assert!(
                            own.norm() <= 1.0 + 1e-12 && rate.norm() < 1e-7 * size,
                            "{seed}"
                        );
                    }
                    DiscVerdict::Slides(_) => {
                        assert!((own.norm() - 1.0).abs() < 1e-12, "{seed}");
                        let across = (&rate - &own * rate.norm()).norm();
                        assert!(across < 1e-7 * size, "{seed}: {rate} {own}");
                    }
                }
            }
            for (row, verdict) in scalars.iter().enumerate() {
                let is_right = match verdict {
                    Verdict::Releases(side) => side * u[row] > 0.0,
                    _ => u[row].abs() < 1e-7 * size,
                };
                assert!(is_right, "{seed}: {verdict:?} {}", u[row]);
            }
        }
        assert!(unsolved <= 5, "{unsolved} unsolved");
    }

    #[test]
    fn disc_holds_up_to_its_limit_in_every_direction() {
        for (angle, load) in [(0.3_f64, 0.99), (2.0, 0.5), (4.0, 1.01), (5.5, 3.0)] {
            let c = DVector::from_vec(vec![load * angle.cos(), load * angle.sin()]);
            let w = -DMatrix::identity(2, 2);
            let disc = DiscArrival {
                rows: 0..2,
                along: vec![1.0, 0.0],
                exceeds_limit: false,
            };
            let (_, found) = decide_with_discs(
                &Rates {
                    w,
                    c,
                    sharing: Sharing::LeastMaximum,
                },
                &[],
                &[disc],
            )
            .unwrap();
            let holds = matches!(found[0], DiscVerdict::Holds(_));
            assert_eq!(holds, load < 1.0);
            let s = found[0].vector();
            assert!((s[1].atan2(s[0]) - angle).sin().abs() < 1e-12);
        }
    }
}
