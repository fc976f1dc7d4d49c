//! The emitted Jacobians: for each the pattern of its structural nonzeros, as blocks from
//! which the places of all are made at compile time, and a function that returns the
//! nonzeros, row by row. The linearisation puts them into dense matrices.

use super::body::Body;
use super::emit_error::Emitted;
use super::expression::{Expression, array, assignment, infix};
use super::file::File;
use super::functions::Needed;
use super::roots::entry_roots;
use super::signature::stage;
use super::types::literal;
use crate::program::BlockPlace;
use crate::program::{Extent, Jacobian, JacobianBlock, Output, ValueId};

pub(super) fn jacobians(file: &File<'_>, needed: &mut Needed) -> Emitted<String> {
    let outputs = &file.program.outputs;
    if outputs.jacobians.is_empty() {
        return Ok(String::new());
    }
    let mut text = String::new();
    for jacobian in &outputs.jacobians {
        text += &pattern(jacobian);
        text += &nonzeros(file, jacobian, needed)?;
    }
    if outputs.kinds.contains(&Output::Linearisation) {
        text += LINEARISATION;
        text += &stage(
            file,
            "/// The linearisation about a point.\n",
            "linearise",
            "Linearisation<T>",
            &linearise(file),
        );
    }
    Ok(text + PATTERN)
}

/// The statements of the linearisation: every part from its own function.
fn linearise(file: &File<'_>) -> String {
    let arguments = ["t", "state", "inputs", "coefficients"].map(Expression::atom);
    let parts = [
        "rates",
        "observables",
        "rates_by_state",
        "rates_by_inputs",
        "observables_by_state",
        "observables_by_inputs",
    ];
    let call = |part: &str| Expression::call(&format!("{}{part}", file.inlined()), &arguments);
    let computed = parts.map(|part| assignment(&format!("let {part}"), call(part)) + "\n");
    let fields = ["A", "B", "C", "D"].iter().zip(&parts[2..]);
    let dense =
        fields.map(|(field, part)| format!("{field}: {}.dense(&{part})", part.to_uppercase()));
    let fields: Vec<String> = parts[..2]
        .iter()
        .map(|part| (*part).to_owned())
        .chain(dense)
        .collect();
    computed.concat() + &literal("Linearisation", &fields)
}

fn pattern(jacobian: &Jacobian<ValueId>) -> String {
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
    let blocks = Expression::atom(format!("&{}", array(&blocks)));
    format!(
        "/// Structural nonzeros of [`{}`].\n\
         pub const {name}_NONZEROS: usize = {nonzeros};\n\
         /// Where they stand in the matrix of {} x {}.\n\
         pub static {name}: Pattern<{nonzeros}> = {};\n",
        jacobian.name,
        jacobian.rows,
        jacobian.columns,
        Expression::call("pattern", &[blocks])
    )
}

fn nonzeros(file: &File<'_>, jacobian: &Jacobian<ValueId>, needed: &mut Needed) -> Emitted<String> {
    let roots = entry_roots(file.program, jacobian);
    let mut body = file.body(&roots, needed)?;
    let constant = format!("{}_NONZEROS", jacobian.name.to_uppercase());
    body.push(&format!("let mut values = [T::number(0.0); {constant}];"));
    for (entry, BlockPlace { start, width }) in jacobian.entries.iter().zip(jacobian.places()) {
        write_entry(&mut body, entry, start, width)?;
    }
    body.push("values");
    let (what, by) = jacobian
        .name
        .split_once("_by_")
        .unwrap_or((jacobian.name, "state"));
    let head = format!(
        "/// The Jacobian of the {what} by the {by}: its structural nonzeros, row by row, at the\n\
         /// places of [`{}`].\n\
         #[allow(unused_variables, unused_mut)]\n",
        jacobian.name.to_uppercase()
    );
    let result = format!("[T; {constant}]");
    Ok(stage(
        file,
        &head,
        jacobian.name,
        &result,
        &body.statements(),
    ))
}

/// The loop or statement of a block: `start` is the place of its first nonzero, `width` the
/// distance from one row to the next.
fn write_entry(
    body: &mut Body<'_>,
    entry: &JacobianBlock<ValueId>,
    start: usize,
    width: usize,
) -> Emitted<()> {
    let extent = body.program.value(entry.value).extent;
    if let (Extent::Matrix(..), false) = (extent, entry.diagonal) {
        let op = body.program.value(entry.value).op.clone();
        let place = |i: &str, j: &str| {
            let row = infix("+", start, infix("*", width, i));
            format!("values[{}]", infix("+", row, j))
        };
        let loops = body.block_loops(&op, (entry.rows, entry.columns), &place)?;
        body.push(loops.trim_end());
        return Ok(());
    }
    let (count, stride) = if entry.columns > 1 && !entry.diagonal {
        (entry.columns, 1)
    } else {
        (entry.rows, width)
    };
    let value = body.element(entry.value)?;
    if count == 1 && extent == Extent::Scalar {
        body.push(&assignment(&format!("values[{start}]"), value));
        return Ok(());
    }
    let step = if stride == 1 {
        "i".to_owned()
    } else {
        infix("*", stride, "i")
    };
    let place = format!("values[{}]", infix("+", start, step));
    body.push_loop("i", count, &assignment(&place, value));
    Ok(())
}

const PATTERN: &str = "\
/// Where the structural nonzeros of a matrix stand, row by row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pattern<const N: usize> {
    /// The row of each.
    pub rows: [usize; N],
    /// The column of each.
    pub columns: [usize; N],
}
impl<const N: usize> Pattern<N> {
    /// The matrix of `R` rows and `C` columns with these nonzeros.
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
/// The places of blocks: first row, rows, first column, columns, and whether only the diagonal
/// is filled. Blocks of the same rows stand together.
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
/// The linearisation about a point: rates + A dx + B du, observables + C dx + D du.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linearisation<T = f64> {
    /// The rates at the point.
    pub rates: [T; STATES],
    /// The observables at the point.
    pub observables: [T; OBSERVABLES],
    /// The rates by the state.
    pub A: [[T; STATES]; STATES],
    /// The rates by the inputs.
    pub B: [[T; INPUTS]; STATES],
    /// The observables by the state.
    pub C: [[T; STATES]; OBSERVABLES],
    /// The observables by the inputs.
    pub D: [[T; INPUTS]; OBSERVABLES],
}
";
