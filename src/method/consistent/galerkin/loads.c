/* Loads and prescribed faces of the consistent method: integrals of the basis functions, exact for patches
 * along the axes, by quadrature to rounding for discs (manual, section 4).
 *
 * The scene's load is the whole load: what a symmetry plane cuts off is not counted, and a point on the plane
 * counts half. */
#include "method/consistent/galerkin/galerkin.h"

#include "base/memory.h"
#include "method/consistent/galerkin/moving_load.h"
#include "method/consistent/galerkin/surface.h"
#include "method/spline/disc.h"
#include "method/spline/source.h"

#include <math.h>
#include <string.h>

/* Work space of set-up: a field, and the 1-D weights of the three axes. */
struct workspace {
    struct dense field;    /* 0 between loads */
    double *line[3];       /* [count] by axis; the first holds all that follows */
    double *work;          /* [largest count] */
    double *face;          /* [counts of a face's two axes]: disc */
    moment_beside *beside; /* NULL: moment tensors act on the splines' strain ... */
    force_beside *at_kink; /* ... and forces on their displacement */
};

static bool workspace_new(const struct consistent *c, struct workspace *w)
{
    size_t largest = 1;
    for (int axis = 0; axis < c->dimension; axis++)
        largest = c->spline[axis]->count > largest ? c->spline[axis]->count : largest;
    *w = (struct workspace){.field.value = array_new((size_t)c->dimension * c->volume, sizeof(double)),
                            .line[0] = array_new((4 + largest) * largest, sizeof(double))};
    if (w->field.value == NULL || w->line[0] == NULL) return false;
    w->line[1] = w->line[0] + largest;
    w->line[2] = w->line[1] + largest;
    w->work = w->line[2] + largest;
    w->face = w->work + largest;
    return true;
}

static void workspace_free(struct workspace *w)
{
    array_free(w->field.value);
    array_free(w->line[0]);
}

void consistent_add_product(const struct consistent *c, double *const line[3], int component, double factor,
                            struct dense *field)
{
    static const double one[1] = {1};
    const double *by_slot[3] = {one, one, one};
    struct footprint within;
    for (int axis = 0; axis < c->dimension; axis++)
        by_slot[c->slot[axis]] = line[axis] + c->part.along[c->slot[axis]].first;
    for (int slot = 0; slot < 3; slot++) {
        size_t from = 0, to = c->n[slot];
        while (from < to && by_slot[slot][from] == 0)
            from++;
        while (to > from && by_slot[slot][to - 1] == 0)
            to--;
        if (from == to) return;
        within.from[slot] = from;
        within.to[slot] = to;
    }
    double *out = field->value + (size_t)component * c->volume;
    for (size_t k = within.from[2]; k < within.to[2]; k++)
        for (size_t j = within.from[1]; j < within.to[1]; j++)
            for (size_t i = within.from[0]; i < within.to[0]; i++)
                out[k * c->plane + j * c->n[0] + i] += factor * by_slot[0][i] * by_slot[1][j] * by_slot[2][k];
    dense_widen(field, component, &within);
}

static void add_product(const struct consistent *c, struct workspace *w, int component, double factor)
{
    consistent_add_product(c, w->line, component, factor, &w->field);
}

/* Values (or slopes) of an axis's functions at x; halved where x lies on a symmetry plane and half is true.
 * Slopes of degree 1 jump at the points: there the mean of both sides. */
static void point_line(const struct consistent *c, int axis, bool odd, bool slope, bool half,
                       enum source_kind source, double x, double *line)
{
    const struct spline *spline = c->spline[axis];
    const struct boundary *boundary = &c->model.scene->boundary[2 * axis];
    const double small = 1e-9 * (spline->high - spline->low); /* no layer lies behind a symmetry plane */
    const bool cut = (boundary_mirrors(&boundary[0]) && fabs(x - spline->low) < small) ||
                     (boundary_mirrors(&boundary[1]) && fabs(x - spline->high) < small);
    struct tuned_point at;
    const bool wide = source_at(spline, odd, source, slope, x, &at);
    const int sides = !wide && slope && spline->degree == 1 ? 2 : 1;
    memset(line, 0, spline->count * sizeof *line);
    for (int side = 0; side < sides; side++) {
        const double beside = x + (sides == 2 ? (2 * side - 1) * small : 0);
        if (!wide) tuned_at(spline, odd, sides == 2 ? fmin(fmax(beside, spline->low), spline->high) : x, &at);
        for (size_t j = 0; j < at.count; j++)
            line[at.index[j]] += (slope ? at.slope[j] : at.value[j]) * (half && cut ? .5 : 1) / sides;
    }
}

