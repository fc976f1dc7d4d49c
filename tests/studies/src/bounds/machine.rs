//! Comparison of bounds with the largest rounding errors of one machine.

use std::fmt;
use std::path::{Path, PathBuf};

use eomgen_codegen::program::Program;
use eomgen_codegen::rounding::{Format, RoundingBound, bound_quantities};
use eomgen_codegen::variant::Variant;
use eomgen_validate::oracle::Oracle;
use eomgen_validate::random::Random;
use eomgen_validate::rounding::VariableRanges;
use eomgen_validate::rounding::samples::ErrorSampler;

use crate::sample::Sample;

/// Order of all fields.
const ORDER: usize = 3;

/// Maximum number of single states for each machine and precision. Bounds take more time to compute than errors.
const STATES: usize = 1000;

/// Kinds of quantities, by the prefix of their names.
const KINDS: [&str; 4] = ["mass_matrix", "velocity_terms", "forces", "rates"];

/// Bounds and errors of the quantities of one kind, for one machine in one precision.
pub struct KindSummary {
    machine: String,
    format: Format,
    kind: String,
    /// Number of quantities with a bound, and number of all quantities.
    counts: [usize; 2],
    /// Bound and largest error of each quantity with a nonzero error, sorted by their ratio.
    pairs: Vec<(f64, f64)>,
    /// Report of errors that exceed their bounds, one line each.
    pub failures: String,
}

impl fmt::Display for KindSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [bounded, all] = self.counts;
        let (machine, kind) = (&self.machine, &self.kind);
        write!(
            f,
            "{machine} | {} | {kind} | {bounded} of {all} | ",
            self.format.name()
        )?;
        let ratio = |(bound, error): &(f64, f64)| bound / error;
        let (first, middle, last) = match &self.pairs[..] {
            [] => return write!(f, "no error |"),
            pairs => (&pairs[0], &pairs[pairs.len() / 2], &pairs[pairs.len() - 1]),
        };
        let ratios = [first, middle, last].map(ratio);
        write!(
            f,
            "{:.2}, {:.2}, {:.2} | {:.1e}, {:.1e}",
            ratios[0], ratios[1], ratios[2], last.0, last.1
        )
    }
}

/// Returns the paths of all shipped specifications.
pub fn machines() -> Result<Vec<PathBuf>, String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../model-spec/models");
    let words = |error: std::io::Error| format!("{}: {error}", folder.display());
    let entries = std::fs::read_dir(&folder).map_err(words)?;
    let mut paths = Vec::new();
    for entry in entries {
        paths.push(entry.map_err(words)?.path());
    }
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
    paths.sort();
    Ok(paths)
}

/// Compares a machine in both precisions.
///
/// # Errors
/// A machine that cannot be derived, or whose recorded operations are not bit-identical to the evaluator.
pub fn judge(path: &Path, sample: &Sample) -> Result<Vec<KindSummary>, String> {
    let name = path
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    let words = |error: &dyn fmt::Debug| format!("{name}: {error:?}");
    let model = eomgen_model_spec::load(path)
        .map_err(|error| words(&error))?
        .model;
    let values = model.parameter_values().map_err(|error| words(&error))?;
    let orders = vec![ORDER; model.fields.len()];
    let order = model.fields.first().map_or(0, |_| ORDER);
    let variant = Variant::derive(&model, &orders).map_err(|error| words(&error))?;
    let oracle = Oracle::new(&model, order, &values).map_err(|error| words(&error))?;
    let program = &variant.program;
    let ranges = VariableRanges::from_model(&model, program);
    let mut ranges = ranges.map_err(|error| words(&error))?;
    ranges
        .fill_missing(&oracle)
        .map_err(|error| words(&error))?;
    let mut rows = Vec::new();
    for format in Format::ALL {
        let bounds = bound_quantities(program, format, ranges.ranges());
        let mut sampler = ErrorSampler::new(program, format, ranges.ranges());
        let mut random = Random::new(sample.seed);
        for _ in 0..sample.count {
            sampler.draw(&mut random).map_err(|error| words(&error))?;
        }
        let pairs: Vec<(RoundingBound, f64)> = bounds
            .into_iter()
            .zip(sampler.largest_errors().iter().copied())
            .collect();
        rows.extend(KINDS.map(|kind| row(&name, format, kind, &pairs)));
        let at_states = judge_states(program, &mut sampler, &mut random, sample.count.min(STATES));
        let at_states = at_states.map_err(|error| words(&error))?;
        rows.push(row_of_states(&name, format, &at_states));
    }
    rows.retain(|row| row.counts[1] > 0);
    Ok(rows)
}

/// Returns bound and error of each rate at single states; a missing bound is infinite.
fn judge_states(
    program: &Program,
    sampler: &mut ErrorSampler,
    random: &mut Random,
    count: usize,
) -> Result<Vec<(String, f64, f64)>, String> {
    let format = sampler.format();
    let mut found = Vec::new();
    for _ in 0..count {
        sampler.draw(random)?;
        let (point, errors) = sampler.last();
        let at = point.iter().map(|number| {
            Some(eomgen_model_spec::interval::Interval {
                low: *number,
                high: *number,
            })
        });
        let at: Vec<_> = at.collect();
        let bounds = bound_quantities(program, format, &at);
        let pairs = bounds.iter().zip(errors);
        let rates = pairs.filter(|(bound, _)| bound.quantity.name.starts_with("rates"));
        found.extend(rates.map(|(bound, error)| {
            let number = bound.bound.as_ref().copied().unwrap_or(f64::INFINITY);
            (bound.quantity.name.clone(), number, *error)
        }));
    }
    Ok(found)
}

fn row(machine: &str, format: Format, kind: &str, pairs: &[(RoundingBound, f64)]) -> KindSummary {
    let own = pairs
        .iter()
        .filter(|(bound, _)| bound.quantity.name.starts_with(kind));
    let numbers = own.map(|(bound, error)| {
        let number = bound.bound.as_ref().copied().unwrap_or(f64::INFINITY);
        (bound.quantity.name.clone(), number, *error)
    });
    summarise_kind(machine, format, kind, &numbers.collect::<Vec<_>>())
}

fn row_of_states(machine: &str, format: Format, found: &[(String, f64, f64)]) -> KindSummary {
    summarise_kind(machine, format, "rates at single states", found)
}

fn summarise_kind(
    machine: &str,
    format: Format,
    kind: &str,
    found: &[(String, f64, f64)],
) -> KindSummary {
    let bounded = found.iter().filter(|(_, bound, _)| bound.is_finite());
    let above = found.iter().filter(|(_, bound, error)| error > bound);
    let failures = above.map(|(name, bound, error)| {
        format!(
            "{machine} {} {name}: error {error:e} above its bound {bound:e}\n",
            format.name()
        )
    });
    let with_error = bounded.clone().filter(|(_, _, error)| *error > 0.0);
    let mut pairs: Vec<(f64, f64)> = with_error
        .map(|(_, bound, error)| (*bound, *error))
        .collect();
    pairs.sort_by(|a, b| (a.0 / a.1).total_cmp(&(b.0 / b.1)));
    KindSummary {
        machine: machine.to_owned(),
        format,
        kind: kind.to_owned(),
        counts: [bounded.count(), found.len()],
        pairs,
        failures: failures.collect(),
    }
}
