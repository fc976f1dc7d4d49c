//! Sums, products and quotients of scalars, vectors and rotations.

use super::expression::{EvaluationResult, Reader};
use super::rotation::Factor;
use super::scalar::{add, multiply, negate, number};
use super::value::Value;
use super::vector::{Rows, Vector, scale, sum, zero};
use crate::ast::{BinaryOperator, Syntax, SyntaxKind};
use crate::diagnostic::Diagnostic;
use crate::span::Span;

/// Largest number of factors kept in a named rotation. Three turns can represent any rotation. With more factors, a
/// matrix needs fewer products.
const MAX_FACTORS: usize = 3;

type Operand = (Value, Span);

impl Reader<'_> {
    pub(super) fn binary(
        &mut self,
        operator: BinaryOperator,
        left: Operand,
        right: Operand,
        span: Span,
    ) -> EvaluationResult {
        match (left.0, right.0) {
            (Value::Scalar(left), Value::Scalar(right)) => {
                let kind = SyntaxKind::Binary(operator, Box::new(left), Box::new(right));
                Ok(Value::Scalar(Syntax { kind, span }))
            }
            (one, other) => {
                let (left, right) = ((one, left.1), (other, right.1));
                let made = match operator {
                    BinaryOperator::Add => self.sum(left, right, false)?,
                    BinaryOperator::Subtract => self.sum(left, right, true)?,
                    BinaryOperator::Multiply => self.product(left, right, span)?,
                    BinaryOperator::Divide => self.quotient(left, right)?,
                    BinaryOperator::Power => return Err(power(&left, &right)),
                };
                Ok(set_span(made, span))
            }
        }
    }

    fn sum(&mut self, left: Operand, right: Operand, minus: bool) -> EvaluationResult {
        match (left, right) {
            ((Value::Vector(a, one), _), (Value::Vector(b, other), _)) if one == other => {
                let b = match minus {
                    true => b.map(negate),
                    false => b,
                };
                let total = sum(a, b);
                self.require_same_unit(&total);
                Ok(Value::Vector(total, one))
            }
            (left, right) => Err(addition_error(&left, &right)),
        }
    }

    fn product(&mut self, left: Operand, right: Operand, span: Span) -> EvaluationResult {
        match (left, right) {
            ((Value::Scalar(by), _), (Value::Vector(vector, dimensions), _))
            | ((Value::Vector(vector, dimensions), _), (Value::Scalar(by), _)) => {
                let by = self.named(by)?;
                Ok(Value::Vector(scale(&vector, &by), dimensions))
            }
            ((Value::Rotation(mut first, one), _), (Value::Rotation(then, other), _))
                if one == other =>
            {
                first.extend(then);
                Ok(Value::Rotation(first, one))
            }
            ((Value::Rotation(factors, one), _), (Value::Vector(vector, other), _))
                if one == other =>
            {
                Ok(Value::Vector(self.rotate(&factors, vector)?, one))
            }
            (left @ (Value::Vector(..), _), right @ (Value::Vector(..), _)) => {
                Err(Diagnostic::error("`*` of two vectors is ambiguous")
                    .with_span(span, "`*` needs a scalar operand")
                    .with_related_span(left.1, left.0.kind())
                    .with_related_span(right.1, right.0.kind())
                    .with_help("write dot(a, b) for the scalar product, cross(a, b) for the vector product"))
            }
            (left @ (Value::Vector(..), _), right @ (Value::Rotation(..), _)) => {
                Err(operand_error(&left, &right)
                    .with_help("write the rotation before the vector: R*v"))
            }
            (left, right) => Err(operand_error(&left, &right)
                .with_help("multiply a rotation by a vector, R*v, or by another rotation, R*S; a scalar stands before such a product, s*(R*v)")),
        }
    }

    fn quotient(&mut self, left: Operand, right: Operand) -> EvaluationResult {
        match (left, right) {
            ((Value::Vector(vector, dimensions), _), (Value::Scalar(by), span)) => {
                let by = self.named(by)?;
                let divided = vector.map(|component| divided(component, &by, span));
                Ok(Value::Vector(divided, dimensions))
            }
            (left, right) => {
                Err(operand_error(&left, &right).with_help("divide a vector only by a scalar: v/m"))
            }
        }
    }

    /// Returns the factors of a named rotation. A long product is replaced by its matrix with named
    /// elements, so that references have one factor.
    ///
    /// # Errors
    /// Errors of the generation of names.
    pub(super) fn shared_rotation(
        &mut self,
        factors: Vec<Factor>,
        span: Span,
    ) -> Result<Vec<Factor>, Diagnostic> {
        if factors.len() <= MAX_FACTORS {
            return Ok(factors);
        }
        let mut rows: Rows = [0, 1, 2].map(|_| zero(span));
        for axis in 0..3 {
            let mut column = zero(span);
            column[axis] = number(1.0, span);
            let column = self.rotate(&factors, column)?;
            for (row, element) in rows.iter_mut().zip(self.name_each(column)?) {
                row[axis] = element;
            }
        }
        Ok(vec![Factor::Frame(Box::new(rows))])
    }

    /// Rotates a vector by all factors, starting with the last factor.
    pub(super) fn rotate(
        &mut self,
        factors: &[Factor],
        vector: Vector,
    ) -> Result<Vector, Diagnostic> {
        let mut turned = vector;
        for factor in factors.iter().rev() {
            turned = factor.turn(&turned, &mut |value| self.named(value))?;
        }
        Ok(turned)
    }
}

