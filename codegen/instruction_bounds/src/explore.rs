//! Longest path through the states of a function.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::rc::Rc;

use crate::graph::Graph;
use crate::instruction::{Instruction, decode};
use crate::jump::Step;
use crate::library::{KnownLoop, known_loops};
use crate::listing::{CodeAddress, Listing};
use crate::state::{Effect, State, Writes};
use crate::step::Machine;
use crate::value::{UNKNOWN, Value};

/// Largest number of states at the targets of jumps in one function.
const MAX_STATES: usize = 20_000;

/// Upper bounds for one call of a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bound {
    /// Number of executed instructions, including instructions whose condition is false.
    pub instructions: u64,
    /// Number of executed instructions if no operand of a double-precision product or quotient in libgcc is
    /// subnormal.
    pub without_subnormals: u64,
    /// Stack use below the caller's stack pointer, in bytes.
    pub stack: u64,
}

#[derive(Clone, Debug)]
struct Summary {
    instructions: u64,
    stack: u64,
    effect: Effect,
}

/// Function, and the known numbers among its arguments.
type Call = (CodeAddress, [Option<u32>; 4]);

/// Computation of the bounds of the functions in a listing.
pub struct Explorer<'a> {
    listing: &'a Listing,
    instructions: BTreeMap<CodeAddress, Instruction>,
    targets: BTreeSet<CodeAddress>,
    loops: BTreeMap<CodeAddress, KnownLoop>,
    /// True if operands may be subnormal.
    has_subnormals: bool,
    summaries: HashMap<Call, Result<Rc<Summary>, String>>,
    active: Vec<CodeAddress>,
}

impl<'a> Explorer<'a> {
    /// Creates an explorer of a listing.
    pub fn new(listing: &'a Listing) -> Self {
        let (instructions, targets) = decode(listing);
        Self {
            listing,
            instructions,
            targets,
            loops: known_loops(listing),
            has_subnormals: true,
            summaries: HashMap::new(),
            active: Vec::new(),
        }
    }

    /// Computes the bounds of functions for any arguments. If a function has no bound, the error contains the reason.
    pub fn bound_functions(mut self, functions: &[CodeAddress]) -> Vec<Result<Bound, String>> {
        let all: Vec<_> = functions
            .iter()
            .map(|function| self.summarise_any_call(*function))
            .collect();
        self.has_subnormals = false;
        if !self.loops.is_empty() {
            self.summaries.clear();
        }
        let bounds = functions.iter().zip(all).map(|(function, all)| {
            let all = all?;
            let without_subnormals = self.summarise_any_call(*function)?.instructions;
            Ok(Bound {
                instructions: all.instructions,
                without_subnormals,
                stack: all.stack,
            })
        });
        bounds.collect()
    }

    fn summarise_any_call(&mut self, function: CodeAddress) -> Result<Rc<Summary>, String> {
        self.summarise_call((function, [None; 4]))
    }

    fn summarise_call(&mut self, call: Call) -> Result<Rc<Summary>, String> {
        if let Some(known) = self.summaries.get(&call) {
            return known.clone();
        }
        if self.active.contains(&call.0) {
            return Err(format!("{} calls itself", self.listing.describe(call.0)));
        }
        self.active.push(call.0);
        let summary = self.explore(call).map(Rc::new);
        self.active.pop();
        self.summaries.insert(call, summary.clone());
        summary
    }

    fn explore(&mut self, (function, numbers): Call) -> Result<Summary, String> {
        let mut run = Run {
            machine: Machine {
                listing: self.listing,
                writes: Writes::default(),
            },
            graph: Graph::default(),
            stack: 0,
            registers: None,
        };
        run.graph.node(function, State::at_entry(numbers));
        let mut next = 0;
        while next < run.graph.nodes.len() {
            if run.graph.nodes.len() > MAX_STATES {
                let code_address = self.listing.describe(run.graph.most_visited());
                return Err(format!(
                    "a loop or branches with more than {MAX_STATES} states, at {code_address}"
                ));
            }
            self.follow(&mut run, next)?;
            next += 1;
        }
        let instructions = run.graph.longest_path().map_err(|code_address| {
            let code_address = self.listing.describe(code_address);
            format!("a loop without proven number of iterations, at {code_address}")
        })?;
        Ok(Summary {
            instructions,
            stack: run.stack,
            effect: Effect {
                writes: run.machine.writes,
                registers: run.registers.unwrap_or([UNKNOWN; 15]),
            },
        })
    }

