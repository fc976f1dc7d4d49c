//! Compilation of all stages with Cranelift, and calls of the compiled code. Only this file contains `unsafe`.

use std::collections::HashMap;
use std::fmt;
use std::ops::Range;
use std::sync::Mutex;

use cranelift_codegen::Context;
use cranelift_codegen::ir::{AbiParam, InstBuilder, Signature, types};
use cranelift_codegen::settings::{self, Configurable};
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};
use cranelift_jit::{JITBuilder, JITModule};
use cranelift_module::{FuncId, Module, default_libcall_names};
use eomgen_codegen::program::Program;
use eomgen_codegen::program::evaluator::{MachineCode, Places, Point, Stage};

use crate::constants::Constants;
use crate::plan::{Plan, Task};
use crate::stage::{Call, Shared, Writer};

/// Reason why a program cannot be compiled.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CompileError {
    message: String,
}

impl CompileError {
    fn new(error: impl fmt::Display) -> Self {
        Self {
            message: error.to_string(),
        }
    }
}

impl fmt::Display for CompileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "no machine code: {}", self.message)
    }
}

impl std::error::Error for CompileError {}

type Function = unsafe extern "C" fn(*mut f64, f64, *const f64, *mut f64);

/// Machine code of every stage of one program.
pub struct Machine {
    /// Pieces of the preparation.
    prepare: Vec<Function>,
    /// Pieces of each stage, in the order of [`Stage::ALL`].
    stages: [Vec<Function>; Stage::ALL.len()],
    /// Memory after the values: the inputs, then the literals.
    room: Vec<f64>,
    /// Number of values that the functions access, counted from `memory`.
    reach: usize,
    /// Indices of the inputs in memory.
    inputs: std::ops::Range<usize>,
    states: usize,
    /// Owner of the code. The lock is needed because the module is `Send` but not `Sync`.
    module: Mutex<Option<JITModule>>,
}

/// Compiles every stage of a program.
///
/// # Errors
/// The processor architecture is not supported by Cranelift, the program is too large, or a value cannot be computed
/// in its stage.
pub fn compile(program: &Program) -> Result<Machine, CompileError> {
    let places = Places::new(program);
    let mut shared = Shared {
        program,
        places: &places,
        constants: Constants::default(),
        kernels: HashMap::new(),
    };
    // Displacements from a pointer are 32 bits wide.
    if places.size() > i32::MAX as usize / 16 {
        return Err(CompileError::new("the program is too large"));
    }
    let mut module = new_module()?;
    let mut contexts = (module.make_context(), FunctionBuilderContext::new());
    let mut define = |module: &mut JITModule, task| {
        let plan = Plan::new(program, task);
        let pieces = plan.pieces().into_iter();
        pieces
            .map(|piece| define(module, &mut contexts, &mut shared, (&plan, piece)))
            .collect::<Result<Vec<FuncId>, CompileError>>()
    };
    let prepare = define(&mut module, Task::Prepare)?;
    // Most programs lack optional outputs. A stage without roots needs no function.
    let mut stages = [const { Vec::new() }; Stage::ALL.len()];
    for (slot, stage) in stages.iter_mut().zip(Stage::ALL) {
        if stage == Stage::Rates || !stage.roots(program).is_empty() {
            *slot = define(&mut module, Task::PerCall(stage))?;
        }
    }
    module.finalize_definitions().map_err(CompileError::new)?;
    let inputs = shared.inputs()..shared.inputs() + program.inputs.len();
    let functions = |ids: Vec<FuncId>| ids.into_iter().map(|id| function(&module, id)).collect();
    let mut room = vec![0.0; shared.first_constant() - inputs.start];
    room.extend(shared.constants.numbers());
    Ok(Machine {
        prepare: functions(prepare),
        stages: stages.map(functions),
        reach: places.size() + room.len(),
        room,
        inputs,
        states: program.states(),
        module: Mutex::new(Some(module)),
    })
}

fn new_module() -> Result<JITModule, CompileError> {
    let mut flags = settings::builder();
    for (name, value) in [
        ("opt_level", "speed"),
        ("is_pic", "false"),
        ("use_colocated_libcalls", "false"),
        // Tests run with debug assertions, or compare every number.
        (
            "enable_verifier",
            if cfg!(debug_assertions) {
                "true"
            } else {
                "false"
            },
        ),
    ] {
        flags.set(name, value).map_err(CompileError::new)?;
    }
    let target = cranelift_native::builder().map_err(CompileError::new)?;
    let target = target
        .finish(settings::Flags::new(flags))
        .map_err(CompileError::new)?;
    let builder = JITBuilder::with_isa(target, default_libcall_names());
    Ok(JITModule::new(builder))
}

