/* The choice between kernels (processor.h). */
#include "base/processor.h"

#include <stdlib.h>
#include <string.h>

#ifdef PROCESSOR_CHOICE
#define PLAIN "x86-64"
#define NAMES "'x86-64', 'x86-64-v3' or 'x86-64-v4'"
#else
#define PLAIN "plain"
#define NAMES "'plain'"
#endif

static const struct {
    const char *name;
    int bytes;
} kinds[PROCESSORS] = {{PLAIN, 16}, {"x86-64-v3", 32}, {"x86-64-v4", 64}};

bool processor_there(enum processor kind)
{
    if (kind == PROCESSOR_PLAIN) return true;
#ifdef PROCESSOR_CHOICE
    /* all processors that have these have the rest of their level (BMI, F16C, LZCNT, MOVBE) */
    const bool v3 =
        __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
    if (kind == PROCESSOR_V3) return v3;
    return v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl");
#else
    return false;
#endif
}

static enum processor best(void)
{
    enum processor kind = PROCESSOR_V4;
    while (!processor_there(kind))
        kind--;
    return kind;
}

/* SELAS_PROCESSOR; NULL: not set. */
static const char *wanted(void)
{
    const char *name = getenv("SELAS_PROCESSOR");
    return name == NULL || *name == '\0' ? NULL : name;
}

/* PROCESSORS: no kind. */
static enum processor find(const char *name)
{
    enum processor kind = PROCESSOR_PLAIN;
    while (kind < PROCESSORS && strcmp(name, kinds[kind].name) != 0)
        kind++;
    return kind;
}

enum processor processor_taken(void)
{
    static int known; /* 1 more than the kind: neither machine nor choice changes while a program runs */
    int kind = __atomic_load_n(&known, __ATOMIC_RELAXED) - 1;
    if (kind < 0) {
        const enum processor named = wanted() == NULL ? PROCESSORS : find(wanted());
        kind = named != PROCESSORS && processor_there(named) ? (int)named : (int)best();
        __atomic_store_n(&known, kind + 1, __ATOMIC_RELAXED);
    }
    return (enum processor)kind;
}

const char *processor_name(enum processor kind)
{
    return kinds[kind].name;
}

int processor_bytes(enum processor kind)
{
    return kinds[kind].bytes;
}

selas_status processor_check(struct messages *messages)
{
    const char *name = wanted();
    if (name == NULL) return SELAS_OK;
    const enum processor named = find(name);
    if (named == PROCESSORS)
        return fail(messages, SELAS_BAD_ARGUMENT,
                    "SELAS_PROCESSOR = '%s' is no kind of processor here; expected " NAMES, name);
    if (!processor_there(named))
        return fail(messages, SELAS_BAD_ARGUMENT,
                    "SELAS_PROCESSOR = '%s': this machine does not have it; the best it has is '%s'", name,
                    processor_name(best()));
    return SELAS_OK;
}
