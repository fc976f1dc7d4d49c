//! What a test could not do where it ran, said where people see it: on the terminal at once,
//! though the test passes, and in a list for who reads only the end, as `.ci/run` prints it.

use std::fs::OpenOptions;
use std::io::Write;
use std::panic::Location;

/// The variable that names the file which skips are added to, a line each. Without it there
/// is no list.
pub const LIST: &str = "EOMGEN_SKIPS";

/// Says that the calling test, or a part of it, is not run, and why: what was not done, for
/// want of what, and how to get that.
///
/// # Panics
/// If the list cannot be written: a skip that nobody sees is worse than a failure.
#[track_caller]
pub fn skip(reason: &str) {
    let line = format!("SKIPPED: {}: {reason}\n", Location::caller().file());
    // Not `eprintln`, which the test runner keeps to itself where a test passes.
    let written = std::io::stderr().write_all(line.as_bytes());
    written.expect("the standard error can be written to");
    if let Some(list) = std::env::var_os(LIST) {
        let file = OpenOptions::new().create(true).append(true).open(list);
        let written = file.and_then(|mut file| file.write_all(line.as_bytes()));
        written.expect("the list of skips can be written to");
    }
}
