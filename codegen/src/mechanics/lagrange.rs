//! The rows of Lagrange's equations: gradients by coordinates and rates, the mass matrix and
//! the velocity terms of a kinetic energy.

use model_spec::model::Model;

use crate::mechanics::mass_matrix::MassMatrix;
use crate::mechanics::rows::Rows;
use crate::mechanics::translate::along_motion;
use crate::symbolic::differentiate::{ModalDerivative, by_scalar};
use crate::symbolic::expand::{MOST_EXPANSIONS, expand_once};
use crate::symbolic::graph::{Graph, Id, Operation, Space};
use crate::symbolic::operation_count::count_operations;

/// What a gradient is taken by.
pub(crate) enum Kind {
    Coordinates,
    Rates,
}

/// Which variables there are.
pub(crate) struct Layout {
    coordinates: usize,
    fields: usize,
}

impl Layout {
    pub(crate) fn new(model: &Model, orders: &[usize]) -> Self {
        Self {
            coordinates: model.coordinates.len(),
            fields: orders.len(),
        }
    }

    /// The gradient of a scalar by coordinates or by rates.
    pub(crate) fn gradient(&self, graph: &mut Graph, scalar: Id, kind: Kind) -> Rows {
        let scalars = (0..self.coordinates)
            .map(|index| {
                let variable = graph.intern(match kind {
                    Kind::Coordinates => Operation::Coordinate(index),
                    Kind::Rates => Operation::Rate(index),
                });
                by_scalar(graph, scalar, variable)
            })
            .collect();
        let modal = (0..self.fields)
            .map(|field| match self.modal(graph, field, &kind) {
                Some(mut derivative) => derivative.gradient(graph, scalar),
                None => graph.zero(),
            })
            .collect();
        Rows { scalars, modal }
    }

    fn modal(&self, graph: &mut Graph, field: usize, kind: &Kind) -> Option<ModalDerivative> {
        let variable = graph.intern(match kind {
            Kind::Coordinates => Operation::ModeCoordinates(field),
            Kind::Rates => Operation::ModeRates(field),
        });
        ModalDerivative::new(graph, variable)
    }

    pub(crate) fn mass_matrix(&self, graph: &mut Graph, momenta: &Rows) -> MassMatrix {
        let rates: Vec<Id> = (0..self.coordinates)
            .map(|index| graph.intern(Operation::Rate(index)))
            .collect();
        // By symmetry an entry comes from the momentum of the smaller index.
        let mut scalars: Vec<Vec<Id>> = Vec::with_capacity(self.coordinates);
        for row in 0..self.coordinates {
            let mut entries: Vec<Id> = scalars.iter().map(|above| above[row]).collect();
            for &rate in &rates[row..] {
                let entry = by_scalar(graph, momenta.scalars[row], rate);
                entries.push(cheaper_expansion(graph, entry));
            }
            scalars.push(entries);
        }
        let mut coupling = vec![Vec::new(); self.coordinates];
        let mut modal = vec![Vec::new(); self.fields];
        for field in 0..self.fields {
            let Some(mut derivative) = self.modal(graph, field, &Kind::Rates) else {
                continue;
            };
            for (row, entries) in coupling.iter_mut().enumerate() {
                entries.push(derivative.gradient(graph, momenta.scalars[row]));
            }
            for (row, blocks) in modal.iter_mut().enumerate() {
                let rows = Space::Modes(row);
                let momentum = momenta.modal[row];
                blocks.push(derivative.of_elements(graph, momentum, rows));
            }
        }
        MassMatrix {
            scalars,
            coupling,
            modal,
        }
    }

    /// The rate of the momenta along the motion without accelerations, minus dT/dq.
    pub(crate) fn velocity_terms(&self, graph: &mut Graph, kinetic: Id, momenta: &Rows) -> Rows {
        let gradient = self.gradient(graph, kinetic, Kind::Coordinates);
        let mut row = |momentum: Id, slope: Id| {
            let rate = along_motion(graph, momentum);
            let difference = graph.combine_flat(&[(1.0, rate), (-1.0, slope)]);
            cheaper_expansion(graph, difference)
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
        Rows { scalars, modal }
    }

    pub(crate) fn with_potential(&self, graph: &mut Graph, applied: &Rows, potential: Id) -> Rows {
        let gradient = self.gradient(graph, potential, Kind::Coordinates);
        self.combine(graph, &[(1.0, applied.clone()), (-1.0, gradient)])
    }

    pub(crate) fn difference(&self, graph: &mut Graph, a: &Rows, b: &Rows) -> Rows {
        self.combine(graph, &[(1.0, a.clone()), (-1.0, b.clone())])
    }

    pub(crate) fn combine(&self, graph: &mut Graph, rows: &[(f64, Rows)]) -> Rows {
        let scalars = (0..self.coordinates)
            .map(|j| {
                let terms: Vec<(f64, Id)> = rows.iter().map(|(c, r)| (*c, r.scalars[j])).collect();
                graph.combine_flat(&terms)
            })
            .collect();
        let modal = (0..self.fields)
            .map(|f| {
                let terms: Vec<(f64, Id)> = rows.iter().map(|(c, r)| (*c, r.modal[f])).collect();
                graph.combine_flat(&terms)
            })
            .collect();
        Rows { scalars, modal }
    }

    /// The sum over all rows of a row times its rate.
    pub(crate) fn dot_rates(&self, graph: &mut Graph, rows: &Rows) -> Id {
        let mut terms = Vec::new();
        for (index, &row) in rows.scalars.iter().enumerate() {
            let rate = graph.intern(Operation::Rate(index));
            terms.push((1.0, graph.multiply(row, rate)));
        }
        for (field, &row) in rows.modal.iter().enumerate() {
            let rates = graph.intern(Operation::ModeRates(field));
            let product = graph.multiply(row, rates);
            terms.push((1.0, graph.total_over(Space::Modes(field), product)));
        }
        graph.combine(&terms)
    }
}

/// A node multiplied out where that is cheaper. Of a velocity term the rate of a momentum
/// and the slope of the kinetic energy share terms that cancel, but often only inside
/// products: d/dt(dv/dq') = dv/dq for the rate v of anything that depends on coordinates.
fn cheaper_expansion(graph: &mut Graph, term: Id) -> Id {
    let mut best = term;
    let mut operations = count_operations(graph, &[term]);
    let mut expanded = term;
    for _ in 0..MOST_EXPANSIONS {
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
