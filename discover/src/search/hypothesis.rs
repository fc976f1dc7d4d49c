//! Hypotheses: candidates that are fitted together, their unknowns, the specification with them,
//! and the start of a fit.

use crate::error::DiscoverError;
use crate::fit::fitted::Fit;
use crate::fit::preliminary::{self, PreliminaryFit, WarmStart};
use crate::ids::{EffectId, ResponseId, UnknownId};
use crate::interval::Interval;
use crate::model::specification_texts::SpecificationTexts;
use crate::model::unknowns::{NormalPrior, Unknown};
use crate::search::acceptance::EffectUnknown;
use crate::search::pool::Pool;
use crate::thresholds;

/// Candidates that are fitted together, and a parameter whose term they replace.
#[derive(Clone)]
pub struct Hypothesis {
    /// Responses of the candidates.
    pub responses: Vec<ResponseId>,
    /// Parameter whose term is replaced.
    pub deleted: Option<UnknownId>,
    /// Predicted sizes of the candidates, in order.
    pub sizes: Vec<f64>,
}

/// The unknowns of a fit with further ones, and where they begin, SI.
struct Extended {
    unknowns: Vec<Unknown>,
    theta: Vec<f64>,
}

/// Returns the names of the candidates and of the replaced term.
pub fn label(pool: &Pool<'_>, hypothesis: &Hypothesis) -> String {
    let names = pool.label(&hypothesis.responses);
    let unknowns = &pool.context.fit.unknowns;
    match hypothesis
        .deleted
        .and_then(|id| unknowns[id].what.parameter())
    {
        Some(deleted) => format!("{names} without {deleted}"),
        None => names,
    }
}

/// Returns the unknowns of the effects in a fit with the hypothesis.
pub fn own_unknowns(pool: &Pool<'_>, hypothesis: &Hypothesis) -> Vec<EffectUnknown> {
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
                prior: Some(sd),
            });
        }
        for candidate_unknown in &response.candidate_unknowns {
            own.push(EffectUnknown {
                unknown: UnknownId::new(next),
                effect,
                base: candidate_unknown.base,
                is_shape: candidate_unknown.is_shape,
                prior: None,
            });
            next += 1;
        }
    }
    own
}

/// Runs a preliminary fit with the candidates.
pub fn preliminary(
    pool: &Pool<'_>,
    hypothesis: &Hypothesis,
) -> Result<PreliminaryFit, DiscoverError> {
    let (problem, fit) = (pool.context.problem, pool.context.fit);
    problem.stop.check()?;
    let Extended { unknowns, theta } = unknowns_with(pool, hypothesis, pool.parts[0]);
    let texts = texts(pool, hypothesis, &unknowns, &theta)?;
    // What swings in coordinates of its own is far from the fit however little it does.
    let adds_states = hypothesis.responses.iter().any(|response| {
        let parameters = &pool.candidate(*response).parameters;
        parameters.iter().any(|parameter| parameter.inverse)
    });
    let others = pool.parts[1..]
        .iter()
        .map(|part| unknowns_with(pool, hypothesis, *part).theta);
    let begins: Vec<Vec<f64>> = std::iter::once(theta).chain(others).collect();
    if pool.is_whole && hypothesis.deleted.is_none() && !adds_states {
        let cost = pool.screening.predicted(&hypothesis.responses).cost;
        let most = thresholds::FAR * fit.train.rms;
        let warm_start = WarmStart { fit, cost, most };
        return preliminary::expected(problem, texts, unknowns, &begins, warm_start);
    }
    let mut preliminary = preliminary::preliminary(problem, texts, unknowns, &begins)?;
    if pool.is_whole {
        // Beside others that are promised and not fitted yet.
        preliminary.cost = pool.screening.predicted(&hypothesis.responses).cost;
    }
    Ok(preliminary)
}

