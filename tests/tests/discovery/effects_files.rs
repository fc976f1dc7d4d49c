//! Tests of files with user-defined effects. Valid effects are tested as candidates; invalid files are rejected with
//! location and suggestion.

use eomgen_tests::measured::{Measured, Moment};
use eomgen_tests::program;
use serde_json::Value;

/// User-defined effect: dry friction proportional to the distance from the centre.
const EFFECTS: &str = r#"[[effect]]
name = "bent_rail"
site = "axis"
says = "a friction that grows away from the middle"
experiment = "slow motion over the whole range"
parameters = [{ name = "B_r", unit = "{force}/{unit}", sign = "+", doc = "bent rail" }]
edits = [{ add = "force", name = "rail", on = "{on}", value = "-{B_r}*abs({on})*sign(dot({on}))" }]
"#;

fn arguments(measured: &Measured, effects: &str, out: &str) -> Vec<String> {
    measured.write("effects.toml", effects.as_bytes());
    let mut arguments = measured.arguments("discover", out);
    let path = measured.file("effects.toml").display().to_string();
    arguments.extend(["--effects".to_owned(), path]);
    arguments
}

/// Returns the location of `part` in a file of effects, as messages print it.
fn location(effects: &str, part: &str) -> String {
    let lines = effects.lines().enumerate();
    let mut places = lines.filter_map(|(line, text)| Some((line, text.find(part)?)));
    let (line, column) = places.next().expect("the file contains the part");
    format!("effects.toml:{}:{}", line + 1, column + 1)
}

/// Asserts that each changed file is rejected with the location of the given part and with the given words.
fn assert_rejects(measured: &Measured, cases: &[(&str, &str, &str, &str)]) {
    for (from, to, part, words) in cases {
        let effects = EFFECTS.replacen(from, to, 1);
        assert_ne!(effects, EFFECTS, "{from}");
        let message = rejection(measured, &effects);
        let place = location(&effects, part);
        assert!(message.contains(&place), "{to}: {place}: {message}");
        assert!(message.contains(words), "{to}: {words}: {message}");
    }
}

/// Returns the message of a rejected file of effects; asserts that nothing is written.
fn rejection(measured: &Measured, effects: &str) -> String {
    let arguments = arguments(measured, effects, "refused");
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let message = program::run_rejected(&arguments);
    assert!(!measured.file("refused").exists(), "{message}");
    message
}

