//! SI units of the values of a program, inferred from the units of its quantities.

use eomgen_model_spec::dimension::{Dimension, Exponent};
use eomgen_model_spec::function::Function;
use eomgen_model_spec::unit::Unit;

use super::{Argument, Op, Program, ValueId, Variable};

/// Unit of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ValueUnit {
    /// Unit of the value 0, which is compatible with every unit.
    Any,
    /// Dimension of a known unit.
    Known(Dimension),
    /// Unknown unit.
    Unknown,
}

impl ValueUnit {
    /// Returns the dimension, if it is known.
    pub fn dimension(self) -> Option<Dimension> {
        match self {
            Self::Known(dimension) => Some(dimension),
            Self::Any | Self::Unknown => None,
        }
    }

    /// Returns the SI unit as text, `1` without a dimension; `None` if it is not known.
    pub fn si_text(self) -> Option<String> {
        let dimension = self.dimension()?;
        Some(match dimension.is_dimensionless() {
            true => "1".to_owned(),
            false => dimension.to_string(),
        })
    }

    fn from_text(unit: &str) -> Self {
        Self::from_dimension(Unit::parse(unit).ok().map(|unit| unit.dimension))
    }

    fn from_dimension(dimension: Option<Dimension>) -> Self {
        dimension.map_or(Self::Unknown, Self::Known)
    }

    /// Returns the common unit of two summands or branches.
    fn common(self, other: Self) -> Self {
        match (self, other) {
            (Self::Any, unit) | (unit, Self::Any) => unit,
            (a, b) if a == b => a,
            _ => Self::Unknown,
        }
    }

    fn multiply(self, other: Self) -> Self {
        match (self, other) {
            (Self::Any, _) | (_, Self::Any) => Self::Any,
            (Self::Known(a), Self::Known(b)) => Self::from_dimension(a.multiply(b)),
            _ => Self::Unknown,
        }
    }

    fn divide(self, other: Self) -> Self {
        match (self, other) {
            (Self::Any, _) => Self::Any,
            (Self::Known(a), Self::Known(b)) => Self::from_dimension(a.divide(b)),
            _ => Self::Unknown,
        }
    }

    fn raise(self, exponent: Exponent) -> Self {
        match self {
            Self::Known(a) => Self::from_dimension(a.raise(exponent)),
            other => other,
        }
    }
}

const NUMBER: ValueUnit = ValueUnit::Known(Dimension::DIMENSIONLESS);

/// Infers the unit of each value. If the units of the operands are inconsistent, the unit is unknown.
pub fn infer_units(program: &Program) -> Vec<ValueUnit> {
    let mut units: Vec<ValueUnit> = Vec::with_capacity(program.values.len());
    for value in &program.values {
        let unit = infer(program, &value.op, &units);
        units.push(unit);
    }
    units
}

