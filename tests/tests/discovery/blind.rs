//! Test of a small fixed part of the blind suite: cases are generated, run and scored. The assertions concern errors
//! that discovery must never make. The full suite measures the success rate.

use std::path::Path;
use std::time::Duration;

use eomgen_blind::plan::{Case, Group, plan};
use eomgen_blind::records::{self, Label};
use eomgen_blind::run::{Ending, RunResult, run};
use eomgen_blind::score::{self, Judgement, Score};
use eomgen_tests::models::project;
use eomgen_tests::program;
use serde_json::{Value, json};

const SEED: u64 = 2026;

fn make_cases(cases: &[&Case], out: &Path) {
    let specifications = project().join("model-spec/models");
    for case in cases {
        records::make_case(case, SEED, &specifications, out).expect("the case is written");
    }
}

/// Returns the first cases with machines of one coordinate, because these run fast.
fn fast_cases(cases: &[Case]) -> Vec<&Case> {
    use eomgen_blind::machines::Kind;
    let of = |kind: Kind, group: Group, count: usize| {
        let fits = move |case: &&Case| case.machine == kind && case.group == group;
        cases.iter().filter(fits).take(count)
    };
    of(Kind::Stage, Group::Nothing, 2)
        .chain(of(Kind::Stage, Group::Single, 2))
        .chain(of(Kind::Pendulum, Group::Single, 2))
        .collect()
}

#[test]
fn fixed_part_of_blind_suite_is_generated_run_and_scored() {
    let folder = tempfile::tempdir().expect("a folder");
    let cases = plan(SEED);
    let chosen = fast_cases(&cases);
    assert_eq!(chosen.len(), 6);
    make_cases(&chosen, folder.path());
    for case in &chosen {
        let limit = Duration::from_secs(60);
        run(program::path(), folder.path(), case.number, limit).expect("the program is run");
    }
    let numbers: Vec<usize> = chosen.iter().map(|case| case.number).collect();
    let score = score::score(folder.path(), &numbers).expect("labels and results");
    println!("{}", score::table(&score));
    assert_eq!(score.without_answer, (0, 0), "{score:#?}");
    assert_eq!(score.false_alarms, (0, 2), "{score:#?}");
    assert_eq!(score.wrong_signs, 0, "{score:#?}");
}

#[test]
fn finished_case_is_not_run_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let result = folder.path().join("results/007.json");
    records::write_whole(&result, "kept").expect("a file");
    let nowhere = Path::new("/nowhere/at/all");
    run(nowhere, folder.path(), 7, Duration::from_secs(1)).expect("the case is skipped");
    assert_eq!(std::fs::read_to_string(&result).expect("a file"), "kept");
    assert!(run(nowhere, folder.path(), 8, Duration::from_secs(1)).is_err());
}

#[test]
fn same_seed_gives_same_cases() {
    let cases = plan(SEED);
    let chosen = [fast_cases(&cases)[2]];
    let folders = [(), ()].map(|()| tempfile::tempdir().expect("a folder"));
    for folder in &folders {
        make_cases(&chosen, folder.path());
    }
    for name in ["train0.csv", "dataset.toml", "spec.toml"] {
        let place = format!("cases/{:03}/{name}", chosen[0].number);
        let [one, other] = [&folders[0], &folders[1]]
            .map(|folder| std::fs::read(folder.path().join(&place)).expect("a file"));
        assert!(one == other && !one.is_empty(), "{place}");
    }
}

/// Returns the label (true answer) of a case with these effects; each has one parameter with the true value 2.
fn label(group: Group, effects: &[&str]) -> Label {
    let truth = |effect: &&str| {
        json!({
            "hidden": {"effect": effect, "on": "q", "order": 0.0, "sign": 1.0, "phase": 0.0, "amount": 2.0},
            "effect": effect, "parameters": [2.0], "floors": 5.0, "alike": [],
        })
    };
    let label = json!({
        "case": 1, "group": group, "machine": "stage", "full_priors": false,
        "declared": [["M", 1.01]],
        "hidden": effects.iter().map(truth).collect::<Vec<Value>>(),
        "sensors": {"gain": [0.0], "bias": [0.0], "delay": [0.0]},
    });
    serde_json::from_value(label).expect("a label")
}

