//! P-value of an effect on held-out records: an exact test on a split sample (Cox, Biometrika 62,
//! 1975). The response of the effect is determined from the training records only. Under the null
//! hypothesis it is therefore independent of the noise of the test records. Initial states and
//! unknowns are projected out. The projection of the residuals on the response then has a Student t
//! distribution, if the noise is white and normal and the model is linear in the projected
//! unknowns. Correlated residuals reduce the effective number of samples.

use nalgebra::{DMatrix, DVector};

use crate::fit::fit_result::Fit;
use crate::fit::gauss_newton::compute_derivatives;
use crate::fit::initial_states::prior_from_states;
use crate::fit::shooting::Shooting;
use crate::fit::variable_projection::StateProjection;
use crate::ids::WindowId;
use crate::model::problem::EstimationProblem;
use crate::search::acceptance::EffectUnknown;

/// Held-out residuals of a fit and their derivatives with respect to its unknowns.
pub struct SplitSampleTest<'f> {
    fit: &'f Fit,
    /// Normalised response of the residuals to each unknown: one row per residual over all windows.
    nuisances: DMatrix<f64>,
    /// Degrees of freedom: number of compared values, minus initial states and unknowns, minus 1.
    freedom: f64,
}

impl<'f> SplitSampleTest<'f> {
    /// Creates the test for a fit without the tested effects; `None` if a simulation fails.
    pub fn from_fit(problem: &EstimationProblem<'_>, fit: &'f Fit) -> Option<Self> {
        let shooting = Shooting {
            windows: &problem.test,
            ..fit.training_shooting(problem)
        };
        let estimate = &fit.test.estimate;
        let linear = compute_derivatives(&shooting, estimate);
        let prior = prior_from_states(problem, &estimate.initial_states, &fit.ranges);
        let count = fit.unknowns.len();
        let rows: usize = fit.test.window_residuals.iter().map(Vec::len).sum();
        let mut nuisances = DMatrix::zeros(rows.max(count), count);
        let mut first = 0;
        for (window, linear) in WindowId::first(linear.len()).zip(&linear) {
            let linear = linear.as_ref()?;
            let start = &estimate.initial_states[window];
            let projection = StateProjection::new(linear, &prior, window, start);
            for column in 0..count {
                let free = projection.project(&linear.by_unknown.column(column).into_owned());
                let mut slot = nuisances.view_mut((first, column), (free.len(), 1));
                slot.copy_from(&free);
            }
            first += linear.residual.len();
        }
        // Normalised columns avoid the loss of small columns to rounding.
        for mut column in nuisances.column_iter_mut() {
            let norm = column.norm();
            if norm > 0.0 {
                column /= norm;
            }
        }
        let all = fit.test.window_residuals.iter().flatten();
        let compared = all.filter(|residual| **residual != 0.0).count();
        let states = prior.sd.len() * linear.len();
        Some(Self {
            fit,
            nuisances,
            freedom: compared as f64 - (states + count + 1) as f64,
        })
    }

    /// Returns the probability that noise produces at least this projection of the residuals on the
    /// response of an effect. Unknowns whose priors the effect removes are not projected out,
    /// because without the effect they are within their bounds. `None` if the response vanishes or
    /// a simulation fails.
    pub fn compute_p_value(&self, with: &Fit, own: &[EffectUnknown]) -> Option<f64> {
        let column = |fit: &Fit| {
            DVector::from_iterator(
                fit.test.window_residuals.iter().map(Vec::len).sum(),
                fit.test.window_residuals.iter().flatten().copied(),
            )
        };
        let (residual, after) = (column(self.fit), column(with));
        if residual.len() != after.len() || self.nuisances.nrows() != residual.len() {
            return None;
        }
        let is_nuisance = |column: &usize| own.iter().all(|own| own.unknown.index() != *column);
        let columns: Vec<usize> = (0..self.nuisances.ncols()).filter(is_nuisance).collect();
        let nuisances = self.nuisances.select_columns(&columns).qr().q();
        let free = |of: &DVector<f64>| of - &nuisances * nuisances.tr_mul(of);
        let own = free(&(&residual - after));
        let residual = free(&residual);
        let size = own.norm();
        let along = residual.dot(&own) / size;
        let rest = (residual.norm_squared() - along * along).max(0.0);
        let correlation = with.test.correlation_length;
        // A correlation over several samples reduces the number of independent samples.
        let t = along / (rest / self.freedom * correlation).sqrt();
        let freedom = self.freedom / correlation;
        let p_value = || compute_student_tail(t, freedom).max(f64::MIN_POSITIVE);
        (size > 0.0 && freedom >= 1.0 && t.is_finite()).then(p_value)
    }
}

/// Returns the probability that a Student t variable exceeds `t`, by a normal approximation
/// (Wallace, Ann. Math. Stat. 30, 1959: within 1 % from ten degrees of freedom on).
fn compute_student_tail(t: f64, freedom: f64) -> f64 {
    let factor = (8.0 * freedom + 1.0) / (8.0 * freedom + 3.0);
    let z = factor * (freedom * (t * t / freedom).ln_1p()).sqrt();
    match t < 0.0 {
        true => 1.0 - compute_normal_tail(z),
        false => compute_normal_tail(z),
    }
}

/// Returns the probability that a standard normal variable exceeds `z`, which must not be negative.
/// Uses a series near 0 and Laplace's continued fraction for larger values.
fn compute_normal_tail(z: f64) -> f64 {
    let density = (-0.5 * z * z).exp() / (2.0 * std::f64::consts::PI).sqrt();
    if z < 3.0 {
        let (mut term, mut sum, mut k) = (z, z, 1.0);
        while term > 1e-17 * sum {
            k += 2.0;
            term *= z * z / k;
            sum += term;
        }
        return 0.5 - density * sum;
    }
    let fraction = (1..=60).rev().fold(z, |below, k| z + f64::from(k) / below);
    density / fraction
}

#[cfg(test)]
mod tests {
    use super::{compute_normal_tail, compute_student_tail};

    #[test]
    fn tail_probabilities_match_tables() {
        for (z, p) in [
            (0.0, 0.5),
            (1.0, 0.158_655_253_931_457),
            (1.959_963_984_540_054, 0.025),
            (3.0, 1.349_898_031_630_095e-3),
            (6.0, 9.865_876_450_376_98e-10),
        ] {
            assert!(
                (compute_normal_tail(z) / p - 1.0).abs() < 1e-9,
                "{z}: {}",
                compute_normal_tail(z)
            );
        }
        for (t, freedom, p) in [
            (1.812, 10.0, 0.05),
            (2.764, 10.0, 0.01),
            (1.660, 100.0, 0.05),
        ] {
            assert!(
                (compute_student_tail(t, freedom) / p - 1.0).abs() < 0.02,
                "{t}"
            );
            assert!(
                (compute_student_tail(-t, freedom) - 1.0 + p).abs() < 0.02 * p,
                "{t}"
            );
        }
    }
}