/// Runs a preliminary fit with the candidates and with shapes at this multiple of their typical
/// sizes.
pub fn with_shape(
    pool: &Pool<'_>,
    hypothesis: &Hypothesis,
    times: f64,
) -> Result<PreliminaryFit, DiscoverError> {
    let Extended {
        unknowns,
        mut theta,
    } = unknowns_with(pool, hypothesis, 1.0);
    for own in own_unknowns(pool, hypothesis)
        .iter()
        .filter(|own| own.is_shape)
    {
        theta[own.unknown] = unknowns[own.unknown].admissible(times * theta[own.unknown]);
    }
    let texts = texts(pool, hypothesis, &unknowns, &theta)?;
    preliminary::preliminary(pool.context.problem, texts, unknowns, &[theta])
}

/// Starts a hypothesis of one candidate from the motions of a fit with another. `shape_ratio`:
/// multiple of the typical size of a shape.
pub fn warm_started(
    pool: &Pool<'_>,
    hypothesis: &Hypothesis,
    warm_start: WarmStart<'_>,
    shape_ratio: f64,
) -> Result<PreliminaryFit, DiscoverError> {
    let Extended {
        unknowns,
        mut theta,
    } = unknowns_with(pool, hypothesis, 1.0);
    let count = pool.context.fit.unknowns.len();
    theta[..count].copy_from_slice(&warm_start.fit.train.estimate.theta[..count]);
    for own in own_unknowns(pool, hypothesis)
        .iter()
        .filter(|own| own.is_shape)
    {
        theta[own.unknown] = unknowns[own.unknown].admissible(shape_ratio * theta[own.unknown]);
    }
    let texts = texts(pool, hypothesis, &unknowns, &theta)?;
    preliminary::expected(pool.context.problem, texts, unknowns, &[theta], warm_start)
}

/// Starts a hypothesis of one candidate from the end of the fit of a pair. `own`: its unknowns in
/// that fit, SI.
pub fn half_alone(
    pool: &Pool<'_>,
    hypothesis: &Hypothesis,
    pair: &Fit,
    own: &[f64],
) -> Result<PreliminaryFit, DiscoverError> {
    let Extended { unknowns, .. } = unknowns_with(pool, hypothesis, 1.0);
    let count = pool.context.fit.unknowns.len();
    let theta = [&pair.train.estimate.theta[..count], own].concat();
    let texts = texts(pool, hypothesis, &unknowns, &theta)?;
    let warm_start = WarmStart {
        fit: pair,
        cost: pair.train.estimate.cost,
        most: thresholds::FAR * pair.train.rms,
    };
    preliminary::expected(pool.context.problem, texts, unknowns, &[theta], warm_start)
}

/// The specification's texts with a hypothesis' candidates, at these values of the unknowns.
fn texts(
    pool: &Pool<'_>,
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
            .map(|index| unknowns[index].what.stated(theta[index]))
            .collect();
        let candidate = &pool.candidates[response.candidate];
        texts = candidate.added(pool.context.problem, &texts, &values)?;
    }
    Ok(texts)
}

/// The unknowns with a hypothesis' candidates and their values, so much of the promised sizes from
/// absent.
fn unknowns_with(pool: &Pool<'_>, hypothesis: &Hypothesis, part: f64) -> Extended {
    let fit = pool.context.fit;
    let mut unknowns = fit.unknowns.clone();
    let mut theta = fit.restarted();
    if let Some(deleted) = hypothesis.deleted {
        unknowns[deleted].bounds = Interval::ZERO;
        theta[deleted] = 0.0;
    }
    let mut sizes = hypothesis.sizes.iter().map(|size| part * size);
    for response in &hypothesis.responses {
        let response = &pool.screening.responses[*response];
        if let Some(id) = response.dropped_prior {
            let size = sizes.next().unwrap_or(0.0);
            unknowns[id] = unknowns[id].without_prior();
            theta[id] = unknowns[id].admissible(fit.train.estimate.theta[id] + size);
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
                    .admissible(candidate_unknown.base + size),
            );
            let mut unknown = candidate_unknown.unknown.clone();
            unknown.scale = size.abs().max(1e-3 * unknown.scale);
            unknowns.push(unknown);
        }
    }
    Extended { unknowns, theta }
}
