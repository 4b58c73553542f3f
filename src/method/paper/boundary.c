/* Boundary conditions of the published method: Lysmer-Kuhlemeyer dampers (Ding et al. 2006, Eqs 31-34) and
 * prescribed components.
 *
 * Eq 33 as printed feeds energy in and has lost the density of Eq 32; what is meant is
 *
 *   rho u'' + rho C v alpha_a sum(W_ab A_b) = ...,   C = c_p n n^T + c_s (1 - n n^T)
 *
 * with v central in time. On edges and corners the dampers of all transmitting faces add; instead of turning
 * to local axes (R_a) the dim x dim matrix is kept in deck coordinates. Prescribed displacements are set at
 * the points themselves instead of by the sum of Eq 30, which would smooth them. */
#include "base/memory.h"
#include "method/paper/paper.h"
#include "scene/initial.h"

#include <math.h>

/* Faces of a point that need something of the method (CAN_...). */
static unsigned faces_that(const struct paper *paper, size_t point, unsigned needs)
{
    unsigned mask = 0;
    for (unsigned face = 0; face < BOX_FACES; face++)
        if ((paper->set.faces[point] >> face & 1) != 0 &&
            (boundary_needs(&paper->model.scene->boundary[face]) & needs) != 0)
            mask |= 1u << face;
    return mask;
}

static void add_damper(const struct paper *paper, size_t point, enum face face, double matrix[9])
{
    const struct boundary *boundary = &paper->model.scene->boundary[face];
    const double *n = paper->face_normal[face];
    const double share = paper_face_sum(paper, point, face);
    const double normal = boundary->normal_factor * paper->material->p_speed * share;
    const double shear = boundary->shear_factor * paper->material->s_speed * share;
    const size_t dimension = (size_t)paper->dimension;
    for (size_t i = 0; i < dimension; i++)
        for (size_t k = 0; k < dimension; k++)
            matrix[i * dimension + k] += (normal - shear) * n[i] * n[k] + (i == k ? shear : 0);
}

/* Marks component `axis` (of the body's frame) as held by a face; what holds at rest or moves wins over
 * nothing, a moving face wins over one at rest. */
static void hold(struct constraint *constraint, int axis, enum face face, double factor)
{
    if (constraint->held[axis] && constraint->factor[axis] != 0) return;
    constraint->held[axis] = true;
    constraint->face[axis] = face;
    constraint->factor[axis] = factor;
}

static void add_constraint(const struct paper *paper, enum face face, struct constraint *constraint)
{
    const struct scene *scene = paper->model.scene;
    const struct boundary *boundary = &scene->boundary[face];
    double own[3] = {0};
    if (boundary_moves(boundary)) body_direction_from_deck(&scene->body, boundary->direction, own);
    for (int axis = 0; axis < paper->dimension; axis++)
        if (face_holds(scene, face, axis)) hold(constraint, axis, face, boundary->amplitude * own[axis]);
}

selas_status paper_make_boundary(struct paper *paper, struct messages *messages)
{
    const size_t points = paper->set.points;
    for (size_t i = 0; i < points; i++) {
        paper->dampers += faces_that(paper, i, CAN_DAMP) != 0;
        paper->constraints += faces_that(paper, i, CAN_HOLD) != 0;
    }
    paper->damper = array_new(paper->dampers, sizeof *paper->damper);
    paper->constraint = array_new(paper->constraints, sizeof *paper->constraint);
    paper->told = array_new(points, sizeof *paper->told);
    if (paper->damper == NULL || paper->constraint == NULL || paper->told == NULL)
        return fail(messages, SELAS_NO_MEMORY, "no memory for the boundary points");
    size_t damper = 0, constraint = 0;
    for (size_t i = 0; i < points; i++) {
        const unsigned damping = faces_that(paper, i, CAN_DAMP), holding = faces_that(paper, i, CAN_HOLD);
        if (damping != 0) paper->damper[damper].point = i;
        if (holding != 0) paper->constraint[constraint].point = i;
        for (enum face face = FACE_X_LOW; (int)face < BOX_FACES; face++) {
            if ((damping >> face & 1) != 0) add_damper(paper, i, face, paper->damper[damper].matrix);
            if ((holding >> face & 1) != 0) add_constraint(paper, face, &paper->constraint[constraint]);
        }
        paper->told[i] = holding != 0;
        for (int c = 0; c < paper->dimension && holding != 0; c++)
            paper->told[i] = paper->told[i] && paper->constraint[constraint].held[c];
        damper += damping != 0;
        constraint += holding != 0;
    }
    paper->model.damped = paper->dampers > 0;
    return SELAS_OK;
}

void paper_hold(const struct paper *paper, const struct constraint *constraint, const double wanted[3],
                double *field)
{
    const struct body *body = &paper->model.scene->body;
    double *value = field + (size_t)paper->dimension * constraint->point;
    double deck[3] = {0}, own[3];
    for (int c = 0; c < paper->dimension; c++)
        deck[c] = value[c];
    body_direction_from_deck(body, deck, own);
    for (int c = 0; c < paper->dimension; c++)
        if (constraint->held[c]) own[c] = wanted[c];
    body_direction_to_deck(body, own, deck);
    for (int c = 0; c < paper->dimension; c++)
        value[c] = deck[c];
}

void paper_initialise(struct model *model, double *y)
{
    const struct paper *paper = (const struct paper *)model;
    const struct scene *scene = model->scene;
    const size_t dimension = (size_t)paper->dimension;
    for (size_t i = 0; i < model->points; i++) {
        double value[2][3];
        initial_at(scene, paper->set.position + 3 * i, value[0], value[1]);
        for (size_t order = 0; order < 2; order++)
            for (size_t c = 0; c < dimension; c++)
                y[order * model->unknowns + dimension * i + c] = value[order][c];
    }
    for (size_t k = 0; k < paper->constraints; k++) {
        const struct constraint *constraint = &paper->constraint[k];
        for (int order = 0; order < 2; order++) {
            double wanted[3] = {0};
            for (int c = 0; c < paper->dimension; c++)
                if (constraint->held[c])
                    wanted[c] = constraint->factor[c] *
                                boundary_displacement(&scene->boundary[constraint->face[c]], 0, order);
            paper_hold(paper, constraint, wanted, y + (size_t)order * model->unknowns);
        }
    }
}
