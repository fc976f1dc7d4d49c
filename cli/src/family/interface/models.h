/** Variants of the family `FAMILY` as tables of function pointers. Do not edit: generate again. */
#include <stddef.h>
#ifdef __cplusplus
extern "C" {
#endif

/* The headers of all families have the same type. */
#ifndef EOMGEN_MODEL
#define EOMGEN_MODEL
/** Model of any order in double precision: one observer, one solver or one test serves all variants. Numbers are in SI. The
 * caller provides memory of the given sizes, aligned for double. */
typedef struct {
    /** Prefix of the names of its functions. */
    const char *name;
    /** Number of states. */
    int states;
    /** Number of degrees of freedom: coordinates and modes. */
    int degrees_of_freedom;
    /** Number of inputs. */
    int inputs;
    /** Number of parameters. */
    int parameters;
    /** Number of observables. */
    int observables;
    /** Number of switching surfaces. */
    int surfaces;
    /** Names, in their order. */
    const char *const *state_names, *const *input_names, *const *parameter_names, *const *observable_names;
    /** Sizes of the structures in bytes. */
    size_t size_of_parameters, size_of_inputs, size_of_coefficients;
    /** Sets the values of the specification. */
    void (*default_parameters)(void *parameters);
    /** Sets parameters in the order of their names. */
    void (*parameters_from_array)(const double *numbers, void *parameters);
    /** Sets inputs in the order of their names. */
    void (*inputs_from_array)(const double *numbers, void *inputs);
    /** Prepares the coefficients; returns 0 if the mass matrix is not positive definite. */
    int (*prepare)(const void *parameters, void *coefficients);
    /** Computes the rates of the state. */
    void (*rates)(double t, const double *state, const void *inputs, const void *coefficients, double *rates);
    /** Computes the observables. */
    void (*observe)(double t, const double *state, const void *inputs, const void *coefficients, double *observables);
    /** Computes the values of the switching surfaces. */
    void (*guards)(double t, const double *state, const void *inputs, const void *coefficients, double *values);
    /** Computes the mass matrix, row by row. */
    void (*mass_matrix)(double t, const double *state, const void *inputs, const void *coefficients, double *values);
    /** Returns kinetic plus potential energy, in J. */
    double (*energy)(double t, const double *state, const void *inputs, const void *coefficients);
    /** Returns the power of all non-conservative forces, in W. */
    double (*power)(double t, const double *state, const void *inputs, const void *coefficients);
} eomgen_model;
#endif

DECLARATIONS
#ifdef __cplusplus
}
#endif
