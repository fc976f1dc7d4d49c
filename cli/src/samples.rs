//! Inputs of a simulation, and the times of its rows.

use eomgen_compiled_model::list_undriven_inputs;
use eomgen_model_spec::model::Model;
use eomgen_records::read_inputs;
use eomgen_sim::inputs::HeldInputs;

use crate::arguments::Simulate;
use crate::error::{Error, Result, warn};
use crate::input_file::register_input;

/// Maximum number of values in a table (rows times columns); it needs a few GB of memory.
const MAX_VALUES: f64 = 1e8;

/// Default number of intervals if `--interval` is missing.
const DEFAULT_INTERVALS: f64 = 1000.0;

/// Returns the inputs: from a record, or constant. `driven` contains the names of inputs that are driven otherwise and
/// need no warning.
pub fn inputs(options: &Simulate, model: &Model, driven: &[&str]) -> Result<HeldInputs> {
    match &options.inputs.record {
        Some(dataset) => {
            let record = read_inputs(dataset, &options.inputs.record_name, (model, driven))
                .map_err(Error::records)?;
            record.files.iter().for_each(|path| register_input(path));
            for warning in record.warnings {
                warn(&format!("warning: {warning}"));
            }
            Ok(record.inputs)
        }
        None => {
            let values =
                (model.typical_inputs(0.0)).map_err(|error| Error::model(&model.source, error))?;
            for warning in list_undriven_inputs(model, driven) {
                warn(&format!("warning: {warning}"));
            }
            Ok(HeldInputs::constant(values))
        }
    }
}

/// Returns the times of the rows, in s.
pub fn times(options: &Simulate, inputs: &HeldInputs) -> Result<Vec<f64>> {
    let span = span(options, inputs)?;
    match options.rows.interval {
        None if options.inputs.record.is_some() => record_times(inputs, span),
        step => even_times(span, step),
    }
}

/// Returns start and end of the simulation, in s.
fn span(options: &Simulate, inputs: &HeldInputs) -> Result<(f64, f64)> {
    let recorded = options.inputs.record.as_ref().map(|_| inputs.times());
    let start = recorded
        .and_then(|times| times.first())
        .copied()
        .unwrap_or(0.0);
    let end = options
        .until
        .or_else(|| recorded.and_then(|times| times.last()).copied());
    let end = end.ok_or_else(|| Error::input("--until is missing: the simulated time in s"))?;
    if end.is_finite() && (end - start) / DEFAULT_INTERVALS >= f64::MIN_POSITIVE {
        return Ok((start, end));
    }
    let shortest = match end > start && end.is_finite() {
        true => format!(
            ", by at least {:e} s",
            DEFAULT_INTERVALS * f64::MIN_POSITIVE
        ),
        false => String::new(),
    };
    Err(Error::input(format!(
        "--until {end:?}: expected a finite time in s after {start:?}{shortest}"
    )))
}

/// Returns the times of the record's samples up to `end`.
fn record_times(inputs: &HeldInputs, (_, end): (f64, f64)) -> Result<Vec<f64>> {
    let times: Vec<f64> = inputs
        .times()
        .iter()
        .copied()
        .take_while(|t| *t <= end + rounding(end))
        .collect();
    let last = inputs.times().last().copied().unwrap_or(end);
    if end > last {
        return Err(Error::input(format!(
            "--until {end:?}: the record ends at {last:?} s; give an earlier time, or --interval to hold the last inputs"
        )));
    }
    match times.len() {
        0 | 1 => Err(Error::input(format!(
            "--until {end:?}: the record has fewer than two samples up to then; give a later time, or --interval"
        ))),
        _ => Ok(times),
    }
}

