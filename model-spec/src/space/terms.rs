//! Replaces vectors in energies, forces, constraints and observables by components.

use super::definitions::Owner;
use super::expression::Reader;
use super::scalar::{expansion, half, is_literal, name, number, set_span};
use super::state::ExpansionState;
use super::value::{Dimensions, Value};
use super::vector::{self, AXES, Vector, cross};
use crate::ast::Syntax;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{MULTIPLIER, RESIDUAL};
use crate::quantity::{Name, Quantity};
use crate::raw::{Document, RawTerm};
use crate::span::Span;

/// Replaces vectors in all sections other than definitions and frames.
pub fn expand(document: &mut Document, space: &mut ExpansionState, found: &mut Diagnostics) {
    let product = "give a scalar, for example 1/2*m*dot(v, v)";
    for (terms, subject) in [
        (&mut document.kinetic, "this term of the kinetic energy"),
        (&mut document.potential, "this term of the potential energy"),
        (&mut document.dissipation, "this term of the dissipation"),
    ] {
        for term in terms {
            let owner = Owner::new(&term.name, &term.doc);
            scalar(space, &owner, &mut term.value, (subject, product), found);
        }
    }
    for state in &mut document.states {
        let owner = Owner::new(&state.name, &state.doc);
        let subject = format!("the rate of `{}`", state.name.text);
        let help = "give a scalar, for example a component, v.x";
        scalar(space, &owner, &mut state.rate, (&subject, help), found);
    }
    for impact in &mut document.impacts {
        let distance = &mut impact.distance;
        let owner = Owner::new(&distance.name, &distance.doc);
        let help = "give a scalar, for example dot(n, r), or norm(r)";
        let subject = ("this distance", help);
        scalar(space, &owner, &mut distance.value, subject, found);
        if let Some(friction) = &mut impact.friction {
            let help =
                "contact friction acts along one direction: give a component, for example v.x";
            scalar(
                space,
                &owner,
                &mut friction.slip,
                ("this slip", help),
                found,
            );
        }
    }
    let forces = std::mem::take(&mut document.forces);
    for force in forces {
        document
            .forces
            .extend(self::expand_forces(space, force, found));
    }
    let constraints = std::mem::take(&mut document.constraints);
    for constraint in constraints {
        let expanded = self::expand_constraints(space, constraint, found);
        document.constraints.extend(expanded);
    }
    for prefix in [MULTIPLIER, RESIDUAL] {
        let constraints = document.constraints.iter();
        let names = constraints.map(|constraint| format!("{prefix}{}", constraint.name.text));
        space.constraint_outputs.extend(names);
    }
    let observables = std::mem::take(&mut document.observables);
    for (term, unit) in observables {
        let terms = self::expand_observables(space, term, found);
        document
            .observables
            .extend(terms.into_iter().map(|term| (term, unit.clone())));
    }
}

/// Evaluates an expression. Returns `None` if it contains no vectors, or after an error.
fn read(
    space: &mut ExpansionState,
    owner: &Owner,
    quantity: &Quantity,
    found: &mut Diagnostics,
) -> Option<Value> {
    let syntax = parse_if_spatial(space, quantity)?;
    found.push_error(Reader::new(space, owner).value(&syntax))
}

/// Returns the expression if it contains vectors and refers to no entry with an error.
fn parse_if_spatial(space: &ExpansionState, quantity: &Quantity) -> Option<Syntax> {
    // Syntax errors are ignored here: `resolve` reports them.
    let syntax = quantity.syntax().ok()?;
    (space.contains_vectors(&syntax) && !space.is_broken(&syntax)).then_some(syntax)
}

fn scalar(
    space: &mut ExpansionState,
    owner: &Owner,
    quantity: &mut Quantity,
    (subject, help): (&str, &str),
    found: &mut Diagnostics,
) {
    if parse_if_spatial(space, quantity).is_none() {
        return;
    }
    let read = Reader::new(space, owner).scalar(quantity, subject, help);
    if let Some(scalar) = found.push_error(read) {
        *quantity = expansion(scalar);
    }
}

