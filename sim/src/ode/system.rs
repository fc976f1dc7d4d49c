//! What the solver needs to know of a system.

use super::settings::difference_step;

/// A step that a solver has made, for those who observe a motion. Looking at it changes nothing.
pub struct ObservedStep<'s> {
    /// Time (s) and state at its start.
    pub start: (f64, &'s [f64]),
    /// Time (s) and state at its end. What jumps at a breakpoint has not jumped yet.
    pub end: (f64, &'s [f64]),
    /// The state at a time (s) inside; `None` if it cannot be had.
    pub inside: &'s mut dyn FnMut(f64, Interior) -> Option<Vec<f64>>,
}

/// How to find a state inside a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interior {
    /// By interpolation, without evaluations of the rates.
    Interpolated,
    /// By a shorter step from the same start, if that is more accurate.
    Resolved,
}

/// A system y' = f(t, y) whose right-hand side is smooth between switching surfaces.
pub trait System {
    /// The number of state variables.
    fn states(&self) -> usize;

    /// Writes y' at time `t` and state `y` to `out`; all have [`System::states`] entries.
    fn rates(&self, t: f64, y: &[f64], out: &mut [f64]);

    /// Typical sizes of the states, in their own units: [`System::states`] entries. Solvers compare states
    /// near 0 with them.
    fn typical_sizes(&self) -> Vec<f64> {
        vec![1.0; self.states()]
    }

    /// Writes the derivatives of the rates by the state at time `t` and state `y` to `out`, row by
    /// row: entry (i, j), of y_i' by y_j, at `i * states + j`. Implicit methods ask for it. By
    /// forward differences unless the system knows better.
    fn jacobian(&self, t: f64, y: &[f64], out: &mut [f64]) {
        jacobian_by_differences(self, t, y, out);
    }

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

    /// Brings the state `y` at time `t` back onto what the motion keeps exactly, such as the
    /// constraints of a mechanism, from which steps stray by their errors. Returns how many
    /// evaluations of the rates that took: 0 where there is nothing to keep.
    fn project(&self, _t: f64, _y: &mut [f64]) -> u64 {
        0
    }

    /// The next time after `t` at which the right-hand side is not smooth in time (the
    /// next sample of a recorded input, say); no step reaches across it.
    fn next_breakpoint(&self, _t: f64) -> Option<f64> {
        None
    }

    /// The motion has gone over a switching surface: `before` (time and state) is on its near
    /// side, `t` and `y` are just beyond it. Changes in `y` what jumps there, as the distance to a
    /// neighbouring motion does that is carried beside the motion.
    fn cross(&self, _before: (f64, &[f64]), _t: f64, _y: &mut [f64]) {}

    /// From here on rates go on smoothly over surfaces that may hold a motion, as they are on these sides
    /// of them: for each switching function -1, 1, or 0 where it is not known. With none they are
    /// those of the side where a state is, again. A system that does not know how may leave it.
    fn keep_sides(&self, _sides: Option<&[f64]>) {}

    /// The motion has come to `t` and `y`, and what drives it may jump here. Returns the
    /// switching functions whose surfaces have caught the motion since this was last asked, or let it
    /// go, each with whether the motion came from its negative side, or goes to its positive one. Such
    /// a function need not change its sign.
    fn caught_or_let_go(&self, _t: f64, _y: &[f64]) -> Vec<(usize, bool)> {
        Vec::new()
    }

    /// Whether [`System::observe_step`] is to be called.
    fn is_observing(&self) -> bool {
        false
    }

    /// Takes note of a step that the solver has accepted.
    fn observe_step(&self, _step: &mut ObservedStep<'_>) {}
}

impl<S: System + ?Sized> System for &S {
    fn states(&self) -> usize {
        (**self).states()
    }

    fn rates(&self, t: f64, y: &[f64], out: &mut [f64]) {
        (**self).rates(t, y, out);
    }

    fn typical_sizes(&self) -> Vec<f64> {
        (**self).typical_sizes()
    }

    fn jacobian(&self, t: f64, y: &[f64], out: &mut [f64]) {
        (**self).jacobian(t, y, out);
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

    fn project(&self, t: f64, y: &mut [f64]) -> u64 {
        (**self).project(t, y)
    }

    fn next_breakpoint(&self, t: f64) -> Option<f64> {
        (**self).next_breakpoint(t)
    }

    fn cross(&self, before: (f64, &[f64]), t: f64, y: &mut [f64]) {
        (**self).cross(before, t, y);
    }

    fn keep_sides(&self, sides: Option<&[f64]>) {
        (**self).keep_sides(sides);
    }

    fn caught_or_let_go(&self, t: f64, y: &[f64]) -> Vec<(usize, bool)> {
        (**self).caught_or_let_go(t, y)
    }

    fn is_observing(&self) -> bool {
        (**self).is_observing()
    }

    fn observe_step(&self, step: &mut ObservedStep<'_>) {
        (**self).observe_step(step);
    }
}

/// The derivatives of the rates by the state, as [`System::jacobian`] has them, by forward
/// differences, each over a part of the state's size.
pub fn jacobian_by_differences<S: System + ?Sized>(system: &S, t: f64, y: &[f64], out: &mut [f64]) {
    let states = y.len();
    let mut base = vec![0.0; states];
    system.rates(t, y, &mut base);
    let (mut moved, mut rates) = (y.to_vec(), vec![0.0; states]);
    let sizes = system.typical_sizes();
    for column in 0..states {
        let step = difference_step(y[column], sizes[column]);
        moved[column] = y[column] + step;
        system.rates(t, &moved, &mut rates);
        for row in 0..states {
            out[row * states + column] = (rates[row] - base[row]) / (moved[column] - y[column]);
        }
        moved[column] = y[column];
    }
}
