//! Function under construction: instructions, variables and named arrays.

use std::collections::HashMap;

use wasm_encoder::{BlockType, Function, InstructionSink, MemArg, MemArgTarget, ValType};

use super::indices::Indices;
use super::memory::{Memory, NUMBER, Region, missing_address_error};
use crate::program::{Extent, Program};
use crate::statements::{EmitError, EmitResult, Index, Span};

/// Index of the imported global variable that contains the address of the module's memory.
pub(super) const BASE: u32 = 0;

/// Binary logarithm of the size of a number in bytes, for alignment.
const ALIGNMENT: u32 = NUMBER.trailing_zeros();

pub(super) struct Code<'m> {
    pub(super) program: &'m Program,
    pub(super) memory: &'m mut Memory,
    pub(super) functions: &'m Indices,
    bytes: Vec<u8>,
    arguments: u32,
    /// Types of the variables other than arguments.
    types: Vec<ValType>,
    variables: HashMap<String, u32>,
    arrays: HashMap<String, Region>,
}

impl<'m> Code<'m> {
    pub(super) fn new(
        program: &'m Program,
        memory: &'m mut Memory,
        functions: &'m Indices,
        arguments: &[&str],
    ) -> Self {
        let names = (0..).zip(arguments);
        Self {
            program,
            memory,
            functions,
            bytes: Vec::new(),
            arguments: arguments.len() as u32,
            types: Vec::new(),
            variables: names.map(|(at, name)| ((*name).to_owned(), at)).collect(),
            arrays: HashMap::new(),
        }
    }

    pub(super) fn name_array(&mut self, name: &str, region: Region) {
        self.arrays.insert(name.to_owned(), region);
    }

    pub(super) fn finish(mut self) -> Function {
        self.instructions().end();
        let mut function = Function::new_with_locals_types(self.types);
        function.raw(self.bytes);
        function
    }

