/* Numbers drawn by chance, always the same ones; others with SELAS_SEED=n (regress/hardening/seeds). */
#ifndef CHANCE_H
#define CHANCE_H

#include <stdint.h>
#include <stdlib.h>

static uint64_t seed;

static inline void seed_begin(uint64_t own)
{
    const char *other = getenv("SELAS_SEED");
    seed = other != NULL ? strtoull(other, NULL, 10) : own;
}

/* 0 to n - 1 */
static inline size_t chance(size_t n)
{
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return (size_t)(seed >> 33) % n;
}

#endif
