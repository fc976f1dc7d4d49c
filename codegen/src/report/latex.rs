//! The report as a LaTeX document.

use std::fmt::Write;

use super::{Line, Report};

impl Report {
    /// As a LaTeX document.
    pub fn latex(&self) -> String {
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = self.write_latex(&mut text);
        text
    }

    fn write_latex(&self, out: &mut String) -> std::fmt::Result {
        writeln!(
            out,
            "\\documentclass{{article}}\n\\usepackage{{amsmath,breqn}}"
        )?;
        writeln!(
            out,
            "\\begin{{document}}\n\\section*{{{}}}",
            latex_text(&self.title)
        )?;
        let mut lines: Vec<(String, String)> = vec![
            ("T".into(), self.kinetic.clone()),
            ("V".into(), self.potential.clone()),
        ];
        lines.extend(
            self.definitions
                .iter()
                .map(|l| (l.name.clone(), l.formula.clone())),
        );
        lines.extend(
            self.terms
                .iter()
                .map(|l| (l.name.clone(), l.formula.clone())),
        );
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
        lines.extend(
            self.coefficients
                .iter()
                .map(|l| (l.name.clone(), l.formula.clone())),
        );
        lines.extend(
            self.accelerations
                .iter()
                .map(|l| (l.name.clone(), l.formula.clone())),
        );
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
