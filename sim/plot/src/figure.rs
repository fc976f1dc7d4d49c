//! What a figure shows, as its caller states it: panels, series, reference lines. Values are
//! in SI units; prefixes are chosen when the figure is drawn.
//!
//! A name such as `x_sp` or `theta_s_dot` is drawn as in the paper, with its subscript, its
//! Greek letter and its dot.

/// Quantities over time.
#[derive(Clone, Debug, Default)]
pub struct TimeHistory<'a> {
    /// What the figure shows, for those who cannot see it; not drawn.
    pub title: String,
    /// From top to bottom.
    pub panels: Vec<Panel<'a>>,
}

/// Power spectral densities over frequency.
#[derive(Clone, Debug, Default)]
pub struct Spectrum<'a> {
    /// What the figure shows, for those who cannot see it; not drawn.
    pub title: String,
    /// How frequencies are spaced.
    pub frequency: FrequencyAxis,
    /// From top to bottom; abscissae in Hz, values such as m^2/Hz.
    pub panels: Vec<Panel<'a>>,
}

/// How frequencies are spaced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FrequencyAxis {
    /// Equal differences look equal.
    Linear,
    /// Equal ratios look equal.
    #[default]
    Logarithmic,
}

/// What is drawn through the samples of a series.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Drawn {
    /// A curve over its abscissa, which never decreases.
    #[default]
    Curve,
    /// A line from sample to sample, wherever it leads: a motion in a plane.
    Orbit,
    /// A point for each sample.
    Points,
}

/// One frame with its curves.
#[derive(Clone, Debug, Default)]
pub struct Panel<'a> {
    /// Written above the frame if there is any.
    pub title: String,
    /// The ordinate's name, `x_sp` say.
    pub quantity: String,
    /// The SI unit of the values as specifications write it, `m` or `N m`; empty for a
    /// number.
    pub unit: String,
    /// The curves; a legend is drawn if there is more than one.
    pub series: Vec<Series<'a>>,
    /// Horizontal reference lines.
    pub references: Vec<Reference>,
}

/// One curve.
#[derive(Clone, Debug, Default)]
pub struct Series<'a> {
    /// Its name in the legend.
    pub label: String,
    /// Times in s or frequencies in Hz; finite, and of a curve never decreasing.
    pub abscissa: &'a [f64],
    /// As many values in the panel's unit; one that is not finite leaves a gap.
    pub values: &'a [f64],
}

/// A dashed horizontal line with its label to the right of the frame.
#[derive(Clone, Debug, Default)]
pub struct Reference {
    /// What the line marks, `b_sp` say.
    pub label: String,
    /// Where, in the panel's unit; left out if it cannot be drawn.
    pub value: f64,
}
