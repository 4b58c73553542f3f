/* Tables of the shared passes of absorbing layers (pml_fast.h): the matrices are those of the terms
 * (pml_terms.c), with their factors. */
#include "method/consistent/absorbing/pml_fast_tables.h"

#include "base/memory.h"

void *pml_numbers(size_t n, bool single)
{
    return array_new(n, single ? sizeof(float) : sizeof(double));
}

static void put(void *table, size_t place, double value, bool single)
{
    if (single)
        ((float *)table)[place] = (float)value;
    else
        ((double *)table)[place] = value;
}

/* Term number `which` from an input to a component; NULL: there is none. */
static const struct tensor_term *term_number(const struct terms *terms, int out, int in, size_t which)
{
    for (size_t i = 0; i < terms->count; i++)
        if (terms->term[i].out == out && terms->term[i].in == in && which-- == 0) return &terms->term[i];
    return NULL;
}

static const struct tensor_term *term_of(const struct terms *terms, int out, int in)
{
    return term_number(terms, out, in, 0);
}

/* Those that make T_jj of u_k: one, or one of lambda and one of mu. */
static size_t count_crosses(const struct terms *outer, int j, int k)
{
    return term_number(outer, j, k, 1) == NULL ? 1 : 2;
}

/* Weights of one group of rows, from the columns that are not 0 alone. */
static bool lay_group(struct row_group *group, const struct band *band, double factor, size_t row,
                      size_t column, size_t columns, bool single)
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
    group->weight = pml_numbers(group->inputs * group->rows, single);
    for (size_t t = 0; group->weight != NULL && t < group->inputs; t++)
        for (size_t r = 0; r < group->rows; r++)
            put(group->weight, t * group->rows + r,
                factor * band_get(band, row + group->to + r, column + group->from + t), single);
    return group->weight != NULL;
}

/* Floats: the rows from now on take differences, so that their rounding does not act on an even displacement like a
 * load. */
static void take_changes(struct row_table *table, const struct band *band, double factor, size_t row,
                         size_t column)
{
    for (size_t g = 0; g < table->groups; g++) {
        struct row_group *group = &table->group[g];
        for (size_t r = 0; group->inputs > 0 && r < group->rows; r++) {
            double sum = 0;
            for (size_t t = 0; t < group->inputs; t++)
                sum += factor * band_get(band, row + group->to + r, column + group->from + t);
            put(group->weight, group->inputs / 2 * group->rows + r, sum, true);
        }
        group->changes = group->inputs > 0;
    }
}

/* Rows or columns of a matrix. */
struct span {
    size_t from, n;
};

/* factor * the part of a matrix with these rows and columns, in groups of about the same size. */
static bool lay_table(struct row_table *table, const struct band *band, double factor, struct span to,
                      struct span from, size_t most, bool single)
{
    const size_t rows = to.n;
    const size_t groups = (rows + most - 1) / most;
    table->group = array_new(groups, sizeof *table->group);
    if (table->group == NULL) return false;
    table->groups = groups;
    for (size_t g = 0; g < groups; g++) {
        struct row_group *group = &table->group[g];
        group->to = rows * g / groups;
        group->rows = rows * (g + 1) / groups - group->to;
        if (!lay_group(group, band, factor, to.from, from.from, from.n, single)) return false;
    }
    return true;
}

static void free_table(struct row_table *table)
{
    for (size_t g = 0; g < table->groups; g++)
        array_free(table->group[g].weight);
    array_free(table->group);
}

/* Groups of rows of the body that the window has whole, numbered from its first row. */
static void keep_window(struct row_table *table, struct span window)
{
    size_t kept = 0;
    for (size_t g = 0; g < table->groups; g++) {
        struct row_group *group = &table->group[g];
        if (group->to < window.from || group->to + group->rows > window.from + window.n) {
            array_free(group->weight);
            continue;
        }
        group->to -= window.from;
        table->group[kept++] = *group;
    }
    table->groups = kept;
}

/* Matrix of the rows b. */
static bool lay_over_b(const struct fast_slab *fast, struct row_table *table, const struct tensor_term *term,
                       double factor, bool single)
{
    const struct band *band = term->matrix[fast->axis[ROLE_B]];
    const struct span all = {0, band->n}, window = {fast->first_b, fast->nb};
    if (!lay_table(table, band, factor, all, window, FAST_GROUP, single)) return false;
    keep_window(table, window);
    return true;
}

