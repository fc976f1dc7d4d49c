//! Layout of the module's part of the linear memory: one array after the other. Addresses are relative to the start
//! of this part. No memory is allocated at run time.

use std::collections::HashMap;

use crate::program::{Extent, Program};
use crate::statements::{EmitError, EmitResult, File};

/// Size of a number, in bytes.
pub(super) const NUMBER: u32 = 8;

/// Largest address: addresses are signed 32-bit constants.
const MAX_ADDRESS: u32 = i32::MAX as u32;

/// Array in the memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Region {
    /// Address of its first byte.
    pub(super) first: u32,
    /// Length of a row for a matrix, else 1.
    pub(super) columns: usize,
}

impl Region {
    pub(super) fn address(self, place: usize) -> u32 {
        // No overflow: the end of the region was checked at allocation.
        self.first + NUMBER * place as u32
    }
}

/// Arrays that callers write and read.
#[derive(Clone, Copy, Debug)]
pub(super) struct ExchangedArray {
    pub(super) parameters: Region,
    pub(super) inputs: Region,
    pub(super) state: Region,
    pub(super) rates: Region,
    pub(super) observables: Region,
    pub(super) guards: Region,
}

#[derive(Debug)]
pub(super) struct Memory {
    size: u32,
    pub(super) exchanged: ExchangedArray,
    coefficients: HashMap<String, Region>,
    tables: HashMap<String, Region>,
    parameters: HashMap<String, usize>,
    inputs: HashMap<String, usize>,
    /// Initial content.
    pub(super) constants: Vec<(Region, Vec<f64>)>,
}

impl Memory {
    /// Allocates the arrays that stages read and write.
    pub(super) fn new(file: &File<'_>) -> EmitResult<Self> {
        let program = file.program;
        let mut size = 0;
        let mut vector = |length: usize| allocate(&mut size, Extent::Vector(length));
        let exchanged = ExchangedArray {
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
            parameters: assign_indices(program.parameters.iter().map(|p| &p.quantity.name)),
            inputs: assign_indices(program.inputs.iter().map(|input| &input.name)),
            constants: vec![(exchanged.parameters, program.default_parameters())],
        };
        for id in &file.fields {
            let region = memory.allocate(program.value(*id).extent)?;
            let name = file.field_names[id].clone();
            memory.coefficients.insert(name, region);
        }
        Ok(memory)
    }

    pub(super) fn allocate(&mut self, extent: Extent) -> EmitResult<Region> {
        allocate(&mut self.size, extent)
    }

    /// Returns the number of bytes.
    pub(super) fn size(&self) -> u32 {
        self.size
    }

    /// Returns the region of a table, which is allocated at its first use.
    pub(super) fn table(&mut self, program: &Program, name: &str) -> EmitResult<Region> {
        if let Some(known) = self.tables.get(name) {
            return Ok(*known);
        }
        let table = program.tables.iter().find(|table| table.name == name);
        let table = table.ok_or_else(|| missing_address_error(name))?;
        let region = self.allocate(table.extent)?;
        self.constants.push((region, table.values.clone()));
        self.tables.insert(name.to_owned(), region);
        Ok(region)
    }

    pub(super) fn coefficient(&self, name: &str) -> EmitResult<Region> {
        let region = self.coefficients.get(name).copied();
        region.ok_or_else(|| missing_address_error(name))
    }

    pub(super) fn parameter(&self, name: &str) -> EmitResult<u32> {
        let place = self
            .parameters
            .get(name)
            .ok_or_else(|| missing_address_error(name))?;
        Ok(self.exchanged.parameters.address(*place))
    }

    pub(super) fn input(&self, name: &str) -> EmitResult<u32> {
        let place = self
            .inputs
            .get(name)
            .ok_or_else(|| missing_address_error(name))?;
        Ok(self.exchanged.inputs.address(*place))
    }
}

/// Reserves an array of this extent at the end of the memory.
fn allocate(size: &mut u32, extent: Extent) -> EmitResult<Region> {
    let columns = match extent {
        Extent::Matrix(_, columns) => columns,
        Extent::Scalar | Extent::Vector(_) => 1,
    };
    let bytes = u32::try_from(extent.length())
        .ok()
        .and_then(|length| length.checked_mul(NUMBER));
    let end = bytes.and_then(|bytes| size.checked_add(bytes));
    let Some(end) = end.filter(|end| *end <= MAX_ADDRESS) else {
        return Err(EmitError::Value(
            "the data of the model exceed the 2 GiB memory of a WebAssembly module".to_owned(),
        ));
    };
    let first = std::mem::replace(size, end);
    Ok(Region { first, columns })
}

fn assign_indices<'n>(names: impl Iterator<Item = &'n String>) -> HashMap<String, usize> {
    let numbered = names.enumerate();
    numbered
        .map(|(place, name)| (name.clone(), place))
        .collect()
}

/// Returns the error for a name without an address: a defect of the generator.
pub(super) fn missing_address_error(name: &str) -> EmitError {
    EmitError::Value(format!(
        "`{name}` has no address in the memory of the module"
    ))
}
