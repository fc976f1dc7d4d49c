/* Instructions and stack of the functions of an emitted machine on a Cortex-M without operating system, at random
 * states. MODEL is the name of the model, MODEL_H its header. Prints for each function the largest number of ticks of CALLS calls
 * more than those of an empty function at states of usual size, then at all states, and the bytes of stack. In QEMU with
 * `-icount shift=0` a tick is 40 instructions. */
#include MODEL_H

#define JOINED(model, item) model##item
#define EXPANDED(model, item) JOINED(model, item)
#define ITEM(item) EXPANDED(MODEL, item)

enum { CALLS = 80, STATES_OF_USUAL_SIZE = 12, ALL_STATES = 24 };

typedef ITEM(_real) real;

extern unsigned stack_top;
extern unsigned stack_bottom;
void reset(void);

__attribute__((section(".vectors"), used)) static void *const vectors[16] = {&stack_top, (void *)reset};

static ITEM(_parameters) parameters;
static ITEM(_coefficients) coefficients, prepared;
static ITEM(_inputs) inputs;
static real state[ITEM(_STATES) + 1], moved[ITEM(_STATES) + 1], output[4096];

static void call_debugger(int operation, const void *argument) {
    register int r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
}

static void print(unsigned number, char end) {
    char text[10];
    for (int digit = 0; digit < 8; ++digit) {
        text[digit] = "0123456789abcdef"[(number >> (28 - 4 * digit)) & 15];
    }
    text[8] = end;
    text[9] = 0;
    call_debugger(4, text);
}

/* Functions with the interfaces of the emitted ones, each one instruction. */
__attribute__((naked, noinline)) static void empty(void) {
    __asm__ volatile("bx lr");
}

typedef void (*function)(void);
typedef void (*function_of_state)(real, const real *, const void *, const void *, real *);
typedef void (*function_of_step)(real, real, real *, const void *, const void *);
typedef void (*function_of_parameters)(const void *, void *);

static volatile function called;

static void call_of_state(void) {
    ((function_of_state)called)((real)0.1, state, &inputs, &coefficients, output);
}

static void call_of_step(void) {
    for (int i = 0; i < ITEM(_STATES); ++i) {
        moved[i] = state[i];
    }
    ((function_of_step)called)((real)0.1, (real)1e-3, moved, &inputs, &coefficients);
}

static void call_of_parameters(void) {
    ((function_of_parameters)called)(&parameters, &prepared);
}

#define SYSTICK_CONTROL (*(volatile unsigned *)0xe000e010)
#define SYSTICK_RELOAD (*(volatile unsigned *)0xe000e014)
#define SYSTICK_CURRENT (*(volatile unsigned *)0xe000e018)

static unsigned ticks(function with, function of) {
    called = of;
    SYSTICK_RELOAD = 0xffffff;
    SYSTICK_CURRENT = 0;
    SYSTICK_CONTROL = 5;
    while (SYSTICK_CURRENT == 0) {
    }
    const unsigned begin = SYSTICK_CURRENT;
    for (int i = 0; i < CALLS; ++i) {
        with();
    }
    return (begin - SYSTICK_CURRENT) & 0xffffff;
}

static unsigned stack(function with, function of) {
    unsigned here;
    __asm__ volatile("mov %0, sp" : "=r"(here));
    called = of;
    for (volatile unsigned *word = &stack_bottom; (unsigned)word < here; ++word) {
        *word = 0xa5a55a5a;
    }
    with();
    const volatile unsigned *word = &stack_bottom;
    while ((unsigned)word < here && *word == 0xa5a55a5a) {
        ++word;
    }
    return here - (unsigned)word;
}

static unsigned seed = 1;

static unsigned draw(void) {
    seed = seed * 1664525 + 1013904223;
    return seed >> 8;
}

/* Draws a number of usual size, or any of zero, tiny, subnormal, huge, infinite and undefined ones. */
static real number(int is_usual) {
    const real usual = (real)((int)(draw() % 200001) - 100000) * (real)2e-5;
    const real tiny = sizeof(real) == 4 ? (real)1e-40 : (real)1e-310;
    const real huge = sizeof(real) == 4 ? (real)1e30 : (real)1e300;
    if (is_usual) {
        return usual;
    }
    switch (draw() % 10) {
    case 0:
        return 0;
    case 1:
        return usual * huge;
    case 2:
        return usual * huge * huge;
    case 3:
        return huge * huge - huge * huge;
    case 4:
        return usual * (real)1e4;
    case 5:
        return usual;
    default:
        return usual * tiny;
    }
}

static void draw_state(int is_usual) {
    for (int i = 0; i < ITEM(_STATES); ++i) {
        state[i] = number(is_usual);
    }
    for (unsigned i = 0; i < sizeof inputs / sizeof(real); ++i) {
        ((real *)&inputs)[i] = number(is_usual);
    }
}

static void measure(function with, function of) {
    unsigned worst[2] = {0, 0}, deepest = 0;
    seed = 1;
    ITEM(_default_parameters)(&parameters);
    for (int i = 0; i < ALL_STATES; ++i) {
        const int is_usual = i < STATES_OF_USUAL_SIZE;
        draw_state(is_usual);
        const unsigned alone = ticks(with, empty);
        const unsigned more = ticks(with, of) - alone;
        const unsigned depth = stack(with, of) - stack(with, empty);
        for (int kind = is_usual ? 0 : 1; kind < 2; ++kind) {
            worst[kind] = more > worst[kind] ? more : worst[kind];
        }
        deepest = depth > deepest ? depth : deepest;
        if (with == call_of_parameters) {
            for (unsigned k = 0; k < sizeof parameters / sizeof(real); ++k) {
                ((real *)&parameters)[k] *= 1 + number(is_usual) / 8;
            }
        }
    }
    print(worst[0], ' ');
    print(worst[1], ' ');
    print(deepest, '\n');
}

void run(void) {
    ITEM(_default_parameters)(&parameters);
    ITEM(_prepare)(&parameters, &coefficients);
    measure(call_of_parameters, (function)ITEM(_prepare));
    measure(call_of_state, (function)ITEM(_rates));
    measure(call_of_state, (function)ITEM(_observables));
    measure(call_of_state, (function)ITEM(_energy));
    measure(call_of_state, (function)ITEM(_power));
    measure(call_of_state, (function)ITEM(_guards));
    measure(call_of_state, (function)ITEM(_mass_matrix));
    measure(call_of_step, (function)ITEM(_step));
    call_debugger(0x18, (const void *)0x20026);
    for (;;) {
    }
}

/* Enables the floating-point unit before any code uses it. */
__attribute__((naked)) void reset(void) {
    __asm__ volatile("ldr r0, =0xe000ed88\n ldr r1, [r0]\n orr r1, r1, #0xf00000\n str r1, [r0]\n dsb\n isb\n b run");
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