fn component(term: &RawTerm, axis: &str, value: Syntax) -> RawTerm {
    RawTerm {
        name: Name {
            text: format!("{}_{axis}", term.name.text),
            span: term.name.span,
        },
        value: expansion(value),
        doc: term.doc.clone(),
        origin: term.origin.clone(),
    }
}

fn component_terms(term: &RawTerm, vector: Vector, dimensions: Dimensions) -> Vec<RawTerm> {
    let components = vector.into_iter().zip(AXES).take(dimensions.count());
    components
        .map(|(value, axis)| component(term, axis, value))
        .collect()
}

/// Replaces a vector by one observable per component.
fn expand_observables(
    space: &mut ExpansionState,
    term: RawTerm,
    found: &mut Diagnostics,
) -> Vec<RawTerm> {
    let owner = Owner::new(&term.name, &term.doc);
    let place = term.value.span();
    match read(space, &owner, &term.value, found) {
        None => vec![term],
        Some(Value::Scalar(value)) => {
            let value = expansion(value);
            vec![RawTerm { value, ..term }]
        }
        Some(Value::Vector(vector, dimensions)) => {
            let columns = [0, 1, 2].map(|axis| vector::component(&vector, axis));
            component_terms(&term, columns, dimensions)
        }
        Some(Value::Rotation(..)) => {
            found.push(
                Diagnostic::error("an observable must be a scalar or a vector")
                    .with_span(place, "this is a rotation")
                    .with_help("report a rotated vector, R*v, or an axis of a frame, FRAME.x"),
            );
            vec![]
        }
    }
}

/// Replaces a vector by one constraint per component. A component that is the literal 0 gives
/// no constraint.
fn expand_constraints(
    space: &mut ExpansionState,
    term: RawTerm,
    found: &mut Diagnostics,
) -> Vec<RawTerm> {
    let owner = Owner::new(&term.name, &term.doc);
    let place = term.value.span();
    match read(space, &owner, &term.value, found) {
        None => vec![term],
        Some(Value::Scalar(value)) => {
            let value = expansion(value);
            vec![RawTerm { value, ..term }]
        }
        Some(Value::Vector(vector, dimensions)) => {
            for prefix in [MULTIPLIER, RESIDUAL] {
                let reported = format!("{prefix}{}", term.name.text);
                let mut axes = AXES.into_iter();
                let components = vector.each_ref().map(|component| {
                    let axis = axes.next().unwrap_or_default();
                    match is_literal(component, 0.0) {
                        true => component.clone(),
                        false => name(&format!("{reported}_{axis}"), place),
                    }
                });
                let value = Value::Vector(components, dimensions);
                space.vectors.insert(reported, value);
            }
            let mut terms = component_terms(&term, vector.clone(), dimensions);
            let mut components = vector.iter();
            terms.retain(|_| components.next().is_none_or(|c| !is_literal(c, 0.0)));
            if terms.is_empty() {
                found.push(
                    Diagnostic::error(format!("the constraint `{}` has no effect", term.name.text))
                        .with_span(place, "this is identically 0"),
                );
            }
            terms
        }
        Some(Value::Rotation(..)) => {
            found.push(
                Diagnostic::error("a constraint cannot be a rotation")
                    .with_span(place, "this is a rotation")
                    .with_help("keep axes parallel by scalar products: dot(A.x, B.y) and so on"),
            );
            vec![]
        }
    }
}

type Force = (RawTerm, Quantity);

