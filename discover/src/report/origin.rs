//! Origin of a result: specification and records with their hashes, seed, version and date.

use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};

use eomgen_model_spec::source::sha256;
use eomgen_records::dataset::Dataset;

/// Specification that is compared with records.
#[derive(Clone, Copy, Debug)]
pub struct Specification<'s> {
    /// Path, for messages.
    pub path: &'s str,
    /// Text.
    pub text: &'s str,
    /// Order of the fields; `None` for the default order.
    pub order: Option<usize>,
}

/// Origin of a result.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Origin {
    /// Version of the program.
    pub version: &'static str,
    /// Date in universal time, for example `2026-11-23`.
    pub date: String,
    /// Seed of the noise of the replica.
    pub seed: u64,
    /// Specification, dataset file and records.
    pub files: Vec<HashedFile>,
}

/// File with its hash.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct HashedFile {
    /// Role: `specification`, `dataset`, `train[0]`, ...
    pub role: String,
    /// Path as given.
    pub path: String,
    /// SHA-256, 64 hexadecimal digits; `None` if the file can no longer be read.
    pub sha256: Option<String>,
}

impl Origin {
    /// Returns the origin of a result that is computed now.
    pub(crate) fn record_inputs(
        specification: Specification<'_>,
        dataset: &Dataset,
        seed: u64,
    ) -> Self {
        let hashed = |role: &str, path: &Path| HashedFile {
            role: role.to_owned(),
            path: path.display().to_string(),
            sha256: std::fs::read(path).ok().map(sha256),
        };
        let mut files = vec![HashedFile {
            role: "specification".to_owned(),
            path: specification.path.to_owned(),
            sha256: Some(sha256(specification.text)),
        }];
        files.push(hashed("dataset", &dataset.path));
        let records = dataset.train.iter().chain(&dataset.test);
        files.extend(records.map(|record| hashed(&record.name, &record.path)));
        let now = SystemTime::now().duration_since(UNIX_EPOCH);
        Self {
            version: env!("CARGO_PKG_VERSION"),
            date: format_date(now.map_or(0, |since| since.as_secs()) / SECONDS_PER_DAY),
            seed,
            files,
        }
    }
}

const SECONDS_PER_DAY: u64 = 86_400;

/// Returns the Gregorian date for a number of days after 1970-01-01. The computation uses eras of
/// 400 years that begin in March; a leap day is then the last day of its year.
fn format_date(days: u64) -> String {
    let days = days + 719_468;
    let (era, day) = (days / 146_097, days % 146_097);
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let day = day - (153 * month + 2) / 5 + 1;
    let (month, next) = if month < 10 {
        (month + 3, 0)
    } else {
        (month - 9, 1)
    };
    format!("{:04}-{month:02}-{day:02}", year + 400 * era + next)
}

#[cfg(test)]
mod tests {
    use super::format_date;

    #[test]
    fn days_are_formatted_as_dates() {
        for (days, expected) in [
            (0, "1970-01-01"),
            (11_016, "2000-02-29"),
            (11_017, "2000-03-01"),
            (19_782, "2024-02-29"),
            (20_780, "2026-11-23"),
            (47_540, "2100-02-28"),
            (47_541, "2100-03-01"),
        ] {
            assert_eq!(format_date(days), expected);
        }
    }
}
