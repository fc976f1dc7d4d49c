//! The points of a sweep: those of a grid, or random samples.

use crate::grid::{Axis, Grid};
use crate::samples::Samples;

/// Where parameters are set to, point by point, counted from 0.
#[derive(Clone, Debug, PartialEq)]
pub enum Points {
    /// All combinations of the values of some axes.
    Grid(Grid),
    /// Random samples.
    Samples(Samples),
}

impl Points {
    /// How many there are.
    pub fn count(&self) -> usize {
        match self {
            Self::Grid(grid) => grid.points(),
            Self::Samples(samples) => samples.count,
        }
    }

    /// The parameters that are set.
    pub fn names(&self) -> Vec<&str> {
        match self {
            Self::Grid(grid) => grid.names().collect(),
            Self::Samples(samples) => samples.names().collect(),
        }
    }

    /// The parameters' values at a point, in the order of [`Points::names`].
    pub fn settings(&self, point: usize) -> Vec<(&str, f64)> {
        match self {
            Self::Grid(grid) => grid.settings(point),
            Self::Samples(samples) => samples.settings(point),
        }
    }

    /// The axes of a grid; none of samples.
    pub fn axes(&self) -> &[Axis] {
        match self {
            Self::Grid(grid) => grid.axes(),
            Self::Samples(_) => &[],
        }
    }

    /// The samples, if that is what they are.
    pub fn samples(&self) -> Option<&Samples> {
        match self {
            Self::Grid(_) => None,
            Self::Samples(samples) => Some(samples),
        }
    }
}
