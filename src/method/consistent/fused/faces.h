/* What two displacements in one operator or layered ground leave at the faces (fused.h, F1b, F1d), for numbers of
 * type REAL; included by fused_double.c and fused_single.c.
 *
 * On each face the displacement, of two the second, is a field of its two axes, `row` along rows and `deep` across
 * them; what is made of it goes to the planes that N e of the axis across the face reaches. Of faces across x and y
 * row k is made for plane k while a thread has it in the cache; faces across depth are made before all planes. */
#include "base/machine.h"
#include "method/consistent/fused/kernels.h"

#include <string.h>

/* What a thread works with at a face. */
struct face_rows {
    const struct consistent *c;
    const struct fused_face *face;
    const REAL *u; /* the displacement */
    REAL *taken;   /* [component][FUSED_MOST_TAPS][n[0]]: of a face across x */
    REAL *bare[2]; /* a row of B of the components along rows and across the face, 0 on both sides of it */
    REAL *made[3]; /* a row by component, of a face across depth the whole face */
    int row, deep;
    size_t n[2]; /* numbers in a row, rows */
};

static struct face_rows rows_of_face(const struct consistent *c, const struct fused_face *face, int thread,
                                     const REAL *u)
{
    const struct fused_faces *faces = c->fused->faces;
    struct face_rows of = {
        .c = c, .face = face, .u = u, .row = face->axis == 0 ? 1 : 0, .deep = face->axis == 2 ? 1 : 2};
    REAL *room = (REAL *)faces->room + (size_t)thread * faces->room_size;
    of.n[0] = c->n[of.row];
    of.n[1] = c->n[of.deep];
    for (int i = 0; i < 2; i++)
        of.bare[i] = room + (size_t)i * faces->row + FUSED_MOST_TAPS;
    for (int component = 0; component < 3; component++)
        of.made[component] = face->axis == DEPTH
                                 ? (REAL *)faces->flat[face->end] + (size_t)component * c->plane
                                 : room + (size_t)(2 + component) * faces->row;
    of.taken = room + (size_t)(5 + face->end * 3 * FUSED_MOST_TAPS) * faces->row;
    return of;
}

/* Of a face across x: the rows that plane k needs and, but of a thread's first plane, the one before did not. */
static void take_rows(const struct face_rows *of, bool first, size_t k)
{
    const struct consistent *c = of->c;
    const size_t half = (size_t)c->fused->deep / 2;
    for (size_t j = first ? less(k, half) : k + half; j <= k + half && j < of->n[1]; j++)
        for (size_t component = 0; component < 3; component++) {
            const REAL *column = of->u + component * c->volume + j * c->plane + of->face->at;
            REAL *row = of->taken + (component * FUSED_MOST_TAPS + j % FUSED_MOST_TAPS) * of->n[0];
            for (size_t i = 0; i < of->n[0]; i++)
                row[i] = column[i * c->n[0]];
        }
}

/* out += row j of a matrix across rows (NULL: the identity) times a component. */
static void across_rows(const struct face_rows *of, const struct band *band, int component, size_t j,
                        REAL *out)
{
    const struct consistent *c = of->c;
    const size_t half = band == NULL ? 0 : band->half, from = less(j, half);
    const size_t stride[3] = {1, c->n[0], c->plane}, step = stride[of->deep];
    const REAL *field = of->u + (size_t)component * c->volume + of->face->at * stride[of->face->axis];
    const REAL *taken = of->taken + (size_t)component * FUSED_MOST_TAPS * of->n[0], *row[FUSED_MOST_TAPS];
    REAL weight[FUSED_MOST_TAPS];
    size_t count = 0, place = from % FUSED_MOST_TAPS;
    for (size_t other = from; other <= j + half && other < of->n[1]; other++, count++) {
        row[count] = of->face->axis == 0 ? taken + place * of->n[0] : field + other * step;
        weight[count] = (REAL)(band == NULL ? 1 : band->value[(other + half - j) * band->n + j]);
        place = place + 1 < FUSED_MOST_TAPS ? place + 1 : 0;
    }
    NAME(taken_fused_kernels)()->gather(of->n[0], count, weight, row, out);
}

/* out += matrix times a row that is 0 on both sides. */
static void along_row(const struct band *band, const REAL *in, REAL *out)
{
    NAME(taken_fused_kernels)()->weigh(band->n, 2 * band->half + 1, band->value, in - band->half, out);
}

/* made := what (F1b) and (F1d) have along the face in row j. */
static void make_row(const struct face_rows *of, size_t j)
{
    const struct fused_faces *faces = of->c->fused->faces;
    const int axis = of->face->axis, row = of->row, deep = of->deep;
    const bool over_depth = deep == DEPTH;
    const size_t at = over_depth ? 0 : j * of->n[0];
    for (int i = 0; i < 2; i++)
        memset(of->bare[i] - FUSED_MOST_TAPS, 0, faces->row * sizeof(REAL));
    for (int component = 0; component < 3; component++)
        memset(of->made[component] + at, 0, of->n[0] * sizeof(REAL));
    across_rows(of, over_depth ? faces->bare[0] : NULL, row, j, of->bare[0]);
    across_rows(of, over_depth ? faces->bare[1] : NULL, axis, j, of->bare[1]);
    along_row(faces->first[row], of->bare[0], of->made[axis] + at);
    across_rows(of, faces->first[deep], deep, j, of->made[axis] + at);
    along_row(faces->second[row], of->bare[1], of->made[row] + at);
    across_rows(of, faces->second[deep], axis, j, of->made[deep] + at);
}

