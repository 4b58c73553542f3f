/* A consistent model's share of a body on ranks (galerkin/part.h): its arrays, what is told of it. */
#include "method/consistent/absorbing/pml_fast.h"
#include "method/consistent/consistent.h"
#include "method/consistent/general/general.h"

#include <math.h>
#include <stdio.h>

/* --- Arrays -------------------------------------------------------------------------------------------- */

/* Rows of the window over the last axis, of `row` numbers each. */
static void add_rows(const struct consistent *c, size_t row, struct spread *shares)
{
    const struct rank_part *part = &c->part;
    const struct spread_run run =
        spread_line(0, part->first * row, c->n[DEPTH] * row, part->own * row, part->end * row);
    spread_add(shares, c->n[DEPTH] * row, part->whole * row, &run);
}

/* Memory at the points of general ground that the layer behind a face has of a family (general/layers.c). A rank's own
 * points stand in the cells that begin with its own planes. */
static void add_points(const struct consistent *c, int face, const struct family *family,
                       struct spread *shares)
{
    const struct general *g = c->general;
    const struct rank_part *part = &c->part;
    const struct spline *spline = c->layout[DEPTH];
    const int slot = c->slot[face / 2], me = ranks_me(part->ranks), last = ranks_count(part->ranks) - 1;
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

/* Memory variables of the layers, face by face: those across the last axis are one rank's own, whole. */
static void add_layers(const struct consistent *c, struct spread *shares)
{
    const struct slab *own[BOX_FACES] = {NULL};
    double sizes[BOX_FACES] = {0};
    for (size_t s = 0; c->pml != NULL && s < c->pml->slabs; s++) {
        const struct slab *slab = &c->pml->slab[s];
        own[2 * slab->axis + slab->end] = slab;
        sizes[2 * slab->axis + slab->end] = (double)slab->inner;
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
        if (sizes[face] == 0) continue;
        const size_t here = own[face] != NULL ? own[face]->inner : 0, there = (size_t)sizes[face];
        const struct spread_run all = spread_line(0, 0, here, 0, here);
        if (c->slot[face / 2] == DEPTH)
            spread_add(shares, here, there, &all);
        else
            add_rows(c, here / c->n[DEPTH], shares);
    }
}

void consistent_share(struct model *model, enum model_array array, struct spread *shares)
{
    const struct consistent *c = consistent_of(model);
    if (array == ARRAY_EXTRA)
        add_layers(c, shares);
    else
        for (int component = 0; component < c->dimension; component++)
            add_rows(c, c->plane, shares);
}

/* --- What the plan tells -------------------------------------------------------------------------------- */

/* Bytes that a rank sends to one neighbour at each step: each operator of damped ground its own, but the velocities of
 * steps in one pass once. */
static double halo_bytes(const struct consistent *c)
{
    const struct pml_fast *fast = c->pml == NULL           ? NULL
                                  : c->pml->single != NULL ? c->pml->single
                                                           : c->pml->fast;
    const double number = c->model.single ? sizeof(float) : sizeof(double);
    const double operators = c->model.parts > 1 ? c->model.parts : 1;
    double numbers = c->dimension * (double)c->plane * (c->model.one_pass != NULL ? 1 : operators);
    for (size_t s = 0; fast != NULL && s < c->pml->slabs; s++)
        if (fast->slab[s].axis[ROLE_B] == DEPTH)
            numbers += operators * 3 * (double)(fast->slab[s].ns * fast->slab[s].width);
    return numbers * number * (double)c->part.halo;
}

/* And by the solves of an exact mass, one way or the other. */
static double solve_bytes(const struct consistent *c)
{
    if (c->hform != NULL) return 0;
    return c->dimension * (double)(c->plane * c->factors[0].half[DEPTH] * sizeof(double));
}

void shared_describe(const struct consistent *c,
                     void (*tell)(void *context, const char *key, const char *value), void *context)
{
    const struct rank_part *part = &c->part;
    const int ranks = ranks_count(part->ranks), me = ranks_me(part->ranks);
    char text[200];
    if (part->ranks == NULL) return;
    int used = snprintf(text, sizeof text, "%d, planes over the last axis:", ranks);
    for (int r = 0; r < ranks && (size_t)used + 24 < sizeof text; r++)
        used +=
            snprintf(text + used, sizeof text - (size_t)used, " %zu", part->bound[r + 1] - part->bound[r]);
    tell(context, "ranks", text);
    const int neighbours = (me > 0) + (me + 1 < ranks);
    snprintf(text, sizeof text, "%.0f by the first rank in each operator call (%zu planes to a neighbour)",
             neighbours * (halo_bytes(c) + solve_bytes(c)), part->halo);
    tell(context, "halo bytes a step", text);
}

/* --- What is wrong -------------------------------------------------------------------------------------- */

/* Where fields of the whole body are not at hand: the fastest of the own control values, or the middle of those
 * that are spoiled. */
static void own_fastest(const struct consistent *c, const double *y, struct unseen *found)
{
    const double *v = y + c->model.unknowns;
    double inside[3] = {0}, middle[3] = {0}, position[3];
    found->places = (c->part.end - c->part.own) * c->plane;
    for (size_t p = c->part.own * c->plane; p < c->part.end * c->plane; p++) {
        const size_t at[3] = {p % c->n[0], p / c->n[0] % c->n[1], c->part.first + p / c->plane};
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
