//! Tests of `eomgen sweep` and `eomgen merge`. Results are byte-identical for any number of threads and shards and
//! after kills. They are compared with the closed form of a forced oscillator. Invalid options are rejected.

mod conditions;
mod exponents;
mod over_time;
mod rejections;
mod samples;
mod sections;
mod sweep_folder;

use std::f64::consts::TAU;
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use eomgen_tests::models::path;
use eomgen_tests::program::{self, run_accepted};

use sweep_folder::{
    MAP, SweepFolder, accept, column, expect_rejection, merge_command, parts, results, table,
};

#[test]
fn sweep_matches_closed_form() {
    let place = SweepFolder::new();
    let span = ["--transient", "60", "--periods", "4"];
    let axes = ["--vary", "c=400:1000:3", "--vary", "omega=1:3:4"];
    accept(&place.sweep("map", &[&axes[..], &span[..]].concat()));
    let table = table(&place.path_to("map"));
    let (c, omega) = (column(&table, "c"), column(&table, "omega"));
    assert_eq!(c[..5], [400.0, 400.0, 400.0, 400.0, 700.0]);
    assert_eq!((omega[0], omega[3], omega[4]), (1.0, 3.0, 1.0));
    for (point, mean) in column(&table, "poincare_mean").iter().enumerate() {
        // The response x = A sin(omega t) + B cos(omega t) equals B after every forcing period.
        let (c, omega) = (c[point] / 1000.0, omega[point]);
        let stiffness = 4.0 - omega * omega;
        let amplitude = 3.0 / (stiffness.powi(2) + (c * omega).powi(2));
        let expected = -amplitude * c * omega;
        // The transient decays as exp(-c t/(2 m)): 3e-11 after 60 periods at the smallest c and
        // largest omega, times a resonance of a few m.
        assert!(
            (mean - expected).abs() < 1e-9,
            "{point}: {mean}, expected {expected}"
        );
        for name in ["poincare_min", "poincare_max"] {
            assert!((column(&table, name)[point] - expected).abs() < 1e-9);
        }
        assert_eq!(column(&table, "poincare_period")[point], 1.0);
        assert_eq!(column(&table, "poincare_clusters")[point], 1.0);
        assert_eq!(column(&table, "poincare_status")[point], 0.0);
    }
}

#[test]
fn varied_expression_and_set_parameter_match_simulate() {
    let place = SweepFolder::new();
    let vary = ["--vary", "zeta=0.1:0.3:2", "--set", "F=-2"];
    let span = ["--transient", "2", "--periods", "2"];
    accept(&place.sweep("line", &[&vary[..], &span[..]].concat()));
    let swept = table(&place.path_to("line"));
    let csv = place.path_to("x.csv").display().to_string();
    let spec = place.path_to("oscillator.toml").display().to_string();
    // For omega = 2, the fourth period begins at 3 pi.
    let (until, sample) = (format!("{:?}", TAU * 1.5), format!("{:?}", TAU / 2.0));
    let settings = ["--set", "zeta=0.3", "--set", "F=-2", "--out", &csv];
    let times = ["--until", &until, "--interval", &sample];
    run_accepted(&[&["simulate", &spec], &settings[..], &times[..]].concat());
    let text = fs::read_to_string(&csv).expect("the trajectory");
    let last = text.lines().last().expect("a row").split(',').nth(1);
    let expected: f64 = last.expect("x").parse().expect("a number");
    let found = column(&swept, "poincare_2")[1];
    // Sweep and `simulate` run the exact solver with different output times; the table contains all digits.
    assert!(
        (found - expected).abs() < 1e-13,
        "{found}, expected {expected}"
    );
}

#[test]
fn threads_and_shards_give_same_bytes() {
    let place = SweepFolder::new();
    let (one, two, shards) = (
        place.path_to("one"),
        place.path_to("two"),
        place.path_to("shards"),
    );
    accept(&place.sweep("one", &[&MAP[..], &["--threads", "1"]].concat()));
    accept(&place.sweep("two", &[&MAP[..], &["--threads", "2"]].concat()));
    assert!(results(&one) == results(&two), "two threads");
    for shard in ["3/3", "1/3", "2/3"] {
        let error = merge_command(&shards);
        assert!(expect_rejection(&error).contains(if shard == "3/3" {
            "sweep.json"
        } else {
            "missing"
        }));
        accept(&place.sweep("shards", &[&MAP[..], &["--shard", shard]].concat()));
        assert!(!shards.join("sweep.parquet").exists());
    }
    accept(&merge_command(&shards));
    assert!(results(&one) == results(&shards), "three shards");
    // The command is repeated although all points are computed.
    let text = accept(&place.sweep("one", &MAP));
    assert!(text.contains("0 points computed, 20 resumed"), "{text}");
    assert!(results(&one) == results(&two), "again");
}

