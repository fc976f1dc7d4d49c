//! Matrices of a piecewise-linear model for given parameters and sides.

use eomgen_model_spec::ids::FieldId;
use eomgen_model_spec::model::Function;

use crate::program::evaluator::Evaluator;
use crate::program::{Extent, Program, ValueId};

#[derive(Clone)]
pub(crate) struct AffineRowValues {
    pub coordinates: Vec<ValueId>,
    pub mode_coordinates: Vec<ValueId>,
    pub rates: Vec<ValueId>,
    pub mode_rates: Vec<ValueId>,
    pub states: Vec<ValueId>,
    pub inputs: Vec<ValueId>,
    pub sines: Vec<ValueId>,
    pub cosines: Vec<ValueId>,
    pub constant: ValueId,
}

/// Program that computes the coefficients of a piecewise-linear model.
#[derive(Clone)]
pub struct AffineProgram {
    pub(crate) program: Program,
    pub(crate) layout: AffineLayout,
}

#[derive(Clone)]
pub(crate) struct AffineLayout {
    pub(crate) scalars: Vec<AffineRowValues>,
    pub(crate) modal: Vec<AffineRowValues>,
    pub(crate) first_order: Vec<AffineRowValues>,
    pub(crate) guards: Vec<AffineRowValues>,
    pub(crate) guard_functions: Vec<Function>,
    pub(crate) guard_groups: Vec<usize>,
    pub(crate) guards_rest: Vec<bool>,
    pub(crate) phases: Vec<[ValueId; 2]>,
    pub(crate) half_widths: Vec<ValueId>,
    pub(crate) inputs: usize,
}

/// Coefficients of linear functions of the state, the inputs and sinusoids of time, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct AffineRows {
    /// Number of functions.
    pub rows: usize,
    /// Factors of the state, rows x states.
    pub state: Vec<f64>,
    /// Factors of the inputs, rows x inputs.
    pub inputs: Vec<f64>,
    /// Factors of the sines, rows x phases.
    pub sines: Vec<f64>,
    /// Factors of the cosines, rows x phases.
    pub cosines: Vec<f64>,
    /// Constant of each row.
    pub constant: Vec<f64>,
}

/// System y' = A y + B u + S sin + C cos + c and its switching functions, for given sides.
#[derive(Clone, Debug, PartialEq)]
pub struct AffineSystem {
    /// Number of states.
    pub states: usize,
    /// Degrees of freedom. The state holds the positions, then as many rates, then the first-order states.
    pub degrees: usize,
    /// Rates of the state, one row for each state.
    pub rates: AffineRows,
    /// Switching functions.
    pub guards: AffineRows,
    /// Rate (rad/s) and offset (rad) of each phase.
    pub phases: Vec<[f64; 2]>,
}

/// Evaluator of the matrices of a piecewise-linear model.
pub struct AffineEvaluator {
    evaluator: Evaluator,
    layout: AffineLayout,
    parameters: Vec<f64>,
    /// Index of each prescribed motion among the inputs, followed by its rate and its second derivative.
    prescribed: Vec<usize>,
}

impl AffineEvaluator {
    /// Prepares a program with the parameters of the specification.
    pub fn new(program: AffineProgram) -> Self {
        let parameters = program.program.default_parameters();
        Self {
            evaluator: Evaluator::new(program.program),
            layout: program.layout,
            parameters,
            prescribed: Vec::new(),
        }
    }

    /// Turns prescribed motions from inputs into states; each adds its value, rate and second derivative after the
    /// other states. `prescribed` has their indices among the inputs. The input of the second derivative then supplies
    /// the third derivative.
    #[must_use]
    pub fn with_prescribed_states(mut self, prescribed: Vec<usize>) -> Self {
        self.prescribed = prescribed;
        self
    }

    /// Returns the indices of the prescribed motions that are states.
    pub fn prescribed_states(&self) -> &[usize] {
        &self.prescribed
    }

    /// Returns the number of switching surfaces.
    pub fn guard_count(&self) -> usize {
        self.layout.guards.len()
    }

