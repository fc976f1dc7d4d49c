//! Basis functions of an unknown force. A force over the rate may jump at rest, as friction does; a
//! force over position or time is piecewise linear; a periodic force is a wave. Coefficients are
//! estimated elsewhere.

use crate::ids::EquationId;
use std::f64::consts::TAU;

use crate::residual_force::equations::OperatingPoint;
use crate::thresholds;

/// Argument of a force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Over {
    /// The rate.
    Rate,
    /// The position.
    Position,
    /// The position within a turn.
    Turn,
    /// The time within a window; the force differs between windows.
    Time,
    /// The angle, with this order per turn.
    Order(u32),
    /// The time within a window, at this frequency, Hz; the force differs between windows.
    Frequency(f64),
}

/// Family of basis functions of a force in an equation.
#[derive(Clone, Debug, PartialEq)]
pub struct Family {
    /// Equation in which the force acts.
    pub equation: EquationId,
    /// Argument of the force.
    pub over: Over,
    /// Knots in ascending order. Over the rate, 0 occurs twice.
    pub bends: Vec<f64>,
}

/// Range of the motion in an equation over all windows.
#[derive(Clone, Debug, Default)]
pub struct Range {
    /// Usual lowest and highest position.
    pub position: (f64, f64),
    /// Usual largest absolute rate.
    pub rate: f64,
    /// RMS of position and rate.
    pub usual: (f64, f64),
}

impl Range {
    /// Computes the range of operating points, without the outer 1 % at each end.
    pub fn of(operating_points: &[OperatingPoint]) -> Self {
        let sorted = |of: &dyn Fn(&OperatingPoint) -> f64| {
            let mut values: Vec<f64> = operating_points.iter().map(of).collect();
            values.sort_by(f64::total_cmp);
            values
        };
        let positions = sorted(&|s| s.position);
        let rates = sorted(&|s| s.rate.abs());
        let last = positions.len().saturating_sub(1);
        let at = |values: &[f64], part: f64| {
            let index = (part * last as f64).round() as usize;
            values.get(index).copied().unwrap_or(0.0)
        };
        let usual = |values: &[f64]| {
            let sum: f64 = values.iter().map(|v| v * v).sum();
            (sum / values.len().max(1) as f64).sqrt()
        };
        Self {
            position: (at(&positions, 0.01), at(&positions, 0.99)),
            rate: at(&rates, 0.99),
            usual: (usual(&positions), usual(&rates)),
        }
    }

    /// Returns the width of the position range.
    pub fn width(&self) -> f64 {
        self.position.1 - self.position.0
    }
}

impl Family {
    /// Builds the family over the rate.
    pub fn over_rate(equation: EquationId, range: &Range) -> Self {
        // Closer near rest, where friction bends most.
        let last = (thresholds::RATE_BENDS - 1) as f64;
        let side: Vec<f64> = (0..thresholds::RATE_BENDS)
            .map(|k| range.rate * (k as f64 / last).powi(2))
            .collect();
        let bends = side.iter().rev().map(|b| -b).chain(side.iter().copied());
        Self {
            equation,
            over: Over::Rate,
            bends: bends.collect(),
        }
    }

    /// Builds the family over the position, or over a turn if the motion covers a full turn.
    pub fn over_position(equation: EquationId, range: &Range, is_angle: bool) -> Self {
        if is_angle && range.width() > TAU {
            let bend = |k: usize| TAU * k as f64 / thresholds::TURN_BENDS as f64;
            return Self {
                equation,
                over: Over::Turn,
                bends: (0..thresholds::TURN_BENDS).map(bend).collect(),
            };
        }
        let bend = |k: usize| {
            range.position.0 + range.width() * k as f64 / (thresholds::POSITION_BENDS - 1) as f64
        };
        Self {
            equation,
            over: Over::Position,
            bends: (0..thresholds::POSITION_BENDS).map(bend).collect(),
        }
    }

    /// Builds the family over the time of a window of this length, s.
    pub fn over_time(equation: EquationId, length: f64) -> Self {
        let bend = |k: usize| length * k as f64 / (thresholds::TIME_BENDS - 1) as f64;
        Self {
            equation,
            over: Over::Time,
            bends: (0..thresholds::TIME_BENDS).map(bend).collect(),
        }
    }

    /// Builds the sine and cosine of a wave.
    pub fn wave(equation: EquationId, over: Over) -> Self {
        Self {
            equation,
            over,
            bends: Vec::new(),
        }
    }

    /// Returns the number of basis functions.
    pub fn count(&self) -> usize {
        match self.over {
            Over::Order(_) | Over::Frequency(_) => 2,
            Over::Rate | Over::Position | Over::Turn | Over::Time => self.bends.len(),
        }
    }

