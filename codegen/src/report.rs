//! The equations of one variant as a person wants to read them: energies, the rows of
//! M q'' + c = f, the named coefficients with their values, the switching surfaces, and
//! how the accelerations are solved for. As text, LaTeX or JSON.

use std::fmt::Write;

use model_spec::model::{Model, Term};
use serde::Serialize;

use crate::equations::{Equations, Row, Rows};
use crate::evaluator::Evaluator;
use crate::graph::{Graph, Id, Space};
use crate::print::{Notation, expression, formula};

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

    /// As plain text.
    pub fn text(&self) -> String {
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = self.write_text(&mut text);
        text
    }

    fn write_text(&self, out: &mut String) -> std::fmt::Result {
        writeln!(out, "{}", self.title)?;
        writeln!(out, "state: {}", self.state.join(", "))?;
        section(out, "Definitions", &self.definitions)?;
        section(out, "Terms of the energies (T, V), of the dissipation (R), and forces", &self.terms)?;
        writeln!(out, "\nEnergies\n  T = {}\n  V = {}", self.kinetic, self.potential)?;
        writeln!(out, "\nMass matrix M, by entries (symmetric)")?;
        for entry in &self.mass_matrix {
            writeln!(out, "  M[{}, {}] = {}", entry.row, entry.column, entry.formula)?;
        }
        section(out, "Pivots, which must be positive", &self.pivots)?;
        section(out, "Velocity terms c", &self.velocity_terms)?;
        section(out, "Generalised forces f, with M q'' + c = f", &self.forces)?;
        if !self.coefficients.is_empty() {
            writeln!(out, "\nCoefficients")?;
            for line in &self.coefficients {
                writeln!(out, "  {} = {}", line.name, line.formula)?;
                if !line.values.is_empty() {
                    writeln!(out, "      = {}", values_text(&line.values))?;
                }
            }
        }
        section(out, "Accelerations", &self.accelerations)?;
        if !self.guards.is_empty() {
            writeln!(out, "\nThe equations switch where one of these changes sign")?;
            for guard in &self.guards {
                writeln!(out, "  {guard}")?;
            }
        }
        writeln!(out, "\n{}", self.solution_sentence())
    }

    fn solution_sentence(&self) -> String {
        let solution = &self.solution;
        let modes = match (self.orders.iter().sum::<usize>(), solution.dense_modes) {
            (0, _) => String::new(),
            (_, false) => "the modes first, then ".to_owned(),
            (_, true) => "the modes first by a dense Cholesky factor, then ".to_owned(),
        };
        let interfaces = match solution.interfaces {
            0 => String::new(),
            n => format!("{n} interface unknowns, then "),
        };
        format!(
            "Solved without pivoting: {modes}{interfaces}{} ({} operations a call; {} in the dearest order).",
            solution.order.join(", "),
            solution.operations,
            solution.dearest
        )
    }

    /// As a LaTeX document.
    pub fn latex(&self) -> String {
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = self.write_latex(&mut text);
        text
    }

    fn write_latex(&self, out: &mut String) -> std::fmt::Result {
        writeln!(out, "\\documentclass{{article}}\n\\usepackage{{amsmath,breqn}}")?;
        writeln!(out, "\\begin{{document}}\n\\section*{{{}}}", latex_text(&self.title))?;
        let mut lines: Vec<(String, String)> = vec![
            ("T".into(), self.kinetic.clone()),
            ("V".into(), self.potential.clone()),
        ];
        lines.extend(self.definitions.iter().map(|l| (l.name.clone(), l.formula.clone())));
        lines.extend(self.terms.iter().map(|l| (l.name.clone(), l.formula.clone())));
        lines.extend(
            self.mass_matrix
                .iter()
                .map(|e| (format!("M_{{{},{}}}", e.row, e.column), e.formula.clone())),
        );
        let rows = |symbol: &str, lines: &[Line]| {
            lines
                .iter()
                .map(|l| (format!("{symbol}_{{{}}}", l.name), l.formula.clone()))
                .collect::<Vec<_>>()
        };
        lines.extend(rows("c", &self.velocity_terms));
        lines.extend(rows("f", &self.forces));
        lines.extend(self.coefficients.iter().map(|l| (l.name.clone(), l.formula.clone())));
        lines.extend(self.accelerations.iter().map(|l| (l.name.clone(), l.formula.clone())));
        for (left, right) in lines {
            writeln!(out, "\\begin{{dmath*}} {left} = {right} \\end{{dmath*}}")?;
        }
        writeln!(out, "\\end{{document}}")
    }
}

