//! Tests of the commands in README.md and docs/. The commands of a page run in order in one folder, with the files that
//! the reader of the page must save. Their output and the pictures that they write ([`pictures`]) must match the page.
//! Other commands must be in `.ci/run`. A command of an unknown form fails the test.
//!
//! The folders consist of links, and the commands need a Unix shell.
#![cfg(unix)]

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use eomgen_tests::measured::Measured;
use eomgen_tests::models::{path, project};
use eomgen_tests::pages::{
    PrintedCommand, blocks, commands_in_blocks_of, commands_in_text_of, inline_code, is_recipe,
    saved_files,
};
use eomgen_tests::program::{self, text};

use super::pictures;

const TIMEOUT: Duration = Duration::from_secs(300);

/// Number of pages whose commands run in parallel.
const THREADS: usize = 2;

/// Replacements that shorten long-running commands.
const REDUCED: [(&str, &str); 2] = [
    (
        "--vary b_sp,b_pr=0:100e-6:40 --vary omega=10:60:40",
        "--vary b_sp,b_pr=0:100e-6:3 --vary omega=10:60:2",
    ),
    (
        "--vary b_sp,b_pr=0:100e-6:50 --vary omega=10:60:50",
        "--vary b_sp,b_pr=0:100e-6:3 --vary omega=10:60:2",
    ),
];

/// Commands that another test runs, with the file of the test.
const TESTED_ELSEWHERE: [(&str, &str); 23] = [
    // The test compiles an image with two variants and lists them.
    (
        "cargo run --release -- identify firmware.elf ",
        "tests/tests/emission/families.rs",
    ),
    // `generate --all --check` compares the variants of the same file.
    (
        "cargo run --release -- family generated/family.toml ",
        "tests/tests/emission/checked_in_variants.rs",
    ),
    (
        "cargo install --path cli",
        "tests/tests/project/installed.rs",
    ),
    // The test builds and runs them if `nvcc` is installed.
    ("examples/cuda/build ", "tests/tests/hosts/cuda/mod.rs"),
    ("examples/cuda/arms_double", "tests/tests/hosts/cuda/mod.rs"),
    // The README of the package contains the same commands.
    ("python3 -m venv .venv", "tests/tests/hosts/python.rs"),
    ("pip install ./python", "tests/tests/hosts/python.rs"),
    // The test runs the script if MuJoCo is installed.
    (
        "python3 examples/measured/identify.py",
        "tests/tests/hosts/mujoco.rs",
    ),
    // The test checks the dependencies that this command adds.
    ("cargo add eomgen", "tests/tests/project/packages.rs"),
    // The test builds and runs the benchmark of a small machine.
    (
        "cd emps && cargo bench -- --",
        "tests/tests/emission/bench_of_a_model.rs",
    ),
    // The test runs searches of one set and compares the assumed values with docs/claims.json.
    (
        "cargo run --release -- paper claims ",
        "tests/tests/paper/study_search.rs",
    ),
    // The test bounds several machines and compares with the emulator.
    (
        "cargo run --release -- instructions ",
        "tests/tests/emission/instruction_bounds.rs",
    ),
    // The test runs all four studies.
    (
        "cargo run --release -- paper study ",
        "tests/tests/paper/study.rs",
    ),
    // The test runs the script with the currently emitted arm.
    (
        "examples/bare_metal/run rig4/lib.rs",
        "tests/tests/emission/bare_metal.rs",
    ),
    // The test runs the script for three machines and compares its output.
    (
        "examples/bare_metal/count puma",
        "tests/tests/emission/bare_metal.rs",
    ),
    // The test runs the script and compares its output.
    (
        "examples/bare_metal/observe rig4_jacobians/lib.rs",
        "tests/tests/emission/bare_metal.rs",
    ),
    // The test runs the script with the currently emitted loop.
    (
        "examples/closed_loop/run emitted motion.csv",
        "tests/tests/emission/closed_loop.rs",
    ),
    // The test runs six cases of the suite.
    (
        "cargo run --release -p eomgen-blind -- ",
        "tests/tests/discovery/blind.rs",
    ),
    // The test checks counts and figures against the record; timing needs an idle machine.
    (
        "cargo run --release -p eomgen-benches --bin history",
        "benches/tests/benches/instructions.rs",
    ),
    // The test compiles and compares the emitted C; timing needs an idle machine.
    (
        "cargo run --release -p eomgen-benches --bin c99",
        "tests/tests/hosts/c99/mod.rs",
    ),
    // The test counts operations of the same specifications; timing needs an idle machine.
    (
        "cargo run --release -p eomgen-benches --bin rigid_trees",
        "benches/tests/benches/rigid_trees.rs",
    ),
    // The test uses fewer models by default.
    (
        "EOMGEN_SMOOTH_MODELS=300 ",
        "tests/tests/equations/smooth_models.rs",
    ),
    // The same test runs without rewriting its recorded results.
    (
        "EOMGEN_REFRESH=1 cargo test ",
        "benches/tests/benches/instructions.rs",
    ),
];

