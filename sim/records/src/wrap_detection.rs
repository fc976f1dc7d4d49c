//! Detection of wrapped columns. If a motion leaves a sensor's range at one end, the values jump to the other end, and
//! the motion continues at the same speed, opposite to the jump. A square wave has similar jumps but is at rest at its
//! levels, and rest gives no evidence of wrapping.

use crate::noise;
use crate::unwrapping::{median, unwrap_values};
use crate::wrap_period::{ColumnUnit, estimate_period};

const MIN_CROSSINGS: usize = 10;

/// Largest relative difference between jumps, between range and period, and between two periods.
pub(crate) const MAX_RELATIVE_DIFFERENCE: f64 = 0.1;

/// Minimum motion, in standard deviations of the noise.
const MIN_MOTION_OVER_NOISE: f64 = 5.0;

/// Number of samples within which jumps back and forth count as one crossing with noise.
const MAX_CHATTER_SAMPLES: usize = 20;

/// Number of samples around a crossing within which the motion must exceed its noise.
const MOTION_SEARCH_SAMPLES: usize = 1000;

/// Minimum fraction of crossings that continue at the same speed.
const MIN_CONTINUED_FRACTION: f64 = 0.8;

/// Number of steps around a jump that determine its speed.
const STEPS_AROUND_JUMP: usize = 5;

#[derive(Clone, Copy, Debug)]
pub(crate) struct WrapPattern {
    /// Period in the unit of the values. If a common period is within the uncertainty, it is used exactly.
    pub period: f64,
    /// Half width of the confidence interval of the period; `None` if it is below the resolution of the sensor.
    pub uncertainty: Option<f64>,
    pub is_usual: bool,
    pub first: f64,
    pub count: usize,
    pub is_turn: bool,
    /// True if the motion travels through the whole range between jumps.
    pub has_full_travel: bool,
}

impl WrapPattern {
    /// Returns true if the column is wrapped. For an input, only jumps by a full turn are sufficient evidence.
    pub fn is_wrapped(&self, is_input: bool) -> bool {
        self.is_turn || (self.has_full_travel && !is_input)
    }

    /// Formats the period for a dataset file: one digit beyond its uncertainty, unless the period is common.
    pub fn format_period(&self, period: f64) -> String {
        if self.is_turn {
            return format!("{period}");
        }
        let digits = match self.uncertainty {
            Some(own) if own > 0.0 && !self.is_usual => {
                (self.period / own).log10().ceil().clamp(1.0, 11.0) as usize + 1
            }
            _ => 12,
        };
        let rounded = format!("{period:.*e}", digits).parse::<f64>();
        format!("{}", rounded.unwrap_or(period))
    }

    /// Returns a remark on the uncertainty of the period; `None` if the uncertainty is below the sensor's resolution.
    pub fn uncertainty_note(&self, period: f64) -> Option<String> {
        let own = self.uncertainty? / self.period * period;
        let rounded = format!("{own:.0e}").parse::<f64>().unwrap_or(own);
        Some(format!(
            "uncertain by {rounded}; the exact value is in the sensor's data sheet"
        ))
    }
}

/// Detects the pattern of a wrapped column; `None` if no jumps look like ends of a range.
pub(crate) fn detect_wrapping(
    times: &[f64],
    column: &[f64],
    unit: ColumnUnit,
) -> Option<WrapPattern> {
    let samples: Vec<usize> = (0..column.len())
        .filter(|sample| column[*sample].is_finite())
        .collect();
    if samples.len() < MIN_CROSSINGS {
        return None;
    }
    let times: Vec<f64> = samples.iter().map(|sample| times[*sample]).collect();
    let values: Vec<f64> = samples.iter().map(|sample| column[*sample]).collect();
    let jumps = find_common_jumps(&values)?;
    let period = estimate_period(&values, &jumps, unit)?;
    let motion = unwrap_values(&times, &values, period.value).values;
    let crossings = group_crossings(&jumps, &values);
    let threshold = MIN_MOTION_OVER_NOISE * noise::estimate_noise(&motion).unwrap_or(0.0);
    let decided: Vec<bool> = crossings
        .iter()
        .filter_map(|crossing| crossing.is_continued(&motion, threshold))
        .collect();
    let continued = decided.iter().filter(|is_continued| **is_continued).count();
    if decided.is_empty() || (continued as f64) < MIN_CONTINUED_FRACTION * decided.len() as f64 {
        return None;
    }
    let mut neighbours = crossings.windows(2);
    Some(WrapPattern {
        period: period.value,
        uncertainty: period.uncertainty,
        is_usual: period.is_usual,
        first: times[jumps[0] + 1],
        count: jumps.len(),
        is_turn: period.is_turn,
        has_full_travel: neighbours.any(|pair| pair[0].direction == pair[1].direction),
    })
}

/// Returns the samples before the jumps of a column. The size of a jump is corrected by the motion during its step.
/// `None` if the sizes differ from each other or from the range.
fn find_common_jumps(values: &[f64]) -> Option<Vec<usize>> {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let range = high - low;
    let step = |k: usize| values[k + 1] - values[k];
    let is_jump = |k: &usize| step(*k).abs() > 0.5 * range;
    let jumps: Vec<usize> = (0..values.len() - 1).filter(is_jump).collect();
    let beside = |jump: usize| -> f64 {
        let near = jump.saturating_sub(STEPS_AROUND_JUMP)
            ..(jump + STEPS_AROUND_JUMP + 1).min(values.len() - 1);
        let regular: Vec<f64> = near.filter(|k| !is_jump(k)).map(step).collect();
        median(&regular).unwrap_or(0.0)
    };
    let sizes: Vec<f64> = jumps
        .iter()
        .map(|jump| (step(*jump) - beside(*jump)).abs())
        .collect();
    let period = median(&sizes)?;
    let alike = sizes
        .iter()
        .filter(|size| (**size - period).abs() < MAX_RELATIVE_DIFFERENCE * period)
        .count();
    let speeds: Vec<f64> = jumps.iter().map(|jump| beside(*jump).abs()).collect();
    let fastest = speeds.into_iter().fold(0.0, f64::max);
    let fills = (period - range).abs() < fastest + MAX_RELATIVE_DIFFERENCE * period;
    (fills && alike as f64 >= MIN_CONTINUED_FRACTION * sizes.len() as f64).then_some(jumps)
}

