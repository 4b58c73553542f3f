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

/* Plain means over the cell, of the whole ground and of a part of it (G11a); 0 but in parts. */
enum cell {
    CELL_SOFTNESS,
    CELL_SPREAD,
    CELL_SLIP,
    CELL_SHEAR,
    PART_SOFTNESS,
    PART_RATIO,
    PART_SPREAD,
    PART_SLIP,
    PART_SHEAR,
    CELL
};

/* log M and its first and second slopes in cells, by slot (G10a); those along the surface stand first. */
enum slope {
    SLOPE_NONE,
    SLOPE_0,
    SLOPE_1,
    SLOPE_00,
    SLOPE_01,
    SLOPE_11,
    FLAT,
    SLOPE_2 = FLAT,
    SLOPE_02,
    SLOPE_12,
    SLOPE_22,
    SLOPES
};

/* At a place: averages, the least of what they are of, slopes, and by slot the normal of the layering. */
struct averaged {
    double mean[AVERAGES], cell[CELL], least[POSITIVE], slope[SLOPES], normal[3];
    bool even; /* one rock all around */
};

/* C of the effective medium in Voigt's order of the slots (points.h), the upper triangle by rows. False: it is
 * isotropic, with this lambda and mu. */
bool medium_stiffness(const struct averaged *averaged, double stiffness[STIFFNESSES], double *lambda,
                      double *mu);
/* The same for a part of damped ground (G11a); stiffness NULL where C of the whole is isotropic. */
void medium_part(const struct averaged *averaged, double *stiffness, double *lambda, double *mu);

/* A part of damped ground (method/damped/damped.h) but the one that is the whole. */
bool general_is_part(const struct scene *scene);

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
