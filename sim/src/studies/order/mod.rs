//! The study of the modal truncation order: Fig. 4, S = 4 against S = 5 without backlash,
//! and convergence over S = 1 to 16, without and with backlash.
//!
//! Without backlash the machine is linear and every quantity converges at every time. With
//! backlash the motion is chaotic: two orders part exponentially, however small their
//! difference is at first. There, differences are taken over a short time from the start,
//! and over a long time only the statistics are compared.

use std::f64::consts::PI;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;
use serde_json::{Value, json};

use crate::plot::{Axes, Frame, Panel, Plate, Series};

use super::arm::{Arm, Case};
use super::case::{Amplitude, Length, Record, measure};
use super::display::{Display, WINDOW, even_times, sampled};
use super::error::StudyError;
use super::figures::{above_floor, density_panel, marks, svg};
use super::report::{Columns, Figure, Study, amplitude, case, id, tables};
use super::responses::{Progress, paper_case};

/// The orders compared, and the one that stands for all modes.
const HIGHEST: usize = 16;
const REFERENCE: usize = 32;
/// The forcing frequency, which the paper does not give for Fig. 4, and the backlash of the
/// chaotic case in micrometres.
const OMEGA: f64 = 10.0 * PI;
const BACKLASH: u32 = 25;
/// Time from one sample to the next, s; over a long time, where only amplitudes are wanted.
const STEP: f64 = 1.0 / 20_480.0;
const COARSE_STEP: f64 = 1.0 / 4_096.0;
/// The motion from the start is kept over this time, s.
const START: f64 = 6.0;
/// With backlash, differences are averaged over this time from the start, s.
const SHORT: f64 = 0.02;
/// Statistics are taken over this time, s, after this transient, s.
const STATISTICS: f64 = 40.0;
const TRANSIENT: f64 = 60.0;
/// The differences' largest values are shown for pieces of this many samples: 5 ms.
const PIECE: usize = 102;
/// The orders whose differences are shown over time, and whose spectra are.
const SHOWN: [usize; 4] = [1, 4, 5, 16];

/// One order's series at one backlash.
struct Run {
    order: usize,
    /// From the start.
    start: Record,
    /// x_sp, f_la and dr over a long time after the transient.
    statistics: [Amplitude; 3],
}

/// The rms differences of x_sp, f_la and dr, one value per order.
struct Convergence {
    orders: Vec<f64>,
    values: [Vec<f64>; 3],
}

const NAMES: [&str; 3] = ["x_sp", "f_la", "dr"];

/// Fig. 4 and convergence.
///
/// # Errors
/// If a case cannot be run or a figure not be drawn.
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
                    "with backlash the motion is chaotic and two orders part exponentially: the series converge over a short time only, the statistics over a long one",
                    "the paper does not give the forcing frequency of Fig. 4",
                ]),
            ),
        ],
    })
}

/// The run at an order.
fn at(runs: &[Run], order: usize) -> Result<&Run, StudyError> {
    let found = runs.iter().find(|run| run.order == order);
    found.ok_or_else(|| StudyError::Request(format!("order {order} was not run")))
}

/// The rms difference to the reference over so many seconds from the start.
fn convergence(runs: &[Run], seconds: f64) -> Result<Convergence, StudyError> {
    let reference = at(runs, REFERENCE)?;
    let count = (seconds / STEP) as usize;
    let compared: Vec<&Run> = runs.iter().filter(|run| run.order != REFERENCE).collect();
    let values = [0, 1, 2].map(|which| {
        let of = |run: &Run| {
            let pairs = series(&run.start, which)
                .iter()
                .zip(series(&reference.start, which));
            let squares: f64 = pairs.take(count).map(|(a, b)| (a - b).powi(2)).sum();
            (squares / count.max(1) as f64).sqrt()
        };
        compared.iter().map(|run| of(run)).collect()
    });
    Ok(Convergence {
        orders: compared.iter().map(|run| run.order as f64).collect(),
        values,
    })
}

/// x_sp, f_la or dr.
fn series(record: &Record, which: usize) -> &[f64] {
    match which {
        0 => &record.x_sp,
        1 => &record.f_la,
        _ => &record.dr,
    }
}

