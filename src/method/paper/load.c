/* Loads of the published method: tractions on faces by Eq 19 of Ding et al. (2006), body forces, moment
 * tensors.
 *
 * Eq 19 approximates the integral of W T over the face; the sum of W_ab A_b T_b does, at every point a near
 * the face, while the printed T_a times the sum of W_ab A_b loads only points on the face. Points on the rim
 * of a patch carry the part of their cell that the patch covers (1/2 on an edge, 1/4 at a corner of the
 * patch), and the shares are scaled so that the patch carries exactly its area. */
#include "base/memory.h"
#include "method/paper/paper.h"
#include "points/disc.h"

#include <math.h>

/* Length of [a, a + b] within [c, d]. */
static double overlap(double low, double high, double from, double to)
{
    return fmax(0, fmin(high, to) - fmax(low, from));
}

/* Rectangle on a face: ranges along its (up to two) axes. */
struct rectangle {
    int axes, axis[2];
    double low[2], high[2];
};

static struct rectangle whole_face(const struct paper *paper, enum face face)
{
    const struct body *body = &paper->model.scene->body;
    struct rectangle whole = {0};
    for (int axis = 0; axis < paper->dimension; axis++) {
        if (axis == face_axis(face)) continue;
        whole.axis[whole.axes] = axis;
        whole.low[whole.axes] = body->low[axis];
        whole.high[whole.axes] = body->high[axis];
        whole.axes++;
    }
    return whole;
}

static struct rectangle clipped(struct rectangle part, const struct rectangle *whole)
{
    for (int k = 0; k < part.axes; k++) {
        part.low[k] = fmax(part.low[k], whole->low[k]);
        part.high[k] = fmax(part.low[k], fmin(part.high[k], whole->high[k]));
    }
    return part;
}

static double rectangle_area(const struct rectangle *rectangle)
{
    double area = 1;
    for (int k = 0; k < rectangle->axes; k++)
        area *= rectangle->high[k] - rectangle->low[k];
    return area;
}

/* Area of a rectangle within a disc; on the line that is a face in 2D, the length within. */
static double area_in_disc(const struct rectangle *part, const double centre[2], double radius)
{
    if (part->axes == 0) return 1;
    if (part->axes == 1) return overlap(part->low[0], part->high[0], centre[0] - radius, centre[0] + radius);
    const double low[2] = {part->low[0] - centre[0], part->low[1] - centre[1]};
    const double high[2] = {part->high[0] - centre[0], part->high[1] - centre[1]};
    double moment[3];
    disc_and_rectangle(low, high, radius, moment);
    return moment[0];
}

/* Where a load acts at a time: its patch on the face, and the centre for a disc. A point force is a patch of
 * the size of one cell that carries the force. */
struct patch {
    struct rectangle area;
    bool disc;
    double centre[2], radius;
    double traction; /* force per area for unit history */
};

static struct patch patch_at(const struct paper *paper, const struct load *load, double time)
{
    struct patch patch = {.area = whole_face(paper, load->face), .traction = load->amplitude};
    const struct rectangle whole = patch.area;
    if (load->shape == LOAD_FACE) return patch;
    double place[3], own[3];
    for (int c = 0; c < 3; c++)
        place[c] = load->centre[c] + load->velocity[c] * time;
    body_from_deck(&paper->model.scene->body, place, own);
    patch.disc = load->shape == LOAD_DISC;
    patch.radius = load->size[0] / 2;
    for (int k = 0; k < whole.axes; k++) {
        double size = load->size[patch.disc ? 0 : k];
        if (load->shape == LOAD_POINT) {
            size = paper->set.spacing[whole.axis[k]];
            patch.traction /= size;
        }
        patch.centre[k] = own[whole.axis[k]];
        patch.area.low[k] = patch.centre[k] - size / 2;
        patch.area.high[k] = patch.centre[k] + size / 2;
    }
    patch.area = clipped(patch.area, &whole);
    return patch;
}

/* Part of the patch that lies in a rectangle. */
static double covered(const struct patch *patch, const struct rectangle *part)
{
    const struct rectangle both = clipped(*part, &patch->area);
    return patch->disc ? area_in_disc(&both, patch->centre, patch->radius) : rectangle_area(&both);
}

/* Fraction of the element's cell (half a spacing to each side, within the face) that the patch covers;
 * without overlap weights: 1 for points inside the closed patch. */
static double covered_fraction(const struct paper *paper, const struct patch *patch,
                               const struct rectangle *whole, const double *own)
{
    struct rectangle cell = *whole;
    double reach = 0;
    bool inside = true;
    for (int k = 0; k < whole->axes; k++) {
        const double x = own[whole->axis[k]], half = paper->set.spacing[whole->axis[k]] / 2;
        cell.low[k] = x - half;
        cell.high[k] = x + half;
        const double slack = 1e-9 * half;
        inside = inside && x >= patch->area.low[k] - slack && x <= patch->area.high[k] + slack;
        reach += (x - patch->centre[k]) * (x - patch->centre[k]);
    }
    if (!paper->options.patch_overlap)
        return inside && (!patch->disc || reach <= patch->radius * patch->radius * (1 + 1e-9)) ? 1 : 0;
    cell = clipped(cell, whole);
    return covered(patch, &cell) / rectangle_area(&cell);
}

