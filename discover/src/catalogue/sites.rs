//! Sites of effects in a model with their placeholder values. This module finds axes, angles and
//! inputs; meshes, flexible bodies, springs and the whole machine are found in their own modules.

use std::collections::BTreeSet;

use eomgen_model_spec::ast::BinaryOperator;
use eomgen_model_spec::ids::CoordinateId;
use eomgen_model_spec::model::{Expr, ExprKind, Input, Model};

use crate::catalogue::arms::find_arms;
use crate::catalogue::effect::SiteKind;
use crate::catalogue::machine::find_machine;
use crate::catalogue::meshes::{find_mesh_coordinates, find_meshes};
use crate::catalogue::site::Site;
use crate::catalogue::springs::find_springs;
use crate::model::input_occurrences::list_replaceable;

/// Returns the sites of a model.
pub fn find_sites(model: &Model) -> Vec<Site> {
    let mut found = find_axes(model, &find_mesh_coordinates(model));
    found.extend(find_meshes(model));
    found.extend(find_arms(model));
    found.extend(find_springs(model));
    found.extend(list_replaceable(model).map(create_input_site));
    found.extend(find_machine(model));
    found
}

fn create_input_site(input: &Input) -> Site {
    let arguments = [("on", &input.name), ("unit", &input.unit.text)];
    Site {
        kind: SiteKind::Input,
        name: input.name.clone(),
        arguments: arguments.map(|(key, word)| (key, word.clone())).into(),
        terms: Vec::new(),
        dampers: Vec::new(),
    }
}

/// Coordinates and other quantities of an expression, with definitions expanded.
#[derive(Default)]
struct Parts {
    coordinates: Vec<CoordinateId>,
    /// Expanded definitions; vectors use one definition several times.
    definitions: BTreeSet<usize>,
    other: bool,
}

fn collect_parts(model: &Model, expr: &Expr, into: &mut Parts) {
    expr.visit(&mut |part| match part.kind {
        ExprKind::Coordinate(id) => into.coordinates.push(id),
        ExprKind::Definition(id) if into.definitions.insert(id.index()) => {
            collect_parts(model, &model.definitions[id].value, into);
        }
        ExprKind::Dot(_)
        | ExprKind::Field(_)
        | ExprKind::ModeCoordinate(_)
        | ExprKind::SingleMode { .. }
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

/// Returns the degree of an expression in the coordinates; `None` if it is not a polynomial.
fn compute_degree(model: &Model, expr: &Expr) -> Option<u32> {
    let of = |expr: &Expr| compute_degree(model, expr);
    match &expr.kind {
        ExprKind::Coordinate(_) => Some(1),
        ExprKind::Definition(id) => of(&model.definitions[*id].value),
        ExprKind::Negate(inner) => of(inner),
        ExprKind::Binary(BinaryOperator::Add | BinaryOperator::Subtract, left, right) => {
            Some(of(left)?.max(of(right)?))
        }
        ExprKind::Binary(BinaryOperator::Multiply, left, right) => {
            of(left)?.checked_add(of(right)?)
        }
        ExprKind::Binary(BinaryOperator::Divide, left, right) if of(right) == Some(0) => of(left),
        ExprKind::Binary(BinaryOperator::Power, base, exponent)
            if exponent.kind == ExprKind::Number(1.0) =>
        {
            of(base)
        }
        _ => {
            let mut parts = Parts::default();
            collect_parts(model, expr, &mut parts);
            (parts.coordinates.is_empty() && !parts.other).then_some(0)
        }
    }
}

fn find_axes(model: &Model, meshes: &[CoordinateId]) -> Vec<Site> {
    let mut found = Vec::new();
    let mut shown = Vec::new();
    for observable in &model.observables {
        let on = match observable.value.kind {
            ExprKind::Definition(id) => &model.definitions[id].name,
            ExprKind::Coordinate(id) => &model.coordinates[id].name,
            _ => continue,
        };
        let mut of = Parts::default();
        collect_parts(model, &observable.value, &mut of);
        of.coordinates.sort_unstable();
        of.coordinates.dedup();
        let only_meshes = of.coordinates.iter().all(|place| meshes.contains(place));
        if of.other || only_meshes {
            continue;
        }
        if let Some(site) = create_axis_site(&observable.name, on, &observable.unit.text) {
            // If the observable is linear in a single coordinate, a force on the coordinate has the
            // same form, so the coordinate is not a further site.
            if let [only] = of.coordinates[..]
                && compute_degree(model, &observable.value) == Some(1)
            {
                shown.push(only);
            }
            found.push(site);
        }
    }
    for (id, coordinate) in CoordinateId::first(model.coordinates.len()).zip(&model.coordinates) {
        if !meshes.contains(&id) && !shown.contains(&id) {
            found.extend(create_axis_site(
                &coordinate.name,
                &coordinate.name,
                &coordinate.unit.text,
            ));
        }
    }
    found
}

fn create_axis_site(name: &str, on: &str, unit: &str) -> Option<Site> {
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
