/* The order of the layers' shared passes (pml_fast.h, L1 to L4) for numbers of type REAL; included by
 * pml_fast_double.c and pml_fast_single.c. Threads share rows or groups of rows along b; none writes what
 * another one reads. */
#include "method/consistent/absorbing/pml_kernels.h"
#include "method/spline/passes.h"

#include <math.h>
#include <omp.h>
#include <string.h>

/* Numbers that rows are whole numbers of. */
enum { ROW_LANES = FAST_LANES * sizeof(double) / sizeof(REAL) };

static const struct NAME(pml_kernels) * kernels(void)
{
    return NAME(taken_pml_kernels)();
}

static void apply_group(const struct row_group *group, const REAL *in, size_t in_step, size_t width, bool add,
                        REAL *out, size_t out_step, const struct ahead *ahead)
{
    const struct NAME(pml_kernels) *k = kernels();
    (add              ? k->add
     : group->changes ? k->change
                      : k->set)[group->rows]((const REAL *)group->weight, group->inputs,
                                             in + group->from * in_step, in_step, width, out, out_step,
                                             ahead);
}

/* ahead: NULL, or what is ahead of all rows. */
static void apply(const struct row_table *table, const REAL *in, size_t step, bool add, REAL *out,
                  const struct ahead *ahead)
{
    for (size_t g = 0; g < table->groups; g++) {
        const struct row_group *group = &table->group[g];
        struct ahead part = {0};
        if (ahead != NULL)
            part = (struct ahead){(const REAL *)ahead->place + group->to * ahead->step_row, ahead->step_row,
                                  ahead->step};
        apply_group(group, in, step, step, add, out + group->to * step, step, ahead == NULL ? NULL : &part);
    }
}

#include "method/consistent/absorbing/pml_fast_meet.h"
#include "method/consistent/absorbing/pml_fast_rest.h"

/* out += matrix along f of the rows of the slab, by way of `padded`, whose rows have zeros between them. */
static void apply_along(const struct fast_slab *s, const void *matrix, const REAL *in, REAL *padded,
                        REAL *out)
{
    const size_t step = s->width + FAST_PAD;
    for (size_t r = 0; r < s->ns; r++) {
        memcpy(padded + r * step + FAST_PAD, in + r * s->width, s->width * sizeof *in);
        memset(padded + r * step, 0, FAST_PAD * sizeof *in);
    }
    memset(padded + s->ns * step, 0, FAST_PAD * sizeof *in);
    for (size_t r = 0; r < s->ns; r += FAST_ROWS) {
        const size_t rows = s->ns - r < FAST_ROWS ? s->ns - r : FAST_ROWS;
        kernels()->along[rows]((const REAL *)matrix, s->taps_f, padded + r * step + FAST_PAD, step, s->width,
                               out + r * s->width);
    }
}

/* Moves a memory variable on in row b of a slab. */
static void move_rows(const struct fast_slab *s, double dt, const REAL *g, REAL *memory, REAL *middle)
{
    for (size_t r = 0; r < s->ns; r++) {
        const double q = s->damping[r] * dt / 2, kept = 1 / (1 + q + s->slab->relaxation * dt / 2);
        const size_t at = r * s->width;
        kernels()->move(s->width, (REAL)q, (REAL)kept, g + at, memory + at,
                        middle == NULL ? NULL : middle + at);
    }
}

static void twice(size_t n, const REAL *restrict in, REAL *restrict out)
{
    for (size_t i = 0; i < n; i++)
        out[i] = 2 * in[i];
}

/* C1_f (C2_j u_f) in row b, from C_j u_f where that serves. */
static void cross_rows(const struct fast_slab *s, size_t b, const REAL *region, REAL *slope, REAL *padded)
{
    for (size_t n = 0; n < s->crosses; n++) {
        const struct cross *cross = &s->cross[n];
        if (cross->change.groups > 0) apply(&cross->change, region, s->width, false, slope, NULL);
        apply_along(s, cross->along, slope, padded, (REAL *)s->wait[cross->part] + b * s->ns * s->width);
    }
}

