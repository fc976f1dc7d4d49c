//! The program: its values, quantities, rows and blocks.

use model_spec::model::Function;

use crate::mechanics::outputs::Outputs;
use crate::symbolic::arguments::Arguments;
use crate::symbolic::graph::{Argument, Variable};

/// A value of a [`Program`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ValueId(pub(crate) usize);

impl ValueId {
    /// The value's place in the program's list.
    pub fn index(self) -> usize {
        self.0
    }
}

/// How many numbers a value holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Extent {
    /// One.
    Scalar,
    /// One per index.
    Vector(usize),
    /// Rows times columns, row by row.
    Matrix(usize, usize),
}

impl Extent {
    /// How many numbers.
    pub fn length(self) -> usize {
        match self {
            Self::Scalar => 1,
            Self::Vector(n) => n,
            Self::Matrix(rows, columns) => rows * columns,
        }
    }

    /// How many numbers stand in a row: one, but for a matrix.
    pub fn columns(self) -> usize {
        match self {
            Self::Scalar | Self::Vector(_) => 1,
            Self::Matrix(_, columns) => columns,
        }
    }
}

/// How many partial sums a long sum has: enough that an addition need not wait for the one
/// before it, and for the widest vectors.
pub const PARTIAL_SUMS: usize = 8;

/// How a value is computed.
#[derive(Clone, Debug, PartialEq)]
pub enum Op {
    /// A number.
    Constant(f64),
    /// A table of numbers, by its place in [`Program::tables`].
    Table(usize),
    /// An independent parameter, by its place in [`Program::parameters`].
    Parameter(usize),
    /// A coordinate of the state.
    Coordinate(usize),
    /// The rate of a coordinate.
    Rate(usize),
    /// A field's mode coordinates.
    ModeCoordinates(usize),
    /// The rates of a field's mode coordinates.
    ModeRates(usize),
    /// An input.
    Input(usize),
    /// The time.
    Time,
    /// What an argument holds for a variable.
    Argument(Argument, Variable),
    /// -a
    Negate(ValueId),
    /// a + b
    Add(ValueId, ValueId),
    /// a - b
    Subtract(ValueId, ValueId),
    /// a b
    Multiply(ValueId, ValueId),
    /// a / b
    Divide(ValueId, ValueId),
    /// a^b
    Power(ValueId, ValueId),
    /// A function of one or two arguments.
    Call(Function, Arguments<ValueId>),
    /// `if a > b { then } else { otherwise }`
    Select {
        /// Compared.
        a: ValueId,
        /// Compared with.
        b: ValueId,
        /// Value where a > b.
        then: ValueId,
        /// Value elsewhere, also where a or b is NaN.
        otherwise: ValueId,
    },
    /// 1/a where a > 0, NaN elsewhere.
    PivotReciprocal(ValueId),
    /// The sum of the elements, 0 of none. The first [`PARTIAL_SUMS`] of them each begin a
    /// partial sum, to which every eighth element from there on is added in order. Then
    /// neighbours are added in pairs until one number is left; of an odd count the last
    /// passes on to the next round.
    Total(ValueId),
    /// Matrix (or its transpose) times vector; each element from 0 and the first product to
    /// the last.
    Apply {
        /// The matrix.
        matrix: ValueId,
        /// Whether its transpose is meant.
        transposed: bool,
        /// The vector.
        vector: ValueId,
    },
    /// left^T diag(weight) right: element (r, c) sums (left_gr * weight_g) * right_gc.
    Gram {
        /// Matrix nodes x rows.
        left: ValueId,
        /// Vector over the nodes.
        weight: ValueId,
        /// Matrix nodes x columns.
        right: ValueId,
    },
    /// The diagonal of the same.
    GramDiagonal {
        /// Matrix nodes x modes.
        left: ValueId,
        /// Vector over the nodes.
        weight: ValueId,
        /// Matrix nodes x modes.
        right: ValueId,
    },
    /// Element (r, c): the diagonal, then each outer product u_r v_c, then each
    /// (row_r * matrix_rc) * column_c, added in this order to 0.
    Assemble {
        /// The diagonal.
        diagonal: Option<ValueId>,
        /// Outer products.
        outer: Vec<(ValueId, ValueId)>,
        /// Scaled matrices.
        matrices: Vec<ScaledValue>,
    },
    /// Lower Cholesky factor, row by row; the upper part is 0. A pivot that is not
    /// positive gives NaN.
    Cholesky(ValueId),
    /// Forward, then backward substitution with a Cholesky factor, column by column.
    CholeskySolve(ValueId, ValueId),
}

