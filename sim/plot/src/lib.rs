//! Figures as self-contained SVG (time histories, power spectra, maps over parameters), and their rendering as
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
//!         ..Series::default()
//!     }],
//!     references: Vec::new(),
//! };
//! let figure = TimeHistory {
//!     title: "Deflection over one second".to_owned(),
//!     panels: vec![panel],
//! };
//! assert!(time_history(&figure)?.contains("<svg"));
//! # Ok::<(), eomgen_plot::PlotError>(())
//! ```
//!
//! Modules in the order of drawing a figure: [`figure`] (content), `quantity` (SI prefixes and axis labels),
//! `axis` (positions and ticks), `decimate` (fewer points), `layout` (positions of all parts), `panel`
//! (drawing), `canvas` (SVG elements). `symbol` and `lettering` write names and text. [`mod@plate`] arranges
//! frames with separate axes. [`bars`] contains histograms and shares, [`mod@distribution`] distributions of
//! numbers, [`mod@modes`] shapes of natural modes, [`map`] maps and scatter plots, and [`mod@drawing`] free
//! drawings. [`render_png`] renders any of these SVG documents. This crate does not depend on models.
//!
//! The SVG has no script, identifier or external reference, so a page can contain it several times. Its
//! only style sheet replaces the colours (`palette`) if the reader prefers a dark scheme. The crate writes it directly: plotting crates round points to whole pixels or
//! misalign the frames of stacked panels.

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
mod palette;
mod panel;
pub mod plate;
mod quantity;
mod rendering;
mod symbol;

#[cfg(test)]
mod tests;

pub use error::PlotError;
pub use figure::{
    FigureWidth, FrequencyAxis, Panel, Reference, Series, SeriesRole, SeriesStyle, Spectrum,
    TimeHistory,
};
pub use map::{draw_map, draw_scatter};
pub use plate::{Axes, Frame, Plate, plate, plate_at};
pub use quantity::scaled_unit;
pub use rendering::render_png;

use axis::Scale;
use layout::{Abscissa, Format, Layout};

/// Draws quantities over time, with the panels stacked over one time axis. Returns an SVG document
/// with a width of 900 px. Its curves have less than 200 kB for any number of samples.
///
/// # Errors
///
/// [`PlotError`] without panels, for a panel or a series without anything to draw, for times that
/// are not finite or that decrease, and for different numbers of values and times.
pub fn time_history(plot: &TimeHistory<'_>) -> Result<String, PlotError> {
    time_history_at(plot, FigureWidth::Wide)
}

/// Draws quantities over time like [`time_history`], with a given width.
///
/// # Errors
///
/// Same as [`time_history`].
pub fn time_history_at(plot: &TimeHistory<'_>, width: FigureWidth) -> Result<String, PlotError> {
    let abscissa = Abscissa {
        symbol: "t",
        unit: "s",
        scale: Scale::Linear,
    };
    draw((&plot.title, &plot.panels), &abscissa, Scale::Linear, width)
}

/// Draws power spectral densities over frequency, with a logarithmic axis for the densities.
/// Returns an SVG document like [`time_history`]. Values without a logarithm leave a gap.
///
/// # Errors
///
/// Same as [`time_history`].
pub fn spectrum(plot: &Spectrum<'_>) -> Result<String, PlotError> {
    spectrum_at(plot, FigureWidth::Wide)
}

/// Draws power spectral densities like [`spectrum`], with a given width.
///
/// # Errors
///
/// Same as [`time_history`].
pub fn spectrum_at(plot: &Spectrum<'_>, width: FigureWidth) -> Result<String, PlotError> {
    let abscissa = Abscissa {
        symbol: "f",
        unit: "Hz",
        scale: match plot.frequency {
            FrequencyAxis::Linear => Scale::Linear,
            FrequencyAxis::Logarithmic => Scale::Logarithmic,
        },
    };
    draw(
        (&plot.title, &plot.panels),
        &abscissa,
        Scale::Logarithmic,
        width,
    )
}

fn draw(
    (title, panels): (&str, &[Panel<'_>]),
    abscissa: &Abscissa,
    ordinate: Scale,
    width: FigureWidth,
) -> Result<String, PlotError> {
    error::check_panels(panels, |_| SeriesStyle::Curve)?;
    let layout = Layout::new(
        panels,
        abscissa,
        ordinate,
        Format::stacked(panels.len(), width),
    )?;
    let mut canvas = canvas::Canvas::default();
    for (panel, geometry) in panels.iter().zip(&layout.geometries) {
        panel::draw_panel(&mut canvas, panel, geometry, &layout);
    }
    panel::draw_abscissa(&mut canvas, &layout);
    Ok(canvas.document(title, layout.width, layout.height))
}
