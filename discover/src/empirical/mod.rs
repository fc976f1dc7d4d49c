//! Empirical expressions for a gap that no effect of the catalogue explains. An expression of few
//! terms is added to the equation of motion with the largest residual force. It is fitted like an
//! effect and must pass a stricter test on held-out records. Its status is `empirical`, because it
//! does not identify the cause. `expressions` defines the terms, and `term_selection` selects them.

pub mod expressions;
pub mod term_selection;

use crate::ids::{EffectId, EquationId, UnknownId};
use eomgen_model_spec::edit::{Edit, NewForce, NewParameter, NewValue};
use eomgen_model_spec::model::Model;

use crate::catalogue::candidate::{Candidate, CandidateParameter, list_names_in_use};
use crate::catalogue::candidate_unknown::CandidateUnknown;
use crate::catalogue::template::reserve_name;
use crate::empirical::expressions::{ExpressionNames, FactorArgument, Term};
use crate::empirical::term_selection::{Expression, select_expression};
use crate::error::DiscoverError;
use crate::fit::fit_result::Fit;
use crate::fit::full_fit;
use crate::fit::preliminary_fit::{self, WarmStart};
use crate::model::problem::EstimationProblem;
use crate::residual_force::estimate_residual_force;
use crate::residual_force::types::RankedEquation;
use crate::search::acceptance::{EffectUnknown, TestStatistics, test_acceptance};
use crate::search::rejection::Rejection;
use crate::search::search_result::{AcceptedEffect, RejectedCandidate, SearchResult, TestGap};
use crate::thresholds;

/// Effect name of an empirical expression.
pub const EMPIRICAL_EFFECT: &str = "empirical";

/// Adds an empirical expression if no effect of the catalogue is accepted. After an accepted
/// effect, the remaining gap may be a misfit of this effect. If only a parameter shift was accepted
/// and a large gap remains, an expression with a clearly smaller gap replaces it.
pub fn add_empirical_effect(
    problem: &EstimationProblem<'_>,
    found: &mut SearchResult,
    floor: f64,
    progress: &(dyn Fn(&str) + Sync),
) {
    let is_offset = |effect: &AcceptedEffect| effect.candidate.is_offset();
    let leaves_little = found
        .best_fit()
        .is_below(thresholds::MIN_FLOOR_RATIO_FOR_EXPRESSION * floor);
    if !found.accepted.iter().all(is_offset) || (leaves_little && found.extended_fit.is_some()) {
        return;
    }
    let (offset, with_offsets) = (
        std::mem::take(&mut found.accepted),
        found.extended_fit.take(),
    );
    add_empirical(problem, found, floor, progress);
    if let Some(with_offsets) = with_offsets {
        let is_better =
            (found.extended_fit.as_ref()).is_some_and(|last| last.is_clearly_below(&with_offsets));
        if !is_better {
            (found.accepted, found.extended_fit) = (offset, Some(with_offsets));
        }
    }
}

/// Adds an expression to the result if a gap remains and the expression closes it. `floor`: RMS
/// residual of a correct model, in standard deviations.
fn add_empirical(
    problem: &EstimationProblem<'_>,
    found: &mut SearchResult,
    floor: f64,
    progress: &dyn Fn(&str),
) {
    let before = found.best_fit();
    let is_wide = |rms: f64| rms > thresholds::MIN_FLOOR_RATIO_FOR_EXPRESSION * floor;
    if !(is_wide(before.train.rms) && is_wide(before.test.rms)) {
        return;
    }
    progress(
        "no effect of the catalogue explains the residual; searching for a force that is an expression",
    );
    let Some(expression) = find_expression(problem, before) else {
        progress("  no force with few terms in a single equation is significant");
        return;
    };
    let (candidate, fit) = match simplify_expression(problem, before, expression) {
        Ok(found) => found,
        Err(error) => {
            progress(&format!("  {error}"));
            return;
        }
    };
    let label = candidate.label();
    let unknowns: Vec<UnknownId> = UnknownId::first(fit.unknowns.len())
        .skip(before.unknowns.len())
        .collect();
    let verdict = accept_expression((before, &fit), &candidate, &unknowns, floor);
    let outcome = verdict
        .as_ref()
        .err()
        .map_or_else(|| "accepted".to_owned(), Rejection::to_string);
    let (train, test) = (fit.train.rms, fit.test.rms);
    progress(&format!(
        "  {label}, {}: residuals of {train:.2} (training) and {test:.2} (test) standard deviations of the \
         noise; {outcome}",
        candidate.term
    ));
    match verdict {
        Ok(statistics) => {
            found.accepted.push(AcceptedEffect {
                candidate,
                unknowns,
                equivalents: Vec::new(),
                statistics,
                test_gap: TestGap {
                    before: before.test.rms,
                    after: test,
                },
            });
            found.extended_fit = Some(fit);
        }
        Err(reason) => found.rejected.push(RejectedCandidate {
            reason: format!("{}: {reason}", candidate.term),
            candidate,
            best_of_round: None,
            is_fitted: true,
            is_untestable: false,
            p_value: None,
        }),
    }
}

