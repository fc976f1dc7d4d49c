//! Boundary to the importer: instances behind pointers, messages to its logger, arrays, and panics.
//!
//! The FMI standard defines the pointers that the importer passes: instances and saved states from this
//! library, null-terminated texts, and arrays of the given lengths. Null pointers are rejected.
#![allow(unsafe_code)]

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::rejection::{Outcome, Rejection, Status, invalid};
use crate::resources::derive_specification;
use crate::saved_state::SavedState;
use crate::unit::{ANY_MODE, Kind, Unit};

/// Category of all messages.
const CATEGORY: &CStr = c"logStatusError";

/// Logger of FMI 2.0: environment, name of the instance, status, category, format and its arguments.
pub type Logger2 =
    unsafe extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char, ...);

/// Logger of FMI 3.0: environment, status, category, message.
pub type Logger3 = unsafe extern "C" fn(*mut c_void, c_int, *const c_char, *const c_char);

/// Logger of the importer.
#[derive(Clone, Copy)]
pub enum Logger {
    None,
    Two(Logger2),
    Three(Logger3),
}

/// Receiver of messages.
pub struct Messages {
    logger: Logger,
    environment: *mut c_void,
    name: CString,
}

/// Instance with its importer.
pub struct Component {
    unit: Unit,
    messages: Messages,
    /// True after a panic, which may have left the instance in an inconsistent state.
    has_failed: bool,
}

impl Messages {
    /// Returns the messages of an instance.
    pub fn new(name: Option<&CStr>, (environment, logger): (*mut c_void, Logger)) -> Self {
        Self {
            logger,
            environment,
            name: name.map_or_else(CString::default, CStr::to_owned),
        }
    }

    pub fn log(&self, rejection: &Rejection) {
        // A C string ends at its first null character.
        let text = CString::new(rejection.message.replace('\0', " ")).unwrap_or_default();
        let status = rejection.status as c_int;
        match self.logger {
            Logger::None => {}
            // SAFETY: the importer's function, with the arguments that the standard defines; the format has one
            // string argument.
            Logger::Two(logger) => unsafe {
                logger(
                    self.environment,
                    self.name.as_ptr(),
                    status,
                    CATEGORY.as_ptr(),
                    c"%s".as_ptr(),
                    text.as_ptr(),
                );
            },
            // SAFETY: the importer's function, with the arguments that the standard defines.
            Logger::Three(logger) => unsafe {
                logger(self.environment, status, CATEGORY.as_ptr(), text.as_ptr());
            },
        }
    }
}

/// Returns the text at a pointer; `None` for a null pointer.
///
/// # Safety
/// The pointer is null or points to a null-terminated text.
unsafe fn text<'a>(pointer: *const c_char) -> Option<&'a CStr> {
    // SAFETY: by the contract of this function.
    (!pointer.is_null()).then(|| unsafe { CStr::from_ptr(pointer) })
}

/// Returns the array at a pointer.
///
/// # Errors
/// A null pointer for an array with elements.
///
/// # Safety
/// The pointer is null or points to `count` elements.
pub unsafe fn array<'a, T>(pointer: *const T, count: usize, what: &str) -> Outcome<&'a [T]> {
    match (count, pointer.is_null()) {
        (0, _) => Ok(&[]),
        (_, true) => Err(null_pointer(what)),
        // SAFETY: by the contract of this function.
        _ => Ok(unsafe { std::slice::from_raw_parts(pointer, count) }),
    }
}

/// Returns the writable array at a pointer; see [`array`].
///
/// # Errors
/// A null pointer for an array with elements.
///
/// # Safety
/// The pointer is null or points to `count` elements, which nothing else uses during the call.
pub unsafe fn array_mut<'a, T>(pointer: *mut T, count: usize, what: &str) -> Outcome<&'a mut [T]> {
    match (count, pointer.is_null()) {
        (0, _) => Ok(&mut []),
        (_, true) => Err(null_pointer(what)),
        // SAFETY: by the contract of this function.
        _ => Ok(unsafe { std::slice::from_raw_parts_mut(pointer, count) }),
    }
}

/// Writes a value to a pointer.
///
/// # Errors
/// A null pointer.
///
/// # Safety The pointer is null or points to a value.
pub unsafe fn write<T>(pointer: *mut T, value: T, what: &str) -> Outcome {
    if pointer.is_null() {
        return Err(null_pointer(what));
    }
    // SAFETY: by the contract of this function.
    unsafe { pointer.write(value) };
    Ok(())
}

fn null_pointer(what: &str) -> Rejection {
    invalid(format!("a null pointer in place of {what}"))
}

