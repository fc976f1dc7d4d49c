//! Rows of Lagrange's equations: gradients by coordinates and rates, mass matrix and velocity terms.

use eomgen_model_spec::ids::{CoordinateId, FieldId};
use eomgen_model_spec::model::Model;

use crate::mechanics::mass_matrix::MassMatrix;
use crate::mechanics::rows::RowNodes;
use crate::mechanics::translate::along_motion;
use crate::symbolic::association::count_shared_operations;
use crate::symbolic::differentiate::derive_by_scalar;
use crate::symbolic::expand::{MAX_EXPANSIONS, expand_once};
use crate::symbolic::factor::factor_if_cheaper;
use crate::symbolic::gradient::derive_by_all;
use crate::symbolic::graph::{Dependence, Graph, NodeId, Operation, Space};
use crate::symbolic::modal_derivative::ModalDerivative;
use crate::symbolic::operation_count::count_operations;
use crate::symbolic::trigonometry::with_sums_of_angles;

pub(crate) enum GradientBy {
    Coordinates,
    Rates,
}

/// Returns the nonzero derivatives of a scalar with respect to coordinates or rates, with their indices. The work
/// grows with the number of nodes of the scalar.
pub(crate) fn derive_nonzero_gradient(
    graph: &mut Graph,
    scalar: NodeId,
    by: &GradientBy,
) -> Vec<(usize, NodeId)> {
    let by = match by {
        GradientBy::Coordinates => Dependence::COORDINATE,
        GradientBy::Rates => Dependence::RATE,
    };
    let gradient = derive_by_all(graph, scalar, by).into_iter();
    let indexed = gradient.filter_map(|(leaf, derivative)| match graph.operation(leaf) {
        Operation::Coordinate(index) | Operation::Rate(index) => Some((index.index(), derivative)),
        _ => None,
    });
    indexed.collect()
}

pub(crate) struct Variables {
    pub(crate) coordinates: usize,
    pub(crate) fields: usize,
}

impl Variables {
    pub(crate) fn new(model: &Model, orders: &[usize]) -> Self {
        Self {
            coordinates: model.coordinates.len(),
            fields: orders.len(),
        }
    }

    pub(crate) fn gradient(&self, graph: &mut Graph, scalar: NodeId, kind: GradientBy) -> RowNodes {
        let scalars = CoordinateId::first(self.coordinates)
            .map(|index| {
                let variable = graph.intern(match kind {
                    GradientBy::Coordinates => Operation::Coordinate(index),
                    GradientBy::Rates => Operation::Rate(index),
                });
                derive_by_scalar(graph, scalar, variable)
            })
            .collect();
        let modal = FieldId::first(self.fields)
            .map(|field| match self.modal(graph, field, &kind) {
                Some(mut derivative) => derivative.gradient(graph, scalar),
                None => graph.zero(),
            })
            .collect();
        RowNodes { scalars, modal }
    }

    fn modal(
        &self,
        graph: &mut Graph,
        field: FieldId,
        kind: &GradientBy,
    ) -> Option<ModalDerivative> {
        let variable = graph.intern(match kind {
            GradientBy::Coordinates => Operation::ModeCoordinates(field),
            GradientBy::Rates => Operation::ModeRates(field),
        });
        ModalDerivative::new(graph, variable)
    }

    pub(crate) fn mass_matrix(&self, graph: &mut Graph, momenta: &RowNodes) -> MassMatrix {
        let scalars = self.derive_mass_rows(graph, momenta, usize::MAX);
        self.with_modes(graph, momenta, scalars)
    }

    /// Returns the mass matrix; `None` if the rows of the coordinates take more operations than `most`.
    pub(crate) fn derive_mass_matrix_within(
        &self,
        graph: &mut Graph,
        momenta: &RowNodes,
        most: usize,
    ) -> Option<MassMatrix> {
        let scalars = self.derive_mass_rows(graph, momenta, most);
        let is_whole = scalars.len() == self.coordinates;
        is_whole.then(|| self.with_modes(graph, momenta, scalars))
    }

    /// Returns the rows of the mass matrix for the coordinates, without the modes. If the rows take more operations
    /// than `most`, the remaining rows are missing.
    fn derive_mass_rows(
        &self,
        graph: &mut Graph,
        momenta: &RowNodes,
        most: usize,
    ) -> Vec<Vec<NodeId>> {
        let rates: Vec<NodeId> = CoordinateId::first(self.coordinates)
            .map(|index| graph.intern(Operation::Rate(index)))
            .collect();
        // The matrix is symmetric: each entry is computed from the momentum with the smaller index.
        let mut scalars: Vec<Vec<NodeId>> = Vec::with_capacity(self.coordinates);
        let mut moving: Vec<NodeId> = Vec::new();
        for row in 0..self.coordinates {
            let mut entries: Vec<NodeId> = scalars.iter().map(|above| above[row]).collect();
            for &rate in &rates[row..] {
                let entry = derive_by_scalar(graph, momenta.scalars[row], rate);
                entries.push(expand_if_cheaper(graph, entry));
            }
            let own = entries[row..].iter().copied();
            let before = moving.len();
            moving.extend(own.filter(|entry| !graph.dependence(*entry).is_parameter_only()));
            scalars.push(entries);
            if most < usize::MAX && moving.len() > before && count_operations(graph, &moving) > most
            {
                break;
            }
        }
        scalars
    }

