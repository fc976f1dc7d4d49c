//! The frequency at which a fit's residuals are largest.

use crate::ids::ChannelId;
use realfft::RealFftPlanner;

use crate::fit::fitted::Fit;
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
    let transform = RealFftPlanner::<f64>::new().plan_fft_forward(length);
    let mut sum = vec![0.0; length / 2 + 1];
    for residual in fit
        .train
        .residuals
        .iter()
        .filter(|r| r.len() / count == length)
    {
        let mut signal: Vec<f64> = residual
            .iter()
            .skip(channel.index())
            .step_by(count)
            .copied()
            .collect();
        let mut spectrum = transform.make_output_vec();
        transform.process(&mut signal, &mut spectrum).ok()?;
        sum.iter_mut()
            .zip(&spectrum)
            .for_each(|(s, c)| *s += c.norm_sqr());
    }
    let peak = (1..sum.len()).max_by(|a, b| sum[*a].total_cmp(&sum[*b]))?;
    Some(peak as f64 / (length as f64 * step))
}
