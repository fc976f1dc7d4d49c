//! Matrices of a linearisation. For a large model they are computed column by column, from derivatives along each state
//! and input.
//!
//! The program of one derivative along a direction is a few times as long as that of the rates. Programs of Jacobians
//! compute each entry: in relative coordinates of a chain, their length grows with a power of the number of bodies.

use eomgen_codegen::mechanics::outputs::TANGENTS;
use eomgen_codegen::program::evaluator::{Evaluator, Point};

use crate::error::Error;
use crate::evaluation::prepare_evaluator;
use crate::instance::Instance;
use crate::jacobians::{Jacobian, JacobianEvaluator, JacobianLayout};

/// Derivatives of rates and observables at a point, row-major.
pub(crate) struct StateSpace {
    /// Derivatives of the rates with respect to the state.
    pub a: Vec<f64>,
    /// Derivatives of the rates with respect to the inputs.
    pub b: Vec<f64>,
    /// Derivatives of the observables with respect to the state.
    pub c: Vec<f64>,
    /// Derivatives of the observables with respect to the inputs.
    pub d: Vec<f64>,
}

impl StateSpace {
    fn is_finite(&self) -> bool {
        let all = [&self.a, &self.b, &self.c, &self.d];
        all.into_iter().flatten().all(|number| number.is_finite())
    }
}

/// Largest product of two numbers for which every entry of the Jacobians is derived: operations of the rates, and
/// variables. A plane chain of 20 hinged bodies is below this limit and needs 0.2 GB. A chain of 40 bodies would need
/// 1.5 GB.
const MAX_ENTRY_WORK: usize = 500_000;

/// Evaluator of [`StateSpace`] and of derivatives with respect to time.
pub(crate) struct StateSpaceEvaluator<'i, 'm> {
    instance: &'i Instance<'m>,
    tangents: Option<Tangents>,
    entries: Option<JacobianEvaluator>,
}

impl<'m> Instance<'m> {
    /// Returns an evaluator of the matrices of a linearisation. It does not check that the mass matrix is positive
    /// definite, so its accelerations may be invalid.
    ///
    /// Small models are differentiated entry by entry, because entries that cancel are then exactly 0 and null spaces
    /// can be found. Large models are differentiated along directions.
    pub(crate) fn state_space_evaluator(&self) -> Result<StateSpaceEvaluator<'_, 'm>, Error> {
        let program = self.model().program();
        let variables = program.states() + program.inputs.len();
        match program.ids().count() * variables > MAX_ENTRY_WORK {
            true => self.state_space_along_directions(),
            false => Ok(StateSpaceEvaluator {
                instance: self,
                tangents: None,
                entries: Some(self.interpreted_jacobians()?),
            }),
        }
    }

    fn state_space_along_directions(&self) -> Result<StateSpaceEvaluator<'_, 'm>, Error> {
        let program = self.model().tangent_program()?;
        let layout = |name: &str| JacobianLayout::find(program, name).unwrap_or_default();
        let tangents = Tangents {
            along: layout(TANGENTS),
            by_time: layout(Jacobian::RatesByTime.name()),
            evaluator: prepare_evaluator(program, None, self.parameters()),
        };
        Ok(StateSpaceEvaluator {
            instance: self,
            tangents: Some(tangents),
            entries: None,
        })
    }
}

impl StateSpaceEvaluator<'_, '_> {
    /// Returns the matrices at a point. On a switching surface the derivatives are one-sided. An infinite entry does
    /// not affect the other entries.
    pub(crate) fn evaluate(&mut self, point: Point<'_>) -> Result<StateSpace, Error> {
        if let Some(tangents) = &mut self.tangents {
            let found = tangents.evaluate(point);
            if found.is_finite() {
                return Ok(found);
            }
        }
        // In a derivative along one direction, infinity times 0 hides the finite entries of the same row.
        let entries = match &mut self.entries {
            Some(entries) => entries,
            none => none.insert(self.instance.interpreted_jacobians()?),
        };
        let mut dense = |of| entries.evaluate_dense(of, point);
        Ok(StateSpace {
            a: dense(Jacobian::RatesByState),
            b: dense(Jacobian::RatesByInputs),
            c: dense(Jacobian::ObservablesByState),
            d: dense(Jacobian::ObservablesByInputs),
        })
    }

    /// Returns true if a rate depends on time at a point, at constant state and inputs.
    pub(crate) fn depends_on_time(&mut self, point: Point<'_>) -> bool {
        let by_time = match (&mut self.tangents, &mut self.entries) {
            (Some(tangents), _) => tangents.by_time(point),
            (None, Some(entries)) => entries.evaluate_dense(Jacobian::RatesByTime, point),
            (None, None) => Vec::new(),
        };
        by_time.iter().any(|rate| *rate != 0.0)
    }
}

/// Evaluator of derivatives along directions.
struct Tangents {
    evaluator: Evaluator,
    along: JacobianLayout,
    by_time: JacobianLayout,
}

