/* The planetary arm with its contacts under state feedback u = -gain x, called by lqr.py. */
#include "planetary_arm_rig.h"

enum { STATES = planetary_arm_rig_STATES };

/* Called from another language. */
int closed_loop(double play, const double *gain, double step, int steps, double *states);

static double torque(const double *gain, const double *state) {
    double u = 0;
    for (int i = 0; i < STATES; ++i) {
        u -= gain[i] * state[i];
    }
    return u;
}

/* Simulates with steps of `step` s by the classical Runge-Kutta method, from the first row of `states`.
 * Each step writes one row. `play` is half the backlash of both meshes, in m. Returns 0 if the
 * parameters are invalid. */
int closed_loop(double play, const double *gain, double step, int steps, double *states) {
    static const double along[4] = {0, 0.5, 0.5, 1}, weight[4] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
    planetary_arm_rig_parameters parameters;
    planetary_arm_rig_coefficients coefficients;
    planetary_arm_rig_default_parameters(&parameters);
    parameters.b_sp = parameters.b_pr = play;
    planetary_arm_rig_prepare(&parameters, &coefficients);
    if (!coefficients.positive_definite) {
        return 0;
    }
    for (int count = 0; count < steps; ++count) {
        const double *from = states + (long)count * STATES;
        double *to = states + (long)(count + 1) * STATES;
        double at[STATES], rates[STATES] = {0};
        for (int i = 0; i < STATES; ++i) {
            to[i] = from[i];
        }
        for (int stage = 0; stage < 4; ++stage) {
            planetary_arm_rig_inputs inputs;
            for (int i = 0; i < STATES; ++i) {
                at[i] = from[i] + step * along[stage] * rates[i];
            }
            inputs.u = torque(gain, at);
            planetary_arm_rig_rates((count + along[stage]) * step, at, &inputs, &coefficients, rates);
            for (int i = 0; i < STATES; ++i) {
                to[i] += step * weight[stage] * rates[i];
            }
        }
    }
    return 1;
}
