//! Approaches to switching surfaces, from which stiffness at a surface is detected.

/// Approach to a switching surface that a step crossed.
pub(super) struct Approach {
    /// Time of its end, s.
    pub(super) t: f64,
    /// Number of steps that were tried until then.
    pub(super) steps: u64,
    /// True if the motion itself crossed the surface.
    pub(super) has_crossed: bool,
}
