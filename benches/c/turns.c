/* Measures emitted and hand-written rates alternately over the same states. Prints the shortest time of a call of each, in
 * ns, and their difference relative to the largest rate. */
#define _POSIX_C_SOURCE 199309L
#include "by_hand.h"
#include "planetary_arm.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define N planetary_arm_STATES

static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return 1e9 * (double)time.tv_sec + (double)time.tv_nsec;
}

int main(int count, char **arguments) {
    const int states = count > 3 ? atoi(arguments[2]) : 0, passes = count > 3 ? atoi(arguments[3]) : 0;
    FILE *file = count > 3 ? fopen(arguments[1], "rb") : NULL;
    double *state = malloc(sizeof(double) * N * (size_t)(states + 1));
    double emitted[N], written[N], least[2] = {HUGE_VAL, HUGE_VAL}, apart = 0.0, largest = 0.0;
    planetary_arm_parameters parameters;
    planetary_arm_coefficients coefficients;
    planetary_arm_inputs inputs = {0};
    by_hand arm;
    int pass, i, k;
    if (!file || !state || fread(&arm, sizeof arm, 1, file) != 1
        || fread(state, sizeof(double) * N, (size_t)states, file) != (size_t)states) {
        return 1;
    }
    planetary_arm_default_parameters(&parameters);
    planetary_arm_prepare(&parameters, &coefficients);
    for (pass = 0; pass < passes; ++pass) {
        double begin = now(), middle, end;
        for (i = 0; i < states; ++i) {
            planetary_arm_rates(1e-3 * i, state + N * i, &inputs, &coefficients, emitted);
        }
        middle = now();
        for (i = 0; i < states; ++i) {
            by_hand_rates(&arm, 1e-3 * i, state + N * i, written);
        }
        end = now();
        least[0] = fmin(least[0], (middle - begin) / states);
        least[1] = fmin(least[1], (end - middle) / states);
    }
    for (i = 0; i < states; ++i) {
        planetary_arm_rates(1e-3 * i, state + N * i, &inputs, &coefficients, emitted);
        by_hand_rates(&arm, 1e-3 * i, state + N * i, written);
        for (k = 0; k < N; ++k) {
            apart = fmax(apart, fabs(emitted[k] - written[k]));
            largest = fmax(largest, fabs(written[k]));
        }
    }
    printf("%.4f %.4f %e\n", least[0], least[1], apart / largest);
    return 0;
}
