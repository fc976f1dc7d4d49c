//! Functions of sampled controllers: start and update.

use std::collections::HashSet;

use super::emit_error::{EmitError, EmitResult};
use super::expression::{ArgumentStruct, Expression};
use super::file::File;
use super::needed::RequiredFunctions;
use super::statement::Statement;
use crate::program::evaluator::elementary;
use crate::program::{ControlOp, ProgramController, Quantity};

/// Largest number of operations in one emitted expression.
const MAX_OPERATIONS_PER_EXPRESSION: usize = 8;

/// Time fields in a controller's memory, with their meaning.
pub const TIME_FIELDS: [(&str, &str); 3] = [
    ("period", "time between two samples"),
    ("offset", "time of the first sample"),
    (
        "delay",
        "time between a sample and the action of its outputs",
    ),
];

/// Statements of a function, and the values that it writes to fields.
pub struct ControllerStage {
    /// Statements.
    pub computed: Vec<Statement>,
    /// Fields of the memory with their values.
    pub memory: Vec<(String, Expression)>,
    /// Outputs with their values.
    pub outputs: Vec<(String, Expression)>,
}

/// Functions of a controller.
pub struct ControllerStages {
    /// Sets times and initial states from the parameters.
    pub start: ControllerStage,
    /// Computes outputs and states of a sample.
    pub update: ControllerStage,
}

/// Builds the functions of a controller.
///
/// # Errors
/// A name is not an identifier of the language, or a state has the name of a time field.
pub fn build_controller_stages(
    file: &File<'_>,
    controller: &ProgramController,
    needed: &mut RequiredFunctions,
) -> EmitResult<ControllerStages> {
    let names = |quantities: &[Quantity]| -> EmitResult<Vec<String>> {
        let names = quantities.iter();
        names
            .map(|quantity| Ok(file.words.identifier(&quantity.name)?.to_owned()))
            .collect()
    };
    file.words.identifier(&controller.name)?;
    let (states, outputs) = (names(&controller.states)?, names(&controller.outputs)?);
    let measured = names(&controller.measured)?;
    if let Some((taken, _)) = TIME_FIELDS
        .iter()
        .find(|(name, _)| states.iter().any(|s| s == name))
    {
        return Err(EmitError::Value(format!(
            "the controller `{}` has a state `{taken}`, which is the name of one of its times: rename the state",
            controller.name
        )));
    }
    let start = TIME_FIELDS.iter().map(|(name, _)| (*name).to_owned());
    let start = start.zip(controller.times);
    let start = start.chain(
        states
            .iter()
            .cloned()
            .zip(controller.initial.iter().copied()),
    );
    let mut writer = ControlWriter {
        file,
        controller,
        measured: &measured,
        states: &states,
        needed,
    };
    let update = states.iter().cloned().zip(controller.next.iter().copied());
    let written = outputs
        .into_iter()
        .zip(controller.output_values.iter().copied());
    Ok(ControllerStages {
        start: writer.stage(start.collect(), Vec::new())?,
        update: writer.stage(update.collect(), written.collect())?,
    })
}

struct ControlWriter<'c> {
    file: &'c File<'c>,
    controller: &'c ProgramController,
    measured: &'c [String],
    states: &'c [String],
    needed: &'c mut RequiredFunctions,
}

impl ControlWriter<'_> {
    fn stage(
        &mut self,
        memory: Vec<(String, usize)>,
        outputs: Vec<(String, usize)>,
    ) -> EmitResult<ControllerStage> {
        let roots = memory.iter().chain(&outputs).map(|(_, place)| *place);
        let uses = self.count_uses(roots);
        let mut computed = Vec::new();
        let mut expressions: Vec<Expression> = Vec::new();
        for (place, op) in self.controller.values.iter().enumerate() {
            let expression = match uses[place] {
                0 => Expression::Number(f64::NAN),
                _ => self.operation(op, &expressions)?,
            };
            let is_leaf = op.operands().is_empty();
            if uses[place] > 1 && !is_leaf || expression.size() > MAX_OPERATIONS_PER_EXPRESSION {
                let name = format!("v{place}");
                computed.push(Statement::Let(name.clone(), expression));
                expressions.push(Expression::name(name));
            } else {
                expressions.push(expression);
            }
        }
        // All values are computed before the first state changes.
        let mut bound = HashSet::new();
        let mut bind = |(field, place): (String, usize)| {
            let name = format!("next_{place}");
            if bound.insert(place) {
                computed.push(Statement::Let(name.clone(), expressions[place].clone()));
            }
            (field, Expression::name(name))
        };
        let memory = memory.into_iter().map(&mut bind).collect();
        let outputs = outputs.into_iter().map(&mut bind).collect();
        Ok(ControllerStage {
            computed,
            memory,
            outputs,
        })
    }

    /// Counts how often each value is used by the roots and by the values on which the roots depend.
    fn count_uses(&self, roots: impl Iterator<Item = usize>) -> Vec<usize> {
        let mut uses = vec![0; self.controller.values.len()];
        roots.for_each(|root| uses[root] += 1);
        for (place, op) in self.controller.values.iter().enumerate().rev() {
            if uses[place] > 0 {
                op.operands()
                    .into_iter()
                    .for_each(|operand| uses[operand] += 1);
            }
        }
        uses
    }

    fn operation(&mut self, op: &ControlOp, known: &[Expression]) -> EmitResult<Expression> {
        let at = |place: &usize| &known[*place];
        let field = |of: ArgumentStruct, name: &str| Expression::Field(of, name.to_owned());
        Ok(match op {
            ControlOp::Constant(value) => Expression::Number(*value),
            ControlOp::Parameter(place) => {
                let name = &self.file.program.parameters[*place].quantity.name;
                field(
                    ArgumentStruct::Parameters,
                    self.file.words.identifier(name)?,
                )
            }
            ControlOp::Period => field(ArgumentStruct::Memory, TIME_FIELDS[0].0),
            ControlOp::Measured(place) => field(ArgumentStruct::Measured, &self.measured[*place]),
            ControlOp::State(place) => field(ArgumentStruct::Memory, &self.states[*place]),
            ControlOp::Negate(a) => Expression::negate(at(a)),
            ControlOp::Add(a, b) => Expression::add(at(a), at(b)),
            ControlOp::Subtract(a, b) => Expression::subtract(at(a), at(b)),
            ControlOp::Multiply(a, b) => Expression::multiply(at(a), at(b)),
            ControlOp::Divide(a, b) => Expression::divide(at(a), at(b)),
            ControlOp::Call(function, arguments) => {
                let arguments = arguments.iter().map(|a| at(a).clone()).collect();
                Expression::Call(self.needed.name(elementary(*function)), arguments)
            }
            ControlOp::Elementary(function, both) => {
                let arguments = both.iter().map(|a| at(a).clone()).collect();
                Expression::Call(self.needed.name(*function), arguments)
            }
            ControlOp::Select(parts) => {
                Expression::Select(Box::new(parts.map(|part| known[part].clone())))
            }
        })
    }
}
