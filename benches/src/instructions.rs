//! Instruction counts of [`crate::cases`] by callgrind. They do not depend on other work of the machine. They depend on
//! the compiler and, for derivations, slightly on the seeds of hash maps.

use std::path::Path;
use std::process::Command;

/// Number of calls of a right-hand side; counts are divided by it.
pub const CALLS: u64 = 100;

/// Prefix of cases that run once.
const ONCE: &str = "derive_and_emit";

/// Name of a case and its instructions per call.
pub type Count = (String, u64);

/// Command-line argument with which the counted program runs the cases.
pub const ARGUMENT: &str = "cases";

/// Counts the instructions of every case in `program`, in the order of `names`.
///
/// # Errors
/// A missing tool or case, or a failed command.
pub fn counted(program: &Path, folder: &Path, names: &[String]) -> Result<Vec<Count>, String> {
    let profile = folder.join("callgrind.out");
    run(Command::new("valgrind")
        .arg("--tool=callgrind")
        .arg(format!("--callgrind-out-file={}", profile.display()))
        .arg(program)
        .arg(ARGUMENT))?;
    let table = run(Command::new("callgrind_annotate")
        .args(["--inclusive=yes", "--threshold=100"])
        .arg(&profile))?;
    names
        .iter()
        .map(|name| {
            let total =
                total(&table, name).ok_or(format!("the output of callgrind has no {name}"))?;
            let calls = if name.starts_with(ONCE) { 1 } else { CALLS };
            Ok((name.clone(), total / calls))
        })
        .collect()
}

/// Returns true if valgrind is installed.
pub fn available() -> bool {
    run(Command::new("valgrind").arg("--version")).is_ok()
}

fn run(command: &mut Command) -> Result<String, String> {
    let output = command
        .output()
        .map_err(|error| format!("{error}: {command:?}"))?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        return Err(format!("{command:?} failed: {said}"));
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// Returns the inclusive instructions of a function from callgrind's table. Each line has a number with commas, a
/// percentage in parentheses, and a location with the function's name.
fn total(table: &str, name: &str) -> Option<u64> {
    let line = table.lines().find(|line| {
        line.match_indices("cases::").any(|(place, prefix)| {
            let rest = &line[place + prefix.len()..];
            let after = rest.strip_prefix(name);
            after.is_some_and(|after| !after.starts_with(|c: char| c.is_alphanumeric() || c == '_'))
        })
    })?;
    let number = line.split_whitespace().next()?;
    number.replace(',', "").parse().ok()
}

/// Parses a table of counts with a case and its count in each line.
pub fn read(text: &str) -> Vec<Count> {
    let parts = text.lines().filter_map(|line| line.split_once(','));
    parts
        .filter_map(|(name, number)| Some((name.to_owned(), number.parse().ok()?)))
        .collect()
}

/// Formats a table of counts.
pub fn format_counts(counts: &[Count]) -> String {
    let line = |(name, number): &Count| format!("{name},{number}\n");
    let lines: String = counts.iter().map(line).collect();
    format!("case,instructions\n{lines}")
}

/// Returns the names of all cases.
pub fn names() -> Vec<String> {
    let orders = [0, 1, 2, 4, 8, 16, 32, 64, 128];
    let sides = orders.iter().flat_map(|order| {
        ["generated", "hand_written", "equation_22"].map(|who| format!("{who}_{order}"))
    });
    let derived = [4, 128].map(|order| format!("{ONCE}_{order}"));
    sides.chain(derived).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = "\
1,234,500 (12.3%)  ???:cases::generated_64::h0123 [/x/history]
  56,700 ( 0.5%)  ???:cases::generated_6 [/x/history]
   1,000 ( 0.1%)  lib.rs:cases::generated_64_else [/x/history]
";

    #[test]
    fn functions_are_found_by_their_whole_name() {
        assert_eq!(total(TABLE, "generated_64"), Some(1_234_500));
        assert_eq!(total(TABLE, "generated_6"), Some(56_700));
        assert_eq!(total(TABLE, "generated_4"), None);
    }

    #[test]
    fn written_tables_are_read_back() {
        let counts = vec![("a_1".to_owned(), 5), ("b_2".to_owned(), 70)];
        assert_eq!(read(&format_counts(&counts)), counts);
    }
}