pub fn set_span(value: Value, span: Span) -> Value {
    let here = |component: Syntax| Syntax { span, ..component };
    match value {
        Value::Scalar(scalar) => Value::Scalar(here(scalar)),
        Value::Vector(vector, dimensions) => Value::Vector(vector.map(here), dimensions),
        rotation => rotation,
    }
}

fn divided(component: Syntax, by: &Syntax, span: Span) -> Syntax {
    if super::scalar::is_literal(&component, 0.0) {
        return component;
    }
    let kind = SyntaxKind::Binary(
        BinaryOperator::Divide,
        Box::new(component),
        Box::new(by.clone()),
    );
    Syntax { kind, span }
}

pub fn addition_error(left: &Operand, right: &Operand) -> Diagnostic {
    let message = format!("{} and {} cannot be added", left.0.kind(), right.0.kind());
    let help = match (&left.0, &right.0) {
        (Value::Vector(..), Value::Vector(..)) => "give both vectors 3 components: write [x, y, 0]",
        (Value::Rotation(..), _) | (_, Value::Rotation(..)) => "multiply rotations: R*S",
        _ => "write the scalar as a vector, for example [x, 0, 0], or use a component, v.x",
    };
    Diagnostic::error(message)
        .with_span(right.1, format!("this is {}", right.0.kind()))
        .with_related_span(left.1, left.0.kind())
        .with_help(help)
}

fn operand_error(left: &Operand, right: &Operand) -> Diagnostic {
    let message = format!(
        "{} and {} are not valid operands here",
        left.0.kind(),
        right.0.kind()
    );
    Diagnostic::error(message)
        .with_span(right.1, format!("this is {}", right.0.kind()))
        .with_related_span(left.1, left.0.kind())
}

fn power(left: &Operand, right: &Operand) -> Diagnostic {
    let (value, place) = match &left.0 {
        Value::Scalar(_) => right,
        _ => left,
    };
    Diagnostic::error(format!("{} cannot be raised to a power", value.kind()))
        .with_span(*place, "expected a scalar")
        .with_help("write dot(v, v) for the square of a vector, norm(v) for its length")
}

/// Returns the scalar product `a_x b_x + ...`. The product of two equal names is written as a square.
pub fn scalar_product([ax, ay, az]: Vector, [bx, by, bz]: Vector) -> Syntax {
    let product = |a: Syntax, b: Syntax| match a.kind == b.kind && is_name(&a) {
        true => super::scalar::square(a),
        false => multiply(a, b),
    };
    add(add(product(ax, bx), product(ay, by)), product(az, bz))
}

fn is_name(syntax: &Syntax) -> bool {
    matches!(syntax.kind, SyntaxKind::Name(_))
}
