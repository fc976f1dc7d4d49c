//! Finished chunk as a text file. Three header lines identify the job and the points; one line per
//! point follows, in the order of the grid:
//!
//! ```text
//! eomgen sweep part 1
//! job 64 HEXADECIMAL DIGITS
//! points 00000120 00000130
//! 3ff0000000000000 7ff8000000000000 ...
//! ```
//!
//! Points are counted from 0; the last one is excluded. A number is the 16 hexadecimal digits of
//! its bits. This is exact, and the length of every part is known: a file with another length is
//! incomplete.

use std::fmt::Write;

use super::job::Job;

const TITLE: &str = "eomgen sweep part 1";

#[derive(Debug, PartialEq, Eq)]
pub enum PartState {
    Complete,
    Damaged,
    OtherJob,
}

/// Returns the bytes of a chunk. All NaNs become equal, because their bits depend on the machine.
pub fn encode(job: &Job, chunk: usize, numbers: &[f64]) -> String {
    let mut text = header(job, chunk);
    text.reserve(numbers.len() * 17);
    for row in numbers.chunks(job.measured_count()) {
        for (place, number) in row.iter().enumerate() {
            let number = if number.is_nan() { f64::NAN } else { *number };
            let between = if place == 0 { "" } else { " " };
            let _ = write!(text, "{between}{:016x}", number.to_bits());
        }
        text.push('\n');
    }
    text
}

pub fn header_length(job: &Job) -> usize {
    header(job, 0).len()
}

pub fn inspect_part(job: &Job, chunk: usize, length: u64, start: &[u8]) -> PartState {
    let expected = header(job, chunk);
    let whole = expected.len() + job.chunk_range(chunk).len() * job.measured_count() * 17;
    if start == expected.as_bytes() {
        return if length == whole as u64 {
            PartState::Complete
        } else {
            PartState::Damaged
        };
    }
    let lines = |text: &str| text.lines().take(2).map(str::to_owned).collect::<Vec<_>>();
    let found = lines(&String::from_utf8_lossy(start));
    let is_part = found.len() == 2 && found[0] == TITLE && start.len() == expected.len();
    if is_part && found != lines(&expected) {
        return PartState::OtherJob;
    }
    PartState::Damaged
}

/// Parses the numbers of a complete part, point by point; `None` if it is incomplete.
pub fn decode(job: &Job, chunk: usize, bytes: &[u8]) -> Option<Vec<f64>> {
    let text = std::str::from_utf8(bytes).ok()?;
    let body = text.strip_prefix(&header(job, chunk))?;
    let count = job.chunk_range(chunk).len() * job.measured_count();
    if body.len() != count * 17 {
        return None;
    }
    let numbers = body.split_ascii_whitespace().map(|digits| {
        let bits = u64::from_str_radix(digits, 16).ok()?;
        (digits.len() == 16).then(|| f64::from_bits(bits))
    });
    let numbers = numbers.collect::<Option<Vec<f64>>>()?;
    (numbers.len() == count).then_some(numbers)
}

fn header(job: &Job, chunk: usize) -> String {
    let points = job.chunk_range(chunk);
    format!(
        "{TITLE}\njob {}\npoints {:08} {:08}\n",
        job.hash(),
        points.start,
        points.end
    )
}

#[cfg(test)]
mod tests {
    use super::super::job::tests::job;
    use super::*;

    /// Returns numbers of a chunk with two points and two numbers per point.
    fn numbers() -> [f64; 4] {
        [-0.0, f64::NAN, f64::NEG_INFINITY, 5e-324]
    }

    #[test]
    fn numbers_are_read_back_with_all_bits() {
        let job = job(2000);
        let text = encode(&job, 7, &numbers());
        let read = decode(&job, 7, text.as_bytes()).expect("a whole part");
        let bits = |numbers: &[f64]| numbers.iter().map(|n| n.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&read), bits(&numbers()));
        assert_eq!(
            encode(&job, 7, &[-f64::NAN; 4]),
            encode(&job, 7, &[f64::NAN; 4])
        );
    }

    #[test]
    fn only_complete_part_of_job_and_chunk_is_accepted() {
        let job = job(2000);
        let text = encode(&job, 7, &numbers());
        let start = header_length(&job);
        let judged = |job: &Job, chunk, text: &str| {
            let bytes = text.as_bytes();
            inspect_part(
                job,
                chunk,
                bytes.len() as u64,
                &bytes[..start.min(bytes.len())],
            )
        };
        assert_eq!(judged(&job, 7, &text), PartState::Complete);
        assert_eq!(judged(&job, 8, &text), PartState::Damaged);
        assert_eq!(
            judged(&super::super::job::tests::job(1999), 7, &text),
            PartState::OtherJob
        );
        for length in 0..text.len() {
            assert_eq!(
                judged(&job, 7, &text[..length]),
                PartState::Damaged,
                "{length}"
            );
            assert_eq!(
                decode(&job, 7, &text.as_bytes()[..length]),
                None,
                "{length}"
            );
        }
        assert_eq!(decode(&job, 8, text.as_bytes()), None);
        let broken = text.replace("8000000000000000", "80000000 0000000");
        assert_eq!(decode(&job, 7, broken.as_bytes()), None);
    }
}
