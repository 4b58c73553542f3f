/* Making of what two displacements in one operator need, and of what is left at faces (fused.h, F1a, F1b, F1d). */
#include "method/consistent/fused/fused.h"

#include "base/memory.h"
#include "method/consistent/galerkin/hform.h"

/* The window's part of factor * N * inner, which is freed, along an axis for component `out`. NULL: no memory. */
static struct band *window_product(struct consistent *c, int axis, int out, double factor, struct band *inner)
{
    struct band *whole = inner == NULL ? NULL : band_product(c->hform->inverse[out][axis], inner);
    band_free(inner);
    struct band *part = whole == NULL ? NULL : band_cut(whole, c->part.along[axis].first, c->n[axis]);
    band_free(whole);
    for (size_t i = 0; part != NULL && i < (2 * part->half + 1) * part->n; i++)
        part->value[i] *= factor;
    return part;
}

/* factor N (D - share E) along an axis for component `out`: of its own component if that is another, else of another
 * one. NULL: no memory. */
static struct band *gradient(struct consistent *c, int axis, int out, double factor, double share)
{
    const bool odd = out == axis;
    return window_product(c, axis, out, factor, fused_narrow_matrix(c, axis, odd, false, !odd, true, share));
}

static bool lay_bands(struct consistent *c, struct fused_faces *faces)
{
    const double lambda = c->property[WEIGHT_LAMBDA], mu = c->property[WEIGHT_MU];
    for (int axis = 0; axis < 3; axis++) {
        faces->first[axis] = gradient(c, axis, axis == 0 ? 1 : 0, -1, 0);
        faces->second[axis] = gradient(c, axis, axis, 1, lambda / (lambda + mu));
        if (faces->first[axis] == NULL || faces->second[axis] == NULL) return false;
    }
    for (int i = 0; i < 2 && c->options.depth_exact; i++) {
        faces->bare[i] =
            window_product(c, DEPTH, 0, 1, fused_narrow_matrix(c, DEPTH, false, false, false, false, 0));
        if (faces->bare[i] == NULL) return false;
    }
    return true;
}

/* factor N (a matrix over depth by a property) for component `out`. NULL: no memory. */
static struct band *weighted(struct consistent *c, int out, double factor, bool slope, enum weighting weight)
{
    const bool odd = out == DEPTH;
    const struct band *known = consistent_matrix(c, DEPTH, 0, odd, slope, slope != odd, weight);
    return known == NULL ? NULL : window_product(c, DEPTH, out, factor, band_sum(known, 0, known));
}

/* Of layered ground (F1d). */
static bool lay_layered_bands(struct consistent *c, struct fused_faces *faces)
{
    bool good = true;
    for (int axis = 0; axis < 2; axis++) {
        faces->first[axis] = gradient(c, axis, 1 - axis, -1, 0);
        faces->second[axis] = gradient(c, axis, axis, -1, 0);
        faces->bare[axis] = weighted(c, 0, 1, false, axis == 0 ? WEIGHT_LAMBDA : WEIGHT_MU);
        good = good && faces->first[axis] != NULL && faces->second[axis] != NULL && faces->bare[axis] != NULL;
    }
    faces->first[DEPTH] = weighted(c, 0, -1, true, WEIGHT_LAMBDA);
    faces->second[DEPTH] = weighted(c, DEPTH, -1, true, WEIGHT_MU);
    return good && faces->first[DEPTH] != NULL && faces->second[DEPTH] != NULL;
}

