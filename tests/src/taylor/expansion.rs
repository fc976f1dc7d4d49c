//! Taylor series of the motion about a time, from the equations of motion in one regime.
//!
//! With x_s = x_sp + x_pr + 2 x_c and x_p = x_pr + x_c, the balances of sun, planet,
//! carrier and modes are
//!
//! ```text
//! M_s x_s'' = (a_m + F_w sin(omega t))/r_s - b_m/r_s^2 x_s' - 3 F_sp
//! M_p x_p'' = F_sp - F_pr
//! I_tot th_c'' + sum_i h_i q_i'' = 3 r_c cos(alpha) (F_sp + F_pr)
//! M_i q_i'' + h_i th_c'' + K_i q_i = 0
//! ```
//!
//! with x_c = r_c cos(alpha) th_c. If the last equation is substituted into the third, the carrier has the inertia
//! I_tot - sum_i h_i^2/M_i and the load sum_i h_i K_i/M_i q_i.
//!
//! The unit of time, sigma, is a power of two in seconds. In this unit the coefficients of the series have the
//! magnitude of the displacements, and the state after a full step is their sum. With u = (t - t_0)/sigma, the
//! coefficients of x(u) follow from (k + 1)(k + 2) x_(k+2) = sigma^2 x''_k, and the coefficients of x' are (k + 1)
//! x_(k+1)/sigma.

use super::arm::Arm;
use super::scalar::Scalar;

/// Contact state of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Contact with x > b.
    Positive,
    /// No contact, inside the backlash.
    Free,
    /// Contact with x < -b.
    Negative,
}

impl Side {
    /// Returns the sign of the deflection in contact, otherwise 0.
    pub fn sign(self) -> f64 {
        match self {
            Self::Positive => 1.0,
            Self::Free => 0.0,
            Self::Negative => -1.0,
        }
    }
}

/// State: displacements and rates in the order x_sp, x_pr, x_c, q_1, ..., q_S, in m and m/s.
#[derive(Clone, Debug)]
pub struct State<T> {
    /// Displacements.
    pub positions: Vec<T>,
    /// Rates.
    pub rates: Vec<T>,
}

/// Constants of the arm in time units of sigma: factors of displacements contain sigma^2, factors
/// of rates sigma.
#[derive(Clone, Debug)]
struct Scaled<T> {
    k: T,
    c: T,
    drive: T,
    drag: T,
    ripple: T,
    omega: T,
    stiffness: Vec<T>,
    loads: Vec<T>,
}

/// Computes Taylor series for one arm; stores the constants that all steps share.
#[derive(Clone, Debug)]
pub struct Expander<T> {
    arm: Arm<T>,
    sigma: f64,
    scaled: Scaled<T>,
    /// 1/((k + 1)(k + 2)).
    inverses: Vec<T>,
    inverse_m_s: T,
    inverse_m_p: T,
    inverse_inertia: T,
}

/// Taylor series of all displacements about a time.
#[derive(Clone, Debug)]
pub struct Series<T> {
    /// Time unit, in s.
    pub sigma: f64,
    /// Number of displacements.
    pub width: usize,
    /// Coefficients in m: one row of displacements per power of u.
    pub coefficients: Vec<T>,
}

impl<T: Scalar> Expander<T> {
    /// Prepares the series of an arm with a time unit in s, a power of two.
    pub fn new(arm: Arm<T>, sigma: f64) -> Self {
        let one = T::from_f64(1.0);
        let inverses = (0..T::DEGREE)
            .map(|k| one / T::from_f64(((k + 1) * (k + 2)) as f64))
            .collect();
        let stiffness: Vec<T> = (arm.modes.iter())
            .map(|mode| mode.stiffness.scaled_by(sigma * sigma))
            .collect();
        let loads = (arm.modes.iter().zip(&stiffness))
            .map(|(mode, stiffness)| mode.h * *stiffness)
            .collect();
        Self {
            scaled: Scaled {
                k: arm.k.scaled_by(sigma * sigma),
                c: arm.c.scaled_by(sigma),
                drive: arm.drive.scaled_by(sigma * sigma),
                drag: arm.drag.scaled_by(sigma),
                ripple: arm.ripple.scaled_by(sigma * sigma),
                omega: arm.omega.scaled_by(sigma),
                stiffness,
                loads,
            },
            inverses,
            inverse_m_s: one / arm.m_s,
            inverse_m_p: one / arm.m_p,
            inverse_inertia: one / arm.inertia,
            sigma,
            arm,
        }
    }

    /// Returns the expander with half the time unit.
    pub fn with_half_time_unit(&self) -> Self {
        Self::new(self.arm.clone(), self.sigma / 2.0)
    }

    /// Returns the time unit, in s.
    pub fn sigma(&self) -> f64 {
        self.sigma
    }

    /// Returns the arm.
    pub fn arm(&self) -> &Arm<T> {
        &self.arm
    }

    /// Returns the number of displacements.
    pub fn width(&self) -> usize {
        3 + self.arm.modes.len()
    }

