/* Weights of many materials along few directions (doc/theory/damping.md, section 3). A modulus of a material, kappa
 * or mu, is a column of weights, one for each mechanism; a run needs an operator for each direction in which
 * columns lie apart. Weights for unlike Q are nearly a constant and one more direction times 1/Q: columns
 * are brought into the least affine space in which none of them moves by more than a small part of what
 * mechanisms are off anyway. */
#include "damping/directions.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

/* Of a column, as a share of the misfit of the mechanisms. */
static const double allowed = 1. / 3;

struct space {
    const struct ground_damping *damping;
    size_t mechanisms, columns, directions;
    struct damping_column *column; /* kappa, mu of each material */
    double origin[MOST_MECHANISMS], direction[MOST_MECHANISMS][MOST_MECHANISMS];
};

static double dot(size_t n, const double *a, const double *b)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

/* What weights do over the band: root mean square of sum over l of Y_l r_l/(r_l + i w), weighed by the band. */
static double effect(const struct ground_damping *damping, const double weight[MOST_MECHANISMS])
{
    const struct relaxation_band *band = &damping->band;
    double sum = 0, all = 0;
    for (size_t k = 0; k < RELAXATION_SAMPLES; k++) {
        double complex one = 0;
        for (size_t l = 0; l < damping->mechanisms; l++)
            one += weight[l] * damping->rate[l] / (damping->rate[l] + I * band->angular_frequency[k]);
        sum += band->weight[k] * creal(one * conj(one));
        all += band->weight[k];
    }
    return sqrt(sum / all);
}

/* What of a column lies beside the space. */
static void beside(const struct space *space, const struct damping_column *column,
                   double off[MOST_MECHANISMS])
{
    const size_t n = space->mechanisms;
    for (size_t l = 0; l < n; l++)
        off[l] = column->weight[l] - space->origin[l];
    for (size_t d = 0; d < space->directions; d++) {
        const double share = dot(n, off, space->direction[d]);
        for (size_t l = 0; l < n; l++)
            off[l] -= share * space->direction[d][l];
    }
}

/* How far a column would move, over its length; infinite if a weight would become negative. */
static double moves(const struct space *space, const struct damping_column *column)
{
    double off[MOST_MECHANISMS];
    const size_t n = space->mechanisms;
    beside(space, column, off);
    for (size_t l = 0; l < n; l++)
        if (column->weight[l] - off[l] < -1e-12 * column->length) return INFINITY;
    return column->length > 0 ? effect(space->damping, off) / column->length : 0;
}

/* Directions until no column moves by more than `most` of itself. */
static void find_directions(struct space *space, double most)
{
    while (space->directions < space->mechanisms) {
        double off[MOST_MECHANISMS], best[MOST_MECHANISMS] = {0}, largest = 0, worst = 0;
        for (size_t i = 0; i < space->columns; i++) {
            const double moved = moves(space, &space->column[i]);
            worst = fmax(worst, moved);
            beside(space, &space->column[i], off);
            const double size = dot(space->mechanisms, off, off);
            if (size <= largest || !(moved > most)) continue;
            largest = size;
            memcpy(best, off, sizeof best);
        }
        if (!(worst > most) || !(largest > 0)) return;
        double *direction = space->direction[space->directions++];
        for (size_t l = 0; l < space->mechanisms; l++)
            direction[l] = best[l] / sqrt(largest);
    }
}

/* sqrt(density) times the slowness at an angular frequency of kappa + 4/3 mu with these sizes. */
static double slowness(const struct modulus *bulk, double size, const struct modulus *shear,
                       double angular_frequency)
{
    struct modulus scaled = *bulk;
    scaled.size = size;
    const double complex s = I * angular_frequency;
    return creal(1 / csqrt(modulus_at(&scaled, s) + 4. / 3 * modulus_at(shear, s)));
}