fn discover(measured: &Measured, effects: &str) -> (Value, String) {
    let arguments = arguments(measured, effects, "found");
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let output = program::run(&arguments);
    let message = program::text(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{message}");
    let text = measured.read("found/discovery.json");
    (serde_json::from_str(&text).expect("JSON"), message)
}

#[test]
fn user_defined_effect_is_found_with_its_name() {
    let hidden = |at: Moment| -60.0 * at.q.abs() * (at.v / 1e-4).tanh();
    let measured = Measured::stage_with_force(&hidden);
    let (result, message) = discover(&measured, EFFECTS);
    let effects = result["effects"].as_array().expect("a list");
    assert_eq!(effects.len(), 1, "{message}{effects:#?}");
    assert_eq!(effects[0]["effect"], "bent_rail");
    assert_eq!(effects[0]["on"], "q");
    let size = effects[0]["parameters"]["B_r"]["value"].as_f64();
    assert!(
        size.is_some_and(|size| (size - 60.0).abs() < 3.0),
        "{size:?}"
    );
}

#[test]
fn unknown_words_and_keys_are_rejected_with_suggestion() {
    let sign = "sign = \"+\"";
    assert_rejects(
        &Measured::stage(0.0),
        &[
            (
                "\"force\"",
                "\"froce\"",
                "\"froce\"",
                "did you mean `force`?",
            ),
            (
                sign,
                "sign = \"positive\"",
                "\"positive\"",
                "expected \"+\" or \"\"",
            ),
            ("\"axis\"", "\"axes\"", "\"axes\"", "did you mean `axis`?"),
            (
                "[[effect]]",
                "[[effects]]",
                "effects",
                "did you mean `effect`?",
            ),
            ("site =", "sites =", "sites", "did you mean `site`?"),
            ("add =", "ad =", "ad =", "did you mean `add`?"),
            (
                "on = \"{on}\"",
                "onto = \"{on}\"",
                "onto",
                "did you mean `on`?",
            ),
            (
                "experiment =",
                "orders = \"yes\"\nexperiment =",
                "\"yes\"",
                "is not a truth value",
            ),
            (
                "add = \"force\"",
                "substitute = \"mesured\"",
                "\"mesured\"",
                "did you mean `measured`?",
            ),
            (
                "add = \"force\"",
                "substitute = \"mesh\"",
                "\"mesh\"",
                "expected site = \"mesh\"",
            ),
            (
                sign,
                "sign = \"+\", scale = \"rates\", share = 0.1",
                "\"rates\"",
                "did you mean `rate`?",
            ),
            (
                sign,
                "sign = \"+\", scale = \"rate\"",
                "scale",
                "`scale` and `share` must be given together",
            ),
            (
                sign,
                "sign = \"+\", scale = \"rate\", share = 0.0",
                "0.0",
                "expected a number above 0",
            ),
            (
                sign,
                "sign = \"+\", inverse = \"no\"",
                "\"no\"",
                "is not a truth value",
            ),
        ],
    );
}

#[test]
fn invalid_placeholders_and_expressions_are_rejected_with_location() {
    assert_rejects(
        &Measured::stage(0.0),
        &[
            ("abs({on})", "abs({onn})", "onn", "did you mean `on`?"),
            ("-{B_r}", "-{B_s}", "B_s", "did you mean `B_r`?"),
            ("-{B_r}", "-2", "\"B_r\"", "`B_r` is not used"),
            ("abs({on})", "abs({on)", "on)*", "unknown placeholder"),
            (
                "abs({on})",
                "abs(on})",
                "})*",
                "the braces of a placeholder are not balanced",
            ),
            ("abs({on})*", "abs({on})*/", "/sign", "error"),
            ("\"B_r\"", "\"B r\"", "\"B r\"", "is not a name"),
            (
                "\"B_r\"",
                "\"unit\"",
                "\"unit\"",
                "is a placeholder of this site",
            ),
            ("edits = [{", "edits = [] #", "[] #", "`edits` is empty"),
            (
                "says = \"a friction that grows away from the middle\"\n",
                "",
                "[[effect]]",
                "has no `says`",
            ),
        ],
    );
}

#[test]
fn damper_can_only_be_substituted_at_springs() {
    let on_springs = EFFECTS.replace("\"axis\"", "\"spring\"");
    let on_axes = EFFECTS.replace(
        "{ add = \"force\", name = \"rail\", on = \"{on}\", ",
        "{ substitute = \"damper\", find = \"{damper}\", replace = \"{damper}*{B_r}\" }, { add = \"force\", name = \"rail\", on = \"{on}\", ",
    );
    let measured = Measured::stage(0.0);
    for (effects, words) in [
        (on_axes, "expected site = \"spring\""),
        (
            on_springs.replace("-{B_r}*", "-{B_r}*{damper}*"),
            "unknown placeholder `damper`",
        ),
        (
            on_springs.replace("B_r", "damper"),
            "`damper` is a placeholder of this site",
        ),
    ] {
        let message = rejection(&measured, &effects);
        assert!(message.contains(words), "{words}: {message}");
    }
}

#[test]
fn inputs_are_substituted_at_inputs_and_loads_at_axes() {
    let measured = Measured::stage(0.0);
    let added = "{ add = \"force\", name = \"rail\", on = \"{on}\", ";
    let replaced = "{ substitute = \"input\", find = \"{on}\", replace = \"{on}*{B_r}\" }, ";
    for (effects, words) in [
        (
            EFFECTS.replace(added, &format!("{replaced}{added}")),
            "expected site = \"input\"",
        ),
        (
            EFFECTS
                .replace("\"axis\"", "\"spring\"")
                .replace("experiment =", "loads = true\nexperiment ="),
            "expected site = \"axis\" or site = \"angle\"",
        ),
        (
            EFFECTS.replace("-{B_r}*", "-{B_r}*{load}*"),
            "unknown placeholder `load`",
        ),
        (
            EFFECTS.replace(
                added,
                &format!("{{ add = \"state\", name = \"z\" }}, {added}"),
            ),
            "has no `unit`",
        ),
    ] {
        let message = rejection(&measured, &effects);
        assert!(message.contains(words), "{words}: {message}");
    }
}

#[test]
fn invalid_effects_files_are_rejected() {
    let measured = Measured::stage(0.0);
    for (text, part) in [
        ("", "begin each effect with [[effect]]"),
        ("[[effect", "effects.toml:1:"),
        ("effect = 3", "effects.toml:1:10"),
        ("effect = [3]", "effects.toml:1:11"),
        ("effect = [{}]", "has no `name`"),
    ] {
        let message = rejection(&measured, text);
        assert!(message.contains(part), "{text}: {message}");
    }
    measured.write("effects.toml", &[0xff, 0xfe, 0, 0]);
    let mut arguments = measured.arguments("discover", "refused");
    arguments.extend(["--effects".to_owned(), String::new()]);
    for path in [
        measured.file("effects.toml"),
        measured.file("none.toml"),
        measured.file("."),
    ] {
        let last = arguments.len() - 1;
        arguments[last] = path.display().to_string();
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        let message = program::run_rejected(&arguments);
        assert!(message.contains("cannot read"), "{message}");
    }
}

#[test]
fn effect_that_makes_specification_invalid_is_rejected() {
    let measured = Measured::stage(0.0);
    for (from, to, part) in [
        ("unit = \"{force}/{unit}\"", "unit = \"kg\"", "bent_rail"),
        ("abs({on})", "abs(no_such)", "no_such"),
    ] {
        let message = rejection(&measured, &EFFECTS.replacen(from, to, 1));
        let parts = [
            "the effect `bent_rail` on `q` makes the specification invalid",
            part,
        ];
        for part in parts {
            assert!(message.contains(part), "{to}: {message}");
        }
    }
}

#[test]
fn effect_without_site_is_reported_as_untested() {
    let measured = Measured::stage(0.0);
    let (result, message) = discover(&measured, &EFFECTS.replacen("axis", "angle", 1));
    let note = "the effect `bent_rail` has no site in this model and is not tested";
    assert!(message.contains(note), "{message}");
    assert!(result["notes"].to_string().contains(note), "{result:#}");
}

#[test]
fn effects_with_the_same_name_are_all_tested() {
    let hidden = |at: Moment| -60.0 * at.q.abs() * (at.v / 1e-4).tanh();
    let measured = Measured::stage_with_force(&hidden);
    let other = EFFECTS
        .replacen("abs({on})*", "", 1)
        .replacen("/{unit}", "", 1);
    let (result, message) = discover(&measured, &format!("{EFFECTS}{other}"));
    assert_eq!(result["effects"][0]["effect"], "bent_rail", "{message}");
    let term = result["effects"][0]["term"].as_str();
    assert!(term.is_some_and(|term| term.contains("abs(q)")), "{term:?}");
}
