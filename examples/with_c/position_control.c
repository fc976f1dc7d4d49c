/* Turns the hub of `hub_beam_tip_mass` to an angle with a PD controller. It uses named indices, so this file drives
 * the same coordinate at every order. Compile it with -DMODEL=PREFIX -DHEADER='"PREFIX.h"', see docs/families.md. */
#include HEADER
#include <stdio.h>

#define JOIN_NAMES(prefix, name) prefix##_##name
#define JOIN(prefix, name) JOIN_NAMES(prefix, name)
#define OF(name) JOIN(MODEL, name)

int main(void) {
    OF(parameters) parameters;
    OF(coefficients) coefficients;
    OF(inputs) inputs = {0};
    double state[OF(STATES)] = {0}, rates[OF(STATES)];
    const double h = 2e-6, target = 0.1;
    OF(default_parameters)(&parameters);
    OF(prepare)(&parameters, &coefficients);
    for (int step = 0; step < 500000; ++step) {
        inputs.u = 5.0 * (target - state[OF(STATE_THETA)]) - 2.0 * state[OF(STATE_THETA_DOT)];
        OF(rates)(step * h, state, &inputs, &coefficients, rates);
        /* Semi-implicit Euler: rates first, then coordinates with the new rates. */
        for (int i = 0; i < OF(DEGREES_OF_FREEDOM); ++i) {
            state[OF(DEGREES_OF_FREEDOM) + i] += h * rates[OF(DEGREES_OF_FREEDOM) + i];
            state[i] += h * state[OF(DEGREES_OF_FREEDOM) + i];
        }
    }
    printf("order %d: %s = %.3f rad after 1 s\n", OF(orders)[0], OF(state_names)[OF(STATE_THETA)],
           state[OF(STATE_THETA)]);
    return 0;
}
