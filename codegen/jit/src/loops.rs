//! Loops over the elements of vectors, unrolled with two lanes, and over the rows and columns of matrices.

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{BlockArg, InstBuilder, Value, types};

use crate::lanes::{ElementRef, MAX_REGISTER_VECTOR, pairs};
use crate::stage::Writer;

/// Number of elements in one iteration of a loop.
const ELEMENTS_PER_TURN: usize = 4;

impl Writer<'_, '_, '_> {
    /// Writes `step` for the elements `0..length`.
    pub fn loop_over_elements(
        &mut self,
        length: usize,
        mut step: impl FnMut(&mut Self, ElementRef),
    ) {
        let turns = if length > MAX_REGISTER_VECTOR {
            length / ELEMENTS_PER_TURN
        } else {
            0
        };
        self.loop_turns(turns, ELEMENTS_PER_TURN, Vec::new(), |writer, moving, _| {
            for element in (0..ELEMENTS_PER_TURN).step_by(2) {
                step(writer, ElementRef::pair(Some(moving), element));
            }
            Vec::new()
        });
        for at in pairs(turns * ELEMENTS_PER_TURN, length) {
            step(self, at);
        }
    }

    /// Writes a loop of `turns` iterations over `turn` elements each. Pairs of numbers are passed from one iteration
    /// to the next. An argument of `body` is the byte offset of the iteration.
    pub fn loop_turns(
        &mut self,
        turns: usize,
        turn: usize,
        first: Vec<Value>,
        body: impl FnOnce(&mut Self, Value, &[Value]) -> Vec<Value>,
    ) -> Vec<Value> {
        if turns == 0 {
            return first;
        }
        let (head, exit) = (self.builder.create_block(), self.builder.create_block());
        let moving = self.builder.append_block_param(head, types::I64);
        let kinds = first.iter().map(|_| types::F64X2);
        let carried: Vec<Value> = kinds
            .map(|kind| self.builder.append_block_param(head, kind))
            .collect();
        let zero = self.index(0);
        let enter = arguments(zero, &first);
        self.instructions().jump(head, &enter);
        self.builder.switch_to_block(head);
        let carried = body(self, moving, &carried);
        let next = self.instructions().iadd_imm_u(moving, (turn * 8) as i64);
        let bound = (turns * turn * 8) as i64;
        let again = self
            .instructions()
            .icmp_imm_u(IntCC::UnsignedLessThan, next, bound);
        let back = arguments(next, &carried);
        self.instructions().brif(again, head, &back, exit, &[]);
        self.builder.switch_to_block(exit);
        carried
    }

    /// Writes a loop over the index range `from..to`, which can be empty. Numbers are passed from one iteration to
    /// the next.
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
        let enter = arguments(from, first);
        self.instructions().jump(head, &enter);
        self.builder.switch_to_block(head);
        let more = self.instructions().icmp(IntCC::SignedLessThan, index, to);
        self.instructions().brif(more, inside, &[], exit, &[]);
        self.builder.switch_to_block(inside);
        let after = body(self, index, &carried);
        let next = self.instructions().iadd_imm_u(index, 1);
        let back = arguments(next, &after);
        self.instructions().jump(head, &back);
        self.builder.switch_to_block(exit);
        carried
    }

    /// Writes a loop over `0..count`. Numbers are passed from one iteration to the next.
    pub fn count(
        &mut self,
        count: usize,
        first: &[Value],
        body: impl FnOnce(&mut Self, Value, &[Value]) -> Vec<Value>,
    ) -> Vec<Value> {
        let bounds = (self.index(0), self.index(count));
        self.range(bounds, first, body)
    }

    pub fn index(&mut self, value: usize) -> Value {
        self.instructions().iconst(types::I64, value as i64)
    }
}

fn arguments(index: Value, carried: &[Value]) -> Vec<BlockArg> {
    let values = [index].into_iter().chain(carried.iter().copied());
    values.map(BlockArg::from).collect()
}
