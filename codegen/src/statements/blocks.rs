//! Statements for matrices: products, Gram matrices, assembled blocks and Cholesky factors, as loops in the
//! order that the program defines.

use super::body::Body;
use super::emit_error::{EmitError, EmitResult};
use super::expression::Expression;
use super::index::Index;
use super::needed::Helper;
use super::statement::{Place, Statement};
use crate::program::{Extent, Op, ValueId};

impl Body<'_> {
    /// Returns the loop that sums one element of a matrix-vector product, or one diagonal element of a Gram matrix,
    /// and the name of the result vector.
    pub(super) fn summed_element(&mut self, id: ValueId) -> EmitResult<(Statement, String)> {
        let name = self.name(id)?;
        let (summand, length) = match self.program.value(id).op.clone() {
            Op::Apply {
                matrix,
                transposed,
                vector,
            } => {
                let (rows, columns) = self.matrix_size(matrix);
                let (indices, length) = if transposed {
                    (["k", "i"], rows)
                } else {
                    (["i", "k"], columns)
                };
                let entry = self.entry(matrix, indices)?;
                let vector = self.element_at(vector, "k")?;
                (Expression::multiply(&entry, &vector), length)
            }
            Op::GramDiagonal {
                left,
                weight,
                right,
            } => {
                let (nodes, _) = self.matrix_size(left);
                let (left, right) = (
                    self.entry(left, ["k", "i"])?,
                    self.entry(right, ["k", "i"])?,
                );
                let weight = self.element_at(weight, "k")?;
                let weighted = Expression::multiply(&left, &weight);
                (Expression::multiply(&weighted, &right), nodes)
            }
            _ => return Err(EmitError::misplaced_value(id, "is not a sum of products")),
        };
        let added = Statement::add_to(Place::new(&*name, [Index::Variable("i")]), &summand);
        Ok((Statement::loop_over("k", length, vec![added]), name))
    }

    pub(super) fn matrix_size(&self, id: ValueId) -> (usize, usize) {
        match self.program.value(id).extent {
            Extent::Matrix(rows, columns) => (rows, columns),
            other => (other.length(), 1),
        }
    }

    pub(super) fn matrix_step(
        &mut self,
        id: ValueId,
        rows: usize,
        columns: usize,
    ) -> EmitResult<()> {
        let name = self.name(id)?;
        match self.program.value(id).op.clone() {
            Op::Cholesky(matrix) => {
                self.needed.add(Helper::Cholesky);
                let matrix = self.numbers(matrix)?;
                self.push(Statement::Cholesky {
                    name: name.clone(),
                    matrix,
                    rows,
                });
            }
            Op::Gram {
                left,
                weight,
                right,
            } => {
                let nodes = self.matrix_size(left).0;
                let (left, right) = (
                    self.entry(left, ["k", "i"])?,
                    self.entry(right, ["k", "j"])?,
                );
                let weight = self.element_at(weight, "k")?;
                let weighted = Expression::multiply(&left, &weight);
                let summand = Expression::multiply(&weighted, &right);
                let place = Place::new(&*name, ["i", "j"].map(Index::Variable));
                let added = Statement::add_to(place, &summand);
                let inner = Statement::loop_over("k", nodes, vec![added]);
                self.push(Statement::Zeros(name.clone(), vec![rows, columns]));
                let row = Statement::loop_over("j", columns, vec![inner]);
                self.push(Statement::loop_over_elements(rows, row));
            }
            Op::CholeskySolve(factor, right) => {
                self.needed.add(Helper::CholeskyOfMatrix);
                let factor = self.numbers(factor)?;
                let right = self.numbers(right)?;
                self.push(Statement::CholeskySolve {
                    name: name.clone(),
                    factor,
                    right,
                    rows,
                    columns: Some(columns),
                });
            }
            block => {
                self.push(Statement::Zeros(name.clone(), vec![rows, columns]));
                let place = |i: &'static str, j: &'static str| {
                    Place::new(&*name, [i, j].map(Index::Variable))
                };
                let loops = self.block_loops(&block, (rows, columns), &place)?;
                self.push(loops);
            }
        }
        self.bound.insert(id, name);
        Ok(())
    }

    /// Returns loops that add the parts of an assembled matrix to the elements at `place(i, j)`.
    pub fn block_loops(
        &mut self,
        block: &Op,
        (rows, columns): (usize, usize),
        place: &dyn Fn(&'static str, &'static str) -> Place,
    ) -> EmitResult<Statement> {
        let Op::Assemble {
            diagonal,
            outer,
            matrices,
        } = block
        else {
            return Err(EmitError::Value(format!(
                "{block:?} is not a block of a matrix"
            )));
        };
        let mut statements = Vec::new();
        if let Some(diagonal) = diagonal {
            let element = self.element(*diagonal)?;
            statements.push(Statement::add_to(place("i", "i"), &element));
        }
        let mut entries = Vec::new();
        for (u, v) in outer {
            let (u, v) = (self.element_at(*u, "i")?, self.element_at(*v, "j")?);
            let product = Expression::multiply(&u, &v);
            entries.push(Statement::add_to(place("i", "j"), &product));
        }
        for scaled in matrices {
            let indices = if scaled.transposed {
                ["j", "i"]
            } else {
                ["i", "j"]
            };
            let element = self.entry(scaled.matrix, indices)?;
            let (row, column) = (
                self.element_at(scaled.row, "i")?,
                self.element_at(scaled.column, "j")?,
            );
            let scaled_row = Expression::multiply(&row, &element);
            let product = Expression::multiply(&scaled_row, &column);
            entries.push(Statement::add_to(place("i", "j"), &product));
        }
        if !entries.is_empty() {
            statements.push(Statement::loop_over("j", columns, entries));
        }
        Ok(Statement::loop_over("i", rows, statements))
    }
}
