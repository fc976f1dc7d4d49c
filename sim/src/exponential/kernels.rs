//! Products of small matrices with vectors, compiled for the widest SIMD registers of the processor.

use crate::registers::dispatch_registers;

/// Number of rows is padded to a multiple of this.
pub const LANES: usize = 8;

/// Matrix stored by columns, each padded with zeros to whole SIMD vectors.
#[derive(Clone, Debug, Default)]
pub struct Columns {
    /// Number of rows with padding.
    pub rows: usize,
    entries: Vec<f64>,
}

impl Columns {
    /// Creates a matrix from its entries.
    pub fn from_entries(rows: usize, columns: usize, entry: impl Fn(usize, usize) -> f64) -> Self {
        let padded = rows.next_multiple_of(LANES);
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

    /// Returns one entry.
    pub fn entry(&self, row: usize, column: usize) -> f64 {
        self.entries[column * self.rows + row]
    }

    /// Adds the product with a vector to `out`, which has [`Columns::rows`] entries.
    pub fn add_product(&self, vector: &[f64], out: &mut [f64]) {
        let (rows, entries) = (self.rows, &self.entries[..]);
        dispatch_registers!(_simd => add_product(entries, rows, vector, out));
    }

    /// Adds the products with many vectors, which are stored consecutively, each with the padding of the rows.
    /// The first `inner` entries of each are used.
    pub fn add_products(&self, inner: usize, vectors: &[f64], out: &mut [f64]) {
        let (rows, entries) = (self.rows, &self.entries[..]);
        dispatch_registers!(_simd => {
            for (vector, out) in vectors.chunks_exact(rows).zip(out.chunks_exact_mut(rows)) {
                add_product(entries, rows, &vector[..inner], out);
            }
        });
    }
}

#[inline(always)]
fn add_product(entries: &[f64], rows: usize, vector: &[f64], out: &mut [f64]) {
    match rows / LANES {
        1 => add_vectors::<1>(entries, vector, out),
        2 => add_vectors::<2>(entries, vector, out),
        3 => add_vectors::<3>(entries, vector, out),
        4 => add_vectors::<4>(entries, vector, out),
        _ => {
            for (column, factor) in entries.chunks_exact(rows).zip(vector) {
                for (slot, entry) in out.iter_mut().zip(column) {
                    *slot += entry * factor;
                }
            }
        }
    }
}

/// Adds a product for this number of SIMD vectors of rows. The sums stay in registers. Even and odd columns
/// have separate sums, so that consecutive additions do not depend on each other.
#[inline(always)]
fn add_vectors<const VECTORS: usize>(entries: &[f64], vector: &[f64], out: &mut [f64]) {
    let (entries, _) = entries.as_chunks::<LANES>();
    let (out, _) = out.as_chunks_mut::<LANES>();
    let mut even = [[0.0; LANES]; VECTORS];
    let mut odd = [[0.0; LANES]; VECTORS];
    even.copy_from_slice(&out[..VECTORS]);
    let (pairs, last) = vector.as_chunks::<2>();
    let mut columns = entries.chunks_exact(2 * VECTORS);
    for (columns, [a, b]) in columns.by_ref().zip(pairs) {
        for vector_of_rows in 0..VECTORS {
            for lane in 0..LANES {
                even[vector_of_rows][lane] += columns[vector_of_rows][lane] * a;
                odd[vector_of_rows][lane] += columns[VECTORS + vector_of_rows][lane] * b;
            }
        }
    }
    if let [factor] = last {
        let first = 2 * VECTORS * pairs.len();
        let column = &entries[first..first + VECTORS];
        for vector_of_rows in 0..VECTORS {
            for lane in 0..LANES {
                even[vector_of_rows][lane] += column[vector_of_rows][lane] * factor;
            }
        }
    }
    for vector_of_rows in 0..VECTORS {
        for lane in 0..LANES {
            out[vector_of_rows][lane] = even[vector_of_rows][lane] + odd[vector_of_rows][lane];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Columns;

    #[test]
    fn products_are_sums_of_columns() {
        for (rows, columns) in [(1, 1), (5, 3), (8, 2), (17, 9)] {
            let entry = |i: usize, j: usize| (3 * i + j * j) as f64 - 4.0;
            let matrix = Columns::from_entries(rows, columns, entry);
            let vector: Vec<f64> = (0..columns).map(|j| j as f64 + 0.5).collect();
            let mut out = vec![1.0; matrix.rows];
            matrix.add_product(&vector, &mut out);
            for (row, found) in out.iter().enumerate().take(rows) {
                let wanted: f64 = (0..columns).map(|j| entry(row, j) * vector[j]).sum();
                // Small integers and halves are exact.
                assert_eq!(*found, 1.0 + wanted);
            }
        }
    }
}
