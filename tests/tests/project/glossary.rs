//! Test that retired words of `docs/glossary.md` are not used.

use std::path::{Path, PathBuf};

use eomgen_tests::models::project;

/// Folders whose comments may still contain retired words.
const EXCEPTIONS: [&str; 2] = ["discover", "sim/src"];

/// Returns the retired phrases of two or more words. Rows with a remark in parentheses are skipped, because they retire
/// a word in one sense only.
fn retired_phrases(glossary: &str) -> Vec<String> {
    let (_, table) = glossary
        .split_once("## Retired words")
        .expect("a section on retired words");
    let rows = table.lines().filter_map(|line| line.strip_prefix("| "));
    let cells = rows.filter_map(|row| row.split_once(" | ").map(|(retired, _)| retired));
    cells
        .filter(|cell| !cell.contains(['(', '`']))
        .flat_map(|cell| cell.split(", "))
        .filter(|phrase| phrase.contains(' '))
        .map(str::to_lowercase)
        .collect()
}

/// Collects Markdown and Rust files below a folder.
fn collect_files(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder").flatten() {
        let path = entry.path();
        let name = entry.file_name();
        let is_skipped = ["target", "generated", ".git", ".venv"]
            .iter()
            .any(|skipped| name == *skipped);
        if path.is_dir() && !path.is_symlink() && !is_skipped {
            collect_files(&path, files);
        } else if path
            .extension()
            .is_some_and(|kind| kind == "md" || kind == "rs")
        {
            files.push(path);
        }
    }
}

/// Returns the prose of a file in lower case on one line: the whole text of Markdown, or the comments of Rust.
fn prose(path: &Path) -> String {
    let text = std::fs::read_to_string(path).expect("a file");
    let is_rust = path.extension().is_some_and(|kind| kind == "rs");
    let text = match path.ends_with("docs/glossary.md") {
        true => text.split("## Retired words").next().unwrap_or_default(),
        false => &text,
    };
    let lines = text.lines().map(str::trim);
    let lines: Vec<&str> = lines
        .filter(|line| !is_rust || line.starts_with("//"))
        .map(|line| line.trim_start_matches(['/', '!', ' ']))
        .collect();
    lines.join(" ").to_lowercase()
}

#[test]
fn retired_phrases_are_in_no_page_and_no_comment() {
    let glossary = std::fs::read_to_string(project().join("docs/glossary.md")).expect("a glossary");
    let phrases = retired_phrases(&glossary);
    assert!(phrases.len() > 10, "{phrases:?}");
    let mut files = Vec::new();
    collect_files(project(), &mut files);
    let mut found = Vec::new();
    for file in files {
        let name = file.strip_prefix(project()).expect("a project file");
        if EXCEPTIONS.iter().any(|folder| name.starts_with(folder)) {
            continue;
        }
        let text = prose(&file);
        for phrase in &phrases {
            if text.contains(phrase.as_str()) {
                found.push(format!("{}: {phrase}", name.display()));
            }
        }
    }
    assert!(
        found.is_empty(),
        "retired in docs/glossary.md:\n{}",
        found.join("\n")
    );
}