/// Finds the best expression in the equations that may contain the missing force.
fn find_expression(problem: &EstimationProblem<'_>, fit: &Fit) -> Option<Expression> {
    let force = estimate_residual_force(problem, fit, None)?;
    force.kind.as_ref()?;
    let explains =
        |ranking: &RankedEquation| ranking.fraction_by_state.max(ranking.fraction_by_time);
    let most = force.ranking.iter().map(explains).fold(0.0, f64::max);
    let mut as_well: Vec<&RankedEquation> = (force.ranking.iter())
        .filter(|ranking| explains(ranking) >= thresholds::MIN_FRACTION_OF_BEST * most)
        .collect();
    as_well.sort_by(|a, b| explains(b).total_cmp(&explains(a)));
    let best = as_well.iter().take(thresholds::MAX_EXPRESSION_EQUATIONS);
    let among: Vec<EquationId> = best.map(|ranking| ranking.equation).collect();
    select_expression(problem, fit, &among)
}

/// Converts an expression to an effect that can be added to a specification. Each term has a
/// parameter with the unit of the force, and each scale is a parameter.
fn write_candidate(model: &Model, expression: &Expression) -> Candidate {
    let equation = &expression.equation;
    let mut taken = list_names_in_use(model);
    let mut name = |wanted: &str| reserve_name(wanted, &equation.name, &mut taken);
    let mut changes = Vec::new();
    let mut scale = |of: FactorArgument, (wanted, value, unit): (&str, f64, &str), what: &str| {
        let name = name(wanted);
        if expression.terms.iter().any(|term| term.uses_scale_of(of)) {
            changes.push(Edit::AddParameter(NewParameter {
                name: name.clone(),
                value: NewValue::Number(value),
                unit: unit.to_owned(),
                doc: format!("scale of the {what} in an empirical force"),
                source: "largest value in the training records".to_owned(),
            }));
        }
        name
    };
    let (scales, per_second) = (
        &expression.scales,
        match equation.unit {
            "rad" => "1/s",
            _ => "m/s",
        },
    );
    let arguments = ExpressionNames {
        target: equation.target.clone(),
        scales: [
            scale(
                FactorArgument::Rate,
                ("e_rate", scales.rate, per_second),
                "rate",
            ),
            scale(
                FactorArgument::Position,
                (
                    "e_place",
                    scales.position,
                    if equation.unit == "rad" { "1" } else { "m" },
                ),
                "position",
            ),
        ],
        inputs: (model.inputs.iter().zip(&scales.inputs).enumerate())
            .map(|(number, (input, size))| {
                let wanted = format!("e_{}", input.name);
                let of = (wanted.as_str(), *size, input.unit.text.as_str());
                (
                    input.name.clone(),
                    scale(FactorArgument::Input(number), of, "input"),
                )
            })
            .collect(),
    };
    let size = |name: String| CandidateParameter {
        name,
        unit: equation.force_unit().to_owned(),
        typical_size: 1.0,
        is_positive: false,
        is_inverse: false,
        shape_size: None,
        offset: None,
        doc: "coefficient of a term of an empirical force".to_owned(),
    };
    let place = |name: String, at: f64| CandidateParameter {
        unit: "1".to_owned(),
        is_positive: true,
        shape_size: Some(at),
        doc: "position of a kink of an empirical force, relative to its scale".to_owned(),
        ..size(name)
    };
    // Parameters: first the coefficient of each term, then the positions of kinks.
    let (mut parameters, mut kinks, mut terms) = (Vec::new(), Vec::new(), Vec::new());
    for (number, term) in (1..).zip(&expression.terms) {
        let own = size(name(&format!("e_{number}")));
        let kink = term.kink().map(|at| place(name("e_kink"), at));
        let at = kink.as_ref().map_or("", |kink| kink.name.as_str());
        terms.push(term.format_term(&own.name, at, &arguments));
        parameters.push(own);
        kinks.extend(kink);
    }
    parameters.extend(kinks);
    let value = terms.join(" + ");
    changes.push(Edit::AddForce(NewForce {
        name: name(EMPIRICAL_EFFECT),
        on: equation.target.clone(),
        value: value.clone(),
        doc: "a fitted expression that does not identify the cause".to_owned(),
        source: String::new(),
    }));
    Candidate {
        effect: EMPIRICAL_EFFECT.to_owned(),
        site: equation.name.clone(),
        angle_order: None,
        load: None,
        on_mesh: equation.is_mesh,
        scaled_stiffness: None,
        parameters,
        description: "a fitted expression for the residual".to_owned(),
        experiment: "records with other combinations of rates, positions and inputs".to_owned(),
        changes,
        linear_changes: None,
        term: value,
        dropped_prior: None,
    }
}

