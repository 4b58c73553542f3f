#include "base/float_rules.h"

#include <float.h>

/* Of a thread that OpenMP gives: what it had, and by how many calls inside each other it was set aside. */
static _Thread_local struct {
    fenv_t own;
    unsigned calls;
} aside;

/* Has the calling thread rules of its own? */
static bool other_rules(void)
{
    volatile const double least = DBL_MIN;
    bool traps = false;
#ifdef __GLIBC__
    traps = fegetexcept() != 0;
#endif
    return traps || fegetround() != FE_TONEAREST || least / 2 <= 0;
}

struct float_rules float_rules_begin(void)
{
    struct float_rules rules = {.others = other_rules()};
    fegetenv(&rules.host);
    fesetenv(FE_DFL_ENV);
    if (!rules.others) return rules;
#pragma omp parallel
    {
        if (aside.calls++ == 0) fegetenv(&aside.own);
        fesetenv(FE_DFL_ENV);
    }
    return rules;
}

void float_rules_end(const struct float_rules *rules)
{
    if (rules->others) {
#pragma omp parallel
        if (aside.calls > 0 && --aside.calls == 0) fesetenv(&aside.own);
    }
    fesetenv(&rules->host);
}
