//! Oracle: Euler-Lagrange equations of the checked model by automatic differentiation (num-dual) of
//! its expressions. Fields are integrated by Gauss quadrature of their mode shapes. The oracle
//! shares only the checked model with the derivation. Its results are [`Equations`].
//!
//! Modules in the order of the computation:
//!
//! - `lower` converts expressions to a `tree`; `places` contains the quadrature nodes of fields (from `legendre`) with
//!   the mode `shapes`;
//! - `scene` contains a state and directions of differentiation;
//! - `evaluate` evaluates any number type, with `functions`; [`Conditioned`] numbers carry a scale
//!   of their rounding error;
//! - `integrals` caches results that all rows share;
//! - `terms`, `constraints` and `rows` compute the rows of an [`Oracle`]; `projection` moves states onto dependent
//!   constraints;
//! - `energy` and `observables` compute energies, powers and observables;
//! - `switches` finds the switching surfaces of piecewise functions.
//!
//! With L = T - V, the row of every generalised coordinate j is
//!
//! ```text
//! d/dt dT/dq_j' - dT/dq_j + dV/dq_j + dR/dq_j' - sum of value * d(on)/dq_j = 0
//! ```
//!
//! With constraints A q'' = b, the term A^T lambda is subtracted. Here d/dt dT/dq_j' = sum over k of M_jk q_k'' + (the
//! derivative of dT/dq_j' along the motion with constant rates). The row of a first-order state is z' - rate = 0.

mod affine;
mod bounds;
mod conditioned;
mod constraints;
mod emptiness;
mod energy;
mod equations;
mod error;
mod evaluate;
mod fold;
mod functions;
mod integrals;
mod knots;
mod legendre;
mod lower;
mod nonzero;
mod observables;
mod places;
mod powers;
mod projection;
mod ranges;
mod rows;
mod scene;
mod shapes;
mod splines;
mod switches;
mod system;
mod terms;
mod tree;

#[cfg(test)]
mod tests;

pub use conditioned::Conditioned;
pub use equations::{Equations, Residual, RowTerm, RowTermKind};
pub use error::OracleError;
pub use ranges::Ranges;
pub use switches::{Side, Switch, SwitchGradient, SwitchValue};

use constraints::{LoweredConstraint, lower_constraints, stabilisation_rate};
use eomgen_model_spec::evaluate::evaluate as evaluate_constant;
use eomgen_model_spec::model::{Expr, Model};
use lower::Lowering;
use observables::lower_observables;
use scene::Scene;
use system::System;
use terms::{Lowered, LoweredForce, lower_force, lower_terms};
use tree::Tree;

/// Evaluator of the equations of motion of one variant.
///
/// # Errors
/// Methods return [`OracleError::WrongLength`] if the length of an argument does not match the model.
#[derive(Debug)]
pub struct Oracle {
    system: System,
    names: Vec<String>,
    input_rates: Vec<Option<usize>>,
    typical_inputs: Vec<f64>,
    states: usize,
    initial: Vec<f64>,
    ranges: Ranges,
    kinetic: Vec<Lowered>,
    potential: Vec<Lowered>,
    dissipation: Vec<Lowered>,
    forces: Vec<LoweredForce>,
    switches: Vec<Switch>,
    observables: Vec<Option<Tree>>,
    constraints: Vec<LoweredConstraint>,
    /// Number of redundant constraints: constraints that depend on the others.
    excess: usize,
    stabilisation_rate: f64,
}

impl Oracle {
    /// Creates the oracle of `model`; `parameters` are ordered as in [`Model::parameter_values`].
    ///
    /// # Errors
    /// [`OracleError`] if the model is not supported.
    pub fn new(model: &Model, order: usize, parameters: &[f64]) -> Result<Self, OracleError> {
        expect_length("parameters", model.parameters.len(), parameters.len())?;
        let mut lowering = Lowering::from_model(model, order, parameters)?;
        let kinetic = lower_terms(&mut lowering, &model.kinetic)?;
        let potential = lower_terms(&mut lowering, &model.potential)?;
        let dissipation = lower_terms(&mut lowering, &model.dissipation)?;
        let mut forces = Vec::new();
        for force in &model.forces {
            forces.extend(lower_force(&mut lowering, force)?);
        }
        let constraints = lower_constraints(&mut lowering, model)?;
        let observables = lower_observables(&mut lowering, model);
        if let Some(term) = kinetic.iter().find(|term| term.dependence.has_input) {
            return Err(OracleError::InputRate(term.name.clone()));
        }
        let mut oracle = Self {
            system: lowering.system,
            names: coordinate_names(model, order),
            input_rates: lower::input_rate_indices(model),
            typical_inputs: model
                .typical_inputs(1.0)
                .unwrap_or_else(|_| vec![0.0; model.inputs.len()]),
            states: model.states.len(),
            initial: initial_state(model, order, parameters),
            ranges: Ranges::from_model(model, order, parameters),
            kinetic,
            potential,
            dissipation,
            forces,
            switches: Vec::new(),
            observables,
            constraints,
            excess: 0,
            stabilisation_rate: stabilisation_rate(model, parameters),
        };
        oracle.excess = oracle.count_excess();
        oracle.switches = switches::find_switches(&oracle, model);
        Ok(oracle)
    }

