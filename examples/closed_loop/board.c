/* Runs the loop on a Cortex-M7 without operating system or library. It prints the bits of the same states as host.c
   through the semihosting of a debugger or emulator. */
#include "loop.h"

extern unsigned stack_top;
void reset(void);

__attribute__((section(".vectors"), used)) static void *const vectors[16] = {&stack_top, (void *)reset};

static void call_debugger(int operation, const void *argument) {
    register int r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
}

static void show(long step, const double *state) {
    (void)step;
    for (int i = 0; i < regulator_STATES; ++i) {
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
        call_debugger(4, line);
    }
}

void run(void) {
    run_loop(20000, 1000, show);
    call_debugger(0x18, (const void *)0x20026);
    for (;;) {
    }
}

/* Enables the floating-point unit before any code uses it. */
__attribute__((naked)) void reset(void) {
    __asm__ volatile("ldr r0, =0xe000ed88\n ldr r1, [r0]\n orr r1, r1, #0xf00000\n str r1, [r0]\n dsb\n isb\n b run");
}

/* The compiler may insert calls of these functions. */
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
