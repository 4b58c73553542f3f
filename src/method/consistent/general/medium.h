/* The effective medium at the points of the general operator (doc/theory/general-ground.md, section 4). */
#ifndef SELAS_METHOD_CONSISTENT_GENERAL_MEDIUM_H
#define SELAS_METHOD_CONSISTENT_GENERAL_MEDIUM_H

#include "method/consistent/general/general.h"
#include "scene/ground.h"

/* What is averaged, in this order, M = lambda + 2 mu (G10): all but the last two must stay positive. */
enum average {
    MEAN_DENSITY,
    MEAN_SOFTNESS, /* 1 / M */
    MEAN_SLIP,     /* 1 / mu */
    MEAN_SHEAR,    /* mu */
    MEAN_SPREAD,   /* mu (3 lambda + 2 mu) / M */
    MEAN_RATIO,    /* lambda / M */
    AVERAGES,
    POSITIVE = MEAN_RATIO
};

/* At a place: averages, the least of what they are of, and where the logarithm of M rises to, by slot. */
struct averaged {
    double mean[AVERAGES], least[POSITIVE], rise[3], level;
    double by_bulk[AVERAGES],
        least_by_bulk[POSITIVE]; /* derivatives by e, kappa (1 + e) in the place of kappa
                                                          everywhere; 0 but in parts of damped ground */
    bool even;                   /* one rock all around */
};

/* C of the effective medium in Voigt's order of the slots (points.h), the upper triangle by rows. False: it is
 * isotropic, with this lambda and mu. */
bool medium_stiffness(const struct averaged *averaged, double stiffness[STIFFNESSES], double *lambda,
                      double *mu);
/* dC/de where it is not isotropic, about the same normal. */
void medium_bulk_stiffness(const struct averaged *averaged, double stiffness[STIFFNESSES]);

/* part.c: a part of damped ground but the one that is the whole. */
bool general_is_part(const struct scene *scene);
struct sharing;
struct sharing *sharing_new(const struct consistent *c); /* NULL: no memory */
void sharing_free(struct sharing *sharing);              /* takes NULL */
/* From the numbers of the whole ground at point `at` of a family to those of the part; stiffness NULL: it is
 * isotropic. */
void general_share(const struct sharing *sharing, const struct family *family, const size_t at[3],
                   const struct averaged *averaged, double *stiffness, double *lambda, double *mu);

/* Averages over plane k of the points of family f: k must not fall, for any two families by no more than a plane. */
struct medium;
struct medium *medium_new(const struct consistent *c); /* NULL: no memory */
void medium_free(struct medium *medium);
size_t medium_bytes(const struct medium *medium);
void medium_plane(struct medium *medium, int f, size_t k);
/* Of point i, j of that plane, with the metric there. */
void medium_point(const struct medium *medium, size_t i, size_t j, const struct metric *metric,
                  struct averaged *averaged);

#endif
