//! The hash-consed expression graph: every distinct expression stands in it once, so
//! that differentiation and emission work on shared parts and nothing is expanded.
//!
//! A node is a scalar, a vector over an index space (a field's modes, or its quadrature
//! nodes) or a matrix over two of them; element-wise operations broadcast scalars. Sums
//! over modes therefore stay sums: the graph has the same size for any order. What the
//! operations mean is here; how they simplify is in `simplify`, their derivatives in
//! `differentiate`.

use std::collections::{HashMap, HashSet};

use model_spec::model::Function;

use crate::tables::{Table, TableKind};

/// A node of a [`Graph`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Id(pub(crate) u32);

/// An index space.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Space {
    /// The modes of a field.
    Modes(usize),
    /// The quadrature nodes along a field.
    Nodes(usize),
}

/// The shape of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Shape {
    /// One number.
    Scalar,
    /// One number per index.
    Vector(Space),
    /// One number per pair of indices (rows, columns).
    Matrix(Space, Space),
}

/// A floating-point number that can be hashed: compared by its bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Bits(u64);

impl Bits {
    /// The number as bits; -0 becomes 0 so that both are one constant.
    pub fn new(value: f64) -> Self {
        Self((value + 0.0).to_bits())
    }

    /// The number.
    pub fn value(self) -> f64 {
        f64::from_bits(self.0)
    }
}

/// What a node computes.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Operation {
    /// A number.
    Constant(Bits),
    /// A parameter, independent or derived.
    Parameter(usize),
    /// A generalised coordinate.
    Coordinate(usize),
    /// The rate of a generalised coordinate.
    Rate(usize),
    /// A signal supplied at run time.
    Input(usize),
    /// The time.
    Time,
    /// A field's mode coordinates, a vector.
    ModeCoordinates(usize),
    /// The rates of a field's mode coordinates, a vector.
    ModeRates(usize),
    /// A table of constants: a vector or a matrix.
    Table(usize),
    /// A linear combination with numeric factors, in the order of the nodes; the
    /// constant 1 as a node carries a constant term.
    Sum(Box<[(Bits, Id)]>),
    /// A product of integer powers, in the order of the nodes.
    Product(Box<[(Id, i32)]>),
    /// A function applied element by element.
    Call(Function, Box<[Id]>),
    /// A real power `base^exponent` with an exponent that is no integer literal.
    Power(Id, Id),
    /// `if a > b { then } else { otherwise }`.
    Select {
        /// Compared.
        a: Id,
        /// Compared with.
        b: Id,
        /// Value where a > b.
        then: Id,
        /// Value elsewhere.
        otherwise: Id,
    },
    /// The sum of a vector's elements.
    Total(Id),
    /// A matrix, or its transpose, times a vector.
    Apply {
        /// The matrix.
        matrix: Id,
        /// Whether its transpose is meant.
        transposed: bool,
        /// The vector.
        vector: Id,
    },
    /// left^T diag(weight) right, for tables over quadrature nodes.
    Gram {
        /// Matrix nodes x modes.
        left: Id,
        /// Vector over the nodes.
        weight: Id,
        /// Matrix nodes x modes.
        right: Id,
    },
    /// The diagonal of left^T diag(weight) right.
    GramDiagonal {
        /// Matrix nodes x modes.
        left: Id,
        /// Vector over the nodes.
        weight: Id,
        /// Matrix nodes x modes.
        right: Id,
    },
    /// A matrix put together from a diagonal, outer products u v^T and
    /// row-scaled and column-scaled matrices.
    Assemble(Box<Assembly>),
    /// The lower Cholesky factor of a symmetric positive definite matrix. A pivot that
    /// is not positive makes the factor NaN.
    Cholesky(Id),
    /// The solution of a system by its Cholesky factor; the right side is a vector, a scalar
    /// that stands for one, or a matrix.
    CholeskySolve(Id, Id),
    /// The reciprocal of a pivot, NaN where it is not positive.
    PivotReciprocal(Id),
}

/// The parts of an assembled matrix.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Assembly {
    /// Index space of the rows.
    pub rows: Space,
    /// Index space of the columns.
    pub columns: Space,
    /// The diagonal, a vector or a scalar; only of a square matrix.
    pub diagonal: Option<Id>,
    /// Outer products u v^T.
    pub outer: Vec<(Id, Id)>,
    /// diag(row) matrix diag(column), the matrix transposed if so said.
    pub matrices: Vec<ScaledMatrix>,
}

/// diag(row) matrix diag(column).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ScaledMatrix {
    /// Scales the rows: scalar or vector.
    pub row: Id,
    /// The matrix.
    pub matrix: Id,
    /// Whether its transpose is meant.
    pub transposed: bool,
    /// Scales the columns: scalar or vector.
    pub column: Id,
}

/// What a node depends on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dependence(u8);

