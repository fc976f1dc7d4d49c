//! Windows of records. Each window is simulated from a separate initial state.

use eomgen_sim::inputs::HeldInputs;

use crate::record::Record;
use crate::samples::typical_step;

/// Numbers of samples at the start and at the end of a window. A sensor with a delay or lead reads them from outside
/// the window.
const MARGIN_SAMPLES: (usize, usize) = (MAX_DELAY_SAMPLES as usize, MAX_LEAD_SAMPLES as usize);

/// Largest delay of a sensor, in samples; the same number of samples is ignored at the start of each window.
pub const MAX_DELAY_SAMPLES: f64 = 8.0;

/// Largest lead of a sensor, in samples: four standard deviations of its prior.
pub const MAX_LEAD_SAMPLES: f64 = 2.0;

/// Returns the compared samples of a window: without the margins for delays, unless the margins are most of the window.
pub fn compared_samples(samples: usize) -> std::ops::Range<usize> {
    let (begin, end) = MARGIN_SAMPLES;
    begin.min(samples / 4)..samples - end.min(samples / 4)
}

/// Minimum length of a window, relative to the requested length.
const MIN_RELATIVE_LENGTH: f64 = 0.5;

/// Part of a record.
#[derive(Clone, Debug)]
pub struct Window {
    /// Index of the record.
    pub record: usize,
    /// Index of the window's first sample in the record.
    pub first: usize,
    /// Times of its samples, in s.
    pub times: Vec<f64>,
    /// Measurements, one row per sample and one number per channel; NaN if missing.
    pub measured: Vec<f64>,
    /// Index of the window that ends at the start of this window.
    pub follows: Option<usize>,
}

/// Windows and their records.
#[derive(Clone, Debug)]
pub struct Windows<'d> {
    /// Records that are split.
    pub records: &'d [Record],
    /// Windows, by record and time.
    pub windows: Vec<Window>,
}

impl<'d> Windows<'d> {
    /// Splits records into windows of `length` s, or uses each record as one window.
    pub fn split_records(records: &'d [Record], length: Option<f64>) -> Self {
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
                        // The gap of half a sample absorbs rounding errors.
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
                if duration < MIN_RELATIVE_LENGTH * wanted {
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
        Self {
            records,
            windows: list,
        }
    }

    /// Returns the number of measurements in all windows, including missing ones.
    pub fn measurement_count(&self) -> f64 {
        let counts = self.windows.iter().map(|window| window.measured.len());
        counts.sum::<usize>() as f64
    }

    /// Returns the times of a window as in its file, s.
    pub fn file_times(&self, window: &Window) -> impl Iterator<Item = f64> {
        let origin = self.records[window.record].origin;
        window.times.iter().map(move |t| origin + t)
    }

    /// Returns the inputs of a window's record.
    pub fn inputs(&self, window: &Window) -> &HeldInputs {
        &self.records[window.record].inputs
    }
}
