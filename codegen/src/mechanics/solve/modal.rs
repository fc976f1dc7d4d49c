//! Modal block of the mass matrix: one inverse for each field, and the interface scalars of its outer products.

use super::elimination::{inner_product, pivot_reciprocal};
use super::separation::{SeparatedTerm, separate};
use crate::mechanics::mass_matrix::MassMatrix;
use crate::mechanics::rows::RowNodes;
use crate::symbolic::graph::{Graph, NodeId, Operation, Space};
use eomgen_model_spec::ids::FieldId;

/// Solution for the modes of one field.
pub(super) enum ModalInverse {
    /// Division by a diagonal matrix.
    Diagonal {
        diagonal: NodeId,
        reciprocal: NodeId,
    },
    Dense {
        factor: NodeId,
    },
}

impl ModalInverse {
    pub(super) fn new(graph: &mut Graph, mass: &MassMatrix, field: FieldId) -> Self {
        let block = &mass.modal[field][field];
        // A block without a diagonal part is singular if it has fewer outer products than modes.
        let full_rank = block.outer.len() >= graph.size(Space::Modes(field));
        if block.matrices.is_empty() && (block.diagonal.is_some() || !full_rank) {
            let diagonal = block.diagonal.unwrap_or_else(|| graph.zero());
            let reciprocal = pivot_reciprocal(graph, diagonal);
            return Self::Diagonal {
                diagonal,
                reciprocal,
            };
        }
        let matrix = block.assemble(graph);
        let factor = graph.intern(Operation::Cholesky(matrix));
        Self::Dense { factor }
    }

    /// Applies the inverse to a vector. A constant diagonal divides every term separately, because it can cancel
    /// against the stiffness of the mode.
    pub(super) fn apply(&self, graph: &mut Graph, vector: NodeId) -> NodeId {
        match *self {
            Self::Dense { factor } => graph.cholesky_solve(factor, vector),
            Self::Diagonal { reciprocal, .. } => match graph.operation(vector).clone() {
                Operation::Sum(terms) if graph.dependence(reciprocal).is_parameter_only() => {
                    let divided: Vec<(f64, NodeId)> = terms
                        .iter()
                        .map(|&(c, term)| (c.value(), graph.multiply(term, reciprocal)))
                        .collect();
                    graph.combine(&divided)
                }
                _ => graph.multiply(vector, reciprocal),
            },
        }
    }

    pub(super) fn pivot(&self) -> NodeId {
        match *self {
            Self::Diagonal { diagonal, .. } => diagonal,
            Self::Dense { factor } => factor,
        }
    }

    pub(super) fn is_dense(&self) -> bool {
        matches!(self, Self::Dense { .. })
    }
}

/// Vector over the modes of one field in an outer product.
pub(super) struct Interface {
    pub(super) field: FieldId,
    pub(super) shape: NodeId,
    /// D^-1 shape
    pub(super) solved: NodeId,
    /// shape^T D^-1 shape, before orthogonalisation.
    pub(super) square: NodeId,
}

/// Smallest fraction of an interface's square norm that remains after orthogonalisation. For a dependent interface,
/// rounding leaves about 1e-32.
const MIN_SQUARE_FRACTION: f64 = 1e-20;

/// Modal block: an inverse for each field, and interfaces with their weights G.
pub(super) struct ModalBlock {
    pub(super) inverses: Vec<Option<ModalInverse>>,
    pub(super) interfaces: Vec<Interface>,
    pub(super) weights: Vec<Vec<NodeId>>,
    /// C: coupling of each coordinate through the interfaces.
    pub(super) coupling: Vec<Vec<NodeId>>,
    /// H: other coupling of each coordinate with each field.
    pub(super) direct_coupling: Vec<Vec<NodeId>>,
    /// b: modal forces through the interfaces.
    pub(super) forces: Vec<NodeId>,
    /// Other modal forces, for each field.
    pub(super) direct_forces: Vec<NodeId>,
    /// True if a field couples to coordinates only through its interfaces.
    pub(super) through_interfaces: Vec<bool>,
}

