//! Tour: runs every step on the paper's arm and a discovery on a positioning stage. It writes one HTML page and the
//! files that the page shows.

mod hidden;
mod moving_arm;
mod symbols;

use std::path::{Path, PathBuf};
use std::time::Instant;

use eomgen_codegen::program::evaluator::Evaluator;
use eomgen_codegen::report::Report;
use eomgen_codegen::rust::{self, Packaging};
use eomgen_compiled_model::{CompiledModel, Instance, Motion, Request, Solver};
use eomgen_model_spec::models;
use eomgen_model_spec::source::Source;
use eomgen_page::Figure;
use eomgen_plot::{FigureWidth, Panel, Reference, Series, TimeHistory, time_history_at};
use eomgen_validate::certificate::{Certificate, Check};
use eomgen_validate::model_certificate::certify_model;

use crate::certification::{applicable_checks, document, group_checks, statement};
use crate::count::count;
use crate::emitted_files::CERTIFICATE;
use crate::engines::quote;
use crate::error::{Error, Result};
use crate::model::derive;
use crate::motion::{describe_work, simulate, table};
use crate::output::{file_place, write_file};
use crate::page::{self, InteractivePart};
use crate::progress::Note;
use crate::table::Table;
use hidden::{Rediscovery, rediscover};
use symbols::{piecewise_functions, symbols};

const SPECIFICATION: &str = models::PLANETARY_ARM.text;

/// Path of the specification in the project.
const SPECIFICATION_PATH: &str = "model-spec/models/planetary_arm.toml";

/// Name of the written specification.
const ARM_FILE: &str = "planetary_arm.toml";

/// Truncation order of the paper.
const ORDER: usize = 4;

/// Simulated time and output interval, s.
const UNTIL: f64 = 2.0;
const INTERVAL: f64 = 0.0005;

/// Relative tolerance. It has no effect on the exact solver, which is used if the arm is linear between its switches.
const TOLERANCE: f64 = 1e-10;

