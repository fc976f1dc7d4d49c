/* Interface of a controller in a shared library, for `eomgen simulate --controller libcontroller.so`.

   The library defines the three functions below. All quantities are in SI units. `simulate` calls the functions from one
   thread. Arrays are valid during a call only, and names until the end of `eomgen_controller_start`. A function must not
   throw an exception. */
#ifndef EOMGEN_CONTROLLER_H
#define EOMGEN_CONTROLLER_H
#include <stdint.h>
#ifdef __cplusplus
extern "C" {
#endif

/* Version of this interface. */
#define EOMGEN_CONTROLLER_ABI 1

/* Names of the model, in the order of the arrays of a sample. */
typedef struct {
    uint32_t states;
    uint32_t observables;
    uint32_t inputs;
    const char *const *state_names;
    const char *const *observable_names;
    const char *const *input_names;
} eomgen_controller_model;

/* Times and driven inputs of the controller. */
typedef struct {
    /* Time between two samples, in s; must be set. */
    double period;
    /* Time of the first sample, in s; 0 if not set. */
    double offset;
    /* Time between a sample and the change of the inputs that its outputs drive, in s; 0 if not set. */
    double delay;
    /* Number of driven inputs; must be set. */
    uint32_t outputs;
    /* Index of each driven input. Write `outputs` indices; the array has one element for each input of the model. */
    uint32_t *driven;
} eomgen_controller_schedule;

/* Returns EOMGEN_CONTROLLER_ABI. */
uint32_t eomgen_controller_abi(void);

/* Sets the times and the driven inputs, and resets the controller. Returns 0; any other number rejects the model. */
int32_t eomgen_controller_start(const eomgen_controller_model *model, eomgen_controller_schedule *schedule);

/* Computes the outputs of a sample at time t (in s), in the order of `driven`, from the values before the sample. Returns 0;
   any other number stops the simulation. */
int32_t eomgen_controller_sample(
    double t, const double *state, const double *observables, const double *inputs, double *outputs);

#ifdef __cplusplus
}
#endif
#endif
