//! Checks that there is something to compare: windows with samples, and channels that vary by more
//! than their noise. Otherwise the verdict would be that nothing is missing.

use crate::description::Description;
use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics};
use eomgen_model_spec::table::Number;

use crate::dataset::Dataset;
use crate::record::Record;
use crate::refusal::Refusal;
use crate::samples::{span, typical_step};
use crate::windows::{Windows, judged};

const FEWEST_IN_WINDOW: f64 = 4.0;

/// Minimum number of samples of a channel in all windows of a set.
const FEWEST_COMPARED: usize = 10;

/// Range of a channel, in standard deviations of its noise, below which it contains only noise.
pub(crate) const STILL: f64 = 2.0;

pub(crate) fn check(dataset: &Dataset, description: &Description) -> Result<Vec<String>, Refusal> {
    let wrong = |diagnostic: Diagnostic| Diagnostics::one(description.source.clone(), diagnostic);
    let mut notes = Vec::new();
    for (set, records) in [("training", &dataset.train), ("test", &dataset.test)] {
        if let Some(length) = description.windows.length {
            whole_window(length, set, records).map_err(wrong)?;
        }
        notes.extend(compared(dataset, set, records)?);
        moving(dataset, description, set, records).map_err(wrong)?;
    }
    Ok(notes)
}

/// Checks that a record can be split into windows, before it is split at gaps.
pub(crate) fn can_be_cut(record: &Record, description: &Description) -> Result<(), Refusal> {
    let wrong = |diagnostic: Diagnostic| Diagnostics::one(description.source.clone(), diagnostic);
    match description.windows.length {
        Some(length) => {
            long_enough(length, record).map_err(wrong)?;
            holes(length, record)
        }
        None => Ok(()),
    }
}

fn long_enough(length: Number, record: &Record) -> Result<(), Diagnostic> {
    let step = typical_step(&record.times);
    // The small margin prevents a decision by rounding.
    if length.value >= (FEWEST_IN_WINDOW - 1e-6) * step {
        return Ok(());
    }
    Err(Diagnostic::error(format!(
        "a window of {} s contains fewer than {FEWEST_IN_WINDOW} samples of {}",
        length.value, record.name
    ))
    .at(
        length.span,
        format!("its samples are {step:.3e} s apart; expected a longer window, or another unit of [time]"),
    ))
}

/// Checks that a record has at least as many samples as windows.
fn holes(length: Number, record: &Record) -> Result<(), Refusal> {
    let (span, step) = (duration(record), typical_step(&record.times));
    if span / length.value <= record.times.len() as f64 {
        return Ok(());
    }
    Err(Refusal::file(
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

/// Checks that a record of a set is as long as one window, up to the sample after its last.
fn whole_window(length: Number, set: &str, records: &[Record]) -> Result<(), Diagnostic> {
    // The extra half sample prevents a decision by rounding.
    let holds = |record: &Record| duration(record) + 1.5 * typical_step(&record.times);
    if records.iter().any(|record| holds(record) >= length.value) {
        return Ok(());
    }
    let longest = records.iter().map(duration).fold(0.0, f64::max);
    Err(Diagnostic::error(format!(
        "no {set} record is as long as one window of {} s, so there is nothing to compare",
        length.value
    ))
    .at(
        length.span,
        format!("the longest {set} record lasts {longest:.6} s"),
    )
    .help(format!(
        "write a length of at most {longest:.6}, or \"record\" for one window per record"
    )))
}

fn compared(dataset: &Dataset, set: &str, records: &[Record]) -> Result<Vec<String>, Refusal> {
    let windows = Windows::cut(records, dataset.window);
    let count = dataset.channels.len();
    let mut samples = vec![0; count];
    for window in &windows.list {
        for sample in judged(window.times.len()) {
            for (channel, samples) in samples.iter_mut().enumerate() {
                let measured = window.measured[sample * count + channel];
                *samples += usize::from(measured.is_finite());
            }
        }
    }
    for (channel, samples) in dataset.channels.iter().zip(samples) {
        if samples < FEWEST_COMPARED {
            return Err(Refusal::file(
                &records[0].path,
                format!(
                    "channel `{}` has {samples} samples in the windows of all {set} records; expected {FEWEST_COMPARED} or more",
                    channel.name
                ),
            ));
        }
    }
    let is_used = |place: usize| windows.list.iter().any(|window| window.record == place);
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

fn moving(
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
    let Some(place) = most.filter(|place| deviations(*place) < STILL) else {
        return Ok(());
    };
    let entry = &description.channels[place];
    Err(Diagnostic::error(format!(
        "the {set} records contain only noise: no channel varies by {STILL} standard deviations of its noise"
    ))
    .at(
        entry.noise.span,
        format!(
            "`{}` varies by {:.1e} standard deviations",
            entry.name.text,
            deviations(place)
        ),
    )
    .help("write one standard deviation of the sensor's noise, in the column's unit"))
}
