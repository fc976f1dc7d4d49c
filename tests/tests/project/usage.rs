//! Tests of invalid use of the program: exit status 2 and a message with the remedy.

use eomgen_tests::measured::Measured;
use eomgen_tests::models::path;
use eomgen_tests::program::{eomgen, run_accepted, run_rejected};

/// Commands that take a specification.
const COMMANDS: [&str; 9] = [
    "check",
    "derive",
    "generate",
    "validate",
    "simulate",
    "page",
    "linearise",
    "modes",
    "trim",
];

fn spec(name: &str) -> String {
    path(name).display().to_string()
}

/// Returns the arguments of a command for a specification, including the other required arguments.
fn arguments(command: &'static str, name: &str, more: &[&str]) -> Vec<String> {
    let needed: &[&str] = match command {
        "generate" => &["--out", "never-made"],
        "page" => &["--out", "never-made/a.html"],
        "simulate" => &["--out", "never-made/a.csv", "--until", "0.01"],
        _ => &[],
    };
    let given = needed
        .iter()
        .chain(more)
        .map(|argument| (*argument).to_owned());
    [command.to_owned(), spec(name)]
        .into_iter()
        .chain(given)
        .collect()
}

/// Runs a command that must be rejected without writing files; returns its message.
fn rejection(arguments: &[String]) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let mut command = eomgen();
    let output = command.args(arguments).current_dir(folder.path()).output();
    let output = output.expect("the program can be run");
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    let shown = arguments.join(" ");
    assert_eq!(output.status.code(), Some(2), "{shown}: {message}");
    assert!(message.starts_with("error: "), "{shown}: {message}");
    if arguments.iter().any(|argument| argument == "--json") {
        let document: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
        assert!(document["error"]["message"].is_string(), "{shown}");
    } else {
        assert!(output.stdout.is_empty(), "{shown}");
    }
    let left = std::fs::read_dir(folder.path())
        .expect("the folder")
        .count();
    assert_eq!(left, 0, "{shown} wrote files");
    message
}

fn assert_simulate_rejects(name: &str, options: &[&str], part: &str) {
    let found = rejection(&arguments("simulate", name, options));
    assert!(found.contains(part), "{options:?}: {found}");
}

/// Simulates the arm with options that cause an error before the solver starts (exit status 2) or stop the solver later
/// (1); returns the message.
fn stop_message(options: &[&str]) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let arguments = arguments("simulate", "planetary_arm", options);
    let output = eomgen().args(arguments).current_dir(folder.path()).output();
    let output = output.expect("the program can be run");
    assert!(matches!(output.status.code(), Some(1 | 2)), "{options:?}");
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn unknown_commands_and_options_are_rejected() {
    assert!(run_rejected(&["fly"]).contains("fly"));
    assert!(run_rejected(&["check", &spec("pendulum"), "--fly"]).contains("--fly"));
    assert!(run_rejected(&["derive", &spec("pendulum"), "--format", "word"]).contains("latex"));
    assert!(
        run_rejected(&["generate", &spec("pendulum"), "--target", "ada"]).contains("rust, c99")
    );
    let unknown = run_rejected(&["generate", &spec("pendulum"), "--with", "jacobian"]);
    assert!(unknown.contains("unknown output `jacobian`"), "{unknown}");
    assert!(
        unknown.contains("jacobians:parameters, products"),
        "{unknown}"
    );
    assert!(run_rejected(&["check"]).contains("<SPEC>"));
    assert!(run_rejected(&["generate", &spec("pendulum")]).contains("--out"));
    assert!(run_rejected(&["generate", "--all", &spec("pendulum")]).contains("--all"));
    assert!(run_rejected(&["simulate", &spec("pendulum"), "--out", "a.csv"]).contains("--until"));
}

#[test]
fn help_succeeds_and_has_an_example() {
    assert!(run_accepted(&["--help"]).contains("simulate"));
    assert!(run_accepted(&["--version"]).starts_with("eomgen "));
    for command in COMMANDS.into_iter().chain([
        "family",
        "verify",
        "identify",
        "instructions",
        "dataset",
        "sweep",
        "merge",
        "paper",
        "tour",
    ]) {
        let help = run_accepted(&[command, "--help"]);
        // The usage line contains the command too, so only the example is searched.
        let example = help.split_once("Example").map(|(_, example)| example);
        assert!(
            example.is_some_and(|example| example.contains(&format!("eomgen {command} "))),
            "{command}: {help}"
        );
    }
}

