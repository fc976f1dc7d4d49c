//! Invalid specifications: each file of `corpus/broken` has its messages in a `.txt` file of
//! the same name. `EOMGEN_BLESS=1 cargo test -p eomgen-model-spec --test reader broken`
//! rewrites the messages; review the difference before you commit it.

use std::path::{Path, PathBuf};

use eomgen_model_spec::diagnostic::{Diagnostics, MAX_LISTED, Severity};
use eomgen_model_spec::source::Source;
use eomgen_model_spec::{MAX_SIZE, check, load};

fn corpus() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus/broken");
    let entries = std::fs::read_dir(folder).expect("the corpus is there");
    let paths = entries.map(|entry| entry.expect("readable").path());
    let mut paths: Vec<_> = paths
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .collect();
    paths.sort();
    paths
}

/// Returns the errors of an invalid specification.
fn expect_rejection(name: &str, text: &str) -> Diagnostics {
    let found = check(Source::new(name, text)).expect_err(name);
    assert!(!found.render(false).is_empty());
    found
}

#[test]
fn broken_specifications_have_the_recorded_messages() {
    let bless = std::env::var_os("EOMGEN_BLESS").is_some();
    let mut differing = Vec::new();
    for path in corpus() {
        let name = path
            .file_name()
            .expect("a file")
            .to_string_lossy()
            .into_owned();
        let text = std::fs::read_to_string(&path).expect("readable");
        let shown = expect_rejection(&name, &text).render(false) + "\n";
        let golden = path.with_extension("txt");
        if bless {
            std::fs::write(&golden, &shown).expect("writable");
        } else if std::fs::read_to_string(&golden).ok().as_deref() != Some(&shown) {
            differing.push(format!("--- {name}\n{shown}"));
        }
    }
    let advice = "run with EOMGEN_BLESS=1 if these are right";
    assert!(differing.is_empty(), "{advice}\n{}", differing.join("\n"));
}

#[test]
fn messages_have_a_line_and_a_column() {
    for path in corpus() {
        let name = path
            .file_name()
            .expect("a file")
            .to_string_lossy()
            .into_owned();
        let text = std::fs::read_to_string(&path).expect("readable");
        let found = expect_rejection(&name, &text);
        let shown = found.render(false);
        for record in found.records() {
            let (line, column) = (record.line.expect(&name), record.column.expect(&name));
            assert!(
                shown.contains(&format!("{name}:{line}:{column}")),
                "{line}:{column}\n{shown}"
            );
            assert_eq!(record.severity, Severity::Error);
        }
    }
}

#[test]
fn ten_thousand_brackets_are_rejected() {
    let brackets = "(".repeat(10_000);
    let text = format!(
        "[model]\nname = \"a\"\n[kinetic]\ndeep = \"{brackets}\"\n[coordinates]\nx = {{ unit = \"m\" }}\n"
    );
    let shown = expect_rejection("deep.toml", &text).render(false);
    assert!(
        shown.contains("more than 200 nested levels") && shown.contains("deep.toml:4:"),
        "{shown}"
    );
    for (open, close) in [("[", "]"), ("{a=", "}")] {
        let nested = format!("a = {}{}", open.repeat(10_000), close.repeat(10_000));
        expect_rejection("nested.toml", &nested);
    }
    expect_rejection("dotted.toml", &format!("{}a = 1", "a.".repeat(10_000)));
}

#[test]
fn file_of_ten_megabytes_is_rejected() {
    let path = temporary("large.toml");
    std::fs::write(&path, vec![b'#'; 10 << 20]).expect("writable");
    let shown = load(&path).expect_err("too large").render(false);
    std::fs::remove_file(&path).expect("removable");
    assert!(
        shown.contains("too large") && shown.contains("large.toml:1:1"),
        "{shown}"
    );
}

#[test]
fn a_megabyte_of_errors_lists_twenty() {
    let head =
        "[model]\nname = \"a\"\n[coordinates]\nx = { unit = \"m\" }\n[kinetic]\nk = \"dot(x)\"\n";
    let fill = |line: &dyn Fn(usize) -> String| {
        let mut text = head.to_owned();
        for index in 0.. {
            let line = line(index);
            if (text.len() + line.len()) as u64 > MAX_SIZE {
                return text;
            }
            text.push_str(&line);
        }
        text
    };
    let keys = expect_rejection("keys.toml", &fill(&|index| format!("k{index} = 1\n")));
    let sections = expect_rejection("sections.toml", &fill(&|index| format!("[s{index}]\n")));
    assert_eq!(keys.list().len(), 1);
    assert_eq!(sections.list().len(), MAX_LISTED);
    assert!(
        sections.omitted_count() > 90_000,
        "{}",
        sections.omitted_count()
    );
    let sum = head.to_owned() + "y = \"" + &"x+".repeat(400_000) + "x\"";
    assert_eq!(expect_rejection("sum.toml", &sum).list().len(), 1);
}

#[test]
fn long_chains_of_definitions_do_not_exhaust_the_stack() {
    let mut text = "[model]\nname = \"a\"\n[parameters]\nm = { value = 1, unit = \"kg\" }\n\
                    [coordinates]\nx = { unit = \"m\" }\n[kinetic]\nk = \"1/2*m*dot(x)^2\"\n\
                    [definitions]\nd0 = \"x\"\n"
        .to_owned();
    for index in 1..1900 {
        text.push_str(&format!("d{index} = \"-d{}\"\n", index - 1));
    }
    let shown = expect_rejection("chain.toml", &text).render(false);
    assert!(
        shown.contains("after its definitions are inserted"),
        "{shown}"
    );
}

#[test]
fn unreadable_files_are_named() {
    let missing = load(Path::new("no/such/arm.toml"))
        .expect_err("missing")
        .render(false);
    assert!(
        missing.contains("cannot be read") && missing.contains("no/such/arm.toml"),
        "{missing}"
    );
    let folder = load(Path::new(env!("CARGO_MANIFEST_DIR")))
        .expect_err("a folder")
        .render(false);
    assert!(folder.contains("not a file"), "{folder}");
    let path = temporary("latin1.toml");
    std::fs::write(&path, b"[model]\nname = \"\xe9\"\n").expect("writable");
    let foreign = load(&path).expect_err("Latin-1").render(false);
    std::fs::remove_file(&path).expect("removable");
    assert!(
        foreign.contains("not UTF-8") && foreign.contains("latin1.toml:2:9"),
        "{foreign}"
    );
}

fn temporary(name: &str) -> PathBuf {
    std::env::temp_dir().join(format!("eomgen-{}-{name}", std::process::id()))
}
