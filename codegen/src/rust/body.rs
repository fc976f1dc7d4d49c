//! The statements of one stage: which values get a name, which stand inside the
//! expressions that use them, and which become loops over modes.
//!
//! Expressions keep the operations and operands of the program as they are, so nesting
//! them changes no bit.

use std::collections::{HashMap, HashSet};

use super::emit_error::{EmitError, Emitted};
use super::expression::{Expression, assignment, infix};
use super::functions::Needed;
use super::literals::{block, identifier};
use super::names::Names;
use super::sides::{Switches, of_side};
use crate::program::evaluator::{Law, law};
use crate::program::{Argument, Extent, Op, Output, PARTIAL_SUMS, Program, ValueId, Variable};
use elementary::Function as Elementary;
use model_spec::model::Function;

/// The most operations in one emitted expression.
const EXPRESSION_SIZE: usize = 8;

/// Where a stage finds what was prepared.
pub enum Access<'a> {
    /// It prepares the coefficients itself, from `parameters`.
    Prepare,
    /// In these fields of `coefficients`.
    Coefficients(&'a HashMap<ValueId, String>),
}

/// Writes one stage.
pub struct Body<'a> {
    pub(super) program: &'a Program,
    access: Access<'a>,
    pub(super) names: Names,
    uses: HashMap<ValueId, usize>,
    in_loops: HashMap<ValueId, bool>,
    pub(super) bound: HashMap<ValueId, String>,
    pub(super) statements: String,
    pub(super) needed: &'a mut Needed,
    /// Vectors that the caller reads as arrays.
    arrays: HashSet<ValueId>,
    /// What is decided by the regime that the stage is for.
    switches: Switches,
}

impl<'a> Body<'a> {
    /// A stage that computes `roots`; its values are bound where several need them.
    pub fn new(
        program: &'a Program,
        access: Access<'a>,
        roots: &[ValueId],
        needed: &'a mut Needed,
    ) -> Emitted<Self> {
        Self::in_regime(program, access, roots, needed, Switches::new())
    }

    /// The same for a stage in which a regime decides about these values.
    pub fn in_regime(
        program: &'a Program,
        access: Access<'a>,
        roots: &[ValueId],
        needed: &'a mut Needed,
        switches: Switches,
    ) -> Emitted<Self> {
        let mut body = Self {
            program,
            access,
            names: Names::new(program),
            uses: HashMap::new(),
            in_loops: HashMap::new(),
            bound: HashMap::new(),
            statements: String::new(),
            needed,
            arrays: HashSet::new(),
            switches,
        };
        if matches!(body.access, Access::Prepare) {
            body.arrays.extend(roots);
        }
        let steps = body.steps(roots);
        body.count_uses(&steps, roots);
        for id in steps {
            body.step(id)?;
        }
        Ok(body)
    }

