//! JSON documents `comparison.json` and `discovery.json`.

use std::collections::BTreeMap;

use serde_json::{Map, Value, json};

use crate::experiment::next_experiment::{ClassMember, ExperimentFile, MemberPair, NextExperiment};
use crate::free_function::curves::Curve;
use crate::report::experiment::describe_experiment;
use crate::report::result::{
    ChannelGap, CommonResult, Comparison, ConditionalSize, Discovery, EffectSite, EstimateWithUnit,
    FoundEffect, RejectedEffect, SensorEstimate, TrainTest,
};
use crate::report::summary::{Summary, describe_conditional};

/// Schema version of both documents.
const SCHEMA: u32 = 2;

impl Comparison {
    /// Returns the name of the verdict in the document.
    pub fn verdict_name(&self) -> &'static str {
        match self.has_gap {
            true => "gap_found",
            false => "no_significant_gap",
        }
    }

    /// Returns the document `comparison.json`.
    pub fn to_json(&self) -> Value {
        let gap = |gap: &ChannelGap| {
            json!({
                "unit": gap.unit,
                "floor": gap.floor,
                "train": gap.before.train,
                "test": gap.before.test,
            })
        };
        let mut document = write_common(&self.compared, gap);
        document["verdict"] = json!(self.verdict_name());
        document["summary"] = json!(Summary::from_comparison(self).to_text());
        document
    }
}

impl Discovery {
    /// Returns the document `discovery.json`.
    pub fn to_json(&self) -> Value {
        let gap = |gap: &ChannelGap| {
            json!({
                "unit": gap.unit,
                "floor": gap.floor,
                "before": write_train_test(gap.before),
                "after": gap.after.map(write_train_test),
            })
        };
        let mut document = write_common(&self.compared, gap);
        let effects: Vec<Value> = (self.effects.iter())
            .map(|of| write_effect(of, &self.experiments))
            .collect();
        let rejected = self.rejected.iter().map(|r| write_rejected(r, None));
        let not_testable = self.untestable.iter();
        let not_testable = not_testable.map(|r| write_rejected(r, Some(&self.experiments)));
        document["verdict"] = json!(self.verdict.name());
        document["summary"] = json!(Summary::from_discovery(self).to_text());
        document["effects"] = json!(effects);
        document["rejected"] = Value::Array(rejected.collect());
        document["not_testable"] = Value::Array(not_testable.collect());
        document["closure"] = json!({"train": self.closure.train, "test": self.closure.test});
        document["steps"] = self.write_steps();
        document["validation"] = self.write_validation();
        document["curve"] = self.curve.as_ref().map_or(Value::Null, write_curve);
        document["unfinished"] = json!(self.unfinished);
        document
    }

    /// Returns the RMS residual of the test records after each step, in standard deviations of the
    /// noise.
    fn write_steps(&self) -> Value {
        let step = |step: &crate::report::result::SearchStep| json!({"added": step.added, "test_rms_over_noise": step.test_rms});
        let mut steps: Vec<Value> = self.steps.iter().map(step).collect();
        if let Some(last) = steps.last_mut() {
            last["validated"] = json!(self.validation.as_ref().map(|found| found.has_passed));
        }
        Value::Array(steps)
    }

    fn write_validation(&self) -> Value {
        let found = |found: &crate::report::result::Validation| {
            json!({
                "passed": found.has_passed,
                "checks": found.checks,
                "failed": found.failed,
                "train_rms_over_noise": self.resimulation.train,
                "test_rms_over_noise": self.resimulation.test,
            })
        };
        self.validation.as_ref().map_or(Value::Null, found)
    }
}

/// Writes a free function, SI.
fn write_curve(curve: &Curve) -> Value {
    json!({
        "equation": curve.equation,
        "unit": curve.unit,
        "variable": curve.variable,
        "variable_unit": curve.variable_unit,
        "knots": curve.knots,
        "values": curve.values,
        "band": curve.band,
    })
}

/// Returns the fields that both documents have.
fn write_common(compared: &CommonResult, gap: impl Fn(&ChannelGap) -> Value) -> Value {
    let gaps = compared
        .gap
        .iter()
        .map(|(name, of)| (name.clone(), gap(of)));
    json!({
        "schema": SCHEMA,
        "gap": gaps.collect::<Map<String, Value>>(),
        "refitted": estimates_to_json(&compared.refitted),
        "sensors": sensors_to_json(&compared.sensors),
        "where": compared.location,
        "notes": compared.notes,
    })
}

fn write_train_test(both: TrainTest<f64>) -> Value {
    json!({"train": both.train, "test": both.test})
}

