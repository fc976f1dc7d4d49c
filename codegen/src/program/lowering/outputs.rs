//! Values of the requested outputs.

use super::values::Lowering;
use crate::mechanics::outputs::SlidingSurface;
use crate::mechanics::outputs::Switch;
use crate::mechanics::outputs::{
    Corners, GradientDerivative, GradientRow, Jacobian, JacobianBlock, Outputs, Products, RateRow,
    Reactions,
};
use crate::mechanics::rows::RowNodes;
use crate::program::{RowValues, ValueId};
use crate::symbolic::graph::NodeId;

impl Lowering<'_> {
    pub(super) fn outputs(
        &mut self,
        outputs: &Outputs<NodeId, RowNodes>,
    ) -> Outputs<ValueId, RowValues> {
        Outputs {
            kinds: outputs.kinds.clone(),
            bias_forces: outputs.bias_forces.as_ref().map(|rows| self.rows(rows)),
            inverse_dynamics: outputs
                .inverse_dynamics
                .as_ref()
                .map(|rows| self.rows(rows)),
            guard_rates: outputs
                .guard_rates
                .as_ref()
                .map(|rates| rates.iter().map(|id| self.value(*id)).collect()),
            jacobians: outputs
                .jacobians
                .iter()
                .map(|jacobian| self.jacobian(jacobian))
                .collect(),
            products: outputs.products.as_ref().map(|products| Products {
                forward: self.rows(&products.forward),
                forward_first_order: products
                    .forward_first_order
                    .iter()
                    .map(|node| self.value(*node))
                    .collect(),
                reverse: products
                    .reverse
                    .iter()
                    .map(|(variable, node)| (*variable, self.value(*node)))
                    .collect(),
                by_parameters: self.jacobian(&products.by_parameters),
            }),
            gradient_derivative: outputs.gradient_derivative.as_ref().map(|derivative| {
                let rows = derivative.rows.iter();
                let rows = rows.map(|row| GradientRow {
                    first: row.first,
                    count: row.count,
                    value: self.value(row.value),
                    columns: row.columns.clone(),
                });
                GradientDerivative {
                    rows: rows.collect(),
                }
            }),
            reactions: outputs
                .reactions
                .as_ref()
                .map(|known| self.reactions(known)),
            regimes: outputs.regimes.as_ref().map(|switches| {
                let switches = switches.iter();
                switches
                    .map(|switch| Switch {
                        value: self.value(switch.value),
                        decided: switch.decided,
                    })
                    .collect()
            }),
            sliding: outputs.sliding.iter().map(|s| self.sliding(s)).collect(),
            sides: outputs.sides.clone(),
            corners: outputs
                .corners
                .as_ref()
                .map(|corners| self.corners(corners)),
        }
    }

    fn corners(&mut self, corners: &Corners<NodeId, RowNodes>) -> Corners<ValueId, RowValues> {
        let mut rows = |rows: &[RateRow<NodeId, RowNodes>]| {
            let lowered = rows.iter().map(|known| RateRow {
                place: known.place,
                rate: self.value(known.rate),
                row: self.rows(&known.row),
            });
            lowered.collect()
        };
        Corners {
            surfaces: rows(&corners.surfaces),
            constraints: rows(&corners.constraints),
            momenta: self.rows(&corners.momenta),
            hamiltonian: self.value(corners.hamiltonian),
            energy: self.value(corners.energy),
        }
    }

    fn reactions(&mut self, known: &Reactions<NodeId, RowNodes>) -> Reactions<ValueId, RowValues> {
        let mut values =
            |nodes: &[NodeId]| -> Vec<ValueId> { nodes.iter().map(|id| self.value(*id)).collect() };
        Reactions {
            first_order_rates: values(&known.first_order_rates),
            functions: values(&known.functions),
            effects: values(&known.effects),
            distances: values(&known.distances),
            restitutions: values(&known.restitutions),
            coefficients: (known.coefficients.iter())
                .map(|(contact, node)| (*contact, self.value(*node)))
                .collect(),
            columns: (known.columns.iter())
                .map(|(rates, first_order)| {
                    let first_order = first_order.iter().map(|id| self.value(*id)).collect();
                    (self.rows(rates), first_order)
                })
                .collect(),
            accelerations: self.rows(&known.accelerations),
        }
    }

    fn sliding(
        &mut self,
        surface: &SlidingSurface<NodeId, RowNodes>,
    ) -> SlidingSurface<ValueId, RowValues> {
        let mut values = |nodes: &[NodeId]| nodes.iter().map(|id| self.value(*id)).collect();
        SlidingSurface {
            guard: surface.guard,
            disc: surface.disc,
            is_odd: surface.is_odd,
            is_linear: surface.is_linear,
            by_sides: values(&surface.by_sides),
            first_order: values(&surface.first_order),
            rate: self.value(surface.rate),
            column: self.rows(&surface.column),
        }
    }

    fn jacobian(&mut self, jacobian: &Jacobian<NodeId>) -> Jacobian<ValueId> {
        let entries = jacobian.entries.iter();
        Jacobian {
            name: jacobian.name,
            rows: jacobian.rows,
            columns: jacobian.columns,
            entries: entries
                .map(|entry| JacobianBlock {
                    row: entry.row,
                    rows: entry.rows,
                    column: entry.column,
                    columns: entry.columns,
                    diagonal: entry.diagonal,
                    value: self.value(entry.value),
                })
                .collect(),
        }
    }
}
