//! Expands a specification entry by entry: definitions and frames in dependency order, then
//! everything that uses them.

use std::collections::HashSet;

use super::definitions::{Definitions, Owner};
use super::expression::Reader;
use super::frames::Frames;
use super::placement::Placements;
use super::references::{Entry, Expressions, FrameExpressions, sort_entries};
use super::requirements::{Requirements, UnitRequirement};
use super::rotation::{Turn, turns};
use super::scalar::{expansion, is_literal, is_plain, name, number};
use super::state::{ExpansionState, is_spatial};
use super::tree::tree;
use super::value::{Dimensions, Value};
use super::vector::{self, AXES, Vector};
use super::{bodies, terms};
use crate::ast::{Syntax, SyntaxKind};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::dimension::Dimension;
use crate::quantity::{Name, Quantity};
use crate::raw::{Document, RawFrame, RawTerm};

pub fn has_vectors(document: &Document) -> bool {
    let has_frames = !document.frames.is_empty() || !document.bodies.is_empty();
    // Syntax errors are ignored here: `resolve` reports them.
    let mut read = quantities(document).filter_map(|quantity| quantity.syntax().ok());
    has_frames || document.gravity.is_some() || read.any(|syntax| is_spatial(&syntax))
}

/// Returns the expressions that may contain vectors.
fn quantities(document: &Document) -> impl Iterator<Item = &Quantity> {
    let terms = document.definitions.iter().chain(&document.kinetic);
    let terms = terms
        .chain(&document.potential)
        .chain(&document.dissipation);
    let terms = terms.chain(&document.constraints);
    let terms = terms.chain(document.impacts.iter().map(|impact| &impact.distance));
    let terms = terms.chain(document.observables.iter().map(|(term, _)| term));
    let forces = document.forces.iter();
    let forces = forces.flat_map(|(term, on)| [&term.value, on]);
    let rates = document.states.iter().map(|state| &state.rate);
    let impacts = document.impacts.iter();
    let slips = impacts.filter_map(|impact| Some(&impact.friction.as_ref()?.slip));
    let values = terms.map(|term| &term.value);
    values.chain(forces).chain(rates).chain(slips)
}

/// Replaces all vectors, frames and bodies; `None` if definitions cannot be sorted.
pub fn expand(document: &mut Document, found: &mut Diagnostics) -> Option<Requirements> {
    let expressions = Expressions::read(document, found)?;
    let order = sort_entries(document, &expressions, found)?;
    let mentioned = referenced_names(document);
    let mut space = ExpansionState {
        vectors: Default::default(),
        frames: Frames::with_gravity(None, document.name.span),
        frame_names: document
            .frames
            .iter()
            .map(|f| f.name.text.clone())
            .collect(),
        placements: Placements::default(),
        definitions: Definitions::from_document(document),
        requirements: Requirements::default(),
        constraint_outputs: HashSet::new(),
        invalid_entries: HashSet::new(),
    };
    if let Some(gravity) = document.gravity.take() {
        let owner = Owner::new(&document.name, "");
        let span = document.name.span;
        let written = Quantity::Vector(gravity, span);
        let dimension = Dimension::from_mechanical_exponents([0, 1, -2, 0]);
        let along =
            Reader::new(&mut space, &owner).evaluate_with_unit(&written, "gravity", dimension);
        space.frames = Frames::with_gravity(Some(found.push_error(along)?), span);
    }
    let mut replaced: Vec<Vec<RawTerm>> = Vec::new();
    replaced.resize_with(document.definitions.len(), Vec::new);
    let mut raw: Vec<Option<RawTerm>> = document.definitions.drain(..).map(Some).collect();
    for entry in order {
        if found.is_full() {
            return None;
        }
        match entry {
            Entry::Definition(index) => {
                if let Some(term) = raw[index].take() {
                    let syntax = &expressions.definitions[index];
                    replaced[index] = expand_definition(&mut space, document, term, syntax, found);
                }
            }
            Entry::Frame(index) => {
                let own = &expressions.frames[index];
                expand_frame(&mut space, &document.frames[index], own, found);
            }
        }
    }
    document.definitions = replaced.into_iter().flatten().collect();
    terms::expand(document, &mut space, found);
    if found.is_empty() {
        let bodies = bodies::expand(document, &mut space, found);
        space.requirements.rigid_tree = tree(&space.frames, bodies);
    }
    document.frames.clear();
    document.definitions.extend(space.definitions.take());
    let is_unused = |vector: &&Name| {
        let component = |axis: &&str| mentioned.contains(&format!("{}_{axis}", vector.text));
        !mentioned.contains(&vector.text) && !AXES.iter().any(component)
    };
    space.requirements.unused = document.vectors.iter().filter(is_unused).cloned().collect();
    Some(space.requirements)
}

fn referenced_names(document: &Document) -> HashSet<String> {
    let mut names = HashSet::new();
    let frames = document.frames.iter();
    let frames = frames.filter_map(|frame| frame.origin.as_ref());
    let angles = document.frames.iter().filter_map(|f| f.rotation.as_ref());
    let centres = document.bodies.iter().filter_map(|b| b.centre.as_ref());
    let quantities = quantities(document).chain(frames).chain(centres);
    let read = quantities.filter_map(|quantity| quantity.syntax().ok());
    for syntax in read.chain(angles.filter_map(|angle| angle.syntax().ok())) {
        syntax.visit(&mut |part| {
            if let SyntaxKind::Name(name) = &part.kind {
                names.insert(name.clone());
            }
        });
    }
    names
}

