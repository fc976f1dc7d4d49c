//! `eomgen paper claims`: a search that is killed goes on to the same bytes, its counts are
//! those of its own table, and wrong use is refused.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use eomgen_tests::models::project;
use eomgen_tests::program::{self, accepted, eomgen, refused, text};
use serde_json::Value;

/// One set, of a machine that is well damped, so that a search takes seconds.
const FEW: [&str; 4] = ["--sets", "1", "--seed", "166"];

/// The longest a search of so few sets may take.
const LIMIT: Duration = Duration::from_secs(300);

/// Searches to the end; what is printed.
fn search(out: &Path) -> Value {
    let mut command = eomgen();
    command.timeout(LIMIT);
    command.args(["paper", "claims", "--json"]).args(FEW);
    let output = command.arg("--out").arg(out).output();
    let output = output.expect("the program can be run");
    assert!(output.status.success(), "{}", text(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("JSON")
}

/// Begins a search and kills it once its screening is written.
fn begin(out: &Path) {
    let mut child = Command::new(program::path())
        .args(["paper", "claims"])
        .args(FEW)
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
    assert!(part.exists(), "nothing is screened");
    assert!(!out.join("search.json").exists(), "killed too late");
}

/// The files of a folder, by name.
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

/// The rows of `search.csv`, each a list of fields; the names first.
fn rows(out: &Path) -> Vec<Vec<String>> {
    let table = fs::read_to_string(out.join("search.csv")).expect("search.csv");
    let fields = |line: &str| line.split(',').map(str::to_owned).collect();
    table.lines().map(fields).collect()
}

#[test]
fn a_killed_search_goes_on_to_the_same_bytes() {
    let folder = tempfile::tempdir().expect("a folder");
    let (killed, whole) = (folder.path().join("killed"), folder.path().join("whole"));
    begin(&killed);
    let screened = fs::metadata(killed.join("parts/screened_00000.csv"));
    let written = screened.and_then(|part| part.modified()).expect("a time");
    // What a kill in the middle of a write leaves.
    fs::write(killed.join("parts/confirmed_00000.unfinished"), "0,1").expect("written");
    let found = search(&killed);
    let screened = fs::metadata(killed.join("parts/screened_00000.csv"));
    let again = screened.and_then(|part| part.modified()).expect("a time");
    assert_eq!(written, again, "what was screened is not screened again");
    assert_eq!(search(&whole), found);
    assert_eq!(files(&killed), files(&whole));
    assert_eq!(files(&killed.join("parts")), files(&whole.join("parts")));

    counts_are_those_of_the_table(&found, &rows(&whole));
    the_assumed_values_are_judged_as_the_page_says(&found);
    for name in ["together.svg", "claims.svg"] {
        let svg = fs::read_to_string(whole.join(name)).expect(name);
        assert!(
            svg.starts_with("<svg") && svg.ends_with("</svg>\n"),
            "{name}"
        );
    }
    let table = fs::read_to_string(whole.join("claims.md")).expect("claims.md");
    // A line per claim below the heading; no bar within a cell but those escaped.
    assert_eq!(table.lines().count(), 32);
    let bars = |line: &str| line.matches('|').count() - line.matches("\\|").count();
    assert!(table.lines().all(|line| bars(line) == 9), "{table}");
    let other = whole.display().to_string();
    let error = refused(&[
        "paper", "claims", "--sets", "2", "--seed", "6", "--out", &other,
    ]);
    assert!(error.contains("different search"), "{error}");
}

/// What is said of the assumed values does not depend on the search, and is what
/// docs/claims.json holds: verdicts, and numbers to the last digit printed.
fn the_assumed_values_are_judged_as_the_page_says(found: &Value) {
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
        // Products of matrices are those of the processor: other bits, another chaos.
        let named = if cfg!(target_arch = "x86_64") {
            &["verdict", "strict", "evidence"][..]
        } else {
            &["verdict", "strict"]
        };
        for name in named {
            assert_eq!(
                kept[name], found[name],
                "{id}: run `paper claims` again, as docs/claims.md says"
            );
        }
    }
}

/// `search.json` says what can be counted in `search.csv`.
fn counts_are_those_of_the_table(found: &Value, rows: &[Vec<String>]) {
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
        // After stage, set, five values and two counts.
        let holding = row[9..39].iter().filter(|letter| *letter == "H").count();
        assert_eq!(row[7], holding.to_string());
        expected[holding] += 1;
    }
    assert_eq!(histogram, &expected, "how many hold at once");
}

#[test]
fn wrong_use_is_refused() {
    let nowhere = ["paper", "claims", "--out", "never-made"];
    for (option, value) in [
        ("--sets", "0"),
        ("--sets", "1000001"),
        ("--sets", "few"),
        ("--seed", "first"),
    ] {
        let error = refused(&[&nowhere[..], &[option, value]].concat());
        assert!(error.contains(option) && error.contains(value), "{error}");
    }
    assert!(!Path::new("never-made").exists());
    assert!(refused(&["paper", "claims", "--sets", "2"]).contains("--out"));
    assert!(accepted(&["paper", "claims", "--help"]).contains("eomgen paper claims --sets"));
}

#[test]
fn a_place_that_cannot_be_written_to_is_refused_at_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("file");
    fs::write(&file, "").expect("written");
    // Not counting the time to build the program.
    program::path();
    let began = Instant::now();
    let error = refused(&["paper", "claims", "--out", &file.display().to_string()]);
    assert!(error.contains("file"), "{error}");
    assert!(
        began.elapsed() < Duration::from_secs(10),
        "before the search"
    );
}
