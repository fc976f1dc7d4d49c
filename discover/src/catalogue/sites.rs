//! Where effects may sit in a model: axes, angles, meshes with play, flexible bodies, springs and inputs,
//! with the arguments that fill the placeholders of an effect there.

use std::collections::{BTreeMap, BTreeSet};

use eomgen_model_spec::ast::BinaryOperator;
use eomgen_model_spec::dimension::Dimension;
use eomgen_model_spec::edit::Section;
use eomgen_model_spec::ids::{CoordinateId, FieldId};
use eomgen_model_spec::model::{Expr, ExprKind, Function, Input, Model, Term};

use crate::catalogue::effect::SiteKind;
use crate::catalogue::site::{Site, text};
use crate::catalogue::springs::{is_deflection, springs, units};
use crate::model::input_places::replaceable;

/// All places of a model.
pub fn sites(model: &Model) -> Vec<Site> {
    let deflections = deflections(model);
    let mut found = axes(model, &mesh_coordinates(&deflections));
    found.extend(deflections.iter().filter_map(|of| mesh(model, of)));
    found.extend(arms(model));
    found.extend(springs(model));
    found.extend(replaceable(model).map(input));
    found
}

fn input(input: &Input) -> Site {
    let arguments = [("on", &input.name), ("unit", &input.unit.text)];
    Site {
        kind: SiteKind::Input,
        name: input.name.clone(),
        arguments: arguments.map(|(key, word)| (key, word.clone())).into(),
        terms: Vec::new(),
        dampers: Vec::new(),
    }
}

/// What an expression is made of, definitions written out.
#[derive(Default)]
struct Parts {
    coordinates: Vec<CoordinateId>,
    /// Definitions that were written out: one of vectors is used again and again.
    definitions: BTreeSet<usize>,
    other: bool,
}

fn parts(model: &Model, expr: &Expr, into: &mut Parts) {
    expr.visit(&mut |part| match part.kind {
        ExprKind::Coordinate(id) => into.coordinates.push(id),
        ExprKind::Definition(id) if into.definitions.insert(id.index()) => {
            parts(model, &model.definitions[id].value, into);
        }
        ExprKind::Dot(_)
        | ExprKind::Field(_)
        | ExprKind::ModeCoordinate(_)
        | ExprKind::Time
        | ExprKind::Input(_)
        | ExprKind::State(_)
        | ExprKind::Multiplier(_)
        | ExprKind::Residual(_) => {
            into.other = true;
        }
        _ => {}
    });
}

fn axes(model: &Model, meshes: &[CoordinateId]) -> Vec<Site> {
    let mut found = Vec::new();
    let mut shown = Vec::new();
    for observable in &model.observables {
        let on = match observable.value.kind {
            ExprKind::Definition(id) => &model.definitions[id].name,
            ExprKind::Coordinate(id) => &model.coordinates[id].name,
            _ => continue,
        };
        let mut of = Parts::default();
        parts(model, &observable.value, &mut of);
        of.coordinates.sort_unstable();
        of.coordinates.dedup();
        let only_meshes = of.coordinates.iter().all(|place| meshes.contains(place));
        if of.other || only_meshes {
            continue;
        }
        if let Some(site) = axis(&observable.name, on, &observable.unit.text) {
            if let [only] = of.coordinates[..] {
                shown.push(only);
            }
            found.push(site);
        }
    }
    for (id, coordinate) in CoordinateId::first(model.coordinates.len()).zip(&model.coordinates) {
        if !meshes.contains(&id) && !shown.contains(&id) {
            found.extend(axis(
                &coordinate.name,
                &coordinate.name,
                &coordinate.unit.text,
            ));
        }
    }
    found
}

fn axis(name: &str, on: &str, unit: &str) -> Option<Site> {
    let (kind, force) = match unit {
        "rad" => (SiteKind::Angle, "N m"),
        "m" => (SiteKind::Axis, "N"),
        _ => return None,
    };
    let arguments = [("on", on), ("unit", unit), ("force", force)];
    Some(Site {
        kind,
        name: name.to_owned(),
        arguments: arguments.map(|(key, word)| (key, word.to_owned())).into(),
        terms: Vec::new(),
        dampers: Vec::new(),
    })
}

/// What deflects with play, each once: coordinates first, in their order.
fn deflections(model: &Model) -> Vec<Expr> {
    let mut found: Vec<Expr> = Vec::new();
    for (_, _, value) in values(model) {
        visit_play(value, &mut |function, deflection| {
            let is_known = found.iter().any(|known| is_same(model, known, deflection));
            if function == Function::Deadzone && !is_known && is_deflection(model, deflection) {
                found.push(deflection.clone());
            }
        });
    }
    found.sort_by_key(|deflection| match deflection.kind {
        ExprKind::Coordinate(id) => id.index(),
        _ => usize::MAX,
    });
    found
}

