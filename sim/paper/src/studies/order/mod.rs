//! Study of the modal truncation order: Fig. 4 (S = 4 and S = 5 without backlash), and convergence
//! over S = 1 to 16 without and with backlash.
//!
//! Without backlash the machine is linear, and every quantity converges at every time. With
//! backlash the motion is chaotic, and two orders diverge exponentially. Differences are then taken
//! over a short time from the start; over a long time, only statistics are compared. `differences`
//! computes the numbers, `plates` draws the figures.

mod differences;
mod plates;
mod run;

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;
use serde_json::{Value, json};

use super::arm::{Arm, Case};
use super::case::{Amplitude, Length, measure};
use super::display::{Display, WINDOW, even_times, sampled};
use super::error::StudyError;
use super::report::{Study, case, tables};
use super::responses::{Progress, paper_case};
use differences::{convergence, numbers, table};
use plates::{chaotic, fig_4};
use run::{
    BACKLASH, COARSE_STEP, HIGHEST, OMEGA, REFERENCE, Run, SHORT, SHOWN, START, STATISTICS, STEP,
    TRANSIENT,
};

/// Runs the study of Fig. 4 and of convergence.
///
/// # Errors
/// A case that cannot be run, a figure that cannot be drawn.
pub fn order(progress: Progress<'_>) -> Result<(Study, Arm), StudyError> {
    let orders: Vec<usize> = (1..=HIGHEST).chain([REFERENCE]).collect();
    let arm = Arm::new(&orders)?;
    let done = AtomicUsize::new(0);
    let whole = (2 * orders.len() + 2 + SHOWN.len()) as f64;
    let step = || progress((done.fetch_add(1, Ordering::Relaxed) + 1) as f64 / whole);
    let requests = [0, BACKLASH].map(|b| orders.iter().map(move |s| (b, *s)));
    let requests: Vec<(u32, usize)> = requests.into_iter().flatten().collect();
    let found = requests.par_iter().map(|&(b, s)| {
        let run = run(&arm, &paper_case(s, b, OMEGA));
        step();
        run
    });
    let mut tight: Vec<Run> = found.collect::<Result<_, _>>()?;
    let loose = tight.split_off(orders.len());
    let shown = [(0, 4), (0, 5)].into_iter();
    let shown: Vec<(u32, usize)> = shown.chain(SHOWN.map(|s| (BACKLASH, s))).collect();
    let found = shown.par_iter().map(|&(b, s)| {
        let pair = display(&arm, &paper_case(s, b, OMEGA));
        step();
        pair
    });
    let found: Vec<(Display, Value)> = found.collect::<Result<_, StudyError>>()?;
    let (displays, cases): (Vec<Display>, Vec<Value>) = found.into_iter().unzip();
    let study = study(&tight, &loose, &displays, cases)?;
    Ok((study, arm))
}

fn run(arm: &Arm, each: &Case) -> Result<Run, StudyError> {
    let mut start = sampled(arm, each, &even_times(0.0, STEP, (START / STEP) as usize))?;
    start.modal.clear();
    let steps = (STATISTICS / COARSE_STEP) as usize;
    let long = even_times(TRANSIENT, COARSE_STEP, steps);
    let long = sampled(arm, each, &long)?;
    Ok(Run {
        order: each.order,
        start,
        statistics: [&long.x_sp, &long.f_la, &long.dr].map(|series| Amplitude::of(series)),
    })
}

fn display(arm: &Arm, each: &Case) -> Result<(Display, Value), StudyError> {
    let (transient, report) = {
        let measured = measure(arm, each, &Length::FULL)?;
        (measured.transient, case(&measured))
    };
    Ok((Display::of(arm, each, transient)?, report))
}

fn study(
    tight: &[Run],
    loose: &[Run],
    displays: &[Display],
    cases: Vec<Value>,
) -> Result<Study, StudyError> {
    let whole = convergence(tight, WINDOW)?;
    let short = convergence(loose, SHORT)?;
    let (without, with) = displays.split_at_checked(2).unwrap_or_default();
    let tables = displays.iter().flat_map(tables);
    Ok(Study {
        figures: vec![
            fig_4(tight, without, &whole)?,
            chaotic(loose, with, &short)?,
        ],
        tables: tables
            .chain([table("convergence_b000.csv", tight, &whole)])
            .chain([table(
                &format!("convergence_b{BACKLASH:03}.csv"),
                loose,
                &short,
            )])
            .collect(),
        cases,
        more: vec![
            (
                "convergence",
                json!([
                    numbers(0, WINDOW, tight, &whole),
                    numbers(BACKLASH, SHORT, loose, &short),
                ]),
            ),
            (
                "notes",
                json!([
                    format!(
                        "differences are rms over the given seconds from the start at rest, to S = {REFERENCE}; lengths in m"
                    ),
                    "without backlash the machine is linear and the series converge at every time",
                    "with backlash the motion is chaotic and two orders diverge exponentially: the series converge over a short time only, the statistics over a long time",
                    "the paper does not give the forcing frequency of Fig. 4",
                ]),
            ),
        ],
    })
}
