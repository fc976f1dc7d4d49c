//! Warning of a motion whose integrals along a field exceed the resolution of their quadrature.

use eomgen_codegen::mechanics::fields::resolution::{
    MAX_ERROR, State, has_nonlinear_integrals, worst_at_state,
};
use eomgen_compiled_model::{Instance, Motion};

use crate::error::{Result, warn};

/// Number of samples of a motion that are checked.
const SAMPLES: usize = 20;

/// Warns about the largest error of an integral whose integrand is no polynomial of the motion.
pub fn warn_of_integrals(run: &Instance<'_>, motion: &Motion) -> Result {
    if !has_nonlinear_integrals(run.model().model()) {
        return Ok(());
    }
    let model = run.valued_model()?;
    let parameters = model
        .parameter_values()
        .map_err(|error| crate::error::Error::model(&model.source, error))?;
    let trajectory = &motion.trajectory;
    let step = trajectory.times.len().div_ceil(SAMPLES).max(1);
    let samples = trajectory
        .times
        .iter()
        .zip(&trajectory.states)
        .step_by(step);
    let errors = samples.filter_map(|(&t, state)| {
        let at = State {
            parameters: &parameters,
            t,
            state,
            inputs: &motion.inputs.evaluate(t),
        };
        Some((t, worst_at_state(&model, run.model().orders(), at)?))
    });
    let worst = errors.max_by(|(_, one), (_, other)| one.error.total_cmp(&other.error));
    if let Some((t, found)) = worst
        && found.error > MAX_ERROR
    {
        warn(&format!(
            "warning: the {} quadrature points integrate `integral({})` with a relative error of {:.0e} at t = {t} s; \
             raise the order of the field, which adds points, or write a smoother integrand",
            found.nodes, found.text, found.error
        ));
    }
    Ok(())
}
