//! Serialised models: the programs that motions need, without their derivation.

use std::sync::Arc;

use eomgen_codegen::encode_structures;
use eomgen_codegen::independence::rows::ConstraintRows;
use eomgen_codegen::program::Program;
use eomgen_codegen::program::encoding::Encoded;
use eomgen_codegen::program::evaluator::{Evaluator, MachineCode};

use crate::corners::Corners;
use crate::error::Error;
use crate::evaluation::{prepare_evaluator, require_positive_pivots};
#[cfg(feature = "derive")]
use crate::instance::Instance;
use crate::jacobians::JacobianEvaluator;
use crate::labels::Labels;
use crate::motion_model::MotionModel;
use crate::sticking::SidedModel;

/// Programs that motions of a model need, with names, units and sizes. A host program without the derivation simulates
/// them with the general solvers.
pub struct ExportedModel {
    labels: Labels,
    program: Program,
    sided: Option<Program>,
    corners: Option<Program>,
    /// Program of the constraint derivatives, and the indices of the constraint residuals among its observables.
    constraints: Option<(Program, Vec<usize>)>,
    /// Index of the stabilisation rate among the parameters.
    stabilisation: Option<usize>,
    /// For each impact, the largest parameter with the dimension of its distance, SI.
    lengths: Vec<f64>,
}

encode_structures! {
    ExportedModel { labels, program, sided, corners, constraints, stabilisation, lengths }
}

impl ExportedModel {
    /// Exports the model of an instance; the instance's parameters become its defaults.
    ///
    /// # Errors
    /// Terms that cannot be derived.
    #[cfg(feature = "derive")]
    pub fn new(instance: &Instance<'_>) -> Result<Self, Error> {
        use eomgen_codegen::independence::constraint_program::find_residual_indices;
        use eomgen_model_spec::model::STABILISATION_RATE;

        let compiled = instance.model();
        let with_parameters = |program: &Program| {
            let mut program = program.clone();
            let own = program.parameters.iter_mut().zip(instance.parameters());
            own.for_each(|(parameter, value)| parameter.value = *value);
            program
        };
        let constraints = compiled.constraint_program(instance.values()).map(|known| {
            let residuals = find_residual_indices(compiled.model(), known);
            (with_parameters(known), residuals)
        });
        let labels = compiled.labels().clone();
        let lengths = (0..labels.impacts.len()).map(|impact| instance.largest_length(impact));
        let mut parameters = compiled.program().parameters.iter();
        Ok(Self {
            lengths: lengths.collect(),
            labels,
            program: with_parameters(compiled.program()),
            sided: compiled.sided_program()?.map(with_parameters),
            corners: compiled.corner_program()?.map(with_parameters),
            constraints,
            stabilisation: parameters
                .position(|parameter| parameter.quantity.name == STABILISATION_RATE),
        })
    }

    /// Serialises the model.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        self.encode(&mut bytes);
        bytes
    }

    /// Reads a serialised model; `None` if the bytes are damaged.
    pub fn from_bytes(mut bytes: &[u8]) -> Option<Self> {
        Self::decode(&mut bytes).filter(|_| bytes.is_empty())
    }

    /// Returns the program of rates, observables and switching functions.
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// Returns the program whose rates take the sides of surfaces as inputs; `None` without surfaces.
    pub fn sided_program(&self) -> Option<&Program> {
        self.sided.as_ref()
    }
}

/// Machine code of the programs of an exported model, valid for its own parameters only.
#[derive(Clone, Default)]
pub struct ExportedCode {
    /// Code of [`ExportedModel::program`].
    pub program: Option<Arc<dyn MachineCode>>,
    /// Code of [`ExportedModel::sided_program`].
    pub sided: Option<Arc<dyn MachineCode>>,
}

/// An exported model at one set of parameters.
pub(crate) struct ExportedInstance {
    pub model: ExportedModel,
    pub code: ExportedCode,
    /// Independent parameters, SI.
    pub parameters: Vec<f64>,
}

impl MotionModel for ExportedInstance {
    fn labels(&self) -> &Labels {
        &self.model.labels
    }

    fn evaluator(&self) -> Result<Evaluator, Error> {
        let code = self.code.program.as_ref();
        require_positive_pivots(prepare_evaluator(
            &self.model.program,
            code,
            &self.parameters,
        ))
    }

    fn evaluator_at_stabilisation_rate(&self, rate: f64) -> Result<Evaluator, Error> {
        let mut parameters = self.parameters.clone();
        if let Some(place) = self.model.stabilisation {
            parameters[place] = rate;
        }
        require_positive_pivots(prepare_evaluator(&self.model.program, None, &parameters))
    }

    fn stabilisation_rate(&self) -> f64 {
        let place = self.model.stabilisation;
        place.map_or(0.0, |place| self.parameters[place])
    }

    fn sided_model(&self) -> Result<Option<SidedModel>, Error> {
        let code = self.code.sided.as_ref();
        let evaluator = |program| prepare_evaluator(program, code, &self.parameters);
        let sided = self.model.sided.as_ref();
        Ok(sided.map(|program| SidedModel::new(evaluator(program))))
    }

    fn corners(&self) -> Result<Option<Corners>, Error> {
        let evaluator = |program| prepare_evaluator(program, None, &self.parameters);
        let corners = self.model.corners.as_ref();
        Ok(corners.map(|program| Corners::new(evaluator(program))))
    }

    fn constraint_rows(&self) -> Option<ConstraintRows> {
        let (program, residuals) = self.model.constraints.as_ref()?;
        let mut rows = ConstraintRows::new(program.clone(), residuals.clone());
        rows.prepare(&self.parameters);
        Some(rows)
    }

    fn jacobian_evaluator(&self) -> Result<Option<JacobianEvaluator>, Error> {
        Ok(None)
    }

    fn largest_length(&self, impact: usize) -> f64 {
        self.model.lengths[impact]
    }

    fn find_infinite_function(&self, _: (f64, f64)) -> Option<String> {
        None
    }
}
