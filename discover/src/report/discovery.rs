//! What was found as JSON documents: `comparison.json` and `discovery.json`.

use eomgen_records::dataset::Channel;
use serde_json::{Map, Value, json};

use crate::empirical::EMPIRICAL;
use crate::fit::fitted::Fit;
use crate::fit::noise_floor::NoiseFloor;
use crate::model::problem::EstimationProblem;
use crate::model::unknowns::What;
use crate::search::found::{Accepted, Found, Rejected};

/// The verdict of a comparison.
pub fn compared(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    floor: &NoiseFloor,
    at_floor: bool,
    place: &str,
) -> Value {
    let verdict = if at_floor {
        "no_significant_gap"
    } else {
        "gap_found"
    };
    let gap = by_channel(problem, |channel, entry| {
        json!({
            "unit": entry.unit,
            "floor": floor.channels[channel],
            "train": fit.train.channels[channel],
            "test": fit.test.channels[channel],
        })
    });
    json!({
        "schema": 1,
        "verdict": verdict,
        "gap": gap,
        "refitted": refitted(fit, &[]),
        "sensors": sensors(problem, fit),
        "where": place,
        "notes": problem.dataset.notes,
    })
}

/// The result of a search.
pub fn discovered(
    problem: &EstimationProblem<'_>,
    found: &Found,
    floor: &NoiseFloor,
    at_floor: bool,
    place: &str,
) -> Value {
    let (before, after) = (&found.null, found.best());
    let verdict = match (found.accepted.is_empty(), at_floor) {
        (false, _) => "effects_found",
        (true, true) => "no_significant_gap",
        (true, false) => "unexplained",
    };
    let gap = by_channel(problem, |channel, entry| {
        json!({
            "unit": entry.unit,
            "floor": floor.channels[channel],
            "before": {"train": before.train.channels[channel], "test": before.test.channels[channel]},
            "after": {"train": after.train.channels[channel], "test": after.test.channels[channel]},
        })
    });
    let mut order: Vec<&Accepted> = found.accepted.iter().collect();
    order.sort_by(|a, b| {
        // Squares add up: what one effect closes of them hardly depends on what came before.
        let closed = |effect: &Accepted| effect.test_gap.0.powi(2) - effect.test_gap.1.powi(2);
        closed(b).total_cmp(&closed(a))
    });
    let effects = order
        .iter()
        .map(|effect| effect_entry(problem, after, effect));
    let (not_testable, rejected): (Vec<&Rejected>, Vec<&Rejected>) = found
        .rejected
        .iter()
        .partition(|rejected| rejected.not_testable);
    json!({
        "schema": 1,
        "verdict": verdict,
        "effects": effects.collect::<Vec<_>>(),
        "rejected": rejected.iter().map(|r| json!({
            "effect": r.candidate.effect, "on": r.candidate.on, "reason": reason(r),
        })).collect::<Vec<_>>(),
        "not_testable": not_testable.iter().map(|r| json!({
            "effect": r.candidate.effect, "on": r.candidate.on, "reason": reason(r),
            "experiment": r.candidate.experiment,
        })).collect::<Vec<_>>(),
        "refitted": refitted(after, &found.accepted),
        "sensors": sensors(problem, after),
        "gap": gap,
        "closure": {
            "train": closure(before.train.rms, after.train.rms, floor.rms),
            "test": closure(before.test.rms, after.test.rms, floor.rms),
        },
        "ladder": ladder(found),
        "where": place,
        "notes": problem.dataset.notes,
    })
}

/// The test gap step by step, in noises: of the model as it is, and after each round.
fn ladder(found: &Found) -> Value {
    let mut steps = vec![json!({"added": [], "test_in_noises": found.null.test.rms})];
    for round in found.accepted.chunk_by(|a, b| a.test_gap == b.test_gap) {
        let labels = round.iter().map(|effect| effect.candidate.label());
        steps.push(json!({
            "added": labels.collect::<Vec<_>>(),
            "test_in_noises": round[0].test_gap.1,
        }));
    }
    Value::Array(steps)
}

/// Why a candidate was rejected; with the order where it has one.
fn reason(rejected: &Rejected) -> String {
    match &rejected.candidate.order {
        Some((angle, order)) => format!("{order} per turn of {angle}: {}", rejected.reason),
        None => rejected.reason.clone(),
    }
}

/// The part of the gap that was closed; none where there was none.
fn closure(before: f64, after: f64, floor: f64) -> Value {
    if before < 2.0 * floor {
        return Value::Null;
    }
    json!((before - after) / (before - floor))
}