#[test]
fn shards_in_separate_folders_can_be_merged() {
    let place = SweepFolder::new();
    accept(&place.sweep("whole", &MAP));
    for shard in ["1/2", "2/2"] {
        let folder = format!("shard{}", &shard[..1]);
        accept(&place.sweep(&folder, &[&MAP[..], &["--shard", shard]].concat()));
    }
    let (first, second) = (place.path_to("shard1"), place.path_to("shard2"));
    let gap = expect_rejection(&merge_command(&first));
    assert!(gap.contains("10 of 20 points are missing"), "{gap}");
    for part in parts(&second) {
        let to = first.join("parts").join(&part);
        fs::copy(second.join("parts").join(&part), to).expect("a copy");
    }
    accept(&merge_command(&first));
    assert!(results(&place.path_to("whole")) == results(&first));
}

/// Returns the number of finished parts. Unfinished files after a kill are not counted; they are computed again.
fn count_finished(folder: &Path) -> usize {
    let parts = parts(folder);
    parts.iter().filter(|name| name.ends_with(".part")).count()
}

fn kill_after(mut child: Child, folder: &Path, some: usize) {
    let deadline = Instant::now() + Duration::from_secs(60);
    while count_finished(folder) < some {
        assert!(Instant::now() < deadline, "no parts in a minute");
        let ended = child.try_wait().expect("a child");
        assert!(ended.is_none(), "the run ended before the kill: {ended:?}");
        std::thread::sleep(Duration::from_millis(1));
    }
    child.kill().expect("SIGKILL");
    child.wait().expect("its end");
}

#[test]
fn killed_run_resumes_to_same_bytes() {
    let place = SweepFolder::new();
    // The points take long enough for a kill between the first and the last point.
    let slow = [
        "--vary",
        "c=400:1000:5",
        "--vary",
        "omega=1:3:12",
        "--transient",
        "20000",
        "--periods",
        "2000",
    ];
    accept(&place.sweep("whole", &slow));
    let killed = place.path_to("killed");
    for some in [5, 20] {
        let child = Command::new(program::path())
            .args(place.sweep("killed", &slow))
            .stdout(Stdio::null())
            .spawn()
            .expect("the program can be run");
        kill_after(child, &killed, some);
        let refusal = expect_rejection(&merge_command(&killed));
        assert!(refusal.contains("points are missing"), "{refusal}");
    }
    let text = accept(&place.sweep("killed", &slow));
    let computed: usize = text
        .split(' ')
        .next()
        .and_then(|n| n.parse().ok())
        .expect("a number");
    assert!((1..=40).contains(&computed), "{text}");
    assert!(results(&place.path_to("whole")) == results(&killed));
    assert_eq!(
        parts(&killed),
        parts(&place.path_to("whole")),
        "no unfinished file remains"
    );
}

#[test]
fn sweep_varies_both_meshes_together() {
    let place = SweepFolder::new();
    let (arm, out) = (
        path("planetary_arm").display().to_string(),
        place.path_to("arm"),
    );
    run_accepted(&[
        "sweep",
        &arm,
        "--order",
        "0",
        "--vary",
        "b_sp,b_pr=0:50e-6:2",
        "--measure",
        "poincare",
        "--transient",
        "1",
        "--periods",
        "2",
        "--out",
        &out.display().to_string(),
    ]);
    let found = table(&out);
    assert_eq!(column(&found, "b_sp"), [0.0, 50e-6]);
    assert_eq!(column(&found, "b_pr"), [0.0, 50e-6]);
    assert_eq!(column(&found, "poincare_status"), [0.0, 0.0]);
    let greatest = column(&found, "poincare_max");
    assert!(
        greatest[1] > 50e-6 * 0.9 && greatest[0] < 5e-6,
        "{greatest:?}"
    );
}
