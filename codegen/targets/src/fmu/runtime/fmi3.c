/* Functions of FMI 3.0 for model exchange and co-simulation. */
#include <stdbool.h>

typedef void *fmi3Instance;
typedef void *fmi3InstanceEnvironment;
typedef void *fmi3FMUState;
typedef unsigned int fmi3ValueReference;
typedef float fmi3Float32;
typedef double fmi3Float64;
typedef int8_t fmi3Int8;
typedef uint8_t fmi3UInt8;
typedef int16_t fmi3Int16;
typedef uint16_t fmi3UInt16;
typedef int32_t fmi3Int32;
typedef uint32_t fmi3UInt32;
typedef int64_t fmi3Int64;
typedef uint64_t fmi3UInt64;
typedef bool fmi3Boolean;
typedef char fmi3Char;
typedef const fmi3Char *fmi3String;
typedef uint8_t fmi3Byte;
typedef const fmi3Byte *fmi3Binary;
typedef bool fmi3Clock;
typedef int fmi3Status;
typedef int fmi3DependencyKind;
typedef int fmi3IntervalQualifier;

typedef void (*logger3)(fmi3InstanceEnvironment, fmi3Status, fmi3String, fmi3String);

/* If several units are linked into one program, each needs a prefix for its functions. */
#ifdef FMI3_FUNCTION_PREFIX
#define JOIN_(a, b) a##b
#define JOIN(a, b) JOIN_(a, b)
#define FMI(name) JOIN(FMI3_FUNCTION_PREFIX, name)
#else
#define FMI(name) name
#endif

static void tell(const instance *unit, int status, const char *text) {
    const logger3 logger = (logger3)unit->logger;
    if (logger) {
        logger(unit->environment, status, "logStatusError", text);
    }
}

EXPORT const char *FMI(fmi3GetVersion)(void) {
    return "3.0";
}

EXPORT fmi3Status FMI(fmi3SetDebugLogging)(fmi3Instance c, fmi3Boolean on, size_t count, const fmi3String categories[]) {
    (void)on;
    return !c ? ERROR : is_there(categories, count) ? OK : refuse(c, ERROR, "a null pointer in place of categories");
}

EXPORT fmi3Instance FMI(fmi3InstantiateModelExchange)(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible, fmi3Boolean logging,
    fmi3InstanceEnvironment environment, logger3 logger
) {
    (void)resources;
    (void)visible;
    (void)logging;
    return make(name, token, 1, environment, (void (*)(void))logger);
}

EXPORT fmi3Instance FMI(fmi3InstantiateCoSimulation)(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible, fmi3Boolean logging,
    fmi3Boolean event_mode_used, fmi3Boolean early_return_allowed, const fmi3ValueReference required[],
    size_t required_count, fmi3InstanceEnvironment environment, logger3 logger, void (*intermediate_update)(void)
) {
    instance *unit = make(name, token, 0, environment, (void (*)(void))logger);
    (void)resources;
    (void)visible;
    (void)logging;
    (void)early_return_allowed;
    (void)required;
    (void)intermediate_update;
    if (unit && (event_mode_used || required_count > 0)) {
        refuse(unit, ERROR, "co-simulation has neither an event mode nor intermediate variables");
        discard(unit);
        return NULL;
    }
    return unit;
}

EXPORT fmi3Instance FMI(fmi3InstantiateScheduledExecution)(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible, fmi3Boolean logging,
    fmi3InstanceEnvironment environment, logger3 logger, void (*clock_update)(void), void (*lock)(void),
    void (*unlock)(void)
) {
    (void)name;
    (void)token;
    (void)resources;
    (void)visible;
    (void)logging;
    (void)clock_update;
    (void)lock;
    (void)unlock;
    if (logger) {
        logger(environment, ERROR, "logStatusError", "there is no scheduled execution");
    }
    return NULL;
}

EXPORT void FMI(fmi3FreeInstance)(fmi3Instance c) {
    discard(c);
}

EXPORT fmi3Status FMI(fmi3EnterInitializationMode)(
    fmi3Instance c, fmi3Boolean has_tolerance, fmi3Float64 tolerance, fmi3Float64 start, fmi3Boolean has_stop,
    fmi3Float64 stop
) {
    int status = allowed(c, INSTANTIATED, "fmi3EnterInitializationMode");
    if (status == OK) {
        status = set_up(c, has_tolerance, tolerance, start, has_stop, stop);
    }
    if (status == OK) {
        ((instance *)c)->now.mode = INITIALIZATION;
    }
    return status;
}