    fn with_modes(
        &self,
        graph: &mut Graph,
        momenta: &RowNodes,
        scalars: Vec<Vec<NodeId>>,
    ) -> MassMatrix {
        let mut coupling = vec![Vec::new(); self.coordinates];
        let mut modal = vec![Vec::new(); self.fields];
        for field in FieldId::first(self.fields) {
            let Some(mut derivative) = self.modal(graph, field, &GradientBy::Rates) else {
                continue;
            };
            for (row, entries) in coupling.iter_mut().enumerate() {
                entries.push(derivative.gradient(graph, momenta.scalars[row]));
            }
            for (row, blocks) in FieldId::first(self.fields).zip(&mut modal) {
                let rows = Space::Modes(row);
                let momentum = momenta.modal[row];
                blocks.push(derivative.derive_element_jacobian(graph, momentum, rows));
            }
        }
        MassMatrix {
            scalars,
            coupling,
            modal,
        }
    }

    /// Returns d/dt(dT/dq') - dT/dq at zero accelerations.
    pub(crate) fn velocity_terms(
        &self,
        graph: &mut Graph,
        kinetic: NodeId,
        momenta: &RowNodes,
    ) -> RowNodes {
        let gradient = self.gradient(graph, kinetic, GradientBy::Coordinates);
        let mut row = |momentum: NodeId, slope: NodeId| {
            let rate = along_motion(graph, momentum);
            let difference = graph.combine_flat(&[(1.0, rate), (-1.0, slope)]);
            expand_if_cheaper(graph, difference)
        };
        let scalars = momenta
            .scalars
            .iter()
            .zip(&gradient.scalars)
            .map(|(p, g)| row(*p, *g))
            .collect();
        let modal = momenta
            .modal
            .iter()
            .zip(&gradient.modal)
            .map(|(p, g)| row(*p, *g))
            .collect();
        RowNodes { scalars, modal }
    }

    pub(crate) fn with_potential(
        &self,
        graph: &mut Graph,
        applied: &RowNodes,
        potential: NodeId,
    ) -> RowNodes {
        let mut gradient = self.gradient(graph, potential, GradientBy::Coordinates);
        if self.fields == 0 {
            gradient.scalars = choose_cheapest_slopes(graph, gradient.scalars);
        }
        self.combine(graph, &[(1.0, applied.clone()), (-1.0, gradient)])
    }

    pub(crate) fn subtract_rows(&self, graph: &mut Graph, a: &RowNodes, b: &RowNodes) -> RowNodes {
        self.combine(graph, &[(1.0, a.clone()), (-1.0, b.clone())])
    }

    pub(crate) fn combine(&self, graph: &mut Graph, rows: &[(f64, RowNodes)]) -> RowNodes {
        let scalars = (0..self.coordinates)
            .map(|j| {
                let terms: Vec<(f64, NodeId)> =
                    rows.iter().map(|(c, r)| (*c, r.scalars[j])).collect();
                graph.combine_flat(&terms)
            })
            .collect();
        let modal = (0..self.fields)
            .map(|f| {
                let terms: Vec<(f64, NodeId)> =
                    rows.iter().map(|(c, r)| (*c, r.modal[f])).collect();
                graph.combine_flat(&terms)
            })
            .collect();
        RowNodes { scalars, modal }
    }

    /// Returns the scalar product of the rows with the rates.
    pub(crate) fn multiply_by_rates(&self, graph: &mut Graph, rows: &RowNodes) -> NodeId {
        let mut terms = Vec::new();
        for (index, &row) in CoordinateId::first(rows.scalars.len()).zip(&rows.scalars) {
            let rate = graph.intern(Operation::Rate(index));
            terms.push((1.0, graph.multiply(row, rate)));
        }
        for (field, &row) in FieldId::first(rows.modal.len()).zip(&rows.modal) {
            let rates = graph.intern(Operation::ModeRates(field));
            let product = graph.multiply(row, rates);
            terms.push((1.0, graph.sum_over_space(Space::Modes(field), product)));
        }
        graph.combine(&terms)
    }
}

/// Returns the gradient of a potential in the form with the fewest operations: unchanged, with common factors, or
/// expanded with collected terms.
fn choose_cheapest_slopes(graph: &mut Graph, slopes: Vec<NodeId>) -> Vec<NodeId> {
    let apart: Vec<NodeId> = slopes
        .iter()
        .map(|slope| with_sums_of_angles(graph, *slope).unwrap_or(*slope))
        .collect();
    let slopes = factor_if_cheaper(graph, slopes);
    if count_shared_operations(graph, &apart) < count_shared_operations(graph, &slopes) {
        apart
    } else {
        slopes
    }
}

/// Expands a node if this saves operations. In a velocity term, the rate of a momentum and the gradient of the
/// kinetic energy have terms that cancel, because d/dt(dv/dq') = dv/dq for the rate v of a function of coordinates.
/// Often these terms cancel only after products are expanded.
fn expand_if_cheaper(graph: &mut Graph, term: NodeId) -> NodeId {
    let mut best = term;
    let mut operations = count_operations(graph, &[term]);
    let mut expanded = term;
    for _ in 0..MAX_EXPANSIONS {
        let Some(next) = expand_once(graph, expanded) else {
            break;
        };
        expanded = next;
        let count = count_operations(graph, &[expanded]);
        if count < operations {
            (best, operations) = (expanded, count);
        }
    }
    best
}
