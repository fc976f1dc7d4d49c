//! Every command that README.md and docs/ print does what they say: the program's are run, in
//! the order of the pages and in one folder, as a reader would; the others are found where
//! `.ci/run` runs them. A command of a form that is not known here fails.
//!
//! A reader's folder is made of links here, and shells are those of Unix.
#![cfg(unix)]

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;
use std::time::Duration;

use eomgen_tests::measured::Measured;
use eomgen_tests::models::{path, project};
use eomgen_tests::pages::{Printed, in_blocks, in_text, pages};
use eomgen_tests::program::{self, text};

/// The longest that one command may take.
const LIMIT: Duration = Duration::from_secs(300);

/// What is too much for every run of the tests: it is run with other arguments here.
const REDUCED: [(&str, &str); 2] = [
    (
        "--vary b_sp,b_pr=0:100e-6:40 --vary omega=10:60:40",
        "--vary b_sp,b_pr=0:100e-6:3 --vary omega=10:60:2",
    ),
    (
        "--vary b_sp,b_pr=0:100e-6:100 --vary omega=10:60:100",
        "--vary b_sp,b_pr=0:100e-6:3 --vary omega=10:60:2",
    ),
];

/// What another test runs, with the file that does.
const ELSEWHERE: [(&str, &str); 15] = [
    (
        "cargo install --path cli",
        "tests/tests/project/installed.rs",
    ),
    // The same commands, as the package's own page has them.
    ("python3 -m venv .venv", "tests/tests/hosts/python.rs"),
    ("pip install ./python", "tests/tests/hosts/python.rs"),
    // What it would bring into a project.
    ("cargo add eomgen", "tests/tests/project/packages.rs"),
    // The bench of a small machine, built and run.
    (
        "cd emps && cargo bench -- --",
        "tests/tests/emission/bench_of_a_model.rs",
    ),
    // Searches of one set, and what they say of the assumed values against docs/claims.json.
    (
        "cargo run --release -- paper claims ",
        "tests/tests/paper/study_search.rs",
    ),
    // All four studies.
    (
        "cargo run --release -- paper study ",
        "tests/tests/paper/study.rs",
    ),
    // The same script, with the arm as it is emitted.
    (
        "examples/bare_metal/run rig4/lib.rs",
        "tests/tests/emission/bare_metal.rs",
    ),
    // The same script, and what it prints.
    (
        "examples/bare_metal/observe rig4_jacobians/lib.rs",
        "tests/tests/emission/bare_metal.rs",
    ),
    // Six cases of the suite.
    (
        "cargo run --release -p eomgen-blind -- ",
        "tests/tests/discovery/blind.rs",
    ),
    // Counts and figures with the numbers of the record; timing is for an idle machine.
    (
        "cargo run --release -p eomgen-benches --bin history",
        "benches/tests/benches/instructions.rs",
    ),
    // The emitted C, compiled and compared; timing is for an idle machine.
    (
        "cargo run --release -p eomgen-benches --bin c99",
        "tests/tests/hosts/c99/mod.rs",
    ),
    // The same specifications, by counted operations; timing is for an idle machine.
    (
        "cargo run --release -p eomgen-benches --bin rigid_trees",
        "benches/tests/benches/rigid_trees.rs",
    ),
    // The same test, with fewer models.
    (
        "EOMGEN_SMOOTH_MODELS=300 ",
        "tests/tests/equations/smooth_models.rs",
    ),
    // The same test, keeping what it finds.
    (
        "EOMGEN_REFRESH=1 cargo test ",
        "benches/tests/benches/instructions.rs",
    ),
];

/// Output that is shown without a command, and the file that another test compares it with.
const SHOWN_ELSEWHERE: [(&str, &str); 1] = [(
    // The compiler's, for a mistake in a macro.
    "error: unknown name `thta`",
    "tests/macro_errors/errors/misspelt_name.stderr",
)];

/// Figures that a printed command leaves, and where the pages have them.
const FIGURES: [(&str, &str); 1] = [("tour/trajectory.svg", "docs/tour.svg")];

/// Words of the pages that a reader puts something in the place of.
const PLACES: [(&str, &str); 3] = [
    ("SPEC ", "model-spec/models/emps.toml "),
    ("DATASET.toml", "dataset.toml"),
    ("NAME.toml", "pendulum.toml"),
];