/// Replaces a force vector at a point by its components, and a torque by forces on the ends of
/// axes.
fn expand_forces(
    space: &mut ExpansionState,
    (term, on): Force,
    found: &mut Diagnostics,
) -> Vec<Force> {
    let owner = Owner::new(&term.name, &term.doc);
    if parse_if_spatial(space, &term.value).is_none() && parse_if_spatial(space, &on).is_none() {
        return vec![(term, on)];
    }
    let (place, on_place) = (term.value.span(), on.span());
    let mut value_of = |quantity: &Quantity| {
        let syntax = quantity.syntax().ok()?;
        match space.is_broken(&syntax) {
            true => None,
            false => found.push_error(Reader::new(space, &owner).value(&syntax)),
        }
    };
    let (Some(value), Some(on)) = (value_of(&term.value), value_of(&on)) else {
        return vec![];
    };
    match (value, on) {
        (Value::Scalar(value), Value::Scalar(on)) => {
            let value = expansion(value);
            vec![(RawTerm { value, ..term }, expansion(on))]
        }
        (Value::Vector(value, one), Value::Vector(on, other)) if one == other => {
            let forces = component_terms(&term, value, one).into_iter().zip(on);
            keep_moving(space, forces.collect())
        }
        (Value::Vector(torque, Dimensions::Three), Value::Rotation(factors, Dimensions::Three)) => {
            let made = expand_torques(space, &owner, &term, torque, &factors, on_place);
            let forces = found.push_error(made).unwrap_or_default();
            keep_moving(space, forces)
        }
        (value, on) => {
            found.push(force_error(&value, place, &on, on_place));
            vec![]
        }
    }
}

/// Keeps the forces on points that move. If no point moves, keeps the first force, so that a later step reports the
/// error.
fn keep_moving(space: &ExpansionState, mut forces: Vec<(RawTerm, Syntax)>) -> Vec<Force> {
    let moves = |(_, on): &&(RawTerm, Syntax)| space.definitions.moving.has_rate(on);
    if forces.iter().any(|force| moves(&force)) {
        forces.retain(|force| moves(&force));
    } else {
        forces.truncate(1);
    }
    let kept = forces.into_iter();
    kept.map(|(term, on)| (term, expansion(on))).collect()
}

/// Expands a torque t on axes e_k. A small rotation d moves their ends by d x e_k, and the sum
/// of 1/2 (t x e_k).(d x e_k) over three axes is t.d.
fn expand_torques(
    space: &mut ExpansionState,
    owner: &Owner,
    term: &RawTerm,
    torque: Vector,
    factors: &[super::rotation::Factor],
    place: Span,
) -> Result<Vec<(RawTerm, Syntax)>, Diagnostic> {
    let mut reader = Reader::new(space, owner);
    let torque = reader.name_each(torque)?;
    let halves = reader.name_each(torque.map(half))?;
    // An error in the torque is reported at its own position.
    let value_span = term.value.span();
    let mut forces = Vec::with_capacity(9);
    for (axis, own) in AXES.into_iter().enumerate() {
        let mut unit = [0, 1, 2].map(|_| number(0.0, place));
        unit[axis] = number(1.0, place);
        let end = reader.rotate(factors, unit)?;
        let end = reader.name_each(end)?;
        for ((value, on), along) in cross(&halves, &end).into_iter().zip(end).zip(AXES) {
            let value = Syntax {
                span: value_span,
                ..value
            };
            let on = set_span(on, place);
            forces.push((component(term, &format!("{own}_{along}"), value), on));
        }
    }
    Ok(forces)
}

fn force_error(value: &Value, place: Span, on: &Value, on_place: Span) -> Diagnostic {
    let message = format!("{} does no work on {}", value.kind(), on.kind());
    let help = match (value, on) {
        (Value::Scalar(_), Value::Vector(..)) => {
            "give a force at a point as a vector: [F_x, F_y, F_z]"
        }
        (Value::Vector(..), Value::Scalar(_)) => {
            "give the point at which the force acts, for example on = \"FRAME.origin\""
        }
        (Value::Scalar(_), Value::Rotation(..)) => {
            "give a torque on a frame as a vector: [M_x, M_y, M_z]"
        }
        _ => "give both the same number of components",
    };
    Diagnostic::error(message)
        .with_span(place, format!("this is {}", value.kind()))
        .with_related_span(on_place, format!("on {}", on.kind()))
        .with_help(help)
}
