/* Functions of `functions.txt`, which
 *     arm-none-eabi-gcc -mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard -O1 -c functions.c
 *     arm-none-eabi-gcc -mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard -nostdlib -r functions.o -lgcc -o linked.o
 *     arm-none-eabi-objdump -t -d -r linked.o > functions.txt
 * writes. */
void missing(float *numbers);

static float read(volatile float *number) {
    return *number;
}

/* Seven times. */
void counted(float *numbers, float factor) {
    for (int i = 0; i < 7; ++i) {
        numbers[i] *= factor;
    }
}

/* The loop of events: until nothing changes, at most five times. */
int limited(volatile float *numbers) {
    int pivots = 0;
    for (; pivots < 5; ++pivots) {
        if (read(numbers) < 0.0F) {
            break;
        }
    }
    return pivots;
}

/* As often as the numbers demand. */
int by_data(volatile float *numbers) {
    int steps = 0;
    while (numbers[0] > 1e-6F) {
        numbers[0] = 0.5F * numbers[0];
        ++steps;
    }
    return steps;
}

/* As often as the caller demands. */
void by_argument(float *numbers, int count) {
    for (int i = 0; i < count; ++i) {
        numbers[i] = 2.0F * numbers[i];
    }
}

int recursive(volatile float *numbers) {
    return numbers[0] > 0.0F ? 1 + recursive(numbers + 1) * recursive(numbers + 2) : 0;
}

float by_pointer(float (*function)(float)) {
    return 1.0F + function(2.0F);
}

void with_missing(float *numbers) {
    missing(numbers);
    numbers[0] = 1.0F;
}

/* Stack of a size that the caller gives. */
float of_variable_stack(int count) {
    volatile float numbers[count];
    numbers[0] = 1.0F;
    return numbers[0];
}

/* Soft doubles, in a loop whose counter lies on the stack. */
void product(const double *left, const double *right, double *products) {
    volatile double last = 0.0;
    for (int i = 0; i < 3; ++i) {
        products[i] = left[i] * right[i] / last;
        last = products[i];
    }
}
