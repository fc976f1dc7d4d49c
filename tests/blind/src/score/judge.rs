//! Comparison of the found and hidden effects of one case.

use serde_json::Value;

use super::{CaseScore, Judgement};
use crate::hidden::Effect;
use crate::plan::Group;
use crate::records::{Label, Truth};
use crate::run::{Ending, RunResult};

/// Half-width of a 90 % interval, in standard deviations.
const HALF_WIDTH_90: f64 = 1.645;

/// Judges one case.
pub fn judge(label: &Label, outcome: &RunResult) -> CaseScore {
    let empty = Vec::new();
    let discovery = outcome.discovery.as_ref();
    let list = |key: &str| discovery.and_then(|d| d[key].as_array()).unwrap_or(&empty);
    let effects = list("effects");
    let mut judged = CaseScore {
        case: label.case,
        group: label.group,
        hidden: (label.hidden.iter())
            .map(|t| (t.effect.clone(), t.hidden.on.clone(), t.floors))
            .collect(),
        found: effects
            .iter()
            .map(|e| {
                (
                    read_text(e, "effect"),
                    read_text(e, "on"),
                    read_text(e, "status"),
                )
            })
            .collect(),
        judgement: classify_case(label, outcome, effects),
        full_priors: label.full_priors,
        classes: effects.iter().filter_map(read_class_size).collect(),
        extra: 0,
        wrong_signs: 0,
        intervals: (0, 0),
        refitted: (0, 0),
        closure: read_closure(outcome),
        seconds: outcome.seconds,
    };
    for found in effects {
        match label
            .hidden
            .iter()
            .find(|truth| match_effect(found, truth) == Match::Named)
        {
            Some(truth) => check_parameters(
                truth,
                compute_ordinary_error(label, truth),
                found,
                &mut judged,
            ),
            None if label
                .hidden
                .iter()
                .any(|truth| match_effect(found, truth) == Match::Class) => {}
            // If the hidden effect is outside the catalogue, an empirical force is not a false
            // effect.
            None if label.group == Group::Outside && is_empirical(found) => {}
            None => judged.extra += 1,
        }
    }
    if let Some(discovery) = discovery {
        judged.refitted = count_refitted(label, discovery);
    }
    judged
}

/// Returns the closure on held-out records; zero if there is no answer.
fn read_closure(outcome: &RunResult) -> Option<f64> {
    match (outcome.ending, &outcome.discovery) {
        (Ending::Answered, Some(discovery)) => discovery["closure"]["test"].as_f64(),
        _ => Some(0.0),
    }
}

