//! Transition of a linear system over a step: the exponential of its matrix and the integral of the
//! exponential, by Taylor series with scaling and squaring (Higham, Functions of Matrices, 2008,
//! chapter 10).

use nalgebra::DMatrix;

/// Number of terms of the Taylor series of the integral; its error is below double precision for a
/// norm below 1/2.
const SERIES_TERMS: usize = 12;

/// Maximum number of squarings. For a matrix of a larger norm, the result is not computed.
const MAX_SQUARINGS: u32 = 200;

/// Transition over a step of length h of `x' = J x + b`, with constant b:
/// `x(h) = exponential x(0) + h integral b`.
#[derive(Clone, Debug)]
pub(super) struct Transition {
    /// exp(h J).
    pub exponential: DMatrix<f64>,
    /// Mean of exp(s J) for s from 0 to h.
    pub integral: DMatrix<f64>,
}

impl Transition {
    /// Computes the transition of `h J`; `None` if an entry is not finite.
    pub fn from_step_matrix(step: &DMatrix<f64>) -> Option<Self> {
        let count = step.nrows();
        let rows = step
            .row_iter()
            .map(|row| row.iter().map(|x| x.abs()).sum::<f64>());
        let norm = rows.fold(0.0, |a: f64, b| if b > a || b.is_nan() { b } else { a });
        if !norm.is_finite() {
            return None;
        }
        let halvings = ((2.0 * norm).log2().ceil().max(0.0) as u32).min(MAX_SQUARINGS);
        let small = step / 2f64.powi(halvings as i32);
        let identity = DMatrix::identity(count, count);
        let mut integral = identity.clone();
        for term in (2..=SERIES_TERMS).rev() {
            integral = &identity + &small * integral / term as f64;
        }
        let mut exponential = &identity + &small * &integral;
        for _ in 0..halvings {
            integral = (&exponential + &identity) * integral / 2.0;
            exponential = &exponential * &exponential;
        }
        let is_finite = (exponential.iter().chain(integral.iter())).all(|x| x.is_finite());
        is_finite.then_some(Self {
            exponential,
            integral,
        })
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::Transition;

    #[test]
    fn transition_of_an_oscillator_matches_its_closed_form() {
        for (w, h) in [(3.0, 0.01), (40.0, 0.1), (2000.0, 0.01)] {
            let step = DMatrix::from_row_slice(2, 2, &[0.0, h, -w * w * h, 0.0]);
            let found = Transition::from_step_matrix(&step).unwrap();
            let (s, c) = f64::sin_cos(w * h);
            let exact = [[c, s / w], [-w * s, c]];
            // Mean of exp(s J) for s from 0 to h.
            let mean = [
                [s / (w * h), (1.0 - c) / (w * w * h)],
                [-(1.0 - c) / h, s / (w * h)],
            ];
            for row in 0..2 {
                for column in 0..2 {
                    let size = [1.0, 1.0 / w, w, 1.0][2 * row + column] * 1e-9;
                    let error = found.exponential[(row, column)] - exact[row][column];
                    assert!(error.abs() < size, "{w} {h} {row} {column}: {error}");
                    let error = found.integral[(row, column)] - mean[row][column];
                    assert!(error.abs() < size, "{w} {h} {row} {column}: {error}");
                }
            }
        }
    }

    #[test]
    fn transition_of_a_stiff_damper_ends_at_rest() {
        let found = Transition::from_step_matrix(&DMatrix::from_element(1, 1, -1e9)).unwrap();
        assert!(found.exponential[(0, 0)].abs() < 1e-12);
        assert!((found.integral[(0, 0)] - 1e-9).abs() < 1e-12);
    }
}
