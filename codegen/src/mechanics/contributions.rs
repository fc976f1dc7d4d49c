//! Contributions of single terms of a specification to the equations of motion.

use eomgen_model_spec::model::Model;

use crate::mechanics::equations::Equations;
use crate::mechanics::lagrange::{GradientBy, Variables};
use crate::symbolic::graph::{Graph, NodeId};

/// Largest number of coordinates for which the mass matrix of each term is derived (models without fields).
const MAX_COORDINATES: usize = 12;

/// Contribution of one term of the specification.
pub(crate) struct Contribution {
    /// Section of the specification, or `guards`.
    pub(crate) section: &'static str,
    /// Name in the section; for a guard, its index.
    pub(crate) name: String,
    /// Nodes of the contribution.
    pub(crate) nodes: Vec<NodeId>,
}

/// Derives the contribution of each term alone, on a copy of the graph of the equations.
pub(crate) fn derive_contributions(
    model: &Model,
    equations: &Equations,
    graph: &mut Graph,
) -> Vec<Contribution> {
    let variables = Variables::new(model, graph.orders());
    let mut nodes = equations.terms.iter().copied();
    let mut found = Vec::new();
    let mut add = |section: &'static str, name: &str, nodes: Vec<NodeId>| {
        let name = name.to_owned();
        found.push(Contribution {
            section,
            name,
            nodes,
        });
    };
    for (term, node) in model.kinetic.iter().zip(nodes.by_ref()) {
        let mut part = derive_kinetic_nodes(graph, &variables, node);
        part.push(node);
        add("kinetic", &term.name, part);
    }
    for (term, node) in model.potential.iter().zip(nodes.by_ref()) {
        let mut part = variables
            .gradient(graph, node, GradientBy::Coordinates)
            .nodes();
        part.push(node);
        add("potential", &term.name, part);
    }
    for (term, node) in model.dissipation.iter().zip(nodes.by_ref()) {
        let mut part = variables.gradient(graph, node, GradientBy::Rates).nodes();
        part.push(node);
        add("dissipation", &term.name, part);
    }
    for (force, node) in model.forces.iter().zip(nodes) {
        add("forces", &force.name, vec![node]);
    }
    for (state, node) in model.states.iter().zip(&equations.state_rates) {
        add("states", &state.name, vec![*node]);
    }
    for (constraint, node) in model.constraints.iter().zip(&equations.residuals) {
        add("constraints", &constraint.name, vec![*node]);
    }
    for (index, guard) in equations.guards.iter().enumerate() {
        add("guards", &index.to_string(), vec![guard.value]);
    }
    found
}

/// Derives the momenta, mass matrix and velocity terms of one kinetic energy and returns their nodes.
fn derive_kinetic_nodes(graph: &mut Graph, variables: &Variables, kinetic: NodeId) -> Vec<NodeId> {
    let momenta = variables.gradient(graph, kinetic, GradientBy::Rates);
    let mut nodes = momenta.nodes();
    if variables.fields == 0 && variables.coordinates > MAX_COORDINATES {
        return nodes;
    }
    let mass = variables.mass_matrix(graph, &momenta);
    nodes.extend(mass.scalars.iter().chain(&mass.coupling).flatten());
    let blocks = mass.assemble_blocks(graph);
    nodes.extend(blocks.iter().map(|block| block.matrix));
    nodes.extend(variables.velocity_terms(graph, kinetic, &momenta).nodes());
    nodes
}

/// Returns the contribution of each observable.
pub(crate) fn collect_observable_contributions<'e>(
    model: &'e Model,
    equations: &'e Equations,
) -> impl Iterator<Item = Contribution> + 'e {
    let pairs = model.observables.iter().zip(&equations.observables);
    pairs.map(|(observable, node)| Contribution {
        section: "observables",
        name: observable.name.clone(),
        nodes: vec![*node],
    })
}