/// Returns an answer with these effects; each has an estimated value and optionally an equivalent.
fn answer(verdict: &str, effects: &[(&str, f64, Option<&str>)]) -> RunResult {
    let effect = |(name, value, other): &(&str, f64, Option<&str>)| {
        json!({
            "effect": name, "on": "q",
            "status": if other.is_some() { "class" } else { "named" },
            "equivalent": other.iter().map(|o| json!({"effect": o, "on": "q"})).collect::<Vec<_>>(),
            "parameters": {"p": {"value": value, "sd": 0.1, "unit": "N"}},
        })
    };
    RunResult {
        case: 1,
        ending: Ending::Answered,
        seconds: 1.5,
        said: String::new(),
        discovery: Some(json!({
            "verdict": verdict,
            "effects": effects.iter().map(effect).collect::<Vec<_>>(),
            "refitted": {"M": {"value": 95.9, "sd": 0.1}},
            "closure": {"train": 0.9, "test": 0.85},
        })),
    }
}

#[test]
fn answers_are_judged_correctly() {
    use Group::{Nothing, Outside, Pair, Single, Untellable};
    let (coulomb, offset) = ("coulomb_friction", "force_offset");
    let found = "effects_found";
    let named = |name| (name, 2.05, None);
    let class = |name, other| (name, 2.05, Some(other));
    for (group, hidden, verdict, effects, expected) in [
        (
            Nothing,
            vec![],
            "no_significant_gap",
            vec![],
            Judgement::Right,
        ),
        (Nothing, vec![], "unexplained", vec![], Judgement::Right),
        (
            Nothing,
            vec![],
            found,
            vec![named(coulomb)],
            Judgement::Wrong,
        ),
        (
            Single,
            vec![coulomb],
            found,
            vec![named(coulomb)],
            Judgement::Right,
        ),
        (
            Single,
            vec![coulomb],
            found,
            vec![named(offset), named(coulomb)],
            Judgement::Wrong,
        ),
        (
            Single,
            vec![coulomb],
            found,
            vec![class(offset, coulomb)],
            Judgement::Class,
        ),
        (
            Single,
            vec![coulomb],
            "no_significant_gap",
            vec![],
            Judgement::Missed,
        ),
        (
            Single,
            vec![coulomb],
            "unexplained",
            vec![],
            Judgement::Unexplained,
        ),
        (
            Pair,
            vec![coulomb, offset],
            found,
            vec![named(offset), named(coulomb)],
            Judgement::Right,
        ),
        (
            Pair,
            vec![coulomb, offset],
            found,
            vec![named(offset)],
            Judgement::Part,
        ),
        (
            Untellable,
            vec![coulomb],
            found,
            vec![class(coulomb, offset)],
            Judgement::Right,
        ),
        (
            Untellable,
            vec![coulomb],
            found,
            vec![named(coulomb)],
            Judgement::Part,
        ),
        (
            Outside,
            vec!["worn_friction"],
            "unexplained",
            vec![],
            Judgement::Right,
        ),
        (
            Outside,
            vec!["worn_friction"],
            found,
            vec![named(coulomb)],
            Judgement::Wrong,
        ),
    ] {
        let judged = score::judge(&label(group, &hidden), &answer(verdict, &effects));
        assert_eq!(
            judged.judgement, expected,
            "{group:?} {hidden:?} {effects:?}"
        );
    }
    let mut late = answer(found, &[named(coulomb)]);
    late.ending = Ending::Timeout;
    let judged = score::judge(&label(Single, &[coulomb]), &late);
    assert_eq!(judged.judgement, Judgement::Timeout);
}

#[test]
fn scores_are_summed_correctly() {
    let single = |value: f64| {
        let answer = answer("effects_found", &[("coulomb_friction", value, None)]);
        score::judge(&label(Group::Single, &["coulomb_friction"]), &answer)
    };
    let nothing = score::judge(
        &label(Group::Nothing, &[]),
        &answer("no_significant_gap", &[]),
    );
    let alarm = answer("effects_found", &[("force_offset", 1.0, None)]);
    let alarm = score::judge(&label(Group::Nothing, &[]), &alarm);
    // The standard deviation is 0.1. The interval of +- 1.645 standard deviations about 2.16 contains 2; the interval
    // about 2.17 does not.
    let cases = vec![single(2.16), single(2.17), single(-2.0), nothing, alarm];
    let score: Score = score::sum_judgements(cases);
    assert_eq!(score.named, (3, 3));
    assert_eq!(score.false_alarms, (1, 2));
    assert_eq!(score.intervals, (1, 3));
    assert_eq!(score.wrong_signs, 1);
    // The true M is 1.01 times 95 kg: 95.95. The answer is 95.9.
    assert_eq!(score.refitted, (2, 2));
    assert_eq!(
        (score.single_closure.reached, score.single_closure.of),
        (3, 3)
    );
    assert!((score.seconds.0 - 7.5).abs() < 1e-12);
    assert!(score::table(&score).contains("false alarms"));
}

