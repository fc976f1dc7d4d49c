/* An instance of a functional mock-up unit: what it knows, and what is asked of it by both versions
 * of the interface. The model is reached by MODEL(name), its sizes by MODEL(STATES) and the like.
 * Nothing outlives an instance, so that several may be used at once. */
#include <float.h>
#include <limits.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What both versions number alike. */
enum { OK = 0, DISCARD = 2, ERROR = 3 };

/* Where an instance is in its life; bits, so that a call can name all that it is allowed in. */
enum {
    INSTANTIATED = 1,
    INITIALIZATION = 2,
    EVENT = 4,
    CONTINUOUS = 8,
    STEP = 16,
    TERMINATED = 32,
    ANY = 63
};

/* The places of all variables: value references are one sequence. */
#define FIRST_STATE 1
#define FIRST_RATE (FIRST_STATE + MODEL(STATES))
#define FIRST_INPUT (FIRST_RATE + MODEL(STATES))
#define FIRST_PARAMETER (FIRST_INPUT + MODEL(INPUTS))
#define FIRST_OBSERVABLE (FIRST_PARAMETER + MODEL(PARAMETERS))
#define FIRST_INDICATOR (FIRST_OBSERVABLE + MODEL(OBSERVABLES))
#define VARIABLES (FIRST_INDICATOR + MODEL(GUARDS))

/* Bits that the number of a regime has; later switching surfaces are looked up at every state. */
#define REGIME_BITS 32

/* All that changes: what a saved state of the unit consists of. C has no array without elements,
 * hence one more than there are. */
typedef struct {
    double t;
    double state[MODEL(STATES) + 1];
    double inputs[MODEL(INPUTS) + 1];
    double parameters[MODEL(PARAMETERS) + 1];
    /* The largest values so far, by which small is judged. */
    double magnitudes[MODEL(STATES) + 1];
    double reaches[MODEL(GUARDS) + 1];
    double tolerance;
    double stop;
    /* The step that the solver would try next; 0 if it has to find one. */
    double step;
    int has_stop;
    /* On which side of each switching surface the motion is: 1, -1, or 0 where it rests on it. */
    int sides[MODEL(GUARDS) + 1];
    int sides_known;
    int mode;
    /* As in the instance: no other kind goes on from here. */
    int is_exchange;
} point;

typedef struct {
    point now;
    int is_exchange;
    int coefficients_known;
    MODEL(coefficients) coefficients;
    char *name;
    void *environment;
    /* The caller's logger, as the version of the interface has it. */
    void (*logger)(void);
} instance;

/* Tells the caller; given by the version of the interface. */
static void tell(const instance *unit, int status, const char *text);

/* Tells the caller why, and passes the status on. */
static int refuse(const instance *unit, int status, const char *text) {
    if (unit) {
        tell(unit, status, text);
    }
    return status;
}

/* The same of a quantity: its name, and what it was to be. */
static int refuse_value(const instance *unit, int status, const char *name, double value, const char *why) {
    char text[512];
    snprintf(text, sizeof text, "%.200s = %.17g: %.200s", name, value, why);
    return refuse(unit, status, text);
}

/* Whether a call is allowed now: the status to give back if it is not. */
static int allowed(const instance *unit, int modes, const char *call) {
    char text[160];
    if (!unit) {
        return ERROR;
    }
    if (unit->now.mode & modes) {
        return OK;
    }
    snprintf(text, sizeof text, "%.80s is not allowed in the present state of the unit", call);
    return refuse(unit, ERROR, text);
}

static double magnitude(double x) {
    return x < 0 ? -x : x;
}

static int is_finite(double x) {
    return magnitude(x) <= DBL_MAX;
}

/* Whether numbers can be passed: some pointer, unless there are none. */
static int is_there(const void *numbers, size_t count) {
    return count == 0 || numbers != NULL;
}

/* As at the beginning, with the specification's values. */
static void begin(instance *unit) {
    memset(&unit->now, 0, sizeof unit->now);
    for (int i = 0; i < MODEL(STATES); ++i) {
        unit->now.state[i] = initial_state[i];
    }
    for (int i = 0; i < MODEL(PARAMETERS); ++i) {
        unit->now.parameters[i] = parameter_values[i];
    }
    unit->now.tolerance = DEFAULT_TOLERANCE;
    unit->now.mode = INSTANTIATED;
    unit->now.is_exchange = unit->is_exchange;
    unit->coefficients_known = 0;
}

static instance *make(const char *name, const char *token, int is_exchange, void *environment, void (*logger)(void)) {
    instance *unit = calloc(1, sizeof *unit);
    size_t length = name ? strlen(name) : 0;
    if (!unit) {
        return NULL;
    }
    unit->environment = environment;
    unit->logger = logger;
    unit->is_exchange = is_exchange;
    unit->name = calloc(length + 1, 1);
    if (unit->name && length > 0) {
        memcpy(unit->name, name, length);
        if (token && strcmp(token, TOKEN) == 0) {
            begin(unit);
            return unit;
        }
        refuse(unit, ERROR, "the token is not that of this unit: its description belongs to another");
    } else if (unit->name) {
        refuse(unit, ERROR, "the instance has no name");
    }
    free(unit->name);
    free(unit);
    return NULL;
}

static void discard(instance *unit) {
    if (unit) {
        free(unit->name);
        free(unit);
    }
}
