//! Report as a LaTeX document. Every formula is a paragraph, because TeX breaks the lines of paragraphs
//! automatically.

use std::collections::BTreeMap;
use std::fmt::Write;

use eomgen_model_spec::model::Function;

use super::types::{Line, Report};
use crate::symbolic::formula::{Formula, prose};

/// Preamble. The second and following lines of a formula are indented.
const HEAD: &str = "\
% Needs the package amsmath and nothing else; compiles as it is, with pdflatex for example.
\\documentclass{article}
\\usepackage{amsmath}
\\setlength{\\parindent}{0pt}
\\setlength{\\parskip}{0.6ex}
\\setlength{\\emergencystretch}{3em}
\\raggedright
\\everypar{\\hangindent=2em}
\\everymath{\\displaystyle}
\\begin{document}
";

impl Report {
    /// Returns the report as a LaTeX document.
    pub fn latex(&self) -> String {
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = self.write_latex(&mut text);
        text
    }

    fn write_latex(&self, out: &mut String) -> std::fmt::Result {
        write!(out, "{HEAD}\\section*{{{}}}\n\n", prose(&self.title))?;
        section(out, "Definitions", &lines(&self.definitions))?;
        section(
            out,
            "Terms of the energies, of the dissipation, and forces",
            &lines(&self.terms),
        )?;
        let energies = [("T", &self.kinetic), ("V", &self.potential)];
        let energies = energies.map(|(name, of)| equation(name, of));
        section(out, "Energies", &energies)?;
        section(out, "Shared subexpressions", &lines(&self.shared))?;
        section(
            out,
            "Mass matrix $M$, by entries (symmetric)",
            &self.write_mass_matrix(),
        )?;
        section(out, "Pivots, which must be positive", &lines(&self.pivots))?;
        section(out, "Velocity terms $c$", &rows("c", &self.velocity_terms))?;
        section(
            out,
            "Generalised forces $f$, with $M\\,\\ddot{q} + c = f$",
            &rows("f", &self.forces),
        )?;
        let state_rates = lines(&self.state_rates);
        section(out, "Rates of first-order states", &state_rates)?;
        section(
            out,
            "Constraints, which are zero",
            &lines(&self.constraints),
        )?;
        section(
            out,
            "Multipliers $\\lambda$, with $M\\,\\ddot{q} + c = f + A^T \\lambda$, $A$ the derivatives of the constraints",
            &lines(&self.multipliers),
        )?;
        let coefficients = self.coefficients.iter();
        let coefficients: Vec<String> = coefficients
            .map(|line| equation(&line.name.latex(), &line.formula))
            .collect();
        section(out, "Coefficients", &coefficients)?;
        section(out, "Accelerations", &lines(&self.accelerations))?;
        let guards: Vec<String> = self.guards.iter().map(Formula::latex).collect();
        section(
            out,
            "The equations switch when one of these functions changes its sign",
            &guards,
        )?;
        section(out, "Piecewise functions", &self.piecewise_functions())?;
        self.write_sentences(out)?;
        writeln!(out, "\\end{{document}}")
    }

    fn write_mass_matrix(&self) -> Vec<String> {
        let entries = self.mass_matrix.iter();
        entries
            .map(|entry| {
                let name = format!("M_{{{},{}}}", entry.row.latex(), entry.column.latex());
                equation(&name, &entry.formula)
            })
            .collect()
    }

    fn write_sentences(&self, out: &mut String) -> std::fmt::Result {
        let linearity = match &self.linearity.formula {
            Some(formula) => format!("{} {}.", self.linearity.text, inline_math(&formula.latex())),
            None => self.linearity.to_string(),
        };
        write!(
            out,
            "{linearity}\n\n{}\n\n",
            prose(&self.describe_solution())
        )
    }

    /// Returns the definitions of the piecewise functions that occur in the formulas.
    fn piecewise_functions(&self) -> Vec<String> {
        let mut found = BTreeMap::new();
        self.for_each_formula(&mut |formula| {
            formula.visit(&mut |part| {
                if let Formula::Call(function, _) = part
                    && let Some(definition) = definition(*function)
                {
                    found.insert(function.name(), definition.to_owned());
                }
            });
        });
        found.into_values().collect()
    }

    fn for_each_formula(&self, see: &mut impl FnMut(&Formula)) {
        let parts = [
            &self.definitions,
            &self.terms,
            &self.shared,
            &self.pivots,
            &self.velocity_terms,
            &self.forces,
            &self.state_rates,
            &self.constraints,
            &self.multipliers,
            &self.accelerations,
        ];
        parts
            .into_iter()
            .flatten()
            .for_each(|line| see(&line.formula));
        self.mass_matrix
            .iter()
            .for_each(|entry| see(&entry.formula));
        self.coefficients.iter().for_each(|line| see(&line.formula));
        self.guards.iter().for_each(&mut *see);
    }
}

/// Returns the definition of a piecewise function by cases, as LaTeX.
fn definition(function: Function) -> Option<&'static str> {
    match function {
        Function::Deadzone => Some(
            "\\operatorname{deadzone}(p, b) = \\begin{cases} p - b & p > b\\\\ 0 & |p| \\le b\\\\ p + b & p < -b \\end{cases}",
        ),
        Function::Contact => Some(
            "\\operatorname{contact}(p, b) = \\begin{cases} 1 & |p| > b\\\\ 0 & |p| \\le b \\end{cases}",
        ),
        Function::Above => Some(
            "\\operatorname{above}(p) = \\begin{cases} 1 & p > 0\\\\ 0 & p \\le 0 \\end{cases}",
        ),
        Function::Sign => Some(
            "\\operatorname{sign}(p) = \\begin{cases} 1 & p > 0\\\\ 0 & p = 0\\\\ -1 & p < 0 \\end{cases}",
        ),
        _ => None,
    }
}

fn equation(name: &str, formula: &Formula) -> String {
    format!("{name} = {}", formula.latex())
}

fn lines(lines: &[Line]) -> Vec<String> {
    let lines = lines.iter();
    lines
        .map(|line| equation(&line.name.latex(), &line.formula))
        .collect()
}

fn rows(letter: &str, lines: &[Line]) -> Vec<String> {
    let lines = lines.iter();
    lines
        .map(|line| {
            equation(
                &format!("{letter}_{{{}}}", line.name.latex()),
                &line.formula,
            )
        })
        .collect()
}

fn section(out: &mut String, title: &str, formulas: &[String]) -> std::fmt::Result {
    if formulas.is_empty() {
        return Ok(());
    }
    write!(out, "\\subsection*{{{title}}}\n\n")?;
    for formula in formulas {
        write!(out, "{}\n\n", inline_math(formula))?;
    }
    Ok(())
}

fn inline_math(formula: &str) -> String {
    format!("${formula}$")
}
