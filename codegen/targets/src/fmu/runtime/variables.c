/* Access to variables by value reference. */

static const char *name_of(unsigned int reference) {
    const int place = (int)reference;
    if (place >= FIRST_OBSERVABLE) {
        return place < FIRST_INDICATOR ? MODEL(observable_names)[place - FIRST_OBSERVABLE] : "an event indicator";
    }
    if (place >= FIRST_PARAMETER) {
        return MODEL(parameter_names)[place - FIRST_PARAMETER];
    }
    if (place >= FIRST_INPUT) {
        return MODEL(input_names)[place - FIRST_INPUT];
    }
    if (place >= FIRST_RATE) {
        return "a derivative";
    }
    return place >= FIRST_STATE ? MODEL(state_names)[place - FIRST_STATE] : "time";
}

static int refuse_reference(const instance *unit, unsigned int reference) {
    char text[80];
    snprintf(text, sizeof text, "there is no variable with the value reference %u", reference);
    return refuse(unit, ERROR, text);
}

static int get_values(instance *unit, const unsigned int *references, size_t count, double *values) {
    double rates[MODEL(STATES) + 1], observables[MODEL(OBSERVABLES) + 1], indicators[MODEL(GUARDS) + 1];
    int has_rates = 0, has_observables = 0, has_indicators = 0;
    if (!is_there(references, count) || !is_there(values, count)) {
        return refuse(unit, ERROR, "a null pointer in place of value references or values");
    }
    for (size_t i = 0; i < count; ++i) {
        const unsigned int reference = references[i];
        const int place = reference < VARIABLES ? (int)reference : VARIABLES;
        const int is_computed = place >= FIRST_OBSERVABLE || (place >= FIRST_RATE && place < FIRST_INPUT);
        if (place == VARIABLES) {
            return refuse_reference(unit, reference);
        }
        if (is_computed && !has_rates && !has_observables && !has_indicators) {
            const int status = be_ready(unit);
            if (status != OK) {
                return status;
            }
        }
        if (place >= FIRST_INDICATOR) {
            if (!has_indicators) {
                indicators_now(unit, indicators);
                has_indicators = 1;
            }
            values[i] = indicators[place - FIRST_INDICATOR];
        } else if (place >= FIRST_OBSERVABLE) {
            if (!has_observables) {
                observables_now(unit, observables);
                has_observables = 1;
            }
            values[i] = observables[place - FIRST_OBSERVABLE];
        } else if (place >= FIRST_PARAMETER) {
            values[i] = unit->now.parameters[place - FIRST_PARAMETER];
        } else if (place >= FIRST_INPUT) {
            values[i] = unit->now.inputs[place - FIRST_INPUT];
        } else if (place >= FIRST_RATE) {
            if (!has_rates && !rates_at(unit, unit->now.t, unit->now.state, rates)) {
                return refuse_motion(unit);
            }
            has_rates = 1;
            values[i] = rates[place - FIRST_RATE];
        } else {
            values[i] = place >= FIRST_STATE ? unit->now.state[place - FIRST_STATE] : unit->now.t;
        }
        if (!is_finite(values[i])) {
            return refuse_value(unit, DISCARD, name_of(reference), values[i], "no finite number");
        }
    }
    return OK;
}

/* Checks whether a variable may be set to a value in the current mode. */
static int check_value(const instance *unit, unsigned int reference, double value) {
    const int place = reference < VARIABLES ? (int)reference : VARIABLES;
    int modes = 0;
    if (place == VARIABLES) {
        return refuse_reference(unit, reference);
    }
    if (place >= FIRST_STATE && place < FIRST_RATE) {
        modes = INSTANTIATED | INITIALIZATION | (unit->is_exchange ? EVENT | CONTINUOUS : 0);
    } else if (place >= FIRST_INPUT && place < FIRST_PARAMETER) {
        modes = INSTANTIATED | INITIALIZATION | EVENT | CONTINUOUS | STEP;
    } else if (place >= FIRST_PARAMETER && place < FIRST_OBSERVABLE) {
        const double low = parameter_minima[place - FIRST_PARAMETER];
        const double high = parameter_maxima[place - FIRST_PARAMETER];
        /* Also in continuous time: callers that use the unit as a function set all arguments. */
        modes = INSTANTIATED | INITIALIZATION | EVENT | CONTINUOUS | STEP;
        if (value < low) {
            return refuse_value(unit, ERROR, name_of(reference), value, "below the smallest admissible value");
        }
        if (value > high) {
            return refuse_value(unit, ERROR, name_of(reference), value, "above the largest admissible value");
        }
    }
    if (!(unit->now.mode & modes)) {
        return refuse_value(unit, ERROR, name_of(reference), value, "not to be set in the present state of the unit");
    }
    if (!is_finite(value)) {
        return refuse_value(unit, ERROR, name_of(reference), value, "not a finite number");
    }
    return OK;
}

