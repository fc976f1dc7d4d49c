//! Orders of periodic effects for a given motion. They follow directly from the residuals of the
//! channels, because no equation is integrated.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use nalgebra::{Matrix3, Vector3};

use crate::fit::fit_result::Fit;
use crate::ids::WindowId;
use crate::model::problem::EstimationProblem;
use crate::thresholds;
use eomgen_records::samples::typical_step;

/// Motion of one angle in all windows.
struct AngleMotion {
    /// Angle at each sample of a window, rad.
    angles: Vec<Vec<f64>>,
    /// Range of the angle over all windows, rad.
    travel: f64,
    /// RMS rate of the angle, rad/s.
    rate: f64,
}

/// Returns for each angle coordinate the orders, in periods per turn, whose waves explain most of
/// the training residuals. The best order is first. Only orders that the motion covers and its
/// samples resolve are tried.
pub(crate) fn find_orders(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
) -> BTreeMap<String, Vec<u32>> {
    let coordinates = &fit.model.specification().coordinates;
    let angles = coordinates.iter().enumerate();
    let angles = angles.filter(|(_, coordinate)| coordinate.unit.text == "rad");
    angles
        .map(|(index, coordinate)| {
            let along = AngleMotion::new(problem, fit, index);
            (
                coordinate.name.clone(),
                along.find_best_orders(problem, fit),
            )
        })
        .collect()
}

impl AngleMotion {
    /// Creates the motion of a coordinate, given by its index.
    fn new(problem: &EstimationProblem<'_>, fit: &Fit, index: usize) -> Self {
        let (inputs, count) = (
            fit.model.specification().inputs.len(),
            fit.model.degrees_of_freedom(),
        );
        let records = problem.train.records.iter();
        let motions = records.map(|record| {
            let rates = record.given_motion_rate(index, count, inputs);
            (record.given_motion(index, inputs), rates)
        });
        let motions: Vec<(Vec<f64>, Vec<f64>)> = motions.collect();
        let (mut angles, mut squares, mut samples) = (Vec::new(), 0.0, 0.0);
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for window in &problem.train.windows {
            let own = window.first..window.first + window.times.len();
            let (all, rates) = &motions[window.record];
            for (angle, rate) in all[own.clone()].iter().zip(&rates[own.clone()]) {
                (low, high) = (f64::min(low, *angle), f64::max(high, *angle));
                squares += rate * rate;
                samples += 1.0;
            }
            angles.push(all[own].to_vec());
        }
        Self {
            angles,
            travel: high - low,
            rate: f64::sqrt(squares / f64::max(samples, 1.0)),
        }
    }

    /// Returns the orders whose waves explain most of the residuals.
    fn find_best_orders(&self, problem: &EstimationProblem<'_>, fit: &Fit) -> Vec<u32> {
        let step = typical_step(&problem.dataset.train[0].times);
        let is_seen = |order: &u32| {
            let order = f64::from(*order);
            order * self.travel >= TAU
                && order * self.rate * step * thresholds::MIN_SAMPLES_PER_PERIOD < TAU
        };
        let orders = (1..=thresholds::MAX_SHAFT_ORDER).filter(is_seen);
        let mut explained: Vec<(f64, u32)> = orders
            .map(|order| (self.compute_explained_squares(problem, fit, order), order))
            .collect();
        explained.sort_by(|a, b| b.0.total_cmp(&a.0));
        explained.truncate(thresholds::MAX_SPECTRUM_ORDERS);
        explained.into_iter().map(|(_, order)| order).collect()
    }

    /// Returns the decrease of the sum of squared residuals of all channels due to a wave.
    fn compute_explained_squares(
        &self,
        problem: &EstimationProblem<'_>,
        fit: &Fit,
        order: u32,
    ) -> f64 {
        let channels = problem.noise.len();
        let of_channel = |channel: usize| {
            let (mut products, mut sums) = (Matrix3::zeros(), Vector3::zeros());
            for (window, angles) in WindowId::first(self.angles.len()).zip(&self.angles) {
                let residuals = fit.train.window_residuals[window].iter().skip(channel);
                let residuals = residuals.step_by(channels);
                for (angle, residual) in angles.iter().zip(residuals) {
                    // Samples that are not compared have a residual of 0.
                    if *residual != 0.0 {
                        let (sine, cosine) = (f64::from(order) * angle).sin_cos();
                        let wave = Vector3::new(1.0, cosine, sine);
                        products += wave * wave.transpose();
                        sums += *residual * wave;
                    }
                }
            }
            let solved = products.cholesky().map(|factor| factor.solve(&sums));
            let constant = sums[0] * sums[0] / products[(0, 0)];
            solved.map_or(0.0, |solved| solved.dot(&sums) - constant)
        };
        (0..channels).map(of_channel).sum()
    }
}
