//! Expands expressions with vectors to scalars, and reports operands of the wrong kind. An expression that is used
//! several times gets a name, so that nested products do not double in size at every level.

use super::definitions::Owner;
use super::requirements::UnitRequirement;
use super::rotation::Factor;
use super::scalar::{expansion, is_plain, negate, set_span};
use super::state::ExpansionState;
use super::value::{Dimensions, Value};
use super::vector::{AXES, Vector, component, zero};
use crate::ast::{Syntax, SyntaxKind};
use crate::diagnostic::{Diagnostic, quote};
use crate::dimension::Dimension;
use crate::quantity::Quantity;
use crate::span::Span;
use crate::suggest::did_you_mean;

pub const MEMBERS: [&str; 7] = [
    "origin",
    "velocity",
    "angular_velocity",
    "rotation",
    "x",
    "y",
    "z",
];

/// Largest size of a repeated expression inside integrals and sums, which cannot be named.
const MAX_REPEATED: usize = 10_000;

pub struct Reader<'s> {
    pub(super) space: &'s mut ExpansionState,
    pub(super) owner: &'s Owner,
    /// Number of enclosing integrals, sums and `at`.
    pub(super) open_scopes: usize,
}

pub(super) type EvaluationResult = Result<Value, Diagnostic>;

impl<'s> Reader<'s> {
    pub fn new(space: &'s mut ExpansionState, owner: &'s Owner) -> Self {
        Self {
            space,
            owner,
            open_scopes: 0,
        }
    }

    pub fn value(&mut self, syntax: &Syntax) -> EvaluationResult {
        let span = syntax.span;
        match &syntax.kind {
            SyntaxKind::Number(_) | SyntaxKind::Element { .. } => Ok(Value::Scalar(syntax.clone())),
            SyntaxKind::Name(name) => self.name(name, syntax),
            SyntaxKind::Vector(components) => self.literal(components, span),
            SyntaxKind::Member {
                of,
                member,
                member_span,
            } => self.member(of, (member, *member_span), span),
            SyntaxKind::Negate(operand) => match self.value(operand)? {
                Value::Scalar(operand) => Ok(Value::Scalar(Syntax {
                    kind: SyntaxKind::Negate(Box::new(operand)),
                    span,
                })),
                Value::Vector(vector, dimensions) => {
                    Ok(Value::Vector(vector.map(negate), dimensions))
                }
                rotation @ Value::Rotation(..) => {
                    Err(Diagnostic::error("a rotation has no negative")
                        .with_span(span, rotation.kind())
                        .with_help("write transpose(R) for the inverse rotation"))
                }
            },
            SyntaxKind::Binary(operator, left, right) => {
                let (left, right) = (
                    (self.value(left)?, left.span),
                    (self.value(right)?, right.span),
                );
                self.binary(*operator, left, right, span)
            }
            SyntaxKind::Call {
                function,
                function_span,
                arguments,
            } => self.call((function, *function_span), arguments, span),
        }
    }

    pub fn scalar(
        &mut self,
        quantity: &Quantity,
        subject: &str,
        help: &str,
    ) -> Result<Syntax, Diagnostic> {
        let syntax = quantity.syntax()?;
        match self.value(&syntax)? {
            Value::Scalar(scalar) => Ok(scalar),
            other => Err(Diagnostic::error(format!("{subject} is {}", other.kind()))
                .with_span(syntax.span, "expected a scalar")
                .with_help(help)),
        }
    }

    /// Returns a plain expression unchanged. For any other expression, returns the name of a new definition.
    pub(super) fn named(&mut self, value: Syntax) -> Result<Syntax, Diagnostic> {
        if is_plain(&value) {
            return Ok(value);
        }
        if self.open_scopes > 0 || self.is_reported(&value) {
            // An expression of the position cannot be named outside its field, and a multiplier or residual cannot be
            // named outside observables.
            let mut size = 0;
            value.visit(&mut |_| size += 1);
            return match size > MAX_REPEATED {
                true => Err(Diagnostic::error("this expression becomes too large")
                    .with_span(value.span, "each product repeats it")
                    .with_help("move vectors that do not depend on the position to [definitions]")),
                false => Ok(value),
            };
        }
        let part = self.space.definitions.unique_part_name(self.owner);
        Ok(self.space.definitions.named(self.owner, &part, value))
    }

