/* Functions of the model at the current point of an instance. */

/* Computes the coefficients, which depend on the parameters only. */
static int prepare(instance *unit) {
    MODEL(parameters) parameters;
    if (unit->coefficients_known) {
        return OK;
    }
    MODEL(parameters_from_array)(unit->now.parameters, &parameters);
    MODEL(prepare)(&parameters, &unit->coefficients);
    if (!unit->coefficients.positive_definite) {
        return refuse(unit, ERROR, "with these parameters the mass matrix is not positive definite");
    }
    unit->coefficients_known = 1;
    return OK;
}

static uint32_t regime_of(const instance *unit) {
    uint32_t regime = 0;
    for (int k = 0; k < MODEL(GUARDS) && k < REGIME_BITS; ++k) {
        if (unit->now.sides[k] > 0) {
            regime |= (uint32_t)1 << k;
        }
    }
    return regime;
}

/* Returns whether the motion stays on a surface; the state then determines the sides. */
static int rests(const instance *unit) {
    for (int k = 0; k < MODEL(GUARDS); ++k) {
        if (unit->now.sides[k] == 0) {
            return 1;
        }
    }
    return 0;
}

/* Computes the rates at a time and a state, on the stored sides of all surfaces. Coefficients and sides must be
 * set. Returns whether all rates are finite. */
static int rates_at(const instance *unit, double t, const double *state, double *rates) {
    MODEL(inputs) inputs;
    MODEL(inputs_from_array)(unit->now.inputs, &inputs);
    if (rests(unit)) {
        MODEL(rates)(t, state, &inputs, &unit->coefficients, rates);
    } else {
        MODEL(rates_in_regime)(t, state, &inputs, &unit->coefficients, regime_of(unit), rates);
    }
    for (int i = 0; i < MODEL(STATES); ++i) {
        if (!is_finite(rates[i])) {
            return 0;
        }
    }
    return 1;
}

static void guards_at(const instance *unit, double t, const double *state, double *guards) {
    MODEL(inputs) inputs;
    MODEL(inputs_from_array)(unit->now.inputs, &inputs);
    MODEL(guards)(t, state, &inputs, &unit->coefficients, guards);
}

static int observables_now(const instance *unit, double *observables) {
    MODEL(inputs) inputs;
    MODEL(inputs_from_array)(unit->now.inputs, &inputs);
    MODEL(observables)(unit->now.t, unit->now.state, &inputs, &unit->coefficients, observables);
    return OK;
}

static int refuse_motion(const instance *unit) {
    return refuse(
        unit, DISCARD,
        "a rate is no finite number: the state is too large, or the mass matrix is not positive definite there"
    );
}
