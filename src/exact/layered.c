/* Layers over a half-space under tractions on the surface: the compliances of exact/strata.c with the source there, in
 * the form in which the half-space has them (doc/theory/layered.md). */
#include "exact/layered.h"

#include "base/memory.h"
#include "exact/strata.h"

#include <math.h>
#include <string.h>

enum { MOST_STRATA = 64 };

/* The strata with a face put in at depth z, where the receiver is; the source is on the surface. */
struct cut {
    double depth[MOST_STRATA];
    size_t rock[MOST_STRATA], source, receiver;
    bool moments;
};

static struct strata cut_at(const struct layered *layered, double z, struct cut *cut)
{
    size_t count = 0;
    *cut = (struct cut){.receiver = 0};
    for (size_t i = 0; i < layered->strata; i++) {
        const double top = layered->stratum[i].top;
        const double bottom = i + 1 < layered->strata ? layered->stratum[i + 1].top : INFINITY;
        if (z == top) cut->receiver = count;
        cut->depth[count] = top;
        cut->rock[count++] = i;
        if (!(z > top && z < bottom)) continue;
        cut->receiver = count;
        cut->depth[count] = z;
        cut->rock[count++] = i;
    }
    return (struct strata){.levels = count,
                           .depth = cut->depth,
                           .rock = cut->rock,
                           .rocks = layered->strata,
                           .sources = 1,
                           .source = &cut->source,
                           .moments = &cut->moments,
                           .receivers = 1,
                           .receiver = &cut->receiver};
}

static struct pair pair_of(double complex z)
{
    return (struct pair){creal(z), cimag(z)};
}

void layered_compliance(const struct layered *layered, double complex s, double z, size_t count,
                        const double *k, bool horizontal_loads, struct compliance *compliance)
{
    static const struct {
        int column, response;
        double sign;
    } of[5] = {{COLUMN_VERTICAL, RESPONSE_W, 1},
               {COLUMN_VERTICAL, RESPONSE_U, 1},
               {COLUMN_RADIAL, RESPONSE_U, 1},
               {COLUMN_RADIAL, RESPONSE_W, -1},
               {COLUMN_ACROSS, RESPONSE_V, 1}};
    struct cut cut;
    struct strata_piece piece[MOST_STRATA];
    struct rock_at rock[MOST_STRATA];
    struct pair response[COLUMNS * RESPONSES];
    const struct strata strata = cut_at(layered, z, &cut);
    const double mu = layered->stratum[0].mu;
    for (size_t i = 0; i < layered->strata; i++) {
        const struct stratum *stratum = &layered->stratum[i];
        const double complex p = s / stratum->p_speed, q = s / stratum->s_speed;
        const double ratio = stratum->p_speed / stratum->s_speed;
        rock[i] = (struct rock_at){
            {stratum->mu / mu, 0}, {ratio * ratio * stratum->mu / mu, 0}, pair_of(p * p), pair_of(q * q)};
    }
    double(*const parts[5])[BLOCK] = {compliance->vertical, compliance->horizontal, compliance->radial,
                                      compliance->coupled, compliance->shear};
    for (size_t i = 0; i < count; i++) {
        strata_responses(&strata, rock, k[i], piece, response);
        for (int j = 0; j < (horizontal_loads ? 5 : 2); j++) {
            const struct pair value = response[of[j].column * RESPONSES + of[j].response];
            parts[j][0][i] = of[j].sign * value.re;
            parts[j][1][i] = of[j].sign * value.im;
        }
    }
}

void layered_add_difference(const struct layered *layered, const struct half_space *top, double complex s,
                            double z, size_t count, const double *k, bool horizontal_loads,
                            struct compliance *compliance)
{
    if (layered->strata < 2) return;
    /* the way down to the first interface and to the receiver: exp(-36) is below rounding */
    const double way = fmax(z, 2 * layered->stratum[1].top - z);
    const double most = hypot(36 / way, cimag(s) / layered->slowest);
    while (count > 0 && k[count - 1] > most)
        count--;
    if (count == 0) return;
    struct compliance with, without;
    layered_compliance(layered, s, z, count, k, horizontal_loads, &with);
    half_space_compliance(top, s, z, count, k, horizontal_loads, false, &without);
    double(*const to[5])[BLOCK] = {compliance->vertical, compliance->horizontal, compliance->radial,
                                   compliance->coupled, compliance->shear};
    double(*const plus[5])[BLOCK] = {with.vertical, with.horizontal, with.radial, with.coupled, with.shear};
    double(*const minus[5])[BLOCK] = {without.vertical, without.horizontal, without.radial, without.coupled,
                                      without.shear};
    for (int j = 0; j < (horizontal_loads ? 5 : 2); j++)
        for (int part = 0; part < 2; part++)
            for (size_t i = 0; i < count; i++)
                to[j][part][i] += plus[j][part][i] - minus[j][part][i];
}

selas_status layered_from(size_t strata, const struct stratum *stratum, struct layered **created,
                          struct messages *messages)
{
    *created = NULL;
    if (strata == 0 || strata > MOST_STRATA - 2)
        return fail(messages, SELAS_BAD_SCENE, "reference 'lamb': %zu layers; expected 1 to %d", strata,
                    MOST_STRATA - 2);
    struct layered *layered = array_new(1, sizeof *layered);
    struct stratum *copy = array_new(strata, sizeof *copy);
    if (layered == NULL || copy == NULL) {
        array_free(layered);
        array_free(copy);
        return fail(messages, SELAS_NO_MEMORY, "not enough memory for the layers of the reference 'lamb'");
    }
    memcpy(copy, stratum, strata * sizeof *copy);
    layered->strata = strata;
    layered->stratum = copy;
    layered->slowest = INFINITY;
    for (size_t i = 0; i < strata; i++) {
        struct half_space alone;
        const double mu = copy[i].mu, speed = copy[i].p_speed;
        half_space_set(&alone, copy[i].density, copy[i].density * speed * speed - 2 * mu, mu);
        layered->slowest = fmin(layered->slowest, alone.rayleigh_speed);
        layered->fastest[0] = fmax(layered->fastest[0], copy[i].p_speed);
        layered->fastest[1] = fmax(layered->fastest[1], copy[i].s_speed);
    }
    *created = layered;
    return SELAS_OK;
}

static struct stratum stratum_of(const struct material *material, double top)
{
    return (struct stratum){top, material->density, material->mu, material->p_speed, material->s_speed};
}

selas_status layered_create(const struct scene *scene, struct layered **created, struct messages *messages)
{
    const struct body *body = &scene->body;
    struct stratum stratum[MOST_STRATA];
    size_t strata = 0;
    if (body->layers == 0 || body->layer[0].top > 0)
        stratum[strata++] = stratum_of(&scene->material[body->material], 0);
    for (size_t i = 0; i < body->layers && strata < MOST_STRATA; i++)
        stratum[strata++] = stratum_of(&scene->material[body->layer[i].material], body->layer[i].top);
    return layered_from(strata, stratum, created, messages);
}

void layered_free(struct layered **layered)
{
    if (layered == NULL || *layered == NULL) return;
    array_free((*layered)->stratum);
    array_free(*layered);
    *layered = NULL;
}
