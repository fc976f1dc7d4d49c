//! Hypotheses: candidates that are fitted together, their unknowns, the specification with these
//! candidates, and initial values of the fit.

use crate::error::DiscoverError;
use crate::fit::fit_result::Fit;
use crate::fit::preliminary_fit::{self, PreliminaryFit, WarmStart};
use crate::ids::{EffectId, ResponseId, UnknownId};
use crate::interval::Interval;
use crate::model::specification_texts::SpecificationTexts;
use crate::model::unknowns::{NormalPrior, Unknown};
use crate::search::acceptance::EffectUnknown;
use crate::search::pool::CandidatePool;
use crate::thresholds;

/// Candidates that are fitted together, optionally in place of the term of a parameter.
#[derive(Clone)]
pub struct Hypothesis {
    /// Responses of the candidates.
    pub responses: Vec<ResponseId>,
    /// Parameter whose term is replaced.
    pub replaced_parameter: Option<UnknownId>,
    /// Predicted sizes of the candidates, in the order of `responses`.
    pub predicted_sizes: Vec<f64>,
}

/// Unknowns of a fit and of the additional candidates, and their initial values, SI.
struct ExtendedUnknowns {
    unknowns: Vec<Unknown>,
    theta: Vec<f64>,
}

/// Returns the names of the candidates and of the replaced term.
pub fn describe_hypothesis(pool: &CandidatePool<'_>, hypothesis: &Hypothesis) -> String {
    let names = pool.label(&hypothesis.responses);
    let unknowns = &pool.context.fit.unknowns;
    match hypothesis
        .replaced_parameter
        .and_then(|id| unknowns[id].kind.parameter_name())
    {
        Some(deleted) => format!("{names} without {deleted}"),
        None => names,
    }
}

/// Returns the unknowns of the effects in a fit with the hypothesis.
pub fn list_effect_unknowns(
    pool: &CandidatePool<'_>,
    hypothesis: &Hypothesis,
) -> Vec<EffectUnknown> {
    let mut next = pool.context.fit.unknowns.len();
    let mut own = Vec::new();
    let effects = EffectId::first(hypothesis.responses.len());
    for (effect, response) in effects.zip(&hypothesis.responses) {
        let response = &pool.screening.responses[*response];
        if let Some(unknown) = response.dropped_prior
            && let Some(NormalPrior { mean, sd }) = pool.context.fit.unknowns[unknown].prior
        {
            own.push(EffectUnknown {
                unknown,
                effect,
                base: mean,
                is_shape: false,
                dropped_prior_sd: Some(sd),
            });
        }
        for candidate_unknown in &response.candidate_unknowns {
            own.push(EffectUnknown {
                unknown: UnknownId::new(next),
                effect,
                base: candidate_unknown.base,
                is_shape: candidate_unknown.is_shape,
                dropped_prior_sd: None,
            });
            next += 1;
        }
    }
    own
}

/// Runs a preliminary fit with the candidates.
pub fn fit_preliminary(
    pool: &CandidatePool<'_>,
    hypothesis: &Hypothesis,
) -> Result<PreliminaryFit, DiscoverError> {
    let fit = pool.context.fit;
    let limited = (pool.most_evaluations).map(|most| pool.context.problem.limit_evaluations(most));
    let problem = limited.as_ref().unwrap_or(pool.context.problem);
    problem.stop.check_not_stopped()?;
    let ExtendedUnknowns { unknowns, theta } =
        extend_unknowns(pool, hypothesis, pool.size_fractions[0]);
    let texts = write_texts(pool, hypothesis, &unknowns, &theta)?;
    // With additional coordinates, even a small vibration is far from the previous fit.
    let adds_states = hypothesis.responses.iter().any(|response| {
        let parameters = &pool.candidate(*response).parameters;
        parameters.iter().any(|parameter| parameter.is_inverse)
    });
    let others = pool.size_fractions[1..]
        .iter()
        .map(|part| extend_unknowns(pool, hypothesis, *part).theta);
    let initial_values: Vec<Vec<f64>> = std::iter::once(theta).chain(others).collect();
    if pool.uses_whole_windows && hypothesis.replaced_parameter.is_none() && !adds_states {
        let cost = pool.screening.predict(&hypothesis.responses).cost;
        let most = thresholds::MAX_WARM_START_RATIO * fit.train.rms;
        let warm_start = WarmStart {
            fit,
            cost,
            max_rms: most,
        };
        return preliminary_fit::start_from_fit(
            problem,
            texts,
            unknowns,
            &initial_values,
            warm_start,
        );
    }
    let mut preliminary =
        preliminary_fit::fit_initial_segments(problem, texts, unknowns, &initial_values)?;
    if pool.uses_whole_windows {
        // Preliminary fits are compared by predictions over whole windows.
        preliminary.cost = pool.screening.predict(&hypothesis.responses).cost;
    }
    Ok(preliminary)
}

