//! Study `gradients`: comparison of gradients of the motions of random machines with differences of motions along
//! random directions of parameters, initial state and inputs.

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};

use eomgen_compiled_model::{
    CompiledModel, Error, Instance, Motion, Orders, Request, SampleWeights, Solver,
    TrajectoryGradient,
};
use eomgen_sim::inputs::HeldInputs;
use eomgen_validate::random::Random;

use crate::sample::Sample;
use crate::solvers::machine::{Machine, draw};

const TOLERANCE: f64 = 1e-12;

const SAMPLES: usize = 7;

/// Step sizes of the differences, relative to the quantities.
const STEPS: [f64; 5] = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7];

/// Largest accepted error, relative to the sum of the magnitudes of all contributions. The estimated error of the
/// differences is added.
const ALLOWED_ERROR: f64 = 1e-6;

/// Beginning of the message about a rejected model.
const REJECTED_MODEL: &str = "no gradient of the trajectory: this model has ";

enum Outcome {
    /// Gradient and differences agree; the error is relative to the contributions.
    Equal(f64),
    /// The model or the motion has no gradient; the text is the reason.
    None(String),
}

/// Runs the study and returns its summary.
///
/// # Errors
///
/// Returns a report of all machines whose gradient differs from the differences.
pub fn run(sample: &Sample) -> Result<String, String> {
    let (mut equal, mut worst) = (0, 0.0_f64);
    let mut without: BTreeMap<String, usize> = BTreeMap::new();
    let mut failures = String::new();
    for index in 0..sample.count {
        let seed = sample.seed.wrapping_mul(1_000_003);
        let mut random = Random::new(seed.wrapping_add(index as u64));
        let machine = draw(&mut random);
        let judged = catch_unwind(AssertUnwindSafe(|| judge(&machine, &mut random)));
        let problem = match judged {
            Ok(Ok(Outcome::Equal(error))) => {
                equal += 1;
                worst = worst.max(error);
                continue;
            }
            Ok(Ok(Outcome::None(reason))) => {
                *without.entry(reason).or_default() += 1;
                continue;
            }
            Ok(Err(problem)) => problem,
            Err(_) => "panics".to_owned(),
        };
        failures += &format!(
            "machine {index} with {:?}: {problem}\n{}\n",
            machine.features, machine.text
        );
    }
    let without: Vec<String> = without
        .iter()
        .map(|(reason, count)| format!("{count} {reason}"))
        .collect();
    let summary = format!(
        "{equal} of {} gradients equal differences, largest error {worst:.1e}; without a gradient: {}",
        sample.count,
        without.join(", ")
    );
    match failures.is_empty() {
        true => Ok(summary),
        false => Err(failures + &summary),
    }
}

/// Motion of a machine as a function of parameters, initial state and inputs.
struct Case<'m> {
    model: &'m CompiledModel,
    run: Instance<'m>,
    times: Vec<f64>,
    inputs: HeldInputs,
    weights: SampleWeights,
    /// Directions of the independent parameters (SI), the initial state and the rows of the inputs.
    directions: (Vec<f64>, Vec<f64>, Vec<f64>),
}

fn judge(machine: &Machine, random: &mut Random) -> Result<Outcome, String> {
    let words = |error: Error| error.to_string();
    let model = CompiledModel::from_text("drawn.toml", &machine.text, Orders::Declared);
    let model = model.map_err(words)?;
    let run = model.with_declared_parameters().map_err(words)?;
    let last = (SAMPLES - 1) as f64;
    let times = (0..SAMPLES).map(|sample| machine.until * sample as f64 / last);
    let times: Vec<f64> = times.collect();
    let initial = run.initial_state().to_vec();
    let motion = run.simulate(&initial, &times, &machine.inputs, Solver::Rk);
    let states = motion.map_err(words)?.trajectory.states;
    let sizes = (0..initial.len()).map(|place| {
        let values = states.iter().map(|state| state[place].abs());
        values.fold(0.0_f64, f64::max)
    });
    let sizes: Vec<f64> = sizes.collect();
    let mut draw_weight = |size: &f64| match size {
        0.0 => 0.0,
        size => random.symmetric() / size,
    };
    let rows = (0..SAMPLES).map(|_| sizes.iter().map(&mut draw_weight).collect());
    let weights = SampleWeights {
        states: rows.collect(),
        observables: Vec::new(),
    };
    let mut scaled = |values: &[f64]| -> Vec<f64> {
        values
            .iter()
            .map(|value| value * random.symmetric())
            .collect()
    };
    let given = machine.inputs.times().iter();
    let given: Vec<f64> = given
        .flat_map(|t| machine.inputs.last_sample(*t).to_vec())
        .collect();
    let directions = (scaled(run.parameters()), scaled(&sizes), scaled(&given));
    let mut case = Case {
        model: &model,
        inputs: machine.inputs.clone(),
        run,
        times,
        weights,
        directions,
    };
    let gradient = match case.gradient() {
        Ok(gradient) => gradient,
        Err(error) => {
            let text = error.to_string();
            return match text.strip_prefix(REJECTED_MODEL) {
                Some(feature) => Ok(Outcome::None(first_word(feature))),
                None if text.starts_with("no gradient") => {
                    let cause = text.split(" s, ").nth(1).unwrap_or(&text);
                    Ok(Outcome::None(
                        cause.split('`').next().unwrap_or(cause).trim().to_owned(),
                    ))
                }
                None => Err(text),
            };
        }
    };
    if gradient.initial_state.is_none() {
        case.directions.1.fill(0.0);
    }
    case.compare(&gradient)
}