impl Dependence {
    pub(crate) const NONE: Self = Self(0);
    pub(crate) const PARAMETER: Self = Self(1);
    pub(crate) const COORDINATE: Self = Self(2);
    pub(crate) const RATE: Self = Self(4);
    pub(crate) const INPUT: Self = Self(8);
    pub(crate) const TIME: Self = Self(16);

    fn join(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Whether it depends on anything in `kinds`.
    pub fn has(self, kinds: Self) -> bool {
        self.0 & kinds.0 != 0
    }

    /// Whether it depends on nothing but parameters and constants.
    pub fn is_prepared(self) -> bool {
        self.0 & !Self::PARAMETER.0 == 0
    }
}

struct Entry {
    operation: Operation,
    shape: Shape,
    dependence: Dependence,
}

/// The graph of one variant: its nodes, constant tables and the sizes of its spaces.
pub struct Graph {
    entries: Vec<Entry>,
    known: HashMap<Operation, Id>,
    tables: Vec<Table>,
    orders: Vec<usize>,
    names: HashMap<Id, String>,
    taken: HashSet<String>,
}

impl Graph {
    /// An empty graph for fields of these orders.
    pub fn new(orders: &[usize]) -> Self {
        Self {
            entries: Vec::new(),
            known: HashMap::new(),
            tables: Vec::new(),
            orders: orders.to_vec(),
            names: HashMap::new(),
            taken: HashSet::new(),
        }
    }

    /// Keeps names from being given to nodes: those of the specification's quantities.
    pub fn reserve_names<'n>(&mut self, names: impl Iterator<Item = &'n String>) {
        self.taken.extend(names.cloned());
    }

    /// The order of each field.
    pub fn orders(&self) -> &[usize] {
        &self.orders
    }

    /// How many indices a space has.
    pub fn size(&self, space: Space) -> usize {
        match space {
            Space::Modes(field) => self.orders[field],
            Space::Nodes(field) => crate::tables::quadrature_size(self.orders[field]),
        }
    }

    /// How many numbers a node of this shape holds.
    pub fn length(&self, shape: Shape) -> usize {
        match shape {
            Shape::Scalar => 1,
            Shape::Vector(space) => self.size(space),
            Shape::Matrix(rows, columns) => self.size(rows) * self.size(columns),
        }
    }

    /// What a node computes.
    pub fn operation(&self, id: Id) -> &Operation {
        &self.entries[id.0 as usize].operation
    }

    /// A node's shape.
    pub fn shape(&self, id: Id) -> Shape {
        self.entries[id.0 as usize].shape
    }

    /// What a node depends on.
    pub fn dependence(&self, id: Id) -> Dependence {
        self.entries[id.0 as usize].dependence
    }

    /// A table of constants.
    pub fn table(&self, index: usize) -> &Table {
        &self.tables[index]
    }

    /// How many nodes there are.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// The name a node was given by the specification, if any.
    pub fn name(&self, id: Id) -> Option<&str> {
        self.names.get(&id).map(String::as_str)
    }

    /// Names a node after a quantity of the specification. Leaves keep their own names, a
    /// node its first.
    pub fn set_name(&mut self, id: Id, name: &str) {
        let compound = !self.operands(self.operation(id)).is_empty();
        if compound && !self.names.contains_key(&id) {
            self.taken.insert(name.to_owned());
            self.names.insert(id, name.to_owned());
        }
    }

    /// Names a node, unless the name is in use.
    pub fn suggest_name(&mut self, id: Id, name: &str) {
        if !self.taken.contains(name) {
            self.set_name(id, name);
        }
    }

    /// The node of an operation that needs no simplification.
    pub(crate) fn intern(&mut self, operation: Operation) -> Id {
        if let Some(&id) = self.known.get(&operation) {
            return id;
        }
        let shape = self.shape_of(&operation);
        let dependence = self.dependence_of(&operation);
        let id = Id(self.entries.len() as u32);
        self.known.insert(operation.clone(), id);
        self.entries.push(Entry {
            operation,
            shape,
            dependence,
        });
        id
    }

    /// The node of a table of constants.
    pub fn constants(
        &mut self,
        field: usize,
        kind: TableKind,
        values: impl FnOnce() -> Vec<f64>,
    ) -> Id {
        let index = match self
            .tables
            .iter()
            .position(|t| t.field == field && t.kind == kind)
        {
            Some(index) => index,
            None => {
                self.tables.push(Table {
                    field,
                    kind,
                    values: values(),
                });
                self.tables.len() - 1
            }
        };
        self.intern(Operation::Table(index))
    }

