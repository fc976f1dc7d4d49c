//! Lemke's method with lexicographic ties for the modes of contacts (R. W. Cottle, J.-S. Pang, R. E. Stone,
//! *The Linear Complementarity Problem*, chapter 4).
//!
//! The unknowns of a contact are the normal impulse n and, if the direction of slip is unknown, t + mu n and
//! the slip to the left v. Their complements are the rate of the distance, the slip to the right and mu n - t
//! (Glocker and Pfeiffer).

use super::{ContactMode, ContactProblem};

/// Maximum number of pivots per row.
const MAX_PIVOTS_PER_ROW: usize = 50;

/// Entries of the driving column below this fraction of its largest entry are rounding.
const MIN_PIVOT_FRACTION: f64 = 1e-11;

impl ContactProblem {
    /// Returns the modes of a solution; `None` if the method ends on a ray.
    pub(super) fn find_modes_by_lemke(&self) -> Option<Vec<ContactMode>> {
        let count = self.count();
        let full: Vec<usize> = (0..count)
            .filter(|contact| self.friction[*contact].direction.is_none())
            .collect();
        let size = count + 2 * full.len();
        let mut matrix = vec![0.0; size * size];
        let mut right = vec![0.0; size];
        // Rows of a direction: the effects of the normal impulses with their friction, then those of t + mu n.
        let rows = (0..count).map(|contact| (contact, contact));
        let tangents = full.iter().enumerate();
        let rows = rows.chain(tangents.map(|(index, contact)| (count + index, count + contact)));
        for (row, direction) in rows {
            right[row] = self.c[direction];
            for contact in 0..count {
                let side = self.friction[contact].direction.unwrap_or(1.0);
                let ratio = -side * self.scaled_coefficient(contact);
                matrix[row * size + contact] =
                    self.entry(direction, contact) + ratio * self.entry(direction, count + contact);
            }
            for (index, contact) in full.iter().enumerate() {
                matrix[row * size + count + index] = self.entry(direction, count + contact);
            }
        }
        for (index, contact) in full.iter().enumerate() {
            let (to_right, to_left) = (count + index, count + full.len() + index);
            matrix[to_right * size + to_left] = 1.0;
            matrix[to_left * size + contact] = 2.0 * self.scaled_coefficient(*contact);
            matrix[to_left * size + to_right] = -1.0;
        }
        let z = solve_by_lemke(&matrix, &right)?;
        let mode = |contact: usize| {
            if !z[contact] {
                return ContactMode::Open;
            }
            match full.iter().position(|own| *own == contact) {
                None => ContactMode::Slides(self.friction[contact].direction.unwrap_or(0.0)),
                Some(index) if !z[count + index] => ContactMode::Slides(1.0),
                Some(index) if z[count + full.len() + index] => ContactMode::Slides(-1.0),
                Some(_) => ContactMode::Sticks,
            }
        };
        Some((0..count).map(mode).collect())
    }
}

/// Solves z >= 0, w = M z + q >= 0, z w = 0. Returns true for each z that is basic; `None` on a ray.
pub(super) fn solve_by_lemke(matrix: &[f64], q: &[f64]) -> Option<Vec<bool>> {
    let size = q.len();
    if q.iter().all(|entry| *entry >= 0.0) {
        return Some(vec![false; size]);
    }
    // Columns: w, z, the artificial variable, q.
    let width = 2 * size + 2;
    let (artificial, last) = (2 * size, 2 * size + 1);
    let mut table = vec![0.0; size * width];
    for row in 0..size {
        table[row * width + row] = 1.0;
        for column in 0..size {
            table[row * width + size + column] = -matrix[row * size + column];
        }
        table[row * width + artificial] = -1.0;
        table[row * width + last] = q[row];
    }
    let mut basis: Vec<usize> = (0..size).collect();
    let mut leaving_row = (0..size).min_by(|a, b| q[*a].total_cmp(&q[*b]))?;
    let mut entering = artificial;
    for _ in 0..MAX_PIVOTS_PER_ROW * size {
        let left = basis[leaving_row];
        pivot(&mut table, width, (leaving_row, entering));
        basis[leaving_row] = entering;
        if left == artificial {
            let is_basic = |index: usize| basis.contains(&(size + index));
            return Some((0..size).map(is_basic).collect());
        }
        entering = if left < size {
            size + left
        } else {
            left - size
        };
        let column = |row: usize| table[row * width + entering];
        let largest = (0..size).fold(0.0_f64, |most, row| most.max(column(row)));
        let is_positive = |row: &usize| column(*row) > MIN_PIVOT_FRACTION * largest;
        let rows: Vec<usize> = (0..size).filter(is_positive).collect();
        leaving_row = select_lexicographically(&table, width, entering, rows)?;
        // The artificial variable leaves the basis as soon as possible.
        let out = basis.iter().position(|variable| *variable == artificial)?;
        let ratio = |row: usize| table[row * width + last] / table[row * width + entering];
        if is_positive(&out) && ratio(out) <= ratio(leaving_row) {
            leaving_row = out;
        }
    }
    None
}

/// Returns the row with the lexicographically smallest ratio, first of q, then of the columns of w.
fn select_lexicographically(
    table: &[f64],
    width: usize,
    entering: usize,
    mut rows: Vec<usize>,
) -> Option<usize> {
    for column in std::iter::once(width - 1).chain(0..(width - 2) / 2) {
        if rows.len() <= 1 {
            break;
        }
        let ratio = |row: &usize| table[row * width + column] / table[row * width + entering];
        let least = rows.iter().map(ratio).fold(f64::INFINITY, f64::min);
        let size = rows.iter().map(|row| ratio(row).abs());
        let margin = 1e-12 * size.fold(0.0, f64::max);
        rows.retain(|row| ratio(row) <= least + margin);
    }
    rows.first().copied()
}

fn pivot(table: &mut [f64], width: usize, (row, column): (usize, usize)) {
    let divisor = table[row * width + column];
    for entry in &mut table[row * width..(row + 1) * width] {
        *entry /= divisor;
    }
    let own = table[row * width..(row + 1) * width].to_vec();
    for (index, other) in table.chunks_exact_mut(width).enumerate() {
        let factor = other[column];
        if index != row && factor != 0.0 {
            for (entry, own) in other.iter_mut().zip(&own) {
                *entry -= factor * own;
            }
        }
    }
}
