//! Bounds of rounding errors at single points.

use eomgen_model_spec::interval::Interval;

use super::boxes::bound_root;
use super::format::Format;
use super::scalars::Scalars;
use crate::program::{Program, ValueId};

/// Numbers of a program whose rounding errors are bounded at points, in double precision.
pub struct PointBounds {
    scalars: Scalars,
    roots: Vec<usize>,
}

impl PointBounds {
    /// Prepares the bounds of these values of a program; each value must be a scalar.
    pub fn new(program: &Program, values: &[ValueId]) -> Self {
        let scalars = Scalars::record(program, values, Format::Double);
        let roots = values.iter().map(|id| scalars.element(program, *id, 0));
        Self {
            roots: roots.collect(),
            scalars,
        }
    }

    /// Returns bounds of the rounding errors at a [point](Program::point_place), each in the unit of its value; `None`
    /// for a value without a bound.
    pub fn bound(&self, point: impl IntoIterator<Item = f64>) -> Vec<Option<f64>> {
        let numbers = point.into_iter();
        let numbers = numbers.map(|number| Interval {
            low: number,
            high: number,
        });
        let ranges: Vec<Option<Interval>> = numbers.map(Some).collect();
        let bound = |root: &usize| bound_root(&self.scalars, *root, &ranges).ok();
        self.roots.iter().map(bound).collect()
    }
}
