/* Runs the loop on this machine. It compares every row of a table of `eomgen simulate` bit for bit, and prints the bits
   of some states for the comparison with the board. */
#include "loop.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ROW 10
#define SHOWN 1000

static FILE *table;
static long rows, different;

static void show(long step, const double *state) {
    char line[1024];
    char *at = line;
    if (fgets(line, sizeof line, table) == NULL) {
        ++different;
        return;
    }
    strtod(at, &at);
    for (int i = 0; i < regulator_STATES; ++i) {
        const double expected = strtod(at + 1, &at);
        different += memcmp(&expected, &state[i], sizeof expected) != 0;
        if (step % SHOWN == 0) {
            unsigned long long bits;
            memcpy(&bits, &state[i], sizeof bits);
            fprintf(stderr, "%016llx\n", bits);
        }
    }
    ++rows;
}

int main(int count, char **arguments) {
    char names[1024];
    table = count > 1 ? fopen(arguments[1], "r") : NULL;
    if (table == NULL || fgets(names, sizeof names, table) == NULL) {
        fprintf(stderr, "usage: loop TABLE.csv\n");
        return 2;
    }
    run_loop(20000, ROW, show);
    printf("%ld rows, %ld numbers differ\n", rows, different);
    return different != 0;
}
