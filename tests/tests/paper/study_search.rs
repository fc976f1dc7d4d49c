//! Tests of `eomgen paper claims`: the result of a search that is killed and resumed is byte-identical, its counts
//! match its table, and invalid options are rejected.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use eomgen_tests::models::project;
use eomgen_tests::program::{self, eomgen, run_accepted, run_rejected, text};
use serde_json::Value;

/// Options of a search with one parameter set, a well-damped machine, which takes seconds.
const SMALL_SEARCH: [&str; 4] = ["--sets", "1", "--seed", "166"];

const LIMIT: Duration = Duration::from_secs(300);

fn run_search(out: &Path) -> Value {
    let mut command = eomgen();
    command.timeout(LIMIT);
    command
        .args(["paper", "claims", "--json"])
        .args(SMALL_SEARCH);
    let output = command.arg("--out").arg(out).output();
    let output = output.expect("the program can be run");
    assert!(output.status.success(), "{}", text(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("JSON")
}

/// Starts a search and kills it after the results of the screening are written.
fn start_and_kill(out: &Path) {
    let mut child = Command::new(program::path())
        .args(["paper", "claims"])
        .args(SMALL_SEARCH)
        .arg("--out")
        .arg(out)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program can be run");
    let (began, part) = (Instant::now(), out.join("parts/screened_00000.csv"));
    while !part.exists() && began.elapsed() < LIMIT {
        std::thread::sleep(Duration::from_millis(20));
    }
    child.kill().expect("the program runs");
    child.wait().expect("it ends");
    assert!(part.exists(), "the screening was not written");
    assert!(!out.join("search.json").exists(), "killed too late");
}

fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let entries = fs::read_dir(folder).expect("the folder");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let mut files: Vec<_> = paths
        .filter(|path| path.is_file())
        .map(|path| {
            let name = path.file_name().expect("a name").to_string_lossy();
            (name.into_owned(), fs::read(&path).expect("the file"))
        })
        .collect();
    files.sort();
    files
}

/// Returns the rows of `search.csv` as lists of fields, the header first.
fn rows(out: &Path) -> Vec<Vec<String>> {
    let table = fs::read_to_string(out.join("search.csv")).expect("search.csv");
    let fields = |line: &str| line.split(',').map(str::to_owned).collect();
    table.lines().map(fields).collect()
}

#[test]
fn killed_search_resumes_to_same_bytes() {
    let folder = tempfile::tempdir().expect("a folder");
    let (killed, whole) = (folder.path().join("killed"), folder.path().join("whole"));
    start_and_kill(&killed);
    let screened = fs::metadata(killed.join("parts/screened_00000.csv"));
    let written = screened.and_then(|part| part.modified()).expect("a time");
    // A kill during writing leaves such an unfinished file.
    fs::write(killed.join("parts/confirmed_00000.unfinished"), "0,1").expect("written");
    let found = run_search(&killed);
    let screened = fs::metadata(killed.join("parts/screened_00000.csv"));
    let again = screened.and_then(|part| part.modified()).expect("a time");
    assert_eq!(
        written, again,
        "a resumed search does not repeat the screening"
    );
    assert_eq!(run_search(&whole), found);
    assert_eq!(files(&killed), files(&whole));
    assert_eq!(files(&killed.join("parts")), files(&whole.join("parts")));

    assert_counts_match_table(&found, &rows(&whole));
    assert_assumed_values_match_page(&found);
    for name in ["together.svg", "claims.svg"] {
        let svg = fs::read_to_string(whole.join(name)).expect(name);
        assert!(
            svg.starts_with("<svg") && svg.ends_with("</svg>\n"),
            "{name}"
        );
    }
    let table = fs::read_to_string(whole.join("claims.md")).expect("claims.md");
    // Below the header, the table has one line for each claim; all vertical bars inside cells are escaped.
    assert_eq!(table.lines().count(), 32);
    let bars = |line: &str| line.matches('|').count() - line.matches("\\|").count();
    assert!(table.lines().all(|line| bars(line) == 9), "{table}");
    let other = whole.display().to_string();
    let error = run_rejected(&[
        "paper", "claims", "--sets", "2", "--seed", "6", "--out", &other,
    ]);
    assert!(error.contains("different search"), "{error}");
}

/// Checks that the result for the assumed values is independent of the search and equals
/// docs/claims.json: verdicts, and numbers in all printed digits.
fn assert_assumed_values_match_page(found: &Value) {
    let kept = fs::read_to_string(project().join("docs/claims.json")).expect("claims.json");
    let kept: Value = serde_json::from_str(&kept).expect("JSON");
    let pairs = |document: &Value| -> Vec<(Value, Value)> {
        let claims = document["claims"].as_array().expect("claims").iter();
        claims
            .map(|claim| (claim["id"].clone(), claim["assumed"].clone()))
            .collect()
    };
    let (kept, found) = (pairs(&kept), pairs(found));
    assert_eq!(kept.len(), found.len());
    for ((id, kept), (same, found)) in kept.iter().zip(&found) {
        assert_eq!(id, same);
        let named = if cfg!(target_arch = "x86_64") {
            &["verdict", "strict", "evidence"][..]
        } else {
            &["verdict", "strict"]
        };
        for name in named {
            assert_eq!(
                kept[name], found[name],
                "{id}: run the command of docs/claims.md again"
            );
        }
    }
}

fn assert_counts_match_table(found: &Value, rows: &[Vec<String>]) {
    let (names, rows) = rows.split_first().expect("a table");
    let screened: Vec<_> = rows.iter().filter(|row| row[0] == "screened").collect();
    assert_eq!(screened.len(), 1);
    let claims = found["claims"].as_array().expect("claims");
    assert_eq!(claims.len(), 30);
    let mut undecided = 0.0;
    for claim in claims {
        let id = claim["id"].as_str().expect("an id");
        let share = |name: &str, letter: &str| {
            let column = names.iter().position(|found| found == name).expect(name);
            let with = screened.iter().filter(|row| row[column] == letter);
            with.count() as f64
        };
        for (name, letter) in [("holds", "H"), ("fails", "F"), ("undecided", "U")] {
            assert_eq!(claim["screened"][name], share(id, letter), "{id}");
        }
        let strict = share(&format!("strict_{id}"), "H");
        assert_eq!(claim["screened"]["holds_strictly"], strict, "{id}");
        undecided += share(id, "U") / 30.0;
    }
    let stated = found["undecided"].as_f64().expect("a share");
    assert!((stated - undecided).abs() < 1e-12, "{stated} {undecided}");
    let histogram = found["histogram"].as_array().expect("counts");
    let mut expected = vec![0; 31];
    for row in &screened {
        // In each row, the claims follow after stage, set, five values and two counts.
        let holding = row[9..39].iter().filter(|letter| *letter == "H").count();
        assert_eq!(row[7], holding.to_string());
        expected[holding] += 1;
    }
    assert_eq!(
        histogram, &expected,
        "histogram of claims that hold together"
    );
}

#[test]
fn invalid_options_are_rejected() {
    let nowhere = ["paper", "claims", "--out", "never-made"];
    for (option, value) in [
        ("--sets", "0"),
        ("--sets", "1000001"),
        ("--sets", "few"),
        ("--seed", "first"),
    ] {
        let error = run_rejected(&[&nowhere[..], &[option, value]].concat());
        assert!(error.contains(option) && error.contains(value), "{error}");
    }
    assert!(!Path::new("never-made").exists());
    assert!(run_rejected(&["paper", "claims", "--sets", "2"]).contains("--out"));
    assert!(run_accepted(&["paper", "claims", "--help"]).contains("eomgen paper claims --sets"));
}

#[test]
fn unwritable_output_is_rejected_before_the_search() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("file");
    fs::write(&file, "").expect("written");
    // If the search started, it would exceed the time limit of `run_rejected`.
    let out = file.display().to_string();
    let error = run_rejected(&["paper", "claims", "--sets", "1000000", "--out", &out]);
    assert!(error.contains("file"), "{error}");
}
