//! Table of errata with the results of the comparison.

use std::fmt;

use eomgen_validate::references::evaluation::relative;

/// Largest relative deviation of equal values: rounding errors of a few hundred operations at 1e-16.
const MAX_EQUAL_DEVIATION: f64 = 1e-11;

/// Smallest relative deviation of different values. It is far above rounding errors and below the smallest misprint
/// (beta_4 of Eq. (18), 3e-6).
const MIN_DIFFERENT_DEVIATION: f64 = 1e-6;

/// Printed or corrected statement, with its value at the parameters of the table.
#[derive(Clone, Debug, PartialEq)]
pub struct Statement {
    /// Formula as ASCII text.
    pub text: String,
    /// Value in SI.
    pub value: f64,
}

/// Row of the table: statements and value of the derived model.
#[derive(Clone, Debug, PartialEq)]
pub struct ErratumOutcome {
    /// Equation and compared quantity.
    pub place: String,
    /// Printed statement if it is wrong; `None` if it is correct.
    pub printed: Option<Statement>,
    /// Statement consistent with the energies.
    pub corrected: Statement,
    /// Value of the derived model.
    pub derived: f64,
    /// |derived - corrected| relative to the larger magnitude of the corrected and the printed value.
    pub deviation_from_corrected: f64,
    /// |derived - printed| relative to the same magnitude, if the printed statement is wrong.
    pub deviation_from_printed: Option<f64>,
}

impl ErratumOutcome {
    /// Returns true if the derived value equals the corrected value up to rounding.
    pub fn agrees_with_corrected(&self) -> bool {
        self.deviation_from_corrected <= MAX_EQUAL_DEVIATION
    }

    /// Returns true if the derived value differs from the wrong printed value, or if the printed value is correct.
    pub fn differs_from_printed(&self) -> bool {
        self.deviation_from_printed
            .is_none_or(|deviation| deviation > MIN_DIFFERENT_DEVIATION)
    }

    /// Returns true if the derived value agrees with the corrected one and differs from the printed one.
    pub fn passed(&self) -> bool {
        self.agrees_with_corrected() && self.differs_from_printed()
    }
}

/// Rows in the order of the paper.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ErrataTable {
    /// Rows in the order of the paper.
    pub rows: Vec<ErratumOutcome>,
}

impl ErrataTable {
    /// Adds a row with a wrong printed statement.
    pub fn add_misprint(
        &mut self,
        place: impl Into<String>,
        (printed_text, printed): (&str, f64),
        (corrected_text, corrected): (&str, f64),
        derived: f64,
    ) {
        let scale = printed.abs().max(corrected.abs());
        self.rows.push(ErratumOutcome {
            place: place.into(),
            printed: Some(Statement {
                text: printed_text.to_owned(),
                value: printed,
            }),
            corrected: Statement {
                text: corrected_text.to_owned(),
                value: corrected,
            },
            derived,
            deviation_from_corrected: relative(derived - corrected, scale),
            deviation_from_printed: Some(relative(derived - printed, scale)),
        });
    }

    pub fn add_correct(
        &mut self,
        place: impl Into<String>,
        (text, value): (&str, f64),
        derived: f64,
    ) {
        self.rows.push(ErratumOutcome {
            place: place.into(),
            printed: None,
            corrected: Statement {
                text: text.to_owned(),
                value,
            },
            derived,
            deviation_from_corrected: relative(derived - value, value.abs()),
            deviation_from_printed: None,
        });
    }
}

impl fmt::Display for ErrataTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let place = width(self.rows.iter().map(|row| row.place.as_str()), "where");
        writeln!(
            f,
            "{:4}  {:place$}  {:>13}  {:>13}  {:>13}  {:>8}  {:>8}",
            "", "where", "printed", "corrected", "derived", "dev.corr", "dev.prin"
        )?;
        for row in &self.rows {
            let verdict = if row.passed() { "ok" } else { "FAIL" };
            let printed = row.printed.as_ref().map_or_else(
                || "as corrected".to_owned(),
                |printed| format!("{:.6e}", printed.value),
            );
            let deviation = row
                .deviation_from_printed
                .map_or_else(String::new, |deviation| format!("{deviation:.1e}"));
            writeln!(
                f,
                "{verdict:4}  {:place$}  {printed:>13}  {:>13.6e}  {:>13.6e}  {:>8.1e}  {deviation:>8}",
                row.place, row.corrected.value, row.derived, row.deviation_from_corrected
            )?;
            if let Some(printed) = &row.printed {
                writeln!(f, "      printed   {}", printed.text)?;
                writeln!(f, "      corrected {}", row.corrected.text)?;
            }
        }
        Ok(())
    }
}

fn width<'a>(entries: impl Iterator<Item = &'a str>, title: &str) -> usize {
    entries
        .map(|entry| entry.chars().count())
        .fold(title.len(), usize::max)
}
