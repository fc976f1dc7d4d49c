//! Results from the fits and the search.

use crate::ids::{ChannelId, UnknownId};
use std::collections::BTreeMap;

use eomgen_records::dataset::Channel;

use crate::empirical::EMPIRICAL;
use crate::experiment::next::{Experiments, NextExperiment};
use crate::fit::fitted::Fit;
use crate::fit::noise_floor::NoiseFloor;
use crate::model::input_faults::{declared, delayed_input};
use crate::model::problem::{EstimationProblem, Judged};
use crate::model::unknowns::{Unknown, What};
use crate::report::quantity::{estimate, quantity};
use crate::report::result::{
    ChannelGap, EffectAt, Estimated, FoundEffect, Nuisance, OnRecords, RejectedEffect, Sensor,
    ShaftOrder, Status, Step,
};
use crate::search::found::{Accepted, Found, Rejected};

/// Computes the gap of each channel before and after the search.
pub(crate) fn gap(
    problem: &EstimationProblem<'_>,
    before: &Fit,
    after: Option<&Fit>,
    floor: &NoiseFloor,
) -> BTreeMap<String, ChannelGap> {
    let of = |fit: &Fit, channel: ChannelId| OnRecords {
        train: fit.train.channels[channel],
        test: fit.test.channels[channel],
    };
    by_channel(problem, |channel, entry| ChannelGap {
        unit: entry.unit.clone(),
        floor: floor.channels[channel],
        before: of(before, channel),
        after: after.map(|after| of(after, channel)),
    })
}

/// Evidence for the certainty of effects, besides their own statistics.
#[derive(Clone, Copy)]
pub(crate) struct Certainty {
    /// Whether the remaining gap and the nuisances allow a definite name.
    pub is_sure: bool,
    /// Noise floor, in standard deviations of the noise.
    pub floor: f64,
}

/// Returns the accepted effects by decreasing closed gap.
pub(crate) fn effects(
    problem: &EstimationProblem<'_>,
    found: &Found,
    experiments: &Experiments,
    certainty: Certainty,
) -> Vec<FoundEffect> {
    let mut order: Vec<(&Accepted, &Option<NextExperiment>)> = (found.accepted.iter())
        .zip(&experiments.of_effects)
        .collect();
    order.sort_by(|(a, _), (b, _)| {
        // Squares add up: what one effect closes of them hardly depends on what came before.
        let closed =
            |effect: &Accepted| effect.test_gap.before.powi(2) - effect.test_gap.after.powi(2);
        closed(b).total_cmp(&closed(a))
    });
    let effects = order.into_iter();
    effects
        .map(|(effect, next)| FoundEffect {
            next_experiment: next.clone(),
            ..found_effect(problem, found.best(), effect, certainty)
        })
        .collect()
}

/// Returns the rejected effects, testable or not.
pub(crate) fn rejected(
    judged: &Judged,
    found: &Found,
    experiments: &Experiments,
    not_testable: bool,
) -> Vec<RejectedEffect> {
    let such = found.rejected.iter().zip(&experiments.of_rejected);
    let such = such.filter(|(rejected, _)| rejected.not_testable == not_testable);
    // What is accepted, or may be meant by what is, is not rejected too: a later round knows it as
    // one more of the same.
    let is_believed = |of: &Rejected| {
        let accepted = found.accepted.iter();
        let mut believed = accepted
            .flat_map(|effect| std::iter::once(&effect.candidate).chain(&effect.equivalent));
        believed.any(|known| known.is_same_as(&of.candidate))
    };
    let such = such.filter(|(rejected, _)| !is_believed(rejected));
    such.map(|(of, next)| RejectedEffect {
        at: EffectAt {
            effect: of.candidate.effect.clone(),
            on: of.candidate.on.clone(),
        },
        reason: reason(of),
        experiment: of.candidate.experiment.clone(),
        next_experiment: next.clone(),
        p_values: of.p_value.map(|p| (p, judged.adjusted(p))),
    })
    .collect()
}

