//! Graph of the states of a function.

use std::collections::HashMap;
use std::rc::Rc;

use crate::listing::CodeAddress;
use crate::state::State;

/// States at the targets of jumps. An edge has the number of instructions between two states.
#[derive(Default)]
pub struct Graph {
    /// Nodes in the order in which they were found.
    pub nodes: Vec<Node>,
    known: HashMap<Rc<(CodeAddress, State)>, usize>,
    /// Number of states at each address.
    counts: HashMap<CodeAddress, usize>,
}

/// State, with the paths that begin at it.
pub struct Node {
    /// Address and state.
    pub at: Rc<(CodeAddress, State)>,
    /// Next nodes, each with the number of instructions before it.
    pub edges: Vec<(usize, u64)>,
    /// Number of instructions before the return, if a path returns before the next node.
    pub end: Option<u64>,
}

impl Graph {
    /// Returns the node of a state. Adds the node if it is new.
    pub fn node(&mut self, code_address: CodeAddress, state: State) -> usize {
        let at = Rc::new((code_address, state));
        if let Some(known) = self.known.get(&at) {
            return *known;
        }
        let index = self.nodes.len();
        self.known.insert(Rc::clone(&at), index);
        *self.counts.entry(code_address).or_default() += 1;
        self.nodes.push(Node {
            at,
            edges: Vec::new(),
            end: None,
        });
        index
    }

    /// Returns the address with the most states.
    pub fn most_visited(&self) -> CodeAddress {
        let most = self
            .counts
            .iter()
            .max_by_key(|(code_address, count)| (**count, **code_address));
        most.map_or(0, |(code_address, _)| *code_address)
    }

    /// Returns the length of the longest path from the first node to a return, in instructions. If the graph has a
    /// cycle, the error is an address in the cycle. A path that does not return counts as 0.
    pub fn longest_path(&self) -> Result<u64, CodeAddress> {
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
