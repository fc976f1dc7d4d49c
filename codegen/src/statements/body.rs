//! Statements of one stage: named values, and loops over modes. `operands` writes the other values inside the
//! expressions that use them.
//!
//! Expressions keep the operations and operands of the program. Nesting therefore does not change the results.

use std::collections::{HashMap, HashSet};

use super::emit_error::EmitResult;
use super::expression::{Array, Expression};
use super::index::Index;
use super::names::Names;
use super::needed::{Helper, RequiredFunctions};
use super::sides::Switches;
use super::stage::Notes;
use super::statement::{Place, Statement};
use crate::program::{Extent, Op, PARTIAL_SUMS, Program, ValueId};

/// Largest number of operations in one emitted expression.
const MAX_OPERATIONS_PER_EXPRESSION: usize = 8;

/// Source of the coefficients of a stage.
pub enum Access<'a> {
    /// The stage computes the coefficients from `parameters`.
    Prepare,
    /// The stage reads the coefficients from these fields of `coefficients`.
    Coefficients(&'a HashMap<ValueId, String>),
}

/// Writer of the statements of one stage.
pub struct Body<'a> {
    pub program: &'a Program,
    pub(super) access: Access<'a>,
    pub(super) names: Names,
    uses: HashMap<ValueId, usize>,
    in_loops: HashMap<ValueId, bool>,
    pub(super) bound: HashMap<ValueId, String>,
    notes: Notes,
    statements: Vec<Statement>,
    /// Functions that the statements call.
    pub needed: &'a mut RequiredFunctions,
    /// Vectors that the caller reads as arrays.
    arrays: HashSet<ValueId>,
    pub(super) switches: Switches,
}

impl<'a> Body<'a> {
    /// Starts a stage that computes `roots`, with names from `names`. The regime decides the branches of the values
    /// in `switches`. A value that is used several times gets a name.
    ///
    /// # Errors
    /// A name that is not an identifier in the language of the file.
    pub fn new(
        program: &'a Program,
        names: Names,
        access: Access<'a>,
        roots: &[ValueId],
        needed: &'a mut RequiredFunctions,
        switches: Switches,
    ) -> EmitResult<Self> {
        let mut body = Self {
            program,
            access,
            names,
            uses: HashMap::new(),
            in_loops: HashMap::new(),
            bound: HashMap::new(),
            notes: Notes::default(),
            statements: Vec::new(),
            needed,
            arrays: HashSet::new(),
            switches,
        };
        if matches!(body.access, Access::Prepare) {
            body.arrays.extend(roots);
        }
        let steps = body.list_steps(roots);
        body.count_uses(&steps, roots);
        for id in steps {
            body.write_step(id)?;
        }
        Ok(body)
    }

    /// Returns the values of this stage, operands first.
    fn list_steps(&self, roots: &[ValueId]) -> Vec<ValueId> {
        let prepare = matches!(self.access, Access::Prepare);
        self.program
            .reachable(roots)
            .into_iter()
            .filter(|id| self.program.value(*id).parameter_only == prepare)
            .collect()
    }

    fn count_uses(&mut self, steps: &[ValueId], roots: &[ValueId]) {
        for id in steps {
            let value = self.program.value(*id);
            let loops = value.extent != Extent::Scalar || matches!(value.op, Op::Total(_));
            for operand in value.op.operands() {
                *self.uses.entry(operand).or_insert(0) += 1;
                *self.in_loops.entry(operand).or_insert(false) |= loops;
            }
        }
        for root in roots {
            *self.uses.entry(*root).or_insert(0) += 1;
        }
    }

    /// Returns the statements added since the last call.
    pub fn take_statements(&mut self) -> Vec<Statement> {
        std::mem::take(&mut self.statements)
    }

    /// Returns the names of the values that have a statement.
    pub fn take_names(&mut self) -> HashMap<ValueId, String> {
        std::mem::take(&mut self.bound)
    }

    /// Returns unit and terms of the values that have a statement, by name.
    pub fn take_notes(&mut self) -> Notes {
        std::mem::take(&mut self.notes)
    }

    /// Returns a name for the value of a statement.
    pub(super) fn name(&mut self, id: ValueId) -> EmitResult<String> {
        let name = self.names.value_name(self.program, id, "s")?;
        if let Some(note) = self.program.trace.note(id) {
            self.notes.insert(name.clone(), note);
        }
        Ok(name)
    }

    /// Adds a statement.
    pub fn push(&mut self, statement: Statement) {
        self.statements.push(statement);
    }

    /// Adds an assignment.
    pub fn assign(&mut self, place: Place, value: Expression) {
        self.push(Statement::Assign(place, value));
    }

    /// Adds a loop that assigns elements i of a vector.
    pub fn assign_each(&mut self, length: usize, place: Place, element: Expression) {
        self.push(Statement::loop_over_elements(
            length,
            Statement::Assign(place, element),
        ));
    }

    fn push_filled(&mut self, name: &str, length: usize, statement: Statement) {
        self.push(Statement::Zeros(name.to_owned(), vec![length]));
        self.push(Statement::loop_over_elements(length, statement));
    }

    fn bind(&mut self, id: ValueId, expression: Expression) -> EmitResult<()> {
        let name = self.name(id)?;
        self.push(Statement::Let(name.clone(), expression));
        self.bound.insert(id, name);
        Ok(())
    }

