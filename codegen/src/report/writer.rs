//! Sections of the report, written from the equations.

use eomgen_model_spec::model::Term;

use super::outline::{NamedNode, Outline, term_symbol};
use super::types::{CoefficientLine, Line, MassMatrixEntry, Sentence};
use crate::mechanics::coefficients::EquationRow;
use crate::mechanics::equations::Equations;
use crate::mechanics::linearity::Linearity;
use crate::program::evaluator::Evaluator;
use crate::program::units::infer_units;
use crate::symbolic::formula::{Formula, Index, Reader};
use crate::symbolic::graph::{NodeId, Shape};

pub(super) struct Writer<'a> {
    pub equations: &'a Equations,
    pub outline: &'a Outline<'a>,
    pub reader: &'a Reader<'a>,
}

impl Writer<'_> {
    pub fn lines(&self, shown: &[NamedNode]) -> Vec<Line> {
        shown
            .iter()
            .map(|(name, node)| Line {
                name: name.clone(),
                formula: self.reader.formula(*node),
            })
            .collect()
    }

    /// Returns the lines of shared subexpressions.
    pub fn shared(&self) -> Vec<Line> {
        let lines = self.reader.lines();
        lines
            .map(|(name, formula)| Line { name, formula })
            .collect()
    }

    /// Returns the statement about the linearity of the model between its switching surfaces.
    pub fn linearity(&self) -> Sentence {
        let (text, formula) = match self.outline.linearity {
            Linearity::Linear => ("The model is linear", None),
            Linearity::PiecewiseLinear => {
                ("Between its switching surfaces the model is linear", None)
            }
            Linearity::Constrained => ("The model has constraints", None),
            Linearity::Impacts => (
                "The model has impacts; these equations hold between them",
                None,
            ),
            Linearity::Corners(node) => (
                "Rates jump by the corner conditions where the energies jump; the first such surface is the zero of",
                Some(self.reader.formula(node)),
            ),
            Linearity::Nonlinear(node) => (
                "The model is not linear because of",
                Some(self.reader.formula(node)),
            ),
        };
        Sentence { text, formula }
    }

    /// Returns an energy as the sum of the names of its terms.
    pub fn sum_of_terms(&self, symbol: &str, terms: &[Term]) -> Formula {
        let names = terms.iter().map(|term| term_symbol(symbol, term));
        Formula::sum(names.collect())
    }

    /// Returns one line for each node that has a name.
    pub fn write_named_nodes(&self, nodes: &[NodeId]) -> Vec<Line> {
        let mut lines: Vec<Line> = Vec::new();
        for &node in nodes {
            let Some(name) = self.equations.graph.name(node) else {
                continue;
            };
            let name = Formula::Symbol(self.reader.symbol(name));
            if lines.iter().all(|line| line.name != name) {
                lines.push(Line {
                    name,
                    formula: self.reader.formula(node),
                });
            }
        }
        lines
    }

    pub fn mass_matrix(&self) -> Vec<MassMatrixEntry> {
        let entries = self.outline.mass_matrix.iter();
        entries
            .map(|(row, column, node)| MassMatrixEntry {
                row: row.clone(),
                column: column.clone(),
                formula: self.reader.formula(*node),
            })
            .collect()
    }

    pub fn coefficients(&self, evaluator: &Evaluator) -> Vec<CoefficientLine> {
        let units = infer_units(evaluator.program());
        self.equations
            .coefficients
            .iter()
            .zip(&evaluator.program().coefficient_values)
            .map(|(coefficient, value)| CoefficientLine {
                name: Formula::from_name(&coefficient.name),
                indices: self.mode_indices(coefficient.value).to_vec(),
                columns: self.mode_columns(coefficient.value),
                formula: self.reader.formula(coefficient.value),
                unit: units[value.index()].si_text(),
                values: if evaluator.program().value(*value).parameter_only {
                    evaluator.slice(*value).to_vec()
                } else {
                    Vec::new()
                },
            })
            .collect()
    }

    fn mode_indices(&self, value: NodeId) -> &'static [Index] {
        match self.equations.graph.shape(value) {
            Shape::Scalar => &[],
            Shape::Vector(_) => &[Index::I],
            Shape::Matrix(..) => &[Index::I, Index::J],
        }
    }

    fn mode_columns(&self, value: NodeId) -> usize {
        let graph = &self.equations.graph;
        match graph.shape(value) {
            Shape::Scalar | Shape::Vector(_) => 1,
            Shape::Matrix(_, columns) => graph.size(columns),
        }
    }

    /// Returns the accelerations with named coefficients, each as the sum of coefficient times operand.
    pub fn accelerations(&self) -> Vec<Line> {
        let mut rows: Vec<(EquationRow, Formula, Vec<Formula>)> = Vec::new();
        for coefficient in &self.equations.coefficients {
            let Some(factor) = &coefficient.factor else {
                continue;
            };
            if !self.outline.is_present(factor.row) {
                continue;
            }
            let term = self.write_named_term(&coefficient.name, coefficient.value, factor.by);
            match rows.iter_mut().find(|(row, ..)| *row == factor.row) {
                Some((_, _, terms)) => terms.push(term),
                None => {
                    let symbol = self.outline.row_symbol(factor.row).with_dots(2);
                    let times = match factor.times {
                        Some(id) => self.reader.expression(id),
                        None => Formula::Number(1.0),
                    };
                    let acceleration = times.multiply(Formula::Symbol(symbol));
                    rows.push((factor.row, acceleration, vec![term]));
                }
            }
        }
        let lines = rows.into_iter().map(|(_, name, terms)| Line {
            name,
            formula: Formula::sum(terms),
        });
        lines.collect()
    }

    /// Returns the formula of a named coefficient times its operand.
    fn write_named_term(&self, name: &str, value: NodeId, by: NodeId) -> Formula {
        let graph = &self.equations.graph;
        let multiplied = self.reader.expression(by);
        let indexed =
            |indices: &[Index]| Formula::Symbol(self.reader.symbol(name).with_indices(indices));
        match (graph.shape(value), graph.shape(by)) {
            (Shape::Vector(_), Shape::Vector(_)) => {
                let product = indexed(&[Index::I]).multiply(multiplied);
                Formula::Total(Index::I, Box::new(product))
            }
            (Shape::Matrix(..), _) => {
                let product =
                    indexed(&[Index::I, Index::J]).multiply(multiplied.split_by_columns());
                Formula::Total(Index::J, Box::new(product))
            }
            (Shape::Vector(_), _) => indexed(&[Index::I]).multiply(multiplied),
            (Shape::Scalar, _) => indexed(&[]).multiply(multiplied),
        }
    }
}
