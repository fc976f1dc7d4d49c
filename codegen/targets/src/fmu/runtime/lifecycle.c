/* Transitions between modes. */

static int set_up(instance *unit, int has_tolerance, double tolerance, double start, int has_stop, double stop) {
    if (!is_finite(start) || (has_stop && !(stop > start))) {
        return refuse(unit, ERROR, "the start time is no finite number, or the stop time not after it");
    }
    if (has_tolerance && !(tolerance > 0 && tolerance < 1)) {
        return refuse_value(unit, ERROR, "tolerance", tolerance, "not between 0 and 1");
    }
    unit->now.t = start;
    unit->now.has_stop = has_stop;
    unit->now.stop = has_stop ? stop : 0;
    unit->now.tolerance = has_tolerance ? tolerance : DEFAULT_TOLERANCE;
    return OK;
}

static int end_initialization(instance *unit) {
    double rates[MODEL(STATES) + 1];
    int changed;
    int status;
    unit->now.sides_known = 0;
    status = update_sides(unit, &changed);
    if (status != OK) {
        return status;
    }
    if (!rates_at(unit, unit->now.t, unit->now.state, rates)) {
        return refuse(unit, ERROR, "at the initial state a rate is no finite number: is the mass matrix positive definite?");
    }
    unit->now.mode = unit->is_exchange ? EVENT : STEP;
    return OK;
}
