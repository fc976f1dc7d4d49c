//! Parallel computation of the missing chunks of a job.

use std::ops::Range;
use std::sync::Mutex;

use rayon::ThreadPoolBuilder;
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};

use super::error::SweepError;
use super::folder::Folder;
use super::job::Job;
use super::measure::{Failure, Measure, Worker};
use super::shard::Shard;

/// Result of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RunSummary {
    /// Number of points of this shard that were already complete.
    pub complete_points: usize,
    /// Number of computed points.
    pub computed_points: usize,
}

/// Worker with the ranges of its numbers at a point, one range per description; a status follows each range.
struct WorkerColumns<'a> {
    worker: Box<dyn Worker + 'a>,
    ranges: Vec<Range<usize>>,
    numbers: Vec<f64>,
}

/// Computes the missing chunks of a shard, with the plan's `measures` and `threads` threads (0: one per core).
/// `progress` receives the number of computed points and the number of all points.
///
/// # Errors
/// Parts of another job in the folder, files that cannot be read or written, or threads that cannot be started.
/// Finished chunks are kept for the next run.
pub fn run(
    folder: &Folder,
    measures: &[Box<dyn Measure + '_>],
    shard: Shard,
    threads: usize,
    progress: &mut (dyn FnMut(usize, usize) + Send),
) -> Result<RunSummary, SweepError> {
    run_with_check((folder, measures), shard, threads, progress, &|| {})
}

/// Computes the missing chunks like [`run`]. `check` is called before each point and between steps of the solvers. It
/// stops the run if it unwinds: then each thread ends its point at the next check, and no further point starts.
///
/// # Errors
/// Those of [`run`].
pub fn run_with_check(
    (folder, measures): (&Folder, &[Box<dyn Measure + '_>]),
    shard: Shard,
    threads: usize,
    progress: &mut (dyn FnMut(usize, usize) + Send),
    check: &(dyn Fn() + Sync),
) -> Result<RunSummary, SweepError> {
    let job = folder.job();
    let (missing, found) = missing_chunks(folder, shard)?;
    let whole = missing
        .iter()
        .map(|chunk| job.chunk_range(*chunk).len())
        .sum();
    let state = Mutex::new((0, progress));
    let point_is_done = || {
        // A thread that panicked while it held the lock did not change the count.
        let mut state = state
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner);
        state.0 += 1;
        let computed = state.0;
        (state.1)(computed, whole);
    };
    let pool = ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|error| SweepError::Request(format!("cannot start threads: {error}")))?;
    pool.install(|| {
        missing.par_iter().try_for_each_init(
            || workers(measures),
            |workers, chunk| {
                let numbers = compute_chunk(job, *chunk, workers, (check, &point_is_done));
                folder.store(*chunk, &numbers)
            },
        )
    })?;
    Ok(RunSummary {
        complete_points: found,
        computed_points: whole,
    })
}

/// Returns the missing chunks of a shard, and the number of its complete points.
fn missing_chunks(folder: &Folder, shard: Shard) -> Result<(Vec<usize>, usize), SweepError> {
    let job = folder.job();
    let (mut missing, mut found) = (Vec::new(), 0);
    for chunk in (0..job.chunk_count()).filter(|chunk| shard.contains(*chunk)) {
        if folder.has_chunk(chunk)? {
            found += job.chunk_range(chunk).len();
        } else {
            missing.push(chunk);
        }
    }
    Ok((missing, found))
}

fn workers<'a>(measures: &'a [Box<dyn Measure + 'a>]) -> Vec<WorkerColumns<'a>> {
    let mut start = 0;
    let workers = measures.iter().map(|measure| {
        let descriptions = measure.describe().into_iter();
        let ranges = descriptions.map(|own| {
            let range = start..start + own.columns.len();
            start = range.end + 1;
            range
        });
        let ranges: Vec<Range<usize>> = ranges.collect();
        WorkerColumns {
            worker: measure.worker(),
            numbers: vec![f64::NAN; ranges.iter().map(Range::len).sum()],
            ranges,
        }
    });
    workers.collect()
}

/// Returns the numbers of a chunk, point by point: for each measure its numbers, then its status.
fn compute_chunk(
    job: &Job,
    chunk: usize,
    workers: &mut [WorkerColumns<'_>],
    (check, point_is_done): (&dyn Fn(), &dyn Fn()),
) -> Vec<f64> {
    let points = job.chunk_range(chunk);
    let mut numbers = vec![f64::NAN; points.len() * job.measured_count()];
    for (point, row) in points.zip(numbers.chunks_mut(job.measured_count())) {
        let settings = job.points().settings(point);
        check();
        for columns in workers.iter_mut() {
            columns.numbers.fill(f64::NAN);
            let outcome = columns
                .worker
                .measure(&settings, &mut columns.numbers, check);
            let status = outcome.map_or_else(|failure| f64::from(failure.code()), |()| 0.0);
            let mut found = &columns.numbers[..];
            for range in &columns.ranges {
                let (own, rest) = found.split_at(range.len());
                // For too few crossings, the worker wrote only their number.
                if matches!(outcome, Ok(()) | Err(Failure::FewCrossings(_))) {
                    row[range.clone()].copy_from_slice(own);
                }
                row[range.end] = status;
                found = rest;
            }
        }
        point_is_done();
    }
    numbers
}

#[cfg(test)]
mod tests {
    use super::super::job::tests::job;
    use super::super::measure::Description;
    use super::super::merge::merge;
    use super::*;

    /// Measure 1/x, undefined at 0. It leaves the previous result in its memory, which must not appear at later points.
    struct Reciprocal;

    impl Measure for Reciprocal {
        fn describe(&self) -> Vec<Description> {
            vec![job(2).plan().measures[0].clone()]
        }

        fn worker(&self) -> Box<dyn Worker + '_> {
            Box::new(Reciprocal)
        }
    }

    impl Worker for Reciprocal {
        fn measure(
            &mut self,
            settings: &[(&str, f64)],
            out: &mut [f64],
            _check: &dyn Fn(),
        ) -> Result<(), Failure> {
            out[0] = 1.0 / settings[0].1;
            if settings[0].1 == 0.0 {
                return Err(Failure::Undefined);
            }
            Ok(())
        }
    }

    fn measures() -> Vec<Box<dyn Measure>> {
        vec![Box::new(Reciprocal)]
    }

    #[test]
    fn failed_points_have_codes_and_others_continue() {
        let place = tempfile::tempdir().expect("a folder");
        let folder = Folder::open(place.path(), job(5)).expect("a new sweep");
        let mut seen = Vec::new();
        let mut progress = |done, whole| seen.push((done, whole));
        let done = run(&folder, &measures(), Shard::WHOLE, 2, &mut progress).expect("a run");
        assert_eq!((done.complete_points, done.computed_points), (0, 5));
        assert_eq!(seen, [(1, 5), (2, 5), (3, 5), (4, 5), (5, 5)]);
        let table = merge(&folder).expect("all is there");
        assert_eq!(table.names, ["x", "m_value", "m_status"]);
        assert_eq!(table.columns[0], [0.0, 0.25, 0.5, 0.75, 1.0]);
        assert!(table.columns[1][0].is_nan());
        assert_eq!(table.columns[1][1..], [4.0, 2.0, 1.0 / 0.75, 1.0]);
        assert_eq!(table.columns[2], [5.0, 0.0, 0.0, 0.0, 0.0]);
    }

    #[test]
    fn finished_chunks_are_kept_and_damaged_ones_repeated() {
        let place = tempfile::tempdir().expect("a folder");
        let folder = Folder::open(place.path(), job(5)).expect("a new sweep");
        let go = || run(&folder, &measures(), Shard::WHOLE, 1, &mut |_, _| {}).expect("a run");
        go();
        let first = merge(&folder).expect("all is there");
        assert_eq!(
            go(),
            RunSummary {
                complete_points: 5,
                computed_points: 0
            }
        );
        let part = place.path().join("parts/0003.part");
        let bytes = std::fs::read(&part).expect("the part");
        std::fs::write(&part, &bytes[..bytes.len() - 1]).expect("a part cut short");
        assert_eq!(
            go(),
            RunSummary {
                complete_points: 4,
                computed_points: 1
            }
        );
        assert_eq!(std::fs::read(&part).expect("the part"), bytes);
        assert_eq!(
            merge(&folder).expect("all is there").columns[2],
            first.columns[2]
        );
    }

    #[test]
    fn merge_reports_gaps() {
        let place = tempfile::tempdir().expect("a folder");
        let folder = Folder::open(place.path(), job(7)).expect("a new sweep");
        let shard = Shard::parse("2/3").expect("a shard");
        run(&folder, &measures(), shard, 1, &mut |_, _| {}).expect("a run");
        let error = merge(&folder)
            .expect_err("two shards are missing")
            .to_string();
        assert!(error.contains("5 of 7 points"), "{error}");
        assert!(error.contains("0 to 0, 2 to 3, 5 to 6"), "{error}");
    }

    #[test]
    fn another_job_in_folder_is_rejected() {
        let place = tempfile::tempdir().expect("a folder");
        let folder = Folder::open(place.path(), job(5)).expect("a new sweep");
        run(&folder, &measures(), Shard::WHOLE, 1, &mut |_, _| {}).expect("a run");
        let error = Folder::open(place.path(), job(6))
            .expect_err("another job")
            .to_string();
        assert!(error.contains("differences: --vary"), "{error}");
        let elsewhere = tempfile::tempdir().expect("a folder");
        let other = Folder::open(elsewhere.path(), job(6)).expect("a new sweep");
        let name = "parts/0001.part";
        std::fs::copy(place.path().join(name), elsewhere.path().join(name)).expect("a copy");
        let error = merge(&other)
            .expect_err("a part of another job")
            .to_string();
        assert!(error.contains("belongs to a different sweep"), "{error}");
    }
}
