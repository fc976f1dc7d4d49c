//! Rigid bodies of a model, and its remaining energies and forces.

use eomgen_model_spec::ids::CoordinateId;
use eomgen_model_spec::model::Term;
use eomgen_model_spec::rigid_tree::RigidTree;

use super::base_parameters::regroup;
use super::inward::derive_generalised_forces;
use super::links::build_links;
use super::outward::derive_motions;
use crate::mechanics::lagrange::Variables;
use crate::mechanics::rows::RowNodes;
use crate::mechanics::sweeps::Velocities;
use crate::mechanics::translate::{Derived, Translator};
use crate::symbolic::graph::{Graph, NodeId};

#[derive(Clone)]
pub(crate) struct RigidBodies {
    tree: RigidTree<NodeId>,
    other_kinetic: NodeId,
    /// Generalised forces without the bodies' weights.
    other_forces: RowNodes,
}

impl RigidBodies {
    /// Collects the rigid bodies of a model; `applied` are its forces without those of the potential. Returns `None`
    /// if the model has no bodies, if it has fields, or if its gravity is not constant.
    pub(crate) fn find(
        translator: &mut Translator,
        variables: &Variables,
        applied: &RowNodes,
    ) -> Derived<Option<Self>> {
        let model = translator.model;
        let Some(tree) = model.rigid_tree.as_ref().filter(|_| variables.fields == 0) else {
            return Ok(None);
        };
        let is_other = |term: &&Term| tree.bodies.iter().all(|body| body.name != term.name);
        let tree = tree.try_map(|expression| translator.node(expression))?;
        let constant = |id: &NodeId| translator.graph.dependence(*id).is_parameter_only();
        if !tree.gravity.iter().all(constant) {
            return Ok(None);
        }
        let mut others = |terms: &[Term]| -> Derived<NodeId> {
            let mut nodes = Vec::new();
            for term in terms.iter().filter(is_other) {
                nodes.push((1.0, translator.node(&term.value)?));
            }
            Ok(translator.graph.combine(&nodes))
        };
        let (other_kinetic, other_potential) = (others(&model.kinetic)?, others(&model.potential)?);
        Ok(Some(Self {
            tree,
            other_kinetic,
            other_forces: variables.with_potential(&mut translator.graph, applied, other_potential),
        }))
    }

    /// Returns the rows of M a + c - f. The contribution of the bodies is derived by recursion, the other
    /// contributions by Lagrange's equations. Returns `None` if the remaining kinetic energy does not depend on
    /// rates.
    pub(crate) fn inverse_dynamics(
        &self,
        graph: &mut Graph,
        coordinates: usize,
        acceleration: &dyn Fn(&mut Graph, CoordinateId) -> NodeId,
    ) -> Option<Vec<NodeId>> {
        let others = match graph.is_zero(self.other_kinetic) {
            true => vec![graph.zero(); coordinates],
            false => {
                let velocities = Velocities::from_kinetic_energy(graph, self.other_kinetic)?;
                let momenta = velocities.momenta(graph, coordinates);
                momenta.rates(graph, acceleration)
            }
        };
        let mut links = build_links(graph, &self.tree);
        regroup(graph, &mut links);
        let motions = derive_motions(graph, &links, &self.tree.gravity, acceleration);
        let bodies = derive_generalised_forces(graph, &links, &motions, coordinates);
        let rows = bodies.iter().zip(&others).zip(&self.other_forces.scalars);
        Some(
            rows.map(|((body, other), force)| {
                graph.combine(&[(1.0, *body), (1.0, *other), (-1.0, *force)])
            })
            .collect(),
        )
    }
}
