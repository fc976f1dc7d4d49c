//! Program, quantities, rows and blocks.

use super::controllers::ProgramController;
use super::domain::Domain;
use super::quantity::Quantity;
use super::trace::Trace;
use super::value::{Extent, Op, Value, ValueId};
use crate::mechanics::impact::Impact;
use crate::mechanics::outputs::{Outputs, Products, Reactions};
use crate::symbolic::variable::Variable;
use eomgen_model_spec::ids::FieldId;

/// Independent parameter.
#[derive(Clone, Debug)]
pub struct ProgramParameter {
    /// Name, unit and meaning.
    pub quantity: Quantity,
    /// Source of the value.
    pub origin: String,
    /// Value of the specification in SI units.
    pub value: f64,
}

/// Field of the variant.
#[derive(Clone, Debug)]
pub struct ProgramField {
    /// Name of the modal coordinates.
    pub coordinates: String,
    /// Unit of the modal coordinates.
    pub unit: String,
    /// Truncation order.
    pub order: usize,
}

/// Switching surface.
#[derive(Clone, Debug)]
pub struct ProgramGuard {
    /// Formula of the switching function, as text.
    pub formula: String,
    /// Value of the switching function.
    pub value: ValueId,
    /// True if an energy jumps on the surface and makes rates jump.
    pub is_corner: bool,
}

/// Blocks of the mass matrix.
#[derive(Clone, Debug, Default)]
pub struct MassBlocks {
    /// Block of the coordinates.
    pub scalars: Vec<Vec<ValueId>>,
    /// Vector over the modes for each coordinate and field; a scalar if all entries are equal.
    pub coupling: Vec<Vec<ValueId>>,
    /// Matrix over the modes for each pair of fields; `None` if it is 0.
    pub modal: Vec<Vec<Option<ValueId>>>,
}

/// Values by row: coordinates, then the modes of each field.
#[derive(Clone, Debug, Default)]
pub struct RowValues {
    /// One scalar for each coordinate.
    pub scalars: Vec<ValueId>,
    /// One value for each field: a vector, or a scalar if all entries are equal.
    pub modal: Vec<ValueId>,
}

impl RowValues {
    /// Returns all values.
    pub fn all(&self) -> Vec<ValueId> {
        self.scalars.iter().chain(&self.modal).copied().collect()
    }
}

/// Program of one variant.
#[derive(Clone, Debug)]
pub struct Program {
    /// Prefix of the names in emitted C and name of emitted files: the name of the model unless
    /// another one is given.
    pub name: String,
    /// Name of the specification.
    pub specification: String,
    /// Title of the model.
    pub title: String,
    /// SHA-256 of the specification in hexadecimal.
    pub spec_hash: String,
    /// Independent parameters, in the order of the specification.
    pub parameters: Vec<ProgramParameter>,
    /// Coordinates without the modes.
    pub coordinates: Vec<Quantity>,
    /// Fields.
    pub fields: Vec<ProgramField>,
    /// First-order states.
    pub first_order: Vec<Quantity>,
    /// Inputs.
    pub inputs: Vec<Quantity>,
    /// Observables; the last two are `energy` and `power`.
    pub observables: Vec<Quantity>,
    /// Tables of constants.
    pub tables: Vec<ProgramTable>,
    /// Values, operands first.
    pub values: Vec<Value>,
    /// Accelerations.
    pub accelerations: RowValues,
    /// Rates of the first-order states.
    pub first_order_rates: Vec<ValueId>,
    /// Mass matrix.
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
    /// Prepared pivots; the accelerations are NaN unless all are positive.
    pub pivots: Vec<ValueId>,
    /// Values of the named coefficients of the specification.
    pub coefficient_values: Vec<ValueId>,
    /// Units, initial state and ranges, for the data in emitted files.
    pub domain: Domain,
    /// Sampled controllers.
    pub controllers: Vec<ProgramController>,
    /// Requested outputs.
    pub outputs: Outputs<ValueId, RowValues>,
    /// Units and terms of the values, for comments; empty unless computed by
    /// [`Variant::add_trace`](crate::variant::Variant::add_trace).
    pub trace: Trace,
}

/// Table of constants.
#[derive(Clone, Debug)]
pub struct ProgramTable {
    /// Description.
    pub doc: String,
    /// Short name.
    pub name: String,
    /// Size of the table.
    pub extent: Extent,
    /// Elements, row by row.
    pub values: Vec<f64>,
}

impl Products<ValueId, RowValues> {
    /// Returns the values of the product with a direction.
    pub(crate) fn forward_roots(&self) -> Vec<ValueId> {
        let mut roots = self.forward.all();
        roots.extend(&self.forward_first_order);
        roots
    }

    /// Returns the values of the products with weights.
    pub(crate) fn reverse_roots(&self) -> Vec<ValueId> {
        let by_variables = self.reverse.iter().map(|(_, id)| *id);
        let by_parameters = self.by_parameters.entries.iter();
        by_variables
            .chain(by_parameters.map(|entry| entry.value))
            .collect()
    }
}

