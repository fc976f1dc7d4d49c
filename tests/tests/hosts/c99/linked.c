/* Calls two models, one of them in a shared library loaded twice, from several threads. Every call
 * must have the bits of the first. */
#define _POSIX_C_SOURCE 200809L
#include "first.h"
#include "second.h"
#include <dlfcn.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>

typedef void rates_of_second(
    double, const double *, const second_inputs *, const second_coefficients *, double *
);

enum { THREADS = 4, CALLS = 20000 };

static rates_of_second *loaded[2];

/* Computes the rates of both models at a point, those of the second also by the loaded libraries. */
static int calls(int place, double *rates) {
    first_parameters p;
    first_coefficients c;
    second_parameters q;
    second_coefficients d;
    first_inputs u;
    second_inputs v;
    const double state[2] = {0.1 * place, -1.0};
    double again[2][2];
    u.u = 0.3;
    v.u = 0.4 * place;
    first_default_parameters(&p);
    second_default_parameters(&q);
    p.m = 1.0 + place;
    q.l = 2.0 + place;
    first_prepare(&p, &c);
    second_prepare(&q, &d);
    first_rates(0.0, state, &u, &c, rates);
    second_rates(0.0, state, &v, &d, rates + 2);
    for (int k = 0; k < 2; ++k) {
        loaded[k](0.0, state, &v, &d, again[k]);
        if (memcmp(again[k], rates + 2, sizeof again[k]) != 0) {
            return 0;
        }
    }
    return 1;
}

static void *thread(void *place) {
    double expected[4], rates[4];
    int same = calls(*(int *)place, expected);
    for (int i = 0; same && i < CALLS; ++i) {
        same = calls(*(int *)place, rates) && memcmp(expected, rates, sizeof rates) == 0;
    }
    *(int *)place = same;
    return NULL;
}

int main(int count, char **arguments) {
    pthread_t threads[THREADS];
    int places[THREADS];
    for (int k = 0; k < 2; ++k) {
        void *library = count > 2 ? dlopen(arguments[1 + k], RTLD_NOW | RTLD_LOCAL) : NULL;
        void *found = library != NULL ? dlsym(library, "second_rates") : NULL;
        if (found == NULL) {
            return 1;
        }
        memcpy(&loaded[k], &found, sizeof found);
    }
    if (loaded[0] == loaded[1] || loaded[0] == second_rates) {
        return 2;
    }
    for (int k = 0; k < THREADS; ++k) {
        places[k] = k;
        if (pthread_create(&threads[k], NULL, thread, &places[k]) != 0) {
            return 3;
        }
    }
    for (int k = 0; k < THREADS; ++k) {
        pthread_join(threads[k], NULL);
        if (!places[k]) {
            return 4;
        }
    }
    puts("the same");
    return 0;
}
