//! The interface between a system and its solver.

use eomgen_codegen::program::evaluator::Enclosure;

use super::events::SurfaceMode;
use super::settings::difference_step;

/// An accepted step, for observers. Reading it does not change the motion.
pub struct ObservedStep<'s> {
    /// Time (s) and state at the start.
    pub start: (f64, &'s [f64]),
    /// Time (s) and state at the end, before any jump at a breakpoint.
    pub end: (f64, &'s [f64]),
    /// Returns the state at a time (s) inside the step; `None` if it is not available.
    pub state_inside: &'s mut dyn FnMut(f64, Interior) -> Option<Vec<f64>>,
}

/// Method for states inside a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interior {
    /// Interpolation, without evaluations of the rates.
    Interpolated,
    /// Interpolation if it is accurate enough for samples of a smooth motion, otherwise a shorter step from the
    /// same start.
    Accurate,
    /// A shorter step from the same start, if that is more accurate.
    Recomputed,
}

/// A system y' = f(t, y) whose right-hand side is smooth between switching surfaces.
pub trait System {
    /// Returns the number of states.
    fn state_count(&self) -> usize;

    /// Writes y' at time `t` and state `y` to `out`; all have [`System::state_count`] entries.
    fn rates(&self, t: f64, y: &[f64], out: &mut [f64]);

    /// Returns the typical sizes of the states, [`System::state_count`] entries in the units of the
    /// states. Solvers compare states near 0 with them.
    fn typical_sizes(&self) -> Vec<f64> {
        vec![1.0; self.state_count()]
    }

    /// Writes the derivatives of the rates with respect to the state at time `t` and state `y` to
    /// `out`, row-major: dy_i'/dy_j at `i * states + j`. Implicit methods use it. The default
    /// takes forward differences.
    fn jacobian(&self, t: f64, y: &[f64], out: &mut [f64]) {
        jacobian_by_differences(self, t, y, out);
    }

    /// Returns the number of switching surfaces.
    fn guard_count(&self) -> usize {
        0
    }

    /// Writes the value of each switching function to `out`, [`System::guard_count`] entries. The
    /// right-hand side may have a kink or jump only on a sign change of one of them.
    fn guards(&self, _t: f64, _y: &[f64], _out: &mut [f64]) {}

    /// Writes the bounds of the switching functions over a segment of a motion to `out`,
    /// [`System::guard_count`] entries, from the times `t` (begin, end; s) and the bounds of the states.
    /// Functions with [`Enclosure::UNKNOWN`] are searched by samples.
    fn bound_guards(&self, _t: (f64, f64), _state: &[Enclosure], out: &mut [Enclosure]) {
        out.fill(Enclosure::UNKNOWN);
    }

    /// Returns true if the derivatives of the rates grow without bound towards the surface of a switching
    /// function, as for v/norm(v). Such a surface is approached in several steps.
    fn is_singular(&self, _guard: usize) -> bool {
        false
    }

    /// Returns true if a switching function is the distance of an impact. Bounces may become arbitrarily low,
    /// so the events are applied on the surface itself.
    fn is_distance(&self, _guard: usize) -> bool {
        false
    }

    /// Returns true if the energies jump where a switching function is 0. If a motion starts on such a surface,
    /// it starts on the side on which the function is negative.
    fn has_energy_jump(&self, _guard: usize) -> bool {
        false
    }

    /// Returns the index of the first coordinate whose pivot in the mass matrix is not positive at time `t` and
    /// state `y`, after the elimination of the preceding coordinates; `None` if there is none or the system
    /// does not check.
    fn find_indefinite_coordinate(&self, _t: f64, _y: &[f64]) -> Option<usize> {
        None
    }

    /// Projects the state `y` at time `t` onto invariants such as constraints, from which steps
    /// drift. Returns the number of evaluations of the rates; 0 without invariants.
    fn project(&self, _t: f64, _y: &mut [f64]) -> u64 {
        0
    }

    /// Marks the states that the last call of [`System::project`] corrects, in addition to the states that it
    /// changed: a correction may be below the rounding of a state.
    fn mark_corrected(&self, _is_corrected: &mut [bool]) {}

    /// Discards the data that the last call of [`System::project`] stored: the projected state is not part of
    /// the motion.
    fn forget_projection(&self) {}

    /// Returns the next time after `t` at which the right-hand side is not smooth in time, for
    /// example the next sample of an input. No step crosses it.
    fn next_breakpoint(&self, _t: f64) -> Option<f64> {
        None
    }

