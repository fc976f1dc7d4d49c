//! Meshes and couplings with play: functions with play whose argument is a coordinate, a definition
//! or an expression of both.

use std::collections::BTreeMap;

use eomgen_model_spec::ast::BinaryOperator;
use eomgen_model_spec::edit::Section;
use eomgen_model_spec::ids::CoordinateId;
use eomgen_model_spec::model::{Expr, ExprKind, Function, Model};

use crate::catalogue::effect::SiteKind;
use crate::catalogue::site::{Site, format_expression};
use crate::catalogue::springs::{find_deflection_units, is_deflection};

/// Returns the meshes of a model.
pub(super) fn find_meshes(model: &Model) -> Vec<Site> {
    let deflections = list_deflections(model);
    let found = deflections
        .iter()
        .filter_map(|of| create_mesh_site(model, of));
    found.collect()
}

/// Returns the distinct deflections with play. Coordinates are first, in the order of the
/// specification.
fn list_deflections(model: &Model) -> Vec<Expr> {
    let mut found: Vec<Expr> = Vec::new();
    for (_, _, value) in list_expressions(model) {
        visit_play(value, &mut |function, arguments| {
            let deflection = &arguments[0];
            let is_known = found
                .iter()
                .any(|known| is_same_expression(model, known, deflection));
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

/// Calls `each` with every function with play in an expression and its arguments. The first
/// argument is the deflection.
fn visit_play(expr: &Expr, each: &mut impl FnMut(Function, &[Expr])) {
    expr.visit(&mut |part| {
        if let ExprKind::Call(function @ (Function::Deadzone | Function::Contact), arguments) =
            &part.kind
        {
            each(*function, arguments);
        }
    });
}

/// Returns true if two deflections have the same text apart from spaces.
fn is_same_expression(model: &Model, one: &Expr, other: &Expr) -> bool {
    let plain = |expr: &Expr| {
        format_expression(model, expr)
            .split_whitespace()
            .collect::<String>()
    };
    plain(one) == plain(other)
}

/// Returns the coordinates that are deflections with play.
pub(super) fn find_mesh_coordinates(model: &Model) -> Vec<CoordinateId> {
    let coordinate = |deflection: &Expr| match deflection.kind {
        ExprKind::Coordinate(id) => Some(id),
        _ => None,
    };
    list_deflections(model)
        .iter()
        .filter_map(coordinate)
        .collect()
}

/// Returns all expressions of the model in which text may be replaced.
fn list_expressions(model: &Model) -> Vec<(Section, &str, &Expr)> {
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

/// Returns true if an expression contains a function with play of this deflection.
fn has_play(model: &Model, expr: &Expr, deflection: &Expr) -> bool {
    let mut found = false;
    visit_play(expr, &mut |_, arguments| {
        found |= is_same_expression(model, &arguments[0], deflection);
    });
    found
}

/// Returns the parameters that define the size of a play.
pub fn find_play_parameters(model: &Model) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    for (_, _, value) in list_expressions(model) {
        visit_play(value, &mut |_, arguments| {
            if let Some(ExprKind::Parameter(id)) = arguments.get(1).map(|arg| &arg.kind) {
                found.push(model.parameters[*id].name.clone());
            }
        });
    }
    found.sort();
    found.dedup();
    found
}

fn create_mesh_site(model: &Model, deflection: &Expr) -> Option<Site> {
    let mut terms: Vec<(Section, Vec<String>)> = Vec::new();
    let (mut stiffness, mut of) = (None, None);
    for (section, name, value) in list_expressions(model) {
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
    let (unit, _) = find_deflection_units(model, deflection)?;
    let p = format_expression(model, deflection);
    let mut arguments: BTreeMap<&'static str, String> = [
        ("p", p.clone()),
        ("k", stiffness?),
        ("on", p),
        ("unit", unit.to_owned()),
    ]
    .into();
    arguments.extend(format_half_play(model, deflection).map(|play| ("b", play)));
    Some(Site {
        kind: SiteKind::Mesh,
        arguments,
        name: name_of_mesh(model, deflection).unwrap_or(of?).to_owned(),
        terms,
        dampers: Vec::new(),
    })
}

/// Returns the name of a deflection: the name of a coordinate, with or without a subtracted centre
/// of the play, or of a definition. `None` for other expressions.
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

/// Returns half the play of a deflection as written in the specification.
fn format_half_play(model: &Model, deflection: &Expr) -> Option<String> {
    let mut play = None;
    for (_, _, value) in list_expressions(model) {
        visit_play(value, &mut |function, arguments| {
            if function == Function::Deadzone
                && is_same_expression(model, &arguments[0], deflection)
            {
                play = arguments.get(1).map(|half| format_expression(model, half));
            }
        });
    }
    play
}
