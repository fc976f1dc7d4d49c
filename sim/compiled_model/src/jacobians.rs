//! Dense Jacobians of a compiled model, derived by the crate `codegen`.

use eomgen_codegen::program::Program;
use eomgen_codegen::program::evaluator::{Evaluator, Point};

/// Jacobian of a model: the function and the variable of differentiation.
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
    pub(crate) rows: usize,
    pub(crate) columns: usize,
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
    /// Wraps an evaluator of a program with Jacobians, prepared at its parameters.
    pub(crate) fn new(evaluator: Evaluator) -> Self {
        let program = evaluator.program();
        let layouts = Jacobian::ALL.iter();
        let layouts = layouts.filter_map(|of| JacobianLayout::find(program, of.name()));
        Self {
            layouts: layouts.collect(),
            evaluator,
        }
    }

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

    /// Writes the dense row-major matrix at a point to `out`, which has rows times columns numbers. On a switching
    /// surface the derivatives are one-sided.
    pub fn evaluate(&mut self, of: Jacobian, point: Point<'_>, out: &mut [f64]) {
        self.layouts[of as usize].evaluate(&mut self.evaluator, point, out);
    }
}

impl JacobianLayout {
    /// Writes the dense row-major matrix at a point to `out`.
    pub(crate) fn evaluate(
        &mut self,
        evaluator: &mut Evaluator,
        point: Point<'_>,
        out: &mut [f64],
    ) {
        evaluator.jacobian(self.place, point, &mut self.nonzeros);
        out.fill(0.0);
        for (place, value) in self.dense.iter().zip(&self.nonzeros) {
            out[*place] = *value;
        }
    }

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
