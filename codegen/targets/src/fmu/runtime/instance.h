/* Instance of a functional mock-up unit, for both versions of the interface. MODEL(name) is a name of the model, for
 * example MODEL(STATES). There is no global state, so that several instances can be used at the same time. */
#include <float.h>
#include <limits.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Status values, equal in both versions. */
enum { OK = 0, DISCARD = 2, ERROR = 3 };

/* Modes of an instance, as bits, so that a call can list its allowed modes. */
enum {
    INSTANTIATED = 1,
    INITIALIZATION = 2,
    EVENT = 4,
    CONTINUOUS = 8,
    STEP = 16,
    TERMINATED = 32,
    ANY = 63
};

/* First value reference of each kind of variable. */
#define FIRST_STATE 1
#define FIRST_RATE (FIRST_STATE + MODEL(STATES))
#define FIRST_INPUT (FIRST_RATE + MODEL(STATES))
#define FIRST_PARAMETER (FIRST_INPUT + MODEL(INPUTS))
#define FIRST_OBSERVABLE (FIRST_PARAMETER + MODEL(PARAMETERS))
#define FIRST_INDICATOR (FIRST_OBSERVABLE + MODEL(OBSERVABLES))
#define VARIABLES (FIRST_INDICATOR + MODEL(GUARDS))

/* Number of bits of a regime; sides of further switching surfaces are computed at every state. */
#define REGIME_BITS 32

/* Variable part of an instance, the content of a saved state. C has no empty arrays, so each has one element
 * more than needed. */
typedef struct {
    double t;
    double state[MODEL(STATES) + 1];
    double inputs[MODEL(INPUTS) + 1];
    double parameters[MODEL(PARAMETERS) + 1];
    /* Largest values so far, the scale of small differences. */
    double magnitudes[MODEL(STATES) + 1];
    double reaches[MODEL(GUARDS) + 1];
    double tolerance;
    double stop;
    /* Next step size of the solver; 0 if unknown. */
    double step;
    int has_stop;
    /* Side of each switching surface: 1, -1, or 0 on the surface. */
    int sides[MODEL(GUARDS) + 1];
    int sides_known;
    int mode;
    /* Kind of the instance; a saved state restores instances of this kind only. */
    int is_exchange;
} point;

typedef struct {
    point now;
    int is_exchange;
    int coefficients_known;
    MODEL(coefficients) coefficients;
    char *name;
    void *environment;
    /* Logger of the caller. */
    void (*logger)(void);
} instance;

/* Logs a message; defined by the version of the interface. */
static void tell(const instance *unit, int status, const char *text);

/* Logs a message and returns the status. */
static int refuse(const instance *unit, int status, const char *text) {
    if (unit) {
        tell(unit, status, text);
    }
    return status;
}

/* Logs a message about a quantity and its expected value. */
static int refuse_value(const instance *unit, int status, const char *name, double value, const char *why) {
    char text[512];
    snprintf(text, sizeof text, "%.200s = %.17g: %.200s", name, value, why);
    return refuse(unit, status, text);
}

/* Checks whether a call is allowed in the current mode; returns the status of an error otherwise. */
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

/* Checks that the pointer is not null unless the count is 0. */
static int is_there(const void *numbers, size_t count) {
    return count == 0 || numbers != NULL;
}

/* Resets an instance to the values of the specification. */
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
