/* Simulation of many arms on the host, for comparison with the device. */
#ifndef ARMS_H
#define ARMS_H
#include <stddef.h>
#ifndef planetary_arm_REAL
#define planetary_arm_REAL double
#endif
#ifdef __cplusplus
extern "C" {
#endif

/* Advances the arms `begin` to `end` (exclusive) by `steps` steps of length `h` (in s). `states` has STATES numbers for each arm. */
void advance_on_host(
    planetary_arm_REAL *states, size_t begin, size_t end, int steps, planetary_arm_REAL h
);

#ifdef __cplusplus
}
#endif
#endif
