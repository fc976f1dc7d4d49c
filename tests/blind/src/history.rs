//! Success rates of runs, stored as lines of a table in the repository, with date and command.

use crate::score::Score;

/// Identification of a run.
#[derive(Clone, Debug)]
pub struct Run {
    /// Date of the commit.
    pub date: String,
    /// Hash of the commit.
    pub commit: String,
    /// Command line of `blind`.
    pub command: String,
}

/// Returns the header line of the table.
pub fn heading() -> String {
    let columns = figures(&[]).map(|(name, _)| name);
    format!("date,commit,command,{}\n", columns.join(","))
}

/// Appends a run to the table.
///
/// # Errors
///
/// A table with other columns.
pub fn append_run(table: &str, run: &Run, score: &Score) -> Result<String, String> {
    let heading = heading();
    if !table.starts_with(&heading) {
        return Err(format!(
            "the table has other columns; expected it to begin with {heading}"
        ));
    }
    let values = figures(&[score]).map(|(_, value)| value);
    let Run {
        date,
        commit,
        command,
    } = run;
    let line = format!("{date},{commit},{command},{}\n", values.join(","));
    Ok(table.to_owned() + &line)
}

fn figures(score: &[&Score]) -> [(&'static str, String); 21] {
    let part = |of: fn(&Score) -> (usize, usize)| {
        let parts = score.iter().map(|score| of(score));
        parts.map(|(a, b)| format!("{a}/{b}")).collect::<String>()
    };
    let number = |of: fn(&Score) -> f64| {
        let numbers = score.iter().map(|score| of(score));
        numbers.map(|n| format!("{n:.2}")).collect::<String>()
    };
    let count = |of: fn(&Score) -> usize| {
        let counts = score.iter().map(|score| of(score));
        counts.map(|n| n.to_string()).collect::<String>()
    };
    [
        ("cases", count(|s| s.cases.len())),
        ("nothing_false", part(|s| s.nothing_false)),
        ("named", part(|s| s.named)),
        ("named_or_class", part(|s| s.named_or_class)),
        ("named_at_full_priors", part(|s| s.named_at_full_priors)),
        ("false_alarms", part(|s| s.false_alarms)),
        ("wrong_signs", count(|s| s.wrong_signs)),
        ("intervals", part(|s| s.intervals)),
        ("refitted", part(|s| s.refitted)),
        ("closure", number(|s| s.single_closure.mean)),
        (
            "closure_reached",
            part(|s| (s.single_closure.reached, s.single_closure.of)),
        ),
        ("closure_pairs", number(|s| s.pair_closure.mean)),
        ("pairs", part(|s| s.pairs)),
        ("untellable_as_class", part(|s| s.classes)),
        ("outside_not_named", part(|s| s.outside)),
        ("classes", count(|s| s.class_sizes.0)),
        ("effects_in_classes", count(|s| s.class_sizes.1)),
        ("largest_class", count(|s| s.class_sizes.2)),
        ("too_long", count(|s| s.without_answer.0)),
        ("no_answer", count(|s| s.without_answer.1)),
        ("longest_s", number(|s| s.seconds.1)),
    ]
}

#[cfg(test)]
mod tests {
    use super::{Run, append_run, heading};
    use crate::score::sum_judgements;

    const CHECKED_IN_TABLE: &str = include_str!("../history.csv");

    fn run() -> Run {
        Run {
            date: "2026-01-02".to_owned(),
            commit: "abc".to_owned(),
            command: "--seed 7 --cases 0..24".to_owned(),
        }
    }

    #[test]
    fn line_has_the_columns_of_the_header() {
        let table = append_run(&heading(), &run(), &sum_judgements(Vec::new())).expect("a table");
        let counts: Vec<usize> = table.lines().map(|line| line.split(',').count()).collect();
        assert_eq!(counts, [24, 24], "{table}");
        assert!(table.contains("\n2026-01-02,abc,--seed 7 --cases 0..24,0,0/0,"));
    }

    #[test]
    fn checked_in_table_can_be_extended() {
        assert!(append_run(CHECKED_IN_TABLE, &run(), &sum_judgements(Vec::new())).is_ok());
        assert!(append_run("date,other\n", &run(), &sum_judgements(Vec::new())).is_err());
    }
}
