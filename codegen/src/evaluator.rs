//! Runs a program at once, with no compiler: every value has a place in one block of
//! memory, every stage is a list of steps over it. Slower than emitted code, the same bits.

use elementary::Function as Elementary;
use model_spec::model::Function;

use crate::program::{Extent, Op, Program, ScaledValue, ValueId};

/// A program with memory to run it in. Nothing is allocated after construction.
pub struct Evaluator {
    program: Program,
    memory: Vec<f64>,
    offsets: Vec<usize>,
    prepare: Vec<ValueId>,
    rates: Vec<ValueId>,
    observables: Vec<ValueId>,
    guards: Vec<ValueId>,
    mass: Vec<ValueId>,
    forces: Vec<ValueId>,
}

/// What a call is made at.
#[derive(Clone, Copy, Debug)]
pub struct Point<'a> {
    /// Time, in s.
    pub t: f64,
    /// State: coordinates, modes, and the rates of both.
    pub state: &'a [f64],
    /// Inputs in the order of the program.
    pub inputs: &'a [f64],
}

impl Evaluator {
    /// Takes a program and prepares it with the specification's parameters.
    pub fn new(program: Program) -> Self {
        let mut offsets = Vec::with_capacity(program.values.len());
        let mut size = 0;
        for value in &program.values {
            offsets.push(size);
            size += value.extent.length();
        }
        let observables = program.per_call(&program.observable_values);
        let guard_values: Vec<ValueId> = program.guards.iter().map(|g| g.value).collect();
        let mut mass_values: Vec<ValueId> =
            program.mass.scalars.iter().flatten().copied().collect();
        mass_values.extend(program.mass.coupling.iter().flatten());
        mass_values.extend(program.mass.modal.iter().flatten().flatten());
        let mut force_values = program.velocity_terms.all();
        force_values.extend(program.forces.all());
        let prepare = (0..program.values.len())
            .map(ValueId)
            .filter(|id| program.value(*id).prepared)
            .collect();
        let mut evaluator = Self {
            memory: vec![0.0; size],
            offsets,
            prepare,
            rates: program.per_call(&program.accelerations.all()),
            observables,
            guards: program.per_call(&guard_values),
            mass: program.per_call(&mass_values),
            forces: program.per_call(&force_values),
            program,
        };
        let defaults = evaluator.program.default_parameters();
        evaluator.prepare(&defaults);
        evaluator
    }

    /// The program.
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// Computes everything that depends on the parameters alone.
    ///
    /// `parameters`: the independent parameters in SI, in the order of the program.
    pub fn prepare(&mut self, parameters: &[f64]) {
        for index in 0..self.prepare.len() {
            let id = self.prepare[index];
            if let Op::Parameter(place) = self.program.values[id.0].op {
                self.memory[self.offsets[id.0]] =
                    parameters.get(place).copied().unwrap_or(f64::NAN);
            } else {
                self.step(id, &NOWHERE);
            }
        }
    }

    /// Whether every prepared pivot of the mass matrix is positive: otherwise the rates
    /// are NaN.
    pub fn pivots_are_positive(&self) -> bool {
        self.program.pivots.iter().all(|id| {
            let matrix = matches!(self.program.value(*id).extent, Extent::Matrix(..));
            self.slice(*id)
                .iter()
                .all(|p| *p > 0.0 || (matrix && *p <= 0.0))
        })
    }

    /// The rates of the state; `out` has as many numbers as the state.
    pub fn rates(&mut self, point: Point<'_>, out: &mut [f64]) {
        run(
            &mut self.memory,
            &self.offsets,
            &self.program,
            &self.rates,
            &point,
        );
        let degrees = self.program.degrees_of_freedom();
        let (velocities, accelerations) = out.split_at_mut(degrees);
        velocities.copy_from_slice(&point.state[degrees..2 * degrees]);
        self.copy_rows(
            &self.program.accelerations.scalars,
            &self.program.accelerations.modal,
            accelerations,
        );
    }