/// Creates an instance. Returns null after a message if the creation fails.
///
/// # Safety
/// The pointers are null or point to null-terminated texts.
pub unsafe fn instantiate(
    kind: Kind,
    (name, token, resources): (*const c_char, *const c_char, *const c_char),
    (environment, logger): (*mut c_void, Logger),
) -> *mut c_void {
    // SAFETY: by the contract of this function.
    let [name, token, resources] = [name, token, resources].map(|pointer| unsafe { text(pointer) });
    let messages = Messages::new(name, (environment, logger));
    let made = catch_unwind(AssertUnwindSafe(|| {
        if messages.name.is_empty() {
            return Err(invalid("the instance has no name"));
        }
        let token = token.and_then(|token| token.to_str().ok());
        Unit::new(
            derive_specification(resources.map(CStr::to_bytes), token)?,
            kind,
        )
    }));
    match made.unwrap_or_else(|_| Err(internal_error())) {
        Ok(unit) => Box::into_raw(Box::new(Component {
            unit,
            messages,
            has_failed: false,
        }))
        .cast(),
        Err(rejection) => {
            messages.log(&rejection);
            std::ptr::null_mut()
        }
    }
}

/// Frees an instance; does nothing for a null pointer.
///
/// # Safety
/// The pointer is null or from [`instantiate`], and not used again.
pub unsafe fn free_instance(component: *mut c_void) {
    if !component.is_null() {
        // SAFETY: by the contract of this function.
        drop(unsafe { Box::from_raw(component.cast::<Component>()) });
    }
}

/// Calls `act` with an instance in one of these modes, logs a rejection, and returns the status.
///
/// # Safety
/// The pointer is null or from [`instantiate`], and no other call uses the instance.
pub unsafe fn call(
    component: *mut c_void,
    (modes, name): (u8, &str),
    act: impl FnOnce(&mut Unit) -> Outcome,
) -> c_int {
    // SAFETY: by the contract of this function.
    let Some(component) = (unsafe { component.cast::<Component>().as_mut() }) else {
        return Status::Error as c_int;
    };
    let Component {
        unit,
        messages,
        has_failed,
    } = component;
    let outcome = match *has_failed {
        true => Err(internal_error()),
        false => catch_unwind(AssertUnwindSafe(|| {
            unit.check_mode(modes, name)?;
            act(unit)
        }))
        .unwrap_or_else(|_| {
            *has_failed = true;
            Err(internal_error())
        }),
    };
    match outcome {
        Ok(()) => Status::Ok as c_int,
        Err(rejection) => {
            messages.log(&rejection);
            rejection.status as c_int
        }
    }
}

fn internal_error() -> Rejection {
    invalid("internal error of the FMU; the instance cannot be used any more: please report it")
}

/// Rejects a call.
///
/// # Safety
/// Same as [`call`].
pub unsafe fn reject(component: *mut c_void, rejection: Rejection) -> c_int {
    // SAFETY: by the contract of this function.
    unsafe { call(component, (ANY_MODE, ""), |_| Err(rejection)) }
}

/// Accepts a call without variables, and rejects a call for variables of a type that the unit does not have.
///
/// # Safety
/// Same as [`call`].
pub unsafe fn accept_none(component: *mut c_void, count: usize, reason: &str) -> c_int {
    // SAFETY: by the contract of this function.
    unsafe {
        call(component, (ANY_MODE, ""), |_| match count {
            0 => Ok(()),
            _ => Err(invalid(reason)),
        })
    }
}

/// Reason for a rejection of variables of other types.
pub const NO_SUCH_TYPE: &str = "the FMU has no variables of this type";

/// Saves the state of an instance into a new saved state, or into the one that `saved` points to.
///
/// # Safety
/// Same as [`call`]; `saved` is null or a pointer that is null or from this function.
pub unsafe fn save(component: *mut c_void, saved: *mut *mut c_void, name: &str) -> c_int {
    // SAFETY: by the contract of this function.
    unsafe {
        call(component, (ANY_MODE, name), |unit| {
            let state = unit.save();
            match saved
                .as_ref()
                .and_then(|known| known.cast::<SavedState>().as_mut())
            {
                Some(known) => *known = state,
                None => write(
                    saved,
                    Box::into_raw(Box::new(state)).cast(),
                    "a saved state",
                )?,
            }
            Ok(())
        })
    }
}

/// Continues from a saved state.
///
/// # Safety
/// Same as [`call`]; `saved` is null or from [`save`].
pub unsafe fn restore(component: *mut c_void, saved: *mut c_void, name: &str) -> c_int {
    // SAFETY: by the contract of this function.
    unsafe {
        call(component, (ANY_MODE, name), |unit| {
            let saved = saved.cast::<SavedState>().as_ref();
            unit.restore(saved.ok_or_else(|| null_pointer("a saved state"))?)
        })
    }
}