    /// The values this stage computes, operands first.
    fn steps(&self, roots: &[ValueId]) -> Vec<ValueId> {
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

    /// The statements so far, a line each.
    pub fn statements(self) -> String {
        self.statements
    }

    /// Adds a statement of the caller's.
    pub fn push(&mut self, statement: &str) {
        self.statements.push_str(statement);
        self.statements.push('\n');
    }

    /// Adds a loop over `index` with one statement in it.
    pub fn push_loop(&mut self, index: &str, length: usize, statement: &str) {
        self.statements
            .push_str(&looped(index, length, &format!("{statement}\n")));
    }

    /// Adds a vector filled element by element.
    fn push_filled(&mut self, name: &str, length: usize, statement: &str) {
        self.push(&format!("let mut {name} = [T::number(0.0); {length}];"));
        self.push_loop("i", length, statement);
    }

    /// Prefers a name for a value of this stage.
    fn bind(&mut self, id: ValueId, expression: &Expression) -> Emitted<()> {
        let name = self.names.of(self.program, id, "s")?;
        self.push(&assignment(&format!("let {name}"), expression));
        self.bound.insert(id, name);
        Ok(())
    }

    fn step(&mut self, id: ValueId) -> Emitted<()> {
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
                | Op::Input(_)
                | Op::Parameter(_)
                | Op::Argument(..),
                _,
            ) => {
                let expression = self.leaf(id)?;
                let name = self.leaf_name(id);
                let name = self.names.assign(id, &name, "s")?;
                self.push(&assignment(&format!("let {name}"), expression));
                self.bound.insert(id, name);
                Ok(())
            }
            (_, Extent::Scalar) => self.scalar_step(id, uses),
            (_, Extent::Vector(length)) => self.vector_step(id, uses, length),
            (_, Extent::Matrix(rows, columns)) => self.matrix_step(id, rows, columns),
        }
    }

    fn leaf_name(&self, id: ValueId) -> String {
        let program = self.program;
        match program.value(id).op {
            Op::Coordinate(index) => program.coordinates[index].name.clone(),
            Op::Rate(index) => format!("{}_dot", program.coordinates[index].name),
            Op::Input(index) => program.inputs[index].name.clone(),
            Op::Parameter(place) => program.parameters[place].quantity.name.clone(),
            _ => String::from("s"),
        }
    }

    fn scalar_step(&mut self, id: ValueId, uses: usize) -> Emitted<()> {
        let value = self.program.value(id);
        if let Op::Total(vector) = value.op {
            return self.total(id, vector);
        }
        let expression = self.own_expression(id, None)?;
        let looped = self.in_loops.get(&id).copied().unwrap_or(false);
        if uses > 1 || value.name.is_some() || looped || expression.size > EXPRESSION_SIZE {
            self.bind(id, &expression)
        } else {
            Ok(())
        }
    }

    fn total(&mut self, id: ValueId, vector: ValueId) -> Emitted<()> {
        let name = self.names.of(self.program, id, "s")?;
        let length = self.program.value(vector).extent.length();
        let element = self.element(vector)?;
        let function = if length > PARTIAL_SUMS {
            self.needed.sum = true;
            "sum"
        } else {
            self.needed.sum_of_few = true;
            "sum_of_few"
        };
        let sum = Expression::sum(function, length, &element);
        self.push(&assignment(&format!("let {name}"), sum));
        self.bound.insert(id, name);
        Ok(())
    }

    fn vector_step(&mut self, id: ValueId, uses: usize, length: usize) -> Emitted<()> {
        let elementwise = is_elementwise(&self.program.value(id).op);
        let as_array = self.arrays.contains(&id) || self.is_operand_of_matrix(id);
        if elementwise && uses <= 1 && !as_array {
            let expression = self.own_expression(id, Some("i"))?;
            if expression.size <= EXPRESSION_SIZE {
                return Ok(());
            }
        }
        if let Op::CholeskySolve(factor, vector) = self.program.value(id).op {
            self.needed.cholesky = true;
            let name = self.names.of(self.program, id, "s")?;
            let factor = reference(self.numbers(factor)?);
            let vector = reference(self.vector_array(vector, length)?);
            let solution = Expression::call("cholesky_solve", &[factor, vector]);
            self.push(&assignment(&format!("let {name}"), solution));
            self.bound.insert(id, name);
            return Ok(());
        }
        if elementwise {
            let element = self.element(id)?;
            let name = self.names.of(self.program, id, "s")?;
            self.push_filled(&name, length, &assignment(&format!("{name}[i]"), element));
            self.bound.insert(id, name);
            return Ok(());
        }
        let (statement, name) = self.summed_element(id)?;
        self.push_filled(&name, length, statement.trim_end());
        self.bound.insert(id, name);
        Ok(())
    }

    /// Matrix operations read their vectors as arrays.
    fn is_operand_of_matrix(&self, id: ValueId) -> bool {
        self.program.values.iter().any(|value| {
            !is_elementwise(&value.op)
                && !matches!(value.op, Op::Total(_))
                && value.op.operands().contains(&id)
        })
    }

    /// A scalar.
    pub fn scalar(&mut self, id: ValueId) -> Emitted<Expression> {
        self.expression(id, None)
    }

    /// Element i of a vector, or a scalar.
    pub fn element(&mut self, id: ValueId) -> Emitted<Expression> {
        self.element_at(id, "i")
    }

    /// Element `index` of a vector, or a scalar.
    pub(super) fn element_at(&mut self, id: ValueId, index: &str) -> Emitted<Expression> {
        let scalar = self.program.value(id).extent == Extent::Scalar;
        self.expression(id, (!scalar).then_some(index))
    }

    /// A scalar, or the element of a vector: by its name if it has one by now.
    fn expression(&mut self, id: ValueId, index: Option<&str>) -> Emitted<Expression> {
        match (self.bound.get(&id), index) {
            (Some(name), Some(index)) => Ok(Expression::element(name, index)),
            (Some(name), None) => Ok(Expression::atom(name)),
            (None, _) => self.own_expression(id, index),
        }
    }

    /// The expression that computes a value.
    fn own_expression(&mut self, id: ValueId, index: Option<&str>) -> Emitted<Expression> {
        if let Some(leaf) = self.leaf_or_coefficient(id, index)? {
            return Ok(leaf);
        }
        let op = self.program.value(id).op.clone();
        let operands = op
            .operands()
            .into_iter()
            .map(|operand| {
                let scalar = self.program.value(operand).extent == Extent::Scalar;
                self.expression(operand, if scalar { None } else { index })
            })
            .collect::<Emitted<Vec<_>>>()?;
        match of_side(self.program, &self.switches, id, &operands, self.needed) {
            Some(decided) => Ok(decided),
            None => self.operation(id, &op, &operands),
        }
    }

    /// An operation of scalars or elements.
    fn operation(&mut self, id: ValueId, op: &Op, operands: &[Expression]) -> Emitted<Expression> {
        Ok(match (op, operands) {
            (Op::Negate(_), [a]) => Expression::negate(a),
            (Op::Add(..), [a, b]) => Expression::add(a, b),
            (Op::Subtract(..), [a, b]) => Expression::subtract(a, b),
            (Op::Multiply(..), [a, b]) => Expression::multiply(a, b),
            (Op::Divide(..), [a, b]) => Expression::divide(a, b),
            (Op::Power(..), _) => {
                self.needed.elementary.insert(Elementary::Pow);
                Expression::call("pow", operands)
            }
            (Op::PivotReciprocal(_), _) => {
                self.needed.pivot_reciprocal = true;
                Expression::call("pivot_reciprocal", operands)
            }
            (Op::Select { .. }, _) => Expression::call("T::select_greater", operands),
            (Op::Call(function, _), _) => self.call(*function, operands),
            _ => return Err(EmitError::misplaced(id, "is no operation of elements")),
        })
    }

    fn call(&mut self, function: Function, arguments: &[Expression]) -> Expression {
        let name = match law(function) {
            Law::Elementary(elementary) => {
                self.needed.elementary.insert(elementary);
                elementary.name()
            }
            Law::Deadzone => {
                self.needed.deadzone = true;
                "deadzone"
            }
            Law::Contact => {
                self.needed.contact = true;
                "contact"
            }
            Law::Above => {
                self.needed.above = true;
                "above"
            }
        };
        Expression::call(name, arguments)
    }

    /// Constants, tables, state, and what was prepared before this stage.
    fn leaf_or_coefficient(&self, id: ValueId, index: Option<&str>) -> Emitted<Option<Expression>> {
        let value = self.program.value(id);
        let program = self.program;
        let place = |offset: usize| {
            let place = index.map_or_else(String::new, |index| infix("+", offset, index));
            Expression::element("state", &place)
        };
        Ok(Some(match value.op {
            Op::Constant(value) => Expression::number(value),
            Op::Time => Expression::atom("t"),
            Op::Table(table) => {
                let name = identifier(&program.tables[table].name)?;
                Expression::converted(format!("{name}[{}]", index.unwrap_or_default()))
            }
            Op::ModeCoordinates(field) => place(program.mode_offset(field)),
            Op::ModeRates(field) => {
                place(program.degrees_of_freedom() + program.mode_offset(field))
            }
            Op::Argument(argument, variable) if value.extent != Extent::Scalar => {
                let place = infix(
                    "+",
                    program.variable_place(variable),
                    index.unwrap_or_default(),
                );
                Expression::element(argument_name(argument), &place)
            }
            _ => match &self.access {
                Access::Coefficients(fields) if value.parameter_only => {
                    let Some(name) = fields.get(&id) else {
                        return Err(EmitError::Value(format!(
                            "value {} was not prepared",
                            id.index()
                        )));
                    };
                    self.coefficient(name, index)
                }
                _ => return Ok(None),
            },
        }))
    }

    /// A coefficient, or the entry of one; lanes share it.
    fn coefficient(&self, name: &str, index: Option<&str>) -> Expression {
        let field = Expression::field("coefficients", name);
        let number = match index {
            Some(index) => Expression::element(&field.to_string(), index),
            None => field,
        };
        if self.for_lanes() {
            Expression::call("C::read", &[number])
        } else {
            number
        }
    }

    fn for_lanes(&self) -> bool {
        self.program.outputs.kinds.contains(&Output::Lanes)
    }

    fn leaf(&self, id: ValueId) -> Emitted<Expression> {
        let program = self.program;
        Ok(match program.value(id).op {
            Op::Coordinate(index) => Expression::atom(format!("state[{index}]")),
            Op::Rate(index) => {
                Expression::atom(format!("state[{}]", program.degrees_of_freedom() + index))
            }
            Op::Input(index) => {
                Expression::field("inputs", identifier(&program.inputs[index].name)?)
            }
            Op::Parameter(place) => {
                let name = identifier(&program.parameters[place].quantity.name)?;
                Expression::field("parameters", name)
            }
            Op::Argument(_, Variable::Input(index)) => {
                Expression::field("input_direction", identifier(&program.inputs[index].name)?)
            }
            Op::Argument(argument, variable) => {
                let place = program.variable_place(variable);
                Expression::atom(format!("{}[{place}]", argument_name(argument)))
            }
            _ => return Err(EmitError::misplaced(id, "is nothing that is given")),
        })
    }

    /// An entry of a matrix or of a vector, `index` being all that stands in the brackets.
    pub(super) fn entry(&mut self, id: ValueId, index: &str) -> Emitted<Expression> {
        if let Op::Table(place) = self.program.value(id).op {
            let name = identifier(&self.program.tables[place].name)?;
            return Ok(Expression::converted(format!("{name}[{index}]")));
        }
        if let Some(name) = self.coefficient_name(id) {
            return Ok(self.coefficient(name, Some(index)));
        }
        Ok(Expression::element(&self.numbers(id)?, index))
    }

    /// The name of a value among the coefficients that this stage reads.
    fn coefficient_name(&self, id: ValueId) -> Option<&'a str> {
        match self.access {
            Access::Coefficients(fields) => fields.get(&id).map(String::as_str),
            Access::Prepare => None,
        }
    }

    /// A vector or matrix as a whole.
    pub fn numbers(&mut self, id: ValueId) -> Emitted<String> {
        if let Some(name) = self.bound.get(&id) {
            return Ok(name.clone());
        }
        if let Op::Table(place) = self.program.value(id).op {
            let name = identifier(&self.program.tables[place].name)?;
            let vector = matches!(self.program.value(id).extent, Extent::Vector(_));
            self.needed.converted |= vector;
            self.needed.converted_matrix |= !vector;
            let function = if vector {
                "converted"
            } else {
                "converted_matrix"
            };
            return Ok(format!("{function}(&{name})"));
        }
        let Some(name) = self.coefficient_name(id) else {
            return Err(EmitError::Value(format!(
                "value {} is no array",
                id.index()
            )));
        };
        let field = Expression::field("coefficients", name);
        if !self.for_lanes() {
            return Ok(field.to_string());
        }
        let matrix = matches!(self.program.value(id).extent, Extent::Matrix(..));
        self.needed.read_array |= !matrix;
        self.needed.read_matrix |= matrix;
        let function = if matrix { "read_matrix" } else { "read_array" };
        Ok(Expression::call(function, &[reference(field.to_string())]).to_string())
    }

    /// A vector as a whole array, copied where it is none; a scalar stands for every element.
    fn vector_array(&mut self, id: ValueId, length: usize) -> Emitted<String> {
        if self.program.value(id).extent == Extent::Scalar {
            let value = self.scalar(id)?;
            return Ok(format!("[{value}; {length}]"));
        }
        if let Ok(array) = self.numbers(id) {
            return Ok(array);
        }
        let element = self.element(id)?;
        let name = self.names.of(self.program, id, "s")?;
        self.push_filled(&name, length, &assignment(&format!("{name}[i]"), element));
        Ok(name)
    }
}

/// The name under which a stage is given an argument.
fn argument_name(argument: Argument) -> &'static str {
    match argument {
        Argument::Accelerations => "accelerations",
        Argument::Direction => "direction",
        Argument::Weights => "weights",
    }
}

/// A loop of these lines.
pub(super) fn looped(index: &str, length: usize, lines: &str) -> String {
    block(&format!("for {index} in 0..{length} {{"), lines, "}")
}

/// A reference to an array.
pub(super) fn reference(array: String) -> Expression {
    Expression::atom(format!("&{array}"))
}

/// Whether each element depends on the operands' elements of the same index alone.
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
