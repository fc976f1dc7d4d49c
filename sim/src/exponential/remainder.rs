//! Nonlinear remainder of a model: the accelerations that its piecewise-linear part lacks, and the displacement
//! of its switching surfaces relative to those of this part.

use super::prescribed_motions::PrescribedMotions;
use super::regime::Regime;
use super::surfaces::{Row, Surfaces};

/// Terms that a model adds to its piecewise-linear part.
pub trait Force {
    /// Writes the added accelerations at a state. Each term uses the sides of the actual surfaces of the model.
    fn write_accelerations(&mut self, t: f64, state: &[f64], inputs: &[f64], out: &mut [f64]);

    /// Writes the guards of the piecewise-linear part as the whole model has them. Returns false if no guard
    /// ever differs from the piecewise-linear part.
    fn write_guards(&mut self, t: f64, state: &[f64], inputs: &[f64], out: &mut Vec<f64>) -> bool;
}

/// Nonlinear remainder at a state.
#[derive(Clone, Debug, Default)]
pub struct Remainder {
    /// Accelerations relative to those of the regime.
    pub force: Vec<f64>,
    /// Value added to the function of each surface.
    pub moved: Vec<f64>,
    /// True if a surface may be displaced.
    pub moves: bool,
    /// Value added to the holding force of each holding surface, in the order of the regime.
    pub holding_force_change: Vec<f64>,
    guards: Vec<f64>,
}

impl Remainder {
    /// Creates a remainder of 0.
    pub fn zero(accelerations: usize, surfaces: usize) -> Self {
        Self {
            force: vec![0.0; accelerations],
            moved: vec![0.0; surfaces],
            ..Self::default()
        }
    }

    /// Computes the remainder at a state. The accelerations are relative to the linear part with the sides of
    /// its own surfaces.
    pub fn find(
        &mut self,
        (force, prescribed): (&mut dyn Force, &PrescribedMotions),
        (surfaces, functions): (&Surfaces, &[Row]),
        (t, state, given): (f64, &[f64], &[f64]),
    ) {
        let inputs = &prescribed.model_inputs(state, &given[1..]);
        let own = prescribed.model_state(state);
        force.write_accelerations(t, own, inputs, &mut self.force);
        self.moves = force.write_guards(t, own, inputs, &mut self.guards);
        if self.moves {
            let surfaces = surfaces.guards.iter().zip(functions);
            for (slot, (guards, function)) in self.moved.iter_mut().zip(surfaces) {
                *slot = self.guards[guards[0]] - function.evaluate(state, given);
            }
        }
    }
}

/// Difference of the accelerations of two regimes.
#[derive(Debug, Default)]
pub struct RegimeDifference {
    pub pair: (usize, usize),
    /// Differences by the states: index of a state, and one entry per acceleration. Zero columns are omitted.
    by_state: Vec<(usize, Vec<f64>)>,
    /// Differences by a unit constant and the inputs, in the form of `by_state`.
    by_given: Vec<(usize, Vec<f64>)>,
}

impl RegimeDifference {
    pub fn new(
        a: &Regime,
        b: &Regime,
        (states, degrees): (usize, usize),
        pair: (usize, usize),
    ) -> Self {
        let differing = |columns: usize, entry: &dyn Fn(&Regime, usize, usize) -> f64| {
            let column = |column: usize| -> Vec<f64> {
                let rows = degrees..states;
                rows.map(|row| entry(a, row, column) - entry(b, row, column))
                    .collect()
            };
            let columns = (0..columns).map(|index| (index, column(index)));
            columns
                .filter(|(_, column)| column.iter().any(|entry| *entry != 0.0))
                .collect()
        };
        Self {
            by_state: differing(states, &|regime, row, column| {
                regime.matrix.entry(row, column)
            }),
            by_given: differing(a.given.ncols(), &|regime, row, column| {
                regime.given[(row, column)]
            }),
            pair,
        }
    }

    pub fn add(&self, state: &[f64], given: &[f64], out: &mut [f64]) {
        for (columns, values) in [(&self.by_state, state), (&self.by_given, given)] {
            for (index, column) in columns {
                let sums = out.iter_mut().zip(column);
                sums.for_each(|(slot, entry)| *slot += values[*index] * entry);
            }
        }
    }
}
