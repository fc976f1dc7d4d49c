//! Loops: over the elements of vectors, two lanes at a time and unrolled, and over the rows
//! and columns of matrices.

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{BlockArg, InstBuilder, Value, types};

use crate::stage::Writer;

/// Vectors up to this length are written out and live in registers: four of the sixteen
/// that there are.
pub const SHORT: usize = 8;

/// Elements per turn of a loop.
const TURN: usize = 4;

/// How many neighbouring elements one register holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lanes {
    /// One.
    One,
    /// Two.
    Two,
}

/// Which element, or two neighbouring ones.
#[derive(Clone, Copy, Debug)]
pub struct At {
    /// Bytes that a loop adds.
    pub moving: Option<Value>,
    /// The element where the loop stands at 0.
    pub element: usize,
    /// How many.
    pub lanes: Lanes,
}

impl At {
    /// Element number `element`.
    pub fn one(element: usize) -> Self {
        Self {
            moving: None,
            element,
            lanes: Lanes::One,
        }
    }

    fn two(moving: Option<Value>, element: usize) -> Self {
        Self {
            moving,
            element,
            lanes: Lanes::Two,
        }
    }
}

/// The elements `from..to` in pairs, a single one last.
fn pairs(from: usize, to: usize) -> impl Iterator<Item = At> {
    (from..to).step_by(2).map(move |element| {
        if element + 1 < to {
            At::two(None, element)
        } else {
            At::one(element)
        }
    })
}

impl Writer<'_, '_, '_> {
    /// Goes through the elements `0..length` in order, carrying a value.
    pub fn fold(
        &mut self,
        length: usize,
        first: Option<Value>,
        mut step: impl FnMut(&mut Self, Option<Value>, At) -> Option<Value>,
    ) -> Option<Value> {
        let turns = if length > SHORT { length / TURN } else { 0 };
        let mut carried = first;
        if turns > 0 {
            let zero = self.ins().iconst(types::I64, 0);
            let bound = (turns * TURN * 8) as i64;
            carried = self.turns(zero, bound, carried, |writer, moving, mut carried| {
                for element in (0..TURN).step_by(2) {
                    carried = step(writer, carried, At::two(Some(moving), element));
                }
                carried
            });
        }
        for at in pairs(turns * TURN, length) {
            carried = step(self, carried, at);
        }
        carried
    }

    /// Goes through the elements `0..length`.
    pub fn each(&mut self, length: usize, mut step: impl FnMut(&mut Self, At)) {
        self.fold(length, None, |writer, _, at| {
            step(writer, at);
            None
        });
    }

    /// A loop of a byte offset from `zero` in steps of a turn up to `bound`, at least once.
    fn turns(
        &mut self,
        zero: Value,
        bound: i64,
        first: Option<Value>,
        body: impl FnOnce(&mut Self, Value, Option<Value>) -> Option<Value>,
    ) -> Option<Value> {
        let (head, exit) = (self.builder.create_block(), self.builder.create_block());
        let moving = self.builder.append_block_param(head, types::I64);
        let carried = first.map(|_| self.builder.append_block_param(head, types::F64));
        let enter = arguments(zero, first);
        self.ins().jump(head, &enter);
        self.builder.switch_to_block(head);
        let carried = body(self, moving, carried);
        let next = self.ins().iadd_imm_u(moving, (TURN * 8) as i64);
        let again = self.ins().icmp_imm_u(IntCC::UnsignedLessThan, next, bound);
        let back = arguments(next, carried);
        self.ins().brif(again, head, &back, exit, &[]);
        self.builder.switch_to_block(exit);
        carried
    }

    /// A loop of an index over `from..to`, possibly not once, carrying numbers.
    pub fn range(
        &mut self,
        (from, to): (Value, Value),
        first: &[Value],
        body: impl FnOnce(&mut Self, Value, &[Value]) -> Vec<Value>,
    ) -> Vec<Value> {
        let [head, inside, exit] = [(); 3].map(|()| self.builder.create_block());
        let index = self.builder.append_block_param(head, types::I64);
        let carried: Vec<Value> = first
            .iter()
            .map(|value| {
                let kind = self.builder.func.dfg.value_type(*value);
                self.builder.append_block_param(head, kind)
            })
            .collect();
        let enter: Vec<BlockArg> = [from].iter().chain(first).map(|v| (*v).into()).collect();
        self.ins().jump(head, &enter);
        self.builder.switch_to_block(head);
        let more = self.ins().icmp(IntCC::SignedLessThan, index, to);
        self.ins().brif(more, inside, &[], exit, &[]);
        self.builder.switch_to_block(inside);
        let after = body(self, index, &carried);
        let next = self.ins().iadd_imm_u(index, 1);
        let back: Vec<BlockArg> = [next].iter().chain(&after).map(|v| (*v).into()).collect();
        self.ins().jump(head, &back);
        self.builder.switch_to_block(exit);
        carried
    }

    /// A loop of an index over `0..count`, carrying numbers.
    pub fn count(
        &mut self,
        count: usize,
        first: &[Value],
        body: impl FnOnce(&mut Self, Value, &[Value]) -> Vec<Value>,
    ) -> Vec<Value> {
        let bounds = (self.index(0), self.index(count));
        self.range(bounds, first, body)
    }

    /// The index `value`.
    pub fn index(&mut self, value: usize) -> Value {
        self.ins().iconst(types::I64, value as i64)
    }
}

fn arguments(moving: Value, carried: Option<Value>) -> Vec<BlockArg> {
    let values = [Some(moving), carried];
    values.into_iter().flatten().map(BlockArg::from).collect()
}