    /// Returns the number of generalised coordinates, with modes.
    pub fn size(&self) -> usize {
        self.system.size
    }

    /// Returns the names of the generalised coordinates in the order of the state.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Returns the number of inputs.
    pub fn input_count(&self) -> usize {
        self.input_rates.len()
    }

    /// Returns inputs at which the mass matrix is positive definite; 0 for inputs other than prescribed motions.
    pub fn typical_inputs(&self) -> &[f64] {
        &self.typical_inputs
    }

    /// Returns the rates of the inputs: the given rate, or 0 for an input without one.
    pub fn input_rates(&self, inputs: &[f64]) -> Vec<f64> {
        let at = |rate: usize| inputs.get(rate).copied().unwrap_or(f64::NAN);
        let rates = self.input_rates.iter();
        rates.map(|rate| rate.map_or(0.0, at)).collect()
    }

    /// Returns the number of first-order states.
    pub fn state_count(&self) -> usize {
        self.states
    }

    /// Returns the length of the state: coordinates, their rates, first-order states.
    pub fn state_length(&self) -> usize {
        2 * self.size() + self.states
    }

    /// Returns the initial state of the specification: coordinates, rates, first-order states.
    pub fn initial(&self) -> &[f64] {
        &self.initial
    }

    /// Returns intervals and scales of the state and the inputs.
    pub fn ranges(&self) -> &Ranges {
        &self.ranges
    }

    /// Returns the switches of all piecewise functions that act on the motion.
    pub fn switches(&self) -> &[Switch] {
        &self.switches
    }

    /// Returns the index ranges of the fields' modes among the generalised coordinates.
    pub fn modes(&self) -> impl Iterator<Item = std::ops::Range<usize>> {
        (0..self.system.domains.len()).map(|field| self.system.modes(field))
    }

    /// Returns the lengths of the fields' domains, in the order of [`Oracle::modes`].
    pub fn lengths(&self) -> impl Iterator<Item = f64> {
        self.system.domains.iter().map(|domain| domain.length)
    }

    fn scene<'s>(
        &'s self,
        time: f64,
        state: &'s [f64],
        accelerations: Option<&'s [f64]>,
        inputs: &'s [f64],
    ) -> Result<Scene<'s>, OracleError> {
        expect_length("state entries", self.state_length(), state.len())?;
        expect_length("inputs", self.input_count(), inputs.len())?;
        Ok(Scene::new(&self.system, time, state, accelerations, inputs))
    }
}

/// Returns the initial coordinates (0 for modes), rates and first-order states.
fn initial_state(model: &Model, order: usize, parameters: &[f64]) -> Vec<f64> {
    let modes = vec![0.0; order * model.fields.len()];
    let given = |expr: &Option<Expr>| {
        let value = expr
            .as_ref()
            .map(|expr| evaluate_constant(expr, parameters));
        value.unwrap_or(0.0)
    };
    let values = model.coordinates.iter().map(|c| given(&c.initial));
    let rates = model.coordinates.iter().map(|c| given(&c.initial_rate));
    let mut state: Vec<f64> = values.chain(modes.iter().copied()).collect();
    state.extend(rates.chain(modes.iter().copied()));
    state.extend(model.states.iter().map(|s| given(&s.initial)));
    state
}

/// Returns the coordinates in the order of the model, then each field's modes `q_1 ..`.
fn coordinate_names(model: &Model, order: usize) -> Vec<String> {
    let mut names: Vec<String> = model
        .coordinates
        .iter()
        .map(|coordinate| coordinate.name.clone())
        .collect();
    for field in &model.fields {
        names.extend((1..=order).map(|mode| format!("{}_{mode}", field.coordinates)));
    }
    names
}

fn expect_length(what: &'static str, expected: usize, found: usize) -> Result<(), OracleError> {
    if expected == found {
        Ok(())
    } else {
        Err(OracleError::WrongLength {
            what,
            expected,
            found,
        })
    }
}
