/* Dampers of total-Lagrangian SPH: Lysmer & Kuhlemeyer 1969, traction = -f rho c v on transmitting faces
 * (doc/theory/sph-total-lagrangian.md, section 5).
 *
 * On a lattice a damper sees the face's velocity, and pulls at the points, with the weights b by which a uniform stress
 * pulls at the layers behind the face (tractions.c), so that a plane wave leaves its stress as it is up to the face:
 *
 *   m_j a_j = F_j - b_j x,   x = Z b.(v + h a) = Z (b.v + h b.(F / m)) / (1 + h Z b.(b / m)),             (4a)
 *
 * h the half step by which the scheme brings v. Elsewhere, and where columns of two faces would cross, it acts at the
 * point nearest to the element of the surface. */
#include "method/total_lagrangian/total_lagrangian.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

static const double one = 1;

/* Points from one layer to the next, inwards from a face. */
static ptrdiff_t inwards(const struct tl_model *tl, int face)
{
    const size_t *grid = tl->cloud->grid;
    const int axis = face_axis((enum face)face);
    const size_t step = axis == 0 ? 1 : axis == 1 ? grid[0] : grid[0] * grid[1];
    return -face_sign((enum face)face) * (ptrdiff_t)step;
}

/* Layer of a lattice point behind a face. */
static size_t layer_of(const struct tl_model *tl, size_t i, int face)
{
    const size_t *grid = tl->cloud->grid, all = i + tl->cloud->first;
    const int axis = face_axis((enum face)face);
    const size_t at = axis == 0   ? all % grid[0]
                      : axis == 1 ? all / grid[0] % grid[1]
                                  : all / (grid[0] * grid[1]);
    return face_sign((enum face)face) < 0 ? at : grid[axis] - 1 - at;
}

/* Forces of a uniform stress on the layers of the column in the middle of a face, per area; together. */
static void middle_column(struct tl_model *tl, int face, double weight[TL_LAYERS])
{
    const int d = tl->cloud->dimension, axis = face_axis((enum face)face);
    const struct tl_range range = tl_summed(tl);
    const size_t *grid = tl->cloud->grid;
    double direction[3] = {0}, area = 1;
    direction[axis] = 1;
    for (int c = 0; c < d; c++)
        if (c != axis)
            area *= (tl->model.scene->body.high[c] - tl->model.scene->body.low[c]) / (double)grid[c];
    tl_uniform_stress(tl, direction, (enum face)face);
    memset(weight, 0, TL_LAYERS * sizeof *weight);
    for (size_t i = range.from; i < range.end; i++) {
        const size_t layer = layer_of(tl, i, face);
        bool middle = layer < TL_LAYERS && 2 * layer < grid[axis];
        for (int c = 0; c < d; c++)
            middle = middle && (c == axis || layer_of(tl, i, 2 * c) == grid[c] / 2);
        if (middle) weight[layer] = tl->force[(size_t)d * i + (size_t)axis] / area;
    }
    if (tl->part.shared) ranks_sum(tl->part.ranks, TL_LAYERS, weight);
}

/* Weights of the layers behind a face; their number. */
static size_t weights_of(struct tl_model *tl, int face, double weight[TL_LAYERS])
{
    static const double seen = 1e-9;
    const size_t across = tl->cloud->grid[face_axis((enum face)face)];
    size_t layers = 0;
    double sum = 0;
    if (across < 4 || tl->options.form != NULL) {
        weight[0] = 1;
        return 1;
    }
    middle_column(tl, face, weight);
    for (size_t k = 0; k < TL_LAYERS; k++) {
        if (fabs(weight[k]) > seen) layers = k + 1;
        sum += weight[k];
    }
    if (fabs(sum - 1) < 1e-6 && 2 * layers <= across) return layers;
    weight[0] = 1.5; /* thin bodies: the line through two points */
    weight[1] = -0.5;
    return 2;
}

/* Do the columns of another face reach a point? */
static bool crossed(const struct tl_model *tl, size_t i, int face)
{
    for (int other = 0; other < 2 * tl->cloud->dimension; other++)
        if (face_axis((enum face)other) != face_axis((enum face)face) &&
            layer_of(tl, i, other) < tl->dampers.layers[other])
            return true;
    return false;
}

/* Between a point and the face lies matter whose inertia the point has, but whose compliance nothing has. Behind a
 * damper of a part f of rho c it would pass for the mass (1 - f^2) rho times its length
 * (doc/theory/sph-total-lagrangian.md, Eq 4c). */
static void drop_inertia(struct tl_model *tl, const struct face_element *element, size_t i)
{
    static const double least = 0.25;
    const struct boundary *boundary = &tl->model.scene->boundary[element->face];
    const double part = fmin(1, fmin(boundary->normal_factor, boundary->shear_factor));
    double depth = 0;
    for (size_t a = 0; a < (size_t)tl->cloud->dimension; a++)
        depth += element->normal[a] * (element->position[a] - tl->cloud->position[3 * i + a]);
    tl->mass[i] *= fmax(least, 1 - part * part * element->area * depth / tl->cloud->volume[i]);
}

