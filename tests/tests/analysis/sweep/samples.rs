//! Tests of random samples of uncertain parameters: closed forms within standard errors, byte-identical results for any
//! number of threads and shards and after kills, and rejected options.

use std::fs;
use std::path::Path;

use eomgen_tests::program::{run_accepted, run_rejected};
use serde_json::Value;

use super::sweep_folder::{SweepFolder, column, table};

/// Mass on a spring under a force. All parameters are uncertain, and displacements are linear in the force.
const UNCERTAIN: &str = r#"
[model]
name = "uncertain"
[parameters]
m = { value = 2, unit = "kg" }
k = { value = 50, unit = "N/m" }
F = { value = 3, unit = "N", uncertainty = { relative = 0.05 } }
x_0 = { value = 20, unit = "mm", uncertainty = { between = [10, 40] } }
[coordinates]
x = { unit = "m", initial = "x_0" }
[kinetic]
mass = "1/2*m*dot(x)^2"
[potential]
spring = "1/2*k*x^2"
[forces]
load = { on = "x", value = "F" }
"#;

const COUNT: usize = 900;

fn create_sweep_folder() -> SweepFolder {
    let place = SweepFolder::new();
    fs::write(place.path_to("uncertain.toml"), UNCERTAIN).expect("a specification");
    place
}

fn arguments(place: &SweepFolder, out: &str, more: &[&str]) -> Vec<String> {
    let [spec, out] = ["uncertain.toml", out].map(|name| place.path_to(name).display().to_string());
    let given = [
        "sweep",
        &spec,
        "--out",
        &out,
        "--measure",
        "final:x,max:x_dot",
        "--until",
        "0.5",
    ];
    given
        .iter()
        .chain(more)
        .map(|argument| (*argument).to_owned())
        .collect()
}

fn accept(arguments: &[String]) -> String {
    run_accepted(&arguments.iter().map(String::as_str).collect::<Vec<_>>())
}

fn expect_rejection(arguments: &[String]) -> String {
    run_rejected(&arguments.iter().map(String::as_str).collect::<Vec<_>>())
}

fn statistics(folder: &Path) -> Value {
    let text = fs::read(folder.join("statistics.json")).expect("statistics.json");
    serde_json::from_slice(&text).expect("JSON")
}

fn result_files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let entries = fs::read_dir(folder).expect("the folder").flatten();
    let files = entries.filter(|entry| entry.path().is_file());
    let mut found: Vec<_> = files
        .map(|entry| {
            let name = entry.file_name().to_string_lossy().into_owned();
            (name, fs::read(entry.path()).expect("a file"))
        })
        .collect();
    found.sort();
    found
}

#[test]
fn mean_and_standard_deviation_of_linear_measure_match_closed_form() {
    let place = create_sweep_folder();
    let count = COUNT.to_string();
    accept(&arguments(
        &place,
        "out",
        &["--samples", &count, "--seed", "3"],
    ));
    let out = place.path_to("out");
    let found = statistics(&out);
    let of = |name: &str, what: &str| found["measured"][name][what].as_f64().expect("a number");
    // x = F/k (1 - cos(w t)) + x_0 cos(w t) with w = sqrt(k/m) = 5 rad/s.
    let cos = (5.0_f64 * 0.5).cos();
    let (by_force, by_start) = ((1.0 - cos) / 50.0, cos);
    let mean = 3.0 * by_force + 0.025 * by_start;
    // The force has a standard deviation of 5 % of 3 N. The initial value is uniform in a range of 30 mm, with a
    // standard deviation of 30 mm/sqrt(12).
    let parts = [0.15 * by_force, 0.03 / 12_f64.sqrt() * by_start];
    let sd = parts[0].hypot(parts[1]);
    let root = (COUNT as f64).sqrt();
    assert!((of("final:x", "mean") - mean).abs() < 4.0 * sd / root);
    assert!((of("final:x", "sd") - sd).abs() < 4.0 * sd / (2.0 * COUNT as f64).sqrt());
    assert!((of("final:x", "standard_error") - of("final:x", "sd") / root).abs() < 1e-15);
    let quantiles = found["measured"]["final:x"]["quantiles"]
        .as_object()
        .expect("quantiles");
    let quantiles: Vec<f64> = quantiles
        .values()
        .map(|q| q.as_f64().expect("a number"))
        .collect();
    assert_eq!(quantiles.len(), 7);
    // Each sample matches the closed form at its parameters, with x_0 in mm.
    let table = table(&out);
    let (force, start) = (column(&table, "F"), column(&table, "x_0"));
    for (sample, x) in column(&table, "final:x").iter().enumerate() {
        let expected = force[sample] * by_force + 1e-3 * start[sample] * by_start;
        assert!((x - expected).abs() < 1e-14, "{sample}: {x} {expected}");
        assert!((10.0..=40.0).contains(&start[sample]) && force[sample] > 0.0);
    }
    // The initial value has the largest effect, opposite to the force: the cosine is negative.
    let ranks = &found["measured"]["final:x"]["rank_correlations"];
    let [by_f, by_x] = ["F", "x_0"].map(|name| ranks[name].as_f64().expect("a number"));
    assert!(by_f > 0.2 && by_x < -0.8, "{ranks}");
    for name in ["samples_final_x.svg", "samples_max_x_dot.svg"] {
        let svg = fs::read_to_string(out.join(name)).expect(name);
        assert!(svg.ends_with("</svg>\n") && svg.contains("median"), "{svg}");
    }
}