/// Crossing of an end of the range: one jump, or several jumps back and forth by noise.
struct Crossing {
    before: usize,
    after: usize,
    direction: f64,
}

impl Crossing {
    /// Returns true if the motion continues across the crossing; `None` if noise hides it.
    fn is_continued(&self, motion: &[f64], threshold: f64) -> Option<bool> {
        let level = 0.5 * (motion[self.before] + motion[self.after]);
        let away = |value: &&f64| (**value - level).abs() > threshold;
        let before = motion[..=self.before].iter().rev();
        let came_from = before.take(MOTION_SEARCH_SAMPLES).find(away)?;
        let went_to = motion[self.after..]
            .iter()
            .take(MOTION_SEARCH_SAMPLES)
            .find(away)?;
        let rises = |from: f64, to: f64| (to - from) * self.direction > 0.0;
        Some(rises(*came_from, level) && rises(level, *went_to))
    }
}

fn group_crossings(jumps: &[usize], values: &[f64]) -> Vec<Crossing> {
    let mut found: Vec<(Crossing, f64)> = Vec::new();
    for jump in jumps {
        let sign = -(values[jump + 1] - values[*jump]).signum();
        match found.last_mut() {
            Some((last, sum))
                if sign != last.direction && jump - last.after < MAX_CHATTER_SAMPLES =>
            {
                last.after = jump + 1;
                last.direction = sign;
                *sum += sign;
            }
            _ => found.push((
                Crossing {
                    before: *jump,
                    after: jump + 1,
                    direction: sign,
                },
                sign,
            )),
        }
    }
    let net = found.into_iter().filter(|(_, sum)| *sum != 0.0);
    net.map(|(crossing, _)| crossing).collect()
}

#[cfg(test)]
mod tests {
    use super::{WrapPattern, detect_wrapping};
    use crate::wrap_period::ColumnUnit;

    const UNIT: ColumnUnit = ColumnUnit {
        size: 1.0,
        turn: Some(360.0),
    };

    type Motion<'a> = &'a dyn Fn(usize) -> f64;

    fn noise(k: usize) -> f64 {
        2.0 * ((k as f64 * 12.9898).sin() * 43_758.545).fract().abs() - 1.0
    }

    fn pattern(column: impl Fn(usize) -> f64) -> Option<WrapPattern> {
        let times: Vec<f64> = (0..1000).map(|k| 0.01 * k as f64).collect();
        let column: Vec<f64> = (0..1000).map(column).collect();
        detect_wrapping(&times, &column, UNIT)
    }

    fn wrap_between(low: f64, period: f64, value: f64) -> f64 {
        low + (value - low).rem_euclid(period)
    }

    #[test]
    fn wrapped_angles_are_detected() {
        let swing = |k: usize| 170.0 + 40.0 * (0.03 * k as f64).sin() + 0.5 * noise(k);
        let fast = |k: usize| 130.0 * k as f64 + 0.2 * noise(k);
        let slow = |k: usize| 0.4 * k as f64 + 0.5 * noise(k);
        let motions: [(&str, Motion<'_>, bool); 3] = [
            ("swing", &swing, false),
            ("fast", &fast, true),
            ("slow", &slow, true),
        ];
        for (name, motion, travels) in motions {
            for low in [-180.0, 0.0] {
                let found = pattern(|k| wrap_between(low, 360.0, motion(k)));
                if name == "swing" && low == 0.0 {
                    assert!(found.is_none(), "never at 0");
                    continue;
                }
                let found = found.unwrap_or_else(|| panic!("{name} from {low}"));
                assert_eq!((found.period, found.is_turn), (360.0, true), "{name}");
                assert!(
                    found.has_full_travel || !travels || name == "slow",
                    "{name}"
                );
            }
        }
    }

    #[test]
    fn counter_overflow_is_detected_with_its_period() {
        let found = pattern(|k| (wrap_between(0.0, 4096.0, 61.3 * k as f64)).floor());
        let found = found.expect("a counter");
        assert!((found.period - 4096.0).abs() < 10.0, "{}", found.period);
        assert!(found.has_full_travel && !found.is_turn);
        assert_eq!(found.count, 14);
        assert!((found.first - 0.67).abs() < 1e-9, "{}", found.first);
    }

    #[test]
    fn real_jumps_are_not_wrapping() {
        let square = |k: usize| {
            if (k / 70).is_multiple_of(2) {
                180.0
            } else {
                -180.0
            }
        };
        let columns: [(&str, Motion<'_>); 7] = [
            ("a square wave of a turn", &square),
            ("with noise", &|k| square(k) + noise(k)),
            ("and a drift", &|k| square(k) + noise(k) + 0.02 * k as f64),
            ("on a sine", &|k| square(k) + 20.0 * (0.05 * k as f64).cos()),
            ("noise alone", &|k| 180.0 * noise(k)),
            ("spikes", &|k| if k % 90 == 5 { 360.0 } else { noise(k) }),
            ("a sine", &|k| 180.0 * (0.8 * k as f64).sin()),
        ];
        for (name, column) in columns {
            let found = pattern(column);
            assert!(found.is_none(), "{name}: {found:?}");
        }
    }
}