fn fig_4(
    runs: &[Run],
    displays: &[Display],
    convergence: &Convergence,
) -> Result<Figure, StudyError> {
    let (four, five) = (&at(runs, 4)?.start, &at(runs, 5)?.start);
    // One second.
    let count = ((1.0 / STEP) as usize + 1).min(four.dr.len());
    let t = four.times.get(..count).unwrap_or_default();
    let (dr_4, dr_5) = (
        four.dr.get(..count).unwrap_or_default(),
        five.dr.get(..count).unwrap_or_default(),
    );
    let difference: Vec<f64> = dr_5.iter().zip(dr_4).map(|(a, b)| a - b).collect();
    let curve = |label: &str, values| Series {
        label: label.to_owned(),
        abscissa: t,
        values,
    };
    let overlaid = vec![curve("S = 4", dr_4), curve("S = 5", dr_5)];
    let drawn: Vec<Vec<f64>> = displays
        .iter()
        .map(|d| above_floor(&d.dr.density))
        .collect();
    let caption = format!(
        "Deformation dr of the arm's end without backlash, omega = 10 pi rad/s, S = 4 and S = 5: from the \
         start at rest (a), its spectrum after the transient (b), the difference of the two (c), \
         and rms differences to S = {REFERENCE} over {WINDOW} s from the start (d)"
    );
    let frames = vec![
        history("(a) dr, b = 0", "dr", overlaid),
        spectra(displays, &drawn, "dr"),
        history(
            "(c) dr with S = 5 less dr with S = 4",
            "difference",
            vec![curve("", &difference)],
        ),
        over_order(
            &format!("(d) rms difference to S = {REFERENCE}"),
            "m",
            "rms difference",
            convergence,
        ),
    ];
    Ok(Figure {
        file: "fig_04.svg".to_owned(),
        paper: "Fig. 4".to_owned(),
        svg: svg(&Plate {
            title: caption.clone(),
            columns: 2,
            frames,
        })?,
        cases: displays.iter().map(|d| id(&d.case)).collect(),
        caption,
    })
}

fn chaotic(
    runs: &[Run],
    displays: &[Display],
    convergence: &Convergence,
) -> Result<Figure, StudyError> {
    let whole = at(runs, REFERENCE)?;
    let reference = &whole.start;
    let mut growths = Vec::with_capacity(SHOWN.len());
    for order in SHOWN {
        growths.push((order, largest(&at(runs, order)?.start, reference)));
    }
    let curves = growths.iter().map(|(order, (times, values))| Series {
        label: format!("S = {order}"),
        abscissa: times,
        values,
    });
    let growth = Frame {
        panel: panel(
            &format!("(a) difference of x_sp to S = {REFERENCE}"),
            "difference",
            curves.collect(),
        ),
        axes: Axes::Growth,
        marks: Vec::new(),
    };
    let statistics = Convergence {
        orders: runs
            .iter()
            .filter(|r| r.order != REFERENCE)
            .map(|r| r.order as f64)
            .collect(),
        values: [0, 1, 2].map(|which| {
            let compared = runs.iter().filter(|run| run.order != REFERENCE);
            let long = rms(whole, which);
            let relative = compared.map(|run| (rms(run, which) / long - 1.0).abs());
            relative.collect()
        }),
    };
    let drawn: Vec<Vec<f64>> = displays
        .iter()
        .map(|d| above_floor(&d.f_la.density))
        .collect();
    let caption = format!(
        "Convergence over the modal truncation order with b = {BACKLASH} um, omega = 10 pi rad/s, where the motion is chaotic: \
         orders part exponentially (a, the largest difference in each 5 ms); differences over {SHORT} s from the start (b); rms over \
         {STATISTICS} s after {TRANSIENT} s, compared with S = {REFERENCE} (c) and the spectrum of f_la (d)"
    );
    let frames = vec![
        growth,
        over_order(
            &format!(
                "(b) rms difference to S = {REFERENCE} over {:.0} ms",
                SHORT * 1e3
            ),
            "m",
            "rms difference",
            convergence,
        ),
        over_order(
            &format!("(c) rms over {STATISTICS:.0} s, relative to S = {REFERENCE}"),
            "",
            "relative difference",
            &statistics,
        ),
        spectra(displays, &drawn, "f_la"),
    ];
    Ok(Figure {
        file: "convergence.svg".to_owned(),
        paper: String::new(),
        svg: svg(&Plate {
            title: caption.clone(),
            columns: 2,
            frames,
        })?,
        cases: displays.iter().map(|d| id(&d.case)).collect(),
        caption,
    })
}

