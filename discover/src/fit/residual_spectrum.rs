//! The frequency at which a fit's residuals are largest.

use eomgen_analysis::spectrum::{PowerSpectrum, periodogram};

use crate::fit::fitted::Fit;
use crate::ids::ChannelId;
use crate::model::problem::EstimationProblem;
use eomgen_records::samples::typical_step;

/// The frequency at which the residual of the channel that shows most of it is largest, Hz.
pub fn peak_frequency(problem: &EstimationProblem<'_>, fit: &Fit) -> Option<f64> {
    let sizes = &fit.train.normalised_rms;
    let worst = ChannelId::first(sizes.len()).max_by(|a, b| sizes[*a].total_cmp(&sizes[*b]))?;
    frequency(problem, fit, worst)
}

/// The frequency at which the residual's spectrum, summed over windows of one length, is
/// largest, Hz.
pub fn frequency(problem: &EstimationProblem<'_>, fit: &Fit, channel: ChannelId) -> Option<f64> {
    let count = problem.noise.len();
    let length = fit.train.residuals.iter().map(|r| r.len() / count).max()?;
    let step = typical_step(&problem.train.list.first()?.times);
    if length < 8 || step <= 0.0 {
        return None;
    }
    let whole = (fit.train.residuals.iter()).filter(|r| r.len() / count == length);
    let spectra: Vec<PowerSpectrum> = whole
        .map(|residual| {
            let samples = residual.iter().skip(channel.index()).step_by(count);
            periodogram(&samples.copied().collect::<Vec<f64>>(), step)
        })
        .collect::<Result<_, _>>()
        .ok()?;
    let sum = |k: usize| spectra.iter().map(|of| of.density[k]).sum::<f64>();
    let frequencies = &spectra.first()?.frequency;
    let peak = (1..frequencies.len()).max_by(|a, b| sum(*a).total_cmp(&sum(*b)))?;
    Some(frequencies[peak])
}
