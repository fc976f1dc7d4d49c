//! Separation of a rival model: its residual after a fit to the prediction of another model and to
//! the existing records. The fit removes differences due to initial states or to unknowns that the
//! records do not determine. Criterion of T-optimal designs (Atkinson and Fedorov, Biometrika 62,
//! 1975), with the information of the records.

use nalgebra::{DMatrix, DVector};

use eomgen_records::windows::{Windows, compared_samples};

use crate::experiment::prediction::Prediction;
use crate::fit::bounded_least_squares::solve_least_squares;
use crate::fit::fit_result::Fit;
use crate::fit::gauss_newton::{
    Estimate, apply_fraction, compute_derivatives, eliminate_initial_states, evaluate_cost,
    follow_unknowns,
};
use crate::fit::information::compute_fit_information;
use crate::fit::initial_states::prior_from_states;
use crate::fit::prior::InitialStatePrior;
use crate::fit::residuals::Residuals;
use crate::fit::shooting::Shooting;
use crate::fit::variable_projection::{ReducedBlock, compute_triangular_factor};
use crate::interval::Interval;
use crate::model::estimation_model::EstimationModel;
use crate::model::problem::EstimationProblem;
use crate::model::unknowns::Unknown;
use crate::thresholds;

/// Fit of a model that may imitate the prediction of another model.
pub struct Rival<'f> {
    /// Fit to the records.
    pub fit: &'f Fit,
    /// Triangular factor of the information on the unknowns.
    information: DMatrix<f64>,
    /// Unknowns; their priors are contained in the information.
    unknowns: Vec<Unknown>,
}

/// Residual of a rival after a fit to a prediction.
#[derive(Clone, Debug, PartialEq)]
pub struct Separation {
    /// RMS residual of the channel with the largest residual, in standard deviations of its noise.
    pub rms_in_noise: f64,
    /// Index of this channel.
    pub channel: usize,
    /// Sensor outputs of the rival, one column per channel; NaN at samples that are not compared.
    pub sensor_outputs: Vec<Vec<f64>>,
}

impl<'f> Rival<'f> {
    /// Creates a rival with the information of the records of its fit.
    pub fn with_records(problem: &EstimationProblem<'_>, fit: &'f Fit) -> Self {
        Self::with_information(fit, compute_fit_information(problem, fit))
    }

    /// Creates a rival with the declared priors only, because a large effect would have changed the
    /// information of the records.
    pub fn with_priors(fit: &'f Fit) -> Self {
        let sd = |unknown: &Unknown| unknown.prior.map_or(f64::INFINITY, |prior| prior.sd);
        let weights = fit.unknowns.iter().map(|unknown| 1.0 / sd(unknown));
        let weights = DVector::from_iterator(fit.unknowns.len(), weights);
        Self::with_information(fit, DMatrix::from_diagonal(&weights))
    }

    fn with_information(fit: &'f Fit, information: DMatrix<f64>) -> Self {
        let without_prior = |unknown: &Unknown| Unknown {
            prior: None,
            ..unknown.clone()
        };
        Self {
            fit,
            information,
            unknowns: fit.unknowns.iter().map(without_prior).collect(),
        }
    }

    /// Returns the RMS over all channels of the difference from the prediction of the model
    /// `truth`, before any fit. It is an upper bound on [`Rival::predict_linear_rms`]. `None` if
    /// the motion cannot be simulated.
    pub fn predict_unfitted_rms(
        &self,
        problem: &EstimationProblem<'_>,
        truth: &EstimationModel,
        prediction: &Prediction,
    ) -> Option<f64> {
        self.compute_rms(problem, truth, prediction, |_, _, present| {
            Some(present.squares.iter().sum::<f64>().sqrt())
        })
    }

