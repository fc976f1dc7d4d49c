//! The statements of one stage: which values get a name, which stand inside the
//! expressions that use them (`operands`), and which become loops over modes.
//!
//! Expressions keep the operations and operands of the program as they are, so nesting
//! them changes no bit.

use std::collections::{HashMap, HashSet};

use super::emit_error::Emitted;
use super::expression::{Expression, assignment, reference};
use super::functions::Needed;
use super::literals::block;
use super::names::Names;
use super::sides::Switches;
use crate::program::{Extent, Op, PARTIAL_SUMS, Program, ValueId};

/// The most operations in one emitted expression.
const EXPRESSION_SIZE: usize = 8;

/// Where a stage finds what was prepared.
pub enum Access<'a> {
    /// It prepares the coefficients itself, from `parameters`.
    Prepare,
    /// In these fields of `coefficients`.
    Coefficients(&'a HashMap<ValueId, String>),
}

/// Writes one stage.
pub struct Body<'a> {
    pub(super) program: &'a Program,
    pub(super) access: Access<'a>,
    pub(super) names: Names,
    uses: HashMap<ValueId, usize>,
    in_loops: HashMap<ValueId, bool>,
    pub(super) bound: HashMap<ValueId, String>,
    pub(super) statements: String,
    pub(super) needed: &'a mut Needed,
    /// Vectors that the caller reads as arrays.
    arrays: HashSet<ValueId>,
    /// What is decided by the regime that the stage is for.
    pub(super) switches: Switches,
}

impl<'a> Body<'a> {
    /// A stage that computes `roots`; its values are bound where several need them.
    pub fn new(
        program: &'a Program,
        access: Access<'a>,
        roots: &[ValueId],
        needed: &'a mut Needed,
    ) -> Emitted<Self> {
        Self::in_regime(program, access, roots, needed, Switches::new())
    }

    /// The same for a stage in which a regime decides about these values.
    pub fn in_regime(
        program: &'a Program,
        access: Access<'a>,
        roots: &[ValueId],
        needed: &'a mut Needed,
        switches: Switches,
    ) -> Emitted<Self> {
        let mut body = Self {
            program,
            access,
            names: Names::new(program),
            uses: HashMap::new(),
            in_loops: HashMap::new(),
            bound: HashMap::new(),
            statements: String::new(),
            needed,
            arrays: HashSet::new(),
            switches,
        };
        if matches!(body.access, Access::Prepare) {
            body.arrays.extend(roots);
        }
        let steps = body.steps(roots);
        body.count_uses(&steps, roots);
        for id in steps {
            body.step(id)?;
        }
        Ok(body)
    }

    /// The values this stage computes, operands first.
    fn steps(&self, roots: &[ValueId]) -> Vec<ValueId> {
        let prepare = matches!(self.access, Access::Prepare);
        self.program
            .reachable(roots)
            .into_iter()
            .filter(|id| self.program.value(*id).parameter_only == prepare)
            .collect()
    }

    fn count_uses(&mut self, steps: &[ValueId], roots: &[ValueId]) {
        for id in steps {
            let value = self.program.value(*id);
            let loops = value.extent != Extent::Scalar || matches!(value.op, Op::Total(_));
            for operand in value.op.operands() {
                *self.uses.entry(operand).or_insert(0) += 1;
                *self.in_loops.entry(operand).or_insert(false) |= loops;
            }
        }
        for root in roots {
            *self.uses.entry(*root).or_insert(0) += 1;
        }
    }

    /// The statements so far, a line each.
    pub fn statements(self) -> String {
        self.statements
    }

    /// Adds a statement of the caller's.
    pub fn push(&mut self, statement: &str) {
        self.statements.push_str(statement);
        self.statements.push('\n');
    }

    /// Adds a loop over `index` with one statement in it.
    pub fn push_loop(&mut self, index: &str, length: usize, statement: &str) {
        self.statements
            .push_str(&looped(index, length, &format!("{statement}\n")));
    }

    /// Adds a vector filled element by element.
    fn push_filled(&mut self, name: &str, length: usize, statement: &str) {
        self.push(&format!("let mut {name} = [T::number(0.0); {length}];"));
        self.push_loop("i", length, statement);
    }

    /// Prefers a name for a value of this stage.
    fn bind(&mut self, id: ValueId, expression: &Expression) -> Emitted<()> {
        let name = self.names.of(self.program, id, "s")?;
        self.push(&assignment(&format!("let {name}"), expression));
        self.bound.insert(id, name);
        Ok(())
    }

