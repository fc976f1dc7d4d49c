//! The output of the example in docs/discovery.md equals that of the program.

use eomgen_tests::models::project;
use eomgen_tests::program::eomgen;

const COMMAND: &str = "$ cargo run --release -- discover examples/measured/stage.toml \
                       examples/measured/dataset.toml --out found\n";

#[test]
fn example_prints_documented_output() {
    let page = std::fs::read_to_string(project().join("docs/discovery.md")).expect("the page");
    let (_, behind) = page.split_once(COMMAND).expect("the example");
    let (shown, _) = behind.split_once("```").expect("the end of the example");
    let folder = tempfile::tempdir().expect("a folder");
    let records = project().join("examples/measured");
    let run = eomgen()
        .current_dir(folder.path())
        .arg("discover")
        .args([records.join("stage.toml"), records.join("dataset.toml")])
        .args(["--out", "found"])
        .output()
        .expect("the program runs");
    assert_eq!(String::from_utf8_lossy(&run.stdout), shown);
}
