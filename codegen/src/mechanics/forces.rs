//! Forces from the dissipation and by virtual work, their power, and the switching surfaces of the model.

use eomgen_model_spec::model::{Force, Function};

use crate::mechanics::guard::Guard;
use crate::mechanics::lagrange::{GradientBy, Variables};
use crate::mechanics::rows::RowNodes;
use crate::mechanics::solve::Accelerations;
use crate::mechanics::translate::{DeriveError, Derived, Translator, along_motion, explicit_rate};
use crate::symbolic::differentiate::Direction;
use crate::symbolic::graph::{Dependence, Graph, NodeId, Operation};

/// Derives -dR/dq' and the forces by virtual work, Q_j = value d(on)/dq_j.
pub(crate) fn derive_applied_forces(
    translator: &mut Translator,
    variables: &Variables,
    dissipation: NodeId,
    named: &mut Vec<NodeId>,
) -> Derived<RowNodes> {
    let drag = variables.gradient(&mut translator.graph, dissipation, GradientBy::Rates);
    let mut rows: Vec<(f64, RowNodes)> = vec![(-1.0, drag)];
    for force in &translator.model.forces {
        let (value, on) = translate_force(translator, force)?;
        named.push(value);
        let mut gradient = variables.gradient(&mut translator.graph, on, GradientBy::Coordinates);
        for node in gradient.scalars.iter_mut().chain(&mut gradient.modal) {
            *node = translator.graph.multiply(*node, value);
        }
        rows.push((1.0, gradient));
    }
    Ok(variables.combine(&mut translator.graph, &rows))
}

/// Returns the value of a force and the expression that it acts on.
///
/// # Errors
/// A failed derivation, and an expression that contains a rate.
pub(crate) fn translate_force(
    translator: &mut Translator,
    force: &Force,
) -> Derived<(NodeId, NodeId)> {
    let value = translator.node(&force.value)?;
    // The name of a force can be reserved in formulas.
    if eomgen_model_spec::reservation_reason(&force.name).is_none() {
        translator.graph.suggest_name(value, &force.name);
    }
    let on = translator.node(&force.on)?;
    if translator.graph.dependence(on).has(Dependence::RATE) {
        return Err(DeriveError {
            span: force.on.span,
            message: "`on` of a force contains a rate".into(),
            help: Some("use a coordinate or an expression of coordinates for `on`".into()),
        });
    }
    Ok((value, on))
}

