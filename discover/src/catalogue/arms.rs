//! Flexible bodies of a model: fields with distributed mass whose deflection is a length.

use std::collections::BTreeMap;

use eomgen_model_spec::ast::BinaryOperator;
use eomgen_model_spec::dimension::Dimension;
use eomgen_model_spec::edit::Section;
use eomgen_model_spec::ids::FieldId;
use eomgen_model_spec::model::{Expr, ExprKind, Model, Term};

use crate::catalogue::effect::SiteKind;
use crate::catalogue::site::{Site, format_expression};
use crate::catalogue::stiffness::find_stiffness;

/// Returns the flexible bodies of a model.
pub(super) fn find_arms(model: &Model) -> Vec<Site> {
    let arm = |term: &Term| {
        // Only distributed mass identifies the body; a mass at its end is a separate term.
        let velocity = find_square(
            find_integrand(&term.value)?,
            &|part| matches!(&part.kind, ExprKind::Dot(of) if matches!(of.kind, ExprKind::Field(_))),
        )?;
        let mut field = None;
        let mut root = None;
        velocity.visit(&mut |part| {
            if let ExprKind::Dot(of) = &part.kind {
                match of.kind {
                    ExprKind::Field(id) => field = Some(id),
                    ExprKind::Definition(_) | ExprKind::Coordinate(_) => {
                        root = Some(format_expression(model, of))
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
            .find_map(|term| find_stiffness(model, &term.value, &bent));
        let declared = &model.fields[field];
        // Effects at the end of a body act on a deflection; the twist of a shaft is an angle.
        if declared.unit.dimension != Dimension::LENGTH {
            return None;
        }
        let mut arguments: BTreeMap<&'static str, String> = [
            ("term", term.name.clone()),
            ("velocity", format_expression(model, velocity)),
            ("field", declared.name.clone()),
            ("x", declared.along.clone()),
            ("end", format_expression(model, &declared.to)),
            ("lever", format_lever(model, &declared.from, &declared.to)),
        ]
        .into();
        arguments.extend(root.map(|root| ("root", root)));
        arguments.extend(stiffness.map(|stiffness| ("stiffness", stiffness)));
        let moving = model
            .kinetic
            .iter()
            .filter(|term| contains_field(&term.value, field));
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

/// Returns the integrand of an expression.
fn find_integrand(expr: &Expr) -> Option<&Expr> {
    match &expr.kind {
        ExprKind::Integral { integrand, .. } => Some(integrand),
        ExprKind::Binary(_, left, right) => find_integrand(left).or_else(|| find_integrand(right)),
        ExprKind::Negate(inner) => find_integrand(inner),
        _ => None,
    }
}

/// Returns true if an expression contains a field.
fn contains_field(expr: &Expr, field: FieldId) -> bool {
    let mut found = false;
    expr.visit(&mut |part| found |= part.kind == ExprKind::Field(field));
    found
}

/// Returns the distance between the root and the end of a body.
fn format_lever(model: &Model, from: &Expr, to: &Expr) -> String {
    match from.kind {
        ExprKind::Number(0.0) => format_expression(model, to),
        _ => format!(
            "({} - ({}))",
            format_expression(model, to),
            format_expression(model, from)
        ),
    }
}

/// Returns the base of the first square that contains a part with `wanted`.
fn find_square<'m>(expr: &'m Expr, wanted: &dyn Fn(&Expr) -> bool) -> Option<&'m Expr> {
    let holds = |expr: &Expr| {
        let mut found = false;
        expr.visit(&mut |part| found |= wanted(part));
        found
    };
    match &expr.kind {
        ExprKind::Binary(BinaryOperator::Power, base, _) => holds(base).then_some(base),
        ExprKind::Binary(_, left, right) => {
            find_square(left, wanted).or_else(|| find_square(right, wanted))
        }
        ExprKind::Integral { integrand, .. } => find_square(integrand, wanted),
        ExprKind::Negate(inner) => find_square(inner, wanted),
        _ => None,
    }
}
