//! Comparison of the quadrature of integrals along a field with a finer rule at random states. Only integrands that are
//! not polynomials of the motion are compared.

use eomgen_codegen::mechanics::fields::resolution::{
    MAX_ERROR, State, find_largest_error_at_state, has_nonlinear_integrals,
};
use eomgen_model_spec::model::Model;

use crate::certificate::{Check, Worst};
use crate::oracle::{Oracle, OracleError};
use crate::sampler::Sampler;

const NAME: &str = "integrals";
const SEED: u64 = 0x1a7e_94a1;
const STATES: usize = 20;

/// Compares the quadrature with a rule of panels that resolve the integrand; `None` if the model has no such integral.
pub fn check(
    oracle: &Oracle,
    (model, order, parameters): (&Model, usize, &[f64]),
) -> Result<Option<Check>, OracleError> {
    if !has_nonlinear_integrals(model) {
        return Ok(None);
    }
    let orders = vec![order; model.fields.len()];
    let mut sampler = Sampler::new(oracle, SEED)?;
    let (mut worst, mut states) = (Worst::default(), 0);
    for _ in 0..STATES {
        let Some(drawn) = sampler.draw_inside()? else {
            break;
        };
        let sample = drawn.sample;
        let at = State {
            parameters,
            t: sample.time,
            state: &sample.state,
            inputs: &sample.inputs,
        };
        let Some(found) = find_largest_error_at_state(model, &orders, at) else {
            continue;
        };
        states += 1;
        let detail = format!(
            "{} points for integral({}), at t = {}, state {:?}",
            found.nodes, found.text, sample.time, sample.state
        );
        worst.include(Worst::from_deviation(found.error, detail));
    }
    Ok(Some(match states {
        0 => Check::not_run(
            NAME,
            MAX_ERROR,
            "the integrals have no value at random states",
        ),
        _ => Check::from_deviation(NAME, worst.with_count(states, "states"), MAX_ERROR),
    }))
}