EXPORT fmi3Status FMI(fmi3ExitInitializationMode)(fmi3Instance c) {
    const int status = allowed(c, INITIALIZATION, "fmi3ExitInitializationMode");
    return status != OK ? status : end_initialization(c);
}

EXPORT fmi3Status FMI(fmi3EnterEventMode)(fmi3Instance c) {
    const int status = allowed(c, EVENT | CONTINUOUS, "fmi3EnterEventMode");
    if (status == OK) {
        ((instance *)c)->now.mode = EVENT;
    }
    return status;
}

EXPORT fmi3Status FMI(fmi3Terminate)(fmi3Instance c) {
    const int status = allowed(c, EVENT | CONTINUOUS | STEP, "fmi3Terminate");
    if (status == OK) {
        ((instance *)c)->now.mode = TERMINATED;
    }
    return status;
}

EXPORT fmi3Status FMI(fmi3Reset)(fmi3Instance c) {
    const int status = allowed(c, ANY, "fmi3Reset");
    if (status == OK) {
        begin(c);
    }
    return status;
}

EXPORT fmi3Status FMI(fmi3GetFloat64)(
    fmi3Instance c, const fmi3ValueReference vr[], size_t count, fmi3Float64 values[], size_t value_count
) {
    const int status = allowed(c, ANY, "fmi3GetFloat64");
    if (status == OK && count != value_count) {
        return refuse(c, ERROR, "not as many values as value references: all variables are scalars");
    }
    return status != OK ? status : get_values(c, vr, count, values);
}

EXPORT fmi3Status FMI(fmi3SetFloat64)(
    fmi3Instance c, const fmi3ValueReference vr[], size_t count, const fmi3Float64 values[], size_t value_count
) {
    const int status = allowed(c, ANY, "fmi3SetFloat64");
    if (status == OK && count != value_count) {
        return refuse(c, ERROR, "not as many values as value references: all variables are scalars");
    }
    return status != OK ? status : set_values(c, vr, count, values);
}

/* All variables are double-precision numbers; there are none of other types. */
static fmi3Status none_of_type(const instance *unit, size_t count) {
    return unit && count == 0 ? OK : refuse(unit, ERROR, "there are no variables of this type");
}

#define NONE_OF_TYPE_3(type) \
    EXPORT fmi3Status FMI(fmi3Get##type)( \
        fmi3Instance c, const fmi3ValueReference vr[], size_t count, fmi3##type values[], size_t value_count \
    ) { \
        (void)vr; \
        (void)values; \
        (void)value_count; \
        return none_of_type(c, count); \
    } \
    EXPORT fmi3Status FMI(fmi3Set##type)( \
        fmi3Instance c, const fmi3ValueReference vr[], size_t count, const fmi3##type values[], size_t value_count \
    ) { \
        (void)vr; \
        (void)values; \
        (void)value_count; \
        return none_of_type(c, count); \
    }

NONE_OF_TYPE_3(Float32)
NONE_OF_TYPE_3(Int8)
NONE_OF_TYPE_3(UInt8)
NONE_OF_TYPE_3(Int16)
NONE_OF_TYPE_3(UInt16)
NONE_OF_TYPE_3(Int32)
NONE_OF_TYPE_3(UInt32)
NONE_OF_TYPE_3(Int64)
NONE_OF_TYPE_3(UInt64)
NONE_OF_TYPE_3(Boolean)
NONE_OF_TYPE_3(String)

EXPORT fmi3Status FMI(fmi3GetBinary)(
    fmi3Instance c, const fmi3ValueReference vr[], size_t count, size_t sizes[], fmi3Binary values[],
    size_t value_count
) {
    (void)vr;
    (void)sizes;
    (void)values;
    (void)value_count;
    return none_of_type(c, count);
}

EXPORT fmi3Status FMI(fmi3SetBinary)(
    fmi3Instance c, const fmi3ValueReference vr[], size_t count, const size_t sizes[], const fmi3Binary values[],
    size_t value_count
) {
    (void)vr;
    (void)sizes;
    (void)values;
    (void)value_count;
    return none_of_type(c, count);
}

EXPORT fmi3Status FMI(fmi3GetClock)(fmi3Instance c, const fmi3ValueReference vr[], size_t count, fmi3Clock values[]) {
    (void)vr;
    (void)values;
    return none_of_type(c, count);
}