    fn step(&mut self, id: ValueId) -> Emitted<()> {
        let value = self.program.value(id);
        let uses = self.uses.get(&id).copied().unwrap_or(0);
        match (&value.op, value.extent) {
            (
                Op::Constant(_)
                | Op::Table(_)
                | Op::ModeCoordinates(_)
                | Op::ModeRates(_)
                | Op::Time,
                _,
            ) => Ok(()),
            (Op::Argument(..), Extent::Vector(_)) => Ok(()),
            (
                Op::Coordinate(_)
                | Op::Rate(_)
                | Op::Input(_)
                | Op::Parameter(_)
                | Op::Argument(..),
                _,
            ) => {
                let expression = self.leaf(id)?;
                let name = self.leaf_name(id);
                let name = self.names.assign(id, &name, "s")?;
                self.push(&assignment(&format!("let {name}"), expression));
                self.bound.insert(id, name);
                Ok(())
            }
            (_, Extent::Scalar) => self.scalar_step(id, uses),
            (_, Extent::Vector(length)) => self.vector_step(id, uses, length),
            (_, Extent::Matrix(rows, columns)) => self.matrix_step(id, rows, columns),
        }
    }

    fn leaf_name(&self, id: ValueId) -> String {
        let program = self.program;
        match program.value(id).op {
            Op::Coordinate(index) => program.coordinates[index].name.clone(),
            Op::Rate(index) => format!("{}_dot", program.coordinates[index].name),
            Op::Input(index) => program.inputs[index].name.clone(),
            Op::Parameter(place) => program.parameters[place].quantity.name.clone(),
            _ => String::from("s"),
        }
    }

    fn scalar_step(&mut self, id: ValueId, uses: usize) -> Emitted<()> {
        let value = self.program.value(id);
        if let Op::Total(vector) = value.op {
            return self.total(id, vector);
        }
        let expression = self.own_expression(id, None)?;
        let looped = self.in_loops.get(&id).copied().unwrap_or(false);
        if uses > 1 || value.name.is_some() || looped || expression.size > EXPRESSION_SIZE {
            self.bind(id, &expression)
        } else {
            Ok(())
        }
    }

    fn total(&mut self, id: ValueId, vector: ValueId) -> Emitted<()> {
        let name = self.names.of(self.program, id, "s")?;
        let length = self.program.value(vector).extent.length();
        let element = self.element(vector)?;
        let function = if length > PARTIAL_SUMS {
            self.needed.sum = true;
            "sum"
        } else {
            self.needed.sum_of_few = true;
            "sum_of_few"
        };
        let sum = Expression::sum(function, length, &element);
        self.push(&assignment(&format!("let {name}"), sum));
        self.bound.insert(id, name);
        Ok(())
    }

    fn vector_step(&mut self, id: ValueId, uses: usize, length: usize) -> Emitted<()> {
        let elementwise = is_elementwise(&self.program.value(id).op);
        let as_array = self.arrays.contains(&id) || self.is_operand_of_matrix(id);
        if elementwise && uses <= 1 && !as_array {
            let expression = self.own_expression(id, Some("i"))?;
            if expression.size <= EXPRESSION_SIZE {
                return Ok(());
            }
        }
        if let Op::CholeskySolve(factor, vector) = self.program.value(id).op {
            self.needed.cholesky = true;
            let name = self.names.of(self.program, id, "s")?;
            let factor = reference(self.numbers(factor)?);
            let vector = reference(self.vector_array(vector, length)?);
            let solution = Expression::call("cholesky_solve", &[factor, vector]);
            self.push(&assignment(&format!("let {name}"), solution));
            self.bound.insert(id, name);
            return Ok(());
        }
        if elementwise {
            let element = self.element(id)?;
            let name = self.names.of(self.program, id, "s")?;
            self.push_filled(&name, length, &assignment(&format!("{name}[i]"), element));
            self.bound.insert(id, name);
            return Ok(());
        }
        let (statement, name) = self.summed_element(id)?;
        self.push_filled(&name, length, statement.trim_end());
        self.bound.insert(id, name);
        Ok(())
    }

    /// Matrix operations read their vectors as arrays.
    fn is_operand_of_matrix(&self, id: ValueId) -> bool {
        self.program.values.iter().any(|value| {
            !is_elementwise(&value.op)
                && !matches!(value.op, Op::Total(_))
                && value.op.operands().contains(&id)
        })
    }

    /// A vector as a whole array, copied where it is none; a scalar stands for every element.
    fn vector_array(&mut self, id: ValueId, length: usize) -> Emitted<String> {
        if self.program.value(id).extent == Extent::Scalar {
            let value = self.scalar(id)?;
            return Ok(format!("[{value}; {length}]"));
        }
        if let Ok(array) = self.numbers(id) {
            return Ok(array);
        }
        let element = self.element(id)?;
        let name = self.names.of(self.program, id, "s")?;
        self.push_filled(&name, length, &assignment(&format!("{name}[i]"), element));
        Ok(name)
    }
}

/// A loop of these lines.
pub(super) fn looped(index: &str, length: usize, lines: &str) -> String {
    block(&format!("for {index} in 0..{length} {{"), lines, "}")
}

/// Whether each element depends on the operands' elements of the same index alone.
fn is_elementwise(op: &Op) -> bool {
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
