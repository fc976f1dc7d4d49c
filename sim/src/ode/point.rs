//! A point of a motion.

/// A state and its time.
#[derive(Clone, Debug)]
pub struct Point {
    /// Time, s.
    pub t: f64,
    /// State.
    pub y: Vec<f64>,
}
