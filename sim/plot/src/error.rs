//! Why a figure could not be drawn, and the checks made before drawing.

use std::fmt;

use super::figure::{Drawn, Panel, Series};

/// Why a figure could not be drawn. Panels and samples are counted from 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PlotError {
    /// There are no panels.
    NoPanels,
    /// A panel has no series.
    NoSeries {
        /// Which panel.
        panel: usize,
    },
    /// A series has no sample that can be drawn.
    Empty {
        /// Which panel.
        panel: usize,
        /// The label of the series.
        series: String,
    },
    /// A series has more or fewer values than abscissae.
    Lengths {
        /// Which panel.
        panel: usize,
        /// The label of the series.
        series: String,
        /// The number of abscissae.
        abscissae: usize,
        /// The number of values.
        values: usize,
    },
    /// An abscissa is not finite, or smaller than the one before.
    Abscissa {
        /// Which panel.
        panel: usize,
        /// The label of the series.
        series: String,
        /// Which sample.
        sample: usize,
    },
    /// A map has more or fewer values than cells.
    Cells {
        /// The number of values along the horizontal axis.
        columns: usize,
        /// The number of values along the vertical axis.
        rows: usize,
        /// The number of values in the cells.
        values: usize,
    },
    /// The values along an axis of a map do not ascend, or one has no place on it.
    Grid {
        /// The name of the quantity along the axis.
        axis: String,
        /// Which value.
        index: usize,
    },
    /// The picture could not be encoded.
    Encoding {
        /// What the encoder says.
        reason: String,
    },
}

impl fmt::Display for PlotError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoPanels => write!(f, "the figure has no panels"),
            Self::NoSeries { panel } => write!(f, "panel {panel} of the figure has no series"),
            Self::Empty { panel, series } => write!(
                f,
                "the series `{series}` in panel {panel} of the figure has no sample that can be drawn"
            ),
            Self::Lengths {
                panel,
                series,
                abscissae,
                values,
            } => write!(
                f,
                "the series `{series}` in panel {panel} of the figure has {values} values \
                 for {abscissae} abscissae"
            ),
            Self::Abscissa {
                panel,
                series,
                sample,
            } => write!(
                f,
                "the series `{series}` in panel {panel} of the figure: the abscissa of sample \
                 {sample} is not finite or smaller than the one before"
            ),
            Self::Cells {
                columns,
                rows,
                values,
            } => write!(
                f,
                "the map has {values} values for {columns} columns and {rows} rows"
            ),
            Self::Grid { axis, index } => write!(
                f,
                "the values of `{axis}` along an axis of the map: value {index} is not above \
                 the one before, or has no place on the axis"
            ),
            Self::Encoding { reason } => write!(f, "the picture could not be encoded: {reason}"),
        }
    }
}

impl std::error::Error for PlotError {}

/// Whether a value is so far from overflow that axes can be computed from it.
pub(super) fn is_drawable(value: f64) -> bool {
    value.abs() < 1e100
}

/// Checks all that can be said before the axes are known; `drawn` says it of each panel.
pub(super) fn check(panels: &[Panel<'_>], drawn: impl Fn(usize) -> Drawn) -> Result<(), PlotError> {
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

fn check_series(panel: usize, series: &Series<'_>, drawn: Drawn) -> Result<(), PlotError> {
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
        let goes_back = drawn == Drawn::Curve && abscissa < previous;
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