EXPORT fmi3Status FMI(fmi3SetClock)(fmi3Instance c, const fmi3ValueReference vr[], size_t count, const fmi3Clock values[]) {
    (void)vr;
    (void)values;
    return none_of_type(c, count);
}

EXPORT fmi3Status FMI(fmi3GetNumberOfVariableDependencies)(fmi3Instance c, fmi3ValueReference vr, size_t *count) {
    (void)vr;
    (void)count;
    return refuse(c, ERROR, "dependencies are those of the description: no variable changes its size");
}

EXPORT fmi3Status FMI(fmi3GetVariableDependencies)(
    fmi3Instance c, fmi3ValueReference dependent, size_t dependent_elements[], fmi3ValueReference independents[],
    size_t independent_elements[], fmi3DependencyKind kinds[], size_t count
) {
    (void)dependent;
    (void)dependent_elements;
    (void)independents;
    (void)independent_elements;
    (void)kinds;
    (void)count;
    return refuse(c, ERROR, "dependencies are those of the description: no variable changes its size");
}

EXPORT fmi3Status FMI(fmi3GetFMUState)(fmi3Instance c, fmi3FMUState *saved) {
    const int status = allowed(c, ANY, "fmi3GetFMUState");
    return status != OK ? status : save(c, saved);
}

EXPORT fmi3Status FMI(fmi3SetFMUState)(fmi3Instance c, fmi3FMUState saved) {
    const int status = allowed(c, ANY, "fmi3SetFMUState");
    return status != OK ? status : restore(c, saved);
}

EXPORT fmi3Status FMI(fmi3FreeFMUState)(fmi3Instance c, fmi3FMUState *saved) {
    const int status = allowed(c, ANY, "fmi3FreeFMUState");
    return status != OK ? status : forget(c, saved);
}

EXPORT fmi3Status FMI(fmi3SerializedFMUStateSize)(fmi3Instance c, fmi3FMUState saved, size_t *size) {
    (void)saved;
    if (!c || !size) {
        return refuse(c, ERROR, "a null pointer in place of a size");
    }
    *size = SERIALISED;
    return OK;
}

EXPORT fmi3Status FMI(fmi3SerializeFMUState)(fmi3Instance c, fmi3FMUState saved, fmi3Byte bytes[], size_t size) {
    const int status = allowed(c, ANY, "fmi3SerializeFMUState");
    return status != OK ? status : serialise(c, saved, bytes, size);
}

EXPORT fmi3Status FMI(fmi3DeserializeFMUState)(fmi3Instance c, const fmi3Byte bytes[], size_t size, fmi3FMUState *saved) {
    const int status = allowed(c, ANY, "fmi3DeserializeFMUState");
    return status != OK ? status : deserialise(c, bytes, size, saved);
}

EXPORT fmi3Status FMI(fmi3GetDirectionalDerivative)(
    fmi3Instance c, const fmi3ValueReference unknowns[], size_t unknown_count, const fmi3ValueReference knowns[],
    size_t known_count, const fmi3Float64 seed[], size_t seed_count, fmi3Float64 sensitivity[],
    size_t sensitivity_count
) {
    const int status = allowed(c, ANY, "fmi3GetDirectionalDerivative");
    if (status == OK && (seed_count != known_count || sensitivity_count != unknown_count)) {
        return refuse(c, ERROR, "not as many derivatives as variables");
    }
    return status != OK ? status
                        : differentiate(c, 0, unknowns, unknown_count, knowns, known_count, seed, sensitivity);
}

EXPORT fmi3Status FMI(fmi3GetAdjointDerivative)(
    fmi3Instance c, const fmi3ValueReference unknowns[], size_t unknown_count, const fmi3ValueReference knowns[],
    size_t known_count, const fmi3Float64 seed[], size_t seed_count, fmi3Float64 sensitivity[],
    size_t sensitivity_count
) {
    const int status = allowed(c, ANY, "fmi3GetAdjointDerivative");
    if (status == OK && (seed_count != unknown_count || sensitivity_count != known_count)) {
        return refuse(c, ERROR, "not as many derivatives as variables");
    }
    return status != OK ? status
                        : differentiate(c, 1, unknowns, unknown_count, knowns, known_count, seed, sensitivity);
}