/// A specification with the mistake that the pages show on its 16th line.
const WRONG: &str = r#"[model]
name = "wrong"

[parameters]
m = { value = 0.15, unit = "kg" }
l = { value = 0.3, unit = "m" }
k = { value = 2, unit = "N/m" }

[coordinates]
theta = { unit = "rad" }

[kinetic]
bob = "1/2*m*l^2*dot(theta)^2"

[potential]
spring = "1/2*k*theta^2"
"#;

/// One with the mistake of its 19th line.
const MISSPELT: &str = r#"[model]
name = "misspelt"

[parameters]
m = { value = 0.15, unit = "kg" }
l = { value = 0.3, unit = "m" }
c = { value = 2e-4, unit = "N m s" }
g = { value = 9.81, unit = "m/s^2" }

[coordinates]
theta = { unit = "rad" }

[kinetic]
bob = "1/2*m*l^2*dot(theta)^2"
[potential]
gravity = "-m*g*l*cos(theta)"

[forces]
friction = { on = "theta", value = "-c*dot(thta)" }
"#;

/// One with the circle of its fourth and fifth line.
const CIRCLE: &str = r#"[model]
name = "circle"
[parameters]
a = { value = "b", unit = "kg" }
b = { value = "a", unit = "kg" }
[coordinates]
x = { unit = "m" }
[kinetic]
mass = "1/2*a*dot(x)^2"
"#;

/// A folder as a reader has it: the project, and the files that the pages have one write.
fn reader() -> Measured {
    // Records of a stage with dry friction, to compare and to discover with.
    let measured = Measured::stage(3.0);
    let (_, readme) = pages()
        .into_iter()
        .find(|(name, _)| name == "README.md")
        .expect("README");
    let specification = readme.split("```toml\n").nth(1).expect("a specification");
    let specification = specification.split("```").next().expect("its end");
    for name in ["driven_pendulum.toml", "my_machine.toml"] {
        measured.write(name, specification.as_bytes());
    }
    let controller = project().join("examples/with_command_line/controller.rs");
    measured.write(
        "controller.rs",
        &std::fs::read(controller).expect("an example"),
    );
    for (name, text) in [("wrong", WRONG), ("misspelt", MISSPELT), ("circle", CIRCLE)] {
        measured.write(&format!("{name}.toml"), text.as_bytes());
    }
    for folder in ["model-spec", "examples"] {
        let link = std::os::unix::fs::symlink(project().join(folder), measured.file(folder));
        link.expect("a link");
    }
    measured
}

/// Runs a command of the program, which must do what it was asked; all it says. Words may stand in
/// single quotes, but hold no space. A specification with an error is refused.
fn said(arguments: &str, folder: &Path, refused: bool) -> String {
    let output = assert_cmd::Command::new(program::path())
        .args(arguments.split(' ').map(|word| word.trim_matches('\'')))
        .current_dir(folder)
        .timeout(LIMIT)
        .output()
        .expect("the program can be run");
    let said = text(&output.stderr) + &text(&output.stdout);
    let expected = if refused { 2 } else { 0 };
    assert_eq!(output.status.code(), Some(expected), "{arguments}: {said}");
    said
}

/// Runs a line of compilers and what they made; what is printed.
fn compiled(line: &str, folder: &Path) -> String {
    let output = Command::new("sh")
        .args(["-c", line])
        .current_dir(folder)
        .output();
    let output = output.expect("a shell");
    assert!(output.status.success(), "{line}: {}", text(&output.stderr));
    text(&output.stdout)
}

/// Whether there is a Python with SciPy; says so if not.
fn scipy() -> bool {
    let found = Command::new("python3")
        .args(["-c", "import numpy, scipy"])
        .output();
    let there = found.is_ok_and(|output| output.status.success());
    if !there {
        skips::skip(
            "the regulator of docs/controllers.md was not computed, for want of python3 with \
             numpy and scipy (pip install scipy)",
        );
    }
    there
}

