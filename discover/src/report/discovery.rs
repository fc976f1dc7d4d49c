//! Conversion of fits and search results to the results of a search.

use std::collections::BTreeMap;

use eomgen_records::dataset::Channel;

use crate::empirical::EMPIRICAL_EFFECT;
use crate::experiment::next_experiment::Experiments;
use crate::fit::fit_result::Fit;
use crate::fit::noise_floor::NoiseFloor;
use crate::ids::{ChannelId, UnknownId};
use crate::model::input_faults::{find_declared, find_delayed_input};
use crate::model::problem::{EstimationProblem, TestCounter};
use crate::model::unknowns::{Unknown, UnknownKind};
use crate::report::effect_sizes::{SizesByMember, list_equivalents, list_sizes};
use crate::report::names::{locate, name_unknown};
use crate::report::quantity::{format_estimate, format_quantity};
use crate::report::result::{
    ChannelGap, EffectSite, EffectStatus, EstimateWithUnit, FoundEffect, Nuisance, RejectedEffect,
    SearchStep, SensorEstimate, TrainTest,
};
use crate::search::member_fits::MemberFit;
use crate::search::search_result::{AcceptedEffect, RejectedCandidate, SearchResult};
use crate::thresholds;

/// Computes the gap of each channel before and after the search.
pub(crate) fn compute_gap(
    problem: &EstimationProblem<'_>,
    before: &Fit,
    after: Option<&Fit>,
    floor: &NoiseFloor,
) -> BTreeMap<String, ChannelGap> {
    let of = |fit: &Fit, channel: ChannelId| TrainTest {
        train: fit.train.channel_rms[channel],
        test: fit.test.channel_rms[channel],
    };
    map_channels(problem, |channel, entry| ChannelGap {
        unit: entry.unit.clone(),
        floor: floor.channels[channel],
        before: of(before, channel),
        after: after.map(|after| of(after, channel)),
    })
}

/// Evidence for the certainty of effects in addition to their own statistics.
#[derive(Clone, Copy)]
pub(crate) struct Certainty {
    /// True if the remaining gap and the nuisances allow a definite name.
    pub is_sure: bool,
    /// Noise floor, in standard deviations of the noise.
    pub floor: f64,
}

/// Returns the accepted effects, sorted by decreasing closure. `classes`: members of the class of
/// each accepted effect.
pub(crate) fn summarise_effects(
    problem: &EstimationProblem<'_>,
    found: &SearchResult,
    (classes, experiments): (&[Vec<MemberFit>], &Experiments),
    certainty: Certainty,
) -> Vec<FoundEffect> {
    let mut order: Vec<usize> = (0..found.accepted.len()).collect();
    // Squared gaps are additive, so that the contribution of an effect hardly depends on earlier
    // effects.
    let closed = |index: &usize| {
        let gap = &found.accepted[*index].test_gap;
        gap.before.powi(2) - gap.after.powi(2)
    };
    order.sort_by(|a, b| closed(b).total_cmp(&closed(a)));
    let create = |index: usize| {
        let others = found.accepted.iter().zip(classes).enumerate();
        let others = others.filter(move |(other, _)| *other != index);
        let effect = (&found.accepted[index], &classes[index][..]);
        let others = others.map(|(_, other)| other);
        FoundEffect {
            next_experiment: experiments.for_effects[index].clone(),
            ..create_found_effect(problem, found.best_fit(), effect, others, certainty)
        }
    };
    order.into_iter().map(create).collect()
}

/// Returns the rejected effects, either the testable or the untestable ones.
pub(crate) fn list_rejected(
    judged: &TestCounter,
    found: &SearchResult,
    experiments: &Experiments,
    not_testable: bool,
) -> Vec<RejectedEffect> {
    let rejected = found.rejected.iter().zip(&experiments.for_rejected);
    let rejected = rejected.filter(|(rejected, _)| rejected.is_untestable == not_testable);
    // Accepted effects and members of their classes are left out, because a later round tests them
    // again as a second effect.
    let is_accepted = |of: &RejectedCandidate| {
        let accepted = found.accepted.iter();
        let mut accepted_candidates = accepted
            .flat_map(|effect| std::iter::once(&effect.candidate).chain(&effect.equivalents));
        accepted_candidates.any(|known| known.is_same_effect_as(&of.candidate))
    };
    let rejected = rejected.filter(|(rejected, _)| !is_accepted(rejected));
    rejected
        .map(|(of, next)| RejectedEffect {
            at: EffectSite {
                effect: of.candidate.effect.clone(),
                site: of.candidate.site.clone(),
                // The order is part of the reason.
                order: None,
            },
            reason: describe_reason(of),
            best_of_round: of.best_of_round.clone(),
            is_fitted: of.is_fitted,
            experiment: of.candidate.experiment.clone(),
            next_experiment: next.clone(),
            p_values: of.p_value.map(|p| (p, judged.adjust_p_value(p))),
        })
        .collect()
}

