/* Directional and adjoint derivatives of rates and observables by state, inputs and parameters, from the
 * emitted Jacobians. States are outputs as well; the derivative of a state by itself is 1. */

typedef struct {
    int nonzeros;
    int first_unknown;
    int first_known;
    void (*places)(int *rows, int *columns);
    void (*values)(
        double t, const double *state, const MODEL(inputs) *inputs, const MODEL(coefficients) *coefficients,
        double *values
    );
} jacobian;

#define JACOBIAN(name, size, unknown, known) {size, unknown, known, MODEL(name##_places), MODEL(name)}

static const jacobian jacobians[6] = {
    JACOBIAN(rates_by_state, MODEL(RATES_BY_STATE_NONZEROS), FIRST_RATE, FIRST_STATE),
    JACOBIAN(rates_by_inputs, MODEL(RATES_BY_INPUTS_NONZEROS), FIRST_RATE, FIRST_INPUT),
    JACOBIAN(rates_by_parameters, MODEL(RATES_BY_PARAMETERS_NONZEROS), FIRST_RATE, FIRST_PARAMETER),
    JACOBIAN(observables_by_state, MODEL(OBSERVABLES_BY_STATE_NONZEROS), FIRST_OBSERVABLE, FIRST_STATE),
    JACOBIAN(observables_by_inputs, MODEL(OBSERVABLES_BY_INPUTS_NONZEROS), FIRST_OBSERVABLE, FIRST_INPUT),
    JACOBIAN(
        observables_by_parameters, MODEL(OBSERVABLES_BY_PARAMETERS_NONZEROS), FIRST_OBSERVABLE, FIRST_PARAMETER
    ),
};

/* Adds the product of a Jacobian with the directions of all variables, forward or backward. */
static int add_product(const instance *unit, const jacobian *one, int backward, const double *from, double *to) {
    const size_t room = (size_t)one->nonzeros + 1;
    double *values = malloc(room * sizeof *values);
    int *rows = malloc(room * sizeof *rows);
    int *columns = malloc(room * sizeof *columns);
    int status = OK;
    if (values && rows && columns) {
        MODEL(inputs) inputs;
        MODEL(inputs_from_array)(unit->now.inputs, &inputs);
        one->places(rows, columns);
        one->values(unit->now.t, unit->now.state, &inputs, &unit->coefficients, values);
        for (int k = 0; k < one->nonzeros; ++k) {
            const int unknown = one->first_unknown + rows[k], known = one->first_known + columns[k];
            to[backward ? known : unknown] += values[k] * from[backward ? unknown : known];
        }
    } else {
        status = refuse(unit, ERROR, "there is no memory for a Jacobian");
    }
    free(values);
    free(rows);
    free(columns);
    return status;
}

/* Returns whether the stored sides are those of the state, which the Jacobians use. */
static int is_on_its_sides(const instance *unit) {
    double guards[MODEL(GUARDS) + 1];
    guards_at(unit, unit->now.t, unit->now.state, guards);
    for (int k = 0; k < MODEL(GUARDS); ++k) {
        if (unit->now.sides[k] * guards[k] < -beyond(unit, k)) {
            return 0;
        }
    }
    return 1;
}

static int is_unknown(int place) {
    return (place >= FIRST_STATE && place < FIRST_INPUT) || (place >= FIRST_OBSERVABLE && place < FIRST_INDICATOR);
}

static int is_known(int place) {
    return (place >= FIRST_STATE && place < FIRST_RATE) || (place >= FIRST_INPUT && place < FIRST_OBSERVABLE);
}

static int check_references(const instance *unit, const unsigned int *references, size_t count, int (*fits)(int)) {
    for (size_t i = 0; i < count; ++i) {
        if (references[i] >= VARIABLES) {
            return refuse_reference(unit, references[i]);
        }
        if (!fits((int)references[i])) {
            return refuse(unit, ERROR, "there are derivatives of rates, states and outputs, by states, inputs and parameters");
        }
    }
    return OK;
}

static int differentiate(
    instance *unit, int backward, const unsigned int *unknowns, size_t unknown_count, const unsigned int *knowns,
    size_t known_count, const double *seed, double *sensitivity
) {
    const unsigned int *given = backward ? unknowns : knowns, *wanted = backward ? knowns : unknowns;
    const size_t given_count = backward ? unknown_count : known_count;
    const size_t wanted_count = backward ? known_count : unknown_count;
    double from[VARIABLES] = {0}, to[VARIABLES] = {0};
    int status;
    if (!is_there(unknowns, unknown_count) || !is_there(knowns, known_count) || !is_there(seed, given_count)
        || !is_there(sensitivity, wanted_count)) {
        return refuse(unit, ERROR, "a null pointer in place of value references or derivatives");
    }
    status = check_references(unit, unknowns, unknown_count, is_unknown);
    if (status == OK) {
        status = check_references(unit, knowns, known_count, is_known);
    }
    if (status == OK) {
        status = be_ready(unit);
    }
    if (status != OK) {
        return status;
    }
    if (!is_on_its_sides(unit)) {
        return refuse(unit, DISCARD, "no derivatives beyond a switching surface whose event has not been handled");
    }
    for (size_t i = 0; i < given_count; ++i) {
        from[given[i]] += seed[i];
    }
    for (int j = 0; j < 6 && status == OK; ++j) {
        status = add_product(unit, &jacobians[j], backward, from, to);
    }
    for (int i = FIRST_STATE; i < FIRST_RATE; ++i) {
        to[i] += from[i];
    }
    for (size_t i = 0; i < wanted_count && status == OK; ++i) {
        sensitivity[i] = to[wanted[i]];
        if (!is_finite(sensitivity[i])) {
            status = refuse(unit, DISCARD, "a derivative is no finite number");
        }
    }
    return status;
}