/// Runs a preliminary fit with the candidates. Shapes have the given multiple of their typical
/// sizes.
pub fn fit_with_shape_factor(
    pool: &CandidatePool<'_>,
    hypothesis: &Hypothesis,
    times: f64,
) -> Result<PreliminaryFit, DiscoverError> {
    let ExtendedUnknowns {
        unknowns,
        mut theta,
    } = extend_unknowns(pool, hypothesis, 1.0);
    for own in list_effect_unknowns(pool, hypothesis)
        .iter()
        .filter(|own| own.is_shape)
    {
        theta[own.unknown] = unknowns[own.unknown].clamp(times * theta[own.unknown]);
    }
    let texts = write_texts(pool, hypothesis, &unknowns, &theta)?;
    preliminary_fit::fit_initial_segments(pool.context.problem, texts, unknowns, &[theta])
}

/// Fits a hypothesis of one candidate, starting from the initial states of a fit with another
/// candidate. `shape_ratio`: multiple of the typical size of a shape.
pub fn fit_from_warm_start(
    pool: &CandidatePool<'_>,
    hypothesis: &Hypothesis,
    warm_start: WarmStart<'_>,
    shape_ratio: f64,
) -> Result<PreliminaryFit, DiscoverError> {
    let ExtendedUnknowns {
        unknowns,
        mut theta,
    } = extend_unknowns(pool, hypothesis, 1.0);
    let count = pool.context.fit.unknowns.len();
    theta[..count].copy_from_slice(&warm_start.fit.train.estimate.theta[..count]);
    for own in list_effect_unknowns(pool, hypothesis)
        .iter()
        .filter(|own| own.is_shape)
    {
        theta[own.unknown] = unknowns[own.unknown].clamp(shape_ratio * theta[own.unknown]);
    }
    let texts = write_texts(pool, hypothesis, &unknowns, &theta)?;
    preliminary_fit::start_from_fit(pool.context.problem, texts, unknowns, &[theta], warm_start)
}

/// Fits a hypothesis of one candidate. The initial values are the estimates of a fit of two
/// candidates. `own`: values of its unknowns in this fit, SI.
pub fn fit_half_from_pair(
    pool: &CandidatePool<'_>,
    hypothesis: &Hypothesis,
    pair: &Fit,
    own: &[f64],
) -> Result<PreliminaryFit, DiscoverError> {
    let ExtendedUnknowns { unknowns, .. } = extend_unknowns(pool, hypothesis, 1.0);
    let count = pool.context.fit.unknowns.len();
    let theta = [&pair.train.estimate.theta[..count], own].concat();
    let texts = write_texts(pool, hypothesis, &unknowns, &theta)?;
    let warm_start = WarmStart {
        fit: pair,
        cost: pair.train.estimate.cost,
        max_rms: thresholds::MAX_WARM_START_RATIO * pair.train.rms,
    };
    preliminary_fit::start_from_fit(pool.context.problem, texts, unknowns, &[theta], warm_start)
}

/// Returns the texts of the specification with the candidates of a hypothesis, for given values of
/// the unknowns.
fn write_texts(
    pool: &CandidatePool<'_>,
    hypothesis: &Hypothesis,
    unknowns: &[Unknown],
    theta: &[f64],
) -> Result<SpecificationTexts, DiscoverError> {
    let fit = pool.context.fit;
    let mut texts = fit.texts.clone();
    let mut next = fit.unknowns.len();
    for response in &hypothesis.responses {
        let response = &pool.screening.responses[*response];
        if response.dropped_prior.is_some() {
            continue;
        }
        let own = next..next + response.candidate_unknowns.len();
        next = own.end;
        let values: Vec<f64> = own
            .map(|index| unknowns[index].kind.value_in_specification(theta[index]))
            .collect();
        let candidate = &pool.candidates[response.candidate];
        texts = candidate.add_to_texts(pool.context.problem, &texts, &values)?;
    }
    Ok(texts)
}

/// Returns the unknowns with the candidates of a hypothesis, and initial values. The candidates
/// have the fraction `part` of their predicted sizes.
fn extend_unknowns(
    pool: &CandidatePool<'_>,
    hypothesis: &Hypothesis,
    part: f64,
) -> ExtendedUnknowns {
    let fit = pool.context.fit;
    let mut unknowns = fit.unknowns.clone();
    let mut theta = fit.restart_values();
    if let Some(deleted) = hypothesis.replaced_parameter {
        unknowns[deleted].bounds = Interval::ZERO;
        theta[deleted] = 0.0;
    }
    let mut sizes = hypothesis.predicted_sizes.iter().map(|size| part * size);
    for response in &hypothesis.responses {
        let response = &pool.screening.responses[*response];
        if let Some(id) = response.dropped_prior {
            let size = sizes.next().unwrap_or(0.0);
            unknowns[id] = unknowns[id].without_prior();
            theta[id] = unknowns[id].clamp(fit.train.estimate.theta[id] + size);
            continue;
        }
        for candidate_unknown in &response.candidate_unknowns {
            let size = match candidate_unknown.is_shape {
                true => candidate_unknown.unknown.start - candidate_unknown.base,
                false => sizes.next().unwrap_or(0.0),
            };
            let size = if size == 0.0 {
                part * candidate_unknown.unknown.scale
            } else {
                size
            };
            theta.push(
                candidate_unknown
                    .unknown
                    .clamp(candidate_unknown.base + size),
            );
            let mut unknown = candidate_unknown.unknown.clone();
            unknown.scale = size.abs().max(1e-3 * unknown.scale);
            unknowns.push(unknown);
        }
    }
    ExtendedUnknowns { unknowns, theta }
}
