//! Operands of expressions: the name of a value, the expression that computes it, or its element in the arguments or
//! coefficients.

use super::body::{Access, Body};
use super::emit_error::{EmitError, EmitResult};
use super::expression::{ArgumentStruct, Array, Expression};
use super::index::Index;
use super::sides::decide_by_regime;
use crate::program::evaluator::elementary;
use crate::program::{Argument, Extent, Op, Output, Program, ValueId, Variable};
use eomgen_elementary::Function as Elementary;

impl<'a> Body<'a> {
    /// Returns a scalar.
    pub fn scalar(&mut self, id: ValueId) -> EmitResult<Expression> {
        self.expression(id, None)
    }

    /// Returns element i of a vector, or a scalar.
    pub fn element(&mut self, id: ValueId) -> EmitResult<Expression> {
        self.element_at(id, "i")
    }

    /// Returns element `index` of a vector, or a scalar.
    pub(super) fn element_at(
        &mut self,
        id: ValueId,
        index: &'static str,
    ) -> EmitResult<Expression> {
        let scalar = self.program.value(id).extent == Extent::Scalar;
        self.expression(id, (!scalar).then_some(index))
    }

    /// Returns a scalar or an element of a vector, by name if it has one.
    fn expression(&mut self, id: ValueId, index: Option<&'static str>) -> EmitResult<Expression> {
        match (self.bound.get(&id), index) {
            (Some(name), Some(index)) => Ok(Expression::element(&**name, [index.into()])),
            (Some(name), None) => Ok(Expression::name(name)),
            (None, _) => self.own_expression(id, index),
        }
    }

    /// Returns the expression that computes a value.
    pub(super) fn own_expression(
        &mut self,
        id: ValueId,
        index: Option<&'static str>,
    ) -> EmitResult<Expression> {
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
            .collect::<EmitResult<Vec<_>>>()?;
        match decide_by_regime(self.program, &self.switches, id, &operands, self.needed) {
            Some(decided) => Ok(decided),
            None => self.operation(id, &op, &operands),
        }
    }

    fn operation(
        &mut self,
        id: ValueId,
        op: &Op,
        operands: &[Expression],
    ) -> EmitResult<Expression> {
        Ok(match (op, operands) {
            (Op::Negate(_), [a]) => Expression::negate(a),
            (Op::Add(..), [a, b]) => Expression::add(a, b),
            (Op::Subtract(..), [a, b]) => Expression::subtract(a, b),
            (Op::Multiply(..), [a, b]) => Expression::multiply(a, b),
            (Op::Divide(..), [a, b]) => Expression::divide(a, b),
            (Op::Power(..), _) => self.call(Elementary::Pow, operands),
            (Op::PivotReciprocal(_), _) => self.call(Elementary::PivotReciprocal, operands),
            (Op::Select { .. }, [a, b, then, otherwise]) => {
                let parts = [a, b, then, otherwise].map(Expression::clone);
                Expression::Select(Box::new(parts))
            }
            (Op::Call(function, _), _) => self.call(elementary(*function), operands),
            _ => {
                return Err(EmitError::misplaced_value(
                    id,
                    "is not an elementwise operation",
                ));
            }
        })
    }

    fn call(&mut self, function: Elementary, arguments: &[Expression]) -> Expression {
        Expression::Call(self.needed.name(function), arguments.to_vec())
    }

    /// Returns the expression of a constant, table, state or coefficient, or None for other values.
    fn leaf_or_coefficient(
        &self,
        id: ValueId,
        index: Option<&'static str>,
    ) -> EmitResult<Option<Expression>> {
        let value = self.program.value(id);
        let program = self.program;
        let of = |array: &str, first: usize| {
            let index = index.ok_or_else(|| EmitError::misplaced_value(id, "is a vector"))?;
            Ok(Expression::element(
                array,
                [Index::from_first(first, index)],
            ))
        };
        Ok(Some(match value.op {
            Op::Constant(value) => Expression::Number(value),
            Op::Time => Expression::name("t"),
            Op::Table(table) => {
                let index = index.ok_or_else(|| EmitError::misplaced_value(id, "is a table"))?;
                Expression::Element(self.table(table)?, vec![index.into()])
            }
            Op::ModeCoordinates(field) => of("state", program.mode_offset(field))?,
            Op::ModeRates(field) => {
                let first = program.degrees_of_freedom() + program.mode_offset(field);
                of("state", first)?
            }
            Op::Argument(argument, variable) if value.extent != Extent::Scalar => of(
                argument_name(argument),
                argument_index(program, argument, variable),
            )?,
            _ => match &self.access {
                Access::Coefficients(fields) if value.parameter_only => {
                    let Some(name) = fields.get(&id) else {
                        return Err(EmitError::Value(format!(
                            "value {} is not prepared",
                            id.index()
                        )));
                    };
                    self.shared(match index {
                        Some(index) => {
                            let array = Array::Coefficient(name.clone(), value.extent);
                            Expression::Element(array, vec![index.into()])
                        }
                        None => Expression::Field(ArgumentStruct::Coefficients, name.clone()),
                    })
                }
                _ => return Ok(None),
            },
        }))
    }

