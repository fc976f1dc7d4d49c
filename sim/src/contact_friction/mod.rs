//! Unilateral contacts with Coulomb friction along one direction each.
//!
//! The rates of the distances and the slips are u = c + W p. p are the normal and the tangential impulses; for
//! forces, u are accelerations. A normal impulse is not negative, and is 0 if the distance grows. A tangential
//! impulse is at most mu times the normal impulse, and opposes a nonzero slip. For given modes of the contacts
//! this is a linear system; [`ContactProblem::decide`] finds the modes. `lemke` solves the linear
//! complementarity problem (C. Glocker, F. Pfeiffer 1992), and `impact` computes a single impact with friction.
//!
//! All quantities are scaled by the square roots of the diagonal of W, which makes different units comparable.

mod balance;
mod impact;
mod lemke;
#[cfg(test)]
mod tests;

use nalgebra::DVector;

pub use balance::solve_balance;
use balance::solve_holding_balance;
pub use impact::{SingleImpact, energetic_impulse};

/// Largest violation of a condition, relative to the largest scaled rate or impulse.
const MAX_VIOLATION: f64 = 1e-9;

/// Largest number of contacts for which all combinations of modes are tried.
const MAX_ENUMERATED_CONTACTS: usize = 4;

/// Relative difference of scaled impulses below which two solutions are equal.
const EQUAL_IMPULSE_FRACTION: f64 = 1e-7;

/// Difference of scaled rates below which two solutions are the same motion, relative to the rates without
/// impulses.
const EQUAL_RATE_FRACTION: f64 = 1e-6;

/// Mode of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ContactMode {
    /// The contact exerts no impulse.
    Open,
    /// The slip is zero and the tangential impulse inside its bounds.
    Sticks,
    /// The contact slips in this direction, -1 or 1; 0 without friction.
    Slides(f64),
}

/// Friction of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactFriction {
    /// Coefficient mu.
    pub coefficient: f64,
    /// Known direction of the slip, -1 or 1, or 0 without friction; `None` if the slip is zero.
    pub direction: Option<f64>,
}

impl ContactFriction {
    /// A contact without friction.
    pub const NONE: Self = Self {
        coefficient: 0.0,
        direction: Some(0.0),
    };

    fn modes(self) -> &'static [ContactMode] {
        use ContactMode::{Open, Slides, Sticks};
        match self.direction {
            None => &[Sticks, Slides(1.0), Slides(-1.0), Open],
            Some(0.0) => &[Slides(0.0), Open],
            Some(side) if side > 0.0 => &[Slides(1.0), Open],
            Some(_) => &[Slides(-1.0), Open],
        }
    }
}

/// Contacts at one instant. The directions are the normals of all contacts, then their tangents.
#[derive(Clone, Debug)]
pub struct ContactProblem {
    /// Friction of each contact.
    friction: Vec<ContactFriction>,
    /// Scaled matrix W, row by row.
    w: Vec<f64>,
    /// Scaled vector c.
    c: Vec<f64>,
    /// Square root of the diagonal of W for each direction.
    scale: Vec<f64>,
}

/// Modes of the contacts with their impulses or forces.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactDecision {
    /// Mode of each contact.
    pub modes: Vec<ContactMode>,
    /// Normal impulses, then tangential impulses.
    pub impulses: Vec<f64>,
    /// Number of tried solutions with other rates.
    pub others: usize,
}

impl ContactProblem {
    /// Creates a problem from W (row by row) and c. W is symmetric and positive semidefinite.
    pub fn new(friction: Vec<ContactFriction>, w: &[f64], c: &[f64]) -> Self {
        let size = c.len();
        let root = |index: usize| match w[index * size + index].sqrt() {
            root if root > 0.0 => root,
            _ => 1.0,
        };
        let scale: Vec<f64> = (0..size).map(root).collect();
        let scaled = (0..size * size).map(|entry| {
            let (row, column) = (entry / size, entry % size);
            w[entry] / (scale[row] * scale[column])
        });
        Self {
            w: scaled.collect(),
            c: c.iter().zip(&scale).map(|(c, scale)| c / scale).collect(),
            friction,
            scale,
        }
    }

    fn count(&self) -> usize {
        self.friction.len()
    }

    fn entry(&self, row: usize, column: usize) -> f64 {
        self.w[row * self.c.len() + column]
    }

    /// Returns the scaled coefficient of friction.
    fn scaled_coefficient(&self, contact: usize) -> f64 {
        let tangent = self.count() + contact;
        self.friction[contact].coefficient * self.scale[tangent] / self.scale[contact]
    }

