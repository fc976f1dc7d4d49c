//! Records that contradict each other: each fitted alone, then seen beside the fit of all together.
//! What is off in one record only, as another payload or another supply, is no property of the machine.

use crate::fit::fitted::Fit;
use crate::fit::full;
use crate::fit::residuals::Residuals;
use crate::model::problem::EstimationProblem;
use crate::model::unknowns::{Unknown, What};
use crate::thresholds;
use eomgen_records::dataset::Dataset;
use eomgen_records::record::Record;
use eomgen_records::windows::Windows;

/// What a record says alone.
struct Alone {
    name: String,
    /// What the fit of all records leaves of it, in standard deviations.
    together: f64,
    /// What its own leaves.
    rms: f64,
    /// Its own estimates and their standard deviations, SI.
    estimates: Vec<(f64, f64)>,
}

/// The contradictions among the records of a fit that leaves a gap, in sentences: declared
/// parameters to which two records alone give different values, where each alone is explained much
/// better than all together. None where there is one record.
pub fn contradictions(problem: &EstimationProblem<'_>, fit: &Fit) -> Vec<String> {
    let is_declared =
        |unknown: &Unknown| matches!(unknown.what, What::Parameter(_)) && unknown.prior.is_some();
    if !fit.unknowns.iter().any(is_declared) {
        return Vec::new();
    }
    let dataset = problem.dataset;
    let sets = [
        (&dataset.train, &problem.train, &fit.train),
        (&dataset.test, &problem.test, &fit.test),
    ];
    let alone: Vec<Alone> = sets
        .into_iter()
        .flat_map(|(records, windows, residuals)| {
            let records = records.iter().enumerate();
            records.filter_map(move |(place, record)| {
                let together = left_of(windows, residuals, place)?;
                alone(problem, fit, record, together)
            })
        })
        .collect();
    let mut sentences = Vec::new();
    for (place, unknown) in fit.unknowns.iter().enumerate() {
        if let (What::Parameter(name), true) = (&unknown.what, is_declared(unknown))
            && let Some((a, b)) = furthest(&alone, place)
        {
            sentences.push(said(fit, name, place, a, b));
        }
    }
    sentences
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

/// A record fitted by itself, its declared parameters as far off as it takes.
fn alone(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    record: &Record,
    together: f64,
) -> Option<Alone> {
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
    let unknowns = fit.unknowns.iter().map(free).collect();
    let theta = &fit.train.estimate.theta;
    let found = full::fit(&own, fit.texts.clone(), unknowns, theta).ok()?;
    let estimates = found.train.estimate.theta.iter().zip(&found.sd);
    Some(Alone {
        name: record.name.clone(),
        together,
        rms: found.train.rms,
        estimates: estimates.map(|(value, sd)| (*value, *sd)).collect(),
    })
}

/// The two records that differ most in an unknown, if that is more than uncertainty makes of it and
/// each is explained by its own value.
fn furthest(alone: &[Alone], place: usize) -> Option<(&Alone, &Alone)> {
    let is_explained = |record: &&Alone| {
        record.rms.is_finite() && record.rms * thresholds::CONTRADICTS < record.together
    };
    let explained: Vec<&Alone> = alone.iter().filter(is_explained).collect();
    let apart = |a: &Alone, b: &Alone| {
        let ((x, sx), (y, sy)) = (a.estimates[place], b.estimates[place]);
        let is_large = (x - y).abs() > thresholds::CONTRADICTING_PART * x.abs().max(y.abs());
        ((x - y).abs() / f64::hypot(sx, sy), is_large)
    };
    let pairs = explained.iter().enumerate();
    let pairs = pairs.flat_map(|(n, a)| explained[n + 1..].iter().map(move |b| (*a, *b)));
    let pairs = pairs.filter(|(a, b)| {
        let (deviations, is_large) = apart(a, b);
        is_large && deviations > thresholds::SIGNIFICANCE
    });
    pairs.max_by(|(a, b), (c, d)| apart(a, b).0.total_cmp(&apart(c, d).0))
}

fn said(fit: &Fit, name: &str, place: usize, a: &Alone, b: &Alone) -> String {
    let mut parameters = fit.model.specification().parameters.iter();
    let parameter = parameters.find(|parameter| parameter.name == name);
    let value = |record: &Alone| {
        let (value, sd) = record.estimates[place];
        match parameter {
            Some(p) => format!(
                "{:.3e} +- {:.1e} {}",
                p.unit.from_si(value),
                p.unit.from_si(sd),
                p.unit
            ),
            None => format!("{value:.3e} +- {sd:.1e}"),
        }
    };
    format!(
        "{} and {} contradict each other: alone, they give `{name}` as {} and {}, and leave {:.1} and {:.1} standard \
         deviations, where the fit of all leaves {:.1} and {:.1}. Were they measured on one machine, with one payload?",
        a.name,
        b.name,
        value(a),
        value(b),
        a.rms,
        b.rms,
        a.together,
        b.together
    )
}
