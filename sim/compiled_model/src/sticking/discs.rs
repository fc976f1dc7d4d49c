//! Friction opposite to the sliding velocity v, along the unit vector v/norm(v). Its force is limited to a disc.
//!
//! During sliding, the direction at the last step is the reference. A motion that stops passes v = 0 along this
//! direction, so the switching function is v times the reference. Beyond zero, the stages of a step use the mirrored
//! velocity. The unit vector of a straight motion is then constant and the rates are smooth. Near zero the stages use a
//! small velocity along the reference. A velocity that only turns crosses the surface as well and gets a new reference.

use std::ops::Range;

use eomgen_sim::friction_discs::{DiscArrival, DiscVerdict};

/// Smallest velocity with a defined direction, in rounding errors of the velocity, which then hardly turn it.
const SLOWEST_ROUNDINGS: f64 = 1000.0;

/// Smallest velocity with a defined direction, in allowed errors of the velocity. The errors turn a smaller velocity,
/// and explicit steps of that length oscillate about the direction of the force.
const SLOWEST_ERRORS: f64 = 10.0;

/// State of a friction disc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum DiscState {
    /// The velocity determines the unit vector.
    Sliding,
    /// The disc has held the motion since this time, s.
    Holding { since: f64 },
    /// The motion begins to slide. It keeps a constant direction while its velocity is within rounding. The switching
    /// function is displaced by `moved`.
    Leaving { moved: f64 },
}

/// Friction disc along a motion.
#[derive(Clone, Debug)]
pub(super) struct Disc {
    /// Rows of the components of v among the functions with sides.
    pub rows: Range<usize>,
    pub state: DiscState,
    /// Unit vector of the direction of the motion at the last step.
    pub along: Vec<f64>,
    /// Largest velocity that counts as zero.
    floor: f64,
    /// Smallest velocity with a defined direction. A smaller velocity keeps the reference, because rounding or allowed
    /// errors turn it.
    slowest: f64,
    /// Speed at the last step.
    speed: f64,
}

impl Disc {
    pub fn new(rows: Range<usize>) -> Self {
        let mut along = vec![0.0; rows.len()];
        along[0] = 1.0;
        Self {
            rows,
            state: DiscState::Sliding,
            along,
            floor: 0.0,
            slowest: 0.0,
            speed: 0.0,
        }
    }

    pub fn is_holding(&self) -> bool {
        matches!(self.state, DiscState::Holding { .. })
    }

    pub fn is_leaving(&self) -> bool {
        matches!(self.state, DiscState::Leaving { .. })
    }

    /// Returns the arrival of a motion that was sliding.
    pub fn arrival(&self) -> DiscArrival {
        DiscArrival {
            rows: self.rows.clone(),
            along: self.along.clone(),
            exceeds_limit: false,
        }
    }

    /// Returns true if the turning rate of the unit vector grows beyond all bounds towards zero velocity.
    pub fn is_singular(&self) -> bool {
        !self.is_holding() && self.speed > self.slowest
    }

    /// Returns the smallest velocity with a defined direction.
    pub fn slowest(&self) -> f64 {
        self.slowest
    }

    /// Sets the velocity that counts as zero, which is its rounding error, and the smallest velocity with a defined
    /// direction. `allowed_error` is the error of the velocity that the solver allows.
    pub fn set_roundings(&mut self, rounding: f64, allowed_error: f64) {
        self.floor = rounding;
        self.slowest = (SLOWEST_ROUNDINGS * rounding).max(SLOWEST_ERRORS * allowed_error);
    }

    /// Returns true if the motion begins to slide and rounding still determines its direction.
    fn is_within_rounding(&self, functions: &[f64]) -> bool {
        let speed = norm(self.velocity(functions));
        matches!(self.state, DiscState::Leaving { moved } if speed <= 2.0 * moved)
    }

