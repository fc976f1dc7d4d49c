//! Statements for matrices: products, Gram matrices, assembled blocks and Cholesky factors,
//! as loops in the order that the program defines.

use super::body::{Body, looped};
use super::emit_error::{EmitError, Emitted};
use super::expression::{Expression, assignment, reference};
use crate::program::{Extent, Op, ValueId};

impl Body<'_> {
    /// The loop that sums an element of a matrix-vector product or of the diagonal of a Gram
    /// matrix, and the name of the vector.
    pub(super) fn summed_element(&mut self, id: ValueId) -> Emitted<(String, String)> {
        let name = self.names.of(self.program, id, "s")?;
        let (summand, length) = match self.program.value(id).op.clone() {
            Op::Apply {
                matrix,
                transposed,
                vector,
            } => {
                let (rows, columns) = self.matrix_size(matrix);
                let (index, length) = if transposed {
                    ("k][i", rows)
                } else {
                    ("i][k", columns)
                };
                let entry = self.entry(matrix, index)?;
                let vector = self.element_at(vector, "k")?;
                (Expression::multiply(&entry, &vector), length)
            }
            Op::GramDiagonal {
                left,
                weight,
                right,
            } => {
                let (nodes, _) = self.matrix_size(left);
                let (left, right) = (self.entry(left, "k][i")?, self.entry(right, "k][i")?);
                let weight = self.element_at(weight, "k")?;
                let weighted = Expression::multiply(&left, &weight);
                (Expression::multiply(&weighted, &right), nodes)
            }
            _ => return Err(EmitError::misplaced(id, "is no sum of products")),
        };
        let added = add_to(&format!("{name}[i]"), &summand);
        Ok((looped("k", length, &format!("{added}\n")), name))
    }

    pub(super) fn matrix_size(&self, id: ValueId) -> (usize, usize) {
        match self.program.value(id).extent {
            Extent::Matrix(rows, columns) => (rows, columns),
            other => (other.length(), 1),
        }
    }

    pub(super) fn matrix_step(&mut self, id: ValueId, rows: usize, columns: usize) -> Emitted<()> {
        let name = self.names.of(self.program, id, "s")?;
        match self.program.value(id).op.clone() {
            Op::Cholesky(matrix) => {
                self.needed.cholesky = true;
                let matrix = reference(self.numbers(matrix)?);
                let factor = Expression::call("cholesky", &[matrix]);
                self.push(&assignment(&format!("let {name}"), factor));
            }
            Op::Gram {
                left,
                weight,
                right,
            } => {
                let nodes = self.matrix_size(left).0;
                let (left, right) = (self.entry(left, "k][i")?, self.entry(right, "k][j")?);
                let weight = self.element_at(weight, "k")?;
                let weighted = Expression::multiply(&left, &weight);
                let summand = Expression::multiply(&weighted, &right);
                let added = add_to(&format!("{name}[i][j]"), &summand);
                let inner = looped("k", nodes, &format!("{added}\n"));
                self.push(&format!(
                    "let mut {name} = [[T::number(0.0); {columns}]; {rows}];"
                ));
                self.push(looped("i", rows, &looped("j", columns, &inner)).trim_end());
            }
            Op::CholeskySolve(factor, right) => {
                self.needed.cholesky_of_matrix = true;
                let factor = reference(self.numbers(factor)?);
                let right = reference(self.numbers(right)?);
                let solution = Expression::call("cholesky_solve_matrix", &[factor, right]);
                self.push(&assignment(&format!("let {name}"), solution));
            }
            block => {
                self.push(&format!(
                    "let mut {name} = [[T::number(0.0); {columns}]; {rows}];"
                ));
                let place = |i: &str, j: &str| format!("{name}[{i}][{j}]");
                let loops = self.block_loops(&block, (rows, columns), &place)?;
                self.push(loops.trim_end());
            }
        }
        self.bound.insert(id, name);
        Ok(())
    }

    /// Loops that add the parts of an assembled matrix to what stands at `place(i, j)`.
    pub fn block_loops(
        &mut self,
        block: &Op,
        (rows, columns): (usize, usize),
        place: &dyn Fn(&str, &str) -> String,
    ) -> Emitted<String> {
        let Op::Assemble {
            diagonal,
            outer,
            matrices,
        } = block
        else {
            return Err(EmitError::Value(format!(
                "{block:?} is no block of a matrix"
            )));
        };
        let mut statements = String::new();
        if let Some(diagonal) = diagonal {
            let element = self.element(*diagonal)?;
            statements.push_str(&add_to(&place("i", "i"), &element));
            statements.push('\n');
        }
        let mut entries = String::new();
        for (u, v) in outer {
            let (u, v) = (self.element_at(*u, "i")?, self.element_at(*v, "j")?);
            let product = Expression::multiply(&u, &v);
            entries.push_str(&add_to(&place("i", "j"), &product));
            entries.push('\n');
        }
        for scaled in matrices {
            let index = if scaled.transposed { "j][i" } else { "i][j" };
            let element = self.entry(scaled.matrix, index)?;
            let (row, column) = (
                self.element_at(scaled.row, "i")?,
                self.element_at(scaled.column, "j")?,
            );
            let scaled_row = Expression::multiply(&row, &element);
            let product = Expression::multiply(&scaled_row, &column);
            entries.push_str(&add_to(&place("i", "j"), &product));
            entries.push('\n');
        }
        if !entries.is_empty() {
            statements.push_str(&looped("j", columns, &entries));
        }
        Ok(looped("i", rows, &statements))
    }
}

/// An addition to what stands at `place`.
pub(super) fn add_to(place: &str, summand: &Expression) -> String {
    assignment(place, Expression::add(&Expression::atom(place), summand))
}
