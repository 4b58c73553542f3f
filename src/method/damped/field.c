/* Damped ground from a model (doc/theory/damping.md, section 7): each of its values gets unrelaxed speeds and the
 * parts' shares of its moduli. Weights of lambda + 2 mu and mu are those of their Q, brought into the space that the
 * parts span; those of kappa are what is left of them, and where one of them would be negative, mixed with the mean of
 * all columns. */
#include "method/damped/damped.h"

#include "base/memory.h"
#include "damping/directions.h"
#include "scene/ground.h"
#include "scene/model_pieces.h"

#include <math.h>
#include <string.h>

enum { AXIAL, SHEAR, BULK };

struct fitting {
    const struct damped *d;
    const struct ground_model *given;
    struct damping_curve curve;
    double inside[MOST_MECHANISMS]; /* a column of the space whose weights are all positive or 0 */
    struct modulus modulus;         /* of size 1, for its rates */
    double reference, held; /* angular frequencies: of the values' speeds; where these are kept (Eq 8) */
};

static double dot(size_t n, const double *a, const double *b)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

/* Brings weights into the space of the parts. */
static void project(const struct fitting *fitting, double weight[MOST_MECHANISMS])
{
    const struct damped *d = fitting->d;
    const size_t n = d->damping->mechanisms;
    double off[MOST_MECHANISMS];
    for (size_t l = 0; l < n; l++) {
        off[l] = weight[l] - d->part[0].memory[l];
        weight[l] = d->part[0].memory[l];
    }
    for (size_t p = 1; p < d->parts; p++) {
        const double share = dot(n, off, d->part[p].memory);
        for (size_t l = 0; l < n; l++)
            weight[l] += share * d->part[p].memory[l];
    }
}

/* Mixes weights with `inside` until none is negative. */
static void hold(const struct fitting *fitting, double weight[MOST_MECHANISMS])
{
    const size_t n = fitting->d->damping->mechanisms;
    double part = 0;
    for (size_t l = 0; l < n; l++)
        if (weight[l] < 0) part = fmax(part, -weight[l] / (fitting->inside[l] - weight[l]));
    for (size_t l = 0; l < n && part > 0; l++)
        weight[l] = fmax(0, weight[l] + part * (fitting->inside[l] - weight[l]));
}

/* Of size 1 unrelaxed: what its size is over density times the square of the phase speed where that is kept (Eq 8). */
static double size_of(const struct fitting *fitting, const double weight[MOST_MECHANISMS])
{
    struct modulus modulus = fitting->modulus;
    memcpy(modulus.weight, weight, sizeof modulus.weight);
    const double slowness = creal(1 / csqrt(modulus_at(&modulus, I * fitting->held)));
    return slowness * slowness;
}

/* rho c^2 where the speed is kept, of one at the reference. */
static double wanted_size(const struct fitting *fitting, double size, double q, double power)
{
    if (!(q > 0) || fitting->held == fitting->reference) return size;
    const struct modulus wanted = modulus_power_q(size, q, power, fitting->reference);
    const double speed = modulus_speed(&wanted, 1, fitting->held);
    return speed * speed;
}

/* Sizes and weights of the moduli of a value; false: there is no such passive solid. */
static bool fit_value(const struct fitting *fitting, const struct material *value, double size[3],
                      double weight[3][MOST_MECHANISMS])
{
    enum { TURNS = 40 };
    const size_t n = fitting->d->damping->mechanisms;
    const double wanted[2] = {
        wanted_size(fitting, value->density * value->p_speed * value->p_speed, value->q_p, value->q_power),
        wanted_size(fitting, value->mu, value->q_s, value->q_power)};
    double sum[3] = {0};
    memset(weight, 0, 3 * sizeof *weight);
    if (value->q_p > 0) {
        damping_curve_at(&fitting->curve, n, value->q_p, weight[AXIAL]);
        damping_curve_at(&fitting->curve, n, value->q_s, weight[SHEAR]);
        project(fitting, weight[AXIAL]);
        project(fitting, weight[SHEAR]);
        hold(fitting, weight[SHEAR]);
    }
    size[SHEAR] = wanted[SHEAR] * size_of(fitting, weight[SHEAR]);
    for (int turn = 0; turn < TURNS; turn++) {
        double before[MOST_MECHANISMS], change = 0;
        size[AXIAL] = wanted[AXIAL] * size_of(fitting, weight[AXIAL]);
        size[BULK] = size[AXIAL] - 4. / 3 * size[SHEAR];
        if (!(size[BULK] > 0)) return false;
        memcpy(before, weight[AXIAL], sizeof before);
        for (size_t l = 0; l < n; l++)
            weight[BULK][l] =
                (size[AXIAL] * weight[AXIAL][l] - 4. / 3 * size[SHEAR] * weight[SHEAR][l]) / size[BULK];
        hold(fitting, weight[BULK]);
        for (size_t l = 0; l < n; l++) {
            weight[AXIAL][l] =
                (size[BULK] * weight[BULK][l] + 4. / 3 * size[SHEAR] * weight[SHEAR][l]) / size[AXIAL];
            change = fmax(change, fabs(weight[AXIAL][l] - before[l]));
        }
        if (change < 1e-14) break;
    }
    for (int i = 0; i < 3; i++)
        for (size_t l = 0; l < n; l++)
            sum[i] += weight[i][l];
    return sum[BULK] < 1 && sum[SHEAR] < 1;
}

