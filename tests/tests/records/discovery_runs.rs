//! Tests of runs of `discover`: a killed run leaves no partial file, and the same seed gives the same bytes.

use std::process::{Command, Stdio};
use std::time::Duration;

use eomgen_tests::measured::Measured;
use eomgen_tests::program;

#[test]
fn killed_run_leaves_no_partial_file() {
    let measured = Measured::stage(3.0);
    for wait in [0.02, 0.1, 0.3, 0.6, 1.0, 1.5] {
        let mut child = Command::new(program::path())
            .args(measured.arguments("discover", "killed"))
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("the program starts");
        std::thread::sleep(Duration::from_secs_f64(wait));
        child.kill().ok();
        child.wait().expect("it ends");
        for (name, end) in [
            ("discovery.json", "}\n"),
            ("extended.toml", "\n"),
            ("report.html", "</html>\n"),
        ] {
            if let Ok(text) = std::fs::read_to_string(measured.file("killed").join(name)) {
                assert!(text.ends_with(end), "{name} after {wait} s");
            }
        }
    }
    // The run can be repeated in the same folder.
    measured.run_command("discover", "killed");
}

#[test]
fn same_seed_gives_same_bytes() {
    let measured = Measured::stage(3.0);
    let [one, other] = ["one", "other"].map(|out| {
        let (mut result, _) = measured.run_command("discover", out);
        result["seconds"] = 0.into();
        let texts = ["extended.toml", "report.html"].map(|f| measured.read(&format!("{out}/{f}")));
        (result, texts)
    });
    assert_eq!(one.0, other.0);
    assert_eq!(one.1[0], other.1[0]);
    let page = |text: &str| text.replace("/one", "/other");
    assert!(page(&one.1[1]) == page(&other.1[1]), "the pages differ");
}