/// Durations of the steps, s.
struct Stopwatch {
    started: Instant,
    steps: Vec<(&'static str, f64)>,
}

impl Stopwatch {
    fn lap(&mut self, step: &'static str) {
        self.steps
            .push((step, self.started.elapsed().as_secs_f64()));
        self.started = Instant::now();
    }
}

/// Result of a tour.
pub struct TourResult {
    pub page: PathBuf,
    pub certificate: Certificate,
    /// Number of switches between contact and separation in the meshes.
    pub switches: usize,
}

/// Runs every step and writes the page and its files to a folder.
pub fn run(out: &Path) -> Result<TourResult> {
    let path = out.join("index.html");
    file_place(&path)?;
    let mut watch = Stopwatch {
        started: Instant::now(),
        steps: Vec::new(),
    };
    let note = Note::new("deriving and emitting the equations of the paper's arm");
    let checked = eomgen_model_spec::check(Source::new(SPECIFICATION_PATH, SPECIFICATION))
        .map_err(Error::Specification)?;
    watch.lap("read and check the specification");
    let compiled = derive(checked.model, &[ORDER])?;
    watch.lap("derive the equations and lower them to a program");
    let rust = rust::emit(compiled.program(), Packaging::Crate)?;
    watch.lap("emit Rust");
    drop(note);
    let note = Note::new("validating against independent equations");
    let certificate = certify_model(compiled.model(), &[ORDER], &[])?;
    watch.lap("validate, including a compilation of the emitted Rust");
    drop(note);
    let run = compiled.with_declared_parameters()?;
    let times: Vec<f64> = (0..=(UNTIL / INTERVAL) as usize)
        .map(|i| i as f64 * INTERVAL)
        .collect();
    let request = Request {
        initial: run.initial_state(),
        times: &times,
        inputs: &run.default_inputs(),
        solver: Solver::Auto,
        tolerance: TOLERANCE,
        max_step: f64::INFINITY,
        audit: false,
    };
    let motion = simulate(&run, &request)?;
    let table = table(&run, &motion)?;
    watch.lap("simulate two seconds");
    let figures = [FigureWidth::Wide, FigureWidth::Narrow].map(|width| figure(&run, &table, width));
    let [wide, narrow] = figures;
    let figures = [wide?, narrow?];
    write_files(out, &compiled, &rust, &certificate, &table, &figures[0])?;
    let moving = moving_arm::specification();
    write_file(&out.join(moving_arm::PATH), moving.as_bytes())?;
    let arm = moving_arm::derive_arm(&moving, ORDER)?;
    let initial = arm.with_declared_parameters()?.initial_state().to_vec();
    let arm = InteractivePart::of_parameters(&arm, &initial, &moving_arm::MOVED)?;
    let note = Note::new("discovering a hidden friction in a positioning stage");
    let rediscovery = rediscover(out)?;
    watch.lap("hide a friction in a positioning stage, compare, discover");
    drop(note);
    let parts = Parts {
        rust: &rust,
        figures: &figures,
        rediscovery: &rediscovery,
        certificate: &certificate,
        motion: &motion,
        arm: &arm,
        out,
    };
    let page = page_text(&run, &parts, &watch)?;
    write_file(&path, page.as_bytes())?;
    Ok(TourResult {
        page: path,
        certificate,
        switches: motion.trajectory.events.len(),
    })
}

fn write_files(
    out: &Path,
    compiled: &CompiledModel,
    rust: &str,
    certificate: &Certificate,
    table: &Table,
    figure: &str,
) -> Result {
    let json = document(certificate)?;
    write_file(&out.join(ARM_FILE), compiled.model().source.text.as_bytes())?;
    write_file(&out.join("lib.rs"), rust.as_bytes())?;
    write_file(&out.join(CERTIFICATE), json.as_bytes())?;
    let trajectory = out.join("trajectory.csv");
    write_file(&trajectory, &table.encode(Path::new("trajectory.csv"))?)?;
    write_file(&out.join("trajectory.svg"), figure.as_bytes())
}

/// Draws mesh deflection and positioning error over time.
fn figure(run: &Instance<'_>, table: &Table, width: FigureWidth) -> Result<String> {
    let column = |name: &str| {
        table
            .column(name)
            .ok_or_else(|| Error::input(format!("the trajectory has no column {name}")))
    };
    let t = column("t")?;
    let backlash = run.value("b_sp").unwrap_or(f64::NAN);
    let panel = |title: &str, name: &str, references: Vec<Reference>| -> Result<Panel<'_>> {
        Ok(Panel {
            title: title.to_owned(),
            quantity: name.to_owned(),
            unit: "m".to_owned(),
            series: vec![Series {
                label: name.to_owned(),
                abscissa: t,
                values: column(name)?,
                ..Series::default()
            }],
            references,
        })
    };
    let limits = [("+b_sp", backlash), ("−b_sp", -backlash)];
    let references = limits
        .iter()
        .map(|(label, value)| Reference {
            label: (*label).to_owned(),
            value: *value,
        })
        .collect();
    let history = TimeHistory {
        title: "Motion of the arm over two seconds from rest".to_owned(),
        panels: vec![
            panel(
                "Relative displacement of sun and planet along the line of action",
                "x_sp",
                references,
            )?,
            panel(
                "Positioning error of the arm's end, Eq. (24) of the paper",
                "f_la",
                Vec::new(),
            )?,
        ],
    };
    time_history_at(&history, width).map_err(|error| Error::input(error.to_string()))
}

/// Source of the equation numbers on the page.
const REFERENCE: &str = "Equation numbers on this page are those of the paper \"Influence of backlash in gear reducer on \
    dynamic of single-link manipulator arm\".";

/// Caption of the figure of the simulation.
const CAPTION: &str = "Top: the tooth flanks are in contact outside the dashed lines and separated between them; each \
    contact vibrates at the natural frequency of the mesh. Bottom: positioning error f_la of the arm's end. It is the \
    length of the arm times the angle error from backlash, plus the deflection of the end.";

/// Results that are shown on the page.
struct Parts<'a> {
    rust: &'a str,
    /// Wide and narrow figure of the simulation.
    figures: &'a [String; 2],
    rediscovery: &'a Rediscovery,
    certificate: &'a Certificate,
    motion: &'a Motion,
    arm: &'a InteractivePart,
    /// Folder of the page.
    out: &'a Path,
}