/// Returns the RMS residual of the test records for the original model and after each round.
pub(crate) fn list_steps(found: &SearchResult) -> Vec<SearchStep> {
    let mut steps = vec![SearchStep {
        added: Vec::new(),
        test_rms: found.null_fit.test.rms,
    }];
    for round in found.accepted.chunk_by(|a, b| a.test_gap == b.test_gap) {
        let labels = round.iter().map(|effect| effect.candidate.label());
        steps.push(SearchStep {
            added: labels.collect(),
            test_rms: round[0].test_gap.after,
        });
    }
    steps
}

/// Returns the reason for the rejection of a candidate, with its order or load.
fn describe_reason(rejected: &RejectedCandidate) -> String {
    let RejectedCandidate {
        candidate, reason, ..
    } = rejected;
    match (&candidate.angle_order, &candidate.load) {
        (Some((angle, order)), _) => format!("{order} per turn of {angle}: {reason}"),
        (None, Some(load)) => format!("by the load of {load}: {reason}"),
        (None, None) => reason.clone(),
    }
}

/// Returns the closed fraction of the gap; `None` if the gap is negligible.
pub(crate) fn compute_closure(
    before: &Fit,
    after: &Fit,
    floor: &NoiseFloor,
) -> TrainTest<Option<f64>> {
    let closed = |before: f64, after: f64| {
        let part = (before - after) / (before - floor.rms);
        (before >= 2.0 * floor.rms || before.is_nan()).then_some(part)
    };
    TrainTest {
        train: closed(before.train.rms, after.train.rms),
        test: closed(before.test.rms, after.test.rms),
    }
}

/// Converts an accepted effect. `others`: the other accepted effects with the members of their
/// classes.
fn create_found_effect<'a>(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    (effect, class): (&AcceptedEffect, &[MemberFit]),
    others: impl Iterator<Item = (&'a AcceptedEffect, &'a Vec<MemberFit>)>,
    Certainty { is_sure, floor }: Certainty,
) -> FoundEffect {
    let candidate = &effect.candidate;
    let mut parameters = list_sizes(problem, (fit, &effect.unknowns), candidate, floor);
    let term = match (&candidate.dropped_prior, parameters.first_key_value()) {
        (Some(_), Some((name, size))) => format!("{name} = {}", size.value),
        _ => candidate.term.clone(),
    };
    let by_member = SizesByMember::collect(problem, (fit, effect), others, floor);
    let conditional = by_member.list_different(&parameters);
    by_member.widen(&mut parameters);
    let has_equivalent = !effect.equivalents.is_empty();
    FoundEffect {
        at: locate(candidate),
        description: candidate.description.clone(),
        status: match (candidate.effect.as_str(), has_equivalent, is_sure) {
            (EMPIRICAL_EFFECT, _, _) => EffectStatus::Empirical,
            (_, true, _) => EffectStatus::Class,
            (_, false, true) => EffectStatus::Named,
            (_, false, false) => EffectStatus::Provisional,
        },
        equivalents: list_equivalents(problem, effect, class, floor),
        parameters,
        conditional,
        term,
        statistics: effect.statistics.clone(),
        adjusted_p_value: (effect.statistics.p_value)
            .map(|p| problem.tested_hypotheses.adjust_p_value(p)),
        load: candidate.load.clone(),
        experiment: has_equivalent.then(|| candidate.experiment.clone()),
        next_experiment: None,
    }
}

