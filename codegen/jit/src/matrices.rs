//! Matrix operations in memory, with the order of summation that the program defines. A loop accumulates the sum of
//! one element or of two adjacent elements.

use cranelift_codegen::ir::{InstBuilder, Value, types};
use eomgen_codegen::program::cholesky::{self, MatrixLoops, Range};
use eomgen_codegen::program::{Extent, Op, ScaledValue, ValueId};

use crate::lanes::Array;
use crate::lanes::{ElementRef, Lanes};
use crate::stage::Writer;

/// Matrix in memory, row by row. All elements of a scalar are equal.
#[derive(Clone, Copy, Debug)]
pub struct Matrix {
    array: Array,
    rows: usize,
    columns: usize,
}

impl Writer<'_, '_, '_> {
    /// Computes a matrix operation and stores its result in memory.
    pub fn matrix_operation(&mut self, id: ValueId) {
        let out = self.matrix_of_shape(id, self.place(id));
        match &self.program.value(id).op {
            Op::Apply {
                matrix,
                transposed,
                vector,
            } => self.apply(out, *matrix, *transposed, *vector),
            Op::Gram {
                left,
                weight,
                right,
            } => self.gram(out, [*left, *weight, *right]),
            Op::GramDiagonal {
                left,
                weight,
                right,
            } => self.gram_diagonal(out, [*left, *weight, *right]),
            Op::Assemble {
                diagonal,
                outer,
                matrices,
            } => self.assemble(out, *diagonal, outer, matrices),
            Op::Cholesky(matrix) => self.cholesky(out, *matrix),
            Op::CholeskySolve(factor, right) => self.cholesky_solve(out, *factor, *right),
            // All other operations are computed element by element.
            other => self.defect = Some(format!("{other:?} is not a matrix operation")),
        }
    }

    fn matrix_of_shape(&self, id: ValueId, array: Array) -> Matrix {
        let (rows, columns) = match self.program.value(id).extent {
            Extent::Matrix(rows, columns) => (rows, columns),
            other => (other.length(), 1),
        };
        Matrix {
            array,
            rows,
            columns,
        }
    }

    fn matrix(&self, id: ValueId) -> Matrix {
        let array = self.array(id).unwrap_or_else(|| self.place(id));
        self.matrix_of_shape(id, array)
    }

    /// Returns element (row, column) in one lane, or this element and its right neighbour in two lanes.
    fn entry(&mut self, matrix: Matrix, row: Value, column: ElementRef) -> Value {
        let array = self.row(matrix, row);
        self.load(array, column)
    }

    fn row(&mut self, matrix: Matrix, row: Value) -> Array {
        let bytes = self
            .instructions()
            .imul_imm_u(row, (matrix.columns * 8) as i64);
        let base = self.instructions().iadd(matrix.array.base, bytes);
        Array {
            base,
            ..matrix.array
        }
    }

    fn element_at(&mut self, index: Value) -> ElementRef {
        let moving = self.instructions().imul_imm_u(index, 8);
        ElementRef {
            moving: Some(moving),
            ..ElementRef::single(0)
        }
    }

    /// Returns element `index` of a vector. All elements of a scalar are equal.
    fn vector_element(&mut self, id: ValueId, index: Value, lanes: Lanes) -> Value {
        if self.program.value(id).extent == Extent::Scalar {
            return self.number(id, lanes);
        }
        let at = self.element_at(index);
        let array = self.matrix(id).array;
        let value = self.load(array, at);
        match lanes {
            Lanes::One => value,
            Lanes::Two => self.instructions().splat(types::F64X2, value),
        }
    }

    /// Sums `count` summands in order; the initial value is 0.
    fn sum(
        &mut self,
        count: usize,
        lanes: Lanes,
        summand: impl FnOnce(&mut Self, Value) -> Value,
    ) -> Value {
        let zero = self.literal(0.0, lanes);
        let sums = self.count(count, &[zero], |writer, index, sums| {
            let summand = summand(writer, index);
            vec![writer.instructions().fadd(sums[0], summand)]
        });
        sums[0]
    }

    fn apply(&mut self, out: Matrix, matrix: ValueId, transposed: bool, vector: ValueId) {
        let matrix = self.matrix(matrix);
        if transposed {
            self.loop_over_elements(out.rows, |writer, at| {
                let total = writer.sum(matrix.rows, at.lanes, |writer, g| {
                    let entry = writer.entry(matrix, g, at);
                    let factor = writer.vector_element(vector, g, at.lanes);
                    writer.instructions().fmul(entry, factor)
                });
                writer.store(total, out.array, at);
            });
            return;
        }
        self.count(out.rows, &[], |writer, i, _| {
            let row = writer.row(matrix, i);
            let total = writer.sum(matrix.columns, Lanes::One, |writer, c| {
                let at = writer.element_at(c);
                let entry = writer.load(row, at);
                let factor = writer.vector_element(vector, c, Lanes::One);
                writer.instructions().fmul(entry, factor)
            });
            let at = writer.element_at(i);
            writer.store(total, out.array, at);
            Vec::new()
        });
    }

    fn gram(&mut self, out: Matrix, [left, weight, right]: [ValueId; 3]) {
        let (left, right) = (self.matrix(left), self.matrix(right));
        self.count(out.rows, &[], |writer, r, _| {
            let row = writer.row(out, r);
            let place = writer.element_at(r);
            writer.loop_over_elements(out.columns, |writer, at| {
                let total = writer.sum(left.rows, at.lanes, |writer, g| {
                    let entry = writer.entry(left, g, place);
                    let factor = writer.vector_element(weight, g, Lanes::One);
                    let weighted = writer.instructions().fmul(entry, factor);
                    let weighted = writer.broadcast(weighted, at.lanes);
                    let other = writer.entry(right, g, at);
                    writer.instructions().fmul(weighted, other)
                });
                writer.store(total, row, at);
            });
            Vec::new()
        });
    }

    fn broadcast(&mut self, number: Value, lanes: Lanes) -> Value {
        match lanes {
            Lanes::One => number,
            Lanes::Two => self.instructions().splat(types::F64X2, number),
        }
    }

    fn gram_diagonal(&mut self, out: Matrix, [left, weight, right]: [ValueId; 3]) {
        let (left, right) = (self.matrix(left), self.matrix(right));
        self.loop_over_elements(out.rows, |writer, at| {
            let total = writer.sum(left.rows, at.lanes, |writer, g| {
                let entry = writer.entry(left, g, at);
                let factor = writer.vector_element(weight, g, at.lanes);
                let weighted = writer.instructions().fmul(entry, factor);
                let other = writer.entry(right, g, at);
                writer.instructions().fmul(weighted, other)
            });
            writer.store(total, out.array, at);
        });
    }

    fn assemble(
        &mut self,
        out: Matrix,
        diagonal: Option<ValueId>,
        outer: &[(ValueId, ValueId)],
        matrices: &[ScaledValue],
    ) {
        self.loop_over_elements(out.rows * out.columns, |writer, at| {
            let zero = writer.literal(0.0, at.lanes);
            writer.store(zero, out.array, at);
        });
        if let Some(diagonal) = diagonal {
            self.count(out.columns, &[], |writer, r, _| {
                let row = writer.row(out, r);
                let at = writer.element_at(r);
                let zero = writer.literal(0.0, Lanes::One);
                let element = writer.vector_element(diagonal, r, Lanes::One);
                let sum = writer.instructions().fadd(zero, element);
                writer.store(sum, row, at);
                Vec::new()
            });
        }
        if outer.is_empty() && matrices.is_empty() {
            return;
        }
        self.count(out.rows, &[], |writer, r, _| {
            let row = writer.row(out, r);
            writer.count(out.columns, &[], |writer, c, _| {
                let at = writer.element_at(c);
                let mut sum = writer.load(row, at);
                for (u, v) in outer {
                    let u = writer.vector_element(*u, r, Lanes::One);
                    let v = writer.vector_element(*v, c, Lanes::One);
                    let product = writer.instructions().fmul(u, v);
                    sum = writer.instructions().fadd(sum, product);
                }
                for scaled in matrices {
                    let product = writer.scaled_entry(scaled, r, c);
                    sum = writer.instructions().fadd(sum, product);
                }
                writer.store(sum, row, at);
                Vec::new()
            });
            Vec::new()
        });
    }

    /// Computes (row_r * matrix_rc) * column_c.
    fn scaled_entry(&mut self, scaled: &ScaledValue, r: Value, c: Value) -> Value {
        let matrix = self.matrix(scaled.matrix);
        let (row, column) = if scaled.transposed { (c, r) } else { (r, c) };
        let at = self.element_at(column);
        let entry = self.entry(matrix, row, at);
        let left = self.vector_element(scaled.row, r, Lanes::One);
        let right = self.vector_element(scaled.column, c, Lanes::One);
        let product = self.instructions().fmul(left, entry);
        self.instructions().fmul(product, right)
    }

    fn cholesky(&mut self, out: Matrix, matrix: ValueId) {
        let n = self.index(out.rows);
        let matrix = Operand::Matrix(self.matrix(matrix));
        // The upper triangle in the memory of the factor is always 0.
        cholesky::factorise(self, &n, &matrix, &Operand::Matrix(out));
    }

    fn cholesky_solve(&mut self, out: Matrix, factor: ValueId, right: ValueId) {
        let right = match self.program.value(right).extent {
            Extent::Scalar => Operand::Repeated(self.number(right, Lanes::One)),
            _ => Operand::Matrix(self.matrix(right)),
        };
        let size = [out.rows, out.columns].map(|length| self.index(length));
        let factor = Operand::Matrix(self.matrix(factor));
        let both = [&right, &Operand::Matrix(out)];
        cholesky::solve(self, size.each_ref(), &factor, both);
    }

    /// Returns the bounds of a loop. For a reversed loop the bounds count from its end.
    fn bounds(&mut self, range: &Range<Value>) -> (Value, Value) {
        match *range {
            Range::First(n) | Range::Reversed(n) => (self.index(0), n),
            Range::After(i, n) => (self.instructions().iadd_imm_u(i, 1), n),
        }
    }

    /// Returns the index at a position of a loop.
    fn index_at(&mut self, range: &Range<Value>, position: Value) -> Value {
        match *range {
            Range::First(_) | Range::After(..) => position,
            Range::Reversed(n) => {
                let last = self.instructions().iadd_imm_s(n, -1);
                self.instructions().isub(last, position)
            }
        }
    }
}

