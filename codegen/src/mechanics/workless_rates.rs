//! Rates of distances and slips at which contact forces do no work.
//!
//! A force F along the row A of a distance g(q, t) changes the accelerations by D F and d(T + V)/dt by p D F, with the
//! momenta p = M q' + b, where b = dT/dq' at q' = 0. With the multipliers mu of the constraints C q' + c = 0,
//! M D = A^T + C^T mu, so that
//!
//! ```text
//! p D = g' - w,    w = g_t - b D + mu c
//! ```
//!
//! An impulse P changes T + V by P (g' - w) with the mean of the rates g' before and after it. The same equations
//! hold for the slip of a contact with friction. b is zero if T is a quadratic form of the rates; for coordinates
//! relative to a moving frame, b is not zero.

use std::collections::HashMap;

use eomgen_model_spec::model::Model;

use crate::mechanics::constraints::Constraints;
use crate::mechanics::lagrange::{GradientBy, Variables};
use crate::mechanics::rows::RowNodes;
use crate::mechanics::translate::explicit_rate;
use crate::symbolic::degree::is_quadratic_in_rates;
use crate::symbolic::graph::{Graph, NodeId, Operation};
use crate::symbolic::substitute::substitute;

/// Momenta and constraint rates at zero rates of the coordinates.
pub(crate) struct RestTerms {
    /// Momenta b; `None` if they are zero.
    momenta: Option<RowNodes>,
    /// Rates c of the constraints.
    constraint_rates: Vec<NodeId>,
}

impl RestTerms {
    pub(crate) fn derive(
        graph: &mut Graph,
        model: &Model,
        variables: &Variables,
        kinetic: NodeId,
        constraints: &Constraints,
    ) -> Self {
        let momenta = (!is_quadratic_in_rates(graph, kinetic)).then(|| {
            let mut momenta = variables.gradient(graph, kinetic, GradientBy::Rates);
            for entry in momenta.scalars.iter_mut().chain(&mut momenta.modal) {
                *entry = set_rates_to_zero(graph, *entry);
            }
            momenta
        });
        let residuals = model.constraints.iter().zip(&constraints.residuals);
        let constraint_rates = residuals
            .map(|(constraint, zero)| match constraint.is_nonholonomic {
                true => set_rates_to_zero(graph, *zero),
                false => explicit_rate(graph, *zero),
            })
            .collect();
        Self {
            momenta,
            constraint_rates,
        }
    }

    /// Returns the rate w of a distance or slip. `rate` is its rate at zero rates of the coordinates. The change of
    /// the rates and the multipliers of the constraints are the effect of a unit impulse.
    pub(crate) fn workless_rate(
        &self,
        graph: &mut Graph,
        own_rate: NodeId,
        (column, multipliers): (&RowNodes, &[NodeId]),
    ) -> NodeId {
        let mut terms = vec![(1.0, own_rate)];
        if let Some(momenta) = &self.momenta {
            terms.push((-1.0, momenta.dot(graph, column)));
        }
        for (multiplier, rate) in multipliers.iter().zip(&self.constraint_rates) {
            terms.push((1.0, graph.multiply(*multiplier, *rate)));
        }
        graph.combine(&terms)
    }
}

/// Returns a node with the rates of all coordinates replaced by 0.
pub(crate) fn set_rates_to_zero(graph: &mut Graph, node: NodeId) -> NodeId {
    let zero = |graph: &mut Graph, id: NodeId| {
        let operation = graph.operation(id);
        matches!(operation, Operation::Rate(_) | Operation::ModeRates(_)).then(|| graph.zero())
    };
    substitute(graph, node, &zero, &mut HashMap::new())
}
