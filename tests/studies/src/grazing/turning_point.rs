//! Computes the position of the stop, close to a turning point of the motion without the stop.

use eomgen_compiled_model::{CompiledModel, Instance, Orders, Request, Solver};

use super::machine::Machine;

const TOLERANCE: f64 = 1e-13;

/// Number of samples of the motion without the stop, and of each refinement of a turning point.
const SAMPLES: usize = 2000;

/// Returns the position of the stop in m, for which a turning point is beyond the stop by the machine's penetration
/// depth.
///
/// # Errors
///
/// Returns an error if the motion without the stop ends early.
pub fn place_of_stop(machine: &Machine) -> Result<f64, String> {
    let far = 1e6
        * machine
            .initial
            .iter()
            .fold(0.0_f64, |most, y| most.max(y.abs()));
    let model =
        CompiledModel::from_text("free.toml", &machine.specification(far), Orders::Declared)
            .map_err(|error| error.to_string())?;
    let run = model
        .with_parameters(&[])
        .map_err(|error| error.to_string())?;
    let step = machine.duration / SAMPLES as f64;
    let free = deflections(machine, &run, (0.0, machine.duration))?;
    let peaks = record_maxima(&free);
    let chosen = ((machine.choice * peaks.len() as f64) as usize).min(peaks.len() - 1);
    let mut peak = free[peaks[chosen]];
    let mut near = (
        peaks[chosen].saturating_sub(1) as f64 * step,
        (peaks[chosen] + 1) as f64 * step,
    );
    for _ in 0..2 {
        let finer = deflections(machine, &run, (near.0, near.1.min(machine.duration)))?;
        let highest = (0..finer.len()).fold(0, |a, b| if finer[b] > finer[a] { b } else { a });
        peak = peak.max(finer[highest]);
        let width = (near.1.min(machine.duration) - near.0) / SAMPLES as f64;
        let middle = near.0 + highest as f64 * width;
        near = ((middle - width).max(near.0), middle + width);
    }
    Ok(peak * (1.0 - machine.depth))
}

/// Returns the position of the mass that hits the stop, at evenly spaced times of a time span (in s).
fn deflections(
    machine: &Machine,
    run: &Instance<'_>,
    (from, to): (f64, f64),
) -> Result<Vec<f64>, String> {
    let step = (to - from) / SAMPLES as f64;
    let inside = (0..=SAMPLES).map(|place| from + place as f64 * step);
    let begins_later = from > 0.0;
    let times: Vec<f64> = begins_later
        .then_some(0.0)
        .into_iter()
        .chain(inside)
        .collect();
    let request = Request {
        initial: &machine.initial,
        times: &times,
        inputs: &run.default_inputs(),
        solver: Solver::Rk,
        tolerance: TOLERANCE,
        audit: false,
        max_step: f64::INFINITY,
    };
    let motion = run
        .simulate_until_stop(&request, &mut |_| {})
        .and_then(|motion| motion.into_complete());
    let motion = motion.map_err(|error| format!("without the stop: {error}"))?;
    let states = motion
        .trajectory
        .states
        .iter()
        .skip(usize::from(begins_later));
    let outward = |x: f64| if machine.is_two_sided() { x.abs() } else { x };
    Ok(states.map(|state| outward(state[machine.at])).collect())
}

/// Returns the indices of local maxima above zero and above all previous ones; at least one index.
fn record_maxima(values: &[f64]) -> Vec<usize> {
    let mut highest = values[0].max(0.0);
    let mut found = Vec::new();
    for place in 1..values.len() - 1 {
        if values[place] > highest && values[place] >= values[place + 1] {
            found.push(place);
        }
        highest = highest.max(values[place]);
    }
    if found.is_empty() {
        let place = (0..values.len()).fold(0, |a, b| if values[b] > values[a] { b } else { a });
        found.push(place);
    }
    found
}