/* Moduli of a material with these weights and the phase speeds that the fitted ones have. */
static void set_moduli(size_t n, const struct damping_column column[2], double angular_frequency,
                       struct damped_moduli *fitted)
{
    struct modulus bulk = fitted->axial, shear = fitted->shear;
    const double complex s = I * angular_frequency;
    const double slow[2] = {creal(1 / csqrt(modulus_at(&fitted->axial, s))),
                            creal(1 / csqrt(modulus_at(&fitted->shear, s)))};
    memcpy(bulk.weight, column[0].weight, n * sizeof *bulk.weight);
    memcpy(shear.weight, column[1].weight, n * sizeof *shear.weight);
    const double now = creal(1 / csqrt(modulus_at(&shear, s)));
    shear.size *= now * now / (slow[1] * slow[1]);
    double size = column[0].size, before = 1.001 * size;
    double off = slowness(&bulk, size, &shear, angular_frequency) - slow[0];
    double off_before = slowness(&bulk, before, &shear, angular_frequency) - slow[0];
    for (int turn = 0; turn < 20 && fabs(off) > 1e-15 * slow[0] && off != off_before; turn++) { /* secants */
        const double next = size - off * (size - before) / (off - off_before);
        before = size;
        off_before = off;
        size = next;
        off = slowness(&bulk, size, &shear, angular_frequency) - slow[0];
    }
    fitted->shear = shear;
    fitted->axial.size = size + 4. / 3 * shear.size;
    for (size_t l = 0; l < n; l++)
        fitted->axial.weight[l] =
            (size * bulk.weight[l] + 4. / 3 * shear.size * shear.weight[l]) / fitted->axial.size;
}

void damping_columns(size_t mechanisms, const struct damped_moduli *moduli, struct damping_column column[2])
{
    const struct modulus *axial = &moduli->axial, *shear = &moduli->shear;
    column[0] = (struct damping_column){.size = axial->size - 4. / 3 * shear->size};
    column[1] = (struct damping_column){.size = shear->size};
    for (size_t l = 0; l < mechanisms && shear->mechanisms > 0; l++) {
        column[1].weight[l] = shear->weight[l];
        column[0].weight[l] =
            (axial->size * axial->weight[l] - 4. / 3 * shear->size * shear->weight[l]) / column[0].size;
    }
}

/* A bulk modulus with as good as no damping has none. */
static void set_columns(const struct ground_damping *damping, const struct damped_moduli *moduli, double most,
                        struct damping_column column[2])
{
    damping_columns(damping->mechanisms, moduli, column);
    column[1].length = effect(damping, column[1].weight);
    column[0].length = effect(damping, column[0].weight);
    const double whole = column[0].length + 4. / 3 * column[1].size / column[0].size * column[1].length;
    if (column[0].length <= most * whole) memset(column[0].weight, 0, sizeof column[0].weight);
    column[0].length = whole;
}

selas_status damping_directions(struct ground_damping *damping, struct messages *messages)
{
    const size_t n = damping->mechanisms;
    struct space space = {.damping = damping, .mechanisms = n, .columns = 2 * damping->materials};
    const double most = allowed * damping->misfit;
    bool undamped = false;
    space.column = array_new(space.columns, sizeof *space.column);
    if (space.column == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for damped materials");
    for (size_t i = 0; i < damping->materials; i++) {
        set_columns(damping, &damping->fitted[i], most, &space.column[2 * i]);
        undamped = undamped || dot(n, space.column[2 * i].weight, space.column[2 * i].weight) == 0;
    }
    if (!undamped) memcpy(space.origin, space.column[1].weight, sizeof space.origin);
    find_directions(&space, most);
    for (size_t i = 0; i < damping->materials && space.directions < n; i++) {
        double off[MOST_MECHANISMS] = {0};
        if (damping->fitted[i].shear.mechanisms == 0) continue;
        for (size_t c = 0; c < 2; c++) {
            beside(&space, &space.column[2 * i + c], off);
            for (size_t l = 0; l < n; l++)
                space.column[2 * i + c].weight[l] = fmax(space.column[2 * i + c].weight[l] - off[l], 0);
        }
        const double reference = damping->wanted[i].shear.angular_frequency;
        set_moduli(n, &space.column[2 * i], relaxation_held(&damping->band, reference), &damping->fitted[i]);
    }
    array_free(space.column);
    return SELAS_OK;
}
