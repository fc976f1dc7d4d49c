//! Function of one piece of a stage, and the storage of its values.
//!
//! Numbers are in registers. A vector that is used once is computed where it is used. A short vector with several
//! uses is in registers, a long one in memory. Operands and results of matrix operations are in memory, and so are
//! values that the evaluator or a later piece reads.

use std::collections::{HashMap, HashSet};
use std::ops::Range;
use std::rc::Rc;

use cranelift_codegen::ir::Value;
use cranelift_frontend::{FuncInstBuilder, FunctionBuilder};
use eomgen_codegen::program::evaluator::{Places, Stage};
use eomgen_codegen::program::{Extent, Op, Program, RowValues, ValueId};
use eomgen_elementary::{Function as Elementary, Kernel};
use eomgen_model_spec::ids::FieldId;

use crate::branches::Branches;
use crate::constants::Constants;
use crate::lanes::{Array, ElementRef, Lanes, MAX_REGISTER_VECTOR};
use crate::plan::{Plan, Task, is_elementwise};

/// Data shared by the functions of a program.
pub struct Shared<'a> {
    pub program: &'a Program,
    /// Positions of the values in memory.
    pub places: &'a Places,
    /// Literals of the functions written so far.
    pub constants: Constants,
    /// Recorded kernels with their branches.
    pub kernels: HashMap<Elementary, Rc<(Kernel, Branches)>>,
}

impl Shared<'_> {
    /// Returns the index of the first input, after the values.
    pub fn inputs(&self) -> usize {
        self.places.size()
    }

    /// Returns the index of the first literal. It is even, so that a literal and its copy are in one cache line.
    pub fn first_constant(&self) -> usize {
        (self.inputs() + self.program.inputs.len()).next_multiple_of(2)
    }
}

/// Arguments of a function.
#[derive(Clone, Copy, Debug)]
pub struct Call {
    /// Memory of the evaluator.
    pub memory: Value,
    /// Time.
    pub t: Value,
    /// State.
    pub state: Value,
    /// Array for the rates.
    pub out: Value,
}

/// Writer of the function of one piece.
pub struct Writer<'a, 'p, 'f> {
    pub(crate) builder: FunctionBuilder<'f>,
    pub(crate) shared: &'a mut Shared<'p>,
    pub(crate) program: &'p Program,
    pub(crate) call: Call,
    /// Bound numbers, in one lane.
    pub(crate) numbers: HashMap<ValueId, Value>,
    /// Bound numbers, in both lanes.
    pub(crate) broadcast: HashMap<ValueId, Value>,
    /// Short vectors in registers, two elements per register. If the length is odd, the last register contains one
    /// element.
    pub(crate) registers: HashMap<ValueId, Vec<Value>>,
    plan: &'a Plan,
    /// Range of the plan's steps that this function computes.
    piece: Range<usize>,
    /// Values of this stage that are stored in memory.
    stored: HashSet<ValueId>,
    /// Values of earlier pieces that this one reads.
    earlier: HashSet<ValueId>,
    /// Defect of the program, if one was found.
    pub(crate) defect: Option<String>,
}

