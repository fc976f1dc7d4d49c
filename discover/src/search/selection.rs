//! Selection of the named effect of a round: the accepted hypothesis with the lowest residual, and
//! the candidates that are inseparable from it.

use crate::ids::{EffectId, FittedId, ResponseId};
use std::cmp::Ordering;

use crate::catalogue::candidate::Candidate;
use crate::fit::fit_result::Fit;
use crate::fit::residuals::Residuals;
use crate::model::unknowns::UnknownKind;
use crate::search::acceptance::{EffectUnknown, compute_test_statistics, has_vanishing_shape};
use crate::search::context::RoundContext;
use crate::search::hypothesis_fits::FittedHypothesis;
use crate::search::pairs::fit_other_halves;
use crate::search::parameter_offsets;
use crate::search::pool::CandidatePool;
use crate::search::screening::Screening;
use crate::search::tested_pool::TestedPool;
use crate::thresholds;

/// Named hypothesis.
pub struct SelectedHypothesis {
    /// Candidates of the hypothesis, in the order of its responses.
    pub candidates: Vec<Candidate>,
    /// The fitted hypothesis.
    pub hypothesis: FittedHypothesis,
    /// Candidates that are inseparable from each candidate of the hypothesis.
    pub equivalents: Vec<Vec<Candidate>>,
    /// Effect of a pair that was accepted separately.
    pub accepted_half: Option<AcceptedHalf>,
}

/// Effect of a pair that was accepted separately, as an intermediate step.
#[derive(Clone, Copy, Debug)]
pub struct AcceptedHalf {
    /// Index of the effect.
    pub effect: EffectId,
    /// RMS residual of the test records with this effect, in standard deviations.
    pub test_rms: f64,
}

/// Effect of a hypothesis that is inseparable from an effect of another hypothesis.
struct InseparableHalf {
    effect: EffectId,
    /// Response of the other effect.
    response: ResponseId,
}

/// Selects the named hypothesis among the fitted hypotheses of a round; `None` if none is accepted.
/// A shifted undeclared parameter is less plausible. It is named only if its residual is clearly
/// lower than that of similar candidates.
pub fn select_hypothesis(
    context: RoundContext<'_>,
    tested: TestedPool,
) -> Option<SelectedHypothesis> {
    let selected = select_best(context, with_other_halves(context, tested))?;
    let fit = &selected.hypothesis.fit;
    let similar = match &selected.candidates[..] {
        [candidate] => parameter_offsets::fit_similar_offsets(context, candidate),
        halves => parameter_offsets::fit_similar_pairs(context, halves),
    };
    let Some(similar) = similar else {
        return Some(selected);
    };
    let own = similar.selected_responses;
    let TestedPool {
        candidates,
        screening,
        fitted_hypotheses,
        ..
    } = similar.tested_pool;
    let (better, others): (Vec<FittedHypothesis>, Vec<FittedHypothesis>) = fitted_hypotheses
        .into_iter()
        .partition(|fitted| fitted.verdict.is_ok() && is_clearly_better(&fitted.fit, fit));
    if !better.is_empty() {
        let better = TestedPool {
            candidates,
            screening,
            fitted_hypotheses: better,
            preliminary_outcomes: Vec::new(),
        };
        return select_best(context, better);
    }
    let mut equivalents = selected.equivalents;
    for fitted in &others {
        // An alternative to a pair replaces one of its effects, at the same index.
        let halves = own.iter().zip(&fitted.responses);
        let replaced = halves.zip(&mut equivalents).find(|((a, b), _)| a != b);
        let Some(((own, response), equivalents)) = replaced else {
            continue;
        };
        let similarity = compute_pair_similarity(&candidates, &screening, *own, *response);
        if is_inseparable(
            selected.hypothesis.size_and_fit(),
            fitted.size_and_fit(),
            similarity,
        ) {
            equivalents.push(candidates[screening.responses[*response].candidate].clone());
        }
    }
    Some(SelectedHypothesis {
        equivalents,
        ..selected
    })
}

