//! Check of the records and of given initial states against the constraints of a model.

use eomgen_codegen::independence::rows::ConstraintRows;
use eomgen_codegen::program::evaluator::Point;
use eomgen_compiled_model::InitialChange;
use eomgen_records::dataset::{Initial, Quantity};
use eomgen_records::record::Record;
use eomgen_records::samples::typical_step;

use crate::error::DiscoverError;
use crate::ids::ChannelId;
use crate::model::estimation_model::EstimationModel;
use crate::model::first_state::estimate_without_constraints;
use crate::model::problem::EstimationProblem;
use crate::model::unknowns::{UnknownKind, list_sensor_unknowns};

/// RMS residual of a constraint at measured coordinates above which a note is written, in standard
/// deviations of noise and sensor errors. Normal errors exceed it in one of 500 million records.
const MIN_CONTRADICTION: f64 = 6.0;

/// Checks the constraints at the initial states of the records and at measured coordinates. Returns
/// notes.
///
/// # Errors
///
/// Constraints that no state near an initial state satisfies.
pub fn check_constraints(
    problem: &EstimationProblem<'_>,
    text: &str,
) -> Result<Vec<String>, DiscoverError> {
    let dataset = problem.dataset;
    let channels = &dataset.channels;
    let model = EstimationModel::derive_equations(text, &problem.path, problem.order, channels)?;
    let Some(mut rows) = model.create_constraint_rows(&model.values) else {
        return Ok(Vec::new());
    };
    let mut notes = Vec::new();
    for record in dataset.train.iter().chain(&dataset.test) {
        let state = estimate_without_constraints(&model, record, channels, &dataset.initial);
        let changes =
            model.list_changes_by_constraints(&state, (record.times[0], &record.inputs))?;
        if dataset.initial != Initial::Estimate && !record.is_continued {
            let moved = InitialChange::describe_all("initial state of the dataset file", &changes);
            notes.extend(moved.filter(|moved| !notes.contains(moved)));
        }
        notes.extend(describe_contradictions(problem, &model, record, &mut rows));
    }
    Ok(notes)
}

/// Measured coordinate.
struct MeasuredCoordinate {
    index: usize,
    channel: usize,
    /// Standard deviations: of noise and bias together, SI, and of the gain.
    sd: [f64; 2],
}

/// Describes the constraints that a record contradicts, among those whose coordinates are all
/// measured.
fn describe_contradictions(
    problem: &EstimationProblem<'_>,
    model: &EstimationModel,
    record: &Record,
    rows: &mut ConstraintRows,
) -> Vec<String> {
    let measured = list_measured_coordinates(problem, model, record);
    let constraints = &model.specification().constraints;
    // Elements: sum of squares in standard deviations, number of samples, largest residual and its
    // time.
    let mut found = vec![(0.0, 0.0, (0.0_f64, 0.0)); constraints.len()];
    let mut state = model.initial_state();
    for (sample, t) in record.times.iter().enumerate() {
        for own in &measured {
            let value = record.channels[own.channel][sample];
            state[own.index] = model.sensors[own.channel].quantity(value);
        }
        if state.iter().any(|entry| !entry.is_finite()) {
            continue;
        }
        let inputs = &record.inputs.evaluate(*t);
        let point = Point {
            t: *t,
            state: &state,
            inputs,
        };
        let (residuals, derivatives) = (rows.residuals(point), rows.derivatives(point));
        for (number, (residual, row)) in residuals.iter().zip(&derivatives).enumerate() {
            let Some(variance) = compute_variance(row, &measured, &state) else {
                continue;
            };
            if constraints[number].is_nonholonomic || variance <= 0.0 {
                continue;
            }
            let (sum, count, worst) = &mut found[number];
            *sum += residual * residual / variance;
            *count += 1.0;
            if residual.abs() > worst.0.abs() {
                *worst = (*residual, *t);
            }
        }
    }
    let all = constraints.iter().zip(found);
    all.filter_map(|(constraint, (sum, count, (largest, t)))| {
        let rms = f64::sqrt(sum / f64::max(count, 1.0));
        (rms > MIN_CONTRADICTION).then(|| {
            format!(
                "{}: the measured coordinates contradict the constraint `{}`: its residual is up to {largest:.3e} {} (at \
                 t = {t:.6} s) and {rms:.1} standard deviations of the sensors (RMS); check the columns, their units and \
                 the lengths in the constraint",
                record.name, constraint.name, constraint.unit
            )
        })
    })
    .collect()
}

/// Returns the variance of the residual of a constraint. `row`: derivatives of the constraint.
/// `None` if it depends on an unmeasured coordinate.
fn compute_variance(row: &[f64], measured: &[MeasuredCoordinate], state: &[f64]) -> Option<f64> {
    let mut variance = 0.0;
    for (index, derivative) in row.iter().enumerate().filter(|(_, entry)| **entry != 0.0) {
        let own = measured.iter().find(|own| own.index == index)?;
        let [noise, gain] = own.sd;
        let sd = noise.hypot(gain * state[index]);
        variance += (derivative * sd).powi(2);
    }
    Some(variance)
}

fn list_measured_coordinates(
    problem: &EstimationProblem<'_>,
    model: &EstimationModel,
    record: &Record,
) -> Vec<MeasuredCoordinate> {
    let step = typical_step(&record.times);
    let channels = problem.dataset.channels.iter().enumerate();
    let measured = channels.filter_map(|(number, channel)| {
        let Quantity::Coordinate(index) = channel.quantity else {
            return None;
        };
        let id = ChannelId::new(number);
        let mut sd = [channel.noise, 0.0];
        for unknown in list_sensor_unknowns(id, channel, model.specification(), step) {
            match unknown.kind {
                UnknownKind::Bias(_) => sd[0] = sd[0].hypot(unknown.scale),
                UnknownKind::Gain(_) => sd[1] = unknown.scale,
                _ => {}
            }
        }
        Some(MeasuredCoordinate {
            index,
            channel: number,
            sd,
        })
    });
    measured.collect()
}
