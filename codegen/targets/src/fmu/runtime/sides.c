/* Sides of the switching surfaces. They are constant between events, so that the rates are smooth for a solver that
 * steps over a surface and then locates it. */

/* Distance beyond a surface at which an indicator changes its sign, relative to the largest distance so far.
 * It keeps an indicator away from 0 after its event and prevents chatter. */
#define BEYOND 1e-10
/* The same, absolute, before the first distance is known. */
#define BEYOND_AT_LEAST 1e-20

static double beyond(const instance *unit, int k) {
    const double part = BEYOND * unit->now.reaches[k];
    return part > BEYOND_AT_LEAST ? part : BEYOND_AT_LEAST;
}

/* Updates the largest values. */
static void note_magnitudes(instance *unit) {
    double guards[MODEL(GUARDS) + 1];
    guards_at(unit, unit->now.t, unit->now.state, guards);
    for (int k = 0; k < MODEL(GUARDS); ++k) {
        const double size = magnitude(guards[k]);
        if (size > unit->now.reaches[k] && is_finite(size)) {
            unit->now.reaches[k] = size;
        }
    }
    for (int i = 0; i < MODEL(STATES); ++i) {
        const double size = magnitude(unit->now.state[i]);
        if (size > unit->now.magnitudes[i] && is_finite(size)) {
            unit->now.magnitudes[i] = size;
        }
    }
}

/* Returns whether the rates of the regime are those of the state. They differ if a half-width is negative,
 * because its two surfaces are then in the wrong order. */
static int check_half_widths(const instance *unit, const double *guards) {
    double within[MODEL(STATES) + 1], at[MODEL(STATES) + 1];
    MODEL(inputs) inputs;
    for (int k = 0; k < MODEL(GUARDS); ++k) {
        if (guards[k] * unit->now.sides[k] <= 0) {
            return OK;
        }
    }
    if (!rates_at(unit, unit->now.t, unit->now.state, within)) {
        return OK;
    }
    MODEL(inputs_from_array)(unit->now.inputs, &inputs);
    MODEL(rates)(unit->now.t, unit->now.state, &inputs, &unit->coefficients, at);
    for (int i = 0; i < MODEL(STATES); ++i) {
        /* Equal up to the rounding of contracted products. */
        if (!(magnitude(within[i] - at[i]) <= 1e-6 * (magnitude(within[i]) + magnitude(at[i])))) {
            return refuse(unit, ERROR, "the half-width of a dead zone is negative");
        }
    }
    return OK;
}

/* Computes the sides; `changed` reports whether a side differs from before. */
static int update_sides(instance *unit, int *changed) {
    double guards[MODEL(GUARDS) + 1], rates[MODEL(GUARDS) + 1];
    int has_rates = 0;
    const int status = prepare(unit);
    *changed = 0;
    if (status != OK) {
        return status;
    }
    guards_at(unit, unit->now.t, unit->now.state, guards);
    for (int k = 0; k < MODEL(GUARDS); ++k) {
        const int old = unit->now.sides[k];
        int side = unit->now.sides_known ? old : 0;
        if (!(magnitude(guards[k]) <= DBL_MAX)) {
            return refuse(unit, DISCARD, "a switching function is no finite number");
        }
        if (guards[k] != 0) {
            side = guards[k] > 0 ? 1 : -1;
        } else if (side == 0) {
            if (!has_rates) {
                MODEL(inputs) inputs;
                MODEL(inputs_from_array)(unit->now.inputs, &inputs);
                MODEL(guard_rates)(unit->now.t, unit->now.state, &inputs, &unit->coefficients, rates);
                has_rates = 1;
            }
            side = (rates[k] > 0) - (rates[k] < 0);
        }
        *changed |= side != old;
        unit->now.sides[k] = side;
    }
    unit->now.sides_known = 1;
    note_magnitudes(unit);
    return check_half_widths(unit, guards);
}

/* Computes coefficients and sides if unknown. Before the start of the simulation all of them may change. */
static int be_ready(instance *unit) {
    int changed;
    const int status = prepare(unit);
    if (status != OK) {
        return status;
    }
    if (unit->now.mode & (INSTANTIATED | INITIALIZATION)) {
        unit->now.sides_known = 0;
    }
    return unit->now.sides_known ? OK : update_sides(unit, &changed);
}

/* Computes the event indicators, which change their sign at a surface. */
static void indicators_now(const instance *unit, double *indicators) {
    double guards[MODEL(GUARDS) + 1];
    guards_at(unit, unit->now.t, unit->now.state, guards);
    for (int k = 0; k < MODEL(GUARDS); ++k) {
        const int side = unit->now.sides[k];
        indicators[k] = side ? guards[k] + side * beyond(unit, k) : magnitude(guards[k]) - beyond(unit, k);
    }
}
