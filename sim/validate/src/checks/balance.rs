//! The power balance d(T + V)/dt = power along trajectories of the subject. At every step
//! the change of the energies along the subject's own motion is formed by automatic
//! differentiation, explicit time included, so the balance holds to rounding and does not
//! depend on how well the trajectory was integrated.

use super::super::certificate::{Check, Worst};
use super::super::oracle::{Conditioned, Equations, Oracle, OracleError};
use super::super::sampler::{Sample, Sampler};
use super::super::variant::Variant;
use super::{ROW_TOLERANCE, unknowns};

/// Name of the check.
const NAME: &str = "power_balance";
/// Steps looked at, along as many trajectories as they take.
const STEPS: usize = 200;
/// The most trajectories. One ends where the motion leaves the model's domain or has come
/// to rest.
const TRAJECTORIES: usize = 20;
/// How often a step is halved until it is accepted; a jump of the rates never is otherwise.
const HALVINGS: usize = 10;
/// How far two half steps may end from a whole one, relative to the state and its size.
const ACCURACY: f64 = 1e-3;
/// Below this magnitude, in W, products of terms are subnormal and their rounding is no
/// longer relative.
const REST: f64 = 1e-280;
/// The seed of the initial states.
const SEED: u64 = 0xba1a_4ce5;

/// The power balance along trajectories from random states, with classical Runge-Kutta
/// steps of at most a twelfth of the shortest period a coordinate has by itself. Shorter ones are
/// taken where coupled modes are faster; how the energy grows or falls is the model's.
///
/// # Errors
/// [`OracleError`] as from [`Oracle::equations`].
pub fn check(oracle: &Oracle, variant: &mut dyn Variant) -> Result<Check, OracleError> {
    let mut sampler = Sampler::new(oracle, SEED)?;
    let mut motion = Motion {
        sizes: sampler.sizes().to_vec(),
        longest: 0.5 / sampler.highest_frequency(),
        looked: 0,
        worst: Worst::default(),
    };
    for _ in 0..TRAJECTORIES {
        if motion.looked >= STEPS {
            break;
        }
        let Some(drawn) = sampler.draw_inside()? else {
            break;
        };
        motion.follow(oracle, variant, drawn.sample)?;
    }
    let worst = motion.worst.among(motion.looked, "steps");
    Ok(Check::made(NAME, worst, ROW_TOLERANCE))
}

/// What trajectories have shown.
struct Motion {
    /// How large the entries of a state are.
    sizes: Vec<f64>,
    /// The longest step, in s.
    longest: f64,
    /// Steps looked at.
    looked: usize,
    worst: Worst,
}

impl Motion {
    /// Looks at a trajectory step by step until it ends or enough was seen.
    fn follow(
        &mut self,
        oracle: &Oracle,
        variant: &mut dyn Variant,
        mut sample: Sample,
    ) -> Result<(), OracleError> {
        let mut step = self.longest;
        while self.looked < STEPS {
            let Sample {
                time,
                state,
                inputs,
            } = &sample;
            let Some(equations) = oracle.equations_inside(*time, state, inputs)? else {
                return Ok(());
            };
            let place = format!("step {}", self.looked + 1);
            let balance = imbalance(oracle, &equations, variant, &sample)?;
            if matches!(&balance, Ok((value, size)) if *value > 0.0 && *size < REST) {
                return Ok(());
            }
            self.looked += 1;
            let next = match balance {
                Ok((deviation, _)) => {
                    self.worst.include(Worst::of(deviation, place));
                    self.advance(variant, &sample, &mut step)
                }
                Err(message) => Err(message),
            };
            match next {
                Ok(next) => sample = next,
                Err(message) => {
                    self.worst.include(Worst::of(f64::INFINITY, message));
                    return Ok(());
                }
            }
        }
        Ok(())
    }

    /// The state after a step, or after the half of it that is short enough. The next one is
    /// twice as long.
    fn advance(
        &self,
        variant: &mut dyn Variant,
        sample: &Sample,
        step: &mut f64,
    ) -> Result<Sample, String> {
        for _ in 0..HALVINGS {
            let whole = moved(variant, sample, *step)?;
            let half = moved(variant, sample, 0.5 * *step)?;
            let halves = moved(variant, &half, 0.5 * *step)?;
            if self.is_near(&whole, &halves) {
                *step = (2.0 * *step).min(self.longest);
                return Ok(halves);
            }
            *step *= 0.5;
        }
        moved(variant, sample, *step)
    }

    fn is_near(&self, first: &Sample, second: &Sample) -> bool {
        let states = first.state.iter().zip(&second.state);
        let mut entries = states.zip(&self.sizes);
        entries.all(|((first, second), size)| {
            (first - second).abs() <= ACCURACY * (size + second.abs())
        })
    }
}

/// |d(T + V)/dt - power| relative to the terms of both, and the magnitude of these.
///
/// The difference is the power of what is left of the rows at the variant's accelerations. These
/// hold a row to a share of its largest term, in which inertias of other coordinates may cancel,
/// so a row's term times the row's rate is a term here too.
fn imbalance(
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

/// One classical Runge-Kutta step.
fn moved(variant: &mut dyn Variant, sample: &Sample, step: f64) -> Result<Sample, String> {
    let start = &sample.state;
    let mut slope = vec![0.0; start.len()];
    let mut sum = vec![0.0; start.len()];
    for (share, weight) in [(0.0, 1.0), (0.5, 2.0), (0.5, 2.0), (1.0, 1.0)] {
        let stage = shifted(start, &slope, share * step);
        let time = sample.time + share * step;
        variant.rates(time, &stage, &sample.inputs, &mut slope)?;
        for (sum, slope) in sum.iter_mut().zip(&slope) {
            *sum += weight * slope;
        }
    }
    Ok(Sample {
        time: sample.time + step,
        state: shifted(start, &sum, step / 6.0),
        inputs: sample.inputs.clone(),
    })
}

fn shifted(state: &[f64], slope: &[f64], step: f64) -> Vec<f64> {
    let entries = state.iter().zip(slope);
    entries.map(|(entry, slope)| entry + step * slope).collect()
}
