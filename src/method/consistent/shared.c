/* A consistent model's share of a body on ranks (galerkin/part.h): its arrays, what is told of it. */
#include "method/consistent/absorbing/pml_fast.h"
#include "method/consistent/consistent.h"
#include "method/consistent/general/general.h"

#include <math.h>
#include <stdio.h>

/* --- Arrays -------------------------------------------------------------------------------------------- */

/* Rows of the window along two slots, of `row` numbers each, in planes of the second one. */
static void add_rows(size_t row, const struct part_axis *y, size_t rows, const struct part_axis *z,
                     size_t planes, struct spread *shares)
{
    const struct spread_run run = {.there = (z->first * y->whole + y->first) * row,
                                   .count = rows * row,
                                   .from = y->own * row,
                                   .end = y->end * row,
                                   .times = planes,
                                   .here_step = rows * row,
                                   .there_step = y->whole * row,
                                   .first = z->own,
                                   .last = z->end,
                                   .abreast = y->ranks};
    const size_t plane = rows * row;
    const struct spread_run line =
        spread_line(0, z->first * plane, planes * plane, z->own * plane, z->end * plane);
    spread_add(shares, planes * plane, z->whole * y->whole * row, y->ranks > 1 ? &run : &line);
}

/* Memory at the points of general ground that the layer behind a face has of a family (general/layers.c). A rank's own
 * points stand in the cells that begin with its own planes. */
static void add_points(const struct consistent *c, int face, const struct family *family,
                       struct spread *shares)
{
    const struct general *g = c->general;
    const struct part_axis *part = &c->part.along[DEPTH];
    const struct spline *spline = c->layout[DEPTH];
    const int slot = c->slot[face / 2], me = part->me, last = part->ranks - 1;
    const size_t width = c->layer[face], here = family->n[DEPTH], low = spline->mirror[0] ? 1 : 0;
    const size_t there = spline->cells + (family->at[DEPTH] == AT_KNOTS ? 1 : 0);
    const size_t row = (slot == 0 ? width : family->n[0]) * (slot == 1 ? width : family->n[1]);
    const size_t from = me == 0 ? 0 : part->first + part->own + low - g->first;
    const size_t end = me == last ? here : part->first + part->end + low - g->first;
    const struct spread_run rows = spread_line(0, g->first * row, here * row, from * row, end * row);
    const size_t holds = me == (face % 2 == 0 ? 0 : last) ? width * row : 0;
    const struct spread_run all = spread_line(0, 0, holds, 0, holds);
    for (int component = 0; component < c->dimension; component++) {
        if (slot == DEPTH)
            spread_add(shares, holds, width * row, &all);
        else
            spread_add(shares, here * row, there * row, &rows);
    }
}

/* Numbers that are not shared, of which the rank has all. */
static struct part_axis unshared(size_t n)
{
    return (struct part_axis){.whole = n, .end = n, .ranks = 1};
}

/* A memory variable of shared passes, [b][s][f] with rows of whole vectors (absorbing/pml_fast.h). */
static void add_shared_passes(const struct consistent *c, const struct fast_slab *s, struct spread *shares)
{
    const struct part_axis *y = &c->part.along[1], *z = &c->part.along[DEPTH], one = unshared(1);
    const size_t whole = pml_fast_width(c, y->whole),
                 behind = y->me + 1 == y->ranks ? whole - y->first : y->end;
    const struct spread_run run = {.there = z->first * s->ns * whole + y->first,
                                   .count = y->me + 1 == y->ranks ? behind : c->n[1],
                                   .from = y->own,
                                   .end = behind,
                                   .times = s->nb * s->ns,
                                   .here_step = s->width,
                                   .there_step = whole,
                                   .first = z->own * s->ns,
                                   .last = z->end * s->ns,
                                   .abreast = y->ranks};
    if (s->axis[ROLE_B] == 1)
        add_rows(s->ns * s->width, y, s->nb, &one, 1, shares);
    else if (s->axis[ROLE_F] != 1 || y->ranks == 1)
        add_rows(s->ns * s->width, &one, 1, z, s->nb, shares);
    else
        spread_add(shares, s->nb * s->ns * s->width, z->whole * s->ns * whole, &run);
}

