//! Functions of vectors and rotations.

use super::expression::{EvaluationResult, Reader};
use super::operations::{scalar_product, set_span};
use super::rotation::{Factor, Turn};
use super::scalar::{call, is_literal, number};
use super::value::{Dimensions, Value};
use super::vector::{Vector, cross};
use crate::ast::{BinaryOperator, Syntax, SyntaxKind};
use crate::diagnostic::{Diagnostic, quote};
use crate::functions::VECTOR_FUNCTIONS;
use crate::span::Span;

impl Reader<'_> {
    pub(super) fn call(
        &mut self,
        (function, place): (&str, Span),
        arguments: &[Syntax],
        span: Span,
    ) -> EvaluationResult {
        let made = match (function, arguments) {
            ("dot", [a, b]) => self.dot_product(a, b, span)?,
            ("dot", [operand]) => match self.value(operand)? {
                Value::Vector(vector, dimensions) => Value::Vector(self.rates(vector)?, dimensions),
                Value::Scalar(operand) => {
                    Value::Scalar(rebuild_call(function, place, vec![operand]))
                }
                rotation @ Value::Rotation(..) => {
                    return Err(Diagnostic::error("a rotation has no rate")
                        .with_span(operand.span, rotation.kind())
                        .with_help(
                            "write FRAME.angular_velocity for the rotation rate of a frame",
                        ));
                }
            },
            ("cross", [a, b]) => self.cross_product(a, b)?,
            ("norm", [of]) => Value::Scalar(self.norm(of)?),
            ("transpose", [of]) => self.transposed(of)?,
            ("rotation", [angle]) => {
                let turn = self.turn(2, angle)?;
                Value::Rotation(vec![turn], Dimensions::Two)
            }
            ("rotation", [axis, angle]) => {
                let factor = self.rotation_about(axis, angle)?;
                Value::Rotation(vec![factor], Dimensions::Three)
            }
            ("rotation_x" | "rotation_y" | "rotation_z", [angle]) => {
                let axis = match function {
                    "rotation_x" => 0,
                    "rotation_y" => 1,
                    _ => 2,
                };
                Value::Rotation(vec![self.turn(axis, angle)?], Dimensions::Three)
            }
            _ if VECTOR_FUNCTIONS.contains(&function) => {
                return Err(argument_count_error(function, arguments, span));
            }
            _ => Value::Scalar(self.call_of_scalars((function, place), arguments)?),
        };
        Ok(set_span(made, span))
    }

    fn call_of_scalars(
        &mut self,
        (function, place): (&str, Span),
        arguments: &[Syntax],
    ) -> Result<Syntax, Diagnostic> {
        let is_along = matches!(function, "integral" | "sum" | "at");
        self.open_scopes += usize::from(is_along);
        let mut scalars = Vec::with_capacity(arguments.len());
        for argument in arguments {
            match self.value(argument)? {
                Value::Scalar(scalar) => scalars.push(scalar),
                other => {
                    let help = match function {
                        "abs" | "sqrt" => "write norm(v) for the length of a vector",
                        _ => "use a component, v.x, the length, norm(v), or a product, dot(a, b)",
                    };
                    let message = format!("{} accepts only scalars", quote(function));
                    return Err(Diagnostic::error(message)
                        .with_span(argument.span, format!("this is {}", other.kind()))
                        .with_help(help));
                }
            }
        }
        self.open_scopes -= usize::from(is_along);
        Ok(rebuild_call(function, place, scalars))
    }

    fn dot_product(&mut self, a: &Syntax, b: &Syntax, span: Span) -> EvaluationResult {
        let (left, right) = (self.value(a)?, self.value(b)?);
        match (left, right) {
            (Value::Vector(left, one), Value::Vector(right, other)) if one == other => {
                Ok(Value::Scalar(scalar_product(left, right)))
            }
            (left, right) => Err(vector_operands_error(
                "dot(a, b)",
                (&left, a.span),
                (&right, b.span),
                span,
            )),
        }
    }

    fn cross_product(&mut self, a: &Syntax, b: &Syntax) -> EvaluationResult {
        let (left, right) = (self.value(a)?, self.value(b)?);
        match (left, right) {
            (Value::Vector(left, dimensions), Value::Vector(right, other))
                if dimensions == other =>
            {
                let (left, right) = (self.name_each(left)?, self.name_each(right)?);
                let product = cross(&left, &right);
                let [_, _, z] = &product;
                Ok(match dimensions {
                    Dimensions::Two => Value::Scalar(z.clone()),
                    Dimensions::Three => Value::Vector(product, dimensions),
                })
            }
            (left, right) => Err(vector_operands_error(
                "cross(a, b)",
                (&left, a.span),
                (&right, b.span),
                a.span.join(b.span),
            )),
        }
    }

    fn norm(&mut self, of: &Syntax) -> Result<Syntax, Diagnostic> {
        match self.value(of)? {
            Value::Vector(vector, _) => {
                let vector = self.name_each(vector)?;
                Ok(call("sqrt", scalar_product(vector.clone(), vector)))
            }
            other => Err(Diagnostic::error("`norm` accepts only a vector")
                .with_span(of.span, format!("this is {}", other.kind()))
                .with_help("write abs(x) for the magnitude of a scalar")),
        }
    }

    fn transposed(&mut self, of: &Syntax) -> EvaluationResult {
        match self.value(of)? {
            Value::Rotation(factors, dimensions) => {
                let back = factors.into_iter().rev().map(Factor::transpose);
                Ok(Value::Rotation(back.collect(), dimensions))
            }
            other => Err(Diagnostic::error("`transpose` accepts only a rotation")
                .with_span(of.span, format!("this is {}", other.kind()))
                .with_help(
                    "for example transpose(FRAME.rotation)*v gives the components of v along the axes of the frame",
                )),
        }
    }

    fn turn(&mut self, axis: usize, angle: &Syntax) -> Result<Factor, Diagnostic> {
        let mut angle = self.angle(angle)?;
        // A constant angle is not replaced by a name, so that a quarter turn is recognised and exact.
        if self.space.definitions.moving.has_rate(&angle) {
            angle = self.named(angle)?;
        }
        Ok(Factor::Turn(Turn { axis, angle }))
    }

    fn angle(&mut self, angle: &Syntax) -> Result<Syntax, Diagnostic> {
        match self.value(angle)? {
            Value::Scalar(scalar) => Ok(scalar),
            other => Err(Diagnostic::error("an angle must be a scalar")
                .with_span(angle.span, format!("this is {}", other.kind()))
                .with_help("write rotation_z(ANGLE), or rotation(AXIS, ANGLE)")),
        }
    }

    /// Returns the rotation about an axis. The axis may have any length other than 0.
    fn rotation_about(&mut self, axis: &Syntax, angle: &Syntax) -> Result<Factor, Diagnostic> {
        let direction = match self.value(axis)? {
            Value::Vector(direction, Dimensions::Three) => direction,
            other => {
                return Err(
                    Diagnostic::error("an axis must be a vector of 3 components")
                        .with_span(axis.span, format!("this is {}", other.kind()))
                        .with_help("for example rotation([0, 0, 1], ANGLE)"),
                );
            }
        };
        let angle = self.angle(angle)?;
        let (cosine, sine) = Turn { axis: 2, angle }.cosine_and_sine();
        let direction = self.unit(direction, axis.span)?;
        let (cosine, sine) = (self.named(cosine)?, self.named(sine)?);
        Ok(Factor::AxisAngle(Box::new((direction, cosine, sine))))
    }

    fn unit(&mut self, vector: Vector, span: Span) -> Result<Vector, Diagnostic> {
        let numbers = vector.each_ref().map(|component| match &component.kind {
            SyntaxKind::Number(value) => Some(*value),
            SyntaxKind::Negate(operand) => match operand.kind {
                SyntaxKind::Number(value) => Some(-value),
                _ => None,
            },
            _ => None,
        });
        if let [Some(x), Some(y), Some(z)] = numbers {
            let length = x.hypot(y).hypot(z);
            if length == 0.0 {
                return Err(Diagnostic::error("an axis must not be zero")
                    .with_span(span, "its length is 0"));
            }
            return Ok([x, y, z].map(|component| number(component / length, span)));
        }
        let vector = self.name_each(vector)?;
        let square = scalar_product(vector.clone(), vector.clone());
        let length = self.named(call("sqrt", square))?;
        self.name_each(vector.map(|component| match is_literal(&component, 0.0) {
            true => component,
            false => Syntax {
                kind: SyntaxKind::Binary(
                    BinaryOperator::Divide,
                    Box::new(component),
                    Box::new(length.clone()),
                ),
                span,
            },
        }))
    }

    fn rates(&mut self, [x, y, z]: Vector) -> Result<Vector, Diagnostic> {
        Ok([self.rate(x)?, self.rate(y)?, self.rate(z)?])
    }

    fn rate(&mut self, component: Syntax) -> Result<Syntax, Diagnostic> {
        let span = component.span;
        if !self.space.definitions.moving.has_rate(&component) {
            return Ok(number(0.0, span));
        }
        if self.open_scopes > 0 {
            return Ok(call("dot", component));
        }
        let part = self.space.definitions.unique_part_name(self.owner);
        let definitions = &mut self.space.definitions;
        Ok(definitions.rate(self.owner, &part, component))
    }
}

