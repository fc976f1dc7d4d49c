//! Variables of the equations and additional arguments of outputs.

use eomgen_model_spec::ids::{CoordinateId, FieldId, InputId, ParameterId, StateId};

/// Variable of the equations, or the variables of all modes of a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Variable {
    /// Generalised coordinate.
    Coordinate(CoordinateId),
    /// Modal coordinates of a field.
    ModeCoordinates(FieldId),
    /// Rate of a generalised coordinate.
    Rate(CoordinateId),
    /// Rates of a field's modal coordinates.
    ModeRates(FieldId),
    /// First-order state.
    State(StateId),
    /// Input.
    Input(InputId),
    /// Parameter; in a program, its index among the independent parameters.
    Parameter(ParameterId),
    /// Time.
    Time,
}

/// Additional argument of an output, with one number for each variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Argument {
    /// Accelerations, in the order of the coordinates.
    Accelerations,
    /// Direction in the space of states and inputs.
    Direction,
    /// Direction in the space of time, state, inputs and independent parameters.
    PointDirection,
    /// Weight of each rate of the state, in the order of the state.
    Weights,
    /// Sides of the frictions that can stick, from 0 to 1. The variable is the input whose index is the index of the
    /// friction.
    Sides,
}
