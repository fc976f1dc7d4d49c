/* Steps of an emitted machine. Prints the bits of the state after every ROW of STEPS steps: to the standard output, or,
   with BOARD, through the semihosting of an emulator, without operating system or library. */
#include HEADER

#ifdef BOARD
extern unsigned stack_top;
void reset(void);
__attribute__((section(".vectors"), used)) static void *const vectors[16] = {&stack_top, (void *)reset};

static void call_debugger(int operation, const void *argument) {
    register int r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
}

static void print(const char *line) { call_debugger(4, line); }

/* Enables the floating-point unit before any code uses it. */
__attribute__((naked)) void reset(void) {
    __asm__ volatile("ldr r0, =0xe000ed88\n ldr r1, [r0]\n orr r1, r1, #0xf00000\n str r1, [r0]\n dsb\n isb\n b main");
}

/* The compiler may call these. */
void *memset(void *to, int value, __SIZE_TYPE__ count) {
    for (char *at = to; count > 0; --count) {
        *at++ = (char)value;
    }
    return to;
}

void *memcpy(void *to, const void *from, __SIZE_TYPE__ count) {
    const char *source = from;
    for (char *at = to; count > 0; --count) {
        *at++ = *source++;
    }
    return to;
}
#else
#include <stdio.h>
static void print(const char *line) { fputs(line, stdout); }
#endif

static void show(const double *state, int count) {
    for (int i = 0; i < count; ++i) {
        union {
            double number;
            unsigned long long bits;
        } value = {state[i]};
        char line[18];
        for (int digit = 0; digit < 16; ++digit) {
            line[digit] = "0123456789abcdef"[(value.bits >> (60 - 4 * digit)) & 15];
        }
        line[16] = '\n';
        line[17] = 0;
        print(line);
    }
}

int main(void) {
    static machine_parameters parameters;
    static machine_coefficients coefficients;
    machine_inputs inputs = {0};
    double state[machine_STATES];
    machine_default_parameters(&parameters);
    machine_prepare(&parameters, &coefficients);
    for (int i = 0; i < machine_STATES; ++i) {
        state[i] = machine_initial_state[i];
    }
    for (int k = 0; k < STEPS; ++k) {
        machine_step(k * LENGTH, LENGTH, state, &inputs, &coefficients);
        if ((k + 1) % ROW == 0) {
            show(state, machine_STATES);
        }
    }
#ifdef BOARD
    call_debugger(0x18, (const void *)0x20026);
#endif
    return 0;
}
