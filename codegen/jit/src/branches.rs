//! Branches in scalar kernels. If a long arm of a selection has no other use, it is computed only if it is selected.
//! During a motion the selected arm changes rarely, so the processor predicts the branch well. SIMD lanes can need
//! different arms; their kernels compute both.

use cranelift_codegen::ir::condcodes::FloatCC;
use eomgen_elementary::{Kernel, Operation};

/// Smallest number of operations in an arm with a branch.
const MIN_ARM_OPERATIONS: usize = 8;

/// Arm of the selection with this index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Arm {
    pub(crate) selection: usize,
    pub(crate) taken: bool,
}

/// Innermost arm of each operation, if it belongs to one.
pub struct Branches {
    pub(crate) owners: Vec<Option<Arm>>,
}

impl Branches {
    /// Finds arms that are long enough for a branch.
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
                let members = exclusive_operations(kernel, &users, selection, root);
                if members.len() >= MIN_ARM_OPERATIONS {
                    for member in members {
                        owners[member].get_or_insert(Arm { selection, taken });
                    }
                }
            }
        }
        Self { owners }
    }

    pub(crate) fn is_branch(&self, selection: usize) -> bool {
        let mut arms = self.owners.iter().flatten();
        arms.any(|arm| arm.selection == selection)
    }
}

/// Returns the operations that are used only to compute `root`, an arm of `selection`.
fn exclusive_operations(
    kernel: &Kernel,
    users: &[Vec<usize>],
    selection: usize,
    root: usize,
) -> Vec<usize> {
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

pub(crate) struct Choice {
    pub(crate) condition: FloatCC,
    pub(crate) left: usize,
    pub(crate) right: usize,
    pub(crate) then: usize,
    pub(crate) otherwise: usize,
}

impl Choice {
    pub(crate) fn of(operation: Operation) -> Option<Self> {
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
