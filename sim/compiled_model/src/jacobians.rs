//! Dense Jacobians of a compiled model. The crate `codegen` derives them.

use std::sync::Arc;

use eomgen_codegen::program::evaluator::{Evaluator, MachineCode, Point};
use eomgen_codegen::program::{Op, Program, Variable};
use eomgen_model_spec::ids::FieldId;

use crate::error::Error;
use crate::instance::Instance;
use crate::model::prepare_evaluator;

/// A Jacobian of a model: the function and the variable of differentiation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Jacobian {
    /// Derivatives of the rates with respect to the state.
    RatesByState,
    /// Derivatives of the rates with respect to the inputs.
    RatesByInputs,
    /// Derivatives of the rates with respect to the independent parameters, SI.
    RatesByParameters,
    /// Derivatives of the rates with respect to time at constant state and inputs; one column.
    RatesByTime,
    /// Derivatives of the observables with respect to the state.
    ObservablesByState,
    /// Derivatives of the observables with respect to the inputs.
    ObservablesByInputs,
    /// Derivatives of the observables with respect to the independent parameters, SI.
    ObservablesByParameters,
}

impl Jacobian {
    /// Every Jacobian.
    pub const ALL: [Self; 7] = [
        Self::RatesByState,
        Self::RatesByInputs,
        Self::RatesByParameters,
        Self::RatesByTime,
        Self::ObservablesByState,
        Self::ObservablesByInputs,
        Self::ObservablesByParameters,
    ];

    /// Returns the name used in emitted code.
    pub fn name(self) -> &'static str {
        match self {
            Self::RatesByState => "rates_by_state",
            Self::RatesByInputs => "rates_by_inputs",
            Self::RatesByParameters => "rates_by_parameters",
            Self::RatesByTime => "rates_by_time",
            Self::ObservablesByState => "observables_by_state",
            Self::ObservablesByInputs => "observables_by_inputs",
            Self::ObservablesByParameters => "observables_by_parameters",
        }
    }
}

/// Positions of the structural nonzeros of one Jacobian.
#[derive(Default)]
pub(crate) struct JacobianLayout {
    pub(crate) place: usize,
    rows: usize,
    columns: usize,
    /// Index of each nonzero in the dense row-major matrix.
    pub(crate) dense: Vec<usize>,
    pub(crate) nonzeros: Vec<f64>,
}

/// Evaluator of Jacobians at one set of parameter values.
pub struct JacobianEvaluator {
    evaluator: Evaluator,
    /// Layouts in the order of [`Jacobian::ALL`].
    layouts: Vec<JacobianLayout>,
}

impl JacobianEvaluator {
    /// Returns the numbers of rows and columns.
    pub fn shape(&self, of: Jacobian) -> (usize, usize) {
        let layout = &self.layouts[of as usize];
        (layout.rows, layout.columns)
    }

    pub(crate) fn evaluate_dense(&mut self, of: Jacobian, point: Point<'_>) -> Vec<f64> {
        let (rows, columns) = self.shape(of);
        let mut matrix = vec![0.0; rows * columns];
        self.evaluate(of, point, &mut matrix);
        matrix
    }

    /// Writes the dense row-major matrix at a point to `out`, of rows times columns numbers. On a
    /// switching surface the derivatives are one-sided.
    pub fn evaluate(&mut self, of: Jacobian, point: Point<'_>, out: &mut [f64]) {
        let layout = &mut self.layouts[of as usize];
        self.evaluator
            .jacobian(layout.place, point, &mut layout.nonzeros);
        out.fill(0.0);
        for (place, value) in layout.dense.iter().zip(&layout.nonzeros) {
            out[*place] = *value;
        }
    }
}

impl Instance<'_> {
    /// Returns an evaluator of Jacobians at these parameters, with machine code.
    ///
    /// # Errors
    /// Terms that cannot be differentiated, or a mass matrix that is not positive definite.
    pub fn jacobian_evaluator(&self) -> Result<JacobianEvaluator, Error> {
        self.interpreter()?;
        let differentiated = self.model().jacobian_program()?;
        Ok(self.jacobians(&differentiated.program, differentiated.machine_code()))
    }

    /// Returns an evaluator of Jacobians without machine code, for a few evaluations. It does not
    /// check that the mass matrix is positive definite, so its accelerations may be invalid.
    pub(crate) fn interpreted_jacobians(&self) -> Result<JacobianEvaluator, Error> {
        let program = &self.model().jacobian_program()?.program;
        Ok(self.jacobians(program, None))
    }

    fn jacobians(
        &self,
        program: &Program,
        code: Option<&Arc<dyn MachineCode>>,
    ) -> JacobianEvaluator {
        let layouts = Jacobian::ALL
            .iter()
            .filter_map(|of| JacobianLayout::find(program, of.name()));
        JacobianEvaluator {
            layouts: layouts.collect(),
            evaluator: prepare_evaluator(program, code, self.parameters()),
        }
    }

    /// Returns true for each state that a rate or a switching function depends on. An unrestrained
    /// rotation angle, for example, has no influence.
    ///
    /// # Errors
    /// Same as [`Instance::jacobian_evaluator`].
    pub fn influential_states(&self) -> Result<Vec<bool>, Error> {
        let program = &self.model().jacobian_program()?.program;
        let mut felt = vec![false; program.states()];
        if let Some(layout) = JacobianLayout::find(program, Jacobian::RatesByState.name()) {
            for place in &layout.dense {
                felt[place % layout.columns] = true;
            }
        }
        let guards: Vec<_> = program.guards.iter().map(|guard| guard.value).collect();
        for id in program.reachable(&guards) {
            let (variable, count) = match program.value(id).op {
                Op::Coordinate(index) => (Variable::Coordinate(index), 1),
                Op::Rate(index) => (Variable::Rate(index), 1),
                Op::ModeCoordinates(field) => {
                    (Variable::ModeCoordinates(field), mode_count(program, field))
                }
                Op::ModeRates(field) => (Variable::ModeRates(field), mode_count(program, field)),
                _ => continue,
            };
            let first = program.variable_place(variable);
            felt[first..first + count].fill(true);
        }
        Ok(felt)
    }
}

fn mode_count(program: &Program, field: FieldId) -> usize {
    program.fields[field.index()].order
}

impl JacobianLayout {
    pub(crate) fn find(program: &Program, name: &str) -> Option<Self> {
        let jacobians = &program.outputs.jacobians;
        let place = jacobians.iter().position(|known| known.name == name)?;
        let jacobian = &jacobians[place];
        let mut dense = vec![0; jacobian.nonzeros()];
        for (entry, block) in jacobian.entries.iter().zip(jacobian.places()) {
            for row in 0..entry.rows {
                for column in 0..entry.width() {
                    let of_matrix = entry.column + if entry.diagonal { row } else { column };
                    dense[block.start + block.width * row + column] =
                        (entry.row + row) * jacobian.columns + of_matrix;
                }
            }
        }
        Some(Self {
            place,
            rows: jacobian.rows,
            columns: jacobian.columns,
            nonzeros: vec![0.0; dense.len()],
            dense,
        })
    }
}
