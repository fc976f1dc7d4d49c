//! Products of small matrices with vectors, compiled for the widest registers there are.

use fearless_simd::{Level, dispatch};

/// Rows are filled up to a multiple of this.
const GROUP: usize = 8;

/// A matrix whose columns stand one after the other, filled with zeros to whole groups of rows.
#[derive(Clone, Debug, Default)]
pub struct Columns {
    /// Rows with those that fill up.
    pub rows: usize,
    entries: Vec<f64>,
}

impl Columns {
    /// A matrix from its entries.
    pub fn of(rows: usize, columns: usize, entry: impl Fn(usize, usize) -> f64) -> Self {
        let padded = rows.next_multiple_of(GROUP);
        let mut entries = vec![0.0; padded * columns];
        for column in 0..columns {
            for row in 0..rows {
                entries[column * padded + row] = entry(row, column);
            }
        }
        Self {
            rows: padded,
            entries,
        }
    }

    /// Adds the product with a vector; `out` has as many numbers as there are rows.
    pub fn add_product(&self, vector: &[f64], out: &mut [f64]) {
        let (rows, entries) = (self.rows, &self.entries[..]);
        dispatch!(Level::new(), _simd => add_product(entries, rows, vector, out));
    }

    /// Adds the products with many vectors, which stand one after the other, each filled up as
    /// the rows are, of which the first `inner` numbers count.
    pub fn add_products(&self, inner: usize, vectors: &[f64], out: &mut [f64]) {
        let (rows, entries) = (self.rows, &self.entries[..]);
        dispatch!(Level::new(), _simd => {
            for (vector, out) in vectors.chunks_exact(rows).zip(out.chunks_exact_mut(rows)) {
                add_product(entries, rows, &vector[..inner], out);
            }
        });
    }
}

#[inline(always)]
fn add_product(entries: &[f64], rows: usize, vector: &[f64], out: &mut [f64]) {
    for first in (0..rows).step_by(GROUP) {
        let mut sums = [0.0; GROUP];
        sums.copy_from_slice(&out[first..first + GROUP]);
        for (column, factor) in entries.chunks_exact(rows).zip(vector) {
            let column = &column[first..first + GROUP];
            for (sum, entry) in sums.iter_mut().zip(column) {
                *sum += entry * factor;
            }
        }
        out[first..first + GROUP].copy_from_slice(&sums);
    }
}

#[cfg(test)]
mod tests {
    use super::Columns;

    #[test]
    fn products_are_sums_of_columns() {
        for (rows, columns) in [(1, 1), (5, 3), (8, 2), (17, 9)] {
            let entry = |i: usize, j: usize| (3 * i + j * j) as f64 - 4.0;
            let matrix = Columns::of(rows, columns, entry);
            let vector: Vec<f64> = (0..columns).map(|j| j as f64 + 0.5).collect();
            let mut out = vec![1.0; matrix.rows];
            matrix.add_product(&vector, &mut out);
            for (row, found) in out.iter().enumerate().take(rows) {
                let wanted: f64 = (0..columns).map(|j| entry(row, j) * vector[j]).sum();
                // Small integers and halves: no rounding.
                assert_eq!(*found, 1.0 + wanted);
            }
        }
    }
}