/// Operand of the factorisation or of the solution.
#[derive(Clone, Copy, Debug)]
pub enum Operand {
    Matrix(Matrix),
    /// One number in all elements.
    Repeated(Value),
}

impl MatrixLoops for Writer<'_, '_, '_> {
    type Index = Value;
    type Number = Value;
    type Matrix = Operand;

    fn each(&mut self, _: &str, range: Range<Value>, mut body: impl FnMut(&mut Self, &Value)) {
        let bounds = self.bounds(&range);
        self.range(bounds, &[], |writer, position, _| {
            let index = writer.index_at(&range, position);
            body(writer, &index);
            Vec::new()
        });
    }

    fn subtract_products(
        &mut self,
        first: Value,
        range: Range<Value>,
        mut factors: impl FnMut(&mut Self, &Value) -> [Value; 2],
    ) -> Value {
        let bounds = self.bounds(&range);
        let rests = self.range(bounds, &[first], |writer, position, rests| {
            let index = writer.index_at(&range, position);
            let [a, b] = factors(writer, &index);
            let product = writer.instructions().fmul(a, b);
            vec![writer.instructions().fsub(rests[0], product)]
        });
        rests[0]
    }

    fn get_element(&mut self, matrix: &Operand, [row, column]: [&Value; 2]) -> Value {
        match *matrix {
            Operand::Matrix(matrix) => {
                let column = self.element_at(*column);
                self.entry(matrix, *row, column)
            }
            Operand::Repeated(number) => number,
        }
    }

    fn set_element(&mut self, matrix: &Operand, [row, column]: [&Value; 2], value: Value) {
        if let Operand::Matrix(matrix) = *matrix {
            let column = self.element_at(*column);
            let row = self.row(matrix, *row);
            self.store(value, row, column);
        }
    }

    fn divide(&mut self, a: Value, b: Value) -> Value {
        self.instructions().fdiv(a, b)
    }

    fn root_or_nan(&mut self, a: Value) -> Value {
        self.positive_root(a)
    }
}