impl ModalBlock {
    pub(super) fn new(graph: &mut Graph, mass: &MassMatrix, right: &RowNodes) -> Self {
        let fields = mass.modal.len();
        let inverses = FieldId::first(fields)
            .map(|field| {
                let occupied = graph.size(Space::Modes(field)) > 0;
                occupied.then(|| ModalInverse::new(graph, mass, field))
            })
            .collect();
        let mut block = Self {
            inverses,
            interfaces: Vec::new(),
            weights: Vec::new(),
            coupling: vec![Vec::new(); right.scalars.len()],
            direct_coupling: mass.coupling.clone(),
            forces: Vec::new(),
            direct_forces: right.modal.clone(),
            through_interfaces: vec![false; fields],
        };
        for row in FieldId::first(fields) {
            for column in FieldId::first(fields) {
                let dense = block.inverses[row]
                    .as_ref()
                    .is_some_and(ModalInverse::is_dense);
                if row == column && dense {
                    continue;
                }
                for &(u, v) in &mass.modal[row][column].outer {
                    block.add_outer(graph, (row, u), (column, v));
                }
            }
        }
        for field in FieldId::first(fields) {
            block.couple_through_interfaces(graph, field);
        }
        if !block.weights_are_diagonal(graph) {
            for field in FieldId::first(fields) {
                block.orthogonalise(graph, field);
            }
        }
        block
    }

    /// Makes the shapes of a field interfaces if its coupling depends on the state; for example, the coupling of a
    /// flexible link depends on the angle of the next link. Then only scalars depend on the state. Shapes that depend
    /// on the state are excluded, because their interfaces would cost more than they save.
    fn couple_through_interfaces(&mut self, graph: &mut Graph, field: FieldId) {
        if !matches!(
            self.inverses[field],
            Some(ModalInverse::Diagonal { reciprocal, .. }) if graph.dependence(reciprocal).is_parameter_only()
        ) {
            return;
        }
        let rows: Vec<NodeId> = self.direct_coupling.iter().map(|row| row[field]).collect();
        let turning = |graph: &Graph, id: &NodeId| !graph.dependence(*id).is_parameter_only();
        let interfaces: Vec<NodeId> = self.interfaces.iter().map(|i| i.shape).collect();
        if !rows.iter().any(|row| turning(graph, row))
            || interfaces.iter().any(|shape| turning(graph, shape))
        {
            return;
        }
        let separated: Vec<Vec<SeparatedTerm>> =
            rows.iter().map(|row| separate(graph, *row)).collect();
        if separated
            .iter()
            .flatten()
            .any(|part| turning(graph, &part.vector))
        {
            return;
        }
        self.through_interfaces[field] = true;
        for (row, parts) in separated.into_iter().enumerate() {
            self.direct_coupling[row][field] = graph.zero();
            for part in parts {
                if let Some(index) = self.interface(graph, field, part.vector) {
                    self.coupling[row][index] = part.scalar;
                }
            }
        }
        let mut direct = Vec::new();
        for part in separate(graph, self.direct_forces[field]) {
            let index = self
                .interfaces
                .iter()
                .position(|i| i.field == field && i.shape == part.vector);
            match index {
                Some(index) => self.forces[index] = part.scalar,
                None => direct.push((1.0, graph.multiply(part.scalar, part.vector))),
            }
        }
        self.direct_forces[field] = graph.combine(&direct);
    }

    fn weights_are_diagonal(&self, graph: &Graph) -> bool {
        let diagonal = self.weights.iter().enumerate().all(|(row, weights)| {
            let beside =
                |(column, weight): (usize, &NodeId)| row == column || graph.is_zero(*weight);
            weights.iter().enumerate().all(beside)
        });
        diagonal && !self.through_interfaces.contains(&true)
    }