/// Output shown without a command, and the file of the test that compares it.
const SHOWN_ELSEWHERE: [(&str, &str); 1] = [(
    // Compiler error for a mistake in a macro.
    "error: unknown name `thta`",
    "tests/macro_errors/errors/misspelt_name.stderr",
)];

/// Commands that work from the first release on.
const AFTER_RELEASE: [&str; 2] = ["cargo binstall eomgen-cli", "pip install eomgen"];

/// Pages whose commands run in a new empty folder.
const IN_EMPTY_FOLDER: [&str; 1] = ["docs/first_machine.md"];

/// Placeholders in commands, and their replacements.
const PLACEHOLDERS: [(&str, &str); 3] = [
    ("SPEC ", "model-spec/models/emps.toml "),
    ("DATASET.toml", "dataset.toml"),
    ("NAME.toml", "pendulum.toml"),
];

/// Specification with the error that the pages show in line 16.
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

/// Specification with the misspelling that the pages show in line 19.
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

/// Specification with the cycle of definitions that the pages show in lines 4 and 5.
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

/// Returns the folder of a reader who has saved the files of a page. Unless the page begins in an empty folder, the
/// folder also has links to the project, records, and the specifications that several pages name.
fn reader_folder(page: &str, text: &str) -> Measured {
    // Records of a stage with dry friction, for `compare` and `discover`.
    let measured = match IN_EMPTY_FOLDER.contains(&page) {
        true => Measured::empty(),
        false => folder_with_project(),
    };
    for (name, text) in saved_files(text) {
        measured.write(name, text.as_bytes());
    }
    measured
}

fn folder_with_project() -> Measured {
    let measured = Measured::stage(3.0);
    let language = std::fs::read_to_string(project().join("docs/specification.md"));
    let language = language.expect("a page");
    let specification = blocks(&language, "toml").next().expect("a specification");
    for name in ["driven_pendulum.toml", "my_machine.toml"] {
        measured.write(name, specification.as_bytes());
    }
    for (name, text) in [("wrong", WRONG), ("misspelt", MISSPELT), ("circle", CIRCLE)] {
        measured.write(&format!("{name}.toml"), text.as_bytes());
    }
    for folder in ["model-spec", "examples", "generated"] {
        let link = std::os::unix::fs::symlink(project().join(folder), measured.file(folder));
        link.expect("a link");
    }
    measured
}

/// Splits a command into words, which may be in quotes.
fn words(command: &str) -> Vec<String> {
    let (mut words, mut quote) = (vec![String::new()], None);
    for letter in command.chars() {
        match (quote, letter) {
            (Some(open), _) if open == letter => quote = None,
            (None, '\'' | '"') => quote = Some(letter),
            (None, ' ') => words.push(String::new()),
            _ => words.last_mut().expect("a word").push(letter),
        }
    }
    assert!(quote.is_none(), "an open quote: {command}");
    words
}

/// Runs a command of the program; returns its stdout and stderr. If `refused`, it must exit with an error status.
fn run_program(arguments: &str, folder: &Path, refused: bool) -> String {
    let output = assert_cmd::Command::new(program::path())
        .args(words(arguments))
        .current_dir(folder)
        .timeout(TIMEOUT)
        .output()
        .expect("the program can be run");
    let said = text(&output.stderr) + &text(&output.stdout);
    let expected = if refused { 2 } else { 0 };
    assert_eq!(output.status.code(), Some(expected), "{arguments}: {said}");
    said
}