/// Returns the scalar definitions that replace a definition.
fn expand_definition(
    space: &mut ExpansionState,
    document: &mut Document,
    term: RawTerm,
    syntax: &Syntax,
    found: &mut Diagnostics,
) -> Vec<RawTerm> {
    let name = &term.name.text;
    if space.is_broken(syntax) {
        space.invalid_entries.insert(name.clone());
        return vec![];
    }
    if !space.contains_vectors(syntax) {
        space.definitions.moving.add_definition(name, syntax);
        return vec![term];
    }
    let owner = Owner::new(&term.name, &term.doc);
    let read = Reader::new(space, &owner).value(syntax);
    let Some(value) = found.push_error(read) else {
        space.invalid_entries.insert(name.clone());
        return vec![];
    };
    let (vector, dimensions) = match value {
        Value::Scalar(scalar) => {
            space.definitions.moving.add_definition(name, &scalar);
            let value = expansion(scalar);
            return vec![RawTerm { value, ..term }];
        }
        Value::Vector(vector, dimensions) => (vector, dimensions),
        Value::Rotation(factors, dimensions) => {
            document.vectors.push(term.name.clone());
            let mut reader = Reader::new(space, &owner);
            match found.push_error(reader.shared_rotation(factors, syntax.span)) {
                Some(shared) => {
                    let rotation = Value::Rotation(shared, dimensions);
                    space.vectors.insert(name.clone(), rotation);
                }
                None => {
                    space.invalid_entries.insert(name.clone());
                }
            }
            return vec![];
        }
    };
    if let Some(frame) = document.frames.iter().find(|f| f.name.text == *name) {
        found.push(
            Diagnostic::error(format!("the name `{name}` is taken"))
                .with_span(term.name.span, "used by a frame, and both have members")
                .with_related_span(frame.name.span, "here")
                .with_help("choose another name"),
        );
    }
    document.vectors.push(term.name.clone());
    let (written, vector) = define_components(space, &term, vector, dimensions);
    space
        .vectors
        .insert(name.clone(), Value::Vector(vector, dimensions));
    written
}

/// Returns the definitions of a vector's components, and the vector of their names.
fn define_components(
    space: &mut ExpansionState,
    term: &RawTerm,
    vector: Vector,
    dimensions: Dimensions,
) -> (Vec<RawTerm>, Vector) {
    let mut written = Vec::with_capacity(3);
    let mut axes = AXES.into_iter();
    let vector = vector.map(|component| {
        let axis = axes.next().unwrap_or_default();
        if written.len() == dimensions.count() {
            return component;
        }
        let text = format!("{}_{axis}", term.name.text);
        space.definitions.moving.add_definition(&text, &component);
        let by_name = match is_plain(&component) {
            true => component.clone(),
            false => name(&text, component.span),
        };
        written.push(RawTerm {
            name: Name {
                text,
                span: term.name.span,
            },
            value: expansion(component),
            doc: term.doc.clone(),
            origin: term.origin.clone(),
        });
        by_name
    });
    for (axis, term) in written.iter_mut().enumerate() {
        if is_literal(&vector[axis], 0.0) {
            term.value = expansion(vector::component(&vector, axis));
        }
    }
    (written, vector)
}

fn expand_frame(
    space: &mut ExpansionState,
    raw: &RawFrame,
    expressions: &FrameExpressions,
    found: &mut Diagnostics,
) {
    let name = &raw.name.text;
    let broken = |space: &ExpansionState, syntax: &Option<Syntax>| {
        syntax
            .as_ref()
            .is_some_and(|syntax| space.is_broken(syntax))
    };
    let parent = raw.parent.as_ref().map(|parent| parent.text.as_str());
    if parent.is_some_and(|parent| space.frames.name_motion(parent).is_none())
        || broken(space, &expressions.origin)
        || broken(space, &expressions.rotation)
    {
        space.invalid_entries.insert(name.clone());
        return;
    }
    let owner = Owner::new(&raw.name, &raw.doc);
    let placed = expand_placement(space, &owner, raw, expressions);
    let placed = placed.and_then(|placed| {
        let ExpansionState {
            frames,
            definitions,
            ..
        } = space;
        frames.place(owner, parent, placed, definitions)
    });
    if found.push_error(placed).is_none() {
        space.invalid_entries.insert(name.clone());
    }
}

fn expand_placement(
    space: &mut ExpansionState,
    owner: &Owner,
    raw: &RawFrame,
    expressions: &FrameExpressions,
) -> Result<(Vector, Vec<Turn>), Diagnostic> {
    let name = &raw.name;
    let origin = match &raw.origin {
        Some(origin) => {
            let subject = format!("the origin of `{}`", name.text);
            Reader::new(space, owner).evaluate_with_unit(origin, &subject, Dimension::LENGTH)?
        }
        None => [0, 1, 2].map(|_| number(0.0, name.span)),
    };
    let mut list = match &expressions.rotation {
        Some(rotation) => turns(rotation)?,
        None => Vec::new(),
    };
    for turn in &mut list {
        let written = expansion(turn.angle.clone());
        let mut reader = Reader::new(space, owner);
        let subject = format!("an angle of `{}`", name.text);
        turn.angle = reader.scalar(&written, &subject, "give a scalar")?;
        space.requirements.units.push(UnitRequirement {
            value: expansion(turn.angle.clone()),
            dimension: Dimension::DIMENSIONLESS,
            subject,
        });
    }
    Ok((origin, list))
}
