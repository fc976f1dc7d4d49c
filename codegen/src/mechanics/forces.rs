//! Forces by virtual work and from the dissipation, their power, and the surfaces at which
//! they switch.

use eomgen_model_spec::model::{Force, Function};

use crate::mechanics::guard::Guard;
use crate::mechanics::lagrange::{GradientBy, Variables};
use crate::mechanics::rows::RowNodes;
use crate::mechanics::solve::Accelerations;
use crate::mechanics::translate::{DeriveError, Derived, Translator, along_motion, explicit_rate};
use crate::symbolic::differentiate::Direction;
use crate::symbolic::graph::{Dependence, Graph, NodeId, Operation};

/// -dR/dq' and the forces by virtual work, Q_j = value d(on)/dq_j.
pub(crate) fn applied_forces(
    translator: &mut Translator,
    variables: &Variables,
    dissipation: NodeId,
    named: &mut Vec<NodeId>,
) -> Derived<RowNodes> {
    let drag = variables.gradient(&mut translator.graph, dissipation, GradientBy::Rates);
    let mut rows: Vec<(f64, RowNodes)> = vec![(-1.0, drag)];
    for force in &translator.model.forces {
        let (value, on) = translated(translator, force)?;
        named.push(value);
        let mut gradient = variables.gradient(&mut translator.graph, on, GradientBy::Coordinates);
        for node in gradient.scalars.iter_mut().chain(&mut gradient.modal) {
            *node = translator.graph.multiply(*node, value);
        }
        rows.push((1.0, gradient));
    }
    Ok(variables.combine(&mut translator.graph, &rows))
}

/// The value of a force and the expression that it works on.
///
/// # Errors
/// A failed derivation, and a force on an expression that holds a rate.
pub(crate) fn translated(translator: &mut Translator, force: &Force) -> Derived<(NodeId, NodeId)> {
    let value = translator.node(&force.value)?;
    // A force may be called what means something else in a formula.
    if eomgen_model_spec::reserved(&force.name).is_none() {
        translator.graph.suggest_name(value, &force.name);
    }
    let on = translator.node(&force.on)?;
    if translator.graph.dependence(on).has(Dependence::RATE) {
        return Err(DeriveError {
            span: force.on.span,
            message: "a force acts on something that holds a rate".into(),
            help: Some("virtual work needs a coordinate or an expression of coordinates".into()),
        });
    }
    Ok((value, on))
}

/// d(T + V)/dt for the forces and explicit times: Q q' + dV/dt - dT/dt (partial derivatives by
/// the time), and, if T is no quadratic form of the rates, d(2 T - p q')/dt on top.
pub(crate) fn power(
    graph: &mut Graph,
    variables: &Variables,
    kinetic: NodeId,
    potential: NodeId,
    applied: &RowNodes,
    momenta: &RowNodes,
    accelerations: &Accelerations,
) -> NodeId {
    let work = variables.dot_rates(graph, applied);
    let potential_rate = explicit_rate(graph, potential);
    let mut terms = vec![(1.0, work), (1.0, potential_rate)];
    let kinetic_rate = explicit_rate(graph, kinetic);
    if !crate::symbolic::degree::is_quadratic_in_rates(graph, kinetic) {
        let twice = variables.dot_rates(graph, momenta);
        let rest = graph.combine_flat(&[(2.0, kinetic), (-1.0, twice)]);
        let tangent = |graph: &mut Graph, leaf: NodeId| match *graph.operation(leaf) {
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
pub(crate) fn guards(graph: &mut Graph, roots: &[NodeId]) -> Vec<Guard> {
    let mut found: Vec<Guard> = Vec::new();
    for id in graph.reachable(roots) {
        if graph.dependence(id).is_parameter_only() || graph.guarded_power(id).is_some() {
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
        for value in surfaces(graph, function, &arguments).all() {
            if found.iter().all(|guard| guard.value != value) {
                found.push(Guard { value, function });
            }
        }
    }
    found
}

/// Where a piecewise function switches: nodes that change sign there, and are positive where
/// they say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Surfaces {
    /// Nowhere.
    None,
    /// Where p changes sign.
    One(NodeId),
    /// Where p changes sign: -p, which is positive where p is negative.
    Turned(NodeId),
    /// Where p passes b or -b: positive above the one, and above the other.
    Between {
        /// p - b.
        above: NodeId,
        /// p + b.
        beyond: NodeId,
    },
    /// Where p leaves the rest between -b and b, on which it may stay through a whole region:
    /// both are positive outside, and neither is where p is exactly b or -b.
    Outside {
        /// p - b, or p.
        above: NodeId,
        /// -p - b, or -p.
        below: NodeId,
    },
}

impl Surfaces {
    /// The nodes.
    pub fn all(self) -> impl Iterator<Item = NodeId> {
        let (first, second) = match self {
            Self::None => (None, None),
            Self::One(surface) | Self::Turned(surface) => (Some(surface), None),
            Self::Between { above, beyond } => (Some(above), Some(beyond)),
            Self::Outside { above, below } => (Some(above), Some(below)),
        };
        first.into_iter().chain(second)
    }
}

/// Where a piecewise function switches. What jumps by a switching function that may vanish on a
/// whole region has a surface for either side of it, as it has a value of its own there.
pub(crate) fn surfaces(graph: &mut Graph, function: Function, arguments: &[NodeId]) -> Surfaces {
    match (function, arguments) {
        (Function::Contact, &[p, b]) if may_rest(graph, p) => {
            let beyond = graph.add(p, b);
            Surfaces::Outside {
                above: graph.subtract(p, b),
                below: graph.negate(beyond),
            }
        }
        (Function::Sign, &[p]) if may_rest(graph, p) => Surfaces::Outside {
            above: p,
            below: graph.negate(p),
        },
        (Function::Deadzone | Function::Contact, &[p, b]) => Surfaces::Between {
            above: graph.subtract(p, b),
            beyond: graph.add(p, b),
        },
        (Function::Min | Function::Max, &[a, b]) => Surfaces::One(graph.subtract(a, b)),
        (Function::Above, &[p]) if begins_with_minus(graph, p) && !may_rest(graph, p) => {
            Surfaces::Turned(graph.negate(p))
        }
        (Function::Abs | Function::Sign | Function::Above, &[p]) => Surfaces::One(p),
        _ => Surfaces::None,
    }
}

/// Whether the first of a sum's terms that move is subtracted: the surface is then that of what
/// others, such as min(p, 0), are written with.
fn begins_with_minus(graph: &Graph, id: NodeId) -> bool {
    let Operation::Sum(terms) = graph.operation(id) else {
        return false;
    };
    let mut moving = terms
        .iter()
        .filter(|(_, term)| !graph.dependence(*term).is_parameter_only());
    moving
        .next()
        .is_some_and(|(factor, _)| factor.value() < 0.0)
}

/// Whether a switching function may have one value on a whole region: it holds a piecewise
/// function itself, or is of inputs alone, which may be held.
pub(crate) fn may_rest(graph: &Graph, id: NodeId) -> bool {
    let moves = Dependence::COORDINATE
        .join(Dependence::RATE)
        .join(Dependence::STATE)
        .join(Dependence::TIME);
    if !graph.dependence(id).has(moves) {
        return true;
    }
    graph.reachable(&[id]).into_iter().any(|part| {
        let switches = match graph.operation(part) {
            Operation::Select { .. } => graph.guarded_power(part).is_none(),
            Operation::Call(function, _) => function.switches(),
            _ => false,
        };
        switches && !graph.dependence(part).is_parameter_only()
    })
}