/* The components in turn, that along the slab's axis first: the others add to it. */
static int component_of(int axis, int turn)
{
    return turn == 0 ? axis : turn <= axis ? turn - 1 : turn;
}

/* L1 and L2 in row b. */
static void gradient_row(const struct consistent *c, const struct fast_slab *s, double dt, double to_middle,
                         size_t b, const REAL *u, const REAL *v, REAL *extra)
{
    const size_t size = s->ns * s->width, inner = s->nb * size;
    const size_t across = s->step[ROLE_S], along = s->step[ROLE_F];
    const int j = s->axis[ROLE_S];
    REAL *region = (REAL *)FAST(c)->buffer[omp_get_thread_num()];
    REAL *g = region + s->region * s->width, *m = g + size, *padded = m + size;
    s->idle[b] = false;
    for (int k = 0; k < 3; k++) {
        const int i = component_of(j, k);
        const size_t from = (size_t)i * c->volume + s->first + b * s->step[ROLE_B];
        const size_t next = (size_t)component_of(j, (k + 1) % 3) * c->volume + s->first +
                            (k == 2 ? b + 1 : b) * s->step[ROLE_B];
        REAL *psi = extra + s->slab->psi + (size_t)i * inner + b * size;
        const int part = i == j ? s->own : i;
        REAL *middle = i == j ? (REAL *)s->middle + b * size : m;
        REAL *force = s->wait[part] == NULL ? g : (REAL *)s->wait[part] + b * size;
        const bool over = i == s->axis[ROLE_B];
        REAL *slope = over && s->over[0].change.groups == 0 ? (REAL *)s->over[0].wait + b * size : g;
        kernels()->load(u + from, v + from, (REAL)to_middle, s->region, across, s->nf, along, s->width,
                        region);
        apply(&s->gradient[i], region, s->width, false, slope, &(struct ahead){psi, s->width, 1});
        move_rows(s, dt, slope, psi, middle);
        if (i == s->axis[ROLE_F]) cross_rows(s, b, region, slope, padded);
        for (size_t n = 0; over && n < s->overs; n++)
            apply(&s->over[n].change, region, s->width, false, (REAL *)s->over[n].wait + b * size, NULL);
        apply(&s->second[i], region, s->width, false, force, &(struct ahead){u + next, across, along});
        apply(&s->slope[i], middle, s->width, true, force, &(struct ahead){v + next, across, along});
        if (force == g) move_rows(s, dt, g, extra + s->slab->phi + (size_t)i * inner + b * size, NULL);
        if (part == PART_LAMBDA) twice(size, force, (REAL *)s->wait[PART_MU] + b * size);
    }
}

/* Product over b with all of the slab's rows, a group of the result; no table: the rows as they are. */
static const REAL *over_rows(const struct fast_slab *s, const struct row_table *table, size_t g,
                             const REAL *in, REAL *out)
{
    const size_t size = s->ns * s->width;
    if (table->groups == 0) return in + s->pull_b.group[g].to * size;
    apply_group(&table->group[g], in, size, size, false, out, size, NULL);
    return out;
}

/* Does anything move phi in row b, or phi itself? */
static bool row_moves(const struct consistent *c, const struct fast_slab *s, struct level level, size_t b,
                      const REAL *extra)
{
    REAL *rows = (REAL *)FAST(c)->buffer[omp_get_thread_num()];
    return !rows_rest(s, b, b + 1) || memory_loud(s, level.force, b, extra + s->slab->phi) ||
           add_divergence(c, s, ROLE_B, level.slope, b, rows, NULL);
}

