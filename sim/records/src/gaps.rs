//! Stretches of a record that were lost: nothing is known of what drove the machine there, so what
//! lies before and behind are records of their own.

use crate::record::Record;
use crate::samples::{FEWEST_SAMPLES, LOST, typical_step};

/// A record that more gaps part is taken as it is: its steps differ, nothing was lost.
const MOST: usize = 20;

/// The parts of a record between lost stretches, those with few samples left out; the record where
/// nothing was lost. `notes` are told where that was.
pub(crate) fn unbroken(record: Record, notes: &mut Vec<String>) -> Vec<Record> {
    let step = typical_step(&record.times);
    let steps = record.times.windows(2).enumerate();
    let gaps: Vec<usize> = steps
        .filter(|(_, pair)| pair[1] - pair[0] > LOST * step)
        .map(|(before, _)| before + 1)
        .collect();
    if gaps.is_empty() || gaps.len() > MOST {
        return vec![record];
    }
    let ends = gaps.iter().copied().chain([record.times.len()]);
    let begins = [0].into_iter().chain(gaps.iter().copied());
    let parts: Vec<std::ops::Range<usize>> = begins.zip(ends).map(|(a, b)| a..b).collect();
    if parts.iter().all(|part| part.len() < FEWEST_SAMPLES) {
        return vec![record];
    }
    for gap in &gaps {
        let (before, behind) = (record.times[gap - 1], record.times[*gap]);
        notes.push(format!(
            "{}: nothing was recorded from {before:.6} s to {behind:.6} s, where {:.0} samples would be: \
             what lies before and behind is taken for two records",
            record.name,
            (behind - before) / step - 1.0
        ));
    }
    let mut found = Vec::with_capacity(parts.len());
    for part in parts {
        let begin = record.times[part.start];
        if part.len() < FEWEST_SAMPLES {
            notes.push(format!(
                "{}: {} samples from {begin:.6} s on are too few and not used",
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
