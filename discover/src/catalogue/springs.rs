//! Springs of a model: summands `1/2*k*p^2` of the potential energy, where the deflection `p` is a
//! coordinate, a definition or an expression of both.

use std::collections::BTreeSet;

use eomgen_model_spec::ast::BinaryOperator;
use eomgen_model_spec::dimension::Dimension;
use eomgen_model_spec::edit::Section;
use eomgen_model_spec::ids::DefinitionId;
use eomgen_model_spec::model::{Expr, ExprKind, Model, Term};

use crate::catalogue::dampers::find_dampers;
use crate::catalogue::effect::SiteKind;
use crate::catalogue::products::{Square, find_square, is_constant, split_sum};
use crate::catalogue::site::{Site, format_expression};

/// Returns the springs of a model.
pub(super) fn find_springs(model: &Model) -> Vec<Site> {
    model
        .potential
        .iter()
        .flat_map(|term| find_springs_in_term(model, term))
        .collect()
}

/// Product of a constant stiffness and the square of a deflection.
struct Spring<'m> {
    deflection: &'m Expr,
    parameters: Vec<String>,
}

/// Returns the springs of a term. A single spring has the name of the term; of several springs,
/// each has the name of its stiffness appended.
fn find_springs_in_term(model: &Model, term: &Term) -> Vec<Site> {
    let springs: Vec<Spring<'_>> = split_sum(&term.value)
        .into_iter()
        .filter_map(|summand| read_spring(model, summand))
        .collect();
    let is_only = springs.len() == 1;
    let site = |(number, spring): (usize, &Spring<'_>)| {
        let deflection = format_expression(model, spring.deflection);
        let (unit, force) = find_deflection_units(model, spring.deflection)?;
        let mut arguments: Vec<(&'static str, String)> = vec![
            ("on", deflection.clone()),
            ("p", deflection),
            ("unit", unit.to_owned()),
            ("force", force.to_owned()),
        ];
        if let [stiffness] = &spring.parameters[..] {
            arguments.push(("k", stiffness.clone()));
        }
        Some(Site {
            kind: SiteKind::Spring,
            name: name_spring(term, &spring.parameters, number, is_only),
            arguments: arguments.into_iter().collect(),
            terms: vec![(Section::Potential, vec![term.name.clone()])],
            dampers: find_dampers(model, spring.deflection),
        })
    };
    springs.iter().enumerate().filter_map(site).collect()
}

/// Returns the name of a spring: the name of its term; if the term has several springs, followed by
/// the name of the stiffness.
pub(super) fn name_spring(
    term: &Term,
    parameters: &[String],
    number: usize,
    is_only: bool,
) -> String {
    match (parameters, is_only) {
        (_, true) => term.name.clone(),
        ([stiffness], false) => format!("{}_{stiffness}", term.name),
        (_, false) => format!("{}_{}", term.name, number + 1),
    }
}

/// Returns the units of a deflection and of its force; `None` if the deflection is neither an angle
/// nor a length.
pub(super) fn find_deflection_units(
    model: &Model,
    deflection: &Expr,
) -> Option<(&'static str, &'static str)> {
    let dimension = dimension(model, deflection)?;
    match (
        dimension == Dimension::DIMENSIONLESS,
        dimension == Dimension::LENGTH,
    ) {
        (true, _) => Some(("rad", "N m")),
        (_, true) => Some(("m", "N")),
        _ => None,
    }
}

/// Returns the spring of a product, if the product has the form of a spring energy.
fn read_spring<'m>(model: &Model, product: &'m Expr) -> Option<Spring<'m>> {
    let Square {
        base, parameters, ..
    } = find_square(model, product)?;
    let spring = Spring {
        deflection: base,
        parameters,
    };
    (!spring.parameters.is_empty() && is_deflection(model, base)).then_some(spring)
}

/// Returns true if an expression is a position: a sum of coordinates and prescribed motions with
/// constant factors.
pub(super) fn is_deflection(model: &Model, expr: &Expr) -> bool {
    is_position(model, expr, &mut BTreeSet::new())
}

/// Returns true if an expression is a position. `read`: definitions that were read before; each is
/// read only once.
fn is_position(model: &Model, expr: &Expr, read: &mut BTreeSet<DefinitionId>) -> bool {
    match &expr.kind {
        ExprKind::Coordinate(_) | ExprKind::Parameter(_) | ExprKind::Number(_) | ExprKind::Pi => {
            true
        }
        ExprKind::Input(id) => model.inputs[*id].is_prescribed(),
        ExprKind::Definition(id) => {
            !read.insert(*id) || is_position(model, &model.definitions[*id].value, read)
        }
        ExprKind::Negate(inner) => is_position(model, inner, read),
        ExprKind::Binary(BinaryOperator::Power, ..) => is_constant(model, expr, &mut Vec::new()),
        ExprKind::Binary(_, left, right) => {
            is_position(model, left, read) && is_position(model, right, read)
        }
        _ => false,
    }
}

/// Returns the dimension of a position, or of a velocity times a time.
pub(super) fn dimension(model: &Model, expr: &Expr) -> Option<Dimension> {
    let of = |expr: &Expr| dimension(model, expr);
    match &expr.kind {
        ExprKind::Coordinate(id) => Some(model.coordinates[*id].unit.dimension),
        ExprKind::Parameter(id) => Some(model.parameters[*id].unit.dimension),
        ExprKind::Input(id) => Some(model.inputs[*id].unit.dimension),
        ExprKind::Number(_) | ExprKind::Pi => Some(Dimension::DIMENSIONLESS),
        ExprKind::Definition(id) => Some(model.definitions[*id].unit.dimension),
        ExprKind::Position(_) => Some(Dimension::LENGTH),
        ExprKind::Field(id) | ExprKind::ModeCoordinate(id) => {
            Some(model.fields[*id].unit.dimension)
        }
        ExprKind::ModeShape(_) => Some(Dimension::DIMENSIONLESS),
        ExprKind::Negate(inner)
        | ExprKind::Dot(inner)
        | ExprKind::At { value: inner, .. }
        | ExprKind::Sum { summand: inner, .. } => of(inner),
        ExprKind::Diff(inner, times) => {
            (0..*times).try_fold(of(inner)?, |unit, _| unit.divide(Dimension::LENGTH))
        }
        ExprKind::Binary(BinaryOperator::Add | BinaryOperator::Subtract, left, _) => of(left),
        ExprKind::Binary(BinaryOperator::Multiply, left, right) => of(left)?.multiply(of(right)?),
        ExprKind::Binary(BinaryOperator::Divide, left, right) => of(left)?.divide(of(right)?),
        _ => None,
    }
}
