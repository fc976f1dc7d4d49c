//! Equations of motion of one model at given truncation orders, by Lagrange's equations
//! d/dt(dT/dq') - dT/dq + dV/dq + dR/dq' = Q: mass matrix, generalised forces, accelerations, energy, power and
//! guards, as nodes of one graph.

use eomgen_model_spec::ids::StateId;
use eomgen_model_spec::model::{MULTIPLIER, Model, ParameterValue, Term};

use crate::mechanics::coefficients::{NamedCoefficient, derive_coefficients};
use crate::mechanics::constraints::{Constraints, derive_reaction_power};
use crate::mechanics::forces::{derive_applied_forces, derive_power, find_guards};
use crate::mechanics::guard::Guard;
use crate::mechanics::impact::Impact;
use crate::mechanics::impacts::impacts;
use crate::mechanics::jumps::{Energies, Jump, check_mass, find_jumps};
use crate::mechanics::kinetic::KineticRows;
use crate::mechanics::lagrange::Variables;
use crate::mechanics::mass_matrix::{MassMatrix, ModalMassBlock};
use crate::mechanics::observed_rates::derive_observable;
use crate::mechanics::redundancy::Redundancy;
use crate::mechanics::rigid_tree::bodies::RigidBodies;
use crate::mechanics::rows::RowNodes;
use crate::mechanics::solve::{Accelerations, solve};
use crate::mechanics::sweeps::Momenta;
use crate::mechanics::translate::{Derived, Translator};
use crate::symbolic::graph::{Graph, NodeId, Shape};

/// Equations of motion of one model.
#[derive(Clone)]
pub struct Equations {
    /// Name of the model.
    pub name: String,
    /// Graph of all nodes below.
    pub graph: Graph,
    /// Names of the parameters.
    pub parameter_names: Vec<String>,
    /// Expression of each derived parameter; `None` for independent parameters.
    pub derived_parameters: Vec<Option<NodeId>>,
    /// Kinetic energy T in J.
    pub kinetic: NodeId,
    /// Potential energy V in J.
    pub potential: NodeId,
    /// Mass matrix.
    pub mass: MassMatrix,
    /// Velocity terms c of M q'' + c = f.
    pub velocity_terms: RowNodes,
    /// Momenta from a backward sweep over the velocities, for models without fields.
    pub(crate) sweep: Option<Momenta>,
    pub(crate) rigid_bodies: Option<RigidBodies>,
    /// Generalised forces f: -dV/dq - dR/dq' + Q.
    pub forces: RowNodes,
    /// Accelerations, with the pivots and the operation counts of their solution.
    pub accelerations: Accelerations,
    /// Multipliers lambda of M q'' + c = f + A^T lambda.
    pub multipliers: Vec<NodeId>,
    /// Expressions of the constraints.
    pub residuals: Vec<NodeId>,
    /// Derivatives A of the constraints by coordinates, or by rates.
    pub(crate) constraint_rows: Vec<RowNodes>,
    /// Constraints that depend on each other.
    pub redundancy: Redundancy,
    /// Impacts.
    pub impacts: Vec<Impact<NodeId, RowNodes>>,
    /// Rates of the first-order states.
    pub state_rates: Vec<NodeId>,
    /// Power of all non-conservative forces in W: d(T + V)/dt.
    pub power: NodeId,
    /// Switching surfaces.
    pub guards: Vec<Guard>,
    /// Switching surfaces at which energies jump.
    pub corners: Vec<Corner>,
    /// Observables of the specification.
    pub observables: Vec<NodeId>,
    /// Named coefficients of the specification.
    pub coefficients: Vec<NamedCoefficient>,
    /// Terms in the order of the specification: kinetic, potential, dissipation, forces.
    pub terms: Vec<NodeId>,
    /// Node of each definition that is used.
    pub definitions: Vec<Option<NodeId>>,
    /// Number of inputs.
    pub inputs: usize,
    /// Modal blocks of the mass matrix on and above the diagonal.
    pub modal_blocks: Vec<ModalMassBlock>,
}