/// Frees a saved state.
///
/// # Safety
/// Same as [`call`]; `saved` is null or a pointer that is null or from [`save`].
pub unsafe fn free_saved(component: *mut c_void, saved: *mut *mut c_void, name: &str) -> c_int {
    // SAFETY: by the contract of this function.
    unsafe {
        call(component, (ANY_MODE, name), |_| {
            if let Some(saved) = saved.as_mut()
                && !saved.is_null()
            {
                drop(Box::from_raw(saved.cast::<SavedState>()));
                *saved = std::ptr::null_mut();
            }
            Ok(())
        })
    }
}

/// Writes the number of bytes of a saved state.
///
/// # Safety
/// Same as [`call`]; `saved` is null or from [`save`].
pub unsafe fn write_serialised_length(
    component: *mut c_void,
    saved: *mut c_void,
    size: *mut usize,
    name: &str,
) -> c_int {
    // SAFETY: by the contract of this function.
    unsafe {
        call(component, (ANY_MODE, name), |unit| {
            let saved = saved.cast::<SavedState>().as_ref();
            let content = unit.serialise(saved.ok_or_else(|| null_pointer("a saved state"))?);
            write(size, content.len(), "a size")
        })
    }
}

/// Writes the bytes of a saved state.
///
/// # Safety
/// Same as [`call`]; `saved` is null or from [`save`], and `bytes` has `size` bytes.
pub unsafe fn serialise(
    component: *mut c_void,
    saved: *mut c_void,
    (bytes, size): (*mut u8, usize),
    name: &str,
) -> c_int {
    // SAFETY: by the contract of this function.
    unsafe {
        call(component, (ANY_MODE, name), |unit| {
            let saved = saved.cast::<SavedState>().as_ref();
            let content = unit.serialise(saved.ok_or_else(|| null_pointer("a saved state"))?);
            let bytes = array_mut(bytes, size, "the bytes of a saved state")?;
            let room = bytes.get_mut(..content.len());
            let room = room
                .ok_or_else(|| invalid("the array is too small for the bytes of a saved state"))?;
            room.copy_from_slice(&content);
            Ok(())
        })
    }
}

/// Reads a saved state from its bytes.
///
/// # Safety
/// Same as [`call`]; `bytes` has `size` bytes.
pub unsafe fn deserialise(
    component: *mut c_void,
    (bytes, size): (*const u8, usize),
    saved: *mut *mut c_void,
    name: &str,
) -> c_int {
    // SAFETY: by the contract of this function.
    unsafe {
        call(component, (ANY_MODE, name), |unit| {
            if saved.is_null() {
                return Err(null_pointer("a saved state"));
            }
            let state = unit.deserialise(array(bytes, size, "the bytes of a saved state")?)?;
            write(
                saved,
                Box::into_raw(Box::new(state)).cast(),
                "a saved state",
            )
        })
    }
}

/// Arrays of a derivative: unknowns, knowns, seed and sensitivity.
pub struct Derivative {
    pub unknowns: (*const u32, usize),
    pub knowns: (*const u32, usize),
    pub seed: *const f64,
    pub sensitivity: *mut f64,
    pub backward: bool,
}

/// Writes directional or adjoint derivatives.
///
/// # Safety Same as [`call`]; each array has one element for each of its variables.
pub unsafe fn differentiate(component: *mut c_void, derivative: &Derivative, name: &str) -> c_int {
    let (given, wanted) = match derivative.backward {
        true => (derivative.unknowns.1, derivative.knowns.1),
        false => (derivative.knowns.1, derivative.unknowns.1),
    };
    // SAFETY: by the contract of this function.
    unsafe {
        call(component, (ANY_MODE, name), |unit| {
            let unknowns = array(
                derivative.unknowns.0,
                derivative.unknowns.1,
                "value references",
            )?;
            let knowns = array(derivative.knowns.0, derivative.knowns.1, "value references")?;
            let seed = array(derivative.seed, given, "derivatives")?;
            let out = array_mut(derivative.sensitivity, wanted, "derivatives")?;
            let found = unit.differentiate(derivative.backward, (unknowns, knowns), seed)?;
            out.copy_from_slice(&found);
            Ok(())
        })
    }
}

/// Writes one number per state or event indicator.
///
/// # Safety
/// Same as [`call`]; `out` has `count` elements.
pub unsafe fn write_vector(
    component: *mut c_void,
    name: &str,
    (out, count): (*mut f64, usize),
    values: impl FnOnce(&mut Unit) -> Outcome<Vec<f64>>,
) -> c_int {
    // SAFETY: by the contract of this function.
    unsafe {
        call(component, (ANY_MODE, name), |unit| {
            let values = values(unit)?;
            Unit::check_length(count, values.len(), "numbers are requested")?;
            array_mut(out, count, "numbers")?.copy_from_slice(&values);
            Ok(())
        })
    }
}
