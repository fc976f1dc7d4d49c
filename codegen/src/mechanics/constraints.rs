//! Constraints, differentiated with respect to time until accelerations appear. The constraint forces are A^T lambda
//! with the multipliers lambda, and the accelerations satisfy
//!
//! ```text
//! M a + c = f + A^T lambda,    A a = b
//! ```
//!
//! Holonomic, g(q, t) = 0: A = dg/dq, b = -(g'' without accelerations) - 2 w g' - w^2 g.
//!
//! Nonholonomic, h(q, q', t) = 0 and linear in the rates: A = dh/dq', b = -(h' without accelerations) - 2 w
//! h.
//!
//! The terms with w are zero if the constraints are satisfied; nonzero residuals decay at the rate w (J. Baumgarte,
//! Stabilization of constraints and integrals of motion in dynamical systems, Comp. Meth. Appl. Mech. Eng. 1, 1972),
//! the parameter `stabilisation_rate`. `solve` solves the system; see [`Redundancy`] for dependent rows of A.

use eomgen_model_spec::ids::{ConstraintId, ParameterId};
use eomgen_model_spec::model::{Constraint, STABILISATION_RATE};

use crate::mechanics::lagrange::{GradientBy, Variables};
use crate::mechanics::redundancy::Redundancy;
use crate::mechanics::rows::RowNodes;
use crate::mechanics::translate::{DeriveError, Derived, Translator, along_motion};
use crate::symbolic::graph::{Dependence, Graph, NodeId, Operation};

/// System A a = b of the constraints.
#[derive(Clone, Debug, Default)]
pub(crate) struct Constraints {
    /// Rows of A.
    pub rows: Vec<RowNodes>,
    /// Right-hand sides b.
    pub right: Vec<NodeId>,
    /// Residuals.
    pub residuals: Vec<NodeId>,
    /// Constraints whose rows depend on each other.
    pub redundancy: Redundancy,
}

impl Constraints {
    pub(crate) fn derive(
        translator: &mut Translator,
        variables: &Variables,
        redundancy: &Redundancy,
    ) -> Derived<Self> {
        let mut constraints = Self {
            redundancy: redundancy.clone(),
            ..Self::default()
        };
        let model = translator.model;
        let mut parameters = ParameterId::first(model.parameters.len()).zip(&model.parameters);
        let rate = parameters.find(|(_, parameter)| parameter.name == STABILISATION_RATE);
        let Some((rate, _)) = rate else {
            return Ok(constraints);
        };
        let rate = translator.graph.intern(Operation::Parameter(rate));
        for (id, constraint) in ConstraintId::first(model.constraints.len()).zip(&model.constraints)
        {
            let zero = translator.residual(id)?;
            let (row, right) = match constraint.is_nonholonomic {
                true => derive_nonholonomic_row(&mut translator.graph, variables, zero, rate),
                false => derive_holonomic_row(&mut translator.graph, variables, zero, rate),
            };
            let moves = (row.nodes().iter())
                .any(|entry| translator.graph.dependence(*entry).has(Dependence::RATE));
            if moves {
                return Err(nonlinear_error(constraint));
            }
            constraints.rows.push(row);
            constraints.right.push(right);
            constraints.residuals.push(zero);
        }
        Ok(constraints)
    }
}

fn derive_holonomic_row(
    graph: &mut Graph,
    variables: &Variables,
    zero: NodeId,
    rate: NodeId,
) -> (RowNodes, NodeId) {
    let row = variables.gradient(graph, zero, GradientBy::Coordinates);
    let first = along_motion(graph, zero);
    let second = along_motion(graph, first);
    let squared = graph.integer_power(rate, 2);
    let damped = graph.multiply(rate, first);
    let sprung = graph.multiply(squared, zero);
    let right = graph.combine_flat(&[(-1.0, second), (-2.0, damped), (-1.0, sprung)]);
    (row, right)
}

fn derive_nonholonomic_row(
    graph: &mut Graph,
    variables: &Variables,
    zero: NodeId,
    rate: NodeId,
) -> (RowNodes, NodeId) {
    let row = variables.gradient(graph, zero, GradientBy::Rates);
    let first = along_motion(graph, zero);
    let damped = graph.multiply(rate, zero);
    let right = graph.combine_flat(&[(-1.0, first), (-2.0, damped)]);
    (row, right)
}

pub(crate) fn nonlinear_error(constraint: &Constraint) -> DeriveError {
    DeriveError {
        span: constraint.zero.span,
        message: format!(
            "the constraint `{}` is not linear in the rates",
            constraint.name
        ),
        help: Some(
            "write it as an expression of coordinates, or as one that is linear in the rates"
                .into(),
        ),
    }
}

/// Returns the power of the constraint forces, lambda A q'. It is 0 for exact constraints that do not depend
/// on time.
pub(crate) fn derive_reaction_power(
    graph: &mut Graph,
    variables: &Variables,
    constraints: &Constraints,
    multipliers: &[NodeId],
) -> NodeId {
    let mut terms = Vec::new();
    for (row, multiplier) in constraints.rows.iter().zip(multipliers) {
        let speed = variables.multiply_by_rates(graph, row);
        terms.push((1.0, graph.multiply(*multiplier, speed)));
    }
    graph.combine(&terms)
}
