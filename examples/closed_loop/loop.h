/* The sampled regulator and the rotary pendulum, both emitted from regulator.toml, in one loop. */
#ifndef LOOP_H
#define LOOP_H
#include "regulator.h"

/* Step size, in s. */
#define STEP 1e-4

/* Runs the loop for a number of steps. Calls `show` after every `interval` steps with the number of the step and the state. */
void run_loop(long steps, long interval, void (*show)(long step, const double *state));

#endif