/// Renders the page.
fn page_text(run: &Instance<'_>, parts: &Parts<'_>, watch: &Stopwatch) -> Result<String> {
    let compiled = run.model();
    let Parts {
        rust,
        figures: [wide, narrow],
        rediscovery,
        certificate,
        motion,
        arm,
        out,
    } = parts;
    let evaluator = Evaluator::new(compiled.program().clone());
    let report = Report::new(compiled.model(), compiled.equations(), &evaluator);
    let summary = format!(
        "From rest over {UNTIL} s at order {ORDER}, with the paper's values and assumed values for undisclosed ones: \
         {} between contact and separation of the teeth, {}.",
        count(motion.trajectory.events.len(), "switch"),
        describe_work(motion)
    );
    let found = rediscovery.sentence();
    let chapter = rediscovery.chapter();
    let tour = page::Tour {
        title: &compiled.model().title,
        found: &found,
        arm,
        generated_by: concat!("eomgen ", env!("CARGO_PKG_VERSION")),
        specification: page::Specification {
            path: ARM_FILE,
            reference: REFERENCE,
            text: SPECIFICATION,
            warnings: Vec::new(),
        },
        symbols: symbols(run),
        functions: piecewise_functions(compiled.model()),
        equations: &report,
        source: page::Source {
            path: "lib.rs",
            text: rust,
        },
        checks: check_rows(certificate),
        simulation: page::Simulation {
            summary: &summary,
            path: "trajectory.csv",
            figures: vec![Figure {
                svg: wide,
                narrow,
                caption: CAPTION,
            }],
        },
        hidden: chapter,
        durations: watch
            .steps
            .iter()
            .map(|(step, seconds)| page::StepDuration {
                step,
                seconds: *seconds,
            })
            .collect(),
        next: next_commands(out),
    };
    Ok(tour.render())
}

/// Returns one row for each group of checks, with the largest deviation.
fn check_rows(certificate: &Certificate) -> Vec<page::CheckRow> {
    let checks = applicable_checks(certificate);
    let row = |group: &[&Check]| {
        let worst = group.iter().filter_map(|check| check.value);
        let first = group[0];
        let regimes = match group.len() {
            1 => String::new(),
            count => format!(" This holds in {count} regimes."),
        };
        page::CheckRow {
            sentence: statement(&first.name) + &regimes,
            value: worst.reduce(f64::max),
            tolerance: first.tolerance,
            passed: first.passed,
            skipped: first.skipped.is_some(),
            detail: match first.passed {
                true => String::new(),
                false => first.detail.clone(),
            },
        }
    };
    group_checks(&checks).map(row).collect()
}

/// Returns commands for the folder from which the tour was started. They use the files in `out`.
fn next_commands(out: &Path) -> Vec<page::NextCommand<'static>> {
    let file = |path: PathBuf| quote_if_needed(&path.display().to_string());
    let arm = file(out.join(ARM_FILE));
    let hidden = out.join(hidden::FOLDER);
    let stage = file(hidden.join(hidden::SPECIFICATION_FILE));
    let dataset = file(hidden.join(hidden::DATASET_FILE));
    [
        (
            format!("eomgen derive {stage}"),
            "print the equations of the positioning stage",
        ),
        (
            format!("eomgen generate {arm} --order 16 --out arm16"),
            "emit the arm with sixteen modes",
        ),
        (
            format!(
                "eomgen simulate {arm} --until 2 --set b_sp=100e-6 --set b_pr=100e-6 --out wide.csv"
            ),
            "simulate with four times the backlash",
        ),
        (
            format!("eomgen validate {arm} --order 8"),
            "validate the arm with eight modes",
        ),
        (
            format!("eomgen discover {stage} {dataset} --out found"),
            "repeat the discovery; use a specification and records of your machine to find its missing effects",
        ),
    ]
    .into_iter()
    .map(|(command, purpose)| page::NextCommand { command, purpose })
    .collect()
}

/// Quotes a path for a shell if it has other characters than letters, digits and `/._-`.
fn quote_if_needed(path: &str) -> String {
    let is_plain = |letter: char| letter.is_alphanumeric() || "/._-".contains(letter);
    match path.chars().all(is_plain) {
        true => path.to_owned(),
        false => quote(path),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn next_commands_use_the_files_of_the_tour() {
        let commands = |out: &str| -> Vec<String> {
            let commands = next_commands(Path::new(out)).into_iter();
            commands.map(|next| next.command).collect()
        };
        assert!(
            commands("tour")
                .contains(&"eomgen validate tour/planetary_arm.toml --order 8".to_owned())
        );
        assert!(
            commands("my tour").contains(&"eomgen derive 'my tour/hidden/stage.toml'".to_owned())
        );
    }
}
