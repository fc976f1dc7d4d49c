//! Bounds of the rounding errors of a variant for a certificate, and the ranges in which the bounds are valid.

pub mod samples;

use eomgen_codegen::program::Program;
use eomgen_codegen::rounding::{Format, RoundingBound, bound_quantities, point_names};
use eomgen_model_spec::interval::Interval;
use eomgen_model_spec::model::Model;
use eomgen_model_spec::variant::ModelError;
use serde::Serialize;

use crate::oracle::{Oracle, OracleError};
use crate::sizes::{input_sizes, state_sizes};

/// Bounds of rounding errors, as a certificate lists them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Bounds {
    /// Ranges of time, states, inputs and parameters in which the bounds are valid. Other parameters have the values of
    /// the certificate.
    pub ranges: Vec<NamedRange>,
    /// Bound of each quantity in each precision.
    pub quantities: Vec<QuantityBound>,
}

/// Range of a variable.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NamedRange {
    /// Name of the variable.
    pub name: String,
    /// Lower end in SI.
    pub low: f64,
    /// Upper end in SI.
    pub high: f64,
}

/// Bound of the rounding error of a quantity.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct QuantityBound {
    /// Name of the quantity.
    pub name: String,
    /// `f64` or `f32`.
    pub precision: &'static str,
    /// Bound of the error; `None` if no bound was found.
    pub bound: Option<f64>,
    /// SI unit, if it is known.
    pub unit: Option<String>,
    /// Reason for a missing bound.
    pub reason: Option<String>,
}

/// Ranges of the variables of a program: time, states, inputs and independent parameters.
#[derive(Clone, Debug)]
pub struct VariableRanges {
    names: Vec<String>,
    ranges: Vec<Option<Interval>>,
    first_parameter: usize,
}

impl VariableRanges {
    /// Returns the ranges of the specification. Parameters have their values, and variables without `range` have none.
    ///
    /// # Errors
    /// A parameter without a value.
    pub fn from_model(model: &Model, program: &Program) -> Result<Self, ModelError> {
        let interval = |range: Option<(f64, f64)>| range.map(|(low, high)| Interval { low, high });
        let mut ranges = vec![None];
        ranges.extend(model.coordinate_ranges()?.into_iter().map(interval));
        ranges.resize(1 + 2 * program.degrees_of_freedom(), None);
        ranges.extend(model.state_ranges()?.into_iter().map(interval));
        ranges.extend(model.input_ranges()?.into_iter().map(interval));
        let first_parameter = ranges.len();
        let values = program.default_parameters().into_iter();
        ranges.extend(values.map(|value| interval(Some((value, value)))));
        Ok(Self {
            names: point_names(program),
            ranges,
            first_parameter,
        })
    }

    /// Sets the range of a variable, in SI.
    ///
    /// # Errors
    /// An unknown name, an end that is not finite, or a lower end above the upper end.
    pub fn set(&mut self, name: &str, low: f64, high: f64) -> Result<(), String> {
        let Some(place) = self.names.iter().position(|known| known == name) else {
            let known = self.names.join(", ");
            return Err(format!(
                "`{name}` is not a variable of the equations; the variables are {known}"
            ));
        };
        if !low.is_finite() || !high.is_finite() {
            return Err(format!(
                "the range {low} to {high} of `{name}` is not finite; give two numbers"
            ));
        }
        if low > high {
            return Err(format!(
                "the range of `{name}` begins at {low}, above its end {high}; exchange the ends"
            ));
        }
        self.ranges[place] = Some(Interval { low, high });
        Ok(())
    }

    /// Sets the ranges of time, states and inputs to a single point.
    pub fn set_point(&mut self, t: f64, state: &[f64], inputs: &[f64]) {
        let numbers = std::iter::once(&t).chain(state).chain(inputs);
        for (range, number) in self.ranges.iter_mut().zip(numbers) {
            *range = Some(Interval {
                low: *number,
                high: *number,
            });
        }
    }

    /// Sets missing ranges: for a state or input, the range of random states; for the time, 0 to 1 s.
    ///
    /// # Errors
    /// A model that the oracle cannot evaluate.
    pub fn fill_missing(&mut self, oracle: &Oracle) -> Result<(), OracleError> {
        let sizes = [state_sizes(oracle)?, input_sizes(oracle)].concat();
        let symmetric = sizes.iter().map(|size| Interval {
            low: -size,
            high: *size,
        });
        let first_second = Interval {
            low: 0.0,
            high: 1.0,
        };
        let typical = std::iter::once(first_second).chain(symmetric);
        for (range, typical) in self.ranges.iter_mut().zip(typical) {
            range.get_or_insert(typical);
        }
        Ok(())
    }

    /// Returns the ranges in the order of a point.
    pub fn ranges(&self) -> &[Option<Interval>] {
        &self.ranges
    }

    /// Bounds the rounding errors of all quantities in both precisions.
    pub fn bounds(&self, program: &Program) -> Bounds {
        let bounds = Format::ALL.map(|format| bound_quantities(program, format, &self.ranges));
        let is_stated =
            |place: usize, range: &Interval| place < self.first_parameter || range.low < range.high;
        let ranges = self.names.iter().zip(&self.ranges).enumerate();
        let ranges = ranges.filter_map(|(place, (name, range))| {
            let range = range.filter(|range| is_stated(place, range))?;
            Some(NamedRange {
                name: name.clone(),
                low: range.low,
                high: range.high,
            })
        });
        let [double, single] = bounds;
        let pairs = double.into_iter().zip(single);
        Bounds {
            ranges: ranges.collect(),
            quantities: pairs.flat_map(|(a, b)| [written(a), written(b)]).collect(),
        }
    }
}

fn written(found: RoundingBound) -> QuantityBound {
    QuantityBound {
        name: found.quantity.name,
        precision: found.format.name(),
        bound: found.bound.as_ref().ok().copied(),
        unit: found.quantity.unit,
        reason: found.bound.err(),
    }
}
