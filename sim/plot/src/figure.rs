//! Content of a figure: panels, series, reference lines. Values are in SI units.
//!
//! Names such as `theta_s_dot` are drawn with subscripts, Greek letters and dots.

/// Quantities over time.
#[derive(Clone, Debug, Default)]
pub struct TimeHistory<'a> {
    /// Description for screen readers; not drawn.
    pub title: String,
    /// Panels from top to bottom.
    pub panels: Vec<Panel<'a>>,
}

/// Power spectral densities over frequency.
#[derive(Clone, Debug, Default)]
pub struct Spectrum<'a> {
    /// Description for screen readers; not drawn.
    pub title: String,
    /// Scale of the frequency axis.
    pub frequency: FrequencyAxis,
    /// Panels from top to bottom, with abscissae in Hz and values for example in m^2/Hz.
    pub panels: Vec<Panel<'a>>,
}

/// Scale of a frequency axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FrequencyAxis {
    /// Linear scale.
    Linear,
    /// Logarithmic scale.
    #[default]
    Logarithmic,
}

/// Width of a figure. Text has the same size in px in both widths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FigureWidth {
    /// 900 px, for wide windows and printing.
    #[default]
    Wide,
    /// 330 px, for narrow windows.
    Narrow,
}

/// Role of a series in a comparison. A role has the same colour in all figures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SeriesRole {
    /// No role: the colour follows the order of the series.
    #[default]
    Plain,
    /// Measurement, drawn as a broad curve, which remains visible behind a simulation.
    Measured,
    /// Original model.
    Before,
    /// Extended model.
    After,
}

/// Style of a series.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SeriesStyle {
    /// Curve with abscissae that never decrease.
    #[default]
    Curve,
    /// Line between consecutive samples in a plane.
    Orbit,
    /// One point per sample.
    Points,
}

/// Frame with axes and curves.
#[derive(Clone, Debug, Default)]
pub struct Panel<'a> {
    /// Title above the frame; empty for none.
    pub title: String,
    /// Name of the ordinate, for example `x_sp`.
    pub quantity: String,
    /// SI unit of the values, for example `m` or `N m`; empty for a dimensionless number.
    pub unit: String,
    /// Curves; a legend is drawn for more than one.
    pub series: Vec<Series<'a>>,
    /// Horizontal reference lines.
    pub references: Vec<Reference>,
}

/// Curve of a panel.
#[derive(Clone, Debug, Default)]
pub struct Series<'a> {
    /// Name in the legend.
    pub label: String,
    /// Times in s or frequencies in Hz; finite, and never decreasing for a curve.
    pub abscissa: &'a [f64],
    /// Values in the panel's unit, one per abscissa; a value that is not finite leaves a gap.
    pub values: &'a [f64],
    /// Role in a comparison. Series are drawn in this order, so a measurement must be the first one.
    pub role: SeriesRole,
}

/// Dashed reference line with its label next to the frame.
#[derive(Clone, Debug, Default)]
pub struct Reference {
    /// Label, for example `b_sp`.
    pub label: String,
    /// Value in the panel's unit; the line is omitted if it cannot be drawn.
    pub value: f64,
}