#[test]
fn earlier_names_work_but_are_not_listed() {
    let pendulum = spec("pendulum");
    let out = |arguments: &[&str]| run_accepted(arguments);
    for command in ["linearise", "modes"] {
        let current = out(&[command, &pendulum, "--json", "--state", "theta=pi"]);
        assert_eq!(
            out(&[command, &pendulum, "--json", "--at", "theta=pi"]),
            current
        );
        let trimmed = out(&[command, &pendulum, "--json", "--state", "trim"]);
        assert_eq!(
            out(&[command, &pendulum, "--json", "--at", "trim"]),
            trimmed
        );
    }
    let simulate = |state: &str, interval: &str| {
        let options = [
            "--until",
            "1",
            "--out",
            "-",
            state,
            "theta=0.2",
            interval,
            "0.25",
        ];
        out(&[&["simulate", &pendulum][..], &options].concat())
    };
    let current = simulate("--state", "--interval");
    assert_eq!(current.lines().count(), 6);
    assert_eq!(simulate("--initial", "--sample"), current);
    for (old, new) in [
        (&["study"][..], &["paper", "study"][..]),
        (&["study-search"], &["paper", "claims"]),
    ] {
        let help = |command: &[&str]| out(&[command, &["--help"]].concat());
        assert_eq!(help(old), help(new));
    }
    let listed = out(&["--help"]);
    assert!(listed.contains("  paper "), "{listed}");
    assert!(!listed.contains("  study"), "{listed}");
    let help = ["simulate", "linearise", "modes", "trim"].map(|command| out(&[command, "--help"]));
    let completions = ["bash", "zsh", "fish"].map(|shell| out(&["completions", shell]));
    for text in help.iter().chain(&completions) {
        assert!(text.contains("state"), "{text}");
        for old in ["--at ", "--at=", "--initial", "--sample ", "study-search"] {
            assert!(!text.contains(old), "{old}: {text}");
        }
    }
}

/// A motion that starts at the nearest equilibrium remains at it.
#[test]
fn simulate_starts_at_the_equilibrium_nearest_to_a_state() {
    let motion = run_accepted(&[
        "simulate",
        &spec("pendulum"),
        "--until",
        "1",
        "--state",
        "trim",
        "--state",
        "theta=3",
        "--interval",
        "0.5",
        "--out",
        "-",
    ]);
    let rows: Vec<&str> = motion.lines().skip(1).collect();
    assert_eq!(rows.len(), 3);
    for row in rows {
        let theta: f64 = row
            .split(',')
            .nth(1)
            .expect("theta")
            .parse()
            .expect("a number");
        assert!((theta - std::f64::consts::PI).abs() < 1e-6, "{motion}");
    }
}

#[test]
fn page_starts_at_given_parameters_and_state() {
    let pendulum = spec("pendulum");
    let page = |more: &[&str]| run_accepted(&[&["page", &pendulum, "--out", "-"], more].concat());
    assert!(!page(&[]).contains("\"initial\":0.7"));
    let given = page(&["--state", "theta=0.7", "--set", "a=0.375"]);
    assert!(given.contains("\"initial\":0.7"));
    assert!(given.contains("0.375"));
}

#[test]
fn generate_check_without_all_is_rejected() {
    for more in [
        &["--check"][..],
        &["--check", "--certify"],
        &["--check", "--target", "c99", "--json"],
    ] {
        let refusal = rejection(&arguments("generate", "pendulum", more));
        assert!(refusal.contains("generate --all --check"), "{refusal}");
    }
    run_rejected(&["generate", "--check"]);
    run_rejected(&["generate", "--all", "--check", "--target", "c99"]);
}

