//! Expressions as instructions that push a number or a condition.

use super::code::Code;
use super::memory::{Region, missing_address_error};
use crate::statements::{ArgumentStruct, Array, EmitError, EmitResult, Expression, Operator};

impl Code<'_> {
    /// Pushes the value of an expression.
    pub(super) fn expression(&mut self, expression: &Expression) -> EmitResult<()> {
        match expression {
            Expression::Number(value) => {
                self.instructions().f64_const((*value).into());
            }
            Expression::Name(name) | Expression::Flag(name) => {
                let variable = self.local_index(name)?;
                self.instructions().local_get(variable);
            }
            Expression::Element(Array::Filled(value, _), _) => self.expression(value)?,
            Expression::Element(array, indices) => {
                let region = self.region_of(array)?;
                let from = self.address(region, indices)?;
                self.instructions().f64_load(from);
            }
            Expression::Field(structure, name) => self.field(*structure, name)?,
            Expression::Shared(coefficient) => self.expression(coefficient)?,
            Expression::Binary(operator, a, b) => {
                self.expression(a)?;
                self.expression(b)?;
                self.operator(*operator);
            }
            Expression::Negate(a) => {
                self.expression(a)?;
                self.instructions().f64_neg();
            }
            Expression::Call(name, parts) => {
                self.expressions(parts)?;
                let function = self.functions.index(name)?;
                self.instructions().call(function);
            }
            Expression::Primitive("select_equal", parts) => {
                let [a, b, then, otherwise] = &parts[..] else {
                    return Err(missing_address_error("select_equal"));
                };
                self.expressions([then, otherwise, a, b])?;
                self.instructions().f64_eq().select();
            }
            Expression::Primitive(name, parts) => {
                self.expressions(parts)?;
                self.primitive(name)?;
            }
            // Both branches are computed; the unused value is dropped.
            Expression::Select(parts) => {
                let [a, b, then, otherwise] = &**parts;
                self.expressions([then, otherwise, a, b])?;
                self.instructions().f64_gt().select();
            }
            Expression::Greater(parts) => {
                self.expressions(&**parts)?;
                self.instructions().f64_gt();
            }
            Expression::And(parts) => {
                self.expressions(&**parts)?;
                self.instructions().i32_and();
            }
            Expression::True => {
                self.instructions().i32_const(1);
            }
            Expression::Positive(_) => {
                return Err(EmitError::Value(
                    "regimes are not available in WebAssembly".into(),
                ));
            }
        }
        Ok(())
    }

    fn expressions<'e>(&mut self, all: impl IntoIterator<Item = &'e Expression>) -> EmitResult<()> {
        all.into_iter().try_for_each(|one| self.expression(one))
    }

    fn field(&mut self, structure: ArgumentStruct, name: &str) -> EmitResult<()> {
        let place = match structure {
            ArgumentStruct::Coefficients => self.memory.coefficient(name)?.first,
            ArgumentStruct::Parameters => self.memory.parameter(name)?,
            ArgumentStruct::Inputs => self.memory.input(name)?,
            ArgumentStruct::InputDirection | ArgumentStruct::Measured | ArgumentStruct::Memory => {
                return Err(missing_address_error(name));
            }
        };
        self.load(place);
        Ok(())
    }

    pub(super) fn region_of(&mut self, array: &Array) -> EmitResult<Region> {
        match array {
            Array::Local(name) => self.region(name),
            Array::Coefficient(name, _) => self.memory.coefficient(name),
            Array::Table(name, _) => self.memory.table(self.program, name),
            Array::Filled(..) => Err(EmitError::Value("a repeated number is not an array".into())),
        }
    }

    fn operator(&mut self, operator: Operator) {
        let mut put = self.instructions();
        match operator {
            Operator::Add => put.f64_add(),
            Operator::Subtract => put.f64_sub(),
            Operator::Multiply => put.f64_mul(),
            Operator::Divide => put.f64_div(),
        };
    }

    /// Writes an operation on the bits of a number; see `Real` in `eomgen-elementary`.
    fn primitive(&mut self, name: &str) -> EmitResult<()> {
        const MANTISSA_BITS: i64 = 52;
        let mut put = self.instructions();
        match name {
            "magnitude" => put.f64_abs(),
            "copy_sign" => put.f64_copysign(),
            "power_of_two" => {
                let aligner = (1_u64 << MANTISSA_BITS) + 1023;
                put.f64_const((aligner as f64).into())
                    .f64_add()
                    .i64_reinterpret_f64();
                put.i64_const(MANTISSA_BITS).i64_shl().f64_reinterpret_i64()
            }
            "exponent" => {
                put.i64_reinterpret_f64().i64_const(MANTISSA_BITS);
                put.i64_shr_u().i64_const(0x7ff).i64_and();
                put.f64_convert_i64_s().f64_const(1023.0.into()).f64_sub()
            }
            "significand" => {
                put.i64_reinterpret_f64()
                    .i64_const((1 << MANTISSA_BITS) - 1);
                put.i64_and().i64_const(0x3ff << MANTISSA_BITS).i64_or();
                put.f64_reinterpret_i64()
            }
            _ => return Err(missing_address_error(name)),
        };
        Ok(())
    }
}
