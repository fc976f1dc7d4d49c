//! Checks the quadrature of integrals over a field.
//!
//! An integral with a coefficient that is not a polynomial of the position is evaluated at the quadrature nodes of
//! its field (`modes`). The error is estimated by comparison with panels that resolve the coefficient. Bounds by
//! interval arithmetic detect changes of the coefficient between the nodes. `products` expands an integrand, `panels`
//! divides the domain, and `coefficients` compares both rules. `motion` compares them at a given state for integrands
//! that are not polynomials of the motion.

mod coefficients;
mod motion;
mod panels;
mod products;

use eomgen_model_spec::diagnostic::Diagnostic;
use eomgen_model_spec::ids::FieldId;
use eomgen_model_spec::model::{Expr, ExprKind, Model};
use eomgen_model_spec::span::Span;

use super::rule::FieldRule;
use products::{Expansion, expand, find_moving_jump};

pub use motion::State;

/// Largest error of an integral by quadrature, relative to the integral of the integrand's magnitude.
pub const MAX_ERROR: f64 = 1e-9;

/// Integral over a field that is computed by quadrature.
struct QuadratureIntegral<'m> {
    field: FieldId,
    integrand: &'m Expr,
    expansion: Expansion<'m>,
}

/// Error of the quadrature of an integral.
#[derive(Clone, Debug)]
pub struct QuadratureError {
    /// Location of the integrand in the specification.
    pub span: Span,
    /// Text of the integrand.
    pub text: String,
    /// Error, relative to the integral of the integrand's magnitude.
    pub error: f64,
    /// Number of quadrature nodes.
    pub nodes: usize,
}

/// Checks the integrals with a coefficient that depends only on position, parameters and time.
///
/// # Errors
/// The first coefficient whose integrals have an error above [`MAX_ERROR`] at the parameters of the model, or a
/// coefficient that jumps at a position that moves along the field.
pub fn check_coefficients(model: &Model, orders: &[usize]) -> Result<(), Diagnostic> {
    if model.fields.is_empty() {
        return Ok(());
    }
    let parameters = model
        .parameter_values()
        .map_err(|error| error.diagnostic())?;
    for integral in find_integrals(model) {
        if let Some(jump) = find_moving_jump(model, integral.integrand) {
            return Err(Diagnostic::error(
                "the position of this jump moves along the field, so that the quadrature points switch one after the other",
            )
            .with_span(jump.span, "")
            .with_help(
                "write a smooth transition over a length, for example 1/2*(1 + tanh((v*t - x)/b))",
            ));
        }
        let Expansion::Products(products) = &integral.expansion else {
            continue;
        };
        let field = coefficients::CheckedField::new(model, orders, integral.field, &parameters);
        for product in products {
            field.check(product)?;
        }
    }
    Ok(())
}

/// Returns the largest quadrature error at a state, over the integrals that are not polynomials of the motion.
/// Returns `None` if the model has no such integral, or none with a finite value at this state.
pub fn find_largest_error_at_state(
    model: &Model,
    orders: &[usize],
    state: State<'_>,
) -> Option<QuadratureError> {
    let integrals = find_integrals(model).into_iter();
    let nonlinear = integrals.filter(|found| matches!(found.expansion, Expansion::Nonlinear));
    let errors = nonlinear.filter_map(|integral| {
        let error = motion::error_at(model, orders, &integral, state)?;
        Some(QuadratureError {
            span: integral.integrand.span,
            text: model
                .source
                .text
                .get(integral.integrand.span.start..integral.integrand.span.end)?
                .to_owned(),
            error,
            nodes: FieldRule::new(model, integral.field, orders[integral.field.index()])
                .node_count(),
        })
    });
    errors.max_by(|one, other| one.error.total_cmp(&other.error))
}

/// Returns true if the integrand of an integral of the model is not a polynomial of the motion.
pub fn has_nonlinear_integrals(model: &Model) -> bool {
    find_integrals(model)
        .iter()
        .any(|found| matches!(found.expansion, Expansion::Nonlinear))
}

/// Finds the integrals of the model, each location in the specification once.
fn find_integrals(model: &Model) -> Vec<QuadratureIntegral<'_>> {
    let mut found: Vec<QuadratureIntegral<'_>> = Vec::new();
    if model.fields.is_empty() {
        return found;
    }
    model.for_each_expression(&mut |expr| {
        expr.visit(&mut |part| {
            if let ExprKind::Integral { field, integrand } = &part.kind {
                found.push(QuadratureIntegral {
                    field: *field,
                    integrand,
                    expansion: expand(model, integrand),
                });
            }
        });
    });
    found
}
