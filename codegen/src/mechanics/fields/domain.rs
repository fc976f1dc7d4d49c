//! Domain of a field, as nodes of the graph.

use std::rc::Rc;

use eomgen_model_spec::ids::FieldId;
use eomgen_model_spec::model::Basis;

use super::modes;
use super::rule::FieldRule;
use super::term::Atom;
use crate::symbolic::graph::{Graph, NodeId};
use crate::symbolic::tables::TableKind;

/// Domain of a field, as graph nodes.
pub struct Domain {
    /// Field.
    pub field: FieldId,
    /// Mode shapes.
    pub basis: Basis,
    /// Start position.
    pub from: NodeId,
    /// End position.
    pub to: NodeId,
    /// Length, to - from.
    pub length: NodeId,
    /// Quadrature rule.
    pub rule: Rc<FieldRule>,
}

impl Domain {
    /// Checks that the mode shapes have the derivative that this atom needs.
    ///
    /// # Errors
    /// A third derivative of tabulated shapes, which are cubic splines.
    pub fn check_derivative(&self, atom: Atom) -> Result<(), String> {
        if self.basis.table().is_some() && atom.derivative() > 2 {
            return Err(
                "the shapes of a table have only two derivatives: they are cubic splines through its rows"
                    .into(),
            );
        }
        Ok(())
    }

    /// Returns s = (x - from)/(to - from). Tabulated shapes need a constant s; for these, equal terms of x and of the
    /// ends of the domain are cancelled.
    pub fn derive_relative_position(&self, graph: &mut Graph, position: NodeId) -> NodeId {
        if self.basis.table().is_none() {
            let from_start = graph.subtract(position, self.from);
            return graph.divide(from_start, self.length);
        }
        let from_start = graph.combine_flat(&[(1.0, position), (-1.0, self.from)]);
        let length = graph.combine_flat(&[(1.0, self.to), (-1.0, self.from)]);
        graph.divide(from_start, length)
    }

    /// Returns the node of a table of the field.
    pub fn table(&self, graph: &mut Graph, kind: TableKind) -> NodeId {
        let order = graph.orders()[self.field];
        let basis = &self.basis;
        graph.constants(self.field, kind, || match kind {
            TableKind::NodePosition | TableKind::NodeWeight | TableKind::ShapeAtNodes(_) => {
                modes::compute_table_at_nodes(basis, order, &self.rule.quadrature(), kind)
            }
            _ => modes::table(basis, order, kind),
        })
    }
}
