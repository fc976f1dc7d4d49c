//! Figures: time histories and power spectra as self-contained SVG, maps over parameters as
//! PNG.
//!
//! ```
//! use eomgen_plot::{Panel, Series, TimeHistory, time_history};
//!
//! let (t, x) = ([0.0, 0.5, 1.0], [0.0, 2e-3, 1e-3]);
//! let panel = Panel {
//!     title: "Deflection of the tip".to_owned(),
//!     quantity: "w".to_owned(),
//!     unit: "m".to_owned(),
//!     series: vec![Series {
//!         label: "w".to_owned(),
//!         abscissa: &t,
//!         values: &x,
//!     }],
//!     references: Vec::new(),
//! };
//! let figure = TimeHistory {
//!     title: "A second of motion".to_owned(),
//!     panels: vec![panel],
//! };
//! assert!(time_history(&figure)?.contains("<svg"));
//! # Ok::<(), eomgen_plot::PlotError>(())
//! ```
//!
//! A figure goes through these files: [`figure`] (what the caller states), `quantity` (SI
//! prefixes and axis labels), `axis` (positions and ticks), `decimate` (many samples to few
//! points), `layout` (where everything goes), `panel` (drawing it), `canvas` (SVG elements);
//! `symbol` and `lettering` write names and text. [`mod@plate`] sets frames with axes of their
//! own side by side. [`bars`] has histograms and shares, [`mod@distribution`] how numbers are spread, [`mod@modes`] shapes of natural modes, [`map`] the pictures made of pixels, and [`mod@drawing`] draws what is no graph.
//! What is drawn, and why, is the caller's business: nothing here knows of a model.
//!
//! The SVG has no script, no style sheet, no identifiers and refers to nothing outside, so
//! that it can stand in a page as often as wanted. It is written directly: plotting crates
//! round points to whole pixels or leave the frames of stacked panels misaligned.

mod axis;
pub mod bars;
mod canvas;
mod decimate;
pub mod distribution;
pub mod drawing;
mod error;
pub mod figure;
mod layout;
mod lettering;
pub mod map;
pub mod modes;
mod panel;
pub mod plate;
mod quantity;
mod symbol;

#[cfg(test)]
mod tests;

pub use error::PlotError;
pub use figure::{Drawn, FrequencyAxis, Panel, Reference, Series, Spectrum, TimeHistory};
pub use map::{map_png, scatter_png};
pub use plate::{Axes, Frame, Plate, plate};
pub use quantity::scaled_unit;

use axis::Scale;
use layout::{Abscissa, Format, Layout};

/// Draws quantities over time, the panels stacked over one time axis.
///
/// Returns an SVG document, 900 px wide and below 200 kB of curves however many samples
/// there are.
///
/// # Errors
///
/// No panels, a panel or a series with nothing to draw, times that are not finite or go
/// back, a series with as many values as times.
pub fn time_history(plot: &TimeHistory<'_>) -> Result<String, PlotError> {
    let abscissa = Abscissa {
        symbol: "t",
        unit: "s",
        scale: Scale::Linear,
    };
    draw(&plot.title, &plot.panels, &abscissa, Scale::Linear)
}

/// Draws power spectral densities over frequency, the densities on a logarithmic axis.
///
/// Frequencies and densities that have no place on a logarithmic axis are left out: they
/// leave a gap. Returns an SVG document as [`time_history`] does.
///
/// # Errors
///
/// As for [`time_history`].
pub fn spectrum(plot: &Spectrum<'_>) -> Result<String, PlotError> {
    let abscissa = Abscissa {
        symbol: "f",
        unit: "Hz",
        scale: match plot.frequency {
            FrequencyAxis::Linear => Scale::Linear,
            FrequencyAxis::Logarithmic => Scale::Logarithmic,
        },
    };
    draw(&plot.title, &plot.panels, &abscissa, Scale::Logarithmic)
}

fn draw(
    title: &str,
    panels: &[Panel<'_>],
    abscissa: &Abscissa,
    ordinate: Scale,
) -> Result<String, PlotError> {
    error::check(panels, |_| Drawn::Curve)?;
    let layout = Layout::new(panels, abscissa, ordinate, Format::stacked(panels.len()))?;
    let mut canvas = canvas::Canvas::default();
    for (panel, place) in panels.iter().zip(&layout.places) {
        panel::draw(&mut canvas, panel, place, &layout);
    }
    panel::draw_abscissa(&mut canvas, &layout);
    Ok(canvas.document(title, layout::WIDTH, layout.height))
}
