//! The specification that was written, run on the records: what is handed on is the text, not the
//! fit from which it was written.

use crate::fit::full::Fit;
use crate::fit::gauss_newton::{Estimate, StartPrior, evaluated};
use crate::model::problem::Setting;
use crate::model::unknowns::{Unknown, What};
use crate::search::response::mapped;
use eomgen_records::windows::Windows;

/// What a specification leaves, root mean squares over all channels, in noises.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rerun {
    /// Of the training records.
    pub train: f64,
    /// Of the test records.
    pub test: f64,
}

/// Runs a specification's text with its own numbers on the windows of a fit, from where that begins
/// them, seen by the sensors that it found.
///
/// # Errors
/// What is wrong with the text.
pub fn rerun(setting: &Setting<'_>, fit: &Fit, text: &str) -> Result<Rerun, String> {
    let plant = setting.plant(text, Some(&fit.linear))?;
    let all = fit.unknowns.iter().zip(&fit.train.estimate.theta);
    let (sensors, theta): (Vec<Unknown>, Vec<f64>) = all
        .filter(|(unknown, _)| !matches!(unknown.what, What::Parameter(_) | What::Inverse(_)))
        .map(|(unknown, value)| (unknown.clone(), *value))
        .unzip();
    let ranges = mapped(fit, &plant, &fit.ranges);
    let left = |windows: &Windows<'_>, estimate: &Estimate| {
        let shooting = setting.shooting(&plant, windows, &sensors, &ranges);
        let starts = estimate.starts.iter();
        let starts = starts.map(|start| mapped(fit, &plant, start)).collect();
        let estimate = evaluated(&shooting, &StartPrior::default(), theta.clone(), starts);
        setting.rest(&shooting, estimate).whole().pooled
    };
    Ok(Rerun {
        train: left(&setting.train, &fit.train.estimate),
        test: left(&setting.test, &fit.test.estimate),
    })
}
