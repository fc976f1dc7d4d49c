//! The small system of interface scalars and coordinates that is left when the modes are
//! eliminated, and its elimination without pivoting.

use super::modal::{Interface, ModalBlock};
use crate::equations::{MassMatrix, Rows};
use crate::graph::{Graph, Id, Operation, Space};

/// The system left when the modes are eliminated: interface scalars, then coordinates.
pub(super) struct SmallSystem {
    pub(super) interfaces: usize,
    pub(super) matrix: Vec<Vec<Id>>,
    pub(super) right: Vec<Id>,
    /// D^-1 f_q per field
    pub(super) free_modes: Vec<Id>,
    /// D^-1 h per coordinate and field
    pub(super) solved_coupling: Vec<Vec<Id>>,
}

impl SmallSystem {
    pub(super) fn new(
        graph: &mut Graph,
        mass: &MassMatrix,
        right: &Rows,
        modal: &ModalBlock,
    ) -> Self {
        let free_modes: Vec<Id> = right
            .modal
            .iter()
            .enumerate()
            .map(|(field, row)| modal.solve_field(graph, field, *row))
            .collect();
        let solved_coupling: Vec<Vec<Id>> = mass
            .coupling
            .iter()
            .map(|row| {
                row.iter()
                    .enumerate()
                    .map(|(field, h)| modal.solve_field(graph, field, *h))
                    .collect()
            })
            .collect();
        let mut system = Self {
            interfaces: modal.interfaces.len(),
            matrix: Vec::new(),
            right: Vec::new(),
            free_modes,
            solved_coupling,
        };
        for interface in &modal.interfaces {
            system.push_interface_row(graph, interface, modal);
        }
        for row in 0..right.scalars.len() {
            system.push_coordinate_row(graph, mass, row, right.scalars[row], modal);
        }
        system
    }

    /// y + Phi^T D^-1 (Phi G y + H^T a) = Phi^T D^-1 f_q
    fn push_interface_row(&mut self, graph: &mut Graph, interface: &Interface, modal: &ModalBlock) {
        let index = self.matrix.len();
        let compliances: Vec<Id> = modal
            .interfaces
            .iter()
            .map(|other| {
                if other.field == interface.field {
                    inner_product(graph, interface.field, interface.shape, other.solved)
                } else {
                    graph.zero()
                }
            })
            .collect();
        let mut row: Vec<Id> = (0..self.interfaces)
            .map(|column| {
                let mut terms: Vec<(f64, Id)> = compliances
                    .iter()
                    .enumerate()
                    .map(|(k, c)| (1.0, graph.multiply(*c, modal.weights[k][column])))
                    .collect();
                if column == index {
                    terms.push((1.0, graph.one()));
                }
                graph.combine(&terms)
            })
            .collect();
        for solved in &self.solved_coupling {
            row.push(inner_product(
                graph,
                interface.field,
                interface.shape,
                solved[interface.field],
            ));
        }
        self.right.push(inner_product(
            graph,
            interface.field,
            interface.shape,
            self.free_modes[interface.field],
        ));
        self.matrix.push(row);
    }

    /// (A - H D^-1 H^T) a - H D^-1 Phi G y = f - H D^-1 f_q
    fn push_coordinate_row(
        &mut self,
        graph: &mut Graph,
        mass: &MassMatrix,
        row: usize,
        force: Id,
        modal: &ModalBlock,
    ) {
        let coupling = &mass.coupling[row];
        let through: Vec<Id> = modal
            .interfaces
            .iter()
            .map(|i| inner_product(graph, i.field, coupling[i.field], i.solved))
            .collect();
        let mut entries: Vec<Id> = (0..self.interfaces)
            .map(|column| {
                let terms: Vec<(f64, Id)> = through
                    .iter()
                    .enumerate()
                    .map(|(k, t)| (-1.0, graph.multiply(*t, modal.weights[k][column])))
                    .collect();
                graph.combine(&terms)
            })
            .collect();
        for (column, solved) in self.solved_coupling.iter().enumerate() {
            let mut terms = vec![(1.0, mass.scalars[row][column])];
            for (field, h) in coupling.iter().enumerate() {
                terms.push((-1.0, inner_product(graph, field, *h, solved[field])));
            }
            entries.push(graph.combine(&terms));
        }
        let mut terms = vec![(1.0, force)];
        for (field, h) in coupling.iter().enumerate() {
            terms.push((
                -1.0,
                inner_product(graph, field, *h, self.free_modes[field]),
            ));
        }
        self.right.push(graph.combine_flat(&terms));
        self.matrix.push(entries);
    }

