//! Independent parts of a linearised machine. The cost of one matrix grows with the cube of its size, so
//! separate solutions of the parts are cheaper.

use nalgebra::DMatrix;

pub(crate) struct Part {
    /// Matrix A for the coordinates of the part, their rates and its first-order states.
    pub matrix: DMatrix<f64>,
    /// Rows of C for these states.
    pub constraints: DMatrix<f64>,
    /// Number of coordinates.
    pub degrees: usize,
    /// Indices of the coordinates and first-order states in the machine.
    pub indices: Vec<usize>,
}

/// Returns the parts of d(q, q', z)/dt = A (q, q', z) with C (q, q', z) = 0 that share no entry of
/// A and no row of C, ordered by their first coordinates. `degrees` is the number of coordinates.
pub(crate) fn independent_parts(
    matrix: &DMatrix<f64>,
    held: &DMatrix<f64>,
    degrees: usize,
) -> Vec<Part> {
    let count = matrix.nrows() - degrees;
    // A coordinate and its rate belong to the same part.
    let index = |state: usize| match state < degrees {
        true => state,
        false => state - degrees,
    };
    let mut groups = DisjointSets::new(count);
    for row in 0..matrix.nrows() {
        for column in 0..matrix.nrows() {
            if matrix[(row, column)] != 0.0 {
                groups.join(index(row), index(column));
            }
        }
    }
    let columns_of = |row: usize| (0..held.ncols()).filter(move |at| held[(row, *at)] != 0.0);
    for row in 0..held.nrows() {
        if let Some(first) = columns_of(row).next() {
            columns_of(row).for_each(|column| groups.join(index(first), index(column)));
        }
    }
    let mut rows_of = vec![Vec::new(); count];
    for row in 0..held.nrows() {
        if let Some(first) = columns_of(row).next() {
            rows_of[groups.root(index(first))].push(row);
        }
    }
    let mut parts = Vec::new();
    for (root, places) in groups.members().into_iter().enumerate() {
        if !places.is_empty() {
            parts.push(part(matrix, held, degrees, places, &rows_of[root]));
        }
    }
    parts.sort_by_key(|part| part.indices[0]);
    parts
}

fn part(
    matrix: &DMatrix<f64>,
    held: &DMatrix<f64>,
    degrees: usize,
    places: Vec<usize>,
    rows: &[usize],
) -> Part {
    let of_coordinates = places.partition_point(|index| *index < degrees);
    let (coordinates, first_order) = places.split_at(of_coordinates);
    let rates = coordinates.iter().chain(first_order);
    let states: Vec<usize> = coordinates
        .iter()
        .copied()
        .chain(rates.map(|index| index + degrees))
        .collect();
    Part {
        matrix: DMatrix::from_fn(states.len(), states.len(), |row, column| {
            matrix[(states[row], states[column])]
        }),
        constraints: DMatrix::from_fn(rows.len(), states.len(), |row, column| {
            held[(rows[row], states[column])]
        }),
        degrees: of_coordinates,
        indices: places,
    }
}

/// Disjoint sets of indices (union-find).
struct DisjointSets {
    /// Parent of each index; the root is the smallest index of the set.
    parent: Vec<usize>,
}

impl DisjointSets {
    fn new(count: usize) -> Self {
        Self {
            parent: (0..count).collect(),
        }
    }

    fn root(&mut self, index: usize) -> usize {
        let mut root = index;
        while self.parent[root] != root {
            self.parent[root] = self.parent[self.parent[root]];
            root = self.parent[root];
        }
        root
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.parent[a.max(b)] = a.min(b);
    }

    /// Returns the indices of each set, at the index of its root.
    fn members(&mut self) -> Vec<Vec<usize>> {
        let mut members = vec![Vec::new(); self.parent.len()];
        for index in 0..self.parent.len() {
            members[self.root(index)].push(index);
        }
        members
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns A of undamped masses with springs between the given pairs.
    fn masses(count: usize, springs: &[(usize, usize)]) -> DMatrix<f64> {
        let mut matrix = DMatrix::zeros(2 * count, 2 * count);
        for index in 0..count {
            matrix[(index, count + index)] = 1.0;
        }
        for &(a, b) in springs {
            for (row, column) in [(a, b), (b, a)] {
                matrix[(count + row, row)] -= 1.0;
                matrix[(count + row, column)] += 1.0;
            }
        }
        matrix
    }

    #[test]
    fn unconnected_masses_are_separate_parts() {
        let matrix = masses(4, &[(0, 2)]);
        let parts = independent_parts(&matrix, &DMatrix::zeros(0, 8), 4);
        let places: Vec<&[usize]> = parts.iter().map(|part| &part.indices[..]).collect();
        assert_eq!(places, [&[0, 2][..], &[1], &[3]]);
        assert_eq!(parts[0].matrix, masses(2, &[(0, 1)]));
    }

    #[test]
    fn constrained_coordinates_are_one_part() {
        let mut held = DMatrix::zeros(1, 8);
        (held[(0, 1)], held[(0, 7)]) = (1.0, -1.0);
        let parts = independent_parts(&masses(4, &[(0, 2)]), &held, 4);
        assert_eq!(parts[1].indices, [1, 3]);
        assert_eq!(
            parts[1].constraints,
            DMatrix::from_row_slice(1, 4, &[1.0, 0.0, 0.0, -1.0])
        );
        assert_eq!(parts[0].constraints.nrows(), 0);
    }
}
