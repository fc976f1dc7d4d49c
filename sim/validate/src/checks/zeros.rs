//! Check of rates and Jacobians at states with coordinates or rates equal to 0. Roots or quotients can be NaN at such
//! states.

use super::unknowns;
use crate::certificate::{Check, Worst};
use crate::oracle::{Oracle, OracleError};
use crate::outputs::{JACOBIANS, Outputs};
use crate::random::Random;
use crate::sampler::{Sample, Sampler};
use crate::variant::Variant;

const SEED: u64 = 0x2e20_0f0f;

/// Two step sizes for a test of differentiability, relative to the sizes of the entries.
const STEPS: [f64; 2] = [1e-3, 1e-5];

/// Largest ratio of the deviations from linearity at the two steps if a derivative exists.
const MAX_DEVIATION_RATIO: f64 = 0.2;

/// Largest deviation from linearity, relative to the largest slope, that counts as rounding.
const MAX_ROUNDING_DEVIATION: f64 = 1e-6;

const RATES: &str = "rates_at_zeros";
const JACOBIANS_AT_ZEROS: &str = "jacobians_at_zeros";

/// Checks that rates and Jacobians are finite at every state at which the oracle's are finite.
pub fn check(
    oracle: &Oracle,
    variant: &mut dyn Variant,
    mut outputs: Option<&mut (dyn Outputs + '_)>,
) -> Result<Vec<Check>, OracleError> {
    let mut sampler = Sampler::new(oracle, SEED)?;
    let Some(drawn) = sampler.draw_inside()? else {
        let reason = "no state in the model's domain was found";
        let jacobians = outputs.is_some().then_some(JACOBIANS_AT_ZEROS);
        let names = [RATES].into_iter().chain(jacobians);
        return Ok(names
            .map(|name| Check::not_run(name, 0.0, reason))
            .collect());
    };
    let sizes = sampler.sizes().to_vec();
    let (mut rates, mut jacobians) = (Findings::default(), Findings::default());
    for (place, sample) in states_with_zero(oracle, &drawn.sample) {
        let Some(accelerations) = solve_accelerations(oracle, &sample)? else {
            rates.record_exclusion(format!("the oracle is not finite at {place}"));
            continue;
        };
        let found = unknowns(variant, sample.time, &sample.state, &sample.inputs);
        let is_finite = found.is_ok_and(|found| found.iter().all(|rate| rate.is_finite()));
        rates.record_result(is_finite, &place);
        let Some(outputs) = outputs.as_deref_mut() else {
            continue;
        };
        for name in JACOBIANS {
            let Some(jacobian) = outputs.jacobian(name, &sample) else {
                continue;
            };
            let is_finite = jacobian.iter().all(|entry| entry.is_finite());
            let place = format!("{name}, {place}");
            // The oracle computes accelerations, not Jacobians, so differentiability is tested for this Jacobian only.
            let is_judged = name == "rates_by_state";
            if is_finite || is_judged && has_derivative(oracle, &sample, &accelerations, &sizes)? {
                jacobians.record_result(is_finite, &place);
            } else {
                jacobians.record_exclusion(format!("no derivative for {place}"));
            }
        }
    }
    let mut checks = vec![rates.into_check(RATES)];
    if jacobians.states > 0 || !jacobians.reasons.is_empty() {
        checks.push(jacobians.into_check(JACOBIANS_AT_ZEROS));
    }
    Ok(checks)
}

#[derive(Default)]
struct Findings {
    states: usize,
    worst: Worst,
    reasons: Vec<String>,
}

impl Findings {
    fn record_result(&mut self, is_finite: bool, place: &str) {
        self.states += 1;
        self.worst.include(match is_finite {
            true => Worst::from_deviation(0.0, "all numbers are finite"),
            false => Worst::from_deviation(f64::INFINITY, format!("infinite or NaN at {place}")),
        });
    }

    fn record_exclusion(&mut self, reason: String) {
        self.reasons.push(reason);
    }

    fn into_check(self, name: &str) -> Check {
        let left = match &self.reasons[..] {
            [] => String::new(),
            [one] => format!(" ({one})"),
            [first, others @ ..] => format!(" ({first}, and {} others)", others.len()),
        };
        if self.states == 0 {
            return Check::not_applicable(name, 0.0, format!("every state was excluded{left}"));
        }
        let worst = self
            .worst
            .with_count(self.states, &format!("states with zeros{left}"));
        Check::from_deviation(name, worst, 0.0)
    }
}

/// Returns copies of a sample: with each entry set to 0, with all rates set to 0 and with all
/// entries set to 0. Entries with a range that excludes 0 do not change.
fn states_with_zero(oracle: &Oracle, sample: &Sample) -> Vec<(String, Sample)> {
    let size = oracle.size();
    let names = oracle.names();
    let name = |entry: usize| match entry {
        entry if entry < size => format!("{} = 0", names[entry]),
        entry if entry < 2 * size => format!("{}_dot = 0", names[entry - size]),
        entry => format!("first-order state {} = 0", entry - 2 * size + 1),
    };
    let ranges = &oracle.ranges().state;
    let may_be_0 = |entry: usize| {
        let range = ranges.get(entry).copied().flatten();
        range.is_none_or(|(low, high)| (low..=high).contains(&0.0))
    };
    let at_0 = |entries: &[usize]| {
        let mut sample = sample.clone();
        for entry in entries {
            sample.state[*entry] = 0.0;
        }
        sample
    };
    let entries: Vec<usize> = (0..sample.state.len())
        .filter(|entry| may_be_0(*entry))
        .collect();
    let mut found: Vec<(String, Sample)> = entries
        .iter()
        .map(|entry| (name(*entry), at_0(&[*entry])))
        .collect();
    let rates: Vec<usize> = (size..2 * size).collect();
    found.push(("all rates = 0".to_owned(), at_0(&rates)));
    found.push(("all entries = 0".to_owned(), at_0(&entries)));
    found
}

/// Returns accelerations and rates of first-order states; `None` if one is not finite.
fn solve_accelerations(oracle: &Oracle, sample: &Sample) -> Result<Option<Vec<f64>>, OracleError> {
    let Sample {
        time,
        state,
        inputs,
    } = sample;
    let equations = oracle.equations_inside(*time, state, inputs)?;
    let found = equations.and_then(|equations| equations.unknowns());
    Ok(found.filter(|found| found.iter().all(|number| number.is_finite())))
}

/// Returns true if the deviation from a linear function decreases with the step, or is rounding.
fn has_derivative(
    oracle: &Oracle,
    sample: &Sample,
    here: &[f64],
    sizes: &[f64],
) -> Result<bool, OracleError> {
    let mut random = Random::new(SEED);
    let directions = [0, 1].map(|_| {
        let entries = sizes.iter().map(|size| size * random.away_from_zero());
        entries.collect::<Vec<f64>>()
    });
    let mut deviations = [0.0_f64; 2];
    let mut largest = 0.0_f64;
    for (deviation, step) in deviations.iter_mut().zip(STEPS) {
        let at = |first: f64, second: f64| {
            let mut moved = sample.clone();
            let pairs = directions[0].iter().zip(&directions[1]);
            for (entry, (a, b)) in moved.state.iter_mut().zip(pairs) {
                *entry += first * a + second * b;
            }
            solve_accelerations(oracle, &moved)
        };
        let all = [
            at(step, 0.0)?,
            at(-step, 0.0)?,
            at(0.0, step)?,
            at(0.0, -step)?,
            at(step, step)?,
        ];
        let [Some(a), Some(minus_a), Some(b), Some(minus_b), Some(both)] = all else {
            return Ok(false);
        };
        for row in 0..here.len() {
            let slope = |to: &[f64]| (to[row] - here[row]) / step;
            let (by_a, by_b) = (slope(&a), slope(&b));
            let parts = [
                by_a + slope(&minus_a),
                by_b + slope(&minus_b),
                slope(&both) - by_a - by_b,
            ];
            *deviation = parts
                .into_iter()
                .fold(*deviation, |most, part| most.max(part.abs()));
            largest = largest.max(by_a.abs()).max(here[row].abs());
        }
    }
    let [long, short] = deviations;
    Ok(short <= MAX_DEVIATION_RATIO * long || short <= MAX_ROUNDING_DEVIATION * largest)
}
