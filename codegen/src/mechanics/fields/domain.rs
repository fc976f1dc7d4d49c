//! The domain of a field, as nodes of the graph.

use eomgen_model_spec::ids::FieldId;
use eomgen_model_spec::model::Basis;

use super::modes;
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
    /// The node of one of the field's tables.
    pub fn table(&self, graph: &mut Graph, kind: TableKind) -> NodeId {
        let order = graph.orders()[self.field];
        let basis = self.basis;
        graph.constants(self.field, kind, || modes::table(basis, order, kind))
    }
}
