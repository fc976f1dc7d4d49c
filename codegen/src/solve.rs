//! The accelerations from M a = f, following the structure of the mass matrix.
//!
//! Modes are eliminated first: their block is diagonal plus outer products through a few
//! interface scalars (the deflection at a tip mass, say), so that with
//! D a_q + Phi G (Phi^T a_q) + H^T a = f_q the modes cost O(S). The interface scalars
//! y = Phi^T a_q stand as extra unknowns beside the coordinates in a small system, solved
//! by elimination without pivoting in the order that counts fewest operations. Where G is
//! not diagonal the interfaces are made orthogonal first, or a pivot could be negative
//! although M is positive definite (see [`ModalBlock::orthogonalise`]). Where the
//! basis is not orthogonal the modal block is dense and its Cholesky factor takes the
//! place of D. Pivots must be positive: a reciprocal of one that is not is NaN.

use crate::equations::{MassMatrix, Rows};
use crate::graph::{Graph, Id, Operation, Shape, Space};

/// The accelerations, and how they were found.
#[derive(Clone, Debug)]
pub struct Accelerations {
    /// The accelerations.
    pub rows: Rows,
    /// All pivots of the factorisation, which must be positive: those of the coordinates in
    /// the order of their elimination, then those of the interfaces, vectors over the
    /// modes, and Cholesky factors (positive if they hold no NaN).
    pub pivots: Vec<Id>,
    /// What was chosen.
    pub report: SolveReport,
}

/// How the accelerations are solved for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SolveReport {
    /// The unknowns in the order of their elimination after the modes: coordinates by
    /// number.
    pub order: Vec<usize>,
    /// How many interface scalars stand beside the coordinates.
    pub interfaces: usize,
    /// Operations per call for the chosen order.
    pub operations: usize,
    /// Operations per call of the dearest order tried.
    pub dearest: usize,
    /// Whether a field's modal block is dense.
    pub dense_modes: bool,
}

/// Solves M a = f.
pub fn solve(graph: &mut Graph, mass: &MassMatrix, right: &Rows) -> Accelerations {
    let modal = ModalBlock::new(graph, mass);
    let system = SmallSystem::new(graph, mass, right, &modal);
    let coordinates = right.scalars.len();
    let mut best: Option<(usize, Vec<usize>, Rows, Vec<Id>)> = None;
    let mut dearest = 0;
    for order in elimination_orders(coordinates) {
        let (unknowns, mut pivots) = system.eliminate(graph, &order);
        pivots.rotate_left(system.interfaces);
        let rows = modal.back_substitute(graph, &system, &unknowns);
        let operations = count_operations(graph, &rows.nodes());
        dearest = dearest.max(operations);
        if best.as_ref().is_none_or(|(least, ..)| operations < *least) {
            best = Some((operations, order, rows, pivots));
        }
    }
    let Some((operations, order, rows, mut pivots)) = best else {
        unreachable!("there is at least one order of any number of coordinates");
    };
    pivots.extend(modal.inverses.iter().flatten().map(ModalInverse::pivot));
    Accelerations {
        rows,
        pivots,
        report: SolveReport {
            order,
            interfaces: modal.interfaces.len(),
            operations,
            dearest,
            dense_modes: modal.inverses.iter().flatten().any(ModalInverse::is_dense),
        },
    }
}

/// All orders for up to four coordinates, the natural one and its reverse beyond.
fn elimination_orders(count: usize) -> Vec<Vec<usize>> {
    let natural: Vec<usize> = (0..count).collect();
    if count > 4 {
        return vec![natural.iter().rev().copied().collect(), natural];
    }
    let mut orders = vec![Vec::new()];
    for _ in 0..count {
        orders = orders
            .into_iter()
            .flat_map(|order: Vec<usize>| {
                (0..count)
                    .filter(|index| !order.contains(index))
                    .map(|index| [order.clone(), vec![index]].concat())
                    .collect::<Vec<_>>()
            })
            .collect();
    }
    orders
}

