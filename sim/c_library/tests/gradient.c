/* Prints the largest relative difference between gradients and central differences of a specification, then messages of
 * rejected calls. */
#include "eomgen_simulation.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SAMPLES = 41, MOST = 16 };

static double times[SAMPLES];

/* Sum of squares of all samples. */
static double number(const eomgen_model *model, double *const values[3], eomgen_motion **motion, double *weights) {
    size_t states = eomgen_count(model, EOMGEN_STATES);
    double *samples = malloc(SAMPLES * states * sizeof *samples);
    eomgen_motion *made =
        eomgen_simulate(model, values[1], values[0], values[2], times, SAMPLES, 1e-11, samples);
    double sum = 0;
    if (made == NULL) {
        fprintf(stderr, "%s\n", eomgen_error());
        exit(1);
    }
    for (size_t k = 0; k < SAMPLES * states; k++) {
        sum += samples[k] * samples[k];
        weights[k] = 2 * samples[k];
    }
    free(samples);
    *motion = made;
    return sum;
}

int main(int count, char **arguments) {
    if (count != 2) {
        return 2;
    }
    eomgen_model *model = eomgen_open(arguments[1]);
    if (model == NULL) {
        fprintf(stderr, "%s\n", eomgen_error());
        return 1;
    }
    double values[3][MOST], gradient[3][MOST], weights[SAMPLES * MOST], other[SAMPLES * MOST];
    double *const all[3] = {values[0], values[1], values[2]};
    for (int k = 0; k < SAMPLES; k++) {
        times[k] = 0.05 * k;
    }
    for (int list = 0; list < 3; list++) {
        if (eomgen_count(model, list) > MOST || eomgen_values(model, list, values[list]) != 0) {
            return 3;
        }
    }
    eomgen_motion *motion, *moved;
    number(model, all, &motion, weights);
    if (eomgen_gradient(motion, weights, gradient[0], gradient[1], gradient[2]) != 0) {
        fprintf(stderr, "%s\n", eomgen_error());
        return 1;
    }
    double most = 0;
    for (int list = 0; list < 3; list++) {
        for (size_t k = 0; k < eomgen_count(model, list); k++) {
            double own = values[list][k], step = 1e-5 * fmax(fabs(own), 0.1);
            values[list][k] = own + step;
            double above = number(model, all, &moved, other);
            eomgen_discard(moved);
            values[list][k] = own - step;
            double below = number(model, all, &moved, other);
            eomgen_discard(moved);
            values[list][k] = own;
            double difference = (above - below) / (2 * step);
            double relative = fabs(gradient[list][k] - difference) / (fabs(difference) + 1e-3);
            printf("%s: %.6g\n", eomgen_name(model, list, k), relative);
            most = fmax(most, relative);
        }
    }
    printf("largest: %.1e\n", most);
    eomgen_discard(motion);
    times[1] = NAN;
    printf("%d\n", eomgen_simulate(model, NULL, NULL, NULL, times, SAMPLES, 1e-9, NULL) == NULL);
    printf("%s\n", eomgen_error());
    printf("%d\n", eomgen_gradient(NULL, weights, NULL, NULL, NULL));
    printf("%s\n", eomgen_error());
    printf("%d %d\n", eomgen_name(model, 1, 99) == NULL, eomgen_count(model, 7) == 0);
    eomgen_close(model);
    printf("%d\n", eomgen_open("absent.toml") == NULL);
    printf("%s\n", eomgen_error());
    return most < 1e-6 ? 0 : 4;
}
