/* Tractions on box faces of total-Lagrangian SPH.
 *
 * A uniform stress t x n in the body pulls at the points with f_j = -sum_i V_i (t x n) G_ij + ..., the
 * discrete form of the integral of t phi_j over the surface; so these forces, taken from the points near the
 * loaded face and weighed with the part of their footprint that the patch covers, are the consistent load:
 * under it a uniform stress is in equilibrium to the last layer. */
#include "method/total_lagrangian/total_lagrangian.h"

#include "points/disc.h"

#include <math.h>
#include <string.h>

/* Length that [a - half, a + half] and [b - wide, b + wide] share. */
static double overlap(double a, double half, double b, double wide)
{
    return fmax(0, fmin(a + half, b + wide) - fmax(a - half, b - wide));
}

/* Part of the rectangle about `place` (edges `width`, across `axis`) that a patch covers. */
static double covered(const struct load *load, int axis, const double place[3], const double width[3],
                      const double centre[3], int dimension)
{
    if (load->shape == LOAD_FACE || dimension == 1) return 1;
    double part = 1, low[2] = {0}, high[2] = {0}, moment[3];
    for (int c = 0, edge = 0; c < dimension && edge < 2; c++) {
        if (c == axis) continue;
        const double size = load->size[load->shape == LOAD_DISC ? 0 : edge];
        low[edge] = place[c] - centre[c] - width[c] / 2;
        high[edge] = place[c] - centre[c] + width[c] / 2;
        part *= overlap(place[c], 0.5 * width[c], centre[c], 0.5 * size) / width[c];
        edge++;
    }
    if (load->shape == LOAD_SQUARE || dimension == 2 || part <= 0) return part;
    disc_and_rectangle(low, high, load->size[0] / 2, moment);
    return moment[0] / ((high[0] - low[0]) * (high[1] - low[1]));
}

/* A load's patch about a place of the surface. */
struct patch {
    const struct load *load;
    const double *centre, *direction;
    double *force;  /* [dimension * points] */
    double free[3]; /* the direction but for what the face holds ... */
    double missing; /* ... in which this part of the traction is spread through the depth */
};

/* Area of the patch on the surface. */
static void add_area(struct tl_model *tl, const void *context, double *area)
{
    const struct patch *patch = context;
    const struct load *load = patch->load;
    for (size_t e = 0; e < tl->cloud->elements; e++) {
        const struct face_element *element = &tl->cloud->element[e];
        if (element->face == (int)load->face && tl_owns(tl, element->position))
            *area += element->area * covered(load, face_axis(load->face), element->position, element->width,
                                             patch->centre, tl->cloud->dimension);
    }
}

/* Fails if no element of the surface lies on a face. */
selas_status tl_need_surface(const struct tl_model *tl, enum face face, struct messages *messages)
{
    const struct cloud *cloud = tl->cloud;
    double area;
    if (cloud_on_face(cloud, (int)face, &area) > 0) return SELAS_OK;
    if (tl->part.shared && cloud->all == NULL) return SELAS_OK; /* of a box, on another rank */
    if ((cloud->all != NULL ? cloud->all->elements : cloud->elements) > 0)
        return fail(messages, SELAS_BAD_SCENE,
                    "no point has its normal and area on face '%s' of the body's box low .. high",
                    face_name(face));
    return fail(
        messages, SELAS_BAD_SCENE,
        "face '%s' is not known: the points come without areas and fill %.3g of the box low .. high (within "
        ".02 of 1 its faces would be theirs); give normal and area with the points at the surface",
        face_name(face), cloud_filling(cloud, &tl->model.scene->body));
}

void tl_uniform_stress(struct tl_model *tl, const double direction[3], enum face face)
{
    const size_t d = (size_t)tl->cloud->dimension;
    const size_t axis = (size_t)face_axis(face);
    memset(tl->A, 0, d * tl->plane * sizeof *tl->A);
    if (tl->extra != NULL) memset(tl->extra, 0, d * tl->cloud->points * sizeof *tl->extra);
    for (size_t i = 0; i < tl->cloud->points; i++)
        for (size_t a = 0; a < d; a++)
            tl->A[(size_t)axis * tl->plane + d * i + a] =
                -tl->cloud->volume[i] * direction[a] * face_sign(face);
    tl_divergence(tl);
}

/* The hole's rim is nearer than a face `away`: its forces of the uniform stress are not that face's. */
static bool of_hole(const struct body *body, const double x[3], double away)
{
    return body->shape == BODY_PLATE_WITH_HOLE &&
           hypot(x[0] - body->hole_centre[0], x[1] - body->hole_centre[1]) - body->hole_radius < away;
}

static double depth_behind(const struct tl_model *tl, const struct load *load)
{
    const struct body *body = &tl->model.scene->body;
    const int axis = face_axis(load->face);
    return body->high[axis] - body->low[axis];
}