/// Returns the fitted hypotheses of a round. If a pair is best, further pairs with a candidate that
/// is similar to one of its effects are fitted. This repeats with each better pair while its
/// residual exceeds that of a correct model.
fn with_other_halves(context: RoundContext<'_>, tested: TestedPool) -> TestedPool {
    let TestedPool {
        candidates,
        screening,
        mut fitted_hypotheses,
        ..
    } = tested;
    let pool = CandidatePool::new(
        context,
        &candidates,
        &screening,
        context.starts_with_whole_windows(),
    );
    let mut known = None;
    while let Some(best) = select_best_fit(&fitted_hypotheses)
        && known != Some(best)
    {
        let mut further = fit_other_halves(&pool, &fitted_hypotheses, best);
        further.retain(|fitted| fitted.explains_records);
        fitted_hypotheses.extend(further);
        if fitted_hypotheses[best].fit.is_at_floor(context.floor) {
            break;
        }
        known = Some(best);
    }
    TestedPool {
        candidates,
        screening,
        fitted_hypotheses,
        preliminary_outcomes: Vec::new(),
    }
}

/// Returns the best accepted hypothesis, with the candidates that are inseparable from it. Among
/// inseparable hypotheses, the order is: no contradiction to a declared sensor prior, fewer
/// unknowns, smaller deviation of a declared parameter.
fn select_best(context: RoundContext<'_>, tested: TestedPool) -> Option<SelectedHypothesis> {
    let TestedPool {
        candidates,
        screening,
        mut fitted_hypotheses,
        ..
    } = tested;
    let least = select_best_fit(&fitted_hypotheses)?;
    let candidate = |response: ResponseId| &candidates[screening.responses[response].candidate];
    // A wrong parameter value adds no term to the model.
    let scales = |fitted: &FittedHypothesis| {
        let mut of = fitted.responses.iter();
        of.any(|response| candidate(*response).scaled_stiffness.is_some())
    };
    let is_simpler = |id: &FittedId| {
        let (other, least) = (&fitted_hypotheses[*id], &fitted_hypotheses[least]);
        let is_less_off = match (
            compute_declared_deviation(other),
            compute_declared_deviation(least),
        ) {
            (Some(other), Some(least)) => other < least,
            _ => false,
        };
        let is_likelier = contradicts_sensor(context, least) && !contradicts_sensor(context, other);
        (other.effect_unknowns.len() < least.effect_unknowns.len()
            || is_less_off
            || is_likelier
            || (scales(least) && !scales(other)))
            && other.verdict.is_ok()
            && find_inseparable_half(least, other, &candidates, &screening).is_some()
    };
    let simpler = FittedId::first(fitted_hypotheses.len()).filter(is_simpler);
    let order = |id: &FittedId| {
        (
            contradicts_sensor(context, &fitted_hypotheses[*id]),
            fitted_hypotheses[*id].effect_unknowns.len(),
            compute_declared_deviation(&fitted_hypotheses[*id]).unwrap_or(0.0),
        )
    };
    let best = simpler
        .min_by(|a, b| order(a).partial_cmp(&order(b)).unwrap_or(Ordering::Equal))
        .unwrap_or(least);
    let fitted = fitted_hypotheses.remove(best.index());
    let own: Vec<Candidate> = (fitted.responses.iter())
        .map(|response| candidate(*response).clone())
        .collect();
    let mut equivalent = vec![Vec::new(); own.len()];
    let is_the_same = |other: &FittedHypothesis| {
        other.effect_unknowns.len() > fitted.effect_unknowns.len()
            && has_vanishing_shape(&other.fit, &other.effect_unknowns)
    };
    for other in fitted_hypotheses.iter().filter(|other| !is_the_same(other)) {
        let Some(half) = find_inseparable_half(&fitted, other, &candidates, &screening) else {
            continue;
        };
        let (other, own) = (candidate(half.response), &own[half.effect]);
        if !other.is_same_effect_as(own) || other.angle_order != own.angle_order {
            equivalent[half.effect].push(other.clone());
        }
    }
    Some(SelectedHypothesis {
        equivalents: equivalent,
        accepted_half: find_accepted_half(&fitted, &fitted_hypotheses),
        candidates: own,
        hypothesis: fitted,
    })
}

