//! The equations of one variant as a person wants to read them: energies, the rows of
//! M q'' + c = f, the named coefficients with their values, the switching surfaces, and
//! how the accelerations are solved for. As text, LaTeX or JSON.

mod latex;
mod text;
mod writer;

use model_spec::model::Model;
use serde::Serialize;

use crate::equations::Equations;
use crate::evaluator::Evaluator;
use crate::print::{Notation, formula};
use writer::Writer;

/// The equations of one variant, every formula written out.
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
    pub kinetic: String,
    /// V
    pub potential: String,
    /// Nonzero entries of the mass matrix on and above the diagonal.
    pub mass_matrix: Vec<Entry>,
    /// The pivots of the factorisation.
    pub pivots: Vec<Line>,
    /// Nonzero velocity terms c.
    pub velocity_terms: Vec<Line>,
    /// Generalised forces f.
    pub forces: Vec<Line>,
    /// The coefficients the specification names.
    pub coefficients: Vec<CoefficientLine>,
    /// The accelerations in terms of these.
    pub accelerations: Vec<Line>,
    /// Switching surfaces: formulas that change sign.
    pub guards: Vec<String>,
    /// What kind of model it is between its switching surfaces.
    pub linearity: String,
    /// How the accelerations are solved for.
    pub solution: Solution,
}

/// A name and its formula.
#[derive(Clone, Debug, Serialize)]
pub struct Line {
    /// What is given.
    pub name: String,
    /// Its formula.
    pub formula: String,
}

/// An entry of the mass matrix.
#[derive(Clone, Debug, Serialize)]
pub struct Entry {
    /// Row.
    pub row: String,
    /// Column.
    pub column: String,
    /// Formula.
    pub formula: String,
}

/// A named coefficient.
#[derive(Clone, Debug, Serialize)]
pub struct CoefficientLine {
    /// Its name.
    pub name: String,
    /// Its formula.
    pub formula: String,
    /// Its value, or one per mode (a matrix row by row), at the specification's
    /// parameters in SI; empty if it depends on time or state.
    pub values: Vec<f64>,
}

/// How the accelerations are solved for.
#[derive(Clone, Debug, Serialize)]
pub struct Solution {
    /// Whether the modal block of the mass matrix is dense.
    pub dense_modes: bool,
    /// Coordinates in the order of their elimination, after the modes.
    pub order: Vec<String>,
    /// Interface scalars carried as extra unknowns.
    pub interfaces: usize,
    /// Operations per call of the chosen order.
    pub operations: usize,
    /// Operations per call of the dearest order of the coordinates.
    pub dearest: usize,
}

impl Report {
    /// The report of a variant. `evaluator` runs the variant's program.
    pub fn new(
        model: &Model,
        equations: &Equations,
        evaluator: &Evaluator,
        notation: &Notation,
    ) -> Self {
        let writer = Writer {
            model,
            equations,
            notation,
        };
        let graph = &equations.graph;
        let solution = &equations.accelerations.report;
        Self {
            schema: 1,
            model: model.name.clone(),
            title: model.title.clone(),
            orders: graph.orders().to_vec(),
            state: evaluator.program().state_names(),
            definitions: writer.definitions(),
            terms: writer.terms(),
            kinetic: writer.sum_of_terms("T", &model.kinetic),
            potential: writer.sum_of_terms("V", &model.potential),
            mass_matrix: writer.mass_matrix(),
            pivots: writer.named(&equations.accelerations.pivots),
            velocity_terms: writer.rows(&equations.velocity_terms),
            forces: writer.rows(&equations.forces),
            coefficients: writer.coefficients(evaluator),
            accelerations: writer.accelerations(),
            guards: equations
                .guards
                .iter()
                .map(|guard| formula(graph, notation, guard.value))
                .collect(),
            linearity: writer.linearity(),
            solution: Solution {
                dense_modes: solution.dense_modes,
                order: solution
                    .order
                    .iter()
                    .map(|index| notation.coordinate(*index).to_owned())
                    .collect(),
                interfaces: solution.interfaces,
                operations: solution.operations,
                dearest: solution.dearest,
            },
        }
    }
}