    /// The observables, `energy` and `power` last.
    pub fn observables(&mut self, point: Point<'_>, out: &mut [f64]) {
        run(
            &mut self.memory,
            &self.offsets,
            &self.program,
            &self.observables,
            &point,
        );
        for (value, id) in out.iter_mut().zip(&self.program.observable_values) {
            *value = self.memory[self.offsets[id.0]];
        }
    }

    /// How many switching surfaces there are, those over modes one by one.
    pub fn guard_count(&self) -> usize {
        let extents = self
            .program
            .guards
            .iter()
            .map(|g| self.program.value(g.value).extent);
        extents.map(Extent::length).sum()
    }

    /// The values of the switching surfaces; `out` has [`Evaluator::guard_count`] numbers.
    pub fn guards(&mut self, point: Point<'_>, out: &mut [f64]) {
        run(
            &mut self.memory,
            &self.offsets,
            &self.program,
            &self.guards,
            &point,
        );
        let mut place = 0;
        for guard in &self.program.guards {
            let values = self.slice(guard.value);
            out[place..place + values.len()].copy_from_slice(values);
            place += values.len();
        }
    }

    /// The mass matrix, row by row.
    pub fn mass_matrix(&mut self, point: Point<'_>, out: &mut [f64]) {
        run(
            &mut self.memory,
            &self.offsets,
            &self.program,
            &self.mass,
            &point,
        );
        let size = self.program.degrees_of_freedom();
        let scalars = self.program.coordinates.len();
        out.fill(0.0);
        for row in 0..scalars {
            for column in 0..scalars {
                out[row * size + column] = self.slice(self.program.mass.scalars[row][column])[0];
            }
            for field in 0..self.program.fields.len() {
                let offset = self.program.mode_offset(field);
                for mode in 0..self.program.fields[field].order {
                    let value = self.element(self.program.mass.coupling[row][field], mode);
                    out[row * size + offset + mode] = value;
                    out[(offset + mode) * size + row] = value;
                }
            }
        }
        for (row, blocks) in self.program.mass.modal.iter().enumerate() {
            for (column, block) in blocks.iter().enumerate() {
                let Some(block) = block else { continue };
                let (first_row, first_column) = (
                    self.program.mode_offset(row),
                    self.program.mode_offset(column),
                );
                let columns = self.program.fields[column].order;
                for (place, value) in self.slice(*block).iter().enumerate() {
                    let (r, c) = (place / columns, place % columns);
                    out[(first_row + r) * size + first_column + c] = *value;
                }
            }
        }
    }

    /// Velocity terms c and generalised forces f of M q'' + c = f.
    pub fn bias_and_forces(&mut self, point: Point<'_>, bias: &mut [f64], forces: &mut [f64]) {
        run(
            &mut self.memory,
            &self.offsets,
            &self.program,
            &self.forces,
            &point,
        );
        self.copy_rows(
            &self.program.velocity_terms.scalars,
            &self.program.velocity_terms.modal,
            bias,
        );
        self.copy_rows(
            &self.program.forces.scalars,
            &self.program.forces.modal,
            forces,
        );
    }

    /// The numbers of a value as last computed.
    pub fn slice(&self, id: ValueId) -> &[f64] {
        let start = self.offsets[id.0];
        &self.memory[start..start + self.program.values[id.0].extent.length()]
    }

    fn element(&self, id: ValueId, index: usize) -> f64 {
        match self.program.values[id.0].extent {
            Extent::Scalar => self.memory[self.offsets[id.0]],
            _ => self.memory[self.offsets[id.0] + index],
        }
    }

    fn copy_rows(&self, scalars: &[ValueId], modal: &[ValueId], out: &mut [f64]) {
        for (place, id) in scalars.iter().enumerate() {
            out[place] = self.memory[self.offsets[id.0]];
        }
        for (field, id) in modal.iter().enumerate() {
            let offset = self.program.mode_offset(field);
            for mode in 0..self.program.fields[field].order {
                out[offset + mode] = self.element(*id, mode);
            }
        }
    }

    fn step(&mut self, id: ValueId, point: &Point<'_>) {
        step(&mut self.memory, &self.offsets, &self.program, id, point);
    }
}

