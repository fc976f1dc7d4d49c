//! What keeps a symmetric matrix from being positive definite, as a direction: by Cholesky
//! factorisation of the matrix scaled to a unit diagonal, the largest pivot first.

/// What is lost at most, relative to entries of 1, when a matrix of n rows is factorised: n
/// times this.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Parts of a direction smaller than this, relative to its largest, are rounding.
const NEGLIGIBLE: f64 = 1e-6;

/// What is wrong with a mass matrix.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Lack {
    /// A diagonal entry is not positive, or an entry of its row is no number.
    Of(usize, f64),
    /// Rates at which all others are 0 and whose kinetic energy is 0, or negative.
    Along { rates: Vec<f64>, negative: bool },
}

/// What keeps a symmetric matrix, row by row, from being positive definite.
pub(super) fn lack(matrix: &[f64], size: usize) -> Option<Lack> {
    let rows: Vec<&[f64]> = matrix.chunks(size.max(1)).collect();
    for (place, row) in rows.iter().enumerate() {
        if let Some(bad) = row.iter().find(|entry| !entry.is_finite()) {
            return Some(Lack::Of(place, *bad));
        }
        if row[place] <= 0.0 {
            return Some(Lack::Of(place, row[place]));
        }
    }
    let scales: Vec<f64> = (0..size).map(|place| rows[place][place].sqrt()).collect();
    let mut factor = Factor::new(size);
    while let Some(place) = factor.largest_rest() {
        if factor.rest[place] <= ROUNDING * size as f64 {
            let (place, negative) = factor.smallest_rest();
            let direction = factor.null_direction(place);
            let rates = direction
                .iter()
                .zip(&scales)
                .map(|(part, scale)| part / scale);
            return Some(Lack::Along {
                rates: normalised(rates.collect()),
                negative,
            });
        }
        let entry = |row: usize| rows[place][row] / (scales[place] * scales[row]);
        factor.eliminate(place, entry);
    }
    None
}

/// The Cholesky factor of a matrix with a unit diagonal, the largest rest eliminated first.
struct Factor {
    /// RowNodes of the factor, as long as elements are eliminated.
    rows: Vec<Vec<f64>>,
    /// What is left of the diagonal.
    rest: Vec<f64>,
    /// Elements in the order of their elimination.
    order: Vec<usize>,
}

impl Factor {
    fn new(size: usize) -> Self {
        Self {
            rows: vec![Vec::new(); size],
            rest: vec![1.0; size],
            order: Vec::new(),
        }
    }

    fn remaining(&self) -> impl Iterator<Item = usize> {
        (0..self.rest.len()).filter(|place| !self.order.contains(place))
    }

    fn largest_rest(&self) -> Option<usize> {
        self.remaining()
            .max_by(|a, b| self.rest[*a].total_cmp(&self.rest[*b]))
    }

    /// The element with the smallest rest, and whether that is negative beyond rounding.
    fn smallest_rest(&self) -> (usize, bool) {
        let smallest = self
            .remaining()
            .min_by(|a, b| self.rest[*a].total_cmp(&self.rest[*b]))
            .unwrap_or(0);
        let limit = ROUNDING * self.rest.len() as f64;
        (smallest, self.rest[smallest] < -limit)
    }

    fn eliminate(&mut self, place: usize, entry: impl Fn(usize) -> f64) {
        let pivot = self.rest[place].sqrt();
        let own = self.rows[place].clone();
        self.order.push(place);
        self.rows[place].push(pivot);
        for row in 0..self.rest.len() {
            if self.order.contains(&row) {
                continue;
            }
            let known: f64 = own.iter().zip(&self.rows[row]).map(|(a, b)| a * b).sum();
            let element = (entry(row) - known) / pivot;
            self.rows[row].push(element);
            self.rest[row] -= element * element;
        }
    }

    /// The direction in which the element moves and those eliminated follow freely.
    fn null_direction(&self, place: usize) -> Vec<f64> {
        let mut direction = vec![0.0; self.rest.len()];
        direction[place] = 1.0;
        for (step, &row) in self.order.iter().enumerate().rev() {
            let later = &self.order[step + 1..];
            let known: f64 = later
                .iter()
                .map(|&other| self.rows[other][step] * direction[other])
                .sum();
            direction[row] = -(self.rows[place][step] + known) / self.rows[row][step];
        }
        direction
    }
}

/// With 1 as the largest part, and without what is rounding.
fn normalised(rates: Vec<f64>) -> Vec<f64> {
    let largest = rates.iter().fold(
        0.0_f64,
        |most, rate| {
            if rate.abs() > most.abs() { *rate } else { most }
        },
    );
    let scaled = rates.into_iter().map(|rate| rate / largest);
    scaled
        .map(|rate| if rate.abs() < NEGLIGIBLE { 0.0 } else { rate })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn along(matrix: &[f64], size: usize) -> (Vec<f64>, bool) {
        match lack(matrix, size) {
            Some(Lack::Along { rates, negative }) => (rates, negative),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn a_definite_matrix_lacks_nothing_however_its_units_differ() {
        assert_eq!(lack(&[2.0, 1.0, 1.0, 2.0], 2), None);
        assert_eq!(lack(&[1e18, 1.0, 1.0, 1e-16], 2), None);
        assert_eq!(lack(&[1.0, 1.0, 1.0, 1.0 + 1e-10], 2), None);
        assert_eq!(lack(&[], 0), None);
    }

    #[test]
    fn entries_of_the_diagonal_have_to_be_positive_numbers() {
        assert_eq!(lack(&[1.0, 0.0, 0.0, 0.0], 2), Some(Lack::Of(1, 0.0)));
        assert_eq!(lack(&[-3.0], 1), Some(Lack::Of(0, -3.0)));
        assert!(matches!(lack(&[f64::NAN], 1), Some(Lack::Of(0, value)) if value.is_nan()));
    }

    #[test]
    fn a_motion_without_inertia_is_given_by_its_rates() {
        let (rates, negative) = along(&[1.0, 1.0, 1.0, 1.0], 2);
        assert!(!negative && (rates[0] + rates[1]).abs() < 1e-12 && rates[0].abs() == 1.0);
        // (a + 1000 b)^2 + c^2
        let (rates, _) = along(&[1.0, 1000.0, 0.0, 1000.0, 1e6, 0.0, 0.0, 0.0, 1.0], 3);
        assert!(
            (rates[0] / rates[1] + 1000.0).abs() < 1e-9 && rates[2] == 0.0,
            "{rates:?}"
        );
        let (_, negative) = along(&[1.0, 2.0, 2.0, 1.0], 2);
        assert!(negative);
    }
}
