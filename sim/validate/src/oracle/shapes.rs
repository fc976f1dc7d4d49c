//! Mode shapes of beams from boundary conditions, without the closed formulas of the derivation.
//!
//! The four solutions of phi'''' = z^4 phi have magnitudes of about 1:
//!
//! ```text
//! sin u    cos u    exp(-u)    exp(-(z - u)),    u = z s, s = x/l
//! ```
//!
//! At each end two derivatives are zero. The determinant of these four equations is bisected near a multiple of pi/4 to
//! find z; the null vector is the shape. The phase z s is the multiple times s plus a small remainder. The multiple
//! times s is reduced exactly before it is multiplied by pi.

use crate::double_double::DoubleDouble;
use eomgen_model_spec::model::{Basis, End};
use nalgebra::{Matrix4, SVD, Vector4};
use std::f64::consts::PI;

/// Maximum number of iterations of a singular value decomposition; about ten are usual.
const MAX_SVD_ITERATIONS: usize = 1000;

#[derive(Clone, Copy, Debug)]
pub(super) struct Shape {
    /// Multiple of pi near z, an integer number of quarters.
    half_waves: f64,
    /// Difference of z and that multiple of pi.
    delta: f64,
    /// z = beta_r l.
    root: f64,
    factors: Vector4<f64>,
}

impl Shape {
    /// Returns mode `r` (counted from 1) of a `basis` that has a formula.
    pub fn new(basis: &Basis, r: usize) -> Self {
        match basis {
            Basis::Beam { from, to } => Self::from_boundary_conditions(*from, *to, r),
            _ => Self::from_printed_equations(r),
        }
    }

    /// Returns mode `r` of a beam. For short waves, each end adds a constant phase. The sum determines a multiple of
    /// pi/4, and the root differs from it by less than 1/2.
    fn from_boundary_conditions(from: End, to: End, r: usize) -> Self {
        let phase = |end| match end {
            End::Clamped => 0.25,
            End::Pinned => 0.0,
            End::Free => -0.75,
            End::Guided => -0.5,
        };
        // The roots of the equation include the rigid-body motions, which are not modes of the basis.
        let rigid = f64::from(rigid_motions(from, to));
        let half_waves = r as f64 + rigid + phase(from) + phase(to);
        let determinant = |delta| conditions([from, to], half_waves, delta).determinant();
        let (mut low, mut high) = (-0.5, 0.5);
        let sign = determinant(low).signum();
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if determinant(middle) * sign > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        let delta = 0.5 * (low + high);
        let factors = null_vector(conditions([from, to], half_waves, delta));
        // Normalise the sine's factor to 1, or the cosine's if the start excludes the sine.
        let unit = if from == End::Guided {
            factors.y
        } else {
            factors.x
        };
        Self {
            half_waves,
            delta,
            root: half_waves * PI + delta,
            factors: factors / unit,
        }
    }

    /// Returns the shape of Eq. (18) and (19) of the paper as printed. Eq. (18) is z = (r - 1/2) pi, so cos z = 0 and
    /// sin z = (-1)^(r+1). With the printed sign of Eq. (19) of the paper, (1 + xi)/2 tends to 1 and the growing exp(u)
    /// remains.
    fn from_printed_equations(r: usize) -> Self {
        let half_waves = r as f64 - 0.5;
        let sign = if r.is_multiple_of(2) { -1.0 } else { 1.0 };
        let root = half_waves * PI;
        let decay = (-root).exp();
        let xi = (1.0 + decay * decay) / (2.0 * sign * decay + 1.0 - decay * decay);
        Self {
            half_waves,
            delta: 0.0,
            root,
            factors: Vector4::new(1.0, xi, 0.5 * (1.0 - xi), -0.5 * (1.0 + xi) * root.exp()),
        }
    }

    /// Returns the derivative of phi with respect to s of order `derivative` at `position` in [0, 1].
    pub fn derivative(&self, derivative: u8, position: DoubleDouble) -> f64 {
        let s = position.high;
        let remaining = (1.0 - s) - position.low;
        let solutions = Vector4::from(solutions(
            derivative,
            sine_cosine(self.half_waves, self.delta, position),
            [(-self.root * s).exp(), (-self.root * remaining).exp()],
        ));
        self.factors.dot(&solutions) * self.root.powi(i32::from(derivative))
    }
}

fn rigid_motions(from: End, to: End) -> u8 {
    let translates = |end| matches!(end, End::Free | End::Guided);
    let rotates = |end| matches!(end, End::Free | End::Pinned);
    let translation = translates(from) && translates(to);
    let rotation = rotates(from) && rotates(to) && (from == End::Free || to == End::Free);
    u8::from(translation) + u8::from(rotation)
}

