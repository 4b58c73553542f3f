/* Hourglass control of updated-Lagrangian SPH (derived: Eq 4 of doc/theory/sph-total-lagrangian.md with the
 * neighbours of now).
 *
 * The velocity gradient of Eq 12 does not see motions that alternate from particle to particle, so that no
 * stress resists them: they drift until the particles are in disorder. The displacement u is part of the
 * state; with g = grad u taken as grad v is, w_ij = -W'(r_ij)/r_ij and d_ij = x_j - x_i,
 *
 *   e_ij = u_j - u_i - 1/2 (g_i + g_j) d_ij,      E = 1/4 xi (lambda + 2 mu) sum_ij V_i V_j w_ij |e_ij|^2
 *
 * e vanishes for every displacement linear in x, rigid rotation included. The force is the whole derivative
 * at fixed w and d, the part through g too (without it the control pushes at free faces, where g is wrong for
 * quadratic fields, and slows the beam down):
 *
 *   rho_i dv_i/dt += sum_j V_j w_ij (k e_ij - 1/2 (B_i + B_j) d_ij),
 *   B_i = k sum_j V_j w_ij e_ij d_ij^T L_i^-1,    k = xi (lambda + 2 mu)
 *
 * With forces = 'adjoint' B_i takes -2 s_i L_i^-1 too: the stresses then act by the adjoint of grad v (U12 of
 * doc/theory/sph-updated-lagrangian.md), and updated_rate leaves them out of Eq 19. Ghosts of walls count, those of
 * tractions do not deform. */
#include "base/machine.h"
#include "base/memory.h"
#include "method/updated_lagrangian/updated_lagrangian.h"

#include <math.h>
#include <string.h>

struct updated_hourglass {
    double *packed;   /* [2 * dimension * places] place and displacement */
    double *gradient; /* [dimension^2 * places] g; row: component of u */
    double *inverse;  /* [dimension^2 * points] of L */
    double *turned;   /* [dimension^2 * places] B */
    double *weight;   /* [pairs] V_j w_ij, 0 out of reach */
    size_t room;      /* of weight */
};

selas_status updated_hourglass_new(struct updated *updated, struct messages *messages)
{
    updated->hourglass = array_new(1, sizeof *updated->hourglass);
    if (updated->hourglass == NULL || !updated_hourglass_room(updated) || !updated_hourglass_weights(updated))
        return fail(messages, SELAS_NO_MEMORY, "no memory for hourglass control of %zu particles",
                    updated->points);
    return SELAS_OK;
}

bool updated_hourglass_room(const struct updated *updated)
{
    struct updated_hourglass *all = updated->hourglass;
    const size_t points = updated->points, places = points + updated->ghosts,
                 dimension = (size_t)updated->dimension, square = dimension * dimension;
    if (all == NULL) return true;
    double **const arrays[] = {&all->packed, &all->gradient, &all->turned, &all->inverse};
    const size_t counts[] = {2 * dimension * places, square * places, square * places, square * points};
    bool room = true;
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++) {
        array_free(*arrays[k]);
        *arrays[k] = array_new(counts[k], sizeof(double));
        room = room && *arrays[k] != NULL;
    }
    return room;
}

/* The lists grow and shrink. */
bool updated_hourglass_weights(const struct updated *updated)
{
    struct updated_hourglass *all = updated->hourglass;
    const size_t pairs = updated->neighbours.start[updated->points];
    if (all == NULL || pairs <= all->room) return true;
    array_free(all->weight);
    all->room = pairs + pairs / 8;
    all->weight = array_new(all->room, sizeof(double));
    if (all->weight == NULL) all->room = 0;
    return all->weight != NULL;
}

void updated_hourglass_free(struct updated_hourglass *all)
{
    if (all == NULL) return;
    array_free(all->packed);
    array_free(all->gradient);
    array_free(all->inverse);
    array_free(all->turned);
    array_free(all->weight);
    array_free(all);
}

size_t updated_hourglass_bytes(const struct updated *updated)
{
    if (updated->hourglass == NULL) return 0;
    const size_t dimension = (size_t)updated->dimension;
    return sizeof(double) *
           ((updated->points + updated->ghosts) * dimension * (2 + 3 * dimension) + updated->hourglass->room);
}

/* What the control acts on: the displacement, or the velocity while the spectrum is measured at rest. */
static void pack_motion(const struct updated *updated, size_t place)
{
    const size_t dimension = (size_t)updated->dimension;
    const double *from = updated_packed(updated, place);
    const size_t step = updated_step(updated);
    double *packed = updated->hourglass->packed + 2 * dimension * place;
    for (size_t a = 0; a < dimension; a++) {
        packed[a] = from[step * a];
        packed[dimension + a] = updated->velocities_displace ? from[step * (updated->layout.velocity + a)]
                                                             : packed[a] - updated->reference[3 * place + a];
    }
}

