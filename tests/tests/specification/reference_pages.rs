//! Test that the tables of sections and keys in the documentation match the tables of the parsers. `EOMGEN_BLESS=1
//! cargo test -p eomgen-tests --test specification reference_pages` rewrites them.

use eomgen_model_spec::keys::{Key, Keys, Kind};
use eomgen_model_spec::schema::kinds;
use eomgen_model_spec::sections::SECTIONS;
use eomgen_records::description::keys::TABLES;
use eomgen_tests::models::project;

const BEGIN: &str = "<!-- table of keys -->\n";
const END: &str = "<!-- end of the table of keys -->\n";

/// Returns the anchor of a heading.
fn anchor(heading: &str) -> String {
    let kept = heading.to_lowercase().replace(' ', "-");
    kept.replace(|c: char| c != '-' && !c.is_alphanumeric(), "")
}

/// Returns the names of keys with the same meaning, in bold if required.
fn names(keys: &[Key], path: &str) -> String {
    let name = |key: &Key| match key.is_required {
        true => format!("**`{path}{}`**", key.name),
        false => format!("`{path}{}`", key.name),
    };
    keys.iter().map(name).collect::<Vec<_>>().join(", ")
}

fn meaning(key: &Key) -> String {
    match key.heading {
        "" => key.doc.to_owned(),
        heading => format!("{} ([{heading}](#{}))", key.doc, anchor(heading)),
    }
}

/// Returns the kind of a value with its allowed keys.
fn value(kind: Kind) -> String {
    let listed = |names: &[&str]| {
        let quoted = names.iter().map(|name| format!("`{name}`"));
        quoted.collect::<Vec<_>>().join(" and ")
    };
    let choice = |keys: &Keys| {
        let sets: Vec<String> = keys.one_of.iter().map(|names| listed(names)).collect();
        match (sets.is_empty(), keys.any_of.is_empty()) {
            (false, _) => format!(" with either {}", sets.join(" or ")),
            (true, false) => format!(" with {} or both", keys.any_of.join(" or ")),
            (true, true) => String::new(),
        }
    };
    match kind {
        Kind::Value(kind) => kind.replace('_', " "),
        Kind::Table(keys) => format!("table{}", choice(keys)),
        Kind::Entries(keys) => match keys.shorthand {
            Some(kind) => {
                let kind = kind.replace('_', " ");
                format!("`NAME = {{ ... }}`{}, or the {kind} alone", choice(keys))
            }
            None => format!("`NAME = {{ ... }}`{}", choice(keys)),
        },
    }
}

/// Returns one row for each key of a table; `path` is the prefix of the names.
fn rows(keys: &Keys, path: &str) -> String {
    let same = |one: &Key, other: &Key| one.doc == other.doc && one.heading == other.heading;
    let groups = keys.list.chunk_by(|one, other| same(one, other));
    let rows = groups.map(|group| {
        let first = &group[0];
        let inner = match first.kind {
            Kind::Value(_) => String::new(),
            Kind::Table(inner) => rows(inner, &format!("{path}{}.", first.name)),
            Kind::Entries(inner) => rows(inner, &format!("{path}{}.NAME.", first.name)),
        };
        let (names, value, meaning) = (names(group, path), value(first.kind), meaning(first));
        format!("| | {names} | {value} | {meaning} |\n{inner}")
    });
    rows.collect()
}

/// Returns the rows of a kind of file: each section, followed by its keys.
fn table(file: &Keys) -> String {
    let sections = file.list.iter().map(|section| match section.kind {
        Kind::Table(keys) | Kind::Entries(keys) => {
            let required = if section.is_required {
                "(required)"
            } else {
                ""
            };
            let (name, value, meaning) = (section.name, value(section.kind), meaning(section));
            let inner = rows(keys, "");
            format!("| `[{name}]` | {required} | {value} | {meaning} |\n{inner}")
        }
        Kind::Value(kind) => {
            format!("| | `{}` | {kind} | {} |\n", section.name, section.doc)
        }
    });
    let head = "| section | key | value | meaning |\n| --- | --- | --- | --- |\n";
    head.to_owned() + &sections.collect::<String>()
}

fn legend() -> String {
    let mut rows = "\n| value | in the file |\n| --- | --- |\n".to_owned();
    for (name, schema) in kinds().as_object().expect("kinds") {
        let text = schema["description"].as_str().expect("a description");
        rows.push_str(&format!("| {} | {text} |\n", name.replace('_', " ")));
    }
    rows
}

/// Compares the part of a page between the markers with the table, or rewrites it.
#[track_caller]
fn compare(page: &str, table: &str) {
    let path = project().join("docs").join(page);
    let text = std::fs::read_to_string(&path).expect("a page");
    let (before, rest) = text.split_once(BEGIN).expect("the mark before the table");
    let (shown, after) = rest.split_once(END).expect("the mark after the table");
    let expected = format!("\n{table}\n");
    if std::env::var_os("EOMGEN_BLESS").is_some() {
        let text = format!("{before}{BEGIN}{expected}{END}{after}");
        std::fs::write(&path, text).expect("writable");
    } else {
        assert!(shown == expected, "{page}: run with EOMGEN_BLESS=1");
    }
    for (at, _) in expected.match_indices("](#") {
        let anchored = expected[at + 3..].split(')').next().unwrap_or_default();
        let mut headings = text.lines().filter(|line| line.starts_with('#'));
        let is_there = headings.any(|line| anchor(line.trim_start_matches(['#', ' '])) == anchored);
        assert!(is_there, "{page} has no heading for #{anchored}");
    }
}

#[test]
fn language_reference_matches_the_table_of_sections() {
    compare("specification.md", &(table(&SECTIONS) + &legend()));
}

#[test]
fn dataset_reference_matches_the_table_of_keys() {
    compare("discovery.md", &table(&TABLES));
}
