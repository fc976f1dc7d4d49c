//! Differences between truncation orders and the reference order: over time, as RMS, and in long-time statistics.

use serde_json::{Value, json};

use crate::studies::case::Record;
use crate::studies::error::StudyError;
use crate::studies::report::{Table, amplitude};

use super::run::{
    OMEGA, REFERENCE_ORDER, Run, SAMPLING_INTERVAL_S, STATISTICS_TIME_S, TRANSIENT_S,
};

/// Number of samples per interval of 5 ms, over which the largest difference is taken.
const SAMPLES_PER_INTERVAL: usize = 102;

pub(super) const NAMES: [&str; 3] = ["x_sp", "f_la", "dr"];

/// Differences of x_sp, f_la and dr, one value per order.
pub(super) struct Convergence {
    pub orders: Vec<f64>,
    pub values: [Vec<f64>; 3],
}

pub(super) fn run_at_order(runs: &[Run], order: usize) -> Result<&Run, StudyError> {
    let found = runs.iter().find(|run| run.order == order);
    found.ok_or_else(|| StudyError::Request(format!("order {order} was not run")))
}

/// Computes the RMS difference from the reference over the first `seconds` s, in m.
pub(super) fn compute_convergence(runs: &[Run], seconds: f64) -> Result<Convergence, StudyError> {
    let reference = run_at_order(runs, REFERENCE_ORDER)?;
    let count = (seconds / SAMPLING_INTERVAL_S) as usize;
    Ok(Convergence::of(runs, |run, which| {
        let pairs = series(&run.start, which)
            .iter()
            .zip(series(&reference.start, which));
        let squares: f64 = pairs.take(count).map(|(a, b)| (a - b).powi(2)).sum();
        (squares / count.max(1) as f64).sqrt()
    }))
}

/// Computes the difference of the long-time RMS, relative to the reference.
pub(super) fn compare_statistics(runs: &[Run]) -> Result<Convergence, StudyError> {
    let reference = run_at_order(runs, REFERENCE_ORDER)?;
    Ok(Convergence::of(runs, |run, which| {
        (rms(run, which) / rms(reference, which) - 1.0).abs()
    }))
}

impl Convergence {
    fn of(runs: &[Run], difference: impl Fn(&Run, usize) -> f64) -> Self {
        Self {
            orders: compared_runs(runs).map(|run| run.order as f64).collect(),
            values: [0, 1, 2].map(|which| {
                compared_runs(runs)
                    .map(|run| difference(run, which))
                    .collect()
            }),
        }
    }
}

fn compared_runs(runs: &[Run]) -> impl Iterator<Item = &Run> {
    runs.iter().filter(|run| run.order != REFERENCE_ORDER)
}

fn series(record: &Record, which: usize) -> &[f64] {
    match which {
        0 => &record.x_sp,
        1 => &record.f_la,
        _ => &record.dr,
    }
}

fn rms(run: &Run, which: usize) -> f64 {
    let amplitude = run.statistics.get(which);
    amplitude.map_or(f64::NAN, |amplitude| amplitude.rms)
}

/// Returns the times, s, and the largest difference of x_sp in each 5 ms, m.
pub(super) fn find_largest_differences(of: &Record, reference: &Record) -> (Vec<f64>, Vec<f64>) {
    let pieces = of
        .x_sp
        .chunks(SAMPLES_PER_INTERVAL)
        .zip(reference.x_sp.chunks(SAMPLES_PER_INTERVAL));
    let greatest = pieces.map(|(a, b)| {
        let differences = a.iter().zip(b).map(|(a, b)| (a - b).abs());
        differences.fold(0.0, f64::max)
    });
    (
        of.times
            .iter()
            .step_by(SAMPLES_PER_INTERVAL)
            .copied()
            .collect(),
        greatest.collect(),
    )
}

/// Returns a table of the differences and the long-time RMS.
pub(super) fn table(file: &str, runs: &[Run], of: &Convergence) -> Table {
    let mut columns = vec![("S".to_owned(), of.orders.clone())];
    for (which, (name, values)) in NAMES.iter().zip(&of.values).enumerate() {
        columns.push((format!("difference_{name}"), values.clone()));
        let long = compared_runs(runs).map(|run| rms(run, which));
        columns.push((format!("rms_{name}"), long.collect()));
    }
    Table {
        file: file.to_owned(),
        columns,
    }
}

/// Returns the differences and the long-time RMS for the JSON document of the study.
pub(super) fn format_convergence_json(
    micrometres: u32,
    seconds: f64,
    runs: &[Run],
    of: &Convergence,
) -> Value {
    let statistics = runs.iter().map(|run| {
        let [x_sp, f_la, dr] = &run.statistics;
        json!({ "order": run.order, "x_sp": amplitude(x_sp), "f_la": amplitude(f_la), "dr": amplitude(dr) })
    });
    let [x_sp, f_la, dr] = &of.values;
    json!({
        "b": f64::from(micrometres) * 1e-6,
        "omega": OMEGA,
        "data": format!("convergence_b{micrometres:03}.csv"),
        "reference_order": REFERENCE_ORDER,
        "differences_over_s": seconds,
        "orders": of.orders,
        "rms_difference": { "x_sp": x_sp, "f_la": f_la, "dr": dr },
        "statistics_over_s": STATISTICS_TIME_S,
        "statistics_after_s": TRANSIENT_S,
        "statistics": statistics.collect::<Vec<_>>(),
    })
}
