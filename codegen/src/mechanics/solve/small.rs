//! Small system of interface forces and coordinates after the elimination of the modes, solved without
//! pivoting.

use super::elimination::{Elimination, inner_product};
use super::modal::ModalBlock;
use super::redundant::{DependentRows, DependentSystem};
use crate::mechanics::mass_matrix::MassMatrix;
use crate::mechanics::rows::RowNodes;
use crate::symbolic::graph::{Graph, NodeId, Space};
use eomgen_model_spec::ids::FieldId;

/// System after the elimination of the modes: interface forces, then coordinates.
pub(super) struct SmallSystem {
    pub(super) interfaces: usize,
    /// Number of rows of multipliers at the end, whose pivots are negative.
    multipliers: usize,
    /// Dependent multipliers, which are eliminated last.
    dependent: DependentRows,
    pub(super) matrix: Vec<Vec<NodeId>>,
    pub(super) right: Vec<NodeId>,
    /// D^-1 f_q of each field.
    pub(super) free_modes: Vec<NodeId>,
    /// D^-1 h of each coordinate and field.
    pub(super) solved_coupling: Vec<Vec<NodeId>>,
}

struct Response {
    /// K = Phi^T D^-1 Phi
    compliance: Vec<Vec<NodeId>>,
    /// Phi^T D^-1 H^T, interfaces x coordinates
    coupling: Vec<Vec<NodeId>>,
    /// Phi^T D^-1 f_q
    free: Vec<NodeId>,
}

impl SmallSystem {
    pub(super) fn new(
        graph: &mut Graph,
        mass: &MassMatrix,
        right: &RowNodes,
        modal: &ModalBlock,
        (multipliers, dependent): (usize, DependentRows),
    ) -> Self {
        let mut solved = |vectors: &[NodeId]| -> Vec<NodeId> {
            let fields = FieldId::first(vectors.len()).zip(vectors);
            fields
                .map(|(field, vector)| modal.solve_field(graph, field, *vector))
                .collect()
        };
        let free_modes = solved(&modal.direct_forces);
        let solved_coupling = modal
            .direct_coupling
            .iter()
            .map(|row| solved(row))
            .collect();
        let mut system = Self {
            interfaces: modal.interfaces.len(),
            multipliers,
            dependent,
            matrix: Vec::new(),
            right: Vec::new(),
            free_modes,
            solved_coupling,
        };
        let response = system.derive_response(graph, modal);
        for place in 0..system.interfaces {
            system.push_interface_row(graph, place, modal, &response);
        }
        for row in 0..right.scalars.len() {
            system.push_coordinate_row(graph, mass, row, right.scalars[row], modal, &response);
        }
        system
    }

    fn derive_response(&self, graph: &mut Graph, modal: &ModalBlock) -> Response {
        let mut response = Response {
            compliance: Vec::new(),
            coupling: Vec::new(),
            free: Vec::new(),
        };
        for (place, interface) in modal.interfaces.iter().enumerate() {
            let (field, shape) = (interface.field, interface.shape);
            let orthogonal = modal.through_interfaces[field];
            let others = modal.interfaces.iter().enumerate();
            let compliance = others.map(|(column, other)| {
                if other.field == field && (place == column || !orthogonal) {
                    inner_product(graph, field, shape, other.solved)
                } else {
                    graph.zero()
                }
            });
            response.compliance.push(compliance.collect());
            let coupling = self.solved_coupling.iter();
            let coupling = coupling.map(|h| inner_product(graph, field, shape, h[field]));
            response.coupling.push(coupling.collect());
            let free = self.free_modes[field];
            // A sum of many terms is computed before its products with the shapes.
            response.free.push(if orthogonal && !graph.is_zero(free) {
                let product = graph.multiply(shape, free);
                graph.sum_over_space(Space::Modes(field), product)
            } else {
                inner_product(graph, field, shape, free)
            });
        }
        response
    }

    /// Adds the row (1 + G K) p + (G Phi^T D^-1 H^T - C^T) a = G Phi^T D^-1 f_q - b.
    fn push_interface_row(
        &mut self,
        graph: &mut Graph,
        place: usize,
        modal: &ModalBlock,
        response: &Response,
    ) {
        let weights = &modal.weights[place];
        let mut row: Vec<NodeId> = (0..self.interfaces)
            .map(|column| {
                let one = if column == place {
                    graph.one()
                } else {
                    graph.zero()
                };
                let compliance = response.compliance.iter().map(|row| row[column]);
                add_term_products(graph, one, 1.0, weights, compliance)
            })
            .collect();
        for (coordinate, coupling) in modal.coupling.iter().enumerate() {
            let own = graph.negate(coupling[place]);
            let moved = response.coupling.iter().map(|row| row[coordinate]);
            row.push(add_term_products(graph, own, 1.0, weights, moved));
        }
        let force = graph.negate(modal.forces[place]);
        let free = response.free.iter().copied();
        let right = add_term_products(graph, force, 1.0, weights, free);
        self.right.push(right);
        self.matrix.push(row);
    }

