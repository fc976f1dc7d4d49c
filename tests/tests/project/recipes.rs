//! Tests of the recipes in docs/recipes/. The commands of each page run in a new folder with links to `examples` and
//! `model-spec`. Their output and the picture must equal the output and the picture on the page.
//!
//! The folder consists of links, and the commands need a Unix shell.

use std::path::Path;
use std::process::{Command, Output};

use eomgen_tests::models::project;
use eomgen_tests::pages::{commands_in_blocks_of, recipes};
use eomgen_tests::program::{self, text};
use tempfile::TempDir;

/// Returns a folder with links to the files that the pages name.
fn reader_folder() -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["examples", "model-spec"] {
        let link = std::os::unix::fs::symlink(project().join(name), folder.path().join(name));
        link.expect("a link");
    }
    folder
}

/// Runs a line of a page with `eomgen` in the search path.
fn run_line(line: &str, folder: &Path) -> Output {
    let program = program::path().parent().expect("the program's folder");
    let others = std::env::var_os("PATH").unwrap_or_default();
    let folders = std::iter::once(program.to_owned()).chain(std::env::split_paths(&others));
    Command::new("sh")
        .args(["-c", line])
        .current_dir(folder)
        .env("PATH", std::env::join_paths(folders).expect("a path"))
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .output()
        .expect("a shell")
}

/// Returns true if `lines` equal `shown`, in which `...` represents any number of lines.
fn matches(shown: &[&str], lines: &[&str]) -> bool {
    match shown {
        [] => lines.is_empty(),
        ["...", rest @ ..] => (0..=lines.len()).any(|from| matches(rest, &lines[from..])),
        [first, rest @ ..] => {
            lines.first().is_some_and(|line| line == first) && matches(rest, &lines[1..])
        }
    }
}

fn has_numpy_and_scipy() -> bool {
    let found = Command::new("python3")
        .args(["-c", "import numpy, scipy"])
        .output();
    found.is_ok_and(|output| output.status.success())
}

/// Returns true if a line needs Python packages that are not installed, and reports the skip.
fn lacks_packages(line: &str) -> bool {
    let Some(script) = line.strip_prefix("python3 ") else {
        return false;
    };
    let script = script.split(' ').next().unwrap_or_default();
    let script = std::fs::read_to_string(project().join(script)).expect("a script");
    let is_missing = script.contains("import numpy") && !has_numpy_and_scipy();
    if is_missing {
        skips::skip(&format!(
            "`{line}` of a recipe did not run: python3 with numpy and scipy is missing (pip install \
             scipy)"
        ));
    }
    is_missing
}

/// Runs the commands of a page in `folder` and compares their output.
fn assert_prints_shown_output(page: &(String, String), folder: &Path) {
    let (printed, loose) = commands_in_blocks_of(std::slice::from_ref(page));
    assert!(loose.is_empty(), "output without a command: {loose:#?}");
    assert!(printed.len() > 2, "{}: few commands", page.0);
    for printed in printed {
        let line = &printed.command;
        if lacks_packages(line) {
            continue;
        }
        let output = run_line(line, folder);
        let said = text(&output.stderr) + &text(&output.stdout);
        let is_rejected = printed.output.iter().any(|line| line.starts_with("error"));
        assert_eq!(
            output.status.success(),
            !is_rejected,
            "{}: {line}: {said}",
            page.0
        );
        let shown: Vec<&str> = printed.output.iter().map(|line| line.trim_end()).collect();
        let lines: Vec<&str> = said.lines().map(str::trim_end).collect();
        assert!(
            shown.is_empty() || matches(&shown, &lines),
            "{}: {line} prints\n{said}instead of\n{}",
            page.0,
            shown.join("\n")
        );
    }
}

/// Returns the page's name without folder and file extension.
fn stem(page: &str) -> &str {
    let path = Path::new(page);
    path.file_stem()
        .and_then(|name| name.to_str())
        .expect("a name")
}

/// Runs the commands of a page in a new folder; compares their output and the picture.
fn assert_page_is_reproduced(page: &(String, String)) {
    let folder = reader_folder();
    assert_prints_shown_output(page, folder.path());
    let picture = format!("{}.svg", stem(&page.0));
    let written = std::fs::read(folder.path().join(&picture));
    let written = written.unwrap_or_else(|_| panic!("{}: no {picture}", page.0));
    let kept = std::fs::read(project().join("docs/recipes").join(&picture));
    assert!(
        kept.expect("the picture of a page") == written,
        "docs/recipes/{picture} differs from that of the page's command"
    );
}

#[test]
fn commands_of_recipes_give_the_shown_output_and_picture() {
    let recipes = recipes();
    assert!(!recipes.is_empty());
    std::thread::scope(|scope| {
        for page in &recipes {
            scope.spawn(|| assert_page_is_reproduced(page));
        }
    });
}

/// Returns the files of the project that a page names.
fn named_files(page: &str) -> Vec<String> {
    let is_part = |c: char| c.is_ascii_alphanumeric() || "._-/".contains(c);
    let mut names: Vec<&str> = page.split(|c| !is_part(c)).collect();
    names.sort_unstable();
    names.dedup();
    names
        .into_iter()
        .filter(|name| name.starts_with("examples/") || name.starts_with("model-spec/"))
        .filter_map(|name| std::fs::read_to_string(project().join(name)).ok())
        .collect()
}

#[test]
fn files_shown_in_recipes_match_the_project() {
    for (name, page) in recipes() {
        let files = named_files(&page);
        for block in page.split("\n```").skip(1).step_by(2) {
            let (language, shown) = block.split_once('\n').unwrap_or_default();
            if language == "console" {
                continue;
            }
            // A page may show parts of a file, in the order of the file.
            let is_shown_from = |file: &String| {
                let mut rest = file.as_str();
                shown.split("\n\n").all(|part| {
                    let place = rest.find(part.trim_end());
                    place.inspect(|place| rest = &rest[*place..]).is_some()
                })
            };
            assert!(
                files.iter().any(is_shown_from),
                "{name}: no file that the page names contains\n{shown}"
            );
        }
    }
}