    fn is_reported(&self, value: &Syntax) -> bool {
        let mut reported = false;
        value.visit(&mut |part| {
            if let SyntaxKind::Name(name) = &part.kind {
                reported |= self.space.constraint_outputs.contains(name);
            }
        });
        reported
    }

    pub(super) fn name_each(&mut self, [x, y, z]: Vector) -> Result<Vector, Diagnostic> {
        Ok([self.named(x)?, self.named(y)?, self.named(z)?])
    }

    fn name(&self, name: &str, syntax: &Syntax) -> EvaluationResult {
        match self.space.vectors.get(name) {
            Some(Value::Vector(vector, dimensions)) => {
                let at = |component: &Syntax| set_span(component.clone(), syntax.span);
                return Ok(Value::Vector(vector.each_ref().map(at), *dimensions));
            }
            Some(rotation) => return Ok(rotation.clone()),
            None => {}
        }
        if self.space.frames.name_motion(name).is_some()
            && !self.space.definitions.is_declared(name)
        {
            return Err(
                Diagnostic::error(format!("the frame `{name}` is not a quantity"))
                    .with_span(syntax.span, "a frame")
                    .with_help(format!(
                        "its members are {}: write for example {name}.origin",
                        MEMBERS.join(", ")
                    )),
            );
        }
        Ok(Value::Scalar(syntax.clone()))
    }

    /// Evaluates a vector of three components. The caller checks their units.
    ///
    /// # Errors
    /// Errors of `value`; or the value is of another kind.
    pub fn evaluate_spatial_vector(
        &mut self,
        syntax: &Syntax,
        subject: &str,
    ) -> Result<Vector, Diagnostic> {
        let read = match &syntax.kind {
            SyntaxKind::Vector(components) => self.components(components, syntax.span)?,
            _ => self.value(syntax)?,
        };
        match read {
            Value::Vector(vector, Dimensions::Three) => Ok(vector),
            other => Err(Diagnostic::error(format!("{subject} is {}", other.kind()))
                .with_span(syntax.span, "expected a vector of 3 components")
                .with_help("write [x, y, z]")),
        }
    }

    pub fn evaluate_with_unit(
        &mut self,
        written: &Quantity,
        subject: &str,
        dimension: Dimension,
    ) -> Result<Vector, Diagnostic> {
        let syntax = written.syntax()?;
        let vector = self.evaluate_spatial_vector(&syntax, subject)?;
        for (component, axis) in vector.iter().zip(AXES) {
            self.space.requirements.units.push(UnitRequirement {
                value: expansion(component.clone()),
                dimension,
                subject: format!("the {axis} component of {subject}"),
            });
        }
        Ok(vector)
    }

    fn literal(&mut self, components: &[Syntax], span: Span) -> EvaluationResult {
        let read = self.components(components, span)?;
        if let Value::Vector(vector, _) = &read {
            self.require_same_unit(vector);
        }
        Ok(read)
    }

    fn components(&mut self, components: &[Syntax], span: Span) -> EvaluationResult {
        let dimensions = match components.len() {
            2 => Dimensions::Two,
            3 => Dimensions::Three,
            count => {
                let plural = if count == 1 { "" } else { "s" };
                return Err(Diagnostic::error(format!(
                    "a vector cannot have {count} component{plural}"
                ))
                .with_span(span, "expected 2 or 3")
                .with_help("write [x, y, z], or [x, y] in the plane"));
            }
        };
        let mut vector = zero(span);
        for (own, component) in vector.iter_mut().zip(components) {
            *own = match self.value(component)? {
                Value::Scalar(scalar) => scalar,
                other => {
                    return Err(
                        Diagnostic::error("a component of a vector must be a scalar")
                            .with_span(component.span, format!("this is {}", other.kind())),
                    );
                }
            };
        }
        Ok(Value::Vector(vector, dimensions))
    }

