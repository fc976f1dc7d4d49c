//! Motion held on switching surfaces, for example by sticking friction: equations with the sides of such surfaces as
//! inputs.
//!
//! The rates jump across a surface g = 0. If a convex combination of the rates on both sides makes g' zero, the
//! motion continues with this combination (A. F. Filippov, *Differential Equations with Discontinuous Righthand
//! Sides*). Then sign(g), which is -1 or 1 away from the surface, has a value between -1 and 1. All forces, the power
//! and the observables follow from the side, a number from 0 to 1. A surface can hold the motion if g' depends on its
//! side. This is possible if g is a velocity, but not if g is a position. The simulator determines which surfaces
//! hold the motion, and when they release it.
//!
//! The unit vector v/norm(v) of a velocity is set-valued at v = 0 as well; see the module `discs`. The side of each
//! component is the component of the unit vector itself, from -1 to 1, because a number from 0 to 1 would round a
//! small component. Its switching function is the component of v.
//!
//! The sides of all other surfaces are inputs, too. With constant sides, the rates are smooth across the surfaces.
//! Therefore a step may cross a surface before the crossing is located. Continuous functions of a surface that can
//! hold the motion are not replaced, because rounding moves a held state to either side of the surface.

use std::cell::RefCell;
use std::collections::{HashMap, HashSet};

use eomgen_model_spec::ids::InputId;
use eomgen_model_spec::model::Function;

use crate::mechanics::discs::{divides_by_speed, find_discs};
use crate::mechanics::equations::Equations;
use crate::mechanics::forces::{can_be_constant, depends_on_motion, jumps_with_time};
use crate::mechanics::function_rates::{Column, derive_along, derive_guard_rate};
use crate::mechanics::guard::Guard;
use crate::mechanics::outputs::{Side, SlidingSurface};
use crate::mechanics::rows::RowNodes;
use crate::mechanics::sides::Sides;
use crate::symbolic::differentiate::derive_by_scalar;
use crate::symbolic::graph::{Argument, Dependence, Graph, NodeId, Operation, Shape, Variable};
use crate::symbolic::substitute::substitute;

/// Returns true if the model may have surfaces that hold the motion. The test needs no derivatives and can return
/// true for a model without such surfaces.
pub(crate) fn can_hold_motion(equations: &Equations) -> bool {
    !find_holding_guards(equations).is_empty()
        || divides_by_speed(&equations.graph, &equations.rate_nodes())
}

/// Surfaces whose sides are inputs.
#[derive(Default)]
pub(crate) struct SideInputs {
    /// Surfaces that cannot hold the motion; their sides come first.
    pub others: Vec<Side>,
    /// Surfaces that can hold the motion.
    pub sliding: Vec<SlidingSurface<NodeId, RowNodes>>,
}

