//! Eigenvalues of a balanced matrix, computed for each group of coupled states.
//!
//! The error of a QR iteration is a rounding of the largest entry, which can exceed a slow eigenvalue.
//! Uncoupled groups are therefore solved separately. In a group the fast states come first: the iteration then
//! finds small eigenvalues last, with a relative error of rounding (graded matrices; G. W. Stewart, *Matrix
//! Algorithms II*, 2.3).

use nalgebra::{Complex, DMatrix};

use crate::qr_iteration;

/// Computes the eigenvalues of a balanced square matrix, unsorted. Returns `None` if an iteration does not
/// converge.
pub(crate) fn eigenvalues(matrix: &DMatrix<f64>) -> Option<Vec<Complex<f64>>> {
    let speeds: Vec<f64> = matrix.row_iter().map(|row| row.amax()).collect();
    let mut all = Vec::with_capacity(matrix.nrows());
    for mut group in strongly_connected_groups(&state_dependencies(matrix, &speeds)) {
        group.sort_by(|a, b| speeds[*b].total_cmp(&speeds[*a]));
        let block = DMatrix::from_fn(group.len(), group.len(), |row, column| {
            matrix[(group[row], group[column])]
        });
        all.extend(match block.iter().all(|entry| *entry == 0.0) {
            true => vec![Complex::from(0.0); group.len()],
            false => qr_iteration::eigenvalues(&block)?,
        });
    }
    Some(all)
}

/// Returns, for each state, the states that its rate depends on. Entries below the rounding of both
/// rates are ignored.
fn state_dependencies(matrix: &DMatrix<f64>, speeds: &[f64]) -> Vec<Vec<usize>> {
    let counts = |row: usize, column: usize| {
        matrix[(row, column)].abs() > f64::EPSILON * speeds[row].min(speeds[column])
    };
    let states = 0..matrix.nrows();
    states
        .clone()
        .map(|row| {
            states
                .clone()
                .filter(|column| counts(row, *column))
                .collect()
        })
        .collect()
}

/// Returns the groups of mutually dependent states (strongly connected components, by S. R.
/// Kosaraju's two searches).
fn strongly_connected_groups(depends_on: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let mut needed_by = vec![Vec::new(); depends_on.len()];
    for (state, others) in depends_on.iter().enumerate() {
        for other in others {
            needed_by[*other].push(state);
        }
    }
    let mut seen = vec![false; depends_on.len()];
    let mut order = Vec::with_capacity(depends_on.len());
    for state in 0..depends_on.len() {
        append_reachable(depends_on, state, &mut seen, &mut order);
    }
    seen.fill(false);
    let found = order.into_iter().rev().map(|state| {
        let mut group = Vec::new();
        append_reachable(&needed_by, state, &mut seen, &mut group);
        group
    });
    found.filter(|group| !group.is_empty()).collect()
}

/// Appends all unseen nodes reachable from `state`, each after its successors.
fn append_reachable(
    next: &[Vec<usize>],
    state: usize,
    seen: &mut [bool],
    finished: &mut Vec<usize>,
) {
    if std::mem::replace(&mut seen[state], true) {
        return;
    }
    let mut path = vec![(state, 0)];
    while let Some((state, tried)) = path.last_mut() {
        let state = *state;
        match next[state].get(*tried) {
            Some(&other) => {
                *tried += 1;
                if !std::mem::replace(&mut seen[other], true) {
                    path.push((other, 0));
                }
            }
            None => {
                finished.push(state);
                path.pop();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mutually_dependent_states_form_a_group() {
        // States 0 and 2 depend on each other, 1 depends on 0, and 3 on none.
        let found = strongly_connected_groups(&[vec![2], vec![0], vec![0], vec![]]);
        let mut found: Vec<Vec<usize>> = found
            .into_iter()
            .map(|mut group| {
                group.sort_unstable();
                group
            })
            .collect();
        found.sort();
        assert_eq!(found, [vec![0, 2], vec![1], vec![3]]);
    }
}
