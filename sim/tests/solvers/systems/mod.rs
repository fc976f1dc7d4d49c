//! Small systems with known solutions, for the tests of the solvers.

use eomgen_sim::ode::System;

/// A system of closures.
pub struct Functions<R, G> {
    pub states: usize,
    pub rates: R,
    pub guard_count: usize,
    pub guards: G,
    pub breakpoints: Vec<f64>,
}

impl<R, G> System for Functions<R, G>
where
    R: Fn(f64, &[f64], &mut [f64]),
    G: Fn(&[f64], &mut [f64]),
{
    fn state_count(&self) -> usize {
        self.states
    }

    fn rates(&self, t: f64, y: &[f64], out: &mut [f64]) {
        (self.rates)(t, y, out);
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
pub fn smooth<R: Fn(f64, &[f64], &mut [f64])>(
    states: usize,
    rates: R,
) -> Functions<R, impl Fn(&[f64], &mut [f64])> {
    Functions {
        states,
        rates,
        guard_count: 0,
        guards: |_: &[f64], _: &mut [f64]| {},
        breakpoints: Vec::new(),
    }
}

/// x'' = -k f_k(x, b): free motion between two elastic walls.
pub fn dead_zone(b: f64, frequency: f64) -> impl System {
    Functions {
        states: 2,
        rates: move |_, y: &[f64], out: &mut [f64]| {
            let beyond = if y[0] > b {
                y[0] - b
            } else if y[0] < -b {
                y[0] + b
            } else {
                0.0
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
        rates: move |_, y: &[f64], out: &mut [f64]| {
            let sign = if y[1] > 0.0 {
                1.0
            } else if y[1] < 0.0 {
                -1.0
            } else {
                0.0
            };
            out.copy_from_slice(&[y[1], -y[0] - friction * sign]);
        },
        guard_count: 1,
        guards: |y: &[f64], out: &mut [f64]| out[0] = y[1],
        breakpoints: Vec::new(),
    }
}
