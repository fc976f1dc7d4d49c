//! Where the model and the records disagree, in plain sentences: which channel, when, at which
//! speed, at which frequency.

use realfft::RealFftPlanner;

use crate::fit::full::Fit;
use crate::model::problem::Setting;
use crate::model::smoothing::sloped;
use crate::residual_force::ResidualForce;
use crate::residual_force::wording::said;

/// A difference between slow and fast motion below this factor is not worth a word.
const WORTH_SAYING: f64 = 1.5;

/// The sentences: the equation in which a force is missing first, where that could be estimated.
pub fn located(setting: &Setting<'_>, fit: &Fit, force: Option<&ResidualForce>) -> String {
    let channel = by_channel(setting, fit);
    match force {
        Some(force) => format!("{} {channel}", said(force)),
        None => channel,
    }
}

/// Which channel shows the difference, when, at which speed and frequency.
fn by_channel(setting: &Setting<'_>, fit: &Fit) -> String {
    let count = setting.noise.len();
    let in_noises: Vec<f64> = fit
        .train
        .channels
        .iter()
        .zip(&setting.noise)
        .map(|(gap, noise)| gap / noise)
        .collect();
    let Some(worst) = (0..count).max_by(|a, b| in_noises[*a].total_cmp(&in_noises[*b])) else {
        return String::new();
    };
    let channel = &setting.dataset.channels[worst];
    let mut text = format!(
        "The difference is largest in {}: {:.3e} {} or {:.1} times its noise.",
        channel.name, fit.train.channels[worst], channel.unit, in_noises[worst]
    );
    let squares = &fit.train.estimate.squares;
    let per_sample = |place: usize| squares[place] / setting.train.list[place].times.len() as f64;
    let windows = 0..squares.len();
    if squares.len() > 1
        && let Some(place) = windows.max_by(|a, b| per_sample(*a).total_cmp(&per_sample(*b)))
    {
        let window = &setting.train.list[place];
        text += &format!(
            " It is worst from {:.3} s to {:.3} s of {}.",
            window.times[0],
            window.times[window.times.len() - 1],
            setting.train.records[window.record].name
        );
    }
    if let Some(more) = by_speed(setting, fit, worst) {
        text += &more;
    }
    if let Some(frequency) = frequency(setting, fit, worst) {
        text += &format!(" Its spectrum is largest at {frequency:.3} Hz.");
    }
    text
}

/// Whether the residual's size follows the channel's speed.
fn by_speed(setting: &Setting<'_>, fit: &Fit, channel: usize) -> Option<String> {
    let count = setting.noise.len();
    let mut pairs: Vec<(f64, f64)> = Vec::new();
    for (window, residual) in setting.train.list.iter().zip(&fit.train.residuals) {
        let values: Vec<f64> = window
            .measured
            .iter()
            .skip(channel)
            .step_by(count)
            .copied()
            .collect();
        let smooth = crate::model::smoothing::smoothed(&window.times, &values);
        let slopes = sloped(&window.times, &smooth);
        let speed = (slopes.iter().map(|s| s * s).sum::<f64>() / slopes.len() as f64).sqrt();
        let own: Vec<f64> = residual
            .iter()
            .skip(channel)
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
    if fast > WORTH_SAYING * slow {
        Some(format!(
            " It grows with the speed: {:.1} times as large in the fastest third of the windows as in the slowest.",
            fast / slow
        ))
    } else if slow > WORTH_SAYING * fast {
        Some(format!(
            " It is larger in slow motion: {:.1} times as large in the slowest third of the windows as in the fastest.",
            slow / fast
        ))
    } else {
        None
    }
}

/// The frequency at which the residual of the channel that shows most of it is largest, Hz.
pub(crate) fn peak_frequency(setting: &Setting<'_>, fit: &Fit) -> Option<f64> {
    let sizes = &fit.train.in_noises;
    let worst = (0..sizes.len()).max_by(|a, b| sizes[*a].total_cmp(&sizes[*b]))?;
    frequency(setting, fit, worst)
}

/// The frequency at which the residual's spectrum, summed over windows of one length, is
/// largest, Hz.
fn frequency(setting: &Setting<'_>, fit: &Fit, channel: usize) -> Option<f64> {
    let count = setting.noise.len();
    let length = fit.train.residuals.iter().map(|r| r.len() / count).max()?;
    let step = eomgen_records::samples::typical_step(&setting.train.list.first()?.times);
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
            .skip(channel)
            .step_by(count)
            .copied()
            .collect();
        let mut spectrum = transform.make_output_vec();
        transform.process(&mut signal, &mut spectrum).ok()?;
        sum.iter_mut()
            .zip(&spectrum)
            .for_each(|(s, c)| *s += c.norm_sqr());
    }
    let place = (1..sum.len()).max_by(|a, b| sum[*a].total_cmp(&sum[*b]))?;
    Some(place as f64 / (length as f64 * step))
}
