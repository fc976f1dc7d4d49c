//! Code of kernels of single numbers with branches: only the arm that is taken is computed.

use cranelift_codegen::ir::{BlockArg, InstBuilder, Value, types};
use eomgen_elementary::{Kernel, Operation};

use crate::branches::{Arm, Branches, Choice};
use crate::lanes::Lanes;
use crate::stage::Writer;

/// Kernel under construction.
struct Written<'k> {
    kernel: &'k Kernel,
    branches: &'k Branches,
    /// Arguments, in both lanes.
    arguments: &'k [Value],
    /// Computed values; the first argument as a placeholder before.
    values: Vec<Value>,
}

impl Writer<'_, '_, '_> {
    /// Writes a kernel of one number, which is in both lanes.
    pub fn branching_kernel(
        &mut self,
        kernel: &Kernel,
        branches: &Branches,
        arguments: &[Value],
    ) -> Value {
        let mut written = Written {
            kernel,
            branches,
            arguments,
            values: vec![arguments[0]; kernel.operations.len()],
        };
        self.owned_by(&mut written, None);
        self.known(&written, kernel.outputs[0])
    }

    /// Writes the operations of an arm, or those of no arm.
    fn owned_by(&mut self, written: &mut Written<'_>, owner: Option<Arm>) {
        for place in 0..written.kernel.operations.len() {
            let operation = written.kernel.operations[place];
            if written.branches.owners[place] != owner
                || matches!(operation, Operation::Constant(_))
            {
                continue;
            }
            let value = match Choice::of(operation) {
                Some(choice) if written.branches.at(place) => self.branch(written, place, &choice),
                _ => {
                    operation.map_operands(|operand| {
                        written.values[operand] = self.known(written, operand);
                        operand
                    });
                    let values = &written.values;
                    self.primitive(operation, |operand| values[operand], written.arguments)
                }
            };
            written.values[place] = value;
        }
    }

    /// Returns a computed value. Literals are read again: one read in an arm is unknown outside.
    fn known(&mut self, written: &Written<'_>, place: usize) -> Value {
        match written.kernel.operations[place] {
            Operation::Constant(number) => self.literal(number, Lanes::Two),
            _ => written.values[place],
        }
    }

    fn branch(&mut self, written: &mut Written<'_>, selection: usize, choice: &Choice) -> Value {
        let [then, otherwise, after] = [(); 3].map(|()| self.builder.create_block());
        let result = self.builder.append_block_param(after, types::F64X2);
        let [left, right] = [choice.left, choice.right].map(|side| {
            let side = self.known(written, side);
            self.ins().extractlane(side, 0)
        });
        let holds = self.ins().fcmp(choice.condition, left, right);
        self.ins().brif(holds, then, &[], otherwise, &[]);
        for (block, root, taken) in [
            (then, choice.then, true),
            (otherwise, choice.otherwise, false),
        ] {
            self.builder.switch_to_block(block);
            self.owned_by(written, Some(Arm { selection, taken }));
            let value = self.known(written, root);
            self.ins().jump(after, &[BlockArg::from(value)]);
        }
        self.builder.switch_to_block(after);
        result
    }
}
