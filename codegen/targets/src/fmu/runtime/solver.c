/* Solver of co-simulation: the embedded Runge-Kutta pair of orders 5 and 4 of Dormand and Prince. Its interpolant
 * detects crossings of switching surfaces within a step. Further steps with the rates of the near side, which are smooth
 * beyond the surface, locate a crossing. */

#define STAGES 7
/* Fractions of a step at which surfaces are checked, in addition to its end. */
#define LOOKS 8
/* Limits of chatter: number of successive events, and their largest distance. */
#define MOST_EVENTS_AT_ONCE 200
#define AT_ONCE 1e-10

static const double stage_times[STAGES] = {0, 1. / 5, 3. / 10, 4. / 5, 8. / 9, 1, 1};
static const double stage_weights[STAGES][STAGES - 1] = {
    {0, 0, 0, 0, 0, 0},
    {1. / 5, 0, 0, 0, 0, 0},
    {3. / 40, 9. / 40, 0, 0, 0, 0},
    {44. / 45, -56. / 15, 32. / 9, 0, 0, 0},
    {19372. / 6561, -25360. / 2187, 64448. / 6561, -212. / 729, 0, 0},
    {9017. / 3168, -355. / 33, 46732. / 5247, 49. / 176, -5103. / 18656, 0},
    {35. / 384, 0, 500. / 1113, 125. / 192, -2187. / 6784, 11. / 84},
};
/* Weights of the error estimate: order 5 minus order 4. */
static const double error_weights[STAGES] = {
    71. / 57600, 0, -71. / 16695, 71. / 1920, -17253. / 339200, 22. / 525, -1. / 40,
};
/* Coefficients of the interpolant of order 4. */
static const double dense_weights[STAGES] = {
    -12715105075. / 11282082432., 0, 87487479700. / 32700410799., -10690763975. / 1880347072.,
    701980252875. / 199316789632., -1453857185. / 822651844., 69997945. / 29380423.,
};

/* Step: size, rates of the stages, final state, and error estimate relative to the tolerance. */
typedef struct {
    double length;
    double rates[STAGES][MODEL(STATES) + 1];
    double end[MODEL(STATES) + 1];
    double error;
} step;

/* Computes a step from the current point, with its rates in `rates[0]`. Returns whether all rates are finite. */
static int try_step(const instance *unit, double length, step *tried) {
    const double *from = unit->now.state;
    double largest = 0;
    tried->length = length;
    for (int s = 1; s < STAGES; ++s) {
        for (int i = 0; i < MODEL(STATES); ++i) {
            double sum = 0;
            for (int r = 0; r < s; ++r) {
                sum += stage_weights[s][r] * tried->rates[r][i];
            }
            tried->end[i] = from[i] + length * sum;
        }
        if (!rates_at(unit, unit->now.t + stage_times[s] * length, tried->end, tried->rates[s])) {
            return 0;
        }
    }
    for (int i = 0; i < MODEL(STATES); ++i) {
        double error = 0, scale = unit->now.magnitudes[i];
        for (int s = 0; s < STAGES; ++s) {
            const double moved = magnitude(length * tried->rates[s][i]);
            error += error_weights[s] * tried->rates[s][i];
            scale = moved > scale ? moved : scale;
        }
        error = magnitude(length * error);
        if (error > largest * unit->now.tolerance * scale) {
            largest = error / (unit->now.tolerance * scale);
        }
    }
    tried->error = largest;
    return is_finite(largest);
}

/* Computes the state at a fraction of a step. */
static void within(const instance *unit, const step *tried, double part, double *state) {
    const double rest = 1 - part;
    for (int i = 0; i < MODEL(STATES); ++i) {
        const double whole = tried->end[i] - unit->now.state[i];
        const double before = tried->length * tried->rates[0][i] - whole;
        const double after = whole - tried->length * tried->rates[STAGES - 1][i] - before;
        double quartic = 0;
        for (int s = 0; s < STAGES; ++s) {
            quartic += dense_weights[s] * tried->rates[s][i];
        }
        state[i] = unit->now.state[i]
            + part * (whole + rest * (before + part * (after + rest * tried->length * quartic)));
    }
}

/* Returns the distance of a state from the nearest surface, relative to the largest distance so far;
 * negative beyond a surface. */
static double nearest(const instance *unit, double t, const double *state) {
    double guards[MODEL(GUARDS) + 1];
    double least = 1;
    guards_at(unit, t, state, guards);
    for (int k = 0; k < MODEL(GUARDS); ++k) {
        const int side = unit->now.sides[k];
        const double reach = unit->now.reaches[k] > 0 ? unit->now.reaches[k] : 1;
        const double distance = (side ? side * guards[k] : -magnitude(guards[k])) / reach;
        if (distance < least) {
            least = distance;
        }
    }
    return least;
}

/* Returns fractions of a step before and after the first crossing; 0 if there is none. */
static double look_for_crossing(const instance *unit, const step *tried, double *before) {
    double state[MODEL(STATES) + 1];
    *before = 0;
    if (MODEL(GUARDS) == 0) {
        return 0;
    }
    for (int look = 1; look <= LOOKS; ++look) {
        const double part = (double)look / LOOKS;
        within(unit, tried, part, state);
        if (nearest(unit, unit->now.t + part * tried->length, look < LOOKS ? state : tried->end) < 0) {
            return part;
        }
        *before = part;
    }
    return 0;
}

/* Shortens a step to end just beyond the first surface. Returns 0 if it crosses none, for example if only the
 * interpolant touches a surface, and -1 if a rate is not finite. */
