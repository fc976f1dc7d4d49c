/* The sampled regulator and the rotary pendulum, both emitted from regulator.toml, in one loop. */
#ifndef LOOP_H
#define LOOP_H
#include "regulator.h"

/* Length of a step, s. */
#define STEP 1e-4

/* Runs the loop for a number of steps, and calls `show` at every `interval`th one with its number and the state. */
void run_loop(long steps, long interval, void (*show)(long step, const double *state));

#endif
