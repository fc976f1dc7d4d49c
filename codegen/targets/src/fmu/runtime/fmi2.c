/* Functions of FMI 2.0 for model exchange and co-simulation. */

typedef void *fmi2Component;
typedef void *fmi2ComponentEnvironment;
typedef void *fmi2FMUstate;
typedef unsigned int fmi2ValueReference;
typedef double fmi2Real;
typedef int fmi2Integer;
typedef int fmi2Boolean;
typedef char fmi2Char;
typedef const fmi2Char *fmi2String;
typedef char fmi2Byte;
typedef int fmi2Status;
typedef int fmi2Type;
typedef int fmi2StatusKind;

enum { EXCHANGE_2 = 0, COSIMULATION_2 = 1 };
/* Arguments of fmi2GetRealStatus. */
enum { LAST_SUCCESSFUL_TIME_2 = 2 };

typedef void (*logger2)(fmi2ComponentEnvironment, fmi2String, fmi2Status, fmi2String, fmi2String, ...);

typedef struct {
    logger2 logger;
    void *(*allocateMemory)(size_t, size_t);
    void (*freeMemory)(void *);
    void (*stepFinished)(fmi2ComponentEnvironment, fmi2Status);
    fmi2ComponentEnvironment componentEnvironment;
} fmi2CallbackFunctions;

typedef struct {
    fmi2Boolean newDiscreteStatesNeeded;
    fmi2Boolean terminateSimulation;
    fmi2Boolean nominalsOfContinuousStatesChanged;
    fmi2Boolean valuesOfContinuousStatesChanged;
    fmi2Boolean nextEventTimeDefined;
    fmi2Real nextEventTime;
} fmi2EventInfo;

/* If several units are linked into one program, each needs a prefix for its functions. */
#ifdef FMI2_FUNCTION_PREFIX
#define JOIN_(a, b) a##b
#define JOIN(a, b) JOIN_(a, b)
#define FMI(name) JOIN(FMI2_FUNCTION_PREFIX, name)
#else
#define FMI(name) name
#endif

static void tell(const instance *unit, int status, const char *text) {
    const logger2 logger = (logger2)unit->logger;
    if (logger) {
        logger(unit->environment, unit->name ? unit->name : "", status, "logStatusError", "%s", text);
    }
}

EXPORT const char *FMI(fmi2GetTypesPlatform)(void) {
    return "default";
}

EXPORT const char *FMI(fmi2GetVersion)(void) {
    return "2.0";
}

EXPORT fmi2Status FMI(fmi2SetDebugLogging)(fmi2Component c, fmi2Boolean on, size_t count, const fmi2String categories[]) {
    (void)on;
    return !c ? ERROR : is_there(categories, count) ? OK : refuse(c, ERROR, "a null pointer in place of categories");
}

EXPORT fmi2Component FMI(fmi2Instantiate)(
    fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources, const fmi2CallbackFunctions *functions,
    fmi2Boolean visible, fmi2Boolean logging
) {
    (void)resources;
    (void)visible;
    (void)logging;
    if (type != EXCHANGE_2 && type != COSIMULATION_2) {
        return NULL;
    }
    return make(
        name, guid, type == EXCHANGE_2, functions ? functions->componentEnvironment : NULL,
        functions ? (void (*)(void))functions->logger : NULL
    );
}

EXPORT void FMI(fmi2FreeInstance)(fmi2Component c) {
    discard(c);
}

EXPORT fmi2Status FMI(fmi2SetupExperiment)(
    fmi2Component c, fmi2Boolean has_tolerance, fmi2Real tolerance, fmi2Real start, fmi2Boolean has_stop, fmi2Real stop
) {
    const int status = allowed(c, INSTANTIATED, "fmi2SetupExperiment");
    return status != OK ? status : set_up(c, has_tolerance, tolerance, start, has_stop, stop);
}

EXPORT fmi2Status FMI(fmi2EnterInitializationMode)(fmi2Component c) {
    const int status = allowed(c, INSTANTIATED, "fmi2EnterInitializationMode");
    if (status == OK) {
        ((instance *)c)->now.mode = INITIALIZATION;
    }
    return status;
}

EXPORT fmi2Status FMI(fmi2ExitInitializationMode)(fmi2Component c) {
    const int status = allowed(c, INITIALIZATION, "fmi2ExitInitializationMode");
    return status != OK ? status : end_initialization(c);
}

EXPORT fmi2Status FMI(fmi2Terminate)(fmi2Component c) {
    const int status = allowed(c, EVENT | CONTINUOUS | STEP, "fmi2Terminate");
    if (status == OK) {
        ((instance *)c)->now.mode = TERMINATED;
    }
    return status;
}

EXPORT fmi2Status FMI(fmi2Reset)(fmi2Component c) {
    const int status = allowed(c, ANY, "fmi2Reset");
    if (status == OK) {
        begin(c);
    }
    return status;
}