/// Returns the nuisances of a fit with their declared priors.
pub(crate) fn list_nuisances(problem: &EstimationProblem<'_>, fit: &Fit) -> Vec<Nuisance> {
    let of = |(id, unknown): (UnknownId, &Unknown)| {
        let prior = unknown.prior?;
        let (name, per_si, unit) = name_unknown(problem, fit, &unknown.kind)?;
        let (of, fault) = match &unknown.kind {
            UnknownKind::Parameter(_) | UnknownKind::InverseParameter(_) => {
                match find_declared(&problem.dataset.inputs, &name) {
                    Some((input, fault, _)) => (input.to_owned(), Some(fault.name())),
                    None => (name, None),
                }
            }
            UnknownKind::Gain(at) => (problem.dataset.channels[*at].name.clone(), Some("gain")),
            UnknownKind::Bias(at) => (problem.dataset.channels[*at].name.clone(), Some("bias")),
            UnknownKind::Delay(at) => (problem.dataset.channels[*at].name.clone(), Some("delay")),
            UnknownKind::InputDelay => (
                find_delayed_input(&problem.dataset.inputs)?.0.to_owned(),
                Some("delay"),
            ),
        };
        Some(Nuisance {
            name: of,
            fault,
            declared: (per_si * prior.mean, per_si * prior.sd),
            estimate: EstimateWithUnit {
                value: per_si * fit.train.estimate.theta[id],
                sd: per_si * fit.sd[id],
                unit,
            },
        })
    };
    fit.unknowns().filter_map(of).collect()
}

/// Returns notes about nuisances that deviate significantly from their declared values.
pub(crate) fn describe_deviations(nuisances: &[Nuisance]) -> Vec<String> {
    let far = nuisances
        .iter()
        .filter(|of| of.deviations_from_prior().abs() >= thresholds::MIN_NOTED_DEVIATION);
    let note = |of: &Nuisance| {
        let (mean, sd) = of.declared;
        let unit = &of.estimate.unit;
        let consequence = match of.is_at_bound() {
            true => ", at the bound of the fit: another effect may be missing",
            false => ": a missing effect may be the cause",
        };
        format!(
            "{} is {}, {:.1} standard deviations from the declared value ({}){consequence}",
            of.full_name(),
            format_quantity(of.estimate.value, 4, unit),
            of.deviations_from_prior().abs(),
            format_estimate(mean, sd, unit),
        )
    };
    far.map(note).collect()
}

/// Returns the parameters of the null model, by name.
pub(crate) fn list_refitted(
    fit: &Fit,
    accepted: &[AcceptedEffect],
) -> BTreeMap<String, EstimateWithUnit> {
    let mut found = BTreeMap::new();
    for (id, unknown) in fit.unknowns() {
        let UnknownKind::Parameter(name) = &unknown.kind else {
            continue;
        };
        let is_own = |effect: &AcceptedEffect| {
            effect.candidate.dropped_prior.is_none() && effect.unknowns.contains(&id)
        };
        if accepted.iter().any(is_own) {
            continue;
        }
        let mut parameters = fit.model.specification().parameters.iter();
        if let Some(parameter) = parameters.find(|p| p.name == *name) {
            let entry = EstimateWithUnit {
                value: parameter.unit.from_si(fit.train.estimate.theta[id]),
                sd: parameter.unit.from_si(fit.sd[id]),
                unit: parameter.unit.text.clone(),
            };
            found.insert(name.clone(), entry);
        }
    }
    found
}

/// Returns the sensor of each channel.
pub(crate) fn list_sensors(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
) -> BTreeMap<String, SensorEstimate> {
    let shooting = fit.training_shooting(problem);
    let sensors = shooting.sensor_values(&fit.train.estimate.theta);
    map_channels(problem, |channel, _| SensorEstimate {
        bias: sensors.bias[channel],
        gain: sensors.gain[channel],
        delay: sensors.delay[channel],
    })
}

/// Returns a map with an entry for each channel.
fn map_channels<T>(
    problem: &EstimationProblem<'_>,
    of: impl Fn(ChannelId, &Channel) -> T,
) -> BTreeMap<String, T> {
    let all = &problem.dataset.channels;
    let channels = ChannelId::first(all.len()).zip(all);
    let entries = channels.map(|(id, channel)| (channel.name.clone(), of(id, channel)));
    entries.collect()
}
