/* Regulator of the rotary pendulum `furuta_pendulum.toml` as a shared library: holds it upright with the gains of
   docs/closed_loop.md.

       cc -shared -fPIC -O2 examples/controllers/upright.c -o libupright.so
       eomgen simulate model-spec/models/furuta_pendulum.toml --controller ./libupright.so --until 2 --out upright.csv */
#include "eomgen_controller.h"
#include <string.h>

#define PI 3.14159265358979323846
#define STATES 4

static const char *const names[STATES] = {"phi", "theta", "phi_dot", "theta_dot"};
static const double gains[STATES] = {-0.3811, 3.3202, -0.2212, 0.3626};
static const double upright[STATES] = {0, PI, 0, 0};

/* Indices of the states in the model. */
static uint32_t places[STATES];

uint32_t eomgen_controller_abi(void) {
    return EOMGEN_CONTROLLER_ABI;
}

/* Returns the index of a name, or `count`. */
static uint32_t find(uint32_t count, const char *const *known, const char *name) {
    uint32_t place = 0;
    while (place < count && strcmp(known[place], name) != 0) {
        ++place;
    }
    return place;
}

int32_t eomgen_controller_start(const eomgen_controller_model *model, eomgen_controller_schedule *schedule) {
    const uint32_t torque = find(model->inputs, model->input_names, "u");
    if (torque == model->inputs) {
        return 1;
    }
    for (int i = 0; i < STATES; ++i) {
        places[i] = find(model->states, model->state_names, names[i]);
        if (places[i] == model->states) {
            return 2;
        }
    }
    schedule->period = 2e-3;
    schedule->delay = 1e-3;
    schedule->outputs = 1;
    schedule->driven[0] = torque;
    return 0;
}

int32_t eomgen_controller_sample(
    double t, const double *state, const double *observables, const double *inputs, double *outputs) {
    double torque = 0;
    (void)t, (void)observables, (void)inputs;
    for (int i = 0; i < STATES; ++i) {
        torque -= gains[i] * (state[places[i]] - upright[i]);
    }
    outputs[0] = torque < -0.5 ? -0.5 : torque > 0.5 ? 0.5 : torque;
    return 0;
}
