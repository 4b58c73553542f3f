/* The step of the absorbing layers (doc/theory/absorbing-faces.md, section 4): f' = -(alpha + d) f - d g by the
 * trapezoidal rule,
 *
 *   (f(n+1) - f(n)) / dt = -(alpha + d) m - d g(n+1/2),   m = (f(n) + f(n+1)) / 2,                       (11)
 *   g(n+1/2) from u(n+1/2) = u(n+1) - dt/2 v(n+1/2).
 *
 * Slabs meet at edges and corners: first all psi are moved on, then all phi, with psi at the middle of the
 * step. Regions are worked on plane by plane; sums do not depend on the number of threads. */
#include "method/consistent/absorbing/pml_fast.h"

#include <math.h>
#include <omp.h>
#include <string.h>

static struct block whole_of(const struct consistent *c)
{
    return (struct block){.n = {c->n[0], c->n[1], c->n[2]}};
}

/* What a block has of the rank's own planes, and where that begins in the arrays of the block. */
static struct block own_of(const struct consistent *c, const struct block *block, size_t *place)
{
    const struct part_axis *depth = &c->part.along[DEPTH];
    struct block own = *block;
    const size_t from = block->at[DEPTH], end = from + block->n[DEPTH];
    own.at[DEPTH] = from > depth->own ? from : depth->own;
    own.n[DEPTH] = (end < depth->end ? end : depth->end) - own.at[DEPTH];
    *place = (own.at[DEPTH] - from) * block->n[0] * block->n[1];
    return own;
}

/* to += factor * from where both blocks are. */
static void block_add(int threads, double *to, const struct block *t, double factor, const double *from,
                      const struct block *f)
{
    size_t at[3], end[3];
    for (int s = 0; s < 3; s++) {
        at[s] = t->at[s] > f->at[s] ? t->at[s] : f->at[s];
        end[s] = t->at[s] + t->n[s] < f->at[s] + f->n[s] ? t->at[s] + t->n[s] : f->at[s] + f->n[s];
        if (at[s] >= end[s]) return;
    }
#pragma omp parallel for num_threads(threads) schedule(static)
    for (size_t k = at[2]; k < end[2]; k++)
        for (size_t j = at[1]; j < end[1]; j++) {
            double *row = to + ((k - t->at[2]) * t->n[1] + j - t->at[1]) * t->n[0] + at[0] - t->at[0];
            const double *in = from + ((k - f->at[2]) * f->n[1] + j - f->at[1]) * f->n[0] + at[0] - f->at[0];
            for (size_t i = 0; i < end[0] - at[0]; i++)
                row[i] += factor * in[i];
        }
}

/* Region := the field's part there. */
static void take_in(const struct consistent *c, const struct slab *slab, double *region, const double *field,
                    const struct block *block)
{
    memset(region, 0, slab->volume * sizeof *region);
    block_add(c->threads, region, &slab->region, 1, field, block);
}

/* Displacements in the region in the middle of the step. */
static void take_displacements(const struct consistent *c, const struct slab *slab, const double *u,
                               const double *v, double to_middle)
{
    const struct block *region = &slab->region;
    const size_t rows = region->n[1] * region->n[2], dimension = (size_t)c->dimension;
#pragma omp parallel for num_threads(c->threads) schedule(static)
    for (size_t row = 0; row < rows; row++)
        for (size_t component = 0; component < dimension; component++) {
            const size_t from = component * c->volume + (row / region->n[1] + region->at[2]) * c->plane +
                                (row % region->n[1] + region->at[1]) * c->n[0] + region->at[0];
            double *in = c->pml->in + component * slab->volume + row * region->n[0];
            for (size_t i = 0; i < region->n[0]; i++)
                in[i] = u[from + i] + to_middle * v[from + i];
        }
}

/* Result of a plan on the region's fields in pml->in, component after component in pml->out, at least in the
 * block given (inside or region). */
static void work_out(const struct consistent *c, const struct slab *slab, const struct tensor_plan *plan,
                     const struct block *wanted)
{
    const size_t plane = slab->region.n[0] * slab->region.n[1];
    const size_t first = wanted->at[2] - slab->region.at[2], row = wanted->at[1] - slab->region.at[1];
#pragma omp parallel for num_threads(c->threads) schedule(static)
    for (size_t k = first; k < first + wanted->n[2]; k += TENSOR_PLANES) {
        const size_t left = first + wanted->n[2] - k, planes = left < TENSOR_PLANES ? left : TENSOR_PLANES;
        double *out[3] = {NULL, NULL, NULL};
        for (int i = 0; i < c->dimension; i++) {
            out[i] = c->pml->out + (size_t)i * slab->volume + k * plane;
            memset(out[i], 0, planes * plane * sizeof **out);
        }
        tensor_planes(plan, omp_get_thread_num(), k, planes, row, row + wanted->n[1], 1, c->pml->in, out);
    }
}

/* Moves a memory variable on in some planes of the slab, g in the region; middle (may be NULL) gets the mean of both
 * ends of the step. */
static void move_on(const struct consistent *c, const struct slab *slab, const struct block *in, double dt,
                    const double *g, double *memory, double *middle)
{
    const struct block *region = &slab->region;
    const size_t first = in->at[2] - slab->inside.at[2];
    const int slot = c->slot[slab->axis];
#pragma omp parallel for num_threads(c->threads) schedule(static)
    for (size_t k = 0; k < in->n[2]; k++)
        for (size_t j = 0; j < in->n[1]; j++) {
            const size_t from =
                ((k + in->at[2] - region->at[2]) * region->n[1] + j + in->at[1] - region->at[1]) *
                    region->n[0] +
                in->at[0] - region->at[0];
            const size_t to = (k * in->n[1] + j) * in->n[0];
            for (size_t i = 0; i < in->n[0]; i++) {
                const double q = slab->damping[slot == 0 ? i : slot == 1 ? j : first + k] * dt / 2;
                const double mean = (memory[to + i] - q * g[from + i]) / (1 + q + slab->relaxation * dt / 2);
                memory[to + i] = 2 * mean - memory[to + i];
                if (middle != NULL) middle[to + i] = mean;
            }
        }
}

