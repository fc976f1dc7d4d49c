//! Code of scalar kernels with branches: only the selected arm is computed.

use cranelift_codegen::ir::{BlockArg, InstBuilder, Value, types};
use eomgen_elementary::{Kernel, Operation};

use crate::branches::{Arm, Branches, Choice};
use crate::lanes::Lanes;
use crate::stage::Writer;

/// Kernel under construction.
struct WrittenValues<'k> {
    kernel: &'k Kernel,
    branches: &'k Branches,
    /// Arguments, in both lanes.
    arguments: &'k [Value],
    /// Computed values. Before its computation, a value is represented by the first argument as a placeholder.
    values: Vec<Value>,
}

impl Writer<'_, '_, '_> {
    /// Writes a kernel of one number, which is stored in both lanes.
    pub fn write_branching_kernel(
        &mut self,
        kernel: &Kernel,
        branches: &Branches,
        arguments: &[Value],
    ) -> Value {
        let mut written = WrittenValues {
            kernel,
            branches,
            arguments,
            values: vec![arguments[0]; kernel.operations.len()],
        };
        self.write_operations_of(&mut written, None);
        self.computed_value(&written, kernel.outputs[0])
    }

    /// Writes the operations that belong to an arm, or, if `owner` is `None`, to no arm.
    fn write_operations_of(&mut self, written: &mut WrittenValues<'_>, owner: Option<Arm>) {
        for place in 0..written.kernel.operations.len() {
            let operation = written.kernel.operations[place];
            if written.branches.owners[place] != owner
                || matches!(operation, Operation::Constant(_))
            {
                continue;
            }
            let value = match Choice::of(operation) {
                Some(choice) if written.branches.is_branch(place) => {
                    self.branch(written, place, &choice)
                }
                _ => {
                    operation.map_operands(|operand| {
                        written.values[operand] = self.computed_value(written, operand);
                        operand
                    });
                    let values = &written.values;
                    self.primitive(
                        written.kernel,
                        operation,
                        |operand| values[operand],
                        written.arguments,
                    )
                }
            };
            written.values[place] = value;
        }
    }

    /// Returns a computed value. A literal is read again, because a literal that was read in an arm is not available
    /// outside it.
    fn computed_value(&mut self, written: &WrittenValues<'_>, place: usize) -> Value {
        match written.kernel.operations[place] {
            Operation::Constant(number) => self.literal(number, Lanes::Two),
            _ => written.values[place],
        }
    }

    fn branch(
        &mut self,
        written: &mut WrittenValues<'_>,
        selection: usize,
        choice: &Choice,
    ) -> Value {
        let [then, otherwise, after] = [(); 3].map(|()| self.builder.create_block());
        let result = self.builder.append_block_param(after, types::F64X2);
        let [left, right] = [choice.left, choice.right].map(|side| {
            let side = self.computed_value(written, side);
            self.instructions().extractlane(side, 0)
        });
        let holds = self.instructions().fcmp(choice.condition, left, right);
        self.instructions().brif(holds, then, &[], otherwise, &[]);
        for (block, root, taken) in [
            (then, choice.then, true),
            (otherwise, choice.otherwise, false),
        ] {
            self.builder.switch_to_block(block);
            self.write_operations_of(written, Some(Arm { selection, taken }));
            let value = self.computed_value(written, root);
            self.instructions().jump(after, &[BlockArg::from(value)]);
        }
        self.builder.switch_to_block(after);
        result
    }
}