fn classify_case(label: &Label, outcome: &RunResult, effects: &[Value]) -> Judgement {
    match outcome.ending {
        Ending::Timeout => return Judgement::Timeout,
        Ending::Failed => return Judgement::Failed,
        Ending::Answered if outcome.discovery.is_none() => return Judgement::Failed,
        Ending::Answered => {}
    }
    match (label.group, effects) {
        (Group::Nothing, []) => return Judgement::Right,
        (Group::Outside, found) if found.iter().all(is_empirical) => {
            let verdict = outcome.discovery.as_ref().map(|d| read_text(d, "verdict"));
            return match verdict.as_deref() {
                Some("no_significant_gap") => Judgement::Missed,
                _ => Judgement::Right,
            };
        }
        (Group::Outside | Group::Nothing, _) => return Judgement::Wrong,
        (_, []) => {
            let verdict = outcome.discovery.as_ref().map(|d| read_text(d, "verdict"));
            return match verdict.as_deref() {
                Some("no_significant_gap") => Judgement::Missed,
                _ => Judgement::Unexplained,
            };
        }
        _ => {}
    }
    let count = label.hidden.len();
    let matches: Vec<Match> = (label.hidden.iter())
        .map(|truth| {
            let first = effects
                .iter()
                .take(count)
                .map(|found| match_effect(found, truth));
            first.max().unwrap_or(Match::None)
        })
        .collect();
    let needs_class = label.group == Group::Untellable;
    if matches.contains(&Match::None) {
        let some = matches.iter().any(|m| *m != Match::None);
        return if some {
            Judgement::Part
        } else {
            Judgement::Wrong
        };
    }
    let as_can_be = |(m, truth): (&Match, &Truth)| match m {
        Match::Named => !needs_class,
        Match::Class => needs_class || !truth.alike.is_empty(),
        Match::None => false,
    };
    if matches.iter().zip(&label.hidden).all(as_can_be) {
        Judgement::Right
    } else if needs_class {
        Judgement::Part
    } else {
        Judgement::Class
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Match {
    None,
    /// The effect is a member of a reported class.
    Class,
    Named,
}

fn match_effect(found: &Value, truth: &Truth) -> Match {
    let same = |entry: &Value| {
        read_text(entry, "effect") == truth.effect && read_text(entry, "on") == truth.hidden.on
    };
    let equivalent = found["equivalent"].as_array().into_iter().flatten();
    let class = read_text(found, "status") == "class";
    if class && (same(found) || equivalent.into_iter().any(same)) {
        Match::Class
    } else if !class && same(found) {
        Match::Named
    } else {
        Match::None
    }
}

fn is_empirical(found: &Value) -> bool {
    read_text(found, "status") == "empirical"
}

/// Returns the number of effects in a class; `None` for a named effect.
fn read_class_size(found: &Value) -> Option<usize> {
    let others = found["equivalent"].as_array()?.len();
    (read_text(found, "status") == "class").then_some(1 + others)
}

/// Returns the ordinary error of a sensor whose fault is hidden, which adds to the fault.
fn compute_ordinary_error(label: &Label, truth: &Truth) -> f64 {
    let of = match truth.hidden.effect {
        Effect::SensorBias => &label.sensors.bias,
        Effect::SensorGain => &label.sensors.gain,
        Effect::SensorDelay => &label.sensors.delay,
        _ => return 0.0,
    };
    let channels = label.machine.setup().channels;
    let place = (channels.iter()).position(|channel| channel.name == truth.hidden.on);
    place.map_or(0.0, |place| of[place])
}

/// Checks signs and intervals of the parameters of a correct effect, sorted by name. `usual`:
/// ordinary error in addition to the hidden effect.
fn check_parameters(truth: &Truth, usual: f64, found: &Value, judged: &mut CaseScore) {
    let Some(parameters) = found["parameters"].as_object() else {
        return;
    };
    if parameters.len() != truth.parameters.len() {
        return;
    }
    for (entry, expected) in parameters.values().zip(&truth.parameters) {
        let expected = expected + usual;
        let (Some(value), Some(sd)) = (entry["value"].as_f64(), entry["sd"].as_f64()) else {
            continue;
        };
        // The sign is not checked for a small value, because a small cosine or sine can have the
        // wrong sign by chance.
        let clear = expected.abs() > HALF_WIDTH_90 * 2.0 * sd;
        judged.wrong_signs += usize::from(clear && value * expected < 0.0);
        judged.intervals.0 += usize::from((value - expected).abs() <= HALF_WIDTH_90 * sd);
        judged.intervals.1 += 1;
    }
}

/// Counts the intervals of the declared parameters that contain the true value, and all intervals.
/// They count only if all hidden effects were found.
fn count_refitted(label: &Label, discovery: &Value) -> (usize, usize) {
    let mut counts = (0, 0);
    let shifted = |name: &str| {
        let of = |t: &Truth| t.hidden.effect == Effect::ParameterShift && t.hidden.on == name;
        label.hidden.iter().any(of)
    };
    for (name, factor) in &label.declared {
        let entry = &discovery["refitted"][name];
        let nominal = find_nominal_value(label, name);
        let (Some(value), Some(sd), Some(nominal)) =
            (entry["value"].as_f64(), entry["sd"].as_f64(), nominal)
        else {
            continue;
        };
        if !shifted(name) && label.hidden.is_empty() {
            counts.0 += usize::from((value - factor * nominal).abs() <= HALF_WIDTH_90 * sd);
            counts.1 += 1;
        }
    }
    counts
}

fn find_nominal_value(label: &Label, name: &str) -> Option<f64> {
    use crate::machines::Machine;
    match (label.machine.nominal(), name) {
        (Machine::Arm(arm), "b_m") => Some(arm.b_m),
        (Machine::Stage(stage), "M") => Some(stage.mass),
        (Machine::Stage(stage), "F_v") => Some(stage.viscous),
        (Machine::Pendulum(pendulum), "k") => Some(pendulum.viscous),
        (Machine::Pendulum(pendulum), "I") => Some(pendulum.inertia),
        (Machine::TwoBodies(mut bodies), _) => bodies.parameter(name).copied(),
        _ => None,
    }
}

fn read_text(value: &Value, key: &str) -> String {
    value[key].as_str().unwrap_or_default().to_owned()
}