/// Returns the test gap of the original model and after each round.
pub(crate) fn steps(found: &Found) -> Vec<Step> {
    let mut steps = vec![Step {
        added: Vec::new(),
        test_rms: found.null.test.rms,
    }];
    for round in found.accepted.chunk_by(|a, b| a.test_gap == b.test_gap) {
        let labels = round.iter().map(|effect| effect.candidate.label());
        steps.push(Step {
            added: labels.collect(),
            test_rms: round[0].test_gap.after,
        });
    }
    steps
}

/// Why a candidate was rejected; with the order or the load where it has one.
fn reason(rejected: &Rejected) -> String {
    let Rejected {
        candidate, reason, ..
    } = rejected;
    match (&candidate.order, &candidate.load) {
        (Some((angle, order)), _) => format!("{order} per turn of {angle}: {reason}"),
        (None, Some(load)) => format!("by the load of {load}: {reason}"),
        (None, None) => reason.clone(),
    }
}

/// Returns the closed fraction of the gap; `None` if there was almost no gap.
pub(crate) fn closure(before: &Fit, after: &Fit, floor: &NoiseFloor) -> OnRecords<Option<f64>> {
    let closed = |before: f64, after: f64| {
        let part = (before - after) / (before - floor.rms);
        (before >= 2.0 * floor.rms || before.is_nan()).then_some(part)
    };
    OnRecords {
        train: closed(before.train.rms, after.train.rms),
        test: closed(before.test.rms, after.test.rms),
    }
}

fn found_effect(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    effect: &Accepted,
    Certainty { is_sure, floor }: Certainty,
) -> FoundEffect {
    let candidate = &effect.candidate;
    let theta = &fit.train.estimate.theta;
    let sd = |id: &UnknownId| fit.sd_beside_misfit(*id, floor);
    let mut term = candidate.term.clone();
    let own = candidate.parameters.iter().zip(&effect.unknowns);
    let mut parameters: BTreeMap<String, Estimated> = own
        .map(|(parameter, id)| {
            let (value, sd) = match fit.unknowns[*id].what {
                What::Inverse(_) => {
                    let inverse = theta[*id];
                    (1.0 / inverse, sd(id) / (inverse * inverse))
                }
                _ => {
                    let per_si = parameter.per_si();
                    (per_si * theta[*id], per_si * sd(id))
                }
            };
            let unit = parameter.unit.clone();
            (parameter.name.clone(), Estimated { value, sd, unit })
        })
        .collect();
    if candidate.dropped_prior.is_some()
        && let Some(id) = effect.unknowns.first()
        && let Some((name, per_si, unit)) = named(problem, fit, &fit.unknowns[*id].what)
    {
        let value = per_si * theta[*id];
        let sd = per_si * sd(id);
        term = format!("{name} = {value}");
        parameters.insert(name, Estimated { value, sd, unit });
    }
    let equivalent = effect.equivalent.iter().map(|other| EffectAt {
        effect: other.effect.clone(),
        on: other.on.clone(),
    });
    let has_equivalent = !effect.equivalent.is_empty();
    FoundEffect {
        at: EffectAt {
            effect: candidate.effect.clone(),
            on: candidate.on.clone(),
        },
        says: candidate.says.clone(),
        status: match (candidate.effect.as_str(), has_equivalent, is_sure) {
            (EMPIRICAL, _, _) => Status::Empirical,
            (_, true, _) => Status::Class,
            (_, false, true) => Status::Named,
            (_, false, false) => Status::Provisional,
        },
        equivalent: equivalent.collect(),
        parameters,
        term,
        statistics: effect.statistics.clone(),
        adjusted_p_value: (effect.statistics.p_value).map(|p| problem.judged.adjusted(p)),
        order: candidate
            .order
            .clone()
            .map(|(angle, order)| ShaftOrder { angle, order }),
        load: candidate.load.clone(),
        experiment: has_equivalent.then(|| candidate.experiment.clone()),
        next_experiment: None,
    }
}

