//! Rejected candidates of a round with the reasons.

use crate::catalogue::candidate::Candidate;
use crate::ids::ResponseId;
use crate::search::hypothesis_fits::{FittedHypothesis, PreliminaryOutcome, describe_residuals};
use crate::search::screening::UnexcitedCandidate;
use crate::search::search_result::{BestOfRound, RejectedCandidate};
use crate::search::tested_pool::TestedPool;
use crate::thresholds;

/// Reason for a rejection. A reason from a fit replaces a reason from screening.
struct Reason {
    text: String,
    /// Best candidate of the round, if the reason is a reduction of the residual.
    best_of_round: Option<BestOfRound>,
    not_testable: bool,
    /// True if the candidate was fitted.
    is_of_fit: bool,
    p_value: Option<f64>,
}

/// Adds the rejected candidates of a round to the list. They replace entries from earlier rounds.
/// Within a round, the result of a fit takes precedence. `floor`: noise floor, in standard
/// deviations of the noise.
pub fn note_rejected(rejected: &mut Vec<RejectedCandidate>, round: &[TestedPool], floor: f64) {
    let mut fitted: Vec<String> = Vec::new();
    for tested in round {
        for (candidate, reason) in list_reasons(tested, floor) {
            let label = candidate.label();
            if fitted.contains(&label) && !reason.is_of_fit {
                continue;
            }
            rejected.retain(|known| known.candidate.label() != label);
            rejected.push(RejectedCandidate {
                candidate: candidate.clone(),
                reason: reason.text,
                best_of_round: reason.best_of_round,
                is_fitted: reason.is_of_fit,
                is_untestable: reason.not_testable,
                p_value: reason.p_value,
            });
            if reason.is_of_fit {
                fitted.push(label);
            }
        }
    }
}

/// Adds candidates without a fit. They do not replace results of fits or entries of untestable
/// candidates.
pub fn note_unfitted(rejected: &mut Vec<RejectedCandidate>, unfitted: Vec<RejectedCandidate>) {
    for new in unfitted {
        let label = new.candidate.label();
        let is_same = |known: &RejectedCandidate| known.candidate.label() == label;
        let is_kept = |known: &RejectedCandidate| {
            is_same(known) && (known.p_value.is_some() || known.is_untestable)
        };
        if !rejected.iter().any(is_kept) {
            rejected.retain(|known| !is_same(known));
            rejected.push(new);
        }
    }
}

/// Returns the reason for the rejection of each candidate of a pool, including candidates that are
/// accepted later.
fn list_reasons(tested: &TestedPool, floor: f64) -> Vec<(&Candidate, Reason)> {
    let screening = &tested.screening;
    let not_excited = screening.unexcited.iter();
    let mut found: Vec<(&Candidate, Reason)> = not_excited
        .map(|UnexcitedCandidate { candidate, reason }| {
            let reason = Reason {
                text: reason.to_string(),
                best_of_round: None,
                not_testable: true,
                is_of_fit: false,
                p_value: None,
            };
            (&tested.candidates[*candidate], reason)
        })
        .collect();
    for (id, response) in ResponseId::first(screening.responses.len()).zip(&screening.responses) {
        let mut hypotheses = tested.fitted_hypotheses.iter();
        let alone = hypotheses.find(|fitted| fitted.responses == [id]);
        let reason = match (alone, tested.preliminary_outcome(id)) {
            (Some(fitted), _) => explain_fit(fitted, floor),
            (None, Some(outcome)) => explain_preliminary(tested, outcome),
            (None, None) => explain_screening(tested, id),
        };
        found.push((&tested.candidates[response.candidate], reason));
    }
    found
}

fn explain_fit(fitted: &FittedHypothesis, floor: f64) -> Reason {
    let text = match &fitted.verdict {
        Err(reason) => reason.to_string(),
        Ok(_) => format!(
            "it would be accepted on its own, with {}, but the named effect is preferred",
            describe_residuals(fitted.fit.train.rms / floor, fitted.fit.test.rms / floor)
        ),
    };
    Reason {
        text,
        best_of_round: None,
        not_testable: false,
        is_of_fit: true,
        p_value: fitted.p_value,
    }
}

/// Explains the rejection of a candidate after its preliminary fit, with the same numbers as the
/// progress lines.
fn explain_preliminary(tested: &TestedPool, outcome: &PreliminaryOutcome) -> Reason {
    let text = match (outcome, outcome.remaining_fraction()) {
        (PreliminaryOutcome::Remaining { is_whole: true, .. }, Some(_)) => {
            format!("predicted: {outcome}")
        }
        (PreliminaryOutcome::Remaining { .. }, Some(_)) => format!("after its fit, {outcome}"),
        (PreliminaryOutcome::Remaining { .. }, None) => "its fit did not converge".to_owned(),
        (PreliminaryOutcome::Failed(_), _) => outcome.to_string(),
    };
    let is_comparable = outcome.remaining_fraction().is_some();
    let best = is_comparable.then(|| find_best_fit(tested)).flatten();
    Reason {
        text,
        best_of_round: best,
        not_testable: false,
        is_of_fit: true,
        p_value: None,
    }
}

/// Returns the candidate whose preliminary fit leaves the smallest residual.
fn find_best_fit(tested: &TestedPool) -> Option<BestOfRound> {
    let outcomes = tested.preliminary_outcomes.iter();
    let converged =
        outcomes.filter_map(|(id, outcome)| Some((outcome.remaining_fraction()?, *id, outcome)));
    let (_, id, outcome) = converged.min_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(BestOfRound {
        label: tested.candidate(id).label(),
        reduction: outcome.to_string(),
    })
}

/// Returns the candidate with the largest predicted reduction of the squared residual.
fn find_best_prediction(tested: &TestedPool, cost: f64) -> Option<BestOfRound> {
    let responses = tested.screening.responses.iter();
    let best = responses.max_by(|a, b| a.cost_decrease.total_cmp(&b.cost_decrease))?;
    Some(BestOfRound {
        label: tested.candidates[best.candidate].label(),
        reduction: format!(
            "predicted reduction of the squared residual: {:.1} %",
            100.0 * best.cost_decrease / cost
        ),
    })
}

fn explain_screening(tested: &TestedPool, id: ResponseId) -> Reason {
    let screening = &tested.screening;
    let response = &screening.responses[id];
    let not_testable = response.unexplained_fraction <= thresholds::MIN_UNEXPLAINED_FRACTION;
    let (text, best_of_round) = if not_testable {
        let text = format!(
            "initial states, refitted parameters and sensors together can produce {:.1} % of its response; the rest \
             is too small to test",
            100.0 * (1.0 - response.unexplained_fraction)
        );
        (text, None)
    } else {
        let alone = screening.predict(&[]).cost;
        let unknowns = response.candidate_unknowns.iter();
        let shapes = unknowns.filter(|unknown| unknown.is_shape);
        let shapes: Vec<&str> = shapes.map(|own| own.unknown.label.as_str()).collect();
        // The linear prediction holds for one value of a shape only.
        let condition = match &shapes[..] {
            [] => String::new(),
            shapes => format!(" for the usual {}", shapes.join(" and ")),
        };
        let text = format!(
            "predicted reduction of the squared residual{condition}: {:.1} %; not fitted",
            100.0 * response.cost_decrease / alone
        );
        (text, find_best_prediction(tested, alone))
    };
    Reason {
        text,
        best_of_round,
        not_testable,
        is_of_fit: false,
        p_value: None,
    }
}