/* Part of a point's footprint that the patch covers. */
static double covered_of(const struct tl_model *tl, const struct patch *patch, size_t i)
{
    const double wide = pow(tl->cloud->volume[i], 1.0 / tl->cloud->dimension);
    const double width[3] = {wide, wide, wide};
    return covered(patch->load, face_axis(patch->load->face), tl->cloud->position + 3 * i, width,
                   patch->centre, tl->cloud->dimension);
}

/* Forces of the uniform stress on the points under the patch, and their sum. */
static void add_covered(struct tl_model *tl, const void *context, double *sum)
{
    const struct patch *patch = context;
    const struct body *body = &tl->model.scene->body;
    const size_t d = (size_t)tl->cloud->dimension;
    const int axis = face_axis(patch->load->face);
    const double plane = face_plane(body, patch->load->face);
    const double reach = fmin(2 * tl_search_radius(tl), 0.5 * depth_behind(tl, patch->load));
    const struct tl_range range = tl_summed(tl);
    for (size_t i = range.from; i < range.end; i++) {
        const double *x = tl->cloud->position + 3 * i;
        if (fabs(x[axis] - plane) > reach || of_hole(body, x, fabs(x[axis] - plane))) continue;
        const double part = covered_of(tl, patch, i);
        for (size_t a = 0; a < d; a++) {
            patch->force[d * i + a] = part * tl->force[d * i + a];
            *sum += patch->force[d * i + a] * patch->direction[a];
        }
    }
}

/* Of a direction what a face does not hold, and its part in the work of a traction of 1. */
static double free_part(const struct scene *scene, enum face face, const double direction[3], double free[3])
{
    const struct boundary *boundary = &scene->boundary[face];
    const bool slides = boundary_slides(boundary) || (boundary_moves(boundary) && boundary->slip);
    double part = 0;
    free[0] = free[1] = free[2] = 0;
    if (!slides && boundary_meaning(boundary)->holds != HOLDS_NOTHING) return 0;
    for (int axis = 0; axis < scene->dimension; axis++) {
        if (!slides || axis != face_axis(face)) free[axis] = direction[axis];
        part += free[axis] * free[axis];
    }
    return part;
}

/* Area of the patch as the points under it have it. */
static void add_counted(struct tl_model *tl, const void *context, double *area)
{
    const struct patch *patch = context;
    const struct tl_range range = tl_summed(tl);
    for (size_t i = range.from; i < range.end; i++)
        *area += covered_of(tl, patch, i) * tl->cloud->volume[i] / depth_behind(tl, patch->load);
}

/* Adds what is missing of each area, spread evenly through the depth, and the sum of that. */
static void add_missing(struct tl_model *tl, const void *context, double *sum)
{
    const struct patch *patch = context;
    const size_t d = (size_t)tl->cloud->dimension;
    const struct tl_range range = tl_summed(tl);
    for (size_t i = range.from; i < range.end; i++) {
        const double area = covered_of(tl, patch, i) * tl->cloud->volume[i] / depth_behind(tl, patch->load);
        for (size_t a = 0; a < d; a++) {
            const double force = patch->missing * area * patch->free[a];
            patch->force[d * i + a] += force;
            *sum += force * patch->direction[a];
        }
    }
}

selas_status tl_traction_on_box(struct tl_model *tl, const struct load *load, const double centre[3],
                                const double direction[3], double *forces, struct messages *messages)
{
    struct patch patch = {load, centre, direction, forces, {0}, 0};
    const selas_status known = tl_need_surface(tl, load->face, messages);
    if (known != SELAS_OK) return known;
    tl_uniform_stress(tl, direction, load->face);
    double sum = tl_sum_in_order(tl, add_covered, &patch);
    /* what patches that cut points and scattered points lose or win */
    const double part = free_part(tl->model.scene, load->face, direction, patch.free);
    const double area = part * tl_sum_in_order(tl, add_area, &patch);
    if (part < 1e-20) return SELAS_OK;
    /* A face's own forces reach beyond the middle of a thin body. Those of its half have the traction's moment about
     * the middle, not its sum (sph-total-lagrangian.md, section 5). */
    const double counted = part * tl_sum_in_order(tl, add_counted, &patch);
    if (4 * tl_search_radius(tl) > depth_behind(tl, load) && counted > 0) {
        patch.missing = 1 - sum / counted;
        sum += tl_sum_in_order(tl, add_missing, &patch);
    }
    if (!(sum > 0.5 * area) || !(sum < 2 * area))
        return fail(messages, SELAS_BAD_SCENE,
                    "a load's patch, or the body behind it, is too small for the spacing: make the spacing "
                    "smaller, or a "
                    "small patch a point load");
    for (size_t k = 0; k < (size_t)tl->cloud->dimension * tl->cloud->points; k++)
        forces[k] *= load->amplitude * area / sum;
    return SELAS_OK;
}