#[test]
fn samples_depend_on_seed_but_not_on_threads_shards_or_kills() {
    let place = create_sweep_folder();
    let few = ["--samples", "40"];
    let text = accept(&arguments(
        &place,
        "one",
        &[&few[..], &["--threads", "1"]].concat(),
    ));
    assert!(
        text.contains("final:x: mean ") && text.contains("rank correlations: x_0 "),
        "{text}"
    );
    let whole = result_files(&place.path_to("one"));
    assert_eq!(whole.len(), 6);
    accept(&arguments(
        &place,
        "two",
        &[&few[..], &["--seed", "1", "--threads", "2"]].concat(),
    ));
    assert!(
        result_files(&place.path_to("two")) == whole,
        "two threads with an explicit seed"
    );
    for shard in ["2/2", "1/2"] {
        accept(&arguments(
            &place,
            "shards",
            &[&few[..], &["--shard", shard]].concat(),
        ));
    }
    run_accepted(&["merge", &place.path_to("shards").display().to_string()]);
    assert!(result_files(&place.path_to("shards")) == whole, "shards");
    // After a kill some parts are missing and one is truncated.
    let parts = place.path_to("two/parts");
    fs::remove_file(parts.join("0007.part")).expect("removed");
    fs::write(parts.join("0009.part"), "eomgen sweep part 1").expect("cut");
    let text = accept(&arguments(&place, "two", &few));
    assert!(text.contains("2 points computed, 38 resumed"), "{text}");
    assert!(result_files(&place.path_to("two")) == whole, "after a kill");
    let message = expect_rejection(&arguments(
        &place,
        "one",
        &[&few[..], &["--seed", "2"]].concat(),
    ));
    assert!(
        message.contains("differences: --samples or --seed"),
        "{message}"
    );
    accept(&arguments(
        &place,
        "seed",
        &[&few[..], &["--seed", "2"]].concat(),
    ));
    let [one, other] = ["one", "seed"].map(|name| table(&place.path_to(name)));
    let same = column(&one, "F").iter().zip(column(&other, "F"));
    assert_eq!(same.filter(|(a, b)| a == b).count(), 0);
}

#[test]
fn set_changes_the_nominal_value_of_uncertain_parameter() {
    let place = create_sweep_folder();
    let few = ["--samples", "60", "--set", "F=-30"];
    accept(&arguments(&place, "out", &few));
    let forces = table(&place.path_to("out"));
    let forces = column(&forces, "F");
    let mean = forces.iter().sum::<f64>() / 60.0;
    // The standard error of the mean is 5 % of 30 N divided by sqrt(60).
    assert!((mean + 30.0).abs() < 4.0 * 1.5 / 60_f64.sqrt(), "{mean}");
    assert!(
        forces.iter().all(|force| *force < 0.0),
        "the sign of a force changed"
    );
    for (set, part) in [("F=0", "0.05 of 0"), ("x_0=50", "10 to 40 mm")] {
        let message = expect_rejection(&arguments(&place, "no", &["--samples", "5", "--set", set]));
        assert!(
            message.contains(part) && message.contains("uncertainty"),
            "{message}"
        );
    }
    // In a grid without `--samples`, uncertainties have no effect.
    accept(&arguments(&place, "grid", &["--vary", "F=0:50:2"]));
}

#[test]
fn invalid_sample_options_are_rejected() {
    let place = create_sweep_folder();
    for (more, part) in [
        (&["--samples", "0"][..], "expected a number from 1"),
        (
            &["--samples", "10000001"],
            "expected a number from 1 to 10000000",
        ),
        (&["--samples", "-3"], "--samples"),
        (&["--samples", "5", "--vary", "F=1:2:3"], "--vary"),
        (
            &["--vary", "F=1:2:3", "--seed", "4"],
            "cannot be used with '--seed",
        ),
        (&[], "--vary"),
    ] {
        let message = expect_rejection(&arguments(&place, "never", more));
        assert!(message.contains(part), "{more:?}: {message}");
        assert!(!place.path_to("never").exists());
    }
    let spec = place.path_to("oscillator.toml").display().to_string();
    let message = run_rejected(&[
        "sweep",
        &spec,
        "--samples",
        "5",
        "--measure",
        "final:x",
        "--until",
        "1",
        "--out",
        "never",
    ]);
    assert!(
        message.contains("no uncertain parameter") && message.contains("relative"),
        "{message}"
    );
    for (wrong, part) in [
        ("{ relative = 1.5 }", "1.5 of 3"),
        ("{ sd = 0 }", "standard deviation of 0"),
        ("{ between = [4, 5] }", "4 to 5 N"),
        ("{ between = [4, 2] }", "4 to 2 N"),
        (
            "{ between = [\"F\", 5] }",
            "the bounds of `between` must be numbers",
        ),
        ("{ sd = 0.1, relative = 0.1 }", "not 2"),
        ("{ }", "not 0"),
        ("{ sigma = 0.1 }", "sigma"),
        ("0.1", "relative"),
    ] {
        let text = UNCERTAIN.replace("{ relative = 0.05 }", wrong);
        fs::write(place.path_to("uncertain.toml"), text).expect("a specification");
        let message = expect_rejection(&arguments(&place, "never", &["--samples", "5"]));
        assert!(message.contains(part), "{wrong}: {message}");
        assert!(message.contains("uncertain.toml:7:"), "{wrong}: {message}");
    }
}
