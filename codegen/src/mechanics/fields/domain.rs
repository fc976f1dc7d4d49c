//! The domain of a field, as nodes of the graph.

use eomgen_model_spec::ids::FieldId;
use eomgen_model_spec::model::Basis;

use super::modes;
use super::term::Atom;
use crate::symbolic::graph::{Graph, NodeId};
use crate::symbolic::tables::TableKind;

/// The domain of a field, as nodes.
pub struct Domain {
    /// The field.
    pub field: FieldId,
    /// Its mode shapes.
    pub basis: Basis,
    /// Where it starts.
    pub from: NodeId,
    /// Where it ends.
    pub to: NodeId,
    /// to - from
    pub length: NodeId,
}

impl Domain {
    /// Whether shapes have as many derivatives as this atom.
    ///
    /// # Errors
    /// A third derivative of shapes between whose values a cubic spline runs.
    pub fn has(&self, atom: Atom) -> Result<(), String> {
        if self.basis.table().is_some() && atom.derivative() > 2 {
            return Err(
                "the shapes of a table have two derivatives: a cubic spline runs between its rows"
                    .into(),
            );
        }
        Ok(())
    }

    /// s = (x - from)/(to - from). The shapes of a table are known where it is a number, so there
    /// what is added and taken off again is looked for.
    pub fn relative(&self, graph: &mut Graph, position: NodeId) -> NodeId {
        if self.basis.table().is_none() {
            let from_start = graph.subtract(position, self.from);
            return graph.divide(from_start, self.length);
        }
        let from_start = graph.combine_flat(&[(1.0, position), (-1.0, self.from)]);
        let length = graph.combine_flat(&[(1.0, self.to), (-1.0, self.from)]);
        graph.divide(from_start, length)
    }

    /// The node of one of the field's tables.
    pub fn table(&self, graph: &mut Graph, kind: TableKind) -> NodeId {
        let order = graph.orders()[self.field];
        let basis = &self.basis;
        graph.constants(self.field, kind, || modes::table(basis, order, kind))
    }
}
