//! Waveforms between -1 and 1 for the inputs of experiments. Multisines have Schroeder phases (IEEE
//! Trans. Inf. Theory 16, 1970), which give a low crest factor.

use std::f64::consts::PI;

use crate::interval::Interval;

/// Number of tones of a multisine.
const TONE_COUNT: usize = 12;

/// Levels of a staircase, relative to each end.
const STAIRCASE_LEVELS: [f64; 10] = [0.2, 0.4, 0.6, 0.8, 1.0, -0.2, -0.4, -0.6, -0.8, -1.0];

/// Waveform of an input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Waveform {
    /// Sum of sines, evenly spaced over the octaves of a band, Hz.
    Multisine(Interval),
    /// Cosine with an exponentially rising frequency through a band, Hz.
    Chirp(Interval),
    /// Steps between both ends, with a given number of periods.
    Square(u32),
    /// Steps of relative durations 1, 2 and 1 with alternating signs, with a given number of
    /// periods. A free mass returns to its initial position.
    DoubleReversal(u32),
    /// Linear motion to one end, to the other end and back to rest, with a given number of periods.
    Triangle(u32),
    /// Constant value at one end.
    Constant {
        /// True if the upper end is used.
        is_upper: bool,
    },
    /// Value at one end for a fraction of the duration, then rest.
    Release {
        /// True if the upper end is used.
        is_upper: bool,
        /// Fraction of the duration.
        fraction: f64,
    },
    /// Five levels up to the upper end, then five down to the lower end.
    Staircase,
}

impl Waveform {
    /// Returns all trial waveforms for a band, Hz.
    pub fn list_in_band(band: Interval) -> Vec<Self> {
        let middle = (band.low * band.high).sqrt();
        let mut family = vec![
            Self::Multisine(band),
            Self::Multisine(Interval::new(band.low, middle)),
            Self::Chirp(band),
            Self::Staircase,
        ];
        family.extend([1, 2, 4, 8].map(Self::Square));
        family.extend([1, 2, 4].map(Self::DoubleReversal));
        family.extend([1, 2, 4, 8].map(Self::Triangle));
        for is_upper in [true, false] {
            family.push(Self::Constant { is_upper });
            family.extend([0.25, 0.5].map(|part| Self::Release {
                is_upper,
                fraction: part,
            }));
        }
        family
    }

    /// Returns the values at times from 0 to `duration`, s. `None` if the waveform is too slow for
    /// the duration.
    pub fn sample(&self, times: &[f64], duration: f64) -> Option<Vec<f64>> {
        let at = |of: &dyn Fn(f64) -> f64| times.iter().map(|t| of(t / duration)).collect();
        Some(match *self {
            Self::Multisine(band) => sample_multisine(band, times, duration)?,
            Self::Chirp(band) => {
                let octaves = (band.high / band.low).ln();
                let phase = |part: f64| {
                    let turns = match octaves < 1e-9 {
                        true => part,
                        false => ((octaves * part).exp() - 1.0) / octaves,
                    };
                    2.0 * PI * band.low * duration * turns
                };
                at(&|part| phase(part).cos())
            }
            Self::Square(times) => at(&|part| match compute_phase(part, times) < 0.5 {
                true => 1.0,
                false => -1.0,
            }),
            Self::DoubleReversal(times) => at(&|part| match compute_phase(part, times) {
                phase if (0.25..0.75).contains(&phase) => -1.0,
                _ => 1.0,
            }),
            Self::Triangle(times) => at(&|part| match compute_phase(part, times) {
                phase if phase < 0.25 => 4.0 * phase,
                phase if phase < 0.75 => 2.0 - 4.0 * phase,
                phase => 4.0 * phase - 4.0,
            }),
            Self::Constant { is_upper } => at(&|_| end(is_upper)),
            Self::Release {
                is_upper,
                fraction: part,
            } => at(&|now| match now < part {
                true => end(is_upper),
                false => f64::NAN,
            }),
            Self::Staircase => at(&|part| {
                let step = (part * STAIRCASE_LEVELS.len() as f64) as usize;
                STAIRCASE_LEVELS[step.min(STAIRCASE_LEVELS.len() - 1)]
            }),
        })
    }

    /// Returns a description of the waveform.
    pub fn describe(&self) -> String {
        let times = |count: u32| match count {
            1 => "once".to_owned(),
            2 => "twice".to_owned(),
            count => format!("{count} times"),
        };
        let between = |band: Interval| format!("{:.2} and {:.2} Hz", band.low, band.high);
        let end = |is_upper: bool| if is_upper { "upper" } else { "lower" };
        match *self {
            Self::Multisine(band) => format!("a multisine between {}", between(band)),
            Self::Chirp(band) => format!("a chirp between {}", between(band)),
            Self::Square(count) => {
                format!("steps between both ends, {}", times(count))
            }
            Self::DoubleReversal(count) => {
                format!(
                    "steps of relative durations 1, 2 and 1 with alternating sign, {}",
                    times(count)
                )
            }
            Self::Triangle(count) => {
                format!("a triangle between both ends, {}", times(count))
            }
            Self::Constant { is_upper } => format!("a constant at the {} end", end(is_upper)),
            Self::Release {
                is_upper,
                fraction: part,
            } => format!(
                "a constant at the {} end for {:.0} % of the time, then rest",
                end(is_upper),
                100.0 * part
            ),
            Self::Staircase => "a staircase of five levels on each side".to_owned(),
        }
    }
}

/// Returns the phase of a signal with `periods` periods, at a fraction of the duration. The final
/// time belongs to the last period.
fn compute_phase(part: f64, periods: u32) -> f64 {
    (part.min(1.0 - 1e-12) * f64::from(periods)).fract()
}

fn end(is_upper: bool) -> f64 {
    if is_upper { 1.0 } else { -1.0 }
}

/// Returns a sum of tones with whole numbers of periods, scaled to a maximum of 1.
fn sample_multisine(band: Interval, times: &[f64], duration: f64) -> Option<Vec<f64>> {
    let mut periods: Vec<u64> = (0..TONE_COUNT)
        .map(|tone| {
            let part = tone as f64 / (TONE_COUNT - 1) as f64;
            band.low * (band.high / band.low).powf(part)
        })
        .map(|frequency| (frequency * duration).round() as u64)
        .filter(|periods| *periods > 0)
        .collect();
    periods.dedup();
    let count = periods.len() as f64;
    let value = |t: &f64| -> f64 {
        let tones = periods.iter().enumerate();
        tones
            .map(|(tone, periods)| {
                let phase = -PI * (tone * (tone + 1)) as f64 / count;
                (2.0 * PI * *periods as f64 * t / duration + phase).cos()
            })
            .sum()
    };
    let values: Vec<f64> = times.iter().map(value).collect();
    let crest = values.iter().map(|v| v.abs()).fold(0.0, f64::max);
    (crest > 0.0).then(|| values.iter().map(|v| v / crest).collect())
}