/* Shares of the elements at a time; with overlap weights scaled so that the sum of share times area is the
 * traction times the area of the patch. */
static void set_shares(const struct paper *paper, const struct load *load, double time,
                       struct paper_load *ready)
{
    const struct rectangle whole = whole_face(paper, load->face);
    const struct patch patch = patch_at(paper, load, time);
    double carried = 0;
    for (size_t k = 0; k < ready->elements; k++) {
        const struct surface_element *element = &paper->element[ready->element[k]];
        ready->share[k] =
            covered_fraction(paper, &patch, &whole, paper->set.own_position + 3 * element->point);
        carried += ready->share[k] * element->area;
    }
    const double area = covered(&patch, &patch.area);
    const double scale = paper->options.patch_overlap && carried > 0 ? area / carried : 1;
    for (size_t k = 0; k < ready->elements; k++)
        ready->share[k] *= scale * patch.traction;
}

static selas_status make_traction(struct paper *paper, const struct load *load, struct paper_load *ready,
                                  struct messages *messages)
{
    for (size_t e = 0; e < paper->elements; e++)
        ready->elements += paper->element[e].face == load->face;
    ready->element = array_new(ready->elements, sizeof *ready->element);
    ready->share = array_new(ready->elements, sizeof *ready->share);
    if (ready->element == NULL || ready->share == NULL)
        return fail(messages, SELAS_NO_MEMORY, "no memory for a load");
    size_t k = 0;
    for (size_t e = 0; e < paper->elements; e++)
        if (paper->element[e].face == load->face) ready->element[k++] = e;
    set_shares(paper, load, 0, ready);
    return SELAS_OK;
}

/* Force per volume at a point that sees the source at d = x_a - centre: a force F gives F W, a moment tensor
 * (body force -M_ij delta_,j) gives
 * -M_ij W_,j. */
