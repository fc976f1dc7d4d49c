//! Plan of one stage, and its division into functions.
//!
//! The time of register allocation grows with the square of a function's length. A long stage therefore
//! becomes several functions of at most [`MAX_PIECE`] values, called one after the other. Values that a later
//! piece reads are stored in memory.

use std::collections::{HashMap, HashSet};
use std::ops::Range;

use eomgen_codegen::program::evaluator::Stage;
use eomgen_codegen::program::{Op, Program, ValueId};

/// Largest number of values computed by one function.
const MAX_PIECE: usize = 512;

/// Task of a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Task {
    /// Computation of the coefficients.
    Prepare,
    /// Computation of a stage in each call.
    PerCall(Stage),
}

/// Values of one stage, operands first, with their storage.
pub struct Plan {
    /// Task.
    pub task: Task,
    /// Results of the stage.
    pub roots: Vec<ValueId>,
    /// Number of uses of each value.
    pub uses: HashMap<ValueId, usize>,
    /// Values that must be stored in memory.
    pub wanted: HashSet<ValueId>,
    /// Values computed by the stage, operands first.
    pub steps: Vec<ValueId>,
}

impl Plan {
    /// Plans one stage of a program.
    pub fn new(program: &Program, task: Task) -> Self {
        let roots = match task {
            Task::Prepare => Vec::new(),
            Task::PerCall(stage) => stage.roots(program),
        };
        let steps = match task {
            Task::Prepare => program
                .ids()
                .filter(|id| program.value(*id).parameter_only)
                .collect(),
            Task::PerCall(_) => program.per_call(&roots),
        };
        let mut plan = Self {
            task,
            roots,
            uses: HashMap::new(),
            wanted: HashSet::new(),
            steps,
        };
        plan.count_uses(program);
        plan.store_across_pieces(program);
        plan
    }

    /// Returns at least one piece, in the order of the calls. Each piece is a range of [`Plan::steps`].
    pub fn pieces(&self) -> Vec<Range<usize>> {
        let starts = (0..self.steps.len().max(1)).step_by(MAX_PIECE);
        starts
            .map(|start| start..(start + MAX_PIECE).min(self.steps.len()))
            .collect()
    }

    fn count_uses(&mut self, program: &Program) {
        for id in &self.steps {
            let op = &program.value(*id).op;
            let operands = op.operands();
            if !is_elementwise(op) && !matches!(op, Op::Total(_)) {
                self.wanted.extend(&operands);
            }
            for operand in operands {
                *self.uses.entry(operand).or_insert(0) += 1;
            }
        }
        for root in &self.roots {
            *self.uses.entry(*root).or_insert(0) += 1;
        }
        match self.task {
            Task::Prepare => self.wanted.extend(&self.steps),
            Task::PerCall(Stage::Rates) => {}
            Task::PerCall(_) => self.wanted.extend(&self.roots),
        }
    }

    /// Marks values that another piece reads; the last piece reads the values of the rates.
    fn store_across_pieces(&mut self, program: &Program) {
        let piece = |place: usize| place / MAX_PIECE;
        let places = self.steps.iter().enumerate();
        let piece_of: HashMap<ValueId, usize> = places.map(|(at, id)| (*id, piece(at))).collect();
        let last = piece(self.steps.len().saturating_sub(1));
        let reads = |(at, id): (usize, &ValueId)| {
            let operands = program.value(*id).op.operands().into_iter();
            operands.map(move |operand| (operand, piece(at)))
        };
        let reads = self.steps.iter().enumerate().flat_map(reads);
        let roots = self.roots.iter().map(|root| (*root, last));
        let crossing = reads
            .chain(roots)
            .filter(|(id, reader)| piece_of.get(id).is_some_and(|own| own != reader));
        self.wanted.extend(crossing.map(|(id, _)| id));
    }
}

/// Returns true if each element depends only on the operands' elements with the same index.
pub fn is_elementwise(op: &Op) -> bool {
    !matches!(
        op,
        Op::Total(_)
            | Op::Apply { .. }
            | Op::Gram { .. }
            | Op::GramDiagonal { .. }
            | Op::Assemble { .. }
            | Op::Cholesky(_)
            | Op::CholeskySolve(..)
    )
}

#[cfg(test)]
mod tests {
    use std::fmt::Write;

    use eomgen_codegen::program::evaluator::{Evaluator, Point};
    use eomgen_codegen::variant::Variant;
    use eomgen_model_spec::source::Source;

    use super::*;

    /// Returns the program of a chain of masses on springs with nonlinear forces.
    fn chain(masses: usize) -> Program {
        let mut text =
            "[model]\nname = \"chain\"\n[parameters]\nm = { value = 2, unit = \"kg\" }\n\
                        k = { value = 3, unit = \"N m\" }\nl = { value = 4, unit = \"m\" }\n\
                        [coordinates]\n"
                .to_owned();
        let mut energies = [String::new(), String::new()];
        for mass in 1..=masses {
            let _ = writeln!(text, "x_{mass} = {{ unit = \"m\" }}");
            let before = if mass == 1 {
                String::new()
            } else {
                format!(" - x_{}", mass - 1)
            };
            let _ = writeln!(energies[0], "t_{mass} = \"1/2*m*dot(x_{mass})^2\"");
            let _ = writeln!(
                energies[1],
                "v_{mass} = \"k*(1 - cos((x_{mass}{before})/l))\""
            );
        }
        let text = format!(
            "{text}[kinetic]\n{}[potential]\n{}",
            energies[0], energies[1]
        );
        let checked = eomgen_model_spec::check(Source::new("chain.toml", text));
        let model = checked.expect("a model").model;
        Variant::derive(&model, &[]).expect("equations").program
    }

    #[test]
    fn long_stage_has_bounded_pieces_and_matches_interpreter() {
        let program = chain(150);
        let plan = Plan::new(&program, Task::PerCall(Stage::Rates));
        let pieces = plan.pieces();
        assert!(pieces.len() > 1, "{pieces:?}");
        assert!(pieces.iter().all(|piece| piece.len() <= MAX_PIECE));
        assert!(pieces.windows(2).all(|pair| pair[0].end == pair[1].start));
        let state: Vec<f64> = (0..program.states()).map(|k| (k as f64).sin()).collect();
        let point = Point {
            t: 0.0,
            state: &state,
            inputs: &[],
        };
        let (mut compiled, mut interpreted) = (vec![0.0; state.len()], vec![0.0; state.len()]);
        crate::evaluator(program.clone()).rates(point, &mut compiled);
        let mut interpreter = Evaluator::new(program.clone());
        interpreter.rates(point, &mut interpreted);
        assert_eq!(compiled, interpreted);
        let count = program.observables.len();
        let (mut compiled, mut interpreted) = (vec![0.0; count], vec![0.0; count]);
        crate::evaluator(program).observables(point, &mut compiled);
        interpreter.observables(point, &mut interpreted);
        assert_eq!(compiled, interpreted);
    }
}
