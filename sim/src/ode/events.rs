//! Modes of switching surfaces, and the events that change them.

/// Mode of a switching surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SurfaceMode {
    /// Unknown: the motion began on the surface.
    Unknown,
    /// The motion is on the side where the switching function is negative.
    Negative,
    /// The motion is on the side where the switching function is positive.
    Positive,
    /// The surface holds the motion, like friction at rest.
    Held,
    /// The bodies of a contact touch and press against each other.
    Closed,
    /// The contact to which the friction belongs is open.
    Open,
}

impl SurfaceMode {
    /// Returns the mode on a side: -1, 1, or 0 (unknown).
    pub fn from_side(side: f64) -> Self {
        match side {
            side if side > 0.0 => Self::Positive,
            side if side < 0.0 => Self::Negative,
            _ => Self::Unknown,
        }
    }

    /// Returns the name used in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Unknown => "unknown",
            Self::Negative => "negative",
            Self::Positive => "positive",
            Self::Held => "held",
            Self::Closed => "closed",
            Self::Open => "open",
        }
    }
}

/// An event at a switching surface. The modes before and after are equal if the surface reverses the motion, as
/// an impact does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// Time, s.
    pub t: f64,
    /// Index of the switching function.
    pub guard: usize,
    /// Mode before the event.
    pub from: SurfaceMode,
    /// Mode after the event.
    pub to: SurfaceMode,
}

/// A jump of the state at an instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Jump {
    /// Time, s.
    pub t: f64,
    /// Change of each state, in its unit; 0 if below the tolerance.
    pub change: Vec<f64>,
}
