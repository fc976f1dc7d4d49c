//! Sparse matrices in the compressed-column format of CasADi, built from structural nonzeros in row order.

use std::ops::Range;

use super::super::expression::write_initialiser;
use super::super::names::fill_template;
use crate::program::{GradientDerivative, Jacobian, Program, ValueId};

/// Structural nonzero: its position in the matrix, and its index among the nonzeros in row order.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Nonzero {
    column: usize,
    row: usize,
    index: usize,
}

pub(super) struct Columns {
    rows: usize,
    columns: usize,
    /// Nonzeros, sorted by column and then by row.
    nonzeros: Vec<Nonzero>,
}

impl Columns {
    fn new(rows: usize, columns: usize, mut nonzeros: Vec<Nonzero>) -> Self {
        nonzeros.sort_unstable();
        Self {
            rows,
            columns,
            nonzeros,
        }
    }

    pub(super) fn zero(rows: usize, columns: usize) -> Self {
        Self::new(rows, columns, Vec::new())
    }

    /// Returns one dense column.
    pub(super) fn dense(rows: usize) -> Self {
        let nonzero = |row| Nonzero {
            column: 0,
            row,
            index: row,
        };
        Self::new(rows, 1, (0..rows).map(nonzero).collect())
    }

    /// Collects the structural nonzeros of a Jacobian with this number of columns.
    pub(super) fn from_jacobian(jacobian: &Jacobian<ValueId>, columns: usize) -> Self {
        let mut nonzeros = Vec::new();
        for (block, place) in jacobian.entries.iter().zip(jacobian.places()) {
            for i in 0..block.rows {
                for j in 0..block.width() {
                    nonzeros.push(Nonzero {
                        column: block.column + if block.diagonal { i } else { j },
                        row: block.row + i,
                        index: place.start + i * place.width + j,
                    });
                }
            }
        }
        Self::new(jacobian.rows, columns, nonzeros)
    }

    /// Collects the structural nonzeros of the Hessian block with these rows and columns.
    pub(super) fn hessian_block(
        derivative: &GradientDerivative<ValueId>,
        rows: &Range<usize>,
        columns: &Range<usize>,
    ) -> Self {
        let mut nonzeros = Vec::new();
        for block in &derivative.rows {
            for row in (block.first..block.first + block.count).filter(|row| rows.contains(row)) {
                let depends = block.columns.iter().cloned().flatten();
                for column in depends.filter(|column| columns.contains(column)) {
                    nonzeros.push(Nonzero {
                        column: column - columns.start,
                        row: row - rows.start,
                        index: row,
                    });
                }
            }
        }
        nonzeros.sort_unstable();
        nonzeros.dedup();
        Self::new(rows.len(), columns.len(), nonzeros)
    }

    pub(super) fn transpose(&self) -> Self {
        let turned = self.nonzeros.iter().map(|nonzero| Nonzero {
            column: nonzero.row,
            row: nonzero.column,
            ..*nonzero
        });
        Self::new(self.columns, self.rows, turned.collect())
    }

    pub(super) fn count(&self) -> usize {
        self.nonzeros.len()
    }

    /// Writes CasADi's sparsity: rows, columns, first nonzero of each column, row of each nonzero.
    pub(super) fn write_sparsity(&self, program: &Program, name: &str) -> String {
        let starts = (0..=self.columns)
            .map(|column| self.nonzeros.partition_point(|known| known.column < column));
        let numbers = [self.rows, self.columns].into_iter().chain(starts);
        let numbers = numbers.chain(self.nonzeros.iter().map(|nonzero| nonzero.row));
        write_array(program, "casadi_int", &format!("{name}_sparsity"), numbers)
    }

    /// Writes the row-order index of each nonzero in column order.
    pub(super) fn write_order(&self, program: &Program, name: &str) -> String {
        let indices = self.nonzeros.iter().map(|nonzero| nonzero.index);
        write_array(program, "int", &format!("{name}_order"), indices)
    }
}

/// Writes a constant array with sixteen numbers per line. An empty list is written as one 0, because C has no empty
/// arrays.
fn write_array(
    program: &Program,
    element_type: &str,
    name: &str,
    numbers: impl Iterator<Item = usize>,
) -> String {
    let mut numbers: Vec<String> = numbers.map(|number| number.to_string()).collect();
    if numbers.is_empty() {
        numbers.push("0".to_owned());
    }
    let lines: Vec<String> = numbers.chunks(16).map(|line| line.join(", ")).collect();
    let head = format!("static const {element_type} NAME_{name}[{}]", numbers.len());
    format!(
        "{} = {};\n",
        fill_template(program, &head),
        write_initialiser(&lines)
    )
}