    /// Returns the series of the motion that starts from `state` at `time` (in s). `sides` are the contact states of
    /// the sun-planet and planet-ring meshes.
    pub fn expand(&self, time: T, state: &State<T>, sides: [Side; 2]) -> Series<T> {
        let width = self.width();
        let mut coefficients = Vec::with_capacity((T::DEGREE + 1) * width);
        coefficients.extend_from_slice(&state.positions);
        coefficients.extend(state.rates.iter().map(|rate| rate.scaled_by(self.sigma)));
        let torque = self.torque(time);
        for (k, torque) in torque.into_iter().enumerate() {
            self.next(k, torque, sides, &mut coefficients);
        }
        Series {
            sigma: self.sigma,
            width,
            coefficients,
        }
    }

    /// Returns sigma^2 (a_m + F_w sin(omega t))/r_s as a series about `time`.
    fn torque(&self, time: T) -> Vec<T> {
        let (sin, cos) = (self.arm.omega * time).sin_cos();
        let mut factor = self.scaled.ripple;
        let mut series = Vec::with_capacity(T::DEGREE - 1);
        for k in 0..T::DEGREE - 1 {
            series.push(match k % 4 {
                0 => factor * sin,
                1 => factor * cos,
                2 => -(factor * sin),
                _ => -(factor * cos),
            });
            factor = factor * self.scaled.omega / T::from_f64((k + 1) as f64);
        }
        series[0] = series[0] + self.scaled.drive;
        series
    }

    /// Appends row k + 2 of the coefficients, computed from rows 0 to k + 1.
    fn next(&self, k: usize, torque: T, sides: [Side; 2], coefficients: &mut Vec<T>) {
        let (arm, scaled) = (&self.arm, &self.scaled);
        let (now, after) = coefficients[k * self.width()..].split_at(self.width());
        let rate = |j: usize| after[j].scaled_by((k + 1) as f64);
        let [f_sp, f_pr] = [0, 1].map(|mesh| self.force(k, sides[mesh], now[mesh], rate(mesh)));
        let sun_rate = rate(0) + rate(1) + rate(2).scaled_by(2.0);
        let sun = (torque - scaled.drag * sun_rate - f_sp.scaled_by(3.0)) * self.inverse_m_s;
        let planet = (f_sp - f_pr) * self.inverse_m_p;
        let bending = (scaled.loads.iter().zip(&now[3..]))
            .fold(T::from_f64(0.0), |sum, (load, q)| sum + *load * *q);
        let angle = ((f_sp + f_pr).scaled_by(3.0) * arm.lever + bending) * self.inverse_inertia;
        let carrier = angle * arm.lever;
        let modes: Vec<T> = (arm.modes.iter().zip(&scaled.stiffness).zip(&now[3..]))
            .map(|((mode, stiffness), q)| -(*stiffness * *q + mode.share * angle))
            .collect();
        let accelerations = [sun - planet - carrier, planet - carrier, carrier];
        let accelerations = accelerations.into_iter().chain(modes);
        coefficients.extend(accelerations.map(|acceleration| acceleration * self.inverses[k]));
    }

    /// Returns coefficient `k` of sigma^2 k f_k + sigma c f_c, Eq. (6) to (9), of one mesh.
    fn force(&self, k: usize, side: Side, deflection: T, rate: T) -> T {
        if side == Side::Free {
            return T::from_f64(0.0);
        }
        // The half-width of the backlash is constant, so only the first coefficient contains it.
        let edge = if k == 0 { side.sign() } else { 0.0 };
        self.scaled.k * (deflection - self.arm.b.scaled_by(edge)) + self.scaled.c * rate
    }
}

impl<T: Scalar> Series<T> {
    fn row(&self, k: usize) -> &[T] {
        &self.coefficients[k * self.width..(k + 1) * self.width]
    }

    /// Returns the coefficients of one displacement, in m.
    pub fn displacement_series(&self, displacement: usize) -> Vec<T> {
        (self.coefficients.iter())
            .skip(displacement)
            .step_by(self.width)
            .copied()
            .collect()
    }

    /// Returns the largest coefficient of the last two rows, in m. It is an upper bound of the remainder of a full
    /// step.
    pub fn tail(&self) -> f64 {
        (self.coefficients.iter().rev().take(2 * self.width))
            .map(|coefficient| coefficient.to_f64().abs())
            .fold(0.0, f64::max)
    }

    /// Returns the state at u = `at` in 0..=1 (Horner's rule).
    pub fn state(&self, at: T) -> State<T> {
        let zero = T::from_f64(0.0);
        let mut positions = vec![zero; self.width];
        let mut rates = vec![zero; self.width];
        for k in (0..=T::DEGREE).rev() {
            for (j, coefficient) in self.row(k).iter().enumerate() {
                rates[j] = rates[j] * at + positions[j];
                positions[j] = positions[j] * at + *coefficient;
            }
        }
        self.in_seconds(positions, rates)
    }

    /// Returns the state at u = 1.
    pub fn end(&self) -> State<T> {
        let zero = T::from_f64(0.0);
        let mut positions = vec![zero; self.width];
        let mut rates = vec![zero; self.width];
        for k in (0..=T::DEGREE).rev() {
            for (j, coefficient) in self.row(k).iter().enumerate() {
                positions[j] = positions[j] + *coefficient;
                rates[j] = rates[j] + coefficient.scaled_by(k as f64);
            }
        }
        self.in_seconds(positions, rates)
    }

    fn in_seconds(&self, positions: Vec<T>, rates: Vec<T>) -> State<T> {
        let rates = (rates.into_iter())
            .map(|rate| rate.scaled_by(1.0 / self.sigma))
            .collect();
        State { positions, rates }
    }
}
