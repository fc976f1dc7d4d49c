//! Checks of the records. Records that make a result impossible are rejected; records that make it less reliable cause
//! a note. Units are checked in [`crate::dataset`].

use crate::description::Description;

use crate::coverage::{self, MIN_VARIATION_OVER_NOISE};
use crate::dataset::Dataset;
use crate::gaps::describe_missing;
use crate::record::Record;
use crate::refusal::Refusal;
use crate::samples::{MAX_JITTER_FRACTION, round_file_time, span, typical_step};
use crate::windows::{MAX_DELAY_SAMPLES, MAX_LEAD_SAMPLES};
use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics};
use eomgen_model_spec::model::Input;

const MAX_MISSING_FRACTION: f64 = 0.5;

/// Largest range of a channel in standard deviations of its noise. No sensor has such a resolution, so beyond it the
/// unit or the noise is wrong.
const MAX_RANGE_OVER_NOISE: f64 = 1e10;

/// Largest magnitude of an input, SI; its fourth power does not overflow.
const LARGEST_INPUT: f64 = 1e75;

/// Fraction of samples at an extreme value, with equal neighbours, beyond which a channel counts as clipped.
const MAX_CLIPPED_FRACTION: f64 = 0.02;

/// RMS difference of two records, in standard deviations of the noise, below which they count as the same record. Two
/// measurements of the same motion differ by the square root of two.
const MAX_RMS_OVER_NOISE: f64 = 0.3;

/// Minimum range of a channel, in standard deviations, to compare records.
const MIN_RANGE_OVER_NOISE: f64 = 20.0;

/// Number of samples compared first when one record is shifted along another.
const PROBE_COUNT: usize = 16;

/// Checks all records and returns notes, or the first problem.
pub fn check_records(
    dataset: &Dataset,
    description: &Description,
    inputs: &[Input],
) -> Result<Vec<String>, Refusal> {
    let mut notes = Vec::new();
    for record in dataset.train.iter().chain(&dataset.test) {
        notes.extend(describe_uneven_timing(record));
        notes.extend(list_missing_inputs(record, inputs));
        reject_large_inputs(record, inputs)?;
        for (channel, column) in dataset.channels.iter().zip(&record.channels) {
            notes.extend(check_values(record, &channel.name, channel.noise, column)?);
        }
        check_channels_differ(dataset, record)?;
    }
    check_delays(dataset, description)?;
    notes.extend(coverage::check_coverage(dataset, description)?);
    for test in &dataset.test {
        for train in &dataset.train {
            check_records_differ(dataset, train, test)?;
        }
    }
    Ok(notes)
}

fn check_delays(dataset: &Dataset, description: &Description) -> Result<(), Refusal> {
    let step = typical_step(&dataset.train[0].times);
    let channels = description.channels.iter().map(|channel| channel.delay);
    let inputs = description.inputs.iter().map(|input| input.delay);
    for delay in channels.chain(inputs) {
        let Some(mean) = delay.and_then(|delay| delay.mean) else {
            continue;
        };
        let samples = mean.value / step;
        if !(-MAX_LEAD_SAMPLES..=MAX_DELAY_SAMPLES).contains(&samples) {
            let wrong = Diagnostic::error(format!(
                "a delay of {} s is {samples:.1} samples of the records",
                mean.value
            ))
            .with_span(
                mean.span,
                format!(
                    "expected {} to {MAX_DELAY_SAMPLES} samples",
                    -MAX_LEAD_SAMPLES
                ),
            )
            .with_help(
                "shift the column in the record, or keep fewer samples with `every` in [time]",
            );
            return Err(Diagnostics::from_one(description.source.clone(), wrong).into());
        }
    }
    Ok(())
}

fn describe_uneven_timing(record: &Record) -> Option<String> {
    let step = typical_step(&record.times);
    let steps = record.times.windows(2).map(|pair| pair[1] - pair[0]);
    let uneven = steps
        .filter(|s| (s - step).abs() > MAX_JITTER_FRACTION * step)
        .count();
    (uneven > 0).then(|| {
        format!(
            "{}: {uneven} of {} steps differ from {step:.6} s by more than {:.0} %",
            record.name,
            record.times.len() - 1,
            100.0 * MAX_JITTER_FRACTION
        )
    })
}

/// Returns notes on empty cells of held inputs and of prescribed motions.
pub(crate) fn list_missing_inputs(record: &Record, inputs: &[Input]) -> Vec<String> {
    let note = |is_prescribed: bool, replacement: &str| {
        let columns = inputs.iter().zip(&record.input_columns);
        let gaps = columns.filter_map(|(input, column)| {
            let missing = describe_missing((&record.times, record.origin), column)?;
            let is_own = input.is_prescribed() == is_prescribed;
            is_own.then(|| format!("{missing} of `{}`", input.name))
        });
        let gaps: Vec<String> = gaps.collect();
        (!gaps.is_empty()).then(|| {
            format!(
                "{}: missing: {}; {replacement}",
                record.name,
                gaps.join(", ")
            )
        })
    };
    let notes = [
        note(false, "the last known value is held"),
        note(true, "the spline through the other samples is used"),
    ];
    notes.into_iter().flatten().collect()
}

