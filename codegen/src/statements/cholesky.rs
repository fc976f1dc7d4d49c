//! Statements of the Cholesky factorisation and of the solution with the factor.

use super::expression::{Array, Expression};
use super::index::{Index, Span};
use super::statement::{Place, Statement};
use crate::program::cholesky::{MatrixLoops, Range, factorise, solve, solve_column};
use eomgen_elementary::Function as Elementary;

/// Indices of the elements of a matrix in an array.
#[derive(Clone, Debug)]
pub enum Elements {
    /// Row and column.
    InRows,
    /// One index, with this number of columns.
    Flat(Index),
    /// Row of a matrix with one column.
    InColumn,
}

/// Matrix in the recorded statements.
#[derive(Clone, Debug)]
pub struct MatrixOperand {
    /// Array that contains the elements. A result is an array of the stage.
    array: Array,
    elements: Elements,
}

impl MatrixOperand {
    /// Refers to an array of the stage.
    pub fn local(name: &str, elements: Elements) -> Self {
        Self::new(Array::local(name), elements)
    }

    /// Refers to an array.
    pub fn new(array: Array, elements: Elements) -> Self {
        Self { array, elements }
    }

    fn indices(&self, [row, column]: [&Index; 2]) -> Vec<Index> {
        match &self.elements {
            Elements::InRows => vec![row.clone(), column.clone()],
            Elements::Flat(columns) => {
                vec![row.clone().times(columns.clone()).offset_by(column.clone())]
            }
            Elements::InColumn => vec![row.clone()],
        }
    }
}

/// Recorder of statements.
#[derive(Debug)]
pub struct Recorder {
    /// Name of the variable for a number less a sum of products.
    remainder: &'static str,
    lines: Vec<Statement>,
}

impl Recorder {
    /// Creates a recorder. `remainder` names the variable for remainders; the stage must not use this name.
    pub fn new(remainder: &'static str) -> Self {
        Self {
            remainder,
            lines: Vec::new(),
        }
    }

    /// Returns the statements that factorise a matrix of n rows into an array of zeros.
    pub fn factorise(
        mut self,
        n: impl Into<Index>,
        matrix: &MatrixOperand,
        factor: &MatrixOperand,
    ) -> Vec<Statement> {
        factorise(&mut self, &n.into(), matrix, factor);
        self.lines
    }

    /// Returns the statements that solve for all of m columns, or for one.
    pub fn solve(
        mut self,
        (n, m): (impl Into<Index>, Option<Index>),
        factor: &MatrixOperand,
        both: [&MatrixOperand; 2],
    ) -> Vec<Statement> {
        let n = n.into();
        match m {
            Some(m) => solve(&mut self, [&n, &m], factor, both),
            None => solve_column(&mut self, (&n, &0.into()), factor, both),
        }
        self.lines
    }
}

impl MatrixLoops for Recorder {
    type Index = Index;
    type Number = Expression;
    type Matrix = MatrixOperand;

    fn each(
        &mut self,
        name: &'static str,
        range: Range<Index>,
        mut body: impl FnMut(&mut Self, &Index),
    ) {
        let before = std::mem::take(&mut self.lines);
        body(self, &name.into());
        let lines = std::mem::replace(&mut self.lines, before);
        self.lines.push(Statement::Loop {
            index: name,
            span: span(range),
            lines,
        });
    }

    fn subtract_products(
        &mut self,
        first: Expression,
        range: Range<Index>,
        mut factors: impl FnMut(&mut Self, &Index) -> [Expression; 2],
    ) -> Expression {
        const INDEX: &str = "k";
        let [a, b] = factors(self, &INDEX.into());
        self.lines.push(Statement::Remainder {
            name: self.remainder,
            first,
            index: INDEX,
            span: span(range),
            product: Expression::multiply(&a, &b),
        });
        Expression::name(self.remainder)
    }

    fn get_element(&mut self, matrix: &MatrixOperand, place: [&Index; 2]) -> Expression {
        Expression::Element(matrix.array.clone(), matrix.indices(place))
    }

    fn set_element(&mut self, matrix: &MatrixOperand, place: [&Index; 2], value: Expression) {
        if let Array::Local(name) = &matrix.array {
            let place = Place::new(&**name, matrix.indices(place));
            self.lines.push(Statement::Assign(place, value));
        }
    }

    fn divide(&mut self, a: Expression, b: Expression) -> Expression {
        Expression::divide(&a, &b)
    }

    fn root_or_nan(&mut self, a: Expression) -> Expression {
        let root = Expression::Call(Elementary::Sqrt.name(), vec![a.clone()]);
        let [zero, nan] = [0.0, f64::NAN].map(Expression::Number);
        Expression::Select(Box::new([a, zero, root, nan]))
    }
}

fn span(range: Range<Index>) -> Span {
    match range {
        Range::First(n) => Span::between(0, n),
        Range::Reversed(n) => Span {
            reversed: true,
            ..Span::between(0, n)
        },
        Range::After(i, n) => Span::between(i.offset_by(1), n),
    }
}
