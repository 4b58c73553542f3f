/* The rules of floating-point arithmetic that the library counts on, whatever the host has set: rounding to
 * nearest, no traps (gfortran's -ffpe-trap, feenableexcept), numbers below the least normal one kept (-ffast-math
 * drops them). */
#ifndef SELAS_BASE_FLOAT_RULES_H
#define SELAS_BASE_FLOAT_RULES_H

#include <fenv.h>
#include <stdbool.h>

struct float_rules {
    fenv_t host;
    bool others; /* the host's threads had other rules, too */
};

/* The calling thread has those rules until the end; so have the threads that OpenMP gives it, which have the host's
 * where the host had them made. */
struct float_rules float_rules_begin(void);
void float_rules_end(const struct float_rules *rules);

#endif