const NOWHERE: Point<'static> = Point {
    t: 0.0,
    state: &[],
    inputs: &[],
};

fn run(
    memory: &mut [f64],
    offsets: &[usize],
    program: &Program,
    steps: &[ValueId],
    point: &Point<'_>,
) {
    for id in steps {
        step(memory, offsets, program, *id, point);
    }
}

/// Read access to operands while a value is computed: operands stand before it.
struct Operands<'a> {
    memory: &'a [f64],
    offsets: &'a [usize],
    program: &'a Program,
}

impl<'a> Operands<'a> {
    fn slice(&self, id: ValueId) -> &'a [f64] {
        let start = self.offsets[id.0];
        &self.memory[start..start + self.program.values[id.0].extent.length()]
    }

    /// The operand's numbers and the distance from one element to the next: 0 for a
    /// scalar, which stands for every element.
    fn strided(&self, id: ValueId) -> (&'a [f64], usize) {
        let scalar = self.program.values[id.0].extent == Extent::Scalar;
        (self.slice(id), usize::from(!scalar))
    }

    fn matrix(&self, id: ValueId) -> (&'a [f64], usize, usize) {
        match self.program.values[id.0].extent {
            Extent::Matrix(rows, columns) => (self.slice(id), rows, columns),
            other => (self.slice(id), other.length(), 1),
        }
    }
}

fn step(memory: &mut [f64], offsets: &[usize], program: &Program, id: ValueId, point: &Point<'_>) {
    let value = &program.values[id.0];
    let (before, after) = memory.split_at_mut(offsets[id.0]);
    let out = &mut after[..value.extent.length()];
    let operands = Operands {
        memory: before,
        offsets,
        program,
    };
    let degrees = program.degrees_of_freedom();
    match &value.op {
        Op::Constant(number) => out[0] = *number,
        Op::Table(place) => out.copy_from_slice(&program.tables[*place].values),
        Op::Parameter(_) => {}
        Op::Coordinate(index) => out[0] = point.state[*index],
        Op::Rate(index) => out[0] = point.state[degrees + index],
        Op::ModeCoordinates(field) => {
            let start = program.mode_offset(*field);
            out.copy_from_slice(&point.state[start..start + out.len()]);
        }
        Op::ModeRates(field) => {
            let start = degrees + program.mode_offset(*field);
            out.copy_from_slice(&point.state[start..start + out.len()]);
        }
        Op::Input(index) => out[0] = point.inputs.get(*index).copied().unwrap_or(0.0),
        Op::Time => out[0] = point.t,
        Op::Negate(a) => unary(out, &operands, *a, |a| -a),
        Op::PivotReciprocal(a) => unary(out, &operands, *a, pivot_reciprocal),
        Op::Add(a, b) => binary(out, &operands, *a, *b, |a, b| a + b),
        Op::Subtract(a, b) => binary(out, &operands, *a, *b, |a, b| a - b),
        Op::Multiply(a, b) => binary(out, &operands, *a, *b, |a, b| a * b),
        Op::Divide(a, b) => binary(out, &operands, *a, *b, |a, b| a / b),
        Op::Power(a, b) => binary(out, &operands, *a, *b, |a, b| {
            Elementary::Pow.apply(&[a, b])
        }),
        Op::Call(function, arguments) => match *arguments.as_slice() {
            [a] => unary(out, &operands, a, |a| call(*function, a, f64::NAN)),
            [a, b] => binary(out, &operands, a, b, |a, b| call(*function, a, b)),
            _ => out.fill(f64::NAN),
        },
        Op::Select {
            a,
            b,
            then,
            otherwise,
        } => {
            let (a, b) = (operands.strided(*a), operands.strided(*b));
            let (then, otherwise) = (operands.strided(*then), operands.strided(*otherwise));
            for (i, slot) in out.iter_mut().enumerate() {
                let taken = a.0[i * a.1] > b.0[i * b.1];
                *slot = if taken {
                    then.0[i * then.1]
                } else {
                    otherwise.0[i * otherwise.1]
                };
            }
        }
        Op::Total(a) => out[0] = operands.slice(*a).iter().fold(0.0, |total, x| total + x),
        other => matrix_step(out, value.extent, &operands, other),
    }
}

