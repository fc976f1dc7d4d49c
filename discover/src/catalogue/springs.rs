//! Springs of a model: parts `1/2*k*p^2` of terms of the potential energy, with what deflects as
//! the specification writes it: a coordinate, a definition, or any expression of these.

use eomgen_model_spec::ast::BinaryOperator;
use eomgen_model_spec::dimension::Dimension;
use eomgen_model_spec::edit::Section;
use eomgen_model_spec::model::{Expr, ExprKind, Model, Term};

use crate::catalogue::effect::SiteKind;
use crate::catalogue::site::{Site, text};

/// All springs of a model.
pub(super) fn springs(model: &Model) -> Vec<Site> {
    model
        .potential
        .iter()
        .flat_map(|term| of_term(model, term))
        .collect()
}

/// A stiffness, of parameters and numbers, times the square of something that moves.
struct Spring<'m> {
    deflection: &'m Expr,
    parameters: Vec<String>,
}

/// The springs of a term: one has the term's name, of several each that of its stiffness behind it.
fn of_term(model: &Model, term: &Term) -> Vec<Site> {
    let mut summands = Vec::new();
    summands_of(&term.value, &mut summands);
    let springs: Vec<Spring<'_>> = summands
        .into_iter()
        .filter_map(|summand| spring(model, summand))
        .collect();
    let is_only = springs.len() == 1;
    let site = |(number, spring): (usize, &Spring<'_>)| {
        let deflection = text(model, spring.deflection);
        let dimension = dimension(model, spring.deflection)?;
        let (unit, force) = match (dimension == Dimension::NONE, dimension == Dimension::LENGTH) {
            (true, _) => ("rad", "N m"),
            (_, true) => ("m", "N"),
            _ => return None,
        };
        let mut arguments: Vec<(&'static str, String)> = vec![
            ("on", deflection.clone()),
            ("p", deflection),
            ("unit", unit.to_owned()),
            ("force", force.to_owned()),
        ];
        let name = match (&spring.parameters[..], is_only) {
            (_, true) => term.name.clone(),
            ([stiffness], false) => format!("{}_{stiffness}", term.name),
            (_, false) => format!("{}_{}", term.name, number + 1),
        };
        if let [stiffness] = &spring.parameters[..] {
            arguments.push(("k", stiffness.clone()));
        }
        Some(Site {
            kind: SiteKind::Spring,
            name,
            arguments: arguments.into_iter().collect(),
            terms: vec![(Section::Potential, vec![term.name.clone()])],
        })
    };
    springs.iter().enumerate().filter_map(site).collect()
}

/// What a sum adds up; what it takes away is no spring.
fn summands_of<'m>(expr: &'m Expr, found: &mut Vec<&'m Expr>) {
    match &expr.kind {
        ExprKind::Binary(BinaryOperator::Add, left, right) => {
            summands_of(left, found);
            summands_of(right, found);
        }
        ExprKind::Binary(BinaryOperator::Subtract, left, _) => summands_of(left, found),
        _ => found.push(expr),
    }
}

/// A product as a spring; none if it is none.
fn spring<'m>(model: &Model, product: &'m Expr) -> Option<Spring<'m>> {
    let (mut deflection, mut parameters) = (None, Vec::new());
    factors(model, product, &mut deflection, &mut parameters)?;
    let deflection = deflection.filter(|_| !parameters.is_empty())?;
    let spring = Spring {
        deflection,
        parameters,
    };
    is_position(model, spring.deflection).then_some(spring)
}

/// Goes through the factors of a product: one square of what moves, and parameters and numbers
/// beside it; none if anything else is there.
fn factors<'m>(
    model: &Model,
    expr: &'m Expr,
    deflection: &mut Option<&'m Expr>,
    parameters: &mut Vec<String>,
) -> Option<()> {
    match &expr.kind {
        ExprKind::Binary(BinaryOperator::Multiply, left, right) => {
            factors(model, left, deflection, parameters)?;
            factors(model, right, deflection, parameters)
        }
        ExprKind::Binary(BinaryOperator::Divide, above, below) => {
            factors(model, above, deflection, parameters)?;
            is_fixed(model, below, parameters).then_some(())
        }
        ExprKind::Binary(BinaryOperator::Power, base, exponent)
            if exponent.kind == ExprKind::Number(2.0)
                && deflection.is_none()
                && !is_fixed(model, base, &mut Vec::new()) =>
        {
            *deflection = Some(base);
            Some(())
        }
        _ => is_fixed(model, expr, parameters).then_some(()),
    }
}

/// Whether an expression is made of parameters and numbers alone; notes the parameters.
fn is_fixed(model: &Model, expr: &Expr, parameters: &mut Vec<String>) -> bool {
    match &expr.kind {
        ExprKind::Number(_) | ExprKind::Pi => true,
        ExprKind::Parameter(id) => {
            parameters.push(model.parameters[*id].name.clone());
            true
        }
        ExprKind::Negate(inner) => is_fixed(model, inner, parameters),
        ExprKind::Binary(_, left, right) => {
            is_fixed(model, left, parameters) && is_fixed(model, right, parameters)
        }
        _ => false,
    }
}

/// Whether an expression is a position: sums of coordinates, times what is fixed.
fn is_position(model: &Model, expr: &Expr) -> bool {
    match &expr.kind {
        ExprKind::Coordinate(_) | ExprKind::Parameter(_) | ExprKind::Number(_) | ExprKind::Pi => {
            true
        }
        ExprKind::Definition(id) => is_position(model, &model.definitions[*id].value),
        ExprKind::Negate(inner) => is_position(model, inner),
        ExprKind::Binary(BinaryOperator::Power, ..) => is_fixed(model, expr, &mut Vec::new()),
        ExprKind::Binary(_, left, right) => is_position(model, left) && is_position(model, right),
        _ => false,
    }
}

/// The dimension of a position.
fn dimension(model: &Model, expr: &Expr) -> Option<Dimension> {
    let of = |expr: &Expr| dimension(model, expr);
    match &expr.kind {
        ExprKind::Coordinate(id) => Some(model.coordinates[*id].unit.dimension),
        ExprKind::Parameter(id) => Some(model.parameters[*id].unit.dimension),
        ExprKind::Number(_) | ExprKind::Pi => Some(Dimension::NONE),
        ExprKind::Definition(id) => of(&model.definitions[*id].value),
        ExprKind::Negate(inner) => of(inner),
        ExprKind::Binary(BinaryOperator::Add | BinaryOperator::Subtract, left, _) => of(left),
        ExprKind::Binary(BinaryOperator::Multiply, left, right) => of(left)?.times(of(right)?),
        ExprKind::Binary(BinaryOperator::Divide, left, right) => of(left)?.over(of(right)?),
        _ => None,
    }
}
