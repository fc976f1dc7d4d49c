//! The modal block of the mass matrix: its inverse field by field, and the interface scalars
//! through which outer products couple the modes.

use super::small::{SmallSystem, inner_product, pivot_reciprocal};
use crate::equations::{MassMatrix, Rows};
use crate::graph::{Graph, Id, Operation, Space};

/// How the modes of one field are solved for.
pub(super) enum ModalInverse {
    /// Division by a diagonal.
    Diagonal { diagonal: Id, reciprocal: Id },
    /// Cholesky factor of a dense block.
    Dense { factor: Id },
}

impl ModalInverse {
    pub(super) fn new(graph: &mut Graph, mass: &MassMatrix, field: usize) -> Self {
        let block = &mass.modal[field][field];
        // Without a diagonal, fewer outer products than modes make a singular block.
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

    /// A constant diagonal is divided into every term, where it cancels against the
    /// stiffness of the same mode.
    pub(super) fn apply(&self, graph: &mut Graph, vector: Id) -> Id {
        match *self {
            Self::Dense { factor } => graph.cholesky_solve(factor, vector),
            Self::Diagonal { reciprocal, .. } => match graph.operation(vector).clone() {
                Operation::Sum(terms) if graph.dependence(reciprocal).is_prepared() => {
                    let divided: Vec<(f64, Id)> = terms
                        .iter()
                        .map(|&(c, term)| (c.value(), graph.multiply(term, reciprocal)))
                        .collect();
                    graph.combine(&divided)
                }
                _ => graph.multiply(vector, reciprocal),
            },
        }
    }

    pub(super) fn pivot(&self) -> Id {
        match *self {
            Self::Diagonal { diagonal, .. } => diagonal,
            Self::Dense { factor } => factor,
        }
    }

    pub(super) fn is_dense(&self) -> bool {
        matches!(self, Self::Dense { .. })
    }
}

/// A vector over one field's modes through which outer products act.
pub(super) struct Interface {
    pub(super) field: usize,
    pub(super) shape: Id,
    /// D^-1 shape
    pub(super) solved: Id,
    /// shape^T D^-1 shape, before the interfaces are made orthogonal
    pub(super) square: Id,
}

/// Of a combination of other interfaces rounding leaves about 1e-32 of the square.
const LEAST_SHARE: f64 = 1e-20;

/// The modal block: an inverse per field, and interfaces with their weights G.
pub(super) struct ModalBlock {
    pub(super) inverses: Vec<Option<ModalInverse>>,
    pub(super) interfaces: Vec<Interface>,
    pub(super) weights: Vec<Vec<Id>>,
}

impl ModalBlock {
    pub(super) fn new(graph: &mut Graph, mass: &MassMatrix) -> Self {
        let fields = mass.modal.len();
        let inverses = (0..fields)
            .map(|field| {
                let occupied = graph.size(Space::Modes(field)) > 0;
                occupied.then(|| ModalInverse::new(graph, mass, field))
            })
            .collect();
        let mut block = Self {
            inverses,
            interfaces: Vec::new(),
            weights: Vec::new(),
        };
        for row in 0..fields {
            for column in 0..fields {
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
        if !block.weights_are_diagonal(graph) {
            for field in 0..fields {
                block.orthogonalise(graph, field);
            }
        }
        block
    }

    fn weights_are_diagonal(&self, graph: &Graph) -> bool {
        self.weights.iter().enumerate().all(|(row, weights)| {
            let beside = |(column, weight): (usize, &Id)| row == column || graph.is_zero(*weight);
            weights.iter().enumerate().all(beside)
        })
    }

    /// Makes the interfaces of a field orthogonal by D^-1 (Gram-Schmidt), each keeping its
    /// own direction: phi_k = psi_k + sum over j < k of mu_kj psi_j, G' = U G U^T with
    /// U_jk = mu_kj.
    ///
    /// The pivots of I + C G, C = Phi^T D^-1 Phi, are ratios of its leading minors. With C
    /// diagonal these are the minors of the symmetric I + C^1/2 G C^1/2, all positive if
    /// the modal block is positive definite. With any other C they need not be: for a mass
    /// on a lever between two points of a beam the first can be negative.
    fn orthogonalise(&mut self, graph: &mut Graph, field: usize) {
        let places: Vec<usize> = (0..self.interfaces.len())
            .filter(|place| self.interfaces[*place].field == field)
            .collect();
        for (count, &place) in places.iter().enumerate() {
            let shares: Vec<(usize, Id)> = places[..count]
                .iter()
                .map(|&earlier| (earlier, self.share(graph, place, earlier)))
                .collect();
            let mut terms = vec![(1.0, self.interfaces[place].shape)];
            for &(earlier, share) in &shares {
                terms.push((-1.0, graph.multiply(share, self.interfaces[earlier].shape)));
                self.move_weight(graph, place, earlier, share);
            }
            let shape = graph.combine(&terms);
            self.interfaces[place].shape = shape;
            self.interfaces[place].solved = self.solve_field(graph, field, shape);
        }
    }

    /// mu: how much of the orthogonal interface `earlier` is in the interface `place`; 0 if
    /// `earlier` was a combination of others, which leaves nothing but rounding of it.
    fn share(&self, graph: &mut Graph, place: usize, earlier: usize) -> Id {
        let (own, other) = (&self.interfaces[place], &self.interfaces[earlier]);
        let product = inner_product(graph, own.field, own.shape, other.solved);
        let square = inner_product(graph, own.field, other.shape, other.solved);
        let share = graph.divide(product, square);
        let least = graph.scale(LEAST_SHARE, other.square);
        let zero = graph.zero();
        graph.select(square, least, share, zero)
    }

    /// The weights after phi_place = psi + share psi_earlier.
    fn move_weight(&mut self, graph: &mut Graph, place: usize, earlier: usize, share: Id) {
        for column in 0..self.interfaces.len() {
            let moved = graph.multiply(share, self.weights[place][column]);
            self.weights[earlier][column] = graph.add(self.weights[earlier][column], moved);
        }
        for row in 0..self.interfaces.len() {
            let moved = graph.multiply(share, self.weights[row][place]);
            self.weights[row][earlier] = graph.add(self.weights[row][earlier], moved);
        }
    }

    /// Spreads u v^T over interfaces: scalar factors go into the weights.
    fn add_outer(&mut self, graph: &mut Graph, u: (usize, Id), v: (usize, Id)) {
        for (u_scalar, u_shape) in scaled_shapes(graph, u.1) {
            for (v_scalar, v_shape) in scaled_shapes(graph, v.1) {
                let row = self.interface(graph, u.0, u_shape);
                let column = self.interface(graph, v.0, v_shape);
                let (Some(row), Some(column)) = (row, column) else {
                    continue;
                };
                let weight = graph.multiply(u_scalar, v_scalar);
                self.weights[row][column] = graph.add(self.weights[row][column], weight);
            }
        }
    }

    fn interface(&mut self, graph: &mut Graph, field: usize, shape: Id) -> Option<usize> {
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
        for row in &mut self.weights {
            row.push(zero);
        }
        self.weights.push(vec![zero; self.interfaces.len()]);
        Some(self.interfaces.len() - 1)
    }

    pub(super) fn solve_field(&self, graph: &mut Graph, field: usize, vector: Id) -> Id {
        match &self.inverses[field] {
            Some(inverse) if !graph.is_zero(vector) => inverse.apply(graph, vector),
            _ => graph.zero(),
        }
    }

    /// The accelerations of the modes once interfaces and coordinates are known.
    pub(super) fn back_substitute(
        &self,
        graph: &mut Graph,
        system: &SmallSystem,
        unknowns: &[Id],
    ) -> Rows {
        let (interface_values, coordinates) =
            unknowns.split_at(self.interfaces.len().min(unknowns.len()));
        let weighted = self.weighted(graph, interface_values);
        let modal = (0..self.inverses.len())
            .map(|field| {
                let mut terms = vec![(1.0, system.free_modes[field])];
                for (interface, &value) in self.interfaces.iter().zip(&weighted) {
                    if interface.field == field {
                        terms.push((-1.0, graph.multiply(interface.solved, value)));
                    }
                }
                for (row, &value) in coordinates.iter().enumerate() {
                    terms.push((
                        -1.0,
                        graph.multiply(system.solved_coupling[row][field], value),
                    ));
                }
                graph.combine_flat(&terms)
            })
            .collect();
        Rows {
            scalars: coordinates.to_vec(),
            modal,
        }
    }

    /// G y
    fn weighted(&self, graph: &mut Graph, values: &[Id]) -> Vec<Id> {
        self.weights
            .iter()
            .map(|row| {
                let terms: Vec<(f64, Id)> = row
                    .iter()
                    .zip(values)
                    .map(|(weight, value)| (1.0, graph.multiply(*weight, *value)))
                    .collect();
                graph.combine(&terms)
            })
            .collect()
    }
}

/// A vector as a sum of scalar factors times vectors free of them.
fn scaled_shapes(graph: &mut Graph, vector: Id) -> Vec<(Id, Id)> {
    match graph.operation(vector).clone() {
        Operation::Sum(terms) => terms
            .iter()
            .flat_map(|&(factor, term)| {
                scaled_shapes(graph, term)
                    .into_iter()
                    .map(|(scalar, shape)| (graph.scale(factor.value(), scalar), shape))
                    .collect::<Vec<_>>()
            })
            .collect(),
        Operation::Product(factors) => {
            let (scalars, vectors) = graph.scalar_factors(&factors);
            vec![(graph.product(&scalars), graph.product(&vectors))]
        }
        _ => vec![(graph.one(), vector)],
    }
}