/// Rejects inputs that are so large that their powers overflow.
fn reject_large_inputs(record: &Record, inputs: &[Input]) -> Result<(), Refusal> {
    for (input, column) in inputs.iter().zip(&record.input_columns) {
        let samples = record.times.iter().zip(column);
        if let Some((time, value)) = samples.into_iter().find(|(_, v)| v.abs() > LARGEST_INPUT) {
            let message = format!(
                "input `{}` is {value:e} (SI) at t = {} s: its powers exceed the largest double-precision number, \
                 about 1e308; expected values that the machine can reach",
                input.name,
                round_file_time(record.origin, *time)
            );
            return Err(Refusal::file_error(&record.path, message));
        }
    }
    Ok(())
}

fn check_values(
    record: &Record,
    name: &str,
    noise: f64,
    column: &[f64],
) -> Result<Vec<String>, Refusal> {
    let mut notes = Vec::new();
    let known: Vec<f64> = column.iter().copied().filter(|v| v.is_finite()).collect();
    let missing = column.len() - known.len();
    let refuse = |message: String| Err(Refusal::file_error(&record.path, message));
    if missing as f64 > MAX_MISSING_FRACTION * column.len() as f64 {
        return refuse(format!(
            "channel `{name}`: {missing} of {} samples are missing; expected at most half of them",
            column.len()
        ));
    }
    if let Some(gap) = describe_missing((&record.times, record.origin), column) {
        notes.push(format!(
            "{}: missing, and ignored: {gap} of `{name}`",
            record.name
        ));
    }
    let low = known.iter().copied().fold(f64::INFINITY, f64::min);
    let high = known.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if low == high {
        return refuse(format!(
            "channel `{name}` is {low} throughout: the sensor is dead or the column is wrong; \
             correct `column`, or remove the channel"
        ));
    }
    if (high - low) / noise >= MAX_RANGE_OVER_NOISE {
        return refuse(format!(
            "channel `{name}` ranges from {low:.3e} to {high:.3e} with a noise of {noise:.1e} (SI); no sensor has \
             this resolution: correct its `unit` or its `noise`"
        ));
    }
    if high - low < MIN_VARIATION_OVER_NOISE * noise {
        notes.push(format!(
            "{}: `{name}` varies by less than two standard deviations of its noise",
            record.name
        ));
    }
    for limit in [low, high] {
        let at = known
            .windows(2)
            .filter(|p| p[0] == limit && p[1] == limit)
            .count();
        if at as f64 > MAX_CLIPPED_FRACTION * known.len() as f64 {
            notes.push(format!(
                "{}: `{name}` is exactly {limit} (SI) in {at} samples: the sensor may be saturated; remove the \
                 channel, or exclude that part with `from` and `to`",
                record.name
            ));
        }
    }
    Ok(notes)
}

fn check_channels_differ(dataset: &Dataset, record: &Record) -> Result<(), Refusal> {
    for (a, first) in record.channels.iter().enumerate() {
        for (b, second) in record.channels.iter().enumerate().skip(a + 1) {
            for sign in [1.0, -1.0] {
                let known = |(x, y): &(&f64, &f64)| x.is_finite() && y.is_finite();
                let mut pairs = first.iter().zip(second).filter(known).peekable();
                if pairs.peek().is_some() && pairs.all(|(x, y)| *x == sign * y) {
                    return Err(Refusal::file_error(
                        &record.path,
                        format!(
                            "the channels `{}` and `{}` have the same values except for the sign; give each channel a \
                             different column",
                            dataset.channels[a].name, dataset.channels[b].name
                        ),
                    ));
                }
            }
        }
    }
    Ok(())
}

/// Checks that a test record does not repeat a training record, up to a time shift and the sign.
fn check_records_differ(dataset: &Dataset, train: &Record, test: &Record) -> Result<(), Refusal> {
    let file = |record: &Record| record.path.canonicalize().ok();
    let ends = |record: &Record| (record.times[0], record.times[record.times.len() - 1]);
    let (a, b) = (ends(train), ends(test));
    if file(train).is_some() && file(train) == file(test) && a.0 <= b.1 && b.0 <= a.1 {
        return Err(Refusal::file_error(
            &test.path,
            format!(
                "{} and {} overlap in one file; expected records of different measurements, or parts that do not \
                 overlap",
                test.name, train.name
            ),
        ));
    }
    // The channel with the largest range in units of its noise is compared.
    let deviations = |place: usize| span(&train.channels[place]) / dataset.channels[place].noise;
    let Some(channel) =
        (0..dataset.channels.len()).max_by(|a, b| deviations(*a).total_cmp(&deviations(*b)))
    else {
        return Ok(());
    };
    if deviations(channel) < MIN_RANGE_OVER_NOISE {
        return Ok(());
    }
    let (a, b) = (&train.channels[channel], &test.channels[channel]);
    let noise = dataset.channels[channel].noise;
    let shortest = a.len().min(b.len()) / 2;
    let range = (b.len() - shortest) as isize;
    for lag in -((a.len() - shortest) as isize)..=range {
        for sign in [1.0, -1.0] {
            if is_shifted_copy(a, b, lag, sign, noise) {
                return Err(Refusal::file_error(
                    &test.path,
                    format!(
                        "{} repeats {}{}{}; expected another measurement",
                        test.name,
                        train.name,
                        if lag == 0 {
                            String::new()
                        } else {
                            format!(", {lag} samples later")
                        },
                        if sign < 0.0 {
                            ", with the opposite sign"
                        } else {
                            ""
                        }
                    ),
                ));
            }
        }
    }
    Ok(())
}

