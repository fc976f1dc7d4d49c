#include "arms.h"
#include "planetary_arm.h"

void advance_on_host(
    planetary_arm_real *states, size_t begin, size_t end, int steps, planetary_arm_real h
) {
    planetary_arm_parameters parameters;
    planetary_arm_coefficients coefficients;
    planetary_arm_inputs inputs = {0};
    planetary_arm_default_parameters(&parameters);
    planetary_arm_prepare(&parameters, &coefficients);
    for (size_t arm = begin; arm < end; ++arm) {
        planetary_arm_real *state = states + arm * planetary_arm_STATES;
        for (int step = 0; step < steps; ++step) {
            planetary_arm_step((planetary_arm_real)step * h, h, state, &inputs, &coefficients);
        }
    }
}
