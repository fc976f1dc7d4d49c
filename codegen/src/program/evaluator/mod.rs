//! Evaluation of a program without a compiler. All values are stored in one block of memory, and every stage is a
//! list of steps. The evaluator is slower than emitted code; its results are bit-identical. Machine code for the
//! stages can replace the steps.

mod bounds;
mod bounds_memory;
mod code;
mod corners;
mod enclosure;
mod fixed_step;
mod functions;
mod impacts;
mod matrices;
mod number;
mod operands;
mod outputs;
mod places;
mod point;
mod sliding;
mod step;

use eomgen_model_spec::ids::FieldId;
use std::sync::Arc;

use crate::program::{Argument, Extent, Op, Program, ValueId, Variable};
pub use bounds::Stretch;
use bounds_memory::BoundsMemory;
pub use code::{MachineCode, Stage};
pub use corners::CornerValues;
pub use enclosure::{DEGREE, Enclosure};
pub use fixed_step::StepMemory;
pub(crate) use fixed_step::{
    MAX_LAST_CHANGE, MAX_SETTLED_ROUNDINGS, MAX_SWEEPS, SWEEPS_BETWEEN_CONTACTS,
};
pub use functions::{call, elementary};
pub use impacts::{FrictionValues, ImpactValues};
pub use number::Number;
pub use places::Places;
pub use point::Point;
pub use sliding::SlidingValues;
pub(crate) use step::step;

/// Program with memory for its values. No memory is allocated after construction.
pub struct Evaluator {
    program: Program,
    memory: Vec<f64>,
    places: Places,
    /// Parameter values, each with its index among the independent parameters.
    parameters: Vec<(ValueId, usize)>,
    /// Values that the caller supplies as arguments, such as weights.
    arguments: Vec<(Argument, Variable, ValueId)>,
    guard_count: usize,
    prepare: Vec<ValueId>,
    /// Steps of each stage, in the order of [`Stage::ALL`].
    stages: [Vec<ValueId>; Stage::ALL.len()],
    code: Option<Arc<dyn MachineCode>>,
    /// True for each stage that machine code computes.
    by_code: [bool; Stage::ALL.len()],
    /// Prepared values that are not stored as coefficients; functions in single precision recompute them.
    recomputed: Vec<ValueId>,
    /// Memory of the steps in single precision, if the evaluator uses single precision.
    single: Option<Vec<f32>>,
    /// Memory of bounds, allocated when bounds are first computed.
    bounds: Option<BoundsMemory>,
}

/// State of an element of a prepared pivot of the mass matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PivotState {
    /// Positive and finite; for a factor of a matrix, finite.
    Positive,
    /// Zero or negative.
    NotPositive,
    /// Infinite or NaN.
    NotFinite,
}

impl Evaluator {
    /// Prepares a program with the parameters of the specification.
    pub fn new(program: Program) -> Self {
        let prepare = program
            .ids()
            .filter(|id| program.value(*id).parameter_only)
            .collect();
        let parameters = program
            .ids()
            .filter_map(|id| match program.value(id).op {
                Op::Parameter(place) => Some((id, place)),
                _ => None,
            })
            .collect();
        let arguments = program.ids().filter_map(|id| match program.value(id).op {
            Op::Argument(argument, variable) => Some((argument, variable, id)),
            _ => None,
        });
        let arguments = arguments.collect();
        let places = Places::new(&program);
        let guards = program.guards.iter();
        let guard_extents = guards.map(|guard| program.value(guard.value).extent);
        let mut evaluator = Self {
            guard_count: guard_extents.map(Extent::length).sum(),
            memory: vec![0.0; places.size()],
            places,
            parameters,
            arguments,
            prepare,
            stages: Stage::ALL.map(|stage| program.per_call(&stage.roots(&program))),
            code: None,
            by_code: [false; Stage::ALL.len()],
            recomputed: Vec::new(),
            single: None,
            bounds: None,
            program,
        };
        let defaults = evaluator.program.default_parameters();
        evaluator.prepare(&defaults);
        evaluator
    }

    /// Prepares a program whose stages are computed by the machine code `code`.
    pub fn with_code(program: Program, code: Arc<dyn MachineCode>) -> Self {
        let mut evaluator = Self::new(program);
        evaluator.memory.extend_from_slice(code.initial_memory());
        for stage in code.stages() {
            evaluator.by_code[*stage as usize] = true;
        }
        evaluator.code = Some(code);
        evaluator
    }