void consistent_point_line(const struct consistent *c, int axis, bool odd, bool slope, bool half, double x,
                           double *line)
{
    point_line(c, axis, odd, slope, half, SOURCE_NONE, x, line);
}

static void force_line(const struct consistent *c, int axis, bool odd, double x, double *line)
{
    point_line(c, axis, odd, false, true, SOURCE_FORCE, x, line);
}

void consistent_source_line(const struct consistent *c, int axis, bool odd, bool slope, double x,
                            double *line)
{
    point_line(c, axis, odd, slope, true, SOURCE_MOMENT, x, line);
}

static bool traction(struct consistent *c, const struct load *load, const double centre[3],
                     const double direction[3], struct workspace *w)
{
    const struct body *body = &c->model.scene->body;
    const int normal = face_axis(load->face);
    for (int component = 0; component < c->dimension; component++) {
        if (direction[component] == 0) continue;
        int along[2], count = 0;
        for (int axis = 0; axis < c->dimension; axis++) {
            const struct spline *spline = c->spline[axis];
            const bool odd = axis == component;
            double *line = w->line[axis];
            if (axis == normal) {
                consistent_point_line(c, axis, odd, false, false, face_plane(body, load->face), line);
                continue;
            }
            const double half = load->size[load->shape == LOAD_DISC ? 0 : count] / 2;
            along[count++] = axis;
            if (load->shape == LOAD_POINT)
                force_line(c, axis, odd, centre[axis], line);
            else if (load->shape == LOAD_FACE)
                tuned_moments(spline, odd, body->low[axis], body->high[axis], w->work, line);
            else
                tuned_moments(spline, odd, centre[axis] - half, centre[axis] + half, w->work, line);
        }
        if (load->shape != LOAD_DISC || count < 2) {
            add_product(c, w, component, direction[component]);
            continue;
        }
        /* the disc's moments do not factorise: one row of the first axis at a time */
        const struct spline *first = c->spline[along[0]], *second = c->spline[along[1]];
        const struct disc disc = {centre[along[0]], centre[along[1]], load->size[0] / 2};
        if (!disc_moments(first, along[0] == component, second, along[1] == component, &disc, w->face))
            return false;
        for (size_t i = 0; i < first->count; i++) {
            for (size_t m = 0; m < first->count; m++)
                w->line[along[0]][m] = m == i;
            memcpy(w->line[along[1]], w->face + i * second->count, second->count * sizeof(double));
            add_product(c, w, component, direction[component]);
        }
    }
    return true;
}

static bool body_force(struct consistent *c, const struct load *load, const double centre[3],
                       const double direction[3], struct workspace *w)
{
    const struct body *body = &c->model.scene->body;
    for (int component = 0; component < c->dimension; component++) {
        if (direction[component] == 0) continue;
        for (int axis = 0; axis < c->dimension; axis++) {
            const struct spline *spline = c->spline[axis];
            if (load->shape == LOAD_POINT)
                force_line(c, axis, axis == component, centre[axis], w->line[axis]);
            else
                tuned_moments(spline, axis == component, body->low[axis], body->high[axis], w->work,
                              w->line[axis]);
        }
        add_product(c, w, component, direction[component]);
    }
    double by_slot[3] = {0};
    for (int axis = 0; axis < c->dimension; axis++)
        by_slot[c->slot[axis]] = direction[axis];
    return load->shape != LOAD_POINT || w->at_kink == NULL || w->at_kink(c, centre, by_slot, true, &w->field);
}

