//! The program: its values, quantities, rows and blocks.

use super::value::{Extent, Op, Value, ValueId};
use crate::mechanics::impacts::Impact;
use crate::mechanics::outputs::{Outputs, Products};
use crate::symbolic::graph::Variable;
use eomgen_model_spec::ids::FieldId;

/// A named quantity with its unit.
#[derive(Clone, Debug)]
pub struct Quantity {
    /// ASCII name.
    pub name: String,
    /// Its SI unit, for people.
    pub unit: String,
    /// What it is.
    pub doc: String,
}

/// An independent parameter.
#[derive(Clone, Debug)]
pub struct ProgramParameter {
    /// Name, unit and meaning.
    pub quantity: Quantity,
    /// Where the value comes from.
    pub origin: String,
    /// The specification's value, in SI.
    pub value: f64,
}

/// A field of the variant.
#[derive(Clone, Debug)]
pub struct ProgramField {
    /// Name of the mode coordinates.
    pub coordinates: String,
    /// Unit of the mode coordinates.
    pub unit: String,
    /// The variant's order.
    pub order: usize,
}

/// A switching surface.
#[derive(Clone, Debug)]
pub struct ProgramGuard {
    /// What changes sign, as a formula for people.
    pub formula: String,
    /// Its value.
    pub value: ValueId,
}

/// The blocks of the mass matrix.
#[derive(Clone, Debug, Default)]
pub struct MassBlocks {
    /// coordinates x coordinates
    pub scalars: Vec<Vec<ValueId>>,
    /// For each coordinate and field the vector over the modes (or a scalar for equal
    /// entries).
    pub coupling: Vec<Vec<ValueId>>,
    /// For each pair of fields the matrix over their modes; `None` where it is 0.
    pub modal: Vec<Vec<Option<ValueId>>>,
}

/// Values by row: coordinates, then each field's modes.
#[derive(Clone, Debug, Default)]
pub struct RowValues {
    /// One per coordinate.
    pub scalars: Vec<ValueId>,
    /// One per field: a vector, or a scalar for equal entries.
    pub modal: Vec<ValueId>,
}

impl RowValues {
    /// All values.
    pub fn all(&self) -> Vec<ValueId> {
        self.scalars.iter().chain(&self.modal).copied().collect()
    }
}

/// The program of one variant.
#[derive(Clone, Debug)]
pub struct Program {
    /// The model's name.
    pub name: String,
    /// The model's title.
    pub title: String,
    /// SHA-256 of the specification, in hexadecimal.
    pub spec_hash: String,
    /// Independent parameters, in the order of the specification.
    pub parameters: Vec<ProgramParameter>,
    /// Coordinates without the modes.
    pub coordinates: Vec<Quantity>,
    /// Fields.
    pub fields: Vec<ProgramField>,
    /// States of first order.
    pub first_order: Vec<Quantity>,
    /// Inputs.
    pub inputs: Vec<Quantity>,
    /// Observables; the last two are `energy` and `power`.
    pub observables: Vec<Quantity>,
    /// Tables of constants, each with what it holds.
    pub tables: Vec<ProgramTable>,
    /// The values, operands first.
    pub values: Vec<Value>,
    /// Accelerations.
    pub accelerations: RowValues,
    /// The rates of the states of first order.
    pub first_order_rates: Vec<ValueId>,
    /// The mass matrix.
    pub mass: MassBlocks,
    /// Velocity terms c of M q'' + c = f.
    pub velocity_terms: RowValues,
    /// Generalised forces f.
    pub forces: RowValues,
    /// Values of the observables, `energy` and `power` last.
    pub observable_values: Vec<ValueId>,
    /// Switching surfaces.
    pub guards: Vec<ProgramGuard>,
    /// Impacts.
    pub impacts: Vec<Impact<ValueId, RowValues>>,
    /// Prepared pivots, which must be positive for the accelerations to exist.
    pub pivots: Vec<ValueId>,
    /// Values of the coefficients the specification names.
    pub coefficient_values: Vec<ValueId>,
    /// The outputs on request beside all this.
    pub outputs: Outputs<ValueId, RowValues>,
}

/// A table of constants.
#[derive(Clone, Debug)]
pub struct ProgramTable {
    /// What it holds, for people.
    pub doc: String,
    /// A short name.
    pub name: String,
    /// Its extent.
    pub extent: Extent,
    /// Its numbers, row by row.
    pub values: Vec<f64>,
}

impl Products<ValueId, RowValues> {
    /// What the product with a direction is computed from.
    pub(crate) fn forward_roots(&self) -> Vec<ValueId> {
        let mut roots = self.forward.all();
        roots.extend(&self.forward_first_order);
        roots
    }
}