fn matrix_step(out: &mut [f64], extent: Extent, operands: &Operands<'_>, op: &Op) {
    match op {
        Op::Apply {
            matrix,
            transposed,
            vector,
        } => apply(
            out,
            operands.matrix(*matrix),
            *transposed,
            operands.strided(*vector),
        ),
        Op::Gram {
            left,
            weight,
            right,
        } => {
            let (left, nodes, rows) = operands.matrix(*left);
            let (right, _, columns) = operands.matrix(*right);
            let (weight, stride) = operands.strided(*weight);
            for r in 0..rows {
                for c in 0..columns {
                    out[r * columns + c] = (0..nodes).fold(0.0, |total, g| {
                        total + left[g * rows + r] * weight[g * stride] * right[g * columns + c]
                    });
                }
            }
        }
        Op::GramDiagonal {
            left,
            weight,
            right,
        } => {
            let (left, nodes, modes) = operands.matrix(*left);
            let (right, ..) = operands.matrix(*right);
            let (weight, stride) = operands.strided(*weight);
            for (r, slot) in out.iter_mut().enumerate() {
                *slot = (0..nodes).fold(0.0, |total, g| {
                    total + left[g * modes + r] * weight[g * stride] * right[g * modes + r]
                });
            }
        }
        Op::Assemble {
            diagonal,
            outer,
            matrices,
        } => {
            let Extent::Matrix(_, columns) = extent else {
                return;
            };
            assemble(out, columns, operands, *diagonal, outer, matrices);
        }
        Op::Cholesky(matrix) => {
            let (matrix, size, _) = operands.matrix(*matrix);
            cholesky(out, matrix, size);
        }
        Op::CholeskySolve(factor, vector) => {
            let (factor, size, _) = operands.matrix(*factor);
            let (right, stride) = operands.strided(*vector);
            let columns = if let Extent::Matrix(_, columns) = extent {
                columns
            } else {
                1
            };
            for column in 0..columns {
                cholesky_solve(
                    out,
                    (column, columns),
                    factor,
                    size,
                    (right, stride * columns),
                );
            }
        }
        _ => out.fill(f64::NAN),
    }
}

fn unary(out: &mut [f64], operands: &Operands<'_>, a: ValueId, function: impl Fn(f64) -> f64) {
    let (a, stride) = operands.strided(a);
    for (i, slot) in out.iter_mut().enumerate() {
        *slot = function(a[i * stride]);
    }
}

fn binary(
    out: &mut [f64],
    operands: &Operands<'_>,
    a: ValueId,
    b: ValueId,
    function: impl Fn(f64, f64) -> f64,
) {
    let (a, b) = (operands.strided(a), operands.strided(b));
    for (i, slot) in out.iter_mut().enumerate() {
        *slot = function(a.0[i * a.1], b.0[i * b.1]);
    }
}

/// 1/a for a positive pivot, NaN elsewhere.
fn pivot_reciprocal(a: f64) -> f64 {
    if a > 0.0 { 1.0 / a } else { f64::NAN }
}

/// A function of the expression language; `b` is read by those of two arguments.
pub fn call(function: Function, a: f64, b: f64) -> f64 {
    match function {
        Function::Deadzone => deadzone(a, b),
        Function::Contact => contact(a, b),
        other => match elementary_function(other) {
            Some(elementary) => elementary.apply(&[a, b]),
            None => f64::NAN,
        },
    }
}

/// f_k of Eq. (7).
fn deadzone(p: f64, b: f64) -> f64 {
    if p > b {
        p - b
    } else if p < -b {
        p + b
    } else {
        0.0
    }
}

/// 1 where |p| > b, 0 elsewhere, Eq. (8).
fn contact(p: f64, b: f64) -> f64 {
    if p > b || p < -b { 1.0 } else { 0.0 }
}

