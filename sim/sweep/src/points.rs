//! Points of a sweep: a grid or random samples.

use crate::grid::{Axis, Grid};
use crate::samples::Samples;

/// Parameter values of each point, counted from 0.
#[derive(Clone, Debug, PartialEq)]
pub enum Points {
    /// All combinations of the values of some axes.
    Grid(Grid),
    /// Random samples.
    Samples(Samples),
}

impl Points {
    /// Returns the number of points.
    pub fn count(&self) -> usize {
        match self {
            Self::Grid(grid) => grid.points(),
            Self::Samples(samples) => samples.count,
        }
    }

    /// Returns the names of the parameters.
    pub fn names(&self) -> Vec<&str> {
        match self {
            Self::Grid(grid) => grid.names().collect(),
            Self::Samples(samples) => samples.names().collect(),
        }
    }

    /// Returns the parameters' values at a point, in the order of [`Points::names`].
    pub fn settings(&self, point: usize) -> Vec<(&str, f64)> {
        match self {
            Self::Grid(grid) => grid.settings(point),
            Self::Samples(samples) => samples.settings(point),
        }
    }

    /// Returns the axes of a grid; empty for samples.
    pub fn axes(&self) -> &[Axis] {
        match self {
            Self::Grid(grid) => grid.axes(),
            Self::Samples(_) => &[],
        }
    }

    /// Returns the samples, if the points are samples.
    pub fn samples(&self) -> Option<&Samples> {
        match self {
            Self::Grid(_) => None,
            Self::Samples(samples) => Some(samples),
        }
    }
}