/// Additions, multiplications and calls that depend on the state, element by element.
pub fn count_operations(graph: &Graph, roots: &[Id]) -> usize {
    graph
        .reachable(roots)
        .into_iter()
        .filter(|id| !graph.dependence(*id).is_prepared())
        .map(|id| {
            let operation = graph.operation(id);
            let operands = graph.operands(operation);
            match operation {
                Operation::Total(a) => graph.length(graph.shape(*a)),
                Operation::Apply { matrix, .. } => 2 * graph.length(graph.shape(*matrix)),
                Operation::CholeskySolve(factor, _) => 2 * graph.length(graph.shape(*factor)),
                _ => operands.len() * graph.length(graph.shape(id)),
            }
        })
        .sum()
}

/// How the modes of one field are solved for.
enum ModalInverse {
    /// Division by a diagonal.
    Diagonal { diagonal: Id, reciprocal: Id },
    /// Cholesky factor of a dense block.
    Dense { factor: Id },
}

impl ModalInverse {
    fn new(graph: &mut Graph, mass: &MassMatrix, field: usize) -> Self {
        let block = &mass.modal[field][field];
        if let (Some(diagonal), true) = (block.diagonal, block.matrices.is_empty()) {
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
    fn apply(&self, graph: &mut Graph, vector: Id) -> Id {
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

    fn pivot(&self) -> Id {
        match *self {
            Self::Diagonal { diagonal, .. } => diagonal,
            Self::Dense { factor } => factor,
        }
    }

    fn is_dense(&self) -> bool {
        matches!(self, Self::Dense { .. })
    }
}

/// A vector over one field's modes through which outer products act.
struct Interface {
    field: usize,
    shape: Id,
    /// D^-1 shape
    solved: Id,
    /// shape^T D^-1 shape, before the interfaces are made orthogonal
    square: Id,
}

/// Of a combination of other interfaces rounding leaves about 1e-32 of the square.
const LEAST_SHARE: f64 = 1e-20;

/// The modal block: an inverse per field, and interfaces with their weights G.
struct ModalBlock {
    inverses: Vec<Option<ModalInverse>>,
    interfaces: Vec<Interface>,
    weights: Vec<Vec<Id>>,
}

impl ModalBlock {
    fn new(graph: &mut Graph, mass: &MassMatrix) -> Self {
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

    fn solve_field(&self, graph: &mut Graph, field: usize, vector: Id) -> Id {
        match &self.inverses[field] {
            Some(inverse) if !graph.is_zero(vector) => inverse.apply(graph, vector),
            _ => graph.zero(),
        }
    }

    /// The accelerations of the modes once interfaces and coordinates are known.
    fn back_substitute(&self, graph: &mut Graph, system: &SmallSystem, unknowns: &[Id]) -> Rows {
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
            let (scalars, vectors): (Vec<_>, Vec<_>) = factors
                .iter()
                .partition(|(id, _)| graph.shape(*id) == Shape::Scalar);
            vec![(graph.product(&scalars), graph.product(&vectors))]
        }
        _ => vec![(graph.one(), vector)],
    }
}

/// The system left when the modes are eliminated: interface scalars, then coordinates.
struct SmallSystem {
    interfaces: usize,
    matrix: Vec<Vec<Id>>,
    right: Vec<Id>,
    /// D^-1 f_q per field
    free_modes: Vec<Id>,
    /// D^-1 h per coordinate and field
    solved_coupling: Vec<Vec<Id>>,
}

impl SmallSystem {
    fn new(graph: &mut Graph, mass: &MassMatrix, right: &Rows, modal: &ModalBlock) -> Self {
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
    fn eliminate(&self, graph: &mut Graph, coordinates: &[usize]) -> (Vec<Id>, Vec<Id>) {
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
fn pivot_reciprocal(graph: &mut Graph, pivot: Id) -> Id {
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

fn inner_product(graph: &mut Graph, field: usize, a: Id, b: Id) -> Id {
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
