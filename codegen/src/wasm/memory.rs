//! Where everything stands in the linear memory: one array of numbers after the other. Nothing is
//! allocated while the module runs.

use std::collections::HashMap;

use crate::program::{Extent, Program};
use crate::statements::{EmitError, Emitted, File};

/// Bytes of a number.
pub(super) const NUMBER: u32 = 8;

/// What a module may address: the places are signed 32-bit constants.
const MOST: u32 = i32::MAX as u32;

/// Bytes of a page, in which memories are counted.
const PAGE: u32 = 65536;

/// An array in the memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Region {
    /// The place of its first byte.
    pub(super) first: u32,
    /// Numbers in a row if it has two dimensions, else 1.
    pub(super) columns: usize,
}

impl Region {
    /// The place of a number.
    pub(super) fn at(self, place: usize) -> u32 {
        // Within a region, whose end was checked when it was allocated.
        self.first + NUMBER * place as u32
    }
}

/// What callers write to and read from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Exchanged {
    pub(super) parameters: Region,
    pub(super) inputs: Region,
    pub(super) state: Region,
    pub(super) rates: Region,
    pub(super) observables: Region,
    pub(super) guards: Region,
}

/// The memory of a module.
#[derive(Debug)]
pub(super) struct Memory {
    size: u32,
    pub(super) exchanged: Exchanged,
    coefficients: HashMap<String, Region>,
    tables: HashMap<String, Region>,
    parameters: HashMap<String, usize>,
    inputs: HashMap<String, usize>,
    /// Numbers that stand there from the beginning.
    pub(super) constants: Vec<(Region, Vec<f64>)>,
}

impl Memory {
    /// What every stage reads and writes.
    pub(super) fn new(file: &File<'_>) -> Emitted<Self> {
        let program = file.program;
        let mut size = 0;
        let mut vector = |length: usize| allocate(&mut size, Extent::Vector(length));
        let exchanged = Exchanged {
            parameters: vector(program.parameters.len())?,
            inputs: vector(program.inputs.len())?,
            state: vector(program.states())?,
            rates: vector(program.states())?,
            observables: vector(program.observables.len())?,
            guards: vector(file.guard_count())?,
        };
        let mut memory = Self {
            size,
            exchanged,
            coefficients: HashMap::new(),
            tables: HashMap::new(),
            parameters: places(program.parameters.iter().map(|p| &p.quantity.name)),
            inputs: places(program.inputs.iter().map(|input| &input.name)),
            constants: vec![(exchanged.parameters, program.default_parameters())],
        };
        for id in &file.fields {
            let region = memory.allocate(program.value(*id).extent)?;
            let name = file.field_names[id].clone();
            memory.coefficients.insert(name, region);
        }
        Ok(memory)
    }

    /// A further array.
    pub(super) fn allocate(&mut self, extent: Extent) -> Emitted<Region> {
        allocate(&mut self.size, extent)
    }

    /// Pages that hold everything.
    pub(super) fn pages(&self) -> u64 {
        u64::from(self.size.div_ceil(PAGE))
    }

    /// A table, which is put into the memory when it is first asked for.
    pub(super) fn table(&mut self, program: &Program, name: &str) -> Emitted<Region> {
        if let Some(known) = self.tables.get(name) {
            return Ok(*known);
        }
        let table = program.tables.iter().find(|table| table.name == name);
        let table = table.ok_or_else(|| nowhere(name))?;
        let region = self.allocate(table.extent)?;
        self.constants.push((region, table.values.clone()));
        self.tables.insert(name.to_owned(), region);
        Ok(region)
    }

    /// A coefficient.
    pub(super) fn coefficient(&self, name: &str) -> Emitted<Region> {
        let region = self.coefficients.get(name).copied();
        region.ok_or_else(|| nowhere(name))
    }

    /// The place of a parameter.
    pub(super) fn parameter(&self, name: &str) -> Emitted<u32> {
        let place = self.parameters.get(name).ok_or_else(|| nowhere(name))?;
        Ok(self.exchanged.parameters.at(*place))
    }

    /// The place of an input.
    pub(super) fn input(&self, name: &str) -> Emitted<u32> {
        let place = self.inputs.get(name).ok_or_else(|| nowhere(name))?;
        Ok(self.exchanged.inputs.at(*place))
    }
}

/// The end of what is allocated, moved behind an array of this extent.
fn allocate(size: &mut u32, extent: Extent) -> Emitted<Region> {
    let columns = match extent {
        Extent::Matrix(_, columns) => columns,
        Extent::Scalar | Extent::Vector(_) => 1,
    };
    let bytes = u32::try_from(extent.length())
        .ok()
        .and_then(|length| length.checked_mul(NUMBER));
    let end = bytes.and_then(|bytes| size.checked_add(bytes));
    let Some(end) = end.filter(|end| *end <= MOST) else {
        return Err(EmitError::Value(
            "its numbers do not fit into the memory of a module".to_owned(),
        ));
    };
    let first = std::mem::replace(size, end);
    Ok(Region { first, columns })
}

fn places<'n>(names: impl Iterator<Item = &'n String>) -> HashMap<String, usize> {
    let numbered = names.enumerate();
    numbered
        .map(|(place, name)| (name.clone(), place))
        .collect()
}

/// What has no place: a defect of the generator.
pub(super) fn nowhere(name: &str) -> EmitError {
    EmitError::Value(format!("`{name}` has no place in the module"))
}
