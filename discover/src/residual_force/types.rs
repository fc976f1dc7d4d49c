//! What is told of a residual force.

use crate::ids::EquationId;
use crate::residual_force::equations::Equation;

/// Numbers with one standard deviation each, over something.
#[derive(Clone, Debug, Default)]
pub struct Profile {
    /// Over which, in SI, ascending.
    pub over: Vec<f64>,
    /// The force there, N or N m.
    pub values: Vec<f64>,
    /// One standard deviation.
    pub sd: Vec<f64>,
    /// The part of the squares that it explains; of several waves that which explains most.
    pub part: f64,
    /// The position of the wave that does.
    pub peak: Option<usize>,
}

/// How well a force in an equation does.
#[derive(Clone, Debug)]
pub struct RankedEquation {
    /// The equation.
    pub equation: EquationId,
    /// The part of the squares that a force over its rate explains, or over its position.
    pub by_state: f64,
    /// The same of a force over time that differs from window to window.
    pub by_time: f64,
}

/// What a force is a function of, as far as can be told.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// Its rate: so much of simple functions of it.
    Rate(Vec<SimplePart>),
    /// Its position.
    Position(Vec<SimplePart>),
    /// Neither.
    Time,
}

/// So much of a simple function, in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SimplePart {
    /// The function.
    pub function: Simple,
    /// How much of it.
    pub value: f64,
    /// One standard deviation.
    pub sd: f64,
}

/// Simple functions of a rate or a position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Simple {
    /// The same everywhere.
    Constant,
    /// The sign.
    Sign,
    /// In proportion.
    Linear,
    /// In proportion to the size.
    Size,
    /// With the square and the sign.
    Square,
}

/// The residual force of a fit.
pub struct ResidualForce {
    /// All equations.
    pub equations: Vec<Equation>,
    /// Those in which a force explains something, the best first.
    pub ranking: Vec<RankedEquation>,
    /// The best.
    pub best: EquationId,
    /// The one whose profiles these are.
    pub equation: EquationId,
    /// What the force in the best is a function of; none if nothing stands out.
    pub kind: Option<Kind>,
    /// How much of the squares it explains.
    pub part: f64,
    /// Over the rate.
    pub rate: Profile,
    /// Over the position, or within a turn.
    pub position: Profile,
    /// Over the time of the first record, s.
    pub time: Profile,
    /// The size over the shaft order; none for what does not turn.
    pub order: Profile,
    /// The size over the frequency, Hz.
    pub frequency: Profile,
    /// What opposes or drives the rate, over the largest rate of each window.
    pub amplitude: Profile,
}

impl ResidualForce {
    /// The name of the equation whose profiles these are.
    pub fn profiled_equation(&self) -> &str {
        &self.equations[self.equation].name
    }
}
