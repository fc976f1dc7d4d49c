/* Hand-optimised Eq. (22) with the modes eliminated, the reference for the speed of emitted C.
 * ORDER is the order, at least 1. */
#ifndef BY_HAND_H
#define BY_HAND_H

/* Prepared for one set of parameters, in the order of `Eliminated::prepared`. */
typedef struct {
    double stiffness_sp, damping_sp, half_width_sp; /* N/m, N s/m, m */
    double stiffness_pr, damping_pr, half_width_pr;
    double motor;                   /* m/s^2 */
    double fluctuation;             /* m/s^2 */
    double omega;                   /* rad/s */
    double motor_damping;           /* 1/s */
    double sun, planet, carrier;    /* 1/kg */
    double bending[ORDER];          /* N/m */
    double minus_square[ORDER];     /* 1/s^2 */
    double minus_coupling[ORDER];   /* 1/kg */
} by_hand;

void by_hand_rates(const by_hand *arm, double t, const double *state, double *rates);

#endif
