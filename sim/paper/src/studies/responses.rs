//! Studies of backlash (Fig. 5-10), forcing frequency (Fig. 11-15) and flexibility of the arm (Fig.
//! 16-19).

use std::f64::consts::PI;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;
use serde_json::{Value, json};

use super::arm::{Arm, Case, UndisclosedParameters};
use super::bifurcation::{Bifurcation, figure as bifurcation_figure};
use super::case::{RunLength, measure};
use super::claims::HALF_BACKLASHES_UM;
use super::display::SampledCase;
use super::error::StudyError;
use super::figures::{FigureRow, Heading, Quantity, Row, draw_rows};
use super::machine::draw_machine;
use super::overview::draw_overview;
use super::report::{Figure, Study, Table, case_json, format_case_name, list_sampled_tables};

/// Truncation order of the paper.
const PAPER_ORDER: usize = 4;

/// Callback that receives the completed fraction of the work.
pub type Progress<'a> = &'a (dyn Fn(f64) + Sync);

/// Runs the study of Fig. 5-10: omega = 5 pi, b = 0 to 100 um.
///
/// # Errors
/// A case that cannot be simulated, a figure that cannot be drawn.
pub fn backlash(progress: Progress<'_>) -> Result<(Study, Arm), StudyError> {
    responses(5.0 * PI, 5, progress)
}

/// Runs the study of Fig. 11-15: omega = 10 pi, b = 0 to 100 um.
///
/// # Errors
/// See [`backlash`].
pub fn frequency(progress: Progress<'_>) -> Result<(Study, Arm), StudyError> {
    responses(10.0 * PI, 11, progress)
}

/// Runs the study of Fig. 16-19: rigid and flexible arm at omega = 10 pi, b = 10 to 100 um.
///
/// # Errors
/// See [`backlash`].
pub fn flexibility(progress: Progress<'_>) -> Result<(Study, Arm), StudyError> {
    let arm = Arm::new(&[0, PAPER_ORDER])?;
    let pairs = HALF_BACKLASHES_UM.into_iter().filter(|b| *b > 0);
    let cases: Vec<Case> = pairs
        .flat_map(|b| [0, PAPER_ORDER].map(|order| create_paper_case(order, b, 10.0 * PI)))
        .collect();
    let (displays, mut study) = run(&arm, &cases, progress)?;
    for (index, pair) in displays.chunks(2).enumerate() {
        let [rigid, flexible] = pair else { continue };
        let row = |title: &str, display| Row {
            title: format!("{title}, {}", format_short_title(&rigid.case)),
            quantity: Quantity::MeshDeflection,
            cases: vec![(String::new(), display)],
        };
        let caption = format!(
            "Transmission error x_sp with the rigid arm (a) and, for comparison, with the \
             flexible arm, S = {PAPER_ORDER} (b), and both in the plane of x_sp and its rate (c, d); {}",
            conditions(&rigid.case)
        );
        let drawn = [
            FigureRow::TimeHistory(row("(a) rigid arm", rigid)),
            FigureRow::TimeHistory(row("(b) flexible arm", flexible)),
            FigureRow::Planes("(c) rigid arm,", rigid),
            FigureRow::Planes("(d) flexible arm,", flexible),
        ];
        let heading = Heading {
            file: format!("fig_{:02}.svg", 16 + index),
            paper: format!("Fig. {}", 16 + index),
            caption,
        };
        study.figures.push(draw_rows(heading, &drawn)?);
    }
    let found = [0, PAPER_ORDER].map(|order| Bifurcation::run(&arm, order, 10.0 * PI));
    let [rigid, flexible] = found;
    add_bifurcations(&mut study, &[rigid?, flexible?])?;
    Ok((study, arm))
}

/// Adds the bifurcation diagrams and the drawings of the machine.
fn add_bifurcations(study: &mut Study, found: &[Bifurcation]) -> Result<(), StudyError> {
    study.figures.push(bifurcation_figure(found)?);
    study.figures.extend([draw_overview(), draw_machine()]);
    study.tables.extend(found.iter().map(Bifurcation::table));
    Ok(())
}

/// Returns a case of the paper with the assumed values.
pub(super) fn create_paper_case(order: usize, micrometres: u32, omega: f64) -> Case {
    Case {
        order,
        backlash: f64::from(micrometres) * 1e-6,
        omega,
        undisclosed: UndisclosedParameters::ASSUMED,
    }
}

fn responses(
    omega: f64,
    first_figure: usize,
    progress: Progress<'_>,
) -> Result<(Study, Arm), StudyError> {
    let arm = Arm::new(&[PAPER_ORDER])?;
    let cases = HALF_BACKLASHES_UM.map(|b| create_paper_case(PAPER_ORDER, b, omega));
    let (displays, mut study) = run(&arm, &cases, progress)?;
    for (index, display) in displays.iter().enumerate() {
        study
            .figures
            .push(draw_response(first_figure + index, display)?);
    }
    let backlash = first_figure == 5;
    let paper = if backlash { "Fig. 10" } else { "" };
    let file = if backlash { "fig_10.svg" } else { "dr.svg" };
    let with_play = displays.get(1..).unwrap_or_default();
    study
        .figures
        .push(draw_deflections(paper, file, with_play)?);
    add_bifurcations(&mut study, &[Bifurcation::run(&arm, PAPER_ORDER, omega)?])?;
    Ok((study, arm))
}