/// Adds the sides of surfaces as inputs after the inputs of the model: first the surfaces that cannot hold the
/// motion, then those that can. If `may_hold` is false, all surfaces count as unable to hold the motion. If it is
/// true and no surface can hold the motion, returns `None`; the equations are then unusable.
pub(crate) fn add_side_inputs(equations: &mut Equations, may_hold: bool) -> Option<SideInputs> {
    let mut sliding = match may_hold {
        true => find_holding_guards(equations),
        false => Vec::new(),
    };
    if !sliding.is_empty() {
        let jumping = find_jumping_guards(equations);
        sliding.retain(|(guard, _)| jumping.contains(guard));
    }
    let all = find_scalar_guards(equations);
    let is_sliding = |guard: usize| sliding.iter().any(|(own, _)| *own == guard);
    let others: Vec<(usize, usize)> = (all.into_iter())
        .filter(|(guard, _)| !is_sliding(*guard))
        .collect();
    let first = equations.inputs + others.len();
    let leaf = |side: usize| Operation::Input(InputId::new(side));
    let roots = collect_roots(equations);
    let place =
        |list: &[(usize, usize)], guard: usize| list.iter().position(|(own, _)| *own == guard);
    let inputs = equations.inputs;
    let given = (&mut equations.graph, &equations.guards[..]);
    let mut known = Sides::replace(given, &roots, &|guard, jumps| match (
        place(&sliding, guard),
        place(&others, guard),
    ) {
        (Some(side), _) => jumps.then(|| leaf(first + side)),
        (None, Some(side)) => Some(leaf(inputs + side)),
        (None, None) => None,
    })
    .known;
    replace_sides(equations, &mut known);
    let is_odd = |function: Function| matches!(function, Function::Sign | Function::Abs);
    let others = others.into_iter().map(|(guard, place)| Side {
        guard: place,
        is_odd: is_odd(equations.guards[guard].function),
    });
    let others: Vec<Side> = others.collect();
    if !may_hold {
        return Some(SideInputs {
            others,
            sliding: Vec::new(),
        });
    }
    let mut functions: Vec<SideFunction> = sliding
        .iter()
        .map(|(guard, place)| SideFunction {
            value: equations.guards[*guard].value,
            place: *place,
            is_odd: is_odd(equations.guards[*guard].function),
            disc: None,
        })
        .collect();
    add_unit_vectors(equations, first, &mut functions);
    let leaves: Vec<NodeId> = (0..functions.len())
        .map(|side| equations.graph.intern(leaf(first + side)))
        .collect();
    let rates: Vec<NodeId> = functions
        .iter()
        .map(|function| {
            // Piecewise functions of time also use their sides.
            let graph = &mut equations.graph;
            let value = substitute(graph, function.value, &|_, _| None, &mut known);
            derive_guard_rate(equations, value)
        })
        .collect();
    let graph = &mut equations.graph;
    let accelerations = &equations.accelerations.rows;
    let mut found = Vec::with_capacity(functions.len());
    for (side, function) in functions.iter().enumerate() {
        let own = leaves[side];
        let by = |graph: &mut Graph, nodes: &[NodeId]| -> Vec<NodeId> {
            nodes
                .iter()
                .map(|id| derive_by_scalar(graph, *id, own))
                .collect()
        };
        found.push(SlidingSurface {
            guard: function.place,
            disc: function.disc,
            is_odd: function.is_odd,
            is_linear: true,
            rate: rates[side],
            by_sides: leaves
                .iter()
                .map(|leaf| derive_by_scalar(graph, rates[side], *leaf))
                .collect(),
            column: RowNodes {
                scalars: by(graph, &accelerations.scalars),
                modal: by(graph, &accelerations.modal),
            },
            first_order: by(graph, &equations.state_rates),
        });
    }
    let feels = |(side, surface): (usize, &SlidingSurface<NodeId, RowNodes>)| {
        !graph.is_zero(surface.by_sides[side])
    };
    if !found.iter().enumerate().any(feels) {
        return None;
    }
    for surface in &mut found {
        let parts = graph.reachable(&surface.by_sides);
        surface.is_linear = !parts.iter().any(|part| leaves.contains(part));
    }
    Some(SideInputs {
        others,
        sliding: found,
    })
}

/// Rates with the sides of frictions as an argument.
pub(crate) struct RatesWithSides {
    pub accelerations: RowNodes,
    pub first_order_rates: Vec<NodeId>,
    /// Switching function of each friction.
    pub functions: Vec<NodeId>,
    /// Change of the rates per unit of the sign of each friction.
    pub columns: Vec<Column>,
}

