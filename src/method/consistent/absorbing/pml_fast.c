/* Making the shared passes of absorbing layers (pml_fast.h): sizes, fields, room for threads. */
#include "method/consistent/absorbing/pml_fast_tables.h"

#include "base/memory.h"

static size_t rounded(size_t n, size_t unit)
{
    return (n + unit - 1) / unit * unit;
}

/* Sizes and places. */
static void lay_sizes(const struct consistent *c, struct fast_slab *fast)
{
    const struct slab *slab = fast->slab;
    const size_t step[3] = {1, c->n[0], c->plane};
    const int j = slab->axis;
    fast->axis[ROLE_S] = j;
    fast->axis[ROLE_F] = j == 0 ? 1 : 0;
    fast->axis[ROLE_B] = 3 - j - fast->axis[ROLE_F];
    for (int role = 0; role < 3; role++)
        fast->step[role] = step[fast->axis[role]];
    /* Nothing moves at the outer end, which is held: it is left out. */
    const size_t out = slab->end == 0 ? 1 : 0;
    fast->inside = slab->inside;
    fast->inside.n[j]--;
    fast->inside.at[j] += out;
    fast->damping = slab->damping + out;
    fast->ns = fast->inside.n[j];
    fast->nb = c->n[fast->axis[ROLE_B]];
    fast->first_b = c->part.along[fast->axis[ROLE_B]].first;
    fast->first_f = c->part.along[fast->axis[ROLE_F]].first;
    fast->nf = c->n[fast->axis[ROLE_F]];
    fast->width = pml_fast_width(c, fast->first_f % (2 * FAST_LANES) + fast->nf);
    fast->start = slab->region.at[j] + out;
    fast->region = slab->region.n[j] - 1;
    fast->offset = fast->inside.at[j] - fast->start;
    fast->first = fast->start * fast->step[ROLE_S];
}

static bool lay_slab(struct pml_fast *f, struct fast_slab *fast, const struct slab_terms *terms)
{
    const size_t n = fast->nb * fast->ns * fast->width;
    size_t waits = 0;
    bool good = pml_lay_tables(fast, terms, f->single);
    fast->middle = pml_numbers(n, f->single);
    fast->rests = array_new(fast->nb, sizeof *fast->rests);
    fast->moves = array_new(fast->nb, sizeof *fast->moves);
    fast->idle = array_new(fast->nb, sizeof *fast->idle);
    good = good && fast->middle != NULL && fast->rests != NULL && fast->moves != NULL && fast->idle != NULL;
    for (size_t i = 0; i < fast->parts; i++) {
        if (!pml_waits(fast, (int)i)) continue;
        waits++;
        fast->wait[i] = pml_numbers(n, f->single);
        good = good && fast->wait[i] != NULL;
    }
    for (size_t i = 0; i < fast->overs; i++) {
        fast->over[i].wait = pml_numbers(n, f->single);
        good = good && fast->over[i].wait != NULL;
    }
    f->bytes += (1 + waits + fast->overs) * n * (f->single ? sizeof(float) : sizeof(double));
    return good;
}

size_t pml_fast_width(const struct consistent *c, size_t numbers)
{
    return rounded(numbers, c->options.single ? 2 * FAST_LANES : FAST_LANES);
}

/* Room for a thread: rows of the region of three components and of the slab, groups of rows. */
static bool lay_buffers(const struct consistent *c, struct pml_fast *f)
{
    size_t rows = 0;
    for (size_t s = 0; s < c->pml->slabs; s++) {
        const size_t own = (f->slab[s].region + 1) * (f->slab[s].width + FAST_PAD);
        rows = own > rows ? own : rows;
    }
    f->buffer = array_new((size_t)c->threads, sizeof *f->buffer);
    if (f->buffer == NULL) return false;
    for (int t = 0; t < c->threads; t++) {
        f->buffer[t] = pml_numbers(FAST_BLOCKS * rows, f->single);
        if (f->buffer[t] == NULL) return false;
    }
    f->bytes += (size_t)c->threads * FAST_BLOCKS * rows * (f->single ? sizeof(float) : sizeof(double));
    return true;
}

/* Terms of the slabs; false if one of them cannot share its passes. */
static bool take_terms(struct consistent *c, struct slab_terms *terms, bool *good)
{
    for (size_t s = 0; *good && s < c->pml->slabs; s++) {
        struct slab *slab = &c->pml->slab[s];
        struct fast_slab fast = {.slab = slab};
        if (!far_end_out(c, slab)) return false;
        lay_sizes(c, &fast);
        terms[s] = (struct slab_terms){terms_gradient(c, slab), terms_outer(c, slab), terms_pull(c, slab)};
        *good = terms[s].gradient.good && terms[s].outer.good && terms[s].pull.good;
        if (!*good) return false;
        pml_count_crosses(&fast, &terms[s]);
        if (!pml_shares_passes(&fast, &terms[s])) return false;
    }
    return *good;
}

static void free_passes(const struct consistent *c, struct pml_fast *f)
{
    if (f == NULL) return;
    for (size_t s = 0; s < c->pml->slabs; s++) {
        struct fast_slab *fast = &f->slab[s];
        pml_free_tables(fast);
        for (int part = 0; part < FAST_PARTS; part++)
            array_free(fast->wait[part]);
        for (int n = 0; n < FAST_CROSSES; n++)
            array_free(fast->over[n].wait);
        array_free(fast->middle);
        array_free(fast->rests);
        array_free(fast->moves);
        array_free(fast->idle);
    }
    for (int t = 0; f->buffer != NULL && t < c->threads; t++)
        array_free(f->buffer[t]);
    array_free(f->buffer);
    array_free(f->told);
    array_free(f);
}

static struct pml_fast *lay_passes(struct consistent *c, const struct slab_terms *terms, bool single)
{
    struct pml_fast *f = array_new(1, sizeof *f);
    bool good = f != NULL;
    for (size_t s = 0; good && s < c->pml->slabs; s++) {
        struct fast_slab *fast = &f->slab[s];
        f->single = single;
        fast->slab = &c->pml->slab[s];
        lay_sizes(c, fast);
        pml_count_crosses(fast, &terms[s]);
        c->pml->slab[s].inner = fast->nb * fast->ns * fast->width;
        good = lay_slab(f, fast, &terms[s]);
    }
    if (good) f->told = array_new(2 * c->part.along[DEPTH].whole, sizeof *f->told);
    if (good && f->told != NULL && lay_buffers(c, f)) return f;
    free_passes(c, f);
    return NULL;
}

bool pml_fast_create(struct consistent *c)
{
    const bool layered = c->weighted[WEIGHT_MU] != NULL && c->dimension == 3 && c->hform != NULL;
    if (c->fused == NULL && (!layered || c->options.unfused)) return true;
    struct slab_terms *terms = array_new(BOX_FACES, sizeof *terms);
    bool good = terms != NULL;
    if (good && take_terms(c, terms, &good)) {
        c->pml->fast = lay_passes(c, terms, false);
        if (c->options.single) c->pml->single = lay_passes(c, terms, true);
        good = c->pml->fast != NULL && (!c->options.single || c->pml->single != NULL);
    }
    if (good && c->pml->fast != NULL) c->pml->bytes += c->pml->fast->bytes;
    if (good && c->pml->single != NULL) c->pml->bytes += c->pml->single->bytes;
    array_free(terms);
    return good;
}

void pml_fast_free(struct consistent *c)
{
    free_passes(c, c->pml->fast);
    free_passes(c, c->pml->single);
}
