//! Directional and adjoint derivatives of states, rates and observables with respect to states, inputs and
//! parameters, in the current modes of the surfaces. They are computed by the model's Jacobians, or by central
//! differences while surfaces hold the motion.

use std::collections::BTreeMap;

use eomgen_codegen::program::evaluator::Point;
use eomgen_compiled_model::{Jacobian, JacobianEvaluator};
use eomgen_sim::inputs::HeldInputs;

use crate::layout::Variable;
use crate::rejection::{Outcome, invalid, unavailable};
use crate::unit::{External, Unit};

/// Step of a central difference, relative to the size of the variable: the cube root of the unit roundoff.
const DIFFERENCE_FRACTION: f64 = 6e-6;

/// Values of the rates, then of the observables.
type Values = Vec<f64>;

impl Unit {
    /// Returns the directional derivatives of the unknowns along the `seed` of the knowns. If `backward` is
    /// true, returns the adjoint derivatives of the knowns for the `seed` of the unknowns.
    pub fn differentiate(
        &mut self,
        backward: bool,
        (unknowns, knowns): (&[u32], &[u32]),
        seed: &[f64],
    ) -> Outcome<Vec<f64>> {
        let unknowns = self.find_variables(unknowns, |variable| {
            matches!(
                variable,
                Variable::State(_)
                    | Variable::Rate(_)
                    | Variable::Observable(_)
                    | Variable::ControllerState(_)
            )
        })?;
        let knowns = self.find_variables(knowns, |variable| {
            matches!(
                variable,
                Variable::State(_) | Variable::Input(_) | Variable::Parameter(_)
            )
        })?;
        let wanted = if backward {
            knowns.len()
        } else {
            unknowns.len()
        };
        let mut sensitivity = vec![0.0; wanted];
        let columns = self.compute_columns(&knowns)?;
        for (place, (known, column)) in knowns.iter().zip(&columns).enumerate() {
            for (row, unknown) in unknowns.iter().enumerate() {
                // States of controllers are constant between events.
                let entry = match unknown {
                    Variable::Rate(rate) => column[*rate],
                    Variable::Observable(observable) => column[self.layout.states + observable],
                    unknown => f64::from(u8::from(unknown == known)),
                };
                match backward {
                    true => sensitivity[place] += entry * seed[row],
                    false => sensitivity[row] += entry * seed[place],
                }
            }
        }
        match sensitivity.iter().all(|entry| entry.is_finite()) {
            true => Ok(sensitivity),
            false => Err(unavailable("a derivative is not finite")),
        }
    }

    fn find_variables(
        &self,
        references: &[u32],
        fits: impl Fn(&Variable) -> bool,
    ) -> Outcome<Vec<Variable>> {
        let found: Outcome<Vec<Variable>> = references
            .iter()
            .map(|reference| self.find(*reference))
            .collect();
        let found = found?;
        match found.iter().all(fits) {
            true => Ok(found),
            false => Err(invalid(
                "derivatives are available for rates, states and outputs, with respect to states, inputs and parameters",
            )),
        }
    }

    /// Returns the derivatives of rates and observables with respect to each of these variables.
    fn compute_columns(&mut self, knowns: &[Variable]) -> Outcome<Vec<Values>> {
        let (t, state) = (self.now.t, self.now.state.clone());
        let motion = self.external()?;
        if motion.is_beyond_surface(t, &state) {
            return Err(unavailable(
                "derivatives are not available after the motion crosses a switching surface and before its event is \
                 handled",
            ));
        }
        match motion.system().is_free() {
            true => self.columns_of_jacobians(knowns),
            false => knowns
                .iter()
                .map(|known| self.column_by_differences(*known))
                .collect(),
        }
    }