    /// Returns the RMS over all channels of the residual after a linearised fit to the prediction
    /// of the model `truth`; `None` if the motion cannot be simulated.
    pub fn predict_linear_rms(
        &self,
        problem: &EstimationProblem<'_>,
        truth: &EstimationModel,
        prediction: &Prediction,
    ) -> Option<f64> {
        self.compute_rms(problem, truth, prediction, |shooting, begin, present| {
            let blocks = compute_reduced_blocks(shooting, &begin.prior, present)?;
            let factor = self.compute_factor(&blocks, present);
            let last = factor[(factor.nrows() - 1, factor.ncols() - 1)];
            Some(last.abs())
        })
    }

    /// Returns the RMS over all channels of a residual. `of` computes its norm.
    fn compute_rms(
        &self,
        problem: &EstimationProblem<'_>,
        truth: &EstimationModel,
        prediction: &Prediction,
        of: impl FnOnce(&Shooting<'_>, &WindowInitialStates, &Estimate) -> Option<f64>,
    ) -> Option<f64> {
        let windows = Windows::split_records(&prediction.records, problem.dataset.window);
        let begin = self.map_initial_states(problem, truth, prediction, &windows);
        let shooting = self.create_shooting(problem, &windows, &begin);
        let theta = self.theta().to_vec();
        let present = evaluate_cost(&shooting, &begin.prior, theta, begin.states.clone());
        let left = of(&shooting, &begin, &present)? / windows.measurement_count().sqrt();
        left.is_finite().then_some(left)
    }

    /// Returns the residual after a fit to a prediction and to the rival's records; `None` if the
    /// motion cannot be simulated.
    pub fn compute_separation(
        &self,
        problem: &EstimationProblem<'_>,
        truth: &EstimationModel,
        prediction: &Prediction,
    ) -> Option<Separation> {
        let windows = Windows::split_records(&prediction.records, problem.dataset.window);
        let begin = self.map_initial_states(problem, truth, prediction, &windows);
        let shooting = self.create_shooting(problem, &windows, &begin);
        let fitted = self.fit_windows(&shooting, &begin)?;
        let residuals = Residuals::compute(&shooting, fitted).or_infinite();
        let sizes = residuals.normalised_rms.iter().copied().enumerate();
        let (channel, size) = sizes.max_by(|a, b| a.1.total_cmp(&b.1))?;
        let channels = problem.noise.len();
        let mut seen = vec![vec![f64::NAN; prediction.states.len()]; channels];
        for (window, residual) in windows.windows.iter().zip(&residuals.window_residuals) {
            for sample in compared_samples(window.times.len()) {
                for (channel, noise) in problem.noise.iter().enumerate() {
                    let number = sample * channels + channel;
                    seen[channel][window.first + sample] =
                        window.measured[number] + noise * residual[number];
                }
            }
        }
        size.is_finite().then_some(Separation {
            rms_in_noise: size,
            channel,
            sensor_outputs: seen,
        })
    }

    /// Creates the shooting problem of the rival on the windows of a prediction.
    fn create_shooting<'s>(
        &'s self,
        problem: &'s EstimationProblem<'s>,
        windows: &'s Windows<'s>,
        begin: &'s WindowInitialStates,
    ) -> Shooting<'s> {
        let ranges = &begin.ranges;
        Shooting::new(problem, &self.fit.model, windows, &self.unknowns, ranges)
    }

    fn theta(&self) -> &[f64] {
        &self.fit.train.estimate.theta
    }

    /// Returns the initial states of the windows, taken from the prediction.
    fn map_initial_states(
        &self,
        problem: &EstimationProblem<'_>,
        truth: &EstimationModel,
        prediction: &Prediction,
        windows: &Windows<'_>,
    ) -> WindowInitialStates {
        let model = &self.fit.model;
        let states: Vec<Vec<f64>> = (windows.windows.iter())
            .map(|window| {
                model.clamp_state(model.map_state(truth, &prediction.states[window.first]))
            })
            .collect();
        let count = prediction.states.len() as f64;
        let ranges = self.fit.ranges.iter().enumerate().map(|(state, range)| {
            let name = &model.states[state];
            let own = truth.states.iter().position(|known| known == name);
            let spread = own.map_or(0.0, |own| {
                let column = || prediction.states.iter().map(|state| state[own]);
                let mean = column().sum::<f64>() / count;
                let square = column().map(|x| (x - mean).powi(2)).sum::<f64>() / count;
                square.sqrt()
            });
            range.max(spread)
        });
        let ranges: Vec<f64> = ranges.collect();
        WindowInitialStates {
            prior: prior_from_states(problem, &states, &ranges),
            states,
            ranges,
        }
    }

    /// Fits the unknowns to the windows of a prediction and to the information of the rival's
    /// records.
    fn fit_windows(
        &self,
        shooting: &Shooting<'_>,
        begin: &WindowInitialStates,
    ) -> Option<Estimate> {
        let WindowInitialStates { states, prior, .. } = begin;
        let total = |estimate: &Estimate| {
            estimate.cost + (&self.information * self.compute_deviation(estimate)).norm_squared()
        };
        let mut present = evaluate_cost(shooting, prior, self.theta().to_vec(), states.clone());
        for _ in 0..thresholds::MAX_REFIT_STEPS {
            let blocks = compute_reduced_blocks(shooting, prior, &present)?;
            let factor = self.compute_factor(&blocks, &present);
            let count = self.unknowns.len();
            let bounds: Vec<Interval> = (self.unknowns.iter().zip(&present.theta))
                .map(|(unknown, value)| unknown.bounds.shift_origin_to(*value).extend_to_zero())
                .collect();
            let change = solve_least_squares(
                &factor.columns(0, count).into_owned(),
                &-factor.column(count).into_owned(),
                &bounds,
            );
            let before = total(&present);
            let next = thresholds::REFIT_STEP_FRACTIONS.iter().find_map(|part| {
                let theta = apply_fraction(shooting, &present, &change, *part);
                let next = follow_unknowns(shooting, prior, &present, &blocks, theta);
                (total(&next) < before).then_some(next)
            });
            let Some(next) = next else { break };
            let is_converged =
                total(&next) > (1.0 - thresholds::MIN_GAUSS_NEWTON_DECREASE) * before;
            present = next;
            if is_converged {
                break;
            }
        }
        Some(present)
    }

    /// Returns the unknowns of an estimate minus those of the fit to the records.
    fn compute_deviation(&self, estimate: &Estimate) -> DVector<f64> {
        let pairs = estimate.theta.iter().zip(self.theta());
        DVector::from_iterator(self.unknowns.len(), pairs.map(|(a, b)| a - b))
    }

    /// Returns the triangular factor of [unknowns | residual] from the windows and the information
    /// of the rival's records.
    fn compute_factor(&self, blocks: &[Option<ReducedBlock>], present: &Estimate) -> DMatrix<f64> {
        let count = self.unknowns.len();
        let mut rows = DMatrix::zeros(count, count + 1);
        rows.view_mut((0, 0), (count, count))
            .copy_from(&self.information);
        rows.set_column(
            count,
            &(&self.information * self.compute_deviation(present)),
        );
        let empty = DMatrix::zeros(count + 1, count + 1);
        let factor = compute_triangular_factor(&empty, &rows);
        let windows = blocks.iter().flatten();
        windows.fold(factor, |factor, block| {
            compute_triangular_factor(&factor, &block.reduced_columns())
        })
    }
}

/// Initial states of the rival in the windows of a prediction.
struct WindowInitialStates {
    states: Vec<Vec<f64>>,
    /// Ranges of the states, in the records or in the experiment.
    ranges: Vec<f64>,
    prior: InitialStatePrior,
}

/// Returns the derivatives of each window with its initial state eliminated; `None` if a window
/// cannot be simulated.
fn compute_reduced_blocks(
    shooting: &Shooting<'_>,
    prior: &InitialStatePrior,
    present: &Estimate,
) -> Option<Vec<Option<ReducedBlock>>> {
    let linear = compute_derivatives(shooting, present);
    let blocks = eliminate_initial_states(prior, present, &linear);
    blocks.iter().all(Option::is_some).then_some(blocks)
}
