/* Tables of the shared passes of absorbing layers (pml_fast.h): the matrices are those of the terms
 * (pml_terms.c), with their factors. */
#include "method/pml_fast.h"
#include "method/fused.h"
#include "method/pml_terms.h"

#include "base/memory.h"

#include <string.h>

static size_t rounded(size_t n, size_t unit)
{
    return (n + unit - 1) / unit * unit;
}

/* The terms of a slab. */
struct slab_terms {
    struct terms gradient, outer, pull;
};

/* The one term from an input to a component. */
static const struct tensor_term *term_of(const struct terms *terms, int out, int in)
{
    for (size_t i = 0; i < terms->count; i++)
        if (terms->term[i].out == out && terms->term[i].in == in) return &terms->term[i];
    return NULL;
}

/* Weights of one group of rows, from the columns that are not 0 alone. */
static bool lay_group(struct row_group *group, const struct band *band, double factor, size_t row,
                      size_t column, size_t columns)
{
    size_t end = 0;
    group->from = columns;
    for (size_t j = 0; j < columns; j++)
        for (size_t r = 0; r < group->rows; r++) {
            if (band_get(band, row + group->to + r, column + j) == 0) continue;
            group->from = j < group->from ? j : group->from;
            end = j + 1;
        }
    group->from = end == 0 ? 0 : group->from;
    group->inputs = end - group->from;
    group->weight = array_new(group->inputs * group->rows, sizeof *group->weight);
    for (size_t t = 0; group->weight != NULL && t < group->inputs; t++)
        for (size_t r = 0; r < group->rows; r++)
            group->weight[t * group->rows + r] =
                factor * band_get(band, row + group->to + r, column + group->from + t);
    return group->weight != NULL;
}

/* factor * the part of a matrix from `row` and `column` on, in groups of at most so many rows. */
static bool lay_table(struct row_table *table, const struct band *band, double factor, size_t row,
                      size_t rows, size_t column, size_t columns, size_t most)
{
    const size_t groups = (rows + most - 1) / most;
    table->group = array_new(groups, sizeof *table->group);
    if (table->group == NULL) return false;
    table->groups = groups;
    for (size_t g = 0; g < groups; g++) {
        struct row_group *group = &table->group[g];
        group->to = g * most;
        group->rows = rows - group->to < most ? rows - group->to : most;
        if (!lay_group(group, band, factor, row, column, columns)) return false;
    }
    return true;
}

static void free_table(struct row_table *table)
{
    for (size_t g = 0; g < table->groups; g++)
        array_free(table->group[g].weight);
    array_free(table->group);
}

/* Rows inside the slab, or of its region. */
struct span {
    size_t from, n;
};

static bool lay_across(struct row_table *table, const struct tensor_term *term, int axis, double factor,
                       struct span to, struct span from)
{
    return lay_table(table, term->matrix[axis], factor, to.from, to.n, from.from, from.n, FAST_ROWS);
}

/* Matrix of the rows b. */
static bool lay_over_b(const struct fast_slab *fast, struct row_table *table, const struct tensor_term *term,
                       double factor)
{
    return lay_table(table, term->matrix[fast->axis[ROLE_B]], factor, 0, fast->nb, 0, fast->nb, FAST_GROUP);
}

/* By diagonals: [taps_f * width]. */
static double *lay_along_f(const struct fast_slab *fast, const struct tensor_term *term, double factor)
{
    const struct band *band = term->matrix[fast->axis[ROLE_F]];
    double *table = array_new(fast->taps_f * fast->width, sizeof *table);
    for (size_t i = 0; table != NULL && i < fast->nf; i++)
        for (size_t t = 0; t < fast->taps_f; t++)
            if (i + t >= fast->taps_f / 2 && i + t - fast->taps_f / 2 < fast->nf)
                table[t * fast->width + i] = factor * band_get(band, i, i + t - fast->taps_f / 2);
    return table;
}