    /// Returns v from the functions of all rows.
    pub fn velocity<'f>(&self, functions: &'f [f64]) -> &'f [f64] {
        &functions[self.rows.clone()]
    }

    fn displacement(&self) -> f64 {
        match self.state {
            DiscState::Leaving { moved } => moved,
            _ => -self.floor,
        }
    }

    /// Returns the switching function of a disc that does not hold the motion.
    pub fn guard(&self, functions: &[f64]) -> f64 {
        dot(self.velocity(functions), &self.along) + self.displacement()
    }

    /// Appends the components of the unit vector; 0 if the disc holds the motion. With fixed sides the unit vector is
    /// smooth beyond zero velocity.
    pub fn write_sides(&self, functions: &[f64], is_fixed: bool, sides: &mut Vec<f64>) {
        if self.is_holding() {
            return sides.extend(self.rows.clone().map(|_| 0.0));
        }
        if self.is_within_rounding(functions) {
            return sides.extend(&self.along);
        }
        let velocity = self.continued_velocity(functions, is_fixed);
        sides.extend(unit_vector(&velocity, Some(&self.along)));
    }

    /// Returns the velocity that defines the unit vector. With fixed sides it has a positive component along the
    /// reference.
    fn continued_velocity(&self, functions: &[f64], is_fixed: bool) -> Vec<f64> {
        let mut velocity = self.velocity(functions).to_vec();
        let ahead = dot(&velocity, &self.along);
        let even = ahead.abs().max(self.slowest);
        if is_fixed && ahead < even {
            for (v, along) in velocity.iter_mut().zip(&self.along) {
                *v += (even - ahead) * along;
            }
        }
        velocity
    }

    /// Returns true if the velocity itself defines the unit vector when sides are fixed.
    pub fn has_own_direction(&self, functions: &[f64]) -> bool {
        self.state == DiscState::Sliding
            && dot(self.velocity(functions), &self.along) >= self.slowest
    }

    /// Returns the change of the unit vector due to a `change` of the velocity.
    pub fn change_of_sides(&self, functions: &[f64], is_fixed: bool, change: &[f64]) -> Vec<f64> {
        if self.is_holding() || self.is_within_rounding(functions) {
            return vec![0.0; change.len()];
        }
        let mut change = change.to_vec();
        let ahead = dot(self.velocity(functions), &self.along);
        let even = ahead.abs().max(self.slowest);
        if is_fixed && ahead < even {
            let along = dot(&change, &self.along);
            let removed = if even > -ahead { along } else { 2.0 * along };
            for (entry, along) in change.iter_mut().zip(&self.along) {
                *entry -= removed * along;
            }
        }
        let velocity = self.continued_velocity(functions, is_fixed);
        let (unit, length) = (unit_vector(&velocity, Some(&self.along)), norm(&velocity));
        if length == 0.0 {
            return vec![0.0; change.len()];
        }
        let stretched = dot(&unit, &change);
        let turned = change.iter().zip(&unit);
        turned
            .map(|(entry, s)| (entry - stretched * s) / length)
            .collect()
    }

    /// Updates the direction of sliding. A released disc slides once its velocity exceeds rounding.
    pub fn follow(&mut self, functions: &[f64]) {
        self.speed = norm(self.velocity(functions));
        if self.is_leaving() && !self.is_within_rounding(functions) {
            self.state = DiscState::Sliding;
        }
        if self.state == DiscState::Sliding && self.speed > self.slowest {
            self.along = unit_vector(self.velocity(functions), Some(&self.along));
        }
    }

    /// Enters the state that a decision determined at time `t`, for a velocity with the given rounding error.
    pub fn enter(&mut self, verdict: &DiscVerdict, t: f64, functions: &[f64], rounding: f64) {
        self.state = match (verdict, self.state) {
            (DiscVerdict::Holds(_), DiscState::Holding { since }) => DiscState::Holding { since },
            (DiscVerdict::Holds(_), _) => DiscState::Holding { since: t },
            (DiscVerdict::Slides(along), _) => {
                self.along.clone_from(along);
                DiscState::Leaving {
                    // The displacement keeps the switching function positive on the side to which the motion leaves.
                    moved: rounding
                        .max(2.0 * norm(self.velocity(functions)))
                        .max(self.floor),
                }
            }
        };
    }
}

/// Returns v/norm(v), or `at_zero` for v = 0.
pub(super) fn unit_vector(v: &[f64], at_zero: Option<&[f64]>) -> Vec<f64> {
    let length = norm(v);
    match at_zero {
        _ if length > 0.0 => v.iter().map(|v| v / length).collect(),
        Some(at_zero) => at_zero.to_vec(),
        None => vec![0.0; v.len()],
    }
}

pub(super) fn norm(v: &[f64]) -> f64 {
    dot(v, v).sqrt()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
