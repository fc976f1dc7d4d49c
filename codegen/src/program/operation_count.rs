//! Number of operations in a call, an estimate of its cost that is independent of the machine.

use crate::program::{Extent, Op, Program, RowValues, ValueId};

impl Program {
    /// Counts the additions, subtractions, multiplications, divisions, sign changes and selections per call that
    /// `roots` need, element by element. A function call counts as one operation, a sum of n elements as n - 1.
    pub fn operations(&self, roots: &[ValueId]) -> usize {
        self.per_call(roots)
            .into_iter()
            .map(|id| self.count_value_operations(id))
            .sum()
    }

    /// Counts the operations of a call of each emitted function, see [`Self::operations`].
    pub fn count_operations_by_function(&self) -> Vec<(&'static str, usize)> {
        let observables = &self.observable_values;
        let (energy, power) = match observables[..] {
            [.., energy, power] => (vec![energy], vec![power]),
            _ => Default::default(),
        };
        let guards: Vec<ValueId> = self.guards.iter().map(|guard| guard.value).collect();
        let mass = &self.mass;
        let mass = mass.scalars.iter().chain(&mass.coupling).flatten().copied();
        let mass: Vec<ValueId> = mass
            .chain(self.mass.modal.iter().flatten().flatten().copied())
            .collect();
        let outputs = &self.outputs;
        let rows = |rows: &Option<RowValues>| rows.as_ref().map(RowValues::all);
        let mut functions = vec![
            ("rates", Some(self.rate_roots())),
            ("observables", Some(observables.clone())),
            ("energy", Some(energy)),
            ("power", Some(power)),
            ("guards", Some(guards)),
            ("mass_matrix", Some(mass)),
            ("bias_forces", rows(&outputs.bias_forces)),
            ("inverse_dynamics", rows(&outputs.inverse_dynamics)),
            ("guard_rates", outputs.guard_rates.clone()),
        ];
        for jacobian in &outputs.jacobians {
            let entries = jacobian.entries.iter().map(|entry| entry.value);
            functions.push((jacobian.name, Some(entries.collect())));
        }
        let counted = functions.into_iter();
        counted
            .filter_map(|(name, roots)| Some((name, self.operations(&roots?))))
            .collect()
    }

    fn count_value_operations(&self, id: ValueId) -> usize {
        let value = self.value(id);
        let length = |id: ValueId| self.value(id).extent.length();
        match &value.op {
            Op::Constant(_)
            | Op::Table(_)
            | Op::Parameter(_)
            | Op::Coordinate(_)
            | Op::Rate(_)
            | Op::ModeCoordinates(_)
            | Op::ModeRates(_)
            | Op::State(_)
            | Op::Input(_)
            | Op::Argument(..)
            | Op::Time => 0,
            Op::Negate(_)
            | Op::Add(..)
            | Op::Subtract(..)
            | Op::Multiply(..)
            | Op::Divide(..)
            | Op::Power(..)
            | Op::Call(..)
            | Op::Select { .. } => value.extent.length(),
            // Each element takes a selection and a division.
            Op::PivotReciprocal(_) => 2 * value.extent.length(),
            Op::Total(vector) => length(*vector).saturating_sub(1),
            Op::Apply { matrix, .. } => 2 * length(*matrix),
            Op::Gram { weight, .. } | Op::GramDiagonal { weight, .. } => {
                3 * length(*weight) * value.extent.length()
            }
            Op::Assemble {
                diagonal,
                outer,
                matrices,
            } => {
                let products = 2 * outer.len() + 3 * matrices.len();
                value.extent.length() * products + diagonal.map_or(0, length)
            }
            Op::Cholesky(_) => cube_third(value.extent),
            Op::CholeskySolve(factor, _) => {
                let columns = match value.extent {
                    Extent::Matrix(_, columns) => columns,
                    _ => 1,
                };
                2 * length(*factor) * columns
            }
        }
    }
}

fn cube_third(extent: Extent) -> usize {
    match extent {
        Extent::Matrix(rows, _) => rows.pow(3).div_ceil(3),
        other => other.length(),
    }
}
