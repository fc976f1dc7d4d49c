//! WebAssembly module: functions, memory and exports.

use wasm_encoder::{
    CodeSection, ConstExpr, DataCountSection, DataSection, ExportKind, ExportSection, Function,
    FunctionSection, GlobalSection, GlobalType, ImportSection, MemoryType, Module, StartSection,
    TypeSection, ValType,
};

use super::code::{BASE, Code};
use super::functions::{Helper, build_helpers};
use super::indices::Indices;
use super::memory::{Memory, NUMBER, Region};
use super::names::WORDS;
use crate::program::Program;
use crate::statements::{
    EmitError, EmitResult, File, Index, Outcome, Place, Preparation, PreparedValue,
    RequiredFunctions, Stage, Statement, UsedNames, build_guards, build_observables,
    build_preparation, build_rates,
};

/// WebAssembly module of a program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EmittedModule {
    /// Content of the file.
    pub bytes: Vec<u8>,
    /// Size of the memory that the module needs, in bytes.
    pub size: usize,
}

/// Writes a program as a WebAssembly module.
///
/// It imports from `host` a `memory` and the constant global `base`, the address of its own part of that memory: `size`
/// bytes, a multiple of 8 like the address. Modules can share a memory with a host. It exports the functions
///
/// * `prepare() -> i32`: computes the coefficients from the parameters; returns 1 if all prepared pivots of
///   the mass matrix are positive and finite. The parameters are initially those of the specification;
/// * `rates(t)`: computes the rates of the state from state and inputs;
/// * `observables(t)`: computes the observables, with energy and power last;
/// * `guards(t)`, if there are any: computes the switching surfaces.
///
/// The constant globals `parameters_at`, `inputs_at`, `state_at`, `rates_at`, `observables_at` and `guards_at` are
/// the addresses of the arrays that these functions read and write, in bytes from `base`. The numbers have the order
/// of the program. `size` is a constant global, too.
///
/// # Errors
/// The program exceeds the memory of a module.
pub fn emit(program: &Program) -> Result<EmittedModule, EmitError> {
    let file = File::new(program, &WORDS)?;
    let mut needed = RequiredFunctions::default();
    let prepared = build_preparation(&file, &mut needed)?;
    let mut stages = vec![build_rates(&file, &mut needed)?];
    stages.extend(build_observables(&file, &mut needed)?.into_iter().take(1));
    if file.guard_count() > 0 {
        stages.push(build_guards(&file, &mut needed)?);
    }
    let helpers = build_helpers(&needed);
    let functions = Indices::new(helpers.iter().map(|helper| helper.name));
    let mut memory = Memory::new(&file)?;
    let mut written = Vec::new();
    for helper in &helpers {
        written.push(helper.function(program, &mut memory, &functions)?);
    }
    written.push(write_preparation(&file, prepared, &mut memory, &functions)?);
    let mut exported = vec!["prepare"];
    for stage in stages {
        exported.push(exported_name(&stage));
        written.push(write_stage(program, stage, &mut memory, &functions)?);
    }
    Ok(EmittedModule {
        bytes: assemble_module(&helpers, &exported, &written, &memory),
        size: memory.size() as usize,
    })
}

fn exported_name(stage: &Stage) -> &'static str {
    match stage.outcome {
        Outcome::Rates => "rates",
        _ => stage.name,
    }
}

fn write_preparation(
    file: &File<'_>,
    prepared: Preparation,
    memory: &mut Memory,
    functions: &Indices,
) -> EmitResult<Function> {
    let program = file.program;
    let mut used = UsedNames::from_preparation(&prepared);
    let computed = used.retain(prepared.computed);
    let mut code = Code::new(program, memory, functions, &[]);
    code.statements(&computed)?;
    for (id, coefficient) in file.fields.iter().zip(&prepared.coefficients) {
        // These names contain a space, so no name of a model is equal to them.
        let (target, source) = ("the coefficient", "what was prepared");
        let region = code.memory.coefficient(&file.field_names[id])?;
        code.name_array(target, region);
        match coefficient {
            PreparedValue::Number(value) => {
                code.assign(&Place::new(target, [Index::Number(0)]), value)?;
            }
            // Both arrays have the same extent and are copied number by number.
            PreparedValue::Numbers(array) => {
                let from = Region {
                    columns: 1,
                    ..code.region_of(array)?
                };
                let extent = program.value(*id).extent;
                code.name_array(
                    target,
                    Region {
                        columns: 1,
                        ..region
                    },
                );
                code.name_array(source, from);
                let place = Place::new(source, [Index::Variable("i")]);
                let copy = Statement::Assign(Place::new(target, ["i".into()]), place.value());
                code.statements(&[Statement::loop_over_elements(extent.length(), copy)])?;
            }
        }
    }
    code.expression(&prepared.positive_definite)?;
    Ok(code.finish())
}