/// Runs a shell line with compilers, compiled programs and `cat`; returns the output.
fn run_compilers(line: &str, folder: &Path) -> String {
    let output = Command::new("sh")
        .args(["-c", line])
        .current_dir(folder)
        .output();
    let output = output.expect("a shell");
    assert!(output.status.success(), "{line}: {}", text(&output.stderr));
    text(&output.stdout)
}

fn has_scipy() -> bool {
    let found = Command::new("python3")
        .args(["-c", "import numpy, scipy"])
        .output();
    let there = found.is_ok_and(|output| output.status.success());
    if !there {
        skips::skip(
            "the regulator of docs/controllers.md was not computed: python3 with \
             numpy and scipy is missing (pip install scipy)",
        );
    }
    there
}

/// Returns true if a command runs a Python script that imports NumPy.
fn needs_packages(command: &str) -> bool {
    let script = command.split(' ').nth(1).unwrap_or_default();
    let script = std::fs::read_to_string(project().join(script));
    script.is_ok_and(|script| script.contains("import numpy"))
}

/// Runs a Python example; returns its stdout and stderr. If `refused`, it must exit with status 1.
fn run_python(line: &str, folder: &Path, refused: bool) -> String {
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

/// Removes the parts of a line that vary between runs or machines: durations and rounding errors of checks.
fn without_variable_parts(line: &str) -> String {
    if line.starts_with("  passed ") {
        return line.split(" (").next().unwrap_or(line).to_owned();
    }
    match line.split_once(" passed ") {
        Some((check, _)) => format!("{} passed", check.trim_end()),
        None => line.trim_end().to_owned(),
    }
}

/// Asserts that the output contains the shown lines in order, with gaps only at `...`.
fn assert_shows(shown: &[String], output: &str, command: &str) {
    let lines: Vec<String> = output.lines().map(without_variable_parts).collect();
    let mut from = 0;
    for part in shown.split(|line| line.trim() == "...") {
        let part: Vec<String> = part
            .iter()
            .map(|line| without_variable_parts(line))
            .collect();
        let place = (from..=lines.len()).find(|start| lines[*start..].starts_with(&part));
        let place =
            place.unwrap_or_else(|| panic!("{command} does not print {part:#?}:\n{output}"));
        from = place + part.len();
    }
}

/// Form of a printed command.
enum Form<'a> {
    Program(&'a str),
    /// Shell line with compilers, compiled programs or `cat`.
    Compilers,
    /// Python example, which may need SciPy.
    Scipy,
    /// Command of [`AFTER_RELEASE`].
    AfterRelease,
    /// Command listed in the constants above.
    Elsewhere(&'static str),
    /// Tests of a package, or of one file of its tests, which the full test run includes.
    Tests(&'a str),
    /// Command whose words must be in `.ci/run`.
    Ci(Vec<&'a str>),
}

fn form(command: &str) -> Form<'_> {
    let words: Vec<&str> = command.split(' ').collect();
    if AFTER_RELEASE.contains(&command) {
        return Form::AfterRelease;
    }
    if let Some((_, file)) = TESTED_ELSEWHERE
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
        ["rustc" | "cc" | "cat", ..] => Form::Compilers,
        ["python3", ..] => Form::Scipy,
        ["cargo", "test", "--release", ref rest @ ..] => match rest {
            ["--workspace"] => Form::Tests(""),
            ["-p", _, ..] => Form::Tests(command),
            _ => panic!("unknown form of a test command: {command}"),
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
        ["cargo", "build", "--release", "-p", ..] => {
            Form::Ci(vec!["cargo build --release -p eomgen-cli -p eomgen-python"])
        }
        ["cargo", "build", "--release"] => Form::Ci(vec!["cargo run --release"]),
        ["apt-get", "install", package] => Form::Ci(vec!["for tool in", package]),
        ["rustup", "target", "add", target] => Form::Ci(vec!["rustup target add", target]),
        _ => panic!("unknown form of a command: {command}"),
    }
}

/// Returns the command with replaced placeholders and shortened arguments.
fn runnable_command(command: &str) -> String {
    let replaced = |command: String, (from, to): &(&str, &str)| command.replace(from, to);
    let command = PLACEHOLDERS.iter().fold(command.to_owned(), replaced);
    REDUCED.iter().fold(command, replaced)
}

fn assert_are_tests(command: &str) {
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
        Some(package) => panic!("unknown package: {package}"),
    };
    if let Some(name) = after("--test") {
        let tests = project().join(folder).join("tests");
        let files = [format!("{name}.rs"), format!("{name}/main.rs")];
        let exists = files.iter().any(|file| tests.join(file).exists());
        assert!(exists, "{command}: no test {name} in {}", tests.display());
    }
}

/// Returns the names and texts of all pages except docs/recipes/, which have a separate test.
fn pages() -> Vec<(String, String)> {
    let mut pages = eomgen_tests::pages::pages();
    pages.retain(|(page, _)| !is_recipe(page));
    pages
}

/// Runs the commands of a page.
struct PageRun<'a> {
    folder: Measured,
    ci: &'a str,
    has_scipy: bool,
    /// Outputs of the commands that were run.
    outputs: BTreeMap<String, String>,
}

impl PageRun<'_> {
    fn run(&mut self, printed: &PrintedCommand) {
        let PrintedCommand {
            page,
            command,
            output,
        } = printed;
        let meant = runnable_command(command);
        let place = self.folder.file(".");
        let mut once = |run: &dyn Fn() -> String| {
            let found = self.outputs.entry(meant.clone()).or_insert_with(run);
            assert_shows(output, found, command);
        };
        match form(&meant) {
            Form::Program(arguments) => {
                let refused = output.first().is_some_and(|line| line.starts_with("error"));
                once(&|| run_program(arguments, &place, refused));
            }
            Form::Compilers => once(&|| run_compilers(&meant, &place)),
            Form::Scipy if !self.has_scipy && needs_packages(&meant) => {}
            Form::Scipy => {
                let refused = output.iter().any(|line| line.starts_with("error"));
                once(&|| run_python(&meant, &place, refused));
            }
            Form::AfterRelease => {}
            Form::Elsewhere(file) => assert!(project().join(file).exists(), "{file}"),
            Form::Tests(command) => assert_are_tests(command),
            Form::Ci(words) => {
                let line = |line: &str| words.iter().all(|word| line.contains(word));
                assert!(
                    self.ci.lines().any(line),
                    "{page}: .ci/run does not run {command}"
                );
            }
        }
    }
}