/// Reactions in a step of fixed length, as values of a program.
pub type ProgramReactions = Reactions<ValueId, RowValues>;

impl ProgramReactions {
    /// Returns the values of the rates with sides.
    pub(crate) fn rate_roots(&self) -> Vec<ValueId> {
        let mut roots = self.accelerations.all();
        roots.extend(&self.first_order_rates);
        roots
    }

    /// Returns the functions of the reactions, then the distances of the contacts.
    pub(crate) fn function_roots(&self) -> Vec<ValueId> {
        let functions = self.functions.iter().chain(&self.distances);
        functions.copied().collect()
    }

    /// Returns the effects, the coefficients of restitution and of friction, then the columns.
    pub(crate) fn effect_roots(&self) -> Vec<ValueId> {
        let mut roots = self.effects.clone();
        roots.extend(&self.restitutions);
        roots.extend(
            self.coefficients
                .iter()
                .map(|(_, coefficient)| *coefficient),
        );
        for (rates, first_order) in &self.columns {
            roots.extend(rates.all());
            roots.extend(first_order);
        }
        roots
    }

    /// Returns the number of effects and coefficients before the columns.
    pub fn first_column(&self) -> usize {
        self.effects.len() + self.restitutions.len() + self.coefficients.len()
    }
}

impl Program {
    /// Returns two lengths: of the functions and distances of the reactions, and of their effects, coefficients and
    /// columns. Both are 0 without reactions.
    pub fn reaction_sizes(&self) -> [usize; 2] {
        let Some(known) = &self.outputs.reactions else {
            return [0; 2];
        };
        let column = self.states() - self.degrees_of_freedom();
        [
            known.functions.len() + known.distances.len(),
            known.first_column() + known.columns.len() * column,
        ]
    }

    /// Returns a value.
    pub fn value(&self, id: ValueId) -> &Value {
        &self.values[id.0]
    }

    /// Returns every value, operands first.
    pub fn ids(&self) -> impl Iterator<Item = ValueId> + use<> {
        (0..self.values.len()).map(ValueId)
    }

    /// Returns the number of coordinates and modes.
    pub fn degrees_of_freedom(&self) -> usize {
        self.coordinates.len() + self.fields.iter().map(|f| f.order).sum::<usize>()
    }

    /// Returns the number of states: coordinates, modes, the rates of both, and first-order states.
    pub fn states(&self) -> usize {
        2 * self.degrees_of_freedom() + self.first_order.len()
    }

    /// Returns the names of the states in their order; a rate has the name of its coordinate with `_dot`.
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

    /// Returns the independent parameters of the specification in SI units.
    pub fn default_parameters(&self) -> Vec<f64> {
        self.parameters.iter().map(|p| p.value).collect()
    }

    /// Returns the index in the state of a field's first modal coordinate.
    pub fn mode_offset(&self, field: FieldId) -> usize {
        self.coordinates.len()
            + self.fields[..field.index()]
                .iter()
                .map(|f| f.order)
                .sum::<usize>()
    }

    /// Returns the number of components of a point: time, state, inputs and independent parameters.
    pub fn point_length(&self) -> usize {
        1 + self.states() + self.inputs.len() + self.parameters.len()
    }

    /// Returns the index of a variable in a point; for a field, the index of its first mode.
    pub fn point_place(&self, variable: Variable) -> usize {
        let before = match variable {
            Variable::Time => 0,
            Variable::Input(_) => 1 + self.states(),
            Variable::Parameter(_) => 1 + self.states() + self.inputs.len(),
            _ => 1,
        };
        before + self.variable_place(variable)
    }

    /// Returns the index of a variable in the state, among the inputs, or among the independent parameters; for a
    /// field, the index of its first mode.
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

    /// Returns the values of the accelerations and of the rates of the first-order states.
    pub fn rate_roots(&self) -> Vec<ValueId> {
        let mut roots = self.accelerations.all();
        roots.extend(&self.first_order_rates);
        roots
    }

    /// Returns every value that `roots` depend on, in the order of the program.
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

    /// Returns true if the mass matrix can lose its positive definiteness in some states, because a pivot is computed
    /// in each call. The accelerations are NaN in such states.
    pub fn may_lose_definiteness(&self) -> bool {
        let is_pivot = |op: &Op| matches!(op, Op::PivotReciprocal(_) | Op::Cholesky(_));
        let accelerations = self.per_call(&self.rate_roots());
        accelerations.iter().any(|id| is_pivot(&self.value(*id).op))
    }

    /// Returns the values that `roots` depend on, without prepared values.
    pub fn per_call(&self, roots: &[ValueId]) -> Vec<ValueId> {
        self.reachable(roots)
            .into_iter()
            .filter(|id| !self.value(*id).parameter_only)
            .collect()
    }
}