    /// Returns the piecewise function that switches at each surface.
    pub fn guard_functions(&self) -> &[Function] {
        &self.layout.guard_functions
    }

    /// Returns, for each switching function, the index of the first switching function that differs only by
    /// parameters.
    pub fn guard_groups(&self) -> &[usize] {
        &self.layout.guard_groups
    }

    /// Returns, for each switching function, true if it can be constant throughout a regime, because it depends on
    /// the sides of other surfaces or only on inputs.
    pub fn guards_rest(&self) -> &[bool] {
        &self.layout.guards_rest
    }

    /// Returns the number of states.
    pub fn states(&self) -> usize {
        self.model_states() + 3 * self.prescribed.len()
    }

    /// Returns the number of states without prescribed motions.
    pub fn model_states(&self) -> usize {
        self.evaluator.program().states()
    }

    /// Returns the number of degrees of freedom.
    pub fn degrees_of_freedom(&self) -> usize {
        self.evaluator.program().degrees_of_freedom()
    }

    /// Returns the number of inputs.
    pub fn inputs(&self) -> usize {
        self.layout.inputs
    }

    /// Sets the independent parameters in SI units, in the order of the model's program.
    pub fn set_parameters(&mut self, values: &[f64]) {
        let sides = self.guard_count();
        let own = self.parameters.len() - sides;
        for (slot, value) in self.parameters[..own].iter_mut().zip(values) {
            *slot = *value;
        }
    }

    /// Computes the matrices for given sides, one number for each switching surface: 1 if the switching function is
    /// positive, 0 if it is negative, and a value between them if the motion is held on the surface.
    pub fn system(&mut self, sides: &[f64]) -> AffineSystem {
        let own = self.parameters.len() - self.guard_count();
        for (slot, side) in self.parameters[own..].iter_mut().zip(sides) {
            *slot = *side;
        }
        self.evaluator.prepare(&self.parameters);
        let value = |id: &ValueId| self.evaluator.slice(*id)[0];
        AffineSystem {
            states: self.states(),
            degrees: self.degrees_of_freedom(),
            rates: self.add_prescribed_rates(self.add_prescribed_columns(self.rates())),
            guards: self.add_prescribed_columns(self.guards()),
            phases: self
                .layout
                .phases
                .iter()
                .map(|phase| [value(&phase[0]), value(&phase[1])])
                .collect(),
        }
    }

    /// Returns true if every pivot of the mass matrix was positive in the last computation.
    pub fn pivots_are_positive(&self) -> bool {
        self.evaluator.pivots_are_positive()
    }

    /// Returns true if no half-width of a dead zone was negative in the last computation.
    pub fn half_widths_are_nonnegative(&self) -> bool {
        let mut widths = self.layout.half_widths.iter();
        widths.all(|id| self.evaluator.slice(*id)[0] >= 0.0)
    }

    fn rates(&self) -> AffineRows {
        let program = self.evaluator.program();
        let degrees = program.degrees_of_freedom();
        let states = self.model_states();
        let mut rows = self.create_zero_rows(states);
        for row in 0..degrees {
            rows.state[row * states + degrees + row] = 1.0;
        }
        for (row, values) in self.layout.first_order.iter().enumerate() {
            self.fill(&mut rows, 2 * degrees + row, values, 0);
        }
        for (row, values) in self.layout.scalars.iter().enumerate() {
            self.fill(&mut rows, degrees + row, values, 0);
        }
        for (field, values) in FieldId::first(self.layout.modal.len()).zip(&self.layout.modal) {
            let first = degrees + program.mode_offset(field);
            for mode in 0..program.fields[field].order {
                self.fill(&mut rows, first + mode, values, mode);
            }
        }
        rows
    }

    fn guards(&self) -> AffineRows {
        let mut rows = self.create_zero_rows(self.guard_count());
        for (row, values) in self.layout.guards.iter().enumerate() {
            self.fill(&mut rows, row, values, 0);
        }
        rows
    }