    /// Marks a coefficient as shared if the program is emitted for SIMD lanes.
    fn shared(&self, coefficient: Expression) -> Expression {
        if self.program.outputs.kinds.contains(&Output::Lanes) {
            Expression::Shared(Box::new(coefficient))
        } else {
            coefficient
        }
    }

    pub(super) fn leaf(&self, id: ValueId) -> EmitResult<Expression> {
        let program = self.program;
        let at = |array: &str, place: usize| Expression::element(array, [Index::Number(place)]);
        let field = |of: ArgumentStruct, name: &str| {
            let name = self.names.identifier(name)?.to_owned();
            Ok(Expression::Field(of, name))
        };
        Ok(match program.value(id).op {
            Op::Coordinate(index) => at("state", index.index()),
            Op::Rate(index) => at("state", program.degrees_of_freedom() + index.index()),
            Op::State(index) => at("state", 2 * program.degrees_of_freedom() + index.index()),
            Op::Input(index) => field(ArgumentStruct::Inputs, &program.inputs[index].name)?,
            Op::Parameter(place) => {
                let name = &program.parameters[place].quantity.name;
                field(ArgumentStruct::Parameters, name)?
            }
            Op::Argument(Argument::Direction, Variable::Input(index)) => {
                field(ArgumentStruct::InputDirection, &program.inputs[index].name)?
            }
            Op::Argument(argument, variable) => at(
                argument_name(argument),
                argument_index(program, argument, variable),
            ),
            _ => {
                return Err(EmitError::misplaced_value(
                    id,
                    "is not an argument of the stage",
                ));
            }
        })
    }

    /// Returns an entry of a matrix or of a vector.
    pub fn entry<const N: usize>(
        &mut self,
        id: ValueId,
        indices: [&'static str; N],
    ) -> EmitResult<Expression> {
        let array = match self.program.value(id).op {
            Op::Table(place) => self.table(place)?,
            _ => self.numbers(id)?,
        };
        let prepared = matches!(array, Array::Coefficient(..));
        let entry = Expression::Element(array, indices.map(Index::Variable).to_vec());
        Ok(if prepared { self.shared(entry) } else { entry })
    }

    fn table(&self, place: usize) -> EmitResult<Array> {
        let table = &self.program.tables[place];
        let name = self.names.identifier(&table.name)?;
        Ok(Array::Table(name.to_owned(), table.extent))
    }

    fn coefficient_name(&self, id: ValueId) -> Option<&'a str> {
        match self.access {
            Access::Coefficients(fields) => fields.get(&id).map(String::as_str),
            Access::Prepare => None,
        }
    }

    /// Returns a vector or matrix as an array.
    pub fn numbers(&mut self, id: ValueId) -> EmitResult<Array> {
        if let Some(name) = self.bound.get(&id) {
            return Ok(Array::local(name));
        }
        if let Op::Table(place) = self.program.value(id).op {
            return self.table(place);
        }
        let Some(name) = self.coefficient_name(id) else {
            return Err(EmitError::Value(format!(
                "value {} is not an array",
                id.index()
            )));
        };
        Ok(Array::Coefficient(
            name.to_owned(),
            self.program.value(id).extent,
        ))
    }
}

/// Returns the index of a variable in an argument. For a field, returns the index of its first mode.
fn argument_index(program: &Program, argument: Argument, variable: Variable) -> usize {
    match argument {
        Argument::PointDirection => program.point_place(variable),
        _ => program.variable_place(variable),
    }
}

fn argument_name(argument: Argument) -> &'static str {
    match argument {
        Argument::Accelerations => "accelerations",
        Argument::Direction | Argument::PointDirection => "direction",
        Argument::Weights => "weights",
        Argument::Sides => "sides",
    }
}
