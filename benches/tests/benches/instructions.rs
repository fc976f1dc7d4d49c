//! No case takes more instructions than is kept in `benches/instructions.csv`. Skipped,
//! loudly, without valgrind.

use std::path::Path;

use eomgen_benches::instructions::{available, counted, names, read, written};

/// A rise that fails, in percent.
const RISE: u64 = 5;

#[test]
fn no_case_takes_more_instructions_than_before() {
    if !available() {
        skips::skip(
            "instructions were not counted, for want of valgrind (Debian: apt-get install valgrind)",
        );
        return;
    }
    if cfg!(debug_assertions) {
        skips::skip(
            "instructions were not counted, they are those of optimised code: cargo test --release",
        );
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let program = Path::new(env!("CARGO_BIN_EXE_history"));
    let now = counted(program, folder.path(), &names()).expect("callgrind counts");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("instructions.csv");
    if std::env::var_os("EOMGEN_REFRESH").is_some() {
        std::fs::write(&path, written(&now)).expect("written");
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
        "{}\nif that is meant: EOMGEN_REFRESH=1 cargo test --release -p eomgen-benches --test benches instructions",
        risen.join("\n")
    );
}