impl Tangents {
    fn evaluate(&mut self, point: Point<'_>) -> StateSpace {
        let program = self.evaluator.program();
        let (degrees, observables) = (program.degrees_of_freedom(), program.observables.len());
        let (states, inputs) = (point.state.len(), point.inputs.len());
        let mut found = StateSpace {
            a: vec![0.0; states * states],
            b: vec![0.0; states * inputs],
            c: vec![0.0; observables * states],
            d: vec![0.0; observables * inputs],
        };
        for place in 0..degrees {
            found.a[place * states + degrees + place] = 1.0;
        }
        let mut direction = vec![0.0; states + inputs];
        for column in 0..states + inputs {
            direction[column] = 1.0;
            let parts = direction.split_at(states);
            let along = &mut self.along;
            self.evaluator.compute_derivatives_along(
                along.place,
                point,
                parts,
                &mut along.nonzeros,
            );
            for (row, value) in along.dense.iter().zip(&along.nonzeros) {
                let (matrix, row) = match (*row < states, column < states) {
                    (true, true) => (&mut found.a, *row),
                    (true, false) => (&mut found.b, *row),
                    (false, true) => (&mut found.c, *row - states),
                    (false, false) => (&mut found.d, *row - states),
                };
                let (column, columns) = match column < states {
                    true => (column, states),
                    false => (column - states, inputs),
                };
                matrix[row * columns + column] = *value;
            }
            direction[column] = 0.0;
        }
        found
    }

    /// Returns the derivatives of the rates with respect to time that are not identically 0.
    fn by_time(&mut self, point: Point<'_>) -> Vec<f64> {
        let layout = &mut self.by_time;
        self.evaluator
            .jacobian(layout.place, point, &mut layout.nonzeros);
        layout.nonzeros.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CompiledModel, Orders};

    const FORCED: &str = r#"
[model]
name = "forced"
[parameters]
m = { value = 2, unit = "kg" }
l = { value = 1, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
c = { value = 0.3, unit = "N m s" }
tau = { value = 0.5, unit = "s" }
[coordinates]
q = { unit = "rad" }
p = { unit = "rad" }
[states]
z = { unit = "N m", rate = "(u - z)/tau" }
[inputs]
u = { unit = "N m" }
valve = { unit = "N m" }
[definitions]
r = "[l*sin(q) + l*sin(p), -l*cos(q) - l*cos(p)]"
[kinetic]
bobs = "1/2*m*l^2*dot(q)^2 + 1/2*m*dot(dot(r), dot(r))"
[potential]
weight = "-m*g*l*cos(q) + m*g*r.y"
[dissipation]
joints = "1/2*c*(dot(q)^2 + dot(p)^2)"
[forces]
motor = { on = "q", value = "z + u*cos(p)" }
flow = { on = "p", value = "sign(valve)*sqrt(abs(valve))*sqrt(m*g*l)" }
[observables]
height = { value = "r.y", unit = "m" }
"#;

    /// Returns the matrices computed along directions and entry by entry.
    fn compute_both(inputs: &[f64]) -> [StateSpace; 2] {
        let model = CompiledModel::from_text("forced.toml", FORCED, Orders::Declared);
        let model = model.unwrap_or_else(|error| panic!("{error}"));
        let run = model.with_declared_parameters().expect("an instance");
        let state = [0.4, -0.7, 1.1, 0.2, 3.0];
        let point = Point {
            t: 0.0,
            state: &state,
            inputs,
        };
        let mut entries = run.interpreted_jacobians().expect("Jacobians");
        let mut dense = |of| entries.evaluate_dense(of, point);
        let expected = StateSpace {
            a: dense(Jacobian::RatesByState),
            b: dense(Jacobian::RatesByInputs),
            c: dense(Jacobian::ObservablesByState),
            d: dense(Jacobian::ObservablesByInputs),
        };
        let evaluator = run.state_space_along_directions();
        let found = evaluator.expect("tangents").evaluate(point);
        [found.expect("matrices"), expected]
    }

    #[test]
    fn derivatives_along_variables_match_jacobians() {
        let [found, expected] = compute_both(&[0.5, -2.0]);
        for (found, expected) in [
            (found.a, expected.a),
            (found.b, expected.b),
            (found.c, expected.c),
            (found.d, expected.d),
        ] {
            assert_eq!(found.len(), expected.len());
            for (found, expected) in found.iter().zip(&expected) {
                assert!(
                    (found - expected).abs() <= 1e-13 * expected.abs().max(1.0),
                    "{found} {expected}"
                );
            }
        }
    }

    #[test]
    fn infinite_derivative_by_an_input_leaves_the_others_finite() {
        let [found, _] = compute_both(&[0.5, 0.0]);
        assert!(found.a.iter().all(|entry| entry.is_finite()));
        assert!(found.b.iter().any(|entry| !entry.is_finite()));
    }
}