impl<'a, 'p, 'f> Writer<'a, 'p, 'f> {
    /// Starts a function; its entry block must be current.
    pub fn new(
        builder: FunctionBuilder<'f>,
        shared: &'a mut Shared<'p>,
        call: Call,
        (plan, piece): (&'a Plan, Range<usize>),
    ) -> Self {
        Self {
            builder,
            program: shared.program,
            shared,
            call,
            numbers: HashMap::new(),
            broadcast: HashMap::new(),
            registers: HashMap::new(),
            plan,
            piece,
            stored: HashSet::new(),
            earlier: HashSet::new(),
            defect: None,
        }
    }

    pub(crate) fn instructions(&mut self) -> FuncInstBuilder<'_, 'f> {
        self.builder.ins()
    }

    /// Writes the body of the function without its return.
    pub fn write(&mut self) {
        let steps = &self.plan.steps[self.piece.clone()];
        let writes_rates = self.plan.task == Task::PerCall(Stage::Rates)
            && self.piece.end == self.plan.steps.len();
        let mut read = self.reads(steps);
        if writes_rates {
            read.extend(&self.plan.roots);
        }
        read.sort_unstable();
        read.dedup();
        self.find_earlier(&read);
        self.bind_leaves(&read);
        for id in steps {
            self.step(*id);
        }
        if writes_rates {
            self.write_rates();
        }
    }

    /// Returns the values that these steps read or compute.
    fn reads(&self, steps: &[ValueId]) -> Vec<ValueId> {
        let operands = |id: &ValueId| self.program.value(*id).op.operands();
        let operands = steps.iter().flat_map(operands);
        operands.chain(steps.iter().copied()).collect()
    }

    /// Determines the values that an earlier piece has computed and stored.
    fn find_earlier(&mut self, read: &[ValueId]) {
        let before = &self.plan.steps[..self.piece.start];
        // The steps are sorted by id, because operands have smaller ids.
        let is_earlier = |id: &&ValueId| before.binary_search(id).is_ok();
        self.earlier = read.iter().filter(is_earlier).copied().collect();
        self.stored.extend(&self.earlier);
    }

    /// Binds the numbers that this function does not compute. This happens before any loop.
    fn bind_leaves(&mut self, read: &[ValueId]) {
        for id in read {
            if self.program.value(*id).extent == Extent::Scalar
                && let Some(value) = self.leaf(*id)
            {
                self.bind(*id, value);
            }
        }
    }

    /// Loads a number that this function does not compute.
    fn leaf(&mut self, id: ValueId) -> Option<Value> {
        let program = self.program;
        let value = program.value(id);
        let (base, start) = match value.op {
            Op::Constant(number) => return Some(self.literal(number, Lanes::One)),
            Op::Time => return Some(self.call.t),
            Op::Coordinate(index) => (self.call.state, index.index()),
            Op::Rate(index) => (
                self.call.state,
                program.degrees_of_freedom() + index.index(),
            ),
            Op::State(index) => (
                self.call.state,
                2 * program.degrees_of_freedom() + index.index(),
            ),
            Op::Input(index) => (self.call.memory, self.shared.inputs() + index.index()),
            Op::Parameter(_) | Op::Argument(..) => {
                (self.call.memory, self.shared.places.offset(id))
            }
            _ if value.parameter_only && self.plan.task != Task::Prepare
                || self.earlier.contains(&id) =>
            {
                (self.call.memory, self.shared.places.offset(id))
            }
            _ => return None,
        };
        let array = Array {
            base,
            start,
            constant: true,
        };
        Some(self.load(array, ElementRef::single(0)))
    }

    /// Returns the array of a value that is in memory.
    pub(crate) fn array(&self, id: ValueId) -> Option<Array> {
        let program = self.program;
        let value = program.value(id);
        let state = |start| Array {
            base: self.call.state,
            start,
            constant: true,
        };
        match value.op {
            Op::ModeCoordinates(field) => Some(state(program.mode_offset(field))),
            Op::ModeRates(field) => Some(state(
                program.degrees_of_freedom() + program.mode_offset(field),
            )),
            _ => {
                let constant = matches!(
                    value.op,
                    Op::Table(_) | Op::Constant(_) | Op::Parameter(_) | Op::Argument(..)
                ) || value.parameter_only && self.plan.task != Task::Prepare;
                (constant || self.stored.contains(&id)).then(|| Array {
                    constant,
                    ..self.place(id)
                })
            }
        }
    }

    pub(crate) fn place(&self, id: ValueId) -> Array {
        Array {
            base: self.call.memory,
            start: self.shared.places.offset(id),
            constant: false,
        }
    }

    fn step(&mut self, id: ValueId) {
        let value = self.program.value(id);
        let length = value.extent.length();
        match value.op {
            Op::Constant(_)
            | Op::Table(_)
            | Op::Parameter(_)
            | Op::Coordinate(_)
            | Op::Rate(_)
            | Op::State(_)
            | Op::Input(_)
            | Op::Time => self.store_leaf(id),
            // The evaluator has stored the argument.
            Op::Argument(..) => {}
            Op::ModeCoordinates(_) | Op::ModeRates(_) => self.copy_vector(id, length),
            Op::Total(vector) => {
                let total = self.total(vector);
                self.bind_and_store(id, total);
            }
            _ if !is_elementwise(&value.op) => {
                self.matrix_operation(id);
                self.stored.insert(id);
                if value.extent == Extent::Scalar {
                    let number = self.load(self.place(id), ElementRef::single(0));
                    self.bind(id, number);
                }
            }
            _ if value.extent == Extent::Scalar => {
                let number = self.compute_element(id, ElementRef::single(0));
                self.bind_and_store(id, number);
            }
            _ => self.vector(id, length),
        }
    }

    /// Stores a leaf of the state that the evaluator reads from memory.
    fn store_leaf(&mut self, id: ValueId) {
        if self.plan.task != Task::Prepare && self.plan.wanted.contains(&id) {
            let number = self.number(id, Lanes::One);
            let place = self.place(id);
            self.store(number, place, ElementRef::single(0));
        }
    }

    fn copy_vector(&mut self, id: ValueId, length: usize) {
        if self.plan.roots.contains(&id) && self.plan.wanted.contains(&id) {
            let place = self.place(id);
            self.loop_over_elements(length, |writer, at| {
                let value = writer.element(id, at);
                writer.store(value, place, at);
            });
        }
    }

    fn bind_and_store(&mut self, id: ValueId, number: Value) {
        self.bind(id, number);
        if self.plan.wanted.contains(&id) {
            let place = self.place(id);
            self.store(number, place, ElementRef::single(0));
            self.stored.insert(id);
        }
    }

    fn vector(&mut self, id: ValueId, length: usize) {
        let (wanted, used_once) = (
            self.plan.wanted.contains(&id),
            self.plan.uses.get(&id) <= Some(&1),
        );
        if used_once && !wanted {
            return;
        }
        let place = self.place(id);
        if length <= MAX_REGISTER_VECTOR && self.plan.task != Task::Prepare {
            self.keep(id, length);
            if wanted {
                self.loop_over_elements(length, |writer, at| {
                    let value = writer.element(id, at);
                    writer.store(value, place, at);
                });
                self.stored.insert(id);
            }
        } else {
            self.fill(id, place, length);
            self.stored.insert(id);
        }
    }

    /// Writes the rates: first the velocities, copied from the state, then the accelerations and the rates of
    /// first-order states.
    fn write_rates(&mut self) {
        let degrees = self.program.degrees_of_freedom();
        let velocities = Array {
            base: self.call.state,
            start: degrees,
            constant: true,
        };
        let mut out = Array {
            base: self.call.out,
            start: 0,
            constant: false,
        };
        self.loop_over_elements(degrees, |writer, at| {
            let velocity = writer.load(velocities, at);
            writer.store(velocity, out, at);
        });
        let RowValues { scalars, modal } = &self.program.accelerations;
        for (row, id) in scalars.iter().enumerate() {
            let number = self.number(*id, Lanes::One);
            out.start = degrees + row;
            self.store(number, out, ElementRef::single(0));
        }
        for (place, id) in self.program.first_order_rates.iter().enumerate() {
            let number = self.number(*id, Lanes::One);
            out.start = 2 * degrees + place;
            self.store(number, out, ElementRef::single(0));
        }
        for (field, id) in FieldId::first(modal.len()).zip(modal) {
            out.start = degrees + self.program.mode_offset(field);
            self.loop_over_elements(self.program.fields[field].order, |writer, at| {
                let value = writer.element(*id, at);
                writer.store(value, out, at);
            });
        }
    }
}
