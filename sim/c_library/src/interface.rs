//! Functions of `eomgen_simulation.h`. Only this module has unsafe code.
//!
//! C passes pointers without lengths. The header is the contract: a pointer to a model or a motion comes from this
//! library and was not closed; an array has the length that the header states; a text ends with a zero.
#![allow(unsafe_code)]

use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char, c_int};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr;

use crate::model::{List, Model, Motion, Values};

thread_local! {
    /// Message of the last error.
    static LAST_ERROR: RefCell<CString> = RefCell::default();
}

/// Runs a function and keeps the message of its error. A panic becomes an error, because it must not reach C.
fn call<T>(function: impl FnOnce() -> Result<T, String>) -> Option<T> {
    let ended = catch_unwind(AssertUnwindSafe(function));
    let ended = ended.unwrap_or_else(|_| Err("internal error of eomgen".to_owned()));
    let message = ended.as_ref().err().cloned().unwrap_or_default();
    let message = CString::new(message.replace('\0', " ")).unwrap_or_default();
    LAST_ERROR.with(|last| last.replace(message));
    ended.ok()
}

/// Returns the reference behind a pointer.
///
/// # Errors
/// A null pointer.
///
/// # Safety
/// The contract of the header.
unsafe fn target<'p, T>(pointer: *const T, name: &str) -> Result<&'p T, String> {
    // SAFETY: the contract of the header.
    unsafe { pointer.as_ref() }.ok_or_else(|| format!("`{name}` is NULL"))
}

/// Returns an array, or `None` for a null pointer.
///
/// # Safety
/// The contract of the header.
unsafe fn array<'p>(pointer: *const f64, length: usize) -> Option<&'p [f64]> {
    // SAFETY: the contract of the header.
    (!pointer.is_null()).then(|| unsafe { std::slice::from_raw_parts(pointer, length) })
}

/// Copies values to an array, unless it is a null pointer.
///
/// # Safety
/// The contract of the header.
unsafe fn write(values: &[f64], pointer: *mut f64) {
    if !pointer.is_null() {
        // SAFETY: the contract of the header.
        unsafe { ptr::copy_nonoverlapping(values.as_ptr(), pointer, values.len()) }
    }
}

/// Returns a list of a model by its number.
fn list(model: &Model, list: c_int) -> Result<&List, String> {
    let known = usize::try_from(list)
        .ok()
        .and_then(|list| model.lists.get(list));
    known.ok_or_else(|| format!("list {list} does not exist; expected 0 to 2"))
}

/// `eomgen_error` of the header.
#[unsafe(no_mangle)]
pub extern "C" fn eomgen_error() -> *const c_char {
    LAST_ERROR.with(|last| last.borrow().as_ptr())
}

/// `eomgen_open` of the header.
///
/// # Safety
/// The contract of the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn eomgen_open(path: *const c_char) -> *mut Model {
    let open = || {
        // SAFETY: the contract of the header.
        let path = unsafe { CStr::from_ptr(target(path, "path")?) };
        let path = path
            .to_str()
            .map_err(|_| "the path is not UTF-8".to_owned())?;
        Model::open(path).map_err(|error| error.to_string())
    };
    call(open).map_or(ptr::null_mut(), |model| Box::into_raw(Box::new(model)))
}

/// `eomgen_close` of the header.
///
/// # Safety
/// The contract of the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn eomgen_close(model: *mut Model) {
    if !model.is_null() {
        // SAFETY: `eomgen_open` made the pointer from a box.
        drop(unsafe { Box::from_raw(model) });
    }
}

/// `eomgen_count` of the header.
///
/// # Safety
/// The contract of the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn eomgen_count(model: *const Model, number: c_int) -> usize {
    // SAFETY: the contract of the header.
    let count = || {
        Ok(list(unsafe { target(model, "model") }?, number)?
            .values
            .len())
    };
    call(count).unwrap_or(0)
}

/// `eomgen_name` of the header.
///
/// # Safety
/// The contract of the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn eomgen_name(
    model: *const Model,
    number: c_int,
    index: usize,
) -> *const c_char {
    let name = || {
        // SAFETY: the contract of the header.
        let names = &list(unsafe { target(model, "model") }?, number)?.names;
        let name = names.get(index);
        let name = name.ok_or_else(|| format!("entry {index} of {} does not exist", names.len()));
        name.map(|name| name.as_ptr())
    };
    call(name).unwrap_or(ptr::null())
}

/// `eomgen_values` of the header.
///
/// # Safety
/// The contract of the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn eomgen_values(
    model: *const Model,
    number: c_int,
    values: *mut f64,
) -> c_int {
    let copy = || {
        // SAFETY: the contract of the header.
        unsafe {
            let list = list(target(model, "model")?, number)?;
            write(&list.values, values);
        }
        Ok(())
    };
    call(copy).map_or(-1, |()| 0)
}

/// `eomgen_simulate` of the header.
///
/// # Safety
/// The contract of the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn eomgen_simulate(
    model: *const Model,
    parameters: *const f64,
    initial: *const f64,
    inputs: *const f64,
    times: *const f64,
    count: usize,
    tolerance: f64,
    states: *mut f64,
) -> *mut Motion {
    let simulate = || {
        // SAFETY: the contract of the header.
        unsafe {
            let model = target(model, "model")?;
            let length = |list: usize| model.lists[list].values.len();
            let values = Values {
                initial: array(initial, length(0)),
                parameters: array(parameters, length(1)),
                inputs: array(inputs, length(2)),
            };
            let times = array(times, count).ok_or("`times` is NULL")?;
            let motion = model.simulate(&values, times, tolerance);
            let motion = motion.map_err(|error| error.to_string())?;
            write(&motion.samples(), states);
            Ok(motion)
        }
    };
    call(simulate).map_or(ptr::null_mut(), |motion| Box::into_raw(Box::new(motion)))
}

/// `eomgen_discard` of the header.
///
/// # Safety
/// The contract of the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn eomgen_discard(motion: *mut Motion) {
    if !motion.is_null() {
        // SAFETY: `eomgen_simulate` made the pointer from a box.
        drop(unsafe { Box::from_raw(motion) });
    }
}

/// `eomgen_gradient` of the header.
///
/// # Safety
/// The contract of the header.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn eomgen_gradient(
    motion: *const Motion,
    weights: *const f64,
    by_initial: *mut f64,
    by_parameters: *mut f64,
    by_inputs: *mut f64,
) -> c_int {
    let differentiate = || {
        // SAFETY: the contract of the header.
        unsafe {
            let motion = target(motion, "motion")?;
            let (samples, states) = motion.shape();
            let weights = array(weights, samples * states).ok_or("`weights` is NULL")?;
            let gradient = motion
                .gradient(weights)
                .map_err(|error| error.to_string())?;
            for (values, results) in
                gradient
                    .by_list
                    .iter()
                    .zip([by_initial, by_parameters, by_inputs])
            {
                write(values, results);
            }
        }
        Ok(())
    };
    call(differentiate).map_or(-1, |()| 0)
}