    /// Makes the interfaces of a field orthogonal with respect to D^-1 (Gram-Schmidt): phi_k = psi_k + sum
    /// over j < k of mu_kj psi_j, G' = U G U^T with U_jk = mu_kj.
    ///
    /// The pivots of I + G K, K = Phi^T D^-1 Phi, are ratios of its leading minors. With a diagonal K these are the
    /// minors of the symmetric I + K^1/2 G K^1/2, all positive if the modal block is positive definite. If K is not
    /// diagonal, a pivot can be negative, for example for a mass on a lever between two points of a beam.
    fn orthogonalise(&mut self, graph: &mut Graph, field: FieldId) {
        let places: Vec<usize> = (0..self.interfaces.len())
            .filter(|index| self.interfaces[*index].field == field)
            .collect();
        for (count, &index) in places.iter().enumerate() {
            let shares: Vec<(usize, NodeId)> = places[..count]
                .iter()
                .map(|&earlier| (earlier, self.compute_share(graph, index, earlier)))
                .collect();
            let mut terms = vec![(1.0, self.interfaces[index].shape)];
            for &(earlier, share) in &shares {
                terms.push((-1.0, graph.multiply(share, self.interfaces[earlier].shape)));
                self.move_weight(graph, index, earlier, share);
            }
            let shape = graph.combine(&terms);
            self.interfaces[index].shape = shape;
            self.interfaces[index].solved = self.solve_field(graph, field, shape);
        }
    }

    /// Returns mu, the component of the interface `index` along the orthogonal interface `earlier`. The result is 0
    /// if `earlier` depends on other interfaces, because then it contains only rounding errors.
    fn compute_share(&self, graph: &mut Graph, index: usize, earlier: usize) -> NodeId {
        let (own, other) = (&self.interfaces[index], &self.interfaces[earlier]);
        let product = inner_product(graph, own.field, own.shape, other.solved);
        let square = inner_product(graph, own.field, other.shape, other.solved);
        let share = graph.divide(product, square);
        let least = graph.scale(MIN_SQUARE_FRACTION, other.square);
        let zero = graph.zero();
        graph.select(square, least, share, zero)
    }

    /// Updates the weights for phi_index = psi + share psi_earlier.
    fn move_weight(&mut self, graph: &mut Graph, index: usize, earlier: usize, share: NodeId) {
        for column in 0..self.interfaces.len() {
            let moved = graph.multiply(share, self.weights[index][column]);
            self.weights[earlier][column] = graph.add(self.weights[earlier][column], moved);
        }
        for row in 0..self.interfaces.len() {
            let moved = graph.multiply(share, self.weights[row][index]);
            self.weights[row][earlier] = graph.add(self.weights[row][earlier], moved);
        }
        for row in self.coupling.iter_mut().chain([&mut self.forces]) {
            let moved = graph.multiply(share, row[index]);
            row[earlier] = graph.add(row[earlier], moved);
        }
    }

    /// Adds the outer product u v^T: its vectors become interfaces, its scalar factors weights.
    fn add_outer(&mut self, graph: &mut Graph, u: (FieldId, NodeId), v: (FieldId, NodeId)) {
        let (rows, columns) = (separate(graph, u.1), separate(graph, v.1));
        for u_part in &rows {
            for v_part in &columns {
                let row = self.interface(graph, u.0, u_part.vector);
                let column = self.interface(graph, v.0, v_part.vector);
                let (Some(row), Some(column)) = (row, column) else {
                    continue;
                };
                let weight = graph.multiply(u_part.scalar, v_part.scalar);
                self.weights[row][column] = graph.add(self.weights[row][column], weight);
            }
        }
    }

    fn interface(&mut self, graph: &mut Graph, field: FieldId, shape: NodeId) -> Option<usize> {
        let known = self
            .interfaces
            .iter()
            .position(|i| i.field == field && i.shape == shape);
        if known.is_some() {
            return known;
        }
        let solved = self.inverses[field].as_ref()?.apply(graph, shape);
        let square = inner_product(graph, field, shape, solved);
        self.interfaces.push(Interface {
            field,
            shape,
            solved,
            square,
        });
        let zero = graph.zero();
        let rows = self.weights.iter_mut().chain(&mut self.coupling);
        for row in rows.chain([&mut self.forces]) {
            row.push(zero);
        }
        self.weights.push(vec![zero; self.interfaces.len()]);
        Some(self.interfaces.len() - 1)
    }

    pub(super) fn solve_field(&self, graph: &mut Graph, field: FieldId, vector: NodeId) -> NodeId {
        match &self.inverses[field] {
            Some(inverse) if !graph.is_zero(vector) => inverse.apply(graph, vector),
            _ => graph.zero(),
        }
    }
}