#[test]
fn proposed_dataset_file_is_complete_or_absent() {
    let measured = Measured::stage(0.0);
    let record = measured.file("train.csv").display().to_string();
    let out = measured.file("proposed.toml").display().to_string();
    run_accepted(&["dataset", &record, &spec("emps"), "--out", &out]);
    assert!(measured.read("proposed.toml").contains("[inputs.force]"));
    let printed = run_accepted(&["dataset", &record, &spec("emps")]);
    assert_eq!(printed, measured.read("proposed.toml"));
    let swapped = run_rejected(&["dataset", &spec("emps"), &record]);
    assert!(
        swapped.contains("give the record first and the specification second"),
        "{swapped}"
    );
    let json: serde_json::Value = serde_json::from_str(&run_accepted(&[
        "dataset",
        &record,
        &spec("emps"),
        "--json",
    ]))
    .expect("JSON");
    assert_eq!(json["dataset"], printed);
    let elsewhere = tempfile::tempdir().expect("a folder");
    let outside = elsewhere.path().join("a.toml");
    let text = outside.display().to_string();
    let found = run_rejected(&["dataset", &record, &spec("emps"), "--out", &text]);
    assert!(
        found.contains("in the folder of its records or above it"),
        "{found}"
    );
    assert!(!outside.exists());
    let found = run_rejected(&["dataset", &record, &spec("double_pendulum")]);
    assert!(found.contains("no column is an observable"), "{found}");
}

#[test]
fn invalid_orders_are_rejected_by_every_command() {
    for command in COMMANDS {
        for order in [
            "-1",
            "abc",
            "1e9",
            "4.0",
            "1 000",
            "99999999999999999999",
            "٣",
        ] {
            let found = rejection(&arguments(command, "planetary_arm", &["--order", order]));
            assert!(
                found.contains("whole number from 0 to 128"),
                "{command} {order}: {found}"
            );
        }
        let found = rejection(&arguments(command, "planetary_arm", &["--order", "129"]));
        assert!(
            found.contains("the highest order is 128"),
            "{command}: {found}"
        );
        let found = rejection(&arguments(command, "pendulum", &["--order", "4"]));
        assert!(found.contains("no field"), "{command}: {found}");
    }
}

#[test]
fn certificate_with_different_orders_is_rejected() {
    let folder = tempfile::tempdir().expect("a folder");
    let spec = folder.path().join("two_fields.toml");
    let two = include_str!("../../features/two_fields.toml").replacen("order = 3", "order = 1", 1);
    std::fs::write(&spec, two).expect("a file");
    let spec = spec.display().to_string();
    assert!(run_accepted(&["check", &spec]).contains("order 1, 3"));
    assert!(run_rejected(&["validate", &spec]).contains("give --order"));
    assert!(run_accepted(&["validate", &spec, "--order", "1"]).contains("passed"));
}

#[test]
fn invalid_parameter_assignments_are_rejected() {
    for (assignment, part) in [
        ("b_spp=1", "did you mean `b_sp`"),
        ("=1", "NAME=VALUE"),
        ("b_sp", "NAME=VALUE"),
        ("b_sp=", "NAME=VALUE"),
        ("b_sp=1=2", "--set:1:7"),
        ("b_sp=25 kg", "in m, not in kg"),
        ("b_sp=2*b_pp", "did you mean `b_pr`"),
        ("b_sp=nan", "finite"),
        ("b_sp=inf", "finite"),
        ("k_sp=1e400", "too large"),
        ("b_sp=-1e-6", "at least 0 m"),
        ("l=0", "greater than"),
        ("z_s=0", "division by 0"),
    ] {
        assert_simulate_rejects("planetary_arm", &["--set", assignment], part);
    }
}

#[test]
fn times_with_a_unit_are_accepted() {
    let folder = tempfile::tempdir().expect("a folder");
    for (until, interval) in [("0.5 s", "100 ms"), ("500ms", "0.1"), ("0.5", "0.1s")] {
        let out = folder.path().join("out.csv");
        let out = out.display().to_string();
        let printed = run_accepted(&[
            "simulate",
            &spec("pendulum"),
            "--until",
            until,
            "--interval",
            interval,
            "--out",
            &out,
        ]);
        assert!(printed.contains("6 rows"), "{until}: {printed}");
    }
}

