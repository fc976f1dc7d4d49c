//! Check for a noise floor that exceeds the recorded motion, so that the comparison cannot show a
//! missing effect.

use crate::fit::noise_floor::NoiseFloor;
use crate::ids::ChannelId;
use crate::model::problem::EstimationProblem;
use crate::report::quantity::format_quantity;
use crate::thresholds;

/// Returns a note for each channel whose noise floor exceeds the standard deviation of its training
/// records. In this case the mean of the record predicts it better than a correct model.
pub(crate) fn note_high_floor(problem: &EstimationProblem<'_>, floor: &NoiseFloor) -> Vec<String> {
    let channels = ChannelId::first(problem.noise.len()).zip(&problem.dataset.channels);
    let note = |(id, channel): (ChannelId, &eomgen_records::dataset::Channel)| {
        let (floor, deviation) = (floor.channels[id], compute_standard_deviation(problem, id));
        let is_noise = floor <= thresholds::MAX_FLOORS_OF_CORRECT_MODEL * channel.noise;
        (floor > deviation && !is_noise).then(|| {
            let [floor, deviation, noise] = [floor, deviation, channel.noise]
                .map(|value| format_quantity(value, 3, &channel.unit));
            format!(
                "the noise floor of `{}` is {floor}, its noise {noise} and the standard deviation of its records \
                 {deviation}: the motion amplifies the noise so much that no missing effect can be shown in this \
                 channel; use a shorter `length` in [windows]",
                channel.name
            )
        })
    };
    channels.filter_map(note).collect()
}

/// Returns the standard deviation of a channel in the training records, relative to the mean of
/// each record, SI.
fn compute_standard_deviation(problem: &EstimationProblem<'_>, channel: ChannelId) -> f64 {
    let (mut squares, mut count) = (0.0, 0.0);
    for record in &problem.dataset.train {
        let column = record.channels[channel].iter().copied();
        let values: Vec<f64> = column.filter(|value| value.is_finite()).collect();
        let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
        squares += values
            .iter()
            .map(|value| (value - mean).powi(2))
            .sum::<f64>();
        count += values.len() as f64;
    }
    f64::sqrt(squares / f64::max(count, 1.0))
}
