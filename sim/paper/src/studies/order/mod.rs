//! Study of the modal truncation order: Fig. 4 (S = 4 and S = 5 without backlash), and convergence over S = 1 to 16
//! without and with backlash.
//!
//! Without backlash the machine is linear, and every quantity converges at every time. With backlash the motion is
//! chaotic, and the motions of two orders diverge exponentially. Therefore differences are taken over a short time from
//! the start; over a long time, only statistics are compared. `differences` computes the numbers, `plates` draws the
//! figures.

mod differences;
mod plates;
mod run;

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;
use serde_json::{Value, json};

use super::arm::{Arm, Case};
use super::case::{Amplitude, RunLength, measure};
use super::display::{FIGURE_WINDOW_S, SampledCase, even_times, sample_series};
use super::error::StudyError;
use super::report::{Study, case_json, list_sampled_tables};
use super::responses::{Progress, create_paper_case};
use differences::{compute_convergence, format_convergence_json, table};
use plates::{draw_chaotic_convergence, draw_fig_4};
use run::{
    BACKLASH, COARSE_INTERVAL_S, HIGHEST_ORDER, OMEGA, REFERENCE_ORDER, Run, SAMPLING_INTERVAL_S,
    SHORT_TIME_S, SHOWN_ORDERS, START_TIME_S, STATISTICS_TIME_S, TRANSIENT_S,
};

/// Runs the study of Fig. 4 and of convergence.
///
/// # Errors
/// A case that cannot be simulated, a figure that cannot be drawn.
pub fn order(progress: Progress<'_>) -> Result<(Study, Arm), StudyError> {
    let orders: Vec<usize> = (1..=HIGHEST_ORDER).chain([REFERENCE_ORDER]).collect();
    let arm = Arm::new(&orders)?;
    let done = AtomicUsize::new(0);
    let whole = (2 * orders.len() + 2 + SHOWN_ORDERS.len()) as f64;
    let step = || progress((done.fetch_add(1, Ordering::Relaxed) + 1) as f64 / whole);
    let requests = [0, BACKLASH].map(|b| orders.iter().map(move |s| (b, *s)));
    let requests: Vec<(u32, usize)> = requests.into_iter().flatten().collect();
    let found = requests.par_iter().map(|&(b, s)| {
        let run = run(&arm, &create_paper_case(s, b, OMEGA));
        step();
        run
    });
    let mut tight: Vec<Run> = found.collect::<Result<_, _>>()?;
    let loose = tight.split_off(orders.len());
    let shown = [(0, 4), (0, 5)].into_iter();
    let shown: Vec<(u32, usize)> = shown.chain(SHOWN_ORDERS.map(|s| (BACKLASH, s))).collect();
    let found = shown.par_iter().map(|&(b, s)| {
        let pair = display(&arm, &create_paper_case(s, b, OMEGA));
        step();
        pair
    });
    let found: Vec<(SampledCase, Value)> = found.collect::<Result<_, StudyError>>()?;
    let (displays, cases): (Vec<SampledCase>, Vec<Value>) = found.into_iter().unzip();
    let study = study(&tight, &loose, &displays, cases)?;
    Ok((study, arm))
}

fn run(arm: &Arm, each: &Case) -> Result<Run, StudyError> {
    let mut start = sample_series(
        arm,
        each,
        &even_times(
            0.0,
            SAMPLING_INTERVAL_S,
            (START_TIME_S / SAMPLING_INTERVAL_S) as usize,
        ),
    )?;
    start.modal.clear();
    let steps = (STATISTICS_TIME_S / COARSE_INTERVAL_S) as usize;
    let long = even_times(TRANSIENT_S, COARSE_INTERVAL_S, steps);
    let long = sample_series(arm, each, &long)?;
    Ok(Run {
        order: each.order,
        start,
        statistics: [&long.x_sp, &long.f_la, &long.dr].map(|series| Amplitude::from_values(series)),
    })
}

fn display(arm: &Arm, each: &Case) -> Result<(SampledCase, Value), StudyError> {
    let (transient, report) = {
        let measured = measure(arm, each, &RunLength::FULL)?;
        (measured.transient, case_json(&measured))
    };
    Ok((SampledCase::sample(arm, each, transient)?, report))
}

fn study(
    tight: &[Run],
    loose: &[Run],
    displays: &[SampledCase],
    cases: Vec<Value>,
) -> Result<Study, StudyError> {
    let whole = compute_convergence(tight, FIGURE_WINDOW_S)?;
    let short = compute_convergence(loose, SHORT_TIME_S)?;
    let (without, with) = displays.split_at_checked(2).unwrap_or_default();
    let tables = displays.iter().flat_map(list_sampled_tables);
    Ok(Study {
        figures: vec![
            draw_fig_4(tight, without, &whole)?,
            draw_chaotic_convergence(loose, with, &short)?,
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
        further_entries: vec![
            (
                "convergence",
                json!([
                    format_convergence_json(0, FIGURE_WINDOW_S, tight, &whole),
                    format_convergence_json(BACKLASH, SHORT_TIME_S, loose, &short),
                ]),
            ),
            (
                "notes",
                json!([
                    format!(
                        "differences are rms over the given seconds from the start at rest, to S = {REFERENCE_ORDER}; lengths in m"
                    ),
                    "without backlash the machine is linear and the series converge at every time",
                    "with backlash the motion is chaotic and two orders diverge exponentially: the series converge over a short time only, the statistics over a long time",
                    "the paper does not give the forcing frequency of Fig. 4",
                ]),
            ),
        ],
    })
}
