//! Records cut into windows, each simulated from a state of its own. How that state is found
//! is decided elsewhere.

use eomgen_sim::inputs::HeldInputs;

use crate::record::Record;
use crate::samples::typical_step;

/// Samples at a window's beginning and end that sensors which are late, or early, may see from
/// outside of it.
const MARGIN: (usize, usize) = (LONGEST_DELAY as usize, LONGEST_LEAD as usize);

/// The longest delay that a sensor may have, in samples: what a filter of a few samples and a
/// bus make together. So many samples at the beginning of each window cannot be judged.
pub const LONGEST_DELAY: f64 = 8.0;

/// How far a sensor may seem to see ahead, in samples: four standard deviations of its prior.
pub const LONGEST_LEAD: f64 = 2.0;

/// Which of so many samples of a window are compared: not those that a sensor which is late, or
/// early, may see from outside of it, unless these are most of the window.
pub fn judged(samples: usize) -> std::ops::Range<usize> {
    let (begin, end) = MARGIN;
    begin.min(samples / 4)..samples - end.min(samples / 4)
}

/// A window shorter than this part of the wanted length is not used.
const SHORTEST: f64 = 0.5;

/// A part of a record.
#[derive(Clone, Debug)]
pub struct Window {
    /// The record's place in the list.
    pub record: usize,
    /// Its first sample in the record.
    pub first: usize,
    /// The times of its samples, s.
    pub times: Vec<f64>,
    /// What was measured: a row per sample, a number per channel, NaN where missing.
    pub measured: Vec<f64>,
    /// The window that ends where this one begins.
    pub follows: Option<usize>,
}

/// Windows and the records they are cut from.
#[derive(Clone, Debug)]
pub struct Windows<'d> {
    /// The records.
    pub records: &'d [Record],
    /// The windows, record by record, in order of time.
    pub list: Vec<Window>,
}

impl<'d> Windows<'d> {
    /// Cuts records into windows of this length, s, or takes each as one.
    pub fn cut(records: &'d [Record], length: Option<f64>) -> Self {
        let mut list: Vec<Window> = Vec::new();
        for (place, record) in records.iter().enumerate() {
            let begin = record.times[0];
            let mut first = 0;
            let mut previous = None;
            let mut count = 0.0;
            while first < record.times.len() {
                count += 1.0;
                let end = match length {
                    Some(length) => {
                        // Half a sample, so that rounding does not decide.
                        let gap = typical_step(&record.times);
                        let until = begin + count * length - 0.5 * gap;
                        record.times.partition_point(|t| *t < until)
                    }
                    None => record.times.len(),
                };
                let samples = first..end;
                let wanted = length.unwrap_or(0.0);
                first = end;
                if samples.len() < 2 {
                    continue;
                }
                let times = record.times[samples.clone()].to_vec();
                let duration = times[times.len() - 1] - times[0];
                if duration < SHORTEST * wanted {
                    continue;
                }
                let rows = samples.clone();
                let row = |sample: usize| record.channels.iter().map(move |c| c[sample]);
                list.push(Window {
                    record: place,
                    first: samples.start,
                    times,
                    measured: rows.flat_map(row).collect(),
                    follows: previous,
                });
                previous = Some(list.len() - 1);
            }
        }
        Self { records, list }
    }

    /// How many numbers all windows hold, one per sample and channel.
    pub fn numbers(&self) -> f64 {
        let counts = self.list.iter().map(|window| window.measured.len());
        counts.sum::<usize>() as f64
    }

    /// The inputs of a window's record.
    pub fn inputs(&self, window: &Window) -> &HeldInputs {
        &self.records[window.record].inputs
    }
}
