//! Mode shapes from a CSV file, for example from a finite-element program. The columns are `x, phi_1, phi_2, ...`,
//! with one row for each position. The generator interpolates the shapes.

use std::path::Path;

use crate::adjacent_file;
use crate::diagnostic::Diagnostic;
use crate::source::sha256;
use crate::span::Span;

/// Largest number of rows: each row is a knot of the shapes in emitted code.
pub const MAX_ROWS: usize = 2000;

/// Smallest number of rows: a cubic polynomial needs four.
const MIN_ROWS: usize = 4;

/// Largest number of cells read from a line; no valid table has as many.
const MAX_CELLS: usize = 1000;

/// Largest ratio of a step to its longer neighbour; a larger one is reported as a gap.
const MAX_STEP_RATIO: f64 = 3.0;

/// Smallest norm of an independent shape after orthogonalisation, relative to its norm before.
const MIN_INDEPENDENT_NORM: f64 = 1e-8;

/// Largest distance between the ends of the table and those of the field, relative to the
/// field's length.
const MAX_END_DISTANCE: f64 = 1e-9;

/// Mode shapes at discrete positions.
#[derive(Clone, Debug, PartialEq)]
pub struct ShapeTable {
    /// Name of the file, as in the specification.
    pub file: String,
    /// SHA-256 of the file, in hexadecimal digits.
    pub sha256: String,
    /// Positions x, in m, strictly increasing.
    pub positions: Vec<f64>,
    /// Values of each mode at the positions.
    pub shapes: Vec<Vec<f64>>,
}

impl ShapeTable {
    /// Reads a table with at most `most` shapes from the file with this name, in the folder of a specification or
    /// below. `span` is the position of the name.
    ///
    /// # Errors
    /// The specification has no folder, the name is outside the folder, or the file cannot be read, is too large or
    /// is not UTF-8; also errors of [`Self::parse`].
    pub fn read(
        folder: Option<&Path>,
        span: Span,
        name: &str,
        most: usize,
    ) -> Result<Self, Diagnostic> {
        let refused = |message: String| Diagnostic::error(message).with_span(span, "this table");
        let Some(folder) = folder else {
            return Err(refused(format!(
                "the table \"{name}\" cannot be found: the specification was given as text, without a folder"
            ))
            .with_help("give the specification as a file; sections in a macro and specifications given as text do not support tables"));
        };
        let text = adjacent_file::read(folder, name).map_err(|error| {
            refused(format!("the table \"{name}\" {}", error.0)).with_help(error.1)
        })?;
        Self::parse(name, &text, most).map_err(|fault| {
            refused(format!("{name}:{}:{}: {}", fault.line, fault.column, fault.message)).with_help(
                "write x,phi_1,phi_2,... in the first line, and an increasing position with its values in each other line",
            )
        })
    }

    /// Parses a table with at most `most` shapes.
    ///
    /// # Errors
    /// The header is not `x,phi_1,phi_2,...`, a number is missing or infinite, the positions do not increase or have
    /// a gap, there are too few or too many rows, or the shapes are linearly dependent.
    pub fn parse(file: &str, text: &str, most: usize) -> Result<Self, TableFault> {
        let content = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut lines = (1..).zip(content.lines());
        let header = lines.next().map_or("", |(_, line)| line);
        let count = count_shapes(header, most)?;
        let mut table = Self {
            file: file.to_owned(),
            sha256: sha256(text),
            positions: Vec::new(),
            shapes: vec![Vec::new(); count],
        };
        for (number, line) in lines {
            // A trailing empty line is allowed.
            if !line.trim().is_empty() || content.lines().count() > number {
                table.read_row(number, line)?;
            }
        }
        table.check()?;
        Ok(table)
    }

    fn read_row(&mut self, line: usize, text: &str) -> Result<(), TableFault> {
        if self.positions.len() == MAX_ROWS {
            let message = format!("more than {MAX_ROWS} rows");
            return Err(TableFault::new(line, 1, message));
        }
        let expected = 1 + self.shapes.len();
        let cells = cells(text);
        if cells.len() != expected {
            let message = format!(
                "{} numbers, but the header has {expected} columns",
                cells.len()
            );
            return Err(TableFault::new(line, 1, message));
        }
        for (index, (column, cell)) in cells.into_iter().enumerate() {
            let number = cell.parse().ok().filter(|value: &f64| value.is_finite());
            let number = number.ok_or_else(|| {
                let message = match cell {
                    "" => "a number is missing".to_owned(),
                    cell => format!("`{}` is not a finite number", shorten(cell)),
                };
                TableFault::new(line, column, message)
            })?;
            match index {
                0 => self.push_position(line, column, number)?,
                mode => self.shapes[mode - 1].push(number),
            }
        }
        Ok(())
    }

    fn push_position(&mut self, line: usize, column: usize, x: f64) -> Result<(), TableFault> {
        if let Some(last) = self.positions.last()
            && x <= *last
        {
            let message = format!("x = {x} is not greater than {last} in the line before");
            return Err(TableFault::new(line, column, message));
        }
        self.positions.push(x);
        Ok(())
    }