fn draw_response(number: usize, display: &SampledCase) -> Result<Figure, StudyError> {
    let row = |title: &str, quantity| Row {
        title: format!("{title}, {}", format_short_title(&display.case)),
        quantity,
        cases: vec![(String::new(), display)],
    };
    let caption = format!(
        "Dynamic response of the system with flexible arm, S = {PAPER_ORDER}: transmission error x_sp \
         (a), positioning error f_la (b), and x_sp over its rate in a forcing period and once per \
         period (c); {}",
        conditions(&display.case)
    );
    let drawn = [
        FigureRow::TimeHistory(row("(a) x_sp", Quantity::MeshDeflection)),
        FigureRow::TimeHistory(row("(b) f_la", Quantity::PositioningError)),
        FigureRow::Planes("(c)", display),
    ];
    let heading = Heading {
        file: format!("fig_{number:02}.svg"),
        paper: format!("Fig. {number}"),
        caption,
    };
    draw_rows(heading, &drawn)
}

/// Draws dr of several cases, one below the other.
fn draw_deflections(
    paper: &str,
    file: &str,
    displays: &[SampledCase],
) -> Result<Figure, StudyError> {
    let letters = ["(a)", "(b)", "(c)", "(d)"];
    let mut drawn = Vec::with_capacity(displays.len());
    for (display, letter) in displays.iter().zip(letters) {
        drawn.push(FigureRow::TimeHistory(Row {
            title: format!("{letter} {}", format_short_title(&display.case)),
            quantity: Quantity::ArmDeflection,
            cases: vec![(String::new(), display)],
        }));
    }
    let omega = displays.first().map_or(0.0, |d| d.case.omega / PI);
    let caption = format!(
        "Flexible deformation dr = w(l, t) of the arm's end, omega = {omega:.0} pi rad/s, after \
         the transient; f_1 to f_6 are the natural frequencies with both meshes closed"
    );
    let heading = Heading {
        file: file.to_owned(),
        paper: paper.to_owned(),
        caption,
    };
    draw_rows(heading, &drawn)
}

/// Returns a short description of a case for the title of a panel.
fn format_short_title(case: &Case) -> String {
    let (micrometres, multiple) = (case.backlash * 1e6, case.omega / PI);
    format!("b = {micrometres:.0} µm, ω = {multiple:.0}π rad/s")
}

fn conditions(case: &Case) -> String {
    format!(
        "b = {:.0} um, omega = {:.0} pi rad/s; after the transient, time from the start at \
         rest; f_1, f_2, .. are the natural frequencies with both meshes closed",
        case.backlash * 1e6,
        case.omega / PI
    )
}

/// Measures and samples cases in parallel.
pub(super) fn run(
    arm: &Arm,
    cases: &[Case],
    progress: Progress<'_>,
) -> Result<(Vec<SampledCase>, Study), StudyError> {
    let done = AtomicUsize::new(0);
    let whole = 2.0 * cases.len() as f64;
    let step = || progress((done.fetch_add(1, Ordering::Relaxed) + 1) as f64 / whole);
    let found = cases.par_iter().map(|each| {
        // The long record has 100 MB and is dropped; the transient time, the section and the numbers are kept.
        let (transient, section, mut report) = measure_case(arm, each)?;
        step();
        let display = SampledCase {
            section,
            ..SampledCase::sample(arm, each, transient)?
        };
        report["natural_frequencies"] = json!(display.natural);
        step();
        Ok((display, report))
    });
    let found: Vec<(SampledCase, Value)> = found.collect::<Result<_, StudyError>>()?;
    let (displays, cases): (Vec<SampledCase>, Vec<Value>) = found.into_iter().unzip();
    let study = Study {
        figures: Vec::new(),
        tables: displays.iter().flat_map(list_tables).collect(),
        cases,
        further_entries: vec![("notes", json!(NOTES))],
    };
    Ok((displays, study))
}

/// Returns the transient time, the section and the numbers of a case.
fn measure_case(arm: &Arm, each: &Case) -> Result<(f64, Vec<f64>, Value), StudyError> {
    let measured = measure(arm, each, &RunLength::FULL)?;
    let mut report = case_json(&measured);
    report["section"] = json!(section_table(each));
    Ok((measured.transient, measured.section, report))
}

fn section_table(each: &Case) -> String {
    format!("{}_section.parquet", format_case_name(each))
}

/// Returns all tables of a case: time series, spectra and section.
fn list_tables(display: &SampledCase) -> Vec<Table> {
    let names = ["x_sp", "x_pr", "x_sp_dot", "x_pr_dot"]
        .into_iter()
        .enumerate();
    let columns =
        names.map(|(index, name)| (name.to_owned(), display.extract_section_column(index)));
    let section = Table {
        file: section_table(&display.case),
        columns: columns.collect(),
    };
    list_sampled_tables(display)
        .into_iter()
        .chain([section])
        .collect()
}

/// Definitions of the numbers in the JSON document.
const NOTES: [&str; 8] = [
    "lengths in m, times in s, exponents in 1/s, densities in m^2/Hz; t = 0 is the start at rest",
    "rms is about the mean; peak is the greatest magnitude",
    "numbers are from 400 forcing periods after the transient, spectra of the figures from 40 s; the figures show 2 s",
    "the figures draw densities below 1e-13 of the greatest at that level",
    "f_la is Eq. (24) as printed, l dtheta + dr; trend is the logarithm of the ratio of its rms in the second half of the record to that in the first",
    "natural_frequencies are those with both meshes in contact on one side, Hz; dominant_band uses those of the clamped arm, which are lower",
    "the section has a point per forcing period; bifurcation tables have x_sp and dr at 80 forcing periods after 160 from rest, for each b",
    "dominant_mode is the mode with the largest vibration at the arm's end, at frequencies from the lower limit of the first mode's band on; dominant_mode_with_static includes lower frequencies",
];
