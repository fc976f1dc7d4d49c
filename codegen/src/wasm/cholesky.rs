//! Cholesky factorisation and solution, with the order of operations of the other backends.

use super::code::Code;
use eomgen_elementary::Function as Elementary;

use crate::program::Extent;
use crate::statements::{Array, EmitResult, Expression, Index, Place};

pub(super) struct Solution<'s> {
    pub(super) name: &'s str,
    pub(super) factor: &'s Array,
    pub(super) right: &'s Array,
    pub(super) rows: usize,
    /// Number of columns if the right-hand side is a matrix.
    pub(super) columns: Option<usize>,
}

/// Name of the remainder after the products so far; names of a model contain no space.
const REMAINDER: &str = "the rest";

/// Name of the index that counts rows from the last.
const FROM_THE_END: &str = "from the end";

impl Code<'_> {
    /// Computes the named lower factor L of a symmetric matrix L L^T; NaN if it is not positive definite.
    pub(super) fn cholesky(&mut self, name: &str, matrix: &Array, rows: usize) -> EmitResult<()> {
        let region = self.array(name, &[rows, rows])?;
        self.zero(region, rows * rows)?;
        let factor = Array::local(name);
        let (i, j, k) = (
            Index::Variable("i"),
            Index::Variable("j"),
            Index::Variable("k"),
        );
        let at = |row: &Index, column: &Index| {
            Expression::Element(factor.clone(), vec![row.clone(), column.clone()])
        };
        let place = |row: &Index, column: &Index| Place::new(name, [row.clone(), column.clone()]);
        self.write_loop("i", (0, rows), |code| {
            let entry = |row: &Index, column: &Index| {
                Expression::Element(matrix.clone(), vec![row.clone(), column.clone()])
            };
            code.write_loop_between("j", (&Index::Number(0), &i), |code| {
                code.bind(REMAINDER, &entry(&i, &j))?;
                code.subtract_products(&j, &Expression::multiply(&at(&i, &k), &at(&j, &k)))?;
                let quotient = Expression::divide(&Expression::name(REMAINDER), &at(&j, &j));
                code.assign(&place(&i, &j), &quotient)
            })?;
            code.bind(REMAINDER, &entry(&i, &i))?;
            code.subtract_products(&i, &Expression::multiply(&at(&i, &k), &at(&i, &k)))?;
            let rest = Expression::name(REMAINDER);
            let root = Expression::Call(Elementary::Sqrt.name(), vec![rest.clone()]);
            let parts = [
                rest,
                Expression::Number(0.0),
                root,
                Expression::Number(f64::NAN),
            ];
            code.assign(&place(&i, &i), &Expression::Select(Box::new(parts)))
        })
    }

    /// Computes the named solution of L L^T X = right.
    pub(super) fn cholesky_solve(&mut self, solution: &Solution<'_>) -> EmitResult<()> {
        let Solution { name, rows, .. } = *solution;
        let columns = solution.columns.unwrap_or(1);
        let region = self.memory.allocate(Extent::Matrix(rows, columns))?;
        self.name_array(name, region);
        let last = rows.saturating_sub(1);
        let at = |array: &Array, row: &Index, column: &Index| {
            Expression::Element(array.clone(), vec![row.clone(), column.clone()])
        };
        let factor = |row: &Index, column: &Index| at(solution.factor, row, column);
        let x = |row: &Index| at(&Array::local(name), row, &"j".into());
        let place = |row: &Index| Place::new(name, [row.clone(), "j".into()]);
        let rest = || Expression::name(REMAINDER);
        let (i, k) = (Index::Variable("i"), Index::Variable("k"));
        self.write_loop("j", (0, columns), |code| {
            code.write_loop("i", (0, rows), |code| {
                let right = match solution.columns {
                    Some(_) => at(solution.right, &i, &"j".into()),
                    None => Expression::Element(solution.right.clone(), vec![i.clone()]),
                };
                code.bind(REMAINDER, &right)?;
                code.subtract_products(&i, &Expression::multiply(&factor(&i, &k), &x(&k)))?;
                code.assign(&place(&i), &Expression::divide(&rest(), &factor(&i, &i)))
            })?;
            // Rows from the last to the first.
            code.write_loop(FROM_THE_END, (0, rows), |code| {
                let (down, row) = (code.local_index(FROM_THE_END)?, code.flag("i"));
                let mut put = code.instructions();
                put.i32_const(last as i32).local_get(down);
                put.i32_sub().local_set(row);
                code.bind(REMAINDER, &x(&i))?;
                let product = Expression::multiply(&factor(&k, &i), &x(&k));
                code.subtract_products_between((&i.clone().offset_by(1), &rows.into()), &product)?;
                code.assign(&place(&i), &Expression::divide(&rest(), &factor(&i, &i)))
            })
        })
    }

    /// Subtracts products for k from 0 to an index from the remainder, in order.
    fn subtract_products(&mut self, to: &Index, product: &Expression) -> EmitResult<()> {
        self.subtract_products_between((&Index::Number(0), to), product)
    }

    /// Subtracts products for k between two indices from the remainder, in order.
    fn subtract_products_between(
        &mut self,
        range: (&Index, &Index),
        product: &Expression,
    ) -> EmitResult<()> {
        let rest = self.local_index(REMAINDER)?;
        self.write_loop_between("k", range, |code| {
            code.expression(&Expression::subtract(&Expression::name(REMAINDER), product))?;
            code.instructions().local_set(rest);
            Ok(())
        })
    }
}
