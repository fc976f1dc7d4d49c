//! Mass matrix and velocity terms of a kinetic energy, in the form with the fewest operations.

use eomgen_model_spec::ids::CoordinateId;

use crate::mechanics::lagrange::{GradientBy, Variables};
use crate::mechanics::mass_matrix::MassMatrix;
use crate::mechanics::rows::RowNodes;
use crate::mechanics::sweeps::{Momenta, Velocities};
use crate::symbolic::association::count_shared_operations;
use crate::symbolic::degree::is_quadratic_in_rates;
use crate::symbolic::factor::factor_if_cheaper;
use crate::symbolic::graph::{Graph, NodeId, Operation};
use crate::symbolic::trigonometry::with_sums_of_angles;

/// Contributions of a kinetic energy to Lagrange's equations.
pub(crate) struct KineticRows {
    /// dT/dq'.
    pub(crate) momenta: RowNodes,
    pub(crate) mass: MassMatrix,
    /// d/dt(dT/dq') - dT/dq at zero accelerations.
    pub(crate) velocity_terms: RowNodes,
    pub(crate) sweep: Option<Momenta>,
}

impl KineticRows {
    /// Derives the form with the fewest operations, counted together with the gradient of the potential. Models with
    /// fields are derived by differentiation. Other models are also derived by a sweep. Both derivations are repeated
    /// for the quadratic form with sums of angles. In a long chain, differentiation gives more operations than the
    /// sweep; it is stopped when it cannot be the cheapest.
    pub(crate) fn derive_cheapest(
        graph: &mut Graph,
        variables: &Variables,
        kinetic: NodeId,
        potential: NodeId,
    ) -> Self {
        let swept = match variables.fields {
            0 => Self::derive_by_sweep(graph, variables, kinetic),
            _ => None,
        };
        let Some(swept) = swept else {
            return Self::derive_by_differentiation(graph, variables, kinetic);
        };
        let beside = variables.gradient(graph, potential, GradientBy::Coordinates);
        let sweep = swept.sweep.clone();
        let momenta = variables.gradient(graph, kinetic, GradientBy::Rates);
        let moves = |entry: &NodeId| !graph.dependence(*entry).is_parameter_only();
        let most = match variables.coordinates > MAX_COMPARED_COORDINATES
            && swept.mass.scalars.iter().flatten().any(moves)
        {
            true => MAX_RELATIVE_OPERATIONS * swept.count_operations(graph, &beside.scalars),
            false => usize::MAX,
        };
        let Some(mass) = variables.derive_mass_matrix_within(graph, &momenta, most) else {
            return swept;
        };
        let differentiated = Self::with_mass_matrix(graph, variables, kinetic, (momenta, mass));
        let mut forms = vec![differentiated, swept];
        if is_quadratic_in_rates(graph, kinetic) {
            let entries = &forms[1].mass.scalars.clone();
            if let Some(other) =
                expand_quadratic_form(graph, entries).filter(|other| *other != kinetic)
            {
                forms.push(Self::derive_by_differentiation(graph, variables, other));
                forms.extend(Self::derive_by_sweep(graph, variables, other));
            }
        }
        let operations = |form: &Self| form.count_operations(graph, &beside.scalars);
        let counts: Vec<usize> = forms.iter().map(operations).collect();
        let fewest = (0..forms.len()).min_by_key(|place| counts[*place]);
        let mut best = forms.swap_remove(fewest.unwrap_or(0));
        best.sweep = best.sweep.or(sweep);
        best
    }

    fn derive_by_differentiation(
        graph: &mut Graph,
        variables: &Variables,
        kinetic: NodeId,
    ) -> Self {
        let momenta = variables.gradient(graph, kinetic, GradientBy::Rates);
        let mass = variables.mass_matrix(graph, &momenta);
        Self::with_mass_matrix(graph, variables, kinetic, (momenta, mass))
    }

    fn with_mass_matrix(
        graph: &mut Graph,
        variables: &Variables,
        kinetic: NodeId,
        (momenta, mass): (RowNodes, MassMatrix),
    ) -> Self {
        let mut velocity_terms = variables.velocity_terms(graph, kinetic, &momenta);
        if variables.fields == 0 {
            velocity_terms.scalars = factor_if_cheaper(graph, velocity_terms.scalars);
        }
        Self {
            momenta,
            mass,
            velocity_terms,
            sweep: None,
        }
    }

    fn derive_by_sweep(graph: &mut Graph, variables: &Variables, kinetic: NodeId) -> Option<Self> {
        let velocities = Velocities::from_kinetic_energy(graph, kinetic)?;
        let size = variables.coordinates;
        let mut scalars = velocities.mass_matrix(graph, size)?;
        let momenta = velocities.momenta(graph, size);
        let rows = momenta.rates(graph, &|graph, _| graph.zero());
        let rows = factor_if_cheaper(graph, rows);
        let upper = (0..size).flat_map(|row| scalars[row][row..].to_vec());
        let entries = factor_if_cheaper(graph, upper.collect());
        let places = (0..size).flat_map(|row| (row..size).map(move |column| (row, column)));
        for ((row, column), entry) in places.zip(entries) {
            scalars[row][column] = entry;
            scalars[column][row] = entry;
        }
        Some(Self {
            momenta: RowNodes {
                scalars: momenta.momenta.clone(),
                modal: Vec::new(),
            },
            mass: MassMatrix {
                scalars,
                coupling: vec![Vec::new(); size],
                modal: Vec::new(),
            },
            velocity_terms: RowNodes {
                scalars: rows,
                modal: Vec::new(),
            },
            sweep: Some(momenta),
        })
    }

    /// Counts the operations of these rows and of the nodes `other`; shared nodes count once.
    fn count_operations(&self, graph: &Graph, other: &[NodeId]) -> usize {
        let mut nodes = self.velocity_terms.nodes();
        nodes.extend(other);
        for (row, entries) in self.mass.scalars.iter().enumerate() {
            nodes.extend(&entries[row..]);
        }
        count_shared_operations(graph, &nodes)
    }
}

/// Largest number of coordinates for which differentiation is never stopped.
const MAX_COMPARED_COORDINATES: usize = 12;

/// Differentiation stops if the mass matrix takes more operations than this multiple of all operations by the sweep.
const MAX_RELATIVE_OPERATIONS: usize = 2;

/// Largest number of coordinates for which the quadratic form is expanded.
const MAX_EXPANDED_COORDINATES: usize = 4;

/// Returns 1/2 q' M q', in which products of sines and cosines in M are written with sums of angles. Returns `None`
/// for too many coordinates or too long entries.
fn expand_quadratic_form(graph: &mut Graph, mass: &[Vec<NodeId>]) -> Option<NodeId> {
    if mass.len() > MAX_EXPANDED_COORDINATES {
        return None;
    }
    let rates: Vec<NodeId> = CoordinateId::first(mass.len())
        .map(|index| graph.intern(Operation::Rate(index)))
        .collect();
    let mut terms = Vec::new();
    for (row, entries) in mass.iter().enumerate() {
        for (column, entry) in entries.iter().enumerate().skip(row) {
            let other = with_sums_of_angles(graph, *entry)?;
            let factor = if row == column { 0.5 } else { 1.0 };
            let product = graph.product(&[(other, 1), (rates[row], 1), (rates[column], 1)]);
            terms.push((factor, product));
        }
    }
    Some(graph.combine(&terms))
}