/* Faces up to `sides` that the window has, that are no mirrors and not held. */
static void lay_faces(const struct consistent *c, struct fused_faces *faces, int sides, double factor)
{
    const struct hform *h = c->hform;
    for (int side = 0; side < sides; side++) {
        if (c->held[0][side] && c->held[1][side] && c->held[2][side]) continue;
        const int axis = side / 2, end = side % 2;
        struct fused_face *face = &faces->face[faces->count];
        face->at = part_face(c, side);
        if (c->spline[axis]->mirror[end] || face->at == SIZE_MAX) continue;
        face->axis = axis;
        face->end = end;
        face->factor = end == 0 ? -factor : factor;
        face->from = end == 0 ? 0 : c->n[axis] - h->reach[axis];
        face->to = end == 0 ? h->reach[axis] : c->n[axis];
        for (int out = 0; out < 3; out++)
            face->column[out] = h->column[out][axis][end] + c->part.along[axis].first;
        faces->count++;
    }
}

/* Of each thread two rows of B, three that are made, and what it has taken of the faces across x. */
static bool lay_rooms(const struct consistent *c, struct fused_faces *faces)
{
    enum { ROWS = 2 + 3 + 2 * 3 * FUSED_MOST_TAPS };
    const size_t longest = c->n[0] > c->n[1] ? c->n[0] : c->n[1];
    faces->row = fused_rounded(longest + (size_t)(2 * FUSED_MOST_TAPS), FUSED_VECTOR / sizeof(float));
    faces->room_size = ROWS * faces->row;
    faces->room = array_new((size_t)c->threads * faces->room_size, sizeof(double));
    faces->bytes = sizeof *faces + (size_t)c->threads * faces->room_size * sizeof(double);
    bool good = faces->room != NULL;
    for (size_t i = 0; good && i < faces->count; i++) {
        if (faces->face[i].axis != DEPTH) continue;
        void **flat = &faces->flat[faces->face[i].end];
        *flat = array_new(3 * c->plane, sizeof(double));
        faces->bytes += 3 * c->plane * sizeof(double);
        good = *flat != NULL;
    }
    return good;
}

static struct fused_faces *faces_new(struct consistent *c, bool layered, double factor)
{
    struct fused_faces *faces = array_new(1, sizeof *faces);
    if (faces == NULL) return NULL;
    lay_faces(c, faces, layered ? 2 * DEPTH : BOX_FACES, factor);
    if (lay_rooms(c, faces) && (layered ? lay_layered_bands : lay_bands)(c, faces)) return faces;
    fused_faces_free(faces);
    return NULL;
}

bool fused_mix(struct consistent *c, const struct consistent *second)
{
    const double lambda = c->property[WEIGHT_LAMBDA], mu = c->property[WEIGHT_MU];
    const double more = second->property[WEIGHT_LAMBDA], density = c->property[WEIGHT_DENSITY];
    struct fused_faces *faces = faces_new(c, false, more * mu / ((lambda + mu) * density));
    if (faces == NULL) return false;
    c->model.bytes += faces->bytes;
    for (struct fused *f = c->fused; f != NULL; f = f->single) {
        const size_t before = f->bytes;
        f->faces = faces;
        f->share[SHARE_MIXED] = more / (lambda + mu);
        f->share[SHARE_AXIAL] = more / (lambda + 2 * mu);
        if (!fused_lay_rings(f, 2)) return false;
        c->model.bytes += f->bytes - before;
    }
    return true;
}

bool fused_layered_faces(struct consistent *c)
{
    struct fused_faces *faces = faces_new(c, true, 1);
    if (faces == NULL) return false;
    if (faces->count == 0) {
        fused_faces_free(faces);
        return true;
    }
    c->fused->bytes += faces->bytes;
    for (struct fused *f = c->fused; f != NULL; f = f->single)
        f->faces = faces;
    return true;
}

void fused_faces_free(struct fused_faces *faces)
{
    if (faces == NULL) return;
    for (int axis = 0; axis < 3; axis++) {
        band_free(faces->first[axis]);
        band_free(faces->second[axis]);
    }
    band_free(faces->bare[0]);
    band_free(faces->bare[1]);
    array_free(faces->room);
    array_free(faces->flat[0]);
    array_free(faces->flat[1]);
    array_free(faces);
}
