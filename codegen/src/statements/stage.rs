//! Name, arguments and result of a stage.

use std::collections::HashMap;

use super::expression::Expression;
use super::statement::Statement;

/// Argument of a stage, in addition to time, state, inputs and coefficients.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Argument {
    /// Number of a regime.
    Regime,
    /// Acceleration of each degree of freedom.
    Accelerations,
    /// Direction of the state.
    Direction,
    /// Direction of the inputs.
    InputDirection,
    /// Direction of time, state, inputs and parameters.
    PointDirection,
    /// Weight of each rate.
    Weights,
    /// Side of each dry friction that can stick.
    Sides,
}

/// Length of an array that a stage returns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Size {
    /// Number of states.
    States,
    /// Number of degrees of freedom.
    DegreesOfFreedom,
    /// Number of guards.
    Guards,
    /// Number of parameters.
    Parameters,
    /// Number of components of time, state, inputs and parameters together.
    Point,
    /// Number of structural nonzeros of the Jacobian with this name.
    Nonzeros(&'static str),
    /// Number of functions and distances of the reactions.
    ReactionFunctions,
    /// Number of effects and columns of the reactions.
    ReactionEffects,
}

/// Result of a stage.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// Rates of the state, all assigned.
    Rates,
    /// Number.
    Number(Expression),
    /// Observables.
    Observables(Vec<Expression>),
    /// Array of this name, filled with zeros before the last statements assign its elements.
    Array(&'static str, Size),
    /// Square matrix `values`, filled with zeros before the last statements assign its elements.
    MassMatrix,
    /// Array `product` with one element for each state, filled with zeros before the last statements assign
    /// its elements, and one number for each input by name.
    ArrayAndInputs(Vec<(String, Expression)>),
}

/// Unit and terms of the values with a name, for comments.
pub type Notes = HashMap<String, String>;

/// Function called with prepared coefficients.
#[derive(Clone, Debug)]
pub struct Stage {
    /// Name.
    pub name: &'static str,
    /// Documentation lines; names of other items in brackets are links, in their Rust form.
    pub doc: String,
    /// Description of each number, from the specification.
    pub list: Vec<String>,
    /// Additional arguments.
    pub arguments: Vec<Argument>,
    /// Result.
    pub outcome: Outcome,
    /// Statements that compute the values.
    pub computed: Vec<Statement>,
    /// Statements that write the result.
    pub written: Vec<Statement>,
    /// Units and terms of the named values.
    pub notes: Notes,
}