/// Returns the rates with the sides of all frictions that can stick as an argument.
pub(crate) fn derive_friction_rates(equations: &mut Equations) -> RatesWithSides {
    let jumping = find_jumping_guards(equations);
    let candidates = find_holding_guards(equations).into_iter();
    let mut guards: Vec<usize> = (candidates.map(|(guard, _)| guard))
        .filter(|guard| jumping.contains(guard))
        .collect();
    loop {
        let held = rates_with_sides(equations, &guards);
        let graph = &mut equations.graph;
        let own = held.functions.iter().zip(&held.columns);
        let effects: Vec<NodeId> = own
            .map(|(function, column)| derive_along(graph, *function, column))
            .collect();
        if effects.iter().all(|effect| !graph.is_zero(*effect)) {
            return held;
        }
        let mut effects = effects.into_iter();
        guards.retain(|_| effects.next().is_some_and(|effect| !graph.is_zero(effect)));
    }
}

fn rates_with_sides(equations: &mut Equations, guards: &[usize]) -> RatesWithSides {
    let leaf =
        |side: usize| Operation::Argument(Argument::Sides, Variable::Input(InputId::new(side)));
    let roots = equations.rate_nodes();
    let given = (&mut equations.graph, &equations.guards[..]);
    let mut known = Sides::replace_jumps(given, &roots, &|guard| {
        guards.iter().position(|own| *own == guard).map(leaf)
    })
    .known;
    let graph = &mut equations.graph;
    let mut with_sides = |graph: &mut Graph, nodes: &[NodeId]| -> Vec<NodeId> {
        let replaced = nodes.iter();
        replaced
            .map(|node| substitute(graph, *node, &|_, _| None, &mut known))
            .collect()
    };
    let rows = &equations.accelerations.rows;
    let accelerations = RowNodes {
        scalars: with_sides(graph, &rows.scalars),
        modal: with_sides(graph, &rows.modal),
    };
    let first_order_rates = with_sides(graph, &equations.state_rates);
    // The sign is 2 side - 1, so a derivative by the sign is half the derivative by the side.
    let by_sign = |graph: &mut Graph, side: usize, nodes: &[NodeId]| -> Vec<NodeId> {
        let own = graph.intern(leaf(side));
        let derivatives = nodes.iter();
        derivatives
            .map(|node| {
                let by_side = derive_by_scalar(graph, *node, own);
                graph.combine(&[(0.5, by_side)])
            })
            .collect()
    };
    let columns = (0..guards.len()).map(|side| {
        let rates = RowNodes {
            scalars: by_sign(graph, side, &accelerations.scalars),
            modal: by_sign(graph, side, &accelerations.modal),
        };
        (rates, by_sign(graph, side, &first_order_rates))
    });
    RatesWithSides {
        columns: columns.collect(),
        functions: guards
            .iter()
            .map(|guard| equations.guards[*guard].value)
            .collect(),
        accelerations,
        first_order_rates,
    }
}

/// Switching function whose side is an input.
struct SideFunction {
    value: NodeId,
    /// Index among all guard values.
    place: usize,
    is_odd: bool,
    /// Index of the disc, if the function is one of its components.
    disc: Option<usize>,
}

/// Replaces unit vectors of velocities by inputs after those of `functions`, and adds the components of the
/// velocities to `functions` and to the guards.
fn add_unit_vectors(
    equations: &mut Equations,
    first_side: usize,
    functions: &mut Vec<SideFunction>,
) {
    let lengths = equations.guards.iter().map(|guard| {
        let graph = &equations.graph;
        graph.length(graph.shape(guard.value))
    });
    let mut place = lengths.sum();
    let mut count = 0;
    let rates = equations.rate_nodes();
    let inputs = equations.inputs;
    for disc in find_discs(&mut equations.graph, &rates) {
        let first = first_side + functions.len();
        let graph = &mut equations.graph;
        // Guards are evaluated without sides; therefore components that contain sides are left out.
        let is_side = |part: NodeId| matches!(graph.operation(part), Operation::Input(id) if id.index() >= inputs);
        if graph.reachable(&disc.components).into_iter().any(is_side) {
            continue;
        }
        let unit: Vec<NodeId> = (0..disc.components.len())
            .map(|component| graph.intern(Operation::Input(InputId::new(first + component))))
            .collect();
        let nodes = (&equations.rate_nodes()[..], &collect_roots(equations)[..]);
        let mut known = HashMap::new();
        if !disc.replace_unit_vector(&mut equations.graph, nodes, &unit, &mut known) {
            continue;
        }
        replace_sides(equations, &mut known);
        for value in disc.components {
            equations.guards.push(Guard {
                value,
                function: Function::Sign,
            });
            functions.push(SideFunction {
                value,
                place,
                is_odd: true,
                disc: Some(count),
            });
            place += 1;
        }
        count += 1;
    }
}

