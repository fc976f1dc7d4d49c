//! Checks that records can be compared: windows contain samples, and channels vary by more than their noise. Otherwise
//! the verdict would always be that no effect is missing.

use crate::description::Description;
use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics};
use eomgen_model_spec::quantity::Number;

use crate::dataset::Dataset;
use crate::record::Record;
use crate::refusal::Refusal;
use crate::samples::{span, typical_step};
use crate::windows::{Windows, compared_samples};

const MIN_SAMPLES_PER_WINDOW: f64 = 4.0;

/// Minimum number of samples of a channel in all windows of a set.
const MIN_COMPARED_SAMPLES: usize = 10;

/// Range of a channel, in standard deviations of its noise, below which it contains only noise.
pub(crate) const MIN_VARIATION_OVER_NOISE: f64 = 2.0;

pub(crate) fn check_coverage(
    dataset: &Dataset,
    description: &Description,
) -> Result<Vec<String>, Refusal> {
    let wrong =
        |diagnostic: Diagnostic| Diagnostics::from_one(description.source.clone(), diagnostic);
    let mut notes = Vec::new();
    for (set, records) in [("training", &dataset.train), ("test", &dataset.test)] {
        if let Some(length) = description.windows.length {
            check_window_fits(length, set, records).map_err(wrong)?;
        }
        notes.extend(check_compared_samples(dataset, set, records)?);
        check_motion(dataset, description, set, records).map_err(wrong)?;
    }
    Ok(notes)
}

/// Checks that a record can be split into windows, before it is split at gaps.
pub(crate) fn check_splittable(record: &Record, description: &Description) -> Result<(), Refusal> {
    let wrong =
        |diagnostic: Diagnostic| Diagnostics::from_one(description.source.clone(), diagnostic);
    match description.windows.length {
        Some(length) => {
            check_length(length, record).map_err(wrong)?;
            check_sample_count(length, record)
        }
        None => Ok(()),
    }
}

fn check_length(length: Number, record: &Record) -> Result<(), Diagnostic> {
    let step = typical_step(&record.times);
    // The small margin absorbs rounding errors.
    if length.value >= (MIN_SAMPLES_PER_WINDOW - 1e-6) * step {
        return Ok(());
    }
    Err(Diagnostic::error(format!(
        "a window of {} s contains fewer than {MIN_SAMPLES_PER_WINDOW} samples of {}",
        length.value, record.name
    ))
    .with_span(
        length.span,
        format!("its samples are {step:.3e} s apart; expected a longer window, or another unit in [time]"),
    ))
}

/// Checks that a record has at least as many samples as windows.
fn check_sample_count(length: Number, record: &Record) -> Result<(), Refusal> {
    let (span, step) = (duration(record), typical_step(&record.times));
    if span / length.value <= record.times.len() as f64 {
        return Ok(());
    }
    Err(Refusal::file_error(
        &record.path,
        format!(
            "{} samples span {span:.3e} s: most of the record is missing; expected a sample every {step:.3e} s",
            record.times.len(),
        ),
    ))
}

fn duration(record: &Record) -> f64 {
    record.times[record.times.len() - 1] - record.times[0]
}

/// Checks that some record of a set is as long as one window, including the time up to the sample after its last one.
fn check_window_fits(length: Number, set: &str, records: &[Record]) -> Result<(), Diagnostic> {
    // The extra half sample absorbs rounding errors.
    let holds = |record: &Record| duration(record) + 1.5 * typical_step(&record.times);
    if records.iter().any(|record| holds(record) >= length.value) {
        return Ok(());
    }
    let longest = records.iter().map(duration).fold(0.0, f64::max);
    Err(Diagnostic::error(format!(
        "no {set} record is as long as one window of {} s, so nothing can be compared",
        length.value
    ))
    .with_span(
        length.span,
        format!("the longest {set} record lasts {longest:.6} s"),
    )
    .with_help(format!(
        "write a length of at most {longest:.6}, or \"record\" for one window per record"
    )))
}

fn check_compared_samples(
    dataset: &Dataset,
    set: &str,
    records: &[Record],
) -> Result<Vec<String>, Refusal> {
    let windows = Windows::split_records(records, dataset.window);
    let count = dataset.channels.len();
    let mut samples = vec![0; count];
    for window in &windows.windows {
        for sample in compared_samples(window.times.len()) {
            for (channel, samples) in samples.iter_mut().enumerate() {
                let measured = window.measured[sample * count + channel];
                *samples += usize::from(measured.is_finite());
            }
        }
    }
    for (channel, samples) in dataset.channels.iter().zip(samples) {
        if samples < MIN_COMPARED_SAMPLES {
            return Err(Refusal::file_error(
                &records[0].path,
                format!(
                    "channel `{}` has {samples} samples in the windows of all {set} records; expected \
                     {MIN_COMPARED_SAMPLES} or more",
                    channel.name
                ),
            ));
        }
    }
    let is_used = |place: usize| windows.windows.iter().any(|window| window.record == place);
    let unused = records
        .iter()
        .enumerate()
        .filter(|(place, _)| !is_used(*place));
    Ok(unused
        .map(|(_, record)| {
            format!(
                "{}: the record lasts {:.6} s, less than half a window, and is ignored",
                record.name,
                duration(record)
            )
        })
        .collect())
}

fn check_motion(
    dataset: &Dataset,
    description: &Description,
    set: &str,
    records: &[Record],
) -> Result<(), Diagnostic> {
    let deviations = |place: usize| {
        let noise = dataset.channels[place].noise;
        let spans = records
            .iter()
            .map(|record| span(&record.channels[place]) / noise);
        spans.fold(0.0, f64::max)
    };
    let most = (0..dataset.channels.len()).max_by(|a, b| deviations(*a).total_cmp(&deviations(*b)));
    let Some(place) = most.filter(|place| deviations(*place) < MIN_VARIATION_OVER_NOISE) else {
        return Ok(());
    };
    let entry = &description.channels[place];
    Err(Diagnostic::error(format!(
        "the {set} records contain only noise: no channel varies by {MIN_VARIATION_OVER_NOISE} standard deviations of \
         its noise"
    ))
    .with_span(
        entry.noise.span,
        format!(
            "`{}` varies by {:.1e} standard deviations",
            entry.name.text,
            deviations(place)
        ),
    )
    .with_help("write one standard deviation of the sensor's noise, in the column's unit"))
}