/* Sets all variables, or none if one is invalid. */
static int set_values(instance *unit, const unsigned int *references, size_t count, const double *values) {
    if (!is_there(references, count) || !is_there(values, count)) {
        return refuse(unit, ERROR, "a null pointer in place of value references or values");
    }
    for (size_t i = 0; i < count; ++i) {
        const int status = check_value(unit, references[i], values[i]);
        if (status != OK) {
            return status;
        }
    }
    for (size_t i = 0; i < count; ++i) {
        const int place = (int)references[i];
        if (place >= FIRST_PARAMETER) {
            unit->now.parameters[place - FIRST_PARAMETER] = values[i];
            unit->coefficients_known = 0;
            if (unit->now.mode == CONTINUOUS) {
                unit->now.sides_known = 0;
            }
        } else if (place >= FIRST_INPUT) {
            unit->now.inputs[place - FIRST_INPUT] = values[i];
        } else {
            /* A new state: its sides are recomputed. */
            unit->now.state[place - FIRST_STATE] = values[i];
            unit->now.sides_known = 0;
        }
    }
    return OK;
}

static int set_states(instance *unit, const double *states, size_t count) {
    if (count != MODEL(STATES) || !states) {
        return refuse(unit, ERROR, "not as many continuous states as there are");
    }
    for (int i = 0; i < MODEL(STATES); ++i) {
        if (!is_finite(states[i])) {
            return refuse_value(unit, DISCARD, MODEL(state_names)[i], states[i], "no finite number");
        }
    }
    memcpy(unit->now.state, states, MODEL(STATES) * sizeof(double));
    return OK;
}

static int get_states(const instance *unit, double *states, size_t count) {
    if (count != MODEL(STATES) || !states) {
        return refuse(unit, ERROR, "not as many continuous states as there are");
    }
    memcpy(states, unit->now.state, MODEL(STATES) * sizeof(double));
    return OK;
}

static int get_nominals(const instance *unit, double *nominals, size_t count) {
    if (count != MODEL(STATES) || !nominals) {
        return refuse(unit, ERROR, "not as many continuous states as there are");
    }
    for (int i = 0; i < MODEL(STATES); ++i) {
        nominals[i] = 1;
    }
    return OK;
}

static int get_derivatives(instance *unit, double *rates, size_t count) {
    double all[MODEL(STATES) + 1];
    int status;
    if (count != MODEL(STATES) || !rates) {
        return refuse(unit, ERROR, "not as many derivatives as there are");
    }
    status = be_ready(unit);
    if (status != OK) {
        return status;
    }
    if (!rates_at(unit, unit->now.t, unit->now.state, all)) {
        return refuse_motion(unit);
    }
    memcpy(rates, all, MODEL(STATES) * sizeof(double));
    return OK;
}

static int get_indicators(instance *unit, double *indicators, size_t count) {
    double all[MODEL(GUARDS) + 1];
    int status;
    if (count != MODEL(GUARDS) || !is_there(indicators, count)) {
        return refuse(unit, ERROR, "not as many event indicators as there are");
    }
    status = be_ready(unit);
    if (status != OK) {
        return status;
    }
    indicators_now(unit, all);
    for (int k = 0; k < MODEL(GUARDS); ++k) {
        if (!is_finite(all[k])) {
            return refuse(unit, DISCARD, "an event indicator is no finite number");
        }
        indicators[k] = all[k];
    }
    return OK;
}

static int set_time(instance *unit, double t) {
    if (!is_finite(t)) {
        return refuse_value(unit, ERROR, "time", t, "not a finite number");
    }
    unit->now.t = t;
    return OK;
}