/* A damper for an element of the surface, or what it adds to that of the same point (of[point], 1 + its number). */
static void add_damper(struct tl_model *tl, const struct face_element *element, uint32_t *of)
{
    struct tl_dampers *dampers = &tl->dampers;
    const struct boundary *boundary = &tl->model.scene->boundary[element->face];
    const size_t i = neighbours_nearest(&tl->near, element->position);
    if (i >= tl->cloud->points) return;
    const struct material *material = tl->material[i];
    const bool lattice = tl->cloud->grid[0] > 0;
    const size_t layers = lattice && !crossed(tl, i, element->face) ? dampers->layers[element->face] : 1;
    if (of[i] == 0) {
        of[i] = (uint32_t)++dampers->count;
        dampers->damper[of[i] - 1] =
            (struct tl_damper){.point = i,
                               .layers = layers,
                               .step = layers > 1 ? inwards(tl, element->face) : 0,
                               .weight = layers > 1 ? dampers->weight[element->face] : &one};
    }
    for (size_t a = 0; a < (size_t)tl->cloud->dimension; a++) {
        const double normal = element->normal[a] * element->normal[a];
        const double speed = normal * boundary->normal_factor * material->p_speed +
                             (1 - normal) * boundary->shear_factor * material->s_speed;
        dampers->damper[of[i] - 1].impedance[a] += element->area * material->density * speed;
    }
    if (layers == 1) drop_inertia(tl, element, i);
}

static selas_status make_all(struct tl_model *tl, struct messages *messages)
{
    struct tl_dampers *dampers = &tl->dampers;
    uint32_t *of = array_new(tl->cloud->points, sizeof *of);
    dampers->damper = array_new(tl->cloud->points, sizeof *dampers->damper);
    const bool room = of != NULL && dampers->damper != NULL;
    for (size_t e = 0; room && e < tl->cloud->elements; e++) {
        const struct face_element *element = &tl->cloud->element[e];
        if (element->face < FACES && boundary_damps(&tl->model.scene->boundary[element->face]))
            add_damper(tl, element, of);
    }
    array_free(of);
    return room ? SELAS_OK : fail(messages, SELAS_NO_MEMORY, "no memory for dampers");
}

selas_status tl_make_dampers(struct tl_model *tl, struct messages *messages)
{
    const struct scene *scene = tl->model.scene;
    bool any = false;
    for (int face = 0; face < 2 * scene->dimension; face++) {
        if (!boundary_absorbs(&scene->boundary[face])) continue;
        const selas_status known = tl_need_surface(tl, (enum face)face, messages);
        if (known != SELAS_OK) return known;
        any = true;
        if (tl->cloud->grid[0] > 0) tl->dampers.layers[face] = weights_of(tl, face, tl->dampers.weight[face]);
    }
    return any ? make_all(tl, messages) : SELAS_OK;
}

selas_status tl_keep_dampers(struct tl_model *tl, struct messages *messages)
{
    struct tl_dampers *dampers = &tl->dampers;
    const struct tl_set *own = &tl->part.owned[ranks_me(tl->part.ranks)];
    const size_t first = tl->cloud->first, all = dampers->count;
    selas_status status = SELAS_OK;
    dampers->count = 0;
    for (size_t k = 0; k < all; k++) {
        const struct tl_damper *damper = &dampers->damper[k];
        if (!tl_set_has(own, first + damper->point)) continue;
        for (size_t l = 1; l < damper->layers && status == SELAS_OK; l++)
            if (!tl_set_has(own, first + tl_layer(damper, l)))
                status = fail(messages, SELAS_UNSUPPORTED,
                              "the %zu layers behind a face with dampers are not all on one rank: take fewer "
                              "ranks",
                              damper->layers);
        dampers->damper[dampers->count++] = *damper;
    }
    return status;
}

void tl_damp(struct tl_model *tl, double half_step, const double *v)
{
    const struct tl_dampers *dampers = &tl->dampers;
    const size_t d = (size_t)tl->cloud->dimension;
#pragma omp parallel for schedule(static) if (dampers->count > TL_SERIAL)
    for (size_t k = 0; k < dampers->count; k++) {
        const struct tl_damper *damper = &dampers->damper[k];
        for (size_t a = 0; a < d; a++) {
            double velocity = 0, pulled = 0, light = 0;
            for (size_t l = 0; l < damper->layers; l++) {
                const size_t i = tl_layer(damper, l);
                const double weight = damper->weight[l];
                if (v != NULL) velocity += weight * v[d * i + a];
                pulled += weight * tl->force[d * i + a] / tl->mass[i];
                light += weight * weight / tl->mass[i];
            }
            const double z = damper->impedance[a];
            const double force = z * (velocity + half_step * pulled) / (1 + half_step * z * light);
            for (size_t l = 0; l < damper->layers; l++)
                tl->force[d * tl_layer(damper, l) + a] -= damper->weight[l] * force;
        }
    }
}

double tl_damped(const struct tl_model *tl, const double *v)
{
    const size_t d = (size_t)tl->cloud->dimension;
    double power = 0;
    for (size_t k = 0; k < tl->dampers.count; k++) {
        const struct tl_damper *damper = &tl->dampers.damper[k];
        for (size_t a = 0; a < d; a++) {
            double velocity = 0;
            for (size_t l = 0; l < damper->layers; l++)
                velocity += damper->weight[l] * v[d * tl_layer(damper, l) + a];
            power += damper->impedance[a] * velocity * velocity;
        }
    }
    return power;
}
