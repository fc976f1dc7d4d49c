//! Records that contradict each other: each fitted alone, then seen beside the fit of all together.
//! What is off in one record only, as another payload or another supply, is no property of the machine.

use eomgen_model_spec::model::{Parameter, ParameterValue};

use crate::fit::alone::{Alone, alone, each_alone, most_left};
use crate::fit::fitted::Fit;
use crate::model::problem::EstimationProblem;
use crate::model::unknowns::{Unknown, What, sign_bounds};
use crate::thresholds;

/// The contradictions among the records of a fit that leaves a gap, in sentences. Parameters, declared
/// ones or those of what was found, to which two records alone give different values, where each alone
/// is explained much better than all together. Or records that are not explained alone where others are, with the
/// parameters that would explain them. `floor`: what a right model would leave, in standard deviations.
pub fn contradictions(problem: &EstimationProblem<'_>, fit: &Fit, floor: f64) -> Vec<String> {
    // What none leaves more of than each could alone is no contradiction.
    if most_left(problem, fit) < thresholds::CONTRADICTS * floor {
        return Vec::new();
    }
    let alone = each_alone(problem, fit);
    let mut sentences = Vec::new();
    for (place, unknown) in fit.unknowns.iter().enumerate() {
        if let What::Parameter(name) = &unknown.what
            && let Some((a, b)) = furthest(&alone, place)
        {
            sentences.push(said(fit, name, place, a, b));
        }
    }
    match sentences.is_empty() {
        true => odd(problem, fit, &alone, floor),
        false => sentences,
    }
}

/// Records that leave much alone where others leave no more than a right model would.
fn odd(problem: &EstimationProblem<'_>, fit: &Fit, alone: &[Alone], floor: f64) -> Vec<String> {
    let is_explained = |record: &&Alone| record.rms < thresholds::CLOSE * floor;
    let explained: Vec<&Alone> = alone.iter().filter(is_explained).collect();
    let is_odd = |record: &&Alone| record.rms > thresholds::MUCH_IS_LEFT * floor;
    let odd: Vec<&Alone> = alone.iter().filter(is_odd).collect();
    // What is missing may show in a few records only; that most show it contradicts nothing.
    if odd.len() >= explained.len() {
        return Vec::new();
    }
    let names = |records: &[&Alone]| {
        let names = records.iter().map(|record| record.name.as_str());
        names.collect::<Vec<&str>>().join(", ")
    };
    let sentence = |record: &&Alone| {
        let by = explaining(problem, fit, record, floor);
        let by = match by.is_empty() {
            true => String::new(),
            false => format!(" Alone it is explained by {}.", by.join(", or by ")),
        };
        format!(
            "{} does not go with {}: fitted alone, these leave at most {:.1} standard deviations, and it leaves {:.1}.{by} Was it \
             measured on the same machine, with the same payload?",
            record.name,
            names(&explained),
            explained
                .iter()
                .map(|record| record.rms)
                .fold(0.0, f64::max),
            record.rms
        )
    };
    odd.iter().map(sentence).collect()
}

/// The single parameters of the model that explain a record alone, with their values.
fn explaining(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    record: &Alone,
    floor: f64,
) -> Vec<String> {
    let is_known = |parameter: &Parameter| {
        let mut unknowns = fit.unknowns.iter();
        unknowns.any(|known| known.what == What::Parameter(parameter.name.clone()))
    };
    let parameters = fit.model.specification().parameters.iter();
    let found = parameters
        .filter(|parameter| !is_known(parameter))
        .filter_map(|parameter| {
            let ParameterValue::Number(value) = parameter.value else {
                return None;
            };
            let bounds = sign_bounds(parameter, value);
            let unknown = Unknown {
                what: What::Parameter(parameter.name.clone()),
                label: format!("`{}`", parameter.name),
                start: value,
                prior: None,
                bounds,
                limits: bounds,
                scale: value.abs(),
            };
            let with =
                (value != 0.0).then(|| alone(problem, fit, record.record, Some(&unknown)))??;
            let estimate = *with.estimates.last()?;
            (with.rms < thresholds::CLOSE * floor).then(|| {
                format!(
                    "`{}` = {}",
                    parameter.name,
                    stated(Some(parameter), estimate)
                )
            })
        });
    found.collect()
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
    let value = |record: &Alone| stated(parameter, record.estimates[place]);
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

/// An estimate and its standard deviation, SI, in a parameter's unit.
fn stated(parameter: Option<&Parameter>, (value, sd): (f64, f64)) -> String {
    match parameter {
        Some(p) => format!(
            "{:.3e} +- {:.1e} {}",
            p.unit.from_si(value),
            p.unit.from_si(sd),
            p.unit
        ),
        None => format!("{value:.3e} +- {sd:.1e}"),
    }
}
