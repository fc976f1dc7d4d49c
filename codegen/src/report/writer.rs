//! The parts of the report, written from the equations.

use model_spec::model::{Model, Term};

use super::{CoefficientLine, Entry, Line};
use crate::equations::{Equations, Row, Rows};
use crate::evaluator::Evaluator;
use crate::graph::{Graph, Id, Shape, Space};
use crate::linearity::{Linearity, linearity};
use crate::print::{Notation, expression, formula};

/// What the parts are written from.
pub(super) struct Writer<'a> {
    pub model: &'a Model,
    pub equations: &'a Equations,
    pub notation: &'a Notation,
}

impl Writer<'_> {
    fn graph(&self) -> &Graph {
        &self.equations.graph
    }

    fn row_name(&self, row: Row) -> String {
        match row {
            Row::Coordinate(index) => self.notation.coordinate(index).to_owned(),
            Row::Modes(field) => self.notation.mode(field),
        }
    }

    pub fn definitions(&self) -> Vec<Line> {
        let named = &self.equations.definitions;
        self.model
            .definitions
            .iter()
            .zip(named)
            .filter_map(|(definition, node)| {
                node.map(|node| Line {
                    name: self.notation.name(&definition.name),
                    formula: formula(self.graph(), self.notation, node),
                })
            })
            .collect()
    }

    /// A sentence on what kind of model it is between its switching surfaces.
    pub fn linearity(&self) -> String {
        match linearity(self.equations) {
            Linearity::Linear => "The model is linear.".to_owned(),
            Linearity::PiecewiseLinear => {
                "Between its switching surfaces the model is linear.".to_owned()
            }
            Linearity::Nonlinear(node) => format!(
                "The model is not linear: {}.",
                formula(self.graph(), self.notation, node)
            ),
        }
    }

    /// An energy as the sum of its terms, by their names.
    pub fn sum_of_terms(&self, symbol: &str, terms: &[Term]) -> String {
        if terms.is_empty() {
            return "0".to_owned();
        }
        let names: Vec<String> = terms
            .iter()
            .map(|term| self.notation.name(&format!("{symbol}_{}", term.name)))
            .collect();
        names.join(" + ")
    }

    /// The terms of the specification, each under its own name.
    pub fn terms(&self) -> Vec<Line> {
        let model = self.model;
        let energies = [
            ("T", &model.kinetic),
            ("V", &model.potential),
            ("R", &model.dissipation),
        ];
        let names = energies
            .iter()
            .flat_map(|(symbol, terms)| terms.iter().map(move |t| format!("{symbol}_{}", t.name)))
            .chain(model.forces.iter().map(|force| force.name.clone()));
        names
            .zip(&self.equations.terms)
            .map(|(name, node)| Line {
                name: self.notation.name(&name),
                formula: formula(self.graph(), self.notation, *node),
            })
            .collect()
    }

    /// The nodes that have names, with their formulas.
    pub fn named(&self, nodes: &[Id]) -> Vec<Line> {
        let mut lines: Vec<Line> = Vec::new();
        for &node in nodes {
            let Some(name) = self.graph().name(node) else {
                continue;
            };
            let name = self.notation.name(name);
            if lines.iter().all(|line| line.name != name) {
                lines.push(Line {
                    name,
                    formula: formula(self.graph(), self.notation, node),
                });
            }
        }
        lines
    }

    pub fn rows(&self, rows: &Rows) -> Vec<Line> {
        let scalars = rows
            .scalars
            .iter()
            .enumerate()
            .map(|(i, id)| (Row::Coordinate(i), *id));
        let modal = rows
            .modal
            .iter()
            .enumerate()
            .map(|(f, id)| (Row::Modes(f), *id));
        scalars
            .chain(modal)
            .filter(|(row, id)| !self.graph().is_zero(*id) && self.is_present(*row))
            .map(|(row, id)| Line {
                name: self.row_name(row),
                formula: formula(self.graph(), self.notation, id),
            })
            .collect()
    }

    fn is_present(&self, row: Row) -> bool {
        match row {
            Row::Coordinate(_) => true,
            Row::Modes(field) => self.graph().size(Space::Modes(field)) > 0,
        }
    }

    pub fn mass_matrix(&self) -> Vec<Entry> {
        let mass = &self.equations.mass;
        let mut entries = Vec::new();
        let mut push = |row: Row, column: Row, id: Id| {
            if !self.graph().is_zero(id) && self.is_present(row) && self.is_present(column) {
                entries.push(Entry {
                    row: self.row_name(row),
                    column: self.row_name(column),
                    formula: formula(self.graph(), self.notation, id),
                });
            }
        };
        for (row, values) in mass.scalars.iter().enumerate() {
            for (column, id) in values.iter().enumerate().skip(row) {
                push(Row::Coordinate(row), Row::Coordinate(column), *id);
            }
            for (field, id) in mass.coupling[row].iter().enumerate() {
                push(Row::Coordinate(row), Row::Modes(field), *id);
            }
        }
        for (row, id, column) in &self.equations.modal_blocks {
            push(Row::Modes(*row), Row::Modes(*column), *id);
        }
        entries
    }

    pub fn coefficients(&self, evaluator: &Evaluator) -> Vec<CoefficientLine> {
        self.equations
            .coefficients
            .iter()
            .zip(&evaluator.program().coefficient_values)
            .map(|(coefficient, value)| CoefficientLine {
                name: self.notation.name(&coefficient.name),
                formula: formula(self.graph(), self.notation, coefficient.value),
                values: if evaluator.program().value(*value).prepared {
                    evaluator.slice(*value).to_vec()
                } else {
                    Vec::new()
                },
            })
            .collect()
    }

    /// Each row whose factors the specification names, as the sum of these.
    pub fn accelerations(&self) -> Vec<Line> {
        let mut lines: Vec<(Row, Line)> = Vec::new();
        for coefficient in &self.equations.coefficients {
            let Some(factor) = &coefficient.factor else {
                continue;
            };
            if !self.is_present(factor.row) {
                continue;
            }
            let name = self.notation.name(&coefficient.name);
            let term = self.named_term(&name, coefficient.value, factor.by);
            match lines.iter_mut().find(|(row, _)| *row == factor.row) {
                Some((_, line)) => {
                    line.formula.push_str(" + ");
                    line.formula.push_str(&term);
                }
                None => {
                    let acceleration = self.notation.acceleration(&self.row_name(factor.row));
                    let times = factor
                        .times
                        .map(|id| format!("{} ", expression(self.graph(), self.notation, id)))
                        .unwrap_or_default();
                    lines.push((
                        factor.row,
                        Line {
                            name: format!("{times}{acceleration}"),
                            formula: term,
                        },
                    ));
                }
            }
        }
        lines.into_iter().map(|(_, line)| line).collect()
    }

    fn named_term(&self, name: &str, value: Id, by: Id) -> String {
        let multiplied = expression(self.graph(), self.notation, by);
        match (self.graph().shape(value), self.graph().shape(by)) {
            (Shape::Vector(_), Shape::Vector(_)) => format!("sum_i({name}_i*{multiplied})"),
            (Shape::Matrix(..), _) => {
                format!("sum_j({name}_ij*{})", multiplied.replace("_i", "_j"))
            }
            (Shape::Vector(_), _) if multiplied == "1" => format!("{name}_i"),
            (Shape::Vector(_), _) => format!("{name}_i*{multiplied}"),
            _ if multiplied == "1" => name.to_owned(),
            _ => format!("{name}*{multiplied}"),
        }
    }
}