/* The same in the order of control values. */
static void add_slab(const struct consistent *c, const struct slab *slab, struct spread *shares)
{
    const struct part_axis thick = unshared(slab->inside.n[c->slot[slab->axis]]);
    const struct part_axis *along[3] = {&c->part.along[0], &c->part.along[1], &c->part.along[2]};
    along[c->slot[slab->axis]] = &thick;
    add_rows(slab->inside.n[0], along[1], slab->inside.n[1], along[2], slab->inside.n[2], shares);
}

static void add_memory(const struct consistent *c, const struct slab *slab, struct spread *shares)
{
    if (c->pml != NULL && c->pml->fast != NULL)
        add_shared_passes(c, &c->pml->fast->slab[slab - c->pml->slab], shares);
    else
        add_slab(c, slab, shares);
}

/* Memory variables of the layers, face by face: those across an axis that ranks share are whole one rank's own. */
static void add_layers(const struct consistent *c, struct spread *shares)
{
    const struct slab *own[BOX_FACES] = {NULL};
    double sizes[BOX_FACES] = {0};
    for (size_t s = 0; c->pml != NULL && s < c->pml->slabs; s++) {
        const struct slab *slab = &c->pml->slab[s];
        struct spread its = {0};
        own[2 * slab->axis + slab->end] = slab;
        add_memory(c, slab, &its);
        sizes[2 * slab->axis + slab->end] = (double)its.there;
    }
    ranks_largest(c->part.ranks, BOX_FACES, sizes);
    for (int face = 0; c->general != NULL && face < 2 * c->dimension; face++)
        for (int f = 0; sizes[face] > 0 && f < 3; f++)
            add_points(c, face, &c->general->family[f], shares);
    /* psi and phi of each layer, or phi of all and then their forces (general/layers.c) */
    const int fields = c->general != NULL ? c->dimension : 2 * c->dimension,
              turns = c->general != NULL ? 2 : 1;
    for (int i = 0; i < turns * 2 * c->dimension * fields; i++) {
        const int face = i / fields % (2 * c->dimension);
        if (own[face] != NULL)
            add_memory(c, own[face], shares);
        else
            shares->there += (size_t)sizes[face];
    }
}

void consistent_share(struct model *model, enum model_array array, struct spread *shares)
{
    const struct consistent *c = consistent_of(model);
    if (array == ARRAY_EXTRA)
        add_layers(c, shares);
    else
        for (int component = 0; component < c->dimension; component++)
            add_rows(c->n[0], &c->part.along[1], c->n[1], &c->part.along[DEPTH], c->n[DEPTH], shares);
}

/* --- What the plan tells -------------------------------------------------------------------------------- */

static double operators(const struct consistent *c)
{
    return c->model.parts > 1 ? (double)c->model.parts : 1;
}

/* Bytes that a rank sends at each step: each operator of damped ground its own, but the velocities of steps in one pass
 * once. */
static double halo_bytes(const struct consistent *c)
{
    const size_t number = c->model.single ? sizeof(float) : sizeof(double);
    const struct part_fields values = part_values(c, NULL, (size_t)c->dimension, number);
    return part_bytes(c, &values) * (c->model.one_pass != NULL ? 1 : operators(c));
}

/* And by the solves of an exact mass, one for each operator, to one neighbour one way or the other. */
static double solve_bytes(const struct consistent *c)
{
    if (c->hform != NULL) return 0;
    return operators(c) * c->dimension * (double)(c->plane * c->factors[0].half[DEPTH] * sizeof(double));
}

/* How many control values each part along an axis has for its own, as many as find room. */
static int add_sizes(const struct part_axis *along, char *text, size_t room)
{
    int used = 0;
    for (int r = 0; r < along->ranks && (size_t)used + 24 < room; r++)
        used += snprintf(text + used, room - (size_t)used, " %zu", along->bound[r + 1] - along->bound[r]);
    return used;
}

