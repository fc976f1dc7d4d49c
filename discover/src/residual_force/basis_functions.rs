//! Basis functions of an unknown force. A force over the rate may jump at zero rate, as friction
//! does. A force over position or time is piecewise linear; a periodic force is a sine and a
//! cosine.

use crate::ids::EquationId;
use std::f64::consts::TAU;

use crate::residual_force::equations::OperatingPoint;
use crate::thresholds;

/// Argument of a force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ForceArgument {
    /// Rate.
    Rate,
    /// Position.
    Position,
    /// Angle within one turn.
    Turn,
    /// Time within a window. The force differs between windows.
    Time,
    /// Angle; the force has this number of periods per turn.
    Order(u32),
    /// Time within a window; the force has this frequency, Hz, and differs between windows.
    Frequency(f64),
}

/// Family of basis functions of a force in an equation.
#[derive(Clone, Debug, PartialEq)]
pub struct BasisFamily {
    /// Equation in which the force acts.
    pub equation: EquationId,
    /// Argument of the force.
    pub argument: ForceArgument,
    /// Knots in ascending order. Over the rate, the knot 0 occurs twice.
    pub knots: Vec<f64>,
}

/// Range of the motion in an equation over all windows.
#[derive(Clone, Debug, Default)]
pub struct OperatingRange {
    /// Lowest and highest position, without outliers.
    pub position_bounds: (f64, f64),
    /// Largest absolute rate, without outliers.
    pub largest_rate: f64,
    /// RMS of position and rate.
    pub rms: (f64, f64),
}

impl OperatingRange {
    /// Computes the range of the operating points without the outer 1 % at each end.
    pub fn from_operating_points(operating_points: &[OperatingPoint]) -> Self {
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
            position_bounds: (at(&positions, 0.01), at(&positions, 0.99)),
            largest_rate: at(&rates, 0.99),
            rms: (usual(&positions), usual(&rates)),
        }
    }

    /// Returns the width of the position range.
    pub fn width(&self) -> f64 {
        self.position_bounds.1 - self.position_bounds.0
    }
}

impl BasisFamily {
    /// Builds the family over the rate.
    pub fn build_over_rate(equation: EquationId, range: &OperatingRange) -> Self {
        // Knots are denser near zero rate, where friction changes most.
        let last = (thresholds::RATE_KNOT_COUNT - 1) as f64;
        let side: Vec<f64> = (0..thresholds::RATE_KNOT_COUNT)
            .map(|k| range.largest_rate * (k as f64 / last).powi(2))
            .collect();
        let bends = side.iter().rev().map(|b| -b).chain(side.iter().copied());
        Self {
            equation,
            argument: ForceArgument::Rate,
            knots: bends.collect(),
        }
    }

    /// Builds the family over the position, or over a turn if the motion covers a full turn.
    pub fn build_over_position(
        equation: EquationId,
        range: &OperatingRange,
        is_angle: bool,
    ) -> Self {
        if is_angle && range.width() > TAU {
            let bend = |k: usize| TAU * k as f64 / thresholds::TURN_KNOT_COUNT as f64;
            return Self {
                equation,
                argument: ForceArgument::Turn,
                knots: (0..thresholds::TURN_KNOT_COUNT).map(bend).collect(),
            };
        }
        let bend = |k: usize| {
            range.position_bounds.0
                + range.width() * k as f64 / (thresholds::POSITION_KNOT_COUNT - 1) as f64
        };
        Self {
            equation,
            argument: ForceArgument::Position,
            knots: (0..thresholds::POSITION_KNOT_COUNT).map(bend).collect(),
        }
    }

    /// Builds the family over the time of a window of this length, s.
    pub fn build_over_time(equation: EquationId, length: f64) -> Self {
        let bend = |k: usize| length * k as f64 / (thresholds::TIME_KNOT_COUNT - 1) as f64;
        Self {
            equation,
            argument: ForceArgument::Time,
            knots: (0..thresholds::TIME_KNOT_COUNT).map(bend).collect(),
        }
    }

    /// Builds the sine and cosine of a wave.
    pub fn build_wave(equation: EquationId, over: ForceArgument) -> Self {
        Self {
            equation,
            argument: over,
            knots: Vec::new(),
        }
    }

    /// Returns the number of basis functions.
    pub fn count(&self) -> usize {
        match self.argument {
            ForceArgument::Order(_) | ForceArgument::Frequency(_) => 2,
            ForceArgument::Rate
            | ForceArgument::Position
            | ForceArgument::Turn
            | ForceArgument::Time => self.knots.len(),
        }
    }

