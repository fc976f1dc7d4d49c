//! Comparison of the requested outputs with the oracle:
//!
//! - inverse dynamics and bias forces: with the oracle's mass matrix and forces;
//! - Jacobians and their products: with directional differences of the oracle's rows;
//! - guard rates: with differences of the guards along the oracle's motion.

mod check_context;
mod derivatives;
mod directions;
mod forces;
mod guard_rates;
mod rows;

use crate::certificate::Check;
use crate::differences::DifferencePoint;
use crate::oracle::{Oracle, OracleError};
use crate::outputs::Outputs;
use crate::random::Random;
use crate::sampler::{Sample, Sampler};
use crate::variant::Variant;

pub(crate) use check_context::CheckContext;
use derivatives::{OutputValues, compare_along};
use directions::directions;
use forces::check_forces;
use guard_rates::check_guard_rates;
pub use rows::DIFFERENCE_TOLERANCE;
use rows::OutputFindings;

/// Maximum and minimum number of states, each in a different regime if the model has enough regimes.
const STATES: (usize, usize) = (9, 4);
const SEED: u64 = 0x4e0b_1a75;

pub(crate) fn check(
    judged: &CheckContext<'_>,
    variant: &mut dyn Variant,
    outputs: &mut dyn Outputs,
) -> Result<Vec<Check>, OracleError> {
    let names = outputs.names();
    let mut rows = OutputFindings::default();
    let mut random = Random::new(SEED);
    let samples = draw_samples(judged.oracle)?;
    for (count, sample) in (1..).zip(&samples) {
        let place = format!("state {count}");
        let equations = judged
            .oracle
            .equations(sample.time, &sample.state, &sample.inputs)?;
        check_forces(&mut rows, &equations, outputs, sample, &mut random, &place);
        check_guard_rates(&mut rows, judged.oracle, variant, outputs, sample, &place)?;
        let Some(unknowns) = equations.unknowns() else {
            continue;
        };
        let surroundings = DifferencePoint {
            oracle: judged.oracle,
            model: judged.model,
            order: judged.order,
            parameters: judged.parameters,
            sample,
            unknowns,
        };
        let known = OutputValues::new(judged, &equations, outputs, sample, &mut random);
        for direction in directions(judged, sample, &names, count <= 2, &mut random)? {
            compare_along(
                &mut rows,
                &surroundings,
                &known,
                outputs,
                &direction,
                &place,
            );
        }
    }
    Ok(rows.into_checks(judged, &names, samples.len()))
}

fn draw_samples(oracle: &Oracle) -> Result<Vec<Sample>, OracleError> {
    let mut sampler = Sampler::new(oracle, SEED)?;
    let (most, fewest) = STATES;
    let mut samples = Vec::new();
    let regimes = sampler.visit_regimes()?.visited;
    for regime in regimes
        .iter()
        .cycle()
        .take(regimes.len().clamp(fewest, most))
    {
        samples.extend(sampler.draw_in(regime)?.map(|drawn| drawn.sample));
    }
    Ok(samples)
}