/// The elementary function of the same name; `None` for the mesh laws.
pub fn elementary_function(function: Function) -> Option<Elementary> {
    Some(match function {
        Function::Sin => Elementary::Sin,
        Function::Cos => Elementary::Cos,
        Function::Tan => Elementary::Tan,
        Function::Asin => Elementary::Asin,
        Function::Acos => Elementary::Acos,
        Function::Atan => Elementary::Atan,
        Function::Atan2 => Elementary::Atan2,
        Function::Sinh => Elementary::Sinh,
        Function::Cosh => Elementary::Cosh,
        Function::Tanh => Elementary::Tanh,
        Function::Exp => Elementary::Exp,
        Function::Ln => Elementary::Ln,
        Function::Sqrt => Elementary::Sqrt,
        Function::Abs => Elementary::Abs,
        Function::Sign => Elementary::Sign,
        Function::Min => Elementary::Min,
        Function::Max => Elementary::Max,
        Function::Deadzone | Function::Contact => return None,
    })
}

fn apply(
    out: &mut [f64],
    (matrix, rows, columns): (&[f64], usize, usize),
    transposed: bool,
    (vector, stride): (&[f64], usize),
) {
    for (i, slot) in out.iter_mut().enumerate() {
        *slot = if transposed {
            (0..rows).fold(0.0, |total, g| {
                total + matrix[g * columns + i] * vector[g * stride]
            })
        } else {
            (0..columns).fold(0.0, |total, c| {
                total + matrix[i * columns + c] * vector[c * stride]
            })
        };
    }
}

fn assemble(
    out: &mut [f64],
    columns: usize,
    operands: &Operands<'_>,
    diagonal: Option<ValueId>,
    outer: &[(ValueId, ValueId)],
    matrices: &[ScaledValue],
) {
    out.fill(0.0);
    if let Some(diagonal) = diagonal {
        let (diagonal, stride) = operands.strided(diagonal);
        for r in 0..columns {
            out[r * columns + r] += diagonal[r * stride];
        }
    }
    for (u, v) in outer {
        let (u, v) = (operands.strided(*u), operands.strided(*v));
        for (place, slot) in out.iter_mut().enumerate() {
            *slot += u.0[place / columns * u.1] * v.0[place % columns * v.1];
        }
    }
    for scaled in matrices {
        let (matrix, _, width) = operands.matrix(scaled.matrix);
        let (row, column) = (
            operands.strided(scaled.row),
            operands.strided(scaled.column),
        );
        for (place, slot) in out.iter_mut().enumerate() {
            let (r, c) = (place / columns, place % columns);
            let entry = if scaled.transposed {
                matrix[c * width + r]
            } else {
                matrix[r * width + c]
            };
            *slot += row.0[r * row.1] * entry * column.0[c * column.1];
        }
    }
}

/// Row by row, L L^T = matrix; the upper part of `out` becomes 0.
fn cholesky(out: &mut [f64], matrix: &[f64], size: usize) {
    out.fill(0.0);
    for r in 0..size {
        for c in 0..=r {
            let rest = (0..c).fold(matrix[r * size + c], |rest, k| {
                rest - out[r * size + k] * out[c * size + k]
            });
            out[r * size + c] = if r == c {
                if rest > 0.0 {
                    Elementary::Sqrt.apply(&[rest])
                } else {
                    f64::NAN
                }
            } else {
                rest / out[c * size + c]
            };
        }
    }
}

/// Column `column` of the right side, solved into the same column of `out`; both hold
/// `columns` numbers in a row, the right side possibly one number for all rows.
fn cholesky_solve(
    out: &mut [f64],
    (column, columns): (usize, usize),
    factor: &[f64],
    size: usize,
    (right, stride): (&[f64], usize),
) {
    let at = |r: usize| r * columns + column;
    for r in 0..size {
        let rest = (0..r).fold(right[r * stride + column], |rest, k| {
            rest - factor[r * size + k] * out[at(k)]
        });
        out[at(r)] = rest / factor[r * size + r];
    }
    for r in (0..size).rev() {
        let rest = (r + 1..size).fold(out[at(r)], |rest, k| {
            rest - factor[k * size + r] * out[at(k)]
        });
        out[at(r)] = rest / factor[r * size + r];
    }
}
