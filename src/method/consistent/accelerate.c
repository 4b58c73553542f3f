/* The H-form (hform.c makes it): acceleration, M v and energies. */
#include "method/consistent/absorbing/pml.h"
#include "method/consistent/absorbing/pml_fast.h"
#include "method/consistent/consistent.h"
#include "method/consistent/fused/fused.h"
#include "method/consistent/galerkin/hform.h"
#include "method/consistent/galerkin/moving_load.h"
#include "method/spline/passes.h"

#include <math.h>
#include <omp.h>
#include <string.h>

/* Planes that are made together. */
static size_t block_of(const struct consistent *c)
{
    return c->fused != NULL ? FUSED_PLANES : TENSOR_PLANES;
}

static size_t strips_of(const struct consistent *c)
{
    return (c->n[1] + TENSOR_STRIP - 1) / TENSOR_STRIP;
}

/* Together: the largest displacement of each strip of rows in each plane; up to what is returned nothing moves. What is
 * no number moves. */
static double look(const struct consistent *c, const double *u)
{
    const struct passes *passes = taken_passes();
    const size_t strips = strips_of(c);
    double largest = 0;
    if (!(c->options.quiet > 0)) return -1;
#pragma omp parallel for num_threads(c->threads) schedule(static) reduction(max : largest)
    for (size_t k = 0; k < c->n[DEPTH]; k++)
        for (size_t s = 0; s < strips; s++) {
            const size_t from = s * TENSOR_STRIP, left = c->n[1] - from;
            double *loudest = &c->hform->loudest[k * strips + s];
            *loudest = 0;
            for (int i = 0; i < c->dimension; i++) {
                const double *rows = u + (size_t)i * c->volume + k * c->plane + from * c->n[0];
                const size_t numbers = (left < TENSOR_STRIP ? left : TENSOR_STRIP) * c->n[0];
                const double size = passes->largest_size_double(rows, numbers);
                largest = fmax(largest, size);
                *loudest = fmax(*loudest, passes->all_finite(rows, numbers) ? size : INFINITY);
            }
        }
    return c->options.quiet * part_largest(c, largest);
}

/* Does anything move in what planes from .. end - 1 of a strip of rows read? Each strip is asked for itself, so that
 * all ranks that share rows leave out the same. */
static bool strip_moves(const struct consistent *c, double level, size_t from, size_t end, size_t strip)
{
    const struct tensor_plan *plan = c->hform->acceleration;
    const size_t strips = strips_of(c), deep = tensor_reach(plan, 2), wide = tensor_reach(plan, 1);
    const size_t low = strip * TENSOR_STRIP, high = low + TENSOR_STRIP + wide - 1;
    if (level < 0) return true;
    for (size_t k = from < deep ? 0 : from - deep; k < end + deep && k < c->n[DEPTH]; k++)
        for (size_t s = (low < wide ? 0 : low - wide) / TENSOR_STRIP; s <= high / TENSOR_STRIP && s < strips;
             s++)
            if (c->hform->loudest[k * strips + s] > level) return true;
    return false;
}

/* The operator alone, without edges, in planes from .. end - 1, one block. */
static void operator_block(const struct consistent *c, int thread, size_t from, size_t end, double level,
                           const double *u, double *a)
{
    const struct part_axis *rows = &c->part.along[1];
    double *out[3] = {NULL, NULL, NULL};
    if (c->fused != NULL) {
        const struct fused_fields fields = {.u = u, .a = a};
        fused_planes_double(c->fused, thread, from, &fields);
        return;
    }
    for (int component = 0; component < c->dimension; component++) {
        out[component] = a + (size_t)component * c->volume + from * c->plane;
        memset(out[component], 0, (end - from) * c->plane * sizeof *a);
    }
    size_t strip = rows->own / TENSOR_STRIP;
    while (strip * TENSOR_STRIP < rows->end) { /* strips that follow each other share what they load */
        const size_t first = strip;
        while (strip * TENSOR_STRIP < rows->end && strip_moves(c, level, from, end, strip))
            strip++;
        if (strip > first)
            tensor_planes(c->hform->acceleration, thread, from, end - from, first * TENSOR_STRIP,
                          strip * TENSOR_STRIP < rows->end ? strip * TENSOR_STRIP : rows->end, 1, u, out);
        else
            strip++;
    }
}

/* What is added to the operator in plane k. */
static void rest_of_plane(const struct consistent *c, const struct drive *drive, int thread, size_t k,
                          const double *u, const double *v, double *a)
{
    const struct hform *h = c->hform;
    double *out[3] = {NULL, NULL, NULL};
    for (int component = 0; component < c->dimension; component++)
        out[component] = a + (size_t)component * c->volume + k * c->plane;
    hform_edges_double(c, k, 1, u, out);
    if (h->dissipation != NULL && v != NULL) tensor_plane(h->dissipation, thread, k, 1, v, out);
    for (int component = 0; component < c->dimension; component++) {
        add_forces(c, drive, &h->load, h->pulled, component, k, out[component]);
        moving_loads_add(c, drive, component, k, out[component]);
        consistent_clear_held(c, component, k, out[component]);
    }
}