    /// Determines the modes. A solution with the modes `previous` has priority. Otherwise the solution with the
    /// fewest changed modes is chosen, and among these the one with the smallest impulses. With more than four
    /// contacts Lemke's solution is chosen. Solutions with modes in `excluded` are not chosen. Returns `None`
    /// if no solution is found.
    pub fn decide(
        &self,
        previous: Option<&[ContactMode]>,
        excluded: &[(usize, ContactMode)],
    ) -> Option<ContactDecision> {
        if let Some(modes) = previous.filter(|modes| self.permits(modes, excluded))
            && let Some(kept) = self.solution(modes)
        {
            return Some(kept);
        }
        if self.count() <= MAX_ENUMERATED_CONTACTS {
            return self.decide_by_enumeration(previous, excluded);
        }
        let changed = previous.and_then(|modes| self.decide_by_single_change(modes, excluded));
        changed.or_else(|| self.solution(&self.find_modes_by_lemke()?))
    }

    fn permits(&self, modes: &[ContactMode], excluded: &[(usize, ContactMode)]) -> bool {
        let is_known =
            |(friction, mode): (&ContactFriction, &ContactMode)| friction.modes().contains(mode);
        self.friction.iter().zip(modes).all(is_known)
            && !excluded
                .iter()
                .any(|(contact, mode)| modes[*contact] == *mode)
    }

    /// Finds a solution by changing one excluded mode of a contact.
    fn decide_by_single_change(
        &self,
        previous: &[ContactMode],
        excluded: &[(usize, ContactMode)],
    ) -> Option<ContactDecision> {
        excluded.iter().find_map(|(contact, _)| {
            let mut modes = previous.to_vec();
            self.friction[*contact].modes().iter().find_map(|mode| {
                modes[*contact] = *mode;
                let is_permitted = self.permits(&modes, excluded);
                is_permitted.then(|| self.solution(&modes)).flatten()
            })
        })
    }

    fn decide_by_enumeration(
        &self,
        previous: Option<&[ContactMode]>,
        excluded: &[(usize, ContactMode)],
    ) -> Option<ContactDecision> {
        let mut best: Option<(usize, f64, ContactDecision)> = None;
        let mut motions: Vec<Vec<f64>> = Vec::new();
        let count: usize = self.friction.iter().map(|one| one.modes().len()).product();
        for case in 0..count {
            let modes = self.modes_of_case(case);
            if !self.permits(&modes, excluded) {
                continue;
            }
            let Some(found) = self.solution(&modes) else {
                continue;
            };
            let is_changed = |previous: &[ContactMode]| {
                let pairs = previous.iter().zip(&modes);
                pairs.filter(|(before, after)| before != after).count()
            };
            let changes = previous.map_or(0, is_changed);
            let size = self.scaled_size(&found.impulses);
            self.add_distinct_motion(&found.impulses, &mut motions);
            let is_better = best.as_ref().is_none_or(|(fewest, least, _)| {
                changes < *fewest
                    || changes == *fewest && size < (1.0 - EQUAL_IMPULSE_FRACTION) * least
            });
            if is_better {
                best = Some((changes, size, found));
            }
        }
        best.map(|(_, _, found)| ContactDecision {
            others: motions.len() - 1,
            ..found
        })
    }

    /// Adds the rates after these impulses to `motions` unless they are already included.
    fn add_distinct_motion(&self, impulses: &[f64], motions: &mut Vec<Vec<f64>>) {
        let scaled = impulses.iter().zip(&self.scale).map(|(p, scale)| p * scale);
        let rates = self.rates(&scaled.collect::<Vec<f64>>());
        let equal = EQUAL_RATE_FRACTION * DVector::from_column_slice(&self.c).amax();
        let is_known = motions.iter().any(|known| {
            let mut pairs = known.iter().zip(&rates);
            pairs.all(|(a, b)| (a - b).abs() <= equal)
        });
        if !is_known {
            motions.push(rates);
        }
    }

    fn modes_of_case(&self, mut case: usize) -> Vec<ContactMode> {
        let of_contact = |friction: &ContactFriction| {
            let modes = friction.modes();
            let mode = modes[case % modes.len()];
            case /= modes.len();
            mode
        };
        self.friction.iter().map(of_contact).collect()
    }

    fn scaled_size(&self, impulses: &[f64]) -> f64 {
        let scaled = impulses.iter().zip(&self.scale);
        scaled
            .map(|(p, scale)| (p * scale).powi(2))
            .sum::<f64>()
            .sqrt()
    }