/* M in the body's frame. */
static void own_moment(const struct consistent *c, const struct load *load, double moment[3][3])
{
    static const int place[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    const double(*frame)[3] = c->model.scene->body.frame;
    const bool rotated = c->model.scene->body.rotated;
    for (int i = 0; i < c->dimension; i++)
        for (int j = 0; j < c->dimension; j++) {
            moment[i][j] = rotated ? 0 : load->moment[place[i][j]];
            for (int k = 0; rotated && k < 3; k++)
                for (int l = 0; l < 3; l++)
                    moment[i][j] += frame[k][i] * load->moment[place[k][l]] * frame[l][j];
        }
}

/* The density -M_ij d/dx_j delta gives M_ij dN/dx_j at the source; below a surface that is not level what M pulls at
 * along the lattice (G17). */
static bool moment_tensor(struct consistent *c, const struct load *load, const double centre[3],
                          struct workspace *w)
{
    double moment[3][3], by_slot[3][3] = {{0}};
    const struct metric metric = consistent_metric(c, centre);
    own_moment(c, load, moment);
    for (int i = 0; i < c->dimension; i++)
        for (int j = 0; j < c->dimension; j++)
            by_slot[c->slot[i]][c->slot[j]] = moment[i][j];
    if (w->beside != NULL && !w->beside(c, load, centre, by_slot, &w->field)) return false;
    if (!consistent_beneath(c, centre, by_slot, &w->field)) return false;
    for (int i = 0; i < c->dimension; i++)
        for (int j = 0; j < c->dimension; j++) {
            const double pull = c->slot[j] == DEPTH ? metric_pull(&metric, by_slot[c->slot[i]])
                                                    : by_slot[c->slot[i]][c->slot[j]];
            for (int axis = 0; axis < c->dimension; axis++)
                consistent_source_line(c, axis, axis == i, axis == j, centre[axis], w->line[axis]);
            if (pull != 0) add_product(c, w, i, pull);
        }
    return true;
}

/* The image of another source in a symmetry plane that cuts the body. */
static bool is_image(const struct consistent *c, const double centre[3])
{
    bool beyond = false;
    for (int axis = 0; axis < c->dimension; axis++) {
        const struct spline *spline = c->spline[axis];
        const double small = 1e-9 * (spline->high - spline->low);
        beyond = beyond || (spline->mirror[0] && centre[axis] < spline->low - small) ||
                 (spline->mirror[1] && centre[axis] > spline->high + small);
    }
    return beyond;
}

static selas_status load_create(struct consistent *c, const struct load *load, struct sparse *sparse,
                                struct workspace *w, struct messages *messages)
{
    const struct body *body = &c->model.scene->body;
    double centre[3], direction[3];
    lattice_from_deck(body, load->centre, centre);
    memcpy(direction, load->direction, sizeof direction);
    if (body->rotated) body_direction_from_deck(body, load->direction, direction);
    if (load->kind == LOAD_TRACTION && face_axis(load->face) >= c->dimension)
        return fail(messages, SELAS_BAD_SCENE, "a load acts on face %s, which this body has not",
                    face_name(load->face));
    const bool at_place = load->kind == LOAD_MOMENT_TENSOR || load->shape == LOAD_POINT;
    if (load_moves(load) || (at_place && is_image(c, centre))) /* moving_load.c; nothing here */
        return sparse_take(c, &w->field, sparse) ? SELAS_OK
                                                 : fail(messages, SELAS_NO_MEMORY, "no memory for a load");
    bool good = true;
    if (load->kind == LOAD_TRACTION)
        good = traction(c, load, centre, direction, w);
    else if (load->kind == LOAD_MOMENT_TENSOR)
        good = moment_tensor(c, load, centre, w);
    else if (load->shape == LOAD_POINT || load->shape == LOAD_FACE)
        good = body_force(c, load, centre, direction, w);
    else
        return fail(messages, SELAS_UNSUPPORTED,
                    "a body force acts at a point or over the whole body (shape = 'face')");
    if (good && sparse_take(c, &w->field, sparse)) return SELAS_OK;
    return fail(messages, SELAS_NO_MEMORY, "no memory for a load");
}

bool forces_of_moment(struct consistent *c, moment_beside *beside, const struct load *load,
                      struct sparse *sparse)
{
    struct workspace w;
    double centre[3], failed = !workspace_new(c, &w);
    ranks_largest(c->part.ranks, 1, &failed);
    w.beside = beside;
    lattice_from_deck(&c->model.scene->body, load->centre, centre);
    if (failed == 0) failed = !moment_tensor(c, load, centre, &w) || !sparse_take(c, &w.field, sparse);
    ranks_largest(c->part.ranks, 1, &failed);
    workspace_free(&w);
    return failed == 0;
}

/* True if a control value on a face belongs to it alone: no fixed face and no earlier moving face holds it.
 */
static bool owns(const struct consistent *c, int component, int face, const size_t at[3])
{
    for (int other = 0; other < 2 * c->dimension; other++) {
        const int slot = c->slot[other / 2];
        if (other == face || !c->held[component][other]) continue;
        if (at[slot] != part_face(c, other)) continue;
        if (!c->moving[other] || other < face) return false;
    }
    return true;
}

/* 1 (times the motion's direction) on the control values of a moving face. */
static void face_pattern(const struct consistent *c, int face, double *field)
{
    const int slot = c->slot[face / 2];
    for (int component = 0; component < c->dimension; component++) {
        if (!c->held[component][face]) continue;
        for (size_t i = 0; i < c->volume; i++) {
            const size_t at[3] = {i % c->n[0], i / c->n[0] % c->n[1], i / c->plane};
            if (at[slot] == part_face(c, face) && owns(c, component, face, at))
                field[(size_t)component * c->volume + i] = c->motion[face][component];
        }
    }
}

static bool motion_create(struct consistent *c, int face, struct workspace *w)
{
    struct dense inertia = {.value = array_new((size_t)c->dimension * c->volume, sizeof(double))};
    if (inertia.value == NULL) return false;
    face_pattern(c, face, w->field.value);
    for (size_t k = 0; k < c->n[DEPTH]; k++) {
        double *out[3] = {NULL, NULL, NULL};
        for (int component = 0; component < c->dimension; component++)
            out[component] = inertia.value + (size_t)component * c->volume + k * c->plane;
        tensor_plane(c->mass, 0, k, 1, w->field.value, out);
    }
    dense_whole(c, &w->field);
    dense_whole(c, &inertia);
    const bool good =
        sparse_take(c, &w->field, &c->pattern[face]) && sparse_take(c, &inertia, &c->inertia[face]);
    array_free(inertia.value);
    return good;
}

selas_status forces_create(struct consistent *c, struct messages *messages)
{
    const struct scene *scene = c->model.scene;
    struct workspace w;
    selas_status status = SELAS_OK;
    if (!workspace_new(c, &w) || !sparse_list_new(&c->load, scene->loads))
        status = fail(messages, SELAS_NO_MEMORY, "no memory for the loads");
    for (size_t k = 0; status == SELAS_OK && k < scene->loads; k++)
        status = load_create(c, &scene->load[k], &c->load.of[k], &w, messages);
    if (status == SELAS_OK && !sparse_list_sort(c, &c->load))
        status = fail(messages, SELAS_NO_MEMORY, "no memory for the loads");
    if (status == SELAS_OK) status = moving_loads_create(c, messages);
    for (int face = 0; status == SELAS_OK && face < 2 * c->dimension; face++)
        if (c->moving[face] && !motion_create(c, face, &w))
            status = fail(messages, SELAS_NO_MEMORY, "no memory for a moving face");
    workspace_free(&w);
    return status;
}

selas_status forces_in_ground(struct consistent *c, moment_beside *beside, force_beside *at_kink,
                              struct messages *messages)
{
    const struct scene *scene = c->model.scene;
    struct workspace w;
    selas_status status = SELAS_OK;
    if (!workspace_new(c, &w)) status = fail(messages, SELAS_NO_MEMORY, "no memory for the loads");
    status = ranks_agree(c->part.ranks, status, messages);
    w.beside = beside;
    w.at_kink = at_kink;
    for (size_t k = 0; status == SELAS_OK && k < scene->loads; k++) {
        const struct load *load = &scene->load[k];
        const bool force = load->kind != LOAD_TRACTION && load->shape == LOAD_POINT && !load_moves(load);
        if (load->kind != LOAD_MOMENT_TENSOR && !force) continue;
        sparse_free(&c->load.of[k]);
        status = load_create(c, load, &c->load.of[k], &w, messages);
        status = ranks_agree(c->part.ranks, status, messages);
    }
    if (status == SELAS_OK && !sparse_list_sort(c, &c->load))
        status = fail(messages, SELAS_NO_MEMORY, "no memory for the loads");
    status = ranks_agree(c->part.ranks, status, messages);
    workspace_free(&w);
    return status;
}

size_t forces_bytes(const struct consistent *c)
{
    size_t bytes = sparse_list_bytes(c, &c->load);
    for (int face = 0; face < BOX_FACES; face++)
        bytes += sparse_bytes(&c->pattern[face]) + sparse_bytes(&c->inertia[face]);
    return bytes;
}

void forces_free(struct consistent *c)
{
    sparse_list_free(&c->load);
    moving_loads_free(c);
    for (int face = 0; face < BOX_FACES; face++) {
        sparse_free(&c->pattern[face]);
        sparse_free(&c->inertia[face]);
    }
}
