//! Interface of the machine code that the evaluator calls.

use super::point::Point;
use crate::program::{
    Corners, Impact, Products, Program, Reactions, RowValues, SlidingSurface, ValueId,
};

/// Quantities that one call computes together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Accelerations.
    Rates,
    /// Observables, with `energy` and `power` last.
    Observables,
    /// Switching surfaces.
    Guards,
    /// Distances of the impacts.
    Distances,
    /// All quantities of the impacts.
    Impacts,
    /// All quantities of the surfaces along which the motion can slide.
    Sliding,
    /// All quantities at corners of the motion.
    Corners,
    /// Blocks of the mass matrix.
    Mass,
    /// Velocity terms and generalised forces.
    Forces,
    /// Bias forces c - f. This stage and the following ones are empty if the program lacks the output.
    BiasForces,
    /// Inverse dynamics M a + c - f.
    InverseDynamics,
    /// Rates of the guards.
    GuardRates,
    /// Jacobians.
    Jacobians,
    /// Product of the Jacobian of the rates with a direction.
    ForwardProduct,
    /// Products of weights with the Jacobians of the rates by state, inputs and parameters.
    ReverseProduct,
    /// Rates with the sides of frictions as an argument.
    RatesWithSides,
    /// Functions and distances of the reactions in a step.
    ReactionFunctions,
    /// Effects and columns of the reactions, and the coefficients of the contacts.
    ReactionEffects,
}

impl Stage {
    /// Every stage.
    pub const ALL: [Self; 18] = [
        Self::Rates,
        Self::Observables,
        Self::Guards,
        Self::Distances,
        Self::Impacts,
        Self::Sliding,
        Self::Corners,
        Self::Mass,
        Self::Forces,
        Self::BiasForces,
        Self::InverseDynamics,
        Self::GuardRates,
        Self::Jacobians,
        Self::ForwardProduct,
        Self::ReverseProduct,
        Self::RatesWithSides,
        Self::ReactionFunctions,
        Self::ReactionEffects,
    ];

    /// Returns the values that the stage computes.
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
            Self::Impacts => program.impacts.iter().flat_map(impact_values).collect(),
            Self::Sliding => program
                .outputs
                .sliding
                .iter()
                .flat_map(surface_values)
                .collect(),
            Self::Corners => program
                .outputs
                .corners
                .iter()
                .flat_map(corner_values)
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
            | Self::RatesWithSides
            | Self::ReactionFunctions
            | Self::ReactionEffects => self.output_roots(program),
        }
    }
}

fn impact_values(impact: &Impact<ValueId, RowValues>) -> Vec<ValueId> {
    let mut values = vec![
        impact.distance,
        impact.rate,
        impact.workless_rate,
        impact.acceleration,
        impact.restitution,
    ];
    values.extend(&impact.delassus);
    values.extend(impact.row.all());
    values.extend(impact.column.all());
    if let Some(friction) = &impact.friction {
        values.extend([friction.coefficient, friction.slip, friction.workless_slip]);
        values.push(friction.acceleration);
        values.extend(&friction.delassus);
        values.extend(friction.column.all());
    }
    values
}

fn surface_values(surface: &SlidingSurface<ValueId, RowValues>) -> Vec<ValueId> {
    let mut values = vec![surface.rate];
    values.extend(&surface.by_sides);
    values.extend(&surface.first_order);
    values.extend(surface.column.all());
    values
}

fn corner_values(corners: &Corners<ValueId, RowValues>) -> Vec<ValueId> {
    let mut values = corners.momenta.all();
    values.extend([corners.hamiltonian, corners.energy]);
    for row in corners.surfaces.iter().chain(&corners.constraints) {
        values.push(row.rate);
        values.extend(row.row.all());
    }
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
            Self::ReverseProduct => products.flat_map(Products::reverse_roots).collect(),
            Self::RatesWithSides => (outputs.reactions.iter())
                .flat_map(Reactions::rate_roots)
                .collect(),
            Self::ReactionFunctions => (outputs.reactions.iter())
                .flat_map(Reactions::function_roots)
                .collect(),
            Self::ReactionEffects => (outputs.reactions.iter())
                .flat_map(Reactions::effect_roots)
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

/// Machine code of the stages of a program. Its memory holds the program's values at their [offsets](super::Places),
/// then data of the machine code.
pub trait MachineCode: Send + Sync {
    /// Returns the stages that the machine code computes; they must include [`Stage::Rates`]. The evaluator computes
    /// the other stages. If there are other stages, it also computes the prepared values.
    fn stages(&self) -> &[Stage] {
        &Stage::ALL
    }

    /// Returns the initial content of the data of the machine code.
    fn initial_memory(&self) -> &[f64];

    /// Computes the prepared values from the parameters and tables in memory.
    fn prepare(&self, memory: &mut [f64]);

    /// Computes the roots of a stage.
    fn compute(&self, stage: Stage, memory: &mut [f64], point: &Point<'_>);

    /// Writes the rates of the state to `out`, which has the length of the state. The values of the rates in memory
    /// are not updated.
    fn rates(&self, memory: &mut [f64], point: &Point<'_>, out: &mut [f64]);
}
