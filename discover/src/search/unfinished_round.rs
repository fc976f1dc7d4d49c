//! State of a round that reached the time limit.

use crate::search::hypothesis_fits::FittedHypothesis;
use crate::search::rejection::Rejection;
use crate::search::tested_pool::TestedPool;

/// Hypothesis with a complete fit to the training records.
struct FittedEffects {
    label: String,
    train_rms: f64,
    /// RMS residual of the test records; `None` if the limit was reached before.
    test_rms: Option<f64>,
    is_accepted: bool,
}

impl FittedEffects {
    fn new(pool: &TestedPool, fitted: &FittedHypothesis) -> Self {
        let names = fitted.responses.iter().map(|response| {
            let candidate = pool.screening.responses[*response].candidate;
            pool.candidates[candidate].label()
        });
        let names: Vec<String> = names.collect();
        let is_interrupted = matches!(fitted.verdict, Err(Rejection::Interrupted));
        Self {
            label: names.join(" and "),
            train_rms: fitted.fit.train.rms,
            test_rms: (!is_interrupted).then_some(fitted.fit.test.rms),
            is_accepted: fitted.verdict.is_ok(),
        }
    }
}

/// Returns a sentence about the accepted hypothesis with the lowest residual so far. If none is
/// accepted, the sentence describes the fitted hypothesis with the lowest residual. `has_effects`:
/// true if earlier rounds found effects.
pub fn describe_unfinished(tested: &[TestedPool], has_effects: bool) -> String {
    let fitted = tested.iter().flat_map(|pool| {
        let fitted = pool.fitted_hypotheses.iter();
        fitted.map(move |fitted| FittedEffects::new(pool, fitted))
    });
    describe_best(fitted, find_best_prediction(tested), has_effects)
}

fn describe_best(
    fitted: impl Iterator<Item = FittedEffects>,
    best_prediction: Option<String>,
    has_effects: bool,
) -> String {
    // Accepted hypotheses are first, then those that were compared with the test records.
    let order = |own: &FittedEffects| {
        let rms = own.test_rms.unwrap_or(own.train_rms);
        (!own.is_accepted, own.test_rms.is_none(), rms)
    };
    let best = fitted.min_by(|a, b| {
        let (a, b) = (order(a), order(b));
        (a.0, a.1).cmp(&(b.0, b.1)).then(a.2.total_cmp(&b.2))
    });
    let (effect, among) = match has_effects {
        true => ("a further effect", "of the further effects, "),
        false => ("an effect", ""),
    };
    let Some(best) = best else {
        let none = format!("no fit of {effect} was complete at the limit");
        return match best_prediction {
            Some(name) => format!("{none}; best prediction: {name}"),
            None => none,
        };
    };
    let label = &best.label;
    match best.test_rms {
        Some(rms) => format!(
            "{among}{label} has the lowest residual so far, {rms:.1} standard deviations on the test records, and was \
             not compared with all others"
        ),
        None => format!(
            "{among}{label} has the lowest residual so far, {:.1} standard deviations on the training records, and was \
             not compared with the test records",
            best.train_rms
        ),
    }
}

/// Returns the candidate with the best prediction in screening.
fn find_best_prediction(tested: &[TestedPool]) -> Option<String> {
    let all = tested.iter().flat_map(|pool| {
        let responses = pool.screening.responses.iter();
        responses.map(move |response| (pool, response))
    });
    let best = all.max_by(|(_, a), (_, b)| a.cost_decrease.total_cmp(&b.cost_decrease));
    best.map(|(pool, response)| pool.candidates[response.candidate].label())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fitted(label: &str, train_rms: f64, test_rms: Option<f64>) -> FittedEffects {
        FittedEffects {
            label: label.to_owned(),
            train_rms,
            test_rms,
            is_accepted: false,
        }
    }

    fn describe(fitted: Vec<FittedEffects>, has_effects: bool) -> String {
        describe_best(fitted.into_iter(), Some("play".to_owned()), has_effects)
    }

    #[test]
    fn missing_complete_fit_is_reported() {
        assert_eq!(
            describe(Vec::new(), false),
            "no fit of an effect was complete at the limit; best prediction: play"
        );
        assert_eq!(
            describe(Vec::new(), true),
            "no fit of a further effect was complete at the limit; best prediction: play"
        );
    }

    #[test]
    fn fit_without_test_comparison_is_named() {
        let said = describe(vec![fitted("friction", 0.88, None)], false);
        assert_eq!(
            said,
            "friction has the lowest residual so far, 0.9 standard deviations on the training records, and was not \
             compared with the test records"
        );
        let both = vec![
            fitted("friction", 0.88, None),
            fitted("drag", 3.0, Some(4.0)),
        ];
        let said = describe(both, true);
        let start = "of the further effects, drag has the lowest residual so far, 4.0 standard deviations on the test";
        assert!(said.starts_with(start), "{said}");
    }
}
