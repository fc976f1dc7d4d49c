//! What is measured at every point of a grid, as far as the sweep knows of it.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// A column of numbers in the result.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Column {
    /// Its name, unlike any other's.
    pub name: String,
    /// Its unit, `1` for a pure number.
    pub unit: String,
    /// What it is.
    pub about: String,
}

impl Column {
    /// A column.
    pub fn new(name: impl Into<String>, unit: impl Into<String>, about: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            unit: unit.into(),
            about: about.into(),
        }
    }
}

/// What a measure is, as far as others need to know. All of it enters the job's hash: two
/// measures of one description give the same numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Description {
    /// The name it is asked for by.
    pub name: String,
    /// What is measured and how.
    pub about: String,
    /// Everything its numbers depend on beside the model.
    pub options: BTreeMap<String, String>,
    /// What it gives.
    pub columns: Vec<Column>,
    /// The columns that a figure shows: one over a plane, all of them over a line.
    pub drawn: Vec<String>,
    /// The name of what they hold, `lambda_1` say.
    pub quantity: String,
}

/// Something that can be measured at a point of parameter space.
pub trait Measure: Sync {
    /// What it is; the same at every call.
    fn describe(&self) -> Description;

    /// Whoever measures, one point after the other on one thread.
    fn worker(&self) -> Box<dyn Worker + '_>;
}

/// Measures points with memory of its own. What it writes depends on the point alone and
/// not on the points before.
pub trait Worker {
    /// Measures at a point.
    ///
    /// `settings`: the varied parameters, each in the unit that the specification declares.
    /// `out`: one number per column of [`Description::columns`]; NaN on entry, and what is
    /// written there counts only on success.
    ///
    /// # Errors
    /// Why there is no number at this point.
    fn measure(&mut self, settings: &[(&str, f64)], out: &mut [f64]) -> Result<(), Failure>;
}

/// Why nothing could be measured at a point. The sweep goes on: the point's numbers are NaN
/// and the measure's status column holds [`Failure::code`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Failure {
    /// The parameters are no admissible model.
    Parameters,
    /// Rates of the motion are infinite or not numbers.
    NotFinite,
    /// The motion could not be followed within the limits on step size and work; one that
    /// grows without bound ends here too.
    Limit,
    /// Switching surfaces are crossed too fast, or the motion is held on one.
    Switching,
    /// The motion is known and the measure has no value for it.
    Undefined,
}

impl Failure {
    /// The statuses of a point with their codes; 0 is success.
    pub const CODES: [(u8, &'static str); 6] = [
        (0, "measured"),
        (1, "the parameters are no admissible model"),
        (2, "rates of the motion are infinite or not numbers"),
        (3, "the limits on step size or work were reached"),
        (
            4,
            "switching surfaces are crossed too fast, or hold the motion",
        ),
        (5, "the measure has no value for this motion"),
    ];

    /// The number in the status column.
    pub fn code(self) -> u8 {
        match self {
            Self::Parameters => 1,
            Self::NotFinite => 2,
            Self::Limit => 3,
            Self::Switching => 4,
            Self::Undefined => 5,
        }
    }
}
