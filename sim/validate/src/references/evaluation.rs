//! Value of a hand-written equation with the scale of its rounding error.
//!
//! Two evaluations of the same row agree to a few units in the last place of its largest term, not
//! of its sum.

/// Accelerations in the order of the coordinates, each with a scale.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Evaluation {
    /// Accelerations, in the unit of the coordinate per s^2.
    pub accelerations: Vec<f64>,
    /// Largest term of each row, in the same units.
    pub scales: Vec<f64>,
}

impl Evaluation {
    /// Collects the sums and scales of `rows`.
    pub fn from_rows(rows: impl IntoIterator<Item = Row>) -> Self {
        let mut evaluation = Self::default();
        for row in rows {
            evaluation.accelerations.push(row.sum);
            evaluation.scales.push(row.largest);
        }
        evaluation
    }

    /// Returns the largest deviation of `accelerations`, relative to the scale of its row; infinite
    /// if the lengths differ or a value is NaN.
    pub fn deviation(&self, accelerations: &[f64]) -> f64 {
        if accelerations.len() != self.accelerations.len() {
            return f64::INFINITY;
        }
        let rows = self
            .accelerations
            .iter()
            .zip(&self.scales)
            .zip(accelerations);
        rows.map(|((own, scale), other)| relative(own - other, *scale))
            .fold(0.0, f64::max)
    }
}

/// Returns |difference|/scale: 0 for equal values, infinite if the quotient is NaN.
pub fn relative(difference: f64, scale: f64) -> f64 {
    if difference == 0.0 {
        return 0.0;
    }
    let ratio = (difference / scale).abs();
    if ratio.is_nan() { f64::INFINITY } else { ratio }
}

/// Sum of the terms of a row, with the largest term.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Row {
    sum: f64,
    largest: f64,
}

impl Row {
    /// Creates an empty row.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a term.
    pub fn add(&mut self, term: f64) {
        self.sum += term;
        self.largest = self.largest.max(term.abs());
    }

    /// Returns the sum of the terms.
    pub fn sum(&self) -> f64 {
        self.sum
    }

    /// Returns the largest magnitude of a term.
    pub fn largest(&self) -> f64 {
        self.largest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn deviation_is_relative_to_the_largest_term() {
        let mut row = Row::new();
        row.add(1e6);
        row.add(-1e6);
        row.add(1.0);
        let evaluation = Evaluation::from_rows([row]);
        assert_eq!(evaluation.deviation(&[1.0]), 0.0);
        assert_eq!(evaluation.deviation(&[2.0]), 1e-6);
    }

    #[test]
    fn nan_never_agrees() {
        let evaluation = Evaluation::from_rows([Row::new()]);
        assert_eq!(evaluation.deviation(&[f64::NAN]), f64::INFINITY);
        assert_eq!(evaluation.deviation(&[]), f64::INFINITY);
    }
}