EXPORT fmi2Status FMI(fmi2GetReal)(fmi2Component c, const fmi2ValueReference vr[], size_t count, fmi2Real values[]) {
    const int status = allowed(c, ANY, "fmi2GetReal");
    return status != OK ? status : get_values(c, vr, count, values);
}

EXPORT fmi2Status FMI(fmi2SetReal)(fmi2Component c, const fmi2ValueReference vr[], size_t count, const fmi2Real values[]) {
    const int status = allowed(c, ANY, "fmi2SetReal");
    return status != OK ? status : set_values(c, vr, count, values);
}

/* All variables are real; there are none of other types. */
static fmi2Status none_of_type(const instance *unit, size_t count) {
    return unit && count == 0 ? OK : refuse(unit, ERROR, "there are no variables of this type");
}

#define NONE_OF_TYPE_2(type) \
    EXPORT fmi2Status FMI(fmi2Get##type)(fmi2Component c, const fmi2ValueReference vr[], size_t count, fmi2##type values[]) { \
        (void)vr; \
        (void)values; \
        return none_of_type(c, count); \
    } \
    EXPORT fmi2Status FMI(fmi2Set##type)( \
        fmi2Component c, const fmi2ValueReference vr[], size_t count, const fmi2##type values[] \
    ) { \
        (void)vr; \
        (void)values; \
        return none_of_type(c, count); \
    }

NONE_OF_TYPE_2(Integer)
NONE_OF_TYPE_2(Boolean)
NONE_OF_TYPE_2(String)

EXPORT fmi2Status FMI(fmi2GetFMUstate)(fmi2Component c, fmi2FMUstate *saved) {
    const int status = allowed(c, ANY, "fmi2GetFMUstate");
    return status != OK ? status : save(c, saved);
}

EXPORT fmi2Status FMI(fmi2SetFMUstate)(fmi2Component c, fmi2FMUstate saved) {
    const int status = allowed(c, ANY, "fmi2SetFMUstate");
    return status != OK ? status : restore(c, saved);
}

EXPORT fmi2Status FMI(fmi2FreeFMUstate)(fmi2Component c, fmi2FMUstate *saved) {
    const int status = allowed(c, ANY, "fmi2FreeFMUstate");
    return status != OK ? status : forget(c, saved);
}

EXPORT fmi2Status FMI(fmi2SerializedFMUstateSize)(fmi2Component c, fmi2FMUstate saved, size_t *size) {
    (void)saved;
    if (!c || !size) {
        return refuse(c, ERROR, "a null pointer in place of a size");
    }
    *size = SERIALISED;
    return OK;
}

EXPORT fmi2Status FMI(fmi2SerializeFMUstate)(fmi2Component c, fmi2FMUstate saved, fmi2Byte bytes[], size_t size) {
    const int status = allowed(c, ANY, "fmi2SerializeFMUstate");
    return status != OK ? status : serialise(c, saved, (unsigned char *)bytes, size);
}

EXPORT fmi2Status FMI(fmi2DeSerializeFMUstate)(fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate *saved) {
    const int status = allowed(c, ANY, "fmi2DeSerializeFMUstate");
    return status != OK ? status : deserialise(c, (const unsigned char *)bytes, size, saved);
}

EXPORT fmi2Status FMI(fmi2GetDirectionalDerivative)(
    fmi2Component c, const fmi2ValueReference unknowns[], size_t unknown_count, const fmi2ValueReference knowns[],
    size_t known_count, const fmi2Real seed[], fmi2Real sensitivity[]
) {
    const int status = allowed(c, ANY, "fmi2GetDirectionalDerivative");
    return status != OK ? status
                        : differentiate(c, 0, unknowns, unknown_count, knowns, known_count, seed, sensitivity);
}

EXPORT fmi2Status FMI(fmi2EnterEventMode)(fmi2Component c) {
    const int status = allowed(c, EVENT | CONTINUOUS, "fmi2EnterEventMode");
    if (status == OK) {
        ((instance *)c)->now.mode = EVENT;
    }
    return status;
}

EXPORT fmi2Status FMI(fmi2NewDiscreteStates)(fmi2Component c, fmi2EventInfo *info) {
    int changed;
    const int status = allowed(c, EVENT, "fmi2NewDiscreteStates");
    if (status != OK || !info) {
        return refuse(status == OK ? c : NULL, ERROR, "a null pointer in place of the event's information");
    }
    memset(info, 0, sizeof *info);
    return update_sides(c, &changed);
}

EXPORT fmi2Status FMI(fmi2EnterContinuousTimeMode)(fmi2Component c) {
    const int status = allowed(c, EVENT, "fmi2EnterContinuousTimeMode");
    if (status == OK) {
        ((instance *)c)->now.mode = CONTINUOUS;
    }
    return status;
}