/// Returns the nuisances of a fit with their declared priors.
pub(crate) fn nuisances(problem: &EstimationProblem<'_>, fit: &Fit) -> Vec<Nuisance> {
    let of = |(id, unknown): (UnknownId, &Unknown)| {
        let prior = unknown.prior?;
        let (name, per_si, unit) = named(problem, fit, &unknown.what)?;
        let (of, fault) = match &unknown.what {
            What::Parameter(_) | What::Inverse(_) => match declared(&problem.dataset.inputs, &name)
            {
                Some((input, fault, _)) => (input.to_owned(), Some(fault.word())),
                None => (name, None),
            },
            What::Gain(at) => (problem.dataset.channels[*at].name.clone(), Some("gain")),
            What::Bias(at) => (problem.dataset.channels[*at].name.clone(), Some("bias")),
            What::Delay(at) => (problem.dataset.channels[*at].name.clone(), Some("delay")),
            What::InputDelay => (
                delayed_input(&problem.dataset.inputs)?.0.to_owned(),
                Some("delay"),
            ),
        };
        Some(Nuisance {
            of,
            fault,
            declared: (per_si * prior.mean, per_si * prior.sd),
            fitted: Estimated {
                value: per_si * fit.train.estimate.theta[id],
                sd: per_si * fit.sd[id],
                unit,
            },
        })
    };
    fit.unknowns().filter_map(of).collect()
}

/// Returns notes on nuisances at their bounds.
pub(crate) fn bound_notes(nuisances: &[Nuisance]) -> Vec<String> {
    let at_bound = nuisances.iter().filter(|of| of.is_at_bound());
    let note = |of: &Nuisance| {
        let (mean, sd) = of.declared;
        let unit = &of.fitted.unit;
        format!(
            "{} is {}, {:.1} standard deviations from the declared value ({}), at the bound of the fit: another \
             effect may be missing",
            of.name(),
            quantity(of.fitted.value, 4, unit),
            of.deviations().abs(),
            estimate(mean, sd, unit),
        )
    };
    at_bound.map(note).collect()
}

/// What an unknown of the null model is called, the number of its units that one SI unit is, and
/// the unit.
fn named(problem: &EstimationProblem<'_>, fit: &Fit, what: &What) -> Option<(String, f64, String)> {
    match what {
        What::Gain(_) => Some(("gain".to_owned(), 1.0, "1".to_owned())),
        What::Bias(at) => {
            let unit = problem.dataset.channels[*at].unit.clone();
            Some(("bias".to_owned(), 1.0, unit))
        }
        What::Delay(_) | What::InputDelay => Some(("delay".to_owned(), 1.0, "s".to_owned())),
        What::Parameter(name) => {
            let mut parameters = fit.model.specification().parameters.iter();
            let parameter = parameters.find(|p| p.name == *name)?;
            let unit = parameter.unit.text.clone();
            Some((name.clone(), parameter.unit.from_si(1.0), unit))
        }
        What::Inverse(_) => None,
    }
}

/// Returns the parameters of the null model by name.
pub(crate) fn refitted(fit: &Fit, accepted: &[Accepted]) -> BTreeMap<String, Estimated> {
    let mut found = BTreeMap::new();
    for (id, unknown) in fit.unknowns() {
        let What::Parameter(name) = &unknown.what else {
            continue;
        };
        let is_own = |effect: &Accepted| {
            effect.candidate.dropped_prior.is_none() && effect.unknowns.contains(&id)
        };
        if accepted.iter().any(is_own) {
            continue;
        }
        let mut parameters = fit.model.specification().parameters.iter();
        if let Some(parameter) = parameters.find(|p| p.name == *name) {
            let entry = Estimated {
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
pub(crate) fn sensors(problem: &EstimationProblem<'_>, fit: &Fit) -> BTreeMap<String, Sensor> {
    let shooting = fit.shooting(problem);
    let sensors = shooting.sensors(&fit.train.estimate.theta);
    by_channel(problem, |channel, _| Sensor {
        bias: sensors.bias[channel],
        gain: sensors.gain[channel],
        delay: sensors.delay[channel],
    })
}

/// An entry for each channel, under its name.
fn by_channel<T>(
    problem: &EstimationProblem<'_>,
    of: impl Fn(ChannelId, &Channel) -> T,
) -> BTreeMap<String, T> {
    let all = &problem.dataset.channels;
    let channels = ChannelId::first(all.len()).zip(all);
    let entries = channels.map(|(id, channel)| (channel.name.clone(), of(id, channel)));
    entries.collect()
}
