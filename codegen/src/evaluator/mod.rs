//! Runs a program at once, with no compiler: every value has a place in one block of
//! memory, every stage is a list of steps over it. Slower than emitted code, the same bits.

mod functions;
mod matrices;
mod step;

use crate::program::{Extent, Op, Program, ValueId};
pub use functions::{call, elementary_function};
use step::step;

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
                .all(|p| p.is_finite() && (matrix || *p > 0.0))
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
