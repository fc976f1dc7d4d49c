/** Tables of function pointers of the family `FAMILY`. Do not edit: generate again. */
#include "models.h"
INCLUDES
/** Defines the table of one model. */
#define TABLE(NAME) \
    static void NAME##_set_defaults(void *parameters) { \
        NAME##_default_parameters((NAME##_parameters *)parameters); \
    } \
    static void NAME##_set_parameters(const double *numbers, void *parameters) { \
        NAME##_parameters_from_array(numbers, (NAME##_parameters *)parameters); \
    } \
    static void NAME##_set_inputs(const double *numbers, void *inputs) { \
        NAME##_inputs_from_array(numbers, (NAME##_inputs *)inputs); \
    } \
    static int NAME##_set_coefficients(const void *parameters, void *coefficients) { \
        NAME##_prepare((const NAME##_parameters *)parameters, (NAME##_coefficients *)coefficients); \
        return ((const NAME##_coefficients *)coefficients)->positive_definite; \
    } \
    static void NAME##_find_rates( \
        double t, const double *state, const void *inputs, const void *coefficients, double *rates \
    ) { \
        NAME##_rates(t, state, (const NAME##_inputs *)inputs, (const NAME##_coefficients *)coefficients, rates); \
    } \
    static void NAME##_find_observables( \
        double t, const double *state, const void *inputs, const void *coefficients, double *values \
    ) { \
        NAME##_observables(t, state, (const NAME##_inputs *)inputs, (const NAME##_coefficients *)coefficients, values); \
    } \
    static void NAME##_find_guards( \
        double t, const double *state, const void *inputs, const void *coefficients, double *values \
    ) { \
        NAME##_guards(t, state, (const NAME##_inputs *)inputs, (const NAME##_coefficients *)coefficients, values); \
    } \
    static void NAME##_find_mass_matrix( \
        double t, const double *state, const void *inputs, const void *coefficients, double *values \
    ) { \
        NAME##_mass_matrix( \
            t, state, (const NAME##_inputs *)inputs, (const NAME##_coefficients *)coefficients, \
            (double (*)[NAME##_DEGREES_OF_FREEDOM])values \
        ); \
    } \
    static double NAME##_find_energy( \
        double t, const double *state, const void *inputs, const void *coefficients \
    ) { \
        return NAME##_energy(t, state, (const NAME##_inputs *)inputs, (const NAME##_coefficients *)coefficients); \
    } \
    static double NAME##_find_power( \
        double t, const double *state, const void *inputs, const void *coefficients \
    ) { \
        return NAME##_power(t, state, (const NAME##_inputs *)inputs, (const NAME##_coefficients *)coefficients); \
    } \
    const eomgen_model NAME##_model = { \
        #NAME, NAME##_STATES, NAME##_DEGREES_OF_FREEDOM, NAME##_INPUTS, NAME##_PARAMETERS, NAME##_OBSERVABLES, \
        NAME##_GUARDS, NAME##_state_names, NAME##_input_names, NAME##_parameter_names, NAME##_observable_names, \
        sizeof(NAME##_parameters), sizeof(NAME##_inputs), sizeof(NAME##_coefficients), NAME##_set_defaults, \
        NAME##_set_parameters, NAME##_set_inputs, NAME##_set_coefficients, NAME##_find_rates, NAME##_find_observables, \
        NAME##_find_guards, NAME##_find_mass_matrix, NAME##_find_energy, NAME##_find_power \
    };