    /// Moves the factors of prescribed motions from the inputs to the state.
    fn add_prescribed_columns(&self, mut rows: AffineRows) -> AffineRows {
        if self.prescribed.is_empty() {
            return rows;
        }
        let (own, inputs) = (self.model_states(), self.layout.inputs);
        let mut state = Vec::with_capacity(rows.rows * self.states());
        for row in 0..rows.rows {
            state.extend_from_slice(&rows.state[row * own..(row + 1) * own]);
            for first in &self.prescribed {
                let factors = &mut rows.inputs[row * inputs + first..][..3];
                state.extend_from_slice(factors);
                factors.fill(0.0);
            }
        }
        AffineRows { state, ..rows }
    }

    /// Adds the rows with the rates of prescribed motions.
    fn add_prescribed_rates(&self, mut rows: AffineRows) -> AffineRows {
        let (states, inputs) = (self.states(), self.layout.inputs);
        let phases = self.layout.phases.len();
        rows.state.resize(states * states, 0.0);
        rows.inputs.resize(states * inputs, 0.0);
        rows.sines.resize(states * phases, 0.0);
        rows.cosines.resize(states * phases, 0.0);
        rows.constant.resize(states, 0.0);
        rows.rows = states;
        for (number, first) in self.prescribed.iter().enumerate() {
            let place = self.model_states() + 3 * number;
            rows.state[place * states + place + 1] = 1.0;
            rows.state[(place + 1) * states + place + 2] = 1.0;
            rows.inputs[(place + 2) * inputs + first + 2] = 1.0;
        }
        rows
    }

    fn create_zero_rows(&self, rows: usize) -> AffineRows {
        let phases = self.layout.phases.len();
        AffineRows {
            rows,
            state: vec![0.0; rows * self.model_states()],
            inputs: vec![0.0; rows * self.layout.inputs],
            sines: vec![0.0; rows * phases],
            cosines: vec![0.0; rows * phases],
            constant: vec![0.0; rows],
        }
    }

    fn fill(&self, rows: &mut AffineRows, row: usize, values: &AffineRowValues, element: usize) {
        let program = self.evaluator.program();
        let degrees = program.degrees_of_freedom();
        let states = self.model_states();
        let state = &mut rows.state[row * states..(row + 1) * states];
        let (positions, rest) = state.split_at_mut(degrees);
        let (velocities, first_order) = rest.split_at_mut(degrees);
        for (slot, id) in first_order.iter_mut().zip(&values.states) {
            *slot = self.element(*id, element);
        }
        let halves = [
            (positions, &values.coordinates, &values.mode_coordinates),
            (velocities, &values.rates, &values.mode_rates),
        ];
        for (half, scalars, modes) in halves {
            for (slot, id) in half.iter_mut().zip(scalars) {
                *slot = self.element(*id, element);
            }
            for (field, id) in FieldId::first(modes.len()).zip(modes) {
                let first = program.mode_offset(field);
                for mode in 0..program.fields[field].order {
                    half[first + mode] = self.pair(*id, element, mode);
                }
            }
        }
        let blocks = [
            (&mut rows.inputs, &values.inputs, self.layout.inputs),
            (&mut rows.sines, &values.sines, self.layout.phases.len()),
            (&mut rows.cosines, &values.cosines, self.layout.phases.len()),
        ];
        for (block, ids, width) in blocks {
            for (place, id) in ids.iter().enumerate() {
                block[row * width + place] = self.element(*id, element);
            }
        }
        rows.constant[row] = self.element(values.constant, element);
    }

    /// Returns element `index` of a vector; a scalar is repeated.
    fn element(&self, id: ValueId, index: usize) -> f64 {
        match self.evaluator.program().value(id).extent {
            Extent::Scalar => self.evaluator.slice(id)[0],
            _ => self.evaluator.slice(id)[index],
        }
    }

    /// Returns the factor of mode `column` in element `row`. The value is a matrix, or a vector of factors for a
    /// single row.
    fn pair(&self, id: ValueId, row: usize, column: usize) -> f64 {
        match self.evaluator.program().value(id).extent {
            Extent::Scalar => self.evaluator.slice(id)[0],
            Extent::Vector(_) => self.evaluator.slice(id)[column],
            Extent::Matrix(_, columns) => self.evaluator.slice(id)[row * columns + column],
        }
    }
}