/* V_j w_ij of all pairs of particle i. */
INLINED void weigh_pairs(const struct updated *updated, const int dimension, size_t i)
{
    const struct updated_layout layout = updated->layout;
    const double *own = updated_packed(updated, i);
    const size_t step = updated_step(updated);
    double *weight = updated->hourglass->weight;
    for (size_t k = updated->neighbours.start[i]; k < updated->neighbours.start[i + 1]; k++) {
        const double *other = updated_packed(updated, updated->neighbours.index[k]);
        double square = 0;
        for (size_t a = 0; a < (size_t)dimension; a++)
            square += (other[step * a] - own[step * a]) * (other[step * a] - own[step * a]);
        const double length = (own[step * layout.length] + other[step * layout.length]) / 2;
        const double reach = updated->reach * length;
        weight[k] = 0;
        if (!(square < reach * reach)) continue;
        const double q = sqrt(square) / (updated->smoothing_length * length);
        double slope = updated->slope_scale * updated->options.kernel->slope_over_q(dimension, q);
        for (int power = 0; !updated->even && power < dimension + 2; power++)
            slope /= length;
        weight[k] = -other[step * layout.span] * slope;
    }
}

/* g_i and the inverse of L_i. */
INLINED void take_gradient(const struct updated *updated, const int dimension, size_t i)
{
    struct updated_hourglass *all = updated->hourglass;
    const size_t dim = (size_t)dimension;
    const double *own = all->packed + 2 * dim * i;
    double matrix[6] = {0}, sum[3][3] = {{0}}, inverse[3][3];
    for (size_t k = updated->neighbours.start[i]; k < updated->neighbours.start[i + 1]; k++) {
        const double *other = all->packed + 2 * dim * updated->neighbours.index[k];
        for (int b = 0; b < dimension; b++) {
            const double part = all->weight[k] * (other[b] - own[b]);
            for (int a = 0; a < dimension; a++)
                sum[a][b] += part * (other[dimension + a] - own[dimension + a]);
            for (int a = 0; a <= b; a++)
                matrix[updated_component[dimension][a][b]] += part * (other[a] - own[a]);
        }
    }
    updated_invert(dimension, matrix, inverse);
    for (int a = 0; a < dimension; a++)
        for (int b = 0; b < dimension; b++) {
            const size_t entry = dim * dim * i + dim * (size_t)a + (size_t)b;
            double total = 0;
            for (int c = 0; c < dimension; c++)
                total += sum[a][c] * inverse[c][b];
            all->gradient[entry] = total;
            all->inverse[entry] = inverse[a][b];
        }
}

/* The matrix of a wall's ghost, g or B: T g R, R the reflection, T = -1 without slip, R with slip. */
static void mirror_matrix(const struct updated *updated, double *matrices, size_t g)
{
    const struct updated_ghost *ghost = &updated->ghost[g];
    const size_t dimension = (size_t)updated->dimension, square = dimension * dimension;
    double *image = matrices + square * (updated->points + g);
    memcpy(image, matrices + square * ghost->source, square * sizeof *image);
    for (int f = 0; f < ghost->count; f++) {
        const size_t axis = (size_t)face_axis((enum face)ghost->face[f]);
        const bool stick = updated->wall[ghost->face[f]] == WALL_STICK;
        for (size_t a = 0; a < dimension; a++)
            for (size_t b = 0; b < dimension; b++)
                if ((stick || a == axis) != (b == axis)) image[dimension * a + b] *= -1;
    }
}

/* The direct part of the force of particle i, and B_i. */
INLINED void push_pairs(const struct updated *updated, const int dimension, size_t i, const double *y,
                        double *acceleration)
{
    struct updated_hourglass *all = updated->hourglass;
    const size_t dim = (size_t)dimension, square = dim * dim;
    const double modulus =
        updated->options.hourglass * (updated->material->plane_lambda + 2 * updated->material->mu);
    const double *own = all->packed + 2 * dim * i, *g = all->gradient + square * i;
    double force[3] = {0}, sum[3][3] = {{0}};
    for (size_t k = updated->neighbours.start[i]; k < updated->neighbours.start[i + 1]; k++) {
        const size_t j = updated->neighbours.index[k];
        const double *other = all->packed + 2 * dim * j, *h = all->gradient + square * j;
        for (int a = 0; a < dimension; a++) {
            double unseen = other[dimension + a] - own[dimension + a];
            for (int b = 0; b < dimension; b++)
                unseen -= (g[dimension * a + b] + h[dimension * a + b]) / 2 * (other[b] - own[b]);
            unseen *= all->weight[k];
            force[a] += unseen;
            for (int b = 0; b < dimension; b++)
                sum[a][b] += unseen * (other[b] - own[b]);
        }
    }
    const double density = updated_packed(updated, i)[updated_step(updated) * updated->layout.density];
    const double *inverse = all->inverse + square * i;
    const size_t row = updated_row(updated, i);
    const double *stress = y + 2 * updated->model.unknowns + updated->held + (size_t)updated->stresses * row;
    for (int a = 0; a < dimension; a++) {
        acceleration[dim * row + (size_t)a] += modulus / density * force[a];
        for (int b = 0; b < dimension; b++) {
            double total = 0;
            for (int c = 0; c < dimension; c++)
                total += (modulus * sum[a][c] -
                          (updated->options.adjoint ? 2 * stress[updated_component[dimension][a][c]] : 0)) *
                         inverse[dimension * c + b];
            all->turned[square * i + dim * (size_t)a + (size_t)b] = total;
        }
    }
}