fn conditions(ends: [End; 2], half_waves: f64, delta: f64) -> Matrix4<f64> {
    let decay = (-(half_waves * PI + delta)).exp();
    let one = DoubleDouble::new(1.0);
    let wave = [(0.0, 1.0), sine_cosine(half_waves, delta, one)];
    let exponentials = [[1.0, decay], [decay, 1.0]];
    Matrix4::from_fn(|row, column| {
        let vanishing = match ends[row / 2] {
            End::Clamped => [0, 1],
            End::Pinned => [0, 2],
            End::Free => [2, 3],
            End::Guided => [1, 3],
        };
        solutions(vanishing[row % 2], wave[row / 2], exponentials[row / 2])[column]
    })
}

fn solutions(derivative: u8, (sine, cosine): (f64, f64), exponentials: [f64; 2]) -> [f64; 4] {
    let (of_sine, of_cosine) = match derivative % 4 {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    };
    let parity = if derivative.is_multiple_of(2) {
        1.0
    } else {
        -1.0
    };
    let [decaying, growing] = exponentials;
    [of_sine, of_cosine, parity * decaying, growing]
}

/// Returns the right singular vector of the smallest singular value.
fn null_vector(matrix: Matrix4<f64>) -> Vector4<f64> {
    let decomposed = SVD::try_new(matrix, false, true, 5.0 * f64::EPSILON, MAX_SVD_ITERATIONS);
    let Some(decomposition) = decomposed else {
        return Vector4::zeros();
    };
    let least = decomposition.singular_values.imin();
    decomposition
        .v_t
        .map_or_else(Vector4::zeros, |rows| rows.row(least).transpose())
}

/// Returns sin and cos of z s. Full turns are subtracted exactly, so the error does not increase with r.
fn sine_cosine(half_waves: f64, delta: f64, position: DoubleDouble) -> (f64, f64) {
    let half_turns = DoubleDouble::product(half_waves, position.high);
    let quarter_turns = (2.0 * half_turns.high).round();
    let reduced =
        (half_turns.high - 0.5 * quarter_turns) + (half_turns.low + half_waves * position.low);
    let (sine, cosine) = (PI * reduced + delta * position.high).sin_cos();
    match quarter_turns.rem_euclid(4.0) as u8 {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

#[cfg(test)]
mod tests {
    use super::super::legendre::unit_rule;
    use super::*;

    const ONE: DoubleDouble = DoubleDouble {
        high: 1.0,
        low: 0.0,
    };

    #[test]
    fn first_roots_match_textbook() {
        let roots = [
            1.875_104_068_711_961_2,
            4.694_091_132_974_175,
            7.854_757_438_237_613,
        ];
        for (index, root) in roots.iter().enumerate() {
            let shape = Shape::new(&Basis::CLAMPED_FREE, index + 1);
            assert!((shape.root - root).abs() < 4e-15, "{}", shape.root);
        }
    }

    #[test]
    fn only_exact_shapes_satisfy_boundary_conditions() {
        for r in [1, 2, 3, 12, 64, 128] {
            let shape = Shape::new(&Basis::CLAMPED_FREE, r);
            let clamp = DoubleDouble::new(0.0);
            for (derivative, end) in [(0, clamp), (1, clamp), (2, ONE), (3, ONE)] {
                let scaled = shape.derivative(derivative, end) / shape.root.powi(derivative.into());
                assert!(
                    scaled.abs() < 1e-15,
                    "r = {r}, derivative {derivative}: {scaled}"
                );
            }
        }
        let printed = Shape::new(&Basis::ClampedFreePrinted, 1);
        assert!((printed.derivative(2, ONE) / printed.root.powi(2)).abs() > 1.0);
    }

    #[test]
    fn shapes_are_orthogonal_up_to_highest_order() {
        let rule = unit_rule(4 * 64 + 40);
        for (r, k) in [(1, 2), (1, 64), (63, 64), (30, 41)] {
            let (left, right) = (
                Shape::new(&Basis::CLAMPED_FREE, r),
                Shape::new(&Basis::CLAMPED_FREE, k),
            );
            let product: f64 = rule
                .iter()
                .map(|node| {
                    node.weight
                        * left.derivative(0, node.position)
                        * right.derivative(0, node.position)
                })
                .sum();
            assert!(product.abs() < 1e-15, "modes {r} and {k}: {product}");
        }
    }

    #[test]
    fn first_moment_has_thirteen_digits_at_every_mode() {
        // int_0^1 s phi ds = 2/z^2 in magnitude: phi'''' = z^4 phi integrated by parts.
        let rule = unit_rule(4 * 128 + 40);
        for r in [1, 8, 64, 128] {
            let shape = Shape::new(&Basis::CLAMPED_FREE, r);
            let moment: f64 = rule
                .iter()
                .map(|node| node.weight * node.position.high * shape.derivative(0, node.position))
                .sum();
            let exact = 2.0 * shape.factors.y / shape.root.powi(2);
            // The addends are about 1/552 and the moment is 2/z^2.
            let tolerance = 1e-14_f64.max(2e-17 * shape.root.powi(2));
            assert!(
                (moment / exact + 1.0).abs() < tolerance,
                "r = {r}: {moment} {exact}"
            );
        }
    }
}
