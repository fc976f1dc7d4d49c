//! The equations of motion of one model at one order, by Lagrange's equations
//! d/dt(dT/dq') - dT/dq + dV/dq + dR/dq' = Q, as nodes of one graph: mass matrix,
//! generalised forces, accelerations, energy, power and guards.

use model_spec::model::{Function, Model, ParameterValue, Term};

use crate::differentiate::{Direction, ModalDerivative, by_scalar};
use crate::expand::{MOST_EXPANSIONS, expand_once};
use crate::graph::{Graph, Id, Operation, Space};
use crate::matrix::StructuredMatrix;
use crate::solve::{Accelerations, count_operations, solve};
use crate::translate::{DeriveError, Derived, Translator, along_motion};

/// The equations of motion of one model at one order.
pub struct Equations {
    /// The model's name.
    pub name: String,
    /// The graph all nodes below belong to.
    pub graph: Graph,
    /// Names of the parameters.
    pub parameter_names: Vec<String>,
    /// For each parameter, the node of its expression, if it is derived from others.
    pub derived_parameters: Vec<Option<Id>>,
    /// T, in J.
    pub kinetic: Id,
    /// V, in J.
    pub potential: Id,
    /// The mass matrix.
    pub mass: MassMatrix,
    /// Velocity terms c of M q'' + c = f: what is quadratic in the rates and not a force.
    pub velocity_terms: Rows,
    /// Generalised forces f: -dV/dq - dR/dq' + Q.
    pub forces: Rows,
    /// The accelerations and how they were solved for.
    pub accelerations: Accelerations,
    /// Power of all non-conservative forces, in W: d(T + V)/dt.
    pub power: Id,
    /// The switching surfaces: a node that changes sign, with what it means.
    pub guards: Vec<Guard>,
    /// The specification's observables.
    pub observables: Vec<Id>,
    /// The specification's named coefficients.
    pub coefficients: Vec<NamedCoefficient>,
    /// The terms of the energies and of the dissipation and the forces, in the order of the
    /// specification: kinetic, potential, dissipation, forces.
    pub terms: Vec<Id>,
    /// Nodes of the definitions that anything uses.
    pub definitions: Vec<Option<Id>>,
    /// The modal blocks of the mass matrix on and above the diagonal as nodes: field of
    /// the rows, block, field of the columns.
    pub modal_blocks: Vec<(usize, Id, usize)>,
}

/// One entry per coordinate, then one vector per field.
#[derive(Clone, Debug)]
pub struct Rows {
    /// Scalars, one per coordinate.
    pub scalars: Vec<Id>,
    /// Vectors over the modes, one per field.
    pub modal: Vec<Id>,
}

/// The mass matrix by blocks.
#[derive(Clone, Debug)]
pub struct MassMatrix {
    /// coordinates x coordinates
    pub scalars: Vec<Vec<Id>>,
    /// For each coordinate and field the vector over the modes.
    pub coupling: Vec<Vec<Id>>,
    /// For each pair of fields the block over their modes.
    pub modal: Vec<Vec<StructuredMatrix>>,
}

/// A switching surface.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Guard {
    /// Changes sign where the model switches.
    pub value: Id,
    /// The function that switches.
    pub function: Function,
}

/// A coefficient the specification names.
#[derive(Clone, Debug)]
pub struct NamedCoefficient {
    /// Its name.
    pub name: String,
    /// Its value: a scalar, or a vector over the modes.
    pub value: Id,
    /// For a factor: where it stands.
    pub factor: Option<Factor>,
}

/// Where a named factor stands: `times` the acceleration of `row` holds it times `by`.
#[derive(Clone, Copy, Debug)]
pub struct Factor {
    /// The row.
    pub row: Row,
    /// What it multiplies.
    pub by: Id,
    /// What the row is multiplied with, if anything.
    pub times: Option<Id>,
}

/// A row of the equations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Row {
    /// A coordinate's.
    Coordinate(usize),
    /// Every mode of a field.
    Modes(usize),
}