/// Runs an example in Python; all it says. It refuses with status 1.
fn by_python(line: &str, folder: &Path, refused: bool) -> String {
    let output = Command::new("sh")
        .args(["-c", line])
        .current_dir(folder)
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .output();
    let output = output.expect("a shell");
    let said = text(&output.stdout) + &text(&output.stderr);
    assert_eq!(
        output.status.code(),
        Some(i32::from(refused)),
        "{line}: {said}"
    );
    said
}

/// A line without what differs from run to run or from machine to machine: how long something
/// took, and by how many roundings a check missed its mark.
fn settled(line: &str) -> String {
    match line.split_once(" passed ") {
        Some((check, _)) => format!("{} passed", check.trim_end()),
        None => line.trim_end().to_owned(),
    }
}

/// Asserts that the output holds the lines shown, in their order and without gaps but at `...`.
fn shows(shown: &[String], output: &str, command: &str) {
    let lines: Vec<String> = output.lines().map(settled).collect();
    let mut from = 0;
    for part in shown.split(|line| line.trim() == "...") {
        let part: Vec<String> = part.iter().map(|line| settled(line)).collect();
        let place = (from..=lines.len()).find(|start| lines[*start..].starts_with(&part));
        let place = place.unwrap_or_else(|| panic!("{command} does not say {part:#?}:\n{output}"));
        from = place + part.len();
    }
}