#[test]
fn printed_commands_give_the_printed_output() {
    let ci = std::fs::read_to_string(project().join(".ci/run")).expect(".ci/run");
    let has_scipy = has_scipy();
    let pages = pages();
    let in_text = commands_in_text_of(&pages);
    let (in_blocks, _) = commands_in_blocks_of(&pages);
    assert!(in_blocks.len() > 20, "{in_blocks:#?}");
    let next = AtomicUsize::new(0);
    let run_pages = || {
        let mut compared = Vec::new();
        while let Some((page, text)) = pages.get(next.fetch_add(1, Ordering::Relaxed)) {
            let printed = in_text.iter().chain(&in_blocks);
            let printed: Vec<_> = printed.filter(|printed| printed.page == *page).collect();
            if printed.is_empty() {
                continue;
            }
            let mut run = PageRun {
                folder: reader_folder(page, text),
                ci: &ci,
                has_scipy,
                outputs: BTreeMap::new(),
            };
            for printed in printed {
                run.run(printed);
            }
            compared.extend(pictures::assert_match(page, text, &run.folder.file(".")));
        }
        compared
    };
    let compared: Vec<String> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..THREADS).map(|_| scope.spawn(run_pages)).collect();
        let compared = threads.into_iter().map(|thread| match thread.join() {
            Ok(compared) => compared,
            Err(panic) => std::panic::resume_unwind(panic),
        });
        compared.flatten().collect()
    });
    pictures::assert_all_compared(&compared);
}

