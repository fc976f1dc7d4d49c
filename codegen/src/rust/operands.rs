//! How a stage reads a value: by the name that it has by now, as the expression that computes
//! it, from what was given or prepared; by itself, by element or as a whole array.

use super::body::{Access, Body};
use super::emit_error::{EmitError, Emitted};
use super::expression::{Expression, infix, reference};
use super::literals::identifier;
use super::sides::of_side;
use crate::program::evaluator::{Law, law};
use crate::program::{Argument, Extent, Op, Output, ValueId, Variable};
use eomgen_elementary::Function as Elementary;
use eomgen_model_spec::model::Function;

impl<'a> Body<'a> {
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
    pub(super) fn own_expression(
        &mut self,
        id: ValueId,
        index: Option<&str>,
    ) -> Emitted<Expression> {
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

    pub(super) fn leaf(&self, id: ValueId) -> Emitted<Expression> {
        let program = self.program;
        Ok(match program.value(id).op {
            Op::Coordinate(index) => Expression::atom(format!("state[{}]", index.index())),
            Op::Rate(index) => Expression::atom(format!(
                "state[{}]",
                program.degrees_of_freedom() + index.index()
            )),
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
}

/// The name under which a stage is given an argument.
fn argument_name(argument: Argument) -> &'static str {
    match argument {
        Argument::Accelerations => "accelerations",
        Argument::Direction => "direction",
        Argument::Weights => "weights",
    }
}
