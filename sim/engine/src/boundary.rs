//! Functions for scripts. A script passes addresses in the engine's memory, which it reads and writes between calls.
//!
//! Emitted modules use the same memory. The script imports their functions to the engine as `host.prepare`,
//! `host.rates`, `host.observables` and `host.guards`, with the module number as first argument.

#![allow(unsafe_code)]

use std::sync::Arc;

use eomgen_codegen::program::Program;
use eomgen_codegen::program::evaluator::MachineCode;
use eomgen_compiled_model::ExportedCode;

use crate::module_code::{Array, ModuleCode, ModuleFunctions};
use crate::page_motion::{PageMotion, Status};

#[link(wasm_import_module = "host")]
unsafe extern "C" {
    fn prepare(module: u32);
    fn rates(module: u32, t: f64);
    fn observables(module: u32, t: f64);
    fn guards(module: u32, t: f64);
}

/// Addresses of the arrays of an emitted module, in the order of [`Array`].
type Addresses = [usize; 6];

/// Emitted module that uses the engine's memory.
struct SharedModule {
    number: u32,
    at: Addresses,
}

// SAFETY: all four functions call a module that the script attached under this number.
impl ModuleFunctions for SharedModule {
    fn prepare(&self) {
        unsafe { prepare(self.number) }
    }

    fn rates(&self, t: f64) {
        unsafe { rates(self.number, t) }
    }

    fn observables(&self, t: f64) {
        unsafe { observables(self.number, t) }
    }

    fn guards(&self, t: f64) {
        unsafe { guards(self.number, t) }
    }

    fn write(&self, array: Array, numbers: &[f64]) {
        let to = self.at[array as usize] as *mut f64;
        // SAFETY: the module's array has an element for each quantity of its program, as `numbers` has, and
        // nothing else refers to it.
        unsafe { to.copy_from_nonoverlapping(numbers.as_ptr(), numbers.len()) }
    }

    fn read(&self, array: Array, numbers: &mut [f64]) {
        let from = self.at[array as usize] as *const f64;
        // SAFETY: see `write`.
        unsafe { from.copy_to_nonoverlapping(numbers.as_mut_ptr(), numbers.len()) }
    }
}

/// Reserves memory for `bytes` bytes, at a multiple of 8, until the page is closed.
#[unsafe(no_mangle)]
extern "C" fn reserve(bytes: usize) -> *mut f64 {
    vec![0.0; bytes.div_ceil(8)].leak().as_mut_ptr()
}

/// Creates a motion of the exported model in these bytes; returns null if they are damaged.
///
/// # Safety
/// The bytes are from [`reserve`].
#[unsafe(no_mangle)]
unsafe extern "C" fn create(bytes: *const u8, length: usize, tolerance: f64) -> *mut PageMotion {
    // SAFETY: by the contract of this function.
    let bytes = unsafe { std::slice::from_raw_parts(bytes, length) };
    let made = PageMotion::new(bytes, tolerance);
    made.map_or(std::ptr::null_mut(), |made| Box::into_raw(Box::new(made)))
}

/// Uses emitted modules for the model's programs: module 0 for the program itself, module 1 for the program
/// with sides. `addresses` has six addresses for each module, in the order of [`Array`].
///
/// # Safety
/// The motion is from [`create`], and the addresses are those of modules of its programs.
#[unsafe(no_mangle)]
unsafe extern "C" fn attach(motion: *mut PageMotion, addresses: *const Addresses) {
    // SAFETY: by the contract of this function.
    let motion = unsafe { &mut *motion };
    let attached = |number: u32, program: &Program| {
        // SAFETY: by the contract of this function.
        let at = unsafe { *addresses.add(number as usize) };
        let code = ModuleCode::new(program, SharedModule { number, at });
        Arc::new(code) as Arc<dyn MachineCode>
    };
    let model = motion.model();
    let code = ExportedCode {
        program: Some(attached(0, model.program())),
        sided: model.sided_program().map(|program| attached(1, program)),
    };
    motion.set_code(code);
}

/// Exports functions that act on a motion.
macro_rules! export {
    ($($(#[$doc:meta])* $name:ident($motion:ident $(, $argument:ident: $kind:ty)*) -> $result:ty = $act:expr;)*) => {$(
        $(#[$doc])*
        ///
        /// # Safety
        /// The motion is from [`create`].
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $name($motion: *mut PageMotion $(, $argument: $kind)*) -> $result {
            // SAFETY: by the contract of this function.
            let $motion = unsafe { &mut *$motion };
            $act
        }
    )*};
}

export! {
    /// Returns the address of the independent parameters.
    parameters_at(motion) -> *mut f64 = motion.parameters.as_mut_ptr();
    /// Returns the address of the inputs.
    inputs_at(motion) -> *mut f64 = motion.inputs.as_mut_ptr();
    /// Returns the address of the signals.
    signals_at(motion) -> *mut f64 = motion.signals.as_mut_ptr();
    /// Returns the address of the state.
    state_at(motion) -> *mut f64 = motion.state.as_mut_ptr();
    /// Returns the address of the observables.
    observables_at(motion) -> *mut f64 = motion.observables.as_mut_ptr();
    /// Returns the time reached, s.
    time(motion) -> f64 = motion.time();
    /// Returns the number of events since the start.
    event_count(motion) -> usize = motion.event_count();
    /// Starts at a time, s; see [`PageMotion::start`].
    start(motion, t: f64) -> Status = motion.start(t);
    /// Applies the parameters from the time reached on.
    set_parameters(motion) -> Status = motion.set_parameters();
    /// Holds the inputs from the time reached on.
    hold(motion) -> Status = motion.hold();
    /// Drives the inputs by this number of signals from the time reached on.
    drive(motion, count: usize) -> Status = motion.drive(count);
    /// Continues to a time, s.
    advance(motion, until: f64) -> Status = motion.advance(until);
    /// Returns the address of the reason why the motion ended or cannot start, in UTF-8.
    reason_at(motion) -> *const u8 = motion.reason().as_ptr();
    /// Returns the length of the reason, in bytes.
    reason_length(motion) -> usize = motion.reason().len();
}
