//! Selection of the shared nodes that get separate lines. A graph of n nodes can represent a tree of 2^n nodes;
//! written without sharing, the equations of a chain of twenty pendulums fill gigabytes. If every long shared node
//! has its own line, the length of the text is proportional to the graph. Short reports are not split; longer reports
//! are split only as far as necessary.

use std::collections::{BTreeSet, HashMap, HashSet};

use eomgen_model_spec::model::Model;

use crate::symbolic::graph::{Graph, NodeId, Operation};

/// Largest total length in characters of formulas that are not split.
const MAX_UNSPLIT_LENGTH: u64 = 16_000;

/// Target length in characters of split formulas, as far as [`LENGTHS`] permit.
const SPLIT_TARGET_LENGTH: u64 = 24_000;

/// Lengths in characters above which shared nodes get lines; they are tried in this order.
const LENGTHS: [u64; 4] = [320, 160, 80, 40];

/// Approximate length in characters of the name of a line.
const NAME_LENGTH: u64 = 5;

/// Stems of the line names. The first stem that no numbered quantity of the model uses is taken.
const STEMS: [&str; 4] = ["s", "z", "y", "h"];

/// Shared nodes with separate lines.
#[derive(Clone, Debug, Default)]
pub struct SharedExpressions {
    /// Nodes in the order of the graph; each line uses only earlier lines.
    nodes: Vec<NodeId>,
    names: HashMap<NodeId, String>,
}

impl SharedExpressions {
    /// Selects shared nodes in the formulas of `roots`. The formula of a named root is written in full; elsewhere the
    /// root is printed as its name.
    pub fn find_shared(graph: &Graph, model: &Model, roots: &[NodeId]) -> Self {
        let uses = uses(graph, roots);
        let lengths = Lengths { graph, uses: &uses };
        let mut nodes = Vec::new();
        if lengths.total(roots, u64::MAX).0 > MAX_UNSPLIT_LENGTH {
            for longest in LENGTHS {
                let (total, chosen) = lengths.total(roots, longest);
                nodes = chosen;
                if total <= SPLIT_TARGET_LENGTH {
                    break;
                }
            }
        }
        let stem = stem(graph, model);
        let numbered = nodes.iter().zip(1..);
        let names = numbered.map(|(id, number)| (*id, format!("{stem}_{number}")));
        Self {
            names: names.collect(),
            nodes,
        }
    }

    /// Returns the nodes; the formula of each node uses only earlier nodes.
    pub fn nodes(&self) -> &[NodeId] {
        &self.nodes
    }

    /// Returns the name of a shared node; `None` for other nodes.
    pub fn name(&self, id: NodeId) -> Option<&str> {
        self.names.get(&id).map(String::as_str)
    }
}

struct Lengths<'a> {
    graph: &'a Graph,
    uses: &'a HashMap<NodeId, usize>,
}

impl Lengths<'_> {
    /// Returns the total length in characters if all shared nodes longer than `longest` get lines, and these nodes.
    fn total(&self, roots: &[NodeId], longest: u64) -> (u64, Vec<NodeId>) {
        let mut ids: Vec<NodeId> = self.uses.keys().copied().collect();
        ids.sort_unstable();
        let mut written = HashMap::with_capacity(ids.len());
        let mut chosen = Vec::new();
        let mut total = 0_u64;
        for id in ids {
            let length = estimate_length(self.graph, id, &written);
            let is_shared = self.uses.get(&id).is_some_and(|uses| *uses > 1);
            if is_shared && length > longest {
                total = total.saturating_add(length);
                chosen.push(id);
                written.insert(id, NAME_LENGTH);
            } else {
                written.insert(id, length);
            }
        }
        for &root in roots {
            let length = match written.get(&root) {
                Some(known) => *known,
                None => estimate_length(self.graph, root, &written),
            };
            total = total.saturating_add(length);
        }
        (total, chosen)
    }
}

/// Counts the uses of each unnamed node, with shared nodes written once.
fn uses(graph: &Graph, roots: &[NodeId]) -> HashMap<NodeId, usize> {
    let mut uses: HashMap<NodeId, usize> = HashMap::new();
    let mut waiting: BTreeSet<NodeId> = roots.iter().copied().collect();
    let is_written = |id: NodeId| graph.name(id).is_none() && !is_leaf(graph, id);
    for &root in roots {
        if is_written(root) {
            *uses.entry(root).or_insert(0) += 1;
        }
    }
    // Operands have smaller indices than their uses.
    while let Some(id) = waiting.pop_last() {
        for operand in graph.operands(graph.operation(id)) {
            if is_written(operand) {
                *uses.entry(operand).or_insert(0) += 1;
                waiting.insert(operand);
            }
        }
    }
    uses
}

pub(super) fn is_leaf(graph: &Graph, id: NodeId) -> bool {
    graph.operands(graph.operation(id)).is_empty()
}

/// Returns the approximate length of a node's formula in characters; `written` has the lengths of its unnamed
/// operands.
pub(super) fn estimate_length(graph: &Graph, id: NodeId, written: &HashMap<NodeId, u64>) -> u64 {
    let part = |id: &NodeId| match (written.get(id), graph.name(*id)) {
        (Some(known), _) => *known,
        (None, Some(name)) => name.len() as u64,
        (None, None) => estimate_leaf_length(graph, *id),
    };
    let parts = |ids: &mut dyn Iterator<Item = &NodeId>, around: u64| {
        ids.fold(around, |sum, id| sum.saturating_add(part(id)))
    };
    match graph.operation(id) {
        Operation::Sum(terms) => terms.iter().fold(0, |sum: u64, (factor, id)| {
            let number = if factor.value().abs() == 1.0 { 3 } else { 5 };
            sum.saturating_add(part(id).saturating_add(number))
        }),
        Operation::Product(factors) => factors.iter().fold(0, |sum: u64, (id, exponent)| {
            let power = if exponent.abs() == 1 { 1 } else { 3 };
            sum.saturating_add(part(id).saturating_add(power))
        }),
        operation => {
            let operands = graph.operands(operation);
            let around = 6 + 2 * operands.len() as u64;
            parts(&mut operands.iter(), around)
        }
    }
}

fn estimate_leaf_length(graph: &Graph, id: NodeId) -> u64 {
    match graph.operation(id) {
        Operation::Constant(_) => 2,
        Operation::Table(_) => 14,
        Operation::Rate(_) | Operation::ModeRates(_) => 10,
        _ => 5,
    }
}

/// Returns a letter for the names, or a word if all letters are taken.
fn stem(graph: &Graph, model: &Model) -> String {
    let terms = [&model.kinetic, &model.potential, &model.dissipation];
    let own: HashSet<&str> = graph
        .taken_names()
        .chain(terms.into_iter().flatten().map(|term| term.name.as_str()))
        .chain(model.forces.iter().map(|force| force.name.as_str()))
        .collect();
    let has_number = |name: &str, stem: &str| {
        let number = name.strip_prefix(stem).and_then(|n| n.strip_prefix('_'));
        number.is_some_and(|n| !n.is_empty() && n.bytes().all(|b| b.is_ascii_digit()))
    };
    let letters = STEMS.into_iter().map(str::to_owned);
    let mut stems = letters.chain((1..).map(|number| format!("shared{number}")));
    let is_free = |stem: &String| own.iter().all(|name| !has_number(name, stem));
    stems.find(is_free).unwrap_or_default()
}