static int locate(const instance *unit, double before, double after, step *tried) {
    double low = before, high = after, low_value, high_value;
    step trial = *tried;
    if (!try_step(unit, high, &trial)) {
        return -1;
    }
    high_value = nearest(unit, unit->now.t + high, trial.end);
    if (high_value >= 0) {
        return 0;
    }
    *tried = trial;
    low_value = nearest(unit, unit->now.t, unit->now.state);
    if (low > 0) {
        if (!try_step(unit, low, &trial)) {
            return -1;
        }
        low_value = nearest(unit, unit->now.t + low, trial.end);
        if (low_value < 0) {
            *tried = trial;
            high = low;
            high_value = low_value;
            low = 0;
            low_value = nearest(unit, unit->now.t, unit->now.state);
        }
    }
    for (int i = 0; i < 120; ++i) {
        const double middle = low + 0.5 * (high - low);
        const double span = low_value - high_value;
        double at = i % 2 == 0 && span > 0 ? low + (high - low) * (low_value / span) : middle;
        double value;
        at = at > low && at < high ? at : middle;
        if (!(at > low && at < high) || high - low <= DBL_EPSILON * (magnitude(unit->now.t) + high)) {
            break;
        }
        if (!try_step(unit, at, &trial)) {
            return -1;
        }
        value = nearest(unit, unit->now.t + at, trial.end);
        if (value < 0) {
            *tried = trial;
            high = at;
            high_value = value;
        } else {
            low = at;
            low_value = value;
        }
    }
    return 1;
}

/* Returns the factor of the next step size: error^(-1/5) by Newton's method, with a safety factor and bounds. */
static double next_factor(double error) {
    double root = 1;
    if (error < 1e-5) {
        return 5;
    }
    if (error > 1e4) {
        return 0.1;
    }
    for (int i = 0; i < 60; ++i) {
        root += 0.2 * (error / (root * root * root * root) - root);
    }
    return 0.9 / root > 5 ? 5 : 0.9 / root;
}

/* Returns the first step size, in which the fastest state changes by a thousandth of its scale. */
static double first_step(const instance *unit, const double *rates, double most) {
    double length = 1e-3 * most;
    for (int i = 0; i < MODEL(STATES); ++i) {
        const double size = unit->now.magnitudes[i], rate = magnitude(rates[i]);
        if (size > 0 && rate * length > 1e-3 * size) {
            length = 1e-3 * size / rate;
        }
    }
    return length;
}

/* Integrates to a time. After a failure it logs the reason and keeps the last valid point. */
static int advance(instance *unit, double end) {
    step *tried = malloc(sizeof *tried);
    double last_event = unit->now.t;
    int events = 0, changed, status = tried ? update_sides(unit, &changed) : DISCARD;
    int has_rates = 0;
    while (status == OK && unit->now.t < end) {
        const double rest = end - unit->now.t;
        const double least = 16 * DBL_EPSILON * (magnitude(unit->now.t) > rest ? magnitude(unit->now.t) : rest);
        double length = unit->now.step, before, after;
        int is_last, crossed = 0;
        if (!has_rates && !rates_at(unit, unit->now.t, unit->now.state, tried->rates[0])) {
            status = refuse_motion(unit);
            break;
        }
        has_rates = 1;
        if (!(length > 0)) {
            length = first_step(unit, tried->rates[0], rest);
        }
        is_last = length >= rest * (1 - 1e-9);
        length = is_last ? rest : length;
        if (length < least && !is_last) {
            status = refuse_value(unit, DISCARD, "time", unit->now.t, "here the solver's steps become too short");
            break;
        }
        if (!try_step(unit, length, tried)) {
            if (length <= least) {
                status = refuse_motion(unit);
                break;
            }
            unit->now.step = 0.1 * length;
            continue;
        }
        if (tried->error > 1 && length > least) {
            const double factor = next_factor(tried->error);
            unit->now.step = length * (factor < 0.9 ? factor : 0.9);
            continue;
        }
        if (!is_last || tried->error > 1e-3) {
            unit->now.step = length * next_factor(tried->error);
        }
        after = look_for_crossing(unit, tried, &before);
        if (after > 0) {
            crossed = locate(unit, before * length, after * length, tried);
            if (crossed < 0) {
                status = refuse_motion(unit);
                break;
            }
        }
        memcpy(unit->now.state, tried->end, MODEL(STATES) * sizeof(double));
        unit->now.t = is_last && crossed == 0 ? end : unit->now.t + tried->length;
        memcpy(tried->rates[0], tried->rates[STAGES - 1], sizeof tried->rates[0]);
        if (crossed == 0) {
            note_magnitudes(unit);
            continue;
        }
        has_rates = 0;
        status = update_sides(unit, &changed);
        events = unit->now.t - last_event <= AT_ONCE * (1 + magnitude(unit->now.t)) ? events + 1 : 0;
        last_event = unit->now.t;
        if (status == OK && events > MOST_EVENTS_AT_ONCE) {
            status = refuse_value(
                unit, DISCARD, "time", unit->now.t,
                "here the motion does not leave a switching surface, as dry friction holds a body at rest; "
                "let what jumps there grow over a small distance instead"
            );
        }
    }
    free(tried);
    return status;
}

/* Checks the arguments of a communication step and runs it. */
static int communicate(instance *unit, double from, double length) {
    const double end = from + length;
    const double slack = 1e-9 * (magnitude(unit->now.t) + magnitude(length));
    if (!(length > 0) || !is_finite(end)) {
        return refuse_value(unit, ERROR, "communicationStepSize", length, "not a step forward");
    }
    if (!(magnitude(from - unit->now.t) <= slack)) {
        return refuse_value(unit, ERROR, "currentCommunicationPoint", from, "not where the last step ended");
    }
    if (unit->now.has_stop && end > unit->now.stop + slack) {
        return refuse_value(unit, ERROR, "communicationStepSize", length, "the step leads beyond the stop time");
    }
    return advance(unit, end);
}