/* The part of the force that returns through the gradients. */
INLINED void return_pairs(const struct updated *updated, const int dimension, size_t i, double *acceleration)
{
    const struct updated_hourglass *all = updated->hourglass;
    const size_t dim = (size_t)dimension, square = dim * dim;
    const double *own = all->packed + 2 * dim * i, *turned = all->turned + square * i;
    double force[3] = {0};
    for (size_t k = updated->neighbours.start[i]; k < updated->neighbours.start[i + 1]; k++) {
        const size_t j = updated->neighbours.index[k];
        const double *other = all->packed + 2 * dim * j, *theirs = all->turned + square * j;
        for (int b = 0; b < dimension; b++) {
            const double part = all->weight[k] * (other[b] - own[b]);
            for (int a = 0; a < dimension; a++)
                force[a] += part * (turned[dimension * a + b] + theirs[dimension * a + b]);
        }
    }
    const double density = updated_packed(updated, i)[updated_step(updated) * updated->layout.density];
    for (int a = 0; a < dimension; a++)
        acceleration[dim * updated_row(updated, i) + (size_t)a] -= force[a] / (2 * density);
}

/* Instances with constant dimension: of particles first ... last - 1. */
enum { BLOCK = 64 };
#define INSTANCES(dimension)                                                                                 \
    static void gradients_##dimension(const struct updated *updated, size_t first, size_t last)              \
    {                                                                                                        \
        for (size_t i = first; i < last; i++) {                                                              \
            weigh_pairs(updated, dimension, i);                                                              \
            take_gradient(updated, dimension, i);                                                            \
        }                                                                                                    \
    }                                                                                                        \
    static void pushes_##dimension(const struct updated *updated, size_t first, size_t last,                 \
                                   const double *y, double *acceleration)                                    \
    {                                                                                                        \
        for (size_t i = first; i < last; i++)                                                                \
            push_pairs(updated, dimension, i, y, acceleration);                                              \
    }                                                                                                        \
    static void returns_##dimension(const struct updated *updated, size_t first, size_t last,                \
                                    double *acceleration)                                                    \
    {                                                                                                        \
        for (size_t i = first; i < last; i++)                                                                \
            return_pairs(updated, dimension, i, acceleration);                                               \
    }
INSTANCES(1)
INSTANCES(2)
INSTANCES(3)
#undef INSTANCES

enum pass { GRADIENTS, PUSHES, RETURNS };

static void one_pass(const struct updated *updated, enum pass pass, const double *y, double *acceleration)
{
    const size_t blocks = (updated->own + BLOCK - 1) / BLOCK, end = updated->from + updated->own;
    const int dimension = updated->dimension;
#pragma omp parallel for schedule(static) if (updated->own >= UPDATED_PARALLEL)
    for (size_t block = 0; block < blocks; block++) {
        const size_t first = updated->from + BLOCK * block, last = first + BLOCK < end ? first + BLOCK : end;
        if (pass == GRADIENTS)
            (dimension == 1 ? gradients_1 : dimension == 2 ? gradients_2 : gradients_3)(updated, first, last);
        else if (pass == PUSHES)
            (dimension == 1   ? pushes_1
             : dimension == 2 ? pushes_2
                              : pushes_3)(updated, first, last, y, acceleration);
        else
            (dimension == 1   ? returns_1
             : dimension == 2 ? returns_2
                              : returns_3)(updated, first, last, acceleration);
    }
}

/* Own particles have a matrix, g or B; their images get it, and those of others and theirs. */
static void complete(const struct updated *updated, double *matrices)
{
    const size_t dimension = (size_t)updated->dimension;
    updated_bring(updated, dimension * dimension, matrices);
    for (size_t g = 0; g < updated->ghosts; g++)
        mirror_matrix(updated, matrices, g);
}

void updated_add_hourglass(struct updated *updated, const double *y, double *acceleration)
{
    const size_t places = updated->points + updated->ghosts;
    for (size_t place = 0; place < places; place++)
        pack_motion(updated, place);
    one_pass(updated, GRADIENTS, y, acceleration);
    complete(updated, updated->hourglass->gradient);
    one_pass(updated, PUSHES, y, acceleration);
    complete(updated, updated->hourglass->turned);
    one_pass(updated, RETURNS, y, acceleration);
}
