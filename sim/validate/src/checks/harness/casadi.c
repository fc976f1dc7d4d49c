/* Second part of a harness, after that of the interface. Prints the functions for CasADi with their arguments and
 * results, then reads parameters, times, states and inputs as hexadecimal bits, and prints the results of all functions:
 * all of a call, then each alone. */
#include <stdlib.h>

#define MOST 64
#define GUARD 8
#define MOST_NUMBERS 100000000

typedef struct {
    const char *name;
    casadi_int (*n_in)(void);
    casadi_int (*n_out)(void);
    const char *(*name_in)(casadi_int);
    const char *(*name_out)(casadi_int);
    const casadi_int *(*sparsity_in)(casadi_int);
    const casadi_int *(*sparsity_out)(casadi_int);
    int (*work)(casadi_int *, casadi_int *, casadi_int *, casadi_int *);
    int (*call)(const casadi_real **, casadi_real **, casadi_int *, casadi_real *, int);
} function;

#define FUNCTION(f) {#f, f##_n_in, f##_n_out, f##_name_in, f##_name_out, f##_sparsity_in, f##_sparsity_out, f##_work, f}

static const function functions[] = {/*FUNCTIONS*/};

static void stop(const char *name, const char *reason) {
    fprintf(stderr, "%s %s\n", name, reason);
    exit(1);
}

static casadi_int count(const casadi_int *sparsity) {
    return sparsity[2 + sparsity[1]];
}

static void describe(const char *name, const casadi_int *sparsity) {
    printf("%s", name ? name : "none");
    if (sparsity) {
        if (sparsity[1] < 0 || sparsity[1] > MOST_NUMBERS || count(sparsity) < 0 || count(sparsity) > MOST_NUMBERS) {
            stop(name ? name : "none", "has an impossible sparsity");
        }
        for (casadi_int i = 0; i < 3 + sparsity[1] + count(sparsity); ++i) {
            printf(" %lld", (long long)sparsity[i]);
        }
    }
    printf("\n");
}

static double *guarded(casadi_int length) {
    double *numbers = malloc((size_t)(length + GUARD) * sizeof *numbers);
    if (!numbers) {
        stop("memory", "is exhausted");
    }
    for (casadi_int i = 0; i < length + GUARD; ++i) {
        numbers[i] = 1e-250;
    }
    return numbers;
}

static void check_guard(const char *name, const double *numbers, casadi_int length) {
    for (casadi_int i = length; i < length + GUARD; ++i) {
        if (numbers[i] != 1e-250) {
            stop(name, "writes beyond its results or its work array");
        }
    }
}

/* Calls a function for one result, or for all if `only` is negative. */
static void run(const function *f, const casadi_real *const *given, casadi_int only) {
    const casadi_real *arguments[MOST] = {0};
    casadi_real *results[MOST] = {0};
    casadi_int sz_arg = 0, sz_res = 0, sz_iw = 0, sz_w = 0;
    const casadi_int n_in = f->n_in(), n_out = f->n_out();
    if (f->work(&sz_arg, &sz_res, &sz_iw, &sz_w) || sz_arg < n_in || sz_arg > MOST || sz_res < n_out || sz_res > MOST
        || sz_iw != 0 || sz_w < 0 || sz_w > MOST_NUMBERS) {
        stop(f->name, "asks for an impossible work array");
    }
    memcpy(arguments, given, (size_t)n_in * sizeof *arguments);
    double *w = guarded(sz_w);
    for (casadi_int i = 0; i < n_out; ++i) {
        if (only < 0 || i == only) {
            results[i] = guarded(count(f->sparsity_out(i)));
        }
    }
    if (f->call(arguments, results, NULL, w, 0)) {
        stop(f->name, "returns an error");
    }
    check_guard(f->name, w, sz_w);
    free(w);
    for (casadi_int i = 0; i < n_out; ++i) {
        if (results[i]) {
            const casadi_int length = count(f->sparsity_out(i));
            check_guard(f->name, results[i], length);
            show(results[i], (int)length);
            free(results[i]);
        }
    }
}

static int print_functions(void) {
    const size_t all = sizeof functions / sizeof *functions;
    static double numbers[NAME_PARAMETERS + 1], t[1], state[NAME_STATES], signals[NAME_INPUTS + 1];
    static double weights[NAME_STATES];
    for (int i = 0; i < NAME_STATES; ++i) {
        weights[i] = 0.5 + 0.25 * i;
    }
    for (const function *f = functions; f < functions + all; ++f) {
        const casadi_int n_in = f->n_in(), n_out = f->n_out();
        if (n_in < 0 || n_in > MOST || n_out < 0 || n_out > MOST) {
            stop(f->name, "has an impossible number of arguments");
        }
        printf("%s %lld %lld\n", f->name, (long long)n_in, (long long)n_out);
        for (casadi_int i = 0; i < n_in; ++i) {
            describe(f->name_in(i), f->sparsity_in(i));
        }
        for (casadi_int i = 0; i < n_out; ++i) {
            if (!f->sparsity_out(i)) {
                stop(f->name, "has a result without a sparsity");
            }
            describe(f->name_out(i), f->sparsity_out(i));
        }
    }
    double *defaults = guarded(NAME_PARAMETERS);
    casadi_real *results[1];
    results[0] = defaults;
    printf("default_parameters %lld %lld\n", (long long)default_parameters_n_in(), (long long)default_parameters_n_out());
    describe(default_parameters_name_out(0), default_parameters_sparsity_out(0));
    if (default_parameters(NULL, results, NULL, NULL, 0)) {
        stop("default_parameters", "returns an error");
    }
    check_guard("default_parameters", defaults, NAME_PARAMETERS);
    show(defaults, NAME_PARAMETERS);
    while (next(numbers, NAME_PARAMETERS) && next(t, 1) && next(state, NAME_STATES) && next(signals, NAME_INPUTS)) {
        const casadi_real *const given[MOST] = {t, state, signals, numbers, NULL, weights};
        for (const function *f = functions; f < functions + all; ++f) {
            for (casadi_int only = -1; only < f->n_out(); ++only) {
                run(f, given, only);
            }
        }
    }
    return 0;
}

int main(int count_of_words, char **words) {
    return count_of_words > 1 && strcmp(words[1], "functions") == 0 ? print_functions() : print_interface();
}