    fn columns_of_jacobians(&mut self, knowns: &[Variable]) -> Outcome<Vec<Values>> {
        if self.jacobians.is_none() {
            self.jacobians = Some(self.instance()?.jacobian_evaluator()?);
        }
        let Some(jacobians) = &mut self.jacobians else {
            return Ok(Vec::new());
        };
        let point = Point {
            t: self.now.t,
            state: &self.now.state,
            inputs: &self.now.inputs,
        };
        let mut matrices = BTreeMap::new();
        let mut columns = Vec::with_capacity(knowns.len());
        for known in knowns {
            let (place, kinds) = match known {
                Variable::Input(place) => (
                    *place,
                    [Jacobian::RatesByInputs, Jacobian::ObservablesByInputs],
                ),
                Variable::Parameter(place) => (
                    *place,
                    [
                        Jacobian::RatesByParameters,
                        Jacobian::ObservablesByParameters,
                    ],
                ),
                Variable::State(place) => (
                    *place,
                    [Jacobian::RatesByState, Jacobian::ObservablesByState],
                ),
                _ => continue,
            };
            let mut column = Vec::new();
            for kind in kinds {
                let (rows, width) = jacobians.shape(kind);
                let matrix = matrices
                    .entry(kind.name())
                    .or_insert_with(|| evaluate(jacobians, kind, point));
                column.extend((0..rows).map(|row| matrix[row * width + place]));
            }
            columns.push(column);
        }
        Ok(columns)
    }

    fn column_by_differences(&mut self, known: Variable) -> Outcome<Values> {
        let (value, size) = match known {
            Variable::State(place) => (self.now.state[place], self.compiled.typical_sizes()[place]),
            Variable::Input(place) => (self.now.inputs[place], 1.0),
            Variable::Parameter(place) => (self.now.parameters[place], 0.0),
            _ => return Ok(Vec::new()),
        };
        let step = match value.abs().max(size) {
            size if size > 0.0 => DIFFERENCE_FRACTION * size,
            _ => DIFFERENCE_FRACTION,
        };
        let [above, below] = [value + step, value - step];
        let (up, down) = (
            self.evaluate_with(known, above)?,
            self.evaluate_with(known, below)?,
        );
        let entries = up.iter().zip(&down);
        Ok(entries
            .map(|(up, down)| (up - down) / (above - below))
            .collect())
    }

    /// Returns rates and observables with another value of a variable, in the current modes.
    fn evaluate_with(&mut self, known: Variable, value: f64) -> Outcome<Values> {
        let (t, mut state) = (self.now.t, self.now.state.clone());
        let layout = self.layout;
        match known {
            Variable::Parameter(place) => {
                let modes = self.surface_modes();
                let mut parameters = self.now.parameters.clone();
                parameters[place] = value;
                let mut motion = self.start_external(&parameters, &modes)?;
                if motion.modes() != modes {
                    return Err(unavailable(
                        "the derivative with respect to a parameter does not exist, because any change of this \
                         parameter ends sticking",
                    ));
                }
                Ok(evaluate_motion(&mut motion, layout.observables, t, &state))
            }
            Variable::Input(place) => {
                let given = self.now.inputs.clone();
                let mut inputs = given.clone();
                inputs[place] = value;
                let motion = self.external()?;
                motion.system_mut().set_inputs(HeldInputs::constant(inputs));
                let values = evaluate_motion(motion, layout.observables, t, &state);
                motion.system_mut().set_inputs(HeldInputs::constant(given));
                Ok(values)
            }
            Variable::State(place) => {
                state[place] = value;
                Ok(evaluate_motion(
                    self.external()?,
                    layout.observables,
                    t,
                    &state,
                ))
            }
            _ => Ok(Vec::new()),
        }
    }
}

fn evaluate(jacobians: &mut JacobianEvaluator, kind: Jacobian, point: Point<'_>) -> Vec<f64> {
    let (rows, columns) = jacobians.shape(kind);
    let mut matrix = vec![0.0; rows * columns];
    jacobians.evaluate(kind, point, &mut matrix);
    matrix
}

fn evaluate_motion(motion: &mut External, observables: usize, t: f64, state: &[f64]) -> Values {
    let mut values = vec![0.0; state.len() + observables];
    let (rates, observables) = values.split_at_mut(state.len());
    motion.rates(t, state, rates);
    motion.with_fixed_sides(|system| system.write_observables((t, state), observables));
    values
}
