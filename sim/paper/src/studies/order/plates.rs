//! Figures of the study: Fig. 4, and convergence of chaotic motion.

use crate::studies::display::{FIGURE_WINDOW_S, SampledCase};
use crate::studies::error::StudyError;
use crate::studies::figures::{
    Heading, create_density_panel, draw_frames, list_frequency_marks, raise_to_floor,
};
use crate::studies::report::{Figure, format_case_name};
use eomgen_plot::{Axes, Frame, Panel, Series};

use super::differences::{
    Convergence, NAMES, compare_statistics, find_largest_differences, run_at_order,
};
use super::run::{
    BACKLASH, REFERENCE_ORDER, Run, SAMPLING_INTERVAL_S, SHORT_TIME_S, SHOWN_ORDERS,
    STATISTICS_TIME_S, TRANSIENT_S,
};

/// Draws dr without backlash with four and five modes, as in Fig. 4, and the convergence of the
/// series.
pub(super) fn draw_fig_4(
    runs: &[Run],
    displays: &[SampledCase],
    convergence: &Convergence,
) -> Result<Figure, StudyError> {
    let (four, five) = (&run_at_order(runs, 4)?.start, &run_at_order(runs, 5)?.start);
    // The time history shows one second.
    let count = ((1.0 / SAMPLING_INTERVAL_S) as usize + 1).min(four.dr.len());
    let first = |values: &[f64]| values.get(..count).unwrap_or_default().to_vec();
    let (t, dr_4, dr_5) = (first(&four.times), first(&four.dr), first(&five.dr));
    let difference: Vec<f64> = dr_5.iter().zip(&dr_4).map(|(a, b)| a - b).collect();
    let drawn: Vec<Vec<f64>> = displays
        .iter()
        .map(|d| raise_to_floor(&d.dr.density))
        .collect();
    let frames = vec![
        Frame {
            is_overlaid: true,
            ..history(
                "(a) dr, b = 0, ω = 10π rad/s",
                "dr",
                &t,
                &[("S = 4", &dr_4), ("S = 5", &dr_5)],
            )
        },
        Frame {
            is_overlaid: true,
            ..spectra("(b)", displays, &drawn, "dr")
        },
        history(
            "(c) dr with S = 5 less dr with S = 4",
            "difference",
            &t,
            &[("", &difference)],
        ),
        over_order(
            &format!("(d) rms difference to S = {REFERENCE_ORDER}"),
            "m",
            "rms difference",
            convergence,
        ),
    ];
    let heading = Heading {
        file: "fig_04.svg".to_owned(),
        paper: "Fig. 4".to_owned(),
        caption: format!(
            "Deformation dr of the arm's end without backlash, omega = 10 pi rad/s, S = 4 and S = 5: from the \
             start at rest (a), its spectrum after the transient (b), the difference of the two (c), \
             and rms differences to S = {REFERENCE_ORDER} over {FIGURE_WINDOW_S} s from the start (d), where f_la \
             coincides with dr"
        ),
    };
    draw_frames(heading, ids(displays), frames)
}

/// Draws the convergence with backlash: differences over time, differences over a short time, and long-time statistics.
pub(super) fn draw_chaotic_convergence(
    runs: &[Run],
    displays: &[SampledCase],
    convergence: &Convergence,
) -> Result<Figure, StudyError> {
    let reference = &run_at_order(runs, REFERENCE_ORDER)?.start;
    let mut growths = Vec::with_capacity(SHOWN_ORDERS.len());
    for order in SHOWN_ORDERS {
        growths.push((
            order,
            find_largest_differences(&run_at_order(runs, order)?.start, reference),
        ));
    }
    let curves = growths.iter().map(|(order, (times, values))| Series {
        label: format!("S = {order}"),
        abscissa: times,
        values,
        ..Series::default()
    });
    let title = format!("(a) difference of x_sp to S = {REFERENCE_ORDER}");
    let growth = Frame {
        panel: panel(&title, "difference", curves.collect()),
        axes: Axes::Growth,
        ..Frame::default()
    };
    let statistics = compare_statistics(runs)?;
    let drawn: Vec<Vec<f64>> = displays
        .iter()
        .map(|d| raise_to_floor(&d.f_la.density))
        .collect();
    let milliseconds = SHORT_TIME_S * 1e3;
    let frames = vec![
        growth,
        over_order(
            &format!("(b) rms difference to S = {REFERENCE_ORDER} over {milliseconds:.0} ms"),
            "m",
            "rms difference",
            convergence,
        ),
        over_order(
            &format!("(c) rms over {STATISTICS_TIME_S:.0} s, relative to S = {REFERENCE_ORDER}"),
            "",
            "relative difference",
            &statistics,
        ),
        spectra("(d)", displays, &drawn, "f_la"),
    ];
    let heading = Heading {
        file: "convergence.svg".to_owned(),
        paper: String::new(),
        caption: format!(
            "Convergence over the modal truncation order with b = {BACKLASH} um, omega = 10 pi rad/s, where the \
             motion is chaotic: solutions of different orders diverge exponentially (a, the largest difference in \
             each 5 ms); differences over {SHORT_TIME_S} s from the start (b), where f_la coincides with dr; rms over \
             {STATISTICS_TIME_S} s after {TRANSIENT_S} s, compared with S = {REFERENCE_ORDER} (c) and the spectrum of \
             f_la (d)"
        ),
    };
    draw_frames(heading, ids(displays), frames)
}

fn ids(displays: &[SampledCase]) -> Vec<String> {
    displays
        .iter()
        .map(|display| format_case_name(&display.case))
        .collect()
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

fn history<'a>(
    title: &str,
    quantity: &str,
    abscissa: &'a [f64],
    curves: &[(&str, &'a Vec<f64>)],
) -> Frame<'a> {
    let curves = curves.iter().map(|(label, values)| Series {
        label: (*label).to_owned(),
        abscissa,
        values,
        ..Series::default()
    });
    Frame {
        panel: panel(title, quantity, curves.collect()),
        ..Frame::default()
    }
}

fn over_order<'a>(title: &str, unit: &str, quantity: &str, of: &'a Convergence) -> Frame<'a> {
    let curves = NAMES.iter().zip(&of.values).map(|(name, values)| Series {
        label: (*name).to_owned(),
        abscissa: &of.orders,
        values,
        ..Series::default()
    });
    Frame {
        panel: Panel {
            unit: unit.to_owned(),
            ..panel(title, quantity, curves.collect())
        },
        axes: Axes::Count("S"),
        is_overlaid: true,
        ..Frame::default()
    }
}

/// Returns the spectra of dr or f_la at their common frequencies.
fn spectra<'a>(
    letter: &str,
    displays: &'a [SampledCase],
    drawn: &'a [Vec<f64>],
    of: &str,
) -> Frame<'a> {
    let curves = displays.iter().zip(drawn).map(|(display, density)| Series {
        label: format!("S = {}", display.case.order),
        abscissa: &display.dr.frequency,
        values: density,
        ..Series::default()
    });
    let mut panel = create_density_panel(of, curves.collect());
    panel.title = format!("{letter} {}", panel.title);
    Frame {
        panel,
        axes: Axes::Frequency,
        marks: displays.last().map_or_else(Vec::new, list_frequency_marks),
        ..Frame::default()
    }
}