/* --- The model ------------------------------------------------------------------------------------------ */

/* Shares of part p: what of its way the weights lie off those of part 0. */
static double share_of(const struct damped *d, size_t p, const double weight[MOST_MECHANISMS])
{
    double off[MOST_MECHANISMS];
    for (size_t l = 0; l < d->damping->mechanisms; l++)
        off[l] = weight[l] - d->part[0].memory[l];
    return dot(d->damping->mechanisms, off, d->part[p].memory);
}

/* Fits the values of a box of the given model; `made` (NULL: none is kept) are the parts' ones, which begin at the same
 * values. */
static bool fit_box(const struct fitting *fitting, const struct model_grid *box,
                    const struct model_grid *const *made)
{
    const struct damped *d = fitting->d;
    bool good = true;
    for (size_t i = 0; i < box->n[0] * box->n[1] * box->n[2] && good; i++) {
        const struct material value = ground_model_material(fitting->given, box, i);
        double size[3], weight[3][MOST_MECHANISMS];
        good = fit_value(fitting, &value, size, weight);
        for (size_t p = 0; p < d->parts && made != NULL; p++) {
            if (made[p] == NULL) continue;
            made[p]->value[1][i] = sqrt(size[AXIAL] / value.density);
            made[p]->value[2][i] = sqrt(size[SHEAR] / value.density);
            if (p == 0) continue;
            made[p]->value[MODEL_VALUES][i] = share_of(d, p, weight[BULK]);
            made[p]->value[MODEL_VALUES + 1][i] = share_of(d, p, weight[SHEAR]);
        }
    }
    return good;
}

/* A grid while it is fitted. */
struct laying {
    const struct fitting *fitting;
    size_t number;
};

static bool lay_box(void *context, const struct model_grid *box, size_t first_column)
{
    (void)first_column;
    const struct laying *laying = context;
    const struct damped *d = laying->fitting->d;
    const struct model_grid *made[1 + MOST_MECHANISMS] = {NULL};
    for (size_t p = 0; p < d->parts; p++)
        made[p] = &d->field[p].grid[laying->number];
    return fit_box(laying->fitting, box, d->field[0].grid[laying->number].pieces == NULL ? made : NULL);
}

/* Context of pieces of a part's grid. */
struct fitted {
    const struct fitting *fitting;
    size_t number, part;
};

static bool read_fitted(void *context, const struct model_grid *box, const size_t first[3])
{
    const struct fitted *fitted = context;
    const struct model_grid *made[1 + MOST_MECHANISMS] = {NULL};
    made[fitted->part] = box;
    return model_pieces_read(&fitted->fitting->given->grid[fitted->number], box, first) &&
           fit_box(fitted->fitting, box, made);
}

/* The space of all columns has those of the fits, so their mean too. */
static void set_inside(struct fitting *fitting)
{
    const struct ground_damping *damping = fitting->d->damping;
    for (size_t i = 0; i < damping->materials; i++) {
        struct damping_column column[2];
        damping_columns(damping->mechanisms, &damping->fitted[i], column);
        for (size_t l = 0; l < damping->mechanisms; l++)
            fitting->inside[l] +=
                (column[0].weight[l] + column[1].weight[l]) / (2 * (double)damping->materials);
    }
}

/* The samples as the values are fitted: what the plan says is reached. */
static void refit_samples(const struct fitting *fitting, const struct scene *scene)
{
    const struct ground_damping *damping = fitting->d->damping;
    struct material sample[MOST_SAMPLES];
    const size_t count = damping_samples(scene->body.model, sample);
    for (size_t i = 0; i < count; i++) {
        struct damped_moduli *fitted = &damping->fitted[scene->materials + i];
        double size[3], weight[3][MOST_MECHANISMS];
        if (!(sample[i].q_p > 0) || !fit_value(fitting, &sample[i], size, weight)) continue;
        fitted->axial = fitted->shear = fitting->modulus;
        fitted->axial.size = size[AXIAL];
        fitted->shear.size = size[SHEAR];
        memcpy(fitted->axial.weight, weight[AXIAL], sizeof weight[AXIAL]);
        memcpy(fitted->shear.weight, weight[SHEAR], sizeof weight[SHEAR]);
    }
}

