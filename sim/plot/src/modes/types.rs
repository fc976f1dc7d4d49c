//! What a figure of modes shows, as its caller states it.

/// Natural modes.
#[derive(Clone, Debug, Default)]
pub struct Modes {
    /// Written at the top.
    pub title: String,
    /// Lines below the title: where the modes are those of, say.
    pub notes: Vec<String>,
    /// From top to bottom.
    pub modes: Vec<Mode>,
}

/// One mode. Amplitudes are complex, `[real, imaginary]`: the motion is the real part of each times
/// exp(i omega t).
#[derive(Clone, Debug, Default)]
pub struct Mode {
    /// Its frequency and damping in words.
    pub title: String,
    /// As many in every mode.
    pub fields: Vec<Shape>,
    /// As many in every mode.
    pub bars: Vec<Bar>,
}

/// The shape of a field.
#[derive(Clone, Debug, Default)]
pub struct Shape {
    /// The field's name.
    pub name: String,
    /// Its SI unit.
    pub unit: String,
    /// The name of the position.
    pub along: String,
    /// Positions, m, ascending.
    pub positions: Vec<f64>,
    /// As many amplitudes, in the unit.
    pub amplitudes: Vec<[f64; 2]>,
}

/// A coordinate's part in a mode.
#[derive(Clone, Debug, Default)]
pub struct Bar {
    /// The coordinate's name.
    pub name: String,
    /// Its SI unit.
    pub unit: String,
    /// Its amplitude, in the unit. Bars reach from -1 to 1; where there is more, those of one unit
    /// to its largest.
    pub amplitude: [f64; 2],
}
