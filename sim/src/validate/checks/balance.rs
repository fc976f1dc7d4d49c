//! The power balance d(T + V)/dt = power along a trajectory of the subject. At every
//! step the change of the energies along the subject's own motion is formed by automatic
//! differentiation, so the balance holds to rounding and does not depend on how well the
//! trajectory was integrated.

use super::super::certificate::{Check, Worst};
use super::super::oracle::{Oracle, OracleError};
use super::super::sampler::{Sample, Sampler};
use super::super::variant::Variant;
use super::{ROW_TOLERANCE, accelerations};

/// Name of the check.
const NAME: &str = "power_balance";
/// Steps of the trajectory.
const STEPS: usize = 200;
/// How often the step is divided by four.
const REFINEMENTS: usize = 8;
/// The growth of the energy that no trajectory this short has by itself.
const RUNAWAY: f64 = 1e3;
/// The seed of the initial state.
const SEED: u64 = 0xba1a_4ce5;

/// The power balance along a trajectory from a random state, with classical Runge-Kutta
/// steps of a twelfth of the shortest period a coordinate has by itself. Coupled modes
/// may be faster: if the energy runs away, shorter steps are tried.
///
/// # Errors
/// [`OracleError`] as from [`Oracle::equations`].
pub fn check(oracle: &Oracle, variant: &mut dyn Variant) -> Result<Check, OracleError> {
    let mut sampler = Sampler::new(oracle, SEED)?;
    let start = sampler.draw();
    if !oracle.is_scleronomic(start.time, &start.state, &start.inputs)? {
        let reason = "an energy depends on time or inputs, or the kinetic energy is no \
                      quadratic form of the rates: T + V is not what the forces change";
        return Ok(Check::skipped(NAME, ROW_TOLERANCE, reason));
    }
    let mut step = 0.5 / sampler.highest_frequency();
    for _ in 0..REFINEMENTS {
        if let Some(worst) = along(oracle, variant, start.clone(), step)? {
            return Ok(Check::made(NAME, worst, ROW_TOLERANCE));
        }
        step *= 0.25;
    }
    let worst = Worst::of(f64::INFINITY, "the energy runs away at any step");
    Ok(Check::made(NAME, worst, ROW_TOLERANCE))
}

/// The largest imbalance along a trajectory; none if its energy runs away.
fn along(
    oracle: &Oracle,
    variant: &mut dyn Variant,
    mut sample: Sample,
    step: f64,
) -> Result<Option<Worst>, OracleError> {
    let energy = |sample: &Sample| oracle.energy(sample.time, &sample.state, &sample.inputs);
    let bound = RUNAWAY * energy(&sample)?.scale;
    let mut worst = Worst::default();
    for count in 0..=STEPS {
        match imbalance(oracle, variant, &sample)? {
            Ok(value) => worst.include(Worst::of(value, format!("step {count} of {STEPS}"))),
            Err(message) => worst.include(Worst::of(f64::INFINITY, message)),
        }
        if worst.value() == f64::INFINITY {
            break;
        }
        if let Err(message) = advance(variant, &mut sample, step) {
            worst.include(Worst::of(f64::INFINITY, message));
            break;
        }
        if sample.state.iter().any(|value| !value.is_finite()) {
            // The motion left the domain of a function such as asin: the steps so far count.
            break;
        }
        let scale = energy(&sample)?.scale;
        if scale.is_nan() || scale > bound {
            return Ok(None);
        }
    }
    Ok(Some(worst))
}

/// |d(T + V)/dt - power| relative to the largest addend of both.
fn imbalance(
    oracle: &Oracle,
    variant: &mut dyn Variant,
    sample: &Sample,
) -> Result<Result<f64, String>, OracleError> {
    let Sample {
        time,
        state,
        inputs,
    } = sample;
    let found = accelerations(variant, *time, state, inputs).and_then(|accelerations| {
        let power = variant.power(*time, state, inputs)?;
        Ok((accelerations, power))
    });
    let (accelerations, power) = match found {
        Ok(found) => found,
        Err(message) => return Ok(Err(message)),
    };
    let rate = oracle.energy_rate(*time, state, &accelerations, inputs)?;
    let expected = oracle.power(*time, state, inputs)?;
    let difference = (rate.value - power).abs();
    let scale = rate.scale.max(expected.scale);
    Ok(Ok(if difference == 0.0 {
        0.0
    } else {
        difference / scale
    }))
}

/// One classical Runge-Kutta step.
fn advance(variant: &mut dyn Variant, sample: &mut Sample, step: f64) -> Result<(), String> {
    let start = sample.state.clone();
    let mut slope = vec![0.0; start.len()];
    let mut sum = vec![0.0; start.len()];
    for (share, weight) in [(0.0, 1.0), (0.5, 2.0), (0.5, 2.0), (1.0, 1.0)] {
        let stage = shifted(&start, &slope, share * step);
        let time = sample.time + share * step;
        variant.rates(time, &stage, &sample.inputs, &mut slope)?;
        for (sum, slope) in sum.iter_mut().zip(&slope) {
            *sum += weight * slope;
        }
    }
    sample.state = shifted(&start, &sum, step / 6.0);
    sample.time += step;
    Ok(())
}

fn shifted(state: &[f64], slope: &[f64], step: f64) -> Vec<f64> {
    let entries = state.iter().zip(slope);
    entries.map(|(entry, slope)| entry + step * slope).collect()
}
