//! Reports skipped tests. A report is printed to the terminal immediately, although the test passes, and appended to a
//! list that `.ci/run` prints at the end.

use std::fs::OpenOptions;
use std::io::Write;
use std::panic::Location;

/// Environment variable with the path of the list of skips, one per line. If it is unset, no list
/// is written.
pub const LIST: &str = "EOMGEN_SKIPS";

/// Reports that the calling test, or a part of it, does not run. `reason` states the omitted part,
/// the missing tool and how to install it.
///
/// # Panics
/// Panics if the list cannot be written, because a hidden skip is worse than a failure.
#[track_caller]
pub fn skip(reason: &str) {
    let line = format!("SKIPPED: {}: {reason}\n", Location::caller().file());
    // The test runner captures `eprintln` of passing tests.
    let written = std::io::stderr().write_all(line.as_bytes());
    written.expect("the standard error can be written to");
    if let Some(list) = std::env::var_os(LIST) {
        let file = OpenOptions::new().create(true).append(true).open(list);
        let written = file.and_then(|mut file| file.write_all(line.as_bytes()));
        written.expect("the list of skips can be written to");
    }
}