/// The largest difference of x_sp in each piece of time.
fn largest(of: &Record, reference: &Record) -> (Vec<f64>, Vec<f64>) {
    let pieces = of.x_sp.chunks(PIECE).zip(reference.x_sp.chunks(PIECE));
    let greatest = pieces.map(|(a, b)| {
        let differences = a.iter().zip(b).map(|(a, b)| (a - b).abs());
        differences.fold(0.0, f64::max)
    });
    (
        of.times.iter().step_by(PIECE).copied().collect(),
        greatest.collect(),
    )
}

fn rms(run: &Run, which: usize) -> f64 {
    run.statistics
        .get(which)
        .map_or(f64::NAN, |amplitude| amplitude.rms)
}

fn panel<'a>(title: &str, quantity: &str, series: Vec<Series<'a>>) -> Panel<'a> {
    Panel {
        title: title.to_owned(),
        quantity: quantity.to_owned(),
        unit: "m".to_owned(),
        series,
        references: Vec::new(),
    }
}

fn history<'a>(title: &str, quantity: &str, series: Vec<Series<'a>>) -> Frame<'a> {
    Frame {
        panel: panel(title, quantity, series),
        axes: Axes::Time,
        marks: Vec::new(),
    }
}

fn over_order<'a>(title: &str, unit: &str, quantity: &str, of: &'a Convergence) -> Frame<'a> {
    let curves = NAMES.iter().zip(&of.values).map(|(name, values)| Series {
        label: (*name).to_owned(),
        abscissa: &of.orders,
        values,
    });
    Frame {
        panel: Panel {
            unit: unit.to_owned(),
            ..panel(title, quantity, curves.collect())
        },
        axes: Axes::Count("S"),
        marks: Vec::new(),
    }
}

fn spectra<'a>(displays: &'a [Display], drawn: &'a [Vec<f64>], of: &str) -> Frame<'a> {
    let curves = displays.iter().zip(drawn).map(|(display, density)| Series {
        label: format!("S = {}", display.case.order),
        abscissa: &display.dr.frequency,
        values: density,
    });
    let letter = if of == "dr" { "(b)" } else { "(d)" };
    let mut panel = density_panel(of, curves.collect());
    panel.title = format!("{letter} {}", panel.title);
    Frame {
        panel,
        axes: Axes::Frequency,
        marks: displays.last().map_or_else(Vec::new, marks),
    }
}

fn table(file: &str, runs: &[Run], of: &Convergence) -> Columns {
    let mut columns = vec![("S".to_owned(), of.orders.clone())];
    for (which, (name, values)) in NAMES.iter().zip(&of.values).enumerate() {
        columns.push((format!("difference_{name}"), values.clone()));
        let compared = runs.iter().filter(|run| run.order != REFERENCE);
        columns.push((
            format!("rms_{name}"),
            compared.map(|run| rms(run, which)).collect(),
        ));
    }
    Columns {
        file: file.to_owned(),
        columns,
    }
}

fn numbers(micrometres: u32, seconds: f64, runs: &[Run], of: &Convergence) -> Value {
    let statistics = runs.iter().map(|run| {
        let [x_sp, f_la, dr] = &run.statistics;
        json!({ "order": run.order, "x_sp": amplitude(x_sp), "f_la": amplitude(f_la), "dr": amplitude(dr) })
    });
    let [x_sp, f_la, dr] = &of.values;
    json!({
        "b": f64::from(micrometres) * 1e-6,
        "omega": OMEGA,
        "data": format!("convergence_b{micrometres:03}.csv"),
        "reference_order": REFERENCE,
        "differences_over_s": seconds,
        "orders": of.orders,
        "rms_difference": { "x_sp": x_sp, "f_la": f_la, "dr": dr },
        "statistics_over_s": STATISTICS,
        "statistics_after_s": TRANSIENT,
        "statistics": statistics.collect::<Vec<_>>(),
    })
}