    /// Requires that the components have equal units.
    pub(super) fn require_same_unit(&mut self, vector: &Vector) {
        if self.open_scopes == 0 {
            let components = vector.iter().map(|c| expansion(c.clone()));
            self.space
                .requirements
                .same_unit_vectors
                .push(components.collect());
        }
    }

    fn member(
        &mut self,
        of: &Syntax,
        (member, place): (&str, Span),
        span: Span,
    ) -> EvaluationResult {
        if let SyntaxKind::Name(name) = &of.kind
            && !self.space.vectors.contains_key(name)
        {
            if self.space.frames.name_motion(name).is_some() {
                return self.frame_member(name, member, place, span);
            }
            if !self.space.definitions.is_declared(name) {
                return Err(self.unknown_owner(name, of.span));
            }
        }
        match self.value(of)? {
            Value::Vector(vector, dimensions) => {
                let axes = &AXES[..dimensions.count()];
                match axes.iter().position(|axis| *axis == member) {
                    Some(axis) => Ok(Value::Scalar(set_span(component(&vector, axis), span))),
                    None => Err(Diagnostic::error(format!(
                        "a vector has no component {}",
                        quote(member)
                    ))
                    .with_span(place, "not known")
                    .with_help(format!("its components are {}", axes.join(", ")))),
                }
            }
            other => Err(Diagnostic::error(format!(
                "{} has no component {}",
                other.kind(),
                quote(member)
            ))
            .with_span(of.span, format!("this is {}", other.kind()))),
        }
    }

    fn unknown_owner(&self, name: &str, span: Span) -> Diagnostic {
        let vectors = self.space.vectors.keys().map(String::as_str);
        let known = vectors.chain(self.space.frame_names.iter().map(String::as_str));
        Diagnostic::error(format!("unknown name {}", quote(name)))
            .with_span(span, "neither a vector nor a frame")
            .with_optional_help(did_you_mean(name, known))
    }

    /// Returns a member of a frame, as components along the fixed axes.
    fn frame_member(
        &mut self,
        name: &str,
        member: &str,
        place: Span,
        span: Span,
    ) -> EvaluationResult {
        let ExpansionState {
            frames,
            definitions,
            placements,
            ..
        } = &mut *self.space;
        let Some(frame) = frames.name_motion(name) else {
            return Err(self.unknown_owner(name, span));
        };
        let vector = match member {
            "origin" => placements.origin(frame, frames, definitions),
            "velocity" => placements.velocity(frame, frames, definitions),
            "angular_velocity" => placements.angular_velocity(frame, frames, definitions),
            "rotation" => {
                let rows = placements.rows(frame, frames, definitions);
                let factor = Factor::Frame(Box::new(rows));
                return Ok(Value::Rotation(vec![factor], Dimensions::Three));
            }
            _ => match AXES.iter().position(|axis| *axis == member) {
                Some(axis) => {
                    let rows = placements.rows(frame, frames, definitions);
                    rows.map(|row| row[axis].clone())
                }
                None => {
                    let known = format!("the members of a frame are {}", MEMBERS.join(", "));
                    return Err(Diagnostic::error(format!(
                        "a frame has no member {}",
                        quote(member)
                    ))
                    .with_span(place, "not known")
                    .with_help(did_you_mean(member, MEMBERS).unwrap_or(known)));
                }
            },
        };
        Ok(spatial(vector, span))
    }
}

/// Returns a vector of three components with this position in the text.
fn spatial(vector: Vector, span: Span) -> Value {
    let at = |component| set_span(component, span);
    Value::Vector(vector.map(at), Dimensions::Three)
}
