//! Check of the columns of a dataset against a simulation of the beginning of a training record. A
//! column is wrong if it follows the model with the opposite sign or a unit factor, or if it
//! follows another channel. Missing effects do not cause such deviations. Nor do unknown initial
//! states: the motions that they cause are removed from both sides.

use crate::model::estimation_model::EstimationModel;
use crate::model::first_state::find_measured_states;
use crate::model::problem::EstimationProblem;
use crate::model::unknowns::ExpectedSensor;
use crate::thresholds;
use eomgen_records::Refusal;

/// Factors between units that are often confused.
const UNIT_FACTORS: [(f64, &str, &str); 6] = [
    (1e3, "a thousand times", ""),
    (1e-3, "a thousandth of", ""),
    (1e6, "a million times", ""),
    (1e-6, "a millionth of", ""),
    (
        57.295_779_513,
        "57.3 times",
        ", the factor from radians to degrees",
    ),
    (
        0.017_453_292_52,
        "1/57.3 of",
        ", the factor from degrees to radians",
    ),
];

/// Change of an unknown initial state for the computation of its free motion, relative to its
/// typical size.
const FREE_MOTION_FRACTION: f64 = 1e-3;

/// Minimum fraction of a free motion that other free motions do not explain, relative to its norm.
const MIN_INDEPENDENT_PART: f64 = 1e-9;

/// Returns a description of the factor between two units, relative to `expected`; `None` for other
/// factors.
pub(crate) fn describe_unit_factor(factor: f64, expected: &str) -> Option<String> {
    let is_near = |unit: f64| (factor / unit - 1.0).abs() < thresholds::FACTOR_TOLERANCE;
    let (_, times, as_units) = UNIT_FACTORS.iter().find(|(unit, _, _)| is_near(*unit))?;
    Some(format!("{times} {expected}{as_units}"))
}

/// Checks the columns of the first training record. Returns notes.
///
/// # Errors
///
/// A column that contains another quantity than declared.
pub fn check_channels(problem: &EstimationProblem<'_>, text: &str) -> Result<Vec<String>, Refusal> {
    let mut notes = Vec::new();
    let record = &problem.dataset.train[0];
    let Ok(model) = problem.compile_model(text, None) else {
        return Ok(notes);
    };
    let first = problem.estimate_first_state(&model, record);
    let samples = record.times.len().min(thresholds::CHECKED_SAMPLE_COUNT);
    let times = &record.times[..samples];
    let channels = &problem.dataset.channels;
    // If the model cannot be simulated here, errors appear in its fit.
    let simulate = |first: &[f64]| -> Option<Vec<Vec<f64>>> {
        let mut simulation = model.create_simulation(&model.values).ok()?;
        let run = simulation
            .simulate_outputs(first, times, &record.inputs)
            .ok()?;
        let column = |channel: usize| {
            run.values
                .chunks(channels.len())
                .map(move |row| row[channel])
        };
        Some(
            (0..channels.len())
                .map(|channel| column(channel).collect())
                .collect(),
        )
    };
    let Some(expected) = simulate(&first) else {
        return Ok(notes);
    };
    let mut free = vec![Vec::new(); channels.len()];
    for state in find_unknown_states(problem, &model) {
        let mut moved = first.clone();
        moved[state] += FREE_MOTION_FRACTION * model.typical_sizes()[state];
        let Some(motion) = simulate(&moved) else {
            return Ok(notes);
        };
        for ((free, moved), expected) in free.iter_mut().zip(motion).zip(&expected) {
            free.push(moved.iter().zip(expected).map(|(a, b)| a - b).collect());
        }
    }
    let expected: Vec<Expectation> = (expected.into_iter().zip(free).zip(&model.sensors))
        .map(|((values, free), sensor)| Expectation { values, free }.apply_sensor(sensor))
        .collect();
    for (own_index, channel) in channels.iter().enumerate() {
        let measured = &record.channels[own_index][..samples];
        let own = Correspondence::compare(times, &expected[own_index], measured, channel.noise);
        let reject = |message: String| {
            Err(Refusal::file_error(
                &record.path,
                format!("channel `{}`: {message}", channel.name),
            ))
        };
        if own.correlation < -thresholds::MIN_SAME_CORRELATION
            && (own.factor + 1.0).abs() < thresholds::UNIT_FACTOR_TOLERANCE
        {
            return reject(
                "its column has the opposite sign of the model; change the sign of the column or of the \
                 observable"
                    .to_owned(),
            );
        }
        if own.correlation > thresholds::MIN_SAME_CORRELATION {
            if let Some(words) = describe_unit_factor(own.factor, "the expected value") {
                return reject(format!("its column is {words}; check its unit"));
            }
            if (own.factor - 1.0).abs() < thresholds::UNIT_FACTOR_TOLERANCE {
                continue;
            }
        }
        for (other, instead) in channels.iter().enumerate() {
            let swapped = Correspondence::compare(times, &expected[other], measured, channel.noise);
            if other != own_index
                && swapped.correlation > thresholds::MIN_SAME_CORRELATION
                && (swapped.factor - 1.0).abs() < thresholds::FACTOR_TOLERANCE
            {
                return reject(format!(
                    "its column matches the expected values of `{}`; check if columns are exchanged",
                    instead.name
                ));
            }
        }
        if own.correlation.abs() < thresholds::MAX_WRONG_CORRELATION && own.has_motion {
            notes.push(format!(
                "{}: `{}` does not follow the model (correlation {:.2}); check its column and those of the \
                 inputs",
                record.name, channel.name, own.correlation
            ));
        }
    }
    Ok(notes)
}