fn write_stage(
    program: &Program,
    stage: Stage,
    memory: &mut Memory,
    functions: &Indices,
) -> EmitResult<Function> {
    let exchanged = memory.exchanged;
    let mut used = UsedNames::from_outcome(&stage.outcome);
    let written = used.retain(stage.written);
    let computed = used.retain(stage.computed);
    let mut code = Code::new(program, memory, functions, &["t"]);
    for (name, region) in [
        ("state", exchanged.state),
        ("rates", exchanged.rates),
        ("observables", exchanged.observables),
        ("values", exchanged.guards),
    ] {
        code.name_array(name, region);
    }
    code.statements(&computed)?;
    if let Outcome::Observables(values) = &stage.outcome {
        for (place, value) in values.iter().enumerate() {
            code.assign(&Place::new("observables", [Index::Number(place)]), value)?;
        }
    }
    code.statements(&written)?;
    Ok(code.finish())
}

/// Assembles the sections of a module; helpers precede the exported functions.
fn assemble_module(
    helpers: &[Helper],
    exported: &[&str],
    written: &[Function],
    memory: &Memory,
) -> Vec<u8> {
    const REAL: ValType = ValType::F64;
    let mut types = TypeSection::new();
    types.ty().function([REAL], [REAL]);
    types.ty().function([REAL, REAL], [REAL]);
    types.ty().function([], [ValType::I32]);
    types.ty().function([REAL], []);
    types.ty().function([], []);
    let constant = GlobalType {
        val_type: ValType::I32,
        mutable: false,
        shared: false,
    };
    let mut imports = ImportSection::new();
    let host_memory = MemoryType {
        minimum: 0,
        maximum: None,
        memory64: false,
        shared: false,
        page_size_log2: None,
    };
    imports.import("host", "memory", host_memory);
    imports.import("host", "base", constant);
    let mut functions = FunctionSection::new();
    for helper in helpers {
        functions.function(u32::from(helper.arguments.len() > 1));
    }
    let mut exports = ExportSection::new();
    for (name, index) in exported.iter().zip(helpers.len() as u32..) {
        functions.function(if *name == "prepare" { 2 } else { 3 });
        exports.export(name, ExportKind::Func, index);
    }
    functions.function(4);
    let start = StartSection {
        function_index: written.len() as u32,
    };
    let mut globals = GlobalSection::new();
    let addresses = exported_regions(memory).map(|(name, region)| (name, region.first));
    let numbers = addresses.into_iter().chain([("size", memory.size())]);
    for (index, (name, number)) in (BASE + 1..).zip(numbers) {
        globals.global(constant, &ConstExpr::i32_const(number as i32));
        exports.export(name, ExportKind::Global, index);
    }
    let mut code = CodeSection::new();
    for function in written {
        code.function(function);
    }
    code.function(&write_constants(memory));
    let mut data = DataSection::new();
    for (_, numbers) in &memory.constants {
        let bytes = numbers.iter().flat_map(|number| number.to_le_bytes());
        data.passive(bytes.collect::<Vec<u8>>());
    }
    let counted = DataCountSection { count: data.len() };
    let mut module = Module::new();
    module.section(&types).section(&imports).section(&functions);
    module.section(&globals).section(&exports).section(&start);
    module.section(&counted).section(&code).section(&data);
    module.finish()
}

/// Writes the start function of the module, which copies the constants to their addresses.
fn write_constants(memory: &Memory) -> Function {
    let mut function = Function::new([]);
    let mut put = function.instructions();
    for (place, (region, numbers)) in (0..).zip(&memory.constants) {
        put.global_get(BASE)
            .i32_const(region.first as i32)
            .i32_add();
        put.i32_const(0)
            .i32_const((NUMBER as usize * numbers.len()) as i32);
        put.memory_init(0, place);
    }
    put.end();
    function
}

/// Returns the regions of the exported globals.
fn exported_regions(memory: &Memory) -> [(&'static str, Region); 6] {
    let exchanged = memory.exchanged;
    [
        ("parameters_at", exchanged.parameters),
        ("inputs_at", exchanged.inputs),
        ("state_at", exchanged.state),
        ("rates_at", exchanged.rates),
        ("observables_at", exchanged.observables),
        ("guards_at", exchanged.guards),
    ]
}
