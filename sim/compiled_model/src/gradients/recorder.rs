//! Recorder of the steps and events of a motion.

use std::cell::{Cell, RefCell};

use eomgen_codegen::program::evaluator::Enclosure;
use eomgen_sim::ode::{ObservedStep, SurfaceMode, System};

/// Kind of a part of a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PartKind {
    /// A step of the solver.
    Step,
    /// Crossing of a surface; the state is continuous.
    Crossing,
    /// Crossing of a surface at which the state jumps.
    Jump,
}

/// Part of a motion, with the modes of the surfaces during it.
#[derive(Clone, Debug)]
pub(super) struct Part {
    pub modes: Vec<SurfaceMode>,
    /// Time (s) and state at the start.
    pub start: (f64, Vec<f64>),
    /// Time (s) and state at the end.
    pub end: (f64, Vec<f64>),
    pub kind: PartKind,
}

/// Parts of a motion in order of time, and the modes at its end.
#[derive(Clone, Debug, Default)]
pub(super) struct Recording {
    pub parts: Vec<Part>,
    pub last_modes: Vec<SurfaceMode>,
}

impl Recording {
    /// Returns the modes after a part.
    pub fn modes_after(&self, part: usize) -> &[SurfaceMode] {
        let next = self.parts.get(part + 1);
        next.map_or(&self.last_modes, |next| &next.modes)
    }
}

/// System of a solver that records its steps.
pub(super) struct Recorder<'s> {
    system: &'s dyn System,
    parts: RefCell<Vec<Part>>,
    /// Sides of the surfaces during the current step.
    sides: RefCell<Vec<f64>>,
    kind: Cell<PartKind>,
    /// Modes before the event.
    earlier_modes: RefCell<Vec<SurfaceMode>>,
}

impl<'s> Recorder<'s> {
    pub fn new(system: &'s dyn System) -> Self {
        Self {
            system,
            parts: RefCell::default(),
            sides: RefCell::new(vec![0.0; system.guard_count()]),
            kind: Cell::new(PartKind::Step),
            earlier_modes: RefCell::default(),
        }
    }

    pub fn finish(self) -> Recording {
        Recording {
            last_modes: self.modes(),
            parts: self.parts.into_inner(),
        }
    }

    fn modes(&self) -> Vec<SurfaceMode> {
        let sides = self.sides.borrow();
        let mut modes: Vec<_> = sides.iter().map(|s| SurfaceMode::from_side(*s)).collect();
        self.system.write_modes(&mut modes);
        modes
    }
}

impl System for Recorder<'_> {
    fn state_count(&self) -> usize {
        self.system.state_count()
    }

    fn rates(&self, t: f64, y: &[f64], out: &mut [f64]) {
        self.system.rates(t, y, out);
    }

    fn typical_sizes(&self) -> Vec<f64> {
        self.system.typical_sizes()
    }

    fn jacobian(&self, t: f64, y: &[f64], out: &mut [f64]) {
        self.system.jacobian(t, y, out);
    }

    fn guard_count(&self) -> usize {
        self.system.guard_count()
    }

    fn guards(&self, t: f64, y: &[f64], out: &mut [f64]) {
        self.system.guards(t, y, out);
    }

    fn bound_guards(&self, t: (f64, f64), state: &[Enclosure], out: &mut [Enclosure]) {
        self.system.bound_guards(t, state, out);
    }

    fn is_singular(&self, guard: usize) -> bool {
        self.system.is_singular(guard)
    }

    fn is_distance(&self, guard: usize) -> bool {
        self.system.is_distance(guard)
    }

    fn has_energy_jump(&self, guard: usize) -> bool {
        self.system.has_energy_jump(guard)
    }

    fn find_indefinite_coordinate(&self, t: f64, y: &[f64]) -> Option<usize> {
        self.system.find_indefinite_coordinate(t, y)
    }

    fn project(&self, t: f64, y: &mut [f64]) -> u64 {
        self.system.project(t, y)
    }

    fn mark_corrected(&self, is_corrected: &mut [bool]) {
        self.system.mark_corrected(is_corrected);
    }

    fn forget_projection(&self) {
        self.system.forget_projection();
    }

    fn next_breakpoint(&self, t: f64) -> Option<f64> {
        self.system.next_breakpoint(t)
    }

    fn apply_event(&self, before: (f64, &[f64]), t: f64, y: &mut [f64]) -> bool {
        self.earlier_modes.replace(self.modes());
        let jumps = self.system.apply_event(before, t, y);
        self.kind.set(match jumps {
            true => PartKind::Jump,
            false => PartKind::Crossing,
        });
        jumps
    }

    fn apply_breakpoint(&self, t: f64, y: &mut [f64]) -> bool {
        self.system.apply_breakpoint(t, y)
    }

    fn fix_sides(&self, sides: Option<&[f64]>) {
        if let Some(sides) = sides {
            self.sides.replace(sides.to_vec());
        }
        self.system.fix_sides(sides);
    }

    fn assume_modes(&self, modes: &[SurfaceMode]) {
        self.system.assume_modes(modes);
    }

    fn update_modes(&self, t: f64, y: &[f64]) {
        self.system.update_modes(t, y);
    }

    fn write_modes(&self, modes: &mut [SurfaceMode]) {
        self.system.write_modes(modes);
    }

    fn add_rate_roundings(&self, length: f64, out: &mut [f64]) {
        self.system.add_rate_roundings(length, out);
    }

    fn is_observing(&self) -> bool {
        true
    }

    fn observe_step(&self, step: &mut ObservedStep<'_>) {
        let kind = self.kind.replace(PartKind::Step);
        let modes = match kind {
            PartKind::Step => self.modes(),
            PartKind::Crossing | PartKind::Jump => self.earlier_modes.take(),
        };
        let owned = |(t, y): (f64, &[f64])| (t, y.to_vec());
        self.parts.borrow_mut().push(Part {
            modes,
            start: owned(step.start),
            end: owned(step.end),
            kind,
        });
        if self.system.is_observing() {
            self.system.observe_step(step);
        }
    }
}
