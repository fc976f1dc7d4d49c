//! Period of a wrapped column, estimated from its jumps. A jump is the period minus the motion during one sample; the
//! scatter of the steps near the jump gives the uncertainty.

use crate::unwrapping::median;

/// Number of steps on each side of a jump from which the motion during one sample is estimated.
const STEPS_BESIDE_JUMP: usize = 5;

/// Uncertainty of the period, in standard errors.
const STANDARD_ERRORS: f64 = 4.0;

/// Minimum uncertainty, in standard deviations of one jump. Noise shifts jumps in time.
const MIN_UNCERTAINTY_DEVIATIONS: f64 = 2.0;

/// Largest uncertainty with which a common period is proposed, relative to the period.
const MAX_RELATIVE_UNCERTAINTY: f64 = 0.01;

/// Fraction of the range below which changes of the steps are rounding errors, not the sensor's resolution.
const MAX_ROUNDING_FRACTION: f64 = 1e-5;

/// Powers of two at which counters overflow.
const COUNTER_BITS: std::ops::RangeInclusive<i32> = 3..=32;

/// Leading digits of common decimal periods, for example 1000, 2500 or 3600.
const DECIMAL_PERIOD_DIGITS: [f64; 6] = [1.0, 2.0, 2.5, 3.6, 4.0, 5.0];

const HALF_TURN_DEG: f64 = 180.0;

#[derive(Clone, Copy, Debug)]
pub(crate) struct ColumnUnit {
    /// Unit of the column, expressed in the unit of `values`.
    pub size: f64,
    /// Full turn in the unit of the values, for an angle or a dimensionless number.
    pub turn: Option<f64>,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Period {
    /// Period; exact if a single common period is within the uncertainty.
    pub value: f64,
    /// Half width of the confidence interval of the period; `None` if it is below the resolution, or if the period is a
    /// full turn.
    pub uncertainty: Option<f64>,
    pub is_usual: bool,
    pub is_turn: bool,
}

/// Estimates the period from the samples before the jumps, in ascending order.
pub(crate) fn estimate_period(values: &[f64], jumps: &[usize], unit: ColumnUnit) -> Option<Period> {
    let steps = Steps { values, jumps };
    let sizes: Vec<f64> = jumps
        .iter()
        .map(|jump| steps.compute_step_excess(*jump).abs())
        .collect();
    let seen = median(&sizes)?;
    let deviation = steps.estimate_jump_deviation();
    let error = STANDARD_ERRORS * deviation / (jumps.len() as f64).sqrt();
    let is_whole = values
        .iter()
        .all(|value| is_whole_number(value / unit.size));
    let resolution = if is_whole {
        unit.size
    } else {
        steps.estimate_resolution()
    };
    let uncertainty = error
        .max(MIN_UNCERTAINTY_DEVIATIONS * deviation)
        .max(resolution);
    let is_near = |usual: &f64| (usual - seen).abs() <= uncertainty;
    if let Some(turn) = unit.turn.filter(is_near) {
        return Some(Period {
            value: turn,
            uncertainty: None,
            is_usual: true,
            is_turn: true,
        });
    }
    let near: Vec<f64> = list_common_periods(seen, unit)
        .into_iter()
        .filter(is_near)
        .collect();
    let usual = match near[..] {
        [usual] if uncertainty <= MAX_RELATIVE_UNCERTAINTY * seen => Some(usual),
        _ => None,
    };
    let rounded = if is_whole {
        unit.size * (seen / unit.size).round()
    } else {
        seen
    };
    Some(Period {
        value: usual.unwrap_or(rounded),
        uncertainty: Some(uncertainty)
            .filter(|own| usual.is_none() || *own > MIN_UNCERTAINTY_DEVIATIONS * resolution),
        is_usual: usual.is_some(),
        is_turn: false,
    })
}

fn list_common_periods(seen: f64, unit: ColumnUnit) -> Vec<f64> {
    let order = (seen / unit.size).log10().floor() as i32;
    let decimals = (order - 1..=order + 1)
        .flat_map(|power| DECIMAL_PERIOD_DIGITS.map(|digits| digits * 10f64.powi(power)));
    let numbers = COUNTER_BITS.map(|bits| 2f64.powi(bits)).chain(decimals);
    let numbers = numbers.map(|number| number * unit.size);
    let half_turns = unit
        .turn
        .map(|turn| [0.5 * turn, HALF_TURN_DEG * unit.size]);
    let mut usual: Vec<f64> = numbers.chain(half_turns.into_iter().flatten()).collect();
    usual.sort_by(f64::total_cmp);
    usual.dedup_by(|a, b| (*a - *b).abs() < 1e-9 * *b);
    usual
}

fn is_whole_number(value: f64) -> bool {
    (value - value.round()).abs() <= 1e-9 * value.abs().max(1.0)
}

struct Steps<'v> {
    values: &'v [f64],
    jumps: &'v [usize],
}

impl Steps<'_> {
    fn step(&self, k: usize) -> f64 {
        self.values[k + 1] - self.values[k]
    }

    fn is_regular(&self, k: usize) -> bool {
        self.jumps.binary_search(&k).is_err()
    }

    fn regular_steps_near(&self, k: usize) -> impl Iterator<Item = usize> + '_ {
        let near = k.saturating_sub(STEPS_BESIDE_JUMP)
            ..(k + STEPS_BESIDE_JUMP + 1).min(self.values.len() - 1);
        near.filter(move |other| *other != k && self.is_regular(*other))
    }

    /// Returns the difference of the step at `k` and the mean of the regular steps near it.
    fn compute_step_excess(&self, k: usize) -> f64 {
        let (sum, count) = self
            .regular_steps_near(k)
            .fold((0.0, 0.0), |(sum, count), other| {
                (sum + self.step(other), count + 1.0)
            });
        self.step(k) - sum / f64::max(count, 1.0)
    }

    /// Returns the standard deviation of one step from the mean of its neighbours, from the regular steps near jumps.
    fn estimate_jump_deviation(&self) -> f64 {
        let regular = self
            .jumps
            .iter()
            .flat_map(|jump| self.regular_steps_near(*jump));
        let (sum, count) = regular.fold((0.0, 0.0), |(sum, count), k| {
            (sum + self.compute_step_excess(k).powi(2), count + 1.0)
        });
        f64::sqrt(sum / f64::max(count, 1.0))
    }

    /// Returns the resolution of the sensor: the smallest difference between regular steps, or 0.
    fn estimate_resolution(&self) -> f64 {
        let low = self.values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = self
            .values
            .iter()
            .copied()
            .fold(f64::NEG_INFINITY, f64::max);
        let pairs = (0..self.values.len().saturating_sub(2))
            .filter(|k| self.is_regular(*k) && self.is_regular(k + 1));
        let changes = pairs.map(|k| (self.step(k + 1) - self.step(k)).abs());
        let changes = changes.filter(|change| *change > MAX_ROUNDING_FRACTION * (high - low));
        let least = changes.fold(f64::INFINITY, f64::min);
        if least.is_finite() { least } else { 0.0 }
    }
}