/// Returns estimates as an object with their names as keys.
pub(crate) fn estimates_to_json(of: &BTreeMap<String, EstimateWithUnit>) -> Value {
    let entry = |of: &EstimateWithUnit| json!({"value": of.value, "sd": of.sd, "unit": of.unit});
    let entries = of.iter().map(|(name, of)| (name.clone(), entry(of)));
    Value::Object(entries.collect())
}

/// Returns sensors as an object with the names of their channels as keys.
pub(crate) fn sensors_to_json(of: &BTreeMap<String, SensorEstimate>) -> Value {
    let entry = |of: &SensorEstimate| json!({"bias": of.bias, "gain": of.gain, "delay": of.delay});
    let entries = of.iter().map(|(name, of)| (name.clone(), entry(of)));
    Value::Object(entries.collect())
}

fn write_site(of: &EffectSite) -> Value {
    let mut entry = json!({"effect": of.effect, "on": of.site});
    if let Some(order) = &of.order {
        entry["order"] = json!({"angle": order.angle, "order": order.order});
    }
    entry
}

/// Returns a rejected effect. `files`: experiments for effects that the records cannot show.
fn write_rejected(of: &RejectedEffect, files: Option<&[ExperimentFile]>) -> Value {
    let mut entry = write_site(&of.at);
    entry["reason"] = match &of.best_of_round {
        Some(best) => json!(format!(
            "{} (best of the same round: {}, {})",
            of.reason, best.label, best.reduction
        )),
        None => json!(of.reason),
    };
    entry["p_value"] = json!(of.p_values.map(|(own, _)| own));
    entry["p_value_adjusted"] = json!(of.p_values.map(|(_, all)| all));
    let Some(files) = files else { return entry };
    entry["experiment"] = json!(of.experiment);
    if let Some(next) = &of.next_experiment {
        entry["next_experiment"] = write_next_experiment(next, files);
    }
    entry
}

fn write_conditional(of: &ConditionalSize) -> Value {
    let size = BTreeMap::from([(of.parameter.clone(), of.size.clone())]);
    let mut entry = write_site(&of.with);
    entry["in_place_of"] = write_site(&of.in_place_of);
    entry["parameters"] = estimates_to_json(&size);
    entry["text"] = json!(describe_conditional(of));
    entry
}

fn write_effect(of: &FoundEffect, files: &[ExperimentFile]) -> Value {
    let mut entry = write_site(&of.at);
    entry["status"] = json!(of.status.name());
    let equivalent = of.equivalents.iter().map(|other| {
        let mut entry = write_site(&other.at);
        entry["parameters"] = estimates_to_json(&other.parameters);
        entry
    });
    entry["equivalent"] = equivalent.collect();
    entry["parameters"] = estimates_to_json(&of.parameters);
    if !of.conditional.is_empty() {
        entry["conditional"] = of.conditional.iter().map(write_conditional).collect();
    }
    entry["term"] = json!(of.term);
    entry["evidence"] = json!({
        "held_out_gap_reduction": of.statistics.held_out_reduction,
        "held_out_z_score": of.statistics.reduction_in_standard_errors,
        "log_likelihood_gain": of.statistics.information_gain,
        "t": of.statistics.t_value,
        "p_value": of.statistics.p_value,
        "p_value_adjusted": of.adjusted_p_value,
    });
    if let Some(load) = &of.load {
        entry["load"] = json!(load);
    }
    if let Some(experiment) = &of.experiment {
        entry["experiment"] = json!(experiment);
    }
    if let Some(next) = &of.next_experiment {
        entry["next_experiment"] = write_next_experiment(next, files);
    }
    entry
}

/// Returns a proposed experiment, for `next_experiment`.
fn write_next_experiment(next: &NextExperiment, files: &[ExperimentFile]) -> Value {
    let member = |of: &ClassMember| json!({"effect": of.effect, "on": of.site});
    let pair = |pair: &MemberPair| {
        json!({
            "simulated": member(&pair.truth),
            "alternative": member(&pair.rival),
            "separation": pair.separation,
            "channel": pair.channel,
        })
    };
    json!({
        "text": describe_experiment(next, files),
        "file": next.file.map(|file| &files[file].name),
        "input": next.input,
        "form": next.waveform,
        "separation": next.separation,
        "pairs": next.pairs.iter().map(pair).collect::<Vec<Value>>(),
        "smallest_detectable": next.detectable.as_ref().map(|shown| {
            json!({&shown.parameter: {"value": shown.smallest, "unit": shown.unit}})
        }),
        "excluded": next.failed_members.iter().map(member).collect::<Vec<Value>>(),
        "reason": next.reason,
        "bounds": next.bounds_source,
    })
}
