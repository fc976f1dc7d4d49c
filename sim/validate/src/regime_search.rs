//! Moves a state into a regime by the shortest change of a linearised problem.

use super::feasibility::nearest_point;
use super::oracle::{Oracle, OracleError, Side, SwitchValue};
use super::random::Random;
use super::regimes::Regime;
use super::sample::Sample;

/// Maximum number of corrections of one state. Each correction halves the required distance from
/// the switching surfaces, so that narrow regimes are reached too.
const MAX_CORRECTIONS: i32 = 24;

pub(super) struct Sizes<'s> {
    pub state: &'s [f64],
    pub inputs: &'s [f64],
}

/// Inequality `row * change >= bound`; the change is in units of the sizes.
type Inequality = (Vec<f64>, f64);

pub(super) fn move_into_regime(
    oracle: &Oracle,
    sample: &mut Sample,
    regime: &Regime,
    sizes: &Sizes<'_>,
    random: &mut Random,
) -> Result<bool, OracleError> {
    for correction in 0..MAX_CORRECTIONS {
        if is_inside(oracle, sample, regime)? {
            return Ok(true);
        }
        let margin = 0.5_f64.powi(correction) * random.unit();
        let rows = regime_inequalities(oracle, sample, regime, sizes, margin)?;
        // If the margin is too large, the inequalities are infeasible. The next correction uses a smaller margin.
        if let Some(change) = nearest_point(&rows) {
            shift_sample(sample, &change, sizes);
        }
    }
    is_inside(oracle, sample, regime)
}

/// Returns true if a state is in `regime` and every quantity that must be constantly zero has zero slope.
fn is_inside(oracle: &Oracle, sample: &Sample, regime: &Regime) -> Result<bool, OracleError> {
    if Regime::from_state(oracle, sample)? != *regime {
        return Ok(false);
    }
    let sides = oracle.switches().iter().zip(&regime.sides);
    for (index, (switch, side)) in sides.enumerate() {
        if *side == Side::Free && switch.rests_at_zero() {
            let (time, state, inputs) = (sample.time, &sample.state, &sample.inputs);
            let gradient = oracle.switch_gradient(index, time, state, inputs)?;
            if gradient.quantity.iter().any(|slope| *slope != 0.0) {
                return Ok(false);
            }
        }
    }
    Ok(true)
}

/// Returns the sides of `regime` and the ranges as linear inequalities of a change of the sample.
fn regime_inequalities(
    oracle: &Oracle,
    sample: &Sample,
    regime: &Regime,
    sizes: &Sizes<'_>,
    margin: f64,
) -> Result<Vec<Inequality>, OracleError> {
    let Sample {
        time,
        state,
        inputs,
    } = sample;
    let scales: Vec<f64> = sizes.state.iter().chain(sizes.inputs).copied().collect();
    let values = oracle.switch_values(*time, state, inputs)?;
    let mut rows = Vec::new();
    let sides = oracle.switches().iter().zip(&regime.sides);
    for (index, (value, (switch, side))) in values.iter().zip(sides).enumerate() {
        // Changes of the other switches bring this quantity to zero.
        if *side == Side::Free && switch.rests_at_zero() {
            continue;
        }
        let gradient = oracle.switch_gradient(index, *time, state, inputs)?;
        // The last unknown is the change of time, in s.
        let scaled = |slopes: &[f64]| -> Vec<f64> {
            let scales = scales.iter().chain([&1.0]);
            slopes
                .iter()
                .zip(scales)
                .map(|(s, size)| s * size)
                .collect()
        };
        let slopes = (scaled(&gradient.quantity), scaled(&gradient.half_width));
        rows.extend(side_inequalities(value, &slopes, *side, margin));
    }
    let ranges = oracle.ranges();
    let entries = state.iter().zip(&ranges.state);
    let entries = entries.chain(inputs.iter().zip(&ranges.inputs));
    for (place, ((entry, range), size)) in entries.zip(&scales).enumerate() {
        if let Some((low, high)) = range {
            let unit = |sign: f64| {
                let mut row = vec![0.0; scales.len() + 1];
                row[place] = sign;
                row
            };
            rows.push((unit(1.0), (low - entry) / size));
            rows.push((unit(-1.0), (entry - high) / size));
        }
    }
    let finite =
        |(row, bound): &Inequality| bound.is_finite() && row.iter().all(|entry| entry.is_finite());
    rows.retain(finite);
    Ok(rows)
}

/// Returns the inequalities of one switch. `slopes` are the derivatives of the quantity and of the half-width, scaled
/// by the sizes. Inequalities that are already satisfied remain satisfied.
fn side_inequalities(
    value: &SwitchValue,
    (quantity, half_width): &(Vec<f64>, Vec<f64>),
    side: Side,
    margin: f64,
) -> Vec<Inequality> {
    let row = |sign: f64, widths: f64| -> Vec<f64> {
        let pairs = quantity.iter().zip(half_width);
        pairs.map(|(q, h)| sign * q + widths * h).collect()
    };
    let bound =
        |row: Vec<f64>, distance: f64, wanted: f64| (row, wanted.min(distance.max(0.0)) - distance);
    match side {
        Side::Free => [1.0, -1.0]
            .into_iter()
            .map(|sign| {
                let distance = value.half_width + sign * value.quantity;
                (row(sign, 1.0), margin * value.half_width - distance)
            })
            .collect(),
        side => {
            let row = row(side.sign(), -1.0);
            let distance = side.sign() * value.quantity - value.half_width;
            let slope = row.iter().map(|entry| entry * entry).sum::<f64>().sqrt();
            if distance > 0.0 {
                return vec![bound(row, distance, margin * slope)];
            }
            vec![(row, margin * slope - distance)]
        }
    }
}

fn shift_sample(sample: &mut Sample, change: &[f64], sizes: &Sizes<'_>) {
    let entries = sample.state.iter_mut().zip(sizes.state);
    let entries = entries.chain(sample.inputs.iter_mut().zip(sizes.inputs));
    for ((entry, size), change) in entries.zip(change) {
        *entry += size * change;
    }
    if let Some(change) = change.last() {
        sample.time += change;
    }
}