static bool lay_tables(struct fast_slab *fast, const struct slab_terms *terms)
{
    const int j = fast->axis[ROLE_S], b = fast->axis[ROLE_B], f = fast->axis[ROLE_F];
    const struct span region = {0, fast->region}, inside = {fast->offset, fast->ns};
    bool good = true;
    for (int i = 0; good && i < 3; i++) {
        const struct tensor_term *gradient = term_of(&terms->gradient, i, i);
        const struct tensor_term *second = term_of(&terms->outer, i, i);
        const struct tensor_term *slope = term_of(&terms->outer, i, 3 + i);
        const struct tensor_term *pull = term_of(&terms->pull, i, i);
        good = lay_across(&fast->gradient[i], gradient, j, gradient->factor, inside, region) &&
               lay_across(&fast->second[i], second, j, second->factor, inside, region) &&
               lay_across(&fast->slope[i], slope, j, slope->factor, inside, inside) &&
               lay_across(&fast->pull[i], pull, j, pull->factor, region, inside) &&
               (j == DEPTH || second->matrix[DEPTH] == NULL || lay_over_b(fast, &fast->bare[i], second, 1));
    }
    const struct tensor_term *along = term_of(&terms->outer, j, f), *over = term_of(&terms->outer, j, b);
    const struct tensor_term *slopes = term_of(&terms->outer, j, 6 + f);
    const struct tensor_term *pull_b = term_of(&terms->pull, b, j), *pull_f = term_of(&terms->pull, f, j);
    good = good && lay_across(&fast->change[ROLE_F], along, j, along->factor, inside, region) &&
           lay_across(&fast->change[ROLE_B], over, j, over->factor, inside, region) &&
           lay_across(&fast->divergence, slopes, j, slopes->factor, inside, region) &&
           lay_over_b(fast, &fast->over_b, over, 1) &&
           lay_over_b(fast, &fast->pull_b, pull_b, pull_b->factor);
    fast->along_f = lay_along_f(fast, along, 1);
    fast->pull_f = lay_along_f(fast, pull_f, pull_f->factor);
    return good && fast->along_f != NULL && fast->pull_f != NULL;
}

/* B is the same in all terms of a component, and the two slopes of others are taken alike. */
static bool shares_passes(const struct fast_slab *fast, const struct slab_terms *terms)
{
    const int j = fast->axis[ROLE_S], b = fast->axis[ROLE_B], f = fast->axis[ROLE_F];
    const struct terms *outer = &terms->outer, *pull = &terms->pull;
    if (term_of(outer, j, 6 + f)->matrix[j] != term_of(outer, j, 6 + b)->matrix[j]) return false;
    if (term_of(outer, j, 6 + f)->factor != term_of(outer, j, 6 + b)->factor) return false;
    if (j == DEPTH) return true;
    for (int i = 0; i < 3; i++) {
        const struct band *bare = term_of(outer, i, i)->matrix[DEPTH];
        if (term_of(outer, i, 3 + i)->matrix[DEPTH] != bare || term_of(pull, i, i)->matrix[DEPTH] != bare)
            return false;
    }
    const struct band *bare = term_of(outer, j, j)->matrix[DEPTH];
    return term_of(outer, j, f)->matrix[DEPTH] == bare && term_of(outer, j, 6 + f)->matrix[DEPTH] == bare &&
           term_of(pull, f, j)->matrix[DEPTH] == bare;
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
    fast->ns = slab->inside.n[j];
    fast->nb = c->n[fast->axis[ROLE_B]];
    fast->nf = c->n[fast->axis[ROLE_F]];
    fast->width = rounded(fast->nf, FAST_LANES);
    fast->region = slab->region.n[j];
    fast->offset = slab->inside.at[j] - slab->region.at[j];
    fast->first = slab->region.at[j] * fast->step[ROLE_S];
}

