//! Power balance d(T + V)/dt = power along trajectories of the variant. At every step, automatic differentiation
//! computes the rate of the energy for the variant's accelerations, including explicit time. Therefore the balance
//! holds to rounding, independent of the integration error.

use super::super::certificate::{Check, Worst};
use super::super::oracle::{Conditioned, Equations, Oracle, OracleError};
use super::super::sampler::{Sample, Sampler};
use super::super::variant::Variant;
use super::{ROW_TOLERANCE, unknowns};

const NAME: &str = "power_balance";
/// Number of steps to check, on all trajectories together.
const CHECKED_STEPS: usize = 200;
/// Maximum number of trajectories. A trajectory ends if the motion leaves the domain or comes to rest.
const TRAJECTORIES: usize = 20;
/// Maximum number of halvings of a step. At a jump of the rates no step size would be accepted.
const MAX_STEP_HALVINGS: usize = 10;
/// Largest accepted difference between two half steps and one full step, relative to the state and its typical size.
const MAX_STEP_DIFFERENCE: f64 = 1e-3;
/// Smallest magnitude of the terms that is compared, in W. Below it, products are subnormal and less accurate.
const MIN_POWER_W: f64 = 1e-280;
const SEED: u64 = 0xba1a_4ce5;

/// Checks the power balance along trajectories from random states. Classical Runge-Kutta steps are
/// at most a twelfth of the shortest period, uncoupled or coupled.
pub fn check(oracle: &Oracle, variant: &mut dyn Variant) -> Result<Check, OracleError> {
    let mut sampler = Sampler::new(oracle, SEED)?;
    let mut motion = BalanceCheck {
        sizes: sampler.sizes().to_vec(),
        max_step_s: 0.5 / sampler.highest_frequency(),
        checked_steps: 0,
        worst: Worst::default(),
    };
    for _ in 0..TRAJECTORIES {
        if motion.checked_steps >= CHECKED_STEPS {
            break;
        }
        let Some(drawn) = sampler.draw_inside()? else {
            break;
        };
        motion.check_trajectory(oracle, variant, drawn.sample)?;
    }
    let worst = motion.worst.with_count(motion.checked_steps, "steps");
    Ok(Check::from_deviation(NAME, worst, ROW_TOLERANCE))
}

struct BalanceCheck {
    sizes: Vec<f64>,
    /// Largest step size, in s.
    max_step_s: f64,
    checked_steps: usize,
    worst: Worst,
}

impl BalanceCheck {
    fn check_trajectory(
        &mut self,
        oracle: &Oracle,
        variant: &mut dyn Variant,
        mut sample: Sample,
    ) -> Result<(), OracleError> {
        let mut step = self.max_step_s;
        while self.checked_steps < CHECKED_STEPS {
            let Sample {
                time,
                state,
                inputs,
            } = &sample;
            let Some(equations) = oracle.equations_inside(*time, state, inputs)? else {
                return Ok(());
            };
            let place = format!("step {}", self.checked_steps + 1);
            let balance = power_imbalance(oracle, &equations, variant, &sample)?;
            if matches!(&balance, Ok((value, size)) if *value > 0.0 && *size < MIN_POWER_W) {
                return Ok(());
            }
            self.checked_steps += 1;
            let next = match balance {
                Ok((deviation, _)) => {
                    self.worst.include(Worst::from_deviation(deviation, place));
                    self.take_checked_step(variant, &sample, &mut step)
                }
                Err(message) => Err(message),
            };
            match next {
                Ok(next) => sample = next,
                Err(message) => {
                    self.worst
                        .include(Worst::from_deviation(f64::INFINITY, message));
                    return Ok(());
                }
            }
        }
        Ok(())
    }

    /// Takes a step with step size control: halves the step until two half steps agree with it, then doubles it for the
    /// next call.
    fn take_checked_step(
        &self,
        variant: &mut dyn Variant,
        sample: &Sample,
        step: &mut f64,
    ) -> Result<Sample, String> {
        for _ in 0..MAX_STEP_HALVINGS {
            let whole = take_step(variant, sample, *step)?;
            let half = take_step(variant, sample, 0.5 * *step)?;
            let halves = take_step(variant, &half, 0.5 * *step)?;
            if self.is_near(&whole, &halves) {
                *step = (2.0 * *step).min(self.max_step_s);
                return Ok(halves);
            }
            *step *= 0.5;
        }
        take_step(variant, sample, *step)
    }

    fn is_near(&self, first: &Sample, second: &Sample) -> bool {
        let states = first.state.iter().zip(&second.state);
        let mut entries = states.zip(&self.sizes);
        entries.all(|((first, second), size)| {
            (first - second).abs() <= MAX_STEP_DIFFERENCE * (size + second.abs())
        })
    }
}

/// Returns |d(T + V)/dt - power| relative to the terms of both, and the magnitude of these.
///
/// The difference is the power of the residuals at the variant's accelerations. A residual is small only relative to
/// the largest term of its row, and inertia terms can cancel within a row. Therefore the scale includes the largest
/// term of each row times the rate of its coordinate.
fn power_imbalance(
    oracle: &Oracle,
    equations: &Equations,
    variant: &mut dyn Variant,
    sample: &Sample,
) -> Result<Result<(f64, f64), String>, OracleError> {
    let Sample {
        time,
        state,
        inputs,
    } = sample;
    let found = unknowns(variant, *time, state, inputs).and_then(|unknowns| {
        let power = variant.power(*time, state, inputs)?;
        Ok((unknowns, power))
    });
    let (mut accelerations, power) = match found {
        Ok(found) => found,
        Err(message) => return Ok(Err(message)),
    };
    accelerations.truncate(oracle.size());
    let rate = oracle.energy_rate(*time, state, &accelerations, inputs)?;
    let forces = oracle.power(*time, state, inputs)?;
    let rows = equations.residuals(&accelerations);
    let rates = &state[accelerations.len()..];
    let rows = rows
        .iter()
        .zip(rates)
        .map(|(row, rate)| row.scale * rate.abs());
    let magnitude = rows.fold(rate.magnitude.max(forces.magnitude), f64::max);
    let rate = Conditioned::new(rate.value, magnitude);
    Ok(Ok((rate.deviation(power), rate.magnitude)))
}

fn take_step(variant: &mut dyn Variant, sample: &Sample, step: f64) -> Result<Sample, String> {
    let start = &sample.state;
    let mut slope = vec![0.0; start.len()];
    let mut sum = vec![0.0; start.len()];
    for (share, weight) in [(0.0, 1.0), (0.5, 2.0), (0.5, 2.0), (1.0, 1.0)] {
        let stage = add_scaled(start, &slope, share * step);
        let time = sample.time + share * step;
        variant.rates(time, &stage, &sample.inputs, &mut slope)?;
        for (sum, slope) in sum.iter_mut().zip(&slope) {
            *sum += weight * slope;
        }
    }
    Ok(Sample {
        time: sample.time + step,
        state: add_scaled(start, &sum, step / 6.0),
        inputs: sample.inputs.clone(),
    })
}

fn add_scaled(state: &[f64], slope: &[f64], step: f64) -> Vec<f64> {
    let entries = state.iter().zip(slope);
    entries.map(|(entry, slope)| entry + step * slope).collect()
}
