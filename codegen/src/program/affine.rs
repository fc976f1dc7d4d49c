//! The numbers of a piecewise-linear model: matrices for given parameters and sides.

use eomgen_model_spec::ids::FieldId;
use eomgen_model_spec::model::Function;

use crate::program::evaluator::Evaluator;
use crate::program::{Extent, Program, ValueId};

/// Where the coefficients of one row stand in a program.
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

/// The program that computes the coefficients of a piecewise-linear model.
#[derive(Clone)]
pub struct AffineProgram {
    pub(crate) program: Program,
    pub(crate) layout: AffineLayout,
}

/// Where the coefficients stand in a program.
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

/// Coefficients of linear functions of the state, the inputs and sinusoids of time: `rows`
/// of them, every block row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct AffineRows {
    /// How many functions.
    pub rows: usize,
    /// rows x states.
    pub state: Vec<f64>,
    /// rows x inputs.
    pub inputs: Vec<f64>,
    /// rows x phases: factors of the sines.
    pub sines: Vec<f64>,
    /// rows x phases: factors of the cosines.
    pub cosines: Vec<f64>,
    /// One per row.
    pub constant: Vec<f64>,
}

/// y' = A y + B u + S sin + C cos + c, and the switching functions, with given sides.
#[derive(Clone, Debug, PartialEq)]
pub struct AffineSystem {
    /// Numbers in the state.
    pub states: usize,
    /// Degrees of freedom: positions come first in the state, then as many rates, then states of
    /// first order.
    pub degrees: usize,
    /// The rates of the state: as many rows as states.
    pub rates: AffineRows,
    /// The switching functions.
    pub guards: AffineRows,
    /// Rate (rad/s) and offset (rad) of every phase.
    pub phases: Vec<[f64; 2]>,
}

/// Computes the matrices of a piecewise-linear model.
pub struct AffineEvaluator {
    evaluator: Evaluator,
    layout: AffineLayout,
    parameters: Vec<f64>,
}

impl AffineEvaluator {
    /// Takes a program; the parameters are those of the specification.
    pub fn new(program: AffineProgram) -> Self {
        let parameters = program.program.default_parameters();
        Self {
            evaluator: Evaluator::new(program.program),
            layout: program.layout,
            parameters,
        }
    }

    /// The number of switching surfaces.
    pub fn guard_count(&self) -> usize {
        self.layout.guards.len()
    }

    /// What switches at each surface.
    pub fn guard_functions(&self) -> &[Function] {
        &self.layout.guard_functions
    }

    /// For each switching function the first one that differs from it by parameters alone.
    pub fn guard_groups(&self) -> &[usize] {
        &self.layout.guard_groups
    }

    /// For each switching function whether it may have one value throughout a regime: it feels
    /// the sides of other surfaces, or is of inputs alone.
    pub fn guards_rest(&self) -> &[bool] {
        &self.layout.guards_rest
    }

    /// Numbers in the state.
    pub fn states(&self) -> usize {
        self.evaluator.program().states()
    }

    /// Degrees of freedom.
    pub fn degrees_of_freedom(&self) -> usize {
        self.evaluator.program().degrees_of_freedom()
    }

    /// The number of inputs.
    pub fn inputs(&self) -> usize {
        self.layout.inputs
    }

    /// Sets the independent parameters: SI, in the order of the model's program.
    pub fn set_parameters(&mut self, values: &[f64]) {
        let sides = self.guard_count();
        let own = self.parameters.len() - sides;
        for (slot, value) in self.parameters[..own].iter_mut().zip(values) {
            *slot = *value;
        }
    }

    /// The matrices with these sides, one per switching surface: 1 on its positive side, 0
    /// on the other, between them on the surface itself.
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
            rates: self.rates(),
            guards: self.guards(),
            phases: self
                .layout
                .phases
                .iter()
                .map(|phase| [value(&phase[0]), value(&phase[1])])
                .collect(),
        }
    }

    /// Whether every pivot of the mass matrix was positive when last computed.
    pub fn pivots_are_positive(&self) -> bool {
        self.evaluator.pivots_are_positive()
    }

    /// Whether no half-width of a dead zone was negative when last computed.
    pub fn half_widths_are_right(&self) -> bool {
        let mut widths = self.layout.half_widths.iter();
        widths.all(|id| self.evaluator.slice(*id)[0] >= 0.0)
    }

    fn rates(&self) -> AffineRows {
        let program = self.evaluator.program();
        let degrees = program.degrees_of_freedom();
        let states = self.states();
        let mut rows = self.zero_rows(states);
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
        let mut rows = self.zero_rows(self.guard_count());
        for (row, values) in self.layout.guards.iter().enumerate() {
            self.fill(&mut rows, row, values, 0);
        }
        rows
    }

    fn zero_rows(&self, rows: usize) -> AffineRows {
        let phases = self.layout.phases.len();
        AffineRows {
            rows,
            state: vec![0.0; rows * self.states()],
            inputs: vec![0.0; rows * self.layout.inputs],
            sines: vec![0.0; rows * phases],
            cosines: vec![0.0; rows * phases],
            constant: vec![0.0; rows],
        }
    }

    /// Writes element `element` of a row's coefficients.
    fn fill(&self, rows: &mut AffineRows, row: usize, values: &AffineRowValues, element: usize) {
        let program = self.evaluator.program();
        let degrees = program.degrees_of_freedom();
        let states = self.states();
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

    /// Element `index` of a vector; a scalar stands for every element.
    fn element(&self, id: ValueId, index: usize) -> f64 {
        match self.evaluator.program().value(id).extent {
            Extent::Scalar => self.evaluator.slice(id)[0],
            _ => self.evaluator.slice(id)[index],
        }
    }

    /// The factor of mode `column` in element `row` of what a matrix or, for a scalar row, a
    /// vector holds.
    fn pair(&self, id: ValueId, row: usize, column: usize) -> f64 {
        match self.evaluator.program().value(id).extent {
            Extent::Scalar => self.evaluator.slice(id)[0],
            Extent::Vector(_) => self.evaluator.slice(id)[column],
            Extent::Matrix(_, columns) => self.evaluator.slice(id)[row * columns + column],
        }
    }
}
