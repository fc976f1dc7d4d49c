//! Parts of a record between gaps. The inputs in a gap are unknown, so the parts become separate records.

use crate::gaps::{Gap, find_missing_rows, split_samples};
use crate::record::Record;
use crate::refusal::Refusal;
use crate::samples::MIN_SAMPLES;

/// Splits a record at missing rows and at `empty` cells, adds notes about these gaps to `notes`, and drops short parts.
///
/// # Errors
/// All parts between empty cells are too short.
pub(crate) fn split_at_gaps(
    record: Record,
    empty: Vec<Gap>,
    notes: &mut Vec<String>,
) -> Result<Vec<Record>, Refusal> {
    let mut gaps = find_missing_rows(&record.times);
    let has_empty_cells = !empty.is_empty();
    gaps.extend(empty);
    if gaps.is_empty() {
        return Ok(vec![record]);
    }
    let parts = split_samples(&record.times, gaps.clone());
    if parts.iter().all(|part| part.len() < MIN_SAMPLES) {
        if !has_empty_cells {
            return Ok(vec![record]);
        }
        let shown: Vec<String> = gaps
            .iter()
            .take(3)
            .map(|gap| gap.describe(record.origin))
            .collect();
        return Err(Refusal::file_error(
            &record.path,
            format!(
                "{}; no part without a gap has {MIN_SAMPLES} samples",
                shown.join(", ")
            ),
        ));
    }
    for gap in &gaps {
        let result = match gap.is_inside() {
            true => "the parts before and after are used as separate records",
            false => "this part is ignored",
        };
        notes.push(format!(
            "{}: {}: {result}",
            record.name,
            gap.describe(record.origin)
        ));
    }
    let mut found = Vec::with_capacity(parts.len());
    for part in parts {
        let begin = record.origin + record.times[part.start];
        if part.len() < MIN_SAMPLES {
            notes.push(format!(
                "{}: the {} samples from {begin:.6} s on are too few and are ignored",
                record.name,
                part.len()
            ));
            continue;
        }
        let cut = |columns: &[Vec<f64>]| -> Vec<Vec<f64>> {
            columns
                .iter()
                .map(|column| column[part.clone()].to_vec())
                .collect()
        };
        found.push(Record {
            name: match part.start {
                0 => record.name.clone(),
                _ => format!("{} from {begin:.6} s on", record.name),
            },
            path: record.path.clone(),
            times: record.times[part.clone()].to_vec(),
            origin: record.origin,
            inputs: record.inputs.clone(),
            input_columns: cut(&record.input_columns),
            channels: cut(&record.channels),
            is_continued: record.is_continued || part.start > 0,
        });
    }
    Ok(found)
}
