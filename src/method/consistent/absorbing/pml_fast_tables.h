/* Tables of the shared passes of a slab, made of its terms. */
#ifndef SELAS_METHOD_CONSISTENT_ABSORBING_PML_FAST_TABLES_H
#define SELAS_METHOD_CONSISTENT_ABSORBING_PML_FAST_TABLES_H

#include "method/consistent/absorbing/pml_fast.h"
#include "method/consistent/absorbing/pml_terms.h"

/* The terms of a slab. */
struct slab_terms {
    struct terms gradient, outer, pull;
};

/* n zeros, floats or doubles; NULL: no memory. */
void *pml_numbers(size_t n, bool single);

/* How many products with slopes along f and along b the terms have: sets crosses and overs. */
void pml_count_crosses(struct fast_slab *fast, const struct slab_terms *terms);
/* After that: can the passes of the slab be shared? The two slopes of others are taken alike, and B of a part. */
bool pml_shares_passes(const struct fast_slab *fast, const struct slab_terms *terms);
/* Sets taps_f, parts and all tables, where sizes and places are known; false: no memory. */
bool pml_lay_tables(struct fast_slab *fast, const struct slab_terms *terms, bool single);
/* After that: does a part wait for its product over b? */
bool pml_waits(const struct fast_slab *fast, int part);
void pml_free_tables(struct fast_slab *fast);

#endif
