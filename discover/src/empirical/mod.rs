//! Empirical expressions for a gap that no effect of the catalogue explains: an expression of few
//! terms in the equation of motion with the largest residual force. It is fitted like an effect and
//! must pass a stricter test on held-out records. Its status is `empirical`, without another name.
//! `expressions` defines the terms, and `chosen` selects them.

pub mod chosen;
pub mod expressions;

use crate::ids::{EffectId, EquationId, UnknownId};
use eomgen_model_spec::edit::{Edit, NewForce, NewParameter, NewValue};
use eomgen_model_spec::model::Model;

use crate::catalogue::candidate::{Candidate, CandidateParameter, names};
use crate::catalogue::candidate_unknown::CandidateUnknown;
use crate::catalogue::template::free_name;
use crate::empirical::chosen::{Expression, chosen};
use crate::empirical::expressions::{Of, Term, Words};
use crate::error::DiscoverError;
use crate::fit::fitted::Fit;
use crate::fit::full;
use crate::fit::preliminary::{self, WarmStart};
use crate::model::problem::EstimationProblem;
use crate::residual_force::residual_force;
use crate::residual_force::types::RankedEquation;
use crate::search::acceptance::{EffectUnknown, TestStatistics, acceptance_test};
use crate::search::found::{Accepted, Found, Rejected, TestGap};
use crate::search::rejection::Rejection;
use crate::thresholds;

/// Effect name of an unnamed expression.
pub const EMPIRICAL: &str = "empirical";

/// Adds an unnamed expression if no effect is named. After a named effect the gap may be its own
/// misfit. If only a shifted parameter was accepted and a large gap remains, an expression with a
/// clearly smaller gap replaces it.
pub fn unnamed(
    problem: &EstimationProblem<'_>,
    found: &mut Found,
    floor: f64,
    progress: &(dyn Fn(&str) + Sync),
) {
    let is_offset = |effect: &Accepted| effect.candidate.is_offset();
    let leaves_little = found.best().leaves_less(thresholds::UNNAMED_FROM * floor);
    if !found.accepted.iter().all(is_offset) || (leaves_little && found.last.is_some()) {
        return;
    }
    let (offset, with_offsets) = (std::mem::take(&mut found.accepted), found.last.take());
    add_empirical(problem, found, floor, progress);
    if let Some(with_offsets) = with_offsets {
        let is_better =
            (found.last.as_ref()).is_some_and(|last| last.leaves_clearly_less(&with_offsets));
        if !is_better {
            (found.accepted, found.last) = (offset, Some(with_offsets));
        }
    }
}

/// Adds an expression to what was found, if a real gap is left and one closes it. `floor`: what a
/// right model would leave, in standard deviations; `progress` is told what is done.
fn add_empirical(
    problem: &EstimationProblem<'_>,
    found: &mut Found,
    floor: f64,
    progress: &dyn Fn(&str),
) {
    let before = found.best();
    let is_wide = |rms: f64| rms > thresholds::UNNAMED_FROM * floor;
    if !(is_wide(before.train.rms) && is_wide(before.test.rms)) {
        return;
    }
    progress("no effect of the catalogue explains the residual; searching for an expression");
    let Some(expression) = sought(problem, before) else {
        progress("  no force of few terms in one equation is significant");
        return;
    };
    let (candidate, fit) = match simplest(problem, before, expression) {
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
    let verdict = accepted((before, &fit), &candidate, &unknowns, floor);
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
            found.accepted.push(Accepted {
                candidate,
                unknowns,
                equivalent: Vec::new(),
                statistics,
                test_gap: TestGap {
                    before: before.test.rms,
                    after: test,
                },
            });
            found.last = Some(fit);
        }
        Err(reason) => found.rejected.push(Rejected {
            reason: format!("{}: {reason}", candidate.term),
            candidate,
            not_testable: false,
            p_value: None,
        }),
    }
}

/// The best expression in the equations where the residual force may sit.
fn sought(problem: &EstimationProblem<'_>, fit: &Fit) -> Option<Expression> {
    let force = residual_force(problem, fit, None)?;
    force.kind.as_ref()?;
    let explains = |ranking: &RankedEquation| ranking.by_state.max(ranking.by_time);
    let most = force.ranking.iter().map(explains).fold(0.0, f64::max);
    let mut as_well: Vec<&RankedEquation> = (force.ranking.iter())
        .filter(|ranking| explains(ranking) >= thresholds::AS_WELL * most)
        .collect();
    as_well.sort_by(|a, b| explains(b).total_cmp(&explains(a)));
    let best = as_well.iter().take(thresholds::UNNAMED_EQUATIONS);
    let among: Vec<EquationId> = best.map(|ranking| ranking.equation).collect();
    chosen(problem, fit, &among)
}

