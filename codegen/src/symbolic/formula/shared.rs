//! Which shared nodes get lines of their own. A graph of n nodes can stand for a tree of 2^n:
//! written out, the equations of a chain of twenty pendulums fill gigabytes. With every shared
//! node that is longer than a name in a line of its own, what is written is no longer than the
//! graph. Short reports are left in one piece; longer ones are cut as little as is needed.

use std::collections::{BTreeSet, HashMap, HashSet};

use eomgen_model_spec::model::Model;

use crate::symbolic::graph::{Graph, NodeId, Operation};

/// Up to this many characters in all formulas nothing is cut.
const WRITTEN_OUT: u64 = 16_000;

/// What is longer is cut as much as [`LENGTHS`] allow to be no longer than this.
const CUT: u64 = 24_000;

/// Shared nodes longer than one of these get lines; tried in turn.
const LENGTHS: [u64; 4] = [320, 160, 80, 40];

/// How long a name in a line of its own is, about.
const NAME: u64 = 5;

/// Letters for the names, the first that no quantity of the model has with a number.
const STEMS: [&str; 4] = ["s", "z", "y", "h"];

/// The shared nodes with lines of their own.
#[derive(Clone, Debug, Default)]
pub struct Shared {
    /// In the order of the graph: a line needs none but those before it.
    nodes: Vec<NodeId>,
    names: HashMap<NodeId, String>,
}

impl Shared {
    /// Chooses among what the formulas of `roots` share. A root that the graph names is
    /// written out where it stands, and by its name everywhere else.
    pub fn among(graph: &Graph, model: &Model, roots: &[NodeId]) -> Self {
        let uses = uses(graph, roots);
        let lengths = Lengths { graph, uses: &uses };
        let mut nodes = Vec::new();
        if lengths.total(roots, u64::MAX).0 > WRITTEN_OUT {
            for longest in LENGTHS {
                let (total, chosen) = lengths.total(roots, longest);
                nodes = chosen;
                if total <= CUT {
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

    /// The nodes in an order in which each needs none but those before it.
    pub fn nodes(&self) -> &[NodeId] {
        &self.nodes
    }

    /// The name of a node that has a line.
    pub fn name(&self, id: NodeId) -> Option<&str> {
        self.names.get(&id).map(String::as_str)
    }
}

/// How long nodes are, written out.
struct Lengths<'a> {
    graph: &'a Graph,
    uses: &'a HashMap<NodeId, usize>,
}

impl Lengths<'_> {
    /// The length of all formulas if shared nodes longer than this have lines of their own,
    /// and these nodes.
    fn total(&self, roots: &[NodeId], longest: u64) -> (u64, Vec<NodeId>) {
        let mut ids: Vec<NodeId> = self.uses.keys().copied().collect();
        ids.sort_unstable();
        let mut written = HashMap::with_capacity(ids.len());
        let mut chosen = Vec::new();
        let mut total = 0_u64;
        for id in ids {
            let length = own_length(self.graph, id, &written);
            let is_shared = self.uses.get(&id).is_some_and(|uses| *uses > 1);
            if is_shared && length > longest {
                total = total.saturating_add(length);
                chosen.push(id);
                written.insert(id, NAME);
            } else {
                written.insert(id, length);
            }
        }
        for &root in roots {
            let length = match written.get(&root) {
                Some(known) => *known,
                None => own_length(self.graph, root, &written),
            };
            total = total.saturating_add(length);
        }
        (total, chosen)
    }
}

/// How often each node without a name is written, if what is shared were written once.
fn uses(graph: &Graph, roots: &[NodeId]) -> HashMap<NodeId, usize> {
    let mut uses: HashMap<NodeId, usize> = HashMap::new();
    let mut waiting: BTreeSet<NodeId> = roots.iter().copied().collect();
    let is_written = |id: NodeId| graph.name(id).is_none() && !is_leaf(graph, id);
    for &root in roots {
        if is_written(root) {
            *uses.entry(root).or_insert(0) += 1;
        }
    }
    // Operands stand before what is computed from them.
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

/// How many characters a node takes, about; `written` holds those of its operands that have
/// no name.
pub(super) fn own_length(graph: &Graph, id: NodeId, written: &HashMap<NodeId, u64>) -> u64 {
    let part = |id: &NodeId| match (written.get(id), graph.name(*id)) {
        (Some(known), _) => *known,
        (None, Some(name)) => name.len() as u64,
        (None, None) => leaf_length(graph, *id),
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

fn leaf_length(graph: &Graph, id: NodeId) -> u64 {
    match graph.operation(id) {
        Operation::Constant(_) => 2,
        Operation::Table(_) => 14,
        Operation::Rate(_) | Operation::ModeRates(_) => 10,
        _ => 5,
    }
}

/// The letter of the names, or a word if all letters are taken.
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