void shared_describe(const struct consistent *c,
                     void (*tell)(void *context, const char *key, const char *value), void *context)
{
    const struct part_axis *y = &c->part.along[1], *z = &c->part.along[DEPTH];
    char text[200];
    int used = 0;
    if (c->part.ranks == NULL) return;
    if (y->ranks > 1) used = snprintf(text, sizeof text, "%d x %d blocks, rows over y:", y->ranks, z->ranks);
    if (y->ranks > 1) used += add_sizes(y, text + used, sizeof text / 2 - (size_t)used);
    used += snprintf(text + used, sizeof text - (size_t)used,
                     y->ranks > 1 ? "; planes:" : "%d, planes over the last axis:", z->ranks);
    add_sizes(z, text + used, sizeof text - (size_t)used);
    tell(context, "ranks", text);
    const int neighbours = (z->me > 0) + (z->me + 1 < z->ranks);
    used = snprintf(text, sizeof text, "%.0f by the first rank in each operator call (%zu planes",
                    halo_bytes(c) + neighbours * solve_bytes(c), z->halo);
    snprintf(text + used, sizeof text - (size_t)used,
             y->ranks > 1 ? ", %zu rows to a neighbour)" : " to a neighbour)", y->halo);
    tell(context, "halo bytes a step", text);
    const struct ranks_outlook outlook = part_outlook(c);
    snprintf(text, sizeof text, "of even ground in one pass, with %g ns a point, %g ns of the halo",
             PART_POINT * 1e9, PART_HALO_POINT * 1e9);
    ranks_tell_outlook(&outlook, text, tell, context);
}

/* --- What is wrong -------------------------------------------------------------------------------------- */

/* Where fields of the whole body are not at hand: the fastest of the own control values, or the middle of those
 * that are spoiled. */
static void own_fastest(const struct consistent *c, const double *y, struct unseen *found)
{
    const double *v = y + c->model.unknowns;
    double inside[3] = {0}, middle[3] = {0}, position[3];
    found->places = 0;
    for (size_t p = 0; p < c->volume; p++) {
        const struct part_axis *along = c->part.along;
        const size_t j = p / c->n[0] % c->n[1], k = p / c->plane;
        const size_t at[3] = {p % c->n[0], along[1].first + j, along[DEPTH].first + k};
        if (!part_owns(&c->part, j, k)) continue;
        found->places++;
        double square = 0, way = 0;
        for (size_t component = 0; component < (size_t)c->dimension; component++) {
            square += v[component * c->volume + p] * v[component * c->volume + p];
            way += y[component * c->volume + p] * y[component * c->volume + p];
        }
        const bool spoiled = !isfinite(square + way);
        if (!spoiled && (found->spoiled > 0 || sqrt(square) <= found->speed)) continue;
        found->spoiled += spoiled;
        found->speed = spoiled ? INFINITY : sqrt(square);
        for (int axis = 0; axis < c->dimension; axis++) {
            inside[axis] = c->spline[axis]->greville[at[c->slot[axis]]];
            if (spoiled) middle[axis] += inside[axis];
        }
    }
    for (int axis = 0; found->spoiled > 0 && axis < c->dimension; axis++)
        inside[axis] = middle[axis] / (double)found->spoiled;
    lattice_to_deck(&c->model.scene->body, inside, position);
    snprintf(found->place, sizeof found->place, "%s (%.6g, %.6g, %.6g)", found->spoiled > 0 ? "about" : "at",
             position[0], position[1], position[2]);
}

void consistent_unseen(struct model *model, const double *y, struct unseen *found)
{
    const struct consistent *c = consistent_of(model);
    *found = (struct unseen){.speed = -1};
    if (c->part.ranks != NULL) own_fastest(c, y, found);
    layers_fastest(model, y, found);
}