fn signature(module: &JITModule) -> Signature {
    let pointer = module.target_config().pointer_type();
    let mut signature = module.make_signature();
    let kinds = [pointer, types::F64, pointer, pointer];
    signature.params.extend(kinds.map(AbiParam::new));
    signature
}

fn define(
    module: &mut JITModule,
    (context, builders): &mut (Context, FunctionBuilderContext),
    shared: &mut Shared<'_>,
    piece: (&Plan, Range<usize>),
) -> Result<FuncId, CompileError> {
    context.func.signature = signature(module);
    let mut builder = FunctionBuilder::new(&mut context.func, builders);
    let entry = builder.create_block();
    builder.append_block_params_for_function_params(entry);
    builder.switch_to_block(entry);
    let &[memory, t, state, out] = builder.block_params(entry) else {
        return Err(CompileError::new("a function has four arguments"));
    };
    let call = Call {
        memory,
        t,
        state,
        out,
    };
    let mut writer = Writer::new(builder, shared, call, piece);
    writer.write();
    if let Some(defect) = writer.defect {
        return Err(CompileError::new(defect));
    }
    let mut builder = writer.builder;
    builder.ins().return_(&[]);
    builder.seal_all_blocks();
    builder.finalize(module.target_config());
    let id = module
        .declare_anonymous_function(&context.func.signature)
        .map_err(CompileError::new)?;
    module
        .define_function(id, context)
        .map_err(CompileError::new)?;
    module.clear_context(context);
    Ok(id)
}

#[allow(unsafe_code)]
fn function(module: &JITModule, id: FuncId) -> Function {
    let address = module.get_finalized_function(id);
    // SAFETY: the function was declared with `signature`, which is `Function` in the
    // platform's C convention, and the module is kept as long as the pointer.
    unsafe { std::mem::transmute::<*const u8, Function>(address) }
}

impl Machine {
    /// Calls the functions in order. `out` is used only for the rates and may be empty otherwise.
    #[allow(unsafe_code)]
    fn run(&self, functions: &[Function], memory: &mut [f64], point: &Point<'_>, out: &mut [f64]) {
        let memory = &mut memory[..self.reach];
        let inputs = &mut memory[self.inputs.clone()];
        for (place, input) in inputs.iter_mut().enumerate() {
            *input = point.inputs.get(place).copied().unwrap_or(0.0);
        }
        let (memory, state) = (memory.as_mut_ptr(), point.state.as_ptr());
        for function in functions {
            // SAFETY: the code reads and writes `reach` numbers at `memory` and reads `states` numbers at `state`.
            // Only for the rates, it writes `states` numbers at `out`. The bounds of loops are known when the code is
            // compiled. The callers check these lengths. The code calls no function and keeps no pointer.
            unsafe { function(memory, point.t, state, out.as_mut_ptr()) }
        }
    }
}

impl MachineCode for Machine {
    fn initial_memory(&self) -> &[f64] {
        &self.room
    }

    fn prepare(&self, memory: &mut [f64]) {
        let nowhere = Point {
            t: 0.0,
            state: &[],
            inputs: &[],
        };
        self.run(&self.prepare, memory, &nowhere, &mut []);
    }

    fn compute(&self, stage: Stage, memory: &mut [f64], point: &Point<'_>) {
        // The rates are written to `out`, not to memory.
        assert_ne!(stage, Stage::Rates);
        let point = Point {
            state: &point.state[..self.states],
            ..*point
        };
        self.run(&self.stages[stage as usize], memory, &point, &mut []);
    }

    fn rates(&self, memory: &mut [f64], point: &Point<'_>, out: &mut [f64]) {
        let point = Point {
            state: &point.state[..self.states],
            ..*point
        };
        let out = &mut out[..self.states];
        self.run(&self.stages[Stage::Rates as usize], memory, &point, out);
    }
}

impl Drop for Machine {
    #[allow(unsafe_code)]
    fn drop(&mut self) {
        let module = self.module.get_mut().map(Option::take);
        if let Ok(Some(module)) = module {
            // SAFETY: only this value contains pointers to the code, and it is being dropped.
            unsafe { module.free_memory() }
        }
    }
}
