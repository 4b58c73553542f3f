/* What displacements of the lattice lack beside an interface, where those of the ground have a kink
 * (doc/theory/general-ground.md, section 6). */
#include "method/consistent/general/kink.h"

#include "base/memory.h"
#include "method/consistent/general/glut.h"
#include "method/consistent/general/medium.h"
#include "scene/ground.h"

#include <math.h>

/* Tractions at the place from those at the two knots beside it; at a free end they are 0. */
static void find_share(struct glut *g)
{
    const struct spline *spline = g->c->spline[g->across];
    const double cells = (double)spline->cells, at = (g->centre[g->across] - spline->low) / g->spacing;
    const double first = fmin(fmax(floor(at), 0), cells - 1), part = at - first;
    const struct boundary *end = &g->c->model.scene->boundary[2 * g->across];
    g->share[(size_t)first] = 1 - part;
    g->share[(size_t)first + 1] = part;
    if (first == 0 && boundary_is_free(&end[0])) g->share[0] = 0;
    if (first == cells - 1 && boundary_is_free(&end[1])) g->share[spline->cells] = 0;
}

/* Does the rock jump within some spacings along the axes or diagonals of the lattice? */
static bool jumps_near(const struct consistent *c, const double centre[3])
{
    enum { REACH = 3, FINE = 32 };
    for (int code = 0; code < (c->dimension == 2 ? 9 : 27); code++) {
        const double way[3] = {code % 3 - 1, code / 3 % 3 - 1, c->dimension == 2 ? 0 : code / 9 - 1};
        struct rock last = consistent_rock_at(c, centre);
        for (int n = 1; n <= REACH * FINE; n++) {
            double place[3] = {centre[0], centre[1], centre[2]};
            for (int axis = 0; axis < c->dimension && axis < 3; axis++)
                place[axis] += way[axis] * glut_spacing(c->spline[axis]) * n / FINE;
            const struct rock rock = consistent_rock_at(c, place);
            if (consistent_rock_differs(rock, last)) return true;
            last = rock;
        }
    }
    return false;
}

/* What is alike for all directions, with room to be freed: NULL where nothing is lacking. False: no memory. */
static bool begin(struct glut *g, double *work[3], double **room)
{
    *room = NULL;
    if (!general_find_normal(g) || !g->surface) return true;
    *room = glut_room(g, work);
    double failed = *room == NULL;
    ranks_largest(g->c->part.ranks, 1, &failed);
    if (*room == NULL || failed != 0) {
        array_free(*room);
        return false;
    }
    find_share(g);
    general_find_lag(g);
    return true;
}

/* (G30) */
static void add_kink(struct glut *g, double *const work[3], const double direction[3], struct dense *field)
{
    const double *n = g->normal;
    double stress[3][3], along = 0;
    for (int i = 0; i < 3; i++)
        along += direction[i] * n[i];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const double shear = (direction[i] - along * n[i]) * n[j] + (direction[j] - along * n[j]) * n[i];
            g->strain[i][j] = g->lag * shear / 2 + g->press * along * n[i] * n[j];
            stress[i][j] = -g->slack * along * ((i == j) - n[i] * n[j]);
        }
    glut_add_points(g, work);
    glut_add_stress(g, 0, g->centre[g->across], 1, stress);
    glut_add_lines(g, 0, work, field);
}

static struct glut glut_at(const struct consistent *c, const double centre[3], bool half)
{
    return (struct glut){.c = c, .centre = {centre[0], centre[1], centre[2]}, .plain = true, .half = half};
}

bool general_add_kink(const struct consistent *c, const double centre[3], const double direction[3],
                      bool half, struct dense *field)
{
    struct glut glut = glut_at(c, centre, half);
    double *work[3], *room;
    if (general_is_part(c->model.scene) || !jumps_near(c, centre)) return true;
    if (!begin(&glut, work, &room)) return false;
    if (room != NULL) add_kink(&glut, work, direction, field);
    array_free(room);
    return true;
}

static bool see_kinks(const struct consistent *c, const double place[3], struct readings *readings)
{
    struct glut glut = glut_at(c, place, false);
    double *work[3], *room;
    if (!begin(&glut, work, &room)) return false;
    if (room == NULL) return true;
    struct dense field = {.value = array_new((size_t)c->dimension * c->volume, sizeof(double))};
    double failed = field.value == NULL;
    ranks_largest(c->part.ranks, 1, &failed);
    for (int component = 0; component < c->dimension && failed == 0; component++) {
        double direction[3] = {0};
        direction[c->slot[component]] = 1;
        glut_clear(&glut);
        add_kink(&glut, work, direction, &field);
        failed = !sparse_take(c, &field, &readings->kink[component]);
        ranks_largest(c->part.ranks, 1, &failed);
    }
    array_free(field.value);
    array_free(room);
    return failed == 0;
}

