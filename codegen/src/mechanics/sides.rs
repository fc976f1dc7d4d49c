//! Piecewise functions as polynomials in the sides of their surfaces. A side is 1 if the switching function is
//! positive, else 0; it is between 0 and 1 while the motion is held on the surface.

use std::collections::HashMap;

use eomgen_model_spec::model::Function;

use crate::mechanics::forces::{Surfaces, find_surfaces};
use crate::mechanics::guard::Guard;
use crate::symbolic::graph::{Graph, NodeId, Operation};
use crate::symbolic::substitute::substitute;

/// Replacements of the piecewise functions of a model.
pub(crate) struct Sides {
    /// Replacement of each node.
    pub known: HashMap<NodeId, NodeId>,
    /// Half-widths of dead zones, which must not be negative.
    pub half_widths: Vec<NodeId>,
}

impl Sides {
    /// Replaces the piecewise functions in `roots` by polynomials in sides. `side` returns the leaf of a guard's side
    /// for the index of the guard, if it has one.
    pub fn replace_all(
        given: (&mut Graph, &[Guard]),
        roots: &[NodeId],
        side: &dyn Fn(usize) -> Option<Operation>,
    ) -> Self {
        Self::replace(given, roots, &|guard, _| side(guard))
    }

    /// Replaces only functions that jump. Continuous functions have the same value on both sides of their surface.
    /// Away from the surface, a wrong side could move the argument of another function out of its domain, for example
    /// in `sqrt(abs(p))`.
    pub fn replace_jumps(
        given: (&mut Graph, &[Guard]),
        roots: &[NodeId],
        side: &dyn Fn(usize) -> Option<Operation>,
    ) -> Self {
        Self::replace(given, roots, &|guard, jumps| side(guard).filter(|_| jumps))
    }

    /// Replaces the functions for which `side` returns a leaf. The arguments of `side` are the index of the guard,
    /// and true if the function jumps there.
    pub fn replace(
        (graph, guards): (&mut Graph, &[Guard]),
        roots: &[NodeId],
        side: &dyn Fn(usize, bool) -> Option<Operation>,
    ) -> Self {
        let values: Vec<NodeId> = guards.iter().map(|guard| guard.value).collect();
        let mut sides = Self {
            known: HashMap::new(),
            half_widths: Vec::new(),
        };
        // Operands precede their uses, so inner piecewise functions are already replaced.
        for id in graph.reachable(roots) {
            if graph.dependence(id).is_parameter_only() {
                continue;
            }
            let jumps = match graph.operation(id) {
                Operation::Call(function, _) => function.has_jump(),
                _ => true,
            };
            let parameter = |graph: &mut Graph, surface: NodeId| {
                let index = values.iter().position(|value| *value == surface)?;
                side(index, jumps).map(|leaf| graph.intern(leaf))
            };
            if let Some(replacement) = sides.replacement(graph, id, &parameter) {
                sides.known.insert(id, replacement);
            }
        }
        sides
    }

    fn replacement(
        &mut self,
        graph: &mut Graph,
        id: NodeId,
        parameter: &dyn Fn(&mut Graph, NodeId) -> Option<NodeId>,
    ) -> Option<NodeId> {
        match graph.operation(id).clone() {
            Operation::Call(function, arguments) => {
                self.call(graph, function, &arguments, parameter)
            }
            Operation::Select {
                a,
                b,
                then,
                otherwise,
                is_switch: true,
            } => {
                let difference = graph.subtract(a, b);
                let side = match parameter(graph, difference) {
                    Some(side) => side,
                    None => {
                        let turned = graph.subtract(b, a);
                        let side = parameter(graph, turned)?;
                        build_opposite_side(graph, side)
                    }
                };
                let (then, otherwise) = (
                    self.replace_in(graph, then),
                    self.replace_in(graph, otherwise),
                );
                Some(blend_sides(graph, side, then, otherwise))
            }
            _ => None,
        }
    }

    fn call(
        &mut self,
        graph: &mut Graph,
        function: Function,
        arguments: &[NodeId],
        parameter: &dyn Fn(&mut Graph, NodeId) -> Option<NodeId>,
    ) -> Option<NodeId> {
        let surfaces = find_surfaces(graph, function, arguments);
        let sides = surfaces
            .all()
            .map(|surface| parameter(graph, surface))
            .collect::<Option<Vec<NodeId>>>()?;
        let inner: Vec<NodeId> = arguments
            .iter()
            .map(|a| self.replace_in(graph, *a))
            .collect();
        if let (Function::Contact, &[_, b]) = (function, inner.as_slice()) {
            self.half_widths.push(b);
        }
        if let (Surfaces::OuterSides { .. }, &[above, below]) = (surfaces, sides.as_slice()) {
            return match function {
                Function::Contact => Some(graph.add(above, below)),
                Function::Sign => Some(graph.subtract(above, below)),
                _ => None,
            };
        }
        if let (Surfaces::Negated(_), &[side]) = (surfaces, sides.as_slice()) {
            return Some(build_opposite_side(graph, side));
        }
        Some(match (function, sides.as_slice(), inner.as_slice()) {
            (Function::Deadzone, &[above, beyond], &[p, b]) => {
                self.half_widths.push(b);
                let (upper, lower) = (graph.subtract(p, b), graph.add(p, b));
                let below = build_opposite_side(graph, beyond);
                let (upper, lower) = (graph.multiply(above, upper), graph.multiply(below, lower));
                graph.add(upper, lower)
            }
            (Function::Contact, &[above, beyond], _) => {
                let below = build_opposite_side(graph, beyond);
                graph.add(above, below)
            }
            (Function::Sign, &[side], _) => sign(graph, side),
            (Function::Above, &[side], _) => side,
            (Function::Abs, &[side], &[p]) => {
                let sign = sign(graph, side);
                graph.multiply(sign, p)
            }
            (Function::Max, &[side], &[a, b]) => blend_sides(graph, side, a, b),
            (Function::Min, &[side], &[a, b]) => blend_sides(graph, side, b, a),
            _ => return None,
        })
    }

    fn replace_in(&mut self, graph: &mut Graph, id: NodeId) -> NodeId {
        substitute(graph, id, &|_, _| None, &mut self.known)
    }
}

fn build_opposite_side(graph: &mut Graph, side: NodeId) -> NodeId {
    let one = graph.one();
    graph.subtract(one, side)
}

/// Returns the sign 2 side - 1.
fn sign(graph: &mut Graph, side: NodeId) -> NodeId {
    let one = graph.one();
    graph.combine(&[(2.0, side), (-1.0, one)])
}

/// Returns side * a + (1 - side) * b, which is exactly a or b if the side is 1 or 0.
fn blend_sides(graph: &mut Graph, side: NodeId, a: NodeId, b: NodeId) -> NodeId {
    let other = build_opposite_side(graph, side);
    let (a, b) = (graph.multiply(side, a), graph.multiply(other, b));
    graph.add(a, b)
}
