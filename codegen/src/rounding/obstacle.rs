//! Reasons for missing bounds.

use eomgen_model_spec::interval::Interval;

use super::scalars::Scalars;
use crate::program::Program;

/// Operation and cause of a missing bound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Obstacle {
    /// Index of the operation in [`Scalars::list`](super::Scalars::list).
    pub scalar: usize,
    /// Cause.
    pub cause: Cause,
    /// Bounds of the operation's argument, or of its result for [`Cause::Overflow`].
    pub bounds: Interval,
}

/// Cause of a missing bound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cause {
    /// The variable with this index in the point has no range.
    NoRange(usize),
    /// The divisor may be 0.
    Divisor,
    /// The pivot may be 0 or negative.
    Pivot,
    /// The argument may be outside the domain.
    OutsideDomain,
    /// The magnitude of the angle may exceed this value in rad.
    LargeAngle(f64),
    /// The result of `atan2` may jump at the branch cut, the negative half-axis.
    Cut,
    /// The width of a dead zone may be negative.
    NegativeWidth,
    /// The result may overflow, or its slope is unbounded.
    Overflow,
}

impl Obstacle {
    /// Describes the missing or too wide range and how to declare or narrow it.
    pub fn describe(&self, program: &Program, scalars: &Scalars) -> String {
        let Interval { low, high } = self.bounds;
        let between = format!("it is between {low:.2e} and {high:.2e} in the ranges");
        let origin = program.trace.note(scalars.list[self.scalar].value);
        let origin = origin.map_or(String::new(), |note| format!(" of {note}"));
        match self.cause {
            Cause::NoRange(index) => {
                let name = &point_names(program)[index];
                format!("`{name}` has no range; declare it with `--range {name}=LOW:HIGH`")
            }
            Cause::Divisor => {
                format!("a divisor{origin} is not proven different from 0: {between}")
            }
            Cause::Pivot => {
                format!("a pivot of the mass matrix is not proven positive: {between}")
            }
            Cause::OutsideDomain => {
                format!("an argument{origin} is not proven inside the domain: {between}")
            }
            Cause::LargeAngle(largest) => {
                format!("an angle{origin} may exceed {largest:e} rad: {between}")
            }
            Cause::Cut => format!(
                "the point of `atan2`{origin} may be on the negative half-axis, where the angle jumps"
            ),
            Cause::NegativeWidth => {
                format!("the half-width of a dead zone{origin} may be negative")
            }
            Cause::Overflow => {
                format!("a result{origin} may overflow, or its slope is unbounded: {between}")
            }
        }
    }
}

/// Returns the names of the components of a [point](Program::point_place): `t`, states, inputs, independent parameters.
pub fn point_names(program: &Program) -> Vec<String> {
    let mut names = vec!["t".to_owned()];
    names.extend(program.state_names());
    names.extend(program.inputs.iter().map(|input| input.name.clone()));
    let parameters = program.parameters.iter();
    names.extend(parameters.map(|parameter| parameter.quantity.name.clone()));
    names
}