/// Returns the first word of a feature's description: its kind without its name.
fn first_word(feature: &str) -> String {
    feature
        .split('`')
        .next()
        .unwrap_or(feature)
        .trim()
        .to_owned()
}

impl Case<'_> {
    fn request<'r>(&'r self, initial: &'r [f64], inputs: &'r HeldInputs) -> Request<'r> {
        Request {
            initial,
            times: &self.times,
            inputs,
            solver: Solver::Rk,
            tolerance: TOLERANCE,
            max_step: f64::INFINITY,
            audit: false,
        }
    }

    fn gradient(&self) -> Result<TrajectoryGradient, Error> {
        let request = self.request(self.run.initial_state(), &self.inputs);
        let recorded = self.run.record_motion(&request, &mut |_| {})?;
        recorded.gradient(&self.weights)
    }

    /// Returns the weighted sum of the samples for quantities changed by `step` along their directions.
    fn value(&self, step: f64) -> Result<f64, Error> {
        let names = self.model.parameter_names();
        let known = &self.model.model().parameters;
        let values = self.run.parameters().iter().zip(&self.directions.0);
        let settings = names
            .iter()
            .zip(values)
            .filter_map(|(name, (value, along))| {
                let own = known.iter().find(|own| own.name == *name)?;
                Some((&**name, own.unit.from_si(value + step * along)))
            });
        let run = self.model.with_parameters(&settings.collect::<Vec<_>>())?;
        let moved = self.run.initial_state().iter().zip(&self.directions.1);
        let initial: Vec<f64> = moved.map(|(value, along)| value + step * along).collect();
        let times = self.inputs.times();
        let given = times
            .iter()
            .flat_map(|t| self.inputs.last_sample(*t).to_vec());
        let given = given.zip(&self.directions.2);
        let given = given.map(|(value, along)| value + step * along).collect();
        let count = self.directions.2.len() / times.len();
        let inputs = HeldInputs::new(times.to_vec(), given, count);
        let inputs = inputs.unwrap_or_else(|| self.inputs.clone());
        let motion = run.simulate_until_stop(&self.request(&initial, &inputs), &mut |_| {});
        let states = motion.and_then(Motion::into_complete)?.trajectory.states;
        let pairs = states
            .iter()
            .flatten()
            .zip(self.weights.states.iter().flatten());
        Ok(pairs.map(|(value, weight)| value * weight).sum())
    }

    fn compare(&self, gradient: &TrajectoryGradient) -> Result<Outcome, String> {
        let none = vec![0.0; self.directions.1.len()];
        let by_state = gradient.initial_state.as_ref().unwrap_or(&none);
        let by_inputs = gradient.inputs.iter().flatten();
        let parts = (gradient.parameters.iter().zip(&self.directions.0))
            .chain(by_state.iter().zip(&self.directions.1))
            .chain(by_inputs.zip(&self.directions.2));
        let parts: Vec<f64> = parts.map(|(by, along)| by * along).collect();
        let found: f64 = parts.iter().sum();
        let size: f64 = parts.iter().map(|part| part.abs()).sum();
        let pair = |step: f64| -> Result<f64, Error> {
            Ok((self.value(step)? - self.value(-step)?) / (2.0 * step))
        };
        let mut differences = Vec::new();
        for step in STEPS {
            let difference = pair(step).and_then(|near| Ok((4.0 * near - pair(2.0 * step)?) / 3.0));
            // With a large step, the simulation may fail.
            differences.extend(difference);
        }
        let pairs = differences.windows(2);
        let uncertainty = pairs.map(|pair| (pair[1] - pair[0]).abs());
        let uncertainty = uncertainty.fold(f64::INFINITY, f64::min);
        let errors = differences
            .iter()
            .map(|difference| (found - difference).abs());
        let error = errors.fold(f64::INFINITY, f64::min);
        if error <= ALLOWED_ERROR * size + uncertainty {
            return Ok(Outcome::Equal(error / size.max(f64::MIN_POSITIVE)));
        }
        Err(format!(
            "the gradient gives {found:e}, the differences {differences:?}, of contributions {size:e}"
        ))
    }
}