/// Returns true if the hypothesis changes a sensor by more than a prior in the dataset permits.
fn contradicts_sensor(context: RoundContext<'_>, fitted: &FittedHypothesis) -> bool {
    let channels = &context.problem.dataset.channels;
    let own = fitted
        .effect_unknowns
        .iter()
        .filter(|own| own.dropped_prior_sd.is_some());
    own.map(|own| &fitted.fit.unknowns[own.unknown].kind)
        .any(|what| match what {
            UnknownKind::Gain(channel) => channels[channel.index()].priors.gain.is_some(),
            UnknownKind::Bias(channel) => channels[channel.index()].priors.bias.is_some(),
            UnknownKind::Delay(channel) => channels[channel.index()].priors.delay.is_some(),
            UnknownKind::Parameter(_)
            | UnknownKind::InverseParameter(_)
            | UnknownKind::InputDelay => false,
        })
}

/// Returns the deviation from declared values, in standard deviations of their priors; `None` if an
/// unknown has no declared value.
fn compute_declared_deviation(fitted: &FittedHypothesis) -> Option<f64> {
    let theta = &fitted.fit.train.estimate.theta;
    let of =
        |own: &EffectUnknown| Some((theta[own.unknown] - own.base).abs() / own.dropped_prior_sd?);
    let all: Option<Vec<f64>> = fitted.effect_unknowns.iter().map(of).collect();
    all.map(|all| all.into_iter().fold(0.0, f64::max))
}

/// Returns the accepted hypothesis with the lowest residual. A pair is selected only if its
/// residual is clearly lower than that of the best single effect.
pub fn select_best_fit(fitted_hypotheses: &[FittedHypothesis]) -> Option<FittedId> {
    let rms = |id: &FittedId| fitted_hypotheses[*id].fit.rms();
    let least = |count: fn(usize) -> bool| {
        let is_selected =
            |fitted: &FittedHypothesis| fitted.verdict.is_ok() && count(fitted.responses.len());
        let all = FittedId::first(fitted_hypotheses.len());
        let selected_ids = all.filter(|id| is_selected(&fitted_hypotheses[*id]));
        selected_ids.min_by(|a, b| rms(a).total_cmp(&rms(b)))
    };
    match (least(|n| n == 1), least(|n| n > 1)) {
        (Some(single), Some(pair)) => {
            let is_clear = fitted_hypotheses[pair]
                .fit
                .is_clearly_below(&fitted_hypotheses[single].fit);
            Some(if is_clear { pair } else { single })
        }
        (one, two) => one.or(two),
    }
}

/// Returns true if a fit is clearly better than another: on both sets of records, or certainly on
/// the test records and at least equal on the training records. Training residuals favour the fit
/// with more unknowns.
fn is_clearly_better(one: &Fit, other: &Fit) -> bool {
    let statistics = compute_test_statistics(other, one, &[]);
    let is_certain = statistics.held_out_reduction > thresholds::MIN_HELD_OUT_REDUCTION
        && statistics.reduction_in_standard_errors > thresholds::MIN_REDUCTION_STANDARD_ERRORS;
    one.is_clearly_below(other) || (is_certain && one.train.rms < other.train.rms)
}

/// Returns the index of the effect of a hypothesis that is inseparable from an effect of another
/// hypothesis, and the response of this other effect. Both hypotheses must have equally many
/// effects, and their other effects must be equal.
fn find_inseparable_half(
    fitted: &FittedHypothesis,
    other: &FittedHypothesis,
    candidates: &[Candidate],
    screening: &Screening,
) -> Option<InseparableHalf> {
    if fitted.responses.len() != other.responses.len() {
        return None;
    }
    let differ =
        |a: &[ResponseId], b: &[ResponseId]| a.iter().position(|response| !b.contains(response));
    let half = differ(&fitted.responses, &other.responses)?;
    let response = other.responses[differ(&other.responses, &fitted.responses)?];
    let shared = fitted
        .responses
        .iter()
        .filter(|own| other.responses.contains(own));
    let is_all_else = shared.count() + 1 == fitted.responses.len();
    let similarity =
        compute_pair_similarity(candidates, screening, fitted.responses[half], response);
    (is_all_else && is_inseparable(fitted.size_and_fit(), other.size_and_fit(), similarity))
        .then_some(InseparableHalf {
            effect: EffectId::new(half),
            response,
        })
}