/// Switching surface at which an energy jumps, see [`corners`](crate::mechanics::corners).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Corner {
    /// Index among the switching surfaces.
    pub guard: usize,
    /// True if rates of the coordinates jump there; false if only an energy jumps, at a given time.
    pub moves_rates: bool,
}

impl Equations {
    /// Returns the nodes of the accelerations and of the rates of the first-order states.
    pub(crate) fn rate_nodes(&self) -> Vec<NodeId> {
        let mut nodes = self.accelerations.rows.nodes();
        nodes.extend(&self.state_rates);
        nodes
    }
}

/// Derives the equations of motion of a model with independent constraints; `orders` are the truncation orders of
/// the fields.
pub fn derive(model: &Model, orders: &[usize]) -> Derived<Equations> {
    derive_with_redundancy(model, orders, &Redundancy::default())
}

/// Derives the equations of motion of a model with these dependent constraints.
pub fn derive_with_redundancy(
    model: &Model,
    orders: &[usize],
    redundancy: &Redundancy,
) -> Derived<Equations> {
    let mut translator = Translator::new(model, orders);
    let derived_parameters = derived_parameters(&mut translator)?;
    let mut terms = Vec::new();
    let kinetic = sum_terms(&mut translator, &model.kinetic, "T", &mut terms)?;
    let potential = sum_terms(&mut translator, &model.potential, "V", &mut terms)?;
    let energies = Energies {
        kinetic,
        potential,
        positions: translator.positions().to_vec(),
    };
    let dissipation = sum_terms(&mut translator, &model.dissipation, "R", &mut terms)?;
    let variables = Variables::new(model, orders);
    let KineticRows {
        momenta,
        mass,
        velocity_terms,
        sweep,
    } = KineticRows::derive_cheapest(&mut translator.graph, &variables, kinetic, potential);
    name_mass_matrix(&mut translator.graph, model, &mass);
    let applied = derive_applied_forces(&mut translator, &variables, dissipation, &mut terms)?;
    let forces = variables.with_potential(&mut translator.graph, &applied, potential);
    let right_side = variables.subtract_rows(&mut translator.graph, &forces, &velocity_terms);
    let constraints = Constraints::derive(&mut translator, &variables, redundancy)?;
    let (accelerations, multipliers) =
        solve(&mut translator.graph, &mass, &right_side, &constraints);
    for (constraint, multiplier) in model.constraints.iter().zip(&multipliers) {
        let name = format!("{MULTIPLIER}{}", constraint.name);
        translator.graph.suggest_name(*multiplier, &name);
    }
    translator.set_multipliers(&multipliers);
    name_accelerations(&mut translator.graph, model, &accelerations);
    let state_rates = StateId::first(model.states.len())
        .map(|index| translator.state_rate(index))
        .collect::<Derived<Vec<NodeId>>>()?;
    let reactions = derive_reaction_power(
        &mut translator.graph,
        &variables,
        &constraints,
        &multipliers,
    );
    let power = derive_power(
        &mut translator.graph,
        &variables,
        kinetic,
        potential,
        &applied,
        &momenta,
        &accelerations,
    );
    let power = translator.graph.add(power, reactions);
    let observables = model
        .observables
        .iter()
        .map(|o| derive_observable(&mut translator, o, &accelerations.rows))
        .collect::<Derived<Vec<NodeId>>>()?;
    for (observable, node) in model.observables.iter().zip(&observables) {
        translator.graph.set_name(*node, &observable.name);
    }
    let coefficients = derive_coefficients(&mut translator, &accelerations)?;
    let mut moving = forces.nodes();
    moving.extend(velocity_terms.nodes());
    moving.extend(mass.scalars.iter().flatten());
    moving.extend(accelerations.rows.nodes());
    moving.extend(&state_rates);
    let mut guards = find_guards(&mut translator.graph, &moving);
    let jumps = find_jumps(&mut translator, &energies)?;
    let corners = add_corners(&translator.graph, jumps, &mut guards);
    if corners.iter().any(|corner| corner.moves_rates) {
        check_mass(model, &translator.graph, &mass)?;
    }
    let impacts = impacts(
        &mut translator,
        &variables,
        (kinetic, &mass, &constraints),
        &accelerations.rows,
    )?;
    let modal_blocks = mass.assemble_blocks(&mut translator.graph);
    let definitions = translator.definition_nodes();
    // This comes last because other equations must not share its nodes.
    let rigid_bodies = RigidBodies::find(&mut translator, &variables, &applied)?;
    Ok(Equations {
        name: model.name.clone(),
        graph: translator.graph,
        parameter_names: model.parameters.iter().map(|p| p.name.clone()).collect(),
        derived_parameters,
        kinetic,
        potential,
        mass,
        velocity_terms,
        sweep,
        rigid_bodies,
        forces,
        accelerations,
        multipliers,
        residuals: constraints.residuals,
        constraint_rows: constraints.rows,
        redundancy: constraints.redundancy,
        impacts,
        state_rates,
        power,
        guards,
        corners,
        observables,
        coefficients,
        terms,
        definitions,
        inputs: model.inputs.len(),
        modal_blocks,
    })
}