EXPORT fmi3Status FMI(fmi3EnterConfigurationMode)(fmi3Instance c) {
    return refuse(c, ERROR, "there is nothing to configure");
}

EXPORT fmi3Status FMI(fmi3ExitConfigurationMode)(fmi3Instance c) {
    return refuse(c, ERROR, "there is nothing to configure");
}

EXPORT fmi3Status FMI(fmi3GetIntervalDecimal)(
    fmi3Instance c, const fmi3ValueReference vr[], size_t count, fmi3Float64 intervals[],
    fmi3IntervalQualifier qualifiers[]
) {
    (void)vr;
    (void)intervals;
    (void)qualifiers;
    return none_of_type(c, count);
}

EXPORT fmi3Status FMI(fmi3GetIntervalFraction)(
    fmi3Instance c, const fmi3ValueReference vr[], size_t count, fmi3UInt64 counters[], fmi3UInt64 resolutions[],
    fmi3IntervalQualifier qualifiers[]
) {
    (void)vr;
    (void)counters;
    (void)resolutions;
    (void)qualifiers;
    return none_of_type(c, count);
}

EXPORT fmi3Status FMI(fmi3GetShiftDecimal)(
    fmi3Instance c, const fmi3ValueReference vr[], size_t count, fmi3Float64 shifts[]
) {
    (void)vr;
    (void)shifts;
    return none_of_type(c, count);
}

EXPORT fmi3Status FMI(fmi3GetShiftFraction)(
    fmi3Instance c, const fmi3ValueReference vr[], size_t count, fmi3UInt64 counters[], fmi3UInt64 resolutions[]
) {
    (void)vr;
    (void)counters;
    (void)resolutions;
    return none_of_type(c, count);
}

EXPORT fmi3Status FMI(fmi3SetIntervalDecimal)(
    fmi3Instance c, const fmi3ValueReference vr[], size_t count, const fmi3Float64 intervals[]
) {
    (void)vr;
    (void)intervals;
    return none_of_type(c, count);
}

EXPORT fmi3Status FMI(fmi3SetIntervalFraction)(
    fmi3Instance c, const fmi3ValueReference vr[], size_t count, const fmi3UInt64 counters[],
    const fmi3UInt64 resolutions[]
) {
    (void)vr;
    (void)counters;
    (void)resolutions;
    return none_of_type(c, count);
}

EXPORT fmi3Status FMI(fmi3SetShiftDecimal)(
    fmi3Instance c, const fmi3ValueReference vr[], size_t count, const fmi3Float64 shifts[]
) {
    (void)vr;
    (void)shifts;
    return none_of_type(c, count);
}

EXPORT fmi3Status FMI(fmi3SetShiftFraction)(
    fmi3Instance c, const fmi3ValueReference vr[], size_t count, const fmi3UInt64 counters[],
    const fmi3UInt64 resolutions[]
) {
    (void)vr;
    (void)counters;
    (void)resolutions;
    return none_of_type(c, count);
}

EXPORT fmi3Status FMI(fmi3EvaluateDiscreteStates)(fmi3Instance c) {
    return allowed(c, INITIALIZATION | EVENT, "fmi3EvaluateDiscreteStates");
}

EXPORT fmi3Status FMI(fmi3UpdateDiscreteStates)(
    fmi3Instance c, fmi3Boolean *again, fmi3Boolean *terminate, fmi3Boolean *nominals_changed,
    fmi3Boolean *states_changed, fmi3Boolean *next_defined, fmi3Float64 *next
) {
    int changed;
    const int status = allowed(c, EVENT, "fmi3UpdateDiscreteStates");
    if (status != OK || !again || !terminate || !nominals_changed || !states_changed || !next_defined || !next) {
        return refuse(status == OK ? c : NULL, ERROR, "a null pointer in place of the event's information");
    }
    *again = *terminate = *nominals_changed = *states_changed = *next_defined = false;
    *next = 0;
    return update_sides(c, &changed);
}

EXPORT fmi3Status FMI(fmi3EnterContinuousTimeMode)(fmi3Instance c) {
    const int status = allowed(c, EVENT, "fmi3EnterContinuousTimeMode");
    if (status == OK) {
        ((instance *)c)->now.mode = CONTINUOUS;
    }
    return status;
}

