//! Small systems with known solutions, for the tests of the solvers.

use std::cell::RefCell;

use eomgen_sim::ode::System;

/// Fixed sides of switching functions.
#[derive(Default)]
pub struct FixedSides(RefCell<Option<Vec<f64>>>);

impl FixedSides {
    pub fn fix(&self, sides: Option<&[f64]>) {
        *self.0.borrow_mut() = sides.map(<[f64]>::to_vec);
    }

    /// Returns the fixed side of a function if there is one, otherwise its side for this value.
    pub fn side(&self, guard: usize, value: f64) -> f64 {
        let fixed = self.0.borrow().as_ref().map_or(0.0, |sides| sides[guard]);
        match (fixed, value) {
            (0.0, 0.0) => 0.0,
            (0.0, value) => value.signum(),
            (fixed, _) => fixed,
        }
    }
}

/// A system of closures; the rates depend on the sides of the guards.
pub struct Functions<R, G> {
    pub states: usize,
    pub rates: R,
    pub sides: FixedSides,
    pub guard_count: usize,
    pub guards: G,
    pub breakpoints: Vec<f64>,
}

impl<R, G> System for Functions<R, G>
where
    R: Fn(f64, &[f64], &[f64], &mut [f64]),
    G: Fn(&[f64], &mut [f64]),
{
    fn state_count(&self) -> usize {
        self.states
    }

    fn rates(&self, t: f64, y: &[f64], out: &mut [f64]) {
        let mut sides = vec![0.0; self.guard_count];
        (self.guards)(y, &mut sides);
        for (guard, side) in sides.iter_mut().enumerate() {
            *side = self.sides.side(guard, *side);
        }
        (self.rates)(t, y, &sides, out);
    }

    fn fix_sides(&self, sides: Option<&[f64]>) {
        self.sides.fix(sides);
    }

    fn guard_count(&self) -> usize {
        self.guard_count
    }

    fn guards(&self, _t: f64, y: &[f64], out: &mut [f64]) {
        (self.guards)(y, out);
    }

    fn next_breakpoint(&self, t: f64) -> Option<f64> {
        self.breakpoints.iter().copied().find(|next| *next > t)
    }
}

/// A system without switching surfaces.
pub fn smooth(states: usize, rates: impl Fn(f64, &[f64], &mut [f64])) -> impl System {
    smooth_between(Vec::new(), states, rates)
}

/// A system without switching surfaces that is smooth between breakpoints (s).
pub fn smooth_between(
    breakpoints: Vec<f64>,
    states: usize,
    rates: impl Fn(f64, &[f64], &mut [f64]),
) -> impl System {
    Functions {
        states,
        rates: move |t, y: &[f64], _: &[f64], out: &mut [f64]| rates(t, y, out),
        sides: FixedSides::default(),
        guard_count: 0,
        guards: |_: &[f64], _: &mut [f64]| {},
        breakpoints,
    }
}

/// x'' = -k f_k(x, b): free motion between two elastic walls.
pub fn dead_zone(b: f64, frequency: f64) -> impl System {
    Functions {
        states: 2,
        sides: FixedSides::default(),
        rates: move |_, y: &[f64], sides: &[f64], out: &mut [f64]| {
            let beyond = match (sides[0] > 0.0, sides[1] < 0.0) {
                (true, _) => y[0] - b,
                (_, true) => y[0] + b,
                _ => 0.0,
            };
            out.copy_from_slice(&[y[1], -frequency * frequency * beyond]);
        },
        guard_count: 2,
        guards: move |y: &[f64], out: &mut [f64]| out.copy_from_slice(&[y[0] - b, y[0] + b]),
        breakpoints: Vec::new(),
    }
}

/// x'' = -x - friction sign(x').
pub fn dry_friction(friction: f64) -> impl System {
    Functions {
        states: 2,
        sides: FixedSides::default(),
        rates: move |_, y: &[f64], sides: &[f64], out: &mut [f64]| {
            out.copy_from_slice(&[y[1], -y[0] - friction * sides[0]]);
        },
        guard_count: 1,
        guards: |y: &[f64], out: &mut [f64]| out[0] = y[1],
        breakpoints: Vec::new(),
    }
}
