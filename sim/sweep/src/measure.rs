//! Interface of measures.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// Column of numbers in the result.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Column {
    /// Unique name.
    pub name: String,
    /// Unit; `1` for a dimensionless number.
    pub unit: String,
    /// Description of the numbers.
    pub about: String,
}

impl Column {
    /// Creates a column.
    pub fn new(name: impl Into<String>, unit: impl Into<String>, about: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            unit: unit.into(),
            about: about.into(),
        }
    }
}

/// Description of a measure, part of the job's hash. Equal descriptions imply equal numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Description {
    /// Name of the measure on the command line.
    pub name: String,
    /// Quantity and method.
    pub about: String,
    /// Options that determine the numbers, in addition to the model.
    pub options: BTreeMap<String, String>,
    /// Columns of the result.
    pub columns: Vec<Column>,
    /// Columns in a figure: the first one over a plane, all of them over a line.
    pub drawn: Vec<String>,
    /// Name of the quantity in these columns, for example `lambda_1`.
    pub quantity: String,
}

/// Measures at points of parameter space, from one motion per point.
pub trait Measure: Sync {
    /// Returns the descriptions, the same at every call.
    fn describe(&self) -> Vec<Description>;

    /// Creates a worker, which measures on one thread.
    fn worker(&self) -> Box<dyn Worker + '_>;
}

/// Worker with its own memory. Its results must not depend on previous points.
pub trait Worker {
    /// Measures at a point. `settings` are the varied parameters in their declared units. `out` has
    /// one number per column of all descriptions, NaN before the call. `check` is called between steps of the solver
    /// and unwinds to stop the sweep.
    fn measure(
        &mut self,
        settings: &[(&str, f64)],
        out: &mut [f64],
        check: &dyn Fn(),
    ) -> Result<(), Failure>;
}

/// Reason why a point has no number: the numbers are NaN, except the number of crossings, and the status is
/// [`Failure::code`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Failure {
    /// Inadmissible parameters.
    Parameters,
    /// State derivative that is infinite or NaN.
    NotFinite,
    /// Limits on step size or work exceeded, for example by a diverging motion.
    Limit,
    /// Switching surfaces that are crossed too often, or that hold the motion.
    Switching,
    /// Motion for which the measure is undefined.
    Undefined,
    /// Section that the motion crosses too rarely; contains the number of crossings.
    FewCrossings(usize),
}

impl Failure {
    /// Codes of the statuses with their texts; 0 is success.
    pub const CODES: [(u8, &'static str); 7] = [
        (0, "measured"),
        (1, "the parameter values are not admissible"),
        (2, "rates of the motion are infinite or not numbers"),
        (3, "the limits on step size or work were reached"),
        (
            4,
            "switching surfaces are crossed too fast, or hold the motion",
        ),
        (5, "the measure has no value for this motion"),
        (6, "the section has too few crossings"),
    ];

    /// Returns the number in the status column.
    pub fn code(self) -> u8 {
        match self {
            Self::Parameters => 1,
            Self::NotFinite => 2,
            Self::Limit => 3,
            Self::Switching => 4,
            Self::Undefined => 5,
            Self::FewCrossings(_) => 6,
        }
    }
}
