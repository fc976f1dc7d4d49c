//! Linear dependence among vectors by Gram-Schmidt orthogonalisation with pivoting on the longest remainder.

use super::vectors::{dot, norm};

/// Remainder of a vector, with the factors of the combination that produces it.
struct Remainder {
    vector: Vec<f64>,
    parts: Vec<f64>,
    size: f64,
}

impl Remainder {
    fn subtract(&mut self, factor: f64, other: &Self) {
        let entries = self.vector.iter_mut().chain(&mut self.parts);
        for (entry, taken) in entries.zip(other.vector.iter().chain(&other.parts)) {
            *entry -= factor * taken;
        }
        self.size = norm(&self.vector);
    }
}

/// Returns the factors of a linear combination of `rows` with a norm of at most `tolerance`; `None` if the rows are
/// independent. Rows must have norms of about 1; one row of the combination has a factor of about 1.
pub fn find_dependent_combination(rows: &[Vec<f64>], tolerance: f64) -> Option<Vec<f64>> {
    find_dependent_combinations(rows, tolerance).pop()
}

/// Returns the factors of all independent combinations of `rows` with a norm of at most `tolerance`, ordered by their
/// last rows. Rows must have norms of about 1. Each combination has one row that no other combination contains; its
/// factor is about 1.
pub fn find_dependent_combinations(rows: &[Vec<f64>], tolerance: f64) -> Vec<Vec<f64>> {
    let found = find_remainders(rows, tolerance).into_iter();
    found.map(|(_, rest)| rest.parts).collect()
}

/// Returns the indices of the rows that depend linearly on the remaining rows, ascending; the remaining rows are
/// independent.
pub fn find_dependent_rows(rows: &[Vec<f64>], tolerance: f64) -> Vec<usize> {
    let found = find_remainders(rows, tolerance).into_iter();
    found.map(|(index, _)| index).collect()
}

/// Returns the remainders with a norm of at most `tolerance`, each with the index of its row, ascending.
fn find_remainders(rows: &[Vec<f64>], tolerance: f64) -> Vec<(usize, Remainder)> {
    let unit = |index: usize| {
        (0..rows.len())
            .map(|k| f64::from(u8::from(k == index)))
            .collect()
    };
    let mut rests: Vec<(usize, Remainder)> = rows
        .iter()
        .enumerate()
        .map(|(index, row)| {
            let rest = Remainder {
                vector: row.clone(),
                parts: unit(index),
                size: norm(row),
            };
            (index, rest)
        })
        .collect();
    while let Some(longest) =
        (0..rests.len()).max_by(|a, b| rests[*a].1.size.total_cmp(&rests[*b].1.size))
    {
        let size = rests[longest].1.size;
        if size.is_nan() {
            break;
        }
        if size <= tolerance {
            rests.sort_by_key(|(index, _)| *index);
            return rests;
        }
        let (_, mut chosen) = rests.swap_remove(longest);
        for entry in chosen.vector.iter_mut().chain(&mut chosen.parts) {
            *entry /= size;
        }
        // A second pass removes the rounding errors of the first.
        for _ in 0..2 {
            for (_, rest) in &mut rests {
                let along = dot(&rest.vector, &chosen.vector);
                // Rows of constraints on different bodies are orthogonal, because they share no coordinate.
                if along != 0.0 {
                    rest.subtract(along, &chosen);
                }
            }
        }
    }
    Vec::new()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dependent_rows_yield_their_combination_up_to_a_factor() {
        let rows = [
            vec![1.0, 0.0, 0.0],
            vec![0.6, 0.8, 0.0],
            vec![0.0, 1.0, 0.0],
        ];
        let factors = find_dependent_combination(&rows, 1e-9).expect("a combination");
        let last = factors[2];
        assert!((factors[1] / last + 1.25).abs() < 1e-12);
        assert!((factors[0] / last - 0.75).abs() < 1e-12);
        assert_eq!(find_dependent_combination(&rows[..2], 1e-9), None);
    }

    #[test]
    fn each_dependent_row_has_a_combination() {
        let rows = [
            vec![1.0, 0.0, 0.0],
            vec![-1.0, 0.0, 0.0],
            vec![0.0, 1.0, 0.0],
            vec![0.8, 0.6, 0.0],
        ];
        let found = find_dependent_combinations(&rows, 1e-9);
        assert_eq!(found.len(), 2);
        assert_eq!(find_dependent_rows(&rows, 1e-9).len(), 2);
        for parts in found {
            for column in 0..3 {
                let entries = parts.iter().zip(&rows);
                let sum: f64 = entries.map(|(part, row)| part * row[column]).sum();
                assert!(sum.abs() < 1e-12);
            }
        }
    }

    #[test]
    fn zero_row_is_dependent() {
        let rows = [vec![1.0, 0.0], vec![0.0, 0.0]];
        assert_eq!(
            find_dependent_combination(&rows, 1e-9),
            Some(vec![0.0, 1.0])
        );
    }
}
