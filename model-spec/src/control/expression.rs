//! Expressions of controllers, over numbers that are known at a sample.

use crate::evaluate::{binary, call};
use crate::model::{MeasuredQuantity, Model, SampledExpression, SampledKind};

impl MeasuredQuantity {
    /// Returns the name in the state of the model, for a part of it.
    pub fn state_name(&self, model: &Model) -> Option<String> {
        Some(match self {
            Self::Coordinate(id) => model.coordinates[*id].name.clone(),
            Self::CoordinateRate(id) => format!("{}_dot", model.coordinates[*id].name),
            Self::State(id) => model.states[*id].name.clone(),
            Self::Mode {
                field,
                number,
                is_rate,
                ..
            } => {
                let modes = &model.fields.get(*field)?.coordinates;
                let suffix = if *is_rate { "_dot" } else { "" };
                format!("{modes}_{number}{suffix}")
            }
            _ => return None,
        })
    }
}

impl SampledExpression {
    /// Evaluates the expression at values of the measured quantities, SI.
    pub fn evaluate(&self, measured: &[f64]) -> f64 {
        match &self.kind {
            SampledKind::Number(value) => *value,
            SampledKind::Measured(place) => measured.get(*place).copied().unwrap_or(f64::NAN),
            SampledKind::Negate(operand) => -operand.evaluate(measured),
            SampledKind::Binary(operator, left, right) => {
                binary(*operator, left.evaluate(measured), right.evaluate(measured))
            }
            SampledKind::Call(function, arguments) => {
                let mut values = [f64::NAN; 2];
                for (value, argument) in values.iter_mut().zip(arguments) {
                    *value = argument.evaluate(measured);
                }
                call(*function, values[0], values[1])
            }
            SampledKind::Clamp(arguments) => {
                let [x, low, high] = arguments.each_ref().map(|own| own.evaluate(measured));
                clamp(x, low, high)
            }
            SampledKind::Quantise(arguments) => {
                let [x, step] = arguments.each_ref().map(|own| own.evaluate(measured));
                quantise(x, step)
            }
        }
    }

    /// Calls `see` with this expression and all its parts.
    pub fn visit(&self, see: &mut impl FnMut(&Self)) {
        see(self);
        match &self.kind {
            SampledKind::Number(_) | SampledKind::Measured(_) => {}
            SampledKind::Negate(operand) => operand.visit(see),
            SampledKind::Binary(_, left, right) => {
                left.visit(see);
                right.visit(see);
            }
            SampledKind::Call(_, arguments) => arguments.iter().for_each(|own| own.visit(see)),
            SampledKind::Clamp(arguments) => arguments.iter().for_each(|own| own.visit(see)),
            SampledKind::Quantise(arguments) => arguments.iter().for_each(|own| own.visit(see)),
        }
    }
}

/// Returns x, at least `low` and at most `high`; NaN stays NaN. If `low` is above `high`, the result is `high`.
fn clamp(x: f64, low: f64, high: f64) -> f64 {
    let raised = if x < low { low } else { x };
    if raised > high { high } else { raised }
}

/// Returns the multiple of `step` that is nearest to x; halves are rounded away from zero.
fn quantise(x: f64, step: f64) -> f64 {
    step * (x / step).round()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clamp_limits_and_propagates_nan() {
        assert_eq!(
            [-3.0, 0.5, 7.0].map(|x| clamp(x, -1.0, 2.0)),
            [-1.0, 0.5, 2.0]
        );
        assert!(clamp(f64::NAN, -1.0, 2.0).is_nan());
    }

    #[test]
    fn halves_are_rounded_away_from_zero() {
        let found = [-0.75, -0.25, -0.2, 0.2, 0.25, 0.75, 1.3].map(|x| quantise(x, 0.5));
        assert_eq!(found, [-1.0, -0.5, -0.0, 0.0, 0.5, 1.0, 1.5]);
        assert_eq!(quantise(0.7, -0.5), 0.5);
        assert!(quantise(f64::NAN, 0.5).is_nan() && quantise(1.0, 0.0).is_nan());
    }
}
