//! Piecewise-linear models, derived once for all parameter values.

use eomgen_codegen::mechanics::affine::derive_affine;
use eomgen_codegen::mechanics::equations::{Equations, derive};
use eomgen_codegen::mechanics::linearity::{Linearity, linearity};
use eomgen_codegen::program::affine::{AffineEvaluator, AffineProgram};
use eomgen_codegen::program::lowering::lower_affine;
use eomgen_codegen::symbolic::formula::write_abridged_formula;
use eomgen_model_spec::model::{Model, ParameterValue};

use super::error::ExactError;
use super::propagator::Propagator;

/// A piecewise-linear model at one truncation order: a program that computes the coefficients of its equations
/// from the parameters. Threads may share it; each thread creates its own [`Propagator`]s.
pub struct PiecewiseLinear {
    program: AffineProgram,
    /// Names of the independent parameters.
    independent: Vec<String>,
}

impl PiecewiseLinear {
    /// Derives the coefficients of a model with fields of these orders.
    ///
    /// # Errors
    /// A model that is not piecewise linear, or that cannot be derived.
    pub fn derive(model: &Model, orders: &[usize]) -> Result<Self, ExactError> {
        let equations =
            derive(model, orders).map_err(|error| ExactError::Model(error.message.clone()))?;
        Self::from_equations(model, &equations)
    }

    /// Derives the coefficients of a model from its equations of motion.
    ///
    /// # Errors Same as [`PiecewiseLinear::derive`].
    pub fn from_equations(model: &Model, equations: &Equations) -> Result<Self, ExactError> {
        match linearity(equations) {
            Linearity::Linear | Linearity::PiecewiseLinear => {}
            Linearity::Constrained => return Err(ExactError::Constrained),
            Linearity::Impacts => return Err(ExactError::Impacts),
            Linearity::Corners(node) => {
                let surface = write_abridged_formula(&equations.graph, model, node).to_string();
                return Err(ExactError::Corners { surface });
            }
            Linearity::Nonlinear(node) => {
                let formula = write_abridged_formula(&equations.graph, model, node).to_string();
                return Err(ExactError::NotLinear { formula });
            }
        }
        let affine = derive_affine(equations.clone()).map_err(|_| ExactError::NotLinear {
            formula: "a switching function over modes".to_owned(),
        })?;
        let values = model
            .parameter_values()
            .map_err(|error| ExactError::Model(error.diagnostic().message))?;
        Ok(Self {
            program: lower_affine(model, &affine, &values),
            independent: independent(model)
                .map(|(name, _)| name.to_owned())
                .collect(),
        })
    }

    /// Returns a propagator at the parameters of `model`, which may differ from the derived model only in
    /// values.
    ///
    /// # Errors
    /// Other independent parameters, or matrices that are not finite.
    pub fn propagator_for_model(&self, model: &Model) -> Result<Propagator, ExactError> {
        if !independent(model)
            .map(|(name, _)| name)
            .eq(self.independent.iter().map(String::as_str))
        {
            return Err(ExactError::Model(
                "a number replaces the expression of a parameter; derive the model again"
                    .to_owned(),
            ));
        }
        let all = model
            .parameter_values()
            .map_err(|error| ExactError::Model(error.diagnostic().message))?;
        let values: Vec<f64> = independent(model).map(|(_, index)| all[index]).collect();
        self.propagator_at(&values)
    }

    /// Returns a propagator at these values of the independent parameters, SI, in the order of the
    /// specification.
    ///
    /// # Errors
    /// Matrices that are not finite, or a dead zone with a negative half-width.
    pub fn propagator_at(&self, values: &[f64]) -> Result<Propagator, ExactError> {
        Propagator::new(self.evaluator(values))
    }

    /// Returns an evaluator of the matrices of all regimes at these values of the independent
    /// parameters, SI, in the order of the specification.
    pub fn evaluator(&self, values: &[f64]) -> AffineEvaluator {
        let mut evaluator = AffineEvaluator::new(self.program.clone());
        evaluator.set_parameters(values);
        evaluator
    }

    /// Returns the names of the independent parameters, in the order of their values.
    pub fn parameter_names(&self) -> &[String] {
        &self.independent
    }
}

/// Returns the names of the independent parameters with their indices among all parameters.
fn independent(model: &Model) -> impl Iterator<Item = (&str, usize)> {
    model
        .parameters
        .iter()
        .enumerate()
        .filter(|(_, parameter)| matches!(parameter.value, ParameterValue::Number(_)))
        .map(|(index, parameter)| (parameter.name.as_str(), index))
}