    /// Adds the row (A - H D^-1 H^T) a - (H D^-1 Phi + C K) p = f - H D^-1 f_q - C Phi^T D^-1 f_q. The coupling with
    /// a field is either C or H.
    fn push_coordinate_row(
        &mut self,
        graph: &mut Graph,
        mass: &MassMatrix,
        row: usize,
        force: NodeId,
        modal: &ModalBlock,
        response: &Response,
    ) {
        let direct = &modal.direct_coupling[row];
        let through = &modal.coupling[row];
        let mut entries: Vec<NodeId> = (0..self.interfaces)
            .map(|column| {
                let own = graph.negate(response.coupling[column][row]);
                let compliance = response.compliance.iter().map(|row| row[column]);
                add_term_products(graph, own, -1.0, through, compliance)
            })
            .collect();
        for (column, solved) in self.solved_coupling.iter().enumerate() {
            let mut terms = vec![(1.0, mass.scalars[row][column])];
            for (field, h) in FieldId::first(direct.len()).zip(direct) {
                terms.push((-1.0, inner_product(graph, field, *h, solved[field])));
            }
            entries.push(graph.combine(&terms));
        }
        let mut terms = vec![(1.0, force)];
        for (field, h) in FieldId::first(direct.len()).zip(direct) {
            terms.push((
                -1.0,
                inner_product(graph, field, *h, self.free_modes[field]),
            ));
        }
        for (coupling, free) in through.iter().zip(&response.free) {
            terms.push((-1.0, graph.multiply(*coupling, *free)));
        }
        self.right.push(graph.combine_flat(&terms));
        self.matrix.push(entries);
    }

    /// Eliminates without pivoting: interfaces, coordinates in the given order, multipliers. Returns the
    /// unknowns in their original order, and the pivots (with opposite sign for multipliers), which must be
    /// positive.
    pub(super) fn eliminate(
        &self,
        graph: &mut Graph,
        coordinates: &[usize],
    ) -> (Vec<NodeId>, Vec<NodeId>) {
        let first_multiplier = self.interfaces + coordinates.len();
        let rows = self.dependent.rows.iter();
        let dependent: Vec<usize> = rows.map(|row| first_multiplier + row).collect();
        let multipliers = (first_multiplier..).take(self.multipliers);
        let mut order: Vec<usize> = (0..self.interfaces)
            .chain(coordinates.iter().map(|index| self.interfaces + index))
            .chain(multipliers.filter(|row| !dependent.contains(row)))
            .collect();
        let eliminated = order.len();
        order.extend(&dependent);
        let mut rest = Elimination::new(self.matrix.clone(), self.right.clone());
        for _ in 0..first_multiplier {
            rest.eliminate_next(graph, &order, false);
        }
        let scales = dependent.iter();
        let scales = scales.map(|row| graph.negate(rest.matrix[*row][*row]));
        let scales: Vec<NodeId> = scales.collect();
        for _ in first_multiplier..eliminated {
            rest.eliminate_next(graph, &order, true);
        }
        let mut pivots = std::mem::take(&mut rest.pivots);
        let mut unknowns = vec![graph.zero(); order.len()];
        if !dependent.is_empty() {
            let mut negated = |entry: NodeId| graph.negate(entry);
            let mut matrix_row = |row: usize| -> Vec<NodeId> {
                let columns = dependent.iter();
                let entry =
                    |column: &usize| negated(rest.matrix[row.min(*column)][row.max(*column)]);
                columns.map(entry).collect()
            };
            let system = DependentSystem {
                matrix: dependent.iter().map(|row| matrix_row(*row)).collect(),
                right: (dependent.iter())
                    .map(|row| negated(rest.right[*row]))
                    .collect(),
                scales,
                rank: self.dependent.rank,
                has_unit_diagonal: eliminated == first_multiplier,
            };
            let (found, own_pivots) = system.solve(graph);
            for (row, value) in dependent.iter().zip(found) {
                unknowns[*row] = value;
            }
            pivots.extend(own_pivots);
        }
        rest.substitute_back(graph, &order, &mut unknowns);
        (unknowns, pivots)
    }

    /// Returns the accelerations of the modes, D^-1 (f_q - H^T a - Phi p); H includes the rows of the
    /// multipliers.
    pub(super) fn back_substitute(
        &self,
        graph: &mut Graph,
        modal: &ModalBlock,
        unknowns: &[NodeId],
        multipliers: &[NodeId],
    ) -> RowNodes {
        let (forces, coordinates) = unknowns.split_at(modal.interfaces.len());
        let by_field = FieldId::first(modal.inverses.len())
            .map(|field| {
                let mut terms = vec![(1.0, self.free_modes[field])];
                for (interface, &force) in modal.interfaces.iter().zip(forces) {
                    if interface.field == field {
                        terms.push((-1.0, graph.multiply(interface.solved, force)));
                    }
                }
                for (row, &value) in coordinates.iter().chain(multipliers).enumerate() {
                    terms.push((
                        -1.0,
                        graph.multiply(self.solved_coupling[row][field], value),
                    ));
                }
                graph.combine_flat(&terms)
            })
            .collect();
        RowNodes {
            scalars: coordinates.to_vec(),
            modal: by_field,
        }
    }
}

/// Returns start + sign * sum of a_k b_k.
fn add_term_products(
    graph: &mut Graph,
    start: NodeId,
    sign: f64,
    a: &[NodeId],
    b: impl Iterator<Item = NodeId>,
) -> NodeId {
    let products = a.iter().zip(b).map(|(a, b)| (sign, graph.multiply(*a, b)));
    let mut terms: Vec<(f64, NodeId)> = products.collect();
    terms.push((1.0, start));
    graph.combine(&terms)
}