    pub(super) fn instructions(&mut self) -> InstructionSink<'_> {
        InstructionSink::new(&mut self.bytes)
    }

    fn variable(&mut self, of: ValType) -> u32 {
        let place = self.arguments + self.types.len() as u32;
        self.types.push(of);
        place
    }

    pub(super) fn number(&mut self, name: &str) -> u32 {
        let variable = self.variable(ValType::F64);
        self.variables.insert(name.to_owned(), variable);
        variable
    }

    pub(super) fn flag(&mut self, name: &str) -> u32 {
        let variable = self.variable(ValType::I32);
        self.variables.insert(name.to_owned(), variable);
        variable
    }

    pub(super) fn local_index(&self, name: &str) -> EmitResult<u32> {
        let variable = self.variables.get(name).copied();
        variable.ok_or_else(|| missing_address_error(name))
    }

    /// Allocates a named array; its content is undefined.
    pub(super) fn array(&mut self, name: &str, lengths: &[usize]) -> EmitResult<Region> {
        let extent = match *lengths {
            [rows, columns] => Extent::Matrix(rows, columns),
            _ => Extent::Vector(lengths.iter().product()),
        };
        let region = self.memory.allocate(extent)?;
        self.name_array(name, region);
        Ok(region)
    }

    pub(super) fn region(&self, name: &str) -> EmitResult<Region> {
        let region = self.arrays.get(name).copied();
        region.ok_or_else(|| missing_address_error(name))
    }

    pub(super) fn zero(&mut self, region: Region, length: usize) -> EmitResult<()> {
        if length > 0 {
            let (first, bytes) = (to_signed(region.first)?, to_signed(length as u32 * NUMBER)?);
            let mut put = self.instructions();
            put.global_get(BASE)
                .i32_const(first)
                .i32_add()
                .i32_const(0)
                .i32_const(bytes)
                .memory_fill(0);
        }
        Ok(())
    }

    /// Writes a loop over a variable between two numbers.
    pub(super) fn write_loop(
        &mut self,
        index: &'static str,
        (from, to): (usize, usize),
        lines: impl FnOnce(&mut Self) -> EmitResult<()>,
    ) -> EmitResult<()> {
        if from >= to {
            return Ok(());
        }
        let (from, to) = (to_i32(from)?, to_i32(to)?);
        let (variable, outer) = self.loop_variable(index);
        self.instructions().i32_const(from).local_set(variable);
        self.instructions().loop_(BlockType::Empty);
        lines(self)?;
        let mut put = self.instructions();
        put.local_get(variable).i32_const(1).i32_add();
        put.local_tee(variable).i32_const(to).i32_lt_s();
        put.br_if(0).end();
        self.restore(index, outer);
        Ok(())
    }

    /// Writes a loop over a variable.
    pub(super) fn write_loop_over(
        &mut self,
        index: &'static str,
        span: &Span,
        lines: impl FnOnce(&mut Self) -> EmitResult<()>,
    ) -> EmitResult<()> {
        let step = match (span.numbers(), span.reversed) {
            (Some(numbers), false) => return self.write_loop(index, numbers, lines),
            (_, false) => {
                self.index(&span.from)?;
                1
            }
            (_, true) => {
                self.index(&span.to)?;
                self.instructions().i32_const(1).i32_sub();
                -1
            }
        };
        let (variable, outer) = self.loop_variable(index);
        let mut put = self.instructions();
        put.local_set(variable).block(BlockType::Empty);
        put.loop_(BlockType::Empty).local_get(variable);
        if span.reversed {
            self.index(&span.from)?;
            self.instructions().i32_lt_s().br_if(1);
        } else {
            self.index(&span.to)?;
            self.instructions().i32_ge_s().br_if(1);
        }
        lines(self)?;
        let mut put = self.instructions();
        put.local_get(variable).i32_const(step).i32_add();
        put.local_set(variable).br(0).end().end();
        self.restore(index, outer);
        Ok(())
    }

    /// Declares a loop variable. Returns its index, and the index of the outer variable of the same name.
    fn loop_variable(&mut self, index: &str) -> (u32, Option<u32>) {
        let variable = self.variable(ValType::I32);
        (variable, self.variables.insert(index.to_owned(), variable))
    }

    fn restore(&mut self, index: &str, outer: Option<u32>) {
        match outer {
            Some(outer) => self.variables.insert(index.to_owned(), outer),
            None => self.variables.remove(index),
        };
    }

    pub(super) fn index(&mut self, index: &Index) -> EmitResult<()> {
        match index {
            Index::Number(number) => {
                let number = to_i32(*number)?;
                self.instructions().i32_const(number);
            }
            Index::Variable(name) => {
                let variable = self.local_index(name)?;
                self.instructions().local_get(variable);
            }
            Index::Sum(a, b) => {
                self.index(a)?;
                self.index(b)?;
                self.instructions().i32_add();
            }
            Index::Product(a, b) => {
                self.index(a)?;
                self.index(b)?;
                self.instructions().i32_mul();
            }
        }
        Ok(())
    }

    /// Pushes the address of an element, relative to the returned offset of a load or store.
    pub(super) fn address(&mut self, region: Region, indices: &[Index]) -> EmitResult<MemArg> {
        let place = match indices {
            [place] => place.clone(),
            [row, column] => {
                Index::from_multiple(region.columns, row.clone()).offset_by(column.clone())
            }
            _ => {
                return Err(EmitError::Value(
                    "an array element must have one or two indices".into(),
                ));
            }
        };
        // A constant address is part of the instruction.
        let from = if let Index::Number(number) = place {
            self.instructions().global_get(BASE);
            region.address(number)
        } else {
            self.index(&place)?;
            let mut put = self.instructions();
            put.i32_const(ALIGNMENT as i32).i32_shl();
            put.global_get(BASE).i32_add();
            region.first
        };
        Ok(aligned(from))
    }

    /// Pushes the number at a fixed address.
    pub(super) fn load(&mut self, address: u32) {
        self.instructions()
            .global_get(BASE)
            .f64_load(aligned(address));
    }
}

/// Returns the memory argument of a load or store at an address.
fn aligned(from: u32) -> MemArg {
    MemArg {
        offset: u64::from(from),
        align: ALIGNMENT,
        target: MemArgTarget::Memory(0),
        ordering: None,
    }
}

fn to_i32(number: usize) -> EmitResult<i32> {
    i32::try_from(number).map_err(|_| too_large(number))
}

fn to_signed(number: u32) -> EmitResult<i32> {
    i32::try_from(number).map_err(|_| too_large(number as usize))
}

fn too_large(number: usize) -> EmitError {
    EmitError::Value(format!("the index {number} exceeds 32 bits"))
}
