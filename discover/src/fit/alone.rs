//! Fits of single records, for comparison with the joint fit.

use crate::fit::fitted::Fit;
use crate::fit::full;
use crate::fit::residuals::Residuals;
use crate::model::problem::EstimationProblem;
use crate::model::unknowns::{Unknown, What};
use eomgen_records::dataset::Dataset;
use eomgen_records::record::Record;
use eomgen_records::windows::Windows;

/// Fit of a single record.
pub struct Alone {
    /// Name of the record.
    pub name: String,
    /// Index of the record in the dataset.
    pub record: Place,
    /// Residual RMS of the joint fit, in standard deviations.
    pub together: f64,
    /// Residual RMS of the single fit, in standard deviations.
    pub rms: f64,
    /// Estimates of the single fit and their standard deviations, SI.
    pub estimates: Vec<(f64, f64)>,
}

/// Index of a record in the dataset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Index among the training records.
    Train(usize),
    /// Index among the test records.
    Test(usize),
}

impl Place {
    /// The record there.
    fn of(self, dataset: &Dataset) -> &Record {
        match self {
            Self::Train(place) => &dataset.train[place],
            Self::Test(place) => &dataset.test[place],
        }
    }
}

/// Returns the indices of all records.
pub fn places(dataset: &Dataset) -> Vec<Place> {
    let train = (0..dataset.train.len()).map(Place::Train);
    let test = (0..dataset.test.len()).map(Place::Test);
    train.chain(test).collect()
}

/// Fits a single record with wide bounds of the parameters and optionally one more unknown; `None`
/// if the fit fails.
pub fn alone(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    place: Place,
    more: Option<&Unknown>,
) -> Option<Alone> {
    let together = match place {
        Place::Train(record) => left_of(&problem.train, &fit.train, record)?,
        Place::Test(record) => left_of(&problem.test, &fit.test, record)?,
    };
    let record = place.of(problem.dataset);
    let is_fitted_alone = matches!(place, Place::Train(_)) && problem.dataset.train.len() == 1;
    if is_fitted_alone && more.is_none() && !is_held(fit) {
        return Some(Alone {
            record: place,
            name: record.name.clone(),
            together,
            rms: together,
            estimates: estimates(fit),
        });
    }
    let dataset = Dataset {
        train: vec![record.clone()],
        test: vec![record.clone()],
        ..problem.dataset.clone()
    };
    let (path, text) = (&problem.path, &fit.texts.whole);
    let mut own = EstimationProblem::new(&dataset, problem.order, path, text);
    own.stop = problem.stop.clone();
    own.states.clone_from(&problem.states);
    let free = |unknown: &Unknown| match unknown.what {
        What::Parameter(_) => Unknown {
            bounds: unknown.limits,
            ..unknown.clone()
        },
        _ => unknown.clone(),
    };
    let unknowns = fit.unknowns.iter().map(free).chain(more.cloned()).collect();
    let mut theta = fit.train.estimate.theta.clone();
    theta.extend(more.map(|unknown| unknown.start));
    let found = full::fit(&own, fit.texts.clone(), unknowns, &theta).ok()?;
    Some(Alone {
        record: place,
        name: record.name.clone(),
        together,
        rms: found.train.rms,
        estimates: estimates(&found),
    })
}

/// Whether a parameter of a fit is held where its prior ends, and would go on alone.
fn is_held(fit: &Fit) -> bool {
    fit.unknowns().any(|(id, unknown)| {
        let is_narrowed = unknown.bounds != unknown.limits;
        matches!(unknown.what, What::Parameter(_)) && is_narrowed && fit.is_held(id)
    })
}

/// A fit's unknowns with their standard deviations.
fn estimates(fit: &Fit) -> Vec<(f64, f64)> {
    let pairs = fit.train.estimate.theta.iter().zip(&fit.wider_sd);
    pairs.map(|(value, sd)| (*value, *sd)).collect()
}

/// Returns the largest residual RMS of a fit over the records, in standard deviations.
pub fn most_left(problem: &EstimationProblem<'_>, fit: &Fit) -> f64 {
    let train =
        (0..problem.dataset.train.len()).filter_map(|k| left_of(&problem.train, &fit.train, k));
    let test = (0..problem.dataset.test.len()).filter_map(|k| left_of(&problem.test, &fit.test, k));
    train.chain(test).fold(0.0, f64::max)
}

/// The root mean square that a fit leaves of one record, in standard deviations.
fn left_of(windows: &Windows<'_>, residuals: &Residuals, record: usize) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0.0);
    for (window, values) in windows.list.iter().zip(&residuals.residuals) {
        if window.record == record {
            sum += values.iter().map(|r| r * r).sum::<f64>();
            count += values.len() as f64;
        }
    }
    (count > 0.0).then(|| f64::sqrt(sum / count))
}