/* Moment tensors whose work is that of a strain, whole on symmetry planes too. */
static bool see_strains(struct consistent *c, const double place[3], struct readings *readings)
{
    static const int voigt[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    const struct body *body = &c->model.scene->body;
    double whole = 1;
    for (int axis = 0; axis < c->dimension; axis++) {
        const struct spline *spline = c->spline[axis];
        const double small = 1e-9 * (spline->high - spline->low);
        if ((spline->mirror[0] && fabs(place[axis] - spline->low) < small) ||
            (spline->mirror[1] && fabs(place[axis] - spline->high) < small))
            whole *= 2;
    }
    struct sparse *strain = readings->strain;
    for (int i = 0; i < c->dimension; i++)
        for (int j = i; j < c->dimension; j++) {
            struct load load = {.kind = LOAD_MOMENT_TENSOR, .shape = LOAD_POINT, .amplitude = 1};
            lattice_to_deck(body, place, load.centre);
            for (int k = 0; k < 3; k++)
                for (int l = 0; l < 3; l++) {
                    const double *one = body->frame[k], *other = body->frame[l];
                    const double turned = body->rotated ? (one[i] * other[j] + one[j] * other[i]) / 2
                                                        : ((k == i && l == j) + (k == j && l == i)) / 2.;
                    load.moment[voigt[k][l]] = whole * turned;
                }
            if (!forces_of_moment(c, general_add_seen, &load, strain++)) return false;
        }
    return true;
}

bool general_see(struct consistent *c, const double place[3], unsigned fields, struct readings *readings)
{
    static const unsigned moved = 1U << SELAS_DISPLACEMENT | 1U << SELAS_VELOCITY | 1U << SELAS_ACCELERATION,
                          strained = 1U << SELAS_STRAIN | 1U << SELAS_STRESS | 1U << SELAS_PRESSURE |
                                     1U << SELAS_ENERGY;
    if (general_is_part(c->model.scene) || !jumps_near(c, place)) return true;
    if ((fields & moved) != 0 && !see_kinks(c, place, readings)) return false;
    return (fields & strained) == 0 || see_strains(c, place, readings);
}

/* The most that one of them has. */
static size_t sites_of(const struct sparse *of, size_t count)
{
    size_t most = 0;
    for (size_t n = 0; n < count; n++) {
        const size_t has = of[n].start != NULL ? of[n].start[of[n].planes] : 0;
        most = has > most ? has : most;
    }
    return count * most;
}

static size_t strains(const struct consistent *c)
{
    return (size_t)(c->dimension * (c->dimension + 1) / 2);
}

size_t readings_sites(const struct consistent *c, const struct readings *readings)
{
    return sites_of(readings->kink, (size_t)c->dimension) + sites_of(readings->strain, strains(c));
}

static bool keep(struct consistent *c, const struct sparse *of, size_t count, size_t first,
                 struct probe *probe)
{
    const size_t each = sites_of(of, count) / count;
    for (size_t n = 0; n < count && each > 0; n++, first += each)
        for (size_t p = 0; p < of[n].planes; p++)
            for (size_t e = of[n].start[p]; e < of[n].start[p + 1]; e++) {
                const size_t seen = of[n].plane[p] % c->n[DEPTH] * c->plane + of[n].index[e];
                probe->index[first + e] = of[n].plane[p] / c->n[DEPTH] * c->volume + seen;
                probe->weight[first + e] = of[n].value[e];
                if (c->dimension == 3 && !watch_places(c, 1, &seen)) return false;
            }
    return true;
}

bool readings_keep(struct consistent *c, const struct readings *readings, struct probe *probe)
{
    const size_t kinks = sites_of(readings->kink, (size_t)c->dimension);
    probe->sites = readings_sites(c, readings);
    probe->strains = probe->sites - kinks;
    return keep(c, readings->kink, (size_t)c->dimension, probe->count, probe) &&
           keep(c, readings->strain, strains(c), probe->count + kinks, probe);
}

void readings_free(struct readings *readings)
{
    for (int n = 0; n < 3; n++)
        sparse_free(&readings->kink[n]);
    for (int n = 0; n < 6; n++)
        sparse_free(&readings->strain[n]);
}