#[test]
fn notations_of_other_programs_are_rejected_with_their_equivalent() {
    for state in ["dot(theta)=1", "theta'=1", "thetadot=1", "dtheta=1"] {
        assert_simulate_rejects("pendulum", &["--state", state], "write `theta_dot`");
    }
    for name in ["q.mat", "q.json"] {
        let found = run_rejected(&["simulate", &spec("pendulum"), "--until", "1", "--out", name]);
        assert!(found.contains(".csv or .parquet"), "{found}");
    }
    assert!(run_rejected(&["derive", &spec("pendulum"), "--latex"]).contains("--format latex"));
    let found = run_rejected(&["page", &spec("pendulum"), "--out", "never-made.svg"]);
    assert!(found.contains(".html"), "{found}");
    for target in ["matlab", "simulink"] {
        let found = run_rejected(&[
            "generate",
            &spec("emps"),
            "--target",
            target,
            "--out",
            "never",
        ]);
        assert!(found.contains("--target fmu3"), "{found}");
    }
}

#[test]
fn specification_in_place_of_a_family_file_is_one_error() {
    let found = run_rejected(&["family", &spec("pendulum"), "--out", "never-made"]);
    assert!(found.contains("is a specification"), "{found}");
    assert_eq!(found.matches("error").count(), 1, "{found}");
}

#[test]
fn dataset_in_place_of_a_specification_is_recognised() {
    let measured = eomgen_tests::models::project().join("examples/measured");
    let [stage, dataset] =
        ["stage.toml", "dataset.toml"].map(|name| measured.join(name).display().to_string());
    for command in [
        &["check", &dataset][..],
        &["compare", &dataset, &stage, "--out", "never"],
        &["discover", &dataset, &stage, "--out", "never"],
    ] {
        let found = run_rejected(command);
        assert!(found.contains("is a dataset file"), "{command:?}: {found}");
    }
}

/// All commands that compute accelerations reject a coordinate without inertia in the initial state, with its location.
/// The equations can still be derived.
#[test]
fn coordinates_without_inertia_are_rejected() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("spec.toml");
    let text = "[model]\nname = \"two\"\n[parameters]\nm = { value = 1, unit = \"kg\" }\n\
                [coordinates]\nx = { unit = \"m\" }\ny = { unit = \"m\" }\n\
                [kinetic]\nboth = \"1/2*m*(dot(x) + dot(y))^2\"\n";
    std::fs::write(&path, text).expect("a file");
    let spec = path.display().to_string();
    let out = folder.path().join("out.csv").display().to_string();
    for command in [
        &["check", &spec][..],
        &["generate", &spec, "--out", &out],
        &["validate", &spec],
        &["simulate", &spec, "--until", "1", "--out", &out],
    ] {
        let found = run_rejected(command);
        assert!(
            found.contains("`x`, `y` together have no inertia"),
            "{found}"
        );
        assert!(found.contains("spec.toml:6:1"), "{found}");
    }
    let record = eomgen()
        .args(["check", &spec, "--json"])
        .output()
        .expect("it can be run");
    let record: serde_json::Value = serde_json::from_slice(&record.stdout).expect("JSON");
    assert_eq!(record["diagnostics"][0]["line"], 6);
    assert!(run_accepted(&["derive", &spec]).contains("M[x, y] = m"));
}

#[test]
fn parameters_without_solution_are_rejected() {
    for assignment in ["rho=-7900", "rho=0", "I_p=-1", "l=1e300"] {
        assert_simulate_rejects("planetary_arm", &["--set", assignment], "positive definite");
    }
    for assignment in ["r_s=0", "m=0"] {
        assert_simulate_rejects("planetary_arm", &["--set", assignment], "division by 0");
    }
    // The values are so extreme that a rate overflows or no step size is small enough. The general solver stops after
    // its start.
    for assignment in ["l=1e-300", "omega=1e300", "k_sp=1e300", "alpha=90"] {
        let general = ["--solver", "rk", "--set", assignment];
        let found = stop_message(&general);
        assert!(found.contains("at t = "), "{assignment}: {found}");
    }
    let fast = ["--solver", "rk", "--set", "omega=1e300"];
    let found = stop_message(&fast);
    assert!(found.contains("`x_sp"), "{found}");
    for (assignment, part) in [
        ("l=1e-300", "a coefficient"),
        ("omega=1e300", "slower motion"),
        ("k_sp=1e300", "eigenvalues"),
        ("alpha=90", "slower motion"),
    ] {
        let exact = ["--solver", "exact", "--set", assignment];
        let found = stop_message(&exact);
        assert!(found.contains(part), "{assignment}: {found}");
    }
    // The general solver runs after the exact one has failed, and prints the reason why it stops.
    let found = stop_message(&["--set", "k_sp=1e300"]);
    assert!(
        found.starts_with("warning: solved with rk instead of the exact solver"),
        "{found}"
    );
    assert!(found.contains("at t = "), "{found}");
}

