//! The values of what was requested, node by node as it is structured.

use super::values::Lowering;
use crate::mechanics::outputs::Switch;
use crate::mechanics::outputs::{Entry, Jacobian, Products, Requested};
use crate::mechanics::rows::Rows;
use crate::program::{RowValues, ValueId};
use crate::symbolic::graph::Id;

impl Lowering<'_> {
    pub(super) fn requested(
        &mut self,
        requested: &Requested<Id, Rows>,
    ) -> Requested<ValueId, RowValues> {
        Requested {
            requests: requested.requests.clone(),
            bias_forces: requested.bias_forces.as_ref().map(|rows| self.rows(rows)),
            inverse_dynamics: requested
                .inverse_dynamics
                .as_ref()
                .map(|rows| self.rows(rows)),
            guard_rates: requested
                .guard_rates
                .as_ref()
                .map(|rates| rates.iter().map(|id| self.value(*id)).collect()),
            jacobians: requested
                .jacobians
                .iter()
                .map(|jacobian| self.jacobian(jacobian))
                .collect(),
            products: requested.products.as_ref().map(|products| Products {
                forward: self.rows(&products.forward),
                reverse: products
                    .reverse
                    .iter()
                    .map(|(variable, node)| (*variable, self.value(*node)))
                    .collect(),
                by_parameters: self.jacobian(&products.by_parameters),
            }),
            regimes: requested.regimes.as_ref().map(|switches| {
                let switches = switches.iter();
                switches
                    .map(|switch| Switch {
                        value: self.value(switch.value),
                        decided: switch.decided,
                    })
                    .collect()
            }),
        }
    }

    fn jacobian(&mut self, jacobian: &Jacobian<Id>) -> Jacobian<ValueId> {
        let entries = jacobian.entries.iter();
        Jacobian {
            name: jacobian.name,
            rows: jacobian.rows,
            columns: jacobian.columns,
            entries: entries
                .map(|entry| Entry {
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
