/* What two displacements in one operator or layered ground leave at the faces (fused.h, F1b, F1d), for numbers of
 * type REAL; included by fused_double.c and fused_single.c.
 *
 * On each face the displacement, of two the second, is a field of its two axes, `row` along rows and `deep` across
 * them; what is made of it goes to the planes that N e of the axis across the face reaches. */
#include "base/machine.h"
#include "method/consistent/fused/kernels.h"

#include <string.h>

struct face_fields {
    const struct fused_faces *faces;
    const struct fused_face *face;
    int row, deep;
    size_t n[2];    /* numbers in a row, rows */
    REAL *value[3]; /* of the face, by component */
    REAL *made[3];  /* by component */
    REAL *bare[2];  /* B of the components along rows and across the face */
};

static struct face_fields fields_of_face(const struct consistent *c, const struct fused_faces *faces,
                                         const struct fused_face *face)
{
    struct face_fields of = {
        .faces = faces, .face = face, .row = face->axis == 0 ? 1 : 0, .deep = face->axis == 2 ? 1 : 2};
    of.n[0] = c->n[of.row];
    of.n[1] = c->n[of.deep];
    REAL *room = faces->work;
    for (int component = 0; component < 3; component++) {
        of.value[component] = room + (size_t)component * of.n[0] * of.n[1];
        of.made[component] = room + (size_t)(3 + component) * of.n[0] * of.n[1];
    }
    for (int i = 0; i < 2; i++)
        of.bare[i] = room + (size_t)(6 + i) * of.n[0] * of.n[1];
    return of;
}

/* The displacement on the face; false: it is 0 there. */
static bool take_face(const struct consistent *c, const struct face_fields *of, const REAL *u)
{
    const size_t stride[3] = {1, c->n[0], c->plane};
    bool any = false;
#pragma omp parallel for num_threads(c->threads) schedule(static) reduction(|| : any)
    for (size_t place = 0; place < 3 * of->n[1]; place++) {
        const size_t component = place / of->n[1], j = place % of->n[1];
        const REAL *from =
            u + component * c->volume + of->face->at * stride[of->face->axis] + j * stride[of->deep];
        REAL *row = of->value[component] + j * of->n[0];
        for (size_t i = 0; i < of->n[0]; i++) {
            row[i] = from[i * stride[of->row]];
            any = any || row[i] != 0;
        }
    }
    return any;
}

/* Row j of out += matrix across rows (NULL: the identity) times a field. */
static void across_rows(const struct face_fields *of, const struct band *band, const REAL *in, size_t j,
                        REAL *out)
{
    const size_t n = of->n[0], half = band == NULL ? 0 : band->half;
    for (size_t other = less(j, half); other <= j + half && other < of->n[1]; other++) {
        const REAL weight = (REAL)(band == NULL ? 1 : band->value[(other + half - j) * band->n + j]);
        NAME(taken_fused_kernels)()->kick(n, weight, in + other * n, out);
    }
}

/* out += matrix times a row. */
static void along_row(const struct band *band, const REAL *in, REAL *out)
{
    for (size_t d = 0; d <= 2 * band->half; d++) {
        const size_t from = less(band->half, d), n = band->n - less(d, band->half) - from;
        NAME(taken_fused_kernels)
        ()->weigh(n, band->value + d * band->n + from, in + from + d - band->half, out + from);
    }
}

/* made := what (F1b) and (F1d) have along the face. */
static void make_rows(const struct face_fields *of, size_t j)
{
    const struct fused_faces *faces = of->faces;
    const int axis = of->face->axis, row = of->row, deep = of->deep;
    const bool over_depth = deep == DEPTH;
    const size_t at = j * of->n[0], bytes = of->n[0] * sizeof(REAL);
    for (int i = 0; i < 2; i++)
        memset(of->bare[i] + at, 0, bytes);
    for (int component = 0; component < 3; component++)
        memset(of->made[component] + at, 0, bytes);
    across_rows(of, over_depth ? faces->bare[0] : NULL, of->value[row], j, of->bare[0] + at);
    across_rows(of, over_depth ? faces->bare[1] : NULL, of->value[axis], j, of->bare[1] + at);
    along_row(faces->first[row], of->bare[0] + at, of->made[axis] + at);
    across_rows(of, faces->first[deep], of->value[deep], j, of->made[axis] + at);
    along_row(faces->second[row], of->bare[1] + at, of->made[row] + at);
    across_rows(of, faces->second[deep], of->value[axis], j, of->made[deep] + at);
}

/* Adds what was made to a component of plane k. */
static void add_face(const struct consistent *c, const struct face_fields *of, double factor, size_t k,
                     int component, REAL *a)
{
    const struct fused_face *face = of->face;
    const double *column = face->column[component];
    const REAL *made = of->made[component] + (face->axis == DEPTH ? 0 : k * of->n[0]);
    REAL *sum = a + (size_t)component * c->volume + k * c->plane;
    const struct NAME(fused_kernels) *kernels = NAME(taken_fused_kernels)();
    if (face->axis == DEPTH && k >= face->from && k < face->to)
        kernels->kick(c->plane, (REAL)(factor * column[k]), made, sum);
    for (size_t j = face->from; face->axis == 1 && j < face->to; j++)
        kernels->kick(c->n[0], (REAL)(factor * column[j]), made, sum + j * c->n[0]);
    if (face->axis != 0) return;
    REAL weight[FUSED_STRIP] = {0}; /* N e reaches no further */
    const size_t from = face->from == 0 ? 0 : c->n[0] - FUSED_STRIP;
    for (size_t i = face->from; i < face->to; i++)
        weight[i - from] = (REAL)(factor * column[i]);
    kernels->spread(c->n[1], c->n[0], weight, made, sum + from);
}

/* a += factor times (F1b) of the second displacement, or (F1d). False: there is nothing to add. */
static bool add_faces(const struct consistent *c, double factor, const struct fused_fields *fields)
{
    const struct fused_faces *faces = c->fused->faces;
    const REAL *u = fields->other != NULL ? fields->other : fields->u;
    REAL *a = fields->a;
    if (faces == NULL || (fields->other == NULL && !c->fused->layered)) return false;
    for (const struct fused_face *face = faces->face; face < faces->face + faces->count; face++) {
        const struct face_fields of = fields_of_face(c, faces, face);
        if (!take_face(c, &of, u)) continue;
#pragma omp parallel num_threads(c->threads)
        {
            const unsigned before = tiny_as_zero();
#pragma omp for schedule(static)
            for (size_t j = 0; j < of.n[1]; j++)
                make_rows(&of, j);
#pragma omp for schedule(static)
            for (size_t k = 0; k < c->n[DEPTH]; k++)
                for (int component = 0; component < 3; component++)
                    add_face(c, &of, factor * face->factor, k, component, a);
            tiny_as_before(before);
        }
    }
    return true;
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
