//! C interface of a controller library, as in `eomgen_controller.h`. Only this module has unsafe code.
//!
//! Rust cannot check code in another language, so a library is trusted like a program that you start. It must define
//! the three functions of the header with the given types, write only to the memory given for its results, and not
//! unwind.
#![allow(unsafe_code)]

use std::ffi::{CString, c_char};
use std::path::Path;

use libloading::{Library, Symbol};

/// Names of a model, as pointers.
#[repr(C)]
struct RawModel {
    states: u32,
    observables: u32,
    inputs: u32,
    state_names: *const *const c_char,
    observable_names: *const *const c_char,
    input_names: *const *const c_char,
}

/// Times and driven inputs of a controller. `driven` has room for every input.
#[repr(C)]
struct RawSchedule {
    period: f64,
    offset: f64,
    delay: f64,
    outputs: u32,
    driven: *mut u32,
}

type Version = unsafe extern "C" fn() -> u32;
type Start = unsafe extern "C" fn(*const RawModel, *mut RawSchedule) -> i32;
type SampleFunction =
    unsafe extern "C" fn(f64, *const f64, *const f64, *const f64, *mut f64) -> i32;

/// Times and driven inputs that a library requests, unchecked.
#[derive(Clone, Debug)]
pub struct RequestedSchedule {
    /// Period, offset and delay, s.
    pub times: [f64; 3],
    /// Number of driven inputs; it may exceed the length of `driven`.
    pub outputs: usize,
    /// Indices of the driven inputs, one for each input of the model.
    pub driven: Vec<u32>,
}

/// Open library with its functions.
pub struct Functions {
    start: Start,
    sample: SampleFunction,
    /// Open library; it keeps the functions loaded.
    _library: Library,
}

/// Name of a function that is missing, and the loader's message; the name is empty if the library cannot be opened.
pub struct MissingFunction(pub &'static str, pub String);

/// Opens a library and finds its functions. Returns the functions and the version of the interface.
pub fn open(path: &Path) -> Result<(Functions, u32), MissingFunction> {
    // SAFETY: opening a library runs its initialisers; the user trusts the library, see the module.
    let library = unsafe { Library::new(path) };
    let library = library.map_err(|error| MissingFunction("", error.to_string()))?;
    let version: Version = find_function(&library, "eomgen_controller_abi")?;
    // SAFETY: the function has this type according to the header.
    let version = unsafe { version() };
    if version != crate::VERSION {
        // In other versions the functions may have other types.
        let functions = Functions {
            start: never_start,
            sample: never_sample,
            _library: library,
        };
        return Ok((functions, version));
    }
    let start: Start = find_function(&library, "eomgen_controller_start")?;
    let sample: SampleFunction = find_function(&library, "eomgen_controller_sample")?;
    let functions = Functions {
        start,
        sample,
        _library: library,
    };
    Ok((functions, version))
}

unsafe extern "C" fn never_start(_: *const RawModel, _: *mut RawSchedule) -> i32 {
    1
}

unsafe extern "C" fn never_sample(
    _: f64,
    _: *const f64,
    _: *const f64,
    _: *const f64,
    _: *mut f64,
) -> i32 {
    1
}

fn find_function<F: Copy>(library: &Library, name: &'static str) -> Result<F, MissingFunction> {
    // SAFETY: `F` is the type that the header declares for this name, and `Functions` keeps the library loaded.
    let found: Result<Symbol<'_, F>, _> = unsafe { library.get(name) };
    let found = found.map_err(|error| MissingFunction(name, error.to_string()))?;
    Ok(*found)
}

/// Names as C strings, with an array of pointers to the strings.
struct Names {
    _owned: Vec<CString>,
    pointers: Vec<*const c_char>,
}

impl Names {
    fn new(names: &[String]) -> Self {
        // Names in a specification are ASCII identifiers without a zero byte.
        let owned = names
            .iter()
            .map(|name| CString::new(name.as_str()).unwrap_or_default());
        let owned: Vec<CString> = owned.collect();
        Self {
            pointers: owned.iter().map(|name| name.as_ptr()).collect(),
            _owned: owned,
        }
    }
}

impl Functions {
    /// Starts the controller with the names of states, observables and inputs. Returns its status and the requested
    /// times.
    pub fn start(&self, [states, observables, inputs]: [&[String]; 3]) -> (i32, RequestedSchedule) {
        let count = |names: &[String]| u32::try_from(names.len()).unwrap_or(u32::MAX);
        let [state_names, observable_names, input_names] =
            [states, observables, inputs].map(Names::new);
        let model = RawModel {
            states: count(states),
            observables: count(observables),
            inputs: count(inputs),
            state_names: state_names.pointers.as_ptr(),
            observable_names: observable_names.pointers.as_ptr(),
            input_names: input_names.pointers.as_ptr(),
        };
        let mut driven = vec![u32::MAX; inputs.len()];
        let mut schedule = RawSchedule {
            period: f64::NAN,
            offset: 0.0,
            delay: 0.0,
            outputs: 0,
            driven: driven.as_mut_ptr(),
        };
        // SAFETY: both structures and their arrays live until the call returns, and have the layout of the header.
        let status = unsafe { (self.start)(&raw const model, &raw mut schedule) };
        let requested = RequestedSchedule {
            times: [schedule.period, schedule.offset, schedule.delay],
            outputs: schedule.outputs as usize,
            driven,
        };
        (status, requested)
    }

    /// Samples the controller and returns its status. `outputs` has room for the requested number of outputs.
    pub fn sample(
        &self,
        t: f64,
        [state, observables, inputs]: [&[f64]; 3],
        outputs: &mut [f64],
    ) -> i32 {
        let (state, observables, inputs) = (state.as_ptr(), observables.as_ptr(), inputs.as_ptr());
        // SAFETY: the arrays have the lengths given to `start`, and live until the call returns.
        unsafe { (self.sample)(t, state, observables, inputs, outputs.as_mut_ptr()) }
    }
}