/* Adds what was made to a component of plane k. */
static void add_face(const struct face_rows *of, double factor, size_t k, int component, REAL *a)
{
    const struct consistent *c = of->c;
    const struct fused_face *face = of->face;
    const double *column = face->column[component];
    const REAL *made = of->made[component];
    REAL *sum = a + (size_t)component * c->volume + k * c->plane;
    const struct NAME(fused_kernels) *kernels = NAME(taken_fused_kernels)();
    if (face->axis == DEPTH) kernels->kick(c->plane, (REAL)(factor * column[k]), made, sum);
    for (size_t j = face->from; face->axis == 1 && j < face->to; j++)
        kernels->kick(c->n[0], (REAL)(factor * column[j]), made, sum + j * c->n[0]);
    if (face->axis != 0) return;
    REAL weight[FUSED_STRIP] = {0}; /* N e reaches no further */
    const size_t from = face->from == 0 ? 0 : c->n[0] - FUSED_STRIP;
    for (size_t i = face->from; i < face->to; i++)
        weight[i - from] = (REAL)(factor * column[i]);
    kernels->spread(c->n[1], c->n[0], weight, made, sum + from);
}

/* The displacement that leaves something at the faces; NULL: none does. */
static const REAL *left_at_faces(const struct consistent *c, const struct fused_fields *fields)
{
    if (c->fused->faces == NULL) return NULL;
    return fields->other != NULL ? fields->other : c->fused->layered ? fields->u : NULL;
}

/* A thread's share of what is made of faces across depth. */
static void make_flat(const struct consistent *c, int thread, const struct fused_fields *fields)
{
    const struct fused_faces *faces = c->fused->faces;
    const REAL *u = left_at_faces(c, fields);
    const size_t all = (size_t)c->threads, own = (size_t)thread;
    for (size_t i = 0; u != NULL && i < faces->count; i++) {
        const struct face_rows of = rows_of_face(c, &faces->face[i], thread, u);
        if (of.face->axis != DEPTH) continue;
        for (size_t j = own * of.n[1] / all; j < (own + 1) * of.n[1] / all; j++)
            make_row(&of, j);
    }
}

/* Is the displacement 0 in all that a face reads for plane k? */
static bool silent_face(const struct fused *f, const struct fused_face *face, size_t k)
{
    const size_t half = (size_t)f->deep / 2;
    if (face->axis == DEPTH) return window_points(&f->reached[face->at]) == 0;
    for (size_t p = less(k, half); p <= k + half && p < f->n[2]; p++)
        if (window_points(&f->reached[p]) > 0 && face->at >= f->reached[p].from[face->axis] &&
            face->at < f->reached[p].end[face->axis])
            return false;
    return true;
}

/* Plane k of a += factor times (F1b) of the second displacement, or (F1d). A thread takes planes one after the other,
 * this is its first or not. */
static void add_faces(const struct consistent *c, int thread, double factor,
                      const struct fused_fields *fields, bool first, size_t k)
{
    const struct fused_faces *faces = c->fused->faces;
    const REAL *u = left_at_faces(c, fields);
    for (size_t i = 0; u != NULL && i < faces->count; i++) {
        const struct fused_face *face = &faces->face[i];
        const struct face_rows of = rows_of_face(c, face, thread, u);
        const bool flat = face->axis == DEPTH;
        if (face->axis == 0) take_rows(&of, first, k);
        if (flat && (k < face->from || k >= face->to)) continue;
        if (fields->moved != NULL && silent_face(FUSED(c), face, k)) continue;
        if (!flat) make_row(&of, k);
        for (int component = 0; component < 3; component++)
            add_face(&of, factor * face->factor, k, component, fields->a);
    }
}

/* What faces make of u, in plane k. */
static struct window reached_by_faces(const struct consistent *c, const struct fused *f, size_t k)
{
    const struct fused_faces *faces = c->fused->faces;
    const size_t half = (size_t)f->deep / 2;
    struct window reached = {{0, 0}, {0, 0}};
    if (faces == NULL) return reached;
    for (const struct fused_face *face = faces->face; face < faces->face + faces->count; face++) {
        const bool flat = face->axis == DEPTH;
        if (flat && (k < face->from || k >= face->to)) continue;
        struct window source = f->reached[flat ? face->at : k];
        for (size_t p = less(k, half); !flat && p <= k + half && p < f->n[2]; p++)
            source = window_join(&source, &f->reached[p]);
        if (window_points(&source) == 0) continue;
        if (!flat && (face->at < source.from[face->axis] || face->at >= source.end[face->axis])) continue;
        for (int axis = 0; axis < 2; axis++) {
            const size_t end = source.end[axis] + half;
            source.from[axis] = axis == face->axis ? face->from : less(source.from[axis], half);
            source.end[axis] = axis == face->axis ? face->to : end < f->n[axis] ? end : f->n[axis];
        }
        reached = window_join(&reached, &source);
    }
    return reached;
}
