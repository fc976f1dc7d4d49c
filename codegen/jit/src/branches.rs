//! Kernels of single numbers with branches: where an arm of a selection is long and used
//! nowhere else, only the arm taken is computed. Motions change arms rarely, so that
//! branches are foreseen. Two lanes may want different arms and compute both.

use cranelift_codegen::ir::condcodes::FloatCC;
use cranelift_codegen::ir::{BlockArg, InstBuilder, Value, types};
use elementary::{Kernel, Operation};

use crate::loops::Lanes;
use crate::stage::Writer;

/// The fewest operations worth a branch.
const WORTH: usize = 8;

/// An arm of the selection at this place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Arm {
    selection: usize,
    taken: bool,
}

/// Which operations belong to an arm alone; the innermost one.
pub struct Branches {
    owners: Vec<Option<Arm>>,
}

impl Branches {
    /// Looks for arms worth a branch.
    pub fn of(kernel: &Kernel) -> Self {
        let count = kernel.operations.len();
        let mut users = vec![Vec::new(); count];
        for (user, operation) in kernel.operations.iter().enumerate() {
            operation.map_operands(|operand| {
                users[operand].push(user);
                operand
            });
        }
        for output in &kernel.outputs {
            users[*output].push(count);
        }
        let mut owners = vec![None; count];
        for (selection, operation) in kernel.operations.iter().enumerate() {
            let Some(choice) = Choice::of(*operation) else {
                continue;
            };
            for (root, taken) in [(choice.then, true), (choice.otherwise, false)] {
                let members = alone(kernel, &users, selection, root);
                if members.len() >= WORTH {
                    for member in members {
                        owners[member].get_or_insert(Arm { selection, taken });
                    }
                }
            }
        }
        Self { owners }
    }

    fn at(&self, selection: usize) -> bool {
        let mut arms = self.owners.iter().flatten();
        arms.any(|arm| arm.selection == selection)
    }
}

/// The operations that only `root`, as an arm of `selection`, needs.
fn alone(kernel: &Kernel, users: &[Vec<usize>], selection: usize, root: usize) -> Vec<usize> {
    let mut inside = vec![false; selection];
    for place in (0..=root).rev() {
        inside[place] = if place == root {
            users[place] == [selection]
        } else {
            users[place]
                .iter()
                .all(|user| *user <= root && inside[*user])
        } && kernel.operations[place].is_computed();
    }
    (0..selection).filter(|place| inside[*place]).collect()
}

/// A selection.
struct Choice {
    condition: FloatCC,
    left: usize,
    right: usize,
    then: usize,
    otherwise: usize,
}

impl Choice {
    fn of(operation: Operation) -> Option<Self> {
        match operation {
            Operation::SelectLess {
                left,
                right,
                then,
                otherwise,
            } => Some(Self {
                condition: FloatCC::LessThan,
                left,
                right,
                then,
                otherwise,
            }),
            Operation::SelectEqual {
                left,
                right,
                then,
                otherwise,
            } => Some(Self {
                condition: FloatCC::Equal,
                left,
                right,
                then,
                otherwise,
            }),
            _ => None,
        }
    }
}

/// A kernel being written.
struct Written<'k> {
    /// Its operations.
    kernel: &'k Kernel,
    /// Where it branches.
    branches: &'k Branches,
    /// Its arguments, in both lanes.
    arguments: &'k [Value],
    /// Values by now; the first argument where there is none yet.
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

    /// Writes what belongs to an arm, or to none.
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

    /// A value by now. Literals are read anew: one read in an arm is not known outside.
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
