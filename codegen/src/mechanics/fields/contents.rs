//! Quantities that a part of an integrand depends on.

use eomgen_model_spec::ids::DefinitionId;
use eomgen_model_spec::model::{Expr, ExprKind, Model};

/// Quantities that an expression depends on.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Contents {
    pub position: bool,
    pub shapes: bool,
    pub motion: bool,
    pub time: bool,
}

impl Contents {
    pub fn include(&mut self, other: Self) {
        self.position |= other.position;
        self.shapes |= other.shapes;
        self.motion |= other.motion;
        self.time |= other.time;
    }

    /// Returns true for a function of the position and parameters only.
    pub fn is_coefficient(self) -> bool {
        self.position && !self.shapes && !self.motion && !self.time
    }

    pub fn varies_along_field(self) -> bool {
        self.position || self.shapes
    }
}

/// Finds the quantities that a part of an integrand depends on.
pub(super) fn contents(model: &Model, expr: &Expr) -> Contents {
    let mut found = Contents::default();
    match &expr.kind {
        ExprKind::Number(_) | ExprKind::Pi | ExprKind::Parameter(_) => {}
        ExprKind::Time => found.time = true,
        ExprKind::Position(_) => found.position = true,
        ExprKind::Field(_) | ExprKind::ModeShape(_) => found.shapes = true,
        ExprKind::Dot(operand) | ExprKind::Diff(operand, _) => {
            found = contents(model, operand);
            found.motion |= !found.shapes;
        }
        ExprKind::Definition(index) => found = find_definition_quantities(model, *index),
        ExprKind::Negate(operand) => found = contents(model, operand),
        ExprKind::Binary(_, left, right) => {
            found = contents(model, left);
            found.include(contents(model, right));
        }
        ExprKind::Call(_, arguments) => {
            for argument in arguments {
                found.include(contents(model, argument));
            }
        }
        _ => found.motion = true,
    }
    found
}

/// Returns the contents of a definition, which is constant along fields.
fn find_definition_quantities(model: &Model, index: DefinitionId) -> Contents {
    let value = &model.definitions[index].value;
    let mut found = Contents::default();
    value.visit(&mut |part| match &part.kind {
        ExprKind::Number(_)
        | ExprKind::Pi
        | ExprKind::Parameter(_)
        | ExprKind::Negate(_)
        | ExprKind::Binary(..)
        | ExprKind::Call(..) => {}
        ExprKind::Time => found.time = true,
        ExprKind::Definition(index) => found.include(find_definition_quantities(model, *index)),
        _ => found.motion = true,
    });
    found
}
