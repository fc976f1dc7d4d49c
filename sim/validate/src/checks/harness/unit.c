/* Loads the library of a functional mock-up unit, then reads values of the variables `given` and prints those of the
 * variables `asked`, as hexadecimal bits. Words: library, token, resources. */
#include <inttypes.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef _WIN32
#include <windows.h>
#else
#include <dlfcn.h>
#endif

/*BITS*/
static const uint32_t given[] = {/*GIVEN*/0};
static const uint32_t asked[] = {/*ASKED*/0};
#define GIVEN (sizeof given / sizeof *given - 1)
#define ASKED (sizeof asked / sizeof *asked - 1)

static void stop(const char *reason) {
    fprintf(stderr, "%s\n", reason);
    exit(1);
}

static void require(int status, const char *name) {
    if (status != 0) {
        fprintf(stderr, "%s returns status %d\n", name, status);
        exit(1);
    }
}

static void *library;

/* Sets a pointer to a function of the library. */
static void find(void *pointer, const char *name) {
#ifdef _WIN32
    FARPROC found = GetProcAddress((HMODULE)library, name);
#else
    void *found = dlsym(library, name);
#endif
    if (!found) {
        fprintf(stderr, "the library lacks %s\n", name);
        exit(1);
    }
    memcpy(pointer, &found, sizeof found);
}

#if VERSION == 2
typedef void (*logger)(void *, const char *, int, const char *, const char *, ...);
typedef struct {
    logger log;
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void (*finished)(void *, int);
    void *environment;
} callbacks;

static void log_message(void *environment, const char *name, int status, const char *category, const char *message, ...) {
    (void)environment;
    fprintf(stderr, "%s (%s, %d, %s)\n", message, name, status, category);
}
#else
typedef void (*logger)(void *, int, const char *, const char *);

static void log_message(void *environment, int status, const char *category, const char *message) {
    (void)environment;
    fprintf(stderr, "%s (%d, %s)\n", message, status, category);
}
#endif

int main(int count, char **words) {
    static double time[1], values[GIVEN + 1], results[ASKED + 1];
    if (count != 4) {
        stop("words: library, token, resources");
    }
#ifdef _WIN32
    library = LoadLibraryA(words[1]);
#else
    library = dlopen(words[1], RTLD_NOW | RTLD_LOCAL);
#endif
    if (!library) {
        stop("the library cannot be loaded");
    }
    int (*reset)(void *);
    void *unit;
#if VERSION == 2
    static callbacks own;
    void *(*instantiate)(const char *, int, const char *, const char *, const callbacks *, int, int);
    int (*set_up)(void *, int, double, double, int, double);
    int (*enter)(void *);
    int (*set)(void *, const uint32_t *, size_t, const double *);
    int (*get)(void *, const uint32_t *, size_t, double *);
    find(&instantiate, "fmi2Instantiate");
    find(&set_up, "fmi2SetupExperiment");
    find(&enter, "fmi2EnterInitializationMode");
    find(&set, "fmi2SetReal");
    find(&get, "fmi2GetReal");
    find(&reset, "fmi2Reset");
    own.log = log_message;
    unit = instantiate("unit", EXCHANGE ? 0 : 1, words[2], words[3], &own, 0, 0);
#else
    int (*enter)(void *, bool, double, double, bool, double);
    int (*set)(void *, const uint32_t *, size_t, const double *, size_t);
    int (*get)(void *, const uint32_t *, size_t, double *, size_t);
    find(&enter, "fmi3EnterInitializationMode");
    find(&set, "fmi3SetFloat64");
    find(&get, "fmi3GetFloat64");
    find(&reset, "fmi3Reset");
#if EXCHANGE
    void *(*instantiate)(const char *, const char *, const char *, bool, bool, void *, logger);
    find(&instantiate, "fmi3InstantiateModelExchange");
    unit = instantiate("unit", words[2], words[3], false, false, NULL, log_message);
#else
    void *(*instantiate)(
        const char *, const char *, const char *, bool, bool, bool, bool, const uint32_t *, size_t, void *, logger, void *
    );
    find(&instantiate, "fmi3InstantiateCoSimulation");
    unit = instantiate("unit", words[2], words[3], false, false, false, false, NULL, 0, NULL, log_message, NULL);
#endif
#endif
    if (!unit) {
        stop("the library makes no instance");
    }
    while (next(time, 1) && next(values, (int)GIVEN)) {
        require(reset(unit), "Reset");
#if VERSION == 2
        require(set_up(unit, 0, 0, time[0], 0, 0), "SetupExperiment");
        require(set(unit, given, GIVEN, values), "SetReal");
        require(enter(unit), "EnterInitializationMode");
        require(get(unit, asked, ASKED, results), "GetReal");
#else
        require(set(unit, given, GIVEN, values, GIVEN), "SetFloat64");
        require(enter(unit, false, 0, time[0], false, 0), "EnterInitializationMode");
        require(get(unit, asked, ASKED, results, ASKED), "GetFloat64");
#endif
        show(results, (int)ASKED);
    }
    return 0;
}
