//! The oracle's own form of an expression: parameters are numbers, positions are lists
//! of nodes, constants are folded. Made by `lower`, evaluated by `evaluate`. Nothing is
//! differentiated here.

use eomgen_model_spec::ast::BinaryOperator;
use eomgen_model_spec::model::Function;
use std::collections::BTreeSet;

/// An expression of the state, the time and the inputs.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Tree {
    /// A number: a literal, a parameter, or what is made of them alone.
    Constant(f64),
    /// A number for each mode of a field, taken at the index of the enclosing sum.
    PerMode {
        /// The field whose sum is meant.
        field: usize,
        /// One value per mode.
        values: Vec<f64>,
    },
    /// The time.
    Time,
    /// An input that is held, or of which no further rate is given.
    Input(usize),
    /// An input whose rate is given.
    PrescribedInput {
        /// The input.
        input: usize,
        /// The input that is its rate.
        rate: usize,
        /// The input that is the rate of that, if it is given.
        second: Option<usize>,
    },
    /// The position in the innermost enclosing place set, in m (or the field's unit of x).
    Position {
        /// The place set.
        set: usize,
    },
    /// A coordinate that is no mode, by its place in the state.
    Coordinate(usize),
    /// A state of first order, by its place among them.
    State(usize),
    /// The rate of a state of first order.
    StateRate(usize),
    /// The multiplier of a constraint.
    Multiplier(usize),
    /// A definition.
    Definition(usize),
    /// A field, or its derivative by the position, at the current place.
    Field {
        /// Which leaf.
        leaf: Leaf,
        /// The place set it is read from.
        set: usize,
    },
    /// A mode coordinate at the index of the enclosing sum.
    Mode {
        /// The field.
        field: usize,
    },
    /// A mode shape, or its derivative, at the current place and index.
    Shape {
        /// Field and order of the derivative.
        leaf: Leaf,
        /// The place set it is read from.
        set: usize,
    },
    /// The time derivative.
    Dot(Box<Tree>),
    /// The weighted sum of `body` over a place set: an integral, or a value at a point.
    Places {
        /// The place set.
        set: usize,
        /// What is summed.
        body: Box<Tree>,
        /// Where `integrals` keeps its derivatives, if it can.
        integral: Option<usize>,
    },
    /// The sum over a field's modes.
    Sum {
        /// The field.
        field: usize,
        /// What is summed.
        body: Box<Tree>,
    },
    /// `-operand`.
    Negate(Box<Tree>),
    /// `left operator right`.
    Binary(BinaryOperator, Box<Tree>, Box<Tree>),
    /// A power with a constant exponent.
    Power(Box<Tree>, f64),
    /// A function of one or two arguments.
    Call(Function, Vec<Tree>),
}

/// The derivative of order `derivative` of a field by its position.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Leaf {
    /// The field.
    pub field: usize,
    /// The order of the derivative, 0 for the field itself.
    pub derivative: u8,
}

/// What an expression depends on.
#[derive(Clone, Debug, Default)]
pub(super) struct Dependence {
    /// Coordinates that are no modes.
    pub coordinates: BTreeSet<usize>,
    /// Fields, through their modes or their values.
    pub fields: BTreeSet<usize>,
    /// States of first order, through their values or their rates.
    pub states: BTreeSet<usize>,
    /// Field values at the place around the expression.
    pub leaves: BTreeSet<Leaf>,
    /// Fields whose sum's index is used and not bound inside.
    pub indices: BTreeSet<usize>,
    /// The position around the expression.
    pub position: bool,
    /// The time, explicitly.
    pub time: bool,
    /// An input whose rate is not given.
    pub input: bool,
    /// An input whose rate is given, or such a rate.
    pub prescribed: bool,
    /// A time derivative is taken inside.
    pub dot: bool,
    /// It holds a sum over places or modes, itself or in a definition.
    pub nested: bool,
}

impl Dependence {
    /// Nothing that changes with the state, the time or the inputs.
    pub fn is_constant(&self) -> bool {
        let sets = self.coordinates.is_empty() && self.fields.is_empty() && self.states.is_empty();
        sets && !self.time && !self.input && !self.prescribed
    }

    fn absorb(&mut self, other: &Self) {
        self.coordinates.extend(&other.coordinates);
        self.fields.extend(&other.fields);
        self.states.extend(&other.states);
        self.leaves.extend(&other.leaves);
        self.indices.extend(&other.indices);
        self.position |= other.position;
        self.time |= other.time;
        self.input |= other.input;
        self.prescribed |= other.prescribed;
        self.dot |= other.dot;
        self.nested |= other.nested;
    }
}

impl Tree {
    /// What this expression depends on; `definitions` in the order of the model.
    pub fn dependence(&self, definitions: &[Dependence]) -> Dependence {
        let mut found = Dependence::default();
        for child in self.children() {
            found.absorb(&child.dependence(definitions));
        }
        self.amend(&mut found, definitions);
        found
    }

    /// From what the parts depend on to what the whole depends on.
    fn amend(&self, found: &mut Dependence, definitions: &[Dependence]) {
        match self {
            Self::PerMode { field, .. } => drop(found.indices.insert(*field)),
            // It changes with all that moves.
            Self::Time | Self::Multiplier(_) => found.time = true,
            Self::Input(_) => found.input = true,
            Self::PrescribedInput { .. } => found.prescribed = true,
            Self::Position { .. } => found.position = true,
            Self::Coordinate(index) => drop(found.coordinates.insert(*index)),
            Self::State(index) | Self::StateRate(index) => drop(found.states.insert(*index)),
            Self::Definition(index) => {
                if let Some(definition) = definitions.get(*index) {
                    found.absorb(definition);
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
                found.position = true;
            }
            Self::Dot(_) => found.dot = true,
            Self::Places { .. } => {
                found.position = false;
                found.leaves.clear();
                found.nested = true;
            }
            Self::Sum { field, .. } => {
                found.indices.remove(field);
                found.nested = true;
            }
            _ => {}
        }
    }

    /// The addends of a sum; anything else is its own only addend.
    pub fn addends(self) -> Vec<Tree> {
        match self {
            Self::Binary(BinaryOperator::Add, left, right) => {
                [left.addends(), right.addends()].concat()
            }
            Self::Binary(BinaryOperator::Subtract, left, right) => {
                [left.addends(), Self::Negate(right).addends()].concat()
            }
            Self::Negate(operand) => {
                let addends = operand.addends().into_iter();
                addends.map(|addend| Self::Negate(addend.into())).collect()
            }
            other => vec![other],
        }
    }

    /// The operands.
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
