//! States that determine all others by linear constraints, by elimination with complete pivoting
//! (Golub and Van Loan, *Matrix Computations*, 3.4).

use nalgebra::DMatrix;

use crate::null_space::equilibrate_rows;

/// Largest remainder of a scaled constraint that counts as zero. Redundant constraints differ by the error of
/// the point of linearisation.
const MAX_DEPENDENT_REMAINDER: f64 = 1e-6;

/// Independent states of a machine with constraints.
pub(crate) struct IndependentStates {
    /// Indices of the independent states: first coordinates whose rates are independent too, then these rates,
    /// then other coordinates and first-order states.
    pub states: Vec<usize>,
    /// Number of coordinates whose rates are independent.
    pub degrees: usize,
    /// Matrix from the independent states (columns) to all states (rows).
    pub basis: DMatrix<f64>,
}

/// Selects the independent states of (q, q', z) with C (q, q', z) = 0. `held` is C; `degrees` is the number of
/// coordinates q. The rates of dependent coordinates are dependent. The states must have similar sizes: an
/// entry far below the largest of its row is rounding.
pub(crate) fn independent_states(held: &DMatrix<f64>, degrees: usize) -> IndependentStates {
    let states = held.ncols();
    let mut elimination = Elimination::new(held);
    let is_position = |row: &usize| held.row(*row).columns(degrees, degrees).amax() == 0.0;
    let positions: Vec<usize> = (0..held.nrows()).filter(is_position).collect();
    let all: Vec<usize> = (0..held.nrows()).collect();
    elimination.eliminate(&positions, 0..degrees);
    let coordinates = elimination.dependent_states();
    for coordinate in coordinates {
        let rate = degrees + coordinate;
        elimination.eliminate(&all, rate..rate + 1);
    }
    elimination.eliminate(&all, degrees..2 * degrees);
    elimination.eliminate(&all, (0..degrees).chain(2 * degrees..states));
    let dependent = elimination.dependent_states();
    let is_free = |state: &usize| !dependent.contains(state);
    let (moving, others): (Vec<usize>, Vec<usize>) = (0..degrees)
        .filter(is_free)
        .partition(|state| is_free(&(degrees + state)));
    let rates = moving.iter().map(|state| degrees + state);
    let independent = moving.iter().copied().chain(rates).chain(others);
    let independent: Vec<usize> = independent
        .chain((2 * degrees..states).filter(is_free))
        .collect();
    IndependentStates {
        basis: elimination.solve_for(&independent),
        degrees: moving.len(),
        states: independent,
    }
}

/// Gauss-Jordan elimination of scaled constraints.
struct Elimination {
    /// Scaled constraints, reduced by the pivots so far.
    matrix: DMatrix<f64>,
    /// Row and column of each pivot.
    pivots: Vec<(usize, usize)>,
}

impl Elimination {
    fn new(held: &DMatrix<f64>) -> Self {
        Self {
            matrix: equilibrate_rows(held.clone()),
            pivots: Vec::new(),
        }
    }

    /// Eliminates columns by the largest pivots of rows without a pivot, until no pivot exceeds rounding.
    fn eliminate(&mut self, rows: &[usize], columns: impl Iterator<Item = usize>) {
        let columns: Vec<usize> = columns.collect();
        loop {
            let is_unused = |row: &&usize| self.pivots.iter().all(|(used, _)| used != *row);
            let free = rows.iter().filter(is_unused);
            let entries = free.flat_map(|row| columns.iter().map(|column| (*row, *column)));
            let size = |(row, column): &(usize, usize)| self.matrix[(*row, *column)].abs();
            let best = entries.max_by(|a, b| size(a).total_cmp(&size(b)));
            let Some(pivot) = best.filter(|entry| size(entry) > MAX_DEPENDENT_REMAINDER) else {
                return;
            };
            self.eliminate_column(pivot);
        }
    }

    fn eliminate_column(&mut self, (row, column): (usize, usize)) {
        let reduced = self.matrix.row(row) / self.matrix[(row, column)];
        for other in 0..self.matrix.nrows() {
            let factor = self.matrix[(other, column)];
            if other != row && factor != 0.0 {
                let mut changed = self.matrix.row_mut(other);
                changed -= factor * &reduced;
                changed[column] = 0.0;
            }
        }
        self.matrix.set_row(row, &reduced);
        self.pivots.push((row, column));
    }

    fn dependent_states(&self) -> Vec<usize> {
        self.pivots.iter().map(|(_, column)| *column).collect()
    }

    /// Returns the matrix from the independent states to all states.
    fn solve_for(&self, independent: &[usize]) -> DMatrix<f64> {
        let mut basis = DMatrix::zeros(self.matrix.ncols(), independent.len());
        for (index, state) in independent.iter().enumerate() {
            basis[(*state, index)] = 1.0;
            for (row, column) in &self.pivots {
                basis[(*column, index)] = -self.matrix[(*row, *state)];
            }
        }
        basis
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_without_constraint_are_independent() {
        // y_1 = 2 y_0 and y_0 = 0, with their rates. Rounding adds the free coordinate x.
        let held = [
            [1e-17, 2.0, -1.0, 0.0, 0.0, 0.0],
            [-1e-16, 5.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 1e-17, 2.0, -1.0],
            [0.0, 0.0, 0.0, -1e-16, 5.0, 0.0],
        ];
        let held = DMatrix::from_row_slice(4, 6, held.as_flattened());
        let found = independent_states(&held, 3);
        assert_eq!((&found.states[..], found.degrees), (&[0, 3][..], 1));
        assert!((&held * &found.basis).amax() < 1e-16);
    }

    #[test]
    fn rates_of_dependent_coordinates_are_dependent() {
        // Motion in the direction of 45 degrees on a ring: both coordinates can be the independent one.
        let held = [[1.0, 1.0, 0.0, 0.0], [1e-17, 0.0, 1.0, 1.0 + 1e-15]];
        let held = DMatrix::from_row_slice(2, 4, held.as_flattened());
        let found = independent_states(&held, 2);
        assert_eq!(found.degrees, 1);
        assert_eq!(found.states[1], found.states[0] + 2);
        assert!((&held * &found.basis).amax() < 1e-16);
    }

    #[test]
    fn coordinate_with_a_prescribed_rate_is_an_independent_state_without_rate() {
        // A knife edge: y' = 3 phi, and the redundant constraint 2 y' = 6 phi.
        let held = [[0.0, -3.0, 1.0, 0.0], [0.0, -6.0 - 1e-11, 2.0, 0.0]];
        let held = DMatrix::from_row_slice(2, 4, held.as_flattened());
        let found = independent_states(&held, 2);
        assert_eq!((&found.states[..], found.degrees), (&[1, 3, 0][..], 1));
        assert!((found.basis[(2, 0)] - 3.0).abs() < 1e-11);
    }
}
