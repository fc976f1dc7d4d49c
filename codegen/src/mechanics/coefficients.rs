//! The coefficients a specification names, as Eq. (22) names a_01 to a_78: the factors
//! with which given quantities enter the accelerations. They are read off the derived
//! accelerations by differentiation, so a name cannot say anything the equations do not.

use std::collections::HashMap;

use eomgen_model_spec::ids::{CoordinateId, FieldId};
use eomgen_model_spec::model::{Coefficient, CoefficientKind, Expr, ExprKind};

use crate::mechanics::solve::Accelerations;
use crate::mechanics::translate::{DeriveError, Derived, Translator};
use crate::symbolic::differentiate::by_scalar;
use crate::symbolic::graph::{Graph, NodeId, Operation};
use crate::symbolic::matrix::StructuredMatrix;
use crate::symbolic::modal_derivative::ModalDerivative;
use crate::symbolic::substitute::substitute;

/// A coefficient the specification names.
#[derive(Clone, Debug)]
pub struct NamedCoefficient {
    /// Its name.
    pub name: String,
    /// Its value: a scalar, or a vector over the modes.
    pub value: NodeId,
    /// For a factor: where it stands.
    pub factor: Option<Factor>,
}

/// Where a named factor stands: `times` the acceleration of `row` holds it times `by`.
#[derive(Clone, Copy, Debug)]
pub struct Factor {
    /// The row.
    pub row: EquationRow,
    /// What it multiplies.
    pub by: NodeId,
    /// What the row is multiplied with, if anything.
    pub times: Option<NodeId>,
}

/// A row of the equations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EquationRow {
    /// A coordinate's.
    Coordinate(CoordinateId),
    /// Every mode of a field.
    Modes(FieldId),
}

/// The named coefficients in the order of the specification.
pub fn named(
    translator: &mut Translator,
    accelerations: &Accelerations,
) -> Derived<Vec<NamedCoefficient>> {
    let model = translator.model;
    let mut found = Vec::with_capacity(model.coefficients.len());
    for coefficient in &model.coefficients {
        let named = one(translator, accelerations, coefficient)?;
        translator.push_coefficient(named.value);
        translator.graph.set_name(named.value, &named.name);
        found.push(named);
    }
    Ok(found)
}

fn one(
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
    let row = row_of(of)?;
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

/// The row that `of` names.
pub(crate) fn row_of(of: &Expr) -> Derived<EquationRow> {
    match of.kind {
        ExprKind::Coordinate(index) => Ok(EquationRow::Coordinate(index)),
        ExprKind::ModeCoordinate(field) => Ok(EquationRow::Modes(field)),
        _ => Err(DeriveError {
            span: of.span,
            message: "`of` names a coordinate or a field's mode coordinates".into(),
            help: None,
        }),
    }
}

/// times * factor; a matrix factor is scaled row by row.
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

/// The factor with which `by` enters a row: its derivative by every factor of `by`, with
/// the motion and every other switching function at 0. For `by` = 1 what is left of the
/// row there.
fn factor_of(graph: &mut Graph, row: NodeId, by: NodeId) -> NodeId {
    if let Operation::ModeCoordinates(_) | Operation::ModeRates(_) = graph.operation(by) {
        let at_rest = at_rest_except(graph, row, &[by]);
        return by_modes(graph, at_rest, by);
    }
    let factors: Vec<NodeId> = match graph.operation(by).clone() {
        Operation::Product(factors) => factors.iter().map(|(factor, _)| *factor).collect(),
        Operation::Constant(_) => Vec::new(),
        _ => vec![by],
    };
    let mut result = row;
    for &factor in &factors {
        result = by_scalar(graph, result, factor);
    }
    at_rest_except(graph, result, &[])
}

/// A row's derivative by modes: a vector for a coordinate's row, a matrix for modes'.
fn by_modes(graph: &mut Graph, row: NodeId, variable: NodeId) -> NodeId {
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

/// With every coordinate, rate and switching function 0, except those to be kept.
fn at_rest_except(graph: &mut Graph, id: NodeId, kept: &[NodeId]) -> NodeId {
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
