//! Statements for matrices: products, Gram matrices, assembled blocks and Cholesky factors,
//! as loops in the order that the program defines.

use super::EmitError;
use super::body::{Body, Emitted, looped, reference};
use super::expression::{Expression, assignment, infix};
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
                let entry = self.array(matrix)?;
                let vector = self.element_at(vector, "k")?;
                let (entry, length) = if transposed {
                    (format!("{entry}[k][i]"), rows)
                } else {
                    (format!("{entry}[i][k]"), columns)
                };
                let entry = Expression::atom(entry);
                (Expression::multiply(&entry, &vector), length)
            }
            Op::GramDiagonal {
                left,
                weight,
                right,
            } => {
                let (nodes, _) = self.matrix_size(left);
                let (left, right) = (self.array(left)?, self.array(right)?);
                let weight = self.element_at(weight, "k")?;
                let left = Expression::atom(format!("{left}[k][i]"));
                let right = Expression::atom(format!("{right}[k][i]"));
                let weighted = Expression::multiply(&left, &weight);
                (Expression::multiply(&weighted, &right), nodes)
            }
            _ => (Expression::number(f64::NAN), 1),
        };
        let added = infix("+=", format!("{name}[i]"), summand);
        Ok((looped("k", length, &format!("{added};\n")), name))
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
                let matrix = reference(self.array(matrix)?);
                let factor = Expression::call("cholesky", &[matrix]);
                self.push(&assignment(&format!("let {name}"), factor));
            }
            Op::Gram {
                left,
                weight,
                right,
            } => {
                let nodes = self.matrix_size(left).0;
                let (left, right) = (self.array(left)?, self.array(right)?);
                let weight = self.element_at(weight, "k")?;
                let left = Expression::atom(format!("{left}[k][i]"));
                let right = Expression::atom(format!("{right}[k][j]"));
                let weighted = Expression::multiply(&left, &weight);
                let summand = Expression::multiply(&weighted, &right);
                let added = infix("+=", format!("{name}[i][j]"), summand);
                let inner = looped("k", nodes, &format!("{added};\n"));
                self.push(&format!("let mut {name} = [[0.0; {columns}]; {rows}];"));
                self.push(looped("i", rows, &looped("j", columns, &inner)).trim_end());
            }
            Op::CholeskySolve(..) => {
                return Err(EmitError::Value(
                    "a solved matrix stands in no emitted stage".to_owned(),
                ));
            }
            block => {
                self.push(&format!("let mut {name} = [[0.0; {columns}]; {rows}];"));
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
            return Ok(String::new());
        };
        let mut statements = String::new();
        if let Some(diagonal) = diagonal {
            let element = self.element(*diagonal)?;
            statements.push_str(&infix("+=", place("i", "i"), element));
            statements.push_str(";\n");
        }
        let mut entries = String::new();
        for (u, v) in outer {
            let (u, v) = (self.element_at(*u, "i")?, self.element_at(*v, "j")?);
            let product = Expression::multiply(&u, &v);
            entries.push_str(&infix("+=", place("i", "j"), product));
            entries.push_str(";\n");
        }
        for scaled in matrices {
            let matrix = self.array(scaled.matrix)?;
            let (row, column) = (
                self.element_at(scaled.row, "i")?,
                self.element_at(scaled.column, "j")?,
            );
            let element = if scaled.transposed {
                format!("{matrix}[j][i]")
            } else {
                format!("{matrix}[i][j]")
            };
            let scaled_row = Expression::multiply(&row, &Expression::atom(element));
            let product = Expression::multiply(&scaled_row, &column);
            entries.push_str(&infix("+=", place("i", "j"), product));
            entries.push_str(";\n");
        }
        if !entries.is_empty() {
            statements.push_str(&looped("j", columns, &entries));
        }
        Ok(looped("i", rows, &statements))
    }
}
