//! Tests of the output files of the program: they are complete or absent, reproducible, and never replace a special
//! file.

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use eomgen_tests::models::path;
use eomgen_tests::program::{self, run_accepted, run_rejected, text};

fn spec(name: &str) -> String {
    path(name).display().to_string()
}

fn path_text(path: &Path) -> String {
    path.display().to_string()
}

#[test]
fn same_input_gives_same_bytes() {
    let folder = tempfile::tempdir().expect("a folder");
    let made = |run: &str| {
        let out = folder.path().join(run);
        let arm = spec("planetary_arm");
        let table = path_text(&out.join("a.csv"));
        run_accepted(&["simulate", &arm, "--until", "0.02", "--out", &table]);
        run_accepted(&["generate", &arm, "--order", "3", "--out", &path_text(&out)]);
        let certificate = path_text(&out.join("certificate.json"));
        run_accepted(&["validate", &spec("emps"), "--out", &certificate]);
        let mut contents: Vec<Vec<u8>> = ["a.csv", "lib.rs", "certificate.json"]
            .iter()
            .map(|name| std::fs::read(out.join(name)).expect("a file"))
            .collect();
        for format in ["text", "latex", "json"] {
            contents.push(run_accepted(&["derive", &arm, "--format", format]).into_bytes());
        }
        contents
    };
    let (first, second) = (made("first"), made("second"));
    assert!(first.iter().all(|contents| contents.len() > 100));
    assert!(first == second, "two runs differ");
}

#[test]
fn output_in_place_of_a_non_file_is_rejected() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("file");
    std::fs::write(&file, "kept").expect("a file");
    let pendulum = spec("pendulum");
    for out in [
        path_text(folder.path()),
        path_text(&file.join("a.csv")),
        "/".to_owned(),
    ] {
        let message = run_rejected(&["simulate", &pendulum, "--until", "1", "--out", &out]);
        assert!(message.contains("cannot write"), "{message}");
        let message = run_rejected(&["validate", &pendulum, "--out", &out]);
        assert!(message.contains("cannot write"), "{message}");
    }
    let message = run_rejected(&["generate", &pendulum, "--out", &path_text(&file)]);
    assert!(message.contains("is not a folder"), "{message}");
    assert_eq!(std::fs::read(&file).expect("the file"), b"kept");
}

#[cfg(unix)]
#[test]
fn output_folder_that_is_a_broken_link_is_rejected() {
    let folder = tempfile::tempdir().expect("a folder");
    let link = folder.path().join("link");
    std::os::unix::fs::symlink("missing", &link).expect("a link");
    for out in [path_text(&link), path_text(&link.join("deeper"))] {
        let message = run_rejected(&["generate", &spec("pendulum"), "--out", &out]);
        let cause = format!(
            "{} is a link to missing, which does not exist",
            link.display()
        );
        assert!(message.contains(&cause), "{message}");
        assert!(message.contains("create that folder"), "{message}");
    }
    assert!(link.is_symlink());
}

#[test]
fn inputs_are_never_replaced_by_outputs() {
    let folder = tempfile::tempdir().expect("a folder");
    let model = folder.path().join("model.toml");
    let text = std::fs::read(spec("pendulum")).expect("a specification");
    std::fs::write(&model, &text).expect("written");
    let (input, out) = (path_text(&model), format!("--out={}", path_text(&model)));
    // The name of the specification ends in `.csv`, which is allowed.
    let table = folder.path().join("model.csv");
    std::fs::write(&table, &text).expect("written");
    let beside = path_text(&folder.path().join(".").join("model.csv"));
    let table = path_text(&table);
    let extended = folder.path().join("extended.toml");
    std::fs::write(&extended, "[model]\nextends = \"model.toml\"\n").expect("written");
    for arguments in [
        &["simulate", &table, "--until", "1", "--out", &beside][..],
        &["linearise", &input, &out],
        &["validate", &input, "--out", &input],
        &["linearise", &path_text(&extended), "--out", &input],
    ] {
        let message = run_rejected(arguments);
        assert!(
            message.contains("is also read by this command"),
            "{message}"
        );
        for kept in [&input, &table] {
            assert_eq!(std::fs::read(kept).expect("the file"), text);
        }
    }
}

#[cfg(unix)]
#[test]
fn endless_files_are_rejected() {
    let message = run_rejected(&["identify", "/dev/zero"]);
    assert!(message.contains("not a file"), "{message}");
    let message = run_rejected(&["instructions", "/dev/zero", "--cc", "cc"]);
    assert!(message.contains("not a file"), "{message}");
}

#[cfg(unix)]
#[test]
fn devices_pipes_and_links_are_preserved() {
    let folder = tempfile::tempdir().expect("a folder");
    let (pipe, link, target) = (
        folder.path().join("pipe"),
        folder.path().join("link"),
        folder.path().join("target"),
    );
    let made = Command::new("mkfifo")
        .arg(&pipe)
        .status()
        .expect("mkfifo can be run");
    assert!(made.success());
    std::fs::write(&target, "old").expect("a file");
    std::os::unix::fs::symlink("target", &link).expect("a link");
    let simulate = |out: &Path| {
        let out = path_text(out);
        program::run(&["simulate", &spec("pendulum"), "--until", "1", "--out", &out])
    };
    let refused = simulate(&pipe);
    assert_eq!(refused.status.code(), Some(2));
    assert!(text(&refused.stderr).contains("not a file"));
    assert!(
        !std::fs::symlink_metadata(&pipe)
            .expect("the pipe")
            .is_file()
    );
    assert_eq!(simulate(&link).status.code(), Some(0));
    assert!(
        std::fs::symlink_metadata(&link)
            .expect("the link")
            .is_symlink()
    );
    assert!(
        std::fs::read_to_string(&target)
            .expect("the table")
            .starts_with("t,theta")
    );
}