/* T_j in a group of rows, without m_bb: the parts of lambda and mu, and slopes along b, besides T'_j. */
static void sum_forces(const struct fast_slab *s, size_t g, REAL *sum)
{
    const size_t size = s->ns * s->width;
    const struct row_group *group = &s->pull_b.group[g];
    const REAL *force = over_rows(s, &s->bare[s->own], g, (const REAL *)s->wait[s->own], sum);
    if (force != sum) memcpy(sum, force, group->rows * size * sizeof *sum);
    for (size_t part = PART_MU; part < s->parts; part++)
        apply_group(&s->bare[part].group[g], (const REAL *)s->wait[part], size, size, true, sum, size, NULL);
    for (size_t n = 0; n < s->overs; n++)
        apply_group(&s->over[n].over_b.group[g], (const REAL *)s->over[n].wait, size, size, true, sum, size,
                    NULL);
}

/* L3 in a group of rows. */
static void force_rows(const struct consistent *c, const struct fast_slab *s, double dt, size_t g,
                       REAL *extra)
{
    const size_t size = s->ns * s->width, inner = s->nb * size;
    const struct row_group *group = &s->pull_b.group[g];
    REAL *sum = (REAL *)FAST(c)->buffer[omp_get_thread_num()], *rows = sum + FAST_GROUP * size;
    const int j = s->axis[ROLE_S];
    for (int i = 0; i < 3; i++) {
        if (i == j)
            sum_forces(s, g, sum);
        else if (s->wait[i] != NULL)
            over_rows(s, &s->bare[i], g, (const REAL *)s->wait[i], sum);
        else
            continue;
        for (size_t r = 0; r < group->rows; r++) {
            const size_t b = group->to + r;
            if (i == j) add_divergence(c, s, ROLE_B, -1, b, rows, sum + r * size);
            move_rows(s, dt, sum + r * size, extra + s->slab->phi + (size_t)i * inner + b * size, NULL);
        }
    }
}

/* Adds C2_j m_ff to what waits. */
static void meet_rows(const struct consistent *c, const struct fast_slab *s, struct level level)
{
    const size_t size = s->ns * s->width;
#pragma omp parallel for num_threads(c->threads) schedule(static)
    for (size_t b = 0; b < s->nb; b++) {
        REAL *rows = (REAL *)FAST(c)->buffer[omp_get_thread_num()];
        const REAL least = s->rests[b] ? level.slope : -1;
        for (size_t n = 0; n < (s->parts > 3 ? s->crosses : 1); n++)
            if (add_divergence(c, s, ROLE_F, least, b, rows, (REAL *)s->wait[s->cross[n].part] + b * size))
                s->rests[b] = s->idle[b] = false;
    }
}

/* Own rows that move. */
static void find_moves(const struct consistent *c, const struct fast_slab *s, struct level level,
                       const REAL *extra)
{
#pragma omp parallel for num_threads(c->threads) schedule(static)
    for (size_t b = 0; b < s->nb; b++)
        s->moves[b] = owns_row(c, s, b) && row_moves(c, s, level, b, extra);
}

/* L3 in all groups that have one of them; the others forget phi. */
static void move_forces(const struct consistent *c, const struct fast_slab *s, double dt, REAL *extra)
{
    unsigned long skipped = 0;
#pragma omp parallel for num_threads(c->threads) schedule(static) reduction(+ : skipped)
    for (size_t g = 0; g < s->pull_b.groups; g++) {
        const struct row_group *group = &s->pull_b.group[g];
        if (!owns_group(c, s, g)) continue;
        if (!group_moves(s, g))
            skipped++;
        else
            force_rows(c, s, dt, g, extra);
        for (size_t b = group->to; b < group->to + group->rows; b++)
            if (!s->moves[b]) forget_memory(s, b, extra + s->slab->phi);
    }
    FAST(c)->groups += s->pull_b.groups;
    FAST(c)->skipped += skipped;
}

