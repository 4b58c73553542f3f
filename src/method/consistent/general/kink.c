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
    if (general_is_part(g->c->model.scene) || !jumps_near(g->c, g->centre)) return true;
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
    if (!begin(&glut, work, &room)) return false;
    if (room != NULL) add_kink(&glut, work, direction, field);
    array_free(room);
    return true;
}

bool general_see_kink(const struct consistent *c, const double place[3], struct kinks *kinks)
{
    struct glut glut = glut_at(c, place, false);
    double *work[3], *room;
    if (!begin(&glut, work, &room)) return false;
    if (room == NULL) return true;
    struct dense field = {.value = array_new((size_t)c->dimension * c->volume, sizeof(double))};
    double failed = field.value == NULL;
    ranks_largest(c->part.ranks, 1, &failed);
    for (int component = 0; component < c->dimension && failed == 0; component++) {
        struct sparse *kink = &kinks->of[component];
        double direction[3] = {0};
        direction[c->slot[component]] = 1;
        glut_clear(&glut);
        add_kink(&glut, work, direction, &field);
        failed = !sparse_take(c, &field, kink);
        ranks_largest(c->part.ranks, 1, &failed);
        const size_t sites = failed != 0 ? 0 : (size_t)c->dimension * kink->start[kink->planes];
        kinks->sites = sites > kinks->sites ? sites : kinks->sites;
    }
    array_free(field.value);
    array_free(room);
    return failed == 0;
}

bool general_keep_kink(struct consistent *c, const struct kinks *kinks, struct probe *probe)
{
    probe->sites = kinks->sites;
    for (int component = 0; component < c->dimension && probe->sites > 0; component++) {
        const struct sparse *kink = &kinks->of[component];
        const size_t first = probe->count + (size_t)component * probe->sites / (size_t)c->dimension;
        for (size_t p = 0; p < kink->planes; p++)
            for (size_t e = kink->start[p]; e < kink->start[p + 1]; e++) {
                const size_t seen = kink->plane[p] % c->n[DEPTH] * c->plane + kink->index[e];
                probe->index[first + e] = kink->plane[p] / c->n[DEPTH] * c->volume + seen;
                probe->weight[first + e] = kink->value[e];
                if (c->dimension == 3 && !watch_places(c, 1, &seen)) return false;
            }
    }
    return true;
}

void kinks_free(struct kinks *kinks)
{
    for (int component = 0; component < 3; component++)
        sparse_free(&kinks->of[component]);
}
