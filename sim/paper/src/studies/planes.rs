//! Phase plane and stroboscopic section of the sun-planet mesh.

use eomgen_plot::{Axes, Frame, Panel, Reference, Series, SeriesStyle};

use super::display::SampledCase;

/// Axes of the phase plane: x_sp and its rate.
const PLANE: Axes = Axes::Quantity {
    symbol: "x_sp",
    unit: "m",
};

/// Draws the phase plane over the first forcing period shown.
pub(super) fn orbit<'a>(letter: &str, display: &'a SampledCase) -> Frame<'a> {
    let count = display.per_period() + 1;
    let first = |values: &'a [f64]| values.get(..count).unwrap_or(values);
    let panel = panel(
        format!("{letter} phase plane, one period"),
        first(&display.history.x_sp),
        first(&display.x_sp_dot),
    );
    frame(panel, SeriesStyle::Orbit, display)
}

/// Draws the stroboscopic section, given as columns.
pub(super) fn section<'a>(display: &SampledCase, [x_sp, x_sp_dot]: &'a [Vec<f64>; 2]) -> Frame<'a> {
    let title = format!("Poincaré section, {} forcing periods", x_sp.len());
    frame(panel(title, x_sp, x_sp_dot), SeriesStyle::Points, display)
}

fn panel<'a>(title: String, x_sp: &'a [f64], x_sp_dot: &'a [f64]) -> Panel<'a> {
    Panel {
        title,
        quantity: "x_sp_dot".to_owned(),
        unit: "m/s".to_owned(),
        series: vec![Series {
            label: String::new(),
            abscissa: x_sp,
            values: x_sp_dot,
            ..Series::default()
        }],
        references: Vec::new(),
    }
}

fn frame<'a>(panel: Panel<'a>, drawn: SeriesStyle, display: &SampledCase) -> Frame<'a> {
    let b = display.case.backlash;
    let flanks = [("−b", -b), ("+b", b)].map(|(label, value)| Reference {
        label: label.to_owned(),
        value,
    });
    Frame {
        panel,
        axes: PLANE,
        marks: if b > 0.0 { flanks.into() } else { Vec::new() },
        is_overlaid: false,
        style: drawn,
    }
}
