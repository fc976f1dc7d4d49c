//! Named coefficients of a specification, for example a_01 to a_78 of Eq. (22) of the paper: the factors of given
//! quantities in the accelerations. They are computed as derivatives of the derived accelerations, and are therefore
//! consistent with these.

use std::collections::HashMap;

use eomgen_model_spec::ids::{CoordinateId, FieldId};
use eomgen_model_spec::model::{Coefficient, CoefficientKind, Expr, ExprKind};

use crate::mechanics::solve::Accelerations;
use crate::mechanics::translate::{DeriveError, Derived, Translator};
use crate::symbolic::differentiate::derive_by_scalar;
use crate::symbolic::graph::{Graph, NodeId, Operation};
use crate::symbolic::matrix::StructuredMatrix;
use crate::symbolic::modal_derivative::ModalDerivative;
use crate::symbolic::substitute::substitute;

/// Named coefficient of the specification.
#[derive(Clone, Debug)]
pub struct NamedCoefficient {
    /// Name.
    pub name: String,
    /// Value: a scalar, or a vector over the modes.
    pub value: NodeId,
    /// Position in the equations of motion, if the coefficient is a factor.
    pub factor: Option<Factor>,
}

/// Position of a named factor: the product of `times` and the acceleration of `row` contains the factor times `by`.
#[derive(Clone, Copy, Debug)]
pub struct Factor {
    /// Row of the equations.
    pub row: EquationRow,
    /// Quantity that the factor multiplies.
    pub by: NodeId,
    /// Quantity that multiplies the row, if there is one.
    pub times: Option<NodeId>,
}

/// Row of the equations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EquationRow {
    /// Row of a coordinate.
    Coordinate(CoordinateId),
    /// Rows of all modes of a field.
    Modes(FieldId),
}

/// Derives the named coefficients in the order of the specification.
pub fn derive_coefficients(
    translator: &mut Translator,
    accelerations: &Accelerations,
) -> Derived<Vec<NamedCoefficient>> {
    let model = translator.model;
    let mut found = Vec::with_capacity(model.coefficients.len());
    for coefficient in &model.coefficients {
        let named = derive_coefficient(translator, accelerations, coefficient)?;
        translator.push_coefficient(named.value);
        translator.graph.set_name(named.value, &named.name);
        found.push(named);
    }
    Ok(found)
}

fn derive_coefficient(
    translator: &mut Translator,
    accelerations: &Accelerations,
    coefficient: &Coefficient,
) -> Derived<NamedCoefficient> {
    let (of, by, times) = match &coefficient.kind {
        CoefficientKind::Value(expr) => {
            return Ok(NamedCoefficient {
                name: coefficient.name.clone(),
                value: translator.node(expr)?,
                factor: None,
            });
        }
        CoefficientKind::Factor { of, by, times } => (of, by, times),
    };
    let row = find_equation_row(of)?;
    let acceleration = match row {
        EquationRow::Coordinate(index) => accelerations.rows.scalars[index],
        EquationRow::Modes(field) => accelerations.rows.modal[field],
    };
    let multiplied = translator.node(by)?;
    let factor = factor_of(&mut translator.graph, acceleration, multiplied);
    let times = times
        .as_ref()
        .map(|expr| translator.node(expr))
        .transpose()?;
    let value = match times {
        Some(times) => scale_factor(&mut translator.graph, times, factor),
        None => factor,
    };
    Ok(NamedCoefficient {
        name: coefficient.name.clone(),
        value,
        factor: Some(Factor {
            row,
            by: multiplied,
            times,
        }),
    })
}

pub(crate) fn find_equation_row(of: &Expr) -> Derived<EquationRow> {
    match of.kind {
        ExprKind::Coordinate(index) => Ok(EquationRow::Coordinate(index)),
        ExprKind::ModeCoordinate(field) => Ok(EquationRow::Modes(field)),
        _ => Err(DeriveError {
            span: of.span,
            message: "`of` must be a coordinate or the modal coordinates of a field".into(),
            help: None,
        }),
    }
}

/// Returns times * factor; a matrix is scaled row by row.
fn scale_factor(graph: &mut Graph, times: NodeId, factor: NodeId) -> NodeId {
    match graph.operation(factor).clone() {
        Operation::Assemble(assembly) => {
            let source = StructuredMatrix {
                rows: assembly.rows,
                columns: assembly.columns,
                diagonal: assembly.diagonal,
                outer: assembly.outer,
                matrices: assembly.matrices,
            };
            let mut scaled = StructuredMatrix::zero(source.rows, source.columns);
            scaled.add_scaled(graph, times, &source);
            scaled.assemble(graph)
        }
        _ => graph.multiply(times, factor),
    }
}

/// Returns the factor of `by` in a row: the derivative of the row by all factors of `by`, with coordinates, rates and
/// all other piecewise functions set to 0. If `by` is 1, returns the row with these zeros.
fn factor_of(graph: &mut Graph, row: NodeId, by: NodeId) -> NodeId {
    if let Operation::ModeCoordinates(_) | Operation::ModeRates(_) = graph.operation(by) {
        let at_rest = evaluate_at_rest_except(graph, row, &[by]);
        return derive_by_modes(graph, at_rest, by);
    }
    let factors: Vec<NodeId> = match graph.operation(by).clone() {
        Operation::Product(factors) => factors.iter().map(|(factor, _)| *factor).collect(),
        Operation::Constant(_) => Vec::new(),
        _ => vec![by],
    };
    let mut result = row;
    for &factor in &factors {
        result = derive_by_scalar(graph, result, factor);
    }
    evaluate_at_rest_except(graph, result, &[])
}

/// Differentiates a row with respect to modes: a vector for a coordinate's row, a matrix for the rows of modes.
fn derive_by_modes(graph: &mut Graph, row: NodeId, variable: NodeId) -> NodeId {
    let Some(mut derivative) = ModalDerivative::new(graph, variable) else {
        return graph.zero();
    };
    match graph.shape(row) {
        crate::symbolic::graph::Shape::Scalar => derivative.gradient(graph, row),
        _ => {
            let jacobian = derivative.jacobian(graph, row);
            jacobian.assemble(graph)
        }
    }
}

/// Sets every coordinate, rate and piecewise function to 0, except the nodes in `kept`.
fn evaluate_at_rest_except(graph: &mut Graph, id: NodeId, kept: &[NodeId]) -> NodeId {
    let replacement = |graph: &mut Graph, node: NodeId| {
        if kept.contains(&node) || graph.dependence(node).is_parameter_only() {
            return Some(node);
        }
        let moves = match graph.operation(node) {
            Operation::Coordinate(_)
            | Operation::Rate(_)
            | Operation::ModeCoordinates(_)
            | Operation::ModeRates(_)
            | Operation::State(_) => true,
            Operation::Call(function, _) => {
                matches!(
                    function,
                    eomgen_model_spec::model::Function::Deadzone
                        | eomgen_model_spec::model::Function::Contact
                        | eomgen_model_spec::model::Function::Sign
                        | eomgen_model_spec::model::Function::Abs
                        | eomgen_model_spec::model::Function::Above
                )
            }
            _ => false,
        };
        moves.then(|| graph.zero())
    };
    substitute(graph, id, &replacement, &mut HashMap::new())
}