#[test]
fn invalid_times_are_rejected() {
    for (option, value, part) in [
        ("--until", "0", "after 0"),
        ("--until", "-1", "after 0"),
        ("--until", "nan", "after 0"),
        ("--until", "inf", "after 0"),
        ("--until", "1e-320", "after 0"),
        ("--until", "soon", "expected a number in s"),
        ("--until", "1 kg", "a time is in s, not in kg"),
        ("--interval", "0", "above 0"),
        ("--interval", "-1", "above 0"),
        ("--interval", "nan", "above 0"),
        ("--interval", "inf", "at most 0.01"),
        ("--interval", "0.02", "at most 0.01"),
        ("--interval", "1e-300", "too many rows"),
        ("--interval", "1e-10", "too many rows"),
        ("--tolerance", "0", "1e-14"),
        ("--tolerance", "-1", "1e-14"),
        ("--tolerance", "nan", "1e-14"),
        ("--tolerance", "1", "0.1"),
    ] {
        let mut given = arguments("simulate", "pendulum", &[]);
        given.retain(|argument| option != "--until" || !["--until", "0.01"].contains(&&**argument));
        given.extend([option.to_owned(), value.to_owned()]);
        let found = rejection(&given);
        assert!(found.contains(part), "{option} {value}: {found}");
    }
    // The argument of the sine in the motor's ripple leaves the supported range; the general solver detects this during
    // the run.
    let arm = spec("planetary_arm");
    for (solver, status, part) in [
        ("exact", 2, "shorten the time"),
        ("rk", 1, "the state diverged"),
    ] {
        let folder = tempfile::tempdir().expect("a folder");
        let far = ["--solver", solver, "--out", "a.csv", "--until", "1e300"];
        let mut program = eomgen();
        program.args(["simulate", &arm]).args(far);
        let output = program.current_dir(folder.path()).output();
        let output = output.expect("the program can be run");
        assert_eq!(output.status.code(), Some(status), "{solver}");
        let found = String::from_utf8_lossy(&output.stderr);
        assert!(found.contains(part), "{solver}: {found}");
    }
}

#[test]
fn exact_solver_rejects_nonlinear_models_and_ignores_tolerance() {
    let found = rejection(&arguments("simulate", "pendulum", &["--solver", "exact"]));
    assert!(
        found.contains("`") && found.contains("sin(theta)") && found.contains("--solver rk"),
        "{found}"
    );
    let folder = tempfile::tempdir().expect("a folder");
    let said = |solver: &str, name: &str, more: &[&str]| {
        let mut given = arguments("simulate", name, &["--json", "--solver", solver]);
        given.extend(more.iter().map(|argument| (*argument).to_owned()));
        let output = eomgen().args(&given).current_dir(folder.path()).output();
        let output = output.expect("the program can be run");
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{given:?}: {text}");
        let work: serde_json::Value = serde_json::from_slice(&output.stdout).expect("a document");
        (work["solver"].clone(), text)
    };
    let tolerance = ["--tolerance", "1e-6"];
    let (solver, text) = said("exact", "planetary_arm", &tolerance);
    assert_eq!(solver, "exact");
    assert!(text.contains("--tolerance has no effect"), "{text}");
    assert_eq!(said("auto", "planetary_arm", &[]).0, "exact");
    assert_eq!(
        said("auto", "pendulum", &tolerance),
        ("rk".into(), String::new())
    );
    assert_eq!(said("adams", "planetary_arm", &[]).0, "adams");
}

/// Commands without `--json` are listed in docs/commands.md: `schema`, `completions` and `man`.
#[test]
fn commands_on_a_specification_print_one_json_document() {
    for command in COMMANDS {
        let folder = tempfile::tempdir().expect("a folder");
        let mut program = eomgen();
        program.args([command, &spec("pendulum"), "--json"]);
        match command {
            "generate" => program.args(["--out", "made"]),
            "page" => program.args(["--out", "page.html"]),
            "simulate" => program.args(["--out", "motion.csv", "--until", "0.01"]),
            _ => &mut program,
        };
        let output = program.current_dir(folder.path()).output();
        let output = output.expect("the program can be run");
        assert_eq!(output.status.code(), Some(0), "{command}");
        let document: serde_json::Value =
            serde_json::from_slice(&output.stdout).expect("one document");
        assert!(document.is_object(), "{command}");
    }
}