/// Calls `each` with every function with play in an expression, and what deflects in it.
fn visit_play(expr: &Expr, each: &mut impl FnMut(Function, &Expr)) {
    expr.visit(&mut |part| {
        if let ExprKind::Call(function @ (Function::Deadzone | Function::Contact), arguments) =
            &part.kind
        {
            each(*function, &arguments[0]);
        }
    });
}

/// Whether two deflections are written the same, however they are spaced.
fn is_same(model: &Model, one: &Expr, other: &Expr) -> bool {
    let plain = |expr: &Expr| text(model, expr).split_whitespace().collect::<String>();
    plain(one) == plain(other)
}

/// The coordinates that are deflections with play.
fn mesh_coordinates(deflections: &[Expr]) -> Vec<CoordinateId> {
    let coordinate = |deflection: &Expr| match deflection.kind {
        ExprKind::Coordinate(id) => Some(id),
        _ => None,
    };
    deflections.iter().filter_map(coordinate).collect()
}

/// Every value in which an expression may be replaced.
fn values(model: &Model) -> Vec<(Section, &str, &Expr)> {
    let definitions = model
        .definitions
        .iter()
        .map(|d| (Section::Definitions, d.name.as_str(), &d.value));
    let potential = model
        .potential
        .iter()
        .map(|t| (Section::Potential, t.name.as_str(), &t.value));
    let dissipation = model
        .dissipation
        .iter()
        .map(|t| (Section::Dissipation, t.name.as_str(), &t.value));
    let forces = model
        .forces
        .iter()
        .map(|f| (Section::Forces, f.name.as_str(), &f.value));
    definitions
        .chain(potential)
        .chain(dissipation)
        .chain(forces)
        .collect()
}

/// Whether an expression holds a function with play of what deflects.
fn has_play(model: &Model, expr: &Expr, deflection: &Expr) -> bool {
    let mut found = false;
    visit_play(expr, &mut |_, of| found |= is_same(model, of, deflection));
    found
}

/// The parameters that say how much play there is.
pub fn plays(model: &Model) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    for (_, _, value) in values(model) {
        value.visit(&mut |part| {
            if let ExprKind::Call(Function::Deadzone | Function::Contact, arguments) = &part.kind
                && let Some(ExprKind::Parameter(id)) = arguments.get(1).map(|arg| &arg.kind)
            {
                found.push(model.parameters[*id].name.clone());
            }
        });
    }
    found.sort();
    found.dedup();
    found
}

fn mesh(model: &Model, deflection: &Expr) -> Option<Site> {
    let mut terms: Vec<(Section, Vec<String>)> = Vec::new();
    let (mut stiffness, mut of) = (None, None);
    for (section, name, value) in values(model) {
        if !has_play(model, value, deflection) {
            continue;
        }
        if section == Section::Potential {
            value.visit(&mut |part| {
                if let ExprKind::Parameter(id) = part.kind
                    && stiffness.is_none()
                {
                    stiffness = Some(model.parameters[id].name.clone());
                }
            });
            of = of.or(Some(name));
        }
        match terms.iter_mut().find(|(known, _)| *known == section) {
            Some((_, names)) => names.push(name.to_owned()),
            None => terms.push((section, vec![name.to_owned()])),
        }
    }
    let (unit, _) = units(model, deflection)?;
    let p = text(model, deflection);
    let mut arguments: BTreeMap<&'static str, String> = [
        ("p", p.clone()),
        ("k", stiffness?),
        ("on", p),
        ("unit", unit.to_owned()),
    ]
    .into();
    arguments.extend(half_play(model, deflection).map(|play| ("b", play)));
    Some(Site {
        kind: SiteKind::Mesh,
        arguments,
        name: name_of_mesh(model, deflection).unwrap_or(of?).to_owned(),
        terms,
        dampers: Vec::new(),
    })
}

/// The name of what deflects: a coordinate's, also where a middle of the play is taken from it, or a
/// definition's; none if it is an expression.
fn name_of_mesh<'m>(model: &'m Model, deflection: &Expr) -> Option<&'m str> {
    match deflection.kind {
        ExprKind::Coordinate(id) => Some(&model.coordinates[id].name),
        ExprKind::Definition(id) => {
            let definition = &model.definitions[id];
            let moved = match &definition.value.kind {
                ExprKind::Binary(BinaryOperator::Add | BinaryOperator::Subtract, of, by)
                    if matches!(by.kind, ExprKind::Parameter(_)) =>
                {
                    name_of_mesh(model, of)
                }
                _ => None,
            };
            Some(moved.unwrap_or(&definition.name))
        }
        _ => None,
    }
}

