/* Measures forward and inverse dynamics of emitted C, CasADi and Pinocchio alternately over the same states. MODEL is the
 * name of the model, HEADER its header, DEGREES its degrees of freedom; PEER is defined if Pinocchio is linked. Prints the
 * shortest time of a call of each, in ns (0 if missing), forward then inverse, and the difference of the others from the
 * emitted C, relative to the largest number of a call. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include HEADER

#define JOINED(a, b) a##b
#define OF(model, name) JOINED(model, name)
#define N DEGREES
#define STATES 256
#define TURNS 2000

int contender_forward(const double **arg, double **res, long long *iw, double *w, int mem);
int contender_inverse(const double **arg, double **res, long long *iw, double *w, int mem);
#ifdef PEER
void peer_forward(const double *state, const double *inputs, double *accelerations);
void peer_inverse(const double *state, const double *accelerations, double *forces);
#endif

static double states[STATES][2 * N], accelerations[STATES][N], inputs[64], parameters[64];
static OF(MODEL, _inputs) emitted_inputs;
static OF(MODEL, _coefficients) coefficients;
static long long integers[1];
static double *workspace;

static void emitted_forward(int s, double *out) {
    double rates[2 * N];
    OF(MODEL, _rates)(0.0, states[s], &emitted_inputs, &coefficients, rates);
    for (int i = 0; i < N; ++i) {
        out[i] = rates[N + i];
    }
}

static void emitted_inverse(int s, double *out) {
    OF(MODEL, _inverse_dynamics)(0.0, states[s], &emitted_inputs, &coefficients, accelerations[s], out);
}

static void casadi_forward(int s, double *out) {
    const double *arg[4] = {states[s], states[s] + N, inputs, parameters};
    double *res[1] = {out};
    contender_forward(arg, res, integers, workspace, 0);
}

static void casadi_inverse(int s, double *out) {
    const double *arg[5] = {states[s], states[s] + N, inputs, accelerations[s], parameters};
    double *res[1] = {out};
    contender_inverse(arg, res, integers, workspace, 0);
}

#ifdef PEER
static void pinocchio_forward(int s, double *out) {
    peer_forward(states[s], inputs, out);
}

/* Inputs are forces in addition to the computed ones. */
static void pinocchio_inverse(int s, double *out) {
    peer_inverse(states[s], accelerations[s], out);
    for (int i = 0; i < N; ++i) {
        out[i] -= inputs[i];
    }
}
#endif

typedef void (*contender)(int, double *);
static const contender contenders[6] = {
    emitted_forward, casadi_forward,
#ifdef PEER
    pinocchio_forward,
#else
    NULL,
#endif
    emitted_inverse, casadi_inverse,
#ifdef PEER
    pinocchio_inverse,
#else
    NULL,
#endif
};

static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return 1e9 * (double)time.tv_sec + (double)time.tv_nsec;
}

static double apart(contender one, contender other) {
    double worst = 0;
    for (int s = 0; s < STATES; ++s) {
        double a[N], b[N], largest = 0, distance = 0;
        one(s, a);
        other(s, b);
        for (int i = 0; i < N; ++i) {
            largest = fmax(largest, fabs(a[i]));
            distance = fabs(a[i] - b[i]) > distance || isnan(b[i]) ? fabs(a[i] - b[i]) : distance;
        }
        worst = distance / largest <= worst ? worst : distance / largest;
    }
    return worst;
}

static double number(void) {
    static unsigned long long state = 1;
    state = state * 6364136223846793005ULL + 1;
    return (double)(state >> 11) / (double)(1ULL << 52) - 1.0;
}

int main(void) {
    OF(MODEL, _parameters) given;
    OF(MODEL, _default_parameters)(&given);
    OF(MODEL, _prepare)(&given, &coefficients);
    for (size_t i = 0; i < sizeof given / sizeof(double); ++i) {
        parameters[i] = ((const double *)&given)[i];
    }
    for (int i = 0; i < N; ++i) {
        inputs[i] = 0.1 * (i + 1);
    }
    for (size_t i = 0; i < sizeof emitted_inputs / sizeof(double); ++i) {
        ((double *)&emitted_inputs)[i] = inputs[i];
    }
    for (int s = 0; s < STATES; ++s) {
        for (int i = 0; i < N; ++i) {
            states[s][i] = 3.0 * number();
            states[s][N + i] = number();
            accelerations[s][i] = number();
        }
    }
    workspace = malloc(1 << 24);
    double least[6] = {0}, sum = 0;
    for (int turn = 0; turn < TURNS; ++turn) {
        for (int which = 0; which < 6; ++which) {
            if (!contenders[which]) {
                continue;
            }
            double out[N];
            const double begin = now();
            for (int s = 0; s < STATES; ++s) {
                contenders[which](s, out);
                sum += out[0];
            }
            const double each = (now() - begin) / STATES;
            least[which] = turn == 0 || each < least[which] ? each : least[which];
        }
    }
    double distance = 0;
    for (int which = 0; which < 6; ++which) {
        if (contenders[which]) {
            distance = fmax(distance, apart(contenders[which / 3 * 3], contenders[which]));
        }
    }
    for (int which = 0; which < 6; ++which) {
        printf("%.17g ", least[which]);
    }
    printf("%.17g\n", sum == sum ? distance : sum);
    return 0;
}