    fn write_step(&mut self, id: ValueId) -> EmitResult<()> {
        let value = self.program.value(id);
        let uses = self.uses.get(&id).copied().unwrap_or(0);
        match (&value.op, value.extent) {
            (
                Op::Constant(_)
                | Op::Table(_)
                | Op::ModeCoordinates(_)
                | Op::ModeRates(_)
                | Op::Time,
                _,
            ) => Ok(()),
            (Op::Argument(..), Extent::Vector(_)) => Ok(()),
            (
                Op::Coordinate(_)
                | Op::Rate(_)
                | Op::State(_)
                | Op::Input(_)
                | Op::Parameter(_)
                | Op::Argument(..),
                _,
            ) => {
                let expression = self.leaf(id)?;
                let name = self.leaf_name(id);
                let name = self.names.assign(self.program, id, &name, "s")?;
                self.push(Statement::Let(name.clone(), expression));
                self.bound.insert(id, name);
                Ok(())
            }
            (_, Extent::Scalar) => self.write_scalar(id, uses),
            (_, Extent::Vector(length)) => self.write_vector(id, uses, length),
            (_, Extent::Matrix(rows, columns)) => self.matrix_step(id, rows, columns),
        }
    }

    fn leaf_name(&self, id: ValueId) -> String {
        let program = self.program;
        match program.value(id).op {
            Op::Coordinate(index) => program.coordinates[index].name.clone(),
            Op::Rate(index) => format!("{}_dot", program.coordinates[index].name),
            Op::State(index) => program.first_order[index].name.clone(),
            Op::Input(index) => program.inputs[index].name.clone(),
            Op::Parameter(place) => program.parameters[place].quantity.name.clone(),
            _ => String::from("s"),
        }
    }

    fn write_scalar(&mut self, id: ValueId, uses: usize) -> EmitResult<()> {
        let value = self.program.value(id);
        if let Op::Total(vector) = value.op {
            return self.write_total(id, vector);
        }
        let expression = self.own_expression(id, None)?;
        let looped = self.in_loops.get(&id).copied().unwrap_or(false);
        if uses > 1
            || value.name.is_some()
            || looped
            || expression.size() > MAX_OPERATIONS_PER_EXPRESSION
        {
            self.bind(id, expression)
        } else {
            Ok(())
        }
    }

    fn write_total(&mut self, id: ValueId, vector: ValueId) -> EmitResult<()> {
        let name = self.name(id)?;
        let length = self.program.value(vector).extent.length();
        let element = self.element(vector)?;
        if length > PARTIAL_SUMS {
            self.needed.add(Helper::Sum);
        } else {
            self.needed.add(Helper::SumOfFew);
        }
        self.push(Statement::Sum {
            name: name.clone(),
            length,
            element,
        });
        self.bound.insert(id, name);
        Ok(())
    }

    fn write_vector(&mut self, id: ValueId, uses: usize, length: usize) -> EmitResult<()> {
        let elementwise = is_elementwise(&self.program.value(id).op);
        let as_array = self.arrays.contains(&id) || self.is_operand_of_matrix(id);
        if elementwise && uses <= 1 && !as_array {
            let expression = self.own_expression(id, Some("i"))?;
            if expression.size() <= MAX_OPERATIONS_PER_EXPRESSION {
                return Ok(());
            }
        }
        if let Op::CholeskySolve(factor, vector) = self.program.value(id).op {
            self.needed.add(Helper::Cholesky);
            let name = self.name(id)?;
            let factor = self.numbers(factor)?;
            let right = self.vector_array(vector, length)?;
            self.push(Statement::CholeskySolve {
                name: name.clone(),
                factor,
                right,
                rows: length,
                columns: None,
            });
            self.bound.insert(id, name);
            return Ok(());
        }
        if elementwise {
            let element = self.element(id)?;
            let name = self.name(id)?;
            let place = Place::new(&*name, [Index::Variable("i")]);
            self.push_filled(&name, length, Statement::Assign(place, element));
            self.bound.insert(id, name);
            return Ok(());
        }
        let (statement, name) = self.summed_element(id)?;
        self.push_filled(&name, length, statement);
        self.bound.insert(id, name);
        Ok(())
    }

    /// Returns true if a matrix operation reads the vector `id`, which then must be an array.
    fn is_operand_of_matrix(&self, id: ValueId) -> bool {
        self.program.values.iter().any(|value| {
            !is_elementwise(&value.op)
                && !matches!(value.op, Op::Total(_))
                && value.op.operands().contains(&id)
        })
    }

    /// Returns a vector as an array, copied if necessary; a scalar fills every element.
    fn vector_array(&mut self, id: ValueId, length: usize) -> EmitResult<Array> {
        if self.program.value(id).extent == Extent::Scalar {
            return Ok(Array::Filled(Box::new(self.scalar(id)?), length));
        }
        if let Ok(array) = self.numbers(id) {
            return Ok(array);
        }
        let element = self.element(id)?;
        let name = self.name(id)?;
        let place = Place::new(&*name, [Index::Variable("i")]);
        self.push_filled(&name, length, Statement::Assign(place, element));
        Ok(Array::Local(name))
    }
}

/// Returns true if each element depends only on the operands' elements with the same index.
fn is_elementwise(op: &Op) -> bool {
    !matches!(
        op,
        Op::Total(_)
            | Op::Apply { .. }
            | Op::Gram { .. }
            | Op::GramDiagonal { .. }
            | Op::Assemble { .. }
            | Op::Cholesky(_)
            | Op::CholeskySolve(..)
    )
}
