//! Gaps in a record. The inputs in a gap are unknown, so the parts become separate records.

use crate::record::Record;
use crate::samples::{MIN_GAP_STEPS, MIN_SAMPLES, typical_step};

/// Number of gaps above which a record has uneven steps and is not split.
const MAX_GAPS: usize = 20;

/// Splits a record at gaps, which are added to `notes`, and drops short parts.
pub(crate) fn split_at_gaps(record: Record, notes: &mut Vec<String>) -> Vec<Record> {
    let step = typical_step(&record.times);
    let steps = record.times.windows(2).enumerate();
    let gaps: Vec<usize> = steps
        .filter(|(_, pair)| pair[1] - pair[0] > MIN_GAP_STEPS * step)
        .map(|(before, _)| before + 1)
        .collect();
    if gaps.is_empty() || gaps.len() > MAX_GAPS {
        return vec![record];
    }
    let ends = gaps.iter().copied().chain([record.times.len()]);
    let begins = [0].into_iter().chain(gaps.iter().copied());
    let parts: Vec<std::ops::Range<usize>> = begins.zip(ends).map(|(a, b)| a..b).collect();
    if parts.iter().all(|part| part.len() < MIN_SAMPLES) {
        return vec![record];
    }
    for gap in &gaps {
        let (before, behind) = (record.times[gap - 1], record.times[*gap]);
        notes.push(format!(
            "{}: {:.0} samples are missing between {before:.6} s and {behind:.6} s: \
             the parts before and after are used as separate records",
            record.name,
            (behind - before) / step - 1.0
        ));
    }
    let mut found = Vec::with_capacity(parts.len());
    for part in parts {
        let begin = record.times[part.start];
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
            inputs: record.inputs.clone(),
            input_columns: cut(&record.input_columns),
            channels: cut(&record.channels),
            is_continued: record.is_continued || part.start > 0,
        });
    }
    found
}