/// An expression as an effect that can be written into a specification: a parameter with the
/// unit of the force for each term, and one for each scale.
fn written(model: &Model, expression: &Expression) -> Candidate {
    let equation = &expression.equation;
    let mut taken = names(model);
    let mut name = |wanted: &str| free_name(wanted, &equation.name, &mut taken);
    let mut changes = Vec::new();
    let mut scale = |of: Of, (wanted, value, unit): (&str, f64, &str), what: &str| {
        let name = name(wanted);
        if expression.terms.iter().any(|term| term.scales(of)) {
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
    let arguments = Words {
        on: equation.on.clone(),
        scales: [
            scale(Of::Rate, ("e_rate", scales.rate, per_second), "rate"),
            scale(
                Of::Position,
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
                (input.name.clone(), scale(Of::Input(number), of, "input"))
            })
            .collect(),
    };
    let size = |name: String| CandidateParameter {
        name,
        unit: equation.force_unit().to_owned(),
        typical_size: 1.0,
        positive: false,
        inverse: false,
        shape: None,
        offset: None,
        doc: "coefficient of a term of an empirical force".to_owned(),
    };
    let place = |name: String, at: f64| CandidateParameter {
        unit: "1".to_owned(),
        positive: true,
        shape: Some(at),
        doc: "position of a kink of an empirical force, relative to its scale".to_owned(),
        ..size(name)
    };
    // Sizes first, one for each term, then the places of kinks.
    let (mut parameters, mut kinks, mut terms) = (Vec::new(), Vec::new(), Vec::new());
    for (number, term) in (1..).zip(&expression.terms) {
        let own = size(name(&format!("e_{number}")));
        let kink = term.kink().map(|at| place(name("e_kink"), at));
        let at = kink.as_ref().map_or("", |kink| kink.name.as_str());
        terms.push(term.text(&own.name, at, &arguments));
        parameters.push(own);
        kinks.extend(kink);
    }
    parameters.extend(kinks);
    let value = terms.join(" + ");
    changes.push(Edit::AddForce(NewForce {
        name: name(EMPIRICAL),
        on: equation.on.clone(),
        value: value.clone(),
        doc: "a fitted expression that does not identify the cause".to_owned(),
        source: String::new(),
    }));
    Candidate {
        effect: EMPIRICAL.to_owned(),
        on: equation.name.clone(),
        order: None,
        load: None,
        on_mesh: equation.is_mesh,
        scaled: None,
        parameters,
        says: "a fitted expression for the residual".to_owned(),
        experiment: "records with other combinations of rates, positions and inputs".to_owned(),
        changes,
        term: value,
        dropped_prior: None,
    }
}

/// An expression fitted, without the terms that are not needed: some stand for what parameters
/// and sensors do once they are free again.
fn simplest(
    problem: &EstimationProblem<'_>,
    before: &Fit,
    mut expression: Expression,
) -> Result<(Candidate, Fit), DiscoverError> {
    loop {
        let candidate = written(before.model.specification(), &expression);
        let fit = fitted(problem, before, &candidate, &expression)?;
        let (first, count) = (before.unknowns.len(), expression.terms.len());
        let (own, kinks) = fit.train.estimate.theta[first..].split_at(count);
        let sizes = own.iter().zip(&fit.wider_sd[first..]);
        let t: Vec<f64> = sizes.map(|(value, sd)| (value / sd).abs()).collect();
        let weakest = (0..t.len()).min_by(|a, b| t[*a].total_cmp(&t[*b]));
        match weakest.filter(|term| t.len() > 1 && t[*term] < thresholds::SIGNIFICANCE) {
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

/// The fit with an expression: started close to the one without, and anew from the beginnings of
/// the windows; the better of both.
fn fitted(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    candidate: &Candidate,
    expression: &Expression,
) -> Result<Fit, DiscoverError> {
    let kinks = expression.terms.iter().filter_map(Term::kink);
    let values: Vec<f64> = expression.sizes.iter().copied().chain(kinks).collect();
    let mut unknowns = fit.unknowns.clone();
    let mut theta = fit.restarted();
    for (parameter, value) in candidate.parameters.iter().zip(&values) {
        let mut unknown = CandidateUnknown::of(parameter).unknown;
        unknown.scale = value.abs();
        unknowns.push(unknown);
        theta.push(*value);
    }
    let texts = candidate.added(problem, &fit.texts, &values)?;
    let near = || {
        let warm_start = WarmStart {
            fit,
            cost: fit.train.estimate.cost,
            most: f64::INFINITY,
        };
        let preliminary = preliminary::expected(
            problem,
            texts.clone(),
            unknowns.clone(),
            std::slice::from_ref(&theta),
            warm_start,
        )?;
        full::complete(problem, preliminary)
    };
    let restarted = || full::fit(problem, texts.clone(), unknowns.clone(), &theta);
    match rayon::join(near, restarted) {
        (Ok(near), Ok(restarted)) if restarted.train.rms < near.train.rms => Ok(restarted),
        (Ok(fit), _) | (Err(_), Ok(fit)) => Ok(fit),
        (Err(error), Err(_)) => Err(error),
    }
}

/// Whether an expression is accepted: by all that is asked of an effect, each of its terms by
/// itself, and by how much of the gap it closes.
fn accepted(
    (before, after): (&Fit, &Fit),
    candidate: &Candidate,
    unknowns: &[UnknownId],
    floor: f64,
) -> Result<TestStatistics, Rejection> {
    let parameters = candidate.parameters.iter().zip(unknowns).enumerate();
    let own = parameters.map(|(number, (parameter, unknown))| {
        let is_shape = parameter.shape.is_some();
        EffectUnknown {
            unknown: *unknown,
            // Where a kink is has no size of its own, and goes with any term.
            effect: EffectId::new(if is_shape { 0 } else { number }),
            base: 0.0,
            is_shape,
            prior: None,
        }
    });
    let own: Vec<EffectUnknown> = own.collect();
    let statistics = acceptance_test(before, after, &own)?;
    let asked = thresholds::INFORMATION * (1 + own.len()) as f64;
    if statistics.information < asked {
        return Err(Rejection::Information {
            found: statistics.information,
            asked,
        });
    }
    let closes = |before: f64, after: f64| (before - after) / (before - floor);
    let train = closes(before.train.rms, after.train.rms);
    let test = closes(before.test.rms, after.test.rms);
    if train.min(test) < thresholds::UNNAMED_CLOSES {
        return Err(Rejection::Closes { train, test });
    }
    Ok(statistics)
}
