/* Rates of an emitted machine in single precision, with an interface that does not depend on the number of states. MODEL
 * is the name of the model, MODEL_H its header. The coefficients are constants from `baked.h`, in read-only memory. */
#include MODEL_H
#include "vectors.h"

#define JOINED(model, item) model##item
#define ITEM(model, item) JOINED(model, item)

static ITEM(MODEL, _inputs) inputs;

int machine_self_test(void);
int machine_states(void);
void machine_rates(const float *state, float *rates);

int machine_self_test(void) {
    return ITEM(MODEL, _self_test)();
}

int machine_states(void) {
    return ITEM(MODEL, _STATES);
}

void machine_rates(const float *state, float *rates) {
    ITEM(MODEL, _rates)(0.1F, state, &inputs, &ITEM(MODEL, _baked).coefficients, rates);
}
