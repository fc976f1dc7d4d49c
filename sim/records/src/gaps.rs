//! Gaps in a record: missing rows or cells. The inputs in a gap are unknown, so the parts between gaps become separate
//! records.

use std::ops::Range;

use crate::samples::{MIN_GAP_STEPS, round_file_time, typical_step};

/// Number of gaps between rows above which a record counts as unevenly sampled and is not split.
const MAX_GAPS: usize = 20;

/// Time interval without a known sample, in s.
#[derive(Clone, Debug)]
pub(crate) struct Gap {
    /// Name of the column with the empty cells; `None` for missing rows.
    pub column: Option<String>,
    /// Number of missing samples.
    pub count: usize,
    /// Time of the last sample before the gap; negative infinity at the beginning of a record.
    pub before: f64,
    /// Time of the first sample after the gap; infinity at the end of a record.
    pub behind: f64,
}

impl Gap {
    /// Describes the missing samples and their times in the file, which are later by `origin`.
    pub fn describe(&self, origin: f64) -> String {
        let column = match &self.column {
            Some(name) => format!(" of `{name}`"),
            None => String::new(),
        };
        let (count, before, behind) = (self.count, origin + self.before, origin + self.behind);
        let place = match (before.is_finite(), behind.is_finite()) {
            (true, true) => format!("between {before:.6} s and {behind:.6} s"),
            (false, _) => format!("before {behind:.6} s"),
            (true, false) => format!("after {before:.6} s"),
        };
        format!("{count} samples{column} are missing {place}")
    }

    /// Returns true if there are samples before and after the gap.
    pub fn is_inside(&self) -> bool {
        self.before.is_finite() && self.behind.is_finite()
    }
}

/// Returns the gaps between rows; empty if their number shows uneven sampling.
pub(crate) fn find_missing_rows(times: &[f64]) -> Vec<Gap> {
    let step = typical_step(times);
    let pairs = times.windows(2);
    let long = pairs.filter(|pair| pair[1] - pair[0] > MIN_GAP_STEPS * step);
    let gaps = long.map(|pair| Gap {
        column: None,
        count: ((pair[1] - pair[0]) / step - 1.0).round() as usize,
        before: pair[0],
        behind: pair[1],
    });
    let gaps: Vec<Gap> = gaps.collect();
    if gaps.len() > MAX_GAPS {
        return Vec::new();
    }
    gaps
}

/// Returns the runs of at least `fewest` empty cells of a column.
pub(crate) fn find_empty_cells(
    name: &str,
    times: &[f64],
    column: &[f64],
    fewest: usize,
) -> Vec<Gap> {
    let mut gaps = Vec::new();
    let mut begin = 0;
    while begin < column.len() {
        let known = column[begin..].iter().position(|value| value.is_finite());
        let end = known.map_or(column.len(), |length| begin + length);
        if end > begin && end - begin >= fewest {
            let before = begin.checked_sub(1).map(|last| times[last]);
            gaps.push(Gap {
                column: Some(name.to_owned()),
                count: end - begin,
                before: before.unwrap_or(f64::NEG_INFINITY),
                behind: times.get(end).copied().unwrap_or(f64::INFINITY),
            });
        }
        begin = end + 1;
    }
    gaps
}

/// Returns the runs of empty cells of a column that are as long as a gap between rows.
pub(crate) fn find_long_empty_cells(name: &str, times: &[f64], column: &[f64]) -> Vec<Gap> {
    find_empty_cells(name, times, column, MIN_GAP_STEPS as usize)
}

/// Returns the ranges of samples between the gaps of a column, from its first to its last known sample.
pub(crate) fn find_contiguous_parts(times: &[f64], column: &[f64]) -> Vec<Range<usize>> {
    let mut gaps = find_missing_rows(times);
    gaps.extend(find_long_empty_cells("", times, column));
    let is_known = |sample: &usize| column[*sample].is_finite();
    let parts = split_samples(times, gaps).into_iter();
    let trimmed = parts.filter_map(|part| {
        let first = part.clone().find(is_known)?;
        let last = part.rev().find(is_known)?;
        Some(first..last + 1)
    });
    trimmed.collect()
}

/// Returns the ranges of samples between gaps; the gaps may overlap.
pub(crate) fn split_samples(times: &[f64], mut gaps: Vec<Gap>) -> Vec<Range<usize>> {
    gaps.sort_by(|a, b| a.before.total_cmp(&b.before));
    let mut parts = Vec::with_capacity(gaps.len() + 1);
    let mut begin = 0;
    for gap in gaps {
        let end = times.partition_point(|t| *t <= gap.before);
        if end > begin {
            parts.push(begin..end);
        }
        begin = begin.max(times.partition_point(|t| *t < gap.behind));
    }
    if begin < times.len() {
        parts.push(begin..times.len());
    }
    parts
}

/// Describes the missing samples of a column by their number and the time of the first one in the file; `None` if there
/// are none.
pub(crate) fn describe_missing((times, origin): (&[f64], f64), column: &[f64]) -> Option<String> {
    let count = column.iter().filter(|value| !value.is_finite()).count();
    let first = column.iter().position(|value| !value.is_finite())?;
    let t = round_file_time(origin, *times.get(first)?);
    Some(match count {
        1 => format!("the sample at t = {t} s"),
        count => format!("{count} samples from t = {t} s on"),
    })
}
