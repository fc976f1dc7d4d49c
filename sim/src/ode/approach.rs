//! Approaches to switching surfaces, from which stiffness at a surface is detected.

/// Approach to a switching surface that a step crossed.
pub(super) struct Approach {
    /// Time of the end of the approach, s.
    pub(super) t: f64,
    /// Number of steps tried up to the end of the approach.
    pub(super) steps: u64,
    /// True if the motion itself crossed the surface.
    pub(super) has_crossed: bool,
}
