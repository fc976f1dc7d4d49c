//! `blind` generates the cases of a seed, runs the program on each case and counts correct results.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use clap::Parser;
use eomgen_blind::history::{self, Run};
use eomgen_blind::plan::{Case, Group, plan};
use eomgen_blind::score::{self, Score};
use eomgen_blind::{records, run};

const DEFAULT_TIME_LIMIT_S: f64 = 240.0;

/// Hides effects in records, runs `eomgen discover` on them, and scores the results.
#[derive(Parser)]
#[command(after_help = "Example:\n  blind --seed 1 --out blind-1 --only single")]
struct Options {
    /// Seed of all cases
    #[arg(long)]
    seed: u64,
    /// Folder for cases, labels, results and the score; existing results are reused
    #[arg(long)]
    out: PathBuf,
    /// Runs only these cases, as first..end
    #[arg(long, value_parser = parse_range)]
    cases: Option<Range<usize>>,
    /// Runs only cases of this group: single, nothing, pair, outside or untellable
    #[arg(long, value_parser = parse_group)]
    only: Option<Group>,
    /// Time limit of a case on one core, s; a record may take half of it on two cores
    #[arg(long, default_value_t = DEFAULT_TIME_LIMIT_S)]
    limit: f64,
    /// Appends the success rates to tests/blind/history.csv
    #[arg(long)]
    keep: bool,
}

fn parse_range(text: &str) -> Result<Range<usize>, String> {
    let parts = text.split_once("..").map(|(a, b)| (a.parse(), b.parse()));
    match parts {
        Some((Ok(first), Ok(end))) if first < end => Ok(first..end),
        _ => Err("expected first..end, as 0..10".to_owned()),
    }
}

fn parse_group(text: &str) -> Result<Group, String> {
    serde_json::from_value(serde_json::json!(text))
        .map_err(|_| "expected single, nothing, pair, outside or untellable".to_owned())
}

fn main() -> ExitCode {
    match run_suite(&Options::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::from(2)
        }
    }
}

fn run_suite(options: &Options) -> Result<(), String> {
    let program = find_program()?;
    check_seed(&options.out, options.seed)?;
    let wanted = |case: &Case| {
        options
            .cases
            .as_ref()
            .is_none_or(|range| range.contains(&case.number))
            && options.only.is_none_or(|group| case.group == group)
    };
    let cases: Vec<Case> = plan(options.seed).into_iter().filter(wanted).collect();
    let limit = Duration::try_from_secs_f64(options.limit).map_err(|error| error.to_string())?;
    let next = AtomicUsize::new(0);
    let work = || -> Result<(), String> {
        while let Some(case) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
            let name_case = |error: std::io::Error| format!("case {}: {error}", case.number);
            records::make_case(case, options.seed, specifications(), &options.out)
                .map_err(name_case)?;
            run::run(&program, &options.out, case.number, limit).map_err(name_case)?;
            eprint!(
                "\r{} of {} ",
                next.load(Ordering::Relaxed).min(cases.len()),
                cases.len()
            );
        }
        Ok(())
    };
    std::thread::scope(|scope| {
        let workers = [scope.spawn(work), scope.spawn(work)];
        workers
            .into_iter()
            .try_for_each(|worker| match worker.join() {
                Ok(result) => result,
                Err(_) => Err("a case could not be created".to_owned()),
            })
    })?;
    eprintln!();
    let numbers: Vec<usize> = cases.iter().map(|case| case.number).collect();
    let score = score::score(&options.out, &numbers).map_err(|error| error.to_string())?;
    print!("{}", score::table(&score));
    let document = serde_json::to_string_pretty(&score).map_err(|error| error.to_string())?;
    let path = options.out.join("score.json");
    records::write_whole(&path, &(document + "\n")).map_err(|error| error.to_string())?;
    match options.keep {
        true => append_history(options, &score),
        false => Ok(()),
    }
}

fn append_history(options: &Options, score: &Score) -> Result<(), String> {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/history.csv"));
    let kept = match std::fs::read_to_string(path) {
        Ok(kept) => kept,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => history::heading(),
        Err(error) => return Err(format!("{}: {error}", path.display())),
    };
    let run = Run {
        date: run_git(&["log", "-1", "--format=%cs"]),
        commit: run_git(&["describe", "--always", "--dirty=+"]),
        command: format_command(options),
    };
    let kept = history::append_run(&kept, &run, score)?;
    records::write_whole(path, &kept).map_err(|error| error.to_string())
}

fn format_command(options: &Options) -> String {
    let mut command = format!("--seed {}", options.seed);
    if let Some(cases) = &options.cases {
        command += &format!(" --cases {}..{}", cases.start, cases.end);
    }
    if let Some(group) = options.only {
        command += &format!(" --only {}", format!("{group:?}").to_lowercase());
    }
    if options.limit != DEFAULT_TIME_LIMIT_S {
        command += &format!(" --limit {}", options.limit);
    }
    command
}

fn run_git(arguments: &[&str]) -> String {
    let output = std::process::Command::new("git").args(arguments).output();
    output.map_or_else(
        |_| String::new(),
        |output| String::from_utf8_lossy(&output.stdout).trim().to_owned(),
    )
}

fn specifications() -> &'static Path {
    Path::new(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../model-spec/models"
    ))
}

fn find_program() -> Result<PathBuf, String> {
    let own = std::env::current_exe().map_err(|error| error.to_string())?;
    let program = own.with_file_name(format!("eomgen{}", std::env::consts::EXE_SUFFIX));
    if program.is_file() {
        Ok(program)
    } else {
        Err(format!(
            "there is no {}; build it first: cargo build --release",
            program.display()
        ))
    }
}

fn check_seed(out: &Path, seed: u64) -> Result<(), String> {
    let path = out.join("seed.txt");
    match std::fs::read_to_string(&path) {
        Ok(text) if text.trim() == seed.to_string() => Ok(()),
        Ok(text) => Err(format!(
            "{} holds the cases of seed {}; give another folder to seed {seed}",
            out.display(),
            text.trim()
        )),
        Err(_) => {
            records::write_whole(&path, &format!("{seed}\n")).map_err(|error| error.to_string())
        }
    }
}
