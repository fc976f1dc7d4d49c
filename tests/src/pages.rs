//! Commands printed in README.md and docs/, with the output shown there.

use std::path::PathBuf;

use crate::models::project;

/// Command printed in a page.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PrintedCommand {
    /// Path of the page in the project's folder.
    pub page: String,
    /// Command on one line, without a comment after `#`.
    pub command: String,
    /// Lines shown below the command.
    pub output: Vec<String>,
}

/// Block of output without a command.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutputBlock {
    /// Path of the page in the project's folder.
    pub page: String,
    /// Lines of the block.
    pub lines: Vec<String>,
}

/// Returns the names and texts of README.md and all pages of docs/.
pub fn pages() -> Vec<(String, String)> {
    let docs = std::fs::read_dir(project().join("docs")).expect("docs");
    let docs = docs.map(|entry| entry.expect("an entry").path());
    let mut paths: Vec<PathBuf> = docs
        .filter(|path| path.extension().is_some_and(|end| end == "md"))
        .collect();
    paths.push(project().join("README.md"));
    paths.sort();
    let page = |path: PathBuf| {
        let name = path.strip_prefix(project()).expect("in the project");
        let text = std::fs::read_to_string(&path).expect("a page");
        (name.display().to_string(), text)
    };
    paths.into_iter().map(page).collect()
}

/// Returns all commands in console blocks, in the order of the page, and the blocks without a
/// command.
pub fn commands_in_blocks() -> (Vec<PrintedCommand>, Vec<OutputBlock>) {
    let (mut printed, mut loose) = (Vec::new(), Vec::new());
    for (page, text) in pages() {
        for block in text.split("```console\n").skip(1) {
            let block = block.split("```").next().unwrap_or_default();
            let lines: Vec<String> = block.lines().map(str::to_owned).collect();
            if !lines.iter().any(|line| line.starts_with("$ ")) {
                let page = page.clone();
                loose.push(OutputBlock { page, lines });
                continue;
            }
            assert!(lines[0].starts_with("$ "), "{page}: {block}");
            commands(&page, &lines, &mut printed);
        }
    }
    (printed, loose)
}

fn commands(page: &str, lines: &[String], printed: &mut Vec<PrintedCommand>) {
    let mut goes_on = false;
    for line in lines {
        let begun = line.strip_prefix("$ ");
        let text = begun.unwrap_or(line);
        let (text, more) = match text.strip_suffix('\\') {
            Some(text) if begun.is_some() || goes_on => (text, true),
            _ => (text, false),
        };
        let words = || {
            let words = text.split(" #").next().unwrap_or_default();
            words.split_whitespace().collect::<Vec<_>>().join(" ")
        };
        match printed.last_mut() {
            Some(last) if begun.is_none() && goes_on => {
                last.command = format!("{} {}", last.command, words());
            }
            Some(last) if begun.is_none() => last.output.push(line.clone()),
            _ => printed.push(PrintedCommand {
                page: page.to_owned(),
                command: words(),
                output: Vec::new(),
            }),
        }
        goes_on = more;
    }
}

/// Returns all commands in running text and tables.
pub fn commands_in_text() -> Vec<PrintedCommand> {
    let begins = ["cargo ", "rustc ", "EOMGEN_", "examples/bare_metal/"];
    let mut printed = Vec::new();
    for (page, text) in pages() {
        // Without the blocks, odd parts of the text are between single backticks.
        let prose: String = text.split("```").step_by(2).collect();
        for code in prose.split('`').skip(1).step_by(2) {
            let code = code.split_whitespace().collect::<Vec<_>>().join(" ");
            if begins.iter().any(|begin| code.starts_with(begin)) && code.split(' ').count() > 2 {
                printed.push(PrintedCommand {
                    page: page.clone(),
                    command: code,
                    output: Vec::new(),
                });
            }
        }
    }
    printed
}