/* By diagonals: [taps_f * width]. */
static void *lay_along_f(const struct fast_slab *fast, const struct tensor_term *term, double factor,
                         bool single)
{
    const struct band *band = term->matrix[fast->axis[ROLE_F]];
    void *table = pml_numbers(fast->taps_f * fast->width, single);
    for (size_t i = 0; table != NULL && i < fast->nf; i++)
        for (size_t t = 0; t < fast->taps_f; t++)
            if (i + t >= fast->taps_f / 2 && i + t - fast->taps_f / 2 < fast->nf)
                put(table, t * fast->width + i,
                    factor * band_get(band, fast->first_f + i, fast->first_f + i + t - fast->taps_f / 2),
                    single);
    return table;
}

/* Matrix across the face, with the term's factor. */
static bool lay_across(const struct fast_slab *fast, struct row_table *table, const struct tensor_term *term,
                       struct span to, struct span from, bool single)
{
    return lay_table(table, term->matrix[fast->axis[ROLE_S]], term->factor, to, from, FAST_ROWS, single);
}

/* Half of the widest matrix along f. */
static size_t reach_along_f(const struct fast_slab *fast, const struct slab_terms *terms)
{
    const int f = fast->axis[ROLE_F], j = fast->axis[ROLE_S];
    size_t most = 0;
    for (size_t n = 0; n < fast->crosses; n++) {
        const struct tensor_term *one = term_number(&terms->outer, j, f, n),
                                 *other = term_number(&terms->pull, f, j, n);
        if (one->matrix[f]->half > most) most = one->matrix[f]->half;
        if (other != NULL && other->matrix[f]->half > most) most = other->matrix[f]->half;
    }
    return most;
}

/* Is C2_j of the slopes of u_k in T_jj that C_j of u_k in L1? In layers over depth of layered ground it has moduli in
 * it. */
static bool takes_gradient(const struct fast_slab *fast, const struct slab_terms *terms, int k)
{
    const int j = fast->axis[ROLE_S];
    if (j == DEPTH && fast->crosses > 1) return false;
    return term_of(&terms->gradient, k, k)->matrix[j] == term_of(&terms->outer, j, k)->matrix[j];
}

/* Slopes along f. Both of lambda and mu wait apart where they have a B each; then both have one C2_j. */
static bool lay_crosses(struct fast_slab *fast, const struct slab_terms *terms, struct span to,
                        struct span from, bool single)
{
    const int j = fast->axis[ROLE_S], f = fast->axis[ROLE_F];
    const bool known = takes_gradient(fast, terms, f);
    bool good = true;
    for (size_t n = 0; good && n < fast->crosses; n++) {
        struct cross *cross = &fast->cross[n];
        const struct tensor_term *term = term_number(&terms->outer, j, f, n);
        const struct tensor_term *pull = term_number(&terms->pull, f, j, n);
        const bool apart = fast->parts > 3, shared = known || (apart && n > 0);
        const double of_change = known ? 1 : term_number(&terms->outer, j, f, shared ? 0 : n)->factor;
        cross->part = !apart ? j : n == 0 ? PART_LAMBDA : PART_MU;
        good = shared || lay_across(fast, &cross->change, term, to, from, single);
        if (good && apart) good = lay_over_b(fast, &fast->bare[cross->part], term, 1, single);
        cross->along = lay_along_f(fast, term, term->factor / of_change, single);
        if (pull != NULL) cross->pull = lay_along_f(fast, pull, pull->factor, single);
        good = good && cross->along != NULL && (pull == NULL || cross->pull != NULL);
    }
    return good;
}

/* Slopes along b. */
static bool lay_overs(struct fast_slab *fast, const struct slab_terms *terms, struct span to,
                      struct span from, bool single)
{
    const int j = fast->axis[ROLE_S], b = fast->axis[ROLE_B];
    const struct tensor_term *pull = term_of(&terms->pull, b, j), *slope = term_of(&terms->outer, j, 6 + b);
    const bool known = takes_gradient(fast, terms, b);
    bool good = lay_over_b(fast, &fast->pull_b, pull, pull->factor, single);
    for (size_t n = 0; good && n < fast->overs; n++) {
        const struct tensor_term *term = term_number(&terms->outer, j, b, n);
        good = (known || lay_across(fast, &fast->over[n].change, term, to, from, single)) &&
               lay_over_b(fast, &fast->over[n].over_b, term, known ? term->factor : 1, single);
    }
    if (fast->parts == 3) return good;
    fast->beyond = array_new(fast->nb, sizeof *fast->beyond);
    for (size_t k = 0; fast->beyond != NULL && k < fast->nb; k++)
        fast->beyond[k] = band_get(slope->matrix[b], fast->first_b + k, fast->first_b + k);
    return good && fast->beyond != NULL;
}

