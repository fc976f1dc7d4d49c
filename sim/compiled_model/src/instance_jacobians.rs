//! Jacobians of an instance.

use std::sync::Arc;

use eomgen_codegen::program::evaluator::MachineCode;
use eomgen_codegen::program::{Op, Program, Variable};
use eomgen_model_spec::ids::FieldId;

use crate::error::Error;
use crate::evaluation::prepare_evaluator;
use crate::instance::Instance;
use crate::jacobians::{Jacobian, JacobianEvaluator, JacobianLayout};

impl Instance<'_> {
    /// Returns an evaluator of Jacobians at these parameters, with machine code.
    ///
    /// # Errors
    /// Terms that cannot be differentiated, or a mass matrix that is not positive definite.
    pub fn jacobian_evaluator(&self) -> Result<JacobianEvaluator, Error> {
        self.interpreter()?;
        let differentiated = self.model().jacobian_program()?;
        Ok(self.jacobians(&differentiated.program, differentiated.machine_code()))
    }

    /// Returns an evaluator of Jacobians without machine code, for a few evaluations. It does not
    /// check that the mass matrix is positive definite, so its accelerations may be invalid.
    pub(crate) fn interpreted_jacobians(&self) -> Result<JacobianEvaluator, Error> {
        let program = &self.model().jacobian_program()?.program;
        Ok(self.jacobians(program, None))
    }

    fn jacobians(
        &self,
        program: &Program,
        code: Option<&Arc<dyn MachineCode>>,
    ) -> JacobianEvaluator {
        JacobianEvaluator::new(prepare_evaluator(program, code, self.parameters()))
    }

    /// Returns, for each state, true if a rate or a switching function depends on it. For example, the angle of an
    /// unrestrained rotor has no influence.
    ///
    /// # Errors
    /// See [`Instance::jacobian_evaluator`].
    pub fn influential_states(&self) -> Result<Vec<bool>, Error> {
        let program = &self.model().jacobian_program()?.program;
        let mut felt = vec![false; program.states()];
        if let Some(layout) = JacobianLayout::find(program, Jacobian::RatesByState.name()) {
            for place in &layout.dense {
                felt[place % layout.columns] = true;
            }
        }
        let guards: Vec<_> = program.guards.iter().map(|guard| guard.value).collect();
        for id in program.reachable(&guards) {
            let (variable, count) = match program.value(id).op {
                Op::Coordinate(index) => (Variable::Coordinate(index), 1),
                Op::Rate(index) => (Variable::Rate(index), 1),
                Op::ModeCoordinates(field) => {
                    (Variable::ModeCoordinates(field), mode_count(program, field))
                }
                Op::ModeRates(field) => (Variable::ModeRates(field), mode_count(program, field)),
                _ => continue,
            };
            let first = program.variable_place(variable);
            felt[first..first + count].fill(true);
        }
        Ok(felt)
    }
}

fn mode_count(program: &Program, field: FieldId) -> usize {
    program.fields[field.index()].order
}