/// Characters with a meaning in LaTeX, escaped.
fn latex_text(text: &str) -> String {
    text.chars()
        .map(|c| match c {
            '\\' => "\\textbackslash{}".to_owned(),
            '#' | '$' | '%' | '&' | '_' | '{' | '}' => format!("\\{c}"),
            '~' | '^' => format!("\\{c}{{}}"),
            _ => c.to_string(),
        })
        .collect()
}

fn section(out: &mut String, title: &str, lines: &[Line]) -> std::fmt::Result {
    if lines.is_empty() {
        return Ok(());
    }
    writeln!(out, "\n{title}")?;
    for line in lines {
        writeln!(out, "  {} = {}", line.name, line.formula)?;
    }
    Ok(())
}

/// At most eight numbers.
fn values_text(values: &[f64]) -> String {
    let shown: Vec<String> = values.iter().take(8).map(|v| format!("{v:.10e}")).collect();
    let rest = if values.len() > 8 { format!(", ... ({} values)", values.len()) } else { String::new() };
    format!("{}{rest}", shown.join(", "))
}

struct Writer<'a> {
    model: &'a Model,
    equations: &'a Equations,
    notation: &'a Notation,
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

    fn definitions(&self) -> Vec<Line> {
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

    /// An energy as the sum of its terms, by their names.
    fn sum_of_terms(&self, symbol: &str, terms: &[Term]) -> String {
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
    fn terms(&self) -> Vec<Line> {
        let model = self.model;
        let energies = [("T", &model.kinetic), ("V", &model.potential), ("R", &model.dissipation)];
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
    fn named(&self, nodes: &[Id]) -> Vec<Line> {
        let mut lines: Vec<Line> = Vec::new();
        for &node in nodes {
            let Some(name) = self.graph().name(node) else { continue };
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

    fn rows(&self, rows: &Rows) -> Vec<Line> {
        let scalars = rows.scalars.iter().enumerate().map(|(i, id)| (Row::Coordinate(i), *id));
        let modal = rows.modal.iter().enumerate().map(|(f, id)| (Row::Modes(f), *id));
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

    fn mass_matrix(&self) -> Vec<Entry> {
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

    fn coefficients(&self, evaluator: &Evaluator) -> Vec<CoefficientLine> {
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
    fn accelerations(&self) -> Vec<Line> {
        let mut lines: Vec<(Row, Line)> = Vec::new();
        for coefficient in &self.equations.coefficients {
            let Some(factor) = &coefficient.factor else { continue };
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
        use crate::graph::Shape;
        let multiplied = expression(self.graph(), self.notation, by);
        match (self.graph().shape(value), self.graph().shape(by)) {
            (Shape::Vector(_), Shape::Vector(_)) => format!("sum_i({name}_i*{multiplied})"),
            (Shape::Matrix(..), _) => format!("sum_j({name}_ij*{})", multiplied.replace("_i", "_j")),
            (Shape::Vector(_), _) if multiplied == "1" => format!("{name}_i"),
            (Shape::Vector(_), _) => format!("{name}_i*{multiplied}"),
            _ if multiplied == "1" => name.to_owned(),
            _ => format!("{name}*{multiplied}"),
        }
    }
}