/// Returns the guards that depend on rates or on first-order states, each with its index among all guard values.
fn find_holding_guards(equations: &Equations) -> Vec<(usize, usize)> {
    let graph = &equations.graph;
    let moves = Dependence::RATE.join(Dependence::STATE);
    let mut found = find_scalar_guards(equations);
    found.retain(|(index, _)| {
        let guard = &equations.guards[*index];
        let is_single = matches!(
            guard.function,
            Function::Sign | Function::Abs | Function::Above | Function::Max | Function::Min
        );
        is_single
            && graph.dependence(guard.value).has(moves)
            && !can_be_constant(graph, guard.value)
            && !jumps_with_time(graph, guard.value)
    });
    found
}

/// Returns the scalar guards that depend on the motion, each with its index among all guard values.
fn find_scalar_guards(equations: &Equations) -> Vec<(usize, usize)> {
    let graph = &equations.graph;
    let mut found = Vec::new();
    let mut place = 0;
    for (index, guard) in equations.guards.iter().enumerate() {
        match graph.shape(guard.value) {
            Shape::Vector(space) => place += graph.size(space),
            _ => {
                if depends_on_motion(graph, guard.value) {
                    found.push((index, place));
                }
                place += 1;
            }
        }
    }
    found
}

/// Returns the guards at which a function jumps.
fn find_jumping_guards(equations: &mut Equations) -> HashSet<usize> {
    let found = RefCell::new(HashSet::new());
    let roots = collect_roots(equations);
    let first = InputId::new(equations.inputs);
    let given = (&mut equations.graph, &equations.guards[..]);
    Sides::replace(given, &roots, &|guard, jumps| {
        if jumps {
            found.borrow_mut().insert(guard);
        }
        Some(Operation::Input(first))
    });
    found.into_inner()
}

/// Returns the nodes that are evaluated with sides.
fn collect_roots(equations: &Equations) -> Vec<NodeId> {
    let mut roots = equations.rate_nodes();
    roots.extend(equations.forces.nodes());
    roots.extend(&equations.observables);
    roots.push(equations.power);
    let impacts = equations.impacts.iter();
    roots.extend(impacts.flat_map(|impact| {
        let friction = impact.friction.iter().map(|friction| friction.acceleration);
        std::iter::once(impact.acceleration).chain(friction)
    }));
    roots
}

/// Inserts the sides into all nodes of [`roots`].
fn replace_sides(equations: &mut Equations, known: &mut HashMap<NodeId, NodeId>) {
    let graph = &mut equations.graph;
    let rows = &mut equations.accelerations.rows;
    let nodes = rows.scalars.iter_mut().chain(&mut rows.modal);
    let forces = &mut equations.forces;
    let nodes = nodes.chain(forces.scalars.iter_mut().chain(&mut forces.modal));
    let nodes = nodes.chain(&mut equations.state_rates);
    let nodes = nodes.chain(&mut equations.observables);
    let accelerations = equations.impacts.iter_mut().flat_map(|impact| {
        let friction = impact.friction.iter_mut();
        let along = friction.map(|friction| &mut friction.acceleration);
        std::iter::once(&mut impact.acceleration).chain(along)
    });
    let nodes = nodes.chain(accelerations);
    for node in nodes.chain(std::iter::once(&mut equations.power)) {
        *node = substitute(graph, *node, &|_, _| None, known);
    }
}