/* Pieces of grid `number` of part p that are fitted when they are asked for. */
static bool fit_later(const struct fitting *fitting, size_t number, size_t p, struct model_grid *grid)
{
    struct fitted *fitted = array_new(1, sizeof *fitted);
    const struct model_origin origin = {read_fitted, array_free, fitted, MODEL_SETS,
                                        &fitting->given->grid[number]};
    if (fitted != NULL) *fitted = (struct fitted){fitting, number, p};
    if (fitted != NULL && model_pieces_new(grid, &origin)) return true;
    array_free(fitted);
    return false;
}

/* Sets of numbers that a part's grids have of their own. */
static int first_own(size_t part)
{
    return part == 0 ? 1 : MODEL_VALUES;
}

static int end_own(size_t part)
{
    return part == 0 ? MODEL_VALUES : MODEL_SETS;
}

/* Own grids, with own numbers; all else is that of `other`. */
static bool share_model(const struct fitting *fitting, const struct ground_model *other, size_t p)
{
    struct ground_model *made = &fitting->d->field[p];
    *made = *other;
    made->grid = array_new(other->grids, sizeof *made->grid);
    bool good = made->grid != NULL;
    for (size_t i = 0; i < other->grids && good; i++) {
        struct model_grid *grid = &made->grid[i];
        *grid = other->grid[i];
        grid->pieces = NULL;
        if (other->grid[i].pieces != NULL) good = fit_later(fitting, i, p, grid);
        for (int set = first_own(p); set < end_own(p) && other->grid[i].pieces == NULL; set++) {
            grid->value[set] = array_new(grid->n[0] * grid->n[1] * grid->n[2], sizeof(double));
            good = good && grid->value[set] != NULL;
        }
    }
    return good;
}

void damped_field_free(struct damped *d)
{
    for (size_t p = 0; d->field != NULL && p < d->parts; p++) {
        struct ground_model *made = &d->field[p];
        for (size_t i = 0; made->grid != NULL && i < made->grids; i++) {
            for (int set = first_own(p); set < end_own(p) && made->grid[i].pieces == NULL; set++)
                array_free(made->grid[i].value[set]);
            model_pieces_free(&made->grid[i]);
        }
        array_free(made->grid);
    }
    array_free(d->field);
    array_free(d->fitting);
}

/* What the parts' ground is made with; the modulus has no weights yet. */
static struct fitting *fitting_new(const struct damped *d, const struct ground_model *given)
{
    struct fitting *fitting = array_new(1, sizeof *fitting);
    if (fitting == NULL) return NULL;
    fitting->d = d;
    fitting->given = given;
    fitting->modulus =
        (struct modulus){.size = 1, .mechanisms = d->damping->mechanisms, .by = d->damping->band.by};
    memcpy(fitting->modulus.rate, d->damping->rate, sizeof fitting->modulus.rate);
    fitting->reference = given->q_frequency > 0 ? 2 * M_PI * given->q_frequency : d->damping->centroid;
    fitting->held = relaxation_held(&d->damping->band, fitting->reference);
    set_inside(fitting);
    return fitting;
}

static bool field_new(struct damped *d)
{
    const struct ground_model *given = d->fitting->given;
    d->field = array_new(d->parts, sizeof *d->field);
    if (d->field == NULL || !share_model(d->fitting, given, 0)) return false;
    for (size_t p = 1; p < d->parts; p++)
        if (!share_model(d->fitting, &d->field[0], p)) return false;
    for (size_t p = 0; p < d->parts; p++)
        d->field[p].given = given;
    return true;
}

selas_status damped_field(struct damped *d, const struct scene *scene, struct messages *messages)
{
    const struct ground_model *given = scene->body.model;
    d->fitting = fitting_new(d, given);
    if (d->fitting == NULL || !field_new(d))
        return fail(messages, SELAS_NO_MEMORY, "no memory for the ground's damping");
    selas_status status =
        given->damped ? damping_curve_set(d->damping, given, &d->fitting->curve, messages) : SELAS_OK;
    for (size_t i = 0; i < given->grids && status == SELAS_OK; i++) {
        struct laying laying = {d->fitting, i};
        bool unread = false;
        if (!model_walk(&given->grid[i], lay_box, &laying, &unread) && !unread)
            status = fail(messages, SELAS_BAD_SCENE,
                          "damping: %zu relaxation mechanisms cannot stand for the Q of the &model",
                          d->damping->mechanisms);
    }
    if (status == SELAS_OK) refit_samples(d->fitting, scene);
    return status;
}
