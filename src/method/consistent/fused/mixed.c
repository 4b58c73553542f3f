/* Making of what two displacements in one operator need (fused.h, F1a and F1b). */
#include "method/consistent/fused/fused.h"

#include "base/memory.h"
#include "method/consistent/galerkin/hform.h"

/* N (D - share E) along an axis for component `out`: of its own component if that is another, else of another
 * one. NULL: no memory. */
static struct band *gradient(struct consistent *c, int axis, int out, double share)
{
    const bool odd = out == axis;
    struct band *inner = fused_narrow_matrix(c, axis, odd, false, !odd, true, share);
    struct band *whole = inner == NULL ? NULL : band_product(c->hform->inverse[out][axis], inner);
    band_free(inner);
    struct band *part = whole == NULL ? NULL : band_cut(whole, c->part.along[axis].first, c->n[axis]);
    band_free(whole);
    return part;
}

static bool lay_bands(struct consistent *c, struct fused_faces *faces)
{
    const double lambda = c->property[WEIGHT_LAMBDA], mu = c->property[WEIGHT_MU];
    for (int axis = 0; axis < 3; axis++) {
        faces->first[axis] = gradient(c, axis, axis == 0 ? 1 : 0, 0);
        faces->second[axis] = gradient(c, axis, axis, lambda / (lambda + mu));
        if (faces->first[axis] == NULL || faces->second[axis] == NULL) return false;
    }
    if (!c->options.depth_exact) return true;
    struct band *mass = fused_narrow_matrix(c, DEPTH, false, false, false, false, 0);
    struct band *whole = mass == NULL ? NULL : band_product(c->hform->inverse[0][DEPTH], mass);
    if (whole != NULL) faces->bare = band_cut(whole, c->part.along[DEPTH].first, c->n[DEPTH]);
    band_free(mass);
    band_free(whole);
    return faces->bare != NULL;
}

/* Faces that the window has and that are no mirrors. */
static void lay_faces(const struct consistent *c, struct fused_faces *faces, double factor)
{
    const struct hform *h = c->hform;
    for (int side = 0; side < BOX_FACES; side++) {
        const int axis = side / 2, end = side % 2;
        struct fused_face *face = &faces->face[faces->count];
        face->at = part_face(c, side);
        if (c->spline[axis]->mirror[end] || face->at == SIZE_MAX) continue;
        face->axis = axis;
        face->factor = end == 0 ? -factor : factor;
        face->from = end == 0 ? 0 : c->n[axis] - h->reach[axis];
        face->to = end == 0 ? h->reach[axis] : c->n[axis];
        for (int out = 0; out < 3; out++)
            face->column[out] = h->column[out][axis][end] + c->part.along[axis].first;
        faces->count++;
    }
}

static struct fused_faces *faces_new(struct consistent *c, double factor)
{
    struct fused_faces *faces = array_new(1, sizeof *faces);
    size_t largest = 0;
    if (faces == NULL) return NULL;
    for (int axis = 0; axis < 3; axis++) {
        const size_t size = c->volume / c->n[axis];
        if (size > largest) largest = size;
    }
    lay_faces(c, faces, factor);
    faces->bytes = sizeof *faces + 8 * largest * sizeof(double);
    faces->work = array_new(8 * largest, sizeof(double));
    if (faces->work != NULL && lay_bands(c, faces)) return faces;
    fused_faces_free(faces);
    return NULL;
}

bool fused_mix(struct consistent *c, const struct consistent *second)
{
    const double lambda = c->property[WEIGHT_LAMBDA], mu = c->property[WEIGHT_MU];
    const double more = second->property[WEIGHT_LAMBDA], density = c->property[WEIGHT_DENSITY];
    struct fused_faces *faces = faces_new(c, more * mu / ((lambda + mu) * density));
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

void fused_faces_free(struct fused_faces *faces)
{
    if (faces == NULL) return;
    for (int axis = 0; axis < 3; axis++) {
        band_free(faces->first[axis]);
        band_free(faces->second[axis]);
    }
    band_free(faces->bare);
    array_free(faces->work);
    array_free(faces);
}
