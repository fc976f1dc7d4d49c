//! What of a model is not linear between its surfaces: accelerations, and how far the surfaces
//! themselves lie beyond the linear part's. Teeth with a transmission error touch where the
//! deflection less the error reaches the play; where that differs from the linear part's place
//! by more than the play, a march by the linear part's sides would be in the wrong regime.

use super::regime::Regime;
use super::surfaces::{Row, Side, Surfaces};
use super::{Company, March, Motion};

/// How far from a surface that is crossed, in steps, a model is asked for its accelerations on
/// either side: on the surface itself rounding decides on which it is.
pub const AHEAD: f64 = 1e-4;

/// Terms beyond the linear ones.
pub trait Force {
    /// Writes the accelerations that they add at a state, each part of the model on the sides
    /// of its own surfaces.
    fn at(&mut self, t: f64, state: &[f64], inputs: &[f64], out: &mut [f64]);

    /// Writes the value of each of the linear part's guards in the whole model; false where
    /// that is the linear part's anywhere.
    fn at_guards(&mut self, t: f64, state: &[f64], inputs: &[f64], out: &mut Vec<f64>) -> bool;
}

/// What lies beyond the linear part at a state.
#[derive(Clone, Debug, Default)]
pub struct Excess {
    /// Accelerations, with a regime's own taken away.
    pub force: Vec<f64>,
    /// What is added to the function of each surface.
    pub moved: Vec<f64>,
    /// Whether anything may be.
    pub moves: bool,
    guards: Vec<f64>,
}

impl Excess {
    /// Nothing, so far.
    pub fn none(accelerations: usize, surfaces: usize) -> Self {
        Self {
            force: vec![0.0; accelerations],
            moved: vec![0.0; surfaces],
            ..Self::default()
        }
    }

    /// Finds it at a state; accelerations relative to the linear part on the sides of its own
    /// surfaces.
    pub fn find(
        &mut self,
        force: &mut dyn Force,
        (surfaces, functions): (&Surfaces, &[Row]),
        (t, state, given): (f64, &[f64], &[f64]),
    ) {
        let inputs = &given[1..];
        force.at(t, state, inputs, &mut self.force);
        self.moves = force.at_guards(t, state, inputs, &mut self.guards);
        if self.moves {
            let surfaces = surfaces.guards.iter().zip(functions);
            for (slot, (guards, function)) in self.moved.iter_mut().zip(surfaces) {
                *slot = self.guards[guards[0]] - function.at(state, given);
            }
        }
    }
}

impl March {
    /// Finds what lies beyond the linear part where a motion stands.
    pub(super) fn meet(
        &mut self,
        motion: &mut Motion,
        t: f64,
        force: &mut dyn Force,
    ) -> Result<(), String> {
        let here = (motion.regime, &motion.sides[..]);
        let at = (t, &motion.state[..], &motion.given[..]);
        self.beyond(here, at, force, &mut motion.excess)
    }

    /// The same at any state, relative to a regime with its sides.
    pub(super) fn beyond(
        &mut self,
        (here, sides): (usize, &[Side]),
        (t, state, given): (f64, &[f64], &[f64]),
        force: &mut dyn Force,
        out: &mut Excess,
    ) -> Result<(), String> {
        let functions = &self.regimes[here].functions;
        out.find(force, (&self.surfaces, functions), (t, state, given));
        self.relate((here, sides), state, given, out)
    }

    /// The same where a motion with these rates is so many steps later, or was so many before:
    /// beside a surface that it crosses.
    pub(super) fn meet_near(
        &mut self,
        motion: &mut Motion,
        (t, steps): (f64, f64),
        rates: &[f64],
        company: &mut Company<'_, '_>,
    ) -> Result<(), String> {
        let Some(force) = &mut company.force else {
            return Ok(());
        };
        if !motion.excess.moves {
            return self.meet(motion, t, &mut **force);
        }
        let tau = steps * self.step;
        let pairs = motion.state.iter().zip(rates);
        let near: Vec<f64> = pairs.map(|(x, rate)| x + tau * rate).collect();
        let here = (motion.regime, &motion.sides[..]);
        let at = (t + tau, &near[..], &motion.given[..]);
        self.beyond(here, at, &mut **force, &mut motion.excess)
    }

    /// Takes accelerations relative to a regime with its sides, not to the one in which the
    /// linear part alone would be.
    fn relate(
        &mut self,
        (here, sides): (usize, &[Side]),
        state: &[f64],
        given: &[f64],
        excess: &mut Excess,
    ) -> Result<(), String> {
        if !excess.moves {
            return Ok(());
        }
        let functions = &self.regimes[here].functions;
        self.own.clear();
        self.own.extend_from_slice(sides);
        for ((side, function), moved) in self.own.iter_mut().zip(functions).zip(&excess.moved) {
            if *moved != 0.0 && *side != Side::Held {
                *side = Side::of(function.at(state, given));
            }
        }
        if self.own == sides {
            return Ok(());
        }
        if self.last_own.0 != self.own {
            let own = self.own.clone();
            self.last_own = (own.clone(), self.regime(&own)?);
        }
        let pair = (self.last_own.1, here);
        if self.apart.pair != pair {
            self.apart = Apart::of(
                &self.regimes[pair.0],
                &self.regimes[pair.1],
                self.states,
                pair,
            );
        }
        self.apart.add(state, given, &mut excess.force);
        Ok(())
    }
}

/// How much the accelerations of one regime are above those of another.
#[derive(Debug, Default)]
pub struct Apart {
    pair: (usize, usize),
    /// By each state that they differ by, one per acceleration.
    by_state: Vec<(usize, Vec<f64>)>,
    /// The same by a unit constant and the inputs.
    by_given: Vec<(usize, Vec<f64>)>,
}

impl Apart {
    fn of(a: &Regime, b: &Regime, states: usize, pair: (usize, usize)) -> Self {
        let differing = |columns: usize, entry: &dyn Fn(&Regime, usize, usize) -> f64| {
            let column = |column: usize| -> Vec<f64> {
                let rows = states / 2..states;
                rows.map(|row| entry(a, row, column) - entry(b, row, column))
                    .collect()
            };
            let columns = (0..columns).map(|place| (place, column(place)));
            columns
                .filter(|(_, column)| column.iter().any(|entry| *entry != 0.0))
                .collect()
        };
        Self {
            by_state: differing(states, &|regime, row, column| regime.matrix.at(row, column)),
            by_given: differing(a.given.ncols(), &|regime, row, column| {
                regime.given[(row, column)]
            }),
            pair,
        }
    }

    fn add(&self, state: &[f64], given: &[f64], out: &mut [f64]) {
        for (columns, values) in [(&self.by_state, state), (&self.by_given, given)] {
            for (place, column) in columns {
                let sums = out.iter_mut().zip(column);
                sums.for_each(|(slot, entry)| *slot += values[*place] * entry);
            }
        }
    }
}