    /// Returns the solution with these modes; `None` if it violates a condition.
    pub fn solution(&self, modes: &[ContactMode]) -> Option<ContactDecision> {
        let scaled = self.solve_scaled(modes, solve_balance)?;
        (self.violation(modes, &scaled) <= MAX_VIOLATION).then(|| ContactDecision {
            modes: modes.to_vec(),
            impulses: self.unscaled(&scaled),
            others: 0,
        })
    }

    /// Returns the impulses that keep these modes, without a check of their signs; NaN if there are none.
    pub fn impulses(&self, modes: &[ContactMode]) -> Vec<f64> {
        self.unscaled_or_nan(self.solve_scaled(modes, solve_balance))
    }

    /// Returns the forces that keep these modes, without a check of their signs. The forces are NaN if there
    /// are none, and far beyond the limits of friction if directions that coincided move apart.
    pub fn forces(&self, modes: &[ContactMode]) -> Vec<f64> {
        self.unscaled_or_nan(self.solve_scaled(modes, solve_holding_balance))
    }

    fn unscaled_or_nan(&self, scaled: Option<Vec<f64>>) -> Vec<f64> {
        match scaled {
            Some(scaled) => self.unscaled(&scaled),
            None => vec![f64::NAN; self.c.len()],
        }
    }

    fn unscaled(&self, scaled: &[f64]) -> Vec<f64> {
        let pairs = scaled.iter().zip(&self.scale);
        pairs.map(|(p, scale)| p / scale).collect()
    }

    /// Returns the scaled impulses that keep these modes; `solve` solves the linear system.
    fn solve_scaled(
        &self,
        modes: &[ContactMode],
        solve: impl Fn(Vec<f64>, Vec<f64>) -> Option<Vec<f64>>,
    ) -> Option<Vec<f64>> {
        let count = self.count();
        let mut directions = Vec::with_capacity(2 * count);
        let mut ratios = vec![0.0; count];
        for (contact, mode) in modes.iter().enumerate() {
            match mode {
                ContactMode::Open => continue,
                ContactMode::Slides(side) => {
                    ratios[contact] = -side * self.scaled_coefficient(contact);
                }
                ContactMode::Sticks => directions.push(count + contact),
            }
            directions.push(contact);
        }
        let size = directions.len();
        let mut matrix = Vec::with_capacity(size * size);
        for row in &directions {
            for column in &directions {
                let own = self.entry(*row, *column);
                let slides = *column < count && ratios[*column] != 0.0;
                matrix.push(match slides {
                    true => own + ratios[*column] * self.entry(*row, count + column),
                    false => own,
                });
            }
        }
        let right: Vec<f64> = directions.iter().map(|row| -self.c[*row]).collect();
        let found = solve(matrix, right)?;
        let mut impulses = vec![0.0; 2 * count];
        for (direction, impulse) in directions.iter().zip(found) {
            impulses[*direction] = impulse;
            if *direction < count && ratios[*direction] != 0.0 {
                impulses[count + direction] = ratios[*direction] * impulse;
            }
        }
        Some(impulses)
    }

    /// Returns the scaled rates after these scaled impulses.
    fn rates(&self, impulses: &[f64]) -> Vec<f64> {
        let size = self.c.len();
        let rows = self.w.chunks_exact(size.max(1)).zip(&self.c);
        let change = |row: &[f64]| row.iter().zip(impulses).map(|(w, p)| w * p).sum::<f64>();
        rows.map(|(row, c)| c + change(row)).collect()
    }

    /// Returns the largest violation of a condition by scaled impulses, relative to the largest rate or
    /// impulse.
    fn violation(&self, modes: &[ContactMode], impulses: &[f64]) -> f64 {
        let count = self.count();
        let rates = self.rates(impulses);
        let size = DVector::from_column_slice(&self.c).amax();
        let size = impulses.iter().fold(size, |size, p| size.max(p.abs()));
        let mut most = 0.0_f64;
        for (contact, mode) in modes.iter().enumerate() {
            let tangent = count + contact;
            let bound = self.scaled_coefficient(contact) * impulses[contact];
            let is_known = self.friction[contact].direction.is_some();
            let violations = match mode {
                ContactMode::Open => [-rates[contact], 0.0, 0.0],
                ContactMode::Sticks => [
                    rates[contact].abs().max(-impulses[contact]),
                    rates[tangent].abs(),
                    impulses[tangent].abs() - bound,
                ],
                ContactMode::Slides(side) => [
                    rates[contact].abs(),
                    -impulses[contact],
                    if is_known {
                        0.0
                    } else {
                        -side * rates[tangent]
                    },
                ],
            };
            most = violations
                .iter()
                .fold(most, |most, one| match one.is_nan() {
                    true => f64::INFINITY,
                    false => most.max(*one),
                });
        }
        if most == 0.0 { 0.0 } else { most / size }
    }
}
