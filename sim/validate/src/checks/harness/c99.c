/* Reads times, states and inputs as hexadecimal bits, and prints all results the same way. */
#include "NAME.h"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#define ROOM(n) ((n) > 0 ? (n) : 1)

/*BITS*/
int main(void) {
    static NAME_parameters parameters;
    static NAME_coefficients coefficients;
    static NAME_inputs inputs;
    static NAME_real t[1], state[NAME_STATES], signals[ROOM(NAME_INPUTS)];
    static NAME_real rates[NAME_STATES], observables[NAME_OBSERVABLES];
    static NAME_real guards[ROOM(NAME_GUARDS)], number[1];
    static NAME_real mass[NAME_DEGREES_OF_FREEDOM][NAME_DEGREES_OF_FREEDOM];
    NAME_default_parameters(&parameters);
    NAME_prepare(&parameters, &coefficients);
    while (next(t, 1) && next(state, NAME_STATES) && next(signals, NAME_INPUTS)) {
        NAME_inputs_from_array(signals, &inputs);
        NAME_rates(t[0], state, &inputs, &coefficients, rates);
        show(rates, NAME_STATES);
        NAME_observables(t[0], state, &inputs, &coefficients, observables);
        show(observables, NAME_OBSERVABLES);
        number[0] = NAME_energy(t[0], state, &inputs, &coefficients);
        show(number, 1);
        number[0] = NAME_power(t[0], state, &inputs, &coefficients);
        show(number, 1);
        NAME_guards(t[0], state, &inputs, &coefficients, guards);
        show(guards, NAME_GUARDS);
        NAME_mass_matrix(t[0], state, &inputs, &coefficients, mass);
        show(&mass[0][0], NAME_DEGREES_OF_FREEDOM * NAME_DEGREES_OF_FREEDOM);
    }
    return 0;
}