/// What a command of the pages is.
enum Form<'a> {
    /// Arguments of the program.
    Program(&'a str),
    /// A line for compilers.
    Compilers,
    /// An example in Python that needs SciPy.
    Scipy,
    /// Named in the lists above.
    Elsewhere(&'static str),
    /// Tests that the whole test command runs, of a package and maybe of one file.
    Tests(&'a str),
    /// What `.ci/run` holds these words for.
    Ci(Vec<&'a str>),
}

fn form(command: &str) -> Form<'_> {
    let words: Vec<&str> = command.split(' ').collect();
    if let Some((_, file)) = ELSEWHERE
        .iter()
        .find(|(start, _)| command.starts_with(start))
    {
        return Form::Elsewhere(file);
    }
    match words[..] {
        ["cargo", "run", "--release", "--", ..] => {
            Form::Program(command.trim_start_matches("cargo run --release -- "))
        }
        ["eomgen", ..] => Form::Program(command.trim_start_matches("eomgen ")),
        ["rustc" | "cc", ..] => Form::Compilers,
        ["python3", ..] => Form::Scipy,
        ["cargo", "test", "--release", ref rest @ ..] => match rest {
            ["--workspace"] => Form::Tests(""),
            ["-p", _, ..] => Form::Tests(command),
            _ => panic!("a form of tests that is not known here: {command}"),
        },
        [
            "cargo",
            "bench",
            "-p",
            "eomgen-benches",
            "--bench",
            name,
            ..,
        ] => Form::Ci(vec!["cargo bench --workspace ", name]),
        [
            "cargo",
            "run",
            "--release",
            "-p",
            "eomgen-studies",
            "--",
            study,
            ..,
        ] => Form::Ci(vec!["target/release/studies ", study]),
        ["cargo", "doc", ..] => Form::Ci(vec!["cargo doc --release --workspace --no-deps"]),
        ["cargo", "build", "--release"] => Form::Ci(vec!["cargo run --release"]),
        ["apt-get", "install", package] => Form::Ci(vec!["for tool in", package]),
        ["rustup", "target", "add", target] => Form::Ci(vec!["rustup target add", target]),
        _ => panic!("a command of a form that is not known here: {command}"),
    }
}

/// The command with something in its places, as small as it is run here.
fn meant(command: &str) -> String {
    let replaced = |command: String, (from, to): &(&str, &str)| command.replace(from, to);
    let command = PLACES.iter().fold(command.to_owned(), replaced);
    REDUCED.iter().fold(command, replaced)
}

/// Asserts that a package has these tests.
fn are_tests(command: &str) {
    let words: Vec<&str> = command.split(' ').collect();
    let after = |flag: &str| {
        let place = words.iter().position(|word| *word == flag);
        place.and_then(|place| words.get(place + 1))
    };
    let folder = match after("-p") {
        Some(&"eomgen-tests") => "tests",
        Some(&"eomgen-benches") => "benches",
        Some(&"eomgen-elementary") => "codegen/elementary",
        None => return,
        Some(package) => panic!("a package that is not known here: {package}"),
    };
    if let Some(name) = after("--test") {
        let tests = project().join(folder).join("tests");
        let files = [format!("{name}.rs"), format!("{name}/main.rs")];
        let exists = files.iter().any(|file| tests.join(file).exists());
        assert!(exists, "{command}: no test {name} in {}", tests.display());
    }
}

#[test]
fn every_printed_command_does_what_the_pages_say() {
    let folder = reader();
    let place = folder.file(".");
    let ci = std::fs::read_to_string(project().join(".ci/run")).expect(".ci/run");
    let (in_blocks, _) = in_blocks();
    assert!(in_blocks.len() > 20, "{in_blocks:#?}");
    let mut outputs: BTreeMap<String, String> = BTreeMap::new();
    let scipy = scipy();
    for Printed {
        page,
        command,
        output,
    } in in_text().into_iter().chain(in_blocks)
    {
        let meant = meant(&command);
        let mut once = |run: &dyn Fn() -> String| {
            let found = outputs.entry(meant.clone()).or_insert_with(run);
            shows(&output, found, &command);
        };
        match form(&meant) {
            Form::Program(arguments) => {
                let refused = output.first().is_some_and(|line| line.starts_with("error"));
                once(&|| said(arguments, &place, refused));
            }
            Form::Compilers => once(&|| compiled(&meant, &place)),
            Form::Scipy if !scipy => {}
            Form::Scipy => {
                let refused = output.iter().any(|line| line.starts_with("error"));
                once(&|| by_python(&meant, &place, refused));
            }
            Form::Elsewhere(file) => assert!(project().join(file).exists(), "{file}"),
            Form::Tests(command) => are_tests(command),
            Form::Ci(words) => {
                let line = |line: &str| words.iter().all(|word| line.contains(word));
                assert!(
                    ci.lines().any(line),
                    "{page}: .ci/run does not run {command}"
                );
            }
        }
    }
    for (left, kept) in FIGURES {
        let kept = std::fs::read(project().join(kept)).expect("a figure");
        let left = std::fs::read(folder.file(left)).expect("a figure");
        assert!(
            left == kept,
            "the figure of a page is not what its command leaves"
        );
    }
}

#[test]
fn what_is_shown_without_a_command_is_compared_elsewhere() {
    for block in in_blocks().1 {
        let known = SHOWN_ELSEWHERE
            .iter()
            .find(|(first, _)| block.lines[0] == *first);
        let (_, file) = known.unwrap_or_else(|| panic!("no command above: {block:#?}"));
        let kept = std::fs::read_to_string(project().join(file)).expect("the message as kept");
        // All but the place, which is that of another file.
        for line in block.lines.iter().take_while(|line| !line.contains("-->")) {
            assert!(kept.contains(line.trim()), "{line} is not in {file}");
        }
    }
}

#[test]
fn every_figure_of_the_pages_has_its_command() {
    let table = std::fs::read_to_string(project().join("docs/figures.md")).expect("a page");
    for entry in std::fs::read_dir(project().join("docs")).expect("docs") {
        let path = entry.expect("an entry").path();
        let name = path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        if name.ends_with(".svg") || name.ends_with(".png") {
            let row = table
                .lines()
                .find(|line| line.contains(&format!("`{name}`")));
            let row = row.unwrap_or_else(|| panic!("{name} is not in docs/figures.md"));
            assert!(row.contains("`cargo run --release -"), "{name}: {row}");
            let shown = pages()
                .iter()
                .any(|(_, text)| text.contains(&format!("{name})")));
            assert!(shown, "no page shows {name}");
        }
    }
}

#[test]
fn what_is_named_is_printed_somewhere() {
    let all: Vec<Printed> = in_text().into_iter().chain(in_blocks().0).collect();
    let printed = |text: &str| all.iter().any(|printed| printed.command.contains(text));
    for text in REDUCED
        .iter()
        .chain(&ELSEWHERE)
        .map(|(text, _)| text.trim())
    {
        assert!(printed(text), "no page prints {text}");
    }
    assert!(path("emps").exists() && path("pendulum").exists());
}