/// diag(row) matrix diag(column)
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScaledValue {
    /// Scales the rows.
    pub row: ValueId,
    /// The matrix.
    pub matrix: ValueId,
    /// Whether its transpose is meant.
    pub transposed: bool,
    /// Scales the columns.
    pub column: ValueId,
}

impl Op {
    /// The values it reads.
    pub fn operands(&self) -> Vec<ValueId> {
        match self {
            Self::Constant(_)
            | Self::Table(_)
            | Self::Parameter(_)
            | Self::Coordinate(_)
            | Self::Rate(_)
            | Self::ModeCoordinates(_)
            | Self::ModeRates(_)
            | Self::Input(_)
            | Self::Time
            | Self::Argument(..) => Vec::new(),
            Self::Negate(a) | Self::PivotReciprocal(a) | Self::Total(a) | Self::Cholesky(a) => {
                vec![*a]
            }
            Self::Add(a, b)
            | Self::Subtract(a, b)
            | Self::Multiply(a, b)
            | Self::Divide(a, b)
            | Self::Power(a, b)
            | Self::CholeskySolve(a, b) => vec![*a, *b],
            Self::Call(_, arguments) => arguments.to_vec(),
            Self::Select {
                a,
                b,
                then,
                otherwise,
            } => vec![*a, *b, *then, *otherwise],
            Self::Apply { matrix, vector, .. } => vec![*matrix, *vector],
            Self::Gram {
                left,
                weight,
                right,
            }
            | Self::GramDiagonal {
                left,
                weight,
                right,
            } => vec![*left, *weight, *right],
            Self::Assemble {
                diagonal,
                outer,
                matrices,
            } => diagonal
                .iter()
                .copied()
                .chain(outer.iter().flat_map(|(u, v)| [*u, *v]))
                .chain(matrices.iter().flat_map(|m| [m.row, m.matrix, m.column]))
                .collect(),
        }
    }
}

/// One value.
#[derive(Clone, Debug)]
pub struct Value {
    /// How it is computed.
    pub op: Op,
    /// How many numbers it holds.
    pub extent: Extent,
    /// Whether it depends on parameters and constants alone: it belongs to the stage that is
    /// computed once for a set of parameters.
    pub parameter_only: bool,
    /// The specification's name for it, if it has one.
    pub name: Option<String>,
}

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

    /// Numbers in the state: coordinates, modes, and the rates of both.
    pub fn states(&self) -> usize {
        2 * self.degrees_of_freedom()
    }

    /// Names of the state in its order; a rate's is its coordinate's with `_dot`.
    pub fn state_names(&self) -> Vec<String> {
        let mut names: Vec<String> = self.coordinates.iter().map(|c| c.name.clone()).collect();
        for field in &self.fields {
            names.extend((1..=field.order).map(|i| format!("{}_{i}", field.coordinates)));
        }
        let rates: Vec<String> = names.iter().map(|name| format!("{name}_dot")).collect();
        names.extend(rates);
        names
    }

    /// The specification's values of the independent parameters, in SI.
    pub fn default_parameters(&self) -> Vec<f64> {
        self.parameters.iter().map(|p| p.value).collect()
    }

    /// Place in the state of a field's first mode coordinate.
    pub fn mode_offset(&self, field: usize) -> usize {
        self.coordinates.len() + self.fields[..field].iter().map(|f| f.order).sum::<usize>()
    }

    /// Place of a variable, or of the first of a field's, in the state, or among the inputs.
    pub fn variable_place(&self, variable: Variable) -> usize {
        match variable {
            Variable::Coordinate(index) | Variable::Input(index) => index,
            Variable::ModeCoordinates(field) => self.mode_offset(field),
            Variable::Rate(index) => self.degrees_of_freedom() + index,
            Variable::ModeRates(field) => self.degrees_of_freedom() + self.mode_offset(field),
        }
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
        let accelerations = self.per_call(&self.accelerations.all());
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
