//! Report as plain text.

use std::fmt::Write;

use super::types::{Line, Report};

impl Report {
    /// Returns the report as plain text.
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
        section(
            out,
            "Terms of the energies (T, V), of the dissipation (R), and forces",
            &self.terms,
        )?;
        writeln!(
            out,
            "\nEnergies\n  T = {}\n  V = {}",
            self.kinetic, self.potential
        )?;
        section(out, "Shared subexpressions", &self.shared)?;
        writeln!(out, "\nMass matrix M, by entries (symmetric)")?;
        for entry in &self.mass_matrix {
            writeln!(
                out,
                "  M[{}, {}] = {}",
                entry.row, entry.column, entry.formula
            )?;
        }
        section(out, "Pivots, which must be positive", &self.pivots)?;
        section(out, "Velocity terms c", &self.velocity_terms)?;
        section(
            out,
            "Generalised forces f, with M q'' + c = f",
            &self.forces,
        )?;
        section(out, "Rates of first-order states", &self.state_rates)?;
        section(out, "Constraints, which are zero", &self.constraints)?;
        section(
            out,
            "Multipliers lambda, with M q'' + c = f + A^T lambda, A the derivatives of the constraints",
            &self.multipliers,
        )?;
        if !self.coefficients.is_empty() {
            writeln!(out, "\nCoefficients")?;
            for line in &self.coefficients {
                writeln!(out, "  {} = {}", line.name, line.formula)?;
                if !line.values.is_empty() {
                    let unit = line.unit.as_deref().filter(|unit| *unit != "1");
                    let unit = unit.map(|unit| format!(" {unit}")).unwrap_or_default();
                    writeln!(out, "      = {}{unit}", format_values(&line.values))?;
                }
            }
        }
        section(out, "Accelerations", &self.accelerations)?;
        if !self.guards.is_empty() {
            writeln!(
                out,
                "\nThe equations switch when one of these functions changes its sign"
            )?;
            for guard in &self.guards {
                writeln!(out, "  {guard}")?;
            }
        }
        writeln!(out, "\n{}", self.linearity)?;
        writeln!(out, "{}", self.describe_solution())
    }

    pub(super) fn describe_solution(&self) -> String {
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
        let order: Vec<String> = solution.order.iter().map(ToString::to_string).collect();
        format!(
            "Solved without pivoting: {modes}{interfaces}{} ({} operations per call; {} in the most expensive order).",
            order.join(", "),
            solution.operations,
            solution.dearest
        )
    }
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

fn format_values(values: &[f64]) -> String {
    let shown: Vec<String> = values.iter().take(8).map(|v| format!("{v:.10e}")).collect();
    let rest = if values.len() > 8 {
        format!(", ... ({} values)", values.len())
    } else {
        String::new()
    };
    format!("{}{rest}", shown.join(", "))
}
