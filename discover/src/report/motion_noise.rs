//! Noise of the computed torques due to noise of a given motion.

use eomgen_records::dataset::Quantity;
use eomgen_records::noise;

use crate::fit::fit_result::Fit;
use crate::ids::ChannelId;
use crate::model::problem::EstimationProblem;

/// Returns a note for each torque whose computed value along the first training record is noisier
/// than its declared noise. The noise of the motion then dominates the comparison.
pub(crate) fn note_motion_noise(problem: &EstimationProblem<'_>, fit: &Fit) -> Vec<String> {
    let channels = problem.dataset.channels.iter();
    let channels = ChannelId::first(problem.noise.len()).zip(channels);
    let inputs = channels.filter(|(_, channel)| matches!(channel.quantity, Quantity::Input(_)));
    let note = |(id, channel): (ChannelId, &eomgen_records::dataset::Channel)| {
        let found = noise::estimate_noise(&compute_channel(problem, fit, id))?;
        (found > channel.noise).then(|| {
            format!(
                "noise of the motion causes noise of {found:.1e} {unit} in the computed `{}`, and its declared \
                 noise is {:.1e} {unit}: keep fewer samples with `every` in [time], or measure the motion more accurately",
                channel.name,
                channel.noise,
                unit = channel.unit
            )
        })
    };
    inputs.filter_map(note).collect()
}

/// Returns the computed values of a channel along the first training record, SI. NaN for samples
/// that are not compared.
fn compute_channel(problem: &EstimationProblem<'_>, fit: &Fit, channel: ChannelId) -> Vec<f64> {
    let count = problem.noise.len();
    let windows = problem
        .train
        .windows
        .iter()
        .zip(&fit.train.window_residuals);
    let first = windows.filter(|(window, _)| window.record == 0);
    let values = first.flat_map(|(window, residuals)| {
        let pairs = window.measured.iter().zip(residuals);
        let own = pairs.skip(channel.index()).step_by(count);
        // A residual of 0 marks a sample that is not compared; the computed value is unknown.
        own.map(|(measured, residual)| match *residual {
            0.0 => f64::NAN,
            residual => measured + residual * problem.noise[channel.index()],
        })
    });
    values.collect()
}
