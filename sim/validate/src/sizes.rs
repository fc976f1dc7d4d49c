//! Typical sizes of the entries of a state and of the inputs, in SI.
//!
//! The size of a coordinate is half of its range. Without range, it is twice the half-width of a dead zone in which the
//! coordinate appears, otherwise 1. The size of a field's first mode is a twentieth of the field's length. Sizes of
//! rates are computed from stiffness and inertia of each coordinate.
//!
//! Amplitudes of modes decrease as 1/beta^3, between equal elastic energies (1/beta^2) and equal elastic forces
//! (1/beta^4). The first mode contributes an error of the quadrature (1e-17 instead of zero) to the elastic force of
//! row 64. With a faster decrease, this error would be 1e-12 of the row. With a slower decrease, mode 64 would have a
//! similar error in the inertia of row 1.

use super::oracle::{Oracle, OracleError};

pub(super) fn state_sizes(oracle: &Oracle) -> Result<Vec<f64>, OracleError> {
    let inputs = oracle.typical_inputs().to_vec();
    let mut sizes = coordinate_sizes(oracle, &inputs)?;
    let mut state = sizes.clone();
    state.resize(oracle.state_length(), 0.0);
    // If the state whose entries equal their sizes is outside the model's domain, use the initial state.
    if oracle.equations_inside(0.0, &state, &inputs)?.is_none() {
        state = oracle.initial().to_vec();
    }
    let stiffness = oracle.stiffness_diagonal(0.0, &state, &inputs)?;
    let mass = oracle.equations(0.0, &state, &inputs)?.mass;
    for (modes, length) in oracle.modes().zip(oracle.lengths()) {
        let shares = mode_amplitudes(stiffness.get(modes.clone()).unwrap_or_default());
        for (entry, share) in sizes.iter_mut().skip(modes.start).zip(shares) {
            *entry = 0.05 * length.abs() * share;
        }
    }
    let rates: Vec<f64> = sizes
        .iter()
        .zip(stiffness.iter().zip(mass.diagonal().iter()))
        .map(|(size, (stiffness, mass))| size * uncoupled_frequency(stiffness / mass))
        .collect();
    sizes.extend(rates);
    let first_order = first_order_sizes(oracle, &sizes, &inputs)?;
    sizes.extend(first_order);
    Ok(sizes)
}

/// Returns the inputs' sizes: half the range, otherwise the mean of the parameters of equal dimension, otherwise 1.
pub(super) fn input_sizes(oracle: &Oracle) -> Vec<f64> {
    let ranges = oracle.ranges();
    let inputs = ranges.inputs.iter().zip(&ranges.input_scales);
    inputs
        .map(|(range, scales)| match range {
            Some((low, high)) => 0.5 * (high - low),
            None => geometric_mean(scales.iter().copied()),
        })
        .collect()
}

fn geometric_mean(sizes: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = sizes.fold((0.0, 0.0), |(sum, count), size| {
        (sum + size.ln(), count + 1.0)
    });
    if count > 0.0 {
        (sum / count).exp()
    } else {
        1.0
    }
}

/// Returns the sizes of first-order states. The first known value of this list applies:
///
/// - half of the range;
/// - the steady state of a decaying state, with the other first-order states 0 and coordinates and rates equal to their
///   sizes;
/// - the geometric mean of the initial value and of the parameters of the same dimension;
/// - 1 in SI.
fn first_order_sizes(
    oracle: &Oracle,
    sizes: &[f64],
    inputs: &[f64],
) -> Result<Vec<f64>, OracleError> {
    let mut state = sizes.to_vec();
    state.resize(oracle.state_length(), 0.0);
    let equations = oracle.equations(0.0, &state, inputs)?;
    let decays = oracle.state_decays(0.0, &state, inputs)?;
    let initial = oracle.initial().iter().skip(sizes.len());
    let ranges = oracle.ranges();
    let stated = ranges.state.iter().skip(sizes.len());
    let stated = stated.zip(&ranges.first_order_scales);
    let rates = equations.state_rates.iter().zip(decays);
    let states = rates.zip(initial.zip(stated));
    Ok(states
        .map(|((addends, decay), (initial, (range, scales)))| {
            let rate: f64 = addends.iter().map(|addend| addend.value).sum();
            let balanced = (rate / decay).abs();
            match range {
                Some((low, high)) => 0.5 * (high - low),
                None if balanced > 0.0 && balanced.is_finite() => balanced,
                None => {
                    let initial = Some(initial.abs()).filter(|initial| *initial > 0.0);
                    geometric_mean(scales.iter().copied().chain(initial))
                }
            }
        })
        .collect())
}

/// Returns the sizes of coordinates; 0 for modes. Only dead zones of a single coordinate determine a size.
fn coordinate_sizes(oracle: &Oracle, inputs: &[f64]) -> Result<Vec<f64>, OracleError> {
    let mut sizes = vec![1.0; oracle.size()];
    for row in oracle.modes().flatten() {
        if let Some(entry) = sizes.get_mut(row) {
            *entry = 0.0;
        }
    }
    let still = vec![0.0; oracle.state_length()];
    let values = oracle.switch_values(0.0, &still, inputs)?;
    for (index, value) in values.iter().enumerate() {
        let slopes = oracle.switch_slopes(index, 0.0, &still, inputs)?;
        let mut moving = slopes
            .iter()
            .enumerate()
            .filter(|(_, slope)| **slope != 0.0);
        if let (Some((row, 1.0)), None, true) =
            (moving.next(), moving.next(), value.half_width > 0.0)
            && let Some(entry) = sizes.get_mut(row)
        {
            *entry = 2.0 * value.half_width;
        }
    }
    for (entry, range) in sizes.iter_mut().zip(&oracle.ranges().state) {
        if let Some((low, high)) = range {
            *entry = 0.5 * (high - low);
        }
    }
    Ok(sizes)
}

/// Returns amplitudes of modes relative to the first one; the stiffness is proportional to beta^4.
fn mode_amplitudes(stiffness: &[f64]) -> impl Iterator<Item = f64> {
    let first = stiffness.first().copied().unwrap_or(0.0);
    stiffness.iter().map(move |stiffness| {
        let ratio = first / stiffness;
        if ratio > 0.0 && ratio.is_finite() {
            ratio.powf(0.75)
        } else {
            1.0
        }
    })
}

fn uncoupled_frequency(square: f64) -> f64 {
    if square.is_finite() {
        square.abs().sqrt().max(1.0)
    } else {
        1.0
    }
}
