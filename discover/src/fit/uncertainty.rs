//! Uncertainty of unknowns for residuals that are white noise of one standard deviation.

use nalgebra::{DMatrix, DVector};

use crate::fit::gauss_newton::Estimate;
use crate::fit::information::compute_information_factor;
use crate::fit::prior::InitialStatePrior;
use crate::fit::sensitivity::WindowDerivatives;
use crate::fit::shooting::Shooting;

/// Standard deviation of an unknown in two parts. Both are infinite if the unknown is not
/// observable.
#[derive(Clone, Copy)]
pub(crate) struct Uncertainty {
    /// Part due to the noise of the records.
    pub from_noise: f64,
    /// Part due to the priors of the unknowns: nuisances may vary within them.
    pub from_priors: f64,
}

impl Uncertainty {
    /// Returns the total standard deviation; the part due to noise is multiplied by `wider`.
    pub fn combine(self, wider: f64) -> f64 {
        (wider * self.from_noise).hypot(self.from_priors)
    }

    /// Returns the larger value of each part.
    fn max(self, other: Self) -> Self {
        Self {
            from_noise: self.from_noise.max(other.from_noise),
            from_priors: self.from_priors.max(other.from_priors),
        }
    }
}

/// Returns the uncertainty of each unknown: the largest over several approximations of the
/// derivatives.
pub(crate) fn compute_uncertainties(
    shooting: &Shooting<'_>,
    prior: &InitialStatePrior,
    found: &Estimate,
    linear: &[Vec<Option<WindowDerivatives>>],
) -> Vec<Uncertainty> {
    let of = |linear: &Vec<_>| compute_for_derivatives(shooting, prior, found, linear);
    let larger = |some: Vec<Uncertainty>, other: Vec<Uncertainty>| {
        let pairs = some.into_iter().zip(other);
        pairs.map(|(some, other)| some.max(other)).collect()
    };
    linear.iter().map(of).reduce(larger).unwrap_or_default()
}

fn compute_for_derivatives(
    shooting: &Shooting<'_>,
    prior: &InitialStatePrior,
    found: &Estimate,
    linear: &[Option<WindowDerivatives>],
) -> Vec<Uncertainty> {
    let factor = compute_information_factor(shooting, prior, &found.initial_states, linear);
    let weights = shooting.unknowns.iter().map(|unknown| {
        let of = |sd: f64| shooting.prior_weight / (sd * sd);
        unknown.prior.map_or(0.0, |prior| of(prior.sd))
    });
    let weights = DVector::from_iterator(factor.ncols(), weights);
    (0..factor.ncols())
        .map(|column| compute_uncertainty(&factor, &weights, column))
        .collect()
}

/// The information of records and priors is `R'R = J'J + P`. An estimate changes by `(R'R)^-1 J'`
/// times the change of the residuals, and by `(R'R)^-1 P` times the error of the prior means. The
/// variances are therefore `(R'R)^-1 - (R'R)^-1 P (R'R)^-1` and `(R'R)^-1 P (R'R)^-1`.
fn compute_uncertainty(
    factor: &DMatrix<f64>,
    weights: &DVector<f64>,
    column: usize,
) -> Uncertainty {
    let unit = DVector::from_fn(factor.ncols(), |row, _| f64::from(u8::from(row == column)));
    let half = factor.transpose().solve_lower_triangular(&unit);
    let covariances = half.as_ref().and_then(|v| factor.solve_upper_triangular(v));
    let (Some(half), Some(covariances)) = (half, covariances) else {
        return Uncertainty {
            from_noise: f64::INFINITY,
            from_priors: f64::INFINITY,
        };
    };
    let by_priors = covariances.component_mul(&covariances).dot(weights);
    Uncertainty {
        from_noise: (half.norm_squared() - by_priors).max(0.0).sqrt(),
        from_priors: by_priors.sqrt(),
    }
}