    /// Evaluates the basis functions at an operating point.
    pub fn evaluate(&self, operating_point: &OperatingPoint, out: &mut [f64]) {
        out.fill(0.0);
        let mut wave = |phase: f64| {
            let (sine, cosine) = phase.sin_cos();
            out.copy_from_slice(&[cosine, sine]);
        };
        match self.argument {
            ForceArgument::Order(order) => wave(f64::from(order) * operating_point.position),
            ForceArgument::Frequency(frequency) => wave(TAU * frequency * operating_point.time),
            ForceArgument::Position => {
                write_linear_weights(&self.knots, operating_point.position, out)
            }
            ForceArgument::Time => write_linear_weights(&self.knots, operating_point.time, out),
            ForceArgument::Turn => write_periodic(&self.knots, operating_point.position, out),
            ForceArgument::Rate => {
                let half = self.knots.len() / 2;
                let (negative, positive) = out.split_at_mut(half);
                write_linear_weights(&self.knots[..half], operating_point.rate.min(0.0), negative);
                write_linear_weights(&self.knots[half..], operating_point.rate.max(0.0), positive);
                let width = 2.0 * thresholds::TURNING_RATE_FRACTION * self.knots[2 * half - 1];
                let forwards = (0.5 + operating_point.rate / width).clamp(0.0, 1.0);
                negative.iter_mut().for_each(|w| *w *= 1.0 - forwards);
                positive.iter_mut().for_each(|w| *w *= forwards);
            }
        }
    }
}

/// Writes the weights of a piecewise linear function that is constant beyond its first and last
/// knot.
fn write_linear_weights(bends: &[f64], at: f64, out: &mut [f64]) {
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

/// Writes the weights of a piecewise linear function with the period of one turn.
fn write_periodic(bends: &[f64], at: f64, out: &mut [f64]) {
    let step = TAU / bends.len() as f64;
    let at = at.rem_euclid(TAU) / step;
    let before = (at as usize).min(bends.len() - 1);
    let part = at - before as f64;
    out[before] += 1.0 - part;
    out[(before + 1) % bends.len()] += part;
}

#[cfg(test)]
mod tests {
    use super::{BasisFamily, ForceArgument, OperatingRange};
    use crate::ids::EquationId;
    use crate::residual_force::equations::OperatingPoint;

    fn equation() -> EquationId {
        EquationId::new(0)
    }

    const RANGE: OperatingRange = OperatingRange {
        position_bounds: (-1.0, 3.0),
        largest_rate: 2.0,
        rms: (1.0, 1.0),
    };

    fn sum(family: &BasisFamily, of: &dyn Fn(f64) -> f64, operating_point: OperatingPoint) -> f64 {
        let mut weights = vec![0.0; family.count()];
        family.evaluate(&operating_point, &mut weights);
        let pairs = weights.iter().zip(&family.knots);
        pairs.map(|(weight, bend)| weight * of(*bend)).sum()
    }

    #[test]
    fn linear_function_is_reproduced_between_knots() {
        let line = |x: f64| 0.3 - 0.7 * x;
        for step in 0..40 {
            let at = -1.0 + 0.1 * f64::from(step);
            let operating_point = OperatingPoint {
                position: at,
                rate: 0.9 * at - 0.95,
                time: 0.2 * (at + 1.0),
            };
            let position = BasisFamily::build_over_position(equation(), &RANGE, false);
            assert!((sum(&position, &line, operating_point) - line(at)).abs() < 1e-12);
            let rate = BasisFamily::build_over_rate(equation(), &RANGE);
            assert!(
                (sum(&rate, &line, operating_point) - line(operating_point.rate)).abs() < 1e-12
            );
            let time = BasisFamily::build_over_time(equation(), 0.8);
            assert!(
                (sum(&time, &line, operating_point) - line(operating_point.time)).abs() < 1e-12
            );
        }
    }

    #[test]
    fn force_over_rate_may_jump_at_reversal() {
        let rate = BasisFamily::build_over_rate(equation(), &RANGE);
        let mut weights = vec![0.0; rate.count()];
        for (at, forwards) in [(-0.5, 0.0), (0.5, 1.0), (0.0, 0.5)] {
            let operating_point = OperatingPoint {
                rate: at,
                ..OperatingPoint::default()
            };
            rate.evaluate(&operating_point, &mut weights);
            let found: f64 = weights[rate.count() / 2..].iter().sum();
            assert_eq!(found, forwards);
        }
    }

    #[test]
    fn force_over_turn_is_periodic() {
        let wide = OperatingRange {
            position_bounds: (-10.0, 10.0),
            ..RANGE
        };
        let turn = BasisFamily::build_over_position(equation(), &wide, true);
        assert_eq!(turn.argument, ForceArgument::Turn);
        let mut weights = [vec![0.0; turn.count()], vec![0.0; turn.count()]];
        for (weights, at) in weights
            .iter_mut()
            .zip([-0.1, 4.0 * std::f64::consts::PI - 0.1])
        {
            let operating_point = OperatingPoint {
                position: at,
                ..OperatingPoint::default()
            };
            turn.evaluate(&operating_point, weights);
        }
        let pairs = weights[0].iter().zip(&weights[1]);
        for (a, b) in pairs {
            assert!((a - b).abs() < 1e-12);
        }
        assert!((weights[0].iter().sum::<f64>() - 1.0).abs() < 1e-12);
    }
}
