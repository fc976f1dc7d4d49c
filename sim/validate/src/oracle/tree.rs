//! Expression tree of the oracle. Parameters are numbers, and positions are indices of nodes.

use eomgen_model_spec::ast::BinaryOperator;
use eomgen_model_spec::model::Function;
use std::collections::BTreeSet;

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Tree {
    /// Value of a literal, a parameter or a constant expression.
    Constant(f64),
    /// One number per mode of a field, selected by the index of the enclosing sum.
    PerMode {
        field: usize,
        values: Vec<f64>,
    },
    Time,
    /// Input without a given rate, or the last given rate of an input.
    Input(usize),
    PrescribedInput {
        input: usize,
        rate: usize,
        /// Index of the input that is its second derivative, if given.
        second: Option<usize>,
    },
    /// Position of the current node in the innermost enclosing set, in m (or the unit of the field's domain).
    Position {
        set: usize,
    },
    Coordinate(usize),
    State(usize),
    StateRate(usize),
    Multiplier(usize),
    Definition(usize),
    /// Field, or its derivative by the position, at the current node.
    Field {
        leaf: Leaf,
        set: usize,
    },
    /// Modal coordinate at the index of the enclosing sum.
    Mode {
        field: usize,
    },
    /// Mode shape, or its derivative, at the current node and mode index.
    Shape {
        leaf: Leaf,
        set: usize,
    },
    Dot(Box<Tree>),
    /// Weighted sum of `body` over a set of positions: an integral, or a value at a point.
    Places {
        set: usize,
        body: Box<Tree>,
        /// Index of the cached derivatives of this integral in `integrals`, if any.
        integral: Option<usize>,
    },
    Sum {
        field: usize,
        body: Box<Tree>,
    },
    Negate(Box<Tree>),
    Binary(BinaryOperator, Box<Tree>, Box<Tree>),
    Power(Box<Tree>, f64),
    Call(Function, Vec<Tree>),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Leaf {
    pub field: usize,
    pub derivative: u8,
}

#[derive(Clone, Debug, Default)]
pub(super) struct Dependence {
    /// Coordinates other than modes.
    pub coordinates: BTreeSet<usize>,
    /// Fields whose modes or values appear in the expression.
    pub fields: BTreeSet<usize>,
    pub states: BTreeSet<usize>,
    /// Field values at the current node of the enclosing set.
    pub leaves: BTreeSet<Leaf>,
    /// Fields with a free sum index.
    pub indices: BTreeSet<usize>,
    /// True if the expression contains the position of the current node.
    pub has_position: bool,
    pub has_time: bool,
    pub has_input: bool,
    /// True if the expression contains an input with a given rate, or a given rate.
    pub has_prescribed_input: bool,
    pub has_dot: bool,
    pub has_nested_operator: bool,
}

impl Dependence {
    pub fn is_constant(&self) -> bool {
        let sets = self.coordinates.is_empty() && self.fields.is_empty() && self.states.is_empty();
        sets && !self.has_time && !self.has_input && !self.has_prescribed_input
    }

    fn include(&mut self, other: &Self) {
        self.coordinates.extend(&other.coordinates);
        self.fields.extend(&other.fields);
        self.states.extend(&other.states);
        self.leaves.extend(&other.leaves);
        self.indices.extend(&other.indices);
        self.has_position |= other.has_position;
        self.has_time |= other.has_time;
        self.has_input |= other.has_input;
        self.has_prescribed_input |= other.has_prescribed_input;
        self.has_dot |= other.has_dot;
        self.has_nested_operator |= other.has_nested_operator;
    }
}

impl Tree {
    /// Returns the dependence of this expression; `definitions` are in the order of the model.
    pub fn dependence(&self, definitions: &[Dependence]) -> Dependence {
        let mut found = Dependence::default();
        for child in self.children() {
            found.include(&child.dependence(definitions));
        }
        self.complete_dependence(&mut found, definitions);
        found
    }

    /// Adds the dependence of this node to the dependence of its operands.
    fn complete_dependence(&self, found: &mut Dependence, definitions: &[Dependence]) {
        match self {
            Self::PerMode { field, .. } => drop(found.indices.insert(*field)),
            // A multiplier depends on all of the motion.
            Self::Time | Self::Multiplier(_) => found.has_time = true,
            Self::Input(_) => found.has_input = true,
            Self::PrescribedInput { .. } => found.has_prescribed_input = true,
            Self::Position { .. } => found.has_position = true,
            Self::Coordinate(index) => drop(found.coordinates.insert(*index)),
            Self::State(index) | Self::StateRate(index) => drop(found.states.insert(*index)),
            Self::Definition(index) => {
                if let Some(definition) = definitions.get(*index) {
                    found.include(definition);
                }
            }
            Self::Field { leaf, .. } => {
                found.fields.insert(leaf.field);
                found.leaves.insert(*leaf);
            }
            Self::Mode { field } => {
                found.fields.insert(*field);
                found.indices.insert(*field);
            }
            Self::Shape { leaf, .. } => {
                found.indices.insert(leaf.field);
                found.has_position = true;
            }
            Self::Dot(_) => found.has_dot = true,
            Self::Places { .. } => {
                found.has_position = false;
                found.leaves.clear();
                found.has_nested_operator = true;
            }
            Self::Sum { field, .. } => {
                found.indices.remove(field);
                found.has_nested_operator = true;
            }
            _ => {}
        }
    }

    /// Splits a sum into its addends. Any other expression is returned as a single addend.
    pub fn into_addends(self) -> Vec<Tree> {
        match self {
            Self::Binary(BinaryOperator::Add, left, right) => {
                [left.into_addends(), right.into_addends()].concat()
            }
            Self::Binary(BinaryOperator::Subtract, left, right) => {
                [left.into_addends(), Self::Negate(right).into_addends()].concat()
            }
            Self::Negate(operand) => {
                let addends = operand.into_addends().into_iter();
                addends.map(|addend| Self::Negate(addend.into())).collect()
            }
            other => vec![other],
        }
    }

    pub fn children(&self) -> Vec<&Tree> {
        match self {
            Self::Dot(operand) | Self::Negate(operand) | Self::Power(operand, _) => vec![operand],
            Self::Places { body, .. } | Self::Sum { body, .. } => vec![body],
            Self::Binary(_, left, right) => vec![left, right],
            Self::Call(_, arguments) => arguments.iter().collect(),
            _ => Vec::new(),
        }
    }
}
