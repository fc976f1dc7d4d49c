/* Sampling, delay and hold with fixed steps, as in `eomgen simulate --solver fixed --step 1e-4`. The delay is shorter
   than the period, so that at most one output is pending. */
#include "loop.h"

static long steps_of(double time) {
    return (long)(time / STEP + 0.5);
}

void run_loop(long steps, long interval, void (*show)(long step, const double *state)) {
    regulator_parameters parameters;
    regulator_coefficients coefficients;
    regulator_controller_regulator memory;
    regulator_controller_regulator_outputs outputs = {0};
    regulator_inputs inputs = {0};
    double state[regulator_STATES] = {0};
    long action = -1;
    regulator_default_parameters(&parameters);
    regulator_prepare(&parameters, &coefficients);
    regulator_controller_regulator_start(&parameters, &memory);
    const long period = steps_of(memory.period), offset = steps_of(memory.offset);
    const long delay = steps_of(memory.delay);
    state[regulator_STATE_THETA] = 3.0;
    for (long step = 0; step <= steps; ++step) {
        if (step >= offset && (step - offset) % period == 0) {
            regulator_controller_regulator_measured measured;
            measured.phi = state[regulator_STATE_PHI];
            measured.theta = state[regulator_STATE_THETA];
            regulator_controller_regulator_update(&memory, &measured, &parameters, &outputs);
            action = step + delay;
        }
        if (step == action) {
            inputs.u = outputs.u;
        }
        if (step % interval == 0) {
            show(step, state);
        }
        regulator_step((double)step * STEP, STEP, state, &inputs, &coefficients);
    }
}
