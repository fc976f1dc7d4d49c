//! Report on the equations of one variant: energies, the rows of M q'' + c = f, named coefficients with their
//! values, switching surfaces, and the solution for the accelerations. Formats: text, LaTeX and JSON.
//!
//! `outline` selects the nodes, `writer` writes their formulas, `types` defines the report, `text` and
//! `latex` print it.

mod latex;
mod outline;
mod text;
mod types;
mod writer;

use eomgen_model_spec::model::Model;

use crate::mechanics::equations::Equations;
use crate::program::evaluator::Evaluator;
use crate::symbolic::formula::{Formula, Reader, SharedExpressions};
use outline::Outline;
pub use types::{CoefficientLine, Line, MassMatrixEntry, Report, Sentence, Solution};
use writer::Writer;

impl Report {
    /// Builds the report of a variant; `evaluator` holds the program of the variant.
    pub fn new(model: &Model, equations: &Equations, evaluator: &Evaluator) -> Self {
        let graph = &equations.graph;
        let outline = Outline::new(model, equations);
        let shared = SharedExpressions::find_shared(graph, model, &outline.nodes());
        let reader = Reader::new(graph, model, &shared);
        let writer = Writer {
            equations,
            outline: &outline,
            reader: &reader,
        };
        let guards = equations.guards.iter();
        Self {
            schema: 2,
            model: model.name.clone(),
            title: model.title.clone(),
            orders: graph.orders().to_vec(),
            state: evaluator.program().state_names(),
            definitions: writer.lines(&outline.definitions),
            terms: writer.lines(&outline.terms),
            kinetic: writer.sum_of_terms("T", &model.kinetic),
            potential: writer.sum_of_terms("V", &model.potential),
            shared: writer.shared(),
            mass_matrix: writer.mass_matrix(),
            pivots: writer.write_named_nodes(&equations.accelerations.pivots),
            velocity_terms: writer.lines(&outline.velocity_terms),
            forces: writer.lines(&outline.forces),
            state_rates: writer.lines(&outline.state_rates),
            constraints: writer.lines(&outline.constraints),
            multipliers: writer.lines(&outline.multipliers),
            coefficients: writer.coefficients(evaluator),
            accelerations: writer.accelerations(),
            guards: guards.map(|guard| reader.formula(guard.value)).collect(),
            linearity: writer.linearity(),
            solution: Solution::new(model, equations),
        }
    }
}

impl Solution {
    fn new(model: &Model, equations: &Equations) -> Self {
        let report = &equations.accelerations.report;
        let order = report.order.iter();
        Self {
            dense_modes: report.dense_modes,
            order: order
                .map(|index| Formula::from_name(&model.coordinates[*index].name))
                .collect(),
            interfaces: report.interfaces,
            operations: report.operations,
            dearest: report.most_expensive_operations,
        }
    }
}
