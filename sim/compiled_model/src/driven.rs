//! A derived model seen by the solvers: the evaluator of its program and the inputs that drive
//! it behind their trait.

use std::cell::RefCell;

use codegen::program::evaluator::{Evaluator, Point};
use codegen::program::{Op, ValueId};
use sim::inputs::HeldInputs;
use sim::ode::{NOT_POSITIVE, Surface, System};

/// A derived variant driven by inputs, as the solver sees it.
pub struct Driven {
    evaluator: RefCell<Evaluator>,
    inputs: HeldInputs,
}

impl Driven {
    /// Takes an evaluator, prepared with the parameters to be used, and its inputs.
    ///
    /// # Errors
    /// If the mass matrix is not positive definite.
    pub fn new(evaluator: Evaluator, inputs: HeldInputs) -> Result<Self, String> {
        if !evaluator.pivots_are_positive() {
            return Err(NOT_POSITIVE.to_owned());
        }
        Ok(Self {
            evaluator: RefCell::new(evaluator),
            inputs,
        })
    }

    /// The switching functions, those over modes one by one. A speed is one that depends on rates,
    /// and on no coordinate where nothing moves.
    pub fn surfaces(&self) -> Vec<Surface> {
        let (here, there) = (self.guards_at_rest(0.11), self.guards_at_rest(0.17));
        let evaluator = self.evaluator.borrow();
        let program = evaluator.program();
        let is_rate =
            |id: &ValueId| matches!(program.value(*id).op, Op::Rate(_) | Op::ModeRates(_));
        let all = program.guards.iter().flat_map(|guard| {
            let moves = program.reachable(&[guard.value]).iter().any(is_rate);
            let count = program.value(guard.value).extent.length();
            std::iter::repeat_n((&guard.formula, moves), count)
        });
        all.zip(here.iter().zip(&there))
            .map(|((formula, moves), (here, there))| Surface {
                formula: formula.clone(),
                is_speed: moves && here == there,
            })
            .collect()
    }

    /// The switching functions where nothing moves, with coordinates of this size.
    fn guards_at_rest(&self, size: f64) -> Vec<f64> {
        let mut values = vec![0.0; self.guard_count()];
        let mut state = vec![0.0; self.states()];
        let degrees = state.len() / 2;
        for (place, coordinate) in state[..degrees].iter_mut().enumerate() {
            *coordinate = size / (place + 2) as f64;
        }
        self.guards(0.0, &state, &mut values);
        values
    }

    /// The observables at a state, `energy` and `power` last.
    pub fn observables(&self, t: f64, state: &[f64], out: &mut [f64]) {
        let inputs = self.inputs.at(t);
        self.evaluator
            .borrow_mut()
            .observables(point(t, state, inputs), out);
    }
}

impl System for Driven {
    fn states(&self) -> usize {
        self.evaluator.borrow().program().states()
    }

    fn rates(&self, t: f64, y: &[f64], out: &mut [f64]) {
        let inputs = self.inputs.at(t);
        self.evaluator.borrow_mut().rates(point(t, y, inputs), out);
    }

    fn guard_count(&self) -> usize {
        self.evaluator.borrow().guard_count()
    }

    fn guards(&self, t: f64, y: &[f64], out: &mut [f64]) {
        let inputs = self.inputs.at(t);
        self.evaluator.borrow_mut().guards(point(t, y, inputs), out);
    }

    fn indefinite(&self, t: f64, y: &[f64]) -> Option<usize> {
        let inputs = self.inputs.at(t);
        let mut evaluator = self.evaluator.borrow_mut();
        let size = evaluator.program().degrees_of_freedom();
        let mut mass = vec![0.0; size * size];
        evaluator.mass_matrix(point(t, y, inputs), &mut mass);
        first_not_positive(&mut mass, size)
    }

    fn next_breakpoint(&self, t: f64) -> Option<f64> {
        self.inputs.next_change(t)
    }
}

/// A pivot that is this small beside its diagonal entry is rounding.
const NOTHING_LEFT: f64 = 1e-14;

/// The first row of a symmetric matrix, of finite entries, whose pivot is not positive when the
/// rows before it are eliminated.
fn first_not_positive(matrix: &mut [f64], size: usize) -> Option<usize> {
    if matrix.iter().any(|entry| !entry.is_finite()) {
        return None;
    }
    for row in 0..size {
        let diagonal = matrix[row * size + row];
        // Row by row, L L^T = matrix, into its lower part.
        for column in 0..=row {
            let products = (0..column)
                .map(|k| matrix[row * size + k] * matrix[column * size + k])
                .sum::<f64>();
            let rest = matrix[row * size + column] - products;
            if column == row && rest <= NOTHING_LEFT * diagonal.abs() {
                return Some(row);
            }
            matrix[row * size + column] = if column == row {
                rest.sqrt()
            } else {
                rest / matrix[column * size + column]
            };
        }
    }
    None
}

fn point<'a>(t: f64, state: &'a [f64], inputs: &'a [f64]) -> Point<'a> {
    Point { t, state, inputs }
}