/// Commands with placeholders, in running text and in blocks of text, are not run. Their names and options must be
/// listed by `--help`.
#[test]
fn commands_in_running_text_exist() {
    let mut helps: BTreeMap<Vec<String>, String> = BTreeMap::new();
    let mut checked = 0;
    for (page, text) in eomgen_tests::pages::pages() {
        let shown = blocks(&text, "text").flat_map(str::lines);
        let shown = shown.filter_map(|line| line.strip_prefix("$ ").map(str::to_owned));
        for code in inline_code(&text).into_iter().chain(shown) {
            let Some(arguments) = code.strip_prefix("eomgen ") else {
                continue;
            };
            let arguments = words(arguments);
            let length = if arguments[0] == "paper" { 2 } else { 1 };
            let command = arguments[..length.min(arguments.len())].to_vec();
            if command[0].starts_with('-') || command[0] == "COMMAND" {
                continue;
            }
            let help = helps.entry(command).or_insert_with_key(|command| {
                let arguments = format!("{} --help", command.join(" "));
                run_program(&arguments, project(), false)
            });
            for option in arguments.iter().filter(|word| word.starts_with("--")) {
                let is_option = help
                    .split_whitespace()
                    .any(|word| word.trim_end_matches(',') == option);
                assert!(is_option, "{page}: {code}: unknown option {option}");
            }
            checked += 1;
        }
    }
    assert!(checked > 10, "{checked}");
}

#[test]
fn commands_page_lists_every_command() {
    let page = std::fs::read_to_string(project().join("docs/commands.md")).expect("a page");
    let help = run_program("--help", project(), false);
    let (_, commands) = help.split_once("Commands:\n").expect("commands");
    let (commands, _) = commands.split_once("\n\n").expect("their end");
    // Longer descriptions continue in further lines with larger indentation.
    let names = commands
        .lines()
        .filter_map(|line| line.strip_prefix("  "))
        .filter(|line| !line.starts_with(' '))
        .filter_map(|line| line.split(' ').next())
        .filter(|name| *name != "help");
    let names: Vec<&str> = names.collect();
    assert!(names.len() > 15, "{names:?}");
    for name in names {
        let row = format!("\n| `{name}");
        assert!(page.contains(&row), "docs/commands.md does not list {name}");
    }
}

#[test]
fn commands_that_need_a_release_are_marked() {
    for command in AFTER_RELEASE {
        let pages: Vec<(String, String)> = pages()
            .into_iter()
            .filter(|(_, text)| text.contains(&format!("`{command}`")))
            .collect();
        let [(page, text)] = &pages[..] else {
            panic!("{command} is on {} pages", pages.len());
        };
        let mut paragraphs = text.split("\n\n").filter(|text| text.contains(command));
        assert!(
            paragraphs.all(|text| text.contains("From the first release on")),
            "{page}: {command}"
        );
    }
}

#[test]
fn output_without_command_is_compared_in_another_test() {
    for block in commands_in_blocks_of(&pages()).1 {
        let known = SHOWN_ELSEWHERE
            .iter()
            .find(|(first, _)| block.lines[0] == *first);
        let (_, file) = known.unwrap_or_else(|| panic!("output without a command: {block:#?}"));
        let kept = std::fs::read_to_string(project().join(file)).expect("the recorded message");
        // The location refers to another file, so it is not compared.
        for line in block.lines.iter().take_while(|line| !line.contains("-->")) {
            assert!(kept.contains(line.trim()), "{line} is not in {file}");
        }
    }
}

#[test]
fn listed_commands_occur_in_the_pages() {
    let pages = pages();
    let mut all = commands_in_text_of(&pages);
    all.extend(commands_in_blocks_of(&pages).0);
    let printed = |text: &str| all.iter().any(|printed| printed.command.contains(text));
    for text in REDUCED
        .iter()
        .chain(&TESTED_ELSEWHERE)
        .map(|(text, _)| text.trim())
    {
        assert!(printed(text), "no page prints {text}");
    }
    assert!(path("emps").exists() && path("pendulum").exists());
}