    /// Switches the evaluator to single precision. The results are bit-identical to emitted code in `f32` with
    /// coefficients that are prepared in double precision and converted. Times, states and inputs must be exactly
    /// representable in single precision.
    ///
    /// `coefficients` are the prepared values that emitted functions read; all other prepared values are recomputed
    /// in each function.
    pub fn in_single_precision(mut self, coefficients: &[ValueId]) -> Self {
        self.code = None;
        self.by_code = [false; Stage::ALL.len()];
        self.single = Some(vec![0.0; self.places.size()]);
        self.recomputed = self.prepare.clone();
        self.recomputed.retain(|id| !coefficients.contains(id));
        let defaults = self.program.default_parameters();
        self.prepare(&defaults);
        self
    }

    /// Returns the program.
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// Returns the independent parameters in SI units. Parameters that no value depends on have their default values.
    pub fn parameter_values(&self) -> Vec<f64> {
        let mut values = self.program.default_parameters();
        for (id, place) in &self.parameters {
            values[*place] = self.memory[self.places.offset(*id)];
        }
        values
    }

    /// Computes all values that depend only on the parameters. `parameters` are the independent parameters in
    /// SI units, in the order of the program.
    pub fn prepare(&mut self, parameters: &[f64]) {
        for (id, place) in &self.parameters {
            self.memory[self.places.offset(*id)] = parameters[*place];
        }
        if self.by_code.contains(&false) {
            let steps = &self.prepare;
            run(
                &mut self.memory,
                &self.places,
                &self.program,
                steps,
                &NO_POINT,
            );
        }
        if let Some(code) = &self.code {
            code.prepare(&mut self.memory);
        }
        if self.single.is_some() {
            self.convert_prepared();
        }
    }

    /// Computes all values that depend only on the parameters in single precision, for an evaluator in single
    /// precision. The parameters must be exactly representable in single precision.
    pub fn prepare_in_single_precision(&mut self, parameters: &[f64]) {
        for (id, place) in &self.parameters {
            self.memory[self.places.offset(*id)] = parameters[*place];
        }
        let steps = std::mem::take(&mut self.prepare);
        self.compute_single(&steps, &NO_POINT);
        self.prepare = steps;
    }

    /// Returns true if every prepared pivot of the mass matrix is positive; otherwise the rates are NaN.
    pub fn pivots_are_positive(&self) -> bool {
        self.pivot_states()
            .all(|state| state == PivotState::Positive)
    }

    /// Returns the state of each element of the prepared pivots of the mass matrix.
    pub fn pivot_states(&self) -> impl Iterator<Item = PivotState> {
        self.program.pivots.iter().flat_map(|id| {
            let matrix = matches!(self.program.value(*id).extent, Extent::Matrix(..));
            let state = move |pivot: &f64| match pivot.is_finite() {
                false => PivotState::NotFinite,
                true if matrix || *pivot > 0.0 => PivotState::Positive,
                true => PivotState::NotPositive,
            };
            self.slice(*id).iter().map(state)
        })
    }

    /// Writes the rates of the state to `out`.
    #[inline]
    pub fn rates(&mut self, point: Point<'_>, out: &mut [f64]) {
        match &self.code {
            Some(code) => code.rates(&mut self.memory, &point, out),
            None => self.interpreted_rates(&point, out),
        }
    }

    // This function is separate from `rates`, which keeps the call of machine code short.
    #[inline(never)]
    fn interpreted_rates(&mut self, point: &Point<'_>, out: &mut [f64]) {
        self.compute(Stage::Rates, point);
        let degrees = self.program.degrees_of_freedom();
        let (velocities, rest) = out.split_at_mut(degrees);
        let (accelerations, first_order) = rest.split_at_mut(degrees);
        for (rate, id) in first_order.iter_mut().zip(&self.program.first_order_rates) {
            *rate = self.memory[self.places.offset(*id)];
        }
        velocities.copy_from_slice(&point.state[degrees..2 * degrees]);
        self.copy_rows(
            &self.program.accelerations.scalars,
            &self.program.accelerations.modal,
            accelerations,
        );
    }

    /// Writes the observables to `out`, with `energy` and `power` last.
    pub fn observables(&mut self, point: Point<'_>, out: &mut [f64]) {
        self.compute(Stage::Observables, &point);
        for (value, id) in out.iter_mut().zip(&self.program.observable_values) {
            *value = self.memory[self.places.offset(*id)];
        }
    }

    /// Returns the number of switching surfaces; a surface over modes counts once for each mode.
    pub fn guard_count(&self) -> usize {
        self.guard_count
    }

