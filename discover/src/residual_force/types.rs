//! Results of the estimation of a residual force.

use crate::ids::EquationId;
use crate::residual_force::equations::Equation;

/// Values with standard deviations over an argument.
#[derive(Clone, Debug, Default)]
pub struct Profile {
    /// Arguments in SI units, ascending.
    pub arguments: Vec<f64>,
    /// Force, N or N m.
    pub values: Vec<f64>,
    /// Standard deviation.
    pub sd: Vec<f64>,
    /// Explained fraction of the squares; for a spectrum, the fraction of its best wave.
    pub explained_fraction: f64,
    /// Index of the best wave of a spectrum.
    pub peak: Option<usize>,
}

/// Explained fractions of an equation.
#[derive(Clone, Debug)]
pub struct RankedEquation {
    /// Equation.
    pub equation: EquationId,
    /// Fraction explained by a force over rate or over position.
    pub fraction_by_state: f64,
    /// Fraction explained by a force over time that differs between windows.
    pub fraction_by_time: f64,
}

/// Argument on which a force depends.
#[derive(Clone, Debug, PartialEq)]
pub enum ForceKind {
    /// Rate, with simple functions that describe the force.
    Rate(Vec<SimpleTerm>),
    /// Position, with simple functions that describe the force.
    Position(Vec<SimpleTerm>),
    /// Neither rate nor position.
    Time,
}

/// Simple function with its coefficient, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SimpleTerm {
    /// The function.
    pub function: SimpleFunction,
    /// Coefficient.
    pub value: f64,
    /// Standard deviation.
    pub sd: f64,
}

/// Simple function of a rate or a position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SimpleFunction {
    /// Constant.
    Constant,
    /// Sign.
    Sign,
    /// Linear.
    Linear,
    /// Absolute value.
    Absolute,
    /// Square with the sign of the argument.
    SignedSquare,
}

/// Residual force of a fit.
pub struct ResidualForce {
    /// All equations.
    pub equations: Vec<Equation>,
    /// Equations in which a force explains a part of the residual; the best is first.
    pub ranking: Vec<RankedEquation>,
    /// Best equation.
    pub best_equation: EquationId,
    /// Equation of the profiles.
    pub equation: EquationId,
    /// Argument of the force in the best equation; `None` if no force is significant.
    pub kind: Option<ForceKind>,
    /// Explained fraction of the squares.
    pub explained_fraction: f64,
    /// Profile over the rate.
    pub rate: Profile,
    /// Profile over the position, or within a turn.
    pub position: Profile,
    /// Profile over the time of the first record, s.
    pub time: Profile,
    /// Amplitude over the shaft order; empty for an expression that is not an angle.
    pub order: Profile,
    /// Amplitude over the frequency, Hz.
    pub frequency: Profile,
    /// Rate-proportional force in each window over the largest rate of the window.
    pub amplitude: Profile,
}

impl ResidualForce {
    /// Returns the name of the equation of the profiles.
    pub fn profiled_equation_name(&self) -> &str {
        &self.equations[self.equation].name
    }
}