/// Derives the equations of motion for fields of these orders.
pub fn derive(model: &Model, orders: &[usize]) -> Derived<Equations> {
    let mut translator = Translator::new(model, orders);
    let derived_parameters = derived_parameters(&mut translator)?;
    let mut terms = Vec::new();
    let kinetic = total_of(&mut translator, &model.kinetic, "T", &mut terms)?;
    let potential = total_of(&mut translator, &model.potential, "V", &mut terms)?;
    let dissipation = total_of(&mut translator, &model.dissipation, "R", &mut terms)?;
    let layout = Layout::new(model, orders);
    let momenta = layout.gradient(&mut translator.graph, kinetic, Kind::Rates);
    let mass = layout.mass_matrix(&mut translator.graph, &momenta);
    name_mass_matrix(&mut translator.graph, model, &mass);
    let velocity_terms = layout.velocity_terms(&mut translator.graph, kinetic, &momenta);
    let applied = applied_forces(&mut translator, &layout, dissipation, &mut terms)?;
    let forces = layout.with_potential(&mut translator.graph, &applied, potential);
    let right_side = layout.difference(&mut translator.graph, &forces, &velocity_terms);
    let accelerations = solve(&mut translator.graph, &mass, &right_side);
    name_accelerations(&mut translator.graph, model, &accelerations);
    let power = power(
        &mut translator.graph,
        &layout,
        kinetic,
        potential,
        &applied,
        &momenta,
        &accelerations,
    );
    let observables = model
        .observables
        .iter()
        .map(|o| translator.node(&o.value))
        .collect::<Derived<Vec<Id>>>()?;
    for (observable, node) in model.observables.iter().zip(&observables) {
        translator.graph.set_name(*node, &observable.name);
    }
    let coefficients = crate::coefficients::named(&mut translator, &accelerations)?;
    let mut moving = forces.nodes();
    moving.extend(velocity_terms.nodes());
    moving.extend(mass.scalars.iter().flatten());
    moving.extend(accelerations.rows.nodes());
    let guards = guards(&mut translator.graph, &moving);
    let modal_blocks = mass.assembled_blocks(&mut translator.graph);
    let definitions = translator.definition_nodes();
    Ok(Equations {
        name: model.name.clone(),
        graph: translator.graph,
        parameter_names: model.parameters.iter().map(|p| p.name.clone()).collect(),
        derived_parameters,
        kinetic,
        potential,
        mass,
        velocity_terms,
        forces,
        accelerations,
        power,
        guards,
        observables,
        coefficients,
        terms,
        definitions,
        modal_blocks,
    })
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

fn derived_parameters(translator: &mut Translator) -> Derived<Vec<Option<Id>>> {
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

/// The sum of named terms; each is named after `symbol` and itself.
fn total_of(
    translator: &mut Translator,
    terms: &[Term],
    symbol: &str,
    named: &mut Vec<Id>,
) -> Derived<Id> {
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

/// -dR/dq' and the forces by virtual work, Q_j = value d(on)/dq_j.
fn applied_forces(
    translator: &mut Translator,
    layout: &Layout,
    dissipation: Id,
    named: &mut Vec<Id>,
) -> Derived<Rows> {
    let drag = layout.gradient(&mut translator.graph, dissipation, Kind::Rates);
    let mut rows: Vec<(f64, Rows)> = vec![(-1.0, drag)];
    for force in &translator.model.forces {
        let value = translator.node(&force.value)?;
        translator.graph.suggest_name(value, &force.name);
        named.push(value);
        let on = translator.node(&force.on)?;
        if translator
            .graph
            .dependence(on)
            .has(crate::graph::Dependence::RATE)
        {
            return Err(DeriveError {
                span: force.on.span,
                message: "a force acts on something that holds a rate".into(),
                help: Some(
                    "virtual work needs a coordinate or an expression of coordinates".into(),
                ),
            });
        }
        let mut gradient = layout.gradient(&mut translator.graph, on, Kind::Coordinates);
        for node in gradient.scalars.iter_mut().chain(&mut gradient.modal) {
            *node = translator.graph.multiply(*node, value);
        }
        rows.push((1.0, gradient));
    }
    Ok(layout.combine(&mut translator.graph, &rows))
}

/// d(T + V)/dt for the forces and explicit times: Q q' + dV/dt, and, if T is not a
/// quadratic form of the rates alone, d(2 T - p q')/dt - dT/dt on top.
fn power(
    graph: &mut Graph,
    layout: &Layout,
    kinetic: Id,
    potential: Id,
    applied: &Rows,
    momenta: &Rows,
    accelerations: &Accelerations,
) -> Id {
    let time = graph.intern(Operation::Time);
    let work = layout.dot_rates(graph, applied);
    let potential_rate = by_scalar(graph, potential, time);
    let mut terms = vec![(1.0, work), (1.0, potential_rate)];
    if !crate::degree::is_quadratic_in_rates(graph, kinetic) {
        let kinetic_rate = by_scalar(graph, kinetic, time);
        let twice = layout.dot_rates(graph, momenta);
        let rest = graph.combine_flat(&[(2.0, kinetic), (-1.0, twice)]);
        let tangent = |graph: &mut Graph, leaf: Id| match *graph.operation(leaf) {
            Operation::Rate(index) => accelerations.rows.scalars[index],
            Operation::ModeRates(field) => accelerations.rows.modal[field],
            _ => along_motion(graph, leaf),
        };
        let rest_rate = Direction::new(&tangent).derivative(graph, rest);
        terms.extend([(1.0, rest_rate), (-1.0, kinetic_rate)]);
    }
    graph.combine(&terms)
}

/// The distinct switching surfaces of everything the motion depends on, in the order in
/// which the graph met them.
fn guards(graph: &mut Graph, roots: &[Id]) -> Vec<Guard> {
    let mut found: Vec<Guard> = Vec::new();
    for id in graph.reachable(roots) {
        if graph.dependence(id).is_prepared() {
            continue;
        }
        let (function, arguments) = match graph.operation(id).clone() {
            Operation::Call(function, arguments) => (function, arguments.to_vec()),
            // The slope of the smaller or larger of two; that of the smaller is turned round.
            Operation::Select { a, b, .. } => {
                let turned = graph.subtract(b, a);
                if found.iter().any(|guard| guard.value == turned) {
                    continue;
                }
                (Function::Max, vec![a, b])
            }
            _ => continue,
        };
        for value in surfaces(graph, function, &arguments) {
            if found.iter().all(|guard| guard.value != value) {
                found.push(Guard { value, function });
            }
        }
    }
    found
}

/// Where a piecewise function switches, as nodes that change sign there.
fn surfaces(graph: &mut Graph, function: Function, arguments: &[Id]) -> Vec<Id> {
    match (function, arguments) {
        (Function::Deadzone | Function::Contact, &[p, b]) => {
            vec![graph.subtract(p, b), graph.add(p, b)]
        }
        (Function::Min | Function::Max, &[a, b]) => vec![graph.subtract(a, b)],
        (Function::Abs | Function::Sign, &[a]) => vec![a],
        _ => Vec::new(),
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

impl MassMatrix {
    fn assembled_blocks(&self, graph: &mut Graph) -> Vec<(usize, Id, usize)> {
        let mut blocks = Vec::new();
        for (row, columns) in self.modal.iter().enumerate() {
            for (column, block) in columns.iter().enumerate().skip(row) {
                if !block.is_zero() {
                    blocks.push((row, block.assemble(graph), column));
                }
            }
        }
        blocks
    }
}

impl Rows {
    /// All nodes, coordinates first.
    pub fn nodes(&self) -> Vec<Id> {
        self.scalars.iter().chain(&self.modal).copied().collect()
    }
}

enum Kind {
    Coordinates,
    Rates,
}

/// Which variables there are.
struct Layout {
    coordinates: usize,
    fields: usize,
}

impl Layout {
    fn new(model: &Model, orders: &[usize]) -> Self {
        Self {
            coordinates: model.coordinates.len(),
            fields: orders.len(),
        }
    }

    /// The gradient of a scalar by coordinates or by rates.
    fn gradient(&self, graph: &mut Graph, scalar: Id, kind: Kind) -> Rows {
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

    fn mass_matrix(&self, graph: &mut Graph, momenta: &Rows) -> MassMatrix {
        let rates: Vec<Id> = (0..self.coordinates)
            .map(|index| graph.intern(Operation::Rate(index)))
            .collect();
        // By symmetry the entry comes from the momentum of the smaller index, so that both
        // halves are the same nodes.
        let scalars = (0..self.coordinates)
            .map(|row| {
                (0..self.coordinates)
                    .map(|column| {
                        let (low, high) = (row.min(column), row.max(column));
                        let entry = by_scalar(graph, momenta.scalars[low], rates[high]);
                        cheaper_expansion(graph, entry)
                    })
                    .collect()
            })
            .collect();
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
    fn velocity_terms(&self, graph: &mut Graph, kinetic: Id, momenta: &Rows) -> Rows {
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

    fn with_potential(&self, graph: &mut Graph, applied: &Rows, potential: Id) -> Rows {
        let gradient = self.gradient(graph, potential, Kind::Coordinates);
        self.combine(graph, &[(1.0, applied.clone()), (-1.0, gradient)])
    }

    fn difference(&self, graph: &mut Graph, a: &Rows, b: &Rows) -> Rows {
        self.combine(graph, &[(1.0, a.clone()), (-1.0, b.clone())])
    }

    fn combine(&self, graph: &mut Graph, rows: &[(f64, Rows)]) -> Rows {
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
    fn dot_rates(&self, graph: &mut Graph, rows: &Rows) -> Id {
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
