//! Errors of figures, and checks before drawing.

use thiserror::Error;

use super::figure::{Panel, Series, SeriesStyle};

/// Error of a figure. Panels and samples are counted from 0.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum PlotError {
    /// The figure has no panels.
    #[error("the figure has no panels")]
    NoPanels,
    /// A panel has no series.
    #[error("panel {panel} of the figure has no series")]
    NoSeries {
        /// Index of the panel.
        panel: usize,
    },
    /// A series has no sample that can be drawn.
    #[error("the series `{series}` in panel {panel} of the figure has no sample that can be drawn")]
    Empty {
        /// Index of the panel.
        panel: usize,
        /// Label of the series.
        series: String,
    },
    /// A series has different numbers of values and abscissae.
    #[error(
        "the series `{series}` in panel {panel} of the figure has {values} values but {abscissae} abscissae"
    )]
    Lengths {
        /// Index of the panel.
        panel: usize,
        /// Label of the series.
        series: String,
        /// Number of abscissae.
        abscissae: usize,
        /// Number of values.
        values: usize,
    },
    /// An abscissa is not finite, or is smaller than the previous one.
    #[error(
        "the series `{series}` in panel {panel} of the figure: abscissa {sample} is not finite or is smaller \
         than the previous one"
    )]
    Abscissa {
        /// Index of the panel.
        panel: usize,
        /// Label of the series.
        series: String,
        /// Index of the sample.
        sample: usize,
    },
    /// A map has different numbers of values and cells.
    #[error("the map has {values} values for {columns} columns and {rows} rows")]
    Cells {
        /// Number of values along the horizontal axis.
        columns: usize,
        /// Number of values along the vertical axis.
        rows: usize,
        /// Number of values in the cells.
        values: usize,
    },
    /// The values along an axis of a map do not ascend, or cannot be drawn on it.
    #[error(
        "value {index} of `{axis}` along an axis of the map is not greater than the previous one, or cannot be \
         drawn on the axis"
    )]
    Grid {
        /// Name of the quantity along the axis.
        axis: String,
        /// Index of the value.
        index: usize,
    },
    /// The figure could not be rendered as PNG.
    #[error("the figure could not be rendered as PNG: {reason}")]
    Encoding {
        /// Message of the renderer or the encoder.
        reason: String,
    },
}

/// Returns true if axes can be computed from a value without overflow.
pub(super) fn is_drawable(value: f64) -> bool {
    value.abs() < 1e100
}

/// Checks panels before the axes are known; `drawn` returns the kind of each panel.
pub(super) fn check_panels(
    panels: &[Panel<'_>],
    drawn: impl Fn(usize) -> SeriesStyle,
) -> Result<(), PlotError> {
    if panels.is_empty() {
        return Err(PlotError::NoPanels);
    }
    for (panel, content) in panels.iter().enumerate() {
        if content.series.is_empty() {
            return Err(PlotError::NoSeries { panel });
        }
        for series in &content.series {
            check_series(panel, series, drawn(panel))?;
        }
    }
    Ok(())
}

fn check_series(panel: usize, series: &Series<'_>, drawn: SeriesStyle) -> Result<(), PlotError> {
    let (abscissae, values) = (series.abscissa.len(), series.values.len());
    if abscissae != values {
        return Err(PlotError::Lengths {
            panel,
            series: series.label.clone(),
            abscissae,
            values,
        });
    }
    let mut previous = f64::NEG_INFINITY;
    for (sample, &abscissa) in series.abscissa.iter().enumerate() {
        let goes_back = drawn == SeriesStyle::Curve && abscissa < previous;
        if !is_drawable(abscissa) || goes_back {
            return Err(PlotError::Abscissa {
                panel,
                series: series.label.clone(),
                sample,
            });
        }
        previous = abscissa;
    }
    Ok(())
}
