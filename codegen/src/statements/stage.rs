//! What a stage is beside its statements: its name, what it is called with and what comes of it.

use super::expression::Expression;
use super::statement::Statement;

/// What a stage is called with beside time, state, inputs and coefficients.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Argument {
    /// The number of a regime.
    Regime,
    /// An acceleration for each degree of freedom.
    Accelerations,
    /// A direction of the state.
    Direction,
    /// A direction of the inputs.
    InputDirection,
    /// A direction of time, state, inputs and parameters.
    PointDirection,
    /// A weight for each rate.
    Weights,
}

/// How many numbers come of a stage.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Size {
    /// As many as the state has.
    States,
    /// As many as there are degrees of freedom.
    DegreesOfFreedom,
    /// As many as there are guards.
    Guards,
    /// As many as there are parameters.
    Parameters,
    /// As many as time, state, inputs and parameters have.
    Point,
    /// As many as the Jacobian of this name has structural nonzeros.
    Nonzeros(&'static str),
}

/// What comes of a stage.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// The rates of the state, of which every one is written.
    Rates,
    /// A number.
    Number(Expression),
    /// The observables.
    Observables(Vec<Expression>),
    /// An array of zeros of this name, to which the last statements write.
    Array(&'static str, Size),
    /// A square matrix of zeros, `values`, to which the last statements write.
    MassMatrix,
    /// An array of zeros, `product`, as long as the state, to which the last statements write,
    /// and a number for each input by its name.
    ArrayAndInputs(Vec<(String, Expression)>),
}

/// A function that is called with prepared coefficients.
#[derive(Clone, Debug)]
pub struct Stage {
    /// Its name.
    pub name: &'static str,
    /// What it is, by lines, with links in brackets to other items by their names in Rust.
    pub doc: String,
    /// What its numbers are, an item each: text of the specification.
    pub list: Vec<String>,
    /// What it is called with.
    pub arguments: Vec<Argument>,
    /// What comes of it.
    pub outcome: Outcome,
    /// What is computed.
    pub computed: Vec<Statement>,
    /// What is written to the outcome.
    pub written: Vec<Statement>,
}