    /// Changes `y` after an event: `before` (time and state) is on the near side of the switching
    /// surface, `t` and `y` are just beyond it. Impacts and tangent vectors jump here. Returns true if states jump.
    fn apply_event(&self, _before: (f64, &[f64]), _t: f64, _y: &mut [f64]) -> bool {
        false
    }

    /// Changes `y` at a breakpoint `t`, where inputs jump. Returns true if it did.
    fn apply_breakpoint(&self, _t: f64, _y: &mut [f64]) -> bool {
        false
    }

    /// Fixes the sides of the surfaces, -1, 1, or 0 (unknown) per switching function, so that the rates
    /// continue smoothly across them: a step may pass a surface before the crossing is located. `None` restores
    /// the rates of the side on which the state is. If a system with switching functions does not implement
    /// this method, steps near surfaces are short and only as accurate as the tolerance.
    fn fix_sides(&self, _sides: Option<&[f64]>) {}

    /// Sets the modes in which a motion continues, before its first evaluation. Surfaces that hold or are
    /// closed in `modes` keep this mode from the start, if the state is on them up to errors of its
    /// computation. Empty if no modes are known.
    fn assume_modes(&self, _modes: &[SurfaceMode]) {}

    /// Updates the modes of the surfaces at `t` and `y`, where inputs may jump: sticking ends if a force
    /// exceeds its limit.
    fn update_modes(&self, _t: f64, _y: &[f64]) {}

    /// Replaces modes that follow from the sides of the surfaces, [`System::guard_count`] entries, by the
    /// actual modes: held or closed.
    fn write_modes(&self, _modes: &mut [SurfaceMode]) {}

    /// Adds the rounding errors of the rates at rest to `out`, [`System::state_count`] entries in the units of
    /// the rates. They are caused by forces that balance others, such as forces of holding surfaces. A rate
    /// that is also a state accumulates the rounding errors of a step of this `length` (s).
    fn add_rate_roundings(&self, _length: f64, _out: &mut [f64]) {}

    /// Returns true if the solver must call [`System::observe_step`].
    fn is_observing(&self) -> bool {
        false
    }

    /// Observes an accepted step.
    fn observe_step(&self, _step: &mut ObservedStep<'_>) {}
}

impl<S: System + ?Sized> System for &S {
    fn state_count(&self) -> usize {
        (**self).state_count()
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

    fn bound_guards(&self, t: (f64, f64), state: &[Enclosure], out: &mut [Enclosure]) {
        (**self).bound_guards(t, state, out);
    }

    fn is_singular(&self, guard: usize) -> bool {
        (**self).is_singular(guard)
    }

    fn is_distance(&self, guard: usize) -> bool {
        (**self).is_distance(guard)
    }

    fn has_energy_jump(&self, guard: usize) -> bool {
        (**self).has_energy_jump(guard)
    }

    fn find_indefinite_coordinate(&self, t: f64, y: &[f64]) -> Option<usize> {
        (**self).find_indefinite_coordinate(t, y)
    }

    fn project(&self, t: f64, y: &mut [f64]) -> u64 {
        (**self).project(t, y)
    }

    fn mark_corrected(&self, is_corrected: &mut [bool]) {
        (**self).mark_corrected(is_corrected);
    }

    fn forget_projection(&self) {
        (**self).forget_projection();
    }

    fn next_breakpoint(&self, t: f64) -> Option<f64> {
        (**self).next_breakpoint(t)
    }

    fn apply_event(&self, before: (f64, &[f64]), t: f64, y: &mut [f64]) -> bool {
        (**self).apply_event(before, t, y)
    }

    fn apply_breakpoint(&self, t: f64, y: &mut [f64]) -> bool {
        (**self).apply_breakpoint(t, y)
    }

    fn fix_sides(&self, sides: Option<&[f64]>) {
        (**self).fix_sides(sides);
    }

    fn assume_modes(&self, modes: &[SurfaceMode]) {
        (**self).assume_modes(modes);
    }

    fn update_modes(&self, t: f64, y: &[f64]) {
        (**self).update_modes(t, y);
    }

    fn write_modes(&self, modes: &mut [SurfaceMode]) {
        (**self).write_modes(modes);
    }

    fn add_rate_roundings(&self, length: f64, out: &mut [f64]) {
        (**self).add_rate_roundings(length, out);
    }

    fn is_observing(&self) -> bool {
        (**self).is_observing()
    }

    fn observe_step(&self, step: &mut ObservedStep<'_>) {
        (**self).observe_step(step);
    }
}

/// Computes [`System::jacobian`] by forward differences.
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
