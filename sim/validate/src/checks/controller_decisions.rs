//! Controller samples close to a threshold of an operation. A quantised or clamped result hides an error of its
//! argument, except close to a threshold at which the result changes.

use eomgen_codegen::program::{ControlOp, ControlValues, ProgramController};
use eomgen_elementary::Function as Elementary;
use eomgen_model_spec::function::Function;

/// Maximum number of bisections between two samples, more than double precision can resolve.
const HALVINGS: usize = 64;

/// Evaluator for the threshold operations (quantisation, selection) of a controller; parameters are in SI.
pub struct Decisions<'c> {
    controller: &'c ProgramController,
    parameters: &'c [f64],
    period: f64,
    results: Vec<f64>,
}

impl<'c> Decisions<'c> {
    pub fn new(controller: &'c ProgramController, parameters: &'c [f64]) -> Self {
        let ([period, ..], _) = controller.start(parameters);
        Self {
            controller,
            parameters,
            period,
            results: Vec::new(),
        }
    }

    /// Returns the threshold operation to test in the call with this index, in cyclic order; `None` if there is none.
    pub fn choose(controller: &ProgramController, call: usize) -> Option<usize> {
        let values = controller.values.iter().enumerate();
        let deciding = values.filter(|(_, op)| is_deciding(op));
        let places: Vec<usize> = deciding.map(|(place, _)| place).collect();
        places.get(call % places.len().max(1)).copied()
    }

    /// Bisects between two rows and returns two neighbouring rows with different decisions of an operation; `None` if
    /// both rows have the same decision.
    pub fn bracket(&mut self, op: usize, [first, last]: [&[f64]; 2]) -> Option<[Vec<f64>; 2]> {
        let decision = self.decide(op, first);
        if decision.to_bits() == self.decide(op, last).to_bits() {
            return None;
        }
        let (mut near, mut far) = (first.to_vec(), last.to_vec());
        for _ in 0..HALVINGS {
            let between = near.iter().zip(&far);
            let middle: Vec<f64> = between.map(|(a, b)| 0.5 * a + 0.5 * b).collect();
            match self.decide(op, &middle).to_bits() == decision.to_bits() {
                true => near = middle,
                false => far = middle,
            }
        }
        Some([near, far])
    }

    /// Returns the decision at a row: the result of a step function, or 1 if the first operand of a selection is
    /// larger.
    fn decide(&mut self, op: usize, row: &[f64]) -> f64 {
        let (measured, states) = row.split_at(self.controller.measured.len());
        let given = ControlValues {
            parameters: self.parameters,
            period: self.period,
            measured,
            states,
        };
        self.controller.evaluate(given, &mut self.results);
        let is_larger = |a: usize, b: usize| f64::from(self.results[a] > self.results[b]);
        match &self.controller.values[op] {
            ControlOp::Select([a, b, ..]) => is_larger(*a, *b),
            ControlOp::Call(Function::Min | Function::Max, arguments) => {
                is_larger(arguments[0], arguments[1])
            }
            _ => self.results[op],
        }
    }
}

fn is_deciding(op: &ControlOp) -> bool {
    matches!(
        op,
        ControlOp::Select(_)
            | ControlOp::Elementary(Elementary::Quantise, _)
            | ControlOp::Call(
                Function::Min
                    | Function::Max
                    | Function::Sign
                    | Function::Above
                    | Function::Contact,
                _
            )
    )
}
