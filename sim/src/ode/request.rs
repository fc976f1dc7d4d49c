//! Checks of a simulation request.

use super::error::SolveError;
use super::settings::Settings;
use super::system::System;

/// Rejects an invalid request: lengths, order, ranges, and rates at the start.
pub fn check<S: System + ?Sized>(
    system: &S,
    initial: &[f64],
    (begin, end): (f64, f64),
    samples: &[f64],
    settings: &Settings,
) -> Result<(), SolveError> {
    let refuse = |problem: String| Err(SolveError::Request { problem });
    if initial.is_empty() || initial.len() != system.state_count() {
        return refuse(format!(
            "the initial state has {} entries, but the system has {} states",
            initial.len(),
            system.state_count()
        ));
    }
    if let Some(index) = initial.iter().position(|y| !y.is_finite()) {
        return refuse(format!("entry {index} of the initial state is not finite"));
    }
    check_span((begin, end), samples)?;
    settings.check()?;
    let steps = (end - begin) / settings.max_step;
    if steps > settings.max_steps as f64 {
        return refuse(format!(
            "the longest step, {:e} s, needs {steps:.1e} steps up to the end, but the limit is {:e}: use a longer \
             one, or a shorter time",
            settings.max_step, settings.max_steps as f64
        ));
    }
    check_rates(system, begin, initial)
}

/// Rejects an end before the start (s), and samples outside or not in order.
pub fn check_span((begin, end): (f64, f64), samples: &[f64]) -> Result<(), SolveError> {
    let refuse = |problem: String| Err(SolveError::Request { problem });
    // In a shorter span, steps would be subnormal numbers with reduced precision.
    let shortest = f64::MIN_POSITIVE / f64::EPSILON;
    if !(begin.is_finite() && end.is_finite() && end - begin >= shortest) {
        return refuse(format!(
            "the end of the simulation, {end} s, must be later than its start, {begin} s, by at least {shortest:e} s"
        ));
    }
    let ascending = samples.windows(2).all(|pair| pair[0] <= pair[1]);
    let inside = samples.iter().all(|sample| (begin..=end).contains(sample));
    if !(ascending && inside) {
        return refuse(format!(
            "sample times must ascend from {begin} s to at most {end} s"
        ));
    }
    Ok(())
}

/// Rejects rates at the start that are not finite.
fn check_rates<S: System + ?Sized>(system: &S, t: f64, y: &[f64]) -> Result<(), SolveError> {
    let mut rates = vec![0.0; system.state_count()];
    system.rates(t, y, &mut rates);
    match rates.iter().position(|rate| !rate.is_finite()) {
        Some(state) => Err(match system.find_indefinite_coordinate(t, y) {
            Some(coordinate) => SolveError::NotPositiveDefinite { t, coordinate },
            None => SolveError::NotFinite { t, state },
        }),
        None => Ok(()),
    }
}
