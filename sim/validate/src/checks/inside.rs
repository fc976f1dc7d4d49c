//! States inside regimes: none on a surface, where either side is right.

use super::super::oracle::{Oracle, OracleError};
use super::super::sampler::{Sample, Sampler};
use super::super::variant::Variant;

/// How far a state is moved to see whether a switching function rests there, in sizes of its
/// entries.
const NEARBY: f64 = 1e-6;

/// Up to so many states in every regime, and as many that are drawn whatever their regime.
///
/// # Errors
/// [`OracleError`] as from [`Oracle::equations`]; within, what the variant says, or that there
/// is no such state, so that a comparison over nothing never passes.
pub fn samples(
    oracle: &Oracle,
    variant: &mut dyn Variant,
    per_regime: usize,
    seed: u64,
) -> Result<Result<Vec<Sample>, String>, OracleError> {
    let mut sampler = Sampler::new(oracle, seed)?;
    let mut drawn = Vec::new();
    for _ in 0..per_regime {
        let Some(found) = sampler.draw_inside()? else {
            break;
        };
        drawn.push(found.sample);
    }
    for regime in sampler.regimes()?.visited {
        for _ in 0..per_regime {
            let Some(found) = sampler.draw_in(&regime)? else {
                break;
            };
            drawn.push(found.sample);
        }
    }
    let mut inside = Vec::new();
    for sample in drawn {
        let nearby = nearby(&sample, &sampler.draw());
        match is_inside(variant, &sample, &nearby) {
            Ok(true) => inside.push(sample),
            Ok(false) => {}
            Err(message) => return Ok(Err(message)),
        }
    }
    if inside.is_empty() {
        return Ok(Err("no state was found inside any regime".to_owned()));
    }
    Ok(Ok(inside))
}

/// A sample moved a little in the direction of another one.
fn nearby(sample: &Sample, other: &Sample) -> Sample {
    let pairs = sample.state.iter().zip(&other.state);
    Sample {
        state: pairs.map(|(here, other)| here + NEARBY * other).collect(),
        ..sample.clone()
    }
}

/// Whether every switching function that is 0 at a state is so nearby.
fn is_inside(variant: &mut dyn Variant, sample: &Sample, nearby: &Sample) -> Result<bool, String> {
    let here = variant.guards(sample.time, &sample.state, &sample.inputs)?;
    if here.iter().all(|guard| *guard != 0.0) {
        return Ok(true);
    }
    let there = variant.guards(nearby.time, &nearby.state, &nearby.inputs)?;
    let mut pairs = here.iter().zip(&there);
    Ok(pairs.all(|(here, there)| *here != 0.0 || *there == 0.0))
}