    fn shape_of(&self, operation: &Operation) -> Shape {
        match operation {
            Operation::Constant(_)
            | Operation::Parameter(_)
            | Operation::Coordinate(_)
            | Operation::Rate(_)
            | Operation::Input(_)
            | Operation::Time
            | Operation::Total(_) => Shape::Scalar,
            Operation::ModeCoordinates(field) | Operation::ModeRates(field) => {
                Shape::Vector(Space::Modes(*field))
            }
            Operation::Table(index) => self.tables[*index].shape(),
            Operation::Apply {
                matrix, transposed, ..
            } => match (self.shape(*matrix), transposed) {
                (Shape::Matrix(rows, _), false) => Shape::Vector(rows),
                (Shape::Matrix(_, columns), true) => Shape::Vector(columns),
                (other, _) => other,
            },
            Operation::Gram { left, right, .. } => match (self.shape(*left), self.shape(*right)) {
                (Shape::Matrix(_, a), Shape::Matrix(_, b)) => Shape::Matrix(a, b),
                (other, _) => other,
            },
            Operation::GramDiagonal { left, .. } => match self.shape(*left) {
                Shape::Matrix(_, columns) => Shape::Vector(columns),
                other => other,
            },
            Operation::Assemble(assembly) => Shape::Matrix(assembly.rows, assembly.columns),
            Operation::Cholesky(matrix) => self.shape(*matrix),
            Operation::CholeskySolve(factor, right) => {
                match (self.shape(*factor), self.shape(*right)) {
                    (Shape::Matrix(rows, _), Shape::Matrix(_, columns)) => {
                        Shape::Matrix(rows, columns)
                    }
                    (Shape::Matrix(rows, _), _) => Shape::Vector(rows),
                    (other, _) => other,
                }
            }
            Operation::Sum(_)
            | Operation::Product(_)
            | Operation::Call(..)
            | Operation::Power(..)
            | Operation::PivotReciprocal(_)
            | Operation::Select { .. } => self
                .operands(operation)
                .into_iter()
                .map(|id| self.shape(id))
                .find(|shape| *shape != Shape::Scalar)
                .unwrap_or(Shape::Scalar),
        }
    }

    fn dependence_of(&self, operation: &Operation) -> Dependence {
        match operation {
            Operation::Parameter(_) => Dependence::PARAMETER,
            Operation::Coordinate(_) | Operation::ModeCoordinates(_) => Dependence::COORDINATE,
            Operation::Rate(_) | Operation::ModeRates(_) => Dependence::RATE,
            Operation::Input(_) => Dependence::INPUT,
            Operation::Time => Dependence::TIME,
            _ => self
                .operands(operation)
                .into_iter()
                .map(|id| self.dependence(id))
                .fold(Dependence::NONE, Dependence::join),
        }
    }

    /// The nodes an operation reads.
    pub fn operands(&self, operation: &Operation) -> Vec<Id> {
        match operation {
            Operation::Constant(_)
            | Operation::Parameter(_)
            | Operation::Coordinate(_)
            | Operation::Rate(_)
            | Operation::Input(_)
            | Operation::Time
            | Operation::ModeCoordinates(_)
            | Operation::ModeRates(_)
            | Operation::Table(_) => Vec::new(),
            Operation::Sum(terms) => terms.iter().map(|(_, id)| *id).collect(),
            Operation::Product(factors) => factors.iter().map(|(id, _)| *id).collect(),
            Operation::Call(_, arguments) => arguments.to_vec(),
            Operation::Select {
                a,
                b,
                then,
                otherwise,
            } => vec![*a, *b, *then, *otherwise],
            Operation::Total(a) | Operation::Cholesky(a) | Operation::PivotReciprocal(a) => {
                vec![*a]
            }
            Operation::Power(a, b) | Operation::CholeskySolve(a, b) => vec![*a, *b],
            Operation::Apply { matrix, vector, .. } => vec![*matrix, *vector],
            Operation::Gram {
                left,
                weight,
                right,
            }
            | Operation::GramDiagonal {
                left,
                weight,
                right,
            } => vec![*left, *weight, *right],
            Operation::Assemble(assembly) => assembly.operands(),
        }
    }

    /// Every node that `roots` are computed from, operands first.
    pub fn reachable(&self, roots: &[Id]) -> Vec<Id> {
        let mut needed = vec![false; self.entries.len()];
        for root in roots {
            needed[root.0 as usize] = true;
        }
        for index in (0..self.entries.len()).rev() {
            if needed[index] {
                for operand in self.operands(&self.entries[index].operation) {
                    needed[operand.0 as usize] = true;
                }
            }
        }
        (0..self.entries.len())
            .filter(|&index| needed[index])
            .map(|index| Id(index as u32))
            .collect()
    }
}

impl Assembly {
    fn operands(&self) -> Vec<Id> {
        let mut all: Vec<Id> = self.diagonal.into_iter().collect();
        all.extend(self.outer.iter().flat_map(|(u, v)| [*u, *v]));
        all.extend(
            self.matrices
                .iter()
                .flat_map(|m| [m.row, m.matrix, m.column]),
        );
        all
    }
}
