//! Content of a report.

use serde::{Serialize, Serializer};

use crate::symbolic::formula::{Formula, Index};

/// Equations of one variant. In JSON, formulas and names are plain text.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Version of this schema.
    pub schema: u32,
    /// Name of the model.
    pub model: String,
    /// Title of the model.
    pub title: String,
    /// Truncation order of each field.
    pub orders: Vec<usize>,
    /// Names of the states in their order.
    pub state: Vec<String>,
    /// Definitions of the specification.
    pub definitions: Vec<Line>,
    /// Named terms of the energies and of the dissipation, and the forces.
    pub terms: Vec<Line>,
    /// Kinetic energy T.
    pub kinetic: Formula,
    /// Potential energy V.
    pub potential: Formula,
    /// Long subexpressions that are used several times. A line refers only to earlier lines.
    pub shared: Vec<Line>,
    /// Nonzero entries of the mass matrix on and above the diagonal.
    pub mass_matrix: Vec<MassMatrixEntry>,
    /// Pivots of the factorisation.
    pub pivots: Vec<Line>,
    /// Nonzero velocity terms c.
    pub velocity_terms: Vec<Line>,
    /// Generalised forces f.
    pub forces: Vec<Line>,
    /// Rates of first-order states.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub state_rates: Vec<Line>,
    /// Constraints, each with the expression that is zero.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub constraints: Vec<Line>,
    /// Multipliers of the constraints.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub multipliers: Vec<Line>,
    /// Named coefficients of the specification.
    pub coefficients: Vec<CoefficientLine>,
    /// Accelerations in terms of the coefficients.
    pub accelerations: Vec<Line>,
    /// Formulas that change sign at the switching surfaces.
    pub guards: Vec<Formula>,
    /// Statement on the linearity of the model between its switching surfaces.
    pub linearity: Sentence,
    /// Solution for the accelerations.
    pub solution: Solution,
}

/// Formula with its name.
#[derive(Clone, Debug, Serialize)]
pub struct Line {
    /// Name.
    pub name: Formula,
    /// Formula.
    pub formula: Formula,
}

/// Entry of the mass matrix.
#[derive(Clone, Debug, Serialize)]
pub struct MassMatrixEntry {
    /// Row.
    pub row: Formula,
    /// Column.
    pub column: Formula,
    /// Formula.
    pub formula: Formula,
}

/// Named coefficient.
#[derive(Clone, Debug, Serialize)]
pub struct CoefficientLine {
    /// Name.
    pub name: Formula,
    /// Formula.
    pub formula: Formula,
    /// SI unit, `1` without a dimension; `None` if it is not known.
    pub unit: Option<String>,
    /// Mode indices: none for a scalar, one for a vector, two for a matrix.
    #[serde(skip)]
    pub indices: Vec<Index>,
    /// Number of columns of a matrix, else 1.
    #[serde(skip)]
    pub columns: usize,
    /// Values at the parameters of the specification, in SI units: one number, or one for each mode (a matrix row by
    /// row). Empty if the coefficient depends on time or state.
    pub values: Vec<f64>,
}

/// Statement about a formula.
#[derive(Clone, Debug)]
pub struct Sentence {
    /// Text without a full stop.
    pub text: &'static str,
    /// Formula after the text, if there is one.
    pub formula: Option<Formula>,
}

impl std::fmt::Display for Sentence {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match &self.formula {
            Some(formula) => write!(f, "{} {formula}.", self.text),
            None => write!(f, "{}.", self.text),
        }
    }
}

impl Serialize for Sentence {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// Solution for the accelerations.
#[derive(Clone, Debug, Serialize)]
pub struct Solution {
    /// True if the modal block of the mass matrix is dense.
    pub dense_modes: bool,
    /// Coordinates in the order of their elimination, after the modes.
    pub order: Vec<Formula>,
    /// Number of interface scalars, which are additional unknowns.
    pub interfaces: usize,
    /// Operations per call in the chosen order.
    pub operations: usize,
    /// Operations per call in the most expensive order of the coordinates.
    #[serde(rename = "max_operations")]
    pub dearest: usize,
}