    /// Follows all paths from a node to the next nodes.
    fn follow(&mut self, run: &mut Run<'a>, node: usize) -> Result<(), String> {
        let (code_address, state) = (*run.graph.nodes[node].at).clone();
        let mut paths = vec![(code_address, state, 0_u64)];
        let mut is_first = true;
        while let Some((mut code_address, mut state, mut count)) = paths.pop() {
            loop {
                if !std::mem::take(&mut is_first) && self.targets.contains(&code_address) {
                    let next = run.graph.node(code_address, state);
                    run.graph.nodes[node].edges.push((next, count));
                    break;
                }
                let Some(instruction) = self.instructions.get(&code_address) else {
                    let code_address = self.listing.describe(code_address);
                    return Err(format!("a jump to {code_address}, which is no instruction"));
                };
                count += 1;
                let after = code_address + instruction.size;
                let holds = instruction.condition.value(state.flags);
                if holds == Some(false) {
                    code_address = after;
                    continue;
                }
                if let Some(known) = self.loops.get(&code_address) {
                    if !self.has_subnormals {
                        break;
                    }
                    count += known.repeated_instructions;
                    known.forget(&mut state);
                    code_address = after;
                    continue;
                }
                let before = holds.is_none().then(|| state.clone());
                let step = run.machine.execute(code_address, instruction, &mut state);
                let step = match step {
                    Step::Branch(target, None) => {
                        paths.push((target, state.clone(), count));
                        Step::Next
                    }
                    Step::Branch(target, Some(true)) => Step::Jump(target),
                    Step::Branch(_, Some(false)) => Step::Next,
                    step => step,
                };
                if step == Step::Next {
                    if let Some(before) = before {
                        state = state.join(&before);
                    }
                    run.note_stack(&state, 0)
                        .map_err(|reason| self.describe_failure(code_address, reason))?;
                    code_address = after;
                    continue;
                }
                if let Some(before) = before {
                    paths.push((after, before, count));
                }
                match step {
                    Step::Jump(target) => code_address = target,
                    Step::Call(called) => {
                        let summary = self.summarise_call((called, state.arguments()));
                        let summary = summary.map_err(|reason| self.in_call(called, reason))?;
                        run.note_stack(&state, summary.stack)
                            .map_err(|reason| self.describe_failure(code_address, reason))?;
                        count += summary.instructions;
                        state.call(&summary.effect, &mut run.machine.writes);
                        code_address = after;
                    }
                    Step::Return => {
                        let end = &mut run.graph.nodes[node].end;
                        *end = Some(end.unwrap_or_default().max(count));
                        run.note_end(&state);
                        break;
                    }
                    Step::Unbounded(reason) => {
                        return Err(self.describe_failure(code_address, &reason));
                    }
                    Step::Next | Step::Branch(..) => code_address = after,
                }
            }
        }
        Ok(())
    }

    fn describe_failure(&self, code_address: CodeAddress, reason: &str) -> String {
        format!("{reason}, at {}", self.listing.describe(code_address))
    }

    fn in_call(&self, called: CodeAddress, reason: String) -> String {
        let called = self.listing.describe(called);
        match reason.contains(&called) {
            true => reason,
            false => format!("{reason}, called by {called}"),
        }
    }
}

struct Run<'a> {
    machine: Machine<'a>,
    graph: Graph,
    stack: u64,
    /// Core registers that are known at every return of the function.
    registers: Option<[Value; 15]>,
}

impl Run<'_> {
    fn note_end(&mut self, state: &State) {
        let registers = self.registers.get_or_insert(state.registers());
        for (register, value) in registers.iter_mut().zip(state.registers()) {
            *register = register.join(value);
        }
    }

    /// Updates the largest stack use with the stack of a state and `more` bytes of a called function.
    fn note_stack(&mut self, state: &State, more: u64) -> Result<(), &'static str> {
        let offset = state
            .stack_offset()
            .ok_or("a stack pointer that is not known")?;
        let used = u64::try_from(-i64::from(offset)).unwrap_or_default();
        self.stack = self.stack.max(used + more);
        Ok(())
    }
}
