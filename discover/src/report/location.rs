//! Sentences about the difference between model and records: channel, time, speed and frequency.

use eomgen_records::record::Record;

use crate::fit::fit_result::Fit;
use crate::fit::noise_floor::NoiseFloor;
use crate::fit::residual_spectrum::{SpectralLine, SpectralPeak, find_training_peak};
use crate::ids::{ChannelId, WindowId};
use crate::model::problem::EstimationProblem;
use crate::model::smoothing::differentiate_column;
use crate::report::quantity::{format_number, format_quantity};
use crate::report::remaining_gap::format_floors;
use crate::residual_force::types::ResidualForce;
use crate::residual_force::wording::describe_residual_force;
use crate::thresholds;

/// Returns the sentences. The first names the equation of the residual force, if it was estimated.
pub fn describe_location(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    floor: &NoiseFloor,
    force: Option<&ResidualForce>,
) -> String {
    let channel = describe_channel(problem, fit, floor);
    match force {
        Some(force) => format!("{} {channel}", describe_residual_force(force)),
        None => channel,
    }
}

/// Describes the channel with the largest difference, with time, speed and frequency.
fn describe_channel(problem: &EstimationProblem<'_>, fit: &Fit, floor: &NoiseFloor) -> String {
    let count = problem.noise.len();
    let in_floors: Vec<f64> = fit
        .train
        .channel_rms
        .iter()
        .zip(&floor.channels)
        .map(|(gap, floor)| gap / floor)
        .collect();
    let Some(worst) =
        ChannelId::first(count).max_by(|a, b| in_floors[*a].total_cmp(&in_floors[*b]))
    else {
        return String::new();
    };
    let channel = &problem.dataset.channels[worst];
    let tested = fit.test.channel_rms[worst];
    let mut text = format!(
        "The residual of the training records is largest in {}: {} or {} noise floors; that of the test records is \
         {} or {} noise floors.",
        channel.name,
        format_quantity(fit.train.channel_rms[worst], 3, &channel.unit),
        format_floors(in_floors[worst]),
        format_quantity(tested, 3, &channel.unit),
        format_floors(tested / floor.channels[worst])
    );
    if let Some(worst) = find_worst_window(problem, fit) {
        let window = &problem.train.windows[worst];
        let record = &problem.train.records[window.record];
        text += &format!(
            " It is largest from {:.3} s to {:.3} s of the {}.",
            record.origin + window.times[0],
            record.origin + window.times[window.times.len() - 1],
            describe_record(record)
        );
    }
    if let Some(more) = describe_speed_dependence(problem, fit, worst) {
        text += &more;
    }
    match find_training_peak(problem, fit, worst) {
        Some(SpectralPeak::Line(line)) => {
            text += &format!(
                " Its spectrum has a peak at {} Hz; the windows separate frequencies {} Hz apart.",
                format_to_resolution(line),
                format_number(line.resolution, 2)
            );
        }
        Some(SpectralPeak::BelowResolution) => {
            text += " Most of it has frequencies below three periods per window.";
        }
        None => {}
    }
    text
}

/// Describes a record for a reader: `training record 1`, with its file.
pub(crate) fn describe_record(record: &Record) -> String {
    let path = &record.path;
    let file = path.file_name().unwrap_or(path.as_os_str());
    let number = |list: &str| {
        let index = record.name.strip_prefix(list)?.strip_suffix(']')?;
        index.parse::<usize>().ok().map(|index| index + 1)
    };
    let name = match (number("train["), number("test[")) {
        (Some(number), _) => format!("training record {number}"),
        (_, Some(number)) => format!("held-out record {number}"),
        _ => record.name.clone(),
    };
    format!("{name} (`{}`)", file.to_string_lossy())
}

/// Formats the frequency of a line with a tenth of the resolution as the last decimal.
fn format_to_resolution(line: SpectralLine) -> String {
    let decimals = (1.0 - line.resolution.log10()).ceil().clamp(0.0, 9.0) as usize;
    format!("{:.decimals$}", line.frequency)
}

/// Returns the training window with the largest residuals; `None` if there is only one window.
pub(crate) fn find_worst_window(problem: &EstimationProblem<'_>, fit: &Fit) -> Option<WindowId> {
    let squares = &fit.train.estimate.squares;
    let per_sample = |id: WindowId| squares[id] / problem.train.windows[id].times.len() as f64;
    let windows = WindowId::first(squares.len()).filter(|_| squares.len() > 1);
    windows.max_by(|a, b| per_sample(*a).total_cmp(&per_sample(*b)))
}

/// Describes whether the residual of a channel depends on its speed.
fn describe_speed_dependence(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    channel: ChannelId,
) -> Option<String> {
    let count = problem.noise.len();
    let mut pairs: Vec<(f64, f64)> = Vec::new();
    for (window, residual) in problem
        .train
        .windows
        .iter()
        .zip(&fit.train.window_residuals)
    {
        let values: Vec<f64> = window
            .measured
            .iter()
            .skip(channel.index())
            .step_by(count)
            .copied()
            .collect();
        let smooth = crate::model::smoothing::smooth_column(&window.times, &values);
        let slopes = differentiate_column(&window.times, &smooth);
        let speed = (slopes.iter().map(|s| s * s).sum::<f64>() / slopes.len() as f64).sqrt();
        let own: Vec<f64> = residual
            .iter()
            .skip(channel.index())
            .step_by(count)
            .copied()
            .collect();
        let size = own.iter().map(|r| r * r).sum::<f64>() / own.len().max(1) as f64;
        pairs.push((speed, size));
    }
    if pairs.len() < 6 {
        return None;
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let third = pairs.len() / 3;
    let mean =
        |part: &[(f64, f64)]| (part.iter().map(|p| p.1).sum::<f64>() / part.len() as f64).sqrt();
    let (slow, fast) = (mean(&pairs[..third]), mean(&pairs[pairs.len() - third..]));
    if fast > thresholds::MIN_SPEED_RATIO * slow {
        Some(format!(
            " It increases with the speed: {:.1} times as large in the fastest third of the windows as in the \
             slowest.",
            fast / slow
        ))
    } else if slow > thresholds::MIN_SPEED_RATIO * fast {
        Some(format!(
            " It decreases with the speed: {:.1} times as large in the slowest third of the windows as in the \
             fastest.",
            slow / fast
        ))
    } else {
        None
    }
}
