//! State of a round that reached the time limit.

use crate::search::hypothesis_fits::FittedHypothesis;
use crate::search::tested_pool::TestedPool;

/// Returns a sentence on the accepted hypothesis with the lowest residual so far, or otherwise the
/// fitted one.
pub fn describe_unfinished(tested: &[TestedPool]) -> String {
    let all = tested.iter().flat_map(|pool| {
        let fitted = pool.fitted_hypotheses.iter();
        fitted.map(move |fitted| (pool, fitted))
    });
    // Interrupted fits have no valid test residual.
    let all = all.filter(|(_, fitted)| fitted.fit.test.rms.is_finite());
    let order = |(_, fitted): &(&TestedPool, &FittedHypothesis)| {
        (fitted.verdict.is_err(), fitted.fit.test.rms)
    };
    let best = all.min_by(|a, b| {
        let (a, b) = (order(a), order(b));
        a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
    let Some((pool, best)) = best else {
        return match promising(tested) {
            Some(name) => format!("no effect was fitted before the limit; best prediction: {name}"),
            None => "no effect was fitted before the limit".to_owned(),
        };
    };
    let names = best.responses.iter().map(|response| {
        let candidate = pool.screening.responses[*response].candidate;
        pool.candidates[candidate].label()
    });
    let names: Vec<String> = names.collect();
    format!(
        "{} has the lowest residual so far, {:.1} standard deviations on the test records, and was not compared \
         with all others",
        names.join(" and "),
        best.fit.test.rms
    )
}

/// Returns the candidate with the best prediction in screening.
fn promising(tested: &[TestedPool]) -> Option<String> {
    let all = tested.iter().flat_map(|pool| {
        let responses = pool.screening.responses.iter();
        responses.map(move |response| (pool, response))
    });
    let best = all.max_by(|(_, a), (_, b)| a.cost_decrease.total_cmp(&b.cost_decrease));
    best.map(|(pool, response)| pool.candidates[response.candidate].label())
}
