//! Content of a figure of modes.

/// Natural modes.
#[derive(Clone, Debug, Default)]
pub struct Modes {
    /// Title at the top.
    pub title: String,
    /// Lines below the title, for example the state of the linearisation.
    pub notes: Vec<String>,
    /// Modes from top to bottom.
    pub modes: Vec<Mode>,
}

/// Natural mode. The motion is the real part of `[real, imaginary]` times exp(i omega t).
#[derive(Clone, Debug, Default)]
pub struct Mode {
    /// Text of frequency and damping.
    pub title: String,
    /// Shapes of the fields; equally many in every mode.
    pub fields: Vec<Shape>,
    /// Bars; equally many in every mode.
    pub bars: Vec<Bar>,
}

/// Shape of a field.
#[derive(Clone, Debug, Default)]
pub struct Shape {
    /// Name of the field.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// Name of the position.
    pub position_name: String,
    /// Positions in m, ascending.
    pub positions: Vec<f64>,
    /// Amplitudes in the unit, one per position.
    pub amplitudes: Vec<[f64; 2]>,
}

/// Amplitude of a coordinate in a mode.
#[derive(Clone, Debug, Default)]
pub struct Bar {
    /// Name of the coordinate.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// Amplitude in the unit. Bars range from -1 to 1, or to the largest amplitude with this unit.
    pub amplitude: [f64; 2],
}
