//! Decomposition of terms of an energy or of the dissipation: sums into summands, and summands into
//! a square and its constant factors.

use eomgen_model_spec::ast::BinaryOperator;
use eomgen_model_spec::model::{Expr, ExprKind, Model};

/// Returns the summands of a sum; subtracted terms are left out.
pub(super) fn split_sum(expr: &Expr) -> Vec<&Expr> {
    let mut found = Vec::new();
    collect_summands(expr, &mut found);
    found
}

fn collect_summands<'m>(expr: &'m Expr, found: &mut Vec<&'m Expr>) {
    match &expr.kind {
        ExprKind::Binary(BinaryOperator::Add, left, right) => {
            collect_summands(left, found);
            collect_summands(right, found);
        }
        ExprKind::Binary(BinaryOperator::Subtract, left, _) => collect_summands(left, found),
        _ => found.push(expr),
    }
}

/// Decomposition of a product into one square and constant factors.
pub(super) struct Square<'m> {
    /// Square.
    pub(super) square: &'m Expr,
    /// Base of the square.
    pub(super) base: &'m Expr,
    /// Parameters among the constant factors.
    pub(super) parameters: Vec<String>,
}

/// Returns the only square in a product; `None` if the product contains another variable factor.
pub(super) fn find_square<'m>(model: &Model, product: &'m Expr) -> Option<Square<'m>> {
    let (mut found, mut parameters) = (None, Vec::new());
    read_factors(model, product, &mut found, &mut parameters)?;
    let (whole, base) = found?;
    Some(Square {
        square: whole,
        base,
        parameters,
    })
}

/// Reads the factors of a product: one square of a variable quantity, parameters and numbers.
/// `None` if there is any other factor.
fn read_factors<'m>(
    model: &Model,
    expr: &'m Expr,
    moving: &mut Option<(&'m Expr, &'m Expr)>,
    parameters: &mut Vec<String>,
) -> Option<()> {
    match &expr.kind {
        ExprKind::Binary(BinaryOperator::Multiply, left, right) => {
            read_factors(model, left, moving, parameters)?;
            read_factors(model, right, moving, parameters)
        }
        ExprKind::Binary(BinaryOperator::Divide, above, below) => {
            read_factors(model, above, moving, parameters)?;
            is_constant(model, below, parameters).then_some(())
        }
        ExprKind::Binary(BinaryOperator::Power, base, exponent)
            if exponent.kind == ExprKind::Number(2.0)
                && moving.is_none()
                && !is_constant(model, base, &mut Vec::new()) =>
        {
            *moving = Some((expr, base));
            Some(())
        }
        _ => is_constant(model, expr, parameters).then_some(()),
    }
}

/// Returns true if an expression contains only parameters and numbers. Appends its parameters.
pub(super) fn is_constant(model: &Model, expr: &Expr, parameters: &mut Vec<String>) -> bool {
    match &expr.kind {
        ExprKind::Number(_) | ExprKind::Pi => true,
        ExprKind::Parameter(id) => {
            parameters.push(model.parameters[*id].name.clone());
            true
        }
        ExprKind::Negate(inner) => is_constant(model, inner, parameters),
        ExprKind::Binary(_, left, right) => {
            is_constant(model, left, parameters) && is_constant(model, right, parameters)
        }
        _ => false,
    }
}
