//! Rejected candidates of a round with the reasons.

use crate::catalogue::candidate::Candidate;
use crate::ids::ResponseId;
use crate::search::hypothesis_fits::FittedHypothesis;
use crate::search::screening::UnexcitedCandidate;
use crate::search::search_result::RejectedCandidate;
use crate::search::tested_pool::TestedPool;
use crate::thresholds;

/// Reason for a rejection. A reason from a fit replaces a reason from screening.
struct Reason {
    text: String,
    /// Predicted reduction for the best candidate of the round, if the reason is a predicted
    /// reduction.
    best_reduction: Option<f64>,
    not_testable: bool,
    is_of_fit: bool,
    p_value: Option<f64>,
}

/// Adds the rejected candidates of a round to the list. They replace entries from earlier rounds.
/// Within a round, the result of a fit takes precedence.
pub fn note_rejected(rejected: &mut Vec<RejectedCandidate>, round: &[TestedPool]) {
    let mut fitted: Vec<String> = Vec::new();
    for tested in round {
        for (candidate, reason) in list_reasons(tested) {
            let label = candidate.label();
            if fitted.contains(&label) && !reason.is_of_fit {
                continue;
            }
            rejected.retain(|known| known.candidate.label() != label);
            rejected.push(RejectedCandidate {
                candidate: candidate.clone(),
                reason: reason.text,
                best_reduction: reason.best_reduction,
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
fn list_reasons(tested: &TestedPool) -> Vec<(&Candidate, Reason)> {
    let screening = &tested.screening;
    let not_excited = screening.unexcited.iter();
    let mut found: Vec<(&Candidate, Reason)> = not_excited
        .map(|UnexcitedCandidate { candidate, reason }| {
            let reason = Reason {
                text: reason.to_string(),
                best_reduction: None,
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
        let reason = match alone {
            Some(fitted) => explain_fit(fitted),
            None => explain_screening(tested, id),
        };
        found.push((&tested.candidates[response.candidate], reason));
    }
    found
}

fn explain_fit(fitted: &FittedHypothesis) -> Reason {
    let text = match &fitted.verdict {
        Err(reason) => reason.to_string(),
        Ok(_) => format!(
            "it would be accepted on its own, with residuals of {:.2} (training) and {:.2} (test) standard \
             deviations of the noise, but the named effect is preferred",
            fitted.fit.train.rms, fitted.fit.test.rms
        ),
    };
    Reason {
        text,
        best_reduction: None,
        not_testable: false,
        is_of_fit: true,
        p_value: fitted.p_value,
    }
}

fn explain_screening(tested: &TestedPool, id: ResponseId) -> Reason {
    let screening = &tested.screening;
    let response = &screening.responses[id];
    let not_testable = response.unexplained_fraction <= thresholds::MIN_UNEXPLAINED_FRACTION;
    let (text, best_reduction) = if not_testable {
        let text = format!(
            "initial states, refitted parameters and sensors together can produce {:.1} % of its response; the rest \
             is too small to test",
            100.0 * (1.0 - response.unexplained_fraction)
        );
        (text, None)
    } else {
        let alone = screening.predict(&[]).cost;
        let most = screening.responses.iter();
        let most = most.map(|other| other.cost_decrease).fold(0.0, f64::max);
        let text = format!(
            "it would reduce the squared residual by {:.1} %",
            100.0 * response.cost_decrease / alone
        );
        (text, Some(most / alone))
    };
    Reason {
        text,
        best_reduction,
        not_testable,
        is_of_fit: false,
        p_value: None,
    }
}
