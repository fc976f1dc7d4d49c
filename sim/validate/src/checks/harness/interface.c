/* Prints the interface of emitted C, then reads parameters, times, states and inputs as hexadecimal bits, and prints the
 * results of all functions the same way. */
#include "NAME.h"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/*BITS*/
int main(void) {
    static NAME_parameters parameters;
    static NAME_coefficients coefficients;
    static NAME_inputs inputs, given_inputs;
    static NAME_real given[ROOM], out[ROOM], numbers[NAME_PARAMETERS + 1];
    static NAME_real t[1], state[NAME_STATES], signals[NAME_INPUTS + 1];
    for (int i = 0; i < ROOM; ++i) {
        given[i] = (NAME_real)(0.5 + 0.25 * i);
    }
    NAME_inputs_from_array(given, &given_inputs);
/*INTERFACE*/
    for (;;) {
        if (!next(numbers, NAME_PARAMETERS) || !next(t, 1) || !next(state, NAME_STATES) || !next(signals, NAME_INPUTS)) {
            return 0;
        }
        NAME_parameters_from_array(numbers, &parameters);
        NAME_prepare(&parameters, &coefficients);
        printf("%d\n", coefficients.positive_definite);
        NAME_inputs_from_array(signals, &inputs);
/*CALLS*/
    }
}