/// The half-play of what deflects, as the specification writes it.
fn half_play(model: &Model, deflection: &Expr) -> Option<String> {
    let mut play = None;
    for (_, _, value) in values(model) {
        value.visit(&mut |part| {
            if let ExprKind::Call(Function::Deadzone, arguments) = &part.kind
                && is_same(model, &arguments[0], deflection)
            {
                play = arguments.get(1).map(|half| text(model, half));
            }
        });
    }
    play
}

fn arms(model: &Model) -> Vec<Site> {
    let arm = |term: &Term| {
        // What is spread along the body; a mass at its end is none.
        let velocity = squared(
            spread(&term.value)?,
            &|part| matches!(&part.kind, ExprKind::Dot(of) if matches!(of.kind, ExprKind::Field(_))),
        )?;
        let mut field = None;
        let mut root = None;
        velocity.visit(&mut |part| {
            if let ExprKind::Dot(of) = &part.kind {
                match of.kind {
                    ExprKind::Field(id) => field = Some(id),
                    ExprKind::Definition(_) | ExprKind::Coordinate(_) => {
                        root = Some(text(model, of))
                    }
                    _ => {}
                }
            }
        });
        let field = field?;
        let bent = |part: &Expr| matches!(&part.kind, ExprKind::Diff(of, 2) if of.kind == ExprKind::Field(field));
        let stiffness = model
            .potential
            .iter()
            .find_map(|term| factor_of_square(&term.value, &bent));
        let declared = &model.fields[field];
        // Masses, springs and bending at an end are of a deflection: a shaft that twists has none.
        if declared.unit.dimension != Dimension::LENGTH {
            return None;
        }
        let mut arguments: BTreeMap<&'static str, String> = [
            ("term", term.name.clone()),
            ("velocity", text(model, velocity)),
            ("field", declared.name.clone()),
            ("x", declared.along.clone()),
            ("end", text(model, &declared.to)),
            ("lever", lever(model, &declared.from, &declared.to)),
        ]
        .into();
        arguments.extend(root.map(|root| ("root", root)));
        arguments.extend(stiffness.map(|factor| ("stiffness", text(model, factor))));
        let moving = model
            .kinetic
            .iter()
            .filter(|term| holds_field(&term.value, field));
        let moving = moving.map(|term| term.name.clone()).collect();
        Some(Site {
            kind: SiteKind::Arm,
            name: term.name.clone(),
            arguments,
            terms: vec![(Section::Kinetic, moving)],
            dampers: Vec::new(),
        })
    };
    model.kinetic.iter().filter_map(arm).collect()
}

/// What an expression integrates.
fn spread(expr: &Expr) -> Option<&Expr> {
    match &expr.kind {
        ExprKind::Integral { integrand, .. } => Some(integrand),
        ExprKind::Binary(_, left, right) => spread(left).or_else(|| spread(right)),
        ExprKind::Negate(inner) => spread(inner),
        _ => None,
    }
}

/// Whether an expression holds a field.
fn holds_field(expr: &Expr, field: FieldId) -> bool {
    let mut found = false;
    expr.visit(&mut |part| found |= part.kind == ExprKind::Field(field));
    found
}

/// The distance of a body's end from its root.
fn lever(model: &Model, from: &Expr, to: &Expr) -> String {
    match from.kind {
        ExprKind::Number(0.0) => text(model, to),
        _ => format!("({} - ({}))", text(model, to), text(model, from)),
    }
}

/// The base of a square that holds something wanted.
fn squared<'m>(expr: &'m Expr, wanted: &dyn Fn(&Expr) -> bool) -> Option<&'m Expr> {
    let holds = |expr: &Expr| {
        let mut found = false;
        expr.visit(&mut |part| found |= wanted(part));
        found
    };
    match &expr.kind {
        ExprKind::Binary(BinaryOperator::Power, base, _) => holds(base).then_some(base),
        ExprKind::Binary(_, left, right) => {
            squared(left, wanted).or_else(|| squared(right, wanted))
        }
        ExprKind::Integral { integrand, .. } => squared(integrand, wanted),
        ExprKind::Negate(inner) => squared(inner, wanted),
        _ => None,
    }
}

/// What a square that holds something wanted is multiplied with, inside an integral.
fn factor_of_square<'m>(expr: &'m Expr, wanted: &dyn Fn(&Expr) -> bool) -> Option<&'m Expr> {
    match &expr.kind {
        ExprKind::Binary(BinaryOperator::Multiply, left, right) => match squared(right, wanted) {
            Some(_) if matches!(right.kind, ExprKind::Binary(BinaryOperator::Power, ..)) => {
                Some(left)
            }
            _ => factor_of_square(left, wanted).or_else(|| factor_of_square(right, wanted)),
        },
        ExprKind::Binary(_, left, right) => {
            factor_of_square(left, wanted).or_else(|| factor_of_square(right, wanted))
        }
        ExprKind::Integral { integrand, .. } => factor_of_square(integrand, wanted),
        _ => None,
    }
}
