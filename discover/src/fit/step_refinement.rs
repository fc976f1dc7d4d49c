//! Errors of the outputs due to fixed steps, and their removal from a fit by defect correction
//! (Stetter 1978). Simulations and derivatives keep their steps, and the measurements of each
//! window are shifted by the error of its outputs.

use eomgen_records::windows::Windows;

use crate::fit::gauss_newton::Estimate;
use crate::fit::shooting::Shooting;
use crate::model::estimation_model::EstimationModel;
use crate::thresholds;

/// Errors of the fixed steps of a model at an estimate.
pub(crate) struct StepErrors {
    /// Extrapolated outputs for infinitely short steps minus the outputs, in standard deviations of
    /// the noise. For each window: one row per sample, one number per channel. Empty if a
    /// simulation failed.
    pub corrections: Vec<Vec<f64>>,
    /// Model with steps whose RMS error is below [`thresholds::MAX_STEP_ERROR`]; `None` if the
    /// present steps are short enough.
    pub refined: Option<EstimationModel>,
}

/// Outputs of a model for one step size, as residuals of each window.
struct StepOutputs {
    model: Option<EstimationModel>,
    outputs: Vec<Vec<f64>>,
}

/// Computes the errors of the fixed steps at an estimate by Richardson extrapolation. `None` if no
/// estimate is shifted by more than [`thresholds::MAX_SUMMED_STEP_ERROR`], or if the extrapolation
/// does not converge.
pub(crate) fn compute_step_errors(
    shooting: &Shooting<'_>,
    estimate: &Estimate,
) -> Option<StepErrors> {
    let run = |model: &EstimationModel| -> Vec<Vec<f64>> {
        let shooting = Shooting { model, ..*shooting };
        let residuals = shooting.compute_residuals(&estimate.theta, &estimate.initial_states);
        let values = residuals
            .into_iter()
            .map(|of| of.map_or_else(Vec::new, |of| of.values));
        values.collect()
    };
    let gain = shooting.model.step_error_ratio();
    let mut finer = shooting.model.with_halved_steps();
    finer.as_ref()?;
    let mut runs = vec![StepOutputs {
        model: None,
        outputs: run(shooting.model),
    }];
    let mut limit: Option<Vec<Vec<f64>>> = None;
    let mut change = f64::INFINITY;
    while let Some(model) = finer {
        let coarse = &runs[runs.len() - 1].outputs;
        let fine = run(&model);
        let extrapolated = combine(&fine, coarse, |fine, coarse| fine + (fine - coarse) / gain);
        let before = limit.as_ref().unwrap_or(&runs[0].outputs);
        let next = compute_root_of_squares(&combine(&extrapolated, before, |new, old| new - old));
        let is_falling = next < change;
        finer = model.with_halved_steps();
        runs.push(StepOutputs {
            model: Some(model),
            outputs: fine,
        });
        if next < thresholds::MAX_SUMMED_STEP_ERROR {
            limit.as_ref()?;
            limit = Some(extrapolated);
            break;
        }
        if !is_falling {
            return None;
        }
        (limit, change) = (Some(extrapolated), next);
    }
    let limit = limit?;
    let numbers: usize = limit.iter().map(Vec::len).sum();
    let largest = thresholds::MAX_STEP_ERROR * (numbers as f64).sqrt();
    let corrections = combine(&limit, &runs[0].outputs, |right, own| right - own);
    let is_close = |run: &StepOutputs| {
        compute_root_of_squares(&combine(&limit, &run.outputs, |a, b| a - b)) < largest
    };
    let refined = runs.into_iter().find(is_close).and_then(|run| run.model);
    Some(StepErrors {
        corrections,
        refined,
    })
}

/// Returns windows with shifted measurements. Their residuals equal those of a simulation with
/// short steps.
pub(crate) fn shift_measurements<'d>(
    windows: &Windows<'d>,
    noise: &[f64],
    corrections: &[Vec<f64>],
) -> Windows<'d> {
    let mut shifted = windows.clone();
    for (window, corrections) in shifted.windows.iter_mut().zip(corrections) {
        let numbers = window.measured.iter_mut().zip(corrections).enumerate();
        for (number, (measured, correction)) in numbers {
            *measured -= correction * noise[number % noise.len()];
        }
    }
    shifted
}

/// Combines the values of two sets of windows element by element. A window that is missing in one
/// of them becomes empty.
pub(crate) fn combine(
    a: &[Vec<f64>],
    b: &[Vec<f64>],
    of: impl Fn(f64, f64) -> f64,
) -> Vec<Vec<f64>> {
    let windows = a.iter().zip(b);
    let pairs = windows.map(|(a, b)| a.iter().zip(b).map(|(a, b)| of(*a, *b)).collect());
    pairs.collect()
}

/// Returns the root of the sum of squares.
pub(crate) fn compute_root_of_squares(windows: &[Vec<f64>]) -> f64 {
    windows.iter().flatten().map(|x| x * x).sum::<f64>().sqrt()
}
