//! Adapter that implements [`Variant`] with the evaluator of a derived program.

use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_sim::ode::NOT_POSITIVE_DEFINITE_MESSAGE;

use crate::variant::Variant;

/// Derived variant with fixed parameters.
pub struct Derived {
    evaluator: Evaluator,
}

impl Derived {
    /// Creates the adapter; the evaluator must be prepared with the parameters to use.
    pub fn new(evaluator: Evaluator) -> Self {
        Self { evaluator }
    }

    fn scalars(&self) -> usize {
        self.evaluator.program().observables.len()
    }

    fn observable(&mut self, point: Point<'_>, from_the_end: usize) -> f64 {
        let mut values = vec![0.0; self.scalars()];
        self.evaluator.observables(point, &mut values);
        values[values.len() - from_the_end]
    }
}

impl Variant for Derived {
    fn coordinate_names(&self) -> Vec<String> {
        let program = self.evaluator.program();
        let mut names = program.state_names();
        names.truncate(program.degrees_of_freedom());
        names
    }

    fn corner(&self) -> Option<String> {
        let mut guards = self.evaluator.program().guards.iter();
        let corner = guards.find(|guard| guard.is_corner)?;
        Some(corner.formula.clone())
    }

    fn rates(
        &mut self,
        time: f64,
        state: &[f64],
        inputs: &[f64],
        rates: &mut [f64],
    ) -> Result<(), String> {
        if !self.evaluator.pivots_are_positive() {
            return Err(NOT_POSITIVE_DEFINITE_MESSAGE.to_owned());
        }
        self.evaluator.rates(point(time, state, inputs), rates);
        Ok(())
    }

    fn mass_matrix(
        &mut self,
        time: f64,
        state: &[f64],
        inputs: &[f64],
        mass: &mut [f64],
    ) -> Result<(), String> {
        self.evaluator.mass_matrix(point(time, state, inputs), mass);
        Ok(())
    }

    fn bias_and_forces(
        &mut self,
        time: f64,
        state: &[f64],
        inputs: &[f64],
        bias: &mut [f64],
        forces: &mut [f64],
    ) -> Result<(), String> {
        self.evaluator
            .bias_and_forces(point(time, state, inputs), bias, forces);
        Ok(())
    }

    fn energy(&mut self, time: f64, state: &[f64], inputs: &[f64]) -> Result<f64, String> {
        Ok(self.observable(point(time, state, inputs), 2))
    }

    fn power(&mut self, time: f64, state: &[f64], inputs: &[f64]) -> Result<f64, String> {
        Ok(self.observable(point(time, state, inputs), 1))
    }

    fn guards(&mut self, time: f64, state: &[f64], inputs: &[f64]) -> Result<Vec<f64>, String> {
        let mut values = vec![0.0; self.evaluator.guard_count()];
        self.evaluator
            .guards(point(time, state, inputs), &mut values);
        Ok(values)
    }

    /// Returns the observables, with `energy` and `power` last.
    fn observables(
        &mut self,
        time: f64,
        state: &[f64],
        inputs: &[f64],
    ) -> Result<Vec<f64>, String> {
        let mut values = vec![0.0; self.scalars()];
        self.evaluator
            .observables(point(time, state, inputs), &mut values);
        Ok(values)
    }
}

fn point<'a>(t: f64, state: &'a [f64], inputs: &'a [f64]) -> Point<'a> {
    Point { t, state, inputs }
}