/// Returns true if two columns differ by less than the noise after a shift by `lag` samples.
fn is_shifted_copy(a: &[f64], b: &[f64], lag: isize, sign: f64, noise: f64) -> bool {
    let begin = (-lag).max(0) as usize;
    let end = a.len().min((b.len() as isize - lag).max(0) as usize);
    if end <= begin + PROBE_COUNT {
        return false;
    }
    let difference = |place: usize| a[place] - sign * b[(place as isize + lag) as usize];
    let probe = |k: usize| difference(begin + k * (end - begin) / PROBE_COUNT);
    if (0..PROBE_COUNT).any(|k| probe(k).abs() > 2.0 * noise) {
        return false;
    }
    let most = (MAX_RMS_OVER_NOISE * noise).powi(2) * (end - begin) as f64;
    let (mut sum, mut count) = (0.0, 0);
    for difference in (begin..end).map(difference).filter(|d| d.is_finite()) {
        sum += difference * difference;
        count += 1;
        if sum > most {
            return false;
        }
    }
    // The overlap must be long enough, and the values in it must vary.
    let low = a[begin..end].iter().copied().fold(f64::INFINITY, f64::min);
    let high = a[begin..end]
        .iter()
        .copied()
        .fold(f64::NEG_INFINITY, f64::max);
    let moves = high - low > MIN_RANGE_OVER_NOISE * noise;
    moves && 2 * count > end - begin && sum < (MAX_RMS_OVER_NOISE * noise).powi(2) * count as f64
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use eomgen_model_spec::source::Source;
    use eomgen_sim::inputs::HeldInputs;

    use super::{is_shifted_copy, list_missing_inputs};
    use crate::record::Record;

    #[test]
    fn missing_samples_of_inputs_are_named_with_their_time() {
        let text = r#"[model]
name = "stage"
[parameters]
m = { value = 1, unit = "kg" }
k = { value = 1, unit = "N/m" }
[coordinates]
x = { unit = "m" }
[inputs]
u = { unit = "N" }
v = { unit = "N" }
s = { unit = "m", rates = 2 }
[kinetic]
stage = "1/2*m*dot(x)^2"
[forces]
push = { on = "x", value = "u + v + k*s" }
"#;
        let checked = eomgen_model_spec::check(Source::new("stage.toml", text)).expect("a model");
        let notes = |input_columns: &[Vec<f64>]| {
            let record = Record {
                name: "train[0]".to_owned(),
                path: PathBuf::new(),
                times: vec![0.0, 1.0],
                origin: 0.0,
                inputs: HeldInputs::zero(input_columns.len()),
                input_columns: input_columns.to_vec(),
                channels: Vec::new(),
                is_continued: false,
            };
            list_missing_inputs(&record, &checked.model.inputs)
        };
        let (known, missing) = (vec![0.0, 1.0], vec![0.0, f64::NAN]);
        assert_eq!(notes(std::slice::from_ref(&known)), [""; 0]);
        assert_eq!(
            notes(&[known, missing.clone()]),
            ["train[0]: missing: the sample at t = 1 s of `v`; the last known value is held"]
        );
        let all = vec![f64::NAN, f64::NAN];
        assert_eq!(
            notes(&[all, missing.clone(), missing]),
            [
                "train[0]: missing: 2 samples from t = 0 s on of `u`, the sample at t = 1 s of `v`; the last known \
                 value is held",
                "train[0]: missing: the sample at t = 1 s of `s`; the spline through the other samples is used",
            ]
        );
    }

    #[test]
    fn shifted_and_negated_record_is_recognised() {
        let motion: Vec<f64> = (0..500).map(|i| (0.01 * f64::from(i * i)).sin()).collect();
        let later: Vec<f64> = motion[100..].iter().map(|v| -v).collect();
        assert!(is_shifted_copy(&motion, &later, -100, -1.0, 1e-3));
        assert!(!is_shifted_copy(&motion, &later, -99, -1.0, 1e-3));
        assert!(!is_shifted_copy(&motion, &later, -100, 1.0, 1e-3));
    }
}