static void push_of_source(const struct paper *paper, const struct load *load, const double d[3],
                           double *push)
{
    static const int place[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    const double r = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    const double value = kernel_value(paper->options.kernel, paper->dimension, r, paper->h);
    const double slope = kernel_derivative_over_r(paper->options.kernel, paper->dimension, r, paper->h);
    for (int i = 0; i < paper->dimension; i++) {
        push[i] = load->kind == LOAD_BODY_FORCE ? load->amplitude * load->direction[i] * value : 0;
        for (int j = 0; j < 3 && load->kind == LOAD_MOMENT_TENSOR; j++)
            push[i] -= load->amplitude * load->moment[place[i][j]] * slope * d[j];
    }
}

/* A point force's shares are scaled to the exact force; part of it lies across symmetry planes through it. */
static double force_scale(const struct paper *paper, const struct load *load, const struct paper_load *ready)
{
    if (load->kind != LOAD_BODY_FORCE || load->shape != LOAD_POINT) return 1;
    const struct scene *scene = paper->model.scene;
    double own[3], force = 0;
    body_from_deck(&scene->body, load->centre, own);
    const double wanted = load->amplitude * scene_carries(scene, own);
    for (size_t k = 0; k < ready->points; k++)
        for (int c = 0; c < paper->dimension; c++)
            force += paper->volume[ready->point[k]] * ready->push[k * (size_t)paper->dimension + (size_t)c] *
                     load->direction[c];
    return force > 0 ? wanted / force : 1;
}

static selas_status make_push(struct paper *paper, const struct load *load, struct paper_load *ready,
                              struct messages *messages)
{
    const bool everywhere = load->kind == LOAD_BODY_FORCE && load->shape != LOAD_POINT;
    const size_t dimension = (size_t)paper->dimension;
    ready->points = everywhere ? paper->set.points : neighbours_at(&paper->near, load->centre, 0, NULL);
    ready->point = array_new(ready->points, sizeof *ready->point);
    ready->push = array_new(dimension * ready->points, sizeof *ready->push);
    uint32_t *found = array_new(ready->points, sizeof *found);
    if (ready->point == NULL || ready->push == NULL || found == NULL) {
        array_free(found);
        return fail(messages, SELAS_NO_MEMORY, "no memory for a load");
    }
    if (!everywhere) neighbours_at(&paper->near, load->centre, ready->points, found);
    for (size_t k = 0; k < ready->points; k++) {
        const size_t point = ready->point[k] = everywhere ? k : found[k];
        double *push = ready->push + dimension * k, d[3];
        for (size_t c = 0; c < 3; c++)
            d[c] = paper->set.position[3 * point + c] - load->centre[c];
        if (everywhere)
            for (size_t c = 0; c < dimension; c++)
                push[c] = load->amplitude * load->direction[c];
        else
            push_of_source(paper, load, d, push);
    }
    array_free(found);
    const double scale = force_scale(paper, load, ready);
    for (size_t k = 0; k < dimension * ready->points; k++)
        ready->push[k] *= scale;
    return SELAS_OK;
}

/* Rows of Eq 19: which elements load which point and with what factor. */
static selas_status make_rows(struct paper *paper, struct messages *messages)
{
    const struct neighbours *near = &paper->near;
    const bool distributed = paper->options.load_distributed;
    paper->load_start = array_new(near->points + 1, sizeof *paper->load_start);
    if (paper->load_start == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the loads");
    for (size_t a = 0; a < near->points; a++) {
        size_t count = 0;
        for (size_t p = near->start[a]; p < near->start[a + 1]; p++)
            if (distributed || near->index[p] == a)
                count += paper->first_element[near->index[p] + 1] - paper->first_element[near->index[p]];
        paper->load_start[a + 1] = paper->load_start[a] + count;
    }
    const size_t total = paper->load_start[near->points];
    paper->load_element = array_new(total, sizeof *paper->load_element);
    paper->load_value = array_new(total, sizeof *paper->load_value);
    if (paper->load_element == NULL || paper->load_value == NULL)
        return fail(messages, SELAS_NO_MEMORY, "no memory for the loads");
    for (size_t a = 0; a < near->points; a++) {
        size_t row = paper->load_start[a];
        for (size_t p = near->start[a]; p < near->start[a + 1]; p++) {
            const size_t b = near->index[p];
            if (!distributed && b != a) continue;
            const double kernel = paper->alpha[a] * paper->kernel_volume[p] / paper->volume[b];
            for (size_t e = paper->first_element[b]; e < paper->first_element[b + 1]; e++, row++) {
                paper->load_element[row] = (uint32_t)e;
                paper->load_value[row] = distributed ? kernel * paper->element[e].area
                                                     : paper_face_sum(paper, a, paper->element[e].face);
            }
        }
    }
    return SELAS_OK;
}

selas_status paper_make_loads(struct paper *paper, struct messages *messages)
{
    const struct scene *scene = paper->model.scene;
    paper->load = array_new(scene->loads, sizeof *paper->load);
    if (paper->load == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the loads");
    selas_status status = make_rows(paper, messages);
    for (size_t k = 0; k < scene->loads && status == SELAS_OK; k++)
        status = scene->load[k].kind == LOAD_TRACTION
                     ? make_traction(paper, &scene->load[k], &paper->load[k], messages)
                     : make_push(paper, &scene->load[k], &paper->load[k], messages);
    return status;
}

void paper_free_loads(struct paper *paper)
{
    for (size_t k = 0; paper->load != NULL && k < paper->model.scene->loads; k++) {
        array_free(paper->load[k].element);
        array_free(paper->load[k].share);
        array_free(paper->load[k].point);
        array_free(paper->load[k].push);
    }
    array_free(paper->load);
    array_free(paper->load_start);
    array_free(paper->load_element);
    array_free(paper->load_value);
}

bool paper_tractions(struct paper *paper, const struct drive *drive)
{
    const struct scene *scene = paper->model.scene;
    bool any = false;
    if (drive->load == NULL) return false;
    for (size_t k = 0; k < scene->loads; k++)
        any = any || (scene->load[k].kind == LOAD_TRACTION && drive->load[k] != 0);
    if (!any) return false;
    for (size_t e = 0; e < 3 * paper->elements; e++)
        paper->traction[e] = 0;
    for (size_t k = 0; k < scene->loads; k++) {
        const struct load *load = &scene->load[k];
        struct paper_load *ready = &paper->load[k];
        if (load->kind != LOAD_TRACTION || drive->load[k] == 0) continue;
        if (load_moves(load)) set_shares(paper, load, drive->time, ready);
        for (size_t i = 0; i < ready->elements; i++)
            for (size_t c = 0; c < 3; c++)
                paper->traction[3 * ready->element[i] + c] +=
                    drive->load[k] * ready->share[i] * load->direction[c];
    }
    return true;
}

void paper_point_loads(const struct paper *paper, const struct drive *drive, double *force)
{
    const size_t dimension = (size_t)paper->dimension;
    if (drive->load == NULL) return;
    for (size_t k = 0; k < paper->model.scene->loads; k++) {
        const struct paper_load *ready = &paper->load[k];
        for (size_t i = 0; i < ready->points; i++)
            for (size_t c = 0; c < dimension; c++)
                force[dimension * ready->point[i] + c] += drive->load[k] * ready->push[dimension * i + c];
    }
}
