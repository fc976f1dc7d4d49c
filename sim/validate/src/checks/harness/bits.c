static void show(const NAME_real *numbers, int count) {
    for (int i = 0; i < count; ++i) {
        const double number = (double)numbers[i];
        uint64_t bits;
        memcpy(&bits, &number, sizeof bits);
        printf("%s%016" PRIx64, i > 0 ? " " : "", bits);
    }
    printf("\n");
}

static int next(NAME_real *numbers, int count) {
    for (int i = 0; i < count; ++i) {
        uint64_t bits;
        double number;
        if (scanf("%" SCNx64, &bits) != 1) {
            return 0;
        }
        memcpy(&number, &bits, sizeof number);
        numbers[i] = (NAME_real)number;
    }
    return 1;
}
