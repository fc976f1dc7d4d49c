/* Calls every function of a model at the same states as the Rust driver and prints the bits of
 * each result on a line. */
#include "NAME.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define POINTS 36
/* First point with extreme or non-finite numbers. */
#define EXTREME 24

static uint64_t seed = 0x9e3779b97f4a7c15;

/* Returns a uniform number from -scale to scale. */
static double uniform(double scale) {
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return ((double)(seed >> 11) / 4503599627370496.0 - 1.0) * scale;
}

static void show(const char *what, const NAME_real *numbers, int count) {
    for (int i = 0; i < count; ++i) {
        unsigned long long bits = 0;
        if (numbers[i] != numbers[i]) {
            printf("%s %d nan\n", what, i);
            continue;
        }
        if (sizeof(NAME_real) == 4) {
            uint32_t narrow;
            memcpy(&narrow, &numbers[i], 4);
            bits = narrow;
        } else {
            memcpy(&bits, &numbers[i], 8);
        }
        printf("%s %d %llx\n", what, i, bits);
    }
}

#define ROOM(n) ((n) > 0 ? (n) : 1)

int main(void) {
    (void)defaults;
    static const double scales[4] = {1.0, 1e-2, 2e-5, 10.0};
    const double extremes[6] = {
        strtod("nan", NULL), strtod("inf", NULL), -strtod("inf", NULL), 1e308, -1e308, 5e-324
    };
    static NAME_real mass[NAME_DEGREES_OF_FREEDOM][NAME_DEGREES_OF_FREEDOM];
    for (int point = 0; point < POINTS; ++point) {
        const double scale = scales[point % 4];
        NAME_parameters parameters;
        NAME_inputs inputs;
        NAME_coefficients coefficients;
        NAME_real state[NAME_STATES], rates[NAME_STATES], observables[NAME_OBSERVABLES];
        NAME_real guards[ROOM(NAME_GUARDS)], signals[ROOM(NAME_INPUTS)] = {0};
        NAME_default_parameters(&parameters);
        if (point % 2 == 1) {
            NAME_real numbers[ROOM(NAME_PARAMETERS)] = {0};
            for (int i = 0; i < NAME_PARAMETERS; ++i) {
                numbers[i] = (NAME_real)(defaults[i] * (1.0 + uniform(0.05)));
            }
            if (point >= EXTREME) {
                numbers[point % ROOM(NAME_PARAMETERS)] = (NAME_real)extremes[point / 2 % 6];
            }
            NAME_parameters_from_array(numbers, &parameters);
        }
        NAME_prepare(&parameters, &coefficients);
        const NAME_real t = (NAME_real)uniform(5.0);
        for (int i = 0; i < NAME_STATES; ++i) {
            state[i] = (NAME_real)uniform(scale);
        }
        for (int i = 0; i < NAME_INPUTS; ++i) {
            signals[i] = (NAME_real)uniform(1.0);
        }
        if (point >= EXTREME && point % 2 == 0) {
            state[point / 2 % NAME_STATES] = (NAME_real)extremes[point / 2 % 6];
            signals[0] = (NAME_real)extremes[point / 4 % 6];
        }
        NAME_inputs_from_array(signals, &inputs);
        printf("point %d %d\n", point, coefficients.positive_definite);
        NAME_rates(t, state, &inputs, &coefficients, rates);
        show("rates", rates, NAME_STATES);
        NAME_observables(t, state, &inputs, &coefficients, observables);
        show("observables", observables, NAME_OBSERVABLES);
        const NAME_real energy = NAME_energy(t, state, &inputs, &coefficients);
        const NAME_real power = NAME_power(t, state, &inputs, &coefficients);
        show("energy", &energy, 1);
        show("power", &power, 1);
        NAME_guards(t, state, &inputs, &coefficients, guards);
        show("guards", guards, NAME_GUARDS);
        NAME_mass_matrix(t, state, &inputs, &coefficients, mass);
        show("mass_matrix", &mass[0][0], NAME_DEGREES_OF_FREEDOM * NAME_DEGREES_OF_FREEDOM);
#ifdef REQUESTED
        NAME_real weights[NAME_STATES], forces[NAME_DEGREES_OF_FREEDOM];
        for (int i = 0; i < NAME_STATES; ++i) {
            weights[i] = (NAME_real)uniform(1.0);
        }
        NAME_bias_forces(t, state, &inputs, &coefficients, forces);
        show("bias_forces", forces, NAME_DEGREES_OF_FREEDOM);
        NAME_inverse_dynamics(t, state, &inputs, &coefficients, weights, forces);
        show("inverse_dynamics", forces, NAME_DEGREES_OF_FREEDOM);
        NAME_guard_rates(t, state, &inputs, &coefficients, guards);
        show("guard_rates", guards, NAME_GUARDS);
        const uint32_t regime = NAME_regime(t, state, &inputs, &coefficients);
        printf("regime %u\n", (unsigned)regime);
        NAME_rates_in_regime(t, state, &inputs, &coefficients, regime, rates);
        show("rates_in_regime", rates, NAME_STATES);
#endif
#ifdef DERIVATIVES
        static NAME_linearisation about;
        NAME_real product[NAME_STATES], by_parameters[ROOM(NAME_PARAMETERS)];
        NAME_real directions[ROOM(NAME_INPUTS)] = {0};
        NAME_inputs input_direction, input_product;
        for (int i = 0; i < NAME_INPUTS; ++i) {
            directions[i] = (NAME_real)uniform(1.0);
        }
        NAME_inputs_from_array(directions, &input_direction);
        NAME_jacobian_vector_product(
            t, state, &inputs, &coefficients, weights, &input_direction, product
        );
        show("jacobian_vector_product", product, NAME_STATES);
        NAME_vector_jacobian_product(
            t, state, &inputs, &coefficients, weights, product, &input_product
        );
        show("vector_jacobian_product", product, NAME_STATES);
        /* A structure of numbers only has the layout of an array. */
        show("of_inputs", (const NAME_real *)(const void *)&input_product, NAME_INPUTS);
        NAME_vector_jacobian_product_by_parameters(
            t, state, &inputs, &coefficients, weights, by_parameters
        );
        show("by_parameters", by_parameters, NAME_PARAMETERS);
        NAME_linearise(t, state, &inputs, &coefficients, &about);
        show("A", &about.A[0][0], NAME_STATES * NAME_STATES);
        if (NAME_INPUTS > 0) {
            show("B", &about.B[0][0], NAME_STATES * NAME_INPUTS);
            show("D", &about.D[0][0], NAME_OBSERVABLES * NAME_INPUTS);
        }
        show("C", &about.C[0][0], NAME_OBSERVABLES * NAME_STATES);
#define NONZEROS(name, size)                                                                       \
    {                                                                                              \
        static NAME_real values[ROOM(size)];                                                       \
        static int rows[ROOM(size)], columns[ROOM(size)];                                          \
        NAME_##name(t, state, &inputs, &coefficients, values);                                     \
        NAME_##name##_places(rows, columns);                                                       \
        show(#name, values, size);                                                                 \
        for (int i = 0; point == 0 && i < size; ++i) {                                             \
            printf("place %d %d\n", rows[i], columns[i]);                                          \
        }                                                                                          \
    }
        NONZEROS(rates_by_state, NAME_RATES_BY_STATE_NONZEROS)
        NONZEROS(rates_by_inputs, NAME_RATES_BY_INPUTS_NONZEROS)
        NONZEROS(rates_by_parameters, NAME_RATES_BY_PARAMETERS_NONZEROS)
        NONZEROS(observables_by_state, NAME_OBSERVABLES_BY_STATE_NONZEROS)
        NONZEROS(observables_by_inputs, NAME_OBSERVABLES_BY_INPUTS_NONZEROS)
        NONZEROS(observables_by_parameters, NAME_OBSERVABLES_BY_PARAMETERS_NONZEROS)
#endif
    }
    return 0;
}
