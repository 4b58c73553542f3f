/* Half, quarter or eighth of a body in place of the whole.
 *
 * Points, operator and state are those of the part below the mirror planes; whoever asks for a place above
 * one gets the values of its image, reflected: vectors v -> H v and tensors s -> H s H with H = I - 2 n n^T,
 * n the plane's normal. */
#include "method/mirror.h"

#include "base/memory.h"
#include "method/damped/damped.h"
#include "scene/symmetry.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct mirror {
    struct model model;
    struct scene part_scene;
    unsigned axes;
    struct model_core core; /* what the part has no function for is not there */
};

/* --- Reflection --- */

static double middle(const struct mirror *mirror, int axis)
{
    return mirror->part_scene.body.high[axis];
}

/* Maps a position (deck coordinates) below all mirror planes; returns the mask of planes it was above. */
static unsigned fold(const struct mirror *mirror, const double position[3], double folded[3])
{
    const struct body *body = &mirror->part_scene.body;
    double place[3];
    unsigned above = 0;
    body_from_deck(body, position, place);
    for (int axis = 0; axis < 3; axis++)
        if ((mirror->axes & 1u << axis) != 0 && place[axis] > middle(mirror, axis)) {
            place[axis] = 2.0 * middle(mirror, axis) - place[axis];
            above |= 1u << axis;
        }
    body_to_deck(body, place, folded);
    return above;
}

/* H of the planes in the mask, in deck coordinates. Planes are across each other, so their order does not
 * matter. */
static void reflection(const struct mirror *mirror, unsigned planes, double h[3][3])
{
    const struct body *body = &mirror->part_scene.body;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            h[i][j] = i == j ? 1.0 : 0.0;
            for (int axis = 0; axis < 3; axis++)
                if ((planes & 1u << axis) != 0) h[i][j] -= 2.0 * body->frame[i][axis] * body->frame[j][axis];
        }
}

static void reflect_vector(double h[3][3], double *v)
{
    const double old[3] = {v[0], v[1], v[2]};
    for (int i = 0; i < 3; i++)
        v[i] = h[i][0] * old[0] + h[i][1] * old[1] + h[i][2] * old[2];
}

static void reflect_tensor(double h[3][3], double *s)
{
    static const int place[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}}; /* of xx yy zz xy yz zx */
    double old[3][3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            old[i][j] = s[place[i][j]];
    for (int i = 0; i < 3; i++)
        for (int j = i; j < 3; j++) {
            double sum = 0.0;
            for (int k = 0; k < 3; k++)
                for (int l = 0; l < 3; l++)
                    sum += h[i][k] * old[k][l] * h[l][j];
            s[place[i][j]] = sum;
        }
}

static void reflect(double h[3][3], selas_field field, double *value)
{
    if (field_components(field) == 3) reflect_vector(h, value);
    if (field_components(field) == 6) reflect_tensor(h, value);
}

/* --- The model's functions: those of the part --- */

static void unseen(struct model *model, const double *y, struct unseen *found)
{
    if (model->part->core->unseen != NULL) model->part->core->unseen(model->part, y, found);
}

static void initialise(struct model *model, double *y)
{
    struct model *part = model->part;
    if (part->core->initialise != NULL) part->core->initialise(part, y);
}

static selas_status find_probe(struct model *model, const double position[3], struct probe *probe,
                               struct messages *messages)
{
    struct mirror *mirror = (struct mirror *)model;
    double folded[3];
    const unsigned above = fold(mirror, position, folded);
    const selas_status status = mirror->model.part->core->probe(mirror->model.part, folded, probe, messages);
    probe->mirrored = above;
    for (int c = 0; c < 3; c++)
        probe->position[c] = position[c];
    return status;
}

static void observe(struct model *model, const struct probe *probe, selas_field field, const double *y,
                    const double *a, double *value)
{
    struct mirror *mirror = (struct mirror *)model;
    struct probe inside = *probe; /* methods may go by the position, which must lie in the part */
    fold(mirror, probe->position, inside.position);
    model_observe(mirror->model.part, &inside, field, y, a, value);
    double h[3][3];
    if (probe->mirrored == 0) return;
    reflection(mirror, probe->mirrored, h);
    reflect(h, field, value);
}

