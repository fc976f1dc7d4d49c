//! README.md and the pages of docs/: commands with their printed output, files that the reader saves, links and
//! pictures.

use std::path::{Path, PathBuf};

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

/// Returns the names and texts of README.md and all pages of docs/, in alphabetical order.
pub fn pages() -> Vec<(String, String)> {
    let mut paths = files_in(&project().join("docs"));
    paths.retain(|path| path.extension().is_some_and(|end| end == "md"));
    paths.push(project().join("README.md"));
    paths.sort();
    let page = |path: PathBuf| {
        let text = std::fs::read_to_string(&path).expect("a page");
        (name_in_project(&path), text)
    };
    paths.into_iter().map(page).collect()
}

/// Returns the names and texts of all pages of docs/recipes/.
pub fn recipes() -> Vec<(String, String)> {
    let mut pages = pages();
    pages.retain(|(page, _)| is_recipe(page));
    pages
}

/// Returns true if a page or a picture belongs to a recipe.
pub fn is_recipe(name: &str) -> bool {
    name.starts_with("docs/recipes/")
}

/// Returns the path of a file relative to the project's folder.
pub fn name_in_project(path: &Path) -> String {
    let name = path.strip_prefix(project()).expect("in the project");
    name.display().to_string()
}

/// Returns all files below a folder. Symbolic links are not followed.
pub fn files_in(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_symlink() {
            continue;
        }
        if path.is_dir() {
            files.extend(files_in(&path));
        } else {
            files.push(path);
        }
    }
    files
}

/// Returns the texts of the fenced blocks in a language.
pub fn blocks<'a>(text: &'a str, language: &'a str) -> impl Iterator<Item = &'a str> {
    let fenced = fenced_blocks(text).into_iter();
    fenced.filter_map(move |block| (block.language == language).then_some(block.text))
}

/// Returns the names and texts of the files that the reader of a page must save: blocks below a
/// paragraph with "Save this ... as `NAME`".
pub fn saved_files(text: &str) -> Vec<(&str, &str)> {
    fn file<'a>(block: FencedBlock<'a>) -> Option<(&'a str, &'a str)> {
        let paragraph = block.before.trim_end().rsplit("\n\n").next()?;
        let (_, request) = paragraph.split_once("Save this ")?;
        let (_, name) = request.split_once("as `")?;
        Some((name.split('`').next()?, block.text))
    }
    fenced_blocks(text).into_iter().filter_map(file).collect()
}

/// Returns the targets of all links and pictures outside code. The flag marks pictures.
pub fn links(text: &str) -> Vec<(String, bool)> {
    let mut found = Vec::new();
    for prose in text.split("```").step_by(2) {
        let prose: String = prose.split('`').step_by(2).collect::<Vec<_>>().join("`");
        let mut rest = prose.as_str();
        while let Some(place) = rest.find("](") {
            let label = rest[..place].rfind('[').unwrap_or_default();
            let is_picture = rest[..label].ends_with('!');
            rest = &rest[place + 2..];
            let target = rest.split(')').next().unwrap_or_default();
            found.push((target.to_owned(), is_picture));
        }
    }
    found
}

/// Returns the anchors of a page's headings, as browsers and editors derive them.
pub fn anchors(text: &str) -> Vec<String> {
    let outside: String = text.split("```").step_by(2).collect();
    let headings = outside.lines().filter(|line| line.starts_with('#'));
    let anchor = |line: &str| {
        let title = line.trim_start_matches('#').trim().to_lowercase();
        let kept = title.chars().filter_map(|letter| match letter {
            ' ' => Some('-'),
            letter if letter.is_alphanumeric() || "-_".contains(letter) => Some(letter),
            _ => None,
        });
        kept.collect()
    };
    headings.map(anchor).collect()
}

/// Fenced block of a page.
struct FencedBlock<'a> {
    /// Text of the page before the block.
    before: &'a str,
    language: &'a str,
    text: &'a str,
}

fn fenced_blocks(page: &str) -> Vec<FencedBlock<'_>> {
    const FENCE: &str = "```";
    let mut blocks = Vec::new();
    let mut from = 0;
    while let Some(begin) = page[from..].find(FENCE).map(|place| from + place) {
        let opened = &page[begin + FENCE.len()..];
        let (language, text) = opened.split_once('\n').unwrap_or((opened, ""));
        let (text, _) = text.split_once(FENCE).unwrap_or((text, ""));
        let start = begin + FENCE.len() + language.len() + 1;
        blocks.push(FencedBlock {
            before: &page[..begin],
            language,
            text,
        });
        from = (start + text.len() + FENCE.len()).min(page.len());
    }
    blocks
}

/// Returns all commands in console blocks of `pages` in order, and the blocks without a command.
pub fn commands_in_blocks_of(
    pages: &[(String, String)],
) -> (Vec<PrintedCommand>, Vec<OutputBlock>) {
    let (mut printed, mut loose) = (Vec::new(), Vec::new());
    for (page, text) in pages {
        for block in blocks(text, "console") {
            let lines: Vec<String> = block.lines().map(str::to_owned).collect();
            if !lines.iter().any(|line| line.starts_with("$ ")) {
                let page = page.clone();
                loose.push(OutputBlock { page, lines });
                continue;
            }
            assert!(lines[0].starts_with("$ "), "{page}: {block}");
            commands(page, &lines, &mut printed);
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

/// Returns all commands in running text and tables of `pages`.
pub fn commands_in_text_of(pages: &[(String, String)]) -> Vec<PrintedCommand> {
    let begins = ["cargo ", "rustc ", "EOMGEN_", "examples/bare_metal/"];
    let mut printed = Vec::new();
    for (page, text) in pages {
        for code in inline_code(text) {
            let is_prefix = code.ends_with(" --");
            let is_command = begins.iter().any(|begin| code.starts_with(begin)) && !is_prefix;
            if is_command && code.split(' ').count() > 2 {
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

/// Returns the code in running text and tables, with single spaces between words.
pub fn inline_code(text: &str) -> Vec<String> {
    // After the fenced blocks are removed, every second part of the text is between single backticks.
    let prose: String = text.split("```").step_by(2).collect();
    let code = prose.split('`').skip(1).step_by(2);
    code.map(|code| code.split_whitespace().collect::<Vec<_>>().join(" "))
        .collect()
}