double NAME(pml_fast_quiet)(const struct consistent *c, const REAL *u)
{
    double largest = 0;
    if (!(c->options.quiet > 0)) return 0;
#pragma omp parallel for num_threads(c->threads) schedule(static) reduction(max : largest)
    for (size_t k = 0; k < c->n[DEPTH]; k++)
        for (size_t i = 0; i < 3; i++)
            largest =
                fmax(largest,
                     (double)taken_passes()->NAME(largest_size)(u + i * c->volume + k * c->plane, c->plane));
    return c->options.quiet * part_largest(c, largest);
}

void NAME(pml_fast_remember)(const struct consistent *c, double dt, double to_middle, double quiet,
                             const REAL *u, const REAL *v, REAL *extra)
{
    const struct level level = levels(c, quiet, to_middle);
    const struct fast_slab *const slab = FAST(c)->slab, *const end = slab + c->pml->slabs;
    for (const struct fast_slab *s = slab; s < end; s++)
        for (size_t b = 0; b < s->nb && shares_rows(c, s); b++)
            s->rests[b] = rests(c, s, level, b, u, v, extra);
    agree(c, false);
    for (const struct fast_slab *s = slab; s < end; s++) {
        const bool known = shares_rows(c, s);
#pragma omp parallel for num_threads(c->threads) schedule(static)
        for (size_t b = 0; b < s->nb; b++) {
            if (!known) s->rests[b] = rests(c, s, level, b, u, v, extra);
            if (s->rests[b])
                forget_row(s, b, extra);
            else
                gradient_row(c, s, dt, to_middle, b, u, v, extra);
        }
    }
    for (const struct fast_slab *s = slab; s < end; s++)
        meet_rows(c, s, level);
    agree(c, false);
    for (const struct fast_slab *s = slab; s < end; s++)
        find_moves(c, s, level, extra);
    agree(c, true);
    for (const struct fast_slab *s = slab; s < end; s++)
        move_forces(c, s, dt, extra);
}

/* C2_f of L4 in row r of a group: of psi_jj, each with its B. */
static void pull_along(const struct fast_slab *s, const REAL *const psi_b[FAST_PARTS], size_t r, REAL *padded,
                       REAL *out)
{
    for (size_t n = 0; n < s->crosses; n++)
        if (s->cross[n].pull != NULL)
            apply_along(s, s->cross[n].pull, psi_b[s->cross[n].part] + r * s->ns * s->width, padded, out);
}

/* B_(lambda + 2 mu) psi_jj from the parts of lambda and mu. */
static const REAL *add_moduli(size_t n, const REAL *const psi_b[FAST_PARTS], REAL *out)
{
    for (size_t i = 0; i < n; i++)
        out[i] = psi_b[PART_LAMBDA][i] + 2 * psi_b[PART_MU][i];
    return out;
}

/* L4 in a group of rows. */
static void pull_rows(const struct consistent *c, const struct fast_slab *s, double factor, size_t g,
                      const REAL *extra, REAL *a)
{
    const size_t size = s->ns * s->width, inner = s->nb * size;
    const struct row_group *group = &s->pull_b.group[g];
    const REAL *psi = extra + s->slab->psi, *phi = extra + s->slab->phi, *psi_b[FAST_PARTS];
    const int j = s->axis[ROLE_S];
    REAL *buffer = (REAL *)FAST(c)->buffer[omp_get_thread_num()];
    REAL *over = buffer + s->parts * FAST_GROUP * size, *out = over + FAST_GROUP * size;
    REAL *inside = out + s->offset * s->width, *padded = out + s->region * s->width;
    for (size_t i = 0; i < s->parts; i++)
        if (i != (size_t)j || s->own == j)
            psi_b[i] = over_rows(s, &s->bare[i], g, psi + (i < 3 ? i : (size_t)j) * inner,
                                 buffer + i * FAST_GROUP * size);
    if (s->own != j) psi_b[j] = add_moduli(group->rows * size, psi_b, buffer + (size_t)j * FAST_GROUP * size);
    over_rows(s, &s->pull_b, g, psi + (size_t)j * inner, over);
    for (size_t r = 0; r < group->rows; r++)
        for (int i = 0; i < 3; i++) {
            const size_t b = group->to + r;
            REAL *to = a + (size_t)i * c->volume + s->first + b * s->step[ROLE_B];
            apply(&s->pull[i], psi_b[i] + r * size, s->width, false, out,
                  &(struct ahead){to, s->step[ROLE_S], s->step[ROLE_F]});
            kernels()->sum(size, phi + (size_t)i * inner + b * size, inside);
            if (i == s->axis[ROLE_B]) kernels()->sum(size, over + r * size, inside);
            if (i == s->axis[ROLE_F]) pull_along(s, psi_b, r, padded, inside);
            kernels()->store(out, (REAL)factor, s->region, s->step[ROLE_S], s->nf, s->step[ROLE_F], s->width,
                             to);
        }
}

