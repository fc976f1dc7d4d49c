//! What a report holds.

use serde::{Serialize, Serializer};

use crate::symbolic::formula::Formula;

/// The equations of one variant. In JSON formulas and names are plain text.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Version of this form.
    pub schema: u32,
    /// The model's name.
    pub model: String,
    /// One line for people.
    pub title: String,
    /// Order of each field.
    pub orders: Vec<usize>,
    /// Names of the state in its order.
    pub state: Vec<String>,
    /// The specification's definitions.
    pub definitions: Vec<Line>,
    /// The named terms of the energies and of the dissipation, and the forces.
    pub terms: Vec<Line>,
    /// T
    pub kinetic: Formula,
    /// V
    pub potential: Formula,
    /// What several formulas share and is too long to be repeated, under names of their own;
    /// a line needs none but those before it. Empty where everything is written out.
    pub shared: Vec<Line>,
    /// Nonzero entries of the mass matrix on and above the diagonal.
    pub mass_matrix: Vec<MassMatrixEntry>,
    /// The pivots of the factorisation.
    pub pivots: Vec<Line>,
    /// Nonzero velocity terms c.
    pub velocity_terms: Vec<Line>,
    /// Generalised forces f.
    pub forces: Vec<Line>,
    /// The rates of states of first order.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub state_rates: Vec<Line>,
    /// The constraints, each with the expression that stays zero.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub constraints: Vec<Line>,
    /// Their multipliers.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub multipliers: Vec<Line>,
    /// The coefficients the specification names.
    pub coefficients: Vec<CoefficientLine>,
    /// The accelerations in terms of these.
    pub accelerations: Vec<Line>,
    /// Switching surfaces: formulas that change sign.
    pub guards: Vec<Formula>,
    /// What kind of model it is between its switching surfaces.
    pub linearity: Sentence,
    /// How the accelerations are solved for.
    pub solution: Solution,
}

/// A name and its formula.
#[derive(Clone, Debug, Serialize)]
pub struct Line {
    /// What is given.
    pub name: Formula,
    /// Its formula.
    pub formula: Formula,
}

/// An entry of the mass matrix.
#[derive(Clone, Debug, Serialize)]
pub struct MassMatrixEntry {
    /// EquationRow.
    pub row: Formula,
    /// Column.
    pub column: Formula,
    /// Formula.
    pub formula: Formula,
}

/// A named coefficient.
#[derive(Clone, Debug, Serialize)]
pub struct CoefficientLine {
    /// Its name.
    pub name: Formula,
    /// Its formula.
    pub formula: Formula,
    /// Its value, or one per mode (a matrix row by row), at the specification's
    /// parameters in SI; empty if it depends on time or state.
    pub values: Vec<f64>,
}

/// A statement, on a formula if it is about one.
#[derive(Clone, Debug)]
pub struct Sentence {
    /// What is said, without a full stop.
    pub text: &'static str,
    /// What it is said of.
    pub formula: Option<Formula>,
}

impl std::fmt::Display for Sentence {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match &self.formula {
            Some(formula) => write!(f, "{}: {formula}.", self.text),
            None => write!(f, "{}.", self.text),
        }
    }
}

/// Programs read sentences as plain text.
impl Serialize for Sentence {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// How the accelerations are solved for.
#[derive(Clone, Debug, Serialize)]
pub struct Solution {
    /// Whether the modal block of the mass matrix is dense.
    pub dense_modes: bool,
    /// Coordinates in the order of their elimination, after the modes.
    pub order: Vec<Formula>,
    /// Interface scalars carried as extra unknowns.
    pub interfaces: usize,
    /// Operations per call of the chosen order.
    pub operations: usize,
    /// Operations per call of the dearest order of the coordinates.
    pub dearest: usize,
}
