//! Comparison of declared noise with the noise of the samples.

use eomgen_records::dataset::Quantity;
use eomgen_records::noise::estimate_noise;

use crate::fit::fit_result::Fit;
use crate::ids::ChannelId;
use crate::model::problem::EstimationProblem;
use crate::report::quantity::format_quantity;
use crate::thresholds;

/// Returns a note for each channel whose residual equals the noise of its samples, if its declared noise is smaller. The
/// residual then exceeds the noise floor although the model is complete.
pub(crate) fn note_declared_noise(problem: &EstimationProblem<'_>, fit: &Fit) -> Vec<String> {
    let channels = ChannelId::first(problem.noise.len()).zip(&problem.dataset.channels);
    let motion = channels.filter(|(_, channel)| !matches!(channel.quantity, Quantity::Input(_)));
    let note = |(id, channel): (ChannelId, &eomgen_records::dataset::Channel)| {
        let residual = fit.train.channel_rms.get(id.index()).copied()?;
        let shown = estimate_record_noise(problem, id)?;
        is_noise_only(residual, shown, channel.noise).then(|| {
            let [residual, shown, declared] = [residual, shown, channel.noise]
                .map(|value| format_quantity(value, 3, &channel.unit));
            format!(
                "the residual of `{}` is {residual} and the noise of its samples {shown}, but its declared noise is \
                 {declared}: the residual is noise and shows no missing effect; declare the noise of the samples",
                channel.name
            )
        })
    };
    motion.filter_map(note).collect()
}

/// Returns true if a residual is as large as the noise of the samples and larger than the declared noise.
fn is_noise_only(residual: f64, shown: f64, declared: f64) -> bool {
    let most = 1.0 + thresholds::MAX_ERROR_OF_NOISE_ESTIMATE;
    residual <= most * shown && residual.min(shown) > most * declared
}

/// Returns the RMS over the training records of the noise estimated from the samples of a channel, SI.
fn estimate_record_noise(problem: &EstimationProblem<'_>, channel: ChannelId) -> Option<f64> {
    let records = problem.dataset.train.iter();
    let noise = records.map(|record| estimate_noise(record.channels.get(channel.index())?));
    let squares = noise.map(|noise| noise.map(|noise| noise * noise));
    let squares: Vec<f64> = squares.collect::<Option<_>>()?;
    Some((squares.iter().sum::<f64>() / squares.len() as f64).sqrt())
}

#[cfg(test)]
mod tests {
    use super::is_noise_only;

    #[test]
    fn residual_is_noise_only_if_it_is_shown_and_not_declared() {
        assert!(is_noise_only(1.43, 1.42, 1.0));
        assert!(!is_noise_only(2.0, 1.42, 1.0));
        assert!(!is_noise_only(1.1, 1.1, 1.0));
        assert!(!is_noise_only(1.43, 1.0, 1.0));
    }
}