static void make_planes(struct consistent *c, const struct drive *drive, double level, struct part_range made,
                        const double *u, const double *v, double *a)
{
    const size_t block = block_of(c);
#pragma omp parallel for num_threads(c->threads) schedule(static)
    for (size_t from = made.from; from < made.end; from += block) {
        const int thread = omp_get_thread_num();
        const size_t end = from + block < made.end ? from + block : made.end;
        operator_block(c, thread, from, end, level, u, a);
        for (size_t k = from; k < end; k++)
            rest_of_plane(c, drive, thread, k, u, v, a);
        if (thread == 0) ranks_go_on(c->part.ranks);
    }
}

/* What layers add to the planes that a turn sends. */
static void pull_turn(const struct consistent *c, const double *extra, int turn, double *a)
{
    const struct part_range sent = c->part.sent[turn];
    pml_fast_pull_double(c, turn, 1, extra, a);
    for (int component = 0; component < c->dimension; component++)
        for (size_t k = sent.from; k < sent.end; k++)
            consistent_clear_held(c, component, k, a + (size_t)component * c->volume + k * c->plane);
}

/* What is added to all planes together. */
static void add_late(struct consistent *c, const struct drive *drive, double half_step, const double *u,
                     const double *v, double *a)
{
    const bool faces = c->fused != NULL && fused_add_faces_double(c, u, a);
    if (drive->extra != NULL) pml_accelerate(c, 1, drive->extra, a);
    for (int component = 0; (faces || drive->extra != NULL) && component < c->dimension; component++)
        for (size_t k = c->part.along[DEPTH].own; k < c->part.along[DEPTH].end; k++)
            consistent_clear_held(c, component, k, a + (size_t)component * c->volume + k * c->plane);
    if (c->model.damped && (v != NULL || half_step != 0)) hform_dampers(c, half_step, v, a);
}

/* Halos travel while the inside is made, but where something is added to all planes together. */
void hform_accelerate(struct consistent *c, const struct drive *drive, double half_step, const double *u,
                      const double *v, bool travels, double *a)
{
    const double level = c->fused == NULL ? look(c, u) : -1;
    const bool shared = drive->extra != NULL && c->pml->fast != NULL;
    const bool late =
        c->model.damped || (drive->extra != NULL && !shared) || (c->fused != NULL && c->fused->faces != NULL);
    const struct part_fields fields = part_values(c, a, (size_t)c->dimension, sizeof *a);
    if (c->fused != NULL) fused_look_double(c->fused, u);
    if (shared && !late) pml_fast_look_double(c, drive->extra);
    for (int turn = 0; turn < PART_TURNS; turn++) {
        make_planes(c, drive, level, c->part.made[turn], u, v, a);
        if (shared && !late) pull_turn(c, drive->extra, turn, a);
        if (travels && !late) part_send(c, &fields, turn);
    }
    if (late) add_late(c, drive, half_step, u, v, a);
    if (late && travels) part_exchange(c, &fields);
}

/* Together. */
static bool all_zero(const struct consistent *c, const double *x)
{
    size_t i = 0;
    while (i < c->model.unknowns && x[i] == 0)
        i++;
    return part_largest(c, i < c->model.unknowns ? 1 : 0) == 0;
}

/* M v, M = rho H (x) H (x) H: mass_solve() with the factors of N gives H (x) H (x) H over the density. */
void hform_weigh(struct consistent *c, const double *v, double *product)
{
    const double density = c->weighted[WEIGHT_DENSITY] == NULL ? c->property[WEIGHT_DENSITY] : 1;
    const size_t n = c->model.unknowns;
#pragma omp parallel for num_threads(c->threads) schedule(static)
    for (size_t i = 0; i < n; i++)
        product[i] = density * density * v[i];
    mass_solve(c, &c->hform->factors, product);
}

/* v.Mv / 2, and u.Ku / 2 = -u.M(-M^-1 K u) / 2. */
void hform_energy(struct consistent *c, const double *y, struct energy *energy)
{
    const size_t n = c->model.unknowns;
    const double density = c->weighted[WEIGHT_DENSITY] == NULL ? c->property[WEIGHT_DENSITY] : 1;
    const double scale = density * density;
    double *work = c->hform->work;
    *energy = (struct energy){0};
    if (!all_zero(c, y + n)) {
        hform_weigh(c, y + n, work);
        energy->kinetic = part_product(c, work, y + n) / 2;
    }
    if (!all_zero(c, y)) {
        hform_accelerate(c, &(struct drive){0}, 0, y, NULL, false, work);
        mass_solve(c, &c->hform->factors, work);
        energy->strain = -scale * part_product(c, work, y) / 2;
    }
}
