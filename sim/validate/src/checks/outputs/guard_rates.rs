//! Comparison of guard rates with differences of the guards along the oracle's motion.

use super::rows::{
    DIFFERENCE_TOLERANCE, OutputFindings, STEPS, relative_deviation, worst_deviation,
};
use crate::differences::{Slope, slopes};
use crate::oracle::{Oracle, OracleError};
use crate::outputs::Outputs;
use crate::sampler::Sample;
use crate::sizes;
use crate::variant::Variant;

pub(super) fn check_guard_rates(
    rows: &mut OutputFindings,
    oracle: &Oracle,
    variant: &mut dyn Variant,
    outputs: &mut dyn Outputs,
    sample: &Sample,
    place: &str,
) -> Result<(), OracleError> {
    let Some(found) = outputs
        .guard_rates(sample)
        .filter(|rates| !rates.is_empty())
    else {
        return Ok(());
    };
    let equations = oracle.equations(sample.time, &sample.state, &sample.inputs)?;
    let Some(unknowns) = equations.unknowns() else {
        return Ok(());
    };
    let velocities = &sample.state[oracle.size()..2 * oracle.size()];
    let rates = [velocities, &unknowns].concat();
    let input_rates = oracle.input_rates(&sample.inputs);
    let sizes = sizes::state_sizes(oracle)?;
    let fastest = rates
        .iter()
        .zip(&sizes)
        .map(|(rate, size)| (rate / size).abs());
    // Time interval in which no entry of the state changes by more than its size.
    let time = fastest.fold(1.0, f64::max).recip();
    let mut best = vec![f64::INFINITY; found.len()];
    for step in STEPS {
        let expected = slopes(step, |length| {
            let moved = length * time;
            let state = sample.state.iter().zip(&rates);
            let state: Vec<f64> = state.map(|(x, rate)| x + moved * rate).collect();
            let inputs = sample.inputs.iter().zip(&input_rates);
            let inputs: Vec<f64> = inputs.map(|(u, rate)| u + moved * rate).collect();
            let guards = variant.guards(sample.time + moved, &state, &inputs).ok()?;
            let slope = |value: f64| Slope {
                value,
                scale: value.abs(),
            };
            Some(guards.into_iter().map(slope).collect())
        });
        let Some(expected) = expected.filter(|expected| expected.len() == found.len()) else {
            continue;
        };
        for (best, (found, expected)) in best.iter_mut().zip(found.iter().zip(expected)) {
            let change = found * time;
            let scale = expected.scale.max(change.abs());
            *best = best.min(relative_deviation(change - expected.value, scale));
        }
    }
    rows.include(
        "guard_rates",
        DIFFERENCE_TOLERANCE,
        worst_deviation(best),
        place,
    );
    Ok(())
}
