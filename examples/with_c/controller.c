/* Simulates the arm from rest with twice the specified play. `arm4` is the output folder of
 * `eomgen generate --target c99`, see docs/embedding.md. */
#include "planetary_arm.h"
#include <stdio.h>

int main(void) {
    planetary_arm_parameters parameters;
    planetary_arm_coefficients coefficients;
    planetary_arm_inputs inputs = {0};
    double state[planetary_arm_STATES] = {0}, rates[planetary_arm_STATES];
    const double h = 1e-6;
    planetary_arm_default_parameters(&parameters);
    parameters.b_sp = parameters.b_pr = 50e-6;
    planetary_arm_prepare(&parameters, &coefficients); /* once, outside the loop */
    if (!coefficients.positive_definite) {
        return 1;
    }
    for (int step = 0; step < 10000; ++step) {
        planetary_arm_rates(step * h, state, &inputs, &coefficients, rates);
        for (int i = 0; i < planetary_arm_STATES; ++i) {
            state[i] += h * rates[i];
        }
    }
    printf("%s = %.6f m after 10 ms\n", planetary_arm_state_names[2], state[2]);
    return 0;
}
