//! Tests of datasets with nothing to compare: `compare` and `discover` reject them with the location and the remedy.

use eomgen_tests::measured::{DESCRIPTION, Measured, record};
use eomgen_tests::models::path;
use eomgen_tests::program;

/// Asserts that both commands reject the dataset and write nothing; returns the message.
fn rejection(measured: &Measured) -> String {
    let [compare, discover] = ["compare", "discover"].map(|command| {
        let arguments = measured.arguments(command, "refused");
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        let message = program::run_rejected(&arguments);
        assert!(!measured.file("refused").exists(), "{message}");
        message
    });
    assert_eq!(compare, discover);
    compare
}

/// Asserts that the dataset with one change is rejected with a message that contains all `parts`.
fn assert_rejects(measured: &Measured, from: &str, to: &str, parts: &[&str]) {
    let description = DESCRIPTION.replacen(from, to, 1);
    assert_ne!(description, DESCRIPTION, "{from}");
    measured.write("dataset.toml", description.as_bytes());
    let message = rejection(measured);
    for part in parts {
        assert!(message.contains(part), "{to}: {part}: {message}");
    }
}

/// Returns the record of the stage with changed cells in column `column`, counted from 1.
fn change_column(column: usize, cell: impl Fn(usize, &str) -> String) -> String {
    let text = record(0.0, 0.0);
    let line = |(place, line): (usize, &str)| {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        if place > 0 {
            cells[column] = cell(place, &cells[column]);
        }
        cells.join(",") + "\n"
    };
    text.lines().enumerate().map(line).collect()
}

#[test]
fn windows_longer_than_records_are_rejected() {
    let measured = Measured::stage(3.0);
    // The records last 1.995 s, or 2 s including the interval after the last sample.
    for length in ["5", "1e9", "2.1"] {
        let to = format!("length = {length}");
        let place = ["dataset.toml:27:10", "lasts 1.995", "\"record\""];
        assert_rejects(&measured, "length = 0.25", &to, &place);
    }
    for length in ["2", "1.995", "\"record\""] {
        let description = DESCRIPTION.replacen("0.25", length, 1);
        measured.write("dataset.toml", description.as_bytes());
        let (result, _) = measured.run_command("compare", "whole");
        assert_eq!(result["verdict"], "gap_found", "{length}: {result:#}");
    }
}

#[test]
fn set_of_records_shorter_than_a_window_is_rejected() {
    let measured = Measured::stage(0.0);
    let sound = record(0.0, 1.0);
    let lines: Vec<&str> = sound.lines().take(61).collect();
    measured.write("test.csv", (lines.join("\n") + "\n").as_bytes());
    let parts = [
        "no test record is as long as one window of 0.5 s",
        "lasts 0.295",
    ];
    assert_rejects(&measured, "length = 0.25", "length = 0.5", &parts);
}

#[test]
fn record_shorter_than_half_a_window_is_noted() {
    let measured = Measured::stage(0.0);
    let sound = record(0.0, 2.0);
    let lines: Vec<&str> = sound.lines().take(61).collect();
    measured.write("short.csv", (lines.join("\n") + "\n").as_bytes());
    let description = DESCRIPTION
        .replacen("[\"train.csv\"]", "[\"train.csv\", \"short.csv\"]", 1)
        .replacen("0.25", "0.8", 1);
    measured.write("dataset.toml", description.as_bytes());
    let (result, warned) = measured.run_command("compare", "short");
    let note = "train[1]: the record lasts 0.295000 s, less than half a window, and is ignored";
    assert!(warned.contains(note), "{warned}");
    assert!(result["notes"].to_string().contains(note), "{result:#}");
}

#[test]
fn windows_without_samples_are_rejected() {
    // In a window of four samples only the inner two are compared. All inner samples are missing.
    let measured = Measured::stage(0.0);
    let holes = |place: usize, cell: &str| match (place - 1) % 4 {
        1 | 2 => String::new(),
        _ => cell.to_owned(),
    };
    measured.write("train.csv", change_column(2, holes).as_bytes());
    let parts = [
        "channel `q` has 0 samples in the windows of all training records",
        "train.csv",
    ];
    assert_rejects(&measured, "length = 0.25", "length = 0.02", &parts);
}

