//! Regime of a piecewise model at a point: the side of each switching surface.

use std::fmt;

use eomgen_compiled_model::{Instance, OperatingPoint};
use serde_json::{Value, json};

use crate::error::Result;

/// Side of a switching surface.
pub struct Side {
    /// Switching function.
    formula: String,
    value: f64,
}

impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {} 0", self.formula, self.sign())
    }
}

impl Side {
    fn sign(&self) -> char {
        match self.value {
            value if value > 0.0 => '>',
            value if value < 0.0 => '<',
            _ => '=',
        }
    }

    pub fn json(&self) -> Value {
        json!({ "surface": self.formula, "value": self.value, "side": self.sign().to_string() })
    }
}

/// Returns the sides of all switching surfaces at a point; a surface over modes has one per mode.
pub fn regime(run: &Instance<'_>, at: &OperatingPoint) -> Result<Vec<Side>> {
    let mut evaluator = run.interpreter()?;
    let mut values = vec![0.0; evaluator.guard_count()];
    evaluator.guards(at.point(), &mut values);
    let program = run.model().program();
    let formulas = program.guards.iter().flat_map(|guard| {
        let count = program.value(guard.value).extent.length();
        std::iter::repeat_n(guard.formula.clone(), count)
    });
    let sides = formulas.zip(values);
    Ok(sides
        .map(|(formula, value)| Side { formula, value })
        .collect())
}
