//! Functions of FMI 2.0 for model exchange and co-simulation. See `boundary` for the contract of their pointers.
#![allow(unsafe_code, clippy::missing_safety_doc, non_snake_case)]

use std::ffi::{c_char, c_int, c_void};

use crate::boundary::{
    Derivative, Logger, Logger2, NO_SUCH_TYPE, accept_none, array, array_mut, call, deserialise,
    differentiate, free_instance, free_saved, instantiate, reject, restore, save, serialise, write,
    write_serialised_length, write_vector,
};
use crate::rejection::{Status, invalid, unavailable};
use crate::unit::{ANY_MODE, Kind, Mode, Unit};

const EVENT: u8 = Mode::Event as u8;
const CONTINUOUS: u8 = Mode::Continuous as u8;
const STEP: u8 = Mode::Step as u8;

/// Kind of `fmi2GetRealStatus`: the end time of the last successful step.
const LAST_SUCCESSFUL_TIME: c_int = 2;

/// `fmi2CallbackFunctions`.
#[repr(C)]
pub struct Callbacks {
    logger: Option<Logger2>,
    allocate: *const c_void,
    free: *const c_void,
    step_finished: *const c_void,
    environment: *mut c_void,
}

/// `fmi2EventInfo`.
#[repr(C)]
pub struct EventInfo {
    new_discrete_states_needed: c_int,
    terminate_simulation: c_int,
    nominals_changed: c_int,
    states_changed: c_int,
    next_event_time_defined: c_int,
    next_event_time: f64,
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
    c"default".as_ptr()
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetVersion() -> *const c_char {
    c"2.0".as_ptr()
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetDebugLogging(
    c: *mut c_void,
    _on: c_int,
    count: usize,
    categories: *const *const c_char,
) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        call(c, (ANY_MODE, "fmi2SetDebugLogging"), |_| {
            array(categories, count, "categories").map(|_| ())
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Instantiate(
    name: *const c_char,
    kind: c_int,
    guid: *const c_char,
    resources: *const c_char,
    callbacks: *const Callbacks,
    _visible: c_int,
    _logging: c_int,
) -> *mut c_void {
    let kind = match kind {
        0 => Kind::ModelExchange,
        1 => Kind::CoSimulation,
        _ => return std::ptr::null_mut(),
    };
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        let callbacks = callbacks.as_ref();
        let logger = callbacks.and_then(|callbacks| callbacks.logger);
        let environment = callbacks.map_or(std::ptr::null_mut(), |known| known.environment);
        let logger = logger.map_or(Logger::None, Logger::Two);
        instantiate(kind, (name, guid, resources), (environment, logger))
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeInstance(c: *mut c_void) {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe { free_instance(c) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetupExperiment(
    c: *mut c_void,
    has_tolerance: c_int,
    tolerance: f64,
    start: f64,
    has_stop: c_int,
    stop: f64,
) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        call(
            c,
            (Mode::Instantiated as u8, "fmi2SetupExperiment"),
            |unit| {
                let tolerance = (has_tolerance != 0).then_some(tolerance);
                unit.set_up(tolerance, start, (has_stop != 0).then_some(stop))
            },
        )
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2EnterInitializationMode(c: *mut c_void) -> c_int {
    let name = "fmi2EnterInitializationMode";
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        call(c, (Mode::Instantiated as u8, name), |unit| {
            unit.now.mode = Mode::Initialization;
            Ok(())
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2ExitInitializationMode(c: *mut c_void) -> c_int {
    let name = "fmi2ExitInitializationMode";
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        call(
            c,
            (Mode::Initialization as u8, name),
            Unit::end_initialization,
        )
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Terminate(c: *mut c_void) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        call(c, (EVENT | CONTINUOUS | STEP, "fmi2Terminate"), |unit| {
            unit.now.mode = Mode::Terminated;
            Ok(())
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Reset(c: *mut c_void) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        call(c, (ANY_MODE, "fmi2Reset"), |unit| {
            unit.reset();
            Ok(())
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetReal(
    c: *mut c_void,
    references: *const u32,
    count: usize,
    values: *mut f64,
) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        call(c, (ANY_MODE, "fmi2GetReal"), |unit| {
            let references = array(references, count, "value references")?;
            unit.get_values(references, array_mut(values, count, "values")?)
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetReal(
    c: *mut c_void,
    references: *const u32,
    count: usize,
    values: *const f64,
) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        call(c, (ANY_MODE, "fmi2SetReal"), |unit| {
            let references = array(references, count, "value references")?;
            unit.set_values(references, array(values, count, "values")?)
        })
    }
}

/// Exports functions that reject variables of a type that no FMU has.
macro_rules! reject_type {
    ($($get:ident $set:ident)*) => {$(
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $get(
            c: *mut c_void,
            _references: *const u32,
            count: usize,
            _values: *mut c_void,
        ) -> c_int {
            // SAFETY: the importer's pointers, see `boundary`.
            unsafe { accept_none(c, count, NO_SUCH_TYPE) }
        }

        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $set(
            c: *mut c_void,
            _references: *const u32,
            count: usize,
            _values: *const c_void,
        ) -> c_int {
            // SAFETY: the importer's pointers, see `boundary`.
            unsafe { accept_none(c, count, NO_SUCH_TYPE) }
        }
    )*};
}

reject_type! {
    fmi2GetInteger fmi2SetInteger
    fmi2GetBoolean fmi2SetBoolean
    fmi2GetString fmi2SetString
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetFMUstate(c: *mut c_void, saved: *mut *mut c_void) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe { save(c, saved, "fmi2GetFMUstate") }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetFMUstate(c: *mut c_void, saved: *mut c_void) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe { restore(c, saved, "fmi2SetFMUstate") }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeFMUstate(c: *mut c_void, saved: *mut *mut c_void) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe { free_saved(c, saved, "fmi2FreeFMUstate") }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializedFMUstateSize(
    c: *mut c_void,
    saved: *mut c_void,
    size: *mut usize,
) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe { write_serialised_length(c, saved, size, "fmi2SerializedFMUstateSize") }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializeFMUstate(
    c: *mut c_void,
    saved: *mut c_void,
    bytes: *mut u8,
    size: usize,
) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe { serialise(c, saved, (bytes, size), "fmi2SerializeFMUstate") }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DeSerializeFMUstate(
    c: *mut c_void,
    bytes: *const u8,
    size: usize,
    saved: *mut *mut c_void,
) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe { deserialise(c, (bytes, size), saved, "fmi2DeSerializeFMUstate") }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetDirectionalDerivative(
    c: *mut c_void,
    unknowns: *const u32,
    unknown_count: usize,
    knowns: *const u32,
    known_count: usize,
    seed: *const f64,
    sensitivity: *mut f64,
) -> c_int {
    let derivative = Derivative {
        unknowns: (unknowns, unknown_count),
        knowns: (knowns, known_count),
        seed,
        sensitivity,
        backward: false,
    };
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe { differentiate(c, &derivative, "fmi2GetDirectionalDerivative") }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2EnterEventMode(c: *mut c_void) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        call(c, (EVENT | CONTINUOUS, "fmi2EnterEventMode"), |unit| {
            unit.enter_event_mode();
            Ok(())
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2NewDiscreteStates(c: *mut c_void, info: *mut EventInfo) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        call(c, (EVENT, "fmi2NewDiscreteStates"), |unit| {
            let found = |(states_changed, next): (bool, Option<f64>)| EventInfo {
                new_discrete_states_needed: 0,
                terminate_simulation: 0,
                nominals_changed: 0,
                states_changed: c_int::from(states_changed),
                next_event_time_defined: c_int::from(next.is_some()),
                next_event_time: next.unwrap_or(0.0),
            };
            let what = "the event's information";
            write(info, found((false, None)), what)?;
            write(info, found(unit.apply_event()?), what)
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2EnterContinuousTimeMode(c: *mut c_void) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        call(c, (EVENT, "fmi2EnterContinuousTimeMode"), |unit| {
            unit.now.mode = Mode::Continuous;
            Ok(())
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2CompletedIntegratorStep(
    c: *mut c_void,
    _no_set_before: c_int,
    enter_event_mode: *mut c_int,
    terminate: *mut c_int,
) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        call(c, (CONTINUOUS, "fmi2CompletedIntegratorStep"), |unit| {
            write(terminate, 0, "a flag")?;
            write(enter_event_mode, 0, "a flag")?;
            let needs_event = unit.complete_step()?;
            write(enter_event_mode, c_int::from(needs_event), "a flag")
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetTime(c: *mut c_void, time: f64) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        call(c, (EVENT | CONTINUOUS, "fmi2SetTime"), |unit| {
            unit.set_time(time)
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetContinuousStates(
    c: *mut c_void,
    states: *const f64,
    count: usize,
) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        call(c, (EVENT | CONTINUOUS, "fmi2SetContinuousStates"), |unit| {
            unit.set_states(array(states, count, "continuous states")?)
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetDerivatives(
    c: *mut c_void,
    rates: *mut f64,
    count: usize,
) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe { write_vector(c, "fmi2GetDerivatives", (rates, count), Unit::finite_rates) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetEventIndicators(
    c: *mut c_void,
    indicators: *mut f64,
    count: usize,
) -> c_int {
    let out = (indicators, count);
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe { write_vector(c, "fmi2GetEventIndicators", out, Unit::finite_indicators) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetContinuousStates(
    c: *mut c_void,
    states: *mut f64,
    count: usize,
) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        write_vector(c, "fmi2GetContinuousStates", (states, count), |unit| {
            Ok(unit.now.state.clone())
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetNominalsOfContinuousStates(
    c: *mut c_void,
    nominals: *mut f64,
    count: usize,
) -> c_int {
    let name = "fmi2GetNominalsOfContinuousStates";
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        write_vector(c, name, (nominals, count), |unit| {
            Ok(unit.compiled.typical_sizes().to_vec())
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetRealInputDerivatives(
    c: *mut c_void,
    _references: *const u32,
    count: usize,
    _orders: *const c_int,
    _values: *const f64,
) -> c_int {
    let reason = "inputs are held during a step: their derivatives are not used";
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe { accept_none(c, count, reason) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealOutputDerivatives(
    c: *mut c_void,
    _references: *const u32,
    count: usize,
    _orders: *const c_int,
    _values: *mut f64,
) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe { accept_none(c, count, "time derivatives of outputs are not provided") }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DoStep(
    c: *mut c_void,
    from: f64,
    length: f64,
    _no_set_before: c_int,
) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe { call(c, (STEP, "fmi2DoStep"), |unit| unit.make_step(from, length)) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2CancelStep(c: *mut c_void) -> c_int {
    let reason = "no step can be cancelled: steps are not asynchronous";
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe { reject(c, invalid(reason)) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealStatus(c: *mut c_void, kind: c_int, value: *mut f64) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        call(c, (ANY_MODE, "fmi2GetRealStatus"), |unit| match kind {
            LAST_SUCCESSFUL_TIME => write(value, unit.now.t, "a status"),
            _ => Err(unavailable(NO_STATUS)),
        })
    }
}

const NO_STATUS: &str = "this status kind is not supported";

/// Exports functions that reject a status kind that the unit does not have.
macro_rules! reject_status {
    ($($name:ident)*) => {$(
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(c: *mut c_void, _kind: c_int, _value: *mut c_void) -> c_int {
            // SAFETY: the importer's pointers, see `boundary`.
            unsafe { reject(c, unavailable(NO_STATUS)) }
        }
    )*};
}

reject_status! { fmi2GetStatus fmi2GetIntegerStatus fmi2GetBooleanStatus fmi2GetStringStatus }

// The values must be those of the FMI standard.
const _: () = assert!(Status::Discard as c_int == 2 && Status::Error as c_int == 3);
