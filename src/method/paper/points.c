/* Surface elements, statistical volumes and areas, kernel correction: Ding et al. 2006, Eqs 4, 20, 24-29. */
#include "base/memory.h"
#include "method/paper/paper.h"

#include <math.h>

/* Outward normals of the faces in deck coordinates. */
static void set_normals(struct paper *paper)
{
    const struct body *body = &paper->model.scene->body;
    for (enum face face = FACE_X_LOW; (int)face < 2 * paper->dimension; face++) {
        double own[3] = {0};
        own[face_axis(face)] = face_sign(face);
        if (body->rotated)
            body_direction_to_deck(body, own, paper->face_normal[face]);
        else
            for (int c = 0; c < 3; c++)
                paper->face_normal[face][c] = own[c];
    }
}

selas_status paper_make_elements(struct paper *paper, struct messages *messages)
{
    const struct point_set *set = &paper->set;
    size_t count = 0;
    for (size_t i = 0; i < set->points; i++)
        count += (size_t)faces_count(set->faces[i]);
    paper->elements = count;
    paper->element = array_new(count, sizeof *paper->element);
    paper->first_element = array_new(set->points + 1, sizeof *paper->first_element);
    paper->traction = array_new(3 * count, sizeof *paper->traction);
    if (paper->element == NULL || paper->first_element == NULL || paper->traction == NULL)
        return fail(messages, SELAS_NO_MEMORY, "no memory for %zu surface elements", count);
    set_normals(paper);
    size_t e = 0;
    for (size_t i = 0; i < set->points; i++) {
        paper->first_element[i] = e;
        for (enum face face = FACE_X_LOW; (int)face < BOX_FACES; face++) {
            if ((set->faces[i] >> face & 1) == 0) continue;
            paper->element[e].point = (uint32_t)i;
            paper->element[e].face = face;
            for (int c = 0; c < 3; c++)
                paper->element[e].normal[c] = paper->face_normal[face][c];
            e++;
        }
    }
    paper->first_element[set->points] = e;
    return SELAS_OK;
}

static double pair_kernel(const struct paper *paper, size_t a, size_t b)
{
    double square = 0;
    for (size_t c = 0; c < (size_t)paper->dimension; c++)
        square += pow(paper->set.position[3 * a + c] - paper->set.position[3 * b + c], 2);
    return kernel_value(paper->options.kernel, paper->dimension, sqrt(square), paper->h);
}

/* Eq 25: V_a = F^V / sum of W_ab; F^V = 1/2, 1/4, 1/8 on a face, an edge, a corner (right angles). */
static void set_volumes(struct paper *paper)
{
    const struct neighbours *near = &paper->near;
#pragma omp parallel for schedule(static)
    for (size_t a = 0; a < near->points; a++) {
        double sum = 0;
        for (size_t p = near->start[a]; p < near->start[a + 1]; p++)
            sum += pair_kernel(paper, a, near->index[p]);
        const int faces = faces_count(paper->set.faces[a]);
        paper->volume[a] = (paper->options.volume_factors ? ldexp(1, -faces) : 1) / sum;
    }
}

/* Sum of W_ab over the points b of one face. */
static double face_kernel_sum(const struct paper *paper, size_t a, enum face face)
{
    double sum = 0;
    for (size_t p = paper->near.start[a]; p < paper->near.start[a + 1]; p++) {
        const size_t b = paper->near.index[p];
        if ((paper->set.faces[b] >> face & 1) != 0) sum += pair_kernel(paper, a, b);
    }
    return sum;
}

/* Eq 27 face by face: A = F^A / (S_a sum of W_ab), F^A = 1, 1/2, 1/4 inside the face, on its edges, at its
 * corners. */
static void set_areas(struct paper *paper)
{
    const double plane = kernel_plane_factor(paper->options.kernel, paper->dimension, paper->h);
#pragma omp parallel for schedule(static)
    for (size_t e = 0; e < paper->elements; e++) {
        struct surface_element *element = &paper->element[e];
        const int faces = faces_count(paper->set.faces[element->point]);
        const double factor = paper->options.area_factors ? ldexp(1, 1 - faces) : 1;
        element->area = factor / (plane * face_kernel_sum(paper, element->point, element->face));
    }
}

/* Eq 29 at boundary points; W_ab V_b of all pairs. */
static void set_correction(struct paper *paper)
{
    const struct neighbours *near = &paper->near;
#pragma omp parallel for schedule(static)
    for (size_t a = 0; a < near->points; a++) {
        double sum = 0;
        for (size_t p = near->start[a]; p < near->start[a + 1]; p++) {
            const size_t b = near->index[p];
            paper->kernel_volume[p] = pair_kernel(paper, a, b) * paper->volume[b];
            sum += paper->kernel_volume[p];
        }
        const bool corrected = paper->options.kernel_correction && paper->set.faces[a] != 0;
        paper->alpha[a] = corrected ? 1 / sum : 1;
        paper->whole[a] = corrected ? 1 : sum;
    }
}

selas_status paper_make_statistics(struct paper *paper, struct messages *messages)
{
    const size_t points = paper->set.points;
    const double radius = paper->options.kernel->support * paper->h;
    const selas_status status =
        neighbours_find(&paper->near, paper->dimension, points, paper->set.position, radius, true, messages);
    if (status != SELAS_OK) return status;
    paper->volume = array_new(points, sizeof *paper->volume);
    paper->alpha = array_new(points, sizeof *paper->alpha);
    paper->whole = array_new(points, sizeof *paper->whole);
    paper->kernel_volume = array_new(paper->near.start[points], sizeof *paper->kernel_volume);
    if (paper->volume == NULL || paper->alpha == NULL || paper->whole == NULL || paper->kernel_volume == NULL)
        return fail(messages, SELAS_NO_MEMORY, "no memory for the volumes of %zu points", points);
    set_volumes(paper);
    set_areas(paper);
    set_correction(paper);
    return SELAS_OK;
}

double paper_face_sum(const struct paper *paper, size_t point, enum face face)
{
    double sum = 0;
    for (size_t p = paper->near.start[point]; p < paper->near.start[point + 1]; p++) {
        const size_t b = paper->near.index[p];
        for (size_t e = paper->first_element[b]; e < paper->first_element[b + 1]; e++)
            if (paper->element[e].face == face)
                sum += paper->kernel_volume[p] / paper->volume[b] * paper->element[e].area;
    }
    return paper->alpha[point] * sum;
}
