//! Tests of points without a result, incompatible sweeps, and invalid options.

use std::fs;

use eomgen_tests::models::path;
use eomgen_tests::program::{run_accepted, run_rejected};

use super::sweep_folder::{
    MAP, OSCILLATOR, SweepFolder, accept, column, expect_rejection, results, table,
};

#[test]
fn different_sweep_in_folder_is_rejected_and_unchanged() {
    let place = SweepFolder::new();
    accept(&place.sweep("map", &MAP));
    let before = results(&place.path_to("map"));
    for (more, what) in [
        (["--set", "F=2"], "--set"),
        (["--vary", "k=4:5:1"], "--vary"),
        (["--frequency", "omega2"], "omega2"),
    ] {
        let message = expect_rejection(&place.sweep("map", &[&MAP[..], &more[..]].concat()));
        assert!(message.contains(what), "{message}");
    }
    let changed = OSCILLATOR.replace("value = 3,", "value = 3.5,");
    fs::write(place.path_to("oscillator.toml"), changed).expect("a specification");
    let message = expect_rejection(&place.sweep("map", &MAP));
    assert!(
        message.contains("differences: the specification"),
        "{message}"
    );
    assert!(results(&place.path_to("map")) == before);
}

#[test]
fn invalid_engine_options_are_rejected() {
    let place = SweepFolder::new();
    for (more, what) in [
        (&["--engine", "pbs"][..], "slurm, dask"),
        (
            &["--engine", "slurm", "--shard", "1/2"],
            "--shards sets their number",
        ),
        (&["--shards", "4"], "--shards needs --engine"),
        (&["--engine", "slurm", "--shards", "0"], "1..=1000"),
        (&["--engine", "slurm", "--shards", "1001"], "1..=1000"),
        (
            &["--engine", "slurm", "--scheduler", "tcp://a:1"],
            "--engine dask",
        ),
        (&["--engine", "dask"], "DASK_SCHEDULER_ADDRESS"),
    ] {
        let message = expect_rejection(&place.sweep("map", &[&MAP[..], more].concat()));
        assert!(message.contains(what), "{more:?}: {message}");
        assert!(!place.path_to("map/sweep.parquet").exists());
    }
}

#[test]
fn controller_state_as_measure_is_rejected_by_its_name() {
    let place = SweepFolder::new();
    let controlled = OSCILLATOR.replace("\"F*sin(omega*t)\"", "\"u\"")
        + "[inputs]\nu = { unit = \"N\" }\n[controllers.pi]\nperiod = 0.1\n\
           states = { total = { unit = \"m\", next = \"total + x\" } }\noutputs = { u = \"-k*total\" }\n";
    fs::write(place.path_to("oscillator.toml"), controlled).expect("a specification");
    let given = place.sweep("map", &["--vary", "m=1:2:2", "--until", "1"]);
    let given = given.into_iter().map(|argument| match &*argument {
        "poincare" => "final:total".to_owned(),
        _ => argument,
    });
    let message = expect_rejection(&given.collect::<Vec<_>>());
    assert!(
        message.contains("`total` is a state of the controller `pi`"),
        "{message}"
    );
    assert!(!message.contains("did you mean"), "{message}");
}

#[test]
fn points_without_result_have_a_reason() {
    let place = SweepFolder::new();
    // Without mass the model cannot be simulated, and at frequency 0 there is no forcing period.
    let axes = ["--vary", "m=0:1:2", "--vary", "omega=0:2:2"];
    let more = ["--set", "zeta=0.1", "--periods", "2", "--json"];
    let json = accept(&place.sweep("few", &[&axes[..], &more[..]].concat()));
    let document: serde_json::Value = serde_json::from_str(&json).expect("one document");
    assert_eq!(
        (&document["points"], &document["computed"]),
        (&4.into(), &4.into())
    );
    assert_eq!(document["failed"]["poincare"], 3);
    let found = table(&place.path_to("few"));
    let status = column(&found, "poincare_status");
    assert_eq!(status[1..], [1.0, 5.0, 0.0]);
    let mean = column(&found, "poincare_mean");
    assert_eq!(mean.iter().filter(|mean| mean.is_nan()).count(), 3);
    // Negative damping: growth by exp(9 t) for more than 950 s overflows.
    let growing = ["--vary", "c=-10000:-9000:2", "--transient", "300"];
    accept(&place.sweep("growing", &growing));
    let found = table(&place.path_to("growing"));
    assert!(
        column(&found, "poincare_status")
            .iter()
            .all(|status| *status == 2.0)
    );
    let text = fs::read_to_string(place.path_to("few/sweep.json")).expect("the description");
    assert!(
        text.contains("the parameter values are not admissible"),
        "{text}"
    );
}

#[test]
fn invalid_sweeps_are_rejected_before_writing() {
    let place = SweepFolder::new();
    let c = "c=1:2:3";
    for (more, part) in [
        (vec!["--vary", "d=1:2:3"], "no parameter `d`"),
        (vec!["--vary", "omeag=1:2:3"], "did you mean `omega`"),
        (vec!["--vary", "m=-1:2:3"], "at least 0 kg"),
        (vec!["--vary", "m=2:-1:3"], "at least 0 kg"),
        (vec!["--vary", "c=1:2"], "FROM:TO:COUNT"),
        (vec!["--vary", "c=1:2:0"], "at least 1"),
        (vec!["--vary", "c=1:nan:3"], "finite"),
        (
            vec!["--vary", "c=1:2:5000", "--vary", "k=1:2:5000"],
            "10000000 points",
        ),
        (vec!["--vary", c, "--vary", c], "varied twice"),
        (vec!["--vary", c, "--set", "c=1"], "both set and varied"),
        (vec!["--vary", c, "--set", "m"], "NAME=VALUE"),
        (vec!["--vary", c, "--shard", "0/3"], "such as 2/3"),
        (vec!["--vary", c, "--shard", "4/3"], "such as 2/3"),
        (vec!["--vary", c, "--threads", "0"], "--threads"),
        (vec!["--vary", c, "--order", "3"], "no field"),
        (vec!["--vary", c, "--frequency", "k"], "angular frequency"),
        (vec!["--vary", c, "--periods", "1"], "at least 2 --periods"),
        (vec!["--vary", c, "--transient", "9999999"], "--transient"),
        (
            vec!["--vary", c, "--measure", "fly"],
            "expected one of lyapunov",
        ),
        (
            vec!["--vary", c, "--measure", "poincare"],
            "give each measure once",
        ),
    ] {
        let message = expect_rejection(&place.sweep("never", &more));
        assert!(message.contains(part), "{more:?}: {message}");
        assert!(!place.path_to("never").exists(), "{more:?}");
    }
    let pendulum = path("pendulum").display().to_string();
    let out = place.path_to("never").display().to_string();
    let message = run_rejected(&[
        "sweep",
        &pendulum,
        "--vary",
        "m=1:2:3",
        "--measure",
        "poincare",
        "--out",
        &out,
    ]);
    assert!(message.contains("--frequency NAME"), "{message}");
    let file = place.path_to("oscillator.toml").display().to_string();
    assert!(run_rejected(&["merge", &file]).contains("sweep.json"));
}

#[test]
fn help_has_an_example() {
    for command in ["sweep", "merge"] {
        let help = run_accepted(&[command, "--help"]);
        let example = help.split_once("Example").map(|(_, example)| example);
        assert!(example.is_some_and(|text| text.contains(&format!("eomgen {command} "))));
    }
}
