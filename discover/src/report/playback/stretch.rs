//! The part of the test record that a page holds: windows from its beginning, as far as a file of
//! bounded size takes them.

use eomgen_records::windows::judged;

use crate::fit::fitted::Fit;
use crate::model::problem::EstimationProblem;

/// The most samples.
const SAMPLES: usize = 3000;

/// The most numbers in all columns: 260 kB as text.
const NUMBERS: usize = 24_000;

/// The fewest samples of a window that is cut short.
const FEWEST: usize = 32;

/// Windows of the first test record, one after the other.
pub(super) struct Stretch {
    /// The times of all samples, s.
    pub times: Vec<f64>,
    /// A row per sample, a number per channel, NaN where missing.
    pub measured: Vec<f64>,
    /// The same, of the model as it was: simulated; NaN where it is not compared.
    pub before: Vec<f64>,
    /// The windows, in order of time.
    pub windows: Vec<Piece>,
    /// For each channel what is left of these samples before and with what was found, SI.
    pub left: Vec<[f64; 2]>,
    /// Whether it is the whole record.
    pub is_whole: bool,
}

/// A window of a stretch.
pub(super) struct Piece {
    /// Its place among the test windows.
    pub window: usize,
    /// Its first sample in the stretch.
    pub first: usize,
    /// How many samples it has here.
    pub samples: usize,
    /// Which of them are compared.
    pub judged: std::ops::Range<usize>,
}

impl Stretch {
    /// The beginning of the first test record; none where the fit cannot follow that.
    pub fn of(problem: &EstimationProblem<'_>, null: &Fit, best: &Fit) -> Option<Self> {
        let channels = problem.noise.len();
        let inputs = problem.dataset.test.first()?.input_columns.len();
        let most = SAMPLES.min(NUMBERS / (1 + inputs + 2 * channels));
        let mut stretch = Self {
            times: Vec::new(),
            measured: Vec::new(),
            before: Vec::new(),
            windows: Vec::new(),
            left: Vec::new(),
            is_whole: true,
        };
        let mut sums = vec![[0.0; 2]; channels];
        let mut counts = vec![0.0; channels];
        let all = problem.test.list.iter().enumerate();
        for (place, window) in all.filter(|(_, window)| window.record == 0) {
            let whole = window.times.len();
            let samples = whole.min(most - stretch.times.len());
            if samples < whole && (samples < FEWEST || place > 0) {
                stretch.is_whole = false;
                break;
            }
            stretch.is_whole &= samples == whole;
            let fitted = best.test.residuals.get(place)?;
            if fitted.is_empty() {
                return None;
            }
            let judged = judged(whole);
            let judged = judged.start..judged.end.min(samples);
            let null = null.test.residuals.get(place)?;
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
            stretch.windows.push(Piece {
                window: place,
                first,
                samples,
                judged,
            });
        }
        let root = |sum: f64, count: f64| (sum / f64::max(count, 1.0)).sqrt();
        let left = sums.iter().zip(&counts);
        stretch.left = left
            .map(|([before, fitted], count)| [root(*before, *count), root(*fitted, *count)])
            .collect();
        (!stretch.windows.is_empty()).then_some(stretch)
    }
}