    /// Writes the values of the switching functions to `out`, [`Evaluator::guard_count`] numbers.
    pub fn guards(&mut self, point: Point<'_>, out: &mut [f64]) {
        self.compute(Stage::Guards, &point);
        let mut place = 0;
        for guard in &self.program.guards {
            let values = self.slice(guard.value);
            out[place..place + values.len()].copy_from_slice(values);
            place += values.len();
        }
    }

    /// Writes the mass matrix to `out`, row by row.
    pub fn mass_matrix(&mut self, point: Point<'_>, out: &mut [f64]) {
        self.compute(Stage::Mass, &point);
        let size = self.program.degrees_of_freedom();
        let scalars = self.program.coordinates.len();
        out.fill(0.0);
        for row in 0..scalars {
            for column in 0..scalars {
                out[row * size + column] = self.slice(self.program.mass.scalars[row][column])[0];
            }
            for field in FieldId::first(self.program.fields.len()) {
                let offset = self.program.mode_offset(field);
                for mode in 0..self.program.fields[field].order {
                    let value = self.element(self.program.mass.coupling[row][field], mode);
                    out[row * size + offset + mode] = value;
                    out[(offset + mode) * size + row] = value;
                }
            }
        }
        let fields = FieldId::first(self.program.fields.len());
        for (row, blocks) in fields.clone().zip(&self.program.mass.modal) {
            for (column, block) in fields.clone().zip(blocks) {
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

    /// Computes the velocity terms c and generalised forces f of M q'' + c = f.
    pub fn bias_and_forces(&mut self, point: Point<'_>, bias: &mut [f64], forces: &mut [f64]) {
        self.compute(Stage::Forces, &point);
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

    /// Returns the elements of a value. With machine code, only prepared values and the [roots](Stage::roots) of the
    /// last computed stage are valid, except the rates.
    pub fn slice(&self, id: ValueId) -> &[f64] {
        let start = self.places.offset(id);
        &self.memory[start..start + self.program.values[id.0].extent.length()]
    }

    fn element(&self, id: ValueId, index: usize) -> f64 {
        match self.program.values[id.0].extent {
            Extent::Scalar => self.memory[self.places.offset(id)],
            _ => self.memory[self.places.offset(id) + index],
        }
    }

    fn copy_rows(&self, scalars: &[ValueId], modal: &[ValueId], out: &mut [f64]) {
        for (place, id) in scalars.iter().enumerate() {
            out[place] = self.memory[self.places.offset(*id)];
        }
        for (field, id) in FieldId::first(modal.len()).zip(modal) {
            let offset = self.program.mode_offset(field);
            for mode in 0..self.program.fields[field].order {
                out[offset + mode] = self.element(*id, mode);
            }
        }
    }

    fn compute(&mut self, stage: Stage, point: &Point<'_>) {
        if let Some(code) = &self.code
            && self.by_code[stage as usize]
        {
            code.compute(stage, &mut self.memory, point);
            return;
        }
        if self.single.is_some() {
            let steps = std::mem::take(&mut self.stages[stage as usize]);
            self.compute_single(&steps, point);
            self.stages[stage as usize] = steps;
            return;
        }
        let steps = &self.stages[stage as usize];
        run(&mut self.memory, &self.places, &self.program, steps, point);
    }

    /// Converts the coefficients to single precision and computes the other prepared values from the coefficients.
    fn convert_prepared(&mut self) {
        for number in &mut self.memory {
            *number = f64::from(*number as f32);
        }
        let steps = std::mem::take(&mut self.recomputed);
        self.compute_single(&steps, &NO_POINT);
        self.recomputed = steps;
    }

    /// Computes steps in single precision. Prepared values and arguments are read from the double-precision memory,
    /// and results are written to it; both conversions are exact.
    fn compute_single(&mut self, steps: &[ValueId], point: &Point<'_>) {
        let (places, program) = (&self.places, &self.program);
        let single = self.single.get_or_insert_default();
        single.clear();
        single.extend(self.memory.iter().map(|number| *number as f32));
        run(single, places, program, steps, point);
        for id in steps {
            let start = places.offset(*id);
            let own = start..start + program.values[id.0].extent.length();
            let numbers = self.memory[own.clone()].iter_mut().zip(&single[own]);
            numbers.for_each(|(number, single)| *number = f64::from(*single));
        }
    }
}

/// Point without state and inputs, for the computation of prepared values.
pub(crate) const NO_POINT: Point<'static> = Point {
    t: 0.0,
    state: &[],
    inputs: &[],
};

fn run<N: Number>(
    memory: &mut [N],
    places: &Places,
    program: &Program,
    steps: &[ValueId],
    point: &Point<'_>,
) {
    for id in steps {
        step(memory, places, program, *id, point);
    }
}