impl Program {
    /// A value.
    pub fn value(&self, id: ValueId) -> &Value {
        &self.values[id.0]
    }

    /// Every value, operands first.
    pub fn ids(&self) -> impl Iterator<Item = ValueId> + use<> {
        (0..self.values.len()).map(ValueId)
    }

    /// Degrees of freedom: coordinates and modes.
    pub fn degrees_of_freedom(&self) -> usize {
        self.coordinates.len() + self.fields.iter().map(|f| f.order).sum::<usize>()
    }

    /// Numbers in the state: coordinates, modes, the rates of both, and states of first order.
    pub fn states(&self) -> usize {
        2 * self.degrees_of_freedom() + self.first_order.len()
    }

    /// Names of the state in its order; a rate's is its coordinate's with `_dot`.
    pub fn state_names(&self) -> Vec<String> {
        let mut names: Vec<String> = self.coordinates.iter().map(|c| c.name.clone()).collect();
        for field in &self.fields {
            names.extend((1..=field.order).map(|i| format!("{}_{i}", field.coordinates)));
        }
        let rates: Vec<String> = names.iter().map(|name| format!("{name}_dot")).collect();
        names.extend(rates);
        names.extend(self.first_order.iter().map(|state| state.name.clone()));
        names
    }

    /// The specification's values of the independent parameters, in SI.
    pub fn default_parameters(&self) -> Vec<f64> {
        self.parameters.iter().map(|p| p.value).collect()
    }

    /// Place in the state of a field's first mode coordinate.
    pub fn mode_offset(&self, field: FieldId) -> usize {
        self.coordinates.len()
            + self.fields[..field.index()]
                .iter()
                .map(|f| f.order)
                .sum::<usize>()
    }

    /// How many numbers a point has: time, state, inputs and independent parameters.
    pub fn point_length(&self) -> usize {
        1 + self.states() + self.inputs.len() + self.parameters.len()
    }

    /// Place of a variable, or of the first of a field's, in a point.
    pub fn point_place(&self, variable: Variable) -> usize {
        let before = match variable {
            Variable::Time => 0,
            Variable::Input(_) => 1 + self.states(),
            Variable::Parameter(_) => 1 + self.states() + self.inputs.len(),
            _ => 1,
        };
        before + self.variable_place(variable)
    }

    /// Place of a variable, or of the first of a field's, in the state, among the inputs, or
    /// among the independent parameters.
    pub fn variable_place(&self, variable: Variable) -> usize {
        match variable {
            Variable::Coordinate(index) => index.index(),
            Variable::State(index) => 2 * self.degrees_of_freedom() + index.index(),
            Variable::Input(index) => index.index(),
            Variable::Parameter(index) => index.index(),
            Variable::Time => 0,
            Variable::ModeCoordinates(field) => self.mode_offset(field),
            Variable::Rate(index) => self.degrees_of_freedom() + index.index(),
            Variable::ModeRates(field) => self.degrees_of_freedom() + self.mode_offset(field),
        }
    }

    /// What the rates of the state are computed from: accelerations and the rates of the states
    /// of first order.
    pub fn rate_roots(&self) -> Vec<ValueId> {
        let mut roots = self.accelerations.all();
        roots.extend(&self.first_order_rates);
        roots
    }

    /// Every value that `roots` are computed from, in the order of the program.
    pub fn reachable(&self, roots: &[ValueId]) -> Vec<ValueId> {
        let mut needed = vec![false; self.values.len()];
        for root in roots {
            needed[root.0] = true;
        }
        for index in (0..self.values.len()).rev() {
            if needed[index] {
                for operand in self.values[index].op.operands() {
                    needed[operand.0] = true;
                }
            }
        }
        (0..self.values.len())
            .filter(|i| needed[*i])
            .map(ValueId)
            .collect()
    }

    /// Whether the mass matrix may lose its definiteness as the state moves: where it does, a
    /// pivot that is computed per call makes the accelerations NaN.
    pub fn may_lose_definiteness(&self) -> bool {
        let is_pivot = |op: &Op| matches!(op, Op::PivotReciprocal(_) | Op::Cholesky(_));
        let accelerations = self.per_call(&self.rate_roots());
        accelerations.iter().any(|id| is_pivot(&self.value(*id).op))
    }

    /// The values a stage computes per call: what `roots` need and is not prepared.
    pub fn per_call(&self, roots: &[ValueId]) -> Vec<ValueId> {
        self.reachable(roots)
            .into_iter()
            .filter(|id| !self.value(*id).parameter_only)
            .collect()
    }
}