    /// Evaluates the basis functions at an operating point.
    pub fn at(&self, operating_point: &OperatingPoint, out: &mut [f64]) {
        out.fill(0.0);
        let mut wave = |phase: f64| {
            let (sine, cosine) = phase.sin_cos();
            out.copy_from_slice(&[cosine, sine]);
        };
        match self.over {
            Over::Order(order) => wave(f64::from(order) * operating_point.position),
            Over::Frequency(frequency) => wave(TAU * frequency * operating_point.time),
            Over::Position => bent(&self.bends, operating_point.position, out),
            Over::Time => bent(&self.bends, operating_point.time, out),
            Over::Turn => turned(&self.bends, operating_point.position, out),
            Over::Rate => {
                let half = self.bends.len() / 2;
                let (negative, positive) = out.split_at_mut(half);
                bent(&self.bends[..half], operating_point.rate.min(0.0), negative);
                bent(&self.bends[half..], operating_point.rate.max(0.0), positive);
                let width = 2.0 * thresholds::TURNING * self.bends[2 * half - 1];
                let forwards = (0.5 + operating_point.rate / width).clamp(0.0, 1.0);
                negative.iter_mut().for_each(|w| *w *= 1.0 - forwards);
                positive.iter_mut().for_each(|w| *w *= forwards);
            }
        }
    }
}

/// The weights of a line with bends; level beyond its ends.
fn bent(bends: &[f64], at: f64, out: &mut [f64]) {
    let next = bends.partition_point(|bend| *bend <= at);
    if next == 0 {
        out[0] = 1.0;
    } else if next == bends.len() {
        out[next - 1] = 1.0;
    } else {
        let part = (at - bends[next - 1]) / (bends[next] - bends[next - 1]);
        out[next - 1] = 1.0 - part;
        out[next] = part;
    }
}

/// The same for one that closes after a turn.
fn turned(bends: &[f64], at: f64, out: &mut [f64]) {
    let step = TAU / bends.len() as f64;
    let at = at.rem_euclid(TAU) / step;
    let before = (at as usize).min(bends.len() - 1);
    let part = at - before as f64;
    out[before] += 1.0 - part;
    out[(before + 1) % bends.len()] += part;
}

#[cfg(test)]
mod tests {
    use super::{Family, Over, Range};
    use crate::ids::EquationId;
    use crate::residual_force::equations::OperatingPoint;

    fn equation() -> EquationId {
        EquationId::new(0)
    }

    const RANGE: Range = Range {
        position: (-1.0, 3.0),
        rate: 2.0,
        usual: (1.0, 1.0),
    };

    fn sum(family: &Family, of: &dyn Fn(f64) -> f64, operating_point: OperatingPoint) -> f64 {
        let mut weights = vec![0.0; family.count()];
        family.at(&operating_point, &mut weights);
        let pairs = weights.iter().zip(&family.bends);
        pairs.map(|(weight, bend)| weight * of(*bend)).sum()
    }

    #[test]
    fn a_straight_line_is_itself_between_bends() {
        let line = |x: f64| 0.3 - 0.7 * x;
        for step in 0..40 {
            let at = -1.0 + 0.1 * f64::from(step);
            let operating_point = OperatingPoint {
                position: at,
                rate: 0.9 * at - 0.95,
                time: 0.2 * (at + 1.0),
            };
            let position = Family::over_position(equation(), &RANGE, false);
            assert!((sum(&position, &line, operating_point) - line(at)).abs() < 1e-12);
            let rate = Family::over_rate(equation(), &RANGE);
            assert!(
                (sum(&rate, &line, operating_point) - line(operating_point.rate)).abs() < 1e-12
            );
            let time = Family::over_time(equation(), 0.8);
            assert!(
                (sum(&time, &line, operating_point) - line(operating_point.time)).abs() < 1e-12
            );
        }
    }

    #[test]
    fn a_force_over_the_rate_may_jump_where_it_turns() {
        let rate = Family::over_rate(equation(), &RANGE);
        let mut weights = vec![0.0; rate.count()];
        for (at, forwards) in [(-0.5, 0.0), (0.5, 1.0), (0.0, 0.5)] {
            let operating_point = OperatingPoint {
                rate: at,
                ..OperatingPoint::default()
            };
            rate.at(&operating_point, &mut weights);
            let found: f64 = weights[rate.count() / 2..].iter().sum();
            assert_eq!(found, forwards);
        }
    }

    #[test]
    fn a_turn_closes() {
        let wide = Range {
            position: (-10.0, 10.0),
            ..RANGE
        };
        let turn = Family::over_position(equation(), &wide, true);
        assert_eq!(turn.over, Over::Turn);
        let mut weights = [vec![0.0; turn.count()], vec![0.0; turn.count()]];
        for (weights, at) in weights
            .iter_mut()
            .zip([-0.1, 4.0 * std::f64::consts::PI - 0.1])
        {
            let operating_point = OperatingPoint {
                position: at,
                ..OperatingPoint::default()
            };
            turn.at(&operating_point, weights);
        }
        let pairs = weights[0].iter().zip(&weights[1]);
        for (a, b) in pairs {
            assert!((a - b).abs() < 1e-12);
        }
        assert!((weights[0].iter().sum::<f64>() - 1.0).abs() < 1e-12);
    }
}
