//! What the solver needs to know of a system.

/// A system y' = f(t, y) whose right-hand side is smooth between switching surfaces.
pub trait System {
    /// The number of state variables.
    fn states(&self) -> usize;

    /// Writes y' at time `t` and state `y` to `out`; all have [`System::states`] entries.
    fn rates(&self, t: f64, y: &[f64], out: &mut [f64]);

    /// The number of switching surfaces.
    fn guard_count(&self) -> usize {
        0
    }

    /// Writes the value of each switching function to `out`, which has
    /// [`System::guard_count`] entries. The right-hand side may have a kink or a jump
    /// where one of them changes its sign, and nowhere else.
    fn guards(&self, _t: f64, _y: &[f64], _out: &mut [f64]) {}

    /// The first coordinate whose inertia, given those before it, is not positive at time `t`
    /// and state `y`, if the system knows of one: its index in the state.
    fn indefinite(&self, _t: f64, _y: &[f64]) -> Option<usize> {
        None
    }

    /// The next time after `t` at which the right-hand side is not smooth in time (the
    /// next sample of a recorded input, say); no step reaches across it.
    fn next_breakpoint(&self, _t: f64) -> Option<f64> {
        None
    }
}

impl<S: System + ?Sized> System for &S {
    fn states(&self) -> usize {
        (**self).states()
    }

    fn rates(&self, t: f64, y: &[f64], out: &mut [f64]) {
        (**self).rates(t, y, out);
    }

    fn guard_count(&self) -> usize {
        (**self).guard_count()
    }

    fn guards(&self, t: f64, y: &[f64], out: &mut [f64]) {
        (**self).guards(t, y, out);
    }

    fn indefinite(&self, t: f64, y: &[f64]) -> Option<usize> {
        (**self).indefinite(t, y)
    }

    fn next_breakpoint(&self, t: f64) -> Option<f64> {
        (**self).next_breakpoint(t)
    }
}
