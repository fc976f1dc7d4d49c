//! Functions of FMI 3.0 for model exchange and co-simulation. See `boundary` for the contract of their pointers.
#![allow(unsafe_code, clippy::missing_safety_doc, non_snake_case)]

use std::ffi::{c_char, c_int, c_void};

use crate::boundary::{
    Derivative, Logger, Logger3, Messages, NO_SUCH_TYPE, accept_none, array, array_mut, call,
    deserialise, differentiate, free_instance, free_saved, instantiate, reject, restore, save,
    serialise, write, write_serialised_length, write_vector,
};
use crate::rejection::{Outcome, invalid};
use crate::unit::{ANY_MODE, Kind, Mode, Unit};

const EVENT: u8 = Mode::Event as u8;
const CONTINUOUS: u8 = Mode::Continuous as u8;
const STEP: u8 = Mode::Step as u8;

#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetDebugLogging(
    c: *mut c_void,
    _on: u8,
    count: usize,
    categories: *const *const c_char,
) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        call(c, (ANY_MODE, "fmi3SetDebugLogging"), |_| {
            array(categories, count, "categories").map(|_| ())
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3InstantiateModelExchange(
    name: *const c_char,
    token: *const c_char,
    resources: *const c_char,
    _visible: u8,
    _logging: u8,
    environment: *mut c_void,
    logger: Option<Logger3>,
) -> *mut c_void {
    let logger = logger.map_or(Logger::None, Logger::Three);
    let texts = (name, token, resources);
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe { instantiate(Kind::ModelExchange, texts, (environment, logger)) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3InstantiateCoSimulation(
    name: *const c_char,
    token: *const c_char,
    resources: *const c_char,
    _visible: u8,
    _logging: u8,
    event_mode_used: u8,
    _early_return_allowed: u8,
    _required: *const u32,
    required_count: usize,
    environment: *mut c_void,
    logger: Option<Logger3>,
    _intermediate_update: *const c_void,
) -> *mut c_void {
    let logger = logger.map_or(Logger::None, Logger::Three);
    if event_mode_used != 0 || required_count > 0 {
        let reason = "co-simulation has neither an event mode nor intermediate variables";
        Messages::new(None, (environment, logger)).log(&invalid(reason));
        return std::ptr::null_mut();
    }
    let texts = (name, token, resources);
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe { instantiate(Kind::CoSimulation, texts, (environment, logger)) }
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3InstantiateScheduledExecution(
    _name: *const c_char,
    _token: *const c_char,
    _resources: *const c_char,
    _visible: u8,
    _logging: u8,
    environment: *mut c_void,
    logger: Option<Logger3>,
    _clock_update: *const c_void,
    _lock: *const c_void,
    _unlock: *const c_void,
) -> *mut c_void {
    let logger = logger.map_or(Logger::None, Logger::Three);
    Messages::new(None, (environment, logger))
        .log(&invalid("scheduled execution is not supported"));
    std::ptr::null_mut()
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3FreeInstance(c: *mut c_void) {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe { free_instance(c) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3EnterInitializationMode(
    c: *mut c_void,
    has_tolerance: u8,
    tolerance: f64,
    start: f64,
    has_stop: u8,
    stop: f64,
) -> c_int {
    let name = "fmi3EnterInitializationMode";
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        call(c, (Mode::Instantiated as u8, name), |unit| {
            let tolerance = (has_tolerance != 0).then_some(tolerance);
            unit.set_up(tolerance, start, (has_stop != 0).then_some(stop))?;
            unit.now.mode = Mode::Initialization;
            Ok(())
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3ExitInitializationMode(c: *mut c_void) -> c_int {
    let name = "fmi3ExitInitializationMode";
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
pub unsafe extern "C" fn fmi3EnterEventMode(c: *mut c_void) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        call(c, (EVENT | CONTINUOUS, "fmi3EnterEventMode"), |unit| {
            unit.enter_event_mode();
            Ok(())
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3Terminate(c: *mut c_void) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        call(c, (EVENT | CONTINUOUS | STEP, "fmi3Terminate"), |unit| {
            unit.now.mode = Mode::Terminated;
            Ok(())
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3Reset(c: *mut c_void) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        call(c, (ANY_MODE, "fmi3Reset"), |unit| {
            unit.reset();
            Ok(())
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetFloat64(
    c: *mut c_void,
    references: *const u32,
    count: usize,
    values: *mut f64,
    value_count: usize,
) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        call(c, (ANY_MODE, "fmi3GetFloat64"), |unit| {
            check_counts(count, value_count)?;
            let references = array(references, count, "value references")?;
            unit.get_values(references, array_mut(values, count, "values")?)
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetFloat64(
    c: *mut c_void,
    references: *const u32,
    count: usize,
    values: *const f64,
    value_count: usize,
) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        call(c, (ANY_MODE, "fmi3SetFloat64"), |unit| {
            check_counts(count, value_count)?;
            let references = array(references, count, "value references")?;
            unit.set_values(references, array(values, count, "values")?)
        })
    }
}

fn check_counts(references: usize, values: usize) -> Outcome {
    match references == values {
        true => Ok(()),
        false => Err(invalid(
            "the numbers of values and value references differ, but all variables are scalars",
        )),
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
            _value_count: usize,
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
            _value_count: usize,
        ) -> c_int {
            // SAFETY: the importer's pointers, see `boundary`.
            unsafe { accept_none(c, count, NO_SUCH_TYPE) }
        }
    )*};
}

reject_type! {
    fmi3GetFloat32 fmi3SetFloat32
    fmi3GetInt8 fmi3SetInt8
    fmi3GetUInt8 fmi3SetUInt8
    fmi3GetInt16 fmi3SetInt16
    fmi3GetUInt16 fmi3SetUInt16
    fmi3GetInt32 fmi3SetInt32
    fmi3GetUInt32 fmi3SetUInt32
    fmi3GetInt64 fmi3SetInt64
    fmi3GetUInt64 fmi3SetUInt64
    fmi3GetBoolean fmi3SetBoolean
    fmi3GetString fmi3SetString
}

/// Exports functions of clocks, which have one to three arrays after the value references.
macro_rules! reject_clock {
    ($($name:ident($($array:ident),*))*) => {$(
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(
            c: *mut c_void,
            _references: *const u32,
            count: usize,
            $($array: *mut c_void,)*
        ) -> c_int {
            // SAFETY: the importer's pointers, see `boundary`.
            unsafe { accept_none(c, count, NO_SUCH_TYPE) }
        }
    )*};
}

reject_clock! {
    fmi3GetClock(_values)
    fmi3SetClock(_values)
    fmi3GetIntervalDecimal(_intervals, _qualifiers)
    fmi3GetIntervalFraction(_counters, _resolutions, _qualifiers)
    fmi3GetShiftDecimal(_shifts)
    fmi3GetShiftFraction(_counters, _resolutions)
    fmi3SetIntervalDecimal(_intervals)
    fmi3SetIntervalFraction(_counters, _resolutions)
    fmi3SetShiftDecimal(_shifts)
    fmi3SetShiftFraction(_counters, _resolutions)
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetBinary(
    c: *mut c_void,
    _references: *const u32,
    count: usize,
    _sizes: *mut usize,
    _values: *mut c_void,
    _value_count: usize,
) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe { accept_none(c, count, NO_SUCH_TYPE) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetBinary(
    c: *mut c_void,
    _references: *const u32,
    count: usize,
    _sizes: *const usize,
    _values: *const c_void,
    _value_count: usize,
) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe { accept_none(c, count, NO_SUCH_TYPE) }
}

const CONSTANT_DEPENDENCIES: &str =
    "the dependencies are constant and listed in modelDescription.xml";

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetNumberOfVariableDependencies(
    c: *mut c_void,
    _reference: u32,
    _count: *mut usize,
) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe { reject(c, invalid(CONSTANT_DEPENDENCIES)) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetVariableDependencies(
    c: *mut c_void,
    _dependent: u32,
    _dependent_elements: *mut usize,
    _independents: *mut u32,
    _independent_elements: *mut usize,
    _kinds: *mut c_int,
    _count: usize,
) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe { reject(c, invalid(CONSTANT_DEPENDENCIES)) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetFMUState(c: *mut c_void, saved: *mut *mut c_void) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe { save(c, saved, "fmi3GetFMUState") }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetFMUState(c: *mut c_void, saved: *mut c_void) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe { restore(c, saved, "fmi3SetFMUState") }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3FreeFMUState(c: *mut c_void, saved: *mut *mut c_void) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe { free_saved(c, saved, "fmi3FreeFMUState") }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SerializedFMUStateSize(
    c: *mut c_void,
    saved: *mut c_void,
    size: *mut usize,
) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe { write_serialised_length(c, saved, size, "fmi3SerializedFMUStateSize") }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SerializeFMUState(
    c: *mut c_void,
    saved: *mut c_void,
    bytes: *mut u8,
    size: usize,
) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe { serialise(c, saved, (bytes, size), "fmi3SerializeFMUState") }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DeserializeFMUState(
    c: *mut c_void,
    bytes: *const u8,
    size: usize,
    saved: *mut *mut c_void,
) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe { deserialise(c, (bytes, size), saved, "fmi3DeserializeFMUState") }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetDirectionalDerivative(
    c: *mut c_void,
    unknowns: *const u32,
    unknown_count: usize,
    knowns: *const u32,
    known_count: usize,
    seed: *const f64,
    seed_count: usize,
    sensitivity: *mut f64,
    sensitivity_count: usize,
) -> c_int {
    let counts = (known_count, unknown_count);
    if counts != (seed_count, sensitivity_count) {
        // SAFETY: the importer's pointers, see `boundary`.
        return unsafe {
            reject(
                c,
                invalid("the numbers of derivatives and variables differ"),
            )
        };
    }
    let derivative = Derivative {
        unknowns: (unknowns, unknown_count),
        knowns: (knowns, known_count),
        seed,
        sensitivity,
        backward: false,
    };
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe { differentiate(c, &derivative, "fmi3GetDirectionalDerivative") }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetAdjointDerivative(
    c: *mut c_void,
    unknowns: *const u32,
    unknown_count: usize,
    knowns: *const u32,
    known_count: usize,
    seed: *const f64,
    seed_count: usize,
    sensitivity: *mut f64,
    sensitivity_count: usize,
) -> c_int {
    let counts = (unknown_count, known_count);
    if counts != (seed_count, sensitivity_count) {
        // SAFETY: the importer's pointers, see `boundary`.
        return unsafe {
            reject(
                c,
                invalid("the numbers of derivatives and variables differ"),
            )
        };
    }
    let derivative = Derivative {
        unknowns: (unknowns, unknown_count),
        knowns: (knowns, known_count),
        seed,
        sensitivity,
        backward: true,
    };
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe { differentiate(c, &derivative, "fmi3GetAdjointDerivative") }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3EnterConfigurationMode(c: *mut c_void) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        reject(
            c,
            invalid("the FMU has no structural parameters, so it has no configuration mode"),
        )
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3ExitConfigurationMode(c: *mut c_void) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        reject(
            c,
            invalid("the FMU has no structural parameters, so it has no configuration mode"),
        )
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3EnterStepMode(c: *mut c_void) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        reject(
            c,
            invalid("the step mode cannot be entered: co-simulation has no event mode"),
        )
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3EvaluateDiscreteStates(c: *mut c_void) -> c_int {
    let modes = Mode::Initialization as u8 | EVENT;
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe { call(c, (modes, "fmi3EvaluateDiscreteStates"), |_| Ok(())) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3UpdateDiscreteStates(
    c: *mut c_void,
    again: *mut u8,
    terminate: *mut u8,
    nominals_changed: *mut u8,
    states_changed: *mut u8,
    next_defined: *mut u8,
    next: *mut f64,
) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        call(c, (EVENT, "fmi3UpdateDiscreteStates"), |unit| {
            let what = "the event's information";
            for flag in [
                again,
                terminate,
                nominals_changed,
                states_changed,
                next_defined,
            ] {
                write(flag, 0, what)?;
            }
            write(next, 0.0, what)?;
            let (is_changed, instant) = unit.apply_event()?;
            write(states_changed, u8::from(is_changed), what)?;
            write(next_defined, u8::from(instant.is_some()), what)?;
            write(next, instant.unwrap_or(0.0), what)
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3EnterContinuousTimeMode(c: *mut c_void) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        call(c, (EVENT, "fmi3EnterContinuousTimeMode"), |unit| {
            unit.now.mode = Mode::Continuous;
            Ok(())
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3CompletedIntegratorStep(
    c: *mut c_void,
    _no_set_before: u8,
    enter_event_mode: *mut u8,
    terminate: *mut u8,
) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        call(c, (CONTINUOUS, "fmi3CompletedIntegratorStep"), |unit| {
            write(terminate, 0, "a flag")?;
            write(enter_event_mode, 0, "a flag")?;
            let needs_event = unit.complete_step()?;
            write(enter_event_mode, u8::from(needs_event), "a flag")
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetTime(c: *mut c_void, time: f64) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        call(c, (EVENT | CONTINUOUS, "fmi3SetTime"), |unit| {
            unit.set_time(time)
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetContinuousStates(
    c: *mut c_void,
    states: *const f64,
    count: usize,
) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        call(c, (EVENT | CONTINUOUS, "fmi3SetContinuousStates"), |unit| {
            unit.set_states(array(states, count, "continuous states")?)
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetContinuousStateDerivatives(
    c: *mut c_void,
    rates: *mut f64,
    count: usize,
) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        write_vector(
            c,
            "fmi3GetContinuousStateDerivatives",
            (rates, count),
            Unit::finite_rates,
        )
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetEventIndicators(
    c: *mut c_void,
    indicators: *mut f64,
    count: usize,
) -> c_int {
    let out = (indicators, count);
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe { write_vector(c, "fmi3GetEventIndicators", out, Unit::finite_indicators) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetContinuousStates(
    c: *mut c_void,
    states: *mut f64,
    count: usize,
) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        write_vector(c, "fmi3GetContinuousStates", (states, count), |unit| {
            Ok(unit.now.state.clone())
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetNominalsOfContinuousStates(
    c: *mut c_void,
    nominals: *mut f64,
    count: usize,
) -> c_int {
    let name = "fmi3GetNominalsOfContinuousStates";
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        write_vector(c, name, (nominals, count), |unit| {
            Ok(unit.compiled.typical_sizes().to_vec())
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetNumberOfEventIndicators(
    c: *mut c_void,
    count: *mut usize,
) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        call(c, (ANY_MODE, "fmi3GetNumberOfEventIndicators"), |unit| {
            write(count, unit.layout.indicators, "a count")
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetNumberOfContinuousStates(
    c: *mut c_void,
    count: *mut usize,
) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        call(c, (ANY_MODE, "fmi3GetNumberOfContinuousStates"), |unit| {
            write(count, unit.layout.states, "a count")
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetOutputDerivatives(
    c: *mut c_void,
    _references: *const u32,
    count: usize,
    _orders: *const c_int,
    _values: *mut f64,
    _value_count: usize,
) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe { accept_none(c, count, "time derivatives of outputs are not provided") }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DoStep(
    c: *mut c_void,
    from: f64,
    length: f64,
    _no_set_before: u8,
    event_needed: *mut u8,
    terminate: *mut u8,
    early: *mut u8,
    last: *mut f64,
) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe {
        call(c, (STEP, "fmi3DoStep"), |unit| {
            let what = "the outcome of a step";
            for flag in [event_needed, terminate, early] {
                write(flag, 0, what)?;
            }
            write(last, unit.now.t, what)?;
            let ended = unit.make_step(from, length);
            write(last, unit.now.t, what)?;
            ended
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3ActivateModelPartition(
    c: *mut c_void,
    _clock: u32,
    _time: f64,
) -> c_int {
    // SAFETY: the importer's pointers, see `boundary`.
    unsafe { reject(c, invalid("scheduled execution is not supported")) }
}