fn effect_entry(problem: &EstimationProblem<'_>, fit: &Fit, effect: &Accepted) -> Value {
    let mut term = effect.candidate.term.clone();
    let mut parameters: Map<String, Value> = effect
        .candidate
        .parameters
        .iter()
        .zip(effect.unknowns.iter().copied())
        .map(|(parameter, place)| {
            let (value, sd) = match fit.unknowns[place].what {
                What::Inverse(_) => {
                    let inverse = fit.train.estimate.theta[place];
                    (1.0 / inverse, fit.sd[place] / (inverse * inverse))
                }
                _ => {
                    let per_si = parameter.per_si();
                    (
                        per_si * fit.train.estimate.theta[place],
                        per_si * fit.sd[place],
                    )
                }
            };
            (
                parameter.name.clone(),
                json!({"value": value, "sd": sd, "unit": parameter.unit}),
            )
        })
        .collect();
    if effect.candidate.released.is_some()
        && let Some(place) = effect.unknowns.first()
        && let Some((name, per_si, unit)) = named(problem, fit, &fit.unknowns[*place].what)
    {
        let value = per_si * fit.train.estimate.theta[*place];
        term = format!("{name} = {value}");
        let sd = per_si * fit.sd[*place];
        parameters.insert(name, json!({"value": value, "sd": sd, "unit": unit}));
    }
    let equivalent: Vec<Value> = effect
        .equivalent
        .iter()
        .map(|other| json!({"effect": other.effect, "on": other.on}))
        .collect();
    let status = match (effect.candidate.effect.as_str(), equivalent.is_empty()) {
        (EMPIRICAL, _) => "empirical",
        (_, true) => "named",
        (_, false) => "class",
    };
    let mut entry = json!({
        "effect": effect.candidate.effect,
        "on": effect.candidate.on,
        "status": status,
        "equivalent": equivalent,
        "parameters": parameters,
        "term": term,
        "evidence": {
            "held_out_gap_falls_by": effect.evidence.held_out,
            "standard_errors": effect.evidence.held_out_errors,
            "information": effect.evidence.information,
            "t": effect.evidence.t,
        },
    });
    if let Some((angle, order)) = &effect.candidate.order {
        entry["order"] = json!({"per_turn_of": angle, "order": order});
    }
    if !effect.equivalent.is_empty() {
        entry["experiment"] = json!(effect.candidate.experiment);
    }
    entry
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
        What::Delay(_) => Some(("delay".to_owned(), 1.0, "s".to_owned())),
        What::Parameter(name) => {
            let mut parameters = fit.plant.model().parameters.iter();
            let parameter = parameters.find(|p| p.name == *name)?;
            let unit = parameter.unit.text.clone();
            Some((name.clone(), parameter.unit.from_si(1.0), unit))
        }
        What::Inverse(_) => None,
    }
}

/// Parameters of the null model.
fn refitted(fit: &Fit, accepted: &[Accepted]) -> Value {
    let mut found = Map::new();
    for (place, unknown) in fit.unknowns.iter().enumerate() {
        let What::Parameter(name) = &unknown.what else {
            continue;
        };
        if accepted
            .iter()
            .any(|effect| effect.candidate.released.is_none() && effect.unknowns.contains(&place))
        {
            continue;
        }
        if let Some(parameter) = fit
            .plant
            .model()
            .parameters
            .iter()
            .find(|p| p.name == *name)
        {
            let of = |si: f64| parameter.unit.from_si(si);
            let entry = json!({
                "value": of(fit.train.estimate.theta[place]),
                "sd": of(fit.sd[place]),
                "unit": parameter.unit.text,
            });
            found.insert(name.clone(), entry);
        }
    }
    Value::Object(found)
}

fn sensors(problem: &EstimationProblem<'_>, fit: &Fit) -> Value {
    let shooting = fit.shooting(problem);
    let sensors = shooting.sensors(&fit.train.estimate.theta);
    by_channel(problem, |channel, _| {
        json!({
            "bias": sensors.bias[channel],
            "gain": sensors.gain[channel],
            "delay": sensors.delay[channel],
        })
    })
}

/// An entry for each channel, under its name.
fn by_channel(problem: &EstimationProblem<'_>, of: impl Fn(usize, &Channel) -> Value) -> Value {
    let channels = problem.dataset.channels.iter().enumerate();
    let entries = channels.map(|(place, channel)| (channel.name.clone(), of(place, channel)));
    Value::Object(entries.collect())
}