#[test]
fn model_that_diverges_in_windows_is_rejected() {
    let measured = Measured::stage(3.0);
    let sound = std::fs::read_to_string(path("emps")).expect("a specification");
    // With a negative stiffness the motion overflows.
    let unstable = sound
        .replacen(
            "[coordinates]",
            "k_u = { value = 1e12, unit = \"N/m\" }\n\n[coordinates]",
            1,
        )
        .replacen(
            "[kinetic]",
            "[potential]\nunstable = \"-1/2*k_u*q^2\"\n\n[kinetic]",
            1,
        );
    measured.write("unstable.toml", unstable.as_bytes());
    for command in ["compare", "discover"] {
        let mut arguments = measured.arguments(command, "refused");
        arguments[1] = measured.file("unstable.toml").display().to_string();
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        let message = program::run_rejected(&arguments);
        let part = "the simulation of the model fails in 8 of 8 windows, first at t = 0.000000 s of train[0]";
        assert!(message.contains(part), "{message}");
        assert!(!measured.file("refused").exists(), "{message}");
    }
}

#[test]
fn noise_larger_than_motion_is_rejected() {
    let measured = Measured::stage(3.0);
    let parts = ["dataset.toml:18:9", "contain only noise"];
    assert_rejects(&measured, "noise = 1e-6", "noise = 10", &parts);
    assert_rejects(&measured, "noise = 1e-6", "noise = 1e300", &parts);
}

#[test]
fn invalid_noise_is_rejected_with_location() {
    let measured = Measured::stage(3.0);
    for (to, part) in [
        ("noise = 0", "greater than 0"),
        ("noise = -1e-6", "greater than 0"),
        ("noise = inf", "not a finite number"),
        ("noise = \"1e-6\"", "is not a number"),
        ("noise = []", "is not a number"),
    ] {
        assert_rejects(&measured, "noise = 1e-6", to, &["dataset.toml:18:", part]);
    }
    let parts = ["dataset.toml:15:11", "`q` has no `noise`"];
    assert_rejects(&measured, "noise = 1e-6\n", "", &parts);
}

#[test]
fn short_or_empty_records_are_rejected() {
    let measured = Measured::stage(0.0);
    let sound = record(0.0, 0.0);
    for samples in [0, 1, 2, 49] {
        let lines: Vec<&str> = sound.lines().take(samples + 1).collect();
        for file in ["train.csv", "test.csv"] {
            let measured = Measured::stage(0.0);
            measured.write(file, (lines.join("\n") + "\n").as_bytes());
            let message = rejection(&measured);
            let part = format!("has {samples} samples");
            assert!(
                message.contains(file) && message.contains(&part),
                "{message}"
            );
        }
    }
    // A number that overflows in SI units counts as missing.
    measured.write(
        "train.csv",
        change_column(2, |_, _| "1e308".to_owned()).as_bytes(),
    );
    let parts = ["train.csv", "400 of 400 samples are missing"];
    assert_rejects(
        &measured,
        "unit = \"m\"\nnoise = 1e-6",
        "unit = \"km\"\nnoise = 1e-9",
        &parts,
    );
}

#[test]
fn missing_channels_and_records_are_rejected_with_location() {
    let measured = Measured::stage(0.0);
    let channel = "[channels.q]\ncolumn = \"q\"\nunit = \"m\"\nnoise = 1e-6\n";
    assert_rejects(
        &measured,
        channel,
        "",
        &["dataset.toml:2:2", "nothing can be compared"],
    );
    for (from, to, parts) in [
        (
            "[channels.q]",
            "[channels.q_dott]",
            [
                "dataset.toml:15:11",
                "no observable, coordinate or state `q_dott`",
            ],
        ),
        (
            "noise = 1e-6",
            "noise = 1e-6\nobservable = \"p\"",
            [
                "dataset.toml:19:14",
                "no observable, coordinate or state `p`",
            ],
        ),
        (
            "[\"train.csv\"]",
            "[]",
            ["dataset.toml:2:2", "lists no train record"],
        ),
        (
            "test = [\"test.csv\"]",
            "",
            ["dataset.toml:2:2", "lists no test record"],
        ),
        (
            "[\"test.csv\"]",
            "[7]",
            ["dataset.toml:4:9", "is not a string"],
        ),
        (
            "[\"test.csv\"]",
            "\"test.csv\"",
            ["dataset.toml:4:8", "is not a list"],
        ),
    ] {
        assert_rejects(&measured, from, to, &parts);
    }
}

