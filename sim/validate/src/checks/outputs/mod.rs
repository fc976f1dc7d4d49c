//! Comparison of the requested outputs with the oracle:
//!
//! - inverse dynamics and bias forces: by its mass matrix and forces;
//! - Jacobians and their products: by directional differences of its rows;
//! - guard rates: by differences of the guards along its motion.

mod derivatives;
mod directions;
mod forces;
mod guard_rates;
mod judged;
mod rows;

use crate::certificate::Check;
use crate::differences::Surroundings;
use crate::oracle::{Oracle, OracleError};
use crate::outputs::Outputs;
use crate::random::Random;
use crate::sampler::{Sample, Sampler};
use crate::variant::Variant;

use derivatives::{Known, along};
use directions::directions;
use forces::forces;
use guard_rates::guard_rates;
pub(crate) use judged::Judged;
pub use rows::DIFFERENCE_TOLERANCE;
use rows::Rows;

/// Maximum and minimum number of states, each in another regime if there are enough.
const STATES: (usize, usize) = (9, 4);
const SEED: u64 = 0x4e0b_1a75;

pub(crate) fn check(
    judged: &Judged<'_>,
    variant: &mut dyn Variant,
    outputs: &mut dyn Outputs,
) -> Result<Vec<Check>, OracleError> {
    let names = outputs.names();
    let mut rows = Rows::default();
    let mut random = Random::new(SEED);
    let samples = samples(judged.oracle)?;
    for (count, sample) in (1..).zip(&samples) {
        let place = format!("state {count}");
        let equations = judged
            .oracle
            .equations(sample.time, &sample.state, &sample.inputs)?;
        forces(&mut rows, &equations, outputs, sample, &mut random, &place);
        guard_rates(&mut rows, judged.oracle, variant, outputs, sample, &place)?;
        let Some(unknowns) = equations.unknowns() else {
            continue;
        };
        let surroundings = Surroundings {
            oracle: judged.oracle,
            model: judged.model,
            order: judged.order,
            parameters: judged.parameters,
            sample,
            unknowns,
        };
        let known = Known::new(judged, &equations, outputs, sample, &mut random);
        for direction in directions(judged, &names, count <= 2, &mut random)? {
            along(
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

fn samples(oracle: &Oracle) -> Result<Vec<Sample>, OracleError> {
    let mut sampler = Sampler::new(oracle, SEED)?;
    let (most, fewest) = STATES;
    let mut samples = Vec::new();
    let regimes = sampler.regimes()?.visited;
    for regime in regimes
        .iter()
        .cycle()
        .take(regimes.len().clamp(fewest, most))
    {
        samples.extend(sampler.draw_in(regime)?.map(|drawn| drawn.sample));
    }
    Ok(samples)
}