fn infer(program: &Program, op: &Op, units: &[ValueUnit]) -> ValueUnit {
    let of = |id: &ValueId| units[id.index()];
    match op {
        Op::Constant(0.0) => ValueUnit::Any,
        Op::Constant(_) | Op::Table(_) => NUMBER,
        Op::Parameter(place) => ValueUnit::from_text(&program.parameters[*place].quantity.unit),
        Op::Coordinate(index) => variable_unit(program, Variable::Coordinate(*index)),
        Op::Rate(index) => variable_unit(program, Variable::Rate(*index)),
        Op::ModeCoordinates(field) => variable_unit(program, Variable::ModeCoordinates(*field)),
        Op::ModeRates(field) => variable_unit(program, Variable::ModeRates(*field)),
        Op::State(index) => variable_unit(program, Variable::State(*index)),
        Op::Input(index) => variable_unit(program, Variable::Input(*index)),
        Op::Time => variable_unit(program, Variable::Time),
        Op::Argument(Argument::Accelerations, variable) => {
            variable_unit(program, *variable).divide(second_squared())
        }
        Op::Argument(Argument::Sides, _) => NUMBER,
        // The units of directions and weights depend on the caller.
        Op::Argument(..) => ValueUnit::Unknown,
        Op::Negate(a) | Op::Total(a) => of(a),
        Op::Add(a, b) | Op::Subtract(a, b) => of(a).common(of(b)),
        Op::Multiply(a, b) => of(a).multiply(of(b)),
        Op::Divide(a, b) => of(a).divide(of(b)),
        Op::Power(a, b) => match program.value(*b).op {
            Op::Constant(exponent) => power(of(a), exponent),
            _ if of(a) == NUMBER => NUMBER,
            _ => ValueUnit::Unknown,
        },
        Op::Call(function, arguments) => {
            let mut arguments = arguments.iter().map(of);
            let first = arguments.next().unwrap_or(ValueUnit::Unknown);
            match function {
                Function::Abs => first,
                Function::Sqrt => first.raise(Exponent::new(1, 2)),
                Function::Min | Function::Max | Function::Deadzone => {
                    arguments.fold(first, ValueUnit::common)
                }
                _ => NUMBER,
            }
        }
        Op::Select {
            then, otherwise, ..
        } => of(then).common(of(otherwise)),
        Op::PivotReciprocal(a) => NUMBER.divide(of(a)),
        Op::Apply { matrix, vector, .. } => of(matrix).multiply(of(vector)),
        Op::Gram {
            left,
            weight,
            right,
        }
        | Op::GramDiagonal {
            left,
            weight,
            right,
        } => of(left).multiply(of(weight)).multiply(of(right)),
        Op::Assemble {
            diagonal,
            outer,
            matrices,
        } => {
            let outer = outer.iter().map(|(u, v)| of(u).multiply(of(v)));
            let scaled = (matrices.iter()).map(|part| {
                of(&part.row)
                    .multiply(of(&part.matrix))
                    .multiply(of(&part.column))
            });
            let parts = diagonal.iter().map(of).chain(outer).chain(scaled);
            parts.fold(ValueUnit::Any, ValueUnit::common)
        }
        Op::Cholesky(a) => of(a).raise(Exponent::new(1, 2)),
        Op::CholeskySolve(factor, right) => of(right).divide(of(factor).multiply(of(factor))),
    }
}

fn second_squared() -> ValueUnit {
    ValueUnit::Known(Dimension::TIME).multiply(ValueUnit::Known(Dimension::TIME))
}

/// Returns the unit of a power; it is known if the exponent is a fraction with a small denominator.
fn power(base: ValueUnit, exponent: f64) -> ValueUnit {
    let fraction = (1..=12).find_map(|denominator| {
        let numerator = exponent * f64::from(denominator);
        let whole = numerator.fract() == 0.0 && numerator.abs() <= 1000.0;
        whole.then(|| Exponent::new(numerator as i32, denominator))
    });
    match fraction {
        Some(fraction) => base.raise(fraction),
        None if base == NUMBER => NUMBER,
        None => ValueUnit::Unknown,
    }
}

/// Returns the unit of a variable.
pub fn variable_unit(program: &Program, variable: Variable) -> ValueUnit {
    let second = ValueUnit::Known(Dimension::TIME);
    match variable {
        Variable::Coordinate(index) => ValueUnit::from_text(&program.coordinates[index].unit),
        Variable::Rate(index) => {
            ValueUnit::from_text(&program.coordinates[index].unit).divide(second)
        }
        Variable::ModeCoordinates(field) => ValueUnit::from_text(&program.fields[field].unit),
        Variable::ModeRates(field) => {
            ValueUnit::from_text(&program.fields[field].unit).divide(second)
        }
        Variable::State(index) => ValueUnit::from_text(&program.first_order[index].unit),
        Variable::Input(index) => ValueUnit::from_text(&program.inputs[index].unit),
        Variable::Parameter(index) => {
            ValueUnit::from_text(&program.parameters[index.index()].quantity.unit)
        }
        Variable::Time => second,
    }
}