EXPORT fmi2Status FMI(fmi2CompletedIntegratorStep)(
    fmi2Component c, fmi2Boolean no_set_before, fmi2Boolean *enter_event_mode, fmi2Boolean *terminate
) {
    int status = allowed(c, CONTINUOUS, "fmi2CompletedIntegratorStep");
    (void)no_set_before;
    if (status != OK || !enter_event_mode || !terminate) {
        return refuse(status == OK ? c : NULL, ERROR, "a null pointer in place of a flag");
    }
    *enter_event_mode = 0;
    *terminate = 0;
    status = be_ready(c);
    if (status == OK) {
        note_magnitudes(c);
    }
    return status;
}

EXPORT fmi2Status FMI(fmi2SetTime)(fmi2Component c, fmi2Real time) {
    const int status = allowed(c, EVENT | CONTINUOUS, "fmi2SetTime");
    return status != OK ? status : set_time(c, time);
}

EXPORT fmi2Status FMI(fmi2SetContinuousStates)(fmi2Component c, const fmi2Real states[], size_t count) {
    const int status = allowed(c, EVENT | CONTINUOUS, "fmi2SetContinuousStates");
    return status != OK ? status : set_states(c, states, count);
}

EXPORT fmi2Status FMI(fmi2GetDerivatives)(fmi2Component c, fmi2Real rates[], size_t count) {
    const int status = allowed(c, ANY, "fmi2GetDerivatives");
    return status != OK ? status : get_derivatives(c, rates, count);
}

EXPORT fmi2Status FMI(fmi2GetEventIndicators)(fmi2Component c, fmi2Real indicators[], size_t count) {
    const int status = allowed(c, ANY, "fmi2GetEventIndicators");
    return status != OK ? status : get_indicators(c, indicators, count);
}

EXPORT fmi2Status FMI(fmi2GetContinuousStates)(fmi2Component c, fmi2Real states[], size_t count) {
    const int status = allowed(c, ANY, "fmi2GetContinuousStates");
    return status != OK ? status : get_states(c, states, count);
}

EXPORT fmi2Status FMI(fmi2GetNominalsOfContinuousStates)(fmi2Component c, fmi2Real nominals[], size_t count) {
    const int status = allowed(c, ANY, "fmi2GetNominalsOfContinuousStates");
    return status != OK ? status : get_nominals(c, nominals, count);
}

EXPORT fmi2Status FMI(fmi2SetRealInputDerivatives)(
    fmi2Component c, const fmi2ValueReference vr[], size_t count, const fmi2Integer orders[], const fmi2Real values[]
) {
    (void)vr;
    (void)orders;
    (void)values;
    return c && count == 0 ? OK : refuse(c, ERROR, "inputs are held during a step: their derivatives are not used");
}

EXPORT fmi2Status FMI(fmi2GetRealOutputDerivatives)(
    fmi2Component c, const fmi2ValueReference vr[], size_t count, const fmi2Integer orders[], fmi2Real values[]
) {
    (void)vr;
    (void)orders;
    (void)values;
    return c && count == 0 ? OK : refuse(c, ERROR, "derivatives of outputs by the time are not given");
}

EXPORT fmi2Status FMI(fmi2DoStep)(fmi2Component c, fmi2Real from, fmi2Real length, fmi2Boolean no_set_before) {
    const int status = allowed(c, STEP, "fmi2DoStep");
    (void)no_set_before;
    return status != OK ? status : communicate(c, from, length);
}

EXPORT fmi2Status FMI(fmi2CancelStep)(fmi2Component c) {
    return refuse(c, ERROR, "there is no step to cancel: steps are not asynchronous");
}

static fmi2Status no_status(const instance *unit) {
    return refuse(unit, unit ? DISCARD : ERROR, "of this there is no status");
}

EXPORT fmi2Status FMI(fmi2GetStatus)(fmi2Component c, fmi2StatusKind kind, fmi2Status *value) {
    (void)kind;
    (void)value;
    return no_status(c);
}

EXPORT fmi2Status FMI(fmi2GetRealStatus)(fmi2Component c, fmi2StatusKind kind, fmi2Real *value) {
    if (!c || !value || kind != LAST_SUCCESSFUL_TIME_2) {
        return no_status(c);
    }
    *value = ((instance *)c)->now.t;
    return OK;
}

EXPORT fmi2Status FMI(fmi2GetIntegerStatus)(fmi2Component c, fmi2StatusKind kind, fmi2Integer *value) {
    (void)kind;
    (void)value;
    return no_status(c);
}

EXPORT fmi2Status FMI(fmi2GetBooleanStatus)(fmi2Component c, fmi2StatusKind kind, fmi2Boolean *value) {
    (void)kind;
    (void)value;
    return no_status(c);
}

EXPORT fmi2Status FMI(fmi2GetStringStatus)(fmi2Component c, fmi2StatusKind kind, fmi2String *value) {
    (void)kind;
    (void)value;
    return no_status(c);
}