static void move_gradients(const struct consistent *c, const struct slab *slab, double dt, double to_middle,
                           const double *u, const double *v, double *extra)
{
    take_displacements(c, slab, u, v, to_middle);
    work_out(c, slab, slab->gradient, &slab->inside);
    for (size_t i = 0; i < (size_t)c->dimension; i++)
        move_on(c, slab, &slab->inside, dt, c->pml->out + i * slab->volume,
                extra + slab->psi + i * slab->inner, slab->middle + i * slab->inner);
}

/* Sum of psi_kk of all slabs across axis k, in the region. */
static void take_divergence(const struct consistent *c, const struct slab *slab, int axis, double *region)
{
    memset(region, 0, slab->volume * sizeof *region);
    for (size_t s = 0; s < c->pml->slabs; s++) {
        const struct slab *other = &c->pml->slab[s];
        if (other->axis == axis)
            block_add(c->threads, region, &slab->region, 1, other->middle + (size_t)axis * other->inner,
                      &other->inside);
    }
}

static void move_forces(const struct consistent *c, const struct slab *slab, double dt, double to_middle,
                        const double *u, const double *v, double *extra)
{
    const size_t dimension = (size_t)c->dimension;
    size_t place;
    const struct block own = own_of(c, &slab->inside, &place);
    take_displacements(c, slab, u, v, to_middle);
    for (size_t i = 0; i < dimension; i++)
        take_in(c, slab, c->pml->in + (dimension + i) * slab->volume, slab->middle + i * slab->inner,
                &slab->inside);
    for (size_t k = 0; k < dimension; k++)
        if ((int)k != slab->axis)
            take_divergence(c, slab, (int)k, c->pml->in + (2 * dimension + k) * slab->volume);
    work_out(c, slab, slab->outer, &own);
    for (size_t i = 0; i < dimension; i++)
        move_on(c, slab, &own, dt, c->pml->out + i * slab->volume,
                extra + slab->phi + i * slab->inner + place, NULL);
}

void pml_keep(const struct consistent *c, double dt)
{
    for (size_t s = 0; s < c->pml->slabs; s++) {
        const struct slab *slab = &c->pml->slab[s];
        for (size_t i = 0; slab->drag != NULL && i < slab->inside.n[c->slot[slab->axis]]; i++)
            slab->kept[i] = exp(-slab->drag[i] * dt);
    }
}

/* v := exp(-rate dt) v in the slab (Eq 11). */
static void drag(const struct consistent *c, const struct slab *slab, double *v)
{
    const struct block *in = &slab->inside;
    const int slot = c->slot[slab->axis];
#pragma omp parallel for num_threads(c->threads) schedule(static)
    for (size_t k = 0; k < in->n[2]; k++)
        for (size_t component = 0; component < (size_t)c->dimension; component++)
            for (size_t j = 0; j < in->n[1]; j++) {
                double *row = v + component * c->volume + (k + in->at[2]) * c->plane +
                              (j + in->at[1]) * c->n[0] + in->at[0];
                for (size_t i = 0; i < in->n[0]; i++)
                    row[i] *= slab->kept[slot == 0 ? i : slot == 1 ? j : k];
            }
}

void pml_remember(struct consistent *c, double dt, double to_middle, const double *u, const double *v,
                  double *extra)
{
    if (c->pml->fast != NULL) {
        pml_fast_remember_double(c, dt, to_middle, pml_fast_quiet_double(c, u), u, v, extra);
        return;
    }
    for (size_t s = 0; s < c->pml->slabs; s++)
        move_gradients(c, &c->pml->slab[s], dt, to_middle, u, v, extra);
    for (size_t s = 0; s < c->pml->slabs; s++)
        move_forces(c, &c->pml->slab[s], dt, to_middle, u, v, extra);
}

void pml_damp(const struct consistent *c, double dt, double *v)
{
    pml_keep(c, dt);
    for (size_t s = 0; s < c->pml->slabs; s++)
        if (c->pml->slab[s].drag != NULL) drag(c, &c->pml->slab[s], v);
}

void pml_accelerate(const struct consistent *c, double factor, const double *extra, double *a)
{
    const struct block whole = whole_of(c);
    if (c->pml->fast != NULL) {
        pml_fast_accelerate_double(c, factor, extra, a);
        return;
    }
    for (size_t s = 0; s < c->pml->slabs; s++) {
        const struct slab *slab = &c->pml->slab[s];
        size_t in_region, in_slab;
        const struct block pulled = own_of(c, &slab->region, &in_region),
                           inside = own_of(c, &slab->inside, &in_slab);
        for (size_t i = 0; i < (size_t)c->dimension; i++)
            take_in(c, slab, c->pml->in + i * slab->volume, extra + slab->psi + i * slab->inner,
                    &slab->inside);
        work_out(c, slab, slab->pull, &pulled);
        for (size_t i = 0; i < (size_t)c->dimension; i++) {
            block_add(c->threads, a + i * c->volume, &whole, factor,
                      c->pml->out + i * slab->volume + in_region, &pulled);
            block_add(c->threads, a + i * c->volume, &whole, factor,
                      extra + slab->phi + i * slab->inner + in_slab, &inside);
        }
    }
}