    fn check(&self) -> Result<(), TableFault> {
        let (rows, modes) = (self.positions.len(), self.shapes.len());
        let least = MIN_ROWS.max(2 * modes + 2);
        if rows < least {
            let message = format!("{rows} rows: {modes} shapes need at least {least}");
            return Err(TableFault::new(rows + 1, 1, message));
        }
        self.check_gaps()?;
        if let Some(mode) = find_dependent_shape(&self.shapes) {
            let message = format!(
                "phi_{} is zero or a linear combination of the shapes before it",
                mode + 1
            );
            return Err(TableFault::new(1, 1, message));
        }
        Ok(())
    }

    fn check_gaps(&self) -> Result<(), TableFault> {
        let steps: Vec<f64> = self
            .positions
            .windows(2)
            .map(|pair| pair[1] - pair[0])
            .collect();
        for (index, step) in steps.iter().enumerate() {
            let before = index.checked_sub(1).and_then(|index| steps.get(index));
            let beside = [before, steps.get(index + 1)].into_iter().flatten();
            let longest = beside.fold(0.0, |longest: f64, step| longest.max(*step));
            if *step > MAX_STEP_RATIO * longest {
                let (from, to) = (self.positions[index], self.positions[index + 1]);
                let message = format!(
                    "a gap from x = {from} to {to}, more than {MAX_STEP_RATIO} times the neighbouring steps"
                );
                return Err(TableFault::new(index + 3, 1, message));
            }
        }
        Ok(())
    }

    /// Checks that the positions span the domain of the field.
    ///
    /// # Errors
    /// The first or last position is not an end of the domain.
    pub fn check_span(&self, from: f64, to: f64) -> Result<(), TableFault> {
        let last = self.positions.len() - 1;
        for (index, end, name) in [(0, from, "from"), (last, to, "to")] {
            let x = self.positions[index];
            let there = (x - end).abs() <= MAX_END_DISTANCE * (to - from).abs();
            if !there {
                let message = format!("x = {x} at this end, but the field has {name} = {end} m");
                return Err(TableFault::new(index + 2, 1, message));
            }
        }
        Ok(())
    }
}

/// Error in a table, with its position in the file.
#[derive(Clone, Debug, PartialEq)]
pub struct TableFault {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// Cause.
    pub message: String,
}

impl TableFault {
    fn new(line: usize, column: usize, message: impl Into<String>) -> Self {
        Self {
            line,
            column,
            message: message.into(),
        }
    }
}

fn count_shapes(header: &str, most: usize) -> Result<usize, TableFault> {
    let cells = cells(header);
    if cells.len() < 2 {
        let message = "no header x,phi_1,phi_2,... with at least one shape";
        return Err(TableFault::new(1, 1, message));
    }
    for (index, (column, name)) in cells.iter().enumerate() {
        let expected = match index {
            0 => "x".to_owned(),
            mode => format!("phi_{mode}"),
        };
        if *name != expected {
            let message = format!("unexpected column `{}`, expected {expected}", shorten(name));
            return Err(TableFault::new(1, *column, message));
        }
    }
    let modes = cells.len() - 1;
    if modes > most {
        let message = format!("{modes} shapes: the highest order is {most}");
        return Err(TableFault::new(1, 1, message));
    }
    Ok(modes)
}

/// Returns the cells of a line, trimmed, each with its column.
fn cells(line: &str) -> Vec<(usize, &str)> {
    let mut column = 1;
    line.split(',')
        .take(MAX_CELLS)
        .map(|cell| {
            let blanks = cell.chars().take_while(|c| c.is_whitespace()).count();
            let place = column + blanks;
            column += cell.chars().count() + 1;
            (place, cell.trim())
        })
        .collect()
}

fn shorten(cell: &str) -> String {
    match cell.char_indices().nth(40) {
        Some((end, _)) => format!("{}...", &cell[..end]),
        None => cell.to_owned(),
    }
}

/// Returns the first shape that depends linearly on earlier shapes. The shapes are orthogonalised twice by the
/// modified Gram-Schmidt process.
fn find_dependent_shape(shapes: &[Vec<f64>]) -> Option<usize> {
    let norm = |shape: &[f64]| shape.iter().map(|v| v * v).sum::<f64>().sqrt();
    let mut directions: Vec<Vec<f64>> = Vec::new();
    for (mode, shape) in shapes.iter().enumerate() {
        // The shape is normalised first, so that squares neither overflow nor underflow.
        let size = shape.iter().fold(0.0, |size: f64, v| size.max(v.abs()));
        let mut rest: Vec<f64> = shape.iter().map(|v| v / size).collect();
        let before = norm(&rest);
        for direction in directions.iter().chain(&directions) {
            let part: f64 = rest.iter().zip(direction).map(|(a, b)| a * b).sum();
            for (value, other) in rest.iter_mut().zip(direction) {
                *value -= part * other;
            }
        }
        let left = norm(&rest);
        // The comparison is false for a shape that is zero everywhere, because `left` is NaN.
        let is_another = left > MIN_INDEPENDENT_NORM * before;
        if !is_another {
            return Some(mode);
        }
        rest.iter_mut().for_each(|value| *value /= left);
        directions.push(rest);
    }
    None
}
