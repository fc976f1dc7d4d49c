//! Emitted modules of the model's programs, used as machine code by the evaluator.

use eomgen_codegen::program::evaluator::{MachineCode, Places, Point, Stage};
use eomgen_codegen::program::{Op, Program};

/// Array of an emitted module.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Array {
    /// Independent parameters.
    Parameters,
    /// Inputs.
    Inputs,
    /// State.
    State,
    /// Rates of the state.
    Rates,
    /// Observables.
    Observables,
    /// Switching functions.
    Guards,
}

/// Functions of an emitted module and access to its arrays.
pub trait ModuleFunctions: Send + Sync {
    /// Computes the coefficients from the parameters.
    fn prepare(&self);

    /// Computes the rates at a time, s.
    fn rates(&self, t: f64);

    /// Computes the observables at a time, s.
    fn observables(&self, t: f64);

    /// Computes the switching functions at a time, s.
    fn guards(&self, t: f64);

    /// Writes numbers to the start of an array.
    fn write(&self, array: Array, numbers: &[f64]);

    /// Reads numbers from the start of an array.
    fn read(&self, array: Array, numbers: &mut [f64]);
}

/// Machine code of a program: its emitted module computes rates, observables and switching functions.
pub struct ModuleCode<F> {
    functions: F,
    stages: Vec<Stage>,
    /// Indices in the evaluator's memory.
    parameters: Vec<usize>,
    observables: Vec<usize>,
    guards: Vec<usize>,
}

impl<F: ModuleFunctions> ModuleCode<F> {
    /// Combines a program with the functions of its module.
    pub fn new(program: &Program, functions: F) -> Self {
        let indices = Places::new(program);
        // A parameter without effect on any value has no index in memory; the number in the specification is
        // used.
        let mut parameters = vec![usize::MAX; program.parameters.len()];
        for id in program.ids() {
            if let Op::Parameter(index) = program.value(id).op {
                parameters[index] = indices.offset(id);
            }
        }
        let observables = program.observable_values.iter();
        let guards = program.guards.iter().flat_map(|guard| {
            let first = indices.offset(guard.value);
            first..first + program.value(guard.value).extent.length()
        });
        let guards: Vec<usize> = guards.collect();
        let mut stages = vec![Stage::Rates, Stage::Observables];
        if !guards.is_empty() {
            stages.push(Stage::Guards);
        }
        Self {
            functions,
            stages,
            parameters,
            observables: observables.map(|id| indices.offset(*id)).collect(),
            guards,
        }
    }

    fn set_point(&self, point: &Point<'_>) {
        self.functions.write(Array::State, point.state);
        self.functions.write(Array::Inputs, point.inputs);
    }

    fn read_into(&self, array: Array, indices: &[usize], memory: &mut [f64]) {
        let mut numbers = vec![0.0; indices.len()];
        self.functions.read(array, &mut numbers);
        for (index, number) in indices.iter().zip(numbers) {
            memory[*index] = number;
        }
    }
}

impl<F: ModuleFunctions> MachineCode for ModuleCode<F> {
    fn stages(&self) -> &[Stage] {
        &self.stages
    }

    fn initial_memory(&self) -> &[f64] {
        &[]
    }

    fn prepare(&self, memory: &mut [f64]) {
        let mut parameters = vec![0.0; self.parameters.len()];
        self.functions.read(Array::Parameters, &mut parameters);
        for (slot, index) in parameters.iter_mut().zip(&self.parameters) {
            *slot = memory.get(*index).copied().unwrap_or(*slot);
        }
        self.functions.write(Array::Parameters, &parameters);
        self.functions.prepare();
    }

    fn compute(&self, stage: Stage, memory: &mut [f64], point: &Point<'_>) {
        self.set_point(point);
        match stage {
            Stage::Observables => {
                self.functions.observables(point.t);
                self.read_into(Array::Observables, &self.observables, memory);
            }
            Stage::Guards => {
                self.functions.guards(point.t);
                self.read_into(Array::Guards, &self.guards, memory);
            }
            // The evaluator computes the other stages; the rates have a separate function.
            _ => {}
        }
    }

    fn rates(&self, _: &mut [f64], point: &Point<'_>, out: &mut [f64]) {
        self.set_point(point);
        self.functions.rates(point.t);
        self.functions.read(Array::Rates, out);
    }
}
