//! Axis of a frame: positions of values in pixels, and ticks.

use super::quantity::format_superscript;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scale {
    Linear,
    Logarithmic,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Range {
    pub low: f64,
    pub high: f64,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    pub position: f64,
    pub label: String,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    pub scale: Scale,
    pub range: Range,
    /// Pixels of the low and the high end.
    pub pixels: (f64, f64),
}

impl Scale {
    /// Returns the coordinate along the axis: the value or its logarithm; NaN if there is no logarithm.
    pub fn to_position(self, value: f64) -> f64 {
        match self {
            Self::Linear => value,
            Self::Logarithmic if value > 0.0 => value.log10(),
            Self::Logarithmic => f64::NAN,
        }
    }
}

impl Range {
    /// Returns the range of the finite coordinates; `None` if there are none.
    pub fn from_positions(positions: impl Iterator<Item = f64>) -> Option<Self> {
        positions.filter(|position| position.is_finite()).fold(
            None,
            |range: Option<Self>, position| {
                let Self { low, high } = range.unwrap_or(Self {
                    low: position,
                    high: position,
                });
                Some(Self {
                    low: low.min(position),
                    high: high.max(position),
                })
            },
        )
    }

    /// Widens a range that is a point, so that rounding noise of a constant is not magnified.
    pub fn widen_point(self) -> Self {
        let magnitude = self.low.abs().max(self.high.abs());
        let least = if magnitude < 1e-100 {
            1.0
        } else {
            1e-9 * magnitude
        };
        if self.high - self.low >= least {
            return self;
        }
        let half = if magnitude < 1e-100 {
            1.0
        } else {
            0.1 * magnitude
        };
        let middle = self.low + (self.high - self.low) / 2.0;
        Self {
            low: middle - half,
            high: middle + half,
        }
    }

    pub fn pad(self, share: f64) -> Self {
        let margin = share * (self.high - self.low);
        Self {
            low: self.low - margin,
            high: self.high + margin,
        }
    }

    /// Adds space at the top, as a fraction of the new span.
    pub fn pad_top(self, share: f64) -> Self {
        Self {
            low: self.low,
            high: self.high + share / (1.0 - share) * (self.high - self.low),
        }
    }
}

impl Axis {
    pub fn pixel(&self, position: f64) -> f64 {
        let (start, end) = self.pixels;
        let share = (position - self.range.low) / (self.range.high - self.range.low);
        start + share * (end - start)
    }
}

pub(super) fn ticks(scale: Scale, range: Range, count: usize) -> Vec<Tick> {
    match scale {
        Scale::Linear => linear_ticks(range, count),
        Scale::Logarithmic => decade_ticks(range, count),
    }
}

/// Returns multiples of 1, 2 or 5 times a power of ten, all with the same number of decimals.
fn linear_ticks(range: Range, count: usize) -> Vec<Tick> {
    let step = round_step((range.high - range.low) / count.max(1) as f64);
    let decimals = (-(step.log10() + 1e-9).floor()).clamp(0.0, 12.0) as usize;
    step_multiples(range, step)
        .map(|position| Tick {
            position,
            label: with_minus_sign(&format!("{position:.decimals$}")),
        })
        .collect()
}

/// Returns the multiples of `step` in a range, including those at its ends up to rounding.
fn step_multiples(range: Range, step: f64) -> impl Iterator<Item = f64> {
    let first = (range.low / step - 1e-6).ceil();
    let last = (range.high / step + 1e-6).floor();
    // Cannot overflow: a range is at least 1e-9 of its magnitude, and a step is a fraction of it.
    (first as i64..=last as i64).map(move |multiple| multiple as f64 * step)
}

/// Returns the nearest of 1, 2 and 5 times a power of ten, by ratio.
fn round_step(rough: f64) -> f64 {
    let power = 10f64.powi(rough.log10().floor() as i32);
    let mantissa = match rough / power {
        m if m < 2f64.sqrt() => 1.0,
        m if m < 10f64.sqrt() => 2.0,
        m if m < 50f64.sqrt() => 5.0,
        _ => 10.0,
    };
    mantissa * power
}

/// Returns powers of ten; for less than two decades also 2 and 5 times these.
fn decade_ticks(range: Range, count: usize) -> Vec<Tick> {
    let decades = range.high.floor() - range.low.ceil();
    if decades < 1.0 {
        return fine_ticks(range);
    }
    let stride = (decades / count.max(1) as f64).ceil().max(1.0);
    step_multiples(range, stride)
        .map(|position| Tick {
            position,
            label: format!("10{}", format_superscript(position as i32)),
        })
        .collect()
}

fn fine_ticks(range: Range) -> Vec<Tick> {
    let decades = range.low.floor() as i32..=range.high.floor() as i32;
    decades
        .flat_map(|decade| [1, 2, 5].map(|mantissa| (mantissa, decade)))
        .map(|(mantissa, decade)| Tick {
            position: f64::from(mantissa).log10() + f64::from(decade),
            label: fine_label(mantissa, decade),
        })
        .filter(|tick| (range.low..=range.high).contains(&tick.position))
        .collect()
}

fn fine_label(mantissa: i32, decade: i32) -> String {
    match (mantissa, decade) {
        (_, 0..=3) => format!("{}", f64::from(mantissa) * 10f64.powi(decade)),
        (1, _) => format!("10{}", format_superscript(decade)),
        _ => format!("{mantissa}·10{}", format_superscript(decade)),
    }
}

/// Replaces a hyphen by a minus sign, and removes it before zero.
fn with_minus_sign(number: &str) -> String {
    match number.strip_prefix('-') {
        Some(digits) if digits.chars().all(|c| matches!(c, '0' | '.')) => digits.to_owned(),
        Some(digits) => format!("−{digits}"),
        None => number.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(scale: Scale, low: f64, high: f64) -> Vec<String> {
        let ticks = ticks(scale, Range { low, high }, 5);
        ticks.into_iter().map(|tick| tick.label).collect()
    }

    #[test]
    fn ticks_are_round_and_include_the_ends() {
        assert_eq!(
            labels(Scale::Linear, 0.0, 2.0),
            ["0.0", "0.5", "1.0", "1.5", "2.0"]
        );
        assert_eq!(
            labels(Scale::Linear, -53.0, 53.0),
            ["−40", "−20", "0", "20", "40"]
        );
        assert_eq!(
            labels(Scale::Linear, 0.0, 0.3),
            ["0.00", "0.05", "0.10", "0.15", "0.20", "0.25", "0.30"]
        );
    }

    #[test]
    fn logarithmic_ticks_are_powers_of_ten() {
        assert_eq!(
            labels(Scale::Logarithmic, -12.0, -9.5),
            ["10⁻¹²", "10⁻¹¹", "10⁻¹⁰"]
        );
        assert_eq!(labels(Scale::Logarithmic, 0.5, 1.5), ["5", "10", "20"]);
        assert_eq!(labels(Scale::Logarithmic, -30.0, 0.0).len(), 6);
    }

    #[test]
    fn constant_gets_range_around_it() {
        let point = |value| {
            Range {
                low: value,
                high: value,
            }
            .widen_point()
        };
        assert_eq!(
            point(0.0),
            Range {
                low: -1.0,
                high: 1.0
            }
        );
        assert_eq!(
            point(5.0),
            Range {
                low: 4.5,
                high: 5.5
            }
        );
        let noisy = Range {
            low: 1.0,
            high: 1.0 + 1e-12,
        }
        .widen_point();
        assert!(noisy.high - noisy.low > 0.19);
    }

    #[test]
    fn value_without_logarithm_has_no_place() {
        assert!(
            Scale::Logarithmic.to_position(0.0).is_nan()
                && Scale::Logarithmic.to_position(-1.0).is_nan()
        );
        assert_eq!(
            Range::from_positions([f64::NAN, f64::INFINITY].into_iter()),
            None
        );
    }
}
