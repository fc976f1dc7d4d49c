//! Emitted Jacobians. Each has a pattern of structural nonzeros, expanded from blocks at compile time, and a
//! function that returns the nonzeros, row by row. The linearisation copies them into dense matrices.

use super::expression::{Writer, array, call, reference, write_assignment};
use super::literals::write_linked_doc;
use super::signature::{Signature, stage_with};
use super::stages::{call_stage, write_stage};
use super::types::write_literal;
use crate::program::{Jacobian, Output, ValueId};
use crate::statements::{EmitResult, File, RequiredFunctions, build_jacobian_stage};

pub(super) fn write_jacobians(
    file: &File<'_>,
    needed: &mut RequiredFunctions,
    writer: &mut Writer,
) -> EmitResult<String> {
    let outputs = &file.program.outputs;
    if outputs.jacobians.is_empty() {
        return Ok(String::new());
    }
    let mut text = String::new();
    for jacobian in &outputs.jacobians {
        text += &write_pattern(jacobian);
        text += &write_stage(file, &build_jacobian_stage(file, jacobian, needed)?, writer);
    }
    if outputs.kinds.contains(&Output::Linearisation) {
        text += LINEARISATION;
        let head = write_linked_doc("Linearisation about a point.");
        let signature = Signature::new("linearise", "Linearisation<T>");
        text += &stage_with(file, &head, &signature, &write_linearisation(file));
    }
    Ok(text + PATTERN)
}

/// Writes the statements of the linearisation, which calls a function for each part.
fn write_linearisation(file: &File<'_>) -> String {
    let parts = [
        "rates",
        "observables",
        "rates_by_state",
        "rates_by_inputs",
        "observables_by_state",
        "observables_by_inputs",
    ];
    let computed =
        parts.map(|part| write_assignment(&format!("let {part}"), call_stage(file, part)) + "\n");
    let fields = ["A", "B", "C", "D"].iter().zip(&parts[2..]);
    let dense =
        fields.map(|(field, part)| format!("{field}: {}.dense(&{part})", part.to_uppercase()));
    let fields: Vec<String> = parts[..2]
        .iter()
        .map(|part| (*part).to_owned())
        .chain(dense)
        .collect();
    computed.concat() + &write_literal("Linearisation", &fields)
}

fn write_pattern(jacobian: &Jacobian<ValueId>) -> String {
    let name = jacobian.name.to_uppercase();
    let blocks: Vec<String> = jacobian
        .entries
        .iter()
        .map(|e| {
            let diagonal = usize::from(e.diagonal);
            format!(
                "[{}, {}, {}, {}, {diagonal}]",
                e.row, e.rows, e.column, e.columns
            )
        })
        .collect();
    let nonzeros = jacobian.nonzeros();
    let blocks = reference(array(&blocks));
    format!(
        "/// Number of structural nonzeros of [`{}`].\n\
         pub const {name}_NONZEROS: usize = {nonzeros};\n\
         /// Positions of the nonzeros in the matrix of {} x {}.\n\
         pub static {name}: Pattern<{nonzeros}> = {};\n",
        jacobian.name,
        jacobian.rows,
        jacobian.columns,
        call("pattern", &[blocks])
    )
}

const PATTERN: &str = "\
/// Positions of the structural nonzeros of a matrix, row by row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pattern<const N: usize> {
    /// Row of each nonzero.
    pub rows: [usize; N],
    /// Column of each nonzero.
    pub columns: [usize; N],
}
impl<const N: usize> Pattern<N> {
    /// Returns the matrix of `R` rows and `C` columns with these nonzeros.
    pub fn dense<T: Scalar, const R: usize, const C: usize>(
        &self,
        nonzeros: &[T; N],
    ) -> [[T; C]; R] {
        let mut matrix = [[T::number(0.0); C]; R];
        for k in 0..N {
            if let Some(row) = matrix.get_mut(self.rows[k]) {
                if let Some(entry) = row.get_mut(self.columns[k]) {
                    *entry = nonzeros[k];
                }
            }
        }
        matrix
    }
}
/// Expands blocks to positions. A block has first row, rows, first column, columns, and 1 if only
/// its diagonal is filled, else 0. Blocks of the same rows are adjacent.
const fn pattern<const B: usize, const N: usize>(
    blocks: &[[usize; 5]; B],
) -> Pattern<N> {
    let mut pattern = Pattern {
        rows: [0; N],
        columns: [0; N],
    };
    let (mut next, mut first) = (0, 0);
    while first < B {
        let [row, rows, _, _, _] = blocks[first];
        let mut last = first;
        while last < B && blocks[last][0] == row {
            last += 1;
        }
        let mut i = 0;
        while i < rows {
            let mut block = first;
            while block < last {
                let [_, _, column, columns, diagonal] = blocks[block];
                let (column, count) = if diagonal == 1 {
                    (column + i, 1)
                } else {
                    (column, columns)
                };
                let mut j = 0;
                while j < count {
                    pattern.rows[next] = row + i;
                    pattern.columns[next] = column + j;
                    next += 1;
                    j += 1;
                }
                block += 1;
            }
            i += 1;
        }
        first = last;
    }
    pattern
}
";

const LINEARISATION: &str = "\
/// Linearisation about a point: rates + A dx + B du, observables + C dx + D du.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linearisation<T = f64> {
    /// Rates at the point.
    pub rates: [T; STATES],
    /// Observables at the point.
    pub observables: [T; OBSERVABLES],
    /// Derivatives of the rates with respect to the state.
    pub A: [[T; STATES]; STATES],
    /// Derivatives of the rates with respect to the inputs.
    pub B: [[T; INPUTS]; STATES],
    /// Derivatives of the observables with respect to the state.
    pub C: [[T; STATES]; OBSERVABLES],
    /// Derivatives of the observables with respect to the inputs.
    pub D: [[T; INPUTS]; OBSERVABLES],
}
";