/// With `-`, output is written to stdout, and messages are not. A device receives the bytes and is not replaced.
#[test]
fn output_can_go_to_stdout_or_a_device() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("a.csv");
    let simulate =
        |out: &str| program::run(&["simulate", &spec("pendulum"), "--until", "1", "--out", out]);
    assert_eq!(simulate(&path_text(&file)).status.code(), Some(0));
    let streamed = simulate("-");
    assert_eq!(
        streamed.status.code(),
        Some(0),
        "{}",
        text(&streamed.stderr)
    );
    assert_eq!(streamed.stdout, std::fs::read(&file).expect("the table"));
    assert!(text(&streamed.stderr).contains("1001 rows"));
    let certificate = program::run(&["validate", &spec("emps"), "--out", "-"]);
    assert!(
        text(&certificate.stdout).starts_with("{\n")
            && text(&certificate.stderr).contains("passed")
    );
    for command in [
        &["simulate", &spec("pendulum"), "--until", "1"][..],
        &["validate", &spec("emps")],
    ] {
        let message = run_rejected(&[command, &["--json", "--out", "-"]].concat());
        assert!(message.contains("both write to stdout"), "{message}");
    }
    if cfg!(unix) {
        assert_eq!(simulate("/dev/null").status.code(), Some(0));
        assert!(!std::fs::metadata("/dev/null").expect("a device").is_file());
    }
}

#[cfg(unix)]
#[test]
fn unwritable_folder_is_rejected() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().expect("a folder");
    let closed = folder.path().join("closed");
    std::fs::create_dir(&closed).expect("a folder");
    std::fs::set_permissions(&closed, PermissionsExt::from_mode(0o555)).expect("a closed folder");
    if std::fs::write(closed.join("probe"), "").is_ok() {
        skips::skip(
            "rejection of a read-only folder was not tested: this user (root?) can write to it",
        );
        return;
    }
    let out = path_text(&closed.join("a.csv"));
    let message = run_rejected(&["simulate", &spec("pendulum"), "--until", "1", "--out", &out]);
    assert!(message.contains("cannot write"), "{message}");
}

/// Starts a simulation of the pendulum with a table of `rows` rows and a header.
fn start_simulation(out: &Path, rows: usize, parameter: &str) -> Child {
    let until = (rows - 1) as f64 * 1e-3;
    Command::new(program::path())
        .args([
            "simulate",
            &spec("pendulum"),
            "--interval",
            "1e-3",
            "--set",
            parameter,
        ])
        .arg(format!("--until={until:?}"))
        .arg("--out")
        .arg(out)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program can be run")
}

#[test]
fn killed_run_leaves_a_complete_file_or_none() {
    const ROWS: usize = 100_001;
    let folder = tempfile::tempdir().expect("a folder");
    let whole = folder.path().join("whole.csv");
    // The program is built first, so that the measured time does not include it.
    program::path();
    let begun = std::time::Instant::now();
    assert!(
        start_simulation(&whole, ROWS, "g=9.81")
            .wait()
            .expect("an end")
            .success()
    );
    let taken = begun.elapsed();
    let expected = std::fs::read(&whole).expect("the table");
    assert_eq!(text(&expected).lines().count(), ROWS + 1);
    let out = folder.path().join("killed.csv");
    let mut absent = 0;
    for part in [0.1, 0.5, 0.8, 0.9, 0.95, 1.0] {
        let mut child = start_simulation(&out, ROWS, "g=9.81");
        std::thread::sleep(taken.mul_f64(part).max(Duration::from_millis(5)));
        child.kill().expect("the program can be killed");
        child.wait().expect("an end");
        match std::fs::read(&out) {
            Ok(found) => assert!(found == expected, "a table of {} bytes", found.len()),
            Err(_) => absent += 1,
        }
    }
    assert!(absent > 0, "no run was killed before its end");
}

#[test]
fn concurrent_runs_leave_one_complete_file() {
    const ROWS: usize = 2001;
    let folder = tempfile::tempdir().expect("a folder");
    let alone = |parameter: &str| {
        let out = folder.path().join("alone.csv");
        assert!(
            start_simulation(&out, ROWS, parameter)
                .wait()
                .expect("an end")
                .success()
        );
        std::fs::read(&out).expect("the table")
    };
    let possible = ["g=9.81", "g=1.62"].map(alone);
    assert!(possible[0] != possible[1]);
    for _ in 0..5 {
        let out = folder.path().join("shared.csv");
        let runs = ["g=9.81", "g=1.62"].map(|parameter| start_simulation(&out, ROWS, parameter));
        for mut run in runs {
            assert!(run.wait().expect("an end").success());
        }
        assert!(possible.contains(&std::fs::read(&out).expect("the table")));
    }
    let names: Vec<_> = std::fs::read_dir(folder.path())
        .expect("the folder")
        .collect();
    assert_eq!(names.len(), 2, "temporary files remain: {names:?}");
}
