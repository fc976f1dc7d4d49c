//! Random states inside regimes. States on a switching surface are excluded, because the equations of both sides are
//! correct there.

use super::super::oracle::{Oracle, OracleError};
use super::super::sampler::{Sample, Sampler};
use super::super::variant::Variant;

/// Displacement that tests whether a guard remains 0 nearby, relative to the sizes of the entries.
const REST_DISPLACEMENT: f64 = 1e-6;

/// Draws up to `per_regime` states in every regime and as many in any regime.
pub fn interior_samples(
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
    for regime in sampler.visit_regimes()?.visited {
        for _ in 0..per_regime {
            let Some(found) = sampler.draw_in(&regime)? else {
                break;
            };
            drawn.push(found.sample);
        }
    }
    let mut inside = Vec::new();
    for sample in drawn {
        let nearby = displace_sample(&sample, &sampler.draw());
        match is_inside(variant, &sample, &nearby) {
            Ok(true) => inside.push(sample),
            Ok(false) => {}
            Err(message) => return Ok(Err(message)),
        }
    }
    if inside.is_empty() {
        return Ok(Err(
            "every sampled state is on a switching surface or outside the model's domain"
                .to_owned(),
        ));
    }
    Ok(Ok(inside))
}

fn displace_sample(sample: &Sample, other: &Sample) -> Sample {
    let pairs = sample.state.iter().zip(&other.state);
    Sample {
        state: pairs
            .map(|(here, other)| here + REST_DISPLACEMENT * other)
            .collect(),
        ..sample.clone()
    }
}

/// Returns true if every guard that is 0 at a state is also 0 nearby.
fn is_inside(variant: &mut dyn Variant, sample: &Sample, nearby: &Sample) -> Result<bool, String> {
    let here = variant.guards(sample.time, &sample.state, &sample.inputs)?;
    if here.iter().all(|guard| *guard != 0.0) {
        return Ok(true);
    }
    let there = variant.guards(nearby.time, &nearby.state, &nearby.inputs)?;
    let mut pairs = here.iter().zip(&there);
    Ok(pairs.all(|(here, there)| *here != 0.0 || *there == 0.0))
}
