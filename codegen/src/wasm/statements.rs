//! Statements as instructions.

use super::code::Code;
use crate::program::PARTIAL_SUMS;
use crate::statements::{
    Array, Elements, EmitResult, Expression, Index, MatrixOperand, Place, Recorder, Span, Statement,
};

/// Name of the variable for a remainder. It contains a space, so no name of a model is equal to it.
const REMAINDER: &str = "the rest";

impl Code<'_> {
    pub(super) fn statements(&mut self, statements: &[Statement]) -> EmitResult<()> {
        statements.iter().try_for_each(|one| self.statement(one))
    }

    fn statement(&mut self, statement: &Statement) -> EmitResult<()> {
        match statement {
            Statement::Let(name, value) => self.bind(name, value),
            Statement::Zeros(name, lengths) => {
                let region = self.array(name, lengths)?;
                self.zero(region, lengths.iter().product())
            }
            Statement::Flag(name) => {
                let flag = self.flag(name);
                self.instructions().i32_const(1).local_set(flag);
                Ok(())
            }
            Statement::Assign(place, value) => self.assign(place, value),
            Statement::Loop { index, span, lines } => {
                self.write_loop_over(index, span, |code| code.statements(lines))
            }
            Statement::Remainder {
                name,
                first,
                index,
                span,
                product,
            } => self.remainder((name, first), (index, span), product),
            Statement::Sum {
                name,
                length,
                element,
            } => self.sum(name, *length, element),
            Statement::Cholesky { name, matrix, rows } => {
                let region = self.array(name, &[*rows, *rows])?;
                self.zero(region, rows * rows)?;
                let [matrix, factor] = [matrix.clone(), Array::local(name)]
                    .map(|array| MatrixOperand::new(array, Elements::InRows));
                let lines = Recorder::new(REMAINDER).factorise(*rows, &matrix, &factor);
                self.statements(&lines)
            }
            Statement::CholeskySolve {
                name,
                factor,
                right,
                rows,
                columns,
            } => {
                let lengths: Vec<usize> = [*rows].into_iter().chain(*columns).collect();
                self.array(name, &lengths)?;
                let elements = columns.map_or(Elements::InColumn, |_| Elements::InRows);
                let both = [right.clone(), Array::local(name)]
                    .map(|array| MatrixOperand::new(array, elements.clone()));
                let size = (*rows, columns.map(Index::from));
                let factor = MatrixOperand::new(factor.clone(), Elements::InRows);
                let lines = Recorder::new(REMAINDER).solve(size, &factor, both.each_ref());
                self.statements(&lines)
            }
        }
    }

    /// Computes a number less a sum of products, subtracted in order, and stores it under a name.
    fn remainder(
        &mut self,
        (name, first): (&str, &Expression),
        (index, span): (&'static str, &Span),
        product: &Expression,
    ) -> EmitResult<()> {
        self.bind(name, first)?;
        let rest = self.local_index(name)?;
        self.write_loop_over(index, span, |code| {
            code.expression(&Expression::subtract(&Expression::name(name), product))?;
            code.instructions().local_set(rest);
            Ok(())
        })
    }

    /// Computes a number and stores it under a name.
    pub(super) fn bind(&mut self, name: &str, value: &Expression) -> EmitResult<()> {
        self.expression(value)?;
        let variable = self.number(name);
        self.instructions().local_set(variable);
        Ok(())
    }

    /// Assigns to an element or a flag.
    pub(super) fn assign(&mut self, place: &Place, value: &Expression) -> EmitResult<()> {
        if place.indices.is_empty() {
            self.expression(value)?;
            let flag = self.local_index(&place.name)?;
            self.instructions().local_set(flag);
            return Ok(());
        }
        let region = self.region(&place.name)?;
        let to = self.address(region, &place.indices)?;
        self.expression(value)?;
        self.instructions().f64_store(to);
        Ok(())
    }

    /// Computes a sum in eight partial sums: sum k contains the elements k, k + 8, k + 16, ... in this order. The
    /// partial sums are then added pairwise.
    fn sum(&mut self, name: &str, length: usize, element: &Expression) -> EmitResult<()> {
        if length == 0 {
            return self.bind(name, &Expression::Number(0.0));
        }
        // This name contains a space, so no name of a model is equal to it.
        let parts = format!("parts of {name}");
        let count = length.min(PARTIAL_SUMS);
        self.array(&parts, &[count])?;
        let part = |at: Index| Place::new(&*parts, [at]);
        self.write_loop("i", (0, count), |code| {
            code.assign(&part("i".into()), element)
        })?;
        // Element i is added to partial sum k = i mod 8.
        self.write_loop("i", (count, length), |code| {
            let (i, k) = (code.local_index("i")?, code.flag("k"));
            let mut put = code.instructions();
            put.local_get(i).i32_const(PARTIAL_SUMS as i32);
            put.i32_rem_u().local_set(k);
            let sum = Expression::add(&part("k".into()).value(), element);
            code.assign(&part("k".into()), &sum)
        })?;
        let terms = (0..count).map(|place| part(place.into()).value());
        self.bind(name, &pairwise_sum(terms.collect()))
    }
}

/// Returns the pairwise sum of terms. In each round adjacent terms are added, and an odd last term is kept for the
/// next round.
fn pairwise_sum(mut terms: Vec<Expression>) -> Expression {
    while terms.len() > 1 {
        let pairs = terms.chunks(2).map(|pair| match pair {
            [a, b] => Expression::add(a, b),
            rest => rest[0].clone(),
        });
        terms = pairs.collect();
    }
    terms.pop().unwrap_or(Expression::Number(0.0))
}