EXPORT fmi3Status FMI(fmi3CompletedIntegratorStep)(
    fmi3Instance c, fmi3Boolean no_set_before, fmi3Boolean *enter_event_mode, fmi3Boolean *terminate
) {
    int status = allowed(c, CONTINUOUS, "fmi3CompletedIntegratorStep");
    (void)no_set_before;
    if (status != OK || !enter_event_mode || !terminate) {
        return refuse(status == OK ? c : NULL, ERROR, "a null pointer in place of a flag");
    }
    *enter_event_mode = false;
    *terminate = false;
    status = be_ready(c);
    if (status == OK) {
        note_magnitudes(c);
    }
    return status;
}

EXPORT fmi3Status FMI(fmi3SetTime)(fmi3Instance c, fmi3Float64 time) {
    const int status = allowed(c, EVENT | CONTINUOUS, "fmi3SetTime");
    return status != OK ? status : set_time(c, time);
}

EXPORT fmi3Status FMI(fmi3SetContinuousStates)(fmi3Instance c, const fmi3Float64 states[], size_t count) {
    const int status = allowed(c, EVENT | CONTINUOUS, "fmi3SetContinuousStates");
    return status != OK ? status : set_states(c, states, count);
}

EXPORT fmi3Status FMI(fmi3GetContinuousStateDerivatives)(fmi3Instance c, fmi3Float64 rates[], size_t count) {
    const int status = allowed(c, ANY, "fmi3GetContinuousStateDerivatives");
    return status != OK ? status : get_derivatives(c, rates, count);
}

EXPORT fmi3Status FMI(fmi3GetEventIndicators)(fmi3Instance c, fmi3Float64 indicators[], size_t count) {
    const int status = allowed(c, ANY, "fmi3GetEventIndicators");
    return status != OK ? status : get_indicators(c, indicators, count);
}

EXPORT fmi3Status FMI(fmi3GetContinuousStates)(fmi3Instance c, fmi3Float64 states[], size_t count) {
    const int status = allowed(c, ANY, "fmi3GetContinuousStates");
    return status != OK ? status : get_states(c, states, count);
}

EXPORT fmi3Status FMI(fmi3GetNominalsOfContinuousStates)(fmi3Instance c, fmi3Float64 nominals[], size_t count) {
    const int status = allowed(c, ANY, "fmi3GetNominalsOfContinuousStates");
    return status != OK ? status : get_nominals(c, nominals, count);
}

static fmi3Status count_of(const instance *unit, size_t *count, size_t number) {
    if (!unit || !count) {
        return refuse(unit, ERROR, "a null pointer in place of a count");
    }
    *count = number;
    return OK;
}

EXPORT fmi3Status FMI(fmi3GetNumberOfEventIndicators)(fmi3Instance c, size_t *count) {
    return count_of(c, count, MODEL(GUARDS));
}

EXPORT fmi3Status FMI(fmi3GetNumberOfContinuousStates)(fmi3Instance c, size_t *count) {
    return count_of(c, count, MODEL(STATES));
}

EXPORT fmi3Status FMI(fmi3EnterStepMode)(fmi3Instance c) {
    return refuse(c, ERROR, "co-simulation has no event mode to come from");
}

EXPORT fmi3Status FMI(fmi3GetOutputDerivatives)(
    fmi3Instance c, const fmi3ValueReference vr[], size_t count, const fmi3Int32 orders[], fmi3Float64 values[],
    size_t value_count
) {
    (void)vr;
    (void)orders;
    (void)values;
    (void)value_count;
    return c && count == 0 ? OK : refuse(c, ERROR, "derivatives of outputs by the time are not given");
}

EXPORT fmi3Status FMI(fmi3DoStep)(
    fmi3Instance c, fmi3Float64 from, fmi3Float64 length, fmi3Boolean no_set_before, fmi3Boolean *event_needed,
    fmi3Boolean *terminate, fmi3Boolean *early, fmi3Float64 *last
) {
    int status = allowed(c, STEP, "fmi3DoStep");
    (void)no_set_before;
    if (status != OK || !event_needed || !terminate || !early || !last) {
        return refuse(status == OK ? c : NULL, ERROR, "a null pointer in place of a step's outcome");
    }
    *event_needed = *terminate = *early = false;
    status = communicate(c, from, length);
    *last = ((instance *)c)->now.t;
    return status;
}

EXPORT fmi3Status FMI(fmi3ActivateModelPartition)(fmi3Instance c, fmi3ValueReference clock, fmi3Float64 time) {
    (void)clock;
    (void)time;
    return refuse(c, ERROR, "there is no scheduled execution");
}
