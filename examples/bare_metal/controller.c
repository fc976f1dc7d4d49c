/* The controller of controller.rs in C, with the emitted C. The operations have the same order, so the motion
 * is bit-identical. Compile with -std=c99 or -ffp-contract=off. */
#include "planetary_arm_rig.h"
#ifdef PREPARED_IN_DOUBLE
/* The arm in double precision, emitted under another name; see `run`. */
#include "arm_in_double.h"
#include <stddef.h>
#endif

typedef planetary_arm_rig_real real;
typedef planetary_arm_rig_coefficients coefficients;
enum { STATES = planetary_arm_rig_STATES };

/* Step size, s. */
static const real STEP = (real)20e-6;

/* Gain, in N m per m and N m per m/s; see controller.rs. */
static const real GAIN[STATES] = {
    (real)192.6589,  (real)456.0491,  (real)998.8651,   (real)-312.1875,   (real)-105.3722,
    (real)20.75653,  (real)457.063,   (real)1.629354,   (real)5.443445,    (real)23.76957,
    (real)-1.397188, (real)-0.8054563, (real)-0.8642767, (real)-0.8870597,
};

/* Functions called from Rust, see controller_in_c.rs. */
#ifdef PREPARED_IN_DOUBLE
typedef arm_in_double_parameters parameters_in_double;
#else
typedef planetary_arm_rig_parameters parameters_in_double;
#endif
void controller_default_parameters(parameters_in_double *parameters);
void controller_prepare(const parameters_in_double *parameters, coefficients *prepared);
void controller_displaced(real *state);
void controller_step(real t, const real *state, const coefficients *arm, real *next);

/* Sets the default parameters. */
void controller_default_parameters(parameters_in_double *parameters) {
#ifdef PREPARED_IN_DOUBLE
    arm_in_double_default_parameters(parameters);
#else
    planetary_arm_rig_default_parameters(parameters);
#endif
}

/* Prepares the arm's coefficients in double precision, also if the other functions use single precision. */
void controller_prepare(const parameters_in_double *parameters, coefficients *prepared) {
#ifdef PREPARED_IN_DOUBLE
    /* The structure contains numbers, followed by a flag. */
    enum { NUMBERS = offsetof(coefficients, positive_definite) / sizeof(real) };
    arm_in_double_coefficients in_double;
    const double *from = (const double *)&in_double;
    real *to = (real *)prepared;
    arm_in_double_prepare(parameters, &in_double);
    for (int i = 0; i < NUMBERS; ++i) {
        to[i] = (real)from[i];
    }
    prepared->positive_definite = in_double.positive_definite;
#else
    planetary_arm_rig_prepare(parameters, prepared);
#endif
}

/* Sets the initial state: at rest, with the carrier displaced by 2 mm and loaded meshes. */
void controller_displaced(real *state) {
    for (int i = 0; i < STATES; ++i) {
        state[i] = 0;
    }
    state[0] = state[1] = (real)30e-6;
    state[2] = (real)2e-3;
}

/* Returns the torque of the motor for a state, in N m. */
static real torque(const real *state) {
    real sum = 0;
    for (int i = 0; i < STATES; ++i) {
        sum += GAIN[i] * state[i];
    }
    return -sum;
}

/* Computes state + h rate. */
static void moved(const real *state, real h, const real *rate, real *to) {
    for (int i = 0; i < STATES; ++i) {
        to[i] = state[i] + h * rate[i];
    }
}

/* Computes one step of the closed loop at time `t` (in s) by the classical Runge-Kutta method. The torque for `state`
 * is constant during the step. */
void controller_step(real t, const real *state, const coefficients *arm, real *next) {
    planetary_arm_rig_inputs inputs;
    real at[STATES], at_begin[STATES], at_middle[STATES], again[STATES], at_end[STATES];
    const real half = (real)0.5 * STEP;
    inputs.u = torque(state);
    planetary_arm_rig_rates(t, state, &inputs, arm, at_begin);
    moved(state, half, at_begin, at);
    planetary_arm_rig_rates(t + half, at, &inputs, arm, at_middle);
    moved(state, half, at_middle, at);
    planetary_arm_rig_rates(t + half, at, &inputs, arm, again);
    moved(state, STEP, again, at);
    planetary_arm_rig_rates(t + STEP, at, &inputs, arm, at_end);
    for (int i = 0; i < STATES; ++i) {
        const real between = at_middle[i] + again[i];
        next[i] = state[i] + STEP / 6 * (at_begin[i] + 2 * between + at_end[i]);
    }
}
