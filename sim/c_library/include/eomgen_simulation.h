/* Motions of a specification and their gradients, from C. All numbers are in SI units.
 *
 * A function that fails returns NULL or -1, and eomgen_error() describes the cause. Each thread may use its own models
 * and motions; one model may be used by one thread at a time. */
#ifndef EOMGEN_SIMULATION_H
#define EOMGEN_SIMULATION_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Derived specification. */
typedef struct eomgen_model eomgen_model;

/* Motion with its steps and events. */
typedef struct eomgen_motion eomgen_motion;

/* Lists of a model. Parameters: those that the specification gives by a number. */
enum eomgen_list { EOMGEN_STATES = 0, EOMGEN_PARAMETERS = 1, EOMGEN_INPUTS = 2 };

/* Message of the last error in this thread; empty without an error. Valid until the next call in this thread. */
const char *eomgen_error(void);

/* Reads, checks and derives a specification. */
eomgen_model *eomgen_open(const char *path);
void eomgen_close(eomgen_model *model);

/* Number of entries of a list; 0 for an unknown list. */
size_t eomgen_count(const eomgen_model *model, int list);

/* Name of an entry, valid until eomgen_close; NULL beyond the last entry. */
const char *eomgen_name(const eomgen_model *model, int list, size_t index);

/* Copies the values of the specification: initial state, parameters, or default inputs. */
int eomgen_values(const eomgen_model *model, int list, double *values);

/* Simulates with the solver rk from the first time on and stores the state at each of `count` ascending times:
 * states[count][number of states]. The inputs are constant. NULL for parameters, initial state or inputs stands for the
 * values of the specification. */
eomgen_motion *eomgen_simulate(const eomgen_model *model, const double *parameters, const double *initial,
                               const double *inputs, const double *times, size_t count, double tolerance,
                               double *states);
void eomgen_discard(eomgen_motion *motion);

/* Gradient of a number L that depends on the samples of a motion, by the discrete adjoint of its steps and events.
 * weights[count][number of states]: derivatives of L with respect to the samples. Results: derivatives of L with respect
 * to the initial state, the parameters and the inputs, one number for each entry of its list; NULL for a result that is
 * not needed. Derivatives with respect to the initial state are NAN if friction holds the motion at the start. The time of
 * computation does not depend on the number of parameters. Fails if the motion touches a
 * switching surface without crossing it, crosses several at once, or rests in a contact. */
int eomgen_gradient(const eomgen_motion *motion, const double *weights, double *by_initial, double *by_parameters,
                    double *by_inputs);

#ifdef __cplusplus
}
#endif
#endif