    /// Elimination without pivoting, interfaces first, then coordinates in this order.
    /// Returns the unknowns in their own order, and the pivots.
    pub(super) fn eliminate(&self, graph: &mut Graph, coordinates: &[usize]) -> (Vec<Id>, Vec<Id>) {
        let order: Vec<usize> = (0..self.interfaces)
            .chain(coordinates.iter().map(|index| self.interfaces + index))
            .collect();
        let mut matrix = self.matrix.clone();
        let mut right = self.right.clone();
        let mut reciprocals = Vec::with_capacity(order.len());
        let mut pivots = Vec::with_capacity(order.len());
        for (step, &pivot_row) in order.iter().enumerate() {
            let pivot = matrix[pivot_row][pivot_row];
            let reciprocal = pivot_reciprocal(graph, pivot);
            pivots.push(pivot);
            reciprocals.push(reciprocal);
            for &row in &order[step + 1..] {
                if graph.is_zero(matrix[row][pivot_row]) {
                    continue;
                }
                let factor = graph.multiply(matrix[row][pivot_row], reciprocal);
                for &column in &order[step + 1..] {
                    let product = graph.multiply(factor, matrix[pivot_row][column]);
                    matrix[row][column] =
                        graph.combine_flat(&[(1.0, matrix[row][column]), (-1.0, product)]);
                }
                let product = graph.multiply(factor, right[pivot_row]);
                right[row] = graph.combine_flat(&[(1.0, right[row]), (-1.0, product)]);
            }
        }
        let zero = graph.zero();
        let mut unknowns = vec![zero; order.len()];
        for (step, &row) in order.iter().enumerate().rev() {
            let mut terms = vec![(1.0, right[row])];
            for &column in &order[step + 1..] {
                terms.push((-1.0, graph.multiply(matrix[row][column], unknowns[column])));
            }
            let rest = graph.combine(&terms);
            unknowns[row] = graph.multiply(rest, reciprocals[step]);
        }
        (unknowns, pivots)
    }
}

/// The reciprocal of a pivot. One of parameters alone that is a plain product cancels
/// against the row it divides (it is checked where the coefficients are prepared); any
/// other is checked on the spot.
pub(super) fn pivot_reciprocal(graph: &mut Graph, pivot: Id) -> Id {
    let plain = match graph.operation(pivot) {
        Operation::Parameter(_) | Operation::Product(_) => true,
        Operation::Sum(terms) => terms.len() == 1,
        _ => false,
    };
    if plain && graph.dependence(pivot).is_prepared() {
        graph.integer_power(pivot, -1)
    } else {
        graph.intern(Operation::PivotReciprocal(pivot))
    }
}

pub(super) fn inner_product(graph: &mut Graph, field: usize, a: Id, b: Id) -> Id {
    if graph.is_zero(a) || graph.is_zero(b) {
        return graph.zero();
    }
    let space = Space::Modes(field);
    match graph.operation(b).clone() {
        // A sum's terms have prepared factors of their own: keep them apart.
        Operation::Sum(terms) if terms.len() > 1 => {
            let terms: Vec<(f64, Id)> = terms
                .iter()
                .map(|&(c, term)| {
                    let product = graph.multiply(a, term);
                    (c.value(), graph.total_over(space, product))
                })
                .collect();
            graph.combine(&terms)
        }
        _ => {
            let product = graph.multiply(a, b);
            graph.total_over(space, product)
        }
    }
}
