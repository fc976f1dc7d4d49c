//! Graph of the states of a function.

use std::collections::HashMap;
use std::rc::Rc;

use crate::listing::Place;
use crate::state::State;

/// States at the targets of jumps, with the instructions between them.
#[derive(Default)]
pub struct Graph {
    /// Nodes in the order in which they were found.
    pub nodes: Vec<Node>,
    known: HashMap<Rc<(Place, State)>, usize>,
    /// Number of states by place.
    counts: HashMap<Place, usize>,
}

/// State with the paths from it.
pub struct Node {
    /// Place and state.
    pub at: Rc<(Place, State)>,
    /// Next nodes, with the instructions up to them.
    pub edges: Vec<(usize, u64)>,
    /// Instructions up to the end of the function.
    pub end: Option<u64>,
}

impl Graph {
    /// Returns the node of a state, a new one if it is not known.
    pub fn node(&mut self, place: Place, state: State) -> usize {
        let at = Rc::new((place, state));
        if let Some(known) = self.known.get(&at) {
            return *known;
        }
        let index = self.nodes.len();
        self.known.insert(Rc::clone(&at), index);
        *self.counts.entry(place).or_default() += 1;
        self.nodes.push(Node {
            at,
            edges: Vec::new(),
            end: None,
        });
        index
    }

    /// Returns the place with most states.
    pub fn most_visited(&self) -> Place {
        let most = self
            .counts
            .iter()
            .max_by_key(|(place, count)| (**count, **place));
        most.map_or(0, |(place, _)| *place)
    }

    /// Returns the longest path from the first node, or the place of a cycle. Paths that do not end have no length.
    pub fn longest_path(&self) -> Result<u64, Place> {
        #[derive(Clone, Copy)]
        enum Mark {
            New,
            Open,
            Done(u64),
        }
        let mut marks = vec![Mark::New; self.nodes.len()];
        let mut open = vec![0];
        while let Some(&index) = open.last() {
            let node = &self.nodes[index];
            match marks[index] {
                Mark::New => {
                    marks[index] = Mark::Open;
                    for &(next, _) in &node.edges {
                        match marks[next] {
                            Mark::New => open.push(next),
                            Mark::Open => return Err(self.nodes[next].at.0),
                            Mark::Done(_) => {}
                        }
                    }
                }
                Mark::Open => {
                    let paths = node.edges.iter().map(|&(next, weight)| match marks[next] {
                        Mark::Done(length) => weight + length,
                        Mark::New | Mark::Open => 0,
                    });
                    let longest = paths.chain(node.end).max();
                    marks[index] = Mark::Done(longest.unwrap_or_default());
                    open.pop();
                }
                Mark::Done(_) => {
                    open.pop();
                }
            }
        }
        match marks.first() {
            Some(Mark::Done(length)) => Ok(*length),
            _ => Ok(0),
        }
    }
}
