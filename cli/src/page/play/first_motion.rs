//! Motion when a page opens. If the machine would stay at rest, an input drives it. If the motion is too fast to be
//! visible, the clock is slowed down.

use eomgen_compiled_model::{CompiledModel, OperatingPoint};

use crate::error::Result;

/// Times at which the rates are evaluated, in s. A periodic forcing is unlikely to be zero at all of them.
const TIMES_S: [f64; 3] = [0.0, 0.37, 1.3];

/// Returns true if the machine stays at the initial state with its default inputs; false if it has controllers.
pub(super) fn is_at_rest(compiled: &CompiledModel, initial: &[f64]) -> Result<bool> {
    let degrees = compiled.program().degrees_of_freedom();
    if !compiled.model().controllers.is_empty() {
        return Ok(false);
    }
    if initial[degrees..2 * degrees]
        .iter()
        .any(|rate| *rate != 0.0)
    {
        return Ok(false);
    }
    let run = compiled.with_declared_parameters()?;
    let is_equilibrium = |t: f64| {
        let at = OperatingPoint {
            t,
            state: initial.to_vec(),
            inputs: compiled.default_inputs(),
        };
        // If the Jacobian does not exist, the state is not treated as an equilibrium.
        run.is_equilibrium(&at).unwrap_or(false)
    };
    Ok(TIMES_S.into_iter().all(is_equilibrium))
}

/// Shortest period of an oscillation that is visible in real time, s.
const SHORTEST_VISIBLE_S: f64 = 0.05;

/// Returns the period of the lowest mode at the initial state, in s, if it is too short to be visible. Returns `None`
/// if the modes cannot be computed.
pub(super) fn invisible_period(compiled: &CompiledModel, initial: &[f64]) -> Option<f64> {
    let run = compiled.with_declared_parameters().ok()?;
    let at = OperatingPoint {
        t: 0.0,
        state: initial.to_vec(),
        inputs: compiled.default_inputs(),
    };
    let linear = run.linearise(at.point()).ok()?;
    let modes = run.natural_modes(&linear, at.point()).ok()?;
    let period = modes.first()?.frequency().recip();
    (period < SHORTEST_VISIBLE_S).then_some(period)
}