/* Index along one axis in the part of index i in the whole, and whether it lies above the plane. */
static size_t folded_index(const struct mirror *mirror, int axis, size_t i, unsigned *planes)
{
    const size_t last = mirror->model.part->grid[axis] - 1;
    if ((mirror->axes & 1u << axis) == 0 || i <= last) return i;
    *planes |= 1u << axis;
    return 2 * last - i;
}

/* The part's point that shows a point of the whole. */
static size_t image_of(const struct mirror *mirror, size_t point)
{
    const size_t *whole = mirror->model.grid, *part = mirror->model.part->grid;
    unsigned planes = 0;
    const size_t i = folded_index(mirror, 0, point % whole[0], &planes);
    const size_t j = folded_index(mirror, 1, point / whole[0] % whole[1], &planes);
    return i + part[0] * (j + part[1] * folded_index(mirror, 2, point / (whole[0] * whole[1]), &planes));
}

/* The part's values, from its point `first` on, fill the head of the array and spread from its end to the
 * points from .. end - 1: none of these is nearer to the head than its image, so nothing is overwritten that is
 * still needed. */
static void unfold(const struct mirror *mirror, selas_field field, size_t first, size_t from, size_t end,
                   double *value)
{
    const size_t components = (size_t)field_components(field);
    const size_t *whole = mirror->model.grid;
    const size_t *part = mirror->model.part->grid;
    for (size_t point = end; point-- > from;) {
        unsigned planes = 0;
        const size_t i = folded_index(mirror, 0, point % whole[0], &planes);
        const size_t j = folded_index(mirror, 1, point / whole[0] % whole[1], &planes);
        const size_t k = folded_index(mirror, 2, point / (whole[0] * whole[1]), &planes);
        const double *image = value + components * (i + part[0] * (j + part[1] * k) - first);
        double *to = value + components * (point - from);
        memmove(to, image, components * sizeof *to);
        if (planes == 0) continue;
        double h[3][3];
        reflection(mirror, planes, h);
        reflect(h, field, to);
    }
}

/* Planes from .. end - 1 over the last axis whose images are in the part's planes first .. last - 1. */
static void show_planes(struct mirror *mirror, selas_field field, const double *y, const double *a,
                        const size_t planes[2], const size_t images[2], double *value)
{
    const int axis = mirror->model.scene->dimension - 1;
    struct model *part = mirror->model.part;
    const size_t plane = mirror->model.points / mirror->model.grid[axis],
                 image = part->points / part->grid[axis];
    part->core->field(part, field, y, a, images[0] * image, images[1] * image, value);
    unfold(mirror, field, images[0] * image, planes[0] * plane, planes[1] * plane, value);
}

/* Rows over the first axis from .. end - 1 of the points, one by one. */
static void show_rows(struct mirror *mirror, selas_field field, const double *y, const double *a, size_t from,
                      size_t end, double *value)
{
    struct model *part = mirror->model.part;
    const size_t row = mirror->model.grid[0];
    for (size_t at = from; at < end; at += row) {
        const size_t first = image_of(mirror, at);
        double *to = value + (size_t)field_components(field) * (at - from);
        part->core->field(part, field, y, a, first, first + part->grid[0], to);
        unfold(mirror, field, first, at, at + row, to);
    }
}

/* Planes below the mirror across the last axis, or all from the first on, together; those above it one by one. */
static void whole_field(struct model *model, selas_field field, const double *y, const double *a, size_t from,
                        size_t end, double *value)
{
    struct mirror *mirror = (struct mirror *)model;
    const int axis = model->scene->dimension - 1;
    const size_t plane = model->points / model->grid[axis], below = model->part->grid[axis];
    size_t planes[2] = {from / plane, end / plane};
    if (from % plane != 0 || end % plane != 0) {
        show_rows(mirror, field, y, a, from, end, value);
        return;
    }
    if (planes[0] == 0 || planes[1] <= below) {
        const size_t images[2] = {planes[0], planes[1] < below ? planes[1] : below};
        show_planes(mirror, field, y, a, planes, images, value);
        return;
    }
    for (size_t k = from / plane; k < end / plane; k++) {
        unsigned above = 0;
        const size_t image = folded_index(mirror, axis, k, &above), images[2] = {image, image + 1};
        planes[0] = k;
        planes[1] = k + 1;
        show_planes(mirror, field, y, a, planes, images,
                    value + (size_t)field_components(field) * (k * plane - from));
    }
}

