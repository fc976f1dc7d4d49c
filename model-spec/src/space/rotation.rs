//! Rotations. A rotation of a frame is a product of turns about coordinate axes,
//! `rotation_x(pi/2)*rotation_z(q)`, each about an axis that the turns before it have rotated.
//! A rotation of vectors may also contain turns about any axis and the matrices of frames.

use super::scalar::{add, call, multiply, negate, number};
use super::vector::{Rows, Vector, cross, inner, rotate, scale, sum};
use crate::ast::{BinaryOperator, Syntax, SyntaxKind};
use crate::diagnostic::Diagnostic;
use crate::span::Span;

/// Turn about a coordinate axis.
#[derive(Clone, Debug)]
pub struct Turn {
    /// 0, 1, 2 for x, y, z.
    pub axis: usize,
    /// Angle, right-handed.
    pub angle: Syntax,
}

#[derive(Clone, Debug)]
pub enum Factor {
    /// Turn about a coordinate axis.
    Turn(Turn),
    /// Turn about a unit vector, given by the cosine and the sine of the angle.
    AxisAngle(Box<(Vector, Syntax, Syntax)>),
    /// Rotation from a frame's axes to the fixed axes.
    Frame(Box<Rows>),
    /// Rotation from the fixed axes to the axes of a frame.
    InverseFrame(Box<Rows>),
}

impl Factor {
    pub fn transpose(self) -> Self {
        match self {
            Self::Turn(turn) => Self::Turn(turn.inverse()),
            Self::AxisAngle(about) => {
                let (direction, cosine, sine) = *about;
                Self::AxisAngle(Box::new((direction, cosine, negate(sine))))
            }
            Self::Frame(rows) => Self::InverseFrame(rows),
            Self::InverseFrame(rows) => Self::Frame(rows),
        }
    }

    /// Rotates a vector; `name` names an expression that is used several times.
    ///
    /// # Errors
    /// Errors of `name`.
    pub fn turn(&self, vector: &Vector, name: &mut Naming<'_>) -> Result<Vector, Diagnostic> {
        let [x, y, z] = vector.clone();
        let vector = [name(x)?, name(y)?, name(z)?];
        Ok(match self {
            Self::Turn(turn) => turn.inverse().rotate_axes(&vector),
            Self::Frame(rows) => rotate(rows, &vector),
            Self::InverseFrame(rows) => {
                let columns = [0, 1, 2].map(|j| [0, 1, 2].map(|i| rows[i][j].clone()));
                rotate(&columns, &vector)
            }
            Self::AxisAngle(about) => {
                let (n, cosine, sine) = about.as_ref();
                // Rodrigues' formula: v cos + n x v sin + n (n.v)(1 - cos).
                let rest = add(number(1.0, cosine.span), negate(cosine.clone()));
                let along = name(multiply(inner(n, &vector), rest))?;
                let across = sum(scale(&vector, cosine), scale(&cross(n, &vector), sine));
                sum(across, scale(n, &along))
            }
        })
    }
}

pub type Naming<'n> = dyn FnMut(Syntax) -> Result<Syntax, Diagnostic> + 'n;

/// Returns the turns of a frame's rotation, starting at the parent's axes.
///
/// # Errors
/// The expression is not a product of turns.
pub fn turns(syntax: &Syntax) -> Result<Vec<Turn>, Diagnostic> {
    let mut turns = Vec::new();
    let mut rest = syntax;
    while let SyntaxKind::Binary(BinaryOperator::Multiply, left, right) = &rest.kind {
        turns.push(turn(right)?);
        rest = left;
    }
    turns.push(turn(rest)?);
    turns.reverse();
    Ok(turns)
}

fn turn(syntax: &Syntax) -> Result<Turn, Diagnostic> {
    let help = "write a product of rotation_x(ANGLE), rotation_y(ANGLE) and \
                rotation_z(ANGLE)";
    let refused = |span: Span, why: &str| {
        Diagnostic::error("this is not a rotation of a frame")
            .with_span(span, why)
            .with_help(help)
    };
    let SyntaxKind::Call {
        function,
        function_span,
        arguments,
    } = &syntax.kind
    else {
        return Err(refused(syntax.span, "not a rotation about an axis"));
    };
    let axis = match function.as_str() {
        "rotation_x" => 0,
        "rotation_y" => 1,
        "rotation_z" => 2,
        _ => return Err(refused(*function_span, "not a rotation about an axis")),
    };
    match arguments.as_slice() {
        [angle] => Ok(Turn {
            axis,
            angle: angle.clone(),
        }),
        _ => Err(refused(syntax.span, "expected one angle")),
    }
}

impl Turn {
    pub fn inverse(&self) -> Self {
        Self {
            axis: self.axis,
            angle: negate(self.angle.clone()),
        }
    }

    /// Returns the components of a vector along the rotated axes.
    pub fn rotate_axes(&self, vector: &Vector) -> Vector {
        let (k, i, j) = (self.axis, (self.axis + 1) % 3, (self.axis + 2) % 3);
        let (cosine, sine) = self.cosine_and_sine();
        let product =
            |factor: &Syntax, index: usize| multiply(vector[index].clone(), factor.clone());
        let mut turned = vector.clone();
        turned[i] = add(product(&cosine, i), product(&sine, j));
        turned[j] = add(product(&cosine, j), negate(product(&sine, i)));
        turned[k] = vector[k].clone();
        turned
    }

    /// Returns cosine and sine of the angle, exact for quarter turns. Axes that coincide then coincide exactly in the
    /// equations.
    pub fn cosine_and_sine(&self) -> (Syntax, Syntax) {
        let span = self.angle.span;
        let quarters = quarters(&self.angle).filter(|q| q.fract() == 0.0 && q.abs() < 1e9);
        let values = quarters.map(|quarters| match quarters.rem_euclid(4.0) as u8 {
            0 => (1.0, 0.0),
            1 => (0.0, 1.0),
            2 => (-1.0, 0.0),
            _ => (0.0, -1.0),
        });
        match values {
            Some((cosine, sine)) => (number(cosine, span), number(sine, span)),
            None => match &self.angle.kind {
                SyntaxKind::Negate(angle) => (
                    call("cos", angle.as_ref().clone()),
                    negate(call("sin", angle.as_ref().clone())),
                ),
                _ => (
                    call("cos", self.angle.clone()),
                    call("sin", self.angle.clone()),
                ),
            },
        }
    }
}

fn quarters(angle: &Syntax) -> Option<f64> {
    match &angle.kind {
        SyntaxKind::Number(value) if *value == 0.0 => Some(0.0),
        SyntaxKind::Name(name) if name == "pi" => Some(2.0),
        SyntaxKind::Negate(operand) => Some(-quarters(operand)?),
        SyntaxKind::Binary(operator, left, right) => match (operator, &left.kind, &right.kind) {
            (BinaryOperator::Divide, _, SyntaxKind::Number(by)) => Some(quarters(left)? / by),
            (BinaryOperator::Multiply, SyntaxKind::Number(by), _) => Some(by * quarters(right)?),
            (BinaryOperator::Multiply, _, SyntaxKind::Number(by)) => Some(quarters(left)? * by),
            _ => None,
        },
        _ => None,
    }
}