/// Returns evenly spaced times in s. The default interval is a thousandth of the simulated time.
fn even_times((start, end): (f64, f64), step: Option<f64>) -> Result<Vec<f64>> {
    let whole = end - start;
    let step = step.unwrap_or(whole / DEFAULT_INTERVALS);
    if !(step > 0.0 && step <= whole) {
        return Err(Error::input(format!(
            "--interval {step:?}: expected a time in s above 0 and at most {whole:?}"
        )));
    }
    let lost = rounding(start.abs().max(end.abs())).min(0.5 * step);
    let steps = ((whole + lost) / step * (1.0 + 1e-12)).floor();
    if steps > MAX_VALUES {
        return Err(Error::input(format!(
            "too many rows: {whole:?} s have {steps:.1e} intervals of {step:?} s, the limit is {MAX_VALUES:e} values (rows \
             times columns); give an earlier --until or a longer --interval"
        )));
    }
    let decimals = decimals(start).max(decimals(step));
    Ok((0..=steps as usize)
        .map(|row| round_to_decimals(start + row as f64 * step, decimals).min(end))
        .collect())
}

/// Returns a bound of the rounding error of the difference of two times of magnitude `t`, including their conversion
/// from another unit.
fn rounding(t: f64) -> f64 {
    2.0 * (t.abs().next_up() - t.abs())
}

/// Returns the number of decimals of the shortest notation of a number.
fn decimals(number: f64) -> i32 {
    let text = number.to_string();
    text.split_once('.').map_or(0, |(_, decimals)| {
        i32::try_from(decimals.len()).unwrap_or(i32::MAX)
    })
}

/// Maximum number of decimals to which times are rounded; further decimals are rounding errors.
const MAX_DECIMALS: i32 = 15;

/// Rounds a time to this number of decimals, so that for example 7 times 0.05 s is 0.35 s.
fn round_to_decimals(t: f64, decimals: i32) -> f64 {
    if decimals > MAX_DECIMALS {
        return t;
    }
    let scale = 10f64.powi(decimals);
    let whole = (t * scale).round();
    // Integers of larger magnitude are not exact.
    match whole.abs() < 2f64.powi(53) {
        true => whole / scale,
        false => t,
    }
}

/// Rejects a table that does not fit into memory.
pub fn check_size(rows: usize, columns: usize) -> Result {
    let values = rows as f64 * columns as f64;
    if values <= MAX_VALUES {
        return Ok(());
    }
    Err(Error::input(format!(
        "too many rows: the limit is {MAX_VALUES:e} values (rows times columns); give a longer --interval"
    )))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_have_the_decimals_of_the_interval() {
        let times = even_times((0.0, 2.0), Some(0.05)).ok().expect("times");
        assert_eq!(times[7], 0.35);
        assert_eq!(times[40], 2.0);
        let times = even_times((0.1, 1.1), None).ok().expect("times");
        assert_eq!(times[2], 0.102);
        let longest = times.iter().map(|t| decimals(*t)).max();
        assert_eq!(longest, Some(3));
    }

    #[test]
    fn times_far_from_zero_have_as_many_rows() {
        for start in [0.0, 1.7e9, 1.75e9 + 0.25, -3e7] {
            for (steps, step) in [(1199, 0.005), (1000, 0.1), (777, 0.003)] {
                let end = start + f64::from(steps) * step;
                let times = even_times((start, end), Some(step)).ok().expect("times");
                assert_eq!(times.len(), steps as usize + 1, "{start} {step}");
                assert_eq!(times.last(), Some(&end), "{start} {step}");
            }
        }
    }

    #[test]
    fn long_times_name_both_options() {
        let Err(Error::Input(message)) = even_times((0.0, 1e100), Some(0.01)) else {
            panic!("too many rows");
        };
        assert!(
            message.contains("1e100 s have 1.0e102 intervals of 0.01 s"),
            "{message}"
        );
        assert!(
            message.contains("an earlier --until or a longer --interval"),
            "{message}"
        );
    }

    #[test]
    fn times_of_other_intervals_are_not_rounded() {
        let step = 1.0 / 3.0;
        let times = even_times((0.0, 2.0), Some(step)).ok().expect("times");
        assert_eq!(times[4], 4.0 * step);
        assert_eq!(times.len(), 7);
    }
}
