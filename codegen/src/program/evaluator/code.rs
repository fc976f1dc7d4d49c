//! Machine code of a program, as the evaluator calls it. How it is made is not known here.

use super::point::Point;
use crate::program::{Impact, Products, Program, RowValues, SlidingSurface, ValueId};

/// What is computed together in one call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// The accelerations.
    Rates,
    /// The observables, `energy` and `power` last.
    Observables,
    /// The switching surfaces.
    Guards,
    /// The distances of the impacts.
    Distances,
    /// Everything of the impacts.
    Impacts,
    /// Everything of the surfaces that may hold the motion.
    Sliding,
    /// The blocks of the mass matrix.
    Mass,
    /// Velocity terms and generalised forces.
    Forces,
    /// c - f, if it is among the outputs; so for those that follow.
    BiasForces,
    /// M a + c - f.
    InverseDynamics,
    /// The rates of the guards.
    GuardRates,
    /// All Jacobians.
    Jacobians,
    /// The Jacobian of the rates times a direction.
    ForwardProduct,
    /// Weights times the Jacobian of the rates.
    ReverseProduct,
    /// Weights times the Jacobian of the rates by parameters.
    ParameterProduct,
}

impl Stage {
    /// Every stage.
    pub const ALL: [Self; 15] = [
        Self::Rates,
        Self::Observables,
        Self::Guards,
        Self::Distances,
        Self::Impacts,
        Self::Sliding,
        Self::Mass,
        Self::Forces,
        Self::BiasForces,
        Self::InverseDynamics,
        Self::GuardRates,
        Self::Jacobians,
        Self::ForwardProduct,
        Self::ReverseProduct,
        Self::ParameterProduct,
    ];

    /// The values it answers with.
    pub fn roots(self, program: &Program) -> Vec<ValueId> {
        match self {
            Self::Rates => program.rate_roots(),
            Self::Observables => program.observable_values.clone(),
            Self::Guards => program.guards.iter().map(|guard| guard.value).collect(),
            Self::Distances => program
                .impacts
                .iter()
                .map(|impact| impact.distance)
                .collect(),
            Self::Impacts => program.impacts.iter().flat_map(of_impact).collect(),
            Self::Sliding => program
                .outputs
                .sliding
                .iter()
                .flat_map(of_surface)
                .collect(),
            Self::Mass => {
                let mass = &program.mass;
                let mut roots: Vec<ValueId> = mass.scalars.iter().flatten().copied().collect();
                roots.extend(mass.coupling.iter().flatten());
                roots.extend(mass.modal.iter().flatten().flatten());
                roots
            }
            Self::Forces => {
                let mut roots = program.velocity_terms.all();
                roots.extend(program.forces.all());
                roots
            }
            Self::BiasForces
            | Self::InverseDynamics
            | Self::GuardRates
            | Self::Jacobians
            | Self::ForwardProduct
            | Self::ReverseProduct
            | Self::ParameterProduct => self.output_roots(program),
        }
    }
}

/// The values of an impact.
fn of_impact(impact: &Impact<ValueId, RowValues>) -> Vec<ValueId> {
    let mut values = vec![
        impact.distance,
        impact.rate,
        impact.acceleration,
        impact.restitution,
    ];
    values.extend(&impact.delassus);
    values.extend(impact.column.all());
    values
}

/// The values of a surface that may hold the motion.
fn of_surface(surface: &SlidingSurface<ValueId, RowValues>) -> Vec<ValueId> {
    let mut values = vec![surface.rate];
    values.extend(&surface.by_sides);
    values.extend(&surface.first_order);
    values.extend(surface.column.all());
    values
}

impl Stage {
    fn output_roots(self, program: &Program) -> Vec<ValueId> {
        let outputs = &program.outputs;
        let products = outputs.products.iter();
        match self {
            Self::BiasForces => {
                let rows = outputs.bias_forces.iter();
                rows.flat_map(RowValues::all).collect()
            }
            Self::InverseDynamics => {
                let rows = outputs.inverse_dynamics.iter();
                rows.flat_map(RowValues::all).collect()
            }
            Self::GuardRates => outputs.guard_rates.iter().flatten().copied().collect(),
            Self::ForwardProduct => products.flat_map(Products::forward_roots).collect(),
            Self::ReverseProduct => products
                .flat_map(|p| p.reverse.iter().map(|(_, id)| *id))
                .collect(),
            Self::ParameterProduct => products
                .flat_map(|p| p.by_parameters.entries.iter().map(|entry| entry.value))
                .collect(),
            _ => {
                let jacobians = outputs.jacobians.iter();
                jacobians
                    .flat_map(|jacobian| jacobian.entries.iter().map(|entry| entry.value))
                    .collect()
            }
        }
    }
}

/// Machine code of every stage of a program. It works in the evaluator's memory: the
/// program's values at their [places](super::Places), then room of its own.
pub trait MachineCode: Send + Sync {
    /// What its own room holds at first.
    fn room(&self) -> &[f64];

    /// Computes what is prepared, parameters and tables being in their places.
    fn prepare(&self, memory: &mut [f64]);

    /// Computes the roots of a stage into their places.
    fn compute(&self, stage: Stage, memory: &mut [f64], point: &Point<'_>);

    /// The rates of the state into `out`, of the state's length; their places are not
    /// written.
    fn rates(&self, memory: &mut [f64], point: &Point<'_>, out: &mut [f64]);
}