/// Adds the surfaces at which rates jump to the switching surfaces. A surface at which only an energy jumps is
/// kept if it switches the equations of motion.
fn add_corners(graph: &Graph, jumps: Vec<Jump>, guards: &mut Vec<Guard>) -> Vec<Corner> {
    let mut corners = Vec::with_capacity(jumps.len());
    for Jump { guard, moves_rates } in jumps {
        let known = guards.iter().position(|known| known.value == guard.value);
        let is_scalar = graph.shape(guard.value) == Shape::Scalar;
        let place = match known {
            Some(place) if moves_rates || is_scalar => place,
            None if moves_rates => {
                guards.push(guard);
                guards.len() - 1
            }
            _ => continue,
        };
        corners.push(Corner {
            guard: place,
            moves_rates,
        });
    }
    corners
}

fn name_mass_matrix(graph: &mut Graph, model: &Model, mass: &MassMatrix) {
    for (row, entries) in mass.scalars.iter().enumerate() {
        let name = &model.coordinates[row].name;
        for (column, entry) in entries.iter().enumerate().skip(row) {
            graph.suggest_name(
                *entry,
                &format!("M_{name}_{}", model.coordinates[column].name),
            );
        }
        for (field, entry) in mass.coupling[row].iter().enumerate() {
            graph.suggest_name(
                *entry,
                &format!("M_{name}_{}", model.fields[field].coordinates),
            );
        }
    }
}

fn name_accelerations(graph: &mut Graph, model: &Model, accelerations: &Accelerations) {
    for (pivot, place) in accelerations.pivots.iter().zip(&accelerations.report.order) {
        graph.suggest_name(*pivot, &format!("pivot_{}", model.coordinates[*place].name));
    }
    for (coordinate, node) in model.coordinates.iter().zip(&accelerations.rows.scalars) {
        graph.suggest_name(*node, &format!("{}_ddot", coordinate.name));
    }
    for (field, node) in model.fields.iter().zip(&accelerations.rows.modal) {
        graph.suggest_name(*node, &format!("{}_ddot", field.coordinates));
    }
}

pub(crate) fn derived_parameters(translator: &mut Translator) -> Derived<Vec<Option<NodeId>>> {
    let model = translator.model;
    model
        .parameters
        .iter()
        .map(|parameter| match &parameter.value {
            ParameterValue::Number(_) => Ok(None),
            ParameterValue::Expression(expr) => translator.node(expr).map(Some),
        })
        .collect()
}

/// Returns the sum of terms; each term gets a name of `symbol` and its own name.
pub(crate) fn sum_terms(
    translator: &mut Translator,
    terms: &[Term],
    symbol: &str,
    named: &mut Vec<NodeId>,
) -> Derived<NodeId> {
    let mut nodes = Vec::with_capacity(terms.len());
    for term in terms {
        let node = translator.node(&term.value)?;
        translator
            .graph
            .suggest_name(node, &format!("{symbol}_{}", term.name));
        named.push(node);
        nodes.push((1.0, node));
    }
    Ok(translator.graph.combine(&nodes))
}