/* Does psi or phi pull an own row of a group? */
static bool group_pulls(const struct consistent *c, const struct fast_slab *s, size_t g)
{
    const size_t from = s->pull_b.group[g].to, end = from + s->pull_b.group[g].rows;
    return owns_group(c, s, g) && (group_moves(s, g) || !rows_rest(s, from, end));
}

/* The turn in which a group is due: rows across depth are in all planes of the layer. */
static bool group_due(const struct consistent *c, const struct fast_slab *s, size_t g, int turn)
{
    const size_t from = s->pull_b.group[g].to, end = from + s->pull_b.group[g].rows;
    return turn == (s->axis[ROLE_B] == DEPTH ? part_turn_of(&c->part, from, end) : PART_LAST);
}

void NAME(pml_fast_look)(const struct consistent *c, const REAL *extra)
{
    for (size_t i = 0; i < c->pml->slabs; i++) {
        const struct fast_slab *s = &FAST(c)->slab[i];
#pragma omp parallel for num_threads(c->threads) schedule(static)
        for (size_t b = 0; b < s->nb; b++) {
            s->rests[b] = c->options.quiet > 0 && !memory_loud(s, 0, b, extra + s->slab->psi);
            s->moves[b] = owns_row(c, s, b) && memory_loud(s, 0, b, extra + s->slab->phi);
        }
    }
}

void NAME(pml_fast_pull)(const struct consistent *c, int turn, double factor, const REAL *extra, REAL *a)
{
    for (size_t i = 0; i < c->pml->slabs; i++) {
        const struct fast_slab *s = &FAST(c)->slab[i];
#pragma omp parallel for num_threads(c->threads) schedule(static)
        for (size_t g = 0; g < s->pull_b.groups; g++)
            if (group_due(c, s, g, turn) && group_pulls(c, s, g)) pull_rows(c, s, factor, g, extra, a);
    }
}

void NAME(pml_fast_accelerate)(const struct consistent *c, double factor, const REAL *extra, REAL *a)
{
    NAME(pml_fast_look)(c, extra);
    for (int turn = 0; turn < PART_TURNS; turn++)
        NAME(pml_fast_pull)(c, turn, factor, extra, a);
}

void NAME(pml_fast_reached)(const struct consistent *c, struct window *reached)
{
    for (size_t i = 0; i < c->pml->slabs; i++) {
        const struct fast_slab *s = &FAST(c)->slab[i];
        const int across = s->axis[ROLE_S];
        struct window window = {.end = {c->n[0], c->n[1]}};
        if (across != DEPTH) window.from[across] = s->start;
        if (across != DEPTH) window.end[across] = s->start + s->region;
        for (size_t g = 0; g < s->pull_b.groups; g++) {
            if (!group_pulls(c, s, g)) continue;
            const size_t from = s->pull_b.group[g].to, end = from + s->pull_b.group[g].rows;
            if (across == DEPTH) window.from[1] = from;
            if (across == DEPTH) window.end[1] = end;
            const size_t first = across == DEPTH ? s->start : from;
            const size_t last = across == DEPTH ? s->start + s->region : end;
            for (size_t k = first; k < last; k++)
                reached[k] = window_join(&reached[k], &window);
        }
    }
}
