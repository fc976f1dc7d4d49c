//! Fits of single records, for comparison with the joint fit.

use crate::fit::fit_result::Fit;
use crate::fit::full_fit;
use crate::fit::residuals::Residuals;
use crate::model::problem::EstimationProblem;
use crate::model::unknowns::{Unknown, UnknownKind};
use eomgen_records::dataset::Dataset;
use eomgen_records::record::Record;
use eomgen_records::windows::Windows;

/// Fit of a single record.
pub struct SingleRecordFit {
    /// Name of the record.
    pub name: String,
    /// Index of the record in the dataset.
    pub record: RecordIndex,
    /// Residual RMS of the joint fit, in standard deviations.
    pub joint_rms: f64,
    /// Residual RMS of the single fit, in standard deviations.
    pub rms: f64,
    /// Estimates of the single fit and their standard deviations, SI.
    pub estimates: Vec<(f64, f64)>,
}

/// Index of a record in the dataset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecordIndex {
    /// Index among the training records.
    Train(usize),
    /// Index among the test records.
    Test(usize),
}

impl RecordIndex {
    /// Returns the record.
    fn find_record(self, dataset: &Dataset) -> &Record {
        match self {
            Self::Train(index) => &dataset.train[index],
            Self::Test(index) => &dataset.test[index],
        }
    }
}

/// Returns the indices of all records.
pub fn list_records(dataset: &Dataset) -> Vec<RecordIndex> {
    let train = (0..dataset.train.len()).map(RecordIndex::Train);
    let test = (0..dataset.test.len()).map(RecordIndex::Test);
    train.chain(test).collect()
}

/// Fits a single record with wide bounds of the parameters and optionally one additional unknown;
/// `None` if the fit fails.
pub fn fit_record_separately(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    index: RecordIndex,
    more: Option<&Unknown>,
) -> Option<SingleRecordFit> {
    let together = match index {
        RecordIndex::Train(record) => compute_record_rms(&problem.train, &fit.train, record)?,
        RecordIndex::Test(record) => compute_record_rms(&problem.test, &fit.test, record)?,
    };
    let record = index.find_record(problem.dataset);
    let is_fitted_alone =
        matches!(index, RecordIndex::Train(_)) && problem.dataset.train.len() == 1;
    if is_fitted_alone && more.is_none() && !is_held(fit) {
        return Some(SingleRecordFit {
            record: index,
            name: record.name.clone(),
            joint_rms: together,
            rms: together,
            estimates: list_estimates(fit),
        });
    }
    let dataset = Dataset {
        train: vec![record.clone()],
        test: vec![record.clone()],
        ..problem.dataset.clone()
    };
    let (path, text) = (&problem.path, &fit.texts.full);
    let mut own = EstimationProblem::new(&dataset, problem.order, path, text);
    own.stop = problem.stop.clone();
    own.states.clone_from(&problem.states);
    let free = |unknown: &Unknown| match unknown.kind {
        UnknownKind::Parameter(_) => Unknown {
            bounds: unknown.bounds_without_prior,
            ..unknown.clone()
        },
        _ => unknown.clone(),
    };
    let unknowns = fit.unknowns.iter().map(free).chain(more.cloned()).collect();
    let mut theta = fit.train.estimate.theta.clone();
    theta.extend(more.map(|unknown| unknown.start));
    let found = full_fit::fit_specification(&own, fit.texts.clone(), unknowns, &theta).ok()?;
    Some(SingleRecordFit {
        record: index,
        name: record.name.clone(),
        joint_rms: together,
        rms: found.train.rms,
        estimates: list_estimates(&found),
    })
}

/// Returns true if a parameter of a joint fit is at a bound that comes from its prior. A single fit
/// may exceed this bound.
fn is_held(fit: &Fit) -> bool {
    fit.unknowns().any(|(id, unknown)| {
        let is_narrowed = unknown.bounds != unknown.bounds_without_prior;
        matches!(unknown.kind, UnknownKind::Parameter(_)) && is_narrowed && fit.is_at_bound(id)
    })
}

/// Returns the estimates of a fit and their standard deviations.
fn list_estimates(fit: &Fit) -> Vec<(f64, f64)> {
    let pairs = fit.train.estimate.theta.iter().zip(&fit.effect_sd);
    pairs.map(|(value, sd)| (*value, *sd)).collect()
}

/// Returns the largest RMS residual of a fit over the records, in standard deviations.
pub fn compute_largest_record_rms(problem: &EstimationProblem<'_>, fit: &Fit) -> f64 {
    let train = (0..problem.dataset.train.len())
        .filter_map(|k| compute_record_rms(&problem.train, &fit.train, k));
    let test = (0..problem.dataset.test.len())
        .filter_map(|k| compute_record_rms(&problem.test, &fit.test, k));
    train.chain(test).fold(0.0, f64::max)
}

/// Returns the RMS residual of one record, in standard deviations.
fn compute_record_rms(windows: &Windows<'_>, residuals: &Residuals, record: usize) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0.0);
    for (window, values) in windows.windows.iter().zip(&residuals.window_residuals) {
        if window.record == record {
            sum += values.iter().map(|r| r * r).sum::<f64>();
            count += values.len() as f64;
        }
    }
    (count > 0.0).then(|| f64::sqrt(sum / count))
}