#[test]
fn unknown_keys_and_words_are_rejected_with_suggestion() {
    let measured = Measured::stage(0.0);
    for (from, to, parts) in [
        (
            "[windows]",
            "[window]",
            ["dataset.toml:26:2", "did you mean `windows`?"],
        ),
        (
            "[records]",
            "[record]",
            ["dataset.toml:2:2", "did you mean `records`?"],
        ),
        (
            "[uncertain]",
            "[uncertian]",
            ["dataset.toml:23:2", "did you mean `uncertain`?"],
        ),
        (
            "length = 0.25",
            "lenght = 0.25",
            ["dataset.toml:27:1", "did you mean `length`?"],
        ),
        (
            "noise = 1e-6",
            "noise = 1e-6\ngain = 0.05",
            ["dataset.toml:19:8", "write gain = { sd = 0.02 }"],
        ),
        (
            "noise = 1e-6",
            "noise = 1e-6\ngian = { sd = 0.02 }",
            ["dataset.toml:19:1", "did you mean `gain`?"],
        ),
        (
            "test = ",
            "tets = ",
            ["dataset.toml:4:1", "did you mean `test`?"],
        ),
        (
            "hold = \"zero-order\"",
            "hold = \"zero_order\"",
            ["dataset.toml:13:8", "did you mean `zero-order`?"],
        ),
        (
            "hold = \"zero-order\"",
            "hlod = \"zero-order\"",
            ["dataset.toml:13:1", "did you mean `hold`?"],
        ),
        (
            "length = 0.25",
            "length = 0.25\nstart = \"smooth\"",
            ["dataset.toml:28:9", "did you mean `smoothed`?"],
        ),
        (
            "length = 0.25",
            "length = \"recrod\"",
            ["dataset.toml:27:10", "did you mean `record`?"],
        ),
        (
            "state = \"rest\"",
            "state = \"estimated\"",
            ["dataset.toml:21:9", "did you mean `estimate`?"],
        ),
        ("F_v", "F_w", ["dataset.toml:24:1", "did you mean `F_v`?"]),
        (
            "relative = 0.05",
            "relativ = 0.05",
            ["dataset.toml:24:9", "did you mean `relative`?"],
        ),
        (
            "unit = \"m\"",
            "unit = \"mmm\"",
            ["dataset.toml:17:8", "expected m"],
        ),
    ] {
        assert_rejects(&measured, from, to, &parts);
    }
}

#[test]
fn invalid_initial_states_are_rejected() {
    let measured = Measured::stage(0.0);
    let rest = "state = \"rest\"";
    for (to, part) in [
        ("state = \"given\"", "`values` are missing"),
        ("state = \"rest\"\nvalues = { q = 1 }", "are not used"),
        (
            "state = \"given\"\nvalues = { p = 1 }",
            "the model has no state `p`",
        ),
        (
            "state = \"given\"\nvalues = { q = nan }",
            "not a finite number",
        ),
        ("state = {}", "no state is given"),
        ("", "`initial` has no `state`"),
    ] {
        assert_rejects(&measured, rest, to, &["dataset.toml:2", part]);
    }
}

#[test]
fn invalid_uncertainties_are_rejected() {
    let measured = Measured::stage(0.0);
    for relative in ["0", "-0.1", "1e-300", "1e300", "inf"] {
        let to = format!("relative = {relative}");
        assert_rejects(&measured, "relative = 0.05", &to, &["dataset.toml:24:20"]);
    }
}