/// Returns d(T + V)/dt due to forces and explicit time dependence: Q q' + dV/dt - dT/dt with partial derivatives by
/// time. If T is not a quadratic form of the rates, d(2 T - p q')/dt is added.
pub(crate) fn derive_power(
    graph: &mut Graph,
    variables: &Variables,
    kinetic: NodeId,
    potential: NodeId,
    applied: &RowNodes,
    momenta: &RowNodes,
    accelerations: &Accelerations,
) -> NodeId {
    let work = variables.multiply_by_rates(graph, applied);
    let potential_rate = explicit_rate(graph, potential);
    let mut terms = vec![(1.0, work), (1.0, potential_rate)];
    let kinetic_rate = explicit_rate(graph, kinetic);
    if !crate::symbolic::degree::is_quadratic_in_rates(graph, kinetic) {
        let twice = variables.multiply_by_rates(graph, momenta);
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

/// Returns the distinct switching surfaces in the expressions of `roots`, in the order of the graph.
pub(crate) fn find_guards(graph: &mut Graph, roots: &[NodeId]) -> Vec<Guard> {
    let mut found: Vec<Guard> = Vec::new();
    for id in graph.reachable(roots) {
        if graph.dependence(id).is_parameter_only() || graph.guarded_power(id).is_some() {
            continue;
        }
        let (function, arguments) = match graph.operation(id).clone() {
            Operation::Call(function, arguments) => (function, arguments.to_vec()),
            // Derivatives of min and max are selections by a > b; for min, the switching function has the opposite
            // sign.
            Operation::Select {
                a,
                b,
                is_switch: true,
                ..
            } => {
                let turned = graph.subtract(b, a);
                if found.iter().any(|guard| guard.value == turned) {
                    continue;
                }
                (Function::Max, vec![a, b])
            }
            _ => continue,
        };
        for value in find_surfaces(graph, function, &arguments).all() {
            if found.iter().all(|guard| guard.value != value) {
                found.push(Guard { value, function });
            }
        }
    }
    found
}

/// Switching surfaces of a piecewise function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Surfaces {
    None,
    /// Surface p = 0; the switching function p is positive for p > 0.
    Single(NodeId),
    /// Surface p = 0; the switching function -p is positive for p < 0.
    Negated(NodeId),
    /// Surfaces p = b and p = -b; the switching functions p - b and p + b are positive above their surfaces.
    TwoSided {
        above: NodeId,
        beyond: NodeId,
    },
    /// Surfaces at the ends of the interval -b <= p <= b, in which p can stay for a whole regime. Each switching
    /// function is positive outside its end.
    OuterSides {
        above: NodeId,
        below: NodeId,
    },
}

impl Surfaces {
    pub fn all(self) -> impl Iterator<Item = NodeId> {
        let (first, second) = match self {
            Self::None => (None, None),
            Self::Single(surface) | Self::Negated(surface) => (Some(surface), None),
            Self::TwoSided { above, beyond } => (Some(above), Some(beyond)),
            Self::OuterSides { above, below } => (Some(above), Some(below)),
        };
        first.into_iter().chain(second)
    }
}

/// Returns the surfaces of a piecewise function. If a sign or contact can be zero for a whole regime, each end of the
/// interval -b <= p <= b (p = 0 for a sign) has its own surface, because the function has a third value there.
pub(crate) fn find_surfaces(
    graph: &mut Graph,
    function: Function,
    arguments: &[NodeId],
) -> Surfaces {
    match (function, arguments) {
        (Function::Contact, &[p, b]) if can_be_constant(graph, p) => {
            let beyond = graph.add(p, b);
            Surfaces::OuterSides {
                above: graph.subtract(p, b),
                below: graph.negate(beyond),
            }
        }
        (Function::Sign, &[p]) if can_be_constant(graph, p) => Surfaces::OuterSides {
            above: p,
            below: graph.negate(p),
        },
        (Function::Deadzone | Function::Contact, &[p, b]) => Surfaces::TwoSided {
            above: graph.subtract(p, b),
            beyond: graph.add(p, b),
        },
        (Function::Min | Function::Max, &[a, b]) => Surfaces::Single(graph.subtract(a, b)),
        (Function::Above, &[p]) if begins_with_minus(graph, p) && !can_be_constant(graph, p) => {
            Surfaces::Negated(graph.negate(p))
        }
        (Function::Abs | Function::Sign | Function::Above, &[p]) => Surfaces::Single(p),
        _ => Surfaces::None,
    }
}

/// Returns true if the first moving term of a sum is subtracted. Its surface is then shared with functions
/// such as min(p, 0).
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

/// Returns true if a node depends on the state or the time.
pub(crate) fn depends_on_motion(graph: &Graph, id: NodeId) -> bool {
    let moves = Dependence::COORDINATE
        .join(Dependence::RATE)
        .join(Dependence::STATE)
        .join(Dependence::TIME);
    graph.dependence(id).has(moves)
}

/// Returns true if a switching function can be constant throughout a regime: it contains a piecewise function, or it
/// depends only on inputs, which can be constant. If some terms depend on the state, continuous terms without the
/// state (such as a belt speed) are ignored.
pub(crate) fn can_be_constant(graph: &Graph, id: NodeId) -> bool {
    if !depends_on_motion(graph, id) {
        return true;
    }
    let (own, others) = split_by_state(graph, id);
    let others_jump =
        (others.iter()).any(|term| has_piecewise(graph, *term) && can_jump(graph, *term));
    match own.is_empty() || others_jump {
        true => has_piecewise(graph, id),
        false => own.iter().any(|term| has_piecewise(graph, *term)),
    }
}

/// Returns true if a term of a switching function jumps at a time that does not depend on the state.
pub(crate) fn jumps_with_time(graph: &Graph, id: NodeId) -> bool {
    let (_, others) = split_by_state(graph, id);
    (others.iter()).any(|term| has_discontinuity(graph, *term))
}

/// Returns true if a node contains a piecewise function that switches with the motion.
fn has_piecewise(graph: &Graph, id: NodeId) -> bool {
    graph.reachable(&[id]).into_iter().any(|part| {
        let switches = match graph.operation(part) {
            Operation::Select { is_switch, .. } => {
                *is_switch && graph.guarded_power(part).is_none()
            }
            Operation::Call(function, _) => function.has_switches(),
            _ => false,
        };
        switches && !graph.dependence(part).is_parameter_only()
    })
}

/// Returns true if a node contains a function that jumps, or a quotient or selection that can jump.
fn can_jump(graph: &Graph, id: NodeId) -> bool {
    let varies = |part: NodeId| !graph.dependence(part).is_parameter_only();
    has_discontinuity(graph, id)
        || graph
            .reachable(&[id])
            .into_iter()
            .any(|part| match graph.operation(part) {
                Operation::Product(factors) => {
                    (factors.iter()).any(|(factor, exponent)| *exponent < 0 && varies(*factor))
                }
                Operation::Select { .. } => varies(part),
                _ => false,
            })
}

/// Returns true if a node contains a function of the motion that jumps.
fn has_discontinuity(graph: &Graph, id: NodeId) -> bool {
    graph.reachable(&[id]).into_iter().any(|part| {
        let Operation::Call(function, _) = graph.operation(part) else {
            return false;
        };
        function.has_jump() && !graph.dependence(part).is_parameter_only()
    })
}

/// Splits nested sums into the terms that depend on the state and the other terms. Factors that depend only on
/// parameters are dropped.
fn split_by_state(graph: &Graph, id: NodeId) -> (Vec<NodeId>, Vec<NodeId>) {
    let state = Dependence::COORDINATE
        .join(Dependence::RATE)
        .join(Dependence::STATE);
    let (mut own, mut others) = (Vec::new(), Vec::new());
    let mut parts = vec![id];
    while let Some(part) = parts.pop() {
        match graph.operation(part) {
            Operation::Sum(terms) => parts.extend(terms.iter().map(|(_, term)| *term)),
            Operation::Product(factors) => {
                let mut varying = (factors.iter())
                    .filter(|(factor, _)| !graph.dependence(*factor).is_parameter_only());
                match (varying.next(), varying.next()) {
                    (Some((factor, 1)), None) => parts.push(*factor),
                    _ if graph.dependence(part).has(state) => own.push(part),
                    _ => others.push(part),
                }
            }
            _ if graph.dependence(part).has(state) => own.push(part),
            _ => others.push(part),
        }
    }
    (own, others)
}