static bool lay_slab(struct consistent *c, struct fast_slab *fast, const struct slab_terms *terms)
{
    const struct band *along =
        term_of(&terms->outer, fast->axis[ROLE_S], fast->axis[ROLE_F])->matrix[fast->axis[ROLE_F]];
    const struct band *pull =
        term_of(&terms->pull, fast->axis[ROLE_F], fast->axis[ROLE_S])->matrix[fast->axis[ROLE_F]];
    const size_t n = fast->nb * fast->ns * fast->width;
    c->pml->slab[fast->slab - c->pml->slab].inner = n;
    fast->taps_f = 2 * (along->half > pull->half ? along->half : pull->half) + 1;
    fast->change_b = array_new(n, sizeof *fast->change_b);
    fast->middle = array_new(n, sizeof *fast->middle);
    bool good = fast->change_b != NULL && fast->middle != NULL;
    for (int i = 0; i < 3; i++) {
        fast->wait[i] = array_new(n, sizeof *fast->wait[i]);
        good = good && fast->wait[i] != NULL;
    }
    c->pml->fast->bytes += 5 * n * sizeof *fast->middle;
    return good && lay_tables(fast, terms);
}

/* Room for a thread: rows of the region of three components and of the slab, groups of rows. */
static bool lay_buffers(struct consistent *c)
{
    struct pml_fast *f = c->pml->fast;
    for (size_t s = 0; s < c->pml->slabs; s++) {
        const struct fast_slab *fast = &f->slab[s];
        const size_t rows = (fast->region + 1) * (fast->width + FAST_PAD);
        f->rows = rows > f->rows ? rows : f->rows;
    }
    const size_t size = FAST_BLOCKS * f->rows;
    f->buffer = array_new((size_t)c->threads, sizeof *f->buffer);
    if (f->buffer == NULL) return false;
    for (int t = 0; t < c->threads; t++) {
        f->buffer[t] = array_new(size, sizeof **f->buffer);
        if (f->buffer[t] == NULL) return false;
    }
    f->bytes += (size_t)c->threads * size * sizeof **f->buffer;
    return true;
}

/* Terms of the slabs; false if one of them cannot share its passes. */
static bool take_terms(struct consistent *c, struct slab_terms *terms, bool *good)
{
    for (size_t s = 0; *good && s < c->pml->slabs; s++) {
        struct slab *slab = &c->pml->slab[s];
        if (!far_end_out(c, slab)) return false;
        c->pml->fast->slab[s].slab = slab;
        lay_sizes(c, &c->pml->fast->slab[s]);
        terms[s] = (struct slab_terms){terms_gradient(c, slab), terms_outer(c, slab), terms_pull(c, slab)};
        *good = terms[s].gradient.good && terms[s].outer.good && terms[s].pull.good;
        if (*good && !shares_passes(&c->pml->fast->slab[s], &terms[s])) return false;
    }
    return true;
}

bool pml_fast_create(struct consistent *c)
{
    if (c->fused == NULL) return true;
    struct slab_terms *terms = array_new(BOX_FACES, sizeof *terms);
    bool good = terms != NULL;
    c->pml->fast = array_new(1, sizeof *c->pml->fast);
    good = good && c->pml->fast != NULL;
    const bool fits = good && take_terms(c, terms, &good);
    for (size_t s = 0; fits && good && s < c->pml->slabs; s++)
        good = lay_slab(c, &c->pml->fast->slab[s], &terms[s]);
    good = good && (!fits || lay_buffers(c));
    if (good && !fits) pml_fast_free(c);
    array_free(terms);
    return good;
}

void pml_fast_free(struct consistent *c)
{
    struct pml_fast *f = c->pml->fast;
    if (f == NULL) return;
    for (size_t s = 0; s < c->pml->slabs; s++) {
        struct fast_slab *fast = &f->slab[s];
        for (int i = 0; i < 3; i++) {
            free_table(&fast->gradient[i]);
            free_table(&fast->second[i]);
            free_table(&fast->slope[i]);
            free_table(&fast->change[i]);
            free_table(&fast->pull[i]);
            free_table(&fast->bare[i]);
            array_free(fast->wait[i]);
        }
        free_table(&fast->divergence);
        free_table(&fast->over_b);
        free_table(&fast->pull_b);
        array_free(fast->along_f);
        array_free(fast->pull_f);
        array_free(fast->change_b);
        array_free(fast->middle);
    }
    for (int t = 0; f->buffer != NULL && t < c->threads; t++)
        array_free(f->buffer[t]);
    array_free(f->buffer);
    array_free(f);
    c->pml->fast = NULL;
}