/// With `--json`, an error is one document on stdout with the message and the locations; the message is also on stderr.
#[test]
fn errors_with_json_are_documents() {
    let folder = tempfile::tempdir().expect("a folder");
    let wrong = folder.path().join("wrong.toml");
    let text = std::fs::read_to_string(path("pendulum")).expect("the model");
    std::fs::write(&wrong, text.replace("dot(theta)", "dot(thetta)")).expect("a folder");
    let wrong = wrong.display().to_string();
    let place = |document: &serde_json::Value| document["error"]["diagnostics"][0]["line"].as_u64();
    for command in COMMANDS {
        let mut given = arguments(command, "pendulum", &["--json"]);
        given[1].clone_from(&wrong);
        let document = error_document(&given);
        assert!(place(&document).is_some(), "{command}: {document}");
    }
    for more in [
        &["modes", "no-file.toml", "--json"][..],
        &[
            "modes",
            &spec("pendulum"),
            "--state",
            "theta=1e300",
            "--json",
        ],
        &["modes", &spec("pendulum"), "--no-option", "--json"],
        &[
            "linearise",
            &spec("pendulum"),
            "--state",
            "nothing=1",
            "--json",
        ],
    ] {
        let given: Vec<String> = more.iter().map(|argument| (*argument).to_owned()).collect();
        error_document(&given);
    }
}

fn error_document(arguments: &[String]) -> serde_json::Value {
    let folder = tempfile::tempdir().expect("a folder");
    let output = eomgen().args(arguments).current_dir(folder.path()).output();
    let output = output.expect("the program can be run");
    let shown = arguments.join(" ");
    assert_eq!(output.status.code(), Some(2), "{shown}");
    let document: serde_json::Value =
        serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{shown}: {error}"));
    let message = document["error"]["message"].as_str().expect("a message");
    let stderr = String::from_utf8_lossy(&output.stderr);
    let first = message.lines().next().expect("a line");
    assert!(
        document["schema"].is_u64() && stderr.contains(first),
        "{shown}: {stderr}"
    );
    document
}

/// Inputs whose powers overflow are rejected with their time and value.
#[test]
fn comparison_rejects_inputs_out_of_range() {
    for (value, is_rejected) in [("1e300", true), ("-2e80", true), ("1e2", false)] {
        let measured = Measured::stage(0.0);
        let text = measured.read("train.csv");
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        let column = lines[0]
            .split(',')
            .position(|name| name == "force")
            .expect("the input");
        let mut cells: Vec<&str> = lines[9].split(',').collect();
        cells[column] = value;
        lines[9] = cells.join(",");
        measured.write("train.csv", (lines.join("\n") + "\n").as_bytes());
        if is_rejected {
            let message = measured.rejection();
            assert!(message.contains("(SI) at t = "), "{message}");
        } else {
            measured.run_command("compare", "out");
        }
    }
}

#[test]
fn names_that_are_given_twice_are_rejected() {
    let model = spec("furuta_pendulum");
    let out = tempfile::tempdir().expect("a folder");
    let csv = out.path().join("o.csv").display().to_string();
    for (option, first, second) in [
        ("--input", "u=1", "u=2"),
        ("--state", "theta=1", "theta=2"),
        ("--set", "g=1", "g=2"),
    ] {
        let motion = ["simulate", &model, "--until", "1", "--out", &csv];
        let message = run_rejected(&[&motion[..], &[option, first, option, second]].concat());
        let (name, values) = (&first[..first.len() - 2], "is given twice, as 1 and as 2");
        assert!(
            message.contains(&format!("{option}: `{name}` {values}")),
            "{message}"
        );
    }
    let message = run_rejected(&["trim", &model, "--fix", "theta=pi", "--fix", "theta=0"]);
    assert!(
        message.contains("--fix: `theta` is given twice, as pi and as 0"),
        "{message}"
    );
}