/// Returns the states whose initial values the record does not show.
fn find_unknown_states(problem: &EstimationProblem<'_>, model: &EstimationModel) -> Vec<usize> {
    if !problem.estimates_initial_states() {
        return Vec::new();
    }
    let measured = find_measured_states(model, &problem.dataset.channels);
    let all = 0..model.state_count();
    all.filter(|state| !measured.contains(state)).collect()
}

/// Expected values of a channel at the samples.
struct Expectation {
    values: Vec<f64>,
    /// Changes of the values due to each unknown initial state.
    free: Vec<Vec<f64>>,
}

impl Expectation {
    /// Applies gain and bias of a sensor. Its delay hardly changes the correlation.
    fn apply_sensor(mut self, sensor: &ExpectedSensor) -> Self {
        for value in &mut self.values {
            *value = sensor.gain * *value + sensor.bias;
        }
        for change in self.free.iter_mut().flatten() {
            *change *= sensor.gain;
        }
        self
    }
}

/// Correlation of a column with its expected values. A linear trend and free motions are removed
/// from both.
struct Correspondence {
    correlation: f64,
    factor: f64,
    /// True if the motion of the column is large enough for the comparison.
    has_motion: bool,
}

impl Correspondence {
    fn compare(times: &[f64], expected: &Expectation, measured: &[f64], noise: f64) -> Self {
        let none = Self {
            correlation: 0.0,
            factor: 0.0,
            has_motion: false,
        };
        let known: Vec<usize> = (0..times.len())
            .filter(|i| measured[*i].is_finite() && expected.values[*i].is_finite())
            .collect();
        if 2 * known.len() < times.len() {
            return none;
        }
        let select = |column: &[f64]| known.iter().map(|i| column[*i]).collect::<Vec<f64>>();
        let line = [vec![1.0; times.len()], times.to_vec()];
        let removed: Vec<Vec<f64>> = line
            .iter()
            .chain(&expected.free)
            .map(|c| select(c))
            .collect();
        let basis = orthonormalise(removed);
        let [a, b] = [&expected.values[..], measured].map(|column| {
            let mut values = select(column);
            remove_components(&mut values, &basis);
            values
        });
        let (aa, ab, bb) = (dot(&a, &a), dot(&a, &b), dot(&b, &b));
        let has_motion =
            (bb / known.len() as f64).sqrt() > thresholds::MIN_CHECKED_MOTION_IN_NOISE * noise;
        if !(has_motion && aa > 0.0 && ab.is_finite()) {
            return none;
        }
        Self {
            correlation: ab / (aa * bb).sqrt(),
            factor: ab / aa,
            has_motion,
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// Returns an orthonormal basis of the columns, by the Gram-Schmidt method with a second pass.
fn orthonormalise(columns: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for mut column in columns {
        let before = dot(&column, &column).sqrt();
        for _ in 0..2 {
            remove_components(&mut column, &basis);
        }
        let length = dot(&column, &column).sqrt();
        if length.is_finite() && length > MIN_INDEPENDENT_PART * before {
            column.iter_mut().for_each(|value| *value /= length);
            basis.push(column);
        }
    }
    basis
}

/// Removes the components along orthonormal columns.
fn remove_components(values: &mut [f64], basis: &[Vec<f64>]) {
    for column in basis {
        let component = dot(values, column);
        for (value, part) in values.iter_mut().zip(column) {
            *value -= component * part;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Correspondence, Expectation, describe_unit_factor};

    #[test]
    fn only_factors_between_units_are_recognised() {
        let words = |factor: f64| describe_unit_factor(factor, "that");
        assert_eq!(words(998.5).as_deref(), Some("a thousand times that"));
        assert_eq!(
            words(0.01742).as_deref(),
            Some("1/57.3 of that, the factor from degrees to radians")
        );
        for other in [1.0, -1e3, 900.0, 60.0, 0.0, f64::NAN] {
            assert_eq!(words(other), None, "{other}");
        }
    }

    #[test]
    fn lines_and_free_motions_are_removed() {
        let times: Vec<f64> = (0..500).map(|i| f64::from(i) * 0.01).collect();
        let column = |value: &dyn Fn(f64) -> f64| times.iter().map(|t| value(*t)).collect();
        let wave = |t: f64| (7.0 * t).sin();
        let free = |t: f64| (-t).exp() * (3.0 * t).cos();
        let expected = Expectation {
            values: column(&wave),
            free: vec![column(&free), column(&|t| 2.0 * free(t))],
        };
        let measured: Vec<f64> = column(&|t| 5.0 * t - 2.0 * wave(t) + 9.0 * free(t));
        let found = Correspondence::compare(&times, &expected, &measured, 1e-3);
        assert!((found.factor + 2.0).abs() < 1e-9 && found.correlation < -0.999_999);
        let only_free: Vec<f64> = column(&|t| 3.0 - 2.0 * t - free(t));
        let found = Correspondence::compare(&times, &expected, &only_free, 1e-3);
        assert!(!found.has_motion, "{}", found.correlation);
    }
}