fn rebuild_call(function: &str, place: Span, arguments: Vec<Syntax>) -> Syntax {
    Syntax {
        kind: SyntaxKind::Call {
            function: function.to_owned(),
            function_span: place,
            arguments,
        },
        span: place,
    }
}

fn vector_operands_error(
    what: &str,
    (left, left_place): (&Value, Span),
    (right, right_place): (&Value, Span),
    span: Span,
) -> Diagnostic {
    let finding = Diagnostic::error(format!(
        "{what} needs two vectors with the same number of components"
    ));
    let help = match (left, right) {
        (Value::Scalar(_), Value::Scalar(_)) => "write a*b for the product of scalars",
        _ => "give two vectors [x, y, z], or two vectors [x, y]",
    };
    finding
        .with_span(span, "expected two vectors")
        .with_related_span(left_place, left.kind())
        .with_related_span(right_place, right.kind())
        .with_help(help)
}

fn argument_count_error(function: &str, arguments: &[Syntax], span: Span) -> Diagnostic {
    let written = match function {
        "cross" => "cross(a, b)",
        "norm" => "norm(v)",
        "transpose" => "transpose(R)",
        "rotation" => "rotation(AXIS, ANGLE), or rotation(ANGLE) in the plane",
        _ => "one angle, for example rotation_z(q)",
    };
    let count = arguments.len();
    let plural = if count == 1 { "" } else { "s" };
    Diagnostic::error(format!(
        "`{function}` does not accept {count} argument{plural}"
    ))
    .with_span(span, "here")
    .with_help(format!("write {written}"))
}
