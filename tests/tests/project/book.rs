//! Tests of the documentation: README.md is short, docs/ is a complete book for mdBook, links have existing targets,
//! and snippets of specifications are valid.

use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};

use eomgen_model_spec::source::Source;
use eomgen_tests::models::project;
use eomgen_tests::pages::{anchors, blocks, links, pages};

/// Maximum number of lines of README.md.
const MAX_LINES: usize = 200;
const MAX_WORDS: usize = 1800;

/// Pages outside docs/ whose links are also checked.
const FURTHER_PAGES: [&str; 4] = [
    "CHANGELOG.md",
    "CONTRIBUTING.md",
    "SECURITY.md",
    "python/README.md",
];

const SUMMARY: &str = "docs/SUMMARY.md";

fn read(name: &str) -> String {
    std::fs::read_to_string(project().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Returns the target of a link on a page, relative to the project's folder.
fn target_path(page: &str, target: &str) -> PathBuf {
    let folder = Path::new(page).parent().expect("a folder");
    let mut path = PathBuf::new();
    for component in folder.join(target).components() {
        match component {
            Component::ParentDir => assert!(path.pop(), "{page}: {target}"),
            other => path.push(other),
        }
    }
    path
}

#[test]
fn readme_is_short() {
    let readme = read("README.md");
    let (lines, words) = (readme.lines().count(), readme.split_whitespace().count());
    assert!(lines <= MAX_LINES, "{lines} lines");
    assert!(words <= MAX_WORDS, "{words} words");
}

#[test]
fn summary_lists_every_page_once() {
    let summary = links(&read(SUMMARY)).into_iter();
    let mut listed: Vec<PathBuf> = summary
        .map(|(link, _)| target_path(SUMMARY, &link))
        .collect();
    let pages = pages().into_iter().map(|(page, _)| PathBuf::from(page));
    let mut pages: Vec<PathBuf> = pages
        .filter(|page| page.starts_with("docs") && page != Path::new(SUMMARY))
        .collect();
    listed.sort();
    pages.sort();
    assert_eq!(listed, pages);
    let book: toml_edit::DocumentMut = read("book.toml").parse().expect("TOML");
    assert_eq!(book["book"]["src"].as_str(), Some("docs"));
}

#[test]
fn links_lead_to_existing_targets() {
    let further = FURTHER_PAGES.map(|page| (page.to_owned(), read(page)));
    let pages: BTreeMap<String, String> = pages().into_iter().chain(further).collect();
    let mut wrong = Vec::new();
    for (page, text) in &pages {
        for (link, _) in links(text) {
            if link.starts_with("https://") {
                continue;
            }
            let (file, anchor) = link.split_once('#').unwrap_or((&link, ""));
            let path = match file {
                "" => PathBuf::from(page),
                file => target_path(page, file),
            };
            let name = path.display().to_string();
            let has_anchor = || match pages.get(&name) {
                Some(text) => anchors(text).iter().any(|own| own == anchor),
                None => false,
            };
            if !project().join(&path).exists() || !(anchor.is_empty() || has_anchor()) {
                wrong.push(format!("{page}: {link}"));
            }
            // A link to a page outside the book would have no HTML target.
            let is_page = path.extension().is_some_and(|end| end == "md");
            if page.starts_with("docs/") && is_page && !path.starts_with("docs") {
                wrong.push(format!("{page}: {link} is outside the book"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Complete specifications on the pages must be valid; parts of specifications and other files must be TOML.
#[test]
fn toml_on_the_pages_is_valid() {
    let mut specifications = 0;
    for (page, text) in pages() {
        for block in blocks(&text, "toml") {
            let parsed = block.parse::<toml_edit::DocumentMut>();
            let document = parsed.unwrap_or_else(|error| panic!("{page}: {error}\n{block}"));
            let is_whole = |section| document.contains_key(section);
            if !["model", "parameters", "coordinates"]
                .into_iter()
                .all(is_whole)
            {
                continue;
            }
            specifications += 1;
            let source = Source::new(&page, block.to_owned());
            if let Err(error) = eomgen_model_spec::check(source) {
                panic!("{page}: {error:?}\n{block}");
            }
        }
    }
    assert!(specifications >= 3, "{specifications}");
}

/// The table of times repeats numbers of other pages and names commands that these pages contain.
#[test]
fn times_in_readme_match_the_book() {
    let readme = read("README.md");
    let (_, section) = readme.split_once("## Speed").expect("a section");
    let section = section.split("\n## ").next().unwrap_or_default();
    let book = ["docs/performance.md", "docs/embedding.md"]
        .map(read)
        .concat();
    let rows: Vec<Vec<&str>> = section
        .lines()
        .filter(|line| line.starts_with("| "))
        .skip(2)
        .map(|line| line.split('|').map(str::trim).collect())
        .collect();
    assert!(rows.len() >= 4, "{rows:?}");
    for row in rows {
        let time = row[2].split(' ').next().unwrap_or_default();
        let is_in_the_book = |number: &str| {
            let cells = book.split(['|', ' ']).map(str::trim);
            cells.into_iter().any(|cell| cell == number)
        };
        assert!(is_in_the_book(time), "{time}");
        let command = row[5].trim_matches('`');
        assert!(
            command == "as for 4 modes" || book.contains(command),
            "{command}"
        );
    }
}
