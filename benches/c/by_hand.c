#include "by_hand.h"
#include <math.h>

#define COORDINATES (3 + ORDER)

/* f_k of Eq. (7). */
static double f_k(double p, double b) {
    return p > b ? p - b : p < -b ? p + b : 0.0;
}

/* f_c of Eq. (8). */
static double f_c(double p, double p_dot, double b) {
    return fabs(p) > b ? p_dot : 0.0;
}

void by_hand_rates(const by_hand *arm, double t, const double *state, double *rates) {
    const double *x = state, *q = state + 3, *v = state + COORDINATES;
    double *acceleration = rates + COORDINATES;
    const double f_sp = arm->stiffness_sp * f_k(x[0], arm->half_width_sp)
        + arm->damping_sp * f_c(x[0], v[0], arm->half_width_sp);
    const double f_pr = arm->stiffness_pr * f_k(x[1], arm->half_width_pr)
        + arm->damping_pr * f_c(x[1], v[1], arm->half_width_pr);
    double sums[4] = {0.0, 0.0, 0.0, 0.0};
    double force, x_c, x_pr;
    int i = 0, k;
    /* Four independent sums, to overlap the additions. */
    for (; i + 4 <= ORDER; i += 4) {
        for (k = 0; k < 4; ++k) {
            sums[k] += arm->bending[i + k] * q[i + k];
        }
    }
    for (; i < ORDER; ++i) {
        sums[0] += arm->bending[i] * q[i];
    }
    force = f_sp + f_pr + ((sums[0] + sums[2]) + (sums[1] + sums[3]));
    x_c = arm->carrier * force;
    x_pr = arm->planet * (f_sp - f_pr) - x_c;
    for (i = 0; i < COORDINATES; ++i) {
        rates[i] = v[i];
    }
    acceleration[0] = arm->motor + arm->fluctuation * sin(arm->omega * t)
        - arm->motor_damping * (v[0] + v[1] + 2.0 * v[2]) - arm->sun * f_sp - x_pr - 2.0 * x_c;
    acceleration[1] = x_pr;
    acceleration[2] = x_c;
    for (i = 0; i < ORDER; ++i) {
        acceleration[3 + i] = arm->minus_square[i] * q[i] + arm->minus_coupling[i] * force;
    }
}