static int holder_of(const struct model *model, size_t point)
{
    return model->part->core->holder(model->part, image_of((const struct mirror *)model, point));
}

static double copies(const struct model *model)
{
    double count = 1.0;
    for (int axis = 0; axis < 3; axis++)
        if ((((const struct mirror *)model)->axes & 1u << axis) != 0) count *= 2.0;
    return count;
}

static void whole_energy(struct model *model, const double *y, struct energy *energy)
{
    model->part->core->energy(model->part, y, energy);
    energy->kinetic *= copies(model);
    energy->strain *= copies(model);
}

static double whole_loss(struct model *model, const double *y)
{
    return copies(model) * model->part->core->loss(model->part, y);
}

static void whole_power(struct model *model, const struct drive *drive, const double *y, double *load,
                        double *absorbed)
{
    model->part->core->power(model->part, drive, y, load, absorbed);
    *load *= copies(model);
    *absorbed *= copies(model);
}

static void describe(const struct model *model,
                     void (*tell)(void *context, const char *key, const char *value), void *context)
{
    const struct mirror *mirror = (const struct mirror *)model;
    char text[96];
    snprintf(text, sizeof text, "mirror planes across%s%s%s: 1/%g of the body is computed",
             (mirror->axes & 1u) != 0 ? " x" : "", (mirror->axes & 2u) != 0 ? " y" : "",
             (mirror->axes & 4u) != 0 ? " z" : "", copies(model));
    tell(context, "symmetry", text);
    if (mirror->model.part->core->describe != NULL)
        mirror->model.part->core->describe(mirror->model.part, tell, context);
}

static void forget(struct model *model)
{
    if (model->part->core->forget != NULL) model->part->core->forget(model->part);
}

static void destroy(struct model *model)
{
    struct mirror *mirror = (struct mirror *)model;
    model_free(&mirror->model.part);
    free(mirror);
}

/* --- Building --- */

static const struct model_core mirror_core = {
    .destroy = destroy,
    .initialise = initialise,
    .probe = find_probe,
    .observe = observe,
    .field = whole_field,
    .energy = whole_energy,
    .power = whole_power,
    .unseen = unseen,
    .describe = describe,
    .forget = forget,
};

/* What the whole shows of the part: state, operator, passes and memory are the part's, points the whole's: a
 * lattice that fills the whole body, whose positions nobody stores. */
static void fill(struct mirror *mirror, struct model *part, const struct scene *scene)
{
    struct model *model = &mirror->model;
    *model = *part;
    model->part = part;
    mirror->core = mirror_core;
    if (part->core->loss != NULL) mirror->core.loss = whole_loss;
    if (part->core->holder != NULL) mirror->core.holder = holder_of;
    model->core = &mirror->core;
    model->scene = scene;
    for (int axis = 0; axis < 3; axis++)
        if ((mirror->axes & 1u << axis) != 0) model->grid[axis] = 2 * part->grid[axis] - 1;
    model->points = model->grid[0] * model->grid[1] * model->grid[2];
}

selas_status mirror_create(const struct method *method, const struct scene *scene, unsigned axes,
                           struct model **created, struct messages *messages)
{
    *created = NULL;
    struct mirror *mirror = calloc(1, sizeof *mirror);
    if (mirror == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the model");
    mirror->axes = axes;
    mirror->part_scene = scene_below_mirrors(scene, axes);
    struct model *part = NULL;
    const selas_status status = damped_or_plain(method, &mirror->part_scene, &part, messages);
    if (status != SELAS_OK) {
        free(mirror);
        return status;
    }
    fill(mirror, part, scene);
    *created = &mirror->model;
    return SELAS_OK;
}