/// Returns the similarity of two responses, 0 to 1. It is 1 for two names of one effect.
fn compute_pair_similarity(
    candidates: &[Candidate],
    screening: &Screening,
    a: ResponseId,
    b: ResponseId,
) -> f64 {
    let candidate = |response: ResponseId| &candidates[screening.responses[response].candidate];
    let similarity = screening.compute_similarity(a, b);
    let is_same =
        similarity > thresholds::MIN_SIMILARITY_OF_RIVALS && candidate(a).is_alias_of(candidate(b));
    match is_same {
        true => 1.0,
        false => similarity,
    }
}

/// Returns true if two fitted hypotheses, given by the number of their unknowns and their fit, are
/// inseparable: their responses or residuals are similar,
/// and the other fit is no worse on the test records. Unless they are two names of one effect, the
/// other fit must also be no worse on the training records. It may be better, but not so clearly
/// that it would be selected instead.
pub fn is_inseparable(
    (size, one): (usize, &Fit),
    (other_size, other): (usize, &Fit),
    similarity: f64,
) -> bool {
    let leave_same = size == other_size
        && has_same_residuals(&one.train, &other.train)
        && has_same_residuals(&one.test, &other.test);
    let statistics = compute_test_statistics(one, other, &[]);
    let (part, errors) = (
        -statistics.held_out_reduction,
        -statistics.reduction_in_standard_errors,
    );
    // For identical residuals, the standard error is 0 and the ratio is NaN.
    let as_good = errors.is_nan()
        || errors < thresholds::MIN_REDUCTION_STANDARD_ERRORS
        || part < thresholds::MAX_CLASS_DIFFERENCE;
    let is_worse_in_training = other.train.rms
        > (1.0 + thresholds::MAX_CLASS_DIFFERENCE) * one.train.rms
        && statistics.information_gain < -thresholds::MIN_INFORMATION_GAIN;
    let is_same = similarity > thresholds::MIN_SIMILARITY_OF_SAME_EFFECT
        && part < thresholds::MIN_HELD_OUT_REDUCTION;
    let is_rival = similarity > thresholds::MIN_SIMILARITY_OF_RIVALS || leave_same;
    is_rival && (is_same || (as_good && !is_worse_in_training))
}

/// Returns true if the squared residuals of two fits differ by less than
/// [`thresholds::MAX_CLASS_DIFFERENCE`], summed over blocks. This test complements the similarity
/// of responses, which can differ for equivalent effects along the motion of an incorrect model.
/// For example, the gains of a sensor and of an input are equivalent in a linear model, but their
/// responses agree only after the fit.
fn has_same_residuals(one: &Residuals, other: &Residuals) -> bool {
    let blocks = || one.block_squares.iter().zip(&other.block_squares);
    let difference: f64 = blocks().map(|(a, b)| (a - b).abs()).sum();
    let whole: f64 = blocks().map(|(a, b)| a.max(*b)).sum();
    one.block_squares.len() == other.block_squares.len()
        && difference < thresholds::MAX_CLASS_DIFFERENCE * whole
}

/// Returns the effect of a pair that was accepted separately, with its test residual, as an
/// intermediate step.
fn find_accepted_half(
    best: &FittedHypothesis,
    others: &[FittedHypothesis],
) -> Option<AcceptedHalf> {
    if best.responses.len() < 2 {
        return None;
    }
    let halves = others
        .iter()
        .filter_map(|fitted| match fitted.responses[..] {
            [response] if fitted.verdict.is_ok() => {
                let half = best.responses.iter().position(|own| *own == response)?;
                Some((half, fitted))
            }
            _ => None,
        });
    let (half, fitted) = halves.min_by(|a, b| a.1.fit.rms().total_cmp(&b.1.fit.rms()))?;
    Some(AcceptedHalf {
        effect: EffectId::new(half),
        test_rms: fitted.fit.test.rms,
    })
}