/// Removes superfluous terms of a fitted expression. Some terms only replace parameters and
/// sensors, which are free again.
fn simplify_expression(
    problem: &EstimationProblem<'_>,
    before: &Fit,
    mut expression: Expression,
) -> Result<(Candidate, Fit), DiscoverError> {
    loop {
        let candidate = write_candidate(before.model.specification(), &expression);
        let fit = fit_candidate(problem, before, &candidate, &expression)?;
        let (first, count) = (before.unknowns.len(), expression.terms.len());
        let (own, kinks) = fit.train.estimate.theta[first..].split_at(count);
        let sizes = own.iter().zip(&fit.effect_sd[first..]);
        let t: Vec<f64> = sizes.map(|(value, sd)| (value / sd).abs()).collect();
        let weakest = (0..t.len()).min_by(|a, b| t[*a].total_cmp(&t[*b]));
        match weakest.filter(|term| t.len() > 1 && t[*term] < thresholds::MIN_SIGNIFICANCE) {
            Some(term) => {
                expression.sizes = own.to_vec();
                let mut kinks = kinks.iter();
                for own in &mut expression.terms {
                    if own.kink().is_some()
                        && let Some(at) = kinks.next()
                    {
                        *own = own.clone().with_kink(*at);
                    }
                }
                expression.sizes.remove(term);
                expression.terms.remove(term);
            }
            None => return Ok((candidate, fit)),
        }
    }
}

/// Fits an expression twice: from the estimates of the fit without it, and anew from the initial
/// segments of the windows. Returns the better fit.
fn fit_candidate(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    candidate: &Candidate,
    expression: &Expression,
) -> Result<Fit, DiscoverError> {
    let kinks = expression.terms.iter().filter_map(Term::kink);
    let values: Vec<f64> = expression.sizes.iter().copied().chain(kinks).collect();
    let mut unknowns = fit.unknowns.clone();
    let mut theta = fit.restart_values();
    for (parameter, value) in candidate.parameters.iter().zip(&values) {
        let mut unknown = CandidateUnknown::from_parameter(parameter).unknown;
        unknown.scale = value.abs();
        unknowns.push(unknown);
        theta.push(*value);
    }
    let texts = candidate.add_to_texts(problem, &fit.texts, &values)?;
    let near = || {
        let warm_start = WarmStart {
            fit,
            cost: fit.train.estimate.cost,
            max_rms: f64::INFINITY,
        };
        let preliminary = preliminary_fit::start_from_fit(
            problem,
            texts.clone(),
            unknowns.clone(),
            std::slice::from_ref(&theta),
            warm_start,
        )?;
        full_fit::complete_fit(problem, preliminary)
    };
    let restarted =
        || full_fit::fit_specification(problem, texts.clone(), unknowns.clone(), &theta);
    match rayon::join(near, restarted) {
        (Ok(near), Ok(restarted)) if restarted.train.rms < near.train.rms => Ok(restarted),
        (Ok(fit), _) | (Err(_), Ok(fit)) => Ok(fit),
        (Err(error), Err(_)) => Err(error),
    }
}

/// Tests an expression. It must pass the tests of an effect with each of its terms, and close a
/// required part of the gap.
fn accept_expression(
    (before, after): (&Fit, &Fit),
    candidate: &Candidate,
    unknowns: &[UnknownId],
    floor: f64,
) -> Result<TestStatistics, Rejection> {
    let parameters = candidate.parameters.iter().zip(unknowns).enumerate();
    let own = parameters.map(|(number, (parameter, unknown))| {
        let is_shape = parameter.shape_size.is_some();
        EffectUnknown {
            unknown: *unknown,
            // The position of a kink is a shape parameter; its effect index is not used.
            effect: EffectId::new(if is_shape { 0 } else { number }),
            base: 0.0,
            is_shape,
            dropped_prior_sd: None,
        }
    });
    let own: Vec<EffectUnknown> = own.collect();
    let statistics = test_acceptance(before, after, &own)?;
    let required = thresholds::MIN_INFORMATION_GAIN * (1 + own.len()) as f64;
    if statistics.information_gain < required {
        return Err(Rejection::Information {
            gain: statistics.information_gain,
            required,
        });
    }
    let closes = |before: f64, after: f64| (before - after) / (before - floor);
    let train = closes(before.train.rms, after.train.rms);
    let test = closes(before.test.rms, after.test.rms);
    if train.min(test) < thresholds::MIN_EXPRESSION_CLOSURE {
        return Err(Rejection::Closure { train, test });
    }
    Ok(statistics)
}
