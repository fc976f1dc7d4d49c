//! Statements as instructions.

use super::code::Code;
use crate::program::PARTIAL_SUMS;
use crate::statements::{
    Array, Elements, EmitResult, Expression, Index, MatrixOperand, Place, Recorder, Span, Statement,
};

/// Name of a remainder of products; names of a model contain no space.
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

    /// Computes a named number less products, subtracted in order.
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

    /// Computes a named number.
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

    /// Computes a sum: each of the first elements begins a partial sum, every eighth element after it is
    /// added in order, then neighbours are added in pairs.
    fn sum(&mut self, name: &str, length: usize, element: &Expression) -> EmitResult<()> {
        if length == 0 {
            return self.bind(name, &Expression::Number(0.0));
        }
        // Names of a model contain no space.
        let parts = format!("parts of {name}");
        let count = length.min(PARTIAL_SUMS);
        self.array(&parts, &[count])?;
        let part = |at: Index| Place::new(&*parts, [at]);
        self.write_loop("i", (0, count), |code| {
            code.assign(&part("i".into()), element)
        })?;
        // Element i belongs to the partial sum with its index within its block.
        self.write_loop("i", (count, length), |code| {
            let (i, k) = (code.local_index("i")?, code.flag("k"));
            let mut put = code.instructions();
            put.local_get(i).i32_const(PARTIAL_SUMS as i32);
            put.i32_rem_u().local_set(k);
            let sum = Expression::add(&part("k".into()).value(), element);
            code.assign(&part("k".into()), &sum)
        })?;
        let terms = (0..count).map(|place| part(place.into()).value());
        self.bind(name, &in_pairs(terms.collect()))
    }
}

/// Adds neighbours in pairs until one is left; an odd last number moves on to the next round.
fn in_pairs(mut terms: Vec<Expression>) -> Expression {
    while terms.len() > 1 {
        let pairs = terms.chunks(2).map(|pair| match pair {
            [a, b] => Expression::add(a, b),
            rest => rest[0].clone(),
        });
        terms = pairs.collect();
    }
    terms.pop().unwrap_or(Expression::Number(0.0))
}
