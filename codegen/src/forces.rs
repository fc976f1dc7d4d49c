//! Forces by virtual work and from the dissipation, their power, and the surfaces at which
//! they switch.

use model_spec::model::Function;

use crate::differentiate::{Direction, by_scalar};
use crate::equations::{Guard, Rows};
use crate::graph::{Graph, Id, Operation};
use crate::lagrange::{Kind, Layout};
use crate::solve::Accelerations;
use crate::translate::{DeriveError, Derived, Translator, along_motion};

/// -dR/dq' and the forces by virtual work, Q_j = value d(on)/dq_j.
pub(crate) fn applied_forces(
    translator: &mut Translator,
    layout: &Layout,
    dissipation: Id,
    named: &mut Vec<Id>,
) -> Derived<Rows> {
    let drag = layout.gradient(&mut translator.graph, dissipation, Kind::Rates);
    let mut rows: Vec<(f64, Rows)> = vec![(-1.0, drag)];
    for force in &translator.model.forces {
        let value = translator.node(&force.value)?;
        // A force may be called what means something else in a formula.
        if model_spec::reserved(&force.name).is_none() {
            translator.graph.suggest_name(value, &force.name);
        }
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

/// d(T + V)/dt for the forces and explicit times: Q q' + dV/dt - dT/dt (partial derivatives by
/// the time), and, if T is no quadratic form of the rates, d(2 T - p q')/dt on top.
pub(crate) fn power(
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
    let kinetic_rate = by_scalar(graph, kinetic, time);
    if !crate::degree::is_quadratic_in_rates(graph, kinetic) {
        let twice = layout.dot_rates(graph, momenta);
        let rest = graph.combine_flat(&[(2.0, kinetic), (-1.0, twice)]);
        let tangent = |graph: &mut Graph, leaf: Id| match *graph.operation(leaf) {
            Operation::Rate(index) => accelerations.rows.scalars[index],
            Operation::ModeRates(field) => accelerations.rows.modal[field],
            _ => along_motion(graph, leaf),
        };
        let rest_rate = Direction::new(&tangent).derivative(graph, rest);
        terms.push((1.0, rest_rate));
    }
    terms.push((-1.0, kinetic_rate));
    graph.combine(&terms)
}

/// The distinct switching surfaces of everything the motion depends on, in the order in
/// which the graph met them.
pub(crate) fn guards(graph: &mut Graph, roots: &[Id]) -> Vec<Guard> {
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
pub(crate) fn surfaces(graph: &mut Graph, function: Function, arguments: &[Id]) -> Vec<Id> {
    match (function, arguments) {
        (Function::Deadzone | Function::Contact, &[p, b]) => {
            vec![graph.subtract(p, b), graph.add(p, b)]
        }
        (Function::Min | Function::Max, &[a, b]) => vec![graph.subtract(a, b)],
        (Function::Abs | Function::Sign, &[a]) => vec![a],
        _ => Vec::new(),
    }
}
