//! Whether anything is compared: windows that records hold, samples inside of them, and channels
//! that move by more than noise. A verdict on nothing would be that nothing is missing.

use crate::description::Description;
use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics};
use eomgen_model_spec::table::Number;

use crate::dataset::Dataset;
use crate::record::Record;
use crate::refusal::Refusal;
use crate::samples::{span, typical_step};
use crate::windows::{Windows, judged};

/// A window with fewer samples says nothing of what happens inside it.
const FEWEST_IN_WINDOW: f64 = 4.0;

/// A channel of which fewer samples are compared in all windows of a set is not compared.
const FEWEST_COMPARED: usize = 10;

/// A channel that spans fewer standard deviations of its noise shows noise alone.
pub(crate) const STILL: f64 = 2.0;

/// Checks both sets of records; returns what is worth a remark.
///
/// # Errors
/// Why a set compares nothing.
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

/// A record, before it is parted at what was lost, can be cut into windows.
///
/// # Errors
/// Windows that hold hardly a sample, a record of which most is missing.
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

/// A window holds some samples.
fn long_enough(length: Number, record: &Record) -> Result<(), Diagnostic> {
    let step = typical_step(&record.times);
    // A part of a sample less, so that rounding does not decide.
    if length.value >= (FEWEST_IN_WINDOW - 1e-6) * step {
        return Ok(());
    }
    Err(Diagnostic::error(format!(
        "a window of {} s holds less than {FEWEST_IN_WINDOW} samples of {}",
        length.value, record.name
    ))
    .at(
        length.span,
        format!("its samples are {step:.3e} s apart; expected a longer window, or another unit of [time]"),
    ))
}

/// A record has not many more windows than samples.
fn holes(length: Number, record: &Record) -> Result<(), Refusal> {
    let (span, step) = (duration(record), typical_step(&record.times));
    if span / length.value <= record.times.len() as f64 {
        return Ok(());
    }
    Err(Refusal::file(
        &record.path,
        format!(
            "{} samples span {span:.3e} s: most of the record is missing; expected samples at the pace of {step:.3e} s",
            record.times.len(),
        ),
    ))
}

/// The time from a record's first sample to its last, s.
fn duration(record: &Record) -> f64 {
    record.times[record.times.len() - 1] - record.times[0]
}

/// A record of a set lasts a window or longer, from its first sample to the one after its last.
fn whole_window(length: Number, set: &str, records: &[Record]) -> Result<(), Diagnostic> {
    // Half a sample more, so that rounding does not decide.
    let holds = |record: &Record| duration(record) + 1.5 * typical_step(&record.times);
    if records.iter().any(|record| holds(record) >= length.value) {
        return Ok(());
    }
    let longest = records.iter().map(duration).fold(0.0, f64::max);
    Err(Diagnostic::error(format!(
        "no {set} record lasts one window of {} s: nothing would be compared",
        length.value
    ))
    .at(
        length.span,
        format!("the longest {set} record lasts {longest:.6} s"),
    )
    .help(format!(
        "expected a length of {longest:.6} at most, or \"record\" for one window per record"
    )))
}

/// Every channel is compared in some window of a set; records of which nothing is are noted.
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
                    "channel `{}`: of all {set} records {samples} samples lie inside of windows and are not missing; expected {FEWEST_COMPARED} or more",
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
                "{}: it lasts {:.6} s, less than half a window, and is not used",
                record.name,
                duration(record)
            )
        })
        .collect())
}

/// Some channel shows more than noise in some record of a set.
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
        "the {set} records show nothing but noise: no channel moves by {STILL} standard deviations of its noise"
    ))
    .at(
        entry.noise.span,
        format!(
            "`{}` moves by {:.1e} of these",
            entry.name.text,
            deviations(place)
        ),
    )
    .help("expected one standard deviation of the sensor's noise, in the column's unit"))
}
