//! Dampers parallel to a spring: summands `1/2*d*dot(p)^2` of the dissipation and `-d*dot(p)` of a
//! force on `p`. Their rate is proportional to the rate of the deflection, in any notation.

use eomgen_model_spec::ast::BinaryOperator;
use eomgen_model_spec::edit::Section;
use eomgen_model_spec::model::{Expr, ExprKind, Force, Model};

use crate::catalogue::polynomial::Polynomial;
use crate::catalogue::products::{find_square, is_constant, split_sum};
use crate::catalogue::site::{Damper, format_expression};

/// Returns the dampers of a model that depend only on the rate of a deflection.
pub(super) fn find_dampers(model: &Model, deflection: &Expr) -> Vec<Damper> {
    let rate = Polynomial::from_expression(model, deflection)
        .and_then(|deflection| deflection.differentiate());
    let Some(rate) = rate else {
        return Vec::new();
    };
    let is_along = |value: &Expr| {
        Polynomial::from_expression(model, value)
            .is_some_and(|value| value.is_proportional_to(&rate))
    };
    let mut found: Vec<Damper> = Vec::new();
    let mut note = |section: Section, term: &str, part: &Expr| {
        let damper = Damper {
            section,
            term: term.to_owned(),
            part: format_expression(model, part),
        };
        if !found.contains(&damper) {
            found.push(damper);
        }
    };
    for term in &model.dissipation {
        for part in split_sum(&term.value) {
            if find_square(model, part).is_some_and(|square| is_along(square.base)) {
                note(Section::Dissipation, &term.name, part);
            }
        }
    }
    for force in model.forces.iter().filter(|f| acts_along(model, f, &rate)) {
        for part in split_terms(&force.value) {
            if find_variable_factor(model, part).is_some_and(is_along) {
                note(Section::Forces, &force.name, part);
            }
        }
    }
    found
}

/// Returns true if a force acts on a deflection with the given rate. Components of vectors are
/// excluded, because the specification names them differently.
fn acts_along(model: &Model, force: &Force, rate: &Polynomial) -> bool {
    let named = model.source.text.get(force.span.start..force.span.end);
    let on = || Polynomial::from_expression(model, &force.on)?.differentiate();
    named == Some(&force.name) && on().is_some_and(|on| on.is_proportional_to(rate))
}

/// Returns the terms of a sum or difference.
fn split_terms(value: &Expr) -> Vec<&Expr> {
    match &value.kind {
        ExprKind::Binary(BinaryOperator::Add | BinaryOperator::Subtract, left, right) => {
            [split_terms(left), split_terms(right)].concat()
        }
        _ => vec![value],
    }
}

/// Returns the only variable factor of a product.
fn find_variable_factor<'m>(model: &Model, product: &'m Expr) -> Option<&'m Expr> {
    let is_fixed = |expr: &Expr| is_constant(model, expr, &mut Vec::new());
    match &product.kind {
        ExprKind::Negate(inner) => find_variable_factor(model, inner),
        ExprKind::Binary(BinaryOperator::Multiply, left, right) => {
            match (is_fixed(left), is_fixed(right)) {
                (true, false) => find_variable_factor(model, right),
                (false, true) => find_variable_factor(model, left),
                _ => None,
            }
        }
        ExprKind::Binary(BinaryOperator::Divide, above, below) if is_fixed(below) => {
            find_variable_factor(model, above)
        }
        _ => Some(product),
    }
}