#[test]
fn correct_answers_and_class_sizes_are_counted() {
    use Group::{Nothing, Outside, Single};
    let (coulomb, offset) = ("coulomb_friction", "force_offset");
    let judged = |group, hidden: &[&str], effects: &[(&str, f64, Option<&str>)]| {
        score::judge(&label(group, hidden), &answer("effects_found", effects))
    };
    let mut nameless = answer("effects_found", &[("empirical", 1.0, None)]);
    let discovery = nameless.discovery.as_mut().expect("an answer");
    discovery["effects"][0]["status"] = json!("empirical");
    let mut late = answer("effects_found", &[(coulomb, 2.0, None)]);
    late.ending = Ending::Timeout;
    for (judged, is_true, classes) in [
        (
            judged(Single, &[coulomb], &[(coulomb, 2.0, None)]),
            true,
            vec![],
        ),
        (
            judged(Single, &[coulomb], &[(coulomb, 2.0, Some(offset))]),
            true,
            vec![2],
        ),
        (judged(Single, &[coulomb], &[]), true, vec![]),
        (judged(Nothing, &[], &[]), true, vec![]),
        // Wrong answers: another effect, the opposite sign, an additional effect, a class without the effect.
        (
            judged(Single, &[coulomb], &[(offset, 2.0, None)]),
            false,
            vec![],
        ),
        (
            judged(Single, &[coulomb], &[(coulomb, -2.0, None)]),
            false,
            vec![],
        ),
        (
            judged(
                Single,
                &[coulomb],
                &[(coulomb, 2.0, None), (offset, 2.0, None)],
            ),
            false,
            vec![],
        ),
        (
            judged(Single, &[coulomb], &[(offset, 2.0, Some("gravity"))]),
            false,
            vec![2],
        ),
        (judged(Nothing, &[], &[(offset, 1.0, None)]), false, vec![]),
        (
            score::judge(&label(Outside, &["worn_friction"]), &nameless),
            true,
            vec![],
        ),
        (
            score::judge(&label(Single, &[coulomb]), &nameless),
            false,
            vec![],
        ),
        (
            score::judge(&label(Single, &[coulomb]), &late),
            false,
            vec![],
        ),
    ] {
        assert_eq!(judged.has_no_false_effect(), is_true, "{judged:#?}");
        assert_eq!(judged.classes, classes, "{judged:#?}");
    }
}

#[test]
fn faulty_sensor_is_judged_including_its_ordinary_error() {
    let truth = json!({
        "hidden": {"effect": "sensor_gain", "on": "q", "order": 0.0, "sign": 1.0, "phase": 0.0, "amount": 0.05},
        "effect": "sensor_gain", "parameters": [1.05], "floors": 5.0, "alike": [],
    });
    let mut faulty = label(Group::Single, &[]);
    faulty.hidden = serde_json::from_value(json!([truth])).expect("a truth");
    faulty.sensors.gain = vec![0.01];
    // With a standard deviation of 0.1, the 90 % interval contains 1.06 for estimates up to 1.2245, and 1.05 only for
    // estimates up to 1.2145.
    let found = answer("effects_found", &[("sensor_gain", 1.22, None)]);
    assert_eq!(score::judge(&faulty, &found).intervals, (1, 1));
}

#[test]
fn closure_is_counted_with_a_gap_or_without_an_answer() {
    let answered = |closure: Value| {
        let mut answer = answer("effects_found", &[("coulomb_friction", 2.0, None)]);
        let discovery = answer.discovery.as_mut().expect("an answer");
        discovery["closure"]["test"] = closure;
        answer
    };
    let late = RunResult {
        ending: Ending::Timeout,
        discovery: None,
        ..answered(Value::Null)
    };
    let unexplained = {
        let mut answer = answer("unexplained", &[]);
        let discovery = answer.discovery.as_mut().expect("an answer");
        discovery["closure"]["test"] = json!(0.0);
        answer
    };
    for (group, hidden) in [
        (Group::Single, vec!["coulomb_friction"]),
        (Group::Pair, vec!["coulomb_friction", "force_offset"]),
    ] {
        let outcomes = [
            answered(json!(0.9)),
            answered(Value::Null),
            late.clone(),
            unexplained.clone(),
        ];
        let judged = |outcome: &RunResult| score::judge(&label(group, &hidden), outcome);
        let score = score::sum_judgements(outcomes.iter().map(judged).collect());
        let closure = match group {
            Group::Single => score.single_closure,
            _ => score.pair_closure,
        };
        assert!((closure.mean - 0.3).abs() < 1e-12, "{closure:?}");
        let counts = (closure.reached, closure.of, closure.without_gap);
        assert_eq!(counts, (1, 3, 1));
        assert!(score::table(&score).contains("1 of 3 reach"));
        assert!(score::table(&score).contains("1 had no gap to close"));
    }
}