bool pml_lay_tables(struct fast_slab *fast, const struct slab_terms *terms, bool single)
{
    const int j = fast->axis[ROLE_S], f = fast->axis[ROLE_F];
    const size_t skipped = fast->start - fast->slab->region.at[j];
    const struct span region = {skipped, fast->region}, inside = {skipped + fast->offset, fast->ns};
    const struct terms *outer = &terms->outer;
    bool good = true;
    fast->taps_f = 2 * reach_along_f(fast, terms) + 1;
    fast->parts = fast->crosses > 1 && j != DEPTH ? FAST_PARTS : 3;
    fast->own = fast->parts > 3 ? PART_LAMBDA : j;
    for (int i = 0; good && i < 3; i++) {
        const struct tensor_term *second = term_of(outer, i, i);
        good =
            lay_across(fast, &fast->gradient[i], term_of(&terms->gradient, i, i), inside, region, single) &&
            lay_across(fast, &fast->second[i], second, inside, region, single) &&
            lay_across(fast, &fast->slope[i], term_of(outer, i, 3 + i), inside, inside, single) &&
            lay_across(fast, &fast->pull[i], term_of(&terms->pull, i, i), region, inside, single) &&
            (j == DEPTH || second->matrix[DEPTH] == NULL || (i == j && fast->own != j) ||
             lay_over_b(fast, &fast->bare[i], second, 1, single));
        if (good && single)
            take_changes(&fast->second[i], second->matrix[j], second->factor, inside.from, region.from);
    }
    return good && lay_crosses(fast, terms, inside, region, single) &&
           lay_overs(fast, terms, inside, region, single) &&
           lay_across(fast, &fast->divergence, term_of(outer, j, 6 + f), inside, region, single);
}

bool pml_waits(const struct fast_slab *fast, int part)
{
    return part == fast->own || fast->bare[part].groups > 0;
}

/* In slabs along depth: is B the same in all terms of a component, and of lambda and of mu? */
static bool shares_bare(const struct fast_slab *fast, const struct slab_terms *terms)
{
    const int j = fast->axis[ROLE_S], f = fast->axis[ROLE_F];
    const struct terms *outer = &terms->outer, *pull = &terms->pull;
    for (int i = 0; i < 3; i++) {
        const struct band *bare = term_of(outer, i, i)->matrix[DEPTH];
        if (term_of(outer, i, 3 + i)->matrix[DEPTH] != bare || term_of(pull, i, i)->matrix[DEPTH] != bare)
            return false;
    }
    for (size_t n = 0; n < fast->crosses; n++) {
        const struct band *bare =
            (fast->crosses > 1 ? term_number(outer, j, f, n) : term_of(outer, j, j))->matrix[DEPTH];
        if (term_number(outer, j, f, n)->matrix[DEPTH] != bare ||
            term_number(outer, j, 6 + f, n)->matrix[DEPTH] != bare ||
            term_number(pull, f, j, n)->matrix[DEPTH] != bare)
            return false;
    }
    return true;
}

bool pml_shares_passes(const struct fast_slab *fast, const struct slab_terms *terms)
{
    const int j = fast->axis[ROLE_S], b = fast->axis[ROLE_B], f = fast->axis[ROLE_F];
    const struct terms *outer = &terms->outer;
    for (size_t n = 0; n < (j == DEPTH ? 1 : fast->crosses); n++) {
        if (term_number(outer, j, 6 + f, n)->matrix[j] != term_of(outer, j, 6 + b)->matrix[j]) return false;
        if (term_number(outer, j, 6 + f, n)->factor != term_of(outer, j, 6 + b)->factor) return false;
        if (term_number(outer, j, f, n)->matrix[j] != term_of(outer, j, f)->matrix[j]) return false;
    }
    return j == DEPTH || shares_bare(fast, terms);
}

void pml_count_crosses(struct fast_slab *fast, const struct slab_terms *terms)
{
    const int j = fast->axis[ROLE_S];
    fast->crosses = count_crosses(&terms->outer, j, fast->axis[ROLE_F]);
    fast->overs = count_crosses(&terms->outer, j, fast->axis[ROLE_B]);
}

static void free_cross(struct cross *cross, struct over *over)
{
    free_table(&cross->change);
    array_free(cross->along);
    array_free(cross->pull);
    free_table(&over->change);
    free_table(&over->over_b);
}

void pml_free_tables(struct fast_slab *fast)
{
    for (int i = 0; i < 3; i++) {
        free_table(&fast->gradient[i]);
        free_table(&fast->second[i]);
        free_table(&fast->slope[i]);
        free_table(&fast->pull[i]);
    }
    for (int part = 0; part < FAST_PARTS; part++)
        free_table(&fast->bare[part]);
    for (int n = 0; n < FAST_CROSSES; n++)
        free_cross(&fast->cross[n], &fast->over[n]);
    free_table(&fast->divergence);
    free_table(&fast->pull_b);
    array_free(fast->beyond);
}
