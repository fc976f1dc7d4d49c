//! Expressions of controllers. Their quantities are known at a sample.

use crate::model::{MeasuredQuantity, Model, SampledExpression, SampledKind};

impl MeasuredQuantity {
    /// Returns the name of the quantity in the state of the model, if it is an element of the state.
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
    /// Calls `see` with this expression and all its subexpressions.
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
