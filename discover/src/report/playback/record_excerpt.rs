//! Part of the test record on a page: windows from its beginning, limited by the size of the page.

use eomgen_records::windows::compared_samples;

use crate::fit::fit_result::Fit;
use crate::model::problem::EstimationProblem;

/// Maximum number of samples.
const MAX_SAMPLES: usize = 3000;

/// Maximum number of values in all columns, which need 260 kB as text.
const MAX_VALUES: usize = 24_000;

/// Minimum number of samples of a truncated window.
const MIN_WINDOW_SAMPLES: usize = 32;

/// Consecutive windows of the first test record.
pub(super) struct RecordExcerpt {
    /// Times of all samples, s.
    pub times: Vec<f64>,
    /// Measurements: one row per sample, one number per channel; NaN for missing values.
    pub measured: Vec<f64>,
    /// Simulation of the original model in the layout of `measured`; NaN for samples that are not
    /// compared.
    pub before: Vec<f64>,
    /// Windows in the order of time.
    pub windows: Vec<ExcerptWindow>,
    /// RMS residual of each channel for these samples, before and after the search, SI.
    pub rms_before_after: Vec<[f64; 2]>,
    /// True if the excerpt is the complete record.
    pub is_complete: bool,
}

/// Window of the excerpt.
pub(super) struct ExcerptWindow {
    /// Index among the test windows.
    pub window: usize,
    /// Index of the first sample in the excerpt.
    pub first_sample: usize,
    /// Number of samples in the excerpt.
    pub samples: usize,
    /// Samples that are compared.
    pub compared_samples: std::ops::Range<usize>,
}

impl RecordExcerpt {
    /// Selects the beginning of the first test record; `None` if its simulation failed.
    pub fn from_fits(problem: &EstimationProblem<'_>, null: &Fit, best: &Fit) -> Option<Self> {
        let channels = problem.noise.len();
        let inputs = problem.dataset.test.first()?.input_columns.len();
        let most = MAX_SAMPLES.min(MAX_VALUES / (1 + inputs + 2 * channels));
        let mut stretch = Self {
            times: Vec::new(),
            measured: Vec::new(),
            before: Vec::new(),
            windows: Vec::new(),
            rms_before_after: Vec::new(),
            is_complete: true,
        };
        let mut sums = vec![[0.0; 2]; channels];
        let mut counts = vec![0.0; channels];
        let all = problem.test.windows.iter().enumerate();
        for (index, window) in all.filter(|(_, window)| window.record == 0) {
            let whole = window.times.len();
            let samples = whole.min(most - stretch.times.len());
            if samples < whole && (samples < MIN_WINDOW_SAMPLES || index > 0) {
                stretch.is_complete = false;
                break;
            }
            stretch.is_complete &= samples == whole;
            let fitted = best.test.window_residuals.get(index)?;
            if fitted.is_empty() {
                return None;
            }
            let judged = compared_samples(whole);
            let judged = judged.start..judged.end.min(samples);
            let null = null.test.window_residuals.get(index)?;
            for sample in 0..samples {
                for channel in 0..channels {
                    let number = sample * channels + channel;
                    let (noise, measured) = (problem.noise[channel], window.measured[number]);
                    let before = null.get(number).map_or(f64::NAN, |r| r * noise);
                    let is_judged = judged.contains(&sample);
                    let shown = if is_judged { before } else { f64::NAN };
                    stretch.before.push(measured + shown);
                    if measured.is_finite() {
                        sums[channel][0] += before * before;
                        sums[channel][1] += (fitted[number] * noise).powi(2);
                        counts[channel] += 1.0;
                    }
                }
            }
            let first = stretch.times.len();
            stretch.times.extend_from_slice(&window.times[..samples]);
            stretch
                .measured
                .extend_from_slice(&window.measured[..samples * channels]);
            stretch.windows.push(ExcerptWindow {
                window: index,
                first_sample: first,
                samples,
                compared_samples: judged,
            });
        }
        let root = |sum: f64, count: f64| (sum / f64::max(count, 1.0)).sqrt();
        let left = sums.iter().zip(&counts);
        stretch.rms_before_after = left
            .map(|([before, fitted], count)| [root(*before, *count), root(*fitted, *count)])
            .collect();
        (!stretch.windows.is_empty()).then_some(stretch)
    }
}
