//! Comparison of instruction counts with `benches/instructions.csv`. Skipped with a message if valgrind is missing.

use std::path::Path;

use eomgen_benches::instructions::{available, counted, format_counts, names, read};

/// Largest accepted increase, in percent.
const RISE: u64 = 5;

#[test]
fn no_case_takes_more_instructions_than_recorded() {
    if !available() {
        skips::skip(
            "instructions were not counted: valgrind is missing (Debian: apt-get install valgrind)",
        );
        return;
    }
    if cfg!(debug_assertions) {
        skips::skip(
            "instructions were not counted, because this build is not optimised: cargo test --release",
        );
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let program = Path::new(env!("CARGO_BIN_EXE_history"));
    let now = counted(program, folder.path(), &names()).expect("callgrind counts");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("instructions.csv");
    if std::env::var_os("EOMGEN_REFRESH").is_some() {
        std::fs::write(&path, format_counts(&now)).expect("written");
    }
    let kept = read(&std::fs::read_to_string(&path).expect("the counts as kept"));
    assert_eq!(kept.len(), now.len());
    let risen: Vec<String> = kept
        .iter()
        .zip(&now)
        .inspect(|(kept, now)| assert_eq!(kept.0, now.0))
        .filter(|(kept, now)| 100 * now.1 > (100 + RISE) * kept.1)
        .map(|(kept, now)| format!("{}: {} instead of {}", now.0, now.1, kept.1))
        .collect();
    assert!(
        risen.is_empty(),
        "{}\nif the change is intended: EOMGEN_REFRESH=1 cargo test --release -p eomgen-benches --test benches instructions",
        risen.join("\n")
    );
}
