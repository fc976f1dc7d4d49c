//! Nodes of a model without fields, without its equations of motion. Every expression is translated; constraints and
//! distances of impacts are differentiated with respect to their coordinates. The work is proportional to the size of
//! the specification; deriving the equations of motion takes work that grows at least with its square.

use eomgen_model_spec::ids::{ConstraintId, StateId};
use eomgen_model_spec::model::{CoefficientKind, Model};

use crate::mechanics::coefficients::find_equation_row;
use crate::mechanics::constraints::nonlinear_error;
use crate::mechanics::equations::{derived_parameters, sum_terms};
use crate::mechanics::forces::translate_force;
use crate::mechanics::impacts::{describe_constant_distance, describe_nonlinear_slip};
use crate::mechanics::jumps::{Energies, find_jumps};
use crate::mechanics::lagrange::{GradientBy, derive_nonzero_gradient};
use crate::mechanics::translate::{Derived, Translator, along_motion};
use crate::symbolic::graph::{Argument, Dependence, Graph, NodeId, Operation, Variable};

/// Translated model without accelerations.
pub(crate) struct Unsolved {
    pub(crate) graph: Graph,
    /// Kinetic energy T in J.
    pub(crate) kinetic: NodeId,
    pub(crate) constraints: Vec<ConstraintNodes>,
}

pub(crate) struct ConstraintNodes {
    /// Expression of the constraint.
    pub(crate) residual: NodeId,
    /// Nonzero derivatives with respect to coordinates or rates, with their indices.
    pub(crate) derivatives: Vec<(usize, NodeId)>,
}

impl Unsolved {
    /// Translates a model without fields.
    ///
    /// # Errors
    /// Expressions that cannot be derived.
    pub(crate) fn translate(model: &Model) -> Derived<Self> {
        let mut translator = Translator::new(model, &[]);
        let mut terms = Vec::new();
        derived_parameters(&mut translator)?;
        let kinetic = sum_terms(&mut translator, &model.kinetic, "T", &mut terms)?;
        let potential = sum_terms(&mut translator, &model.potential, "V", &mut terms)?;
        let energies = Energies {
            kinetic,
            potential,
            positions: translator.positions().to_vec(),
        };
        sum_terms(&mut translator, &model.dissipation, "R", &mut terms)?;
        for force in &model.forces {
            translate_force(&mut translator, force)?;
        }
        let constraints = translate_constraints(&mut translator)?;
        for state in StateId::first(model.states.len()) {
            translator.state_rate(state)?;
        }
        for observable in &model.observables {
            translator.node(&observable.value)?;
        }
        translate_coefficients(&mut translator)?;
        translate_impacts(&mut translator)?;
        find_jumps(&mut translator, &energies)?;
        Ok(Self {
            graph: translator.graph,
            kinetic,
            constraints,
        })
    }

    pub(crate) fn residuals(&self) -> impl Iterator<Item = NodeId> {
        self.constraints.iter().map(|one| one.residual)
    }
}

fn translate_constraints(translator: &mut Translator) -> Derived<Vec<ConstraintNodes>> {
    let model = translator.model;
    let mut found = Vec::with_capacity(model.constraints.len());
    let mut multipliers = Vec::with_capacity(model.constraints.len());
    for (id, constraint) in ConstraintId::first(model.constraints.len()).zip(&model.constraints) {
        let residual = translator.residual(id)?;
        let graph = &mut translator.graph;
        let (by, multiplier) = match constraint.is_nonholonomic {
            true => (GradientBy::Rates, residual),
            false => (GradientBy::Coordinates, along_motion(graph, residual)),
        };
        let derivatives = derive_nonzero_gradient(graph, residual, &by);
        let moves = |entry: &(usize, NodeId)| graph.dependence(entry.1).has(Dependence::RATE);
        if derivatives.iter().any(moves) {
            return Err(nonlinear_error(constraint));
        }
        found.push(ConstraintNodes {
            residual,
            derivatives,
        });
        multipliers.push(multiplier);
    }
    // Observables can contain multipliers. The placeholders depend on rates, like the multipliers.
    translator.set_multipliers(&multipliers);
    Ok(found)
}

fn translate_coefficients(translator: &mut Translator) -> Derived<()> {
    for coefficient in &translator.model.coefficients {
        let node = match &coefficient.kind {
            CoefficientKind::Value(expression) => translator.node(expression)?,
            CoefficientKind::Factor { of, by, times } => {
                find_equation_row(of)?;
                translator.node(by)?;
                if let Some(times) = times {
                    translator.node(times)?;
                }
                // This is a placeholder, because the coefficient itself needs the accelerations.
                let unknown = Operation::Argument(Argument::Weights, Variable::Time);
                translator.graph.intern(unknown)
            }
        };
        translator.push_coefficient(node);
    }
    Ok(())
}

/// Translates impacts without deriving their changes of the rates.
///
/// # Errors
/// Expressions that cannot be derived, a distance that no coordinate changes, and a slip that is not linear in
/// the rates.
pub(crate) fn translate_impacts(translator: &mut Translator) -> Derived<()> {
    let model = translator.model;
    for impact in &model.impacts {
        let distance = translator.node(&impact.when)?;
        translator.node(&impact.restitution)?;
        let graph = &mut translator.graph;
        // At order 0, a distance of a field depends on no mode.
        let is_rigid = model.fields.is_empty();
        if is_rigid && derive_nonzero_gradient(graph, distance, &GradientBy::Coordinates).is_empty()
        {
            return Err(describe_constant_distance(impact));
        }
        if let Some(friction) = &impact.friction {
            translator.node(&friction.coefficient)?;
            let slip = translator.node(&friction.slip)?;
            let graph = &mut translator.graph;
            let derivatives = derive_nonzero_gradient(graph, slip, &GradientBy::Rates);
            let moves = |entry: &(usize, NodeId)| graph.dependence(entry.1).has(Dependence::RATE);
            if derivatives.iter().any(moves) {
                return Err(describe_nonlinear_slip(impact, friction));
            }
        }
    }
    Ok(())
}
