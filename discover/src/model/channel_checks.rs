//! Check of the columns of a dataset against the model, simulated over the beginning of a training
//! record. An error is a column that follows the model with the opposite sign, with a unit factor,
//! or that follows another channel. A missing effect causes none of these.

use crate::model::problem::EstimationProblem;
use crate::thresholds;
use eomgen_records::Refusal;

/// Factors between units that are often taken for each other.
const FACTORS: [(f64, &str, &str); 6] = [
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

/// Returns a description of a factor between two units, relative to `expected`; `None` for other
/// factors.
pub(crate) fn describe_unit_factor(factor: f64, expected: &str) -> Option<String> {
    let is_near = |unit: f64| (factor / unit - 1.0).abs() < thresholds::FACTOR_TOLERANCE;
    let (_, times, as_units) = FACTORS.iter().find(|(unit, _, _)| is_near(*unit))?;
    Some(format!("{times} {expected}{as_units}"))
}

/// Checks the columns of the first training record and returns remarks.
///
/// # Errors
///
/// A column with a wrong name.
pub fn check_channels(problem: &EstimationProblem<'_>, text: &str) -> Result<Vec<String>, Refusal> {
    let mut notes = Vec::new();
    let record = &problem.dataset.train[0];
    let Ok(model) = problem.compile_model(text, None) else {
        return Ok(notes);
    };
    let first = problem.estimate_first_state(&model, record);
    let samples = record.times.len().min(thresholds::CHECKED_SAMPLES);
    let times = &record.times[..samples];
    let run = model
        .create_simulation(&model.values)
        .and_then(|mut simulation| simulation.simulate_outputs(&first, times, &record.inputs));
    // A model that cannot be run so far is tested by its fit.
    let Ok(run) = run else { return Ok(notes) };
    let channels = &problem.dataset.channels;
    let count = channels.len();
    let expected: Vec<Vec<f64>> = (0..count)
        .map(|channel| {
            let column = (0..samples).map(|sample| run.values[sample * count + channel]);
            column.collect()
        })
        .collect();
    for (own_index, channel) in channels.iter().enumerate() {
        let measured = &record.channels[own_index][..samples];
        let own = Correspondence::of(times, &expected[own_index], measured, channel.noise);
        let refuse = |message: String| {
            Err(Refusal::file_error(
                &record.path,
                format!("channel `{}`: {message}", channel.name),
            ))
        };
        if own.correlation < -thresholds::MIN_SAME_CORRELATION
            && (own.factor + 1.0).abs() < thresholds::UNIT_FACTOR_TOLERANCE
        {
            return refuse(
                "its column has the opposite sign of the model; change the sign of the column or of the \
                 observable"
                    .to_owned(),
            );
        }
        if own.correlation > thresholds::MIN_SAME_CORRELATION {
            if let Some(words) = describe_unit_factor(own.factor, "the expected value") {
                return refuse(format!("its column is {words}; check its unit"));
            }
            if (own.factor - 1.0).abs() < thresholds::UNIT_FACTOR_TOLERANCE {
                continue;
            }
        }
        for (other, instead) in channels.iter().enumerate() {
            let swapped = Correspondence::of(times, &expected[other], measured, channel.noise);
            if other != own_index
                && swapped.correlation > thresholds::MIN_SAME_CORRELATION
                && (swapped.factor - 1.0).abs() < thresholds::FACTOR_TOLERANCE
            {
                return refuse(format!(
                    "its column matches the expected values of `{}`; check if columns are exchanged",
                    instead.name
                ));
            }
        }
        if own.correlation.abs() < thresholds::MAX_WRONG_CORRELATION && own.shows {
            notes.push(format!(
                "{}: `{}` does not follow the model (correlation {:.2}); check its column and those of the \
                 inputs",
                record.name, channel.name, own.correlation
            ));
        }
    }
    Ok(notes)
}

/// Correlation of a column with its expectation after removing a line from both.
struct Correspondence {
    correlation: f64,
    factor: f64,
    /// True if there is enough to be followed.
    shows: bool,
}

impl Correspondence {
    fn of(times: &[f64], expected: &[f64], measured: &[f64], noise: f64) -> Self {
        let none = Self {
            correlation: 0.0,
            factor: 0.0,
            shows: false,
        };
        let known: Vec<usize> = (0..times.len())
            .filter(|i| measured[*i].is_finite() && expected[*i].is_finite())
            .collect();
        if 2 * known.len() < times.len() {
            return none;
        }
        let of = |column: &[f64]| {
            let pairs: Vec<(f64, f64)> = known.iter().map(|i| (times[*i], column[*i])).collect();
            without_line(&pairs)
        };
        let (a, b) = (of(expected), of(measured));
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        let (aa, ab, bb) = (dot(&a, &a), dot(&a, &b), dot(&b, &b));
        let shows =
            (bb / known.len() as f64).sqrt() > thresholds::MIN_CHECKED_MOTION_IN_NOISE * noise;
        if !(shows && aa > 0.0 && ab.is_finite()) {
            return none;
        }
        Self {
            correlation: ab / (aa * bb).sqrt(),
            factor: ab / aa,
            shows,
        }
    }
}

/// Values with the line that fits them best taken out.
fn without_line(pairs: &[(f64, f64)]) -> Vec<f64> {
    let count = pairs.len() as f64;
    let mean = |of: &dyn Fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>() / count;
    let (t, x) = (mean(&|p| p.0), mean(&|p| p.1));
    let square = mean(&|p| (p.0 - t).powi(2));
    let slope = mean(&|p| (p.0 - t) * (p.1 - x)) / square;
    let value = |p: &(f64, f64)| p.1 - x - slope * (p.0 - t);
    pairs.iter().map(value).collect()
}

#[cfg(test)]
mod tests {
    use super::{Correspondence, describe_unit_factor, without_line};

    #[test]
    fn a_factor_between_units_is_known_and_no_other() {
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
    fn a_line_is_taken_out_and_nothing_else() {
        let wave = |t: f64| (7.0 * t).sin();
        let times: Vec<f64> = (0..500).map(|i| f64::from(i) * 0.01).collect();
        let line: Vec<(f64, f64)> = times.iter().map(|t| (*t, 3.0 - 2.0 * t)).collect();
        assert!(without_line(&line).iter().all(|v| v.abs() < 1e-12));
        let expected: Vec<f64> = times.iter().map(|t| wave(*t)).collect();
        let measured: Vec<f64> = times.iter().map(|t| 5.0 * t - 2.0 * wave(*t)).collect();
        let correspondence = Correspondence::of(&times, &expected, &measured, 1e-3);
        assert!(
            (correspondence.factor + 2.0).abs() < 1e-9 && correspondence.correlation < -0.999_999
        );
    }
}
